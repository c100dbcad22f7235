"""How fast the forces of a world act."""

from __future__ import annotations

from physicslab.systems.system import ForceSystem
from physicslab.world import World

__all__ = ["fastest_force"]


def fastest_force(world: World) -> tuple[float, ForceSystem | None]:
    """Return the fastest rate of any force in the present state [rad/s] and which; 0 and ``None`` if none."""
    with world.active():
        rates = [(system.strongest_rate(world), system) for system in world.schedule.forces]
    return max(rates, key=lambda pair: pair[0], default=(0.0, None))
