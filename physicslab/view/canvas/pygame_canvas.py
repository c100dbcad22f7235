"""A canvas on a pygame surface."""

from collections.abc import Callable, Hashable
from typing import Any

import numpy as np
import pygame
from numpy.typing import NDArray

from physicslab.languages.language import language
from physicslab.theme import RIM, Colour
from physicslab.view.canvas.canvas import Align, Look, Numbers, Painter, Points, Rect, Rounded, TextStyle
from physicslab.view.canvas.plain_shapes import draw_lines, draw_rounded
from physicslab.view.canvas.surface_cache import GLOW_LEVELS, SurfaceCache

_BOX = np.array(((1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), *((1.0, -1.0),) * 5))
"""The corners of a box in half extents, the last one repeated as :class:`Rounded` has it."""


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
        self._surfaces, self._sides = SurfaceCache(), np.empty((len(_BOX), 5))
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
        corners = np.repeat(centre[:, None], len(_BOX), axis=1)
        self._bodies(Rounded(corners, np.ones(len(centre), np.int64), radius), angle, look)

    def boxes(self, centre: Points, extent: Points, angle: Numbers, look: Look) -> None:
        """Draw boxes of the given widths and heights, each with a rim."""
        c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
        a, b = (0.5 * extent[:, axis, None] * _BOX[:, axis] for axis in (0, 1))
        corners = centre[:, None] + np.stack((c * a - s * b, -s * a - c * b), axis=2)
        self._bodies(Rounded(corners, np.full(len(centre), 4), np.zeros(len(centre))), angle, look)

    def rounded(self, shapes: Rounded, look: Look) -> None:
        """Draw rounded polygons, each with a rim; they have turned as far as their first vertex has."""
        own = np.arange(len(_BOX)) < shapes.vertices[:, None]
        middle = (shapes.corners * own[:, :, None]).sum(axis=1) / shapes.vertices[:, None]
        way = shapes.corners[:, 0] - middle
        self._bodies(shapes, np.arctan2(-way[:, 1], way[:, 0]), look)

    def _bodies(self, shapes: Rounded, angle: Numbers, look: Look) -> None:
        """Draw shapes by the loop of the rasteriser, or plainly while it is to be interpreted."""
        paint = _painter("paint_rounded")
        if paint is None:
            draw_rounded(self.surface, shapes, angle, look, RIM)
            return
        placed = map(_plain, (shapes.radius, angle))
        colours = self._packed(look.fill), self._packed(look.rim), look.finish
        corners = _plain(shapes.corners.reshape(len(angle), -1))
        paint(self._pixels(), corners, shapes.vertices, *placed, *colours, RIM, look.shadow, self._sides)

    def lines(
        self, start: Points, end: Points, colour: Colour | NDArray[np.uint8], width: float | Numbers = 1.0,
        opacity: float | Numbers = 1.0,
    ) -> None:  # fmt: skip
        """Draw lines with round ends; each may have its own colour (n, 3), width or opacity (n,)."""
        colours = np.broadcast_to(np.array(colour, np.uint8), (len(start), 3))
        widths, opacities = (np.zeros(len(start)) + one for one in (width, opacity))
        paint = _painter("paint_lines")
        if paint is None:
            draw_lines(self.surface, start, end, colours, widths, opacities)
            return
        paint(self._pixels(), *map(_plain, (start, end, widths, opacities)), self._packed(colours))

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
