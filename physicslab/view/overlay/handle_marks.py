"""The handles of what is selected, as small discs, and the arrow of its velocity."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from physicslab.view.canvas.canvas import Canvas, Look, Rect, TextStyle
from physicslab.view.canvas.theme import Theme
from physicslab.view.overlay.arrows import VELOCITY, draw_arrows

__all__ = ["draw_handles", "draw_reading"]

_RADIUS = 5.0
"""Of a handle [px]."""

type Pixel = tuple[float, float]


def draw_handles(middle: Pixel, places: Sequence[tuple[str, Pixel]], theme: Theme, canvas: Canvas) -> None:
    """Draw handles at their places [px], each with the line that joins it to the middle of the body."""
    for kind, place in places:
        start, span = np.array([middle]), np.array([place]) - np.array([middle])
        if kind == "velocity":
            draw_arrows(start, span, VELOCITY, canvas, theme)
        elif kind == "angle":
            canvas.lines(start, start + span, theme.accent, 1.0, 0.6)
    spots = np.array([place for _, place in places])
    if len(spots):
        look = Look.plain(theme.background, theme.accent, len(spots))
        canvas.discs(spots, np.full(len(spots), _RADIUS), np.zeros(len(spots)), look)


def draw_reading(
    words: str, pointer: Pixel, size: int, theme: Theme, canvas: Canvas, room: Rect | None = None
) -> None:
    """Write words beside the cursor, within the room that is given or the picture [px]."""
    low, top_edge, across, _ = room or (0, 0, *canvas.size)
    style = TextStyle(size, theme.text, bold=True)
    width, height = canvas.text_size(words, style)
    left = max(min(round(pointer[0]) + size, low + across - width - size), low + size)
    top = max(round(pointer[1]) - 2 * size, top_edge + size)
    rect: Rect = (left - size // 2, top - size // 4, width + size, height + size // 2)
    canvas.panel(rect, theme.panel, theme.outline, 0.95)
    canvas.text(words, (left, top), style)
