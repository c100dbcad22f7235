"""How fast the forces of a world act."""

from __future__ import annotations

from physicslab.systems.system import ForceSystem
from physicslab.world import World

__all__ = ["fastest_force"]


def fastest_force(world: World) -> tuple[float, ForceSystem | None]:
    """Return the fastest rate of any force [rad/s] and which; 0 and ``None`` if there is none.

    It is the one of the present state, or the fastest within steps since the motion was last edited, where
    the force measures that: a close passage between two looks counts.
    """
    met = world.fastest_rates
    with world.active():
        rates = [
            (max(system.strongest_rate(world), met.get(system.name, 0.0)), system)
            for system in world.schedule.forces
        ]
    return max(rates, key=lambda pair: pair[0], default=(0.0, None))
