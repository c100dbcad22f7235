"""Films as GIF files: pictures of 255 colours each, of which only what has changed is kept."""

import struct
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from physicslab.export.palette import find_palette
from physicslab.kernels import load
from physicslab.kernels.lzw import CODES, pack_lzw

LARGEST_RATE = 50.0
"""Pictures a second: delays are whole hundredths of a second, and players take 1 for 10."""
_SEE_THROUGH = 0
"""The colour of pixels that stay as they are."""
_BLOCK = 255
"""Bytes in a block of a picture's data."""


class GifWriter:
    """Writes one picture after the other; the film goes round for ever.

    Parameters
    ----------
    file : binary stream
        Where the film goes.
    size : tuple of two ints
        Width and height of all pictures [px], up to 65,535.
    rate : float
        Pictures a second, at most ``LARGEST_RATE``.
    """

    def __init__(self, file: BinaryIO, size: tuple[int, int], rate: float) -> None:
        load(pack_lzw)  # those of a small scene are interpreted: of this, that takes seconds
        self._file, self._rate = file, rate
        self._count = 0
        self._shown: NDArray[np.uint8] | None = None
        self._children = np.empty((CODES, 256), np.int16)
        file.write(b"GIF89a" + struct.pack("<HHBBB", *size, 0x70, 0, 0))
        file.write(b"\x21\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00")

    def write(self, picture: NDArray[np.uint8]) -> None:
        """Add a picture: uint8 (height, width, 4), red, green, blue and one that is not used.

        Raises
        ------
        OSError
            If it cannot be written.
        """
        left, top, part, changed = self._what_changed(picture)
        height, width = changed.shape
        numbers = np.full(height * width, _SEE_THROUGH, np.uint8)
        palette = np.zeros((0, 3), np.uint8)
        if changed.any():
            palette, chosen = find_palette(part[changed], 255)
            numbers[changed.reshape(-1)] = chosen + 1
        depth = max(2, len(palette).bit_length())
        table = np.zeros((1 << depth, 3), np.uint8)
        table[1 : len(palette) + 1] = palette
        delay = self._moment(self._count + 1) - self._moment(self._count)
        self._file.write(b"\x21\xf9\x04" + struct.pack("<BHB", 0x05, delay, _SEE_THROUGH) + b"\x00")
        self._file.write(b"\x2c" + struct.pack("<HHHHB", left, top, width, height, 0x80 | (depth - 1)))
        self._file.write(table.tobytes() + bytes((depth,)) + self._compressed(numbers, depth))
        self._count, self._shown = self._count + 1, picture.copy()

    def close(self) -> None:
        """End the film."""
        self._file.write(b"\x3b")

    def _moment(self, count: int) -> int:
        """Return when a picture is shown [1/100 s]."""
        return round(100.0 * count / self._rate)

    def _what_changed(
        self, picture: NDArray[np.uint8]
    ) -> tuple[int, int, NDArray[np.uint8], NDArray[np.bool_]]:
        """Return left, top and pixels of the part in which something changed, and which pixels did."""
        if self._shown is None:
            return 0, 0, picture, np.ones(picture.shape[:2], np.bool_)
        changed = _whole(picture) != _whole(self._shown)
        rows, columns = np.flatnonzero(changed.any(axis=1)), np.flatnonzero(changed.any(axis=0))
        if not len(rows):  # a picture must have a pixel
            return 0, 0, picture[:1, :1], np.zeros((1, 1), np.bool_)
        down, across = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
        return int(columns[0]), int(rows[0]), picture[down, across], changed[down, across]

    def _compressed(self, numbers: NDArray[np.uint8], depth: int) -> bytes:
        """Return the data of a picture, in blocks."""
        packed = np.empty(2 * len(numbers) + 16, np.uint8)
        data = packed[: pack_lzw(numbers, depth, self._children, packed)].tobytes()
        blocks = (data[k : k + _BLOCK] for k in range(0, len(data), _BLOCK))
        return b"".join(bytes((len(block),)) + block for block in blocks) + b"\x00"


def _whole(picture: NDArray[np.uint8]) -> NDArray[np.uint32]:
    """Return each pixel as one number."""
    return np.ascontiguousarray(picture).view(np.uint32)[:, :, 0]
