"""Words and panels that stay as they are for many frames, drawn once and put down as one picture."""

from __future__ import annotations

from collections.abc import Callable

import pygame

from physicslab.view.canvas.canvas import Align, Rect, TextStyle, TextSurface
from physicslab.view.canvas.surface_cache import SurfaceCache
from physicslab.view.canvas.theme import NOTHING, Colour

__all__ = ["CachedLayer", "left_of"]


class CachedLayer:
    """A part of the picture that is drawn again only when its version or its size changes.

    A panel of figures is some fifty words: put down one by one they take most of the HUD's time.

    Parameters
    ----------
    surfaces : SurfaceCache
        Where the pictures of its words and panels come from.
    """

    def __init__(self, surfaces: SurfaceCache) -> None:
        self._surfaces = surfaces
        self._version: object = None
        self._surface = pygame.Surface((1, 1), pygame.SRCALPHA, 32)
        self._corner = (0, 0)

    def put_on(
        self, target: pygame.Surface, rect: Rect, version: object, draw: Callable[[TextSurface], None]
    ) -> None:
        """Put it down at ``rect`` [px] of a surface, drawn again if size or version are not the last ones."""
        size = (max(rect[2], 1), max(rect[3], 1))
        if size != self._surface.get_size() or version != self._version:
            if size == self._surface.get_size():
                self._surface.fill(NOTHING)
            else:
                self._surface = pygame.Surface(size, pygame.SRCALPHA, 32)
            self._version, self._corner = version, rect[:2]
            draw(self)
        target.blit(self._surface, rect[:2], special_flags=pygame.BLEND_PREMULTIPLIED)

    def panel(self, rect: Rect, colour: Colour, outline: Colour, opacity: float = 1.0) -> None:
        """Draw a rectangle with rounded corners and a thin outline; ``rect`` is that on the canvas."""
        if rect[2] > 0 and rect[3] > 0:
            self._blit(self._surfaces.panel(rect[2:], colour, outline, opacity), rect[:2])

    def text(self, words: str, at: tuple[int, int], style: TextStyle, align: Align = "left") -> None:
        """Write one line; ``at`` is its place on the canvas."""
        if not words:
            return
        line = self._surfaces.text(words, style)
        self._blit(line.premul_alpha(), (left_of(line, at[0], align), at[1]))

    def text_size(self, words: str, style: TextStyle) -> tuple[int, int]:
        """Return the width and height of one line [px]."""
        return self._surfaces.text_size(words, style)

    def _blit(self, surface: pygame.Surface, at: tuple[int, int]) -> None:
        place = (at[0] - self._corner[0], at[1] - self._corner[1])
        self._surface.blit(surface, place, special_flags=pygame.BLEND_PREMULTIPLIED)


def left_of(line: pygame.Surface, x: int, align: Align) -> int:
    """Return where a line begins [px] whose left end, middle or right end is at ``x``."""
    return x - {"left": 0, "centre": line.get_width() // 2, "right": line.get_width()}[align]
