"""How far the bodies of a world are from where they should be."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from physicslab.ecs.vector import Vector2
from physicslab.lab.worlds import place, velocity
from physicslab.world import World

__all__ = ["distance", "state_error"]


def distance(world: World, expected: Mapping[str, Sequence[float]]) -> float:
    """Return the largest distance of a body from where it should be [m], of those that are named."""
    return max((place(world, name) - Vector2(*where)).magnitude for name, where in expected.items())


def state_error(
    world: World, name: str, where: Sequence[float], how: Sequence[float], rate: float = 1.0
) -> float:
    """Return the largest error of x, y [m] and of vx / rate, vy / rate [m] of a body."""
    off = place(world, name) - Vector2(*where)
    slip = (velocity(world, name) - Vector2(*how)) / rate
    return max(abs(off.x), abs(off.y), abs(slip.x), abs(slip.y))
