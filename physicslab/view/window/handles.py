"""The handles of the selection: size, angle and velocity, to be dragged while paused."""

import math
from dataclasses import dataclass
from typing import Literal

from physicslab.components import Shape, Transform, Velocity
from physicslab.components.shape import KINDS
from physicslab.components.vertices import centred
from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.quantities import quantity
from physicslab.view.window.edits import Edits
from physicslab.world import World

type Kind = Literal["size", "angle", "velocity"]

_CATCH = 9.0
"""How near to a handle a press need be [px]."""
_ABOVE = 26.0
"""How far above a body the handle of its angle is [px]."""
_VELOCITY = 3.0
"""Speed that a metre of the arrow of the velocity stands for [m/s]."""
_MIN_ARROW = 22.0
"""Length of the arrow of a body at rest, so that it can be caught [px]."""
_SNAP_ANGLE, _SNAP_SIZE = math.pi / 12.0, 0.1
"""Steps of angles [rad] and sizes [m] while Shift is held."""
_MIN_SIZE = 0.01
"""The smallest size that a handle gives [m]."""


@dataclass(frozen=True, slots=True)
class Handle:
    """One handle: what it changes, and where it is [m]."""

    kind: Kind
    place: Vector2


class Handles:
    """The handles of one body, and the one that is being dragged.

    Attributes
    ----------
    dragged : str, optional
        The quantity that the held handle changes.
    words : str
        The number that it has given, to stand beside the cursor.
    """

    def __init__(self) -> None:
        self.dragged: Kind | None = None
        self.words = ""

    @staticmethod
    def of(world: World, entity: int, camera: Camera) -> list[Handle]:
        """Return the handles of a body."""
        if not world.has(entity, Transform):
            return []
        transform = world.component(entity, Transform)
        found = []
        if world.has(entity, Shape):
            corner = _corner(world, entity)
            found.append(Handle("size", transform.position + corner.rotated(transform.angle)))
            shape = world.component(entity, Shape)
            up = max(corner.y for corner in shape.core) + shape.rounding + _ABOVE / camera.scale
            found.append(Handle("angle", transform.position + Vector2(0.0, up).rotated(transform.angle)))
        if world.has(entity, Velocity):
            found.append(Handle("velocity", transform.position + arrow_of(world, entity, camera)))
        return found

    def press(self, world: World, entity: int, camera: Camera, pixel: tuple[float, float]) -> bool:
        """Take the handle under the cursor; return whether there is one."""
        for handle in reversed(self.of(world, entity, camera)):
            x, y = camera.to_screen(handle.place)
            if math.hypot(x - pixel[0], y - pixel[1]) <= _CATCH:
                self.dragged, self.words = handle.kind, ""
                return True
        return False

    def drag(self, edits: Edits, entity: int, camera: Camera, place: Vector2, *, snaps: bool) -> None:
        """Let the handle follow the cursor, which is at a point of the world [m]."""
        world = edits.world
        if self.dragged is None or not world.has(entity, Transform):
            self.dragged = None
            return
        transform = world.component(entity, Transform)
        offset = place - transform.position
        try:
            if self.dragged == "velocity":
                self._pull(edits, entity, camera, offset)
            elif self.dragged == "angle":
                angle = offset.angle - 0.5 * math.pi
                angle = round(angle / _SNAP_ANGLE) * _SNAP_ANGLE if snaps else angle
                edits.show(entity, Transform, "angle", angle)
                self.words = f"{math.degrees(angle):.1f}°"
            else:
                self._resize(edits, entity, offset.rotated(-transform.angle), snaps)
        except InvalidValue as error:
            self.words = f"must be {error.allowed}"

    def release(self, edits: Edits) -> None:
        """Let go of the handle: what it has changed becomes one edit."""
        if self.dragged is not None:
            edits.keep()
        self.dragged, self.words = None, ""

    def _pull(self, edits: Edits, entity: int, camera: Camera, offset: Vector2) -> None:
        resting = _MIN_ARROW / camera.scale
        length = offset.magnitude
        velocity = offset * (_VELOCITY * (length - resting) / length) if length > resting else Vector2()
        edits.show(entity, Velocity, "linear", velocity)
        self.words = quantity(velocity.magnitude, "m/s")

    def _resize(self, edits: Edits, entity: int, corner: Vector2, snaps: bool) -> None:
        """Make a body as large as its corner says; what it weighs stays."""
        shape, sizes = edits.world.component(entity, Shape), {}
        kind = KINDS[shape.kind]
        if kind.own[1]:
            size = _size(corner.magnitude, snaps)
            factor = size / _corner(edits.world, entity).magnitude
            larger = tuple(factor * one for one in shape.vertices)
            edits.show(entity, Shape, "vertices", larger if kind.part else centred(larger, shape.radius))
            self.words = f"{size:.3g} m"
            return
        if kind.radius:
            sizes[kind.radius] = abs(corner.y) if kind.x else corner.magnitude
        for axis, name in enumerate((kind.x, kind.y)):
            if name:  # what both axes have in common goes by the one along which the corner is farther
                size = abs((corner.x, corner.y)[axis]) / max(abs(place[axis]) for place in kind.core)
                sizes[name] = max(size, sizes.get(name, 0.0))
        sizes = {name: _size(size, snaps) for name, size in sizes.items()}
        for name, size in sizes.items():
            edits.show(entity, Shape, name, size)
        values = [f"{size:.3g} m" for size in sizes.values()]
        self.words = " x ".join(values) if len(values) > 1 else f"radius {quantity(size, 'm')}"


def arrow_of(world: World, entity: int, camera: Camera) -> Vector2:
    """Return where the handle of a body's velocity is from its middle [m]: never too near to be caught."""
    velocity = world.component(entity, Velocity).linear
    speed, resting = velocity.magnitude, _MIN_ARROW / camera.scale
    if speed == 0.0:
        return Vector2(resting, 0.0)
    return velocity * ((speed / _VELOCITY + resting) / speed)


def _corner(world: World, entity: int) -> Vector2:
    shape = world.component(entity, Shape)
    if len(shape.core) == 1:
        return Vector2.from_angle(-0.25 * math.pi, shape.radius)
    if KINDS[shape.kind].part:
        return max(shape.vertices, key=lambda vertex: vertex.magnitude)
    right, low = max(corner.x for corner in shape.core), min(corner.y for corner in shape.core)
    return Vector2(right, low - shape.rounding)


def _size(length: float, snaps: bool) -> float:
    return max(round(length / _SNAP_SIZE) * _SNAP_SIZE if snaps else length, _MIN_SIZE)
