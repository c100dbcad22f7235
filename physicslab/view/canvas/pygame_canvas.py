"""A canvas on a pygame surface."""

from collections.abc import Callable, Hashable
from typing import Any

import numpy as np
import pygame
from numpy.typing import NDArray

from physicslab.languages.language import language
from physicslab.theme import RIM, Colour
from physicslab.view.canvas.canvas import Align, Look, Numbers, Painter, Points, Rect, Rounded, TextStyle
from physicslab.view.canvas.plain_shapes import draw_boxes, draw_discs, draw_rounded, draw_strokes
from physicslab.view.canvas.surface_cache import GLOW_LEVELS, SurfaceCache


class PygameCanvas:
    """Draws on a surface of 32 bits a pixel: the window's, or one that no window shows.

    Bodies and lines are painted into its pixels by compiled loops; words and panels are surfaces that are
    kept, and drawn again for as long as they stay the same.

    Parameters
    ----------
    surface : pygame.Surface
        The surface to draw on.
    """

    def __init__(self, surface: pygame.Surface) -> None:
        if surface.get_bytesize() != 4:
            raise ValueError(f"a canvas needs 32 bits a pixel; this surface has {surface.get_bitsize()}")
        self.surface, self.language = surface, language()
        red, green, blue, _ = surface.get_shifts()
        self._shifts = np.array((red, green, blue), np.uint32)
        self._surfaces = SurfaceCache()
        self._colours: dict[Colour, int] = {}
        self._kept: pygame.Surface | None = None
        self._kept_key: Hashable = None

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

    def clear(self, top: Colour, bottom: Colour, grain: int = 0) -> None:
        """Fill the whole picture from the colour of its top to that of its bottom, with some grain."""
        if top == bottom and not grain:
            self.surface.fill(top)
        else:
            self.surface.blit(self._surfaces.sky(self.size, top, bottom, grain), (0, 0))

    def keep(self, key: Hashable, draw: Callable[[], None]) -> None:
        """Begin the picture as ``draw`` does; the second one with the same key is kept."""
        whole = (key, self.size)
        if self._kept is not None and self._kept_key == whole:
            self.surface.blit(self._kept, (0, 0))
            return
        draw()
        self._kept = self.surface.copy() if self._kept_key == whole else None
        self._kept_key = whole

    def glows(self, centre: Points, radius: Numbers, colour: Colour, strength: Numbers) -> None:
        """Add light to what is there: brightest, by a strength (0 to 1), in the middle of each disc (n,)."""
        spots = []
        for (x, y), r, share in zip(centre.tolist(), radius.tolist(), strength.tolist(), strict=True):
            made = self._surfaces.glow(
                max(round(r), 1), colour, round(GLOW_LEVELS * min(max(share, 0.0), 1.0))
            )
            spots.append((made, (round(x) - made.get_width() // 2, round(y) - made.get_height() // 2)))
        self.surface.fblits(spots, pygame.BLEND_RGB_ADD)

    def discs(self, centre: Points, radius: Numbers, angle: Numbers, look: Look) -> None:
        """Draw discs, each with a rim, and a wedge that shows its angle where it is not flat."""
        self._bodies("paint_discs", draw_discs, (centre, radius, angle), look)

    def boxes(self, centre: Points, extent: Points, angle: Numbers, look: Look) -> None:
        """Draw boxes of the given widths and heights, each with a rim."""
        self._bodies("paint_boxes", draw_boxes, (centre, 0.5 * extent, angle), look)

    def _bodies(
        self, name: str, draw: Callable[..., None], placed: tuple[NDArray[np.float64], ...], look: Look
    ) -> None:
        """Draw bodies by a loop of the rasteriser, or plainly while it is to be interpreted."""
        paint = _painter(name)
        if paint is None:
            draw(self.surface, *placed, look, RIM)
            return
        fill, rim = self._packed(look.fill), self._packed(look.rim)
        paint(self._pixels(), *map(_plain, placed), fill, rim, look.finish, RIM, look.shadow)

    def rounded(self, shapes: Rounded, look: Look) -> None:
        """Draw rounded polygons, each with a rim."""
        paint_rounded = _painter("paint_rounded")
        if paint_rounded is None:
            draw_rounded(self.surface, shapes, look, RIM)
            return
        fill, rim = self._packed(look.fill), self._packed(look.rim)
        corners, radius = _plain(shapes.corners.reshape(len(fill), -1)), _plain(shapes.radius)
        paint_rounded(
            self._pixels(), corners, shapes.vertices, radius, fill, rim, look.finish, RIM, look.shadow
        )

    def lines(
        self, start: Points, end: Points, colour: Colour, width: float = 1.0, opacity: float | Numbers = 1.0
    ) -> None:
        """Draw straight lines of one kind, with round ends; each may have an opacity of its own."""
        paint_lines = _painter("paint_lines")
        shares = np.full(len(start), opacity) if isinstance(opacity, float) else _plain(opacity)
        if paint_lines is None:
            alike = np.tile(np.array(colour, np.uint8), (len(start), 1))
            draw_strokes(self.surface, start, end, alike, np.full(len(start), width), shares)
            return
        packed = self._colours.get(colour)
        if packed is None:
            packed = self._colours[colour] = int(self._packed(np.array([colour], np.uint8))[0])
        paint_lines(self._pixels(), _plain(start), _plain(end), width, packed, shares)

    def strokes(self, start: Points, end: Points, colour: NDArray[np.uint8], width: Numbers) -> None:
        """Draw straight lines with round ends, each of its own colour (n, 3) and width."""
        paint_strokes = _painter("paint_strokes")
        if paint_strokes is None:
            draw_strokes(self.surface, start, end, colour, width, np.ones(len(start)))
            return
        paint = self._packed(colour)
        paint_strokes(self._pixels(), _plain(start), _plain(end), _plain(width), paint)

    def panel(self, rect: Rect, colour: Colour, outline: Colour, opacity: float = 1.0) -> None:
        """Draw a rectangle with rounded corners and a thin outline."""
        left, top, width, height = rect
        if width > 0 and height > 0:
            made = self._surfaces.panel((width, height), colour, outline, opacity)
            self.surface.blit(made, (left, top), special_flags=pygame.BLEND_PREMULTIPLIED)

    def text(self, words: str, at: tuple[int, int], style: TextStyle, align: Align = "left") -> None:
        """Write one line; ``at`` is its top left, top middle or top right."""
        line = self._surfaces.text(self.language.reword(words), style)
        left = at[0] - {"left": 0, "centre": line.get_width() // 2, "right": line.get_width()}[align]
        self.surface.blit(line, (left, at[1]))

    def text_size(self, words: str, style: TextStyle) -> tuple[int, int]:
        """Return the width and height of one line [px]."""
        return self._surfaces.text_size(self.language.reword(words), style)

    def paint(self, painter: Painter) -> None:
        """Let something else draw on the picture."""
        painter(self.surface)


def _painter(name: str) -> Any | None:
    """Return a loop of the rasteriser, ready to be called; ``None`` while it is to be interpreted.

    That would take seconds a picture. numba is imported here and not above: words and bars are drawn before
    it is there.
    """
    from physicslab.kernels import compile_kernels, raster

    painter: Any = getattr(raster, name)
    if not painter.compiled:
        compile_kernels((painter,))
    return painter if painter.compiled else None


def _plain(numbers: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return numbers as the compiled loops take them, whatever stride and type they came in."""
    return np.ascontiguousarray(numbers, np.float64)
