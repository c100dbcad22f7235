"""Two planets on elliptic orbits."""

from physicslab.ecs.config import PhysicsConfig
from physicslab.prefabs import binary
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents


@Scene(
    title="Two planets",
    description="Two planets on ellipses about their centre of mass; their total momentum stays zero.",
    view=(-2.2, -2.2, 3.8, 2.2),
    moment=4.0,
    teaches=("gravity", "momentum"),
    tags=("planets",),
    also="orbits, moon",
    physics=PhysicsConfig(gravity_mode="planet"),
)
def two_planets(world: Contents) -> None:
    # Point masses: without Shapes, nothing has to be searched for contacts.
    binary(world, (6.0, 3.0), separation=5.0, eccentricity=0.5, names=("heavy", "light"))
