"""The types that kernels take, as annotations, and the signatures that follow from them."""

from collections.abc import Callable
from typing import Annotated, Any, get_args, get_origin, get_type_hints

import numba
import numpy as np
from numba import boolean, float64, int64, void
from numpy.typing import NDArray

Numbers = Annotated[NDArray[np.float64], float64[::1]]
"""A float64 array (n,)."""
Vectors = Annotated[NDArray[np.float64], float64[:, ::1]]
"""A float64 array (n, k), contiguous: a vector a row."""
Rows = Annotated[NDArray[np.int64], int64[::1]]
"""An int64 array (n,): row numbers, or codes."""
Flags = Annotated[NDArray[np.bool_], boolean[::1]]
"""A bool array (n,)."""
type Plain[Record] = tuple[Any, ...]
"""The fields of a named tuple without their names, nor those of named tuples within it.

Python passes arguments that belong together so, which numba unpacks three times as fast: ``Record(*plain)``.
"""
unsigned: Any = np.uint64
"""Makes an index of which no loop tests whether it counts from the end: that takes as long as some work."""

_make_tuple: Any = numba.types.Tuple
_make_named: Any = numba.types.BaseTuple.from_types


def signature_of(function: Callable[..., Any]) -> Any:
    """Return numba's signature of a function, which its annotations give.

    Raises
    ------
    KeyError
        If an annotation is not the type of anything that a kernel takes or returns.
    """
    hints = get_type_hints(function, include_extras=True)
    returned = _numba_type(hints.pop("return"))
    return returned(*(_numba_type(hint) for hint in hints.values()))


def _numba_type(hint: Any) -> Any:
    """Return numba's type for an annotation: the one that an alias carries, or that of a plain type."""
    if get_origin(hint) is Annotated:
        return hint.__metadata__[0]
    if _is_record(hint):
        return _make_named([_numba_type(part) for part in _parts(hint)], hint)
    if get_origin(hint) is Plain:
        return _plain_type(*get_args(hint))
    if get_origin(hint) is tuple:
        return _make_tuple([_numba_type(part) for part in get_args(hint)])
    return {float: float64, int: int64, bool: boolean, type(None): void}[hint]


def _plain_type(record: Any) -> Any:
    """Return numba's type for a named tuple without names."""
    return _make_tuple(
        [_plain_type(part) if _is_record(part) else _numba_type(part) for part in _parts(record)]
    )


def _is_record(hint: Any) -> bool:
    """Whether an annotation is a named tuple."""
    return isinstance(hint, type) and issubclass(hint, tuple) and hasattr(hint, "_fields")


def _parts(record: Any) -> list[Any]:
    """Return the annotations of a named tuple's fields."""
    return list(get_type_hints(record, include_extras=True).values())
