"""Numbers as people think of them: length and angle of a pendulum, the angle of a slope, a throw."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from physicslab.components import Rod, Rope, Shape, Spring, Transform, Velocity
from physicslab.components.slope import Slope, find_slope
from physicslab.ecs.vector import Vector2
from physicslab.history import Command, SetField
from physicslab.state.attached import point_of
from physicslab.world import World

_LENGTHS: dict[type[Any], str] = {Rod: "length", Rope: "length", Spring: "rest_length"}
"""The field of the length of a pendulum's link."""


def way_of(length: float, degrees: float) -> Vector2:
    """Return a vector of a length in a direction [deg], exact where that is along an axis.

    >>> way_of(2.0, 180.0), way_of(1.0, -90.0)
    (Vector2(x=-2.0, y=0.0), Vector2(x=0.0, y=-1.0))
    """
    way = Vector2.from_angle(math.radians(degrees), length)
    if not length or math.remainder(degrees, 90.0):
        return way
    return Vector2(*(round(part / length) * length + 0.0 for part in way))


class Hanging(NamedTuple):
    """A body that one rod, rope or spring holds by its middle to a fixed point.

    Attributes
    ----------
    body, link : int
        The body, and the entity that carries its link.
    kind : type
        Which component that is.
    pivot, arm : Vector2
        The fixed point, and the way from there to the body [m].
    """

    body: int
    link: int
    kind: type[Any]
    pivot: Vector2
    arm: Vector2

    @property
    def angle(self) -> float:
        """The angle from straight down, counter-clockwise [rad]."""
        return math.remainder(self.arm.angle + 0.5 * math.pi, 2.0 * math.pi)


def hanging_of(world: World, body: int) -> Hanging | None:
    """Return how a body hangs, if it does as a pendulum."""
    found = [one for kind in _LENGTHS for one in _links(world, body, kind)]
    return found[0] if len(found) == 1 and found[0].arm else None


def _links(world: World, body: int, kind: type[Any]) -> list[Hanging]:
    found = []
    for entity in world.batch(kind).entities.tolist():
        part = world.component(entity, kind)
        a = part.a or (entity if world.has(entity, Transform) else None)
        ends = ((a, part.anchor_a), (part.b, part.anchor_b))
        for (own, anchor), (other, fixed) in (ends, ends[::-1]):
            is_fixed = other is None or not world.has(other, Velocity)
            if own == body and is_fixed and not anchor and world.has(body, Velocity):
                pivot = point_of(world, other, fixed)
                arm = point_of(world, body, anchor) - pivot
                found.append(Hanging(body, entity, kind, pivot, arm))
    return found


def hang(world: World, hanging: Hanging, length: float, angle: float) -> list[Command]:
    """Return what gives a pendulum a length [m] and an angle from straight down [rad].

    Its velocity turns with it.
    """
    arm, body = way_of(length, math.degrees(angle) - 90.0), hanging.body
    commands: list[Command] = [SetField(body, "Transform", "position", hanging.pivot + arm)]
    velocity = world.component(body, Velocity).linear
    if velocity:
        turned = velocity.rotated(arm.angle - hanging.arm.angle)
        commands.append(SetField(body, "Velocity", "linear", turned))
    name = _LENGTHS[hanging.kind]
    before = hanging.arm.magnitude
    if length != before:
        held = getattr(world.component(hanging.link, hanging.kind), name)
        commands.append(SetField(hanging.link, hanging.kind.__name__, name, held + (length - before)))
    return commands


def slope_of(world: World, body: int) -> Slope | None:
    """Return the slope of a ramp; ``None`` for anything else."""
    return find_slope({type(part): part for part in world.components(body)})


def incline(world: World, body: int, slope: Slope, angle: float) -> Sequence[Command]:
    """Return what makes a ramp as steep as an angle [rad]; its foot and the length of its slope stay."""
    way = slope.top - slope.foot
    rise = Vector2.from_angle(angle, way.magnitude)
    top = slope.foot + Vector2(math.copysign(rise.x, way.x), math.copysign(rise.y, way.y))
    corners = [slope.foot, Vector2(top.x, slope.foot.y), top]
    shape = Shape.polygon(corners if (corners[1] - corners[0]).cross(way) > 0.0 else corners[::-1])
    first = corners[0] if (corners[1] - corners[0]).cross(way) > 0.0 else corners[-1]
    return [
        SetField(body, "Shape", "vertices", list(shape.vertices)),
        SetField(body, "Transform", "position", first - shape.vertices[0]),
    ]
