"""Lines that show where what is moved or made has snapped."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, Look
from physicslab.view.canvas.theme import Theme

__all__ = ["draw_snap_marks"]

_OPACITY = 0.75
_DOT = 3.5
"""Radius of the disc at the middle of what has snapped [px]."""


def draw_snap_marks(
    marks: Sequence[tuple[int, float]], middle: Vector2, camera: Camera, theme: Theme, canvas: Canvas
) -> None:
    """Draw a line across the picture for each mark, and a disc at the middle of what has snapped [m].

    A mark is an axis (0 for x, 1 for y) and the coordinate along it [m].
    """
    width, height = camera.size
    x, y = camera.to_screen(middle)
    for axis, at in marks:
        across, down = camera.to_screen(Vector2(at, at))
        start, end = ((across, 0), (across, height)) if axis == 0 else ((0, down), (width, down))
        canvas.lines(np.array([start], np.float64), np.array([end], np.float64), theme.accent, 1.0, _OPACITY)
    look = Look.plain(theme.accent, theme.accent, 1)
    canvas.discs(np.array([(x, y)]), np.full(1, _DOT), np.zeros(1), look)
