"""An open box to pour things into."""

from __future__ import annotations

from physicslab.ecs.vector import Vector2
from physicslab.prefabs.body import Pair
from physicslab.prefabs.box import box
from physicslab.world import World

__all__ = ["container"]


def container(
    world: World,
    position: Pair = (0.0, 0.0),
    *,
    width: float,
    height: float,
    thickness: float = 1.0,
    restitution: float = 0.0,
    friction: float = 0.5,
) -> list[int]:
    """Spawn a static floor and two walls, open at the top; return their entities: floor, left, right.

    Parameters
    ----------
    position : vector
        Middle of the upper side of the floor [m].
    width, height : float
        Of the space inside [m].
    thickness : float
        Of floor and walls [m].
    restitution, friction : float
        Their material.
    """
    middle = Vector2(*position)
    aside, up = (width + thickness) / 2.0, height / 2.0
    floor = box(
        world, middle - Vector2(0.0, thickness / 2.0), width=width + 2.0 * thickness, height=thickness,
        restitution=restitution, friction=friction, static=True,
    )  # fmt: skip
    walls = [
        box(
            world,
            middle + Vector2(x, up),
            width=thickness,
            height=height,
            restitution=restitution,
            friction=friction,
            static=True,
        )
        for x in (-aside, aside)
    ]
    return [floor, *walls]
