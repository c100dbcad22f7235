"""What the window shows while kernels are compiled."""

from __future__ import annotations

from physicslab.view.canvas import Canvas, TextStyle
from physicslab.view.theme import Theme

__all__ = ["draw_progress"]

_WIDTH, _HEIGHT = 460, 14


def draw_progress(canvas: Canvas, theme: Theme, share: float, remark: str) -> None:
    """Draw a bar filled to a share (0 to 1), what it is about, and a remark."""
    width, height = canvas.size
    bar = min(_WIDTH, width - 80)
    left, top, middle = (width - bar) // 2, height // 2, width // 2
    canvas.clear(theme.background)
    canvas.text("PhysicsLab", (middle, top - 110), TextStyle(34, theme.heading, bold=True), "centre")
    first = "First start: compiling the physics for this computer."
    canvas.text(first, (middle, top - 50), TextStyle(16, theme.text), "centre")
    canvas.panel((left, top, bar, _HEIGHT), theme.panel, theme.outline)
    canvas.panel((left, top, round(bar * share), _HEIGHT), theme.accent, theme.accent)
    canvas.text(remark, (middle, top + 28), TextStyle(14, theme.faint), "centre")
    again = "This is done once and kept. Esc quits."
    canvas.text(again, (middle, top + 56), TextStyle(14, theme.faint), "centre")
