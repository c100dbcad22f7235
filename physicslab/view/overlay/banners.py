"""Short words in boxes over the world: banners and warnings at the top, messages at the bottom."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from physicslab.diagnostics.warnings import ModelWarning
from physicslab.languages.sentence import proper
from physicslab.theme import Colour
from physicslab.view.canvas.camera import Drawing
from physicslab.view.canvas.canvas import Canvas, Rect, TextStyle, overlap
from physicslab.view.canvas.drawable_text import MAX_LETTERS, shortened
from physicslab.view.canvas.quantities import with_powers


def broken(words: str, width: int, canvas: Canvas, style: TextStyle) -> list[str]:
    """Break words, in the canvas's language, into lines no wider than ``width`` px; one too long is cut.

    Text beyond ``MAX_LETTERS`` is left out. Lines are what is drawn, in every language.
    """
    lines: list[str] = []
    line = ""
    for word in shortened(with_powers(canvas.language.reword(words)), MAX_LETTERS).split():
        longer = f"{line} {word}" if line else word
        if canvas.text_size(proper(longer), style)[0] <= width:
            line = longer
            continue
        if line:
            lines.append(line)
        line = word
        while canvas.text_size(proper(line), style)[0] > width and len(line) > 1:
            cut = _fitting(line, width, canvas, style)
            lines.append(line[:cut])
            line = line[cut:]
    return list(map(proper, [*lines, line] if line else lines))


def _fitting(word: str, width: int, canvas: Canvas, style: TextStyle) -> int:
    """Return how many letters of a word fit into ``width`` px, and one where none does."""
    fits, too_long = 1, len(word)
    while too_long - fits > 1:
        middle = (fits + too_long) // 2
        if canvas.text_size(proper(word[:middle]), style)[0] <= width:
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


def _pill_rect(words: Sequence[str], middle: int, top: int, style: TextStyle, canvas: Canvas) -> Rect:
    """Return where a box with lines of words is around ``middle`` [px]."""
    width = max(canvas.text_size(line, style)[0] for line in words) + pill_margin(style.size)
    return middle - width // 2, top, width, pill_height(len(words), style, canvas)


def draw_pill(words: Sequence[str], middle: int, top: int, size: int, colour: Colour, on: Drawing) -> Rect:
    """Draw lines of words in a box around ``middle``, and return where it is [px]."""
    style = TextStyle(size, colour, bold=True)
    pad = round(0.55 * size)
    line_height = on.canvas.text_size("Ag", style)[1]
    rect = _pill_rect(words, middle, top, style, on.canvas)
    on.canvas.panel(rect, on.theme.panel, colour, 0.95)
    for n, line in enumerate(words):
        on.canvas.text(line, (middle, top + pad // 2 + n * line_height), style, "centre")
    return rect


_MIN_DROPPED = 0.05
"""Less time [s], dropped within a few seconds, cannot be noticed, and would be written as 0.0 s."""
_HITCHES = 8
"""Frames of those few seconds that drop time if the computer is too slow; fewer do where it loads."""
_DROP_SHOWN = 3.0
"""How long [s] time that was dropped is shown."""


class DroppedTime:
    """Adds up the time that was dropped of late, for as long as more is dropped every few seconds."""

    def __init__(self) -> None:
        self._seen = 0.0
        self._sum = 0.0
        self._until = 0.0
        self._frames = 0

    def forget(self) -> None:
        """Begin again at zero: what was dropped had another reason than a slow computer."""
        self._sum, self._until, self._frames = 0.0, 0.0, 0

    def recent(self, dropped: float, now: float) -> float:
        """Return the time dropped of late [s]; 0 where it is too little, or was dropped in a few frames.

        Parameters
        ----------
        dropped : float
            All the time that was ever dropped [s].
        now : float
            The time that the window has been open [s].
        """
        if dropped > self._seen:
            if now >= self._until:
                self._sum, self._frames = 0.0, 0
            self._frames += 1
            self._sum += dropped - self._seen
            self._seen, self._until = dropped, now + _DROP_SHOWN
        is_slow = self._sum >= _MIN_DROPPED and self._frames >= _HITCHES
        return self._sum if now < self._until and is_slow else 0.0


def draw_banners(
    banners: Iterable[tuple[str, Colour]], room: Rect, windows: Sequence[Rect], on: Drawing
) -> list[Rect]:
    """Draw banners in their colours below each other, from the top of a room on; return where they are [px].

    Those wider than it are broken into lines; those that would reach below it, or into windows, are left out.
    """
    left, top, width, height = room
    middle, bottom = left + width // 2, top + height
    taken: list[Rect] = []
    for words, colour in banners:
        style = TextStyle(on.size + 2, colour, bold=True)
        lines = broken(words, max(width - pill_margin(on.size + 2), 1), on.canvas, style)
        rect = _pill_rect(lines, middle, top, style, on.canvas)
        if top + rect[3] <= bottom and not any(overlap(rect, one) for one in windows):
            taken.append(draw_pill(lines, middle, top, on.size + 2, colour, on))
            top += on.size // 2 + taken[-1][3]
    return taken


@dataclass(frozen=True, slots=True)
class Message:
    """A message of an error or an action: its lines, its colour, its width and height [px]."""

    lines: list[str]
    colour: Colour
    width: int
    height: int


def lay_out_messages(words: Iterable[tuple[str, Colour]], on: Drawing, room: int) -> list[Message]:
    """Break messages into lines of a height [px], no wider than ``room``; empty ones are left out."""
    messages: list[Message] = []
    for message, colour in words:
        style = TextStyle(on.size, colour, bold=True)
        lines = broken(message, max(room - pill_margin(on.size), 1), on.canvas, style)
        if lines:
            height = pill_height(len(lines), style, on.canvas)
            width = max(on.canvas.text_size(line, style)[0] for line in lines) + pill_margin(on.size)
            messages.append(Message(lines, colour, width, height))
    return messages


def draw_messages(messages: Iterable[Message], middle: int, top: int, bottom: int, on: Drawing) -> list[Rect]:
    """Draw messages around ``middle`` above ``bottom``, the first lowest, and return where they are [px].

    Further ones that would reach above ``top`` are left out.
    """
    bottom -= on.size // 2
    taken: list[Rect] = []
    for message in messages:
        if taken and bottom - message.height < top:
            continue
        bottom -= message.height
        taken.append(draw_pill(message.lines, middle, bottom, on.size, message.colour, on))
        bottom -= on.size // 2
    return taken


_MAX_SHOWN = 3
"""Further warnings are counted. All are in ``run --json``."""
_MAX_WIDTH, _MAX_HEIGHT = 60, 0.4
"""How wide a line may be, in heights of the text, and how much of the room all of them may take: the first
stands alone where they would take more."""
_SEEN = 3.0
"""An error of a place that is smaller in the picture is not seen: rims are half as wide [px]."""


def draw_advice(
    advice: Sequence[ModelWarning], room: Rect, on: Drawing, *, plainly: bool = False, seen_only: bool = False
) -> Rect | None:
    """Write what is not to be trusted, in the middle at the top of a room [px]; return where [px].

    The worst comes first, and ``plainly`` alone; what is beyond a limit comes before what has none. With
    ``seen_only`` errors of places that cannot be seen in the picture, and counts of steps and impacts, are
    left out where they have no limit. Without a warning, or room for it, nothing is drawn.
    """
    if seen_only:
        scale = on.camera.scale
        least = {"m": _SEEN / scale, "": math.inf}  # places that are off are seen, numbers of steps are not
        shown = (one.excess[1] >= least.get(one.unit, -math.inf) for one in advice)
        advice = [one for one, is_shown in zip(advice, shown, strict=True) if is_shown or one.limit != 0.0]
    if not advice:
        return None
    ordered = sorted(advice, key=lambda one: (bool(one.limit), one.excess), reverse=True)
    small = max(on.size - 1, 10)
    left, top, width, height = room
    width = min(width, _MAX_WIDTH * on.size) - 3 * on.size
    style, inner = TextStyle(small, on.theme.warning, bold=True), max(width, 4 * on.size)
    own = on.canvas.language
    told = own.reword(ordered[0].told)
    told = told if ordered[0].entity else told[:1].upper() + told[1:]
    rest = f" {own.say_count('And {n} more.', 'And {n} more.', len(ordered) - 1)}" if len(ordered) > 1 else ""
    if plainly:
        rest = f" {own.say('More under Engineer.')}"
    brief = broken(proper(f"! {told}.{rest}"), inner, on.canvas, style)
    lines = ["! Not to be trusted"]
    for one in ordered[:_MAX_SHOWN]:
        pieces = broken(one.words, inner, on.canvas, style)
        lines += [proper(f"- {pieces[0]}"), *pieces[1:]]
    if len(ordered) > _MAX_SHOWN:
        lines.append(f"and {len(ordered) - _MAX_SHOWN} more")
    if plainly or pill_height(len(lines), style, on.canvas) > _MAX_HEIGHT * height:
        lines = brief
    if pill_height(len(lines), style, on.canvas) > height:
        return None
    return draw_pill(lines, left + room[2] // 2, top, small, on.theme.warning, on)
