"""A world at the multiples of a time while it is advanced: between the ends of its steps too."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from physicslab.diagnostics.energy import Accounts
from physicslab.state.samples import motion_of_rows, moving_rows, put_motion
from physicslab.systems.within_step import StepPath, split_at_impacts
from physicslab.world import World

type _Numbers = NDArray[np.float64]

_LATE = 1e-6
"""Share of a step by which an instant may be late that is due: the clock is a sum of rounded steps."""


class Instants:
    """Shows a world at instants; bodies are then on their paths through the step, and are put back.

    Parameters
    ----------
    world : World
        At its start. No body is added to it or removed from it meanwhile.
    every : float
        The time between two instants [s].
    show : callable
        Called at each with the world, which it only reads.

    Attributes
    ----------
    spacing : float
        The time [s] after which :meth:`keep` is to be called: 0 is after each step.
    """

    def __init__(self, world: World, every: float, show: Callable[[World], object]) -> None:
        world.contacts.read = True
        steps, self._late = round(every / world.simulation.dt), _LATE * world.simulation.dt
        whole = abs(steps * world.simulation.dt - every) <= self._late
        self.spacing = every if whole else 0.0
        self._start, self._every, self._show, self._shown = world.time, every, show, 0
        self._before = world.time, world.contacts.logged, motion_of_rows(world, moving_rows(world))

    def keep(self, world: World, _: Accounts) -> None:
        """Show the instants since the last call, the present one included."""
        rows = moving_rows(world)
        (early, logged, first), last = self._before, motion_of_rows(world, rows)
        now = world.time
        self._before = now, world.contacts.logged, last
        while (due := self._start + self._shown * self._every) <= now + self._late:
            self._shown += 1
            if now - due <= self._late:
                self._show(world)
                continue
            split = split_at_impacts(
                world.contacts.impacts_since(logged), world.entity_index.entities[rows], np.array([early]),
                np.array([now - early]), np.stack((first, last)),
            )  # fmt: skip
            self._show_between(world, due, rows, last, *split)

    def _show_between(
        self, world: World, due: float, rows: NDArray[np.int64], last: _Numbers, begins: _Numbers,
        spans: _Numbers, motion: _Numbers,
    ) -> None:  # fmt: skip
        """Show the world at a time within a step, from its motion (t + 1, moving, 6) through it."""
        k = int(np.searchsorted(begins, due, side="right")) - 1
        before, after = motion[k], motion[k + 1]
        path = StepPath.between(before[:, :3], after[:, :3], before[:, 3:], after[:, 3:], float(spans[k]))
        every, share = np.arange(len(rows)), np.full(len(rows), (due - begins[k]) / spans[k])
        then = np.hstack((path.at(every, share), path.velocity(every, share)))
        now = world.time
        try:
            world.time = due
            put_motion(world, rows, then)
            self._show(world)
        finally:
            world.time = now
            put_motion(world, rows, last)
