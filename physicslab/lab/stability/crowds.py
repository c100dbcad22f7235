"""Bodies that are put where others are already."""

from __future__ import annotations

from functools import cache, partial

import numpy as np

from physicslab.components import Transform, Velocity
from physicslab.lab.stability.case import StabilityCase
from physicslab.lab.worlds import largest, open_space
from physicslab.prefabs import circle
from physicslab.world import World

__all__ = ["CROWDS"]

_RADIUS = 0.1


def _crowd(count: int) -> World:
    """Return a world of discs whose centres coincide; nothing pulls at them."""
    world = open_space(gravity=None)
    for _ in range(count):
        circle(world, (0.0, 0.0), radius=_RADIUS)
    return world


def _fastest(world: World) -> float:
    linear = world.table(Velocity)["linear"]
    return float(np.sqrt((linear * linear).sum(axis=1).max()))


@cache  # two cases look at one run
def _parting(count: int, steps: int) -> tuple[float, float]:
    """Return how fast the fastest disc is on the way [m/s], and the overlap at the end, of a radius."""
    world = _crowd(count)
    fastest = largest(world, steps, lambda: _fastest(world))
    return fastest, world.contacts.max_penetration / _RADIUS


def _speed(count: int, steps: int) -> float:
    return _parting(count, steps)[0]


def _overlap(count: int, steps: int) -> float:
    return _parting(count, steps)[1]


def _difference(count: int, steps: int) -> float:
    """Return how far apart two runs end."""
    ends = []
    for _ in range(2):
        world = _crowd(count)
        world.run(steps=steps)
        ends.append(world.table(Transform)["position"].copy())
    return float(np.abs(ends[0] - ends[1]).max())


def _cases(count: int, steps: int) -> list[StabilityCase]:
    title = f"{count:,} discs of 0.1 m on one spot"
    return [
        StabilityCase(
            name=f"crowd_{count}_speed", title=title, group="crowds",
            right="they come apart slowly: coming apart makes no energy to speak of", figure="fastest disc",
            unit="m/s", limit=2.0, measure=partial(_speed, count, steps), run=f"crowd_{count}",
            long_s=60.0 if count > 1_000 else 0.0,
        ),
        StabilityCase(
            name=f"crowd_{count}_apart", title=f"{title}, after {steps} steps", group="crowds",
            right="they are apart, to a tenth of their size", figure="deepest overlap, of a radius",
            limit=0.2, measure=partial(_overlap, count, steps), long_s=60.0 if count > 1_000 else 0.0,
            run=f"crowd_{count}",
        ),
    ]  # fmt: skip


CROWDS = [
    StabilityCase(
        name="coincident_centres", title="two discs on one spot", group="crowds",
        right="they come apart, to a tenth of their size", figure="overlap after 2 s, of a radius", limit=0.2,
        measure=partial(_overlap, 2, 120),
    ),
    *_cases(1_000, 300),
    StabilityCase(
        name="crowd_1000_same", title="1,000 discs on one spot, twice", group="crowds",
        right="they go the same ways: no normal is left to chance", figure="difference of two runs", unit="m",
        limit=0.0, measure=partial(_difference, 1_000, 6),
    ),
    *_cases(5_000, 900),
]  # fmt: skip
