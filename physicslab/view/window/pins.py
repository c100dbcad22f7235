"""Pins: the fixed ends of springs, which can be dragged."""

import math

import numpy as np

from physicslab.components import Spring
from physicslab.diagnostics.period import spring_state
from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.vector import Vector2
from physicslab.history import SetField
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.quantities import quantity
from physicslab.view.window.edits import Edits
from physicslab.world import World

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
