"""The table of shapes, from which every loop reads what a body's outline is.

A convex shape is a core of 1 to 8 vertices, counter-clockwise about the centre, and a radius that rounds it:
a disc is 1 vertex with a radius, a box 4 without, a capsule 2 with one. Names of kinds are for people and
files; ``physicslab/components/shape.py`` has their rows, from which :func:`derive_shape` fills this table.

To use it, take ``shapes_of(state)`` (:mod:`physicslab.contacts.arguments`) as a ``ShapesTuple`` argument and
name it by ``shapes = named_shapes(plain)``; in Python, ``state.bodies.shapes`` is the same, named. It is up
to date from the beginning of a step on. Then, of row ``i``:

- ``shapes.vertices[i]``: their number, 0 where there is no shape. ``shapes.first[i] == BOX``: they are those
  of a box, for which ``half_x`` and ``half_y`` say all.
- ``vertex(shapes, i, k)``, ``face(shapes, i, k)``, ``support(shapes, i, x, y)``: of the core, in the body's
  own directions. Face k goes from vertex k to the next one.
- ``shapes.radius[i]``: its rounding. ``shapes.reach[i]``: the largest distance of the outline from the
  centre. ``shapes.thin[i]``: half of its smallest width. ``half_extents(shapes, i, angle)``: of
  the upright box.

A disc, which turns without effect, has ``shapes.reach[i] - shapes.radius[i]`` equal to 0.
"""

import math
from typing import NamedTuple

from physicslab.kernels import Numbers, Rows, Vectors, always_inlined, inlined, inlined_by_numba
from physicslab.kernels.records import Pairs

BOX = 1
"""Where the vertices of a box begin in the pool, after the one of a disc."""
OWN = 7
"""In the register of cores, the rows behind this one are those of shapes with vertices of their own."""
MOST_VERTICES = 8
"""The largest number of vertices of a core."""


class Shapes(NamedTuple):
    """The outlines of all rows.

    Attributes
    ----------
    vertices, first : int64 arrays (rows,)
        The number of vertices of the core, and where they begin in the pool.
    half_x, half_y : float64 arrays (rows,)
        Half of the extents of the core in the body's own directions [m]: the scales of its vertices.
    radius : float64 array (rows,)
        By how much the core is rounded [m].
    reach : float64 array (rows,)
        The largest distance of the outline from the centre [m].
    thin : float64 array (rows,)
        Half of the smallest width of the outline [m].
    gyration : float64 array (rows,)
        The moment of inertia of a uniform mass, by that mass [m^2]; 0 until it is computed.
    pool : float64 array (n, 4)
        The vertices of each core, in shares of ``half_x`` and ``half_y``; equal cores share theirs. Then the
        outward normal of the face that begins there; 0 where the sizes of a shape turn it.
    """

    vertices: Rows
    first: Rows
    half_x: Numbers
    half_y: Numbers
    radius: Numbers
    reach: Numbers
    thin: Numbers
    gyration: Numbers
    pool: Vectors


ShapesTuple = tuple[Pairs, Vectors, Vectors]
"""The same in three arrays (2, rows), (6, rows), (n, 4), which are passed faster."""
SizesTuple = tuple[Numbers, Numbers, Numbers, Numbers]
"""The columns of sizes of the ``Shape`` component, in its order."""


@inlined_by_numba
def named_shapes(plain: ShapesTuple) -> Shapes:
    """Give names to the arrays."""
    cores, lengths, pool = plain
    return Shapes(
        cores[0], cores[1], lengths[0], lengths[1], lengths[2], lengths[3], lengths[4], lengths[5], pool
    )


@inlined
def vertex(shapes: Shapes, i: int, k: int) -> tuple[float, float]:
    """Return vertex k of the core of row i, from its centre in its own directions [m]."""
    at = shapes.first[i] + k
    return shapes.half_x[i] * shapes.pool[at, 0], shapes.half_y[i] * shapes.pool[at, 1]


@inlined
def face(shapes: Shapes, i: int, k: int) -> tuple[float, float, float, float]:
    """Return the outward normal of face k of the core of row i, its distance from the centre and length [m].

    It goes from vertex k to the next one. The core of a capsule has two faces, back to back; a disc has none.
    """
    x, y = vertex(shapes, i, k)
    to_x, to_y = vertex(shapes, i, (k + 1) % shapes.vertices[i])
    along_x, along_y = to_x - x, to_y - y
    length = math.sqrt(along_x * along_x + along_y * along_y)
    nx, ny = along_y / length, -along_x / length
    return nx, ny, nx * x + ny * y, length


@inlined
def support(shapes: Shapes, i: int, x: float, y: float) -> tuple[int, float]:
    """Return the vertex of the core of row i that is farthest along a unit vector, and how far [m]."""
    best, farthest = 0, -math.inf
    for k in range(shapes.vertices[i]):
        vx, vy = vertex(shapes, i, k)
        along = x * vx + y * vy
        if along > farthest:
            best, farthest = k, along
    return best, farthest


@always_inlined
def is_chain(shapes: Shapes, i: int) -> bool:
    """Whether row i is a chain, one segment of it after the other: no other two vertices have no radius."""
    return bool(shapes.vertices[i] == 2 and shapes.radius[i] == 0.0)


@always_inlined
def segment_of(wall: int) -> int:
    """Return the number of the segment of a chain that the ``wall`` of a pair names, from -2 downwards."""
    return -2 - wall


@always_inlined
def wall_of(segment: int) -> int:
    """Return the ``wall`` that names a segment."""
    return -2 - segment


@always_inlined
def has_own_way(shapes: Shapes, i: int) -> bool:
    """Whether row i is a disc or a box, for which loops have faster ways than for any rounded polygon."""
    return bool(shapes.vertices[i] < 2 or shapes.first[i] == BOX)


@inlined
def half_extents(shapes: Shapes, i: int, angle: float) -> tuple[float, float]:
    """Return half of the width and height of the upright box about the centre of row i, turned so far [m]."""
    radius = shapes.radius[i]
    if shapes.vertices[i] < 2:
        return radius, radius
    c, s, half_x, half_y = math.cos(angle), math.sin(angle), 0.0, 0.0
    if shapes.first[i] == BOX:
        c, s = abs(c), abs(s)
        return c * shapes.half_x[i] + s * shapes.half_y[i], s * shapes.half_x[i] + c * shapes.half_y[i]
    for k in range(shapes.vertices[i]):
        x, y = vertex(shapes, i, k)
        half_x, half_y = max(half_x, abs(c * x - s * y)), max(half_y, abs(s * x + c * y))
    return half_x + radius, half_y + radius


@always_inlined
def _size(column: int, i: int, sizes: SizesTuple) -> float:
    """Return the size of row i in a column; 1 where there is none, so that it is in order."""
    # One by one: to index a tuple by a variable takes ten times as long.
    radius, width, height, length = sizes
    if column < 0:
        return 1.0
    if column < 2:
        return float(radius[i]) if column == 0 else float(width[i])
    return float(height[i]) if column == 2 else float(length[i])


@inlined
def _thinness(shapes: Shapes, i: int) -> float:
    """Return half of the smallest width of the core of row i, which is across one of its faces [m]."""
    smaller: float = min(shapes.half_x[i], shapes.half_y[i])
    if shapes.vertices[i] < 3 or shapes.first[i] == BOX:
        return smaller
    for k in range(shapes.vertices[i]):
        nx, ny, distance, _ = face(shapes, i, k)
        _, behind = support(shapes, i, -nx, -ny)
        smaller = min(smaller, 0.5 * (distance + behind))
    return smaller


@always_inlined
def derive_shape(
    i: int, kind: Rows, own: Rows, sizes: SizesTuple, kinds: Pairs, extents: Vectors, shapes: Shapes
) -> bool:
    """Fill row i of the table from its component; return whether its sizes are finite and above 0.

    ``own`` (rows,) has the codes of vertices of their own, or 0. ``kinds`` (n, 5) is the register of cores:
    of each the number of vertices, where they begin in the pool, and the columns of ``sizes`` that stretch it
    along x and y and round it, or -1; ``extents`` (n, 2) has half of the extents in units of these sizes.
    A chain counts as being as thin as it reaches: what touches it is smaller.
    """
    row = kind[i] if own[i] == 0 else OWN + own[i]
    if row >= len(kinds):
        return False
    count, first, rounded = kinds[row, 0], kinds[row, 1], kinds[row, 4]
    size_x, size_y = _size(kinds[row, 2], i, sizes), _size(kinds[row, 3], i, sizes)
    rounding = _size(rounded, i, sizes)
    half_x, half_y = extents[row, 0] * size_x, extents[row, 1] * size_y
    radius = rounding if rounded >= 0 else 0.0
    same = shapes.half_x[i] == half_x and shapes.half_y[i] == half_y and shapes.radius[i] == radius
    of_kind = kinds[kind[i], 0]  # of a chain 2: it is one segment after the other
    chained = own[i] > 0 and of_kind > 0
    parts = of_kind if chained else count
    if not same or shapes.first[i] != first or shapes.vertices[i] != parts:
        shapes.vertices[i], shapes.first[i] = count, first
        shapes.half_x[i], shapes.half_y[i], shapes.radius[i] = half_x, half_y, radius
        farthest = shapes.gyration[i] = 0.0
        for k in range(count):
            x, y = vertex(shapes, i, k)
            farthest = max(farthest, x * x + y * y)
        shapes.reach[i] = math.sqrt(farthest) + radius
        shapes.vertices[i] = parts
        shapes.thin[i] = shapes.reach[i] if chained else _thinness(shapes, i) + radius
    shaped = (count > 0 or row == 0) and (rounding > 0.0 or own[i] > 0)
    return shaped and 0.0 < size_x < math.inf and 0.0 < size_y < math.inf and 0.0 <= rounding < math.inf
