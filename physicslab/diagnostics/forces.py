"""The forces that run in a world, and how fast they act."""

from __future__ import annotations

from physicslab.systems.schedule import ForceSystem
from physicslab.world import World

__all__ = ["fastest_force", "running_forces"]


def running_forces(world: World) -> list[ForceSystem]:
    """Return the force systems of a synchronised world that are not left out."""
    return [system for system in world.schedule.running if isinstance(system, ForceSystem)]


def fastest_force(world: World) -> tuple[float, ForceSystem | None]:
    """Return the fastest rate of any force in the present state [rad/s] and which; 0 and ``None`` if none."""
    with world.active():
        rates = [(system.strongest_rate(world), system) for system in running_forces(world)]
    return max(rates, key=lambda pair: pair[0], default=(0.0, None))
