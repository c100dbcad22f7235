"""A star and five planets."""

from physicslab.ecs.config import PhysicsConfig
from physicslab.prefabs import Planet, planets
from physicslab.scenes.scene import Scene
from physicslab.world import World

__all__ = ["SOLAR_SYSTEM"]

_PLANETS = (
    Planet("first", 0.001, 0.6, 0.0),
    Planet("second", 0.004, 1.0, 2.1),
    Planet("third", 0.005, 1.5, 4.0),
    Planet("fourth", 0.002, 2.2, 5.5),
    Planet("giant", 0.02, 3.3, 1.0),
)


def _fill(world: World) -> None:
    planets(world, 4.0, _PLANETS)


SOLAR_SYSTEM = Scene(
    name="solar_system",
    title="A star and five planets",
    description="The squares of the periods go like the cubes of the distances: Kepler's third law.",
    fill=_fill,
    view=(-3.5, -3.3, 2.5, 3.5),
    physics=PhysicsConfig(gravity_mode="planet"),
)
