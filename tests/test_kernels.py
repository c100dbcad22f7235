"""Kernels: one signature each, compiled when they are needed."""

import gc
import importlib
import time
from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from compiled import compiled

from physicslab import World, kernels
from physicslab.components import Mass, Transform, Velocity
from physicslab.kernels import (
    KERNELS,
    Flags,
    Numbers,
    Rows,
    Vectors,
    allocating,
    always_inlined,
    ask_before_compiling,
    compile_kernels,
    inlined,
    inlined_loosely,
    kernel,
    load,
    loading,
    motion,
    seconds_waited,
    working_ns,
)
from physicslab.state.state import State
from physicslab.systems.system import Stage, System, at

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
    # Where workers share the tests of a module out, it may begin and end more than once.
    KERNELS.extend(made for made in (every_type, total) if made not in KERNELS)
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
    compile_kernels((motion.find_beyond,))
    vectors, numbers = np.zeros((5, 2)), np.zeros(5)
    assert motion.find_beyond(vectors, numbers, motion.LARGEST) == -1
    for odd in (np.nan, np.inf, -np.inf):
        for column, place in ((vectors, (3, 0)), (vectors, (3, 1)), (numbers, 3)):
            column[place] = odd
            assert motion.find_beyond(vectors, numbers, motion.LARGEST) == 3
            column[place] = 0.0
    vectors[:], numbers[:] = 1.7e308, 1.7e308
    assert motion.find_beyond(vectors, numbers, motion.LARGEST) == -1


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


def test_a_kernel_is_compiled_at_its_first_call_and_for_its_signature_alone() -> None:
    @kernel
    def doubled(numbers: Numbers, n: int) -> float:
        return float(2.0 * numbers[n])

    try:
        assert not doubled.compiled  # type: ignore[attr-defined]
        before = seconds_waited()
        with pytest.raises(TypeError, match="No matching definition"):
            doubled(np.ones(3, np.float32), 1)
        assert len(doubled.signatures) == 1  # type: ignore[attr-defined]
        assert doubled(np.ones(3), 1) == 2.0
        assert doubled.compiled and seconds_waited() > before  # type: ignore[attr-defined]
    finally:
        KERNELS.remove(doubled)


def test_what_is_called_at_first_may_be_answered_by_something_else() -> None:
    """While another process compiles it, a kernel need not be there."""

    @kernel
    def tripled(x: float) -> float:
        return 3.0 * x

    asked: list[Any] = []

    def interpret(missing: Sequence[Any]) -> list[Any]:
        asked.extend(missing)
        missing[0]._compile_for_args = lambda *_: missing[0].py_func
        return list(missing)

    try:
        ask_before_compiling(interpret)
        assert tripled(2.0) == 6.0
        assert asked == [tripled] and not tripled.compiled  # type: ignore[attr-defined]
        load(tripled)
        assert tripled(2.0) == 6.0 and len(tripled.signatures) == 1  # type: ignore[attr-defined]
    finally:
        ask_before_compiling(None)
        KERNELS.remove(tripled)


@pytest.mark.parametrize("make", [inlined, allocating, inlined_loosely, always_inlined])
def test_inner_functions_refuse_calls_from_python(make: Any) -> None:
    """They have no entry for it: of one that a kernel calls, such a call would end the process."""

    @make  # type: ignore[untyped-decorator]
    def half(x: float) -> float:
        return 0.5 * x

    @inlined
    def calls(x: float) -> float:
        return float(half(x))

    assert compiled(calls)(3.0) == 1.5 == half.py_func(3.0)
    with pytest.raises(TypeError, match=r"half is called by kernels alone"):
        half(3.0)
    assert type(half._cache).__name__ == "NullCache"


def test_what_counts_no_references_returns_no_arrays() -> None:
    """What it returned would be freed by a caller that counts them."""

    @inlined
    def same(array: Any) -> Any:
        return array

    with pytest.raises(TypeError, match="same returns arrays"):
        compiled(same)(np.zeros(2))


def test_inner_functions_are_compiled_once_for_constants_and_variables() -> None:
    @inlined
    def shifted(x: float, n: int, up: bool) -> float:
        return x + n if up else x - n

    @inlined
    def calls(n: int) -> float:
        total, k = 0.0, 0
        while k < n:
            total += shifted(1.0, k, True) + shifted(1.0, 1, False)
            k += 1
        return total

    assert compiled(calls)(3) == 1.0 + 2.0 + 3.0
    assert len(shifted.signatures) == 1  # type: ignore[attr-defined]


def test_the_clock_of_work_stands_still_while_kernels_are_compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    """On a clock of its own, which compiling moves by 3 s and working by 1 s."""

    @kernel
    def squared(x: float) -> float:
        return x * x

    now, collecting = 10**9, []
    compile_it = squared.compile  # type: ignore[attr-defined]

    def take_three_seconds(signature: Any) -> Any:
        nonlocal now
        now += 3 * 10**9
        collecting.append(gc.isenabled())
        return compile_it(signature)

    monkeypatch.setattr(loading, "time", SimpleNamespace(perf_counter_ns=lambda: now))
    squared.compile = take_three_seconds  # type: ignore[attr-defined]
    try:
        work, waited = working_ns(), seconds_waited()
        assert compile_kernels((squared,)) == 3.0
        assert seconds_waited() - waited == pytest.approx(3.0) and working_ns() == work
        now += 10**9
        assert compile_kernels((squared,)) == 0.0, "it is there"
        assert working_ns() - work == 10**9
        assert squared(3.0) == 9.0 and now == 5 * 10**9, "and it was compiled once"
        assert collecting == [False] and gc.isenabled()
    finally:
        KERNELS.remove(squared)


class _Late(System):
    """Calls a kernel that is not compiled yet."""

    def __init__(self, late: Any) -> None:
        self._late = late

    @at(Stage.FINISH)
    def call(self, state: State, h: float) -> None:
        self._late(h)


def test_the_wait_for_a_kernel_is_no_cost_of_the_system_that_calls_it() -> None:
    @kernel
    def late(x: float) -> float:
        return x + 1.0

    def compile_slowly(missing: Sequence[Any]) -> None:
        time.sleep(0.2)

    world = World(_Late(late))
    world.spawn(Transform(), Velocity(), Mass(1.0))
    try:
        world.synchronise()
        before = world.compile_s
        ask_before_compiling(compile_slowly)
        world.step(0.01)
    finally:
        ask_before_compiling(None)
        KERNELS.remove(late)
    assert world.schedule.timings["_Late"].ms < 100.0
    assert world.compile_s - before >= 0.2
