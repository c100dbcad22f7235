"""A tower."""

from typing import Unpack

from physicslab.ecs.vector import Vector2
from physicslab.prefabs.body import BodyOptions, Pair
from physicslab.prefabs.box import box
from physicslab.world import World


def stack(
    world: World,
    count: int,
    base: Pair = (0.0, 0.0),
    *,
    width: float = 1.0,
    height: float = 1.0,
    gap: float = 0.0,
    **options: Unpack[BodyOptions],
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
    **options
        Of each box, as :class:`BodyOptions` has them, with a friction of 0.6.
    """
    options.setdefault("friction", 0.6)
    foot = Vector2(*base)
    places = (foot + Vector2(0.0, height / 2.0 + i * (height + gap)) for i in range(count))
    return [box(world, place, width=width, height=height, **options) for place in places]
