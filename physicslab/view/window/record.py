"""Recorded samples: a table with a row for each moment and a column for each quantity."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

__all__ = ["Key", "Record"]

type Key = tuple[int | None, str]
"""A body, or ``None`` for the world, and the name of a quantity."""
type Numbers = NDArray[np.float64]

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
