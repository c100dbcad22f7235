"""A drawing within a panel: lines, arrows and words, at places in pixels from its top left corner."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from imgui_bundle import ImVec2, imgui

from physicslab.view.canvas.theme import Colour
from physicslab.view.toolkit.style import packed
from physicslab.view.toolkit.ui import Ui

__all__ = ["Place", "Sketch", "sketch"]

type Place = tuple[float, float]

THIN, THICK = 1.4, 3.4
"""Widths of arrows: before an impact, and after it [px]."""
_DASH, _GAP = 6.0, 4.0
_HEAD = (7.0, 11.0)
"""Lengths of the heads of thin and of thick arrows [px]."""
_DOT = 3.0
"""Arrows shorter than that are a dot [px]."""


class Sketch:
    """The surface; ``width`` and ``height`` are its size [px]."""

    def __init__(self, ui: Ui, corner: Place, width: float, height: float) -> None:
        self.ui, self.width, self.height = ui, width, height
        self._left, self._top = corner
        self._paper = imgui.get_window_draw_list()
        self._words: list[tuple[float, float, float, float]] = []

    def _at(self, place: Place) -> ImVec2:
        return ImVec2(self._left + place[0], self._top + place[1])

    def line(
        self, start: Place, end: Place, colour: Colour, width: float = 1.0, *, dashed: bool = False
    ) -> None:
        """Draw a line."""
        length = math.dist(start, end)
        if not dashed or length < _DASH:
            self._paper.add_line(self._at(start), self._at(end), packed(colour), width)
            return
        dx, dy = (end[0] - start[0]) / length, (end[1] - start[1]) / length
        done = 0.0
        while done < length:
            until = min(done + _DASH, length)
            self._paper.add_line(
                self._at((start[0] + done * dx, start[1] + done * dy)),
                self._at((start[0] + until * dx, start[1] + until * dy)), packed(colour), width,
            )  # fmt: skip
            done += _DASH + _GAP

    def arrow(self, start: Place, end: Place, colour: Colour, *, before: bool) -> None:
        """Draw an arrow: thin and dashed for what was before, thick for what is after."""
        length = math.dist(start, end)
        if length < _DOT:
            self._paper.add_circle_filled(self._at(start), _DOT, packed(colour))
            return
        head = min(_HEAD[0] if before else _HEAD[1], length)
        dx, dy = (end[0] - start[0]) / length, (end[1] - start[1]) / length
        neck = end[0] - head * dx, end[1] - head * dy
        self.line(start, neck, colour, THIN if before else THICK, dashed=before)
        half = 0.5 * head
        left, right = (neck[0] - half * dy, neck[1] + half * dx), (neck[0] + half * dy, neck[1] - half * dx)
        self._paper.add_triangle_filled(self._at(end), self._at(left), self._at(right), packed(colour))

    def polygon(self, corners: Sequence[Place], fill: Colour, rim: Colour, width: float = 2.0) -> None:
        """Draw a convex outline that is filled."""
        places: Any = [self._at(corner) for corner in corners]
        self._paper.add_convex_poly_filled(places, packed(fill))
        self._paper.add_polyline(places, packed(rim), width, imgui.ImDrawFlags_.closed)

    def disc(self, middle: Place, radius: float, fill: Colour, rim: Colour, width: float = 2.0) -> None:
        """Draw a disc."""
        self._paper.add_circle_filled(self._at(middle), radius, packed(fill))
        self._paper.add_circle(self._at(middle), radius, packed(rim), 0, width)

    def bar(self, low: Place, high: Place, fill: Colour, *, hatched: bool = False) -> None:
        """Draw a rectangle, full or hatched."""
        if not hatched:
            self._paper.add_rect_filled(self._at(low), self._at(high), packed(fill))
            return
        self._paper.add_rect(self._at(low), self._at(high), packed(fill))
        x, tall = low[0], high[1] - low[1]
        while x < high[0]:
            up = min(tall, high[0] - x)
            self.line((x, high[1]), (x + up, high[1] - up), fill)
            x += 6.0

    def words(self, place: Place, words: str, colour: Colour) -> None:
        """Write words with their middle at a place, or near it where others are; all within the sketch."""
        size = imgui.calc_text_size(words)
        x = min(max(place[0] - 0.5 * size.x, 0.0), max(self.width - size.x, 0.0))
        y = min(max(place[1] - 0.5 * size.y, 0.0), max(self.height - size.y, 0.0))
        for _ in range(4):
            taken = next((one for one in self._words if _overlap(one, (x, y, size.x, size.y))), None)
            if taken is None:
                break
            below = taken[1] + taken[3]
            y = below if below + size.y <= self.height else max(taken[1] - size.y, 0.0)
        self._words.append((x, y, size.x, size.y))
        self._paper.add_text(self._at((x, y)), packed(colour), words)
        self.ui.words.append(words)


def _overlap(one: tuple[float, float, float, float], other: tuple[float, float, float, float]) -> bool:
    (x, y, w, h), (u, v, p, q) = one, other
    return x < u + p and u < x + w and y < v + q and v < y + h


@contextmanager
def sketch(ui: Ui, width: float, height: float) -> Iterator[Sketch]:
    """Begin a drawing where the next widget would be, so large [px]."""
    corner = imgui.get_cursor_screen_pos()
    paper, end = imgui.get_window_draw_list(), ImVec2(corner.x + width, corner.y + height)
    paper.add_rect_filled(corner, end, packed(ui.theme.background), 4.0)
    paper.push_clip_rect(corner, end, True)
    try:
        yield Sketch(ui, (corner.x, corner.y), width, height)
    finally:
        paper.pop_clip_rect()
        imgui.dummy(ImVec2(width, height))
