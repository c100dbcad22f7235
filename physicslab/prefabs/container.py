"""An open box to pour things into."""

from typing import Unpack

from physicslab.ecs.vector import Vector2
from physicslab.prefabs.body import BodyOptions, Pair, box
from physicslab.state.contents import Contents


def container(
    world: Contents, position: Pair = (0.0, 0.0), *, width: float, height: float, thickness: float = 1.0,
    **options: Unpack[BodyOptions],
) -> list[int]:  # fmt: skip
    """Spawn a static floor and two walls, open at the top; return their entities: floor, left, right.

    Parameters
    ----------
    position : vector
        Middle of the upper side of the floor [m].
    width, height : float
        Size of the space inside [m].
    thickness : float
        Thickness of floor and walls [m].
    **options
        Options of each, as in :class:`BodyOptions`; all are static.
    """
    middle = Vector2(*position)
    aside, up = (width + thickness) / 2.0, height / 2.0
    options["static"] = True
    below, across = middle - Vector2(0.0, thickness / 2.0), width + 2.0 * thickness
    floor = box(world, below, width=across, height=thickness, **options)
    walls = [
        box(world, middle + Vector2(x, up), width=thickness, height=height, **options)
        for x in (-aside, aside)
    ]
    return [floor, *walls]
