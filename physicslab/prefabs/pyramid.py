"""A pyramid of boxes."""

from __future__ import annotations

from physicslab.ecs.vector import Vector2
from physicslab.prefabs.body import Pair
from physicslab.prefabs.box import box
from physicslab.world import World

__all__ = ["pyramid"]


def pyramid(
    world: World,
    base: int,
    foot: Pair = (0.0, 0.0),
    *,
    size: float = 1.0,
    gap: float = 0.1,
    mass: float = 1.0,
    restitution: float = 0.0,
    friction: float = 0.6,
) -> list[int]:
    """Spawn rows of ``base``, ``base - 1``, ..., 1 square boxes; return their entities, row by row.

    Parameters
    ----------
    base : int
        Boxes in the lowest row.
    foot : vector
        Middle of the lowest row's lower side [m].
    size : float
        Side of a box [m].
    gap : float
        Between neighbours of a row [m]; the rows rest on each other.
    mass, restitution, friction : float
        Of each box: [kg], and the numbers of its surface.
    """
    middle, pitch = Vector2(*foot), size + gap
    return [
        box(
            world,
            middle + Vector2((i - (base - row - 1) / 2.0) * pitch, (row + 0.5) * size),
            width=size,
            height=size,
            mass=mass,
            restitution=restitution,
            friction=friction,
        )
        for row in range(base)
        for i in range(base - row)
    ]
