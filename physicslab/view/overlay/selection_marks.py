"""Outlines around what is selected."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape, Transform
from physicslab.diagnostics.period import spring_state
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas
from physicslab.view.canvas.theme import Colour, Theme
from physicslab.view.picture.bodies import POINT_RADIUS
from physicslab.world import World

__all__ = ["draw_band", "draw_selection"]

_GAP = 4.0
"""Between a body and the line around it [px]."""
_CORNERS = 48
"""Straight lines that a circle is drawn as."""
_WIDTH = 2.0
_SPRING_WIDTH = 9.0
"""Of the band along a spring [px]."""
_FAR = 1e6
"""What is farther out of the picture than this is not drawn [px]."""


def draw_selection(
    world: World,
    entities: Sequence[int],
    camera: Camera,
    theme: Theme,
    canvas: Canvas,
    colour: Colour | None = None,
) -> None:
    """Draw a line around each body, or along a spring; in a colour, or that of what is selected."""
    for entity in entities:
        if world.has(entity, Transform):
            corners = camera.project(_outline(world, entity, _GAP / camera.scale))
            canvas.lines(corners, np.roll(corners, -1, axis=0), colour or theme.accent, _WIDTH)
        elif (spring := spring_state(world, entity)) is not None:
            ends = camera.project(np.array([tuple(spring.start), tuple(spring.end)]))
            if (np.abs(ends) < _FAR).all():
                canvas.lines(ends[:1], ends[1:], colour or theme.accent, _SPRING_WIDTH, 0.5)


def draw_band(
    corner: tuple[float, float], pointer: tuple[float, float], theme: Theme, canvas: Canvas
) -> None:
    """Draw the rectangle that is being drawn around bodies, from its corner to the cursor [px]."""
    (x0, y0), (x1, y1) = corner, pointer
    corners = np.array(((x0, y0), (x1, y0), (x1, y1), (x0, y1)), np.float64)
    canvas.lines(corners, np.roll(corners, -1, axis=0), theme.accent, 1.0, 0.8)


def _outline(world: World, entity: int, gap: float) -> NDArray[np.float64]:
    """Return the corners of the line around a body (n, 2) [m]."""
    transform = world.component(entity, Transform)
    shape = world.component(entity, Shape) if world.has(entity, Shape) else None
    if shape is not None and shape.kind == "box":
        half = np.array((0.5 * shape.width + gap, 0.5 * shape.height + gap))
        corners = half * np.array(((-1, -1), (1, -1), (1, 1), (-1, 1)), np.float64)
    else:
        radius = (POINT_RADIUS / 100.0 if shape is None else shape.radius) + gap
        angles = np.arange(_CORNERS) * (2.0 * math.pi / _CORNERS)
        corners = radius * np.stack((np.cos(angles), np.sin(angles)), axis=1)
    c, s = math.cos(transform.angle), math.sin(transform.angle)
    place = np.array((transform.position.x, transform.position.y))
    turned: NDArray[np.float64] = corners @ np.array(((c, s), (-s, c))) + place
    return turned
