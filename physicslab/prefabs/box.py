"""A rectangle."""

from typing import Unpack

from physicslab.components import Shape
from physicslab.prefabs.body import BodyOptions, Pair, body
from physicslab.world import World


def box(
    world: World, position: Pair, *, width: float = 0.5, height: float = 0.5, **options: Unpack[BodyOptions]
) -> int:
    """Spawn a rectangle of given extents [m] with its centre at ``position`` [m]; return its entity.

    Examples
    --------
    >>> world = World()
    >>> floor = box(world, (0, -0.5), width=20, height=1, static=True, name="floor")
    >>> world.component(floor, Shape).width
    20.0
    """
    return body(world, Shape.box(width, height), position, **options)
