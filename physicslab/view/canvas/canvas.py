"""Drawing on any surface."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, Literal, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from physicslab.languages.language import Language
from physicslab.theme import Colour

if TYPE_CHECKING:
    import pygame


type Numbers = NDArray[np.float64]
"""A float64 array (n,)."""
type Points = NDArray[np.float64]
"""A float64 array (n, 2): right and down from the top left corner [px]."""
type Rect = tuple[int, int, int, int]
"""Left, top, width, height [px]."""


def text_height(window: tuple[int, int], scale: float) -> int:
    """Return how high text is [px]: larger in a larger ``window`` [px], times a chosen ``scale``."""
    width, height = window
    return round(min(max(min(height / 48, width / 80), 12), 20) * scale)


def is_within(place: tuple[float, float], rect: Rect) -> bool:
    """Whether a place lies in a rectangle [px]."""
    left, top, width, height = rect
    return left <= place[0] < left + width and top <= place[1] < top + height


def overlap(one: tuple[float, float, float, float], other: tuple[float, float, float, float]) -> bool:
    """Whether two rectangles have a part in common [px]."""
    (x, y, width, height), (left, top, across, down) = one, other
    return x < left + across and left < x + width and y < top + down and top < y + height


def free_rects(area: Rect, taken: Sequence[Rect]) -> list[Rect]:
    """Return the largest rectangles of an area that others leave [px]: none of them lies in another.

    >>> free_rects((0, 0, 100, 50), [(0, 0, 40, 20)])
    [(40, 0, 60, 50), (0, 20, 100, 30)]
    """
    free = [area]
    for one in taken:
        x, y, width, height = one
        parts: list[Rect] = []
        for rect in free:
            left, top, across, down = rect
            if not overlap(rect, one):
                parts.append(rect)
                continue
            parts += [
                (left, top, x - left, down),
                (x + width, top, left + across - x - width, down),
                (left, top, across, y - top),
                (left, y + height, across, top + down - y - height),
            ]
        parts = [rect for rect in dict.fromkeys(parts) if rect[2] > 0 and rect[3] > 0]
        free = [rect for rect in parts if not any(_holds(other, rect) for other in parts if other != rect)]
    return free


def _holds(outer: Rect, inner: Rect) -> bool:
    """Whether a rectangle lies in another."""
    (x, y, width, height), (left, top, across, down) = outer, inner
    return x <= left and y <= top and left + across <= x + width and top + down <= y + height


type Painter = Callable[[pygame.Surface], None]
"""Draws on a surface."""
type Align = Literal["left", "centre", "right"]


class Finish(IntEnum):
    """How the inside of a body is painted."""

    FLAT = 0
    """One colour."""
    POINT = 1
    """Lit from above; nothing shows how far it has turned."""
    LIT = 2
    """Lit from above."""
    RUBBER = 3
    """Lit, and dull."""
    GROUND = 4
    """Dim below, with a faint hatch: what cannot move."""
    WOOD = 5
    """Lit, with a grain."""
    STEEL = 6
    """Lit, brushed."""
    STONE = 7
    """Lit, with specks."""
    ICE = 8
    """Clear, with streaks of light."""
    GLASS = 9
    """Clearer still."""


@dataclass(frozen=True, slots=True)
class Look:
    """How bodies look, a row each.

    Attributes
    ----------
    fill, rim : uint8 arrays (n, 3)
        Red, green and blue inside and at the edge.
    finish : int64 array (n,)
        How the inside is painted: of :class:`Finish`.
    shadow : float
        Opacity of the shadows below them; 0 is none.
    """

    fill: NDArray[np.uint8]
    rim: NDArray[np.uint8]
    finish: NDArray[np.int64]
    shadow: float = 0.0

    @classmethod
    def plain(cls, fill: Colour, rim: Colour, count: int) -> Look:
        """Return the same two colours for each of ``count`` bodies, which are flat."""
        rows = [np.tile(np.array(colour, np.uint8), (count, 1)) for colour in (fill, rim)]
        return cls(rows[0], rows[1], np.zeros(count, np.int64))


@dataclass(frozen=True, slots=True)
class TextStyle:
    """The look of a line of text: its height [px], colour and weight."""

    size: int
    colour: Colour
    bold: bool = False


class Rounded(NamedTuple):
    """Rounded polygons: vertices (n, 8, 2) [px], the last one repeated; their numbers and radii (n,) [px]."""

    corners: Numbers
    vertices: NDArray[np.int64]
    radius: Numbers


class Canvas(Protocol):
    """A picture in the making. All lengths are pixels, y points down, and what comes later lies on top.

    Angles are counter-clockwise as seen on the screen [rad]. Anything outside the picture is cut off, and
    nothing that is not finite may be passed.
    """

    language: Language
    """The language of words."""

    @property
    def size(self) -> tuple[int, int]:
        """Width and height [px]."""

    def clear(self, top: Colour, bottom: Colour, grain: int = 0) -> None:
        """Fill the whole picture from the colour of its top to that of its bottom, with some grain."""

    def keep(self, key: Hashable, draw: Callable[[], None]) -> None:
        """Begin the picture as ``draw`` does; what it drew may be shown again while its key is the same."""

    def glows(self, centre: Points, radius: Numbers, colour: Colour, strength: Numbers) -> None:
        """Add light to what is there: brightest, by a strength (0 to 1), in the middle of each disc (n,)."""

    def discs(self, centre: Points, radius: Numbers, angle: Numbers, look: Look) -> None:
        """Draw discs: centres (n, 2) and radii (n,) [px], angles (n,) [rad]; with a wedge if not flat."""

    def boxes(self, centre: Points, extent: Points, angle: Numbers, look: Look) -> None:
        """Draw boxes: centres and sides (n, 2) [px], angles (n,) [rad]."""

    def rounded(self, shapes: Rounded, look: Look) -> None:
        """Draw rounded polygons, each with a rim."""

    def lines(
        self, start: Points, end: Points, colour: Colour | NDArray[np.uint8], width: float | Numbers = 1.0,
        opacity: float | Numbers = 1.0,
    ) -> None:  # fmt: skip
        """Draw straight lines between ends (n, 2) [px], with round ends, in their order.

        Colour, width and opacity are those of all, or each has its own: (n, 3), (n,), (n,).
        """

    def panel(self, rect: Rect, colour: Colour, outline: Colour, opacity: float = 1.0) -> None:
        """Draw a rectangle with rounded corners and a thin outline."""

    def text(self, words: str, at: tuple[int, int], style: TextStyle, align: Align = "left") -> None:
        """Write one line; ``at`` is its top left, top middle or top right."""

    def text_size(self, words: str, style: TextStyle) -> tuple[int, int]:
        """Return the width and height of one line [px]."""

    def paint(self, painter: Painter) -> None:
        """Let something else draw on the picture: widgets do that by themselves."""


def draw_spots(canvas: Canvas, centre: Points, radius: float, fill: Colour, rim: Colour) -> None:
    """Draw flat discs (n, 2) of one radius [px] and the same two colours."""
    count = len(centre)
    canvas.discs(centre, np.full(count, radius), np.zeros(count), Look.plain(fill, rim, count))
