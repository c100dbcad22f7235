"""Where a shape touches one segment of a chain, which is solid on its left and knows its neighbours.

A chain collides with the right side of its segments alone, and at a vertex with directions between the
normals there alone: so nothing catches on a seam (the ghost vertices of Box2D: Catto, "Continuous collision",
GDC 2013). Where it turns by up to 15 degrees an arc takes the place of the vertex, as
:mod:`physicslab.kernels.geometry.links` says; where it turns further, outwards, there is a corner. Each
segment has the half of these directions that is nearer to its own normal. An end of an open chain is a corner
of a right angle.

The pool has a vertex before the first one of a chain and one behind the last: its neighbours where it is
closed; else the other end of the segment, as if the chain turned back. Coordinates are relative to the
chain's origin.
"""

import math
from typing import NamedTuple

from physicslab.kernels import Vectors, inlined
from physicslab.kernels.geometry.cores import (
    FACE,
    FLIPPED,
    VERTICES,
    Touch,
    nearest_edge,
    on_face,
    touch_cores,
)
from physicslab.kernels.geometry.manifold import Corner
from physicslab.kernels.geometry.outline import Outline, Way, corner, is_segment

_BETTER = 1e-3
"""Share of the smallest width by which another direction must part the two by more than the normal does."""
_SEAM = 1e-9
"""Share of the smallest width by which what is beyond the end of a segment still touches it."""
_TOGETHER = 0.02
"""Share of the smallest width by which points on an arc may differ in depth and have one normal."""
_STRAIGHT = 1e-9
"""Sine of the angle of two segments below which they are one line."""
_SMOOTH = math.cos(math.radians(15.0)) - 1e-10
"""Cosine of the angle of two segments from which on a chain is round there."""


class End(NamedTuple):
    """Where a segment ends: a corner, or the centre of an arc; its radius, and how far the arc reaches [m].

    The directions there, counter-clockwise from one to another; ``outer`` is the one that is not the
    segment's normal. Whether the chain turns outwards there, or inwards in an arc, and whether all of the
    directions are the segment's own.
    """

    x: float
    y: float
    radius: float
    used: float
    from_x: float
    from_y: float
    to_x: float
    to_y: float
    outer_x: float
    outer_y: float
    convex: bool
    hollow: bool
    whole: bool


@inlined
def _end(
    x: float, y: float, own_length: float, nx: float, ny: float, to_x: float, to_y: float, sign: float
) -> End:
    """Return the end of a segment with a length [m] and normal; its neighbour leads away by (to_x, to_y).

    ``sign`` is 1 where the segment ends, and -1 where it begins.
    """
    length = math.sqrt(to_x * to_x + to_y * to_y)
    mx, my = sign * to_y / length, -sign * to_x / length
    turn, same = sign * (nx * my - ny * mx), nx * mx + ny * my
    back = same < 0.0 and abs(turn) <= _STRAIGHT
    if back:  # a right angle
        mx, my = -sign * ny, sign * nx
    convex, round_, radius, used = back or turn > _STRAIGHT, same >= _SMOOTH, 0.0, 0.0
    hollow = round_ and turn < -_STRAIGHT
    if round_ and abs(turn) > _STRAIGHT:
        used = 0.5 * min(own_length, length)
        radius = used * (1.0 + same) / abs(turn)
        depth = radius if convex else -radius
        x, y = x + sign * used * ny - depth * nx, y - sign * used * nx - depth * ny
    if (sign > 0.0) != hollow:
        return End(x, y, radius, used, nx, ny, mx, my, mx, my, convex, hollow, back)
    return End(x, y, radius, used, mx, my, nx, ny, mx, my, convex, hollow, back)


@inlined
def end_of(a: Outline, pool: Vectors, which: int) -> End:
    """Return the first or the second end of a segment."""
    px, py = corner(0, a, pool)
    qx, qy = corner(1, a, pool)
    tx, ty = qx - px, qy - py
    length = math.sqrt(tx * tx + ty * ty)
    nx, ny = ty / length, -tx / length
    to_x, to_y = corner(3 * which - 1, a, pool)
    if which == 0:
        return _end(px, py, length, nx, ny, to_x - px, to_y - py, -1.0)
    return _end(qx, qy, length, nx, ny, to_x - qx, to_y - qy, 1.0)


class Spot(NamedTuple):
    """A point, and its normal."""

    at: Corner
    nx: float
    ny: float


@inlined
def _put_in(one: Spot, two: Spot, new: Spot) -> tuple[Spot, Spot]:
    """Return the two of three points that are deepest, in order."""
    if new.at.separation < one.at.separation:
        return new, one
    return one, new if new.at.separation < two.at.separation else two


@inlined
def _within_arc(
    end: End, which: int, x: float, y: float, nx: float, ny: float, b: Outline, pool: Vectors, one: Spot,
    two: Spot,
) -> tuple[Spot, Spot]:  # fmt: skip
    """Put in the vertices of B, which is at (x, y), that are at the segment's half of a hollow arc."""
    for k in range(b.vertices):
        vx, vy = corner(k, b, pool)
        dx, dy = x + vx - end.x, y + vy - end.y
        distance = math.sqrt(dx * dx + dy * dy)
        if distance == 0.0:
            continue
        ux, uy = -dx / distance, -dy / distance
        nearer = ux * nx + uy * ny - (ux * end.outer_x + uy * end.outer_y)
        if _is_between(end, ux, uy) and (nearer > 0.0 or (nearer == 0.0 and which == 0)):
            gap = end.radius - distance - b.radius
            back = b.radius + 0.5 * gap
            place = Corner(x + vx - back * ux, y + vy - back * uy, gap, VERTICES + which + 8 * k)
            one, two = _put_in(one, two, Spot(place, ux, uy))
    return one, two


@inlined
def _is_between(end: End, x: float, y: float) -> bool:
    return bool(end.from_x * y - end.from_y * x >= 0.0 and x * end.to_y - y * end.to_x >= 0.0)


@inlined
def _reach_along(x: float, y: float, ux: float, uy: float, b: Outline, pool: Vectors) -> float:
    """Return how far along a direction the core of B, which is at (x, y), begins [m]."""
    least = math.inf
    for j in range(b.vertices):
        vx, vy = corner(j, b, pool)
        least = min(least, ux * (x + vx) + uy * (y + vy))
    return least


@inlined
def _part_at(end: End, x: float, y: float, b: Outline, pool: Vectors) -> tuple[float, float, float, int]:
    """Return by how much a vertex and the core of B part at most along the directions there [m].

    Then that direction, and the feature of B; minus infinity where no feature of B has such a direction.
    """
    gap, ux, uy, feature = -math.inf, 0.0, 0.0, 0
    x, y = x - end.x, y - end.y
    for k in range(b.vertices):
        px, py = corner(k, b, pool)
        px, py = x + px, y + py
        if b.vertices > 1:
            qx, qy = corner((k + 1) % b.vertices, b, pool)
            wx, wy = x + qx - px, y + qy - py
            length = math.sqrt(wx * wx + wy * wy)
            fx, fy = -wy / length, wx / length  # into B
            clear = fx * px + fy * py
            if clear > gap and _is_between(end, fx, fy):
                gap, ux, uy, feature = clear, fx, fy, FLIPPED + 8 * k
        away = math.sqrt(px * px + py * py)
        if b.radius + end.radius > 0.0 and away > 0.0:
            fx, fy = px / away, py / away
            clear = _reach_along(x, y, fx, fy, b, pool)
            if clear > gap and _is_between(end, fx, fy):
                gap, ux, uy, feature = clear, fx, fy, VERTICES + 8 * k
    return gap, ux, uy, feature


@inlined
def _of_spots(one: Spot, two: Spot, margin: float, thin: float) -> Touch:
    """Return where an arc touches at one or two points, with the normal between theirs.

    A point that comes later by more than a share of the smallest width has a normal of its own then.
    """
    none, gap, nx, ny = Corner(0.0, 0.0, 0.0, 0), one.at.separation, one.nx, one.ny
    if gap > margin:
        return Touch(gap, nx, ny, 0, none, none)
    turned = one.nx != two.nx or one.ny != two.ny
    if two.at.separation > margin or (turned and two.at.separation > gap + _TOGETHER * thin):
        return Touch(gap, nx, ny, 1, one.at, none)
    if turned:
        nx, ny = one.nx + two.nx, one.ny + two.ny
        length = math.sqrt(nx * nx + ny * ny)
        nx, ny = nx / length, ny / length
    return Touch(gap, nx, ny, 2, one.at, two.at)


@inlined
def _touch_segment(x: float, y: float, a: Outline, b: Outline, pool: Vectors, margin: float) -> Touch:
    """Return where the segment A and B, which is at (x, y), touch; see :func:`touch_outlines`."""
    none, r = Corner(0.0, 0.0, 0.0, 0), b.radius
    px, py = corner(0, a, pool)
    qx, qy = corner(1, a, pool)
    tx, ty = qx - px, qy - py
    length = math.sqrt(tx * tx + ty * ty)
    tx, ty = tx / length, ty / length
    nx, ny = ty, -tx
    height = nx * (x - px) + ny * (y - py)
    gap = _reach_along(x - px, y - py, nx, ny, b, pool)
    after = _reach_along(x - qx, y - qy, tx, ty, b, pool)
    before = _reach_along(x - px, y - py, -tx, -ty, b, pool)
    beside, sign = max(after, before), 1.0 if after > before else -1.0
    better, of_vertex, own, ux, uy, feature, ex, ey = _BETTER * b.thin, False, True, nx, ny, 0, px, py
    # Arcs begin before the ends, and hollow ones lie above the segment.
    nothing, used_first, used_last = Spot(Corner(0.0, 0.0, math.inf, 0), nx, ny), 0.0, 0.0
    deepest, next_deepest = nothing, nothing
    for which in range(2):
        end = end_of(a, pool, which)
        if which == 0:
            used_first = end.used
        else:
            used_last = end.used
        if end.hollow and end.radius > r:
            deepest, next_deepest = _within_arc(end, which, x, y, nx, ny, b, pool, deepest, next_deepest)
        if end.convex:
            clear = _reach_along(x - end.x, y - end.y, end.outer_x, end.outer_y, b, pool) - end.radius
            if clear > gap + better:
                gap, of_vertex, own, ux, uy = clear, False, False, end.outer_x, end.outer_y
            clear, wx, wy, found = _part_at(end, x, y, b, pool)
            clear -= end.radius
            if clear > gap + (0.0 if r + end.radius > 0.0 else better):
                nearer = wx * nx + wy * ny - (wx * end.outer_x + wy * end.outer_y)
                gap, of_vertex, ux, uy, feature = clear, True, wx, wy, found + which
                own = end.whole or nearer > 0.0 or (nearer == 0.0 and which == 0)
                ex, ey = end.x + end.radius * wx, end.y + end.radius * wy
    if beside > gap:
        apart = Touch(beside - r, sign * tx, sign * ty, 0, none, none)
    else:
        apart = Touch(gap - r, ux, uy, 0, none, none)
    if not own:
        return apart
    if of_vertex:
        separation, height = gap - r, ux * (x - ex) + uy * (y - ey)
        if separation > margin:
            return Touch(separation, ux, uy, 0, none, none)
        if height < 0.0:  # behind it
            return Touch(-height, -ux, -uy, 0, none, none)
        point = Corner(ex + 0.5 * separation * ux, ey + 0.5 * separation * uy, separation, feature)
        return Touch(separation, ux, uy, 1, point, none)
    if height < 0.0:  # behind it
        return Touch(-height, -nx, -ny, 0, none, none) if -height > apart.gap else apart
    hollow = deepest.at.separation < math.inf
    if apart.gap > margin and not hollow:
        return apart
    edge = nearest_edge(nx, ny, b, pool)
    next_edge = (edge + 1) % b.vertices
    vx, vy = corner(edge, b, pool)
    wx, wy = corner(next_edge, b, pool)
    vx, vy, wx, wy = x + vx, y + vy, wx - vx, wy - vy
    along, run = tx * (vx - px) + ty * (vy - py), tx * wx + ty * wy
    start, share, seam = 0.0, 1.0, _SEAM * b.thin
    begins, ends = used_first - seam, length - used_last + seam
    if abs(run) > seam:
        low, high = (begins - along) / run, (ends - along) / run
        start, share = max(start, min(low, high)), min(share, max(low, high))
    elif along < begins or along > ends:
        share = -1.0
    if start > share:
        return _of_spots(deepest, next_deepest, margin, b.thin) if hollow else apart
    distance = nx * px + ny * py
    one = on_face(start, vx, vy, wx, wy, nx, ny, distance, 0.0, r)
    two = on_face(share, vx, vy, wx, wy, nx, ny, distance, 0.0, r)
    one = Corner(one.x, one.y, one.separation, FACE + edge)
    two = Corner(two.x, two.y, two.separation, FACE + next_edge)
    alone = b.vertices == 1 or (share - start) * abs(run) <= 2.0 * seam
    if hollow:
        deepest, next_deepest = _put_in(deepest, next_deepest, Spot(one, nx, ny))
        if not alone:
            deepest, next_deepest = _put_in(deepest, next_deepest, Spot(two, nx, ny))
        return _of_spots(deepest, next_deepest, margin, b.thin)
    first = one.separation <= margin
    if alone or two.separation > margin:
        return Touch(apart.gap, nx, ny, 1 if first else 0, one, none)
    if not first:
        return Touch(apart.gap, nx, ny, 1, two, none)
    return Touch(apart.gap, nx, ny, 2, one, two)


@inlined
def _flipped(point: Corner, dx: float, dy: float) -> Corner:
    """Return a point seen from the other body, which is (dx, dy) away."""
    feature = point.feature
    if feature >= VERTICES:
        feature = VERTICES + (feature - VERTICES) // 8 + 8 * ((feature - VERTICES) % 8)
    elif feature >= FLIPPED:
        feature += FACE - FLIPPED
    elif feature >= FACE:
        feature += FLIPPED - FACE
    return Corner(point.x + dx, point.y + dy, point.separation, feature)


@inlined
def touch_outlines(way: Way, a: Outline, b: Outline, pool: Vectors, margin: float, old: int) -> Touch:
    """Return where two outlines touch, as :func:`touch_cores` does; one may be a segment of a chain."""
    if is_segment(a):
        return _touch_segment(way.dx, way.dy, a, b, pool, margin)
    if is_segment(b):
        gap, nx, ny, points, one, two = _touch_segment(-way.dx, -way.dy, b, a, pool, margin)
        return Touch(gap, -nx, -ny, points, _flipped(one, way.dx, way.dy), _flipped(two, way.dx, way.dy))
    return touch_cores(way, a, b, pool, margin, old)
