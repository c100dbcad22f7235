"""The state of motion at one moment, to go back to."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from physicslab.state.remainders import NO_REMAINDERS, Remainders

type _Columns = Sequence[NDArray[np.float64]]
"""Positions (rows, 2) [m], angles (rows,) [rad], velocities (rows, 2) [m/s], angular ones (rows,) [rad/s]."""


class Checkpoint:
    """Positions, angles, velocities and a few counts, as they were before a step.

    It is taken before every step, so it holds no more than what a step may make infinite (7 us for 4,000
    bodies, of a step of some milliseconds). Records of contacts are not copied, which would cost ten times as
    much; going back drops them, and the contacts are found again.

    Attributes
    ----------
    columns : sequence of float64 arrays
        Positions, angles, velocities and angular velocities of then; compiled loops keep them themselves.
    numbers : float64 array (6 rows,)
        All of them, one column after the other.
    counts : tuple of int
        Force evaluations, impacts, and impacts logged until then.
    time : float
        The clock of then [s].
    remainders : Remainders
        Rounding remainders of positions and velocities; replaced by a step, never changed in place.
    """

    def __init__(self) -> None:
        self.columns: _Columns = ()
        self.numbers: NDArray[np.float64] = np.zeros(0)
        self._of: _Columns | None = None
        self._views: list[tuple[memoryview, memoryview]] = []
        self.counts = 0, 0, 0
        self.time = 0.0
        self.remainders: Remainders = NO_REMAINDERS

    def make_room(self, columns: _Columns, counts: tuple[int, int, int]) -> None:
        """Keep the counts, with room for columns like these."""
        if not self.columns or len(self.columns[0]) != len(columns[0]):
            ends = np.cumsum([column.size for column in columns])
            self.numbers = np.zeros(ends[-1])
            parts = np.split(self.numbers, ends[:-1])
            self.columns = tuple(
                part.reshape(column.shape) for part, column in zip(parts, columns, strict=True)
            )
            self._of = None
        if self._of is not columns:
            # Numpy takes twice as long to copy the numbers of a few bodies.
            pairs = zip(self.columns, columns, strict=True)
            self._views = [(memoryview(a.reshape(-1)), memoryview(b.reshape(-1))) for a, b in pairs]
            self._of = columns
        self.counts = counts

    def take(self, columns: _Columns, counts: tuple[int, int, int]) -> None:
        """Keep columns and counts as they are now."""
        self.make_room(columns, counts)
        for kept, column in self._views:
            kept[:] = column

    def restore(self, columns: _Columns) -> None:
        """Write back the columns that were kept; no body may have come or gone since."""
        for kept, column in zip(self.columns, columns, strict=True):
            np.copyto(column, kept)
