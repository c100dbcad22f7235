"""Rectangles with smooth round corners."""

from __future__ import annotations

from functools import lru_cache

import pygame

from physicslab.view.canvas.theme import NOTHING, Colour

__all__ = ["rounded"]

_CORNER = 8
"""Radius of the corners [px]."""
_SMOOTHING = 4
"""How many times too large corners are drawn, to be shrunk."""


def rounded(size: tuple[int, int], colour: Colour, outline: Colour, opacity: float) -> pygame.Surface:
    """Return a rectangle with a thin outline, its colours multiplied by its opacity.

    The corners alone are drawn large and shrunk, and kept: while a window is resized there is a new size for
    every panel in every frame, and to smooth all of a panel takes a millisecond.
    """
    width, height = size
    reach = min(_CORNER, width // 2, height // 2)
    tile = _tile(reach, colour, outline, opacity)
    if size == tile.get_size():
        return tile.copy()
    made = pygame.Surface(size, pygame.SRCALPHA, 32)
    made.fill(_faded(colour, opacity))
    edge = _faded(outline, opacity)
    for side in ((0, 0, width, 1), (0, height - 1, width, 1), (0, 0, 1, height), (width - 1, 0, 1, height)):
        made.fill(edge, side)
    for left in (0, 1):
        for top in (0, 1):
            corner = ((reach + 1) * left, (reach + 1) * top, reach, reach)
            place = ((width - reach) * left, (height - reach) * top)
            made.fill(NOTHING, (*place, reach, reach))
            made.blit(tile, place, corner, pygame.BLEND_RGBA_ADD)
    return made


def _faded(colour: Colour, opacity: float) -> tuple[int, int, int, int]:
    """Return a colour multiplied by its opacity, and that."""
    red, green, blue = (round(part * opacity) for part in colour)
    return red, green, blue, round(255 * opacity)


@lru_cache(maxsize=256)
def _tile(reach: int, colour: Colour, outline: Colour, opacity: float) -> pygame.Surface:
    """Return the smallest rectangle with corners of this radius [px], one pixel between them."""
    side = 2 * reach + 1
    large = pygame.Surface((_SMOOTHING * side, _SMOOTHING * side), pygame.SRCALPHA, 32)
    pygame.draw.rect(large, outline, large.get_rect(), border_radius=_SMOOTHING * reach)
    inside = large.get_rect().inflate(-2 * _SMOOTHING, -2 * _SMOOTHING)
    pygame.draw.rect(large, colour, inside, border_radius=max(_SMOOTHING * (reach - 1), 0))
    small = pygame.transform.smoothscale(large.premul_alpha(), (side, side))
    small.fill((round(255 * opacity),) * 4, special_flags=pygame.BLEND_RGBA_MULT)
    return small
