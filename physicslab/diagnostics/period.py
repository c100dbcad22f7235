"""What springs do now, and how long an oscillation takes, where one body swings on one spring."""

from __future__ import annotations

import math
from dataclasses import dataclass

from physicslab.components import Mass, Spring, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.world import World

__all__ = ["Period", "SpringState", "period_of", "spring_state"]

_STRING = 0.005
"""Share of its length by which weight stretches a spring that is a string: what hangs on it is a pendulum."""
_HALVES = 60
_ROUNDING = 1e-12
"""Share of its length by which a spring is no longer than at rest."""


@dataclass(frozen=True, slots=True)
class SpringState:
    """What a spring does at this moment.

    Attributes
    ----------
    start, end : Vector2
        Where its ends are [m].
    length, extension : float
        How long it is, and by how much longer than at rest [m].
    force : float
        With which it pulls its ends together, its damper included [N]; negative where it pushes.
    energy : float
        What it stores [J].
    """

    start: Vector2
    end: Vector2
    length: float
    extension: float
    force: float
    energy: float


@dataclass(frozen=True, slots=True)
class Period:
    """How long an oscillation takes [s], and by which law that was found."""

    seconds: float
    law: str


def spring_state(world: World, entity: int) -> SpringState | None:
    """Return what a spring does; of an entity without one, or one that is held by nothing, ``None``."""
    if not world.has(entity, Spring):
        return None
    spring = world.component(entity, Spring)
    first = spring.a or entity
    if not world.has(first, Transform):
        return None
    start, start_speed = _end(world, first, spring.anchor_a)
    end, end_speed = _end(world, spring.b, spring.anchor_b)
    way = end - start
    length = way.magnitude
    extension = length - spring.rest_length
    if abs(extension) < _ROUNDING * length:
        extension = 0.0
    apart = end_speed - start_speed
    lengthening = apart.dot(way / length) if length > 0.0 else 0.0
    force = spring.stiffness * extension + spring.damping * lengthening
    return SpringState(start, end, length, extension, force, 0.5 * spring.stiffness * extension**2)


def period_of(world: World, entity: int) -> Period | None:
    """Return how long an oscillation of a body or a spring takes; ``None`` where there is none.

    One spring alone may hold the body, and its other end something fixed; then uniform gravity and the spring
    are looked at, and no other force and no contact. A body that its weight hardly stretches the spring of is
    a pendulum, whose period follows from its amplitude (by the arithmetic-geometric mean).
    """
    holding = [entity] if world.has(entity, Spring) else _springs_at(world, entity)
    if len(holding) != 1:
        return None
    number = holding[0]
    spring = world.component(number, Spring)
    bodies = [end for end in (spring.a or number, spring.b) if end is not None and _moves(world, end)]
    if spring.stiffness <= 0.0 or not bodies or any(len(_springs_at(world, end)) > 1 for end in bodies):
        return None
    mass = 1.0 / sum(1.0 / world.component(end, Mass).mass for end in bodies)
    if len(bodies) == 1:
        swing = _pendulum(world, number, bodies[0], mass)
        if swing is not None:
            return swing if swing.seconds > 0.0 else None
    rate = spring.stiffness / mass - (0.5 * spring.damping / mass) ** 2
    if rate <= 0.0:
        return None  # its damper lets it creep back
    return Period(2.0 * math.pi / math.sqrt(rate), "of small oscillations along the spring: 2 pi sqrt(m / k)")


def _pendulum(world: World, number: int, body: int, mass: float) -> Period | None:
    """Return the period of a pendulum; 0 s where it turns over; ``None`` where the body is none."""
    physics, state = world.physics, spring_state(world, number)
    spring, pull = world.component(number, Spring), world.physics.gravity.magnitude
    if physics.gravity_mode != "linear" or not pull or state is None:
        return None
    stretch = mass * pull / spring.stiffness
    own = spring.a or number
    anchor = spring.anchor_a if own == body else spring.anchor_b
    if stretch > _STRING * spring.rest_length or anchor or state.length <= 0.0:
        return None
    pivot = state.end if own == body else state.start
    arm = world.component(body, Transform).position - pivot
    length, speed = spring.rest_length + stretch, world.component(body, Velocity).linear.magnitude
    highest = arm.dot(physics.gravity) / (arm.magnitude * pull) - speed**2 / (2.0 * pull * length)
    if highest <= -1.0:
        return Period(0.0, "")
    half = 0.5 * math.acos(min(highest, 1.0))
    seconds = 2.0 * math.pi * math.sqrt(length / pull) / _mean(1.0, math.cos(half))
    return Period(seconds, f"of a pendulum that swings to {math.degrees(2.0 * half):.1f}° on each side")


def _mean(a: float, b: float) -> float:
    """Return the arithmetic-geometric mean of two numbers above 0.

    >>> round(_mean(1.0, 2.0**0.5), 12)
    1.198140234736
    """
    for _ in range(_HALVES):
        if abs(a - b) <= 1e-15 * a:
            break
        a, b = 0.5 * (a + b), math.sqrt(a * b)
    return a


def _moves(world: World, entity: int) -> bool:
    return all(world.has(entity, kind) for kind in (Transform, Velocity, Mass))


def _springs_at(world: World, body: int) -> list[int]:
    """Return the entities with a spring that ends at a body."""
    springs = world.batch(Spring)
    table, own = world.table(Spring), springs.entities
    a, b = table["a"][springs.rows], table["b"][springs.rows]
    held = (a == body) | ((a == 0) & (own == body)) | (b == body)
    found: list[int] = own[held].tolist()
    return found


def _end(world: World, body: int | None, anchor: Vector2) -> tuple[Vector2, Vector2]:
    """Return where an end of a spring is [m], and how it moves [m/s]."""
    if body is None or not world.has(body, Transform):
        return anchor, Vector2()
    transform = world.component(body, Transform)
    arm = anchor.rotated(transform.angle)
    speed = Vector2()
    if world.has(body, Velocity):
        velocity = world.component(body, Velocity)
        speed = velocity.linear + velocity.angular * arm.perpendicular
    return transform.position + arm, speed
