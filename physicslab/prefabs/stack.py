"""A tower."""

from __future__ import annotations

from physicslab.ecs.vector import Vector2
from physicslab.prefabs.body import Pair
from physicslab.prefabs.box import box
from physicslab.world import World

__all__ = ["stack"]


def stack(
    world: World,
    count: int,
    base: Pair = (0.0, 0.0),
    *,
    width: float = 1.0,
    height: float = 1.0,
    gap: float = 0.0,
    mass: float = 1.0,
    restitution: float = 0.0,
    friction: float = 0.6,
) -> list[int]:
    """Spawn ``count`` boxes on top of each other; return their entities from the lowest up.

    Parameters
    ----------
    base : vector
        Middle of the lowest side [m].
    width, height : float
        Of each box [m].
    gap : float
        Left between each and the next at the start [m].
    mass, restitution, friction : float
        Of each box: [kg], and the numbers of its surface.
    """
    foot = Vector2(*base)
    return [
        box(
            world,
            foot + Vector2(0.0, height / 2.0 + i * (height + gap)),
            width=width,
            height=height,
            mass=mass,
            restitution=restitution,
            friction=friction,
        )
        for i in range(count)
    ]
