"""Blocks of different friction on an inclined plane."""

import math

from physicslab.ecs.vector import Vector2
from physicslab.prefabs import box
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_ANGLE = math.radians(20.0)


@Scene(
    title="Friction on a slope",
    description="Four blocks on a slope of 20 degrees: those with a friction below tan 20 = 0.364 slide.",
    view=(-7.8, -3.4, 7.8, 3.4),
    teaches=("friction", "forces"),
    tags=("solid bodies",),
    also="ramp, inclined plane",
)
def slope(world: Contents) -> None:
    along = Vector2.from_angle(_ANGLE)
    box(world, (0, 0), width=16, height=0.5, angle=_ANGLE, static=True, friction=1, name="slope")
    for i, friction in enumerate((0.1, 0.2, 0.5, 0.8)):
        # The friction of a pair is the root of the product, and that of the slope is 1.
        place = along * (1.5 * i - 1.0) + along.perpendicular * 0.5
        box(
            world, place, width=0.8, height=0.5, angle=_ANGLE, friction=friction**2, name=f"mu = {friction:g}"
        )
