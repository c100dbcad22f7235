"""The laws of a world in words."""

from __future__ import annotations

from physicslab.systems.gravity import GravitySystem
from physicslab.world import World

__all__ = ["gravity_in_words", "has_gravity"]


def has_gravity(world: World) -> bool:
    """Whether the world has a system that applies the law of gravity; a world may be made without one."""
    return any(isinstance(system, GravitySystem) for system in world.schedule.systems)


def gravity_in_words(world: World) -> str:
    """Return the law of gravity, with its constant; "none" where no system applies it."""
    physics = world.physics
    if not has_gravity(world):
        return "none: no GravitySystem"
    if physics.gravity_mode == "none" or (physics.gravity_mode == "linear" and not physics.gravity):
        return "off"
    if physics.gravity_mode == "planet":
        return f"G = {physics.G:.4g} N m²/kg²"
    if physics.gravity.x == 0.0:
        return f"{abs(physics.gravity.y):.4g} m/s² {'down' if physics.gravity.y < 0.0 else 'up'}"
    return f"({physics.gravity.x:.3g}, {physics.gravity.y:.3g}) m/s²"
