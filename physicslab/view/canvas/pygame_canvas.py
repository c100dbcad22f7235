"""A canvas on a pygame surface."""

from __future__ import annotations

import functools
import importlib.util
from collections import OrderedDict
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pygame
from numpy.typing import NDArray

from physicslab.view.canvas.cached_layer import CachedLayer
from physicslab.view.canvas.canvas import Align, Look, Numbers, Painter, Points, Rect, TextStyle, TextSurface
from physicslab.view.canvas.rounded import rounded
from physicslab.view.canvas.theme import Colour

__all__ = ["PygameCanvas"]

_KEPT_SURFACES = 512
_KEPT_SIZES = 4096
_RIM = 1.6
"""Width of the rims [px]."""


def _load_font(size: int, bold: bool) -> pygame.font.Font:
    """Return a font by its nominal size [px]: Noto Sans, which comes with pygame_gui, or pygame's own."""
    package = importlib.util.find_spec("pygame_gui")
    if package is not None and package.submodule_search_locations:
        name = "NotoSans-Bold.ttf" if bold else "NotoSans-Regular.ttf"
        path = Path(package.submodule_search_locations[0]) / "data" / name
        if path.is_file():
            return pygame.font.Font(path, size)
    return pygame.font.Font(None, round(1.4 * size))


class PygameCanvas:
    """Draws on a surface of 32 bits a pixel: the window's, or one that no window shows.

    Bodies and lines are painted into its pixels by compiled loops; words and panels are surfaces that are
    kept, and drawn again for as long as they stay the same.

    Parameters
    ----------
    surface : pygame.Surface
        What to draw on.
    """

    def __init__(self, surface: pygame.Surface) -> None:
        if surface.get_bytesize() != 4:
            raise ValueError(f"a canvas needs 32 bits a pixel; this surface has {surface.get_bitsize()}")
        self.surface = surface
        red, green, blue, _ = surface.get_shifts()
        self._shifts = np.array((red, green, blue), np.uint32)
        self._kept: OrderedDict[tuple[object, ...], pygame.Surface] = OrderedDict()
        self._fonts: dict[tuple[int, bool], pygame.font.Font] = {}
        self._colours: dict[Colour, int] = {}
        self._sheets: dict[str, CachedLayer] = {}
        self._sizes: dict[tuple[str, TextStyle], tuple[int, int]] = {}

    @property
    def size(self) -> tuple[int, int]:
        """Width and height [px]."""
        return self.surface.get_size()

    def _pixels(self) -> NDArray[np.uint32]:
        # The surface is locked, and cannot be blitted to, until the array is let go of: so it is never kept.
        flat = np.frombuffer(self.surface.get_buffer(), np.uint32)
        pixels: NDArray[np.uint32] = flat.reshape(self.surface.get_height(), self.surface.get_pitch() // 4)
        return pixels

    def _packed(self, colours: NDArray[np.uint8]) -> NDArray[np.uint32]:
        shifted = colours.astype(np.uint32) << self._shifts
        packed: NDArray[np.uint32] = shifted[:, 0] | shifted[:, 1] | shifted[:, 2]
        return packed

    def clear(self, colour: Colour) -> None:
        """Fill the whole picture."""
        self.surface.fill(colour)

    def discs(self, centre: Points, radius: Numbers, angle: Numbers, look: Look) -> None:
        """Draw discs, each with a rim and a line that shows its angle, or hatched."""
        paint_discs = _painter("paint_discs")
        fill, rim = self._packed(look.fill), self._packed(look.rim)
        centre, radius, angle = _plain(centre), _plain(radius), _plain(angle)
        paint_discs(self._pixels(), centre, radius, angle, fill, rim, look.hatched, _RIM)

    def boxes(self, centre: Points, extent: Points, angle: Numbers, look: Look) -> None:
        """Draw boxes of the given widths and heights, each with a rim and a notch, or hatched."""
        paint_boxes = _painter("paint_boxes")
        fill, rim = self._packed(look.fill), self._packed(look.rim)
        centre, half, angle = _plain(centre), _plain(0.5 * extent), _plain(angle)
        paint_boxes(self._pixels(), centre, half, angle, fill, rim, look.hatched, _RIM)

    def lines(
        self, start: Points, end: Points, colour: Colour, width: float = 1.0, opacity: float | Numbers = 1.0
    ) -> None:
        """Draw straight lines of one kind, with round ends; each may have an opacity of its own."""
        paint_lines = _painter("paint_lines")
        packed = self._colours.get(colour)
        if packed is None:
            packed = self._colours[colour] = int(self._packed(np.array([colour], np.uint8))[0])
        shares = np.full(len(start), opacity) if isinstance(opacity, float) else _plain(opacity)
        paint_lines(self._pixels(), _plain(start), _plain(end), width, packed, shares)

    def strokes(self, start: Points, end: Points, colour: NDArray[np.uint8], width: Numbers) -> None:
        """Draw straight lines with round ends, each of its own colour (n, 3) and width."""
        paint_strokes = _painter("paint_strokes")
        paint = self._packed(colour)
        paint_strokes(self._pixels(), _plain(start), _plain(end), _plain(width), paint)

    def _keep(self, key: tuple[object, ...], make: Callable[[], pygame.Surface]) -> pygame.Surface:
        surface = self._kept.get(key)
        if surface is None:
            surface = self._kept[key] = make()
            if len(self._kept) > _KEPT_SURFACES:
                self._kept.popitem(last=False)
        else:
            self._kept.move_to_end(key)
        return surface

    def panel(self, rect: Rect, colour: Colour, outline: Colour, opacity: float = 1.0) -> None:
        """Draw a rectangle with rounded corners and a thin outline."""
        left, top, width, height = rect
        if width > 0 and height > 0:
            made = self.kept_panel((width, height), colour, outline, opacity)
            self.surface.blit(made, (left, top), special_flags=pygame.BLEND_PREMULTIPLIED)

    def kept_panel(
        self, size: tuple[int, int], colour: Colour, outline: Colour, opacity: float
    ) -> pygame.Surface:
        """Return the picture of a panel, its colours multiplied by its opacity."""
        key = ("panel", *size, colour, outline, opacity)
        return self._keep(key, lambda: rounded(size, colour, outline, opacity))

    def text(self, words: str, at: tuple[int, int], style: TextStyle, align: Align = "left") -> None:
        """Write one line; ``at`` is its top left, top middle or top right."""
        line = self.kept_text(words, style)
        shift = {"left": 0, "centre": line.get_width() // 2, "right": line.get_width()}[align]
        self.surface.blit(line, (at[0] - shift, at[1]))

    def kept_text(self, words: str, style: TextStyle) -> pygame.Surface:
        """Return the picture of one line."""
        font = self._font(style)
        return self._keep(("text", words, style), lambda: font.render(words, True, style.colour))

    def text_size(self, words: str, style: TextStyle) -> tuple[int, int]:
        """Return the width and height of one line [px]."""
        key = words, style
        size = self._sizes.get(key)
        if size is None:
            if len(self._sizes) >= _KEPT_SIZES:
                self._sizes.clear()
            size = self._sizes[key] = self._font(style).size(words)
        return size

    def layer(self, name: str, rect: Rect, version: object, draw: Callable[[TextSurface], None]) -> None:
        """Draw words and panels that lie within ``rect`` [px] and stay for as long as ``version`` does."""
        kept = self._sheets.get(name)
        if kept is None:
            kept = self._sheets[name] = CachedLayer(self)
        kept.put(rect, version, draw)

    def paint(self, painter: Painter) -> None:
        """Let something else draw on the picture."""
        painter(self.surface)

    def _font(self, style: TextStyle) -> pygame.font.Font:
        key = (style.size, style.bold)
        if key not in self._fonts:
            pygame.font.init()  # where there is no window, nobody did
            self._fonts[key] = _load_font(*key)
        return self._fonts[key]


@functools.cache
def _painter(name: str) -> Any:
    """Return a loop of the rasteriser, ready to be called.

    numba is imported here and not above: words and bars are drawn before it is there.
    """
    from physicslab.kernels import compile_kernels, raster

    painter = getattr(raster, name)
    compile_kernels((painter,))
    return painter


def _plain(numbers: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return numbers as the compiled loops take them, whatever stride and type they came in."""
    return np.ascontiguousarray(numbers, np.float64)
