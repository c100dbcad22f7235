"""Films as GIF files: pictures of 255 colours each, of which only what has changed is kept."""

import struct
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from physicslab.kernels import load
from physicslab.kernels.lzw import CODES, pack_lzw

SMALLEST_RATE, LARGEST_RATE = 0.002, 50.0
"""Pictures a second: delays are whole hundredths, less than 65,536 of them, and players take 1 for 10."""
_SEE_THROUGH = 0
"""The colour of pixels that stay as they are."""
_BLOCK = 255
"""Bytes in a block of a picture's data."""

type Colours = NDArray[np.uint8]
"""A uint8 array (n, 3 or 4): red, green, blue, and what is not used."""

_BITS = 6
"""Bits of a channel by which colours are told apart."""
_RARE = 0.65
"""Power of a colour's count by which it is weighed: a large sky leaves colours to small, lit bodies."""


class GifWriter:
    """Writes one picture after the other; the film goes round for ever.

    Parameters
    ----------
    file : binary stream
        Where the film goes.
    size : tuple of two ints
        Width and height of all pictures [px], up to 65,535.
    rate : float
        Pictures a second, from ``SMALLEST_RATE`` to ``LARGEST_RATE``.
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


# ---- the colours of a picture ------------------------------------------------------------------------------


def find_palette(pixels: Colours, limit: int) -> tuple[Colours, NDArray[np.uint8]]:
    """Return at most ``limit`` colours that are near to those of all pixels, and which each pixel gets.

    Colours that differ by less than 4 of 255 in each channel may become one, their mean. Where more are left
    than there may be, boxes of them are divided where they spread most (median cut, by variance).

    Parameters
    ----------
    pixels : uint8 array (n, 3 or 4)
        One at least.
    limit : int
        From 1 to 256.

    Returns
    -------
    palette : uint8 array (k, 3)
        The colours.
    chosen : uint8 array (n,)
        The number of each pixel's colour.
    """
    shift = 8 - _BITS
    parts = (pixels >> shift).astype(np.int32)
    cells = (parts[:, 0] << 2 * _BITS) | (parts[:, 1] << _BITS) | parts[:, 2]
    counts = np.bincount(cells, minlength=1 << 3 * _BITS)
    used = np.flatnonzero(counts)
    weights = counts[used].astype(np.float64)
    sums = [np.bincount(cells, pixels[:, channel], len(counts))[used] for channel in range(3)]
    means = np.stack(sums, axis=1) / weights[:, None]
    boxes = _divided(means, weights**_RARE, limit)
    palette = np.empty((len(boxes), 3))
    number = np.zeros(len(counts), np.uint8)
    for k, box in enumerate(boxes):
        palette[k] = np.average(means[box], axis=0, weights=weights[box])
        number[used[box]] = k
    return np.rint(palette).astype(np.uint8), number[cells]


def _divided(means: NDArray[np.float64], weights: NDArray[np.float64], limit: int) -> list[NDArray[np.int64]]:
    """Return the colours of each box: every colour in one, where they are few enough."""
    count = len(means)
    if count <= limit:
        return [np.array([k]) for k in range(count)]
    boxes = [np.arange(count)]
    spreads = [_spread(means, weights)]
    while len(boxes) < limit:
        k = max(range(len(boxes)), key=lambda n: spreads[n][0])
        box, (spread, axis, middle) = boxes[k], spreads[k]
        if spread <= 0.0:
            break
        above = means[box, axis] > middle
        boxes[k : k + 1] = parts = [box[~above], box[above]]
        spreads[k : k + 1] = [_spread(means[part], weights[part]) for part in parts]
    return boxes


def _spread(means: NDArray[np.float64], weights: NDArray[np.float64]) -> tuple[float, int, float]:
    """Return by how much colours differ, summed over pixels; along which axis most, and the middle there."""
    if len(means) == 1:
        return 0.0, 0, 0.0
    middle = weights @ means / weights.sum()
    squares = weights @ (means - middle) ** 2
    axis = int(np.argmax(squares))
    return float(squares.sum()), axis, float(middle[axis])
