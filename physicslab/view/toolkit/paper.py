"""Drawings within a panel, at places in pixels from their top left corner."""

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import pygame
from imgui_bundle import ImVec2, imgui

from physicslab.ecs.vector import Vector2
from physicslab.theme import Colour
from physicslab.view.canvas.canvas import overlap
from physicslab.view.toolkit.style import packed
from physicslab.view.toolkit.ui import Ui

type Place = Vector2
"""A place in a sketch, right and down from its top left corner [px]."""

THIN, THICK = 1.4, 3.4
"""Widths of arrows: before an impact, and after it [px]."""
_DASH, _GAP = 6.0, 4.0
_HEAD = (7.0, 11.0)
"""Lengths of the heads of thin and of thick arrows [px]."""
_WAYS = [
    0.25 * n * Vector2.from_angle(0.25 * math.pi * turn) for n in range(17) for turn in range(8 if n else 1)
]
"""Where words may go that have no room at their place, the nearest first, in sizes of the text."""
_DOT = 3.0
"""Arrows shorter than that are a dot [px]."""


class Paper:
    """The surface; ``width`` and ``height`` are its size [px].

    Attributes
    ----------
    arrows, axes : list of two places
        Where each begins and ends.
    taken : list of four floats
        Left, top, width and height of the words that were written.
    """

    def __init__(self, ui: Ui, corner: Place, width: float, height: float) -> None:
        self.ui, self.width, self.height = ui, width, height
        self._corner = corner
        self._paper = imgui.get_window_draw_list()
        self.arrows: list[tuple[Place, Place]] = []
        self.axes: list[tuple[Place, Place]] = []
        self.taken: list[tuple[float, float, float, float]] = []
        self._words: list[tuple[Place, str, Colour, Colour | None]] = []

    def _at(self, place: Place) -> ImVec2:
        return ImVec2(*(self._corner + place))

    def line(
        self, start: Place, end: Place, colour: Colour, width: float = 1.0, *, dashed: bool = False
    ) -> None:
        """Draw a line."""
        length = (end - start).magnitude
        if not dashed or length < _DASH:
            self._paper.add_line(self._at(start), self._at(end), packed(colour), width)
            return
        way, done = (end - start) / length, 0.0
        while done < length:
            begin, until = start + done * way, start + min(done + _DASH, length) * way
            self._paper.add_line(self._at(begin), self._at(until), packed(colour), width)
            done += _DASH + _GAP

    def arrow(self, start: Place, end: Place, colour: Colour, *, before: bool) -> None:
        """Draw an arrow: thin and dashed for what was before, thick for what is after."""
        self.arrows.append((start, end))
        length = (end - start).magnitude
        if length < _DOT:
            self._paper.add_circle_filled(self._at(start), _DOT, packed(colour))
            return
        head, way = min(_HEAD[0] if before else _HEAD[1], length), (end - start) / length
        neck, side = end - head * way, 0.5 * head * Vector2(-way.y, way.x)
        self.line(start, neck, colour, THIN if before else THICK, dashed=before)
        tip, left, right = self._at(end), self._at(neck + side), self._at(neck - side)
        self._paper.add_triangle_filled(tip, left, right, packed(colour))

    def polygon(self, corners: Sequence[Place], fill: Colour, rim: Colour) -> None:
        """Draw a convex outline that is filled."""
        places: Any = [self._at(corner) for corner in corners]
        self._paper.add_convex_poly_filled(places, packed(fill))
        self._paper.add_polyline(places, packed(rim), 2.0, imgui.ImDrawFlags_.closed)

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
        x, tall = low.x, high.y - low.y
        while x < high.x:
            up = min(tall, high.x - x)
            self.line(Vector2(x, high.y), Vector2(x + up, high.y - up), fill)
            x += 6.0

    def words(self, place: Place, words: str, colour: Colour, on: Colour | None = None) -> None:
        """Write words with their middle at a place, or near it where arrows and others are, in the sketch.

        ``on`` is a colour laid under them.
        """
        self._words.append((place, self.ui.said(words), colour, on))

    def write(self) -> None:
        """Write all words, once all arrows are known."""
        for place, words, colour, on in self._words:
            size = Vector2(*imgui.calc_text_size(words))
            corners = (self._inside(place + way * self.ui.size - 0.5 * size, size) for way in _WAYS)
            rects = [(corner.x, corner.y, size.x, size.y) for corner in corners]
            rect = next(filter(self._is_free, rects), rects[0])
            self.taken.append(rect)
            corner = Vector2(rect[0], rect[1])
            if on is not None:
                self._paper.add_rect_filled(self._at(corner), self._at(corner + size), packed(on))
            self._paper.add_text(self._at(corner), packed(colour), words)
            self.ui.words.append(words)

    def _inside(self, corner: Place, size: Vector2) -> Place:
        right, low = max(self.width - size.x, 0.0), max(self.height - size.y, 0.0)
        return Vector2(min(max(corner.x, 0.0), right), min(max(corner.y, 0.0), low))

    def _is_free(self, rect: tuple[float, float, float, float]) -> bool:
        """Whether neither words, arrows nor axes are in a rectangle."""
        left, top, width, height = rect
        gap = 0.5 * self.ui.size  # words that touch read as one
        if any(overlap(one, (left - gap, top, width + 2.0 * gap, height)) for one in self.taken):
            return False
        around = pygame.FRect(rect).inflate(_HEAD[1], _HEAD[1])  # heads are wider than the line
        if any(around.clipline(*start, *end) for start, end in self.arrows):
            return False
        return not any(pygame.FRect(rect).clipline(*start, *end) for start, end in self.axes)


@contextmanager
def drawn_on(ui: Ui, width: float, height: float) -> Iterator[Paper]:
    """Begin a drawing where the next widget would be, so large [px]."""
    corner = imgui.get_cursor_screen_pos()
    paper, end = imgui.get_window_draw_list(), ImVec2(corner.x + width, corner.y + height)
    paper.add_rect_filled(corner, end, packed(ui.theme.background), 4.0)
    paper.push_clip_rect(corner, end, True)
    try:
        drawn = Paper(ui, Vector2(corner.x, corner.y), width, height)
        yield drawn
        drawn.write()
    finally:
        paper.pop_clip_rect()
        imgui.dummy(ImVec2(width, height))
