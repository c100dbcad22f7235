"""Float32 columns as text: differences of differences, in as few bytes as each needs, in base 85.

Smooth motion goes on about as it went: differences of a column, and differences of those, are small;
at rest they are 0. They are differences of the bit patterns, in an order in which neighbours are numbers one
unit in the last place apart: unpacking gives every bit back.
"""

import base64

import numpy as np
from numpy.typing import NDArray

_ORDERS = range(5)
"""How often differences may be taken; for each column the number is chosen that leaves the fewest bytes."""
_MAX_BYTES = 5
"""Groups of seven bits that hold 32."""
_SAFE = str.maketrans("<,", ",<")
"""One of the digits of base 85 (RFC 1924) might begin a tag in HTML: a comma stands in its place."""


def pack(values: NDArray[np.float32]) -> str:
    """Return a float32 array (rows, columns) in base 85, column after column: 5 letters hold 4 bytes.

    A column begins with a byte: how often differences were taken. A byte holds seven bits of a number, the
    lowest first, and the eighth says that more follow; the sign is the number's lowest bit.
    ``physicslab/export/player/run.js`` unpacks it.

    Parameters
    ----------
    values : float32 array (rows, columns)
        A row an instant, a column a quantity.
    """
    columns = b"".join(map(_packed, np.ascontiguousarray(values.T, np.float32)))
    return base64.b85encode(columns).decode("ascii").translate(_SAFE)


def _packed(column: NDArray[np.float32]) -> bytes:
    bits = column.view(np.int32)
    rest = bits ^ ((bits >> 31) & 0x7FFFFFFF)
    best = b""
    for order in _ORDERS:
        packed = bytes([order]) + _grouped(((rest << 1) ^ (rest >> 31)).view(np.uint32))
        best = packed if not best or len(packed) < len(best) else best
        rest = np.diff(rest, prepend=np.int32(0))
    return best


def _grouped(numbers: NDArray[np.uint32]) -> bytes:
    """Return numbers (n,) in groups of seven bits."""
    groups = np.ones(len(numbers), np.int64)
    for more in range(1, _MAX_BYTES):
        groups += numbers >= np.uint32(1 << (7 * more))
    start = np.cumsum(groups) - groups
    packed = np.empty(int(groups.sum()), np.uint8)
    for group in range(_MAX_BYTES):
        there = groups > group
        seven = (numbers[there] >> np.uint32(7 * group)) & np.uint32(0x7F)
        packed[start[there] + group] = seven | np.where(groups[there] > group + 1, 0x80, 0).astype(np.uint32)
    return packed.tobytes()
