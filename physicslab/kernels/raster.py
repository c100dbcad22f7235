"""Rounded polygons, discs and boxes among them, and lines with smooth edges, painted into pixels.

Coverage comes from the signed distance to the outline [px], so position, size and angle are exact to a
fraction of a pixel. Raised shapes are lit from above, and may cast a soft shadow. Pixels are 32 bits of
four 8-bit channels in any order; colours are packed in the same order. Pixel (row, column) covers
[column, column + 1) x [row, row + 1), and y points down. Nothing is written outside the array; coordinates
must be finite.

A row of a shape is three runs: an edge where every pixel is mixed, a core of one colour, and an edge again.
"""

import math
from typing import Annotated

import numpy as np
from numba import uint32
from numpy.typing import NDArray

from physicslab.kernels import Numbers, Rows, Vectors, inlined, kernel
from physicslab.kernels import finishes as F
from physicslab.kernels.finishes import hatched, lit, mixed, shaded, textured, unit

Pixels = Annotated[NDArray[np.uint32], uint32[:, ::1]]
"""A uint32 array (height, width): a picture."""
Colours = Annotated[NDArray[np.uint32], uint32[::1]]
"""A uint32 array (n,): packed colours."""


@inlined
def _pixel(place: float, count: int) -> int:
    """Return the first of ``count`` pixels whose middle is not before a place; ``count`` if none is.

    It has no sign, so that an index is not tested for counting from the end: a third of a line's time.
    """
    return np.uint64(min(max(math.ceil(place - 0.5), 0.0), float(count)))  # type: ignore[return-value]


@inlined
def _stroke(
    pixels: Pixels, xa: float, ya: float, xb: float, yb: float, half: float, colour: int, opacity: float
) -> None:
    """Paint a line with round ends of a given half width."""
    height, width = pixels.shape
    reach = half + 0.5
    dx, dy = xb - xa, yb - ya
    length = math.sqrt(dx * dx + dy * dy)
    ux, uy = (dx / length, dy / length) if length > 0.0 else (1.0, 0.0)
    # Along a row, the band around the endless line is so wide; a line along the row has no such limit.
    slant = dx / dy if abs(dy) > 1e-9 else 0.0
    aside = reach / abs(uy) if abs(uy) > 1e-9 else 1e9
    low, high = max(min(xa, xb) - reach, 0.0), float(width)
    limit = int(_pixel(max(xa, xb) + reach, width))
    # As many pixels in each row, though some may not be covered: the processor predicts where a row ends.
    count = int(min(2.0 * aside, high)) + 2
    for row in range(_pixel(min(ya, yb) - reach, height), _pixel(max(ya, yb) + reach, height)):
        py = row + 0.5 - ya
        first = int(min(max(xa + py * slant - aside, low), high) + 0.5)
        px = first + 0.5 - xa
        along, away = px * ux + py * uy, px * uy - py * ux
        for column in range(first, min(first + count, limit)):
            past = max(-along, along - length, 0.0)
            cover = unit(reach - math.sqrt(away * away + past * past)) * opacity
            pixels[row, np.uint64(column)] = mixed(int(pixels[row, np.uint64(column)]), colour, cover)
            along, away = along + ux, away + uy


@inlined
def _rimmed(depth: float, band: float, inside: int, edge: int) -> int:
    """Return the colour of a shape at a depth below its outline [px], where a rim is ``band`` px wide."""
    share = band + 0.5 - depth
    if share >= 1.0:
        return edge
    return mixed(inside, edge, max(share, 0.0))


@inlined
def _wedge(pixels: Pixels, x: float, y: float, r: float, angle: float) -> None:
    """Paint a bright sector from the middle of a disc towards its angle."""
    height, width = pixels.shape
    half, reach = F.WEDGE * (1.0 + 3.0 / r), F.WEDGE_REACH * r
    low_x, low_y = math.cos(angle - half), -math.sin(angle - half)
    high_x, high_y = math.cos(angle + half), -math.sin(angle + half)
    tip_x, tip_y = math.cos(angle), -math.sin(angle)
    left, right = min(0.0, min(low_x, high_x, tip_x)) * reach, max(0.0, max(low_x, high_x, tip_x)) * reach
    top, bottom = min(0.0, min(low_y, high_y, tip_y)) * reach, max(0.0, max(low_y, high_y, tip_y)) * reach
    for row in range(_pixel(y + top - 0.5, height), _pixel(y + bottom + 0.5, height)):
        dy = row + 0.5 - y
        for column in range(_pixel(x + left - 0.5, width), _pixel(x + right + 0.5, width)):
            dx = column + 0.5 - x
            cover = unit(0.5 + dx * low_y - dy * low_x)
            cover *= unit(0.5 + dy * high_x - dx * high_y)
            cover *= unit(0.5 + reach - math.sqrt(dx * dx + dy * dy))
            pixels[row, column] = mixed(int(pixels[row, column]), F.WHITE, F.WEDGE_SHARE * cover)


_ALONG_X, _ALONG_Y, _BESIDE, _FROM, _LENGTH = range(5)
"""A side: its direction, the place of its line across that and of its beginning along it, its length [px]."""


@inlined
def _take_sides(corners: Vectors, i: int, count: int, sides: Vectors) -> tuple[tuple[float, ...], float]:
    """Fill in the sides of a core; return its left, right, top and bottom, and half of its least side [px].

    One vertex has no side: its place stands where the direction of the first one would be.
    """
    left, right, top, bottom, least = math.inf, -math.inf, math.inf, -math.inf, math.inf
    for k in range(count):
        x, y, end = corners[i, 2 * k], corners[i, 2 * k + 1], 2 * (k + 1) if k + 1 < count else 0
        left, right, top, bottom = min(left, x), max(right, x), min(top, y), max(bottom, y)
        along_x, along_y = corners[i, end] - x, corners[i, end + 1] - y
        length = math.sqrt(along_x * along_x + along_y * along_y)
        least, share = min(least, length), 1.0 / length if length > 0.0 else 0.0
        along_x, along_y = along_x * share, along_y * share
        sides[k, _ALONG_X], sides[k, _ALONG_Y], sides[k, _LENGTH] = along_x, along_y, length
        sides[k, _BESIDE], sides[k, _FROM] = along_x * y - along_y * x, along_x * x + along_y * y
    if count == 1:
        sides[0, _ALONG_X], sides[0, _ALONG_Y] = left, top
    return (left, right, top, bottom), 0.5 * least


@inlined
def _beyond_core(px: float, py: float, sides: Vectors, count: int) -> float:
    """Return how far a place is from a core [px], negative within; y points down."""
    if count == 1:
        dx, dy = px - sides[0, _ALONG_X], py - sides[0, _ALONG_Y]
        return math.sqrt(dx * dx + dy * dy)
    farthest, side = -math.inf, 0
    for k in range(count):
        away = sides[k, _ALONG_X] * py - sides[k, _ALONG_Y] * px - sides[k, _BESIDE]
        if away > farthest:
            farthest, side = away, k
    if farthest <= 0.0:
        return farthest
    along = sides[side, _ALONG_X] * px + sides[side, _ALONG_Y] * py - sides[side, _FROM]
    past = max(-along, along - sides[side, _LENGTH], 0.0)
    return math.sqrt(farthest * farthest + past * past)


@inlined
def _run(
    sides: Vectors, count: int, out: float, y: float, low: float, high: float, width: int
) -> tuple[int, int]:
    """Return the pixels [first, end) of a row, at y, that lie within a core whose sides are moved by ``out``.

    They are looked for from ``low`` to ``high`` [px]. A core of one vertex is a disc of that radius.
    """
    if count == 1:
        dy = y - sides[0, _ALONG_Y]
        reach = math.sqrt(max(out * abs(out) - dy * dy, 0.0))
        return _pixel(sides[0, _ALONG_X] - reach, width), _pixel(sides[0, _ALONG_X] + reach, width)
    for k in range(count):
        slope, room = sides[k, _ALONG_Y], out + sides[k, _BESIDE] - sides[k, _ALONG_X] * y
        if slope < -1e-9:
            high = min(high, -room / slope)
        elif slope > 1e-9:
            low = max(low, -room / slope)
        elif room < 0.0:
            high = low
    return _pixel(low, width), _pixel(max(low, high), width)


@inlined
def _shadow(
    pixels: Pixels, sides: Vectors, count: int, radius: float, bounds: tuple[float, ...], opacity: float
) -> None:
    """Paint what is seen of a body's shadow around it."""
    height, width = pixels.shape
    left, right, top, bottom = bounds
    reach, own = radius + F.SHADOW_SOFT, radius - 0.5 if count == 1 else min(radius - 0.5, 0.0)
    low, high = left - reach, right + reach
    for row in range(
        _pixel(top + F.SHADOW_DOWN - reach, height), _pixel(bottom + F.SHADOW_DOWN + reach, height)
    ):
        py = row + 0.5
        first, last = _run(sides, count, reach, py - F.SHADOW_DOWN, low, high, width)
        begin, end = _run(sides, count, own, py, low, high, width)
        if begin >= end:
            begin = end = last
        for part in range(2):
            start, stop = (first, min(begin, last)) if part == 0 else (max(end, first), last)
            for column in range(start, max(start, stop)):
                px = column + 0.5
                if own == radius - 0.5 or _beyond_core(px, py, sides, count) > radius - 0.5:
                    away = _beyond_core(px, py - F.SHADOW_DOWN, sides, count) - radius
                    share = opacity * unit(0.5 - 0.5 * away / F.SHADOW_SOFT)
                    pixels[row, column] = mixed(int(pixels[row, column]), F.BLACK, share)


@kernel
def paint_rounded(
    pixels: Pixels, corners: Vectors, vertices: Rows, radius: Numbers, angle: Numbers,
    fill: Colours, rim: Colours, finish: Rows, rim_width: float, shadow: float, sides: Vectors,
) -> None:  # fmt: skip
    """Paint rounded polygons with a rim, lit by their finish: of one vertex discs, of four boxes.

    ``corners`` (n, 16) holds x and y of each vertex in turn [px], counter-clockwise as it is seen; ``angle``
    is counter-clockwise on the screen [rad], and seen by the texture and by the wedge of a disc that is not
    flat; ``shadow`` is the opacity of the shadows, which lie below all of the shapes.
    ``sides`` (8, 5) is room for the sides of one of them.
    """
    height, width = pixels.shape
    for i in range(len(radius) if shadow > 0.0 else 0):
        bounds, half = _take_sides(corners, i, vertices[i], sides)
        if radius[i] + half >= F.SHADOW_FROM:
            _shadow(pixels, sides, vertices[i], radius[i], bounds, shadow)
    for i in range(len(radius)):
        count, r, inside, edge, kind = vertices[i], radius[i], int(fill[i]), int(rim[i]), finish[i]
        bright, dim = lit(inside, kind), shaded(inside, kind)
        (left, right, top, bottom), half = _take_sides(corners, i, count, sides)
        x, y, reach = 0.0, 0.0, r + 0.5
        for k in range(count):
            x, y = x + corners[i, 2 * k] / count, y + corners[i, 2 * k + 1] / count
        c, s = math.cos(angle[i]), math.sin(angle[i])
        band = min(rim_width, 0.35 * (r + half))
        core = r - band - 0.5 if count == 1 else min(r - band - 0.5, 0.0)
        is_round = count == 1 and kind != F.FLAT
        per_square = 1.0 / (F.LIGHT_REACH * r * r) if is_round else 0.0
        deep = max(F.DEEP, bottom - top + 2.0 * r) if kind == F.GROUND else bottom - top + 2.0 * r
        for row in range(_pixel(top - reach, height), _pixel(bottom + reach, height)):
            py, dy = row + 0.5, row + 0.5 - y
            first, end = _run(sides, count, reach, py, left - reach, right + reach, width)
            begin, last = _run(sides, count, core, py, left - reach, right + reach, width)
            if begin >= last:
                begin = last = end
            below = dy + F.LIGHT_Y * r
            share = (below * below + 0.5 * r * r) * per_square if is_round else (py - top + r) / deep
            level = mixed(bright, dim, unit(share))
            for part in range(2):
                for column in range(first if part == 0 else last, begin if part == 0 else end):
                    dx, under = column + 0.5 - x, int(pixels[row, column])
                    depth = r - _beyond_core(column + 0.5, py, sides, count)
                    if depth > -0.5:
                        colour = level
                        if kind >= F.GROUND:
                            colour = textured(kind, c * dx - s * dy, s * dx + c * dy, level, edge, under)
                        colour = _rimmed(depth, band, colour, edge)
                        pixels[row, column] = mixed(under, colour, unit(depth + 0.5))
            if is_round:
                for column in range(begin, last):
                    dx = column + 0.5 - x
                    away = dx + F.LIGHT_X * r
                    colour = mixed(bright, dim, unit((away * away + below * below) * per_square))
                    if kind >= F.GROUND:
                        u, v = c * dx - s * dy, s * dx + c * dy
                        colour = textured(kind, u, v, colour, edge, int(pixels[row, column]))
                    pixels[row, column] = colour
            elif kind == F.GROUND:  # by itself: ground fills half of many pictures
                ahead, place = (c + s) * F.DIAGONAL, (c - s) * F.DIAGONAL * dy
                for column in range(begin, last):
                    diagonal = place + ahead * (column + 0.5 - x)
                    pixels[row, column] = hatched(diagonal, level, edge)
            elif kind > F.GROUND:
                for column in range(begin, last):
                    dx, under = column + 0.5 - x, int(pixels[row, column])
                    u, v = c * dx - s * dy, s * dx + c * dy
                    pixels[row, column] = textured(kind, u, v, level, edge, under)
            else:
                for column in range(begin, last):
                    pixels[row, column] = level
        if is_round and r >= F.WEDGE_FROM and kind >= F.LIT and kind != F.GROUND:
            _wedge(pixels, x, y, r, angle[i])


@kernel
def paint_lines(
    pixels: Pixels, start: Vectors, end: Vectors, line_width: Numbers, opacity: Numbers, colour: Colours
) -> None:
    """Paint straight lines with round ends in their order; ends and widths in px, opacities 0..1."""
    for i in range(len(start)):
        half, paint = 0.5 * line_width[i], int(colour[i])
        _stroke(pixels, start[i, 0], start[i, 1], end[i, 0], end[i, 1], half, paint, opacity[i])
