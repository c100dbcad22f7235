"""Springs drawn with the mouse, from a body to another or to a point of the world."""

import math

import numpy as np

from physicslab.components import Mass, Spring, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.canvas import Look
from physicslab.view.canvas.drawing import Drawing
from physicslab.view.overlay.arrows import even_dashes
from physicslab.view.window.points import local_point, point_of
from physicslab.world import World

_FREQUENCY = 2.0
"""How fast two bodies swing on a new spring [Hz]: soft enough to be seen, stiff enough to carry them."""
_DAMPING_RATIO = 0.05
_ROD_STRETCH, _EARTH = 1e-4, 9.81
"""Share of its length by which the weight of the heavier body on the Earth [m/s^2] stretches a rod."""
_DASH = 9.0
"""Length of a dash of the preview [px]."""
_END = 4.0
"""Radius of the discs at the ends of the preview [px]."""


class SpringTool:
    """A spring in the making: it is begun on a body, and ended on another or in empty space.

    Attributes
    ----------
    entity : int, optional
        The body it was begun on; ``None`` while there is none.
    """

    def __init__(self) -> None:
        self.entity: int | None = None
        self._anchor = Vector2()

    def begin(self, world: World, entity: int, place: Vector2) -> None:
        """Begin a spring on a body, where a point of the world [m] is on it."""
        self.entity, self._anchor = entity, local_point(world, entity, place)

    def cancel(self) -> None:
        """Forget what was begun."""
        self.entity = None

    def end(self, world: World, target: int | None, place: Vector2) -> Spring | str:
        """Return the spring, as long at rest as it is now, or why there is none.

        Parameters
        ----------
        target : int, optional
            The body at the other end; a fixed point of the world where there is none.
        place : Vector2
            Where the other end is [m].
        """
        start = self._start(world)
        entity, self.entity = self.entity, None
        if entity is None or start is None or target == entity:
            return ""
        return spring_between(world, entity, target, (start, place))

    def draw(self, world: World, on: Drawing, pointer: tuple[float, float]) -> None:
        """Draw where the spring would be: a dashed line from the body to the cursor [px]."""
        start = self._start(world)
        if start is None:
            return
        ends = np.array([on.camera.to_screen(start), pointer])
        if not (np.abs(ends) < 1e6).all():
            return
        on.canvas.lines(*even_dashes(ends[0], ends[1], _DASH), on.theme.accent, 2.0)
        on.canvas.discs(ends, np.full(2, _END), np.zeros(2), Look.plain(on.theme.accent, on.theme.accent, 2))

    def _start(self, world: World) -> Vector2 | None:
        """Return where the spring begins [m]; nowhere if its body is gone."""
        if self.entity is not None and not world.has(self.entity, Transform):
            self.entity = None
        return None if self.entity is None else point_of(world, self.entity, self._anchor)


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
