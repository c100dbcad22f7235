"""Samples of the motion of a world, which steppers take while they advance it."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform, Velocity
from physicslab.state.entities import Entities

FIELDS = 6
"""Numbers of a body at an instant: x, y, angle and their rates."""
_LATE = 1e-6
"""Share of a step by which the end of one may be late: the clock is a sum of rounded steps."""
_LONGER = 2e-3
"""Share of a step by which the last of a run may be longer."""


class Samples:
    """The motion of what moves, at the start and after every ``stride`` steps.

    A world to which they are given as :attr:`State.samples` fills them in the steps that it makes. Steps that
    are undone and made again replace their samples.

    Parameters
    ----------
    state : Entities
        The entities and components of the world, at the start.
    time, dt : float
        Its clock, and the length of its steps [s].
    stride : int
        Steps between two samples.
    steps : int
        Steps to come: so many samples there is room for.

    Attributes
    ----------
    rows : int64 array (moving,)
        Rows of the world that they are taken from.
    times : float64 array (room,)
        The clock [s].
    motion : float64 array (room, moving, 6)
        x and y [m], the angle [rad], and their rates; NaN where none was taken.
    count : int
        How many were taken.
    dt : float
        The length of a step [s].
    """

    def __init__(self, state: Entities, time: float, dt: float, stride: int, steps: int) -> None:
        self.rows = np.flatnonzero(state.table(Transform).present & state.table(Velocity).present)
        self._start, self.dt, self.stride = time, dt, stride
        room = steps // stride + 2
        self.times = np.full(room, np.nan)
        self.motion = np.full((room, len(self.rows), FIELDS), np.nan)
        self.count = 0
        self.take(state, time)

    def steps_ahead(self, time: float) -> int:
        """Return in how many steps from a time [s] on the next sample is due."""
        return self.stride - self._done(time) % self.stride

    def due(self, time: float, span: float) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Return which samples are due within ``span`` seconds from a time on, and how much later each is.

        Returns
        -------
        places : int64 array (n,)
            Their numbers.
        after : float64 array (n,)
            Ascending, above 0 and at most ``span`` [s].
        """
        done, end = self._done(time), self._done(time + span)
        places = np.arange(done // self.stride + 1, end // self.stride + 1)
        after = (places * self.stride - done) * self.dt
        return places, np.where(after < span - _LONGER * self.dt, after, span)

    def put(self, places: NDArray[np.int64], times: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return where the samples of some times [s] (n,) are to be written: (n, moving, 6)."""
        if not len(places):
            return self.motion[:0]
        self.times[places] = times
        self.count = int(places[-1]) + 1
        return self.motion[places[0] : self.count]

    def take(self, state: Entities, time: float) -> None:
        """Take a sample of the state as it is, at a time [s], if one is due then."""
        done = self._done(time)
        if not done % self.stride and abs(time - self._start - done * self.dt) <= _LATE * self.dt:
            self._write(state, done // self.stride, time)

    def finish(self, state: Entities, time: float) -> None:
        """Take a sample at the end of a run, at a time [s]."""
        last = abs(self.times[self.count - 1] - time) <= _LATE * self.dt
        self._write(state, self.count - last, time)

    def _write(self, state: Entities, place: int, time: float) -> None:
        transform, velocity = state.table(Transform), state.table(Velocity)
        into = self.put(np.array([place]), np.array([time]))[0]
        columns: tuple[Any, ...] = (transform["angle"], velocity["angular"])
        into[:, 0:2], into[:, 3:5] = transform["position"][self.rows], velocity["linear"][self.rows]
        into[:, 2], into[:, 5] = (column[self.rows] for column in columns)

    def _done(self, time: float) -> int:
        """Return how many steps are made at a time [s]."""
        return math.floor((time - self._start) / self.dt + _LATE)
