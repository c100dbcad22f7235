"""The controls hint at the bottom of the window."""

from __future__ import annotations

from collections.abc import Sequence

from physicslab.view.canvas import Canvas, TextStyle
from physicslab.view.controls import Control
from physicslab.view.theme import Theme

__all__ = ["Hint"]


class Hint:
    """Keys and what they do, in as few rows as the window's width allows.

    Parameters
    ----------
    controls : sequence of Control
        What to show, in order.
    size : int
        Height of the text [px].
    canvas, theme : Canvas, Theme
        What it will be drawn with.

    Attributes
    ----------
    top : int
        Where it begins [px from the top].
    """

    def __init__(self, controls: Sequence[Control], size: int, canvas: Canvas, theme: Theme) -> None:
        self._theme = theme
        self._cap = TextStyle(size - 1, theme.text, bold=True)
        self._words = TextStyle(size, theme.faint)
        self._pad = size // 2
        self._row = canvas.text_size("Ag", self._words)[1] + self._pad
        width, height = canvas.size
        room = width - 2 * size
        self._rows: list[list[tuple[int, Control]]] = [[]]
        self._widths: list[int] = []
        x = 0
        for control in controls:
            wide = self._width(control, canvas)
            if x + wide > room and self._rows[-1]:
                self._widths.append(x - 2 * self._pad)
                self._rows.append([])
                x = 0
            self._rows[-1].append((x, control))
            x += wide + 2 * self._pad
        self._widths.append(x - 2 * self._pad)
        self._width_px = width
        self.top = height - len(self._rows) * self._row - self._pad

    def _cap_width(self, control: Control, canvas: Canvas) -> int:
        return canvas.text_size(control.label, self._cap)[0] + 2 * self._pad

    def _width(self, control: Control, canvas: Canvas) -> int:
        return self._cap_width(control, canvas) + self._pad + canvas.text_size(control.does, self._words)[0]

    def draw(self, canvas: Canvas) -> None:
        """Draw it, each row in the middle."""
        theme = self._theme
        for n, row in enumerate(self._rows):
            left = (self._width_px - self._widths[n]) // 2
            y = self.top + n * self._row
            for x, control in row:
                cap = self._cap_width(control, canvas)
                height = self._row - self._pad // 2
                canvas.panel((left + x, y, cap, height), theme.key, theme.key_rim)
                drop = (height - canvas.text_size("Ag", self._cap)[1]) // 2
                canvas.text(control.label, (left + x + cap // 2, y + drop), self._cap, "centre")
                drop = (height - canvas.text_size("Ag", self._words)[1]) // 2
                canvas.text(control.does, (left + x + cap + self._pad, y + drop), self._words)
