"""Discs, boxes, rounded polygons and lines with smooth edges, painted into an array of pixels.

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
def _disc_edge(
    pixels: Pixels, row: int, first: int, end: int,
    x: float, dy: float, r: float, band: float, inside: int, edge: int,
) -> None:  # fmt: skip
    """Paint a run of a disc's row that holds rim, or half-covered pixels."""
    for column in range(first, end):
        dx = column + 0.5 - x
        depth = r - math.sqrt(dx * dx + dy * dy)
        colour = _rimmed(depth, band, inside, edge)
        if depth < 0.5:
            colour = mixed(int(pixels[row, column]), colour, max(depth + 0.5, 0.0))
        pixels[row, column] = colour


@inlined
def _shadow_of_disc(pixels: Pixels, x: float, y: float, r: float, opacity: float) -> None:
    """Paint what is seen of a disc's shadow around it."""
    height, width = pixels.shape
    outer, own, middle = r + F.SHADOW_SOFT, r - 0.5, y + F.SHADOW_DOWN
    for row in range(_pixel(middle - outer, height), _pixel(middle + outer, height)):
        dy, from_own = row + 0.5 - middle, row + 0.5 - y
        reach = math.sqrt(max(outer * outer - dy * dy, 0.0))
        core = math.sqrt(max(own * own - from_own * from_own, 0.0))
        for part in range(2):
            first = _pixel(x - reach, width) if part == 0 else _pixel(x + core, width)
            end = _pixel(x - core, width) if part == 0 else _pixel(x + reach, width)
            for column in range(first, end):
                dx = column + 0.5 - x
                away = math.sqrt(dx * dx + dy * dy) - r
                share = opacity * unit(0.5 - 0.5 * away / F.SHADOW_SOFT)
                pixels[row, column] = mixed(int(pixels[row, column]), F.BLACK, share)


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


@kernel
def paint_discs(
    pixels: Pixels, centre: Vectors, radius: Numbers, angle: Numbers,
    fill: Colours, rim: Colours, finish: Rows, rim_width: float, shadow: float,
) -> None:  # fmt: skip
    """Paint discs with a rim, lit by their finish; a wedge shows how far each has turned that is not flat.

    Lengths are in px, ``angle`` is counter-clockwise on the screen [rad]; ``shadow`` is the opacity of the
    shadows, which lie below all of the discs.
    """
    height, width = pixels.shape
    for i in range(len(radius) if shadow > 0.0 else 0):
        if radius[i] >= F.SHADOW_FROM:
            _shadow_of_disc(pixels, centre[i, 0], centre[i, 1], radius[i], shadow)
    for i in range(len(radius)):
        x, y, r, kind = centre[i, 0], centre[i, 1], radius[i], finish[i]
        inside, edge = int(fill[i]), int(rim[i])
        bright, dim = lit(inside, kind), shaded(inside, kind)
        c, s = math.cos(angle[i]), math.sin(angle[i])
        band = min(rim_width, 0.35 * r)
        outer, inner = r + 0.5, max(r - band - 0.5, 0.0)
        per_square = 1.0 / (F.LIGHT_REACH * r * r)
        for row in range(_pixel(y - outer, height), _pixel(y + outer, height)):
            dy = row + 0.5 - y
            reach = math.sqrt(max(outer * outer - dy * dy, 0.0))
            core = math.sqrt(max(inner * inner - dy * dy, 0.0))
            left, right = _pixel(x - reach, width), _pixel(x + reach, width)
            core_left, core_right = _pixel(x - core, width), _pixel(x + core, width)
            below = dy + F.LIGHT_Y * r
            level = mixed(bright, dim, unit((below * below + 0.5 * r * r) * per_square))
            _disc_edge(pixels, row, left, core_left, x, dy, r, band, level, edge)
            if kind == F.FLAT:
                for column in range(core_left, core_right):
                    pixels[row, column] = inside
            else:
                for column in range(core_left, core_right):
                    dx = column + 0.5 - x
                    away = dx + F.LIGHT_X * r
                    colour = mixed(bright, dim, unit((away * away + below * below) * per_square))
                    if kind >= F.GROUND:
                        u, v = c * dx - s * dy, s * dx + c * dy
                        colour = textured(kind, u, v, colour, edge, int(pixels[row, column]))
                    pixels[row, column] = colour
            _disc_edge(pixels, row, core_right, right, x, dy, r, band, level, edge)
        if r >= F.WEDGE_FROM and kind >= F.LIT and kind != F.GROUND:
            _wedge(pixels, x, y, r, angle[i])


@inlined
def _between(slope: float, offset: float, half: float, low: float, high: float) -> tuple[float, float]:
    """Narrow [low, high] to the x with |slope x + offset| <= half; where none is, low >= high."""
    if abs(slope) < 1e-9:
        if abs(offset) <= half:
            return low, high
        return 0.0, 0.0
    a, b = (-half - offset) / slope, (half - offset) / slope
    return max(low, min(a, b)), min(high, max(a, b))


@inlined
def _box_run(c: float, s: float, dy: float, a: float, b: float, x: float, width: int) -> tuple[int, int]:
    """Return the pixels [first, end) of a row that lie in a turned box of half extents a and b."""
    low, high = _between(c, -s * dy, a, -1e9, 1e9)
    low, high = _between(s, c * dy, b, low, high)
    if low >= high or a <= 0.0 or b <= 0.0:
        return _pixel(0.0, 0), _pixel(0.0, 0)
    return _pixel(x + low, width), _pixel(x + high, width)


@inlined
def _box_edge(
    pixels: Pixels, row: int, first: int, end: int, x: float, dy: float, c: float, s: float,
    a: float, b: float, band: float, inside: int, edge: int,
) -> None:  # fmt: skip
    """Paint a run of a box's row that holds rim, or half-covered pixels."""
    for column in range(first, end):
        dx = column + 0.5 - x
        depth_u, depth_v = a - abs(c * dx - s * dy), b - abs(s * dx + c * dy)
        depth = min(depth_u, depth_v)
        colour = _rimmed(depth, band, inside, edge)
        if depth < 0.5:
            cover = unit(depth_u + 0.5) * unit(depth_v + 0.5)
            colour = mixed(int(pixels[row, column]), colour, cover)
        pixels[row, column] = colour


@inlined
def _shadow_of_box(
    pixels: Pixels, x: float, y: float, a: float, b: float, c: float, s: float, opacity: float
) -> None:
    """Paint what is seen of a box's shadow around it."""
    height, width = pixels.shape
    middle, out = y + F.SHADOW_DOWN, F.SHADOW_SOFT
    extent = abs(s) * (a + out) + abs(c) * (b + out)
    for row in range(_pixel(middle - extent, height), _pixel(middle + extent, height)):
        dy = row + 0.5 - middle
        left, right = _box_run(c, s, dy, a + out, b + out, x, width)
        own_left, own_right = _box_run(c, s, row + 0.5 - y, a - 0.5, b - 0.5, x, width)
        if own_left >= own_right:
            own_left = own_right = right
        for part in range(2):
            first, end = (left, min(own_left, right)) if part == 0 else (max(own_right, left), right)
            for column in range(first, end):
                dx = column + 0.5 - x
                beyond_u, beyond_v = abs(c * dx - s * dy) - a, abs(s * dx + c * dy) - b
                u, v = max(beyond_u, 0.0), max(beyond_v, 0.0)
                away = math.sqrt(u * u + v * v) + min(max(beyond_u, beyond_v), 0.0)
                share = opacity * unit(0.5 - 0.5 * away / out)
                pixels[row, column] = mixed(int(pixels[row, column]), F.BLACK, share)


@kernel
def paint_boxes(
    pixels: Pixels, centre: Vectors, half: Vectors, angle: Numbers,
    fill: Colours, rim: Colours, finish: Rows, rim_width: float, shadow: float,
) -> None:  # fmt: skip
    """Paint boxes with a rim, lit by their finish.

    Lengths are in px, ``half`` holds half the extents, ``angle`` is counter-clockwise on the screen [rad];
    ``shadow`` is the opacity of the shadows, which lie below all of the boxes.
    """
    height, width = pixels.shape
    for i in range(len(angle) if shadow > 0.0 else 0):
        a, b = half[i, 0], half[i, 1]
        if min(a, b) >= F.SHADOW_FROM:
            c, s = math.cos(angle[i]), math.sin(angle[i])
            _shadow_of_box(pixels, centre[i, 0], centre[i, 1], a, b, c, s, shadow)
    for i in range(len(angle)):
        x, y, a, b, kind = centre[i, 0], centre[i, 1], half[i, 0], half[i, 1], finish[i]
        inside, edge = int(fill[i]), int(rim[i])
        bright, dim = lit(inside, kind), shaded(inside, kind)
        c, s = math.cos(angle[i]), math.sin(angle[i])
        band = min(rim_width, 0.35 * min(a, b))
        core = band + 0.5
        extent = abs(s) * a + abs(c) * b + 0.75
        depth = max(F.DEEP, 2.0 * extent) if kind == F.GROUND else 2.0 * extent
        for row in range(_pixel(y - extent, height), _pixel(y + extent, height)):
            dy = row + 0.5 - y
            left, right = _box_run(c, s, dy, a + 0.5, b + 0.5, x, width)
            core_left, core_right = _box_run(c, s, dy, a - core, b - core, x, width)
            if core_left >= core_right:
                core_left = core_right = right
            level = mixed(bright, dim, unit((dy + extent) / depth))
            _box_edge(pixels, row, left, core_left, x, dy, c, s, a, b, band, level, edge)
            if kind == F.GROUND:  # by itself: ground fills half of many pictures
                ahead, place = (c + s) * F.DIAGONAL, (c - s) * F.DIAGONAL * dy
                for column in range(core_left, core_right):
                    diagonal = place + ahead * (column + 0.5 - x)
                    pixels[row, column] = hatched(diagonal, level, edge)
            elif kind > F.GROUND:
                for column in range(core_left, core_right):
                    dx = column + 0.5 - x
                    u, v = c * dx - s * dy, s * dx + c * dy
                    pixels[row, column] = textured(kind, u, v, level, edge, int(pixels[row, column]))
            else:
                for column in range(core_left, core_right):
                    pixels[row, column] = level
            _box_edge(pixels, row, core_right, right, x, dy, c, s, a, b, band, level, edge)


@inlined
def _beyond_core(px: float, py: float, corners: Vectors, i: int, count: int) -> float:
    """Return how far a place is from a core [px], negative within; y points down."""
    nearest, within = math.inf, count > 2
    for k in range(count):
        x, y = corners[i, 2 * k], corners[i, 2 * k + 1]
        end = 2 * (k + 1) if k + 1 < count else 0
        along_x, along_y = corners[i, end] - x, corners[i, end + 1] - y
        dx, dy = px - x, py - y
        square = along_x * along_x + along_y * along_y
        share = unit((dx * along_x + dy * along_y) / square) if square > 0.0 else 0.0
        away_x, away_y = dx - share * along_x, dy - share * along_y
        nearest = min(nearest, away_x * away_x + away_y * away_y)
        within = within and along_x * dy - along_y * dx <= 0.0
    return -math.sqrt(nearest) if within else math.sqrt(nearest)


@kernel
def paint_rounded(
    pixels: Pixels, corners: Vectors, vertices: Rows, radius: Numbers,
    fill: Colours, rim: Colours, finish: Rows, rim_width: float, shadow: float,
) -> None:  # fmt: skip
    """Paint rounded polygons with a rim, lit by their finish.

    ``corners`` (n, 16) holds x and y of each vertex in turn [px], counter-clockwise as it is seen; ``shadow``
    is the opacity of their shadows.
    """
    height, width = pixels.shape
    for i in range(len(radius)):
        count, inside, edge, kind = vertices[i], int(fill[i]), int(rim[i]), finish[i]
        bright, dim = lit(inside, kind), shaded(inside, kind)
        left, right, top, bottom, x, y = math.inf, -math.inf, math.inf, -math.inf, 0.0, 0.0
        for k in range(count):
            at_x, at_y = corners[i, 2 * k], corners[i, 2 * k + 1]
            left, right, top, bottom = min(left, at_x), max(right, at_x), min(top, at_y), max(bottom, at_y)
            x, y = x + at_x / count, y + at_y / count
        extent = bottom - top + 2.0 * radius[i]
        casts = shadow > 0.0 and min(extent, right - left + 2.0 * radius[i]) >= 2.0 * F.SHADOW_FROM
        down, soft = (F.SHADOW_DOWN, F.SHADOW_SOFT) if casts else (0.0, 0.5)
        reach = radius[i] + soft
        depth_of_light = max(F.DEEP, extent) if kind == F.GROUND else extent
        along_x, along_y = corners[i, 0] - x, corners[i, 1] - y
        length = max(math.sqrt(along_x * along_x + along_y * along_y), 1e-9)
        c, s = along_x / length, along_y / length
        for row in range(_pixel(top - reach, height), _pixel(bottom + down + reach, height)):
            py = row + 0.5
            level = mixed(bright, dim, unit((py - top + radius[i]) / depth_of_light))
            for column in range(_pixel(left - reach, width), _pixel(right + reach, width)):
                px, under = column + 0.5, int(pixels[row, column])
                depth = radius[i] - _beyond_core(px, py, corners, i, count)
                if casts and depth < 0.5:
                    away = _beyond_core(px, py - down, corners, i, count) - radius[i]
                    under = mixed(under, F.BLACK, shadow * unit(0.5 - 0.5 * away / soft))
                if depth > -0.5:
                    colour = level
                    if kind >= F.GROUND:
                        dx, dy = px - x, py - y
                        colour = textured(kind, c * dx + s * dy, c * dy - s * dx, level, edge, under)
                    under = mixed(under, _rimmed(depth, rim_width, colour, edge), unit(depth + 0.5))
                if depth > -0.5 or casts:
                    pixels[row, column] = under


@kernel
def paint_lines(
    pixels: Pixels, start: Vectors, end: Vectors, line_width: float, colour: int, opacity: Numbers
) -> None:
    """Paint straight lines with round ends; ends and width in px, opacity of each 0..1."""
    for i in range(len(start)):
        _stroke(pixels, start[i, 0], start[i, 1], end[i, 0], end[i, 1], 0.5 * line_width, colour, opacity[i])


@kernel
def paint_strokes(pixels: Pixels, start: Vectors, end: Vectors, line_width: Numbers, colour: Colours) -> None:
    """Paint straight lines with round ends, each of its own width [px] and colour, in their order."""
    for i in range(len(start)):
        half, paint = 0.5 * line_width[i], int(colour[i])
        _stroke(pixels, start[i, 0], start[i, 1], end[i, 0], end[i, 1], half, paint, 1.0)
