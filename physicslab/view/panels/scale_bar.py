"""How long a metre is in the picture, and coordinates along its edges."""

from __future__ import annotations

import math

import numpy as np

from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, Rect, TextStyle
from physicslab.view.canvas.quantities import round_quantity
from physicslab.view.canvas.theme import Theme
from physicslab.view.picture.backdrop import grid_spacing

__all__ = ["draw_axis_numbers", "draw_scale_bar"]


def draw_scale_bar(camera: Camera, right: int, bottom: int, size: int, canvas: Canvas, theme: Theme) -> Rect:
    """Draw a bar as long as a square of the grid is wide, in a corner at the right, and return where [px].

    Parameters
    ----------
    right : int
        Where the corner is [px from the left].
    bottom : int
        Where it ends [px from the top].
    size : int
        Height of the text [px].
    """
    length = grid_spacing(camera.scale)
    bar = length * camera.scale
    style = TextStyle(size, theme.text)
    words = round_quantity(length, "m")
    width = canvas.text_size(words, style)[0]
    pad, tick = round(0.7 * size), 4.0
    panel_width = round(max(bar, width)) + 2 * pad
    panel_height = canvas.text_size(words, style)[1] + size + round(0.7 * size) // 2
    left, top = right - round(0.8 * size) - panel_width, bottom - panel_height
    rect = (left, top, panel_width, panel_height)
    canvas.panel(rect, theme.panel, theme.outline, theme.panel_opacity)
    middle = left + panel_width // 2
    canvas.text(words, (middle, top + pad // 3), style, "centre")
    y = float(bottom - pad)
    start, end = middle - 0.5 * bar, middle + 0.5 * bar
    canvas.lines(
        np.array([(start, y), (start, y - tick), (end, y - tick)]),
        np.array([(end, y), (start, y + tick), (end, y + tick)]),
        theme.text, 2.0,
    )  # fmt: skip
    return rect


_EVERY = 2
"""One in so many lines of the grid has its number."""
_MAX_LINES = 400
"""In a picture with more lines than that, which would be a speck, none has."""


def draw_axis_numbers(camera: Camera, room: Rect, right: int, size: int, canvas: Canvas, theme: Theme) -> int:
    """Write the coordinates [m] of lines of the grid at the lower and the left edge of a room [px].

    Those at the lower edge end before ``right`` [px], where the scale bar begins. Return how high they
    are there [px].
    """
    left, top, width, height = room
    step = _EVERY * grid_spacing(camera.scale)
    low, high = camera.to_world((left, top + height)), camera.to_world((left + width, top))
    style = TextStyle(max(size - 3, 9), theme.faint)
    text_height = canvas.text_size("0", style)[1]
    for x in _multiples(low.x, high.x, step):
        place = round(camera.to_screen(Vector2(x, camera.centre.y))[0])
        words = _words(x, step)
        if left + size < place and place + canvas.text_size(words, style)[0] + size // 2 < right:
            canvas.text(words, (place + 3, top + height - text_height - 2), style)
    for y in _multiples(low.y, high.y, step):
        place = round(camera.to_screen(Vector2(camera.centre.x, y))[1])
        if top + 2 * text_height < place < top + height - 2 * text_height:
            canvas.text(_words(y, step), (left + 4, place - text_height - 1), style)
    return text_height + 2


def _multiples(low: float, high: float, step: float) -> list[float]:
    first, last = math.ceil(low / step), math.floor(high / step)
    return [] if last - first > _MAX_LINES else (step * np.arange(first, last + 1)).tolist()


def _words(value: float, step: float) -> str:
    """Return a coordinate with the digits that its neighbours differ by."""
    decimals = max(-math.floor(math.log10(step) + 1e-9), 0)
    return f"{value + 0.0:.{decimals}f}" if abs(value) < 1e6 and decimals < 7 else f"{value:g}"
