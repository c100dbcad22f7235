"""Equals in plain Python of what only kernels have, for the interpreter to call in its place.

Compiled code rounds every operation by itself and raises nothing: a root of -1 is not a number, a number by
zero is infinite. So do these, in float64, and so gives the interpreter the same bits.
"""

import math
from collections.abc import Callable, Iterator
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

_INT64_MIN = -(2**63)
"""The int64 that stands for a number that no int64 can hold."""


_equivalents: dict[Any, Callable[..., Any]] = {}


def equivalent_for[F: Callable[..., Any]](intrinsic: Any) -> Callable[[F], F]:
    """Let a plain function be called where a kernel that is interpreted calls an intrinsic of numba's."""

    def note(function: F) -> F:
        _equivalents[intrinsic] = function
        return function

    return note


def equivalent_of(intrinsic: Any) -> Callable[..., Any] | None:
    """Return the plain function that is called in place of an intrinsic, if one was given."""
    return _equivalents.get(intrinsic)


# ---- arithmetic --------------------------------------------------------------------------------------------


def _in_float64(name: str) -> Callable[..., Any]:
    """Return a function of ``math`` as compiled code calls it: of what it refuses it gives what C does."""
    exact, odd = getattr(math, name), getattr(np, name, None)

    def call(*numbers: float) -> np.float64:
        try:
            return np.float64(exact(*numbers))
        except (ValueError, OverflowError):
            return np.float64(np.nan if odd is None else odd(*numbers))

    return call


def _whole(function: Callable[[float], int]) -> Callable[[float], int]:
    def call(number: float) -> int:
        try:
            return function(number)
        except (ValueError, OverflowError):
            return _INT64_MIN

    return call


def _equivalent_of_math() -> SimpleNamespace:
    names: dict[str, Any] = {}
    for name, value in vars(math).items():
        if isinstance(value, float):
            names[name] = np.float64(value)
        elif name in ("ceil", "floor", "trunc"):
            names[name] = _whole(value)
        elif callable(value) and not name.startswith("is"):
            names[name] = _in_float64(name)
        else:
            names[name] = value
    return SimpleNamespace(**names)


math_functions = _equivalent_of_math()
"""Stands in for the module ``math``, by whose functions compiled code gives the same bits."""

arithmetic: dict[str, Any] = {"float": np.float64, "int": _whole(int)}
"""Stand in for functions that Python has built in."""


# ---- arrays ------------------------------------------------------------------------------------------------


class Records:
    """An array of records (n,) as kernels see it: fields are attributes, and writing to one writes through.

    It is four times as fast as ``np.recarray``.

    Parameters
    ----------
    array : ndarray (n,)
        An array of a dtype with fields.
    """

    __slots__ = ("_columns", "_kind", "array")

    def __init__(self, array: NDArray[np.void]) -> None:
        self.array = array
        names: tuple[str, ...] = array.dtype.names or ()
        self._columns = tuple(array[name] for name in names)
        self._kind = _record_of(names)

    def __len__(self) -> int:
        return len(self._columns[0])

    def __getitem__(self, row: int) -> Any:
        return self._kind(self._columns, row)

    def __setitem__(self, row: int, record: Any) -> None:
        for column, other in zip(self._columns, record.columns, strict=True):
            column[row] = other[record.row]


@cache
def _record_of(names: tuple[str, ...]) -> type:
    """Return a type whose attributes are the fields of one record."""

    def begin(self: Any, columns: tuple[NDArray[Any], ...], row: int) -> None:
        self.columns, self.row = columns, row

    def words(self: Any) -> str:
        fields = (f"{name}={column[self.row]!r}" for name, column in zip(names, self.columns, strict=True))
        return f"Record({', '.join(fields)})"

    fields = {name: _field(place) for place, name in enumerate(names)}
    return type(
        "Record", (), {"__slots__": ("columns", "row"), "__init__": begin, "__repr__": words, **fields}
    )


def _field(place: int) -> property:
    def read(self: Any) -> Any:
        return self.columns[place][self.row]

    def write(self: Any, value: Any) -> None:
        self.columns[place][self.row] = value

    return property(read, write)


class Memory:
    """Numbers behind a pointer to float64, as a force that is called by its address sees them."""

    __slots__ = ("_pointer",)

    def __init__(self, pointer: Any) -> None:
        self._pointer = pointer

    def __getitem__(self, place: int) -> np.float64:
        return np.float64(self._pointer[place])

    def __setitem__(self, place: int, value: float) -> None:
        self._pointer[place] = value

    def __iter__(self) -> Iterator[float]:
        raise TypeError("nothing says how many numbers there are behind a pointer")
