"""Warnings in the window: what is not to be trusted, in a few lines over the world."""

from __future__ import annotations

from collections.abc import Sequence

from physicslab.diagnostics.warnings import ModelWarning
from physicslab.view.canvas.canvas import Canvas, Rect, TextStyle
from physicslab.view.canvas.theme import Theme
from physicslab.view.panels.panels import broken, draw_pill, pill_height

__all__ = ["draw_advice"]

_MAX_SHOWN = 3
"""Of more warnings the rest is counted. All are in ``run --json``."""
_MAX_WIDTH = 60
"""How wide a line may be, in heights of the text."""


def draw_advice(
    advice: Sequence[ModelWarning], middle: int, top: int, bottom: int, room: int, size: int, canvas: Canvas,
    theme: Theme, *, plainly: bool = False,
) -> Rect | None:  # fmt: skip
    """Write what is not to be trusted, around ``middle`` and no wider than ``room`` px; return where [px].

    The worst comes first, and ``plainly`` alone, without figures. Without a warning, or room for it above
    ``bottom``, nothing is drawn.
    """
    if not advice:
        return None
    ordered = sorted(advice, key=lambda one: one.excess, reverse=True)
    small = max(size - 1, 10)
    width = min(room, _MAX_WIDTH * size) - 3 * size
    style, inner = TextStyle(small, theme.warning, bold=True), max(width, 4 * size)
    if plainly:
        worst = ordered[0]
        words = f"! {worst.entity or 'This scene'}: {worst.what}. More under Engineer."
        lines = broken(words, inner, canvas, style)
    else:
        lines = ["! Not to be trusted"]
        for one in ordered[:_MAX_SHOWN]:
            pieces = broken(str(one), inner, canvas, style)
            lines += [f"- {pieces[0]}", *pieces[1:]]
        if len(ordered) > _MAX_SHOWN:
            lines.append(f"and {len(ordered) - _MAX_SHOWN} more")
    if top + pill_height(len(lines), style, canvas) > bottom:
        return None
    return draw_pill(lines, middle, top, small, theme.warning, canvas, theme)
