"""Eight numbers as one in plain Python: an array (8,) stands in for each vector of ``float64x8``."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.kernels import float64x8
from physicslab.kernels.python_equivalents import equivalent_for
from physicslab.kernels.wide_layout import WIDE

__all__: list[str] = []

type _Lanes = NDArray[np.float64]


@equivalent_for(float64x8.lesser)
def _lesser(x: Any, y: Any) -> Any:
    return _choose(x < y, x, y)


@equivalent_for(float64x8.greater)
def _greater(x: Any, y: Any) -> Any:
    return _choose(x > y, x, y)


@equivalent_for(float64x8.choose)
def _choose(mask: Any, x: Any, y: Any) -> Any:
    if isinstance(mask, np.ndarray):
        return np.where(mask, x, y)
    return x if mask else y


@equivalent_for(float64x8.root)
def _root(x: _Lanes) -> _Lanes:
    roots: _Lanes = np.sqrt(x)
    return roots


@equivalent_for(float64x8.size_of)
def _size_of(x: _Lanes) -> _Lanes:
    return np.abs(x)


@equivalent_for(float64x8.everywhere)
def _everywhere(x: float) -> _Lanes:
    return np.full(WIDE, x)


@equivalent_for(float64x8.sum_of)
def _sum_of(x: _Lanes) -> Any:
    total = x[0]
    for one in x[1:]:
        total = total + one
    return total


@equivalent_for(float64x8.mask_bits)
def _true_lanes(mask: NDArray[np.bool_]) -> int:
    return int(np.packbits(mask, bitorder="little")[0])


@equivalent_for(float64x8.take)
def _take(array: _Lanes, at: int) -> _Lanes:
    return array[at : at + WIDE].copy()


@equivalent_for(float64x8.put)
def _put(array: _Lanes, at: int, value: Any) -> None:
    array[at : at + WIDE] = value


@equivalent_for(float64x8.fetch)
def _fetch(array: _Lanes, at: int) -> None:
    """Nothing: it changes no number."""


@equivalent_for(float64x8.take_numbers)
def _take_numbers(numbers: _Lanes, rows: NDArray[np.int64], first: int) -> _Lanes:
    return numbers[rows[first : first + WIDE]]


@equivalent_for(float64x8.put_numbers)
def _put_numbers(numbers: _Lanes, rows: NDArray[np.int64], first: int, value: _Lanes) -> None:
    numbers[rows[first : first + WIDE]] = value  # of slots with one row the last counts, as in compiled code


@equivalent_for(float64x8.take_vectors)
def _take_vectors(vectors: _Lanes, rows: NDArray[np.int64], first: int) -> tuple[_Lanes, _Lanes]:
    taken = vectors[rows[first : first + WIDE]]
    return taken[:, 0], taken[:, 1]


@equivalent_for(float64x8.put_vectors)
def _put_vectors(vectors: _Lanes, rows: NDArray[np.int64], first: int, x: _Lanes, y: _Lanes) -> None:
    eight = rows[first : first + WIDE]
    vectors[eight, 0], vectors[eight, 1] = x, y


@equivalent_for(float64x8.put_pairs)
def _put_pairs(vectors: _Lanes, first: int, x: _Lanes, y: _Lanes) -> None:
    vectors[first : first + WIDE, 0], vectors[first : first + WIDE, 1] = x, y
