"""Bodies that attract each other without order: close passages, and a crowd."""

from __future__ import annotations

import math
from dataclasses import replace

from physicslab.components import Mass, Transform, Velocity
from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.lab.accuracy.figures import number, record
from physicslab.lab.accuracy.problem import Ladder, Problem
from physicslab.lab.accuracy.states import distance
from physicslab.lab.worlds import PLANETS, empty_world
from physicslab.world import World

__all__ = ["CHAOS", "crowd"]

_ALL = frozenset({"energy", "momentum", "angular_momentum"})

_LIMITS = {5: (1e-4, 1e-11), 10: (1e-4, 1e-10), 15: (1e-4, 1e-10), 20: (1e-4, 6e-10), 40: (1e-3, 4e-8),
           60: (1e-1, 4e-4), 70: (1.0, 1e-2)}  # fmt: skip
"""Good and excellent by time [s]. From 20 s on, excellent is what REBOUND's IAS15 does with doubles."""


def _pythagorean(simulation: SimulationConfig) -> World:
    world = empty_world(simulation, PLANETS)
    for i, (mass, where) in enumerate(((3, (1, 3)), (4, (-2, -1)), (5, (1, -1))), 1):
        world.spawn(Transform(where), Velocity(), Mass(mass), name=str(i))
    return world


def _pythagorean_at(t: int) -> Problem:
    def error(world: World, i: int) -> float:
        return distance(
            world,
            {str(n): [number("pythagorean", f"t={t}", f"{axis}{n}") for axis in "xy"] for n in (1, 2, 3)},
        )

    good, excellent = _LIMITS[t]
    return Problem(
        name=f"pythagorean_t{t}",
        title=f"Masses of 3, 4 and 5 kg let go in a triangle of sides 3, 4 and 5 m, for {t} s",
        group="gravity",
        source="pythagorean",
        compared=f"positions after {t} s",
        measure="largest distance from the true place [m]",
        build=_pythagorean,
        times=(float(t),),
        error=error,
        good=good,
        excellent=excellent,
        ladder=Ladder(4096 * max(1, t // 5), 7),
        keeps=_ALL,
        chaotic=True,
        note="chaotic: passages as close as 0.4 mm make each rounding grow",
    )


CROWD, CROWD_SOFTENING, CROWD_TIME = 100, 0.05, 2.3


def crowd() -> list[tuple[tuple[float, float], tuple[float, float]]]:
    """Return place [m] and velocity [m/s] of each of 100 bodies of 10 g, with no random numbers in it.

    Radii are those of a Plummer disc by quantiles, directions advance by the golden angle, and every third
    body circles the other way; the speed is two thirds of that of a circular orbit. All are multiples of
    2^-20, so that arithmetic of any precision begins at the same numbers.
    """
    golden = math.pi * (3.0 - math.sqrt(5.0))
    bodies = []
    for i in range(CROWD):
        share = (i + 0.5) / CROWD
        radius = math.sqrt(share / (1.0 - 0.9 * share))
        speed = 2.0 / 3.0 * math.sqrt(share / radius) * (-1.0 if i % 3 == 0 else 1.0)
        where = Vector2.from_angle(i * golden, radius)
        how = where.normalized.perpendicular * speed
        x, y, vx, vy = (round(value * 2**20) / 2**20 for value in (*where, *how))
        bodies.append(((x, y), (vx, vy)))
    return bodies


def _crowd(simulation: SimulationConfig) -> World:
    world = empty_world(simulation, replace(PLANETS, softening=CROWD_SOFTENING))
    for i, (where, how) in enumerate(crowd()):
        world.spawn(Transform(where), Velocity(how), Mass(1.0 / CROWD), name=str(i))
    return world


def _crowd_error(world: World, i: int) -> float:
    places: dict[str, list[str]] = record("crowd100")["reference"]["places"]
    return distance(world, {body: [float(digits) for digits in pair] for body, pair in places.items()})


CHAOS = (
    *map(_pythagorean_at, _LIMITS),
    Problem(
        name="crowd100",
        title="A hundred bodies that attract each other, softened",
        group="gravity",
        compared=f"positions of all after {CROWD_TIME} s",
        measure="largest distance from the true place [m]",
        build=_crowd,
        times=(CROWD_TIME,),
        error=_crowd_error,
        good=1e-4,
        excellent=1e-6,
        ladder=Ladder(128, 5),
        keeps=_ALL,
        note="our own, in place of plummer100, whose figures do not contain its start",
    ),
)
"""Their problems."""
