"""Present forces of springs, and the period of one body on one spring."""

import math
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from physicslab.components import Charge, Drag, Mass, Molecule, Pin, Rod, Spring, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.state.attached import motion_of_point
from physicslab.state.joints import Joint
from physicslab.world import World

_STRING = 0.005
"""Share of its length by which weight stretches a spring that serves as a string of a pendulum."""
_MAX_MEANS = 60
"""Largest number of means; each doubles the number of digits."""
_AT_REST = 1e-12
"""Share of its length by which a spring may be longer or shorter and still be treated as at rest."""
_CREEPS = 1e-6
"""Share of its fastest rate below which a swing is rounding: two rates of decay that are the same."""


@dataclass(frozen=True, slots=True)
class SpringState:
    """The present state of a spring.

    Attributes
    ----------
    start, end : Vector2
        Where its ends are [m].
    length, extension : float
        How long it is, and by how much longer than at rest [m].
    force : float
        With which it pulls its ends together, its damper included [N]; negative where it pushes.
    energy : float
        Energy that it stores [J].
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
    """Return the state of a spring; ``None`` for an entity without one, or a spring without ends."""
    if not world.has(entity, Spring):
        return None
    spring = world.component(entity, Spring)
    first = spring.a or entity
    if not world.has(first, Transform):
        return None
    start, start_speed = motion_of_point(world, first, spring.anchor_a)
    end, end_speed = motion_of_point(world, spring.b, spring.anchor_b)
    way = end - start
    length = way.magnitude
    extension = length - spring.rest_length
    if abs(extension) < _AT_REST * length:
        extension = 0.0
    apart = end_speed - start_speed
    lengthening = apart.dot(way / length) if length > 0.0 else 0.0
    force = spring.stiffness * extension + spring.damping * lengthening
    return SpringState(start, end, length, extension, force, 0.5 * spring.stiffness * extension**2)


def period_of(world: World, entity: int) -> Period | None:
    """Return how long an oscillation of a body, a spring or a joint takes; ``None`` where there is none.

    One spring, rod or pin alone may hold the body, and its other end something fixed; then uniform gravity
    and what holds it are looked at, of a spring also linear drag, and no contact. A body that hardly
    stretches its spring is a pendulum, whose period follows from its amplitude and from how far the spring
    gives way.
    """
    world.synchronise()
    joints = [one for one in world.joints.joints if entity in (one.entity, *_bodies_of(world, one))]
    if joints:
        return _on_a_joint(world, joints[0]) if len(joints) == 1 else None
    holding = [entity] if world.has(entity, Spring) else _springs_at(world, entity)
    if len(holding) != 1:
        return None
    number = holding[0]
    spring = world.component(number, Spring)
    bodies = [end for end in (spring.a or number, spring.b) if end is not None and _moves(world, end)]
    joined = world.entity_index.entities[world.joints.edges]
    if spring.stiffness <= 0.0 or np.isin(bodies, joined).any():
        return None
    if not bodies or any(len(_springs_at(world, end)) > 1 for end in bodies):
        return None
    if len(bodies) == 1:
        swing = _on_a_string(world, number, bodies[0])
        if swing is not None:
            return swing if swing.seconds > 0.0 else None
    state, physics = spring_state(world, number), world.physics
    if state is None or any(_is_pulled_besides(world, end) for end in bodies):
        return None
    turns = [_turns(world, end, state) for end in bodies]
    if any(turns) and physics.gravity_mode == "linear" and physics.gravity.magnitude:
        return None  # it turns until it hangs below
    gains: defaultdict[float, float] = defaultdict(float)
    for end, turn in zip(bodies, turns, strict=True):
        mass = world.component(end, Mass).mass
        drag = world.component(end, Drag).linear / mass if world.has(end, Drag) else 0.0
        gains[drag + physics.linear_damping] += 1.0 / mass
        gains[physics.angular_damping] += turn
    rate = _rate(spring, gains)
    if rate == 0.0:
        return None  # its damper lets it creep back
    lost = spring.damping or any(decay * gain for decay, gain in gains.items())
    law = "of small oscillations along the spring" + ("" if any(turns) or lost else ": 2 pi sqrt(m / k)")
    return Period(2.0 * math.pi / rate, law)


def _rate(spring: Spring, gains: Mapping[float, float]) -> float:
    """Return the angular frequency of a spring whose ends an impulse along it moves apart [rad/s], or 0.

    ``gains`` has by how much [1/kg], for each rate at which that velocity decays by drag [1/s].
    """
    decays, gain = np.array([*gains]), np.array([*gains.values()])
    system = np.zeros((1 + len(gain), 1 + len(gain)))  # of the stretch and of these velocities
    with np.errstate(over="ignore"):
        system[0, 1:], system[1:, 0] = 1.0, -spring.stiffness * gain
        system[1:, 1:] = -spring.damping * gain[:, np.newaxis] - np.diag(decays)
    if not np.isfinite(system).all():
        return 0.0
    found = np.linalg.eigvals(system)
    rate = float(found.imag.max())
    return rate if rate > _CREEPS * float(np.abs(found).max()) else 0.0


def _turns(world: World, body: int, state: SpringState) -> float:
    """Return by how much a pull along a spring turns a body's end along it [1/kg]: r^2 / I."""
    inverse = float(world.bodies.inverse_inertia[world.entity_index.row_of[body]])
    way, place = state.end - state.start, world.component(body, Transform).position
    across = (state.start - place).cross(way) / (state.length or 1.0)
    return inverse * across * across if abs(across) > _AT_REST * state.length else 0.0


def _is_pulled_besides(world: World, body: int, *, swings: bool = False) -> bool:
    """Whether charges, fields or molecules change a body's period: a steady pull only if it ``swings``."""
    physics = world.physics
    steady = swings and physics.electric_field != Vector2()
    fields = steady or physics.magnetic_field or physics.coulomb_constant
    return world.has(body, Molecule) or (world.has(body, Charge) and bool(fields))


def _bodies_of(world: World, joint: Joint) -> list[int]:
    found: list[int] = world.entity_index.entities[[joint.a, joint.b]].tolist()
    return found


def _on_a_joint(world: World, joint: Joint) -> Period | None:
    """Return the period of a body that one rod or pin alone holds to something fixed."""
    bodies = _bodies_of(world, joint)
    moving = [body for body in bodies if body and _moves(world, body)]
    if len(moving) != 1 or _springs_at(world, moving[0]) or world.physics.gravity_mode != "linear":
        return None
    if sum(moving[0] in _bodies_of(world, one) for one in world.joints.joints) > 1:
        return None
    if _is_pulled_besides(world, moving[0], swings=True):
        return None
    (body,), part = moving, world.component(joint.entity, joint.kind)
    end = bodies.index(body)
    own, fixed = (part.anchor_a, part.anchor_b)[:: 1 if end == 0 else -1]
    pivot, speed = motion_of_point(world, bodies[1 - end] or None, fixed)
    row, place = world.entity_index.row_of[body], world.component(body, Transform).position
    arm, velocity = place - pivot, world.component(body, Velocity).linear - speed
    inertia = 0.0  # a rod at the middle does not turn it
    if joint.kind is Pin:
        inverse = float(world.bodies.inverse_inertia[row])
        inertia = (1.0 / inverse if inverse else math.inf) / world.component(body, Mass).mass
    elif joint.kind is not Rod or own:
        return None
    bounded = joint.size > (2 if joint.kind is Pin else 1)  # it has limits, or a motor
    if bounded or arm.magnitude < _AT_REST or not math.isfinite(inertia):
        return None
    length = (inertia + arm.dot(arm)) / arm.magnitude
    return _swing(world.physics.gravity, arm, arm.cross(velocity) / arm.dot(arm), length)


def _swing(pull: Vector2, arm: Vector2, rate: float, length: float, give: float = 0.0) -> Period | None:
    """Return the period of a pendulum of a reduced length [m] that turns at a rate [rad/s].

    ``None`` if it turns over, or nothing pulls it. The spring that holds it may give way by a share of its
    length: it follows the pull on it and is longer by e (c + u) of its length, e = m g / (k L), at the cosine
    c of the angle and with u = L w^2 / g. To first order in e the energy, in m g L, is
    u/2 - c + e (3/2 u^2 + u c - c^2/2), and so w^2 = 2 g/L (c - c0) (1 - e (15/2 c - 13/2 c0)).
    """
    strength = pull.magnitude
    if not strength:
        return None
    c, u = arm.dot(pull) / (arm.magnitude * strength), length * rate * rate / strength
    # If it rings about that length, the angular momentum does not: w is that without the ringing.
    u *= (arm.magnitude / (length * (1.0 + give * (c + u)))) ** 4 if give else 1.0
    energy = 0.5 * u - c + give * (1.5 * u * u + u * c - 0.5 * c * c)
    highest = -2.0 * energy / (1.0 + math.sqrt(1.0 - 2.0 * give * energy))
    if highest <= -1.0:
        return None
    first, second = _elliptic(0.5 * (1.0 - min(highest, 1.0)))
    turning = first * (1.0 - give * (3.75 + 3.25 * highest)) + 7.5 * give * second
    angle = math.degrees(math.acos(min(highest, 1.0)))
    law = f"of a pendulum that swings to {angle:.1f}° on each side"
    return Period(4.0 * math.sqrt(length / strength) * turning, law)


def _on_a_string(world: World, number: int, body: int) -> Period | None:
    """Return the period of a pendulum on a spring; 0 s if it has none; ``None`` for any other body."""
    physics, state = world.physics, spring_state(world, number)
    spring, pull = world.component(number, Spring), world.physics.gravity.magnitude
    if physics.gravity_mode != "linear" or not pull or state is None:
        return None
    stretch = world.component(body, Mass).mass * pull / spring.stiffness
    own = spring.a or number
    anchor = spring.anchor_a if own == body else spring.anchor_b
    if stretch > _STRING * spring.rest_length or anchor or state.length <= 0.0:
        return None
    if _is_pulled_besides(world, body, swings=True):
        return Period(0.0, "")
    pivot = state.end if own == body else state.start
    arm, velocity = world.component(body, Transform).position - pivot, world.component(body, Velocity).linear
    rate, length = arm.cross(velocity) / arm.dot(arm), spring.rest_length
    return _swing(physics.gravity, arm, rate, length, stretch / length) or Period(0.0, "")


def _elliptic(m: float) -> tuple[float, float]:
    """Return the complete elliptic integrals of both kinds, K(m) and E(m), for 0 <= m < 1.

    >>> [round(value, 12) for value in _elliptic(0.5)]
    [1.854074677301, 1.350643881048]
    """
    a, b, taken, power = 1.0, math.sqrt(1.0 - m), 0.5 * m, 0.5
    for _ in range(_MAX_MEANS):
        if abs(a - b) <= 1e-15 * a:
            break
        a, b, power = 0.5 * (a + b), math.sqrt(a * b), 2.0 * power
        taken += power * (a * a - b * b)
    first = 0.5 * math.pi / a
    return first, first * (1.0 - taken)


def gives_way(world: World, entity: int) -> float | None:
    """Return by how much the weight of its bodies stretches a spring that they hang from [m].

    It is that of the heavier one. ``None`` where nothing has any weight, or nothing holds it.
    """
    if not world.has(entity, Spring) or world.physics.gravity_mode != "linear":
        return None
    spring = world.component(entity, Spring)
    ends = [end for end in (spring.a or entity, spring.b) if end is not None and _moves(world, end)]
    if not ends or spring.stiffness <= 0.0:
        return None
    heaviest = max(world.component(end, Mass).mass for end in ends)
    return heaviest * world.physics.gravity.magnitude / spring.stiffness or None


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
