"""How long a metre is in the picture."""

from __future__ import annotations

import numpy as np

from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, Rect, TextStyle
from physicslab.view.canvas.quantities import length_of
from physicslab.view.canvas.theme import Theme
from physicslab.view.picture.backdrop import grid_spacing

__all__ = ["draw_scale_bar"]


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
    words = length_of(length)
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
