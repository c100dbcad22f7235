"""A world in words, for who cannot see it: what is there, where it is, how it moves, and its energies."""

import math
from collections.abc import Iterator, Mapping

from physicslab.components import Charge, Gear, Mass, Medium, Shape, Spring, Transform, Velocity
from physicslab.diagnostics.energy import measure_energy, measure_momentum
from physicslab.diagnostics.scales import scales_of
from physicslab.ecs.component import Component, InvalidValue
from physicslab.ecs.vector import Vector2
from physicslab.languages.catalogue import languages
from physicslab.languages.language import Language, language
from physicslab.state.joint_rows import KINDS
from physicslab.world import World

_LISTED = 30
"""So many bodies, and so many joints, are told of; of more there is their number."""
_ZERO_SUM_SHARE = 1e-12
"""Share of what is usual in a world from which on a sum is no rounding."""
_REST = 1e-6
"""Slower than this counts as rest [m/s, rad/s]; in a slow world, than this share of what is usual there."""


def describe(world: World, code: str = "en") -> str:
    """Return a world in words, a sentence a line: the same world gives the same words.

    Parameters
    ----------
    world : World
        The world to describe at its present moment. Nothing in it changes.
    code : str
        The language, as ``"de"``.

    Raises
    ------
    InvalidValue
        If there is no such language.

    Examples
    --------
    >>> from physicslab import describe, load_scene
    >>> print(describe(load_scene("drop")).splitlines()[3])
    ball: circle of radius 0.25 m, 1 kg, at x = -3 m, y = 4 m; it moves at 1 m/s to the right.
    """
    if code not in (known := languages()):
        words = ", ".join(f'"{one}"' for one in known)
        raise InvalidValue("describe", "language", code, f"one of {words}")
    return "\n".join(_lines(world, language(code)))


def _lines(world: World, own: Language) -> Iterator[str]:
    world.synchronise()
    if world.title:
        yield own.reword(world.title)
    bodies = world.batch(Transform).entities.tolist()
    bodies.sort(key=lambda body: not world.has(body, Velocity))  # what moves comes first
    moving = sum(world.has(body, Velocity) for body in bodies)
    can_move = own.say_count("{n} body can move", "{n} bodies can move", moving)
    fixed = own.say_count("{n} is fixed", "{n} are fixed", len(bodies) - moving)
    yield own.say(
        "t = {time} s. {moving}, {fixed}.", time=_number(world.time, own), moving=can_move, fixed=fixed
    )
    yield _gravity(world, own)
    yield from _fields(world, own)
    scales = scales_of(world)
    for body in bodies[:_LISTED]:
        yield _body(world, body, own, scales)
    kinds: tuple[type[Component], ...] = (Spring, *KINDS)
    joints = [(one, kind) for kind in kinds for one in world.batch(kind).entities.tolist()]
    for entity, kind in joints[:_LISTED]:
        first, second = (end or own.say("a fixed point") for end in _ends(world, entity, kind))
        yield own.say("{kind} between {a} and {b}.", kind=own.reword(kind.__name__), a=first, b=second)
    left_out = max(len(bodies) - _LISTED, 0) + max(len(joints) - _LISTED, 0)
    if left_out:
        yield own.say_count("And {n} more.", "And {n} more.", left_out)
    energy, momentum = measure_energy(world), measure_momentum(world).linear
    yield own.say(
        "Kinetic energy {kinetic} J, potential energy {potential} J, together {total} J.",
        kinetic=_number(energy.kinetic, own, scales["J"]), total=_number(energy.total, own, scales["J"]),
        potential=_number(energy.stored, own, scales["J"]),
    )  # fmt: skip
    yield own.say(
        "Total momentum {x} kg m/s along x, {y} kg m/s along y.",
        x=_number(momentum.x, own, scales["kg m/s"]), y=_number(momentum.y, own, scales["kg m/s"]),
    )  # fmt: skip


def _ends(world: World, entity: int, kind: type[Component]) -> Iterator[str]:
    """Yield the names of both ends of a joint; empty for a point of the world."""
    for end in ("first", "second") if kind is Gear else ("a", "b"):
        body = getattr(world.component(entity, kind), end)
        if body is None and end == "a" and world.has(entity, Transform):
            body = entity
        yield "" if body is None else world.label(body)


def _gravity(world: World, own: Language) -> str:
    """Return which gravity acts."""
    physics = world.physics
    if physics.gravity_mode == "planet":
        return own.say("All bodies attract each other.")
    size = physics.gravity.magnitude
    if physics.gravity_mode == "none" or size == 0.0:
        return own.say("There is no gravity.")
    acceleration, way = _number(size, own), _way(physics.gravity, own)
    return own.say("Gravity is {size} m/s² {way}.", size=acceleration, way=way)


def _fields(world: World, own: Language) -> Iterator[str]:
    """Yield which fields act on charges, if anything is charged."""
    physics = world.physics
    electric, magnetic = physics.electric_field, physics.magnetic_field
    if not len(world.batch(Charge)):
        return
    if size := electric.magnitude:
        way = _way(electric, own)
        yield own.say("An electric field of {size} N/C points {way}.", size=_number(size, own), way=way)
    if magnetic:
        tesla = _number(abs(magnetic), own)
        out = own.say("out of the plane") if magnetic > 0.0 else own.say("into the plane")
        yield own.say("A magnetic field of {size} T points {way}.", size=tesla, way=out)


def _body(world: World, body: int, own: Language, scales: Mapping[str, float]) -> str:
    """Return what a body is, where it is, and how it moves."""
    place = world.component(body, Transform).position
    x, y = _number(place.x, own, scales["m"]), _number(place.y, own, scales["m"])
    name, shape = world.label(body), own.say("point without outline")
    if world.has(body, Shape):
        shape = _shape(world.component(body, Shape), own)
    if world.has(body, Medium):
        shape = _filled(shape, world.component(body, Medium), own)
    if world.has(body, Charge):
        charge = _number(world.component(body, Charge).charge, own)
        shape = own.say("{shape} with a charge of {charge} C", shape=shape, charge=charge)
    if not world.has(body, Velocity):
        return own.say("{name}: {shape}, fixed, at x = {x} m, y = {y} m.", name=name, shape=shape, x=x, y=y)
    mass = own.say("infinitely heavy")
    if world.has(body, Mass):
        mass = f"{_number(world.component(body, Mass).mass, own)} kg"
    motion = _motion(world.component(body, Velocity), own, scales)
    return own.say(
        "{name}: {shape}, {mass}, at x = {x} m, y = {y} m; it {motion}.",
        name=name, shape=shape, mass=mass, x=x, y=y, motion=motion,
    )  # fmt: skip


def _shape(shape: Shape, own: Language) -> str:
    """Return the kind of a shape, and its size."""
    radius, width = _number(shape.radius, own), _number(shape.width, own)
    match shape.kind:
        case "circle":
            return own.say("circle of radius {radius} m", radius=radius)
        case "box":
            return own.say("box of {width} m by {height} m", width=width, height=_number(shape.height, own))
        case "capsule":
            return own.say(
                "capsule of radius {radius} m, {length} m long", radius=radius,
                length=_number(shape.length + 2.0 * shape.radius, own),
            )  # fmt: skip
        case "chain":
            return own.say_count("chain of {n} point", "chain of {n} points", len(shape.vertices))
    return own.say_count("polygon of {n} corner", "polygon of {n} corners", len(shape.vertices))


def _filled(shape: str, medium: Medium, own: Language) -> str:
    """Return what a shape is that a fluid fills, and how that flows."""
    density, speed = _number(medium.density, own), medium.flow.magnitude
    fluid = own.say("{shape} full of a fluid of {density} kg/m²", shape=shape, density=density)
    if speed == 0.0:
        return fluid
    way = _way(medium.flow, own)
    return own.say("{fluid} that flows at {speed} m/s {way}", fluid=fluid, speed=_number(speed, own), way=way)


def _motion(velocity: Velocity, own: Language, scales: Mapping[str, float]) -> str:
    """Return how fast a body moves, where to, and how fast it turns."""
    rest, still = (_REST * min(scales[unit], 1.0) for unit in ("m/s", "rad/s"))
    speed, spin = velocity.linear.magnitude, velocity.angular
    parts = []
    if speed > rest:
        way = _way(velocity.linear, own)
        parts.append(own.say("moves at {speed} m/s {way}", speed=_number(speed, own), way=way))
    if spin > still:
        parts.append(own.say("turns at {spin} rad/s counter-clockwise", spin=_number(spin, own)))
    elif spin < -still:
        parts.append(own.say("turns at {spin} rad/s clockwise", spin=_number(-spin, own)))
    return own.say("{one} and {other}", one=parts[0], other=parts[1]) if len(parts) > 1 else (
        parts[0] if parts else own.say("is at rest")
    )  # fmt: skip


def _way(vector: Vector2, own: Language) -> str:
    """Return the direction of a vector, to an eighth of a turn."""
    ways = (
        own.say("to the right"), own.say("to the upper right"), own.say("upwards"),
        own.say("to the upper left"), own.say("to the left"), own.say("to the lower left"),
        own.say("downwards"), own.say("to the lower right"),
    )  # fmt: skip
    return ways[round(math.atan2(vector.y, vector.x) / (0.25 * math.pi)) % 8]


def _number(value: float, own: Language, scale: float = 0.0) -> str:
    """Return a number to four figures, below 1e15 in full; 0 where it is rounding beside ``scale``."""
    rounded = float(f"{value if abs(value) > _ZERO_SUM_SHARE * scale else 0.0:.4g}")
    return own.decimal(f"{rounded:.15g}")
