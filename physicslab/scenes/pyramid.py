"""A pyramid of 465 boxes."""

from physicslab.ecs.config import PhysicsConfig
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import box, pyramid
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents


def _fill(world: Contents) -> None:
    box(world, (0, -0.5), width=100, height=1, static=True, friction=0.6, name="floor")
    pyramid(world, 30)


PYRAMID = Scene(
    name="pyramid",
    title="A pyramid of 465 boxes",
    description="Thirty rows of boxes of 1 m, a measure for contact solvers: they should not sink or spread.",
    fill=_fill,
    view=(-20.0, -1.2, 20.0, 30.5),
    moment=0.0,
    teaches=("equilibrium",),
    tags=("solid bodies", "many bodies"),
    physics=PhysicsConfig(gravity=Vector2(0.0, -10.0)),
)
