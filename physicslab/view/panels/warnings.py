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
_MAX_WIDTH, _MAX_HEIGHT = 60, 0.4
"""How wide a line may be, in heights of the text, and how much of the room all of them may take: the first
stands alone where they would take more."""


def draw_advice(
    advice: Sequence[ModelWarning], middle: int, top: int, bottom: int, room: int, size: int, canvas: Canvas,
    theme: Theme, *, plainly: bool = False,
) -> Rect | None:  # fmt: skip
    """Write what is not to be trusted, around ``middle`` and no wider than ``room`` px; return where [px].

    The worst comes first, and ``plainly`` alone; what is beyond a limit comes before what has none. Without a
    warning, or room for it above ``bottom``, nothing is drawn.
    """
    if not advice:
        return None
    ordered = sorted(advice, key=lambda one: (bool(one.limit), one.excess), reverse=True)
    small = max(size - 1, 10)
    width = min(room, _MAX_WIDTH * size) - 3 * size
    style, inner = TextStyle(small, theme.warning, bold=True), max(width, 4 * size)
    told = ordered[0].told if ordered[0].entity else ordered[0].told.capitalize()
    rest = f" And {len(ordered) - 1} more." if len(ordered) > 1 else ""
    brief = broken(f"! {told}.{' More under Engineer.' if plainly else rest}", inner, canvas, style)
    lines = ["! Not to be trusted"]
    for one in ordered[:_MAX_SHOWN]:
        pieces = broken(str(one), inner, canvas, style)
        lines += [f"- {pieces[0]}", *pieces[1:]]
    if len(ordered) > _MAX_SHOWN:
        lines.append(f"and {len(ordered) - _MAX_SHOWN} more")
    if plainly or pill_height(len(lines), style, canvas) > _MAX_HEIGHT * (bottom - top):
        lines = brief
    if top + pill_height(len(lines), style, canvas) > bottom:
        return None
    return draw_pill(lines, middle, top, small, theme.warning, canvas, theme)
