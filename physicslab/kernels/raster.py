"""Discs, boxes, rounded polygons and lines with smooth edges, painted into an array of pixels.

Coverage comes from the signed distance to the outline [px], so position, size and angle are exact to a
fraction of a pixel. Pixels are 32 bits of four 8-bit channels in any order; colours are packed in the same
order. Pixel (row, column) covers [column, column + 1) x [row, row + 1), and y points down. Nothing is written
outside the array; coordinates must be finite.

A row of a shape is three runs: an edge where every pixel is mixed, a core of one colour, and an edge again.
"""

import math
from typing import Annotated

import numpy as np
from numba import uint32
from numpy.typing import NDArray

from physicslab.kernels import Flags, Numbers, Rows, Vectors, inlined, kernel

Pixels = Annotated[NDArray[np.uint32], uint32[:, ::1]]
"""A uint32 array (height, width): a picture."""
Colours = Annotated[NDArray[np.uint32], uint32[::1]]
"""A uint32 array (n,): packed colours."""

_EVERY_OTHER = 0x00FF00FF
"""Two channels of a pixel, with room between them for products."""
HATCH_SPACING = 10.0
"""Distance between the lines that mark what cannot move [px]."""
SPOKE_FROM = 3.0
"""Radius [px] from which a disc shows how far it has turned."""
NOTCH_FROM = 8.0
"""Half extent [px] from which a box shows which way round it is."""


@inlined
def _mixed(under: int, over: int, share: float) -> int:
    """Return ``under`` with a share (0..1) of ``over`` laid on it, channel by channel."""
    a = int(share * 256.0 + 0.5)
    low = ((under & _EVERY_OTHER) * (256 - a) + (over & _EVERY_OTHER) * a) >> 8
    high = ((under >> 8) & _EVERY_OTHER) * (256 - a) + ((over >> 8) & _EVERY_OTHER) * a
    return (low & _EVERY_OTHER) | (high & (_EVERY_OTHER << 8))


@inlined
def _unit(value: float) -> float:
    """Return a value held within 0..1."""
    return min(max(value, 0.0), 1.0)


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
            cover = _unit(reach - math.sqrt(away * away + past * past)) * opacity
            pixels[row, np.uint64(column)] = _mixed(int(pixels[row, np.uint64(column)]), colour, cover)
            along, away = along + ux, away + uy


@inlined
def _hatched(u: float, v: float, fill: int, line: int) -> int:
    """Return the colour of a slanting hatch at a place in the body's own frame."""
    across = (u + v) * 0.7071067811865476
    across -= HATCH_SPACING * math.floor(across / HATCH_SPACING)
    return _mixed(fill, line, 0.5 * _unit(1.25 - abs(across - 0.5 * HATCH_SPACING)))


@inlined
def _rimmed(depth: float, band: float, inside: int, edge: int) -> int:
    """Return the colour of a shape at a depth below its outline [px], where a rim is ``band`` px wide."""
    share = band + 0.5 - depth
    if share >= 1.0:
        return edge
    return _mixed(inside, edge, max(share, 0.0))


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
            colour = _mixed(int(pixels[row, column]), colour, max(depth + 0.5, 0.0))
        pixels[row, column] = colour


@kernel
def paint_discs(
    pixels: Pixels, centre: Vectors, radius: Numbers, angle: Numbers,
    fill: Colours, rim: Colours, hatched: Flags, rim_width: float,
) -> None:  # fmt: skip
    """Paint discs with a rim; a line from the middle to the rim shows how far each has turned.

    Lengths are in px, ``angle`` is counter-clockwise on the screen [rad].
    """
    height, width = pixels.shape
    for i in range(len(radius)):
        x, y, r = centre[i, 0], centre[i, 1], radius[i]
        inside, edge = int(fill[i]), int(rim[i])
        band = min(rim_width, 0.35 * r)
        outer, inner = r + 0.5, max(r - band - 0.5, 0.0)
        for row in range(_pixel(y - outer, height), _pixel(y + outer, height)):
            dy = row + 0.5 - y
            reach = math.sqrt(max(outer * outer - dy * dy, 0.0))
            core = math.sqrt(max(inner * inner - dy * dy, 0.0))
            left, right = _pixel(x - reach, width), _pixel(x + reach, width)
            core_left, core_right = _pixel(x - core, width), _pixel(x + core, width)
            _disc_edge(pixels, row, left, core_left, x, dy, r, band, inside, edge)
            if hatched[i]:
                for column in range(core_left, core_right):
                    pixels[row, column] = _hatched(column + 0.5 - x, dy, inside, edge)
            else:
                for column in range(core_left, core_right):
                    pixels[row, column] = inside
            _disc_edge(pixels, row, core_right, right, x, dy, r, band, inside, edge)
        if r >= SPOKE_FROM and not hatched[i]:
            end = r - band
            tip_x, tip_y = x + end * math.cos(angle[i]), y - end * math.sin(angle[i])
            _stroke(pixels, x, y, tip_x, tip_y, 0.5 * band, edge, 1.0)


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
            cover = _unit(depth_u + 0.5) * _unit(depth_v + 0.5)
            colour = _mixed(int(pixels[row, column]), colour, cover)
        pixels[row, column] = colour


@kernel
def paint_boxes(
    pixels: Pixels, centre: Vectors, half: Vectors, angle: Numbers,
    fill: Colours, rim: Colours, hatched: Flags, rim_width: float,
) -> None:  # fmt: skip
    """Paint boxes with a rim; a short line at the middle of their own +x side shows which way round they are.

    Lengths are in px, ``half`` holds half the extents, ``angle`` is counter-clockwise on the screen [rad].
    """
    height, width = pixels.shape
    for i in range(len(angle)):
        x, y, a, b = centre[i, 0], centre[i, 1], half[i, 0], half[i, 1]
        inside, edge = int(fill[i]), int(rim[i])
        c, s = math.cos(angle[i]), math.sin(angle[i])
        band = min(rim_width, 0.35 * min(a, b))
        core = band + 0.5
        extent = abs(s) * a + abs(c) * b + 0.75
        for row in range(_pixel(y - extent, height), _pixel(y + extent, height)):
            dy = row + 0.5 - y
            left, right = _box_run(c, s, dy, a + 0.5, b + 0.5, x, width)
            core_left, core_right = _box_run(c, s, dy, a - core, b - core, x, width)
            if core_left >= core_right:
                core_left = core_right = right
            _box_edge(pixels, row, left, core_left, x, dy, c, s, a, b, band, inside, edge)
            if hatched[i]:
                for column in range(core_left, core_right):
                    dx = column + 0.5 - x
                    pixels[row, column] = _hatched(c * dx - s * dy, s * dx + c * dy, inside, edge)
            else:
                for column in range(core_left, core_right):
                    pixels[row, column] = inside
            _box_edge(pixels, row, core_right, right, x, dy, c, s, a, b, band, inside, edge)
        if min(a, b) >= NOTCH_FROM and not hatched[i]:
            near, far = a - 0.5 * min(a, b), a - band
            _stroke(pixels, x + near * c, y - near * s, x + far * c, y - far * s, 0.5 * band, edge, 1.0)


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
        share = _unit((dx * along_x + dy * along_y) / square) if square > 0.0 else 0.0
        away_x, away_y = dx - share * along_x, dy - share * along_y
        nearest = min(nearest, away_x * away_x + away_y * away_y)
        within = within and along_x * dy - along_y * dx <= 0.0
    return -math.sqrt(nearest) if within else math.sqrt(nearest)


@kernel
def paint_rounded(
    pixels: Pixels, corners: Vectors, vertices: Rows, radius: Numbers,
    fill: Colours, rim: Colours, hatched: Flags, rim_width: float,
) -> None:  # fmt: skip
    """Paint rounded polygons with a rim; a line from the middle to the first vertex shows how they lie.

    ``corners`` (n, 16) holds x and y of each vertex in turn [px], counter-clockwise as it is seen.
    """
    height, width = pixels.shape
    for i in range(len(radius)):
        count, inside, edge = vertices[i], int(fill[i]), int(rim[i])
        left, right, top, bottom, x, y = math.inf, -math.inf, math.inf, -math.inf, 0.0, 0.0
        for k in range(count):
            at_x, at_y = corners[i, 2 * k], corners[i, 2 * k + 1]
            left, right, top, bottom = min(left, at_x), max(right, at_x), min(top, at_y), max(bottom, at_y)
            x, y = x + at_x / count, y + at_y / count
        reach = radius[i] + 0.5
        along_x, along_y = corners[i, 0] - x, corners[i, 1] - y
        length = max(math.sqrt(along_x * along_x + along_y * along_y), 1e-9)
        c, s = along_x / length, along_y / length
        for row in range(_pixel(top - reach, height), _pixel(bottom + reach, height)):
            for column in range(_pixel(left - reach, width), _pixel(right + reach, width)):
                px, py = column + 0.5, row + 0.5
                depth = radius[i] - _beyond_core(px, py, corners, i, count)
                if depth <= -0.5:
                    continue
                dx, dy, colour = px - x, py - y, inside
                if hatched[i]:
                    colour = _hatched(c * dx + s * dy, c * dy - s * dx, inside, edge)
                colour = _rimmed(depth, rim_width, colour, edge)
                if depth < 0.5:
                    colour = _mixed(int(pixels[row, column]), colour, depth + 0.5)
                pixels[row, column] = colour
        if not hatched[i]:
            _stroke(pixels, x, y, corners[i, 0], corners[i, 1], 0.5 * rim_width, edge, 1.0)


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
