"""Worlds for the labs to begin with, and what is measured while they run."""

import math
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import TypedDict

from physicslab.components import Mass, Transform, Velocity
from physicslab.diagnostics.energy import Audit, measure_energy
from physicslab.ecs.component import Component
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import box, circle
from physicslab.prefabs.body import Pair
from physicslab.stepping.rigid import Rigid
from physicslab.systems.standard import standard_systems
from physicslab.world import World

GRAVITY = 9.81
"""Gravity of the built-in scenes, downwards [m/s^2]."""
PLANETS = PhysicsConfig(gravity_mode="planet", softening_law="plummer")
"""Bodies attract each other with G = 1."""


class Surface(TypedDict):
    """Friction and restitution that several bodies have."""

    friction: float
    restitution: float


def empty_world(
    simulation: SimulationConfig, physics: PhysicsConfig | None = None, *, gravity: float | None = GRAVITY
) -> World:
    """Return a world with every physics system and nothing in it.

    Parameters
    ----------
    physics : PhysicsConfig, optional
        The laws; where none are given, gravity alone.
    gravity : float, optional
        Downwards [m/s^2]; none where ``None``.
    """
    if physics is None:
        mode = "none" if gravity is None else "linear"
        physics = PhysicsConfig(gravity_mode=mode, gravity=Vector2(0.0, -(gravity or 0.0)))
    return World(*standard_systems(), physics=physics, simulation=simulation)


def open_space(
    *, gravity: float | None = GRAVITY, physics: PhysicsConfig | None = None, **simulation: float | str | bool
) -> World:
    """Return an empty world in which nothing sleeps unless ``sleeping`` is given, so that creep is seen.

    Parameters
    ----------
    gravity, physics
        As of :func:`empty_world`.
    **simulation
        Fields of :class:`SimulationConfig`.
    """
    config = SimulationConfig(**{"sleeping": False, **simulation})  # type: ignore[arg-type]
    return empty_world(config, physics, gravity=gravity)


soft_space = partial(open_space, collisions="step", contacts="soft")
"""Returns such a world with soft contacts, found within steps."""


def floor(
    world: World, at: Vector2 = Vector2(), *, width: float = 100.0, friction: float = 0.6,
    restitution: float = 0.0,
) -> int:  # fmt: skip
    """Spawn a static floor, the middle of its upper side at a point [m]; return its entity."""
    surface = Surface(friction=friction, restitution=restitution)
    return box(world, at + Vector2(0.0, -0.5), width=width, height=1.0, static=True, **surface)


def spawn_point(
    world: World, position: Pair, velocity: Pair = (0.0, 0.0), *more: Component, mass: float = 1.0,
    name: str | None = None,
) -> int:  # fmt: skip
    """Spawn a body without extent [m], [m/s], [kg]; return its entity."""
    return world.spawn(Transform(position), Velocity(velocity), Mass(mass), *more, name=name)


def spawn_bob(world: World, at: Pair, velocity: Pair = (0.0, 0.0), *, touches: bool, part: Component) -> int:
    """Spawn a body of 1 kg that a component acts on [m], [m/s]; return its entity.

    It is a point; where ``touches``, a disc in a world with a floor that it is never near.
    """
    if touches:
        floor(world, Vector2(0.0, -20.0))
        bob = circle(world, at, radius=0.1, velocity=velocity)
    else:
        bob = spawn_point(world, at, velocity)
    world.add(bob, part)
    return bob


def place(world: World, body: int | str) -> Vector2:
    """Return where a body is [m], by its entity or its name."""
    return world.component(world.entity(body) if isinstance(body, str) else body, Transform).position


def velocity(world: World, body: int | str) -> Vector2:
    """Return how a body moves [m/s], by its entity or its name."""
    return world.component(world.entity(body) if isinstance(body, str) else body, Velocity).linear


def steps_not_rigid(*worlds: World) -> tuple[int, int]:
    """Return how many steps of worlds with rigid contacts were left to soft ones, and made by impulses."""
    usable = (stepper for world in worlds for part in world.parts for stepper in part.steppers.usable)
    rigid = [stepper for stepper in usable if isinstance(stepper, Rigid)]
    return sum(stepper.left_to_soft for stepper in rigid), sum(stepper.by_impulses for stepper in rigid)


def largest(world: World, steps: int, look: Callable[[], float], every: int = 1) -> float:
    """Return the largest number that ``look`` returns after every so many steps; NaN if it returns one."""
    found = -math.inf
    for _ in world.stepping(steps=steps, stride=every):
        seen = look()
        if not seen <= found:
            found = seen
        if math.isnan(found):
            break
    return found


def displacements(world: World, bodies: Sequence[int], advance: Callable[[], object]) -> list[Vector2]:
    """Return how far each body is displaced [m] while the world is advanced."""
    starts = [place(world, body) for body in bodies]
    advance()
    return [place(world, body) - start for body, start in zip(bodies, starts, strict=True)]


def energy_growth(world: World, steps: int, scale: float | None = None) -> float:
    """Return the largest rise of the energy above that at the start; 0 where it only fell.

    As a share of ``scale`` [J], or of the energy at the start.
    """
    start = measure_energy(world).total
    share = abs(start) if scale is None else scale
    return max(0.0, largest(world, steps, lambda: (measure_energy(world).total - start) / share))


def energy_change(world: World, moves: Iterable[object]) -> float:
    """Return the largest change of the energy, whatever caused it, as a share of what is exchanged.

    It is looked at whenever ``moves``, which advances the world, yields.
    """
    audit = Audit(world)
    for _ in moves:
        audit.sample(world)
    return audit.change
