"""Where a shape touches one segment of a chain, which is solid on its left and knows its neighbours.

A chain collides with the right side of its segments alone, and at a vertex with directions between the
normals there alone: so nothing catches on a seam (the ghost vertices of Box2D: Catto, "Continuous collision",
GDC 2013). Where two segments form a convex corner, each has the half of these directions that is nearer to
its own normal; in a valley there are none. An end of an open chain is a corner of a right angle.

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
_STRAIGHT = 1e-9
"""Sine of the angle of two segments below which they are one line."""


class End(NamedTuple):
    """A vertex of a segment: its place [m], and the directions there, counter-clockwise from one to another.

    ``outer`` is the one that is not the segment's normal. Whether there are any, and whether all of them are
    the segment's own.
    """

    x: float
    y: float
    from_x: float
    from_y: float
    to_x: float
    to_y: float
    outer_x: float
    outer_y: float
    convex: bool
    whole: bool


@inlined
def _end(x: float, y: float, nx: float, ny: float, to_x: float, to_y: float, sign: float) -> End:
    """Return the end of a segment with a normal; its neighbour leads away by (to_x, to_y).

    ``sign`` is 1 where the segment ends, and -1 where it begins.
    """
    length = math.sqrt(to_x * to_x + to_y * to_y)
    mx, my = sign * to_y / length, -sign * to_x / length
    turn, same = sign * (nx * my - ny * mx), nx * mx + ny * my
    back = same < 0.0 and abs(turn) <= _STRAIGHT
    if back:  # a right angle
        mx, my = -sign * ny, sign * nx
    convex = back or turn > _STRAIGHT
    if sign > 0.0:
        return End(x, y, nx, ny, mx, my, mx, my, convex, back)
    return End(x, y, mx, my, nx, ny, mx, my, convex, back)


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
        if b.radius > 0.0 and away > 0.0:
            fx, fy = px / away, py / away
            clear = _reach_along(x, y, fx, fy, b, pool)
            if clear > gap and _is_between(end, fx, fy):
                gap, ux, uy, feature = clear, fx, fy, VERTICES + 8 * k
    return gap, ux, uy, feature


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
    after, before = (
        _reach_along(x - qx, y - qy, tx, ty, b, pool),
        _reach_along(x - px, y - py, -tx, -ty, b, pool),
    )
    beside, sign = max(after, before), 1.0 if after > before else -1.0
    better, of_vertex, own, ux, uy, feature, ex, ey = _BETTER * b.thin, False, True, nx, ny, 0, px, py
    for which in range(2):
        neighbour_x, neighbour_y = corner(3 * which - 1, a, pool)
        if which == 0:
            end = _end(px, py, nx, ny, neighbour_x - px, neighbour_y - py, -1.0)
        else:
            end = _end(qx, qy, nx, ny, neighbour_x - qx, neighbour_y - qy, 1.0)
        if end.convex:
            clear = _reach_along(x - end.x, y - end.y, end.outer_x, end.outer_y, b, pool)
            if clear > gap + better:
                gap, of_vertex, own, ux, uy = clear, False, False, end.outer_x, end.outer_y
            clear, wx, wy, found = _part_at(end, x, y, b, pool)
            if clear > gap + (0.0 if r > 0.0 else better):
                nearer = wx * nx + wy * ny - (wx * end.outer_x + wy * end.outer_y)
                gap, of_vertex, ux, uy, feature = clear, True, wx, wy, found + which
                own, ex, ey = end.whole or nearer > 0.0 or (nearer == 0.0 and which == 0), end.x, end.y
    if beside > gap:
        apart = Touch(beside - r, sign * tx, sign * ty, 0, none, none)
    else:
        apart = Touch(gap - r, ux, uy, 0, none, none)
    if not own:
        return apart
    if of_vertex:
        separation = gap - r
        if separation > margin:
            return Touch(separation, ux, uy, 0, none, none)
        point = Corner(ex + 0.5 * separation * ux, ey + 0.5 * separation * uy, separation, feature)
        return Touch(separation, ux, uy, 1, point, none)
    if height < 0.0:  # behind it
        return Touch(-height, -nx, -ny, 0, none, none) if -height > apart.gap else apart
    if apart.gap > margin:
        return apart
    edge = nearest_edge(nx, ny, b, pool)
    next_edge = (edge + 1) % b.vertices
    vx, vy = corner(edge, b, pool)
    wx, wy = corner(next_edge, b, pool)
    vx, vy, wx, wy = x + vx, y + vy, wx - vx, wy - vy
    along, run = tx * (vx - px) + ty * (vy - py), tx * wx + ty * wy
    start, share, seam = 0.0, 1.0, _SEAM * b.thin
    if abs(run) > seam:
        low, high = (-seam - along) / run, (length + seam - along) / run
        start, share = max(start, min(low, high)), min(share, max(low, high))
    elif along < -seam or along > length + seam:
        share = -1.0
    if start > share:
        return apart
    distance = nx * px + ny * py
    one = on_face(start, vx, vy, wx, wy, nx, ny, distance, 0.0, r)
    two = on_face(share, vx, vy, wx, wy, nx, ny, distance, 0.0, r)
    one = Corner(one.x, one.y, one.separation, FACE + edge)
    two = Corner(two.x, two.y, two.separation, FACE + next_edge)
    first = one.separation <= margin
    if b.vertices == 1 or two.separation > margin or (share - start) * abs(run) <= 2.0 * seam:
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
