"""Eight numbers as one: every operation gives in each slot what it gives for plain numbers."""

import numba
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from physicslab.kernels.directions import face
from physicslab.kernels.float64x8 import (
    choose,
    greater,
    lesser,
    mask_bits,
    put,
    put_numbers,
    put_vectors,
    root,
    size_of,
    take,
    take_numbers,
    take_vectors,
)
from physicslab.kernels.wide_layout import WIDE

type Numbers = NDArray[np.float64]


@numba.njit(error_model="numpy")
def arithmetic(x: Numbers, y: Numbers, scale: float, out: Numbers) -> None:
    a, b = take(x, 0), take(y, 0)
    put(out, 0, a + b)
    put(out, 8, a - scale)
    put(out, 16, scale * a * b)
    put(out, 24, a / b)
    put(out, 32, -a)
    put(out, 40, 1.0 / size_of(b) + root(size_of(a)))


@numba.njit(error_model="numpy")
def comparisons(x: Numbers, y: Numbers, limit: float, out: Numbers) -> int:
    a, b = take(x, 0), take(y, 0)
    inside = (a < b) & (a > limit)
    put(out, 0, lesser(a, b))
    put(out, 8, greater(a, limit))
    put(out, 16, choose(inside | (b > 1.0), a, limit))
    return mask_bits(inside)


@numba.njit(error_model="numpy")
def plain(x: float, y: float) -> tuple[float, float, float]:
    return lesser(x, y), greater(x, y), choose(x < y, x, 0.0)


@numba.njit(error_model="numpy")
def moved(vectors: Numbers, numbers: Numbers, rows: NDArray[np.int64], first: int) -> None:
    x, y = take_vectors(vectors, rows, first)
    n = take_numbers(numbers, rows, first)
    put_vectors(vectors, rows, first, y, x + n)
    put_numbers(numbers, rows, first, 2.0 * n)


@numba.njit(error_model="numpy")
def faced(angle: Numbers, facing: Numbers) -> None:
    face(angle, facing)


finite = st.floats(-1e100, 1e100).filter(lambda x: x == 0.0 or abs(x) > 1e-100)
eight = st.lists(finite, min_size=WIDE, max_size=WIDE).map(np.array)


@settings(max_examples=200)
@given(eight, eight.filter(lambda y: bool(np.all(y != 0.0))), finite)
def test_arithmetic_is_that_of_each_slot(x: Numbers, y: Numbers, scale: float) -> None:
    out = np.zeros(48)
    arithmetic(x, y, scale, out)
    with np.errstate(over="ignore"):
        expected = [x + y, x - scale, scale * x * y, x / y, -x, 1.0 / abs(y) + np.sqrt(abs(x))]
    for found, wanted in zip(out.reshape(6, WIDE), expected, strict=True):
        np.testing.assert_allclose(found, wanted, rtol=5e-16)


@settings(max_examples=200)
@given(eight, eight, finite)
def test_comparisons_are_those_of_each_slot(x: Numbers, y: Numbers, limit: float) -> None:
    out = np.zeros(24)
    inside = (x < y) & (x > limit)
    assert comparisons(x, y, limit, out) == sum(int(yes) << slot for slot, yes in enumerate(inside))
    expected = [np.minimum(x, y), np.maximum(x, limit), np.where(inside | (y > 1.0), x, limit)]
    assert np.array_equal(out.reshape(3, WIDE), expected)


def test_what_is_not_a_number_stays_so() -> None:
    out, x, y = np.zeros(48), np.full(WIDE, np.nan), np.ones(WIDE)
    arithmetic(x, y, 1.0, out)
    assert np.isnan(out).all()


@given(finite, finite)
def test_choices_are_the_same_of_plain_numbers(x: float, y: float) -> None:
    assert plain(x, y) == (min(x, y), max(x, y), x if x < y else 0.0)


@given(st.permutations(range(20)), st.integers(0, 12))
def test_rows_are_gathered_and_given_back(order: list[int], first: int) -> None:
    vectors, numbers = np.arange(40.0).reshape(20, 2), np.arange(100.0, 120.0)
    rows = np.array(order)[first : first + WIDE]
    expected, doubled = vectors.copy(), numbers.copy()
    expected[rows, 0], expected[rows, 1] = vectors[rows, 1], vectors[rows, 0] + numbers[rows]
    doubled[rows] *= 2.0
    moved(vectors, numbers, np.array(order), first)
    assert np.array_equal(vectors, expected) and np.array_equal(numbers, doubled)


@settings(max_examples=200)
@given(st.lists(st.floats(-1e6, 1e6), min_size=2 * WIDE, max_size=2 * WIDE).map(np.array))
def test_directions_are_the_cosines_and_sines_of_angles(angle: Numbers) -> None:
    facing = np.zeros((2 * WIDE, 2))
    faced(angle, facing)
    np.testing.assert_allclose(facing, np.stack((np.cos(angle), np.sin(angle)), 1), rtol=0.0, atol=2.3e-16)


def test_directions_at_and_between_quarters_beyond_all_turns_and_of_what_is_no_number() -> None:
    angle, facing = np.linspace(-8.0 * np.pi, 7.75 * np.pi, 64), np.zeros((64, 2))
    faced(angle, facing)
    np.testing.assert_allclose(facing, np.stack((np.cos(angle), np.sin(angle)), 1), rtol=0.0, atol=2.3e-16)
    huge = np.array((1e12, -1e15, 1e17, -1e300, np.inf, np.nan, 0.0, -0.0))
    faced(huge, facing[:WIDE])
    assert (np.abs(facing[:4]) <= 1.0).all() and np.isnan(facing[4:6]).all()
    assert facing[6:8].tolist() == [[1.0, 0.0], [1.0, 0.0]]
