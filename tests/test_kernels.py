"""Kernels: one signature each, and kept between runs."""

import ast
import importlib
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numba
import numpy as np
import pytest

from physicslab import kernels
from physicslab.kernels import KERNELS, Flags, Numbers, Rows, Vectors, compile_kernels, kernel, motion

FOLDER = Path(kernels.__file__).parent
MODULES = sorted(
    ".".join(path.relative_to(FOLDER).with_suffix("").parts) for path in FOLDER.rglob("[a-z]*.py")
)


@kernel
def every_type(
    numbers: Numbers, vectors: Vectors, rows: Rows, flags: Flags, x: float, n: int, on: bool
) -> None:
    """Take one of each type that a kernel takes."""


@kernel
def total(numbers: Numbers, n: int) -> tuple[float, int]:
    """Return two values of different types."""
    return numbers.sum(), n


@pytest.fixture(autouse=True, scope="module")
def _leave_no_kernels() -> Any:
    compile_kernels((every_type, total))
    yield
    for made in (every_type, total):
        KERNELS.remove(made)


def test_annotations_are_the_signature() -> None:
    [taken] = every_type.signatures  # type: ignore[attr-defined]
    assert [str(kind) for kind in taken] == [
        "array(float64, 1d, C)", "array(float64, 2d, C)", "array(int64, 1d, C)", "array(bool, 1d, C)",
        "float64", "int64", "bool",
    ]  # fmt: skip
    assert total(np.ones(3), 4) == (3.0, 4)


def test_an_annotation_that_is_no_type_of_a_kernel_is_refused() -> None:
    with pytest.raises(KeyError):

        @kernel
        def takes_text(text: str) -> None: ...


@pytest.mark.parametrize(
    "odd", [np.ones(3, np.float32), np.ones(3, np.int64), np.ones(6)[::2], np.ones((2, 2)), [1.0, 2.0]]
)
def test_nothing_is_compiled_behind_the_back(odd: Any) -> None:
    with pytest.raises(TypeError, match="No matching definition"):
        total(odd, 1)
    assert len(total.signatures) == 1  # type: ignore[attr-defined]


def test_compiling_again_costs_nothing() -> None:
    compile_kernels(KERNELS)
    assert compile_kernels(KERNELS) < 0.01
    assert all(len(made.signatures) == 1 for made in KERNELS)


def test_numbers_that_are_none_survive_fast_arithmetic() -> None:
    compile_kernels((motion.find_not_finite,))
    vectors, numbers = np.zeros((5, 2)), np.zeros(5)
    assert motion.find_not_finite(vectors, numbers) == -1
    for odd in (np.nan, np.inf, -np.inf):
        for column, place in ((vectors, (3, 0)), (vectors, (3, 1)), (numbers, 3)):
            column[place] = odd
            assert motion.find_not_finite(vectors, numbers) == 3
            column[place] = 0.0
    vectors[:], numbers[:] = 1.7e308, 1.7e308
    assert motion.find_not_finite(vectors, numbers) == -1


def test_half_kicks_compose_to_whole_ones() -> None:
    compile_kernels((motion.kick,))
    random = np.random.default_rng(0)
    linear, force, weights = random.normal(size=(4, 2)), random.normal(size=(4, 2)), random.uniform(size=4)
    spins, free = random.normal(size=4), np.zeros(4, np.bool_)
    once, twice = (linear.copy(), spins.copy()), (linear.copy(), spins.copy())
    motion.kick(*once, force, spins, weights, weights, free, 0.7, 0.3, 0.5)
    for _ in range(2):
        motion.kick(*twice, force, spins, weights, weights, free, 0.7, 0.3, 0.25)
    assert once[0] == pytest.approx(twice[0], rel=1e-14)
    assert once[1] == pytest.approx(twice[1], rel=1e-14)


@pytest.mark.parametrize("module", MODULES)
def test_every_kernel_compiles(module: str) -> None:
    importlib.import_module(f"physicslab.kernels.{module}")
    own = [made for made in KERNELS if made.py_func.__module__ == f"physicslab.kernels.{module}"]
    compile_kernels(own)
    assert all(made.py_func.__doc__ for made in own)


# ---- the cache ---------------------------------------------------------------------------------------------

COMPILE = """
from physicslab.kernels import cache_directory, compile_kernels, motion
compile_kernels((motion.clear,))
print(cache_directory(), sum(motion.clear.stats.cache_hits.values()))
"""


def run_with(**environment: str) -> tuple[Path, int]:
    """Compile one kernel in a fresh process; return where it is kept, and whether it was there already."""
    done = subprocess.run(
        [sys.executable, "-c", COMPILE],
        env=os.environ | environment,
        capture_output=True,
        text=True,
        check=True,
    )
    place, hits = done.stdout.split()
    return Path(place), int(hits)


def test_kernels_are_kept_between_runs(tmp_path: Path) -> None:
    place, hits = run_with(XDG_CACHE_HOME=str(tmp_path))
    assert place.is_relative_to(tmp_path) and hits == 0
    assert list(place.rglob("*.nbc"))
    assert run_with(XDG_CACHE_HOME=str(tmp_path)) == (place, 1)


def test_a_cache_that_cannot_be_written_is_put_elsewhere(tmp_path: Path) -> None:
    blocked = tmp_path / "a file"
    blocked.write_text("no directory")
    place, _ = run_with(XDG_CACHE_HOME=str(blocked), TMPDIR=str(tmp_path))
    assert place.is_relative_to(tmp_path) and not place.is_relative_to(blocked)


def test_the_cache_is_named_after_what_is_in_it(monkeypatch: pytest.MonkeyPatch) -> None:
    before = kernels.cache_directory()
    assert kernels.cache_directory() == before
    monkeypatch.setattr(numba, "__version__", "0.0")
    assert kernels.cache_directory() != before
    kernels.cache_directory().rmdir()


def test_functions_that_count_no_references_return_no_arrays() -> None:
    """What one of those returned would be given up once too often by whoever called it."""
    for path in sorted(FOLDER.glob("*.py")):
        for node in ast.parse(path.read_text()).body:
            if isinstance(node, ast.FunctionDef) and node.returns is not None:
                decorators = {ast.unparse(decorator) for decorator in node.decorator_list}
                if decorators & {"inlined", "inlined_loosely"}:
                    returned = set(re.findall(r"\w+", ast.unparse(node.returns)))
                    assert returned <= {"float", "int", "bool", "tuple", "None", "Wide"}, node.name
