"""What would be made at the cursor, as thin outlines."""

from __future__ import annotations

import math

import numpy as np

from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, Numbers, Points
from physicslab.view.canvas.theme import Colour

__all__ = ["draw_cursor", "draw_ghost"]

_CORNERS = 40
"""Straight lines that a circle is drawn as."""
_OPACITY = 0.65
_ARM = 9.0
"""Length of the arms of the cross that shows the cursor [px]."""


def draw_cursor(pixel: tuple[float, float], colour: Colour, canvas: Canvas) -> None:
    """Draw a cross where the cursor is that keys move."""
    arms = np.array(((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)))
    canvas.lines(pixel + 0.3 * _ARM * arms, pixel + _ARM * arms, colour, 1.6)


def draw_ghost(
    place: Points,
    half: Points,
    radius: Numbers,
    angle: Numbers,
    colour: Colour,
    camera: Camera,
    canvas: Canvas,
) -> None:
    """Draw the outlines of discs (with a radius) and boxes (with half extents), a row each [m]."""
    turn = np.arange(_CORNERS) * (2.0 * math.pi / _CORNERS)
    round_ = np.stack((np.cos(turn), np.sin(turn)), axis=1)
    square = np.array(((-1, -1), (1, -1), (1, 1), (-1, 1)), np.float64)
    for n in range(len(place)):
        own = radius[n] * round_ if radius[n] > 0.0 else half[n] * square
        c, s = math.cos(angle[n]), math.sin(angle[n])
        corners = camera.project(own @ np.array(((c, s), (-s, c))) + place[n])
        canvas.lines(corners, np.roll(corners, -1, axis=0), colour, 1.4, _OPACITY)
