"""Text in panels: lines of a label and a figure, and remarks that are broken to fit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from physicslab.view.canvas.canvas import Canvas, Rect, TextStyle
from physicslab.view.canvas.drawable_text import MAX_LETTERS, shortened
from physicslab.view.canvas.theme import Colour, Theme

__all__ = ["Line", "broken", "draw_pill", "pill_height", "pill_margin", "text_size"]

type Kind = Literal["heading", "figure", "detail", "remark", "gap"]


@dataclass(frozen=True, slots=True)
class Line:
    """One line of a panel.

    Attributes
    ----------
    label, value : str
        The words at the left, and those at the right.
    kind : str
        ``"heading"``; ``"figure"``; ``"detail"``, a lesser figure; ``"remark"``, words that may take several
        lines; ``"gap"``, some space.
    """

    label: str = ""
    value: str = ""
    kind: Kind = "figure"


def text_size(canvas: Canvas, scale: float = 1.0) -> int:
    """Return the height of text [px]: larger in a larger window, times a scale that was chosen."""
    width, height = canvas.size
    return round(min(max(min(height / 48, width / 80), 12), 20) * scale)


def broken(words: str, width: int, canvas: Canvas, style: TextStyle) -> list[str]:
    """Break words into lines no wider than ``width`` px; a word that is too long by itself is cut.

    Text beyond ``MAX_LETTERS`` is left out.
    """
    lines: list[str] = []
    line = ""
    for word in shortened(words, MAX_LETTERS).split():
        longer = f"{line} {word}" if line else word
        if canvas.text_size(longer, style)[0] <= width:
            line = longer
            continue
        if line:
            lines.append(line)
        line = word
        while canvas.text_size(line, style)[0] > width and len(line) > 1:
            cut = _fitting(line, width, canvas, style)
            lines.append(line[:cut])
            line = line[cut:]
    return [*lines, line] if line else lines


def _fitting(word: str, width: int, canvas: Canvas, style: TextStyle) -> int:
    """Return how many letters of a word fit into ``width`` px, and one where none does."""
    fits, too_long = 1, len(word)
    while too_long - fits > 1:
        middle = (fits + too_long) // 2
        if canvas.text_size(word[:middle], style)[0] <= width:
            fits = middle
        else:
            too_long = middle
    return fits


def pill_margin(size: int) -> int:
    """Return how much wider a box is than the words in it [px], for text of a height [px]."""
    return 4 * round(0.55 * size)


def pill_height(lines: int, style: TextStyle, canvas: Canvas) -> int:
    """Return how high a box around so many lines is [px]."""
    return canvas.text_size("Ag", style)[1] * lines + round(0.55 * style.size)


def draw_pill(
    words: Sequence[str], middle: int, top: int, size: int, colour: Colour, canvas: Canvas, theme: Theme
) -> Rect:
    """Draw lines of words in a box around ``middle``, and return where it is [px]."""
    style = TextStyle(size, colour, bold=True)
    pad = round(0.55 * size)
    widths = [canvas.text_size(line, style)[0] for line in words]
    line_height = canvas.text_size("Ag", style)[1]
    width, height = max(widths) + pill_margin(size), line_height * len(words) + pad
    rect = (middle - width // 2, top, width, height)
    canvas.panel(rect, theme.panel, colour, 0.95)
    for n, line in enumerate(words):
        canvas.text(line, (middle, top + pad // 2 + n * line_height), style, "centre")
    return rect
