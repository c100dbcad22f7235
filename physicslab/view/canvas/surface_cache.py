"""Pictures of words and panels, made once and used for as long as they are wanted again."""

from __future__ import annotations

import importlib.util
from collections import OrderedDict
from collections.abc import Callable
from pathlib import Path

import pygame

from physicslab.view.canvas.canvas import TextStyle
from physicslab.view.canvas.drawable_text import drawable
from physicslab.view.canvas.rounded import rounded
from physicslab.view.canvas.theme import NOTHING, Colour

__all__ = ["SurfaceCache"]

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
            size = self._sizes[key] = self._font(style).size(drawable(words))
        return size

    def _render(self, words: str, style: TextStyle) -> pygame.Surface:
        if not self.text_size(words, style)[0]:  # SDL refuses to draw what has no width
            clear = pygame.Surface((1, 1), pygame.SRCALPHA, 32)
            clear.fill(NOTHING)
            return clear
        return self._font(style).render(drawable(words), True, style.colour)

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


def _load_font(size: int, bold: bool) -> pygame.font.Font:
    """Return a font by its nominal size [px]: Roboto, which panels have too, or pygame's own."""
    package = importlib.util.find_spec("imgui_bundle")
    if package is not None and package.submodule_search_locations:
        name = "Roboto-Bold.ttf" if bold else "Roboto-Regular.ttf"
        path = Path(package.submodule_search_locations[0]) / "assets" / "fonts" / "Roboto" / name
        if path.is_file():
            return pygame.font.Font(path, size)
    return pygame.font.Font(None, round(1.4 * size))
