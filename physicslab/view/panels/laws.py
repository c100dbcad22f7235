"""The laws of a world in words."""

from __future__ import annotations

import numpy as np

from physicslab.components import Mass, Spring, Transform, Velocity
from physicslab.systems.gravity import GravitySystem
from physicslab.world import World

__all__ = ["energy_changers", "gravity_in_words", "has_gravity"]


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


def energy_changers(world: World) -> list[str]:
    """Return what changes the energy of a world by law; where it is nothing, any change is an error."""
    found = []
    if world.plan.collisions != "none":
        found.append("impacts and friction")
    rows = world.batch(Spring).rows
    if np.any(world.table(Spring)["damping"][rows]):
        found.append("dampers")
    if world.physics.linear_damping or world.physics.angular_damping:
        found.append("damping")
    forces = world.schedule.forces
    found += [force.name.removesuffix("System").lower() for force in forces if force.potential is None]
    moving = world.batch(Transform, Velocity).rows
    if not world.table(Mass).present[moving].all():
        found.append("bodies that are driven")
    return found
