"""Recorded samples: kept, taken again of the past, and as they are plotted."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from physicslab.diagnostics.quantities import Reading
from physicslab.files.checks import SceneError
from physicslab.history import History
from physicslab.history.replay import Played
from physicslab.state.masses import Diverged
from physicslab.world import World

type Key = tuple[int | None, str]
"""A body, or ``None`` for the world, and the name of a quantity."""
type Numbers = NDArray[np.float64]
"""A float64 array, of samples (n,)."""

CAPACITY = 36_000
"""Moments that are kept: ten minutes at 60 a second. Beyond them every other one of the older half goes."""
_FIRST = 256


class Record:
    """Samples at times that rise. A value that was not measured, or not defined, is NaN.

    Attributes
    ----------
    version : int
        Changes with every change of what is recorded.
    """

    def __init__(self) -> None:
        self._columns: dict[Key | str, Numbers] = {"time": np.zeros(_FIRST), "step": np.zeros(_FIRST)}
        self._count = 0
        self.version = 0

    def __len__(self) -> int:
        return self._count

    @property
    def times(self) -> Numbers:
        """The moments (n,) [s]."""
        return self._columns["time"][: self._count]

    @property
    def steps(self) -> Numbers:
        """How many steps of the history lay before each moment (n,)."""
        return self._columns["step"][: self._count]

    def values(self, key: Key) -> Numbers:
        """Return a quantity at each moment (n,), in its unit."""
        column = self._columns.get(key)
        return np.full(self._count, np.nan) if column is None else column[: self._count]

    def add(self, time: float, step: int, values: Mapping[Key, float]) -> None:
        """Take in a moment; what was recorded of this time and of later ones is forgotten.

        A value that is not finite is recorded as not defined.
        """
        self._count = int(np.searchsorted(self.times, time))
        if self._count == CAPACITY:
            self._thin()
        if self._count == len(self._columns["time"]):
            room = np.full(self._count, np.nan)
            self._columns = {key: np.concatenate((old, room)) for key, old in self._columns.items()}
        row = self._count
        for column in self._columns.values():
            column[row] = np.nan
        self._columns["time"][row], self._columns["step"][row] = time, step
        for key, value in values.items():
            if np.isfinite(value):
                self._column(key)[row] = value
        self._count += 1
        self.version += 1

    @property
    def keys(self) -> tuple[Key, ...]:
        """All that was measured at some moment."""
        return tuple(key for key in self._columns if not isinstance(key, str))

    def after(self, past: Record) -> Record:
        """Return what was measured in the ``past``, and behind it what was measured here since then."""
        first = int(np.searchsorted(self.times, past.times[-1], "right")) if len(past) else 0
        made = Record()
        made._count, made.version = len(past) + self._count - first, self.version + past.version
        for key in {**past._columns, **self._columns}:
            parts = [
                source._columns[key][begin : source._count] if key in source._columns
                else np.full(source._count - begin, np.nan)
                for source, begin in ((past, 0), (self, first))
            ]  # fmt: skip
            made._columns[key] = np.concatenate((*parts, np.full(_FIRST, np.nan)))
        while made._count >= CAPACITY:
            made._thin()
        return made

    def _column(self, key: Key) -> Numbers:
        if key not in self._columns:
            self._columns[key] = np.full(len(self._columns["time"]), np.nan)
        return self._columns[key]

    def _thin(self) -> None:
        """Leave out every other moment of the older half."""
        half = self._count // 2
        kept = np.concatenate((np.arange(0, half, 2), np.arange(half, self._count)))
        for column in self._columns.values():
            column[: len(kept)] = column[kept]
        self._count = len(kept)

    def nearest(self, time: float) -> int | None:
        """Return the row of the moment nearest to a time; ``None`` where nothing is recorded."""
        if not self._count:
            return None
        after = min(int(np.searchsorted(self.times, time)), self._count - 1)
        before = max(after - 1, 0)
        return before if time - self.times[before] < self.times[after] - time else after

    def renamed(self, bodies: Mapping[int, int]) -> Record:
        """Return it with other numbers for bodies; what is of a body without one is left out."""
        made = Record()
        made._count, made.version = self._count, self.version
        made._columns = {
            (key if isinstance(key, str) or key[0] is None else (bodies[key[0]], key[1])): column
            for key, column in self._columns.items()
            if isinstance(key, str) or key[0] is None or key[0] in bodies
        }
        return made


# ---- what is plotted of them -------------------------------------------------------------------------------


_ZERO_RANGE_SHARE = 1e-9
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
        Width of the plot [px].
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
        Ranges of ``x`` and ``y`` in the plot.
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
    values : sequence of float64 arrays (n,)
        NaN among them does not count.
    room : float
        Free room at each side, as a share of their range.
    """
    ends = [(np.nanmin(one), np.nanmax(one)) for one in values if not np.isnan(one).all()]
    if not ends:
        return 0.0, 1.0
    low, high = float(min(end[0] for end in ends)), float(max(end[1] for end in ends))
    largest = max(abs(low), abs(high))
    if high - low <= max(_ZERO_RANGE_SHARE * largest, none):
        spread = 0.1 * largest if largest > none else 1.0
        return low - spread, high + spread
    return low - room * (high - low), high + room * (high - low)


def unbroken(y: Numbers) -> list[slice]:
    """Return the parts of a line (n,) in which no value is NaN.

    >>> unbroken(np.array([np.nan, 1.0, 2.0, np.nan, 3.0]))
    [slice(1, 3, None), slice(4, 5, None)]
    """
    there = np.concatenate(([False], ~np.isnan(y), [False]))
    ends = np.flatnonzero(there[1:] != there[:-1]).tolist()
    return [slice(begin, end) for begin, end in zip(ends[::2], ends[1::2], strict=True)]


def slope_between(x: Numbers, y: Numbers, a: int, b: int) -> float:
    """Return the slope between the points a and b of a line ``x``, ``y`` (n,); NaN where it has none."""
    run = float(x[b] - x[a])
    return float(y[b] - y[a]) / run if run != 0.0 else float("nan")


def area_between(x: Numbers, y: Numbers, a: int, b: int) -> float:
    """Return the area under a line ``x``, ``y`` (n,) from point a to b; NaN where a value is missing.

    It is the sum of trapezia between the points, negative below zero; from right to left the sign is changed.
    """
    low, high = min(a, b), max(a, b)
    area = float(np.trapezoid(y[low : high + 1], x[low : high + 1]))
    return area if a <= b else -area


# ---- samples from before a graph was made ------------------------------------------------------------------


_SLICE = 0.004
"""Time [s] that steps may take in a frame."""


class PastSamples:
    """Samples of all steps of a history up to now, taken while frames go by.

    Parameters
    ----------
    history : History
        Its world stays as it is; another one goes through the steps.
    keys : tuple of Key
        Quantities that are measured.

    Attributes
    ----------
    record : Record
        A moment for each step, as far as they were made.
    world : World, optional
        As it was after the last step that was made again, with the log of its impacts.
    share : float
        How much of the way is done, from 0 to 1.
    """

    def __init__(self, history: History, keys: tuple[Key, ...]) -> None:
        self.keys, self.record, self.share = keys, Record(), 0.0
        self.world: World | None = None
        self._branches = history.branches
        self._steps = max(history.steps_range[1], 1)
        self._stride = -(-self._steps // CAPACITY)
        self._again: Iterator[tuple[World, Played]] = history.again()

    def is_of(self, history: History) -> bool:
        """Whether the history goes on from the steps that are made again, and has left none of them."""
        return history.branches == self._branches

    def go_on(self) -> bool:
        """Make some steps; return whether all are made, or one comes out otherwise than it did."""
        until = time.perf_counter() + _SLICE
        try:
            for world, played in self._again:
                self.world = world
                if played.columns:
                    return True
                if self.keys and played.step % self._stride == 0:
                    reading = Reading(world)
                    values = {key: reading.value(key[1], key[0]) for key in self.keys}
                    if not all(map(math.isnan, values.values())):  # no body yet, no moments
                        self.record.add(played.time, played.step, values)
                self.share = played.step / self._steps
                if time.perf_counter() >= until:
                    return False
        except (Diverged, SceneError):
            pass  # only the samples until then exist
        return True
