"""The code that is written for kernels: what they compute is what Python computes, and it is short."""

from typing import Any

import numpy as np
import pytest
from compiled import compiled
from numba.core.codegen import CPUCodeLibrary

from physicslab.kernels import Flags, Numbers, Rows, Vectors, allocating, inlined
from physicslab.kernels.interpreter import is_forced

pytestmark = pytest.mark.skipif(is_forced(), reason="nothing is compiled")


def _as_python_and_compiled(inner: Any, *given: Any) -> None:
    """Compare what a function returns, and what it changes."""
    mine, theirs = ([np.copy(each) if isinstance(each, np.ndarray) else each for each in given] for _ in "ab")
    assert compiled(inner)(*mine) == inner.py_func(*theirs)
    for changed, expected in zip(mine, theirs, strict=True):
        np.testing.assert_array_equal(changed, expected)


@inlined
def _items(numbers: Numbers, vectors: Vectors, rows: Rows, flags: Flags, i: int) -> float:
    found = numbers[i] + vectors[i, 1] * vectors[-1, i - 1] + numbers[-2] + rows[np.uint64(1)]
    flags[i] = not flags[i]
    vectors[i, -1] += 2.0
    found += len(vectors) + vectors.shape[1] + vectors.size
    return float(found + (10.0 if flags[i] and flags[0] else 20.0))


@pytest.mark.parametrize("i", [0, 2, -1])
def test_items_are_those_of_python(i: int) -> None:
    numbers, vectors = np.arange(4.0) ** 2, np.arange(12.0).reshape(4, 3)
    flags = np.array([True, False, True, True])
    _as_python_and_compiled(_items, numbers, vectors, np.arange(3) * 5, flags, i)


@inlined
def _exchanged(one: Numbers, two: Numbers, times: int) -> float:
    """Exchange variables in a loop: each has a value of its own on each way to where it is used."""
    last, total = one, 0.0
    for k in range(times):
        first = one
        if k % 2:
            last = first
        one, two = two, one
        total = 2.0 * total + one[k] - last[0] + first[-1]
    return float(total + one[0] + 3.0 * two[0])


@pytest.mark.parametrize("times", [0, 1, 2, 3])
def test_variables_keep_their_values_in_loops(times: int) -> None:
    _as_python_and_compiled(_exchanged, np.arange(1.0, 5.0), np.arange(7.0, 11.0), times)


@allocating
def _part(vectors: Vectors, numbers: Numbers) -> Numbers:
    made: Numbers = vectors[1] + numbers[1:4] + numbers.reshape(2, 3)[:, 0].sum()
    return made


def test_parts_of_arrays_that_were_passed_are_those_of_python() -> None:
    vectors, numbers = np.arange(9.0).reshape(3, 3), np.arange(6.0) ** 2
    expected = vectors[1] + numbers[1:4] + numbers.reshape(2, 3)[:, 0].sum()
    np.testing.assert_array_equal(compiled(_part)(vectors, numbers), expected)


def test_an_item_takes_few_instructions(monkeypatch: pytest.MonkeyPatch) -> None:
    written: list[str] = []
    add: Any = CPUCodeLibrary.add_ir_module

    def note(library: Any, module: Any) -> None:
        written.append(str(module))
        add(library, module)

    @inlined
    def moved(vectors: Vectors, others: Vectors, i: int) -> None:
        vectors[i, 0] = others[i, 1]

    monkeypatch.setattr(CPUCodeLibrary, "add_ir_module", note)
    compiled(moved)(np.zeros((3, 2)), np.ones((3, 2)), 1)
    [code] = [each for each in written if "moved" in each.partition("\n")[0]]
    [definition] = [line for line in code.splitlines() if line.startswith("define")]
    assert definition.count("%") <= 2 + 3 + 3 + 1  # numba's own: 2 + 9 + 9 + 1
    assert sum(" = " in line or " store " in line for line in code.splitlines()) <= 20  # 108
