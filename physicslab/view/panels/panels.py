"""Text in panels: lines of a label and a figure, and remarks that are broken to fit."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

from physicslab.view.canvas.canvas import Canvas, Rect, TextStyle, TextSurface
from physicslab.view.canvas.drawable_text import MAX_LETTERS, shortened
from physicslab.view.canvas.theme import Colour, Theme

__all__ = ["Line", "Panel", "broken", "draw_pill", "lay_out", "pill_height", "pill_margin", "text_size"]

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


@dataclass(frozen=True, slots=True)
class Panel:
    """Text laid out and ready to be drawn.

    Attributes
    ----------
    rect : Rect
        What it takes up on the screen [px].
    texts : tuple
        Words, place of their top left or top right [px], style, and on which side that is.
    """

    rect: Rect
    texts: tuple[tuple[str, tuple[int, int], TextStyle, Literal["left", "right"]], ...]

    def draw(self, canvas: TextSurface, theme: Theme) -> None:
        """Draw the panel with its text."""
        canvas.panel(self.rect, theme.panel, theme.outline, theme.panel_opacity)
        for words, place, style, side in self.texts:
            canvas.text(words, place, style, side)

    def show(self, name: str, canvas: Canvas, theme: Theme) -> None:
        """Draw it as a picture that is kept under a name."""
        canvas.layer(name, self.rect, (self, theme), lambda surface: self.draw(surface, theme))


def text_size(canvas: Canvas, scale: float = 1.0) -> int:
    """Return the height of text [px]: larger in a larger window, times a scale that was chosen."""
    width, height = canvas.size
    return round(min(max(min(height / 48, width / 80), 12), 20) * scale)


def broken(words: str, width: int, canvas: Canvas, style: TextStyle) -> list[str]:
    """Break words into lines no wider than ``width`` px; a word that is too long by itself is cut.

    Of text beyond ``MAX_LETTERS`` the rest is left out.
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


def _styles(kind: Kind, size: int, theme: Theme) -> tuple[TextStyle, TextStyle]:
    small = max(size - 2, 10)
    match kind:
        case "heading":
            return TextStyle(size, theme.heading, bold=True), TextStyle(small, theme.faint)
        case "detail":
            return TextStyle(small, theme.faint), TextStyle(small, theme.faint)
        case "remark":
            return TextStyle(small, theme.faint), TextStyle(small, theme.faint)
        case _:
            return TextStyle(size, theme.faint), TextStyle(size, theme.text)


def lay_out(
    lines: Iterable[Line], left: int, top: int, width: int, size: int, canvas: Canvas, theme: Theme
) -> Panel:
    """Lay lines out in a panel of a given place, width and text size [px]; its height follows."""
    pad = round(0.7 * size)
    inner = width - 2 * pad
    y = top + pad
    texts: list[tuple[str, tuple[int, int], TextStyle, Literal["left", "right"]]] = []
    for line in lines:
        if line.kind == "gap":
            y += size // 2
            continue
        style, value_style = _styles(line.kind, size, theme)
        room = inner - canvas.text_size(line.value + "  ", value_style)[0] if line.value else inner
        height = canvas.text_size("Ag", style)[1]
        if line.value:
            drop = height - canvas.text_size("Ag", value_style)[1]
            texts.append((line.value, (left + width - pad, y + drop), value_style, "right"))
        pieces = broken(line.label, max(room, 1), canvas, style)
        indent = size if line.kind == "detail" else 0
        for piece in pieces:
            texts.append((piece, (left + pad + indent, y), style, "left"))
            y += height
        y += height if not pieces else 0
    return Panel((left, top, width, y + pad - top), tuple(texts))


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
