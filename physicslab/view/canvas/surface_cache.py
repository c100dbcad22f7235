"""Pictures of words and panels, made once and used for as long as they are wanted again."""

from __future__ import annotations

import importlib.util
import re
from collections import OrderedDict
from collections.abc import Callable
from pathlib import Path

import pygame

from physicslab.view.canvas.canvas import TextStyle
from physicslab.view.canvas.drawable_text import drawable
from physicslab.view.canvas.rounded import rounded
from physicslab.view.canvas.theme import NOTHING, Colour

__all__ = ["SurfaceCache"]

_RAISED = re.compile("([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)")
_PLAIN = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
_RAISED_SIZE = 0.72
"""Height of raised figures, as a share of the line's."""
_MAX_SURFACES = 512
_MAX_SIZES = 4096


class SurfaceCache:
    """Makes pictures of lines of text and of panels; the one that was unused for longest makes room."""

    def __init__(self) -> None:
        self._surfaces: OrderedDict[tuple[object, ...], pygame.Surface] = OrderedDict()
        self._fonts: dict[tuple[int, bool], pygame.font.Font] = {}
        self._sizes: dict[tuple[str, TextStyle], tuple[int, int]] = {}

    def __len__(self) -> int:
        return len(self._surfaces)

    def panel(self, size: tuple[int, int], colour: Colour, outline: Colour, opacity: float) -> pygame.Surface:
        """Return a rectangle of a size [px] with round corners, its colours multiplied by its opacity."""
        key = ("panel", *size, colour, outline, opacity)
        return self._kept(key, lambda: rounded(size, colour, outline, opacity))

    def text(self, words: str, style: TextStyle) -> pygame.Surface:
        """Return the picture of one line; of letters without width it is one clear pixel."""
        return self._kept(("text", words, style), lambda: self._render(words, style))

    def text_size(self, words: str, style: TextStyle) -> tuple[int, int]:
        """Return the width and height of one line [px]."""
        key = words, style
        size = self._sizes.get(key)
        if size is None:
            if len(self._sizes) >= _MAX_SIZES:
                self._sizes.clear()
            pieces = [self._font(style_of).size(piece) for piece, style_of in _pieces(drawable(words), style)]
            size = sum(width for width, _ in pieces), max((height for _, height in pieces), default=0)
            self._sizes[key] = size
        return size

    def _render(self, words: str, style: TextStyle) -> pygame.Surface:
        if not self.text_size(words, style)[0]:  # SDL refuses to draw what has no width
            clear = pygame.Surface((1, 1), pygame.SRCALPHA, 32)
            clear.fill(NOTHING)
            return clear
        pieces = _pieces(drawable(words), style)
        if len(pieces) == 1 and pieces[0][1] is style:
            return self._font(style).render(pieces[0][0], True, style.colour)
        line = pygame.Surface(self.text_size(words, style), pygame.SRCALPHA, 32)
        left = 0
        for piece, style_of in pieces:
            part = self._font(style_of).render(piece, True, style.colour)
            line.blit(part, (left, 0))
            left += part.get_width()
        return line

    def _kept(self, key: tuple[object, ...], make: Callable[[], pygame.Surface]) -> pygame.Surface:
        surface = self._surfaces.get(key)
        if surface is None:
            surface = self._surfaces[key] = make()
            if len(self._surfaces) > _MAX_SURFACES:
                self._surfaces.popitem(last=False)
        else:
            self._surfaces.move_to_end(key)
        return surface

    def _font(self, style: TextStyle) -> pygame.font.Font:
        key = (style.size, style.bold)
        if key not in self._fonts:
            pygame.font.init()  # without a window nothing else has done so
            self._fonts[key] = _load_font(*key)
        return self._fonts[key]


def _pieces(words: str, style: TextStyle) -> list[tuple[str, TextStyle]]:
    """Return the pieces of a line with their styles: raised figures, which fonts lack, are small ones."""
    if _RAISED.search(words) is None:
        return [(words, style)]
    small = TextStyle(max(round(_RAISED_SIZE * style.size), 6), style.colour, style.bold)
    parts = [part for part in _RAISED.split(words) if part]
    return [(part.translate(_PLAIN), small) if _RAISED.match(part) else (part, style) for part in parts]


def _load_font(size: int, bold: bool) -> pygame.font.Font:
    """Return a font by its nominal size [px]: Roboto, which panels have too, or pygame's own."""
    package = importlib.util.find_spec("imgui_bundle")
    if package is not None and package.submodule_search_locations:
        name = "Roboto-Bold.ttf" if bold else "Roboto-Regular.ttf"
        path = Path(package.submodule_search_locations[0]) / "assets" / "fonts" / "Roboto" / name
        if path.is_file():
            return pygame.font.Font(path, size)
    return pygame.font.Font(None, round(1.4 * size))
