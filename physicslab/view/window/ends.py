"""Points of bodies and of the world; springs between two, and their fixed ends, which are dragged."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from physicslab.components import Mass, Rod, Rope, Shape, Spring, Transform, Velocity
from physicslab.contacts.outlines import outlines_of
from physicslab.diagnostics.period import spring_state
from physicslab.ecs.component import Component
from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.vector import Vector2
from physicslab.history import SetField
from physicslab.state.attached import local_point as in_frame
from physicslab.state.attached import point_of
from physicslab.state.joint_rows import KINDS
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.quantities import quantity
from physicslab.view.window.edits import Edits
from physicslab.world import World

# ---- points of bodies: in a frame of their own, and in the world -------------------------------------------


def local_point(world: World, body: int | None, place: Vector2) -> Vector2:
    """Return a point of the world in a body's frame [m]: if it is not on the body, the body's middle."""
    if body is None or not world.has(body, Transform):
        return place
    local = in_frame(world, body, place)
    if not world.has(body, Shape):
        return Vector2()
    row = np.array([world.entity_index.row_of[body]])
    inside = outlines_of(world, row).gaps(place.x, place.y)[0] <= 0.0
    return local if inside else Vector2()


# ---- springs -----------------------------------------------------------------------------------------------


STUCK = "neither of its ends could move. Planks and walls are fixed; a beam or a box moves"
"""Why a spring or a joint would be of no use."""
_FREQUENCY = 2.0
"""How fast two bodies swing on a new spring [Hz]: soft enough to be seen, stiff enough to carry them."""
_DAMPING_RATIO = 0.05


def spring_between(
    world: World, one: int, other: int | None, places: tuple[Vector2, Vector2]
) -> Spring | str:
    """Return a spring that is at rest now, or why there is none.

    Parameters
    ----------
    one : int
        The body at its beginning.
    other : int, optional
        The body at its end; a fixed point of the world where there is none.
    places : two Vector2
        Where its ends are [m].
    """
    inverse = _inverse_mass(world, one) + (_inverse_mass(world, other) if other is not None else 0.0)
    if inverse == 0.0:
        return f"No spring: {STUCK}"
    start, end = (local_point(world, body, place) for body, place in zip((one, other), places, strict=True))
    length = (point_of(world, other, end) - point_of(world, one, start)).magnitude
    if length == 0.0:
        return "No spring: its ends are at one place"
    rate = 2.0 * math.pi * _FREQUENCY
    stiffness, damping = rate * rate / inverse, 2.0 * _DAMPING_RATIO * rate / inverse
    return Spring(
        a=one, b=other, anchor_a=start, anchor_b=end, rest_length=length,
        stiffness=stiffness, damping=damping,
    )  # fmt: skip


def _inverse_mass(world: World, entity: int) -> float:
    """Return 1 / mass [1/kg]; a body in the hand counts with the mass it will have."""
    if not (world.has(entity, Mass) and world.has(entity, Velocity)):
        return 0.0
    return 1.0 / world.component(entity, Mass).mass


# ---- pins: the fixed ends, which can be dragged ------------------------------------------------------------


_CATCH = 8.0
"""How near to a pin a press need be [px]."""


type Held = tuple[int, type[Any]]
"""An entity, and which of its components has the fixed end."""
_KINDS: tuple[type[Any], ...] = (Spring, Rod, Rope)
"""Components with a fixed end that can be dragged."""


def pin_at(world: World, camera: Camera, pixel: tuple[float, float]) -> Held | None:
    """Return the spring, the rod or the rope whose fixed end is under the cursor [px], or ``None``."""
    best, found = _CATCH, None
    for kind in _KINDS:
        links, table = world.batch(kind), world.table(kind)
        fixed = table["b"][links.rows] == 0
        if not fixed.any():
            continue
        pins = camera.project(table["anchor_b"][links.rows[fixed]])
        with np.errstate(all="ignore"):
            distance = np.hypot(pins[:, 0] - pixel[0], pins[:, 1] - pixel[1])
        nearest = int(np.argmin(distance))
        if distance[nearest] <= best:
            best, found = float(distance[nearest]), (int(links.entities[fixed][nearest]), kind)
    return found


class Pins:
    """The pin in the hand.

    Attributes
    ----------
    dragged : tuple of int and component type, optional
        The entity of its spring, rod or rope, and which of these it is.
    words : str
        How long that is, to stand beside the cursor.
    """

    def __init__(self) -> None:
        self.dragged: Held | None = None
        self.words = ""

    def drag(self, edits: Edits, place: Vector2, *, paused: bool) -> None:
        """Let the pin follow the cursor, which is at a point of the world [m]."""
        world = edits.world
        if self.dragged is None:
            return
        entity, kind = self.dragged
        if not world.has(entity, kind) or world.component(entity, kind).b is not None:
            self.dragged = None
            return
        if not all(map(math.isfinite, (place.x, place.y))):
            return
        part = world.component(entity, kind)
        try:
            if paused:
                edits.show(entity, kind, "anchor_b", place)
                gap = _gap(world, entity, part)
                if kind is Rod or (kind is Rope and gap > part.length):
                    edits.show(entity, kind, "length", gap)  # as placed: nothing is to jump
            elif part.anchor_b != place:
                edits.write(SetField(entity, kind.__name__, "anchor_b", place))
        except InvalidValue as error:
            self.words = f"must be {error.allowed}"
            return
        self.words = quantity(_gap(world, entity, part), "m")
        if kind is Spring and (state := spring_state(world, entity)) is not None:
            self.words += f", {quantity(abs(state.force), 'N')}"

    def release(self, edits: Edits) -> None:
        """Let go of the pin: where it was dragged while time stood still, that becomes one edit."""
        if self.dragged is not None:
            edits.keep()
        self.dragged, self.words = None, ""


def _gap(world: World, entity: int, part: Any) -> float:
    """Return the distance of the ends of a spring, a rod or a rope whose second end is fixed [m]."""
    end: Vector2 = part.anchor_b
    return (end - point_of(world, part.a or entity, part.anchor_a)).magnitude


_BODY_OF = {"anchor_a": "a", "anchor_b": "b", "wheel_a": "", "wheel_b": ""}
"""The points of springs and joints, and the field with the body that each is on; wheels are on none."""


def brought(
    parts: Sequence[Component], number: Mapping[int, int], offset: Vector2 = Vector2()
) -> list[Component]:
    """Return copies of the components of an entity, at an offset [m], that name others by new numbers."""
    is_body, found = any(isinstance(part, Transform) for part in parts), []
    for part in parts:
        given = part.given()
        if isinstance(part, Transform):
            given["position"] = part.position + offset
        elif isinstance(part, (Spring, *KINDS)):
            for point, end in _BODY_OF.items():
                if point in given and given.get(end) is None and not (end == "a" and is_body):
                    given[point] = given[point] + offset
            named = (spec.name for spec in part.FIELDS if spec.kind == "entity")
            given |= {end: number[given[end]] for end in named if given[end] is not None}
        found.append(type(part)(**given))
    return found
