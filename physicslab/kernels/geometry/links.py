"""The links of a chain: its faces, its round bends and its corners, one after the other.

Where a chain turns by up to 15 degrees it is round: an arc touches both segments, and begins in the middle of
the shorter one. Where it turns further it has a corner, on the solid side an arc of no radius; one that
turns the other way is where two faces end. Faces are what is left of segments. So normals go on without a
jump but at corners, and what slides along is turned, not hit. Arcs of one circle are one link.

A link is :data:`ROWS` rows of the pool, in the chain's own directions [m], before the vertices; behind them
is a box about every :data:`BLOCK` of them. ``physicslab/state/chain_links.py`` makes them.
"""

import math
from typing import NamedTuple

from physicslab.kernels import always_inlined, inlined
from physicslab.kernels.geometry.shapes import Shapes

BLOCK = 16
"""Number of links that have one box about them."""
ROWS = 7
"""Number of rows of the pool that a link has."""
_BOX, _SEGMENT = 4, 6


class Link(NamedTuple):
    """A face or an arc.

    Whether it bends: 0 is a face, 1 an arc about a centre on the solid side, -1 one about a centre outside;
    the length of a face or the radius of an arc [m]; where the face begins, or the centre [m]; the normals
    where it begins and where it ends.
    """

    bend: float
    size: float
    x: float
    y: float
    nx: float
    ny: float
    mx: float
    my: float


@inlined
def count_links(shapes: Shapes, i: int) -> int:
    """Return how many links the chain in row i has."""
    return int(shapes.pool[shapes.first[i] - 2, 0])


@inlined
def _begin(shapes: Shapes, i: int) -> int:
    """Return where the links of a chain begin in the pool."""
    count = count_links(shapes, i)
    return int(shapes.first[i] - 2 - ROWS * count - 2 * ((count + BLOCK - 1) // BLOCK))


@inlined
def link_of(shapes: Shapes, i: int, k: int) -> Link:
    """Return link k of the chain in row i."""
    at, pool = _begin(shapes, i) + ROWS * k, shapes.pool
    return Link(
        pool[at, 0], pool[at, 1], pool[at + 1, 0], pool[at + 1, 1],
        pool[at + 2, 0], pool[at + 2, 1], pool[at + 3, 0], pool[at + 3, 1],
    )  # fmt: skip


@always_inlined
def segment_at(shapes: Shapes, i: int, k: int) -> int:
    """Return the number of the segment on which link k of the chain in row i begins."""
    return int(shapes.pool[_begin(shapes, i) + ROWS * k + _SEGMENT, 0])


@inlined
def box_of(shapes: Shapes, i: int, k: int) -> tuple[float, float, float, float]:
    """Return the lowest and the highest coordinates of link k of the chain in row i [m]."""
    at, pool = _begin(shapes, i) + ROWS * k + _BOX, shapes.pool
    return pool[at, 0], pool[at, 1], pool[at + 1, 0], pool[at + 1, 1]


@inlined
def are_joined(shapes: Shapes, i: int, k: int, other: int) -> bool:
    """Whether one of two links of the chain in row i goes over into the other without a notch."""
    count, last = count_links(shapes, i), 0
    if other == (k + 1) % count:
        last = k
    elif k == (other + 1) % count:
        last = other
    else:
        return False
    return bool(shapes.pool[_begin(shapes, i) + ROWS * last + _SEGMENT, 1] > 0.0)


@inlined
def next_near(shapes: Shapes, i: int, k: int, x: float, y: float, room: float) -> int:
    """Return the first link from number k on of which the box is within ``room`` of (x, y) along x and y [m].

    The place is seen from the chain in row i, in its own directions. Where there is none, their number.
    """
    count, first = count_links(shapes, i), _begin(shapes, i)
    while k < count:
        if k % BLOCK == 0:
            at = first + ROWS * count + 2 * (k // BLOCK)
            if _beyond_box(shapes, at, x, y) > room:
                k += BLOCK
                continue
        if _beyond_box(shapes, first + ROWS * k + _BOX, x, y) <= room:
            return k
        k += 1
    return count


@inlined
def _beyond_box(shapes: Shapes, at: int, x: float, y: float) -> float:
    """Return how far a place is from a box of the pool, along the axis along which that is more [m]."""
    pool = shapes.pool
    beyond_x = max(pool[at, 0] - x, x - pool[at + 1, 0])
    farther: float = max(beyond_x, max(pool[at, 1] - y, y - pool[at + 1, 1]))
    return farther


@inlined
def distance_to_links(shapes: Shapes, i: int, x: float, y: float, enough: float) -> float:
    """Return a distance that a place has at least from the chain in row i [m]; above ``enough`` any such.

    The place is seen from the chain, in its own directions.
    """
    nearest, count = math.inf, count_links(shapes, i)
    k = next_near(shapes, i, 0, x, y, enough)
    while k < count:
        link = link_of(shapes, i, k)
        dx, dy = x - link.x, y - link.y
        if link.bend == 0.0:
            along = min(max(link.nx * dy - link.ny * dx, 0.0), link.size)
            dx, dy = dx + along * link.ny, dy - along * link.nx
            nearest = min(nearest, math.sqrt(dx * dx + dy * dy))
        else:
            nearest = min(
                nearest,
                max(
                    abs(math.sqrt(dx * dx + dy * dy) - link.size),
                    _beyond_box(shapes, _begin(shapes, i) + ROWS * k + _BOX, x, y),
                ),
            )
        k = next_near(shapes, i, k + 1, x, y, min(enough, nearest))
    return nearest if nearest < math.inf else enough


@inlined
def beside_arc(link: Link, nx: float, ny: float) -> tuple[float, float]:
    """Return the sines of how far a normal is within both ends of an arc."""
    return link.bend * (link.nx * ny - link.ny * nx), link.bend * (nx * link.my - ny * link.mx)
