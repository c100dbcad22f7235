"""A ruler: a length and an angle between two points of the world."""

from __future__ import annotations

import math

import numpy as np

from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, TextStyle
from physicslab.view.canvas.quantities import quantity
from physicslab.view.canvas.theme import Theme

__all__ = ["Ruler"]

_TICK = 6.0
"""Half the length of the strokes at its ends [px]."""
_FAR = 1e6
"""Ends farther out of the picture than this are not drawn [px]."""


class Ruler:
    """Drawn by dragging, and left where it is until another is drawn.

    Attributes
    ----------
    begin, end : Vector2, optional
        Its ends [m].
    drawing : bool
        Whether its end follows the cursor.
    """

    def __init__(self) -> None:
        self.begin: Vector2 | None = None
        self.end: Vector2 | None = None
        self.drawing = False

    def press(self, place: Vector2) -> None:
        """Begin a ruler at a place [m]."""
        self.begin = self.end = place
        self.drawing = True

    def release(self, place: Vector2) -> None:
        """End it; one without length goes."""
        self.drawing = False
        self.end = place
        if self.begin == self.end:
            self.begin = self.end = None

    @property
    def words(self) -> str:
        """Its length, the two parts of it, and its angle from the right."""
        if self.begin is None or self.end is None:
            return ""
        way = self.end - self.begin
        angle = math.degrees(way.angle) if way else 0.0
        return f"{quantity(way.magnitude, 'm')}   ({way.x:.3g}, {way.y:.3g}) m   {angle:.1f}°"

    def draw(self, camera: Camera, pointer: Vector2, size: int, theme: Theme, canvas: Canvas) -> None:
        """Draw it with its words."""
        if self.begin is None:
            return
        self.end = pointer if self.drawing else self.end
        assert self.end is not None
        ends = np.array([camera.to_screen(self.begin), camera.to_screen(self.end)])
        if not (np.abs(ends) < _FAR).all():
            return
        along = ends[1] - ends[0]
        length = float(np.hypot(*along))
        aside = np.array((-along[1], along[0])) * (_TICK / length) if length > 0.0 else np.zeros(2)
        start = np.concatenate((ends[:1], ends - aside))
        stop = np.concatenate((ends[1:], ends + aside))
        canvas.lines(start, stop, theme.accent, 2.0)
        style = TextStyle(size, theme.text, bold=True)
        width, height = canvas.text_size(self.words, style)
        left, top = round(ends[:, 0].mean()) - width // 2, round(ends[:, 1].mean()) - 2 * height
        canvas.panel((left - 6, top - 3, width + 12, height + 6), theme.panel, theme.outline, 0.95)
        canvas.text(self.words, (left, top), style)
