"""Lines as they are plotted: no more points than can be seen, slopes and areas between two moments."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

__all__ = ["area_between", "line_to_show", "path_to_show", "range_to_show", "slope_between", "unbroken"]

type Numbers = NDArray[np.float64]
_ROUNDING = 1e-9
"""Share of the largest value below which a range is rounding."""
_NEEDED = 4
"""Points that a pixel's width can need: the first, the lowest, the highest and the last of those in it."""


def line_to_show(x: Numbers, y: Numbers, low: float, high: float, width: int) -> tuple[Numbers, Numbers]:
    """Return the points of a line that can be seen in a plot.

    In each pixel the first, the lowest, the highest and the last point stay, so that the line covers the same
    pixels as that of all points. The line is broken at NaN.

    Parameters
    ----------
    x, y : float64 arrays (n,)
        The line; ``x`` rises.
    low, high : float
        The range of ``x`` that the plot shows; the nearest point outside it stays at each side.
    width : int
        Of the plot [px].
    """
    begin = max(int(np.searchsorted(x, low)) - 1, 0)
    end = min(int(np.searchsorted(x, high, side="right")) + 1, len(x))
    x, y = x[begin:end], y[begin:end]
    if len(x) <= _NEEDED * width or not high > low:
        return x.copy(), y.copy()
    pixel = np.floor((x - low) * (width / (high - low)))
    missing = np.isnan(y)
    begins = np.ones(len(x), np.bool_)  # where a pixel begins, or a gap, or the line after one
    begins[1:] = (pixel[1:] != pixel[:-1]) | (missing[1:] != missing[:-1])
    first = np.flatnonzero(begins)
    kept = begins.copy()
    kept[np.append(first[1:], len(x)) - 1] = True
    group = np.cumsum(begins) - 1
    for extreme in (np.minimum.reduceat(y, first), np.maximum.reduceat(y, first)):
        found = np.flatnonzero(y == extreme[group])
        pixels = group[found]
        kept[found[np.append(True, pixels[1:] != pixels[:-1])[: len(found)]]] = True  # the first of equals
    return x[kept], y[kept]


def path_to_show(
    x: Numbers, y: Numbers, low: tuple[float, float], high: tuple[float, float], size: tuple[int, int]
) -> tuple[Numbers, Numbers]:
    """Return the points of a path that can be seen.

    The first and the last of those that follow each other within one pixel stay.

    Parameters
    ----------
    x, y : float64 arrays (n,)
        The path, in the order in which it was gone along.
    low, high : tuple of two floats
        What the plot shows of ``x`` and ``y``.
    size : tuple of two ints
        Width and height of the plot [px].
    """
    if len(x) <= _NEEDED * size[0] or not (high[0] > low[0] and high[1] > low[1]):
        return x.copy(), y.copy()
    across = np.floor((x - low[0]) * (size[0] / (high[0] - low[0])))
    up = np.floor((y - low[1]) * (size[1] / (high[1] - low[1])))
    differs = (across[1:] != across[:-1]) | (up[1:] != up[:-1])  # NaN differs from everything
    kept = np.ones(len(x), np.bool_)
    kept[1:-1] = differs[:-1] | differs[1:]
    return x[kept], y[kept]


def range_to_show(values: Sequence[Numbers], room: float = 0.06, none: float = 0.0) -> tuple[float, float]:
    """Return what an axis is to show such that all values can be seen, with room around them.

    Values that vary by no more than rounding are shown as constant, and as 0 where they are no more than
    ``none``.

    Parameters
    ----------
    values : sequence of float64 arrays
        NaN among them does not count.
    room : float
        What is left at each side, as a share of their range.
    """
    ends = [(np.nanmin(one), np.nanmax(one)) for one in values if not np.isnan(one).all()]
    if not ends:
        return 0.0, 1.0
    low, high = float(min(end[0] for end in ends)), float(max(end[1] for end in ends))
    largest = max(abs(low), abs(high))
    if high - low <= max(_ROUNDING * largest, none):
        spread = 0.1 * largest if largest > none else 1.0
        return low - spread, high + spread
    return low - room * (high - low), high + room * (high - low)


def unbroken(y: Numbers) -> list[slice]:
    """Return the parts of a line in which no value is NaN.

    >>> unbroken(np.array([np.nan, 1.0, 2.0, np.nan, 3.0]))
    [slice(1, 3, None), slice(4, 5, None)]
    """
    there = np.concatenate(([False], ~np.isnan(y), [False]))
    ends = np.flatnonzero(there[1:] != there[:-1]).tolist()
    return [slice(begin, end) for begin, end in zip(ends[::2], ends[1::2], strict=True)]


def slope_between(x: Numbers, y: Numbers, a: int, b: int) -> float:
    """Return the slope of the straight line between two points of a line; NaN where it has none."""
    run = float(x[b] - x[a])
    return float(y[b] - y[a]) / run if run != 0.0 else float("nan")


def area_between(x: Numbers, y: Numbers, a: int, b: int) -> float:
    """Return the area under a line from one of its points to another; NaN where a value is missing.

    It is the sum of trapezia between the points, negative below zero; from right to left the sign is changed.
    """
    low, high = min(a, b), max(a, b)
    area = float(np.trapezoid(y[low : high + 1], x[low : high + 1]))
    return area if a <= b else -area
