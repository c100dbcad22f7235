"""A catapult with a counterweight, which throws a stone."""

import math

from physicslab.components import Layer, Pin, Trail, Weld
from physicslab.prefabs import BodyOptions, box, circle, polygon
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_AXLE, _ARM, _STONE, _WEIGHT = (-5.0, 1.8), (-0.8, 2.4), 2.1, -0.7
"""The axle; from it along the arm: its ends, where the stone lies, where the weight is held [m]."""
_FROM, _TO, _TARGET = math.radians(-145.0), math.radians(-240.0), 6.6
"""The angle of the arm at first and where it is stopped [rad]; where the tower stands [m]."""
_WOOD: BodyOptions = {"material": "wood", "restitution": 0.0}


@Scene(
    title="A catapult",
    description="The stone is three times as far from the axle as the hook: it leaves three times as fast.",
    view=(-7.9, -0.5, 9.7, 6.0),
    moment=1.0,
    teaches=("lever", "energy", "machines"),
    tags=("joints", "solid bodies"),
    also="throw, projectile",
)
def catapult(world: Contents) -> None:
    (x, y), along = _AXLE, (math.cos(_FROM), math.sin(_FROM))
    middle = 0.5 * sum(_ARM)

    def at(way: float, up: float = 0.0) -> tuple[float, float]:
        """Return a point of the world so far from the axle along the arm, and above it [m]."""
        return x + way * along[0] + up * along[1], y + way * along[1] - up * along[0]

    box(world, (0.9, -0.2), width=17.0, height=0.4, static=True, friction=0.8, name="ground")
    for side, place, high in (("left", -7.5, 0.6), ("right", 9.3, 1.6)):
        box(world, (place, 0.5 * high), width=0.2, height=high, static=True, name=f"{side} wall")
    corners = [(-0.7, 0.0), (0.7, 0.0), (0.0, y)]
    stand = polygon(world, (x, y / 3.0), corners, static=True, colour="#8a6a45", name="stand")
    world.add(stand, Layer(touches="none"))
    tilted: BodyOptions = _WOOD | {"angle": _FROM}
    arm = box(
        world, at(middle), width=_ARM[1] - _ARM[0], height=0.12, **(tilted | {"mass": 8.0, "name": "arm"})
    )
    cup = box(world, at(2.34, 0.16), width=0.1, height=0.2, **(tilted | {"mass": 0.5, "name": "cup"}))
    hook = at(_WEIGHT)
    weight = box(
        world, (hook[0], hook[1] - 0.35), width=0.7, height=0.7, mass=90.0, material="steel", restitution=0.0,
        name="weight",
    )  # fmt: skip
    stone = circle(
        world, at(_STONE, 0.2), radius=0.14, mass=4.0, material="stone", restitution=0.3, name="stone"
    )
    world.add(stone, Trail(3.0))
    world.spawn(Pin(None, arm, _AXLE, (-middle, 0.0), lower=_TO, upper=_FROM), name="axle")
    world.spawn(Pin(arm, weight, (_WEIGHT - middle, 0.0), (0.0, 0.35)), name="hook")
    world.spawn(Weld(arm, cup, (2.34 - middle, -0.16)))
    for n in range(3):
        box(world, (_TARGET, 0.3 + 0.6 * n), width=0.6, height=0.6, **(_WOOD | {"mass": 5.0}))
