"""The compression of GIF files (LZW with codes of growing length)."""

from typing import Annotated

import numpy as np
from numba import int16, uint8
from numpy.typing import NDArray

from physicslab.kernels import inlined, kernel

Bytes = Annotated[NDArray[np.uint8], uint8[::1]]
"""A uint8 array (n,)."""
Children = Annotated[NDArray[np.int16], int16[:, ::1]]
"""An int16 array (CODES, 256): for each code and the number after it, the code of both, 0 for none."""

CODES = 4096
"""How many codes there are: they have 12 bits at most."""


@inlined
def _whole(number: int) -> int:
    """Return a number of few bits as one of 64: shifts lose none of it then."""
    return np.int64(number)  # type: ignore[return-value]


@kernel
def pack_lzw(numbers: Bytes, depth: int, children: Children, packed: Bytes) -> int:
    """Compress numbers, and return how many bytes that takes.

    Parameters
    ----------
    numbers : uint8 array (n,)
        Each less than 2 ** depth; one at least.
    depth : int
        From 2 to 8.
    children : int16 array (CODES, 256)
        Room to work in, of any contents.
    packed : uint8 array (m,)
        Where the bytes go; 2 n + 16 are enough.
    """
    clear = 1 << depth
    free, width = clear + 2, depth + 1
    children[:clear] = 0
    buffer, held, size = clear, width, 0  # bits that are not written yet, and how many
    prefix = _whole(numbers[0])
    for k in range(1, len(numbers)):
        number = _whole(numbers[k])
        longer = _whole(children[prefix, number])
        if longer:
            prefix = longer
            continue
        buffer |= prefix << held
        held += width
        if free < CODES:
            children[prefix, number] = free
            children[free] = 0
            if free == 1 << width:
                width += 1
            free += 1
        else:
            buffer |= clear << held
            held += width
            children[:clear] = 0
            free, width = clear + 2, depth + 1
        while held >= 8:
            packed[size] = buffer & 255
            buffer, held, size = buffer >> 8, held - 8, size + 1
        prefix = number
    buffer |= prefix << held
    held += width
    if free == 1 << width and width < 12:  # a reader adds a code after each that it reads
        width += 1
    buffer |= (clear + 1) << held
    held += width
    while held > 0:
        packed[size] = buffer & 255
        buffer, held, size = buffer >> 8, held - 8, size + 1
    return size
