"""Springs drawn with the mouse, from a body to another or to a point of the world."""

from __future__ import annotations

import math

import numpy as np

from physicslab.components import Mass, Shape, Spring, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, Look
from physicslab.view.canvas.theme import Theme
from physicslab.world import World

__all__ = ["SpringTool"]

_FREQUENCY = 2.0
"""How fast two bodies swing on a new spring [Hz]: soft enough to be seen, stiff enough to carry them."""
_DAMPING_RATIO = 0.05
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
        self.entity, self._anchor = entity, _local(world, entity, place)

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
        inverse = _inverse_mass(world, entity) + (_inverse_mass(world, target) if target is not None else 0.0)
        if inverse == 0.0:
            return "No spring: neither of its ends could move"
        anchor = place if target is None else _local(world, target, place)
        end = place if target is None else _place(world, target, anchor)
        rate = 2.0 * math.pi * _FREQUENCY
        return Spring(
            a=entity, b=target, anchor_a=self._anchor, anchor_b=anchor, rest_length=(end - start).magnitude,
            stiffness=rate * rate / inverse, damping=2.0 * _DAMPING_RATIO * rate / inverse,
        )  # fmt: skip

    def draw(
        self, world: World, camera: Camera, pointer: tuple[float, float], theme: Theme, canvas: Canvas
    ) -> None:
        """Draw where the spring would be: a dashed line from the body to the cursor [px]."""
        start = self._start(world)
        if start is None:
            return
        ends = np.array([camera.to_screen(start), pointer])
        if not (np.abs(ends) < 1e6).all():
            return
        length = float(np.hypot(*(ends[1] - ends[0])))
        count = max(round(0.5 * length / _DASH), 1)
        share = np.arange(2 * count, dtype=np.float64)[:, None] / max(2 * count - 1, 1)
        corners = ends[0] + share * (ends[1] - ends[0])
        canvas.lines(corners[0::2], corners[1::2], theme.accent, 2.0)
        canvas.discs(ends, np.full(2, _END), np.zeros(2), Look.plain(theme.accent, theme.accent, 2))

    def _start(self, world: World) -> Vector2 | None:
        """Return where the spring begins [m]; nowhere if its body is gone."""
        if self.entity is not None and not world.has(self.entity, Transform):
            self.entity = None
        return None if self.entity is None else _place(world, self.entity, self._anchor)


def _local(world: World, entity: int, place: Vector2) -> Vector2:
    """Return a point of the world in a body's own frame [m]; one without Shape has its middle alone."""
    if not world.has(entity, Shape):
        return Vector2()
    transform = world.component(entity, Transform)
    return (place - transform.position).rotated(-transform.angle)


def _place(world: World, entity: int, anchor: Vector2) -> Vector2:
    transform = world.component(entity, Transform)
    return transform.position + anchor.rotated(transform.angle)


def _inverse_mass(world: World, entity: int) -> float:
    """Return 1 / mass [1/kg]; a body in the hand counts with the mass it will have."""
    if not (world.has(entity, Mass) and world.has(entity, Velocity)):
        return 0.0
    return 1.0 / world.component(entity, Mass).mass
