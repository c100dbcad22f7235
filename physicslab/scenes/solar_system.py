"""A star and five planets."""

from physicslab.ecs.config import PhysicsConfig
from physicslab.prefabs import Planet, planets
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

# Light enough that no planet deflects another: Kepler's law holds to 1e-4 for a hundred turns.
_PLANETS = (
    Planet("first", 1e-5, 0.6, 0.0),
    Planet("second", 4e-5, 1.0, 2.1),
    Planet("third", 5e-5, 1.5, 4.0),
    Planet("fourth", 2e-5, 2.2, 5.5),
    Planet("giant", 2e-4, 3.3, 1.0),
)


@Scene(
    title="A star and five planets",
    description="The squares of the periods go like the cubes of the distances: Kepler's third law.",
    view=(-3.5, -3.3, 2.5, 3.5),
    moment=12.0,
    teaches=("gravity", "circular motion"),
    tags=("planets",),
    also="sun, orbits, planets",
    physics=PhysicsConfig(gravity_mode="planet"),
)
def solar_system(world: Contents) -> None:
    planets(world, 4.0, _PLANETS)
