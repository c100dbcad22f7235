"""All keys and what they do, over the whole window."""

from __future__ import annotations

import math
from collections.abc import Sequence

from physicslab.view.canvas.canvas import Canvas, TextStyle
from physicslab.view.canvas.theme import Theme
from physicslab.view.controls.controls import Control

__all__ = ["Help"]

_TITLE = "Keys and buttons"
_FOOT = "F1 or Esc closes this"
_MAX_COLUMNS = 3


class Help:
    """A panel in the middle of the window, in as few columns as its height allows.

    Parameters
    ----------
    controls : sequence of Control
        What to show, in order.
    size : int
        Height of the text [px].
    canvas, theme : Canvas, Theme
        What it will be drawn with.
    """

    def __init__(self, controls: Sequence[Control], size: int, canvas: Canvas, theme: Theme) -> None:
        self._theme, self._size = theme, size
        self._title = TextStyle(size + 4, theme.heading, bold=True)
        self._foot = TextStyle(size, theme.faint)
        self._cap = TextStyle(size - 1, theme.text, bold=True)
        self._words = TextStyle(size, theme.text)
        self._row = canvas.text_size("Ag", self._words)[1] + size // 2
        self._head = canvas.text_size("Ag", self._title)[1] + size
        width, height = canvas.size
        room = max((height - 2 * self._head - 3 * size) // self._row, 1)
        columns = min(math.ceil(len(controls) / room), _MAX_COLUMNS)
        each = math.ceil(len(controls) / columns)
        self._columns = [controls[n : n + each] for n in range(0, len(controls), each)]
        self._labels = {control: _label(control) for control in controls}
        self._caps = [
            max(canvas.text_size(self._labels[control], self._cap)[0] for control in column) + size
            for column in self._columns
        ]
        self._widths = [
            cap + size + max(canvas.text_size(control.does, self._words)[0] for control in column)
            for cap, column in zip(self._caps, self._columns, strict=True)
        ]
        title = canvas.text_size(_TITLE, self._title)[0]
        inner = max(sum(self._widths) + 2 * size * (len(self._widths) - 1), title)
        wide, high = inner + 4 * size, 2 * self._head + each * self._row + size
        self.rect = ((width - wide) // 2, (height - high) // 2, wide, high)

    def draw(self, canvas: Canvas) -> None:
        """Draw it."""
        theme, size = self._theme, self._size
        left, top, width, height = self.rect
        canvas.panel(self.rect, theme.panel, theme.key_rim)
        canvas.text(_TITLE, (left + width // 2, top + size), self._title, "centre")
        foot = top + height - size - canvas.text_size(_FOOT, self._foot)[1]
        canvas.text(_FOOT, (left + width // 2, foot), self._foot, "centre")
        x = left + 2 * size
        for column, cap, wide in zip(self._columns, self._caps, self._widths, strict=True):
            self._draw_column(column, x, cap, canvas)
            x += wide + 2 * size

    def _draw_column(self, column: Sequence[Control], x: int, cap: int, canvas: Canvas) -> None:
        theme = self._theme
        height = self._row - self._size // 4
        cap_drop = (height - canvas.text_size("Ag", self._cap)[1]) // 2
        words_drop = (height - canvas.text_size("Ag", self._words)[1]) // 2
        for n, control in enumerate(column):
            y = self.rect[1] + self._head + self._size // 2 + n * self._row
            canvas.panel((x, y, cap, height), theme.key, theme.key_rim)
            canvas.text(self._labels[control], (x + cap // 2, y + cap_drop), self._cap, "centre")
            canvas.text(control.does, (x + cap + self._size // 2, y + words_drop), self._words)


def _label(control: Control) -> str:
    return f"{control.label}, {control.also.capitalize()}" if control.also else control.label
