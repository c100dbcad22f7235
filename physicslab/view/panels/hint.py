"""The controls hint at the bottom of the window."""

from __future__ import annotations

from collections.abc import Sequence

from physicslab.view.canvas.canvas import Canvas, TextStyle, TextSurface
from physicslab.view.canvas.theme import Theme
from physicslab.view.controls.controls import Control

__all__ = ["Hint"]


class Hint:
    """Keys and what they do, in as few rows as the window's width allows, all about as long.

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
    rect : Rect
        What it takes up [px].
    """

    def __init__(self, controls: Sequence[Control], size: int, canvas: Canvas, theme: Theme) -> None:
        self._theme = theme
        self._cap = TextStyle(size - 1, theme.text, bold=True)
        self._words = TextStyle(size, theme.faint)
        self._pad = size // 2
        self._row = canvas.text_size("Ag", self._words)[1] + self._pad
        self._cap_widths = {c: canvas.text_size(c.label, self._cap)[0] + 2 * self._pad for c in controls}
        self._widths = {
            c: self._cap_widths[c] + self._pad + canvas.text_size(c.does, self._words)[0] for c in controls
        }
        width, height = canvas.size
        self._rows = self._break(controls, width - 3 * size)
        self._middle = width // 2
        widest = max(map(self._width, self._rows)) + 4 * self._pad
        self.top = height - len(self._rows) * self._row - 2 * self._pad
        self.rect = (self._middle - widest // 2, self.top, widest, height - self.top - self._pad // 2)

    def _width(self, row: Sequence[Control]) -> int:
        return sum(self._widths[control] for control in row) + 2 * self._pad * (len(row) - 1)

    def _break(self, controls: Sequence[Control], room: int) -> list[list[Control]]:
        """Return the controls in rows: as few as fit into ``room`` px, and then as narrow as that allows."""
        fewest = self._fill(controls, room)
        for narrower in range(self._width(controls) // len(fewest), room, 8):
            rows = self._fill(controls, narrower)
            if len(rows) == len(fewest):
                return rows
        return fewest

    def _fill(self, controls: Sequence[Control], room: int) -> list[list[Control]]:
        rows: list[list[Control]] = [[]]
        left, gap = room, 2 * self._pad
        for control in controls:
            width = self._widths[control]
            if rows[-1] and width > left:
                rows.append([])
                left = room
            rows[-1].append(control)
            left -= width + gap
        return rows

    def draw(self, canvas: Canvas) -> None:
        """Draw it, each row in the middle."""
        canvas.layer("hint", self.rect, self, self._draw_on)

    def _draw_on(self, canvas: TextSurface) -> None:
        theme, pad = self._theme, self._pad
        canvas.panel(self.rect, theme.panel, theme.outline, theme.panel_opacity)
        height = self._row - pad // 2
        cap_drop = (height - canvas.text_size("Ag", self._cap)[1]) // 2
        words_drop = (height - canvas.text_size("Ag", self._words)[1]) // 2
        for n, row in enumerate(self._rows):
            x = self._middle - self._width(row) // 2
            y = self.top + pad + n * self._row
            for control in row:
                cap = self._cap_widths[control]
                canvas.panel((x, y, cap, height), theme.key, theme.key_rim)
                canvas.text(control.label, (x + cap // 2, y + cap_drop), self._cap, "centre")
                canvas.text(control.does, (x + cap + pad, y + words_drop), self._words)
                x += self._widths[control] + 2 * pad
