"""Pictures of at most 255 colours."""

import numpy as np
from numpy.typing import NDArray

type Colours = NDArray[np.uint8]
"""A uint8 array (n, 3 or 4): red, green, blue, and what is not used."""

_BITS = 6
"""Bits of a channel by which colours are told apart."""
_RARE = 0.65
"""Power of a colour's count by which it is weighed: a large sky leaves colours to small, lit bodies."""


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
