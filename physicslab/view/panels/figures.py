"""The figures that the HUD shows, measured a few times a second."""

from __future__ import annotations

import math
from dataclasses import dataclass

from physicslab.components import Held
from physicslab.diagnostics.energy import Drift, Energy, Momentum, measure_momentum
from physicslab.diagnostics.reference_solution import ReferenceSolution, reference_solution
from physicslab.view.picture.bodies import body_rows
from physicslab.world import World

__all__ = ["EnergyWatch", "FrameMeter", "WorldFigures", "measure_world"]

_SMOOTHING = 0.5
"""Time [s] over which frame rate and costs are averaged."""


@dataclass(frozen=True, slots=True)
class WorldFigures:
    """What there is to say of a world at one moment.

    Attributes
    ----------
    bodies, asleep, candidate_pairs, contacts : int
        How many bodies there are and sleep, pairs that are near each other, and pairs that touch.
    energy : Energy
        Kinetic and potential [J].
    drift : Drift
        How far the energy [J] departed from what it was at the last edit.
    since : float
        Time of the world [s] at the last edit.
    momentum : Momentum
        Linear [kg m/s], and angular about the origin [kg m^2/s].
    known : ReferenceSolution, optional
        The exact solution since the last edit, where there is one.
    error : float
        How far the body that is furthest off is from that [m].
    frame_rate : float
        Frames per second of late.
    """

    bodies: int
    asleep: int
    candidate_pairs: int
    contacts: int
    energy: Energy
    drift: Drift
    since: float
    momentum: Momentum
    known: ReferenceSolution | None
    error: float
    frame_rate: float = 0.0


def measure_world(world: World, watch: EnergyWatch, frame_rate: float = 0.0) -> WorldFigures:
    """Measure a world as it is now."""
    drift = watch.sample(world)
    contacts, known = world.contacts, watch.known
    return WorldFigures(
        len(body_rows(world)), world.sleep.count, contacts.candidate_pairs, contacts.count,
        drift.latest, drift, watch.since, measure_momentum(world),
        known, known.error(world) if known is not None else 0.0, frame_rate,
    )  # fmt: skip


class EnergyWatch:
    """Watches the energy of a world from one edit to the next, and its motion where that is known exactly.

    What changes the laws of the world, or its structure where the motion may depend on that, is an edit, and
    so is taking a body and letting it go: the energy that these bring in or take out is no error of the
    simulation.

    Attributes
    ----------
    since : float
        Time of the world [s] at the last edit.
    known : ReferenceSolution, optional
        The exact solution since then, where there is one.
    """

    def __init__(self) -> None:
        self.since = 0.0
        self.known: ReferenceSolution | None = None
        self._drift: Drift | None = None
        self._seen: tuple[World, int] | None = None

    def follow(self, world: World) -> None:
        """Begin again if the world was edited; to be called in every frame, so that nothing is missed."""
        if self._drift is None or self._seen != (world, world.motion_edits):
            self.restart(world)

    def restart(self, world: World) -> Drift:
        """Begin again from the energy as it is now."""
        self._drift = Drift(world)
        self.known = reference_solution(world)
        self._seen, self.since = (world, world.motion_edits), world.time
        return self._drift

    def sample(self, world: World) -> Drift:
        """Measure the energy as it is now.

        While a body is held the hand does work all the time, and there is nothing to compare with.
        """
        self.follow(world)
        if self._drift is None or len(world.batch(Held)):
            return self.restart(world)
        self._drift.sample(world)
        return self._drift


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
        """Count a frame, ``elapsed`` seconds after the last."""
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
