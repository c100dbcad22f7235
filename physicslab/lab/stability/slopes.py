"""A block on a slope at the edge of sliding."""

from __future__ import annotations

import math
from functools import partial

from physicslab.ecs.vector import Vector2
from physicslab.lab.stability.case import StabilityCase
from physicslab.lab.worlds import GRAVITY, largest, open_space, place
from physicslab.prefabs import box
from physicslab.world import World

__all__ = ["SLOPES"]

_ANGLE = math.radians(20.0)


def _block(share: float) -> tuple[World, int]:
    """Return a block on a slope of 20 degrees, with a share of the friction at which it would just hold."""
    along = Vector2.from_angle(_ANGLE)
    world = open_space(contacts="soft")
    friction = share * math.tan(_ANGLE)
    box(world, (0.0, 0.0), width=200.0, height=1.0, angle=_ANGLE, static=True, friction=friction)
    block = box(world, along.perpendicular * 0.75, width=1.0, height=0.5, angle=_ANGLE, friction=friction)
    return world, block


def _creep(share: float, seconds: float) -> float:
    world, block = _block(share)
    start = place(world, block)
    return largest(world, round(60.0 * seconds), lambda: (place(world, block) - start).magnitude, 10)


def _acceleration_error(share: float, seconds: float) -> float:
    """Return how far the acceleration down the slope is from the right one, as a share of it."""
    world, block = _block(share)
    start = place(world, block)
    world.run(seconds=seconds)
    slid = (place(world, block) - start).dot(-Vector2.from_angle(_ANGLE))
    right = GRAVITY * math.sin(_ANGLE) * (1.0 - share)
    return abs(2.0 * slid / seconds**2 / right - 1.0)


SLOPES = [
    *(
        StabilityCase(
            name=f"slope_holds_{share:g}", group="slopes",
            title=f"block on a slope of 20 degrees, friction {share:g} times the threshold, 60 s",
            right="it holds: it creeps less than 1 mm", figure="creep", unit="m", limit=0.001,
            measure=partial(_creep, share, 60.0),
        )
        for share in (1.01, 1.1)
    ),
    *(
        StabilityCase(
            name=f"slope_slides_{share:g}", group="slopes",
            title=f"block on a slope of 20 degrees, friction {share:g} times the threshold, 10 s",
            right="it slides with g (sin - mu cos), within 1 %", figure="error of the acceleration",
            limit=0.01, measure=partial(_acceleration_error, share, 10.0),
        )
        for share in (0.99, 0.9)
    ),
]  # fmt: skip
