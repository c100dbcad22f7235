"""Words and panels that stay as they are for many frames, drawn once and put down as one picture."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import pygame

from physicslab.view.canvas.canvas import Align, Rect, TextStyle
from physicslab.view.canvas.theme import NOTHING, Colour

if TYPE_CHECKING:
    from physicslab.view.canvas.canvas import TextSurface
    from physicslab.view.canvas.pygame_canvas import PygameCanvas

__all__ = ["CachedLayer"]


class CachedLayer:
    """A part of the picture that is drawn anew only when it is another.

    A panel of figures is some fifty words: put down one by one they take most of the HUD's time.

    Parameters
    ----------
    canvas : PygameCanvas
        What it is put down on.
    """

    def __init__(self, canvas: PygameCanvas) -> None:
        self._canvas = canvas
        self._version: object = None
        self._surface = pygame.Surface((1, 1), pygame.SRCALPHA, 32)
        self._corner = (0, 0)

    def put(self, rect: Rect, version: object, draw: Callable[[TextSurface], None]) -> None:
        """Put it down at ``rect`` [px], drawn anew where size or version are not those of the last time."""
        size = (max(rect[2], 1), max(rect[3], 1))
        if size != self._surface.get_size() or version != self._version:
            if size == self._surface.get_size():
                self._surface.fill(NOTHING)
            else:
                self._surface = pygame.Surface(size, pygame.SRCALPHA, 32)
            self._version, self._corner = version, rect[:2]
            draw(self)
        self._canvas.surface.blit(self._surface, rect[:2], special_flags=pygame.BLEND_PREMULTIPLIED)

    def panel(self, rect: Rect, colour: Colour, outline: Colour, opacity: float = 1.0) -> None:
        """Draw a rectangle with rounded corners and a thin outline; ``rect`` is that on the canvas."""
        if rect[2] > 0 and rect[3] > 0:
            self._blit(self._canvas.kept_panel(rect[2:], colour, outline, opacity), rect[:2])

    def text(self, words: str, at: tuple[int, int], style: TextStyle, align: Align = "left") -> None:
        """Write one line; ``at`` is its place on the canvas."""
        if not words:
            return
        line = self._canvas.kept_text(words, style)
        shift = {"left": 0, "centre": line.get_width() // 2, "right": line.get_width()}[align]
        self._blit(line.premul_alpha(), (at[0] - shift, at[1]))

    def text_size(self, words: str, style: TextStyle) -> tuple[int, int]:
        """Return the width and height of one line [px]."""
        return self._canvas.text_size(words, style)

    def _blit(self, surface: pygame.Surface, at: tuple[int, int]) -> None:
        place = (at[0] - self._corner[0], at[1] - self._corner[1])
        self._surface.blit(surface, place, special_flags=pygame.BLEND_PREMULTIPLIED)
