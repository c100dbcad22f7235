"""Discs, boxes and lines with smooth edges, painted into an array of pixels.

Coverage comes from the signed distance to the outline [px], so position, size and angle are exact to a fraction of a
pixel. Pixels are 32 bits of four 8-bit channels in any order; colours are packed in the same order. Pixel (row, column)
covers [column, column + 1) x [row, row + 1), and y points down.

A row of a shape is three runs: an edge where every pixel is mixed, a core of one colour, and an edge again.
"""

import math

from numba import boolean, float64, int64, uint32, void

from physicslab.kernels import inlined, kernel

__all__ = ["paint_boxes", "paint_discs", "paint_lines"]

_FLAGS = boolean[::1]
_NUMBERS = float64[::1]
_COLOURS = uint32[::1]
_PIXELS = uint32[:, ::1]

_EVERY_OTHER = 0x00FF00FF
"""Two channels of a pixel, with room between them for products."""
HATCH_SPACING = 10.0
"""Distance between the lines that mark what cannot move [px]."""
SPOKE_FROM = 3.0
"""Radius [px] from which a disc shows how far it has turned."""
NOTCH_FROM = 8.0
"""Half extent [px] from which a box shows which way round it is."""


@inlined
def _mixed(under, over, share):
    """Return ``under`` with a share (0..1) of ``over`` laid on it, channel by channel."""
    a = int64(share * 256.0 + 0.5)
    low = ((under & _EVERY_OTHER) * (256 - a) + (over & _EVERY_OTHER) * a) >> 8
    high = ((under >> 8) & _EVERY_OTHER) * (256 - a) + ((over >> 8) & _EVERY_OTHER) * a
    return (low & _EVERY_OTHER) | (high & (_EVERY_OTHER << 8))


@inlined
def _unit(value):
    """Return a value held within 0..1."""
    return min(max(value, 0.0), 1.0)


@inlined
def _pixel(place, count):
    """Return the first pixel of a line of ``count`` whose middle is not left of a place; ``count`` if there is none."""
    return int64(min(max(math.ceil(place - 0.5), 0.0), float(count)))


@inlined
def _stroke(pixels, xa, ya, xb, yb, half, colour, opacity):
    """Paint a line with round ends of a given half width."""
    height, width = pixels.shape
    reach = half + 0.5
    dx, dy = xb - xa, yb - ya
    square = dx * dx + dy * dy
    for row in range(_pixel(min(ya, yb) - reach, height), _pixel(max(ya, yb) + reach, height)):
        y = row + 0.5
        first, last = 0.0, 1.0  # the part of the line that comes near this row
        if abs(dy) > 1e-9:
            t, u = (y - reach - ya) / dy, (y + reach - ya) / dy
            first, last = _unit(min(t, u)), _unit(max(t, u))
        near, far = xa + first * dx, xa + last * dx
        for column in range(_pixel(min(near, far) - reach, width), _pixel(max(near, far) + reach, width)):
            px, py = column + 0.5 - xa, y - ya
            t = _unit((px * dx + py * dy) / square) if square > 0.0 else 0.0
            ex, ey = px - t * dx, py - t * dy
            cover = _unit(half + 0.5 - math.sqrt(ex * ex + ey * ey)) * opacity
            if cover > 0.0:
                pixels[row, column] = _mixed(int64(pixels[row, column]), colour, cover)


@inlined
def _hatched(u, v, fill, line):
    """Return the colour of a slanting hatch at a place in the body's own frame."""
    across = (u + v) * 0.7071067811865476
    across -= HATCH_SPACING * math.floor(across / HATCH_SPACING)
    return _mixed(fill, line, 0.5 * _unit(1.25 - abs(across - 0.5 * HATCH_SPACING)))


@inlined
def _disc_edge(pixels, row, first, end, x, dy, r, band, inside, edge):
    """Paint a run of a disc's row that holds rim, or half-covered pixels."""
    for column in range(first, end):
        dx = column + 0.5 - x
        depth = r - math.sqrt(dx * dx + dy * dy)
        colour = _mixed(inside, edge, _unit(band + 0.5 - depth))
        if depth < 0.5:
            colour = _mixed(int64(pixels[row, column]), colour, max(depth + 0.5, 0.0))
        pixels[row, column] = colour


@kernel(void(_PIXELS, _NUMBERS, _NUMBERS, _NUMBERS, _NUMBERS, _COLOURS, _COLOURS, _FLAGS, float64))
def paint_discs(pixels, x, y, radius, angle, fill, rim, hatched, rim_width):
    """Paint discs with a rim; a line from the middle to the rim shows how far each has turned.

    ``x, y, radius`` are in px, ``angle`` counter-clockwise on the screen [rad].
    """
    height, width = pixels.shape
    for i in range(len(x)):
        r, inside, edge = radius[i], int64(fill[i]), int64(rim[i])
        band = min(rim_width, 0.35 * r)
        outer, inner = r + 0.5, max(r - band - 0.5, 0.0)
        for row in range(_pixel(y[i] - outer, height), _pixel(y[i] + outer, height)):
            dy = row + 0.5 - y[i]
            reach = math.sqrt(max(outer * outer - dy * dy, 0.0))
            core = math.sqrt(max(inner * inner - dy * dy, 0.0))
            left, right = _pixel(x[i] - reach, width), _pixel(x[i] + reach, width)
            core_left, core_right = _pixel(x[i] - core, width), _pixel(x[i] + core, width)
            _disc_edge(pixels, row, left, core_left, x[i], dy, r, band, inside, edge)
            if hatched[i]:
                for column in range(core_left, core_right):
                    pixels[row, column] = _hatched(column + 0.5 - x[i], dy, inside, edge)
            else:
                for column in range(core_left, core_right):
                    pixels[row, column] = inside
            _disc_edge(pixels, row, core_right, right, x[i], dy, r, band, inside, edge)
        if r >= SPOKE_FROM and not hatched[i]:
            c, s = math.cos(angle[i]), math.sin(angle[i])
            end = r - band
            _stroke(pixels, x[i], y[i], x[i] + end * c, y[i] - end * s, 0.5 * band, edge, 1.0)


@inlined
def _between(slope, offset, half, low, high):
    """Narrow [low, high] to the x with |slope x + offset| <= half; an empty range comes back with low >= high."""
    if abs(slope) < 1e-9:
        if abs(offset) <= half:
            return low, high
        return 0.0, 0.0
    a, b = (-half - offset) / slope, (half - offset) / slope
    return max(low, min(a, b)), min(high, max(a, b))


@inlined
def _box_run(c, s, dy, a, b, x, width):
    """Return the pixels [first, end) of a row that lie in a turned box of half extents a and b."""
    low, high = _between(c, -s * dy, a, -1e9, 1e9)
    low, high = _between(s, c * dy, b, low, high)
    if low >= high or a <= 0.0 or b <= 0.0:
        return 0, 0
    return _pixel(x + low, width), _pixel(x + high, width)


@inlined
def _box_edge(pixels, row, first, end, x, dy, c, s, a, b, band, inside, edge):
    """Paint a run of a box's row that holds rim, or half-covered pixels."""
    for column in range(first, end):
        dx = column + 0.5 - x
        depth_u, depth_v = a - abs(c * dx - s * dy), b - abs(s * dx + c * dy)
        colour = _mixed(inside, edge, _unit(band + 0.5 - min(depth_u, depth_v)))
        if min(depth_u, depth_v) < 0.5:
            cover = _unit(depth_u + 0.5) * _unit(depth_v + 0.5)
            colour = _mixed(int64(pixels[row, column]), colour, cover)
        pixels[row, column] = colour


@kernel(void(_PIXELS, _NUMBERS, _NUMBERS, _NUMBERS, _NUMBERS, _NUMBERS, _COLOURS, _COLOURS, _FLAGS, float64))
def paint_boxes(pixels, x, y, half_width, half_height, angle, fill, rim, hatched, rim_width):
    """Paint boxes with a rim; a short line at the middle of the box's own +x side shows which way round it is.

    ``x, y`` and the half extents are in px, ``angle`` counter-clockwise on the screen [rad].
    """
    height, width = pixels.shape
    for i in range(len(x)):
        a, b, inside, edge = half_width[i], half_height[i], int64(fill[i]), int64(rim[i])
        c, s = math.cos(angle[i]), math.sin(angle[i])
        band = min(rim_width, 0.35 * min(a, b))
        core = band + 0.5
        extent = abs(s) * a + abs(c) * b + 0.75
        for row in range(_pixel(y[i] - extent, height), _pixel(y[i] + extent, height)):
            dy = row + 0.5 - y[i]
            left, right = _box_run(c, s, dy, a + 0.5, b + 0.5, x[i], width)
            core_left, core_right = _box_run(c, s, dy, a - core, b - core, x[i], width)
            if core_left >= core_right:
                core_left = core_right = right
            _box_edge(pixels, row, left, core_left, x[i], dy, c, s, a, b, band, inside, edge)
            if hatched[i]:
                for column in range(core_left, core_right):
                    dx = column + 0.5 - x[i]
                    pixels[row, column] = _hatched(c * dx - s * dy, s * dx + c * dy, inside, edge)
            else:
                for column in range(core_left, core_right):
                    pixels[row, column] = inside
            _box_edge(pixels, row, core_right, right, x[i], dy, c, s, a, b, band, inside, edge)
        if min(a, b) >= NOTCH_FROM and not hatched[i]:
            start, end = a - 0.5 * min(a, b), a - band
            _stroke(
                pixels, x[i] + start * c, y[i] - start * s, x[i] + end * c, y[i] - end * s, 0.5 * band, edge, 1.0
            )


@kernel(void(_PIXELS, _NUMBERS, _NUMBERS, _NUMBERS, _NUMBERS, _NUMBERS, _COLOURS, _NUMBERS))
def paint_lines(pixels, x_a, y_a, x_b, y_b, line_width, colour, opacity):
    """Paint straight lines with round ends; ends and widths in px, opacity 0..1."""
    for i in range(len(x_a)):
        _stroke(pixels, x_a[i], y_a[i], x_b[i], y_b[i], 0.5 * line_width[i], int64(colour[i]), opacity[i])
