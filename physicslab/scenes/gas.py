"""Two thousand elastic discs between four walls."""

from physicslab import prefabs
from physicslab.ecs.config import PhysicsConfig
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_WALLS = (-12.0, -7.5, 12.0, 7.5)


@Scene(
    title="A gas of two thousand discs",
    description="Elastic, frictionless discs fill 17 % of a box; their kinetic energy should stay the same.",
    view=(-12.2, -7.7, 12.2, 7.7),
    moment=0.0,
    teaches=("heat", "collisions"),
    tags=("solid bodies", "many bodies"),
    also="temperature, pressure",
    physics=PhysicsConfig(gravity_mode="none", bounds=_WALLS, bounds_restitution=1.0, bounds_friction=0.0),
)
def gas(world: Contents) -> None:
    prefabs.gas(world, 2_000, _WALLS)
