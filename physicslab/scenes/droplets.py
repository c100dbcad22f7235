"""Two crystals of molecules that collide and melt."""

import math

from physicslab.components import Mass, Molecule, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig
from physicslab.scenes.scene import Scene
from physicslab.state.contents import Contents

_DISTANCE, _RINGS = 0.2, 6
"""Distance of neighbours [m]; rings of molecules around the one in the middle of each crystal."""


def _crystal(world: Contents, x: float, y: float, speed: float, turn: float) -> None:
    """Spawn a hexagon of molecules, closely packed, about a point."""
    for i in range(-_RINGS, _RINGS + 1):
        for j in range(-_RINGS, _RINGS + 1):
            if abs(i + j) > _RINGS:
                continue
            u, v = _DISTANCE * (i + 0.5 * j), _DISTANCE * math.sqrt(0.75) * j
            where = x + math.cos(turn) * u - math.sin(turn) * v, y + math.sin(turn) * u + math.cos(turn) * v
            world.spawn(Transform(where), Velocity((speed, 0.0)), Mass(1.0), Molecule(1.0, _DISTANCE))


@Scene(
    title="Two crystals collide",
    description="Molecules attract their neighbours: two crystals meet, and melt into one drop.",
    view=(-4.0, -2.4, 4.0, 2.4),
    teaches=("heat", "energy"),
    tags=("many bodies",),
    also="melting, drop of water",
    physics=PhysicsConfig(gravity_mode="none"),
)
def droplets(world: Contents) -> None:
    _crystal(world, -1.8, 0.35, 1.4, 0.2)
    _crystal(world, 1.8, -0.35, -1.4, 0.6)
