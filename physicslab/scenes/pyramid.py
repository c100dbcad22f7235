"""A pyramid of 465 boxes."""

from physicslab import prefabs
from physicslab.ecs.config import PhysicsConfig
from physicslab.ecs.vector import Vector2
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents


@Scene(
    title="A pyramid of 465 boxes",
    description="Thirty rows of boxes of 1 m, a measure for contact solvers: they should not sink or spread.",
    view=(-20.0, -1.2, 20.0, 30.5),
    moment=0.0,
    teaches=("equilibrium",),
    tags=("solid bodies", "many bodies"),
    also="wall, building blocks",
    physics=PhysicsConfig(gravity=Vector2(0.0, -10.0)),
)
def pyramid(world: Contents) -> None:
    prefabs.box(world, (0, -0.5), width=100, height=1, static=True, friction=0.6, name="floor")
    prefabs.pyramid(world, 30)
