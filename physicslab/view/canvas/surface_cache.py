"""Pictures of words and panels, made once and used for as long as they are wanted again."""

import importlib.util
import re
from functools import lru_cache
from pathlib import Path

import numpy as np
import pygame

from physicslab.theme import NOTHING, Colour
from physicslab.view.canvas.canvas import TextStyle
from physicslab.view.canvas.drawable_text import drawable
from physicslab.view.canvas.system_font import FAR, system_font

_RAISED = re.compile("([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)")
_PLAIN = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "\N{MINUS SIGN}0123456789")
RAISED_SIZE = 0.72
"""Height of raised figures, as a share of the line's."""
_MAX_SURFACES = 512
_MAX_SIZES = 4096
_MAX_SKIES = 2
GLOW_LEVELS = 12
"""How many strengths of glows there are."""


class SurfaceCache:
    """Makes pictures of lines of text and of panels; the one that was unused for longest makes room.

    Attributes
    ----------
    panel : callable
        Returns a rectangle with round corners, by size [px], colour, outline and opacity, as :func:`rounded`.
    sky, glow : callable
        Return what :func:`sky` and :func:`glow` do.
    text : callable
        Returns the picture of one line, by its words and style; of letters without width one clear pixel.
    text_size : callable
        Returns the width and height of one line [px], by its words and style.
    """

    def __init__(self) -> None:
        self._font = lru_cache(maxsize=None)(_load_font)  # fonts end with pygame: they are a canvas's
        self.panel = lru_cache(_MAX_SURFACES)(rounded)
        self.sky, self.glow = lru_cache(_MAX_SKIES)(sky), lru_cache(_MAX_SURFACES)(glow)
        self.text = lru_cache(_MAX_SURFACES)(self._render)
        self.text_size = lru_cache(_MAX_SIZES)(self._measure)

    def _measure(self, words: str, style: TextStyle) -> tuple[int, int]:
        sizes = [self._of(piece, one).size(piece) for piece, one in _pieces(drawable(words), style)]
        return sum(width for width, _ in sizes), max((height for _, height in sizes), default=0)

    def _of(self, piece: str, style: TextStyle) -> pygame.font.Font:
        """Return the font of a piece of a line, which has letters of one kind."""
        return self._font(style.size, style.bold, system_font(piece[:1]))

    def _render(self, words: str, style: TextStyle) -> pygame.Surface:
        size = self.text_size(words, style)
        line = pygame.Surface(size if size[0] else (1, 1), pygame.SRCALPHA, 32)
        if not size[0]:  # SDL refuses to draw what has no width
            line.fill(NOTHING)
            return line
        pieces, left = _pieces(drawable(words), style), 0
        for piece, one in pieces:
            part = self._of(piece, one).render(piece, True, style.colour)
            if len(pieces) == 1 and one is style:
                return part
            own = self._of(piece, one)
            is_far = FAR.match(piece) is not None  # raised figures keep to the upper edge
            down = self._font(one.size, one.bold, None).get_ascent() - own.get_ascent() if is_far else 0
            line.blit(part, (left, down))
            left += part.get_width()
        return line


def _pieces(words: str, style: TextStyle) -> list[tuple[str, TextStyle]]:
    """Return the pieces of a line with their styles: raised figures, which fonts lack, are small ones."""
    small = TextStyle(max(round(RAISED_SIZE * style.size), 6), style.colour, style.bold)
    parts = [(part, small if raised else style) for part, raised in raised_parts(words)]
    if FAR.search(words) is None:
        return parts
    return [(piece, one) for part, one in parts for piece in FAR.split(part) if piece]


def raised_parts(words: str) -> list[tuple[str, bool]]:
    """Return the parts of a line, and whether each is raised: those are written with plain figures.

    >>> raised_parts("2·10⁻⁶ J")
    [('2·10', False), ('\N{MINUS SIGN}6', True), (' J', False)]
    """
    if _RAISED.search(words) is None:
        return [(words, False)]
    parts = [(part, _RAISED.match(part) is not None) for part in _RAISED.split(words) if part]
    return [(part.translate(_PLAIN) if raised else part, raised) for part, raised in parts]


def _load_font(size: int, bold: bool, far: Path | None) -> pygame.font.Font:
    """Return a font by its nominal size [px]: Roboto, which panels have too, or pygame's own.

    ``far`` is one of the system, for letters that it has not.
    """
    pygame.font.init()  # without a window nothing else has done so
    if far is not None:
        return pygame.font.Font(far, size)
    package = importlib.util.find_spec("imgui_bundle")
    if package is not None and package.submodule_search_locations:
        name = "Roboto-Bold.ttf" if bold else "Roboto-Regular.ttf"
        path = Path(package.submodule_search_locations[0]) / "assets" / "fonts" / "Roboto" / name
        if path.is_file():
            return pygame.font.Font(path, size)
    return pygame.font.Font(None, round(1.4 * size))


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


_GRAIN_TILE = 256
"""Side of the pattern of grain, which is repeated [px]."""


def sky(size: tuple[int, int], top: Colour, bottom: Colour, grain: int) -> pygame.Surface:
    """Return a picture whose colour goes from its top to its bottom; grain makes pixels differ by so much."""
    share = np.linspace(0.0, 1.0, size[1])[:, None]
    rows = np.array(top) * (1.0 - share) + np.array(bottom) * share - 0.5 * grain
    column = pygame.Surface((1, size[1]), 0, 32)
    pygame.surfarray.blit_array(column, np.clip(np.rint(rows), 0, 255).astype(np.uint8)[None])
    made = pygame.transform.scale(column, size)
    tile = _grain(grain)
    for left in range(0, size[0], _GRAIN_TILE):
        for above in range(0, size[1], _GRAIN_TILE):
            made.blit(tile, (left, above), special_flags=pygame.BLEND_RGB_ADD)
    return made


@lru_cache(maxsize=4)
def _grain(levels: int) -> pygame.Surface:
    """Return grey pixels of 0 to so many levels, always the same ones."""
    tile = pygame.Surface((_GRAIN_TILE, _GRAIN_TILE), 0, 32)
    chance = np.random.default_rng(1).integers(0, levels + 1, (_GRAIN_TILE, _GRAIN_TILE, 1), np.uint8)
    pygame.surfarray.blit_array(tile, np.repeat(chance, 3, axis=2))
    return tile


def glow(radius: int, colour: Colour, level: int) -> pygame.Surface:
    """Return a light to be added to a picture, of a radius [px], brightest in its middle."""
    places = np.arange(2 * radius + 1) - radius
    away = np.hypot(places[:, None], places[None, :]) / (radius + 0.5)
    light = np.clip(1.0 - away, 0.0, 1.0) ** 2 * level / GLOW_LEVELS
    made = pygame.Surface((2 * radius + 1, 2 * radius + 1), 0, 32)
    pygame.surfarray.blit_array(made, (light[:, :, None] * np.array(colour)).astype(np.uint8))
    return made


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
