"""The figures that the HUD shows, measured a few times a second."""

from __future__ import annotations

import math
from dataclasses import dataclass

from physicslab.diagnostics import Energy, measure_energy, measure_momentum
from physicslab.view.bodies import body_rows
from physicslab.world import World

__all__ = ["FrameMeter", "WorldFigures", "measure_world"]

_SMOOTHING = 0.5
"""Time [s] over which frame rate and costs are averaged."""


@dataclass(frozen=True, slots=True)
class WorldFigures:
    """What there is to say of a world at one moment.

    Attributes
    ----------
    bodies, candidate_pairs, contacts : int
        How many bodies there are, pairs that are near each other, and pairs that touch.
    energy : Energy
        Kinetic and potential [J].
    momentum : float
        Magnitude of the total linear momentum [kg m/s].
    """

    bodies: int
    candidate_pairs: int
    contacts: int
    energy: Energy
    momentum: float


def measure_world(world: World) -> WorldFigures:
    """Measure a world as it is now."""
    energy, momentum = measure_energy(world), measure_momentum(world)
    contacts = world.contacts
    return WorldFigures(
        len(body_rows(world)), contacts.candidate_pairs, contacts.count, energy, momentum.linear.magnitude
    )


class FrameMeter:
    """Averages frame rate and costs over the last half second or so.

    Attributes
    ----------
    cost : dict of str to float
        What each system takes a frame [ms], by name.
    """

    def __init__(self) -> None:
        self.cost: dict[str, float] = {}
        self._frame_time = 0.0
        self._before: dict[str, int] = {}
        self._world: World | None = None

    @property
    def frame_rate(self) -> float:
        """Frames per second; 0 before the first."""
        return 1.0 / self._frame_time if self._frame_time > 0.0 else 0.0

    def note(self, world: World, elapsed: float) -> None:
        """Take note of a frame, ``elapsed`` seconds after the last."""
        if elapsed <= 0.0:  # the first frame
            return
        share = 1.0 - math.exp(-elapsed / _SMOOTHING)
        if self._frame_time == 0.0:
            self._frame_time = elapsed
        self._frame_time += (elapsed - self._frame_time) * share
        if world is not self._world:
            self._world, self._before, self.cost = world, {}, {}
        for name, timing in world.schedule.timings.items():
            spent = (timing.nanoseconds - self._before.get(name, timing.nanoseconds)) / 1e6
            self._before[name] = timing.nanoseconds
            self.cost[name] = self.cost.get(name, spent) + (spent - self.cost.get(name, spent)) * share
