"""A cue ball and a rack of fifteen."""

import math

from physicslab.ecs.config import PhysicsConfig
from physicslab.prefabs import BodyOptions, circle
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_RADIUS = 0.15
_BALL: BodyOptions = {"mass": 0.17, "restitution": 0.95, "friction": 0.05}


@Scene(
    title="The break",
    description="A cue ball runs into a rack of fifteen, seen from above: where does its momentum go?",
    view=(-5.1, -2.6, 5.1, 2.6),
    moment=1.0,
    teaches=("momentum", "collisions", "energy"),
    tags=("solid bodies",),
    also="snooker, pool, cue",
    physics=PhysicsConfig(
        gravity_mode="none",
        bounds=(-5.0, -2.5, 5.0, 2.5),
        bounds_restitution=0.8,
        bounds_friction=0.1,
        linear_damping=0.25,
        angular_damping=0.25,
    ),
)
def billiards(world: Contents) -> None:
    circle(world, (-3.0, 0.05), radius=_RADIUS, **(_BALL | {"velocity": (8.0, 0.0), "name": "cue ball"}))
    pitch = 2.0 * _RADIUS + 0.002
    for row in range(5):
        for i in range(row + 1):
            place = (1.5 + row * pitch * math.sqrt(0.75), (i - row / 2.0) * pitch)
            circle(world, place, radius=_RADIUS, **_BALL)
