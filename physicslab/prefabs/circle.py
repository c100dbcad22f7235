"""A disc."""

from typing import Unpack

from physicslab.components import Shape
from physicslab.prefabs.body import BodyOptions, Pair, body
from physicslab.world import World


def circle(world: World, position: Pair, *, radius: float = 0.25, **options: Unpack[BodyOptions]) -> int:
    """Spawn a disc of a given radius [m] with its centre at ``position`` [m]; return its entity.

    Examples
    --------
    >>> world = World()
    >>> ball = circle(world, (0, 5), radius=0.1, mass=0.5, restitution=0.8, name="ball")
    >>> world.component(ball, Shape).radius
    0.1
    """
    return body(world, Shape.circle(radius), position, **options)
