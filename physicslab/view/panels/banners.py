"""Short words in boxes over the world: banners at the top, messages above the controls hint."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from physicslab.view.canvas.canvas import Canvas, Rect, TextStyle
from physicslab.view.canvas.theme import Colour, Theme
from physicslab.view.panels.panels import broken, draw_pill

__all__ = ["DroppedTime", "Message", "draw_banners", "draw_messages", "lay_out_messages"]

_MESSAGE_WIDTH = 0.7
"""How wide a message may be, as a share of what is left for the world: the scale bar stands beside it."""
_MIN_DROPPED = 0.005
"""Less time [s], dropped within a few seconds, cannot be noticed."""
_DROP_SHOWN = 3.0
"""How long [s] time that was dropped is shown."""


class DroppedTime:
    """Adds up the time that was dropped of late, for as long as more is dropped every few seconds."""

    def __init__(self) -> None:
        self._seen = 0.0
        self._sum = 0.0
        self._until = 0.0

    def recent(self, dropped: float, now: float) -> float:
        """Return the time dropped of late [s]; 0 where it is too little to be noticed.

        Parameters
        ----------
        dropped : float
            All the time that was ever dropped [s].
        now : float
            The time that the window has been open [s].
        """
        if dropped > self._seen:
            if now >= self._until:
                self._sum = 0.0
            self._sum += dropped - self._seen
            self._seen, self._until = dropped, now + _DROP_SHOWN
        return self._sum if now < self._until and self._sum >= _MIN_DROPPED else 0.0


def draw_banners(
    banners: Iterable[tuple[str, Colour]], middle: int, top: int, size: int, canvas: Canvas, theme: Theme
) -> list[Rect]:
    """Draw banners in their colours below each other, from ``top`` on, and return where they are [px]."""
    taken: list[Rect] = []
    for words, colour in banners:
        taken.append(draw_pill([words], middle, top, size + 2, colour, canvas, theme))
        top += size // 2 + taken[-1][3]
    return taken


@dataclass(frozen=True, slots=True)
class Message:
    """What went wrong or was just done: its lines, its colour, and how high it is [px]."""

    lines: list[str]
    colour: Colour
    height: int


def lay_out_messages(
    words: Iterable[tuple[str, Colour]], size: int, room: int, canvas: Canvas
) -> list[Message]:
    """Break messages into lines of a height [px] for a room so wide; those without words are left out."""
    messages: list[Message] = []
    for message, colour in words:
        style = TextStyle(size, colour, bold=True)
        lines = broken(message, round(_MESSAGE_WIDTH * room), canvas, style)
        if lines:
            height = canvas.text_size("Ag", style)[1] * len(lines) + round(0.55 * size)
            messages.append(Message(lines, colour, height))
    return messages


def draw_messages(
    messages: Iterable[Message], middle: int, bottom: int, size: int, canvas: Canvas, theme: Theme
) -> list[Rect]:
    """Draw messages around ``middle`` above ``bottom``, the first lowest, and return where they are [px]."""
    bottom -= size // 2
    taken: list[Rect] = []
    for message in messages:
        top = bottom - message.height
        taken.append(draw_pill(message.lines, middle, top, size, message.colour, canvas, theme))
        bottom = top - size // 2
    return taken
