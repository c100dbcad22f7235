"""Planets that come close, or closer."""

import math
from collections.abc import Iterator
from functools import partial

import numpy as np

from physicslab.components import Transform, Velocity
from physicslab.ecs.config import PhysicsConfig
from physicslab.lab.stability.case import StabilityCase
from physicslab.lab.worlds import energy_change, open_space, spawn_point
from physicslab.prefabs import binary
from physicslab.state.masses import Diverged
from physicslab.world import World


def _planets(softening: float = 0.0) -> World:
    return open_space(physics=PhysicsConfig(gravity_mode="planet", softening=softening))


def _unreported(softening: float, apart: float) -> float:
    """Return how many bodies have no finite state without a report; two start so far apart, at rest [m]."""
    world = _planets(softening)
    for x in (0.0, apart):
        spawn_point(world, (x, 0.0))
    try:
        world.run(seconds=10.0)
    except Diverged as error:  # a clear end is right: it names the time, and a likely reason
        return float("t =" not in str(error))
    transform, velocity = world.table(Transform), world.table(Velocity)
    finite = np.isfinite(transform["position"]).all(axis=1) & np.isfinite(velocity["linear"]).all(axis=1)
    return float((~finite).sum())


def _stops(world: World, seconds: float) -> Iterator[None]:
    """Advance a world that chooses its steps, with 97 stops on the way."""
    for _ in range(97):
        world.run(seconds=seconds / 97.0)
        yield


def _close_encounter() -> float:
    """Return the change of energy of two bodies that pass at 1e-6 of their largest distance."""
    world = _planets()
    binary(world, separation=2.0, eccentricity=(1.0 - 1e-6) / (1.0 + 1e-6))
    period = 2.0 * math.pi * math.sqrt((1.0 + 1e-6) ** 3 / 2.0)
    return energy_change(world, _stops(world, 2.3 * period))


def _pythagorean() -> float:
    """Return the change of energy of three bodies at rest in the corners of a triangle of 3, 4 and 5."""
    world = _planets()
    for mass, corner in ((3.0, (1.0, 3.0)), (4.0, (-2.0, -1.0)), (5.0, (1.0, -1.0))):
        spawn_point(world, corner, mass=mass)
    return energy_change(world, _stops(world, 70.0))


_case = partial(StabilityCase, group="planets")
_keeps = partial(
    _case, right="the adaptive method keeps the energy", figure="largest change of energy", limit=1e-6
)

ATTRACTION = (
    *(
        _case(
            name=name, title=title, figure="bodies without a finite place, unreported", limit=0.0,
            right="a clear end that names the time, or the right motion: never NaN",
            measure=partial(_unreported, softening, apart),
        )
        for name, title, softening, apart in (
            ("planets_coincident", "two bodies on one spot, softening 0", 0.0, 0.0),
            ("planets_coincident_soft", "two bodies on one spot, softening 0.1 m", 0.1, 0.0),
            ("planets_head_on", "two bodies that fall into each other, softening 0", 0.0, 1.0),
        )
    ),
    _keeps(
        name="planets_close", title="two bodies that pass at 1e-6 of their largest distance",
        measure=_close_encounter,
    ),
    _keeps(name="planets_pythagorean", title="the Pythagorean problem, t = 70", measure=_pythagorean),
)  # fmt: skip
