"""Triangles of panels, plots and letters, painted into a transparent picture.

Pictures hold premultiplied colours, so that they can be laid over anything later: a pixel is alpha, red,
green and blue from the highest byte down, each colour multiplied by alpha already. Vertices are those of
Dear ImGui: place [px], place in the texture (0 to 1) and a colour, in 20 bytes. The texture holds the
coverage of letters alone.

Pixel (row, column) is covered where its middle is inside; of two triangles with an edge in common only one
paints what lies on it (the rule of left and upper edges, as graphics processors have it).
"""

import math
from typing import Annotated

import numpy as np
from numba import float32, uint8, uint32
from numpy.typing import NDArray

from physicslab.kernels import inlined, kernel
from physicslab.kernels.raster import Pixels

__all__ = ["Coverage", "Indices", "Vertices", "paint_triangles"]

Vertices = Annotated[NDArray[np.float32], float32[:, ::1]]
"""A float32 array (n, 5): x, y [px], u, v (0 to 1), and four bytes of colour."""
Colours = Annotated[NDArray[np.uint32], uint32[:, ::1]]
"""The same memory as whole numbers: of column 4 red is the lowest byte, alpha the highest."""
Indices = Annotated[NDArray[np.uint32], uint32[::1]]
"""A uint32 array (n,): three vertices for each triangle."""
Coverage = Annotated[NDArray[np.uint8], uint8[:, ::1]]
"""A uint8 array (height, width): how much of each texel is covered, 255 for all."""

_EVERY_OTHER = 0x00FF00FF
"""Two channels of a pixel, with room between them for products."""


@inlined
def _laid(under: int, red: int, green: int, blue: int, alpha: int) -> int:
    """Return a premultiplied pixel with a plain colour of some opacity (0 to 255) laid over it."""
    rest, share = 256 - alpha - (alpha >> 7), alpha + (alpha >> 7)
    low = ((under & _EVERY_OTHER) * rest + ((red << 16) | blue) * share) >> 8
    high = ((under >> 8) & _EVERY_OTHER) * rest + ((255 << 16) | green) * share
    return (low & _EVERY_OTHER) | (high & (_EVERY_OTHER << 8))


@inlined
def _whole(number: int) -> int:
    """Return a number of any type as a signed one: of signed and unsigned ones arithmetic makes fractions."""
    return np.int64(number)  # type: ignore[return-value]


@inlined
def _texel(coverage: Coverage, u: float, v: float) -> int:
    """Return the coverage at a place in the texture (0 to 1)."""
    height, width = coverage.shape
    row = min(max(int(v * height), 0), height - 1)
    column = min(max(int(u * width), 0), width - 1)
    return _whole(coverage[row, column])


@inlined
def _is_upright(vertices: Vertices, colours: Colours, a: int, b: int, c: int, d: int) -> bool:
    """Whether four vertices are the corners of a rectangle along the axes, of one colour."""
    placed = (
        vertices[a, 1] == vertices[b, 1]
        and vertices[b, 0] == vertices[c, 0]
        and vertices[c, 1] == vertices[d, 1]
        and vertices[d, 0] == vertices[a, 0]
    )
    colour = colours[a, 4]
    alike = colours[b, 4] == colour and colours[c, 4] == colour and colours[d, 4] == colour
    # The texture lies along the axes, too: that of a line lies across it.
    laid = (
        vertices[a, 3] == vertices[b, 3]
        and vertices[b, 2] == vertices[c, 2]
        and vertices[c, 3] == vertices[d, 3]
        and vertices[d, 2] == vertices[a, 2]
    )
    return bool(placed and alike and laid)


@inlined
def _rectangle(
    pixels: Pixels, vertices: Vertices, a: int, c: int, colour: int, coverage: Coverage,
    left: int, top: int, right: int, bottom: int,
) -> None:  # fmt: skip
    """Paint a rectangle from corner a to corner c, plain or as a part of the texture: most are letters."""
    red, green, blue, alpha = colour & 255, (colour >> 8) & 255, (colour >> 16) & 255, colour >> 24
    xa, ya, xc, yc = vertices[a, 0], vertices[a, 1], vertices[c, 0], vertices[c, 1]
    ua, va, uc, vc = vertices[a, 2], vertices[a, 3], vertices[c, 2], vertices[c, 3]
    # Lines of plots have their corners in any order.
    first, last = max(left, math.ceil(min(xa, xc) - 0.5)), min(right, math.ceil(max(xa, xc) - 0.5))
    upper, lower = max(top, math.ceil(min(ya, yc) - 0.5)), min(bottom, math.ceil(max(ya, yc) - 0.5))
    plain = ua == uc and va == vc
    across = 0.0 if plain else (uc - ua) / (xc - xa)
    down = 0.0 if plain else (vc - va) / (yc - ya)
    opaque = (255 << 24) | (red << 16) | (green << 8) | blue
    for row in range(upper, lower):
        v = va + (row + 0.5 - ya) * down
        for column in range(first, last):
            share = alpha
            if not plain:
                share = alpha * _texel(coverage, ua + (column + 0.5 - xa) * across, v) // 255
            if share == 255:
                pixels[row, column] = opaque
            elif share > 0:
                pixels[row, column] = _laid(_whole(pixels[row, column]), red, green, blue, share)


@inlined
def _weight(x: float, y: float, xa: float, ya: float, xb: float, yb: float) -> float:
    """Return twice the signed area of a triangle: of a point and an edge."""
    return (xb - xa) * (y - ya) - (yb - ya) * (x - xa)


@inlined
def _from(weight: float, slope: float, first: float) -> float:
    """Return the first column at which a weight that rises along a row is not negative."""
    return max(first, math.ceil(-weight / slope)) if slope > 0.0 else first


@inlined
def _until(weight: float, slope: float, last: float) -> float:
    """Return the column before which a weight that falls along a row is positive."""
    return min(last, math.ceil(-weight / slope)) if slope < 0.0 else last


@inlined
def _leaves_out(weight: float, slope: float, rise: float) -> bool:
    """Whether a row lies outside of a level edge, or on it where another triangle paints it."""
    return slope == 0.0 and (weight < 0.0 or (weight == 0.0 and rise < 0.0))


@inlined
def _mixed(p: int, q: int, r: int, shift: int, wp: float, wq: float, wr: float) -> int:
    """Return one channel of a colour between three."""
    mixed = ((p >> shift) & 255) * wp + ((q >> shift) & 255) * wq + ((r >> shift) & 255) * wr
    return min(max(int(mixed + 0.5), 0), 255)


@inlined
def _triangle(
    pixels: Pixels, vertices: Vertices, colours: Colours, a: int, b: int, c: int, coverage: Coverage,
    left: int, top: int, right: int, bottom: int,
) -> None:  # fmt: skip
    """Paint one triangle, its colour and texture interpolated between its corners."""
    xa, ya, xb, yb = (
        float(vertices[a, 0]),
        float(vertices[a, 1]),
        float(vertices[b, 0]),
        float(vertices[b, 1]),
    )
    xc, yc = float(vertices[c, 0]), float(vertices[c, 1])
    area = _weight(xc, yc, xa, ya, xb, yb)
    if area == 0.0:
        return
    if area < 0.0:  # so that weights are positive inside
        b, c, xb, yb, xc, yc, area = c, b, xc, yc, xb, yb, -area
    ca, cb, cc = _whole(colours[a, 4]), _whole(colours[b, 4]), _whole(colours[c, 4])
    ua, va = float(vertices[a, 2]), float(vertices[a, 3])
    ub, vb, uc, vc = (
        float(vertices[b, 2]),
        float(vertices[b, 3]),
        float(vertices[c, 2]),
        float(vertices[c, 3]),
    )
    flat = ua == ub and ub == uc and va == vb and vb == vc
    whole = _texel(coverage, ua, va)
    low, high = float(max(left, int(min(xa, xb, xc)))), float(min(right, math.ceil(max(xa, xb, xc)) + 1))
    for row in range(max(top, int(min(ya, yb, yc))), min(bottom, math.ceil(max(ya, yb, yc)) + 1)):
        y = row + 0.5
        wa, wb, wc = (
            _weight(0.5, y, xb, yb, xc, yc),
            _weight(0.5, y, xc, yc, xa, ya),
            _weight(0.5, y, xa, ya, xb, yb),
        )
        sa, sb, sc = yb - yc, yc - ya, ya - yb  # how weights change from column to column
        if _leaves_out(wa, sa, xc - xb) or _leaves_out(wb, sb, xa - xc) or _leaves_out(wc, sc, xb - xa):
            continue
        first = _from(wa, sa, _from(wb, sb, _from(wc, sc, low)))
        last = _until(wa, sa, _until(wb, sb, _until(wc, sc, high)))
        for column in range(int(first), int(last)):
            pa, pb = (wa + sa * column) / area, (wb + sb * column) / area
            pc = 1.0 - pa - pb
            share = (
                whole if flat else _texel(coverage, ua * pa + ub * pb + uc * pc, va * pa + vb * pb + vc * pc)
            )
            alpha = _mixed(ca, cb, cc, 24, pa, pb, pc) * share // 255
            if alpha > 0:
                red, green = _mixed(ca, cb, cc, 0, pa, pb, pc), _mixed(ca, cb, cc, 8, pa, pb, pc)
                blue = _mixed(ca, cb, cc, 16, pa, pb, pc)
                pixels[row, column] = _laid(_whole(pixels[row, column]), red, green, blue, alpha)


@inlined
def _corner(indices: Indices, k: int, offset: int) -> int:
    """Return which vertex an index means."""
    return offset + _whole(indices[k])


@kernel
def paint_triangles(
    pixels: Pixels,
    vertices: Vertices,
    colours: Colours,
    indices: Indices,
    first: int,
    count: int,
    offset: int,
    coverage: Coverage,
    left: int,
    top: int,
    right: int,
    bottom: int,
) -> None:
    """Paint triangles in their order, within a rectangle.

    Parameters
    ----------
    pixels : Pixels
        The picture, premultiplied.
    vertices, colours : float32 array (n, 5), uint32 array (n, 5)
        Two views of the same vertices.
    indices : uint32 array
        Three vertices for each triangle, before ``offset`` is added.
    first, count, offset : int
        Which of the indices to take, and what is added to each.
    coverage : uint8 array (height, width)
        The texture.
    left, top, right, bottom : int
        What may be painted [px]; it lies within the picture.
    """
    k, end = first, first + count
    while k + 2 < end:
        a, b, c = (
            _corner(indices, k, offset),
            _corner(indices, k + 1, offset),
            _corner(indices, k + 2, offset),
        )
        if k + 5 < end and indices[k + 3] == indices[k] and indices[k + 4] == indices[k + 2]:
            d = _corner(indices, k + 5, offset)
            if _is_upright(vertices, colours, a, b, c, d):
                colour = _whole(colours[a, 4])
                _rectangle(pixels, vertices, a, c, colour, coverage, left, top, right, bottom)
                k += 6
                continue
        _triangle(pixels, vertices, colours, a, b, c, coverage, left, top, right, bottom)
        k += 3
