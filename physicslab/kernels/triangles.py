"""Triangles of panels, plots and letters, painted into a transparent picture.

Pictures hold premultiplied colours, so that they can be laid over anything later: a pixel is alpha, red,
green and blue from the highest byte down, each colour multiplied by alpha already. Vertices are those of
Dear ImGui: place [px], place in the texture (0 to 1) and a colour, in 20 bytes. The texture holds the
coverage of letters alone. A triangle has one colour, that of its first vertex; its opacity may differ from
vertex to vertex, as it does along soft edges.

Pixel (row, column) is covered where its middle is inside; of two triangles with an edge in common only one
paints what lies on it (the rule of left and upper edges, as graphics processors have it).
"""

import math
from typing import Annotated

import numpy as np
from numba import float32, uint8, uint32
from numpy.typing import NDArray

from physicslab.kernels import inlined, kernel
from physicslab.kernels.finishes import blended
from physicslab.kernels.raster import Pixels

Vertices = Annotated[NDArray[np.float32], float32[:, ::1]]
"""A float32 array (n, 5): x, y [px], u, v (0 to 1), and four bytes of colour."""
Colours = Annotated[NDArray[np.uint32], uint32[:, ::1]]
"""The same memory as whole numbers: of column 4 red is the lowest byte, alpha the highest."""
Indices = Annotated[NDArray[np.uint32], uint32[::1]]
"""A uint32 array (n,): three vertices for each triangle."""
Coverage = Annotated[NDArray[np.uint8], uint8[:, ::1]]
"""A uint8 array (height, width): how much of each texel is covered, 255 for all."""

_OPAQUE = 0xFF000000
"""The highest byte of a pixel: its opacity."""


@inlined
def _whole(number: int) -> int:
    """Return a number of any type as a signed one: of signed and unsigned ones arithmetic makes fractions."""
    return np.int64(number)  # type: ignore[return-value]


@inlined
def _narrowed(first: int, last: int, y: float, xa: float, ya: float, xb: float, yb: float) -> tuple[int, int]:
    """Return which columns of a row at ``y`` lie on the inner side of an edge: from ``first`` up to ``last``.

    Middles of pixels that lie on a left or upper edge are inside, those on others are not.
    """
    slope = ya - yb
    weight = (xb - xa) * (y - ya) + slope * (0.5 - xa)  # of column 0: above 0 inside
    if slope == 0.0:
        return (first, last) if weight > 0.0 or (weight == 0.0 and xb > xa) else (first, first)
    crossing = math.ceil(-weight / slope)
    return (max(first, crossing), last) if slope > 0.0 else (first, min(last, crossing))


@inlined
def _slopes(
    ab: float, ac: float, xab: float, yab: float, xac: float, yac: float, area: float
) -> tuple[float, float]:
    """Return how something changes per column and row that differs by ``ab``, ``ac`` from a to b, c."""
    return (ab * yac - ac * yab) / area, (ac * xab - ab * xac) / area


@inlined
def _triangle(
    pixels: Pixels, vertices: Vertices, colours: Colours, a: int, b: int, c: int, coverage: Coverage,
    left: int, top: int, right: int, bottom: int,
) -> None:  # fmt: skip
    """Paint one triangle, its opacity and its place in the texture interpolated between its corners."""
    xa, ya, xb, yb = vertices[a, 0], vertices[a, 1], vertices[b, 0], vertices[b, 1]
    xc, yc = vertices[c, 0], vertices[c, 1]
    xab, yab, xac, yac = float(xb - xa), float(yb - ya), float(xc - xa), float(yc - ya)
    area = xab * yac - xac * yab
    if area == 0.0:
        return
    height, width = coverage.shape
    ua, va, packed = width * vertices[a, 2], height * vertices[a, 3], _whole(colours[a, 4])
    colour = _OPAQUE | (packed & 255) << 16 | (packed & 0xFF00) | (packed >> 16 & 255)
    opacity = float(packed >> 24)
    of_b, of_c = _whole(colours[b, 4]) >> 24, _whole(colours[c, 4]) >> 24
    ox, oy = _slopes(of_b - opacity, of_c - opacity, xab, yab, xac, yac, area)
    ux, uy = _slopes(width * vertices[b, 2] - ua, width * vertices[c, 2] - ua, xab, yab, xac, yac, area)
    vx, vy = _slopes(height * vertices[b, 3] - va, height * vertices[c, 3] - va, xab, yab, xac, yac, area)
    uniform = ox == 0.0 and oy == 0.0 and ux == 0.0 and uy == 0.0 and vx == 0.0 and vy == 0.0
    alpha = int(opacity) * _whole(coverage[min(int(va), height - 1), min(int(ua), width - 1)]) // 255
    if area < 0.0:  # so that the inner side is the same of all edges
        xb, yb, xc, yc = xc, yc, xb, yb
    low, high = max(left, math.floor(min(xa, xb, xc))), min(right, math.ceil(max(xa, xb, xc)))
    for row in range(max(top, math.floor(min(ya, yb, yc))), min(bottom, math.ceil(max(ya, yb, yc)))):
        y = row + 0.5
        first, last = _narrowed(low, high, y, xa, ya, xb, yb)
        first, last = _narrowed(first, last, y, xb, yb, xc, yc)
        first, last = _narrowed(first, last, y, xc, yc, xa, ya)
        if uniform and alpha == 255:
            for column in range(first, last):
                pixels[row, column] = colour
            continue
        for column in range(first, last):
            if not uniform:
                across, down = column + 0.5 - xa, y - ya
                u = min(max(int(ua + ux * across + uy * down), 0), width - 1)
                v = min(max(int(va + vx * across + vy * down), 0), height - 1)
                alpha = int(min(max(opacity + ox * across + oy * down, 0.0), 255.0) + 0.5)
                alpha = alpha * _whole(coverage[v, u]) // 255
            if alpha > 0:
                pixels[row, column] = blended(_whole(pixels[row, column]), colour, alpha + (alpha >> 7))


@kernel
def paint_triangles(
    pixels: Pixels, vertices: Vertices, colours: Colours, indices: Indices, first: int, count: int,
    offset: int, coverage: Coverage, left: int, top: int, right: int, bottom: int,
) -> None:  # fmt: skip
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
        The part that may be painted [px]; it lies within the picture.
    """
    for k in range(first, first + count - 2, 3):
        a, b = offset + _whole(indices[k]), offset + _whole(indices[k + 1])
        c = offset + _whole(indices[k + 2])
        _triangle(pixels, vertices, colours, a, b, c, coverage, left, top, right, bottom)
