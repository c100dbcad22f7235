"""Trails: past positions of bodies."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Trail, Transform
from physicslab.kernels import direct_entry
from physicslab.kernels.trails import note_places
from physicslab.state.samples import ends_of_steps
from physicslab.state.state import State
from physicslab.systems.system import Stage, System, at

SAMPLES = 128
"""Positions kept of each body."""


class TrailSystem(System):
    """Records where each body with a Trail has been, as far back as its Trail is long.

    It reads positions and writes to nothing but its own record. A body has a ring of ``SAMPLES`` places, at
    least ``length / (SAMPLES - 2)`` seconds apart, so memory and cost do not depend on a trail's length. The
    newest place is always that of now. The record goes with the body, or with its Trail.

    Attributes
    ----------
    entities : int64 array (n,)
        The bodies on record, ascending.
    """

    needs = (Trail, Transform)
    sampled = True

    def __init__(self) -> None:
        self.entities: NDArray[np.int64] = np.zeros(0, np.int64)
        self._place = np.zeros((0, SAMPLES, 2))
        self._time = np.zeros((0, SAMPLES))  # NaN where nothing was recorded yet
        self._head: NDArray[np.int64] = np.zeros(0, np.int64)
        self._rows: NDArray[np.int64] = np.zeros(0, np.int64)
        self._length = np.zeros(0)
        self._now = 0.0

    def attach(self, state: State) -> None:
        """Drop the records of bodies that are gone, and begin those of new ones where they are now."""
        batch = state.batch(*self.needs)
        known = np.isin(batch.entities, self.entities)
        old = np.searchsorted(self.entities, batch.entities[known])
        place, time = np.zeros((len(batch), SAMPLES, 2)), np.full((len(batch), SAMPLES), np.nan)
        head = np.zeros(len(batch), np.int64)
        place[known], time[known], head[known] = self._place[old], self._time[old], self._head[old]
        place[~known, 0] = state.table(Transform)["position"][batch.rows[~known]]
        time[~known, 0] = state.time
        self.entities, self._rows = batch.entities, batch.rows
        self._place, self._time, self._head = place, time, head
        self._length = state.table(Trail)["length"][batch.rows]
        if len(batch):
            state.compile((note_places,))

    def keep(self) -> tuple[NDArray[Any], ...]:
        """Return copies of the record."""
        if not len(self.entities):
            return ()
        return self._place.copy(), self._time.copy(), self._head.copy(), np.array(self._now)

    def restore(self, kept: tuple[NDArray[Any], ...]) -> None:
        """Go on with an earlier record of the same bodies, of the shapes that :meth:`keep` gave it."""
        place, time, head, now = kept
        self._place, self._time, self._head, self._now = place.copy(), time.copy(), head.copy(), float(now)

    @at(Stage.FINISH)
    def record(self, state: State, h: float) -> None:
        """Note where the bodies are at the end of the step, or of each of the steps that were one call."""
        now = state.time + h
        if now <= self._now:  # the clock was set back: what was recorded is in the future
            self._time[:] = np.nan
            self._now = state.time
        self._length = state.table(Trail)["length"][self._rows]
        ends = ends_of_steps(state.samples, state, self._rows, self._now, now, h)
        if len(ends.times):
            self._now = float(ends.times[-1])
            motion = np.ascontiguousarray(ends.motion.reshape(-1, ends.motion.shape[2]))
            place = self._place.reshape(-1, 2)
            direct_entry(note_places)(ends.times, motion, self._length, self._head, self._time, place)

    def paths(self, every: int = 1) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return every path, in the order of ``entities``, and how old each part of it is.

        Parameters
        ----------
        every : int
            Take only one of so many places, a divisor of ``SAMPLES``; always the same ones, and that of now.

        Returns
        -------
        positions : float64 array (n, SAMPLES // every + 1, 2)
            Places in the order of time [m]; the last is that of now.
        ages : float64 array (n, SAMPLES // every + 1)
            Time since then, as a share of the Trail's length; NaN or above 1 where there is no such place.
        """
        slots = (self._head[:, None] // every + np.arange(1, SAMPLES // every + 1)) * every % SAMPLES
        slots = np.append(slots, self._head[:, None], axis=1)
        slots += SAMPLES * np.arange(len(slots))[:, None]
        times = self._time.reshape(-1)[slots]
        ages = (times[:, -1:] - times) / self._length[:, None]
        return np.take(self._place.reshape(-1, 2), slots, axis=0), ages

    def path(self, entity: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return where a body has been (k, 2) [m] and when (k,) [s], in the order of time.

        Raises
        ------
        KeyError
            If the body has no record.
        """
        found = np.flatnonzero(self.entities == entity)
        if not len(found):
            raise KeyError(f"entity {entity} has no trail on record")
        i = int(found[0])
        order = (self._head[i] + np.arange(1, SAMPLES + 1)) % SAMPLES
        times = self._time[i, order]
        kept = times[-1] - times <= self._length[i] * (1.0 + 1e-12)
        return self._place[i, order][kept], times[kept]
