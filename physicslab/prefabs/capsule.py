"""A capsule."""

from typing import Unpack

from physicslab.components import Shape
from physicslab.prefabs.body import BodyOptions, Pair, body
from physicslab.world import World


def capsule(
    world: World, position: Pair, *, length: float = 0.5, radius: float = 0.2, **options: Unpack[BodyOptions]
) -> int:
    """Spawn a capsule, whose round ends have centres ``length`` [m] apart, at ``position`` [m].

    Returns
    -------
    entity : int
        Its middle is at ``position``, and without an angle it lies along x.

    Examples
    --------
    >>> world = World()
    >>> pill = capsule(world, (0, 2), length=1, radius=0.25)
    >>> world.component(pill, Shape).length
    1.0
    """
    return body(world, Shape.capsule(length, radius), position, **options)
