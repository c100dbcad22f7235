"""Where the bodies of a world are, beside where they should be."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from physicslab.components import Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.world import World

__all__ = ["distance", "place", "state_error", "velocity"]


def place(world: World, name: str) -> Vector2:
    """Return where a body is [m]."""
    return world.component(world.entity(name), Transform).position


def velocity(world: World, name: str) -> Vector2:
    """Return how a body moves [m/s]."""
    return world.component(world.entity(name), Velocity).linear


def distance(world: World, expected: Mapping[str, Sequence[float]]) -> float:
    """Return how far the body that is farthest off is from where it should be [m]."""
    return max(
        math.hypot(*(place(world, name) - Vector2(*where))) for name, where in expected.items()
    )  # fmt: skip


def state_error(
    world: World, name: str, where: Sequence[float], how: Sequence[float], rate: float = 1.0
) -> float:
    """Return the largest error of x, y [m] and of vx / rate, vy / rate [m] of a body."""
    off = place(world, name) - Vector2(*where)
    slip = (velocity(world, name) - Vector2(*how)) / rate
    return max(abs(off.x), abs(off.y), abs(slip.x), abs(slip.y))
