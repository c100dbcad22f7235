"""Positions of bodies at regular moments."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Strobe, Transform
from physicslab.state.samples import ends_of_steps, motion_of_rows
from physicslab.state.state import State
from physicslab.systems.system import Stage, System, at
from physicslab.systems.within_step import StepPath

_LIMIT = 200_000
"""Pictures that are kept of all bodies together; the oldest go first."""
_CLOCK_ERROR = 1e-9
"""Share of the interval by which a moment may be missed, as the clock rounds."""

type _Rows = NDArray[np.int64]


class StrobeSystem(System):
    """Records where each body with a :class:`Strobe` is at the multiples of its interval, and its angle.

    Places between the ends of steps lie on the path through the step
    (:class:`physicslab.systems.within_step.StepPath`). It writes to nothing but its own record, which goes
    with the body, or with its Strobe.
    """

    needs = (Strobe, Transform)
    sampled = True

    def __init__(self) -> None:
        self._entities: _Rows = np.zeros(0, np.int64)
        self._rows: _Rows = np.zeros(0, np.int64)
        # Flashes, a few rows each: entity, time, x, y, angle. None is changed, so key frames share them.
        self._flashes: tuple[NDArray[np.float64], ...] = ()
        self._until = -np.inf
        self._before: NDArray[np.float64] | None = None

    def attach(self, state: State) -> None:
        """Follow the bodies there are, and drop the records of those that are gone."""
        batch = state.batch(*self.needs)
        gone = np.setdiff1d(self._entities, batch.entities)
        if len(gone):
            kept = (flash[~np.isin(flash[:, 0], gone)] for flash in self._flashes)
            self._flashes = tuple(flash for flash in kept if len(flash))
        self._entities, self._rows, self._before = batch.entities, batch.rows, None

    def keep(self) -> tuple[NDArray[Any], ...]:
        """Return the record."""
        return np.array(self._until), *self._flashes

    def restore(self, kept: tuple[NDArray[Any], ...]) -> None:
        """Go on with an earlier record of the same bodies, of the shapes that :meth:`keep` gave it."""
        until, *flashes = kept
        self._until, self._flashes, self._before = float(until), tuple(flashes), None

    @at(Stage.PREPARE)
    def begin(self, state: State, h: float) -> None:
        """Note where the bodies are at the beginning of the step."""
        if state.time + h < self._until:  # the clock was set back: what was recorded is in the future
            self._flashes, self._until = (), -np.inf
        self._before = motion_of_rows(state, self._rows)

    @at(Stage.FINISH)
    def record(self, state: State, h: float) -> None:
        """Note where the bodies were at the multiples of their intervals within the steps."""
        if self._before is None:
            return
        interval = state.table(Strobe)["interval"][self._rows]
        start, end = state.time, state.time + h
        first = np.ceil(start / interval - _CLOCK_ERROR).astype(np.int64)
        behind = np.ceil(end / interval - _CLOCK_ERROR).astype(np.int64)
        first = np.maximum(first, behind - state.table(Strobe)["count"][self._rows])
        self._until = end
        many = np.maximum(behind - first, 0)
        if not many.any():
            return
        body = np.repeat(np.arange(len(many)), many)
        turn = np.arange(len(body)) - np.repeat(np.cumsum(many) - many, many) + np.repeat(first, many)
        times = turn * interval[body]
        ends = ends_of_steps(state.samples, state, self._rows, start, end, h)
        begins = np.append(start, ends.times[:-1])
        step = np.searchsorted(begins[1:], times + _CLOCK_ERROR * interval[body], side="right")
        span = ends.spans[step]
        motion = np.concatenate((self._before[None], ends.motion))
        before, after = motion[step, body], motion[step + 1, body]
        path = StepPath.between(before[:, :3], after[:, :3], before[:, 3:], after[:, 3:], span)
        where = path.at(np.arange(len(body)), np.clip((times - begins[step]) / span, 0.0, 1.0))
        flash = np.column_stack((self._entities[body], times, where))
        self._flashes = (*self._flashes, flash)
        self._forget_old(state)

    def _forget_old(self, state: State) -> None:
        """Drop the flashes that are too old to be shown, and the oldest where there are too many."""
        strobe = state.table(Strobe)
        longest = float((strobe["interval"][self._rows] * (strobe["count"][self._rows] + 1)).max())
        flashes = [flash for flash in self._flashes if flash[-1, 1] > self._until - longest]
        total = sum(map(len, flashes))
        while total > _LIMIT and len(flashes) > 1:
            total -= len(flashes.pop(0))
        self._flashes = tuple(flashes)

    def pictures(self, state: State) -> tuple[_Rows, NDArray[np.float64]]:
        """Return the rows of bodies (k,), and where they were: x, y, angle and time (k, 4) [m, rad, s].

        The oldest come first; of each body no more than its Strobe shows.
        """
        if not self._flashes:
            return np.zeros(0, np.int64), np.zeros((0, 4))
        every = np.concatenate(self._flashes)
        rows = state.entity_index.rows_of(every[:, 0].astype(np.int64))
        strobe, present = state.table(Strobe), rows > 0
        every, rows = every[present], rows[present]
        age = self._until - every[:, 1]
        shown = age <= (1.0 + _CLOCK_ERROR) * strobe["interval"][rows] * strobe["count"][rows]
        order = np.argsort(every[shown, 1], kind="stable")
        return rows[shown][order], every[shown][order][:, [2, 3, 4, 1]]
