"""Worlds to begin a case with, and what is looked at while they run."""

from __future__ import annotations

import math
from collections.abc import Callable

from physicslab.components import Mass, Transform, Velocity
from physicslab.diagnostics.energy import Drift, measure_energy
from physicslab.ecs.component import Component
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import box
from physicslab.systems.standard import standard_systems
from physicslab.world import World

__all__ = ["energy_change", "energy_growth", "floor", "largest", "open_space", "place", "spawn_point"]

_G = 9.81


def open_space(
    *, gravity: float | None = _G, physics: PhysicsConfig | None = None, **simulation: float | str | bool
) -> World:
    """Return a world with every physics system and nothing in it.

    Parameters
    ----------
    gravity : float, optional
        Downwards [m/s^2]; none where ``None``.
    physics : PhysicsConfig, optional
        Other laws, in place of that gravity.
    **simulation
        Fields of :class:`SimulationConfig`. Nobody sleeps unless they say so: what creeps is to be seen.
    """
    if physics is None:
        mode = "none" if gravity is None else "linear"
        physics = PhysicsConfig(gravity_mode=mode, gravity=Vector2(0.0, -(gravity or 0.0)))
    config = SimulationConfig(**{"sleeping": False, **simulation})  # type: ignore[arg-type]
    return World(*standard_systems(), physics=physics, simulation=config)


def floor(
    world: World,
    at: Vector2 = Vector2(),
    *,
    width: float = 100.0,
    friction: float = 0.6,
    restitution: float = 0.0,
) -> int:
    """Spawn a static floor, the middle of its upper side at a point [m]; return its entity."""
    middle = at + Vector2(0.0, -0.5)
    return box(
        world, middle, width=width, height=1.0, static=True, friction=friction, restitution=restitution
    )


def spawn_point(
    world: World,
    position: Vector2 | tuple[float, float],
    velocity: Vector2 | tuple[float, float] = (0.0, 0.0),
    *more: Component,
    mass: float = 1.0,
) -> int:
    """Spawn a body without extent [m], [m/s], [kg]; return its entity."""
    return world.spawn(Transform(position), Velocity(velocity), Mass(mass), *more)


def place(world: World, entity: int) -> Vector2:
    """Return where a body is [m]."""
    return world.component(entity, Transform).position


def largest(world: World, steps: int, look: Callable[[], float], every: int = 1) -> float:
    """Return the largest number seen on the way, looking after every so many steps; NaN if one was."""
    most = -math.inf
    for _ in world.stepping(steps=steps, stride=every):
        seen = look()
        if not seen <= most:
            most = seen
        if math.isnan(most):
            break
    return most


def energy_growth(world: World, steps: int, scale: float | None = None, every: int = 1) -> float:
    """Return by how much the energy rose above that at the start, at the most.

    As a share of ``scale`` [J], or of the energy at the start; where it fell it is 0.
    """
    start = measure_energy(world).total
    share = abs(start) if scale is None else scale
    return max(0.0, largest(world, steps, lambda: (measure_energy(world).total - start) / share, every))


def energy_change(world: World, steps: int, every: int = 1) -> float:
    """Return the largest departure of the energy from that at the start, as a share of it."""
    drift = Drift(world)
    for _ in world.stepping(steps=steps, stride=every):
        drift.sample(world)
    return drift.relative
