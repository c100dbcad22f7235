"""Springs by hand: between a body and another or a point of the world, and dragged by their pins."""

import math

import numpy as np

from physicslab.components import Mass, Shape, Spring, Transform, Velocity
from physicslab.contacts.outlines import outlines_of
from physicslab.diagnostics.period import spring_state
from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.vector import Vector2
from physicslab.history import SetField
from physicslab.state.attached import local_point as in_frame
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.quantities import quantity
from physicslab.view.window.edits import Edits
from physicslab.world import World

# ---- points of bodies: in a frame of their own, and in the world -------------------------------------------


def point_of(world: World, body: int | None, anchor: Vector2) -> Vector2:
    """Return where a point in a body's frame is in the world [m]; without a body it is one of the world."""
    if body is None or not world.has(body, Transform):
        return anchor
    transform = world.component(body, Transform)
    return transform.position + anchor.rotated(transform.angle)


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


_FREQUENCY = 2.0
"""How fast two bodies swing on a new spring [Hz]: soft enough to be seen, stiff enough to carry them."""
_DAMPING_RATIO = 0.05
_ROD_STRETCH, _EARTH = 1e-4, 9.81
"""Share of its length by which the weight of the heavier body on the Earth [m/s^2] stretches a rod."""


def spring_between(
    world: World, one: int, other: int | None, places: tuple[Vector2, Vector2], *, stiff: bool = False
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
    stiff : bool
        Whether weight hardly stretches it, so that it serves as a rod.
    """
    inverse = _inverse_mass(world, one) + (_inverse_mass(world, other) if other is not None else 0.0)
    if inverse == 0.0:
        return "No spring: neither of its ends could move"
    start, end = (local_point(world, body, place) for body, place in zip((one, other), places, strict=True))
    length = (point_of(world, other, end) - point_of(world, one, start)).magnitude
    if length == 0.0:
        return "No spring: its ends are at one place"
    rate = 2.0 * math.pi * _FREQUENCY
    stiffness, damping = rate * rate / inverse, 2.0 * _DAMPING_RATIO * rate / inverse
    if stiff:
        inverses = (_inverse_mass(world, end) for end in (one, other) if end is not None)
        heaviest = max(1.0 / part for part in inverses if part > 0.0)
        stiffness, damping = rod_stiffness(heaviest, length), 0.0
    return Spring(
        a=one, b=other, anchor_a=start, anchor_b=end, rest_length=length,
        stiffness=stiffness, damping=damping,
    )  # fmt: skip


def rod_stiffness(mass: float, length: float) -> float:
    """Return the stiffness [N/m] of a spring that serves as a rod for a mass [kg]."""
    return mass * _EARTH / (_ROD_STRETCH * length)


def _inverse_mass(world: World, entity: int) -> float:
    """Return 1 / mass [1/kg]; a body in the hand counts with the mass it will have."""
    if not (world.has(entity, Mass) and world.has(entity, Velocity)):
        return 0.0
    return 1.0 / world.component(entity, Mass).mass


# ---- pins: the fixed ends, which can be dragged ------------------------------------------------------------


_CATCH = 8.0
"""How near to a pin a press need be [px]."""


def pin_at(world: World, camera: Camera, pixel: tuple[float, float]) -> int | None:
    """Return the entity of the spring whose fixed end is under the cursor [px], or ``None``."""
    springs = world.batch(Spring)
    table = world.table(Spring)
    fixed = table["b"][springs.rows] == 0
    if not fixed.any():
        return None
    pins = camera.project(table["anchor_b"][springs.rows[fixed]])
    with np.errstate(all="ignore"):
        distance = np.hypot(pins[:, 0] - pixel[0], pins[:, 1] - pixel[1])
    nearest = int(np.argmin(distance))
    return int(springs.entities[fixed][nearest]) if distance[nearest] <= _CATCH else None


class Pins:
    """The pin in the hand.

    Attributes
    ----------
    dragged : int, optional
        The entity of its spring.
    words : str
        How long the spring is, to stand beside the cursor.
    """

    def __init__(self) -> None:
        self.dragged: int | None = None
        self.words = ""

    def drag(self, edits: Edits, place: Vector2, *, paused: bool) -> None:
        """Let the pin follow the cursor, which is at a point of the world [m]."""
        world, entity = edits.world, self.dragged
        if entity is None:
            return
        if not world.has(entity, Spring) or world.component(entity, Spring).b is not None:
            self.dragged = None
            return
        if not all(map(math.isfinite, (place.x, place.y))):
            return
        try:
            if paused:
                edits.show(entity, Spring, "anchor_b", place)
            elif world.component(entity, Spring).anchor_b != place:
                edits.write(SetField(entity, Spring.__name__, "anchor_b", place))
        except InvalidValue as error:
            self.words = f"must be {error.allowed}"
            return
        state = spring_state(world, entity)
        self.words = (
            "" if state is None else f"{quantity(state.length, 'm')}, {quantity(abs(state.force), 'N')}"
        )

    def release(self, edits: Edits) -> None:
        """Let go of the pin: where it was dragged while time stood still, that becomes one edit."""
        if self.dragged is not None:
            edits.keep()
        self.dragged, self.words = None, ""
