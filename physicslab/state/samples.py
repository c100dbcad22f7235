"""Samples of the motion of a world, which steppers take while they advance it."""

import math
from copy import copy
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform, Velocity
from physicslab.state.entities import Entities

FIELDS = 6
"""Numbers of a body at an instant: x, y, angle and their rates."""
_LATE = 1e-6
"""Share of a step by which the end of one may be late: the clock is a sum of rounded steps."""
_LONGER = 1.1e-3
"""Share of a step by which the last of a run may be longer: less than a part of one that is divided."""
NOTHING_SAMPLED = np.zeros(0, np.int64), np.zeros((0, 0)), 1, 1
"""Samples of no row, as kernels take them (:class:`physicslab.kernels.arguments.Sampled`)."""


class StepEnds(NamedTuple):
    """The ends of the steps that were one call, the present state as the last.

    Attributes
    ----------
    times, spans : float64 arrays (k,)
        When each ends, and how long it is [s].
    motion : float64 array (k, n, 6)
        x and y [m], the angle [rad] and their rates of some rows then.
    """

    times: NDArray[np.float64]
    spans: NDArray[np.float64]
    motion: NDArray[np.float64]


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
        self.rows = moving_rows(state)
        self._start, self.dt, self.stride, self._first = time, dt, stride, 0
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
        within = time - (self._start + done * self.dt)
        if abs(within) > _LATE * self.dt:  # in the middle of a step
            after -= within
        return places, np.where(after < span - _LONGER * self.dt, after, span)

    def put(self, places: NDArray[np.int64], times: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return where the samples of some times [s] (n,) are to be written: (n, moving, 6)."""
        if not len(places):
            return self.motion[:0]
        first, self.count = int(places[0]) - self._first, int(places[-1]) + 1
        self.times[first : self.count - self._first] = times
        return self.motion[first : self.count - self._first]

    def part(self, state: Entities, time: float, span: float) -> Self:
        """Return samples of another world, such as an island, for ``span`` seconds from a time [s] on."""
        places, _ = self.due(time, span)
        part = copy(self)
        part.rows = moving_rows(state)
        part._first = part.count = int(places[0]) if len(places) else 0
        part.times = np.full(len(places), np.nan)
        part.motion = np.full((len(places), len(part.rows), FIELDS), np.nan)
        return part

    def join(self, part: Self, own: NDArray[np.int64], there: NDArray[np.int64]) -> None:
        """Take the samples of rows ``own`` (n,) of a part, which here are the rows ``there`` (n,)."""
        places = np.arange(part._first, part.count)
        columns = np.searchsorted(self.rows, there), np.searchsorted(part.rows, own)
        self.put(places, part.times[: len(places)])[:, columns[0]] = part.motion[: len(places), columns[1]]

    def between(self, early: float, late: float) -> range:
        """Return the numbers in ``motion`` of the samples between two times [s], without their ends."""
        known, rounding = self.times[: self.count - self._first], _LATE * self.dt
        return range(*np.searchsorted(known, (early + rounding, late - rounding)).tolist())

    def put_into(self, motion: NDArray[np.float64], rows: NDArray[np.int64], numbers: range) -> None:
        """Write samples of some numbers over ``motion`` (k, n, 6) of ``rows`` (n,), where they move."""
        column = np.minimum(np.searchsorted(self.rows, rows), max(len(self.rows) - 1, 0))
        moves = np.flatnonzero(self.rows[column] == rows) if len(self.rows) else column[:0]
        motion[:, moves] = self.motion[numbers.start : numbers.stop, column[moves]]

    def repeat(self, state: Entities, time: float, span: float) -> None:
        """Take the state as it is for all samples within ``span`` seconds from a time [s] on."""
        places, after = self.due(time, span)
        self.put(places, time + after)[:] = motion_of_rows(state, self.rows)

    def take(self, state: Entities, time: float) -> None:
        """Take a sample of the state as it is, at a time [s], if one is due then."""
        place, after = divmod(self._done(time), self.stride)
        late = time - self._start - place * self.stride * self.dt
        if not after and abs(late) <= _LATE * self.dt and 0 <= place - self._first < len(self.times):
            self._write(state, place, time)

    def finish(self, state: Entities, time: float) -> None:
        """Take a sample at the end of a run, at a time [s]."""
        last = abs(self.times[self.count - 1] - time) <= _LATE * self.dt
        self._write(state, self.count - last, time)

    def _write(self, state: Entities, place: int, time: float) -> None:
        self.put(np.array([place]), np.array([time]))[0] = motion_of_rows(state, self.rows)

    def _done(self, time: float) -> int:
        """Return how many steps are made at a time [s]."""
        return math.floor((time - self._start) / self.dt + _LATE)


def ends_of_steps(
    samples: Samples | None, state: Entities, rows: NDArray[np.int64], early: float, late: float, h: float
) -> StepEnds:
    """Return the ends of the steps between two times [s], of ``h`` seconds together, which are one call.

    Their motion is that of ``rows`` (n,).
    """
    between = range(0) if samples is None else samples.between(early, late)
    motion = np.repeat(motion_of_rows(state, rows)[None], len(between) + 1, axis=0)
    if samples is None or not between:
        return StepEnds(np.array([late]), np.array([h]), motion)
    samples.put_into(motion[:-1], rows, between)
    spans = np.full(len(motion), samples.dt)
    spans[-1] = h - len(between) * samples.dt
    return StepEnds(np.append(samples.times[between.start : between.stop], late), spans, motion)


def moving_rows(state: Entities) -> NDArray[np.int64]:
    """Return the rows of what moves (moving,)."""
    return np.flatnonzero(state.table(Transform).present & state.table(Velocity).present)


def motion_of_rows(state: Entities, rows: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return x, y [m], the angle [rad] and their rates of rows (n, 6)."""
    transform, velocity, found = state.table(Transform), state.table(Velocity), np.empty((len(rows), FIELDS))
    columns: tuple[Any, ...] = (transform["angle"], velocity["angular"])
    found[:, 0:2], found[:, 3:5] = transform["position"][rows], velocity["linear"][rows]
    found[:, 2], found[:, 5] = (column[rows] for column in columns)
    return found


def put_motion(state: Entities, rows: NDArray[np.int64], motion: NDArray[np.float64]) -> None:
    """Put x, y [m], the angle [rad] and their rates of rows (n, 6) into the columns."""
    transform, velocity = state.table(Transform), state.table(Velocity)
    transform["position"][rows], velocity["linear"][rows] = motion[:, 0:2], motion[:, 3:5]
    transform["angle"][rows], velocity["angular"][rows] = motion[:, 2], motion[:, 5]


def sampled(samples: Samples | None, time: float, span: float, steps: int) -> tuple[Any, ...]:
    """Return what a compiled loop takes of ``steps`` steps of ``span`` seconds from a time [s] on.

    It is :class:`physicslab.kernels.arguments.Sampled`, without names.
    """
    if samples is None:
        return NOTHING_SAMPLED
    places, after = samples.due(time, steps * span)
    room = samples.put(places, time + after).reshape(len(places), FIELDS * len(samples.rows))
    return samples.rows, room, samples.steps_ahead(time), samples.stride
