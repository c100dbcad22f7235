"""A canvas that draws nothing and records what is drawn on it."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.languages.language import Language, language
from physicslab.theme import Colour
from physicslab.view.canvas.canvas import Align, Look, Numbers, Painter, Points, Rect, Rounded, TextStyle

__all__ = ["RecordingCanvas"]


@dataclass(slots=True)
class RecordingCanvas:
    """A canvas that draws nothing and keeps a list of the calls.

    Attributes
    ----------
    size : tuple of two ints
        Width and height [px].
    calls : list of (str, dict)
        The name of each method called, and what it was given.
    language : Language
        That of the window.
    """

    size: tuple[int, int]
    calls: list[tuple[str, dict[str, Any]]] = field(default_factory=list)
    language: Language = field(default_factory=language)

    def called(self, name: str) -> list[dict[str, Any]]:
        """Return what each call of a method was given."""
        return [given for called, given in self.calls if called == name]

    @property
    def words(self) -> list[str]:
        """Everything that was written."""
        return [given["words"] for given in self.called("text")]

    def clear(self, top: Colour, bottom: Colour, grain: int = 0) -> None:
        """Note the colours."""
        self.calls.append(("clear", {"top": top, "bottom": bottom, "grain": grain}))

    def keep(self, key: Hashable, draw: Callable[[], None]) -> None:
        """Draw: nothing is kept."""
        draw()

    def glows(self, centre: Points, radius: Numbers, colour: Colour, strength: Numbers) -> None:
        """Note the lights."""
        given = {"centre": centre, "radius": radius, "colour": colour, "strength": strength}
        self.calls.append(("glows", given))

    def discs(self, centre: Points, radius: Numbers, angle: Numbers, look: Look) -> None:
        """Note the discs."""
        given = {"centre": centre, "radius": radius, "angle": angle, "look": look}
        self.calls.append(("discs", given))

    def boxes(self, centre: Points, extent: Points, angle: Numbers, look: Look) -> None:
        """Note the boxes."""
        given = {"centre": centre, "extent": extent, "angle": angle, "look": look}
        self.calls.append(("boxes", given))

    def rounded(self, shapes: Rounded, look: Look) -> None:
        """Note the polygons."""
        self.calls.append(("rounded", {"shapes": shapes, "look": look}))

    def lines(
        self, start: Points, end: Points, colour: Colour | NDArray[np.uint8], width: float | Numbers = 1.0,
        opacity: float | Numbers = 1.0,
    ) -> None:  # fmt: skip
        """Note the lines, as strokes where each has a colour of its own."""
        given = {"start": start, "end": end, "colour": colour, "width": width, "opacity": opacity}
        self.calls.append(("strokes" if isinstance(colour, np.ndarray) else "lines", given))

    def panel(self, rect: Rect, colour: Colour, outline: Colour, opacity: float = 1.0) -> None:
        """Note the rectangle."""
        given = {"rect": rect, "colour": colour, "outline": outline, "opacity": opacity}
        self.calls.append(("panel", given))

    def text(self, words: str, at: tuple[int, int], style: TextStyle, align: Align = "left") -> None:
        """Note the words."""
        self.calls.append(("text", {"words": words, "at": at, "style": style, "align": align}))

    def text_size(self, words: str, style: TextStyle) -> tuple[int, int]:
        """Return a guess: letters a little over half as wide as high."""
        return round(0.55 * style.size * len(words)), round(1.36 * style.size)

    def paint(self, painter: Painter) -> None:
        """Note that something was to be drawn."""
        self.calls.append(("paint", {"painter": painter}))
