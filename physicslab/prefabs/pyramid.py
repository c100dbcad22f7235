"""A pyramid of boxes."""

from typing import Unpack

from physicslab.ecs.vector import Vector2
from physicslab.prefabs.body import BodyOptions, Pair
from physicslab.prefabs.box import box
from physicslab.world import World


def pyramid(
    world: World,
    base: int,
    foot: Pair = (0.0, 0.0),
    *,
    size: float = 1.0,
    gap: float = 0.1,
    **options: Unpack[BodyOptions],
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
    **options
        Of each box, as :class:`BodyOptions` has them, with a friction of 0.6.
    """
    options.setdefault("friction", 0.6)
    middle, pitch = Vector2(*foot), size + gap
    places = (
        middle + Vector2((i - (base - row - 1) / 2.0) * pitch, (row + 0.5) * size)
        for row in range(base)
        for i in range(base - row)
    )
    return [box(world, place, width=size, height=size, **options) for place in places]
