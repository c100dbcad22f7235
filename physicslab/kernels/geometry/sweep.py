"""When moving shapes first touch: for bodies so fast that they could step over each other.

Each function returns the share of the displacement (ux, uy) of B against A, 0 to 1, at which they touch, or 2
where they miss each other. Rotation within the displacement is neglected, but for a box that turns into a
circle.
"""

import math

from physicslab.kernels import Vectors, inlined
from physicslab.kernels.geometry.cores import FLIPPED, VERTICES, Touch, lowest
from physicslab.kernels.geometry.manifold import Corner, circle_box, circle_circle
from physicslab.kernels.geometry.outline import Outline, Way, is_segment, rotation, swing_of, turned
from physicslab.kernels.geometry.segment import touch_outlines

MISS = 2.0
"""Result of a sweep where two outlines miss each other."""
APPROACHES, REFINEMENTS = 40, 8
"""Largest numbers of steps towards a meeting, none of which can pass it, and of Newton's steps at its end."""
NEAR = 0.02
"""Share of the farthest motion from which on the gap is nearly linear."""
INNER_SHARE = 0.5
"""Radius of the inner disc of a shape, of half its smallest width: within any convex shape, and with room for
what overlaps a little."""
INNER = 1000
"""The feature of the point at which an inner disc meets another shape."""


@inlined
def sweep_circle_circle(dx: float, dy: float, ux: float, uy: float, reach: float) -> float:
    """Solve |d + t u| = reach for the first t, for centres (dx, dy) apart."""
    a = ux * ux + uy * uy
    b = dx * ux + dy * uy
    c = dx * dx + dy * dy - reach * reach
    if b >= 0.0 or a == 0.0:
        return MISS
    if c <= 0.0:
        return 0.0
    root = b * b - a * c
    if root < 0.0:
        return MISS
    t = c / (-b + math.sqrt(root))  # the form without cancellation
    return t if t <= 1.0 else MISS


@inlined
def _slab(d: float, u: float, reach: float) -> tuple[float, float]:
    """Return when a point at d moving by u enters and leaves |d| <= reach."""
    if u == 0.0:
        return (-math.inf, math.inf) if abs(d) <= reach else (math.inf, -math.inf)
    t1, t2 = (-reach - d) / u, (reach - d) / u
    return min(t1, t2), max(t1, t2)


@inlined
def sweep_circle_box(x: float, y: float, ux: float, uy: float, box: Outline, radius: float) -> float:
    """Return when a circle at (x, y) from a box's centre, moving by (ux, uy), touches the box."""
    c, s, half_x, half_y = box.c, box.s, box.half_x, box.half_y
    px, py, qx, qy = c * x + s * y, c * y - s * x, c * ux + s * uy, c * uy - s * ux
    enter_x, leave_x = _slab(px, qx, half_x + radius)
    enter_y, leave_y = _slab(py, qy, half_y + radius)
    t = max(enter_x, enter_y, 0.0)
    if t > min(leave_x, leave_y) or t > 1.0:
        return MISS
    at_x, at_y = px + t * qx, py + t * qy
    if abs(at_x) <= half_x or abs(at_y) <= half_y:
        return t
    # It enters by a corner of the box grown by the radius, where only the round part is solid.
    corner_x = half_x if at_x > 0.0 else -half_x
    corner_y = half_y if at_y > 0.0 else -half_y
    return sweep_circle_circle(px - corner_x, py - corner_y, qx, qy, radius)


@inlined
def sweep_turning_box(way: Way, start: float, box: Outline, turn: float, radius: float) -> float:
    """Return when a circle and a box touch that turns by ``turn`` [rad] meanwhile.

    The circle is at (dx, dy) from the box's centre at first; the box has its angle ``-start`` of the
    displacement later.
    """
    x, y, ux, uy = way
    farthest, t = math.sqrt(ux * ux + uy * uy) + swing_of(box, turn), 0.0
    for step in range(APPROACHES + REFINEMENTS):
        at_x, at_y = x + t * ux, y + t * uy
        nx, ny, _px, _py, gap = circle_box(at_x, at_y, turned(box, (start + t) * turn), radius)
        if step < APPROACHES and gap > NEAR * farthest:
            t += gap / farthest
        else:
            rate = nx * ux + ny * uy - turn * (ny * at_x - nx * at_y)
            if rate >= 0.0:
                return MISS
            if step == 0 and gap < 0.0:
                return 0.0
            t -= gap / rate
            if abs(gap) <= 1e-14 * radius:
                break
        if t > 1.0 or t < 0.0:
            return MISS
    return t


@inlined
def sweep_box_box(way: Way, a: Outline, b: Outline) -> float:
    """Return when the last of the four axes along which two boxes are apart closes."""
    dx, dy, ux, uy = way
    c, s = abs(a.c * b.c + a.s * b.s), abs(a.c * b.s - a.s * b.c)
    ax, ay, bx, by = a.half_x, a.half_y, b.half_x, b.half_y
    enter1, leave1 = _slab(a.c * dx + a.s * dy, a.c * ux + a.s * uy, ax + c * bx + s * by)
    enter2, leave2 = _slab(a.c * dy - a.s * dx, a.c * uy - a.s * ux, ay + s * bx + c * by)
    enter3, leave3 = _slab(b.c * dx + b.s * dy, b.c * ux + b.s * uy, bx + c * ax + s * ay)
    enter4, leave4 = _slab(b.c * dy - b.s * dx, b.c * uy - b.s * ux, by + s * ax + c * ay)
    t = max(max(enter1, enter2), max(enter3, enter4), 0.0)
    if t > min(min(leave1, leave2), min(leave3, leave4)) or t > 1.0:
        return MISS
    return t


@inlined
def pose_at(
    way: Way, turn_a: float, turn_b: float, a: Outline, b: Outline, share: float
) -> tuple[Way, Outline, Outline]:
    """Return how two outlines lie a share of a substep from now."""
    dx, dy, ux, uy = way
    moved = Way(dx + share * ux, dy + share * uy, ux, uy)
    return moved, turned(a, share * turn_a), turned(b, share * turn_b)


@inlined
def opening(point: Corner, way: Way, nx: float, ny: float, turn_a: float, turn_b: float) -> float:
    """Return by how much a point of two outlines opens in a substep, with the normal of now [m]."""
    bx, by = point.x - way.dx, point.y - way.dy
    ux = way.ux - turn_b * by + turn_a * point.y
    uy = way.uy + turn_b * bx - turn_a * point.x
    return ux * nx + uy * ny


@inlined
def _least_beside(
    gap: float, nx: float, ny: float, way: Way, turn: float, turn_other: float, one: Outline, other: Outline,
    pool: Vectors,
) -> float:  # fmt: skip
    """Return what :func:`least_gap` does, where the normal turns with ``one``, from which ``way`` leads."""
    (dx, dy, ux, uy), against = way, turn_other - turn
    travel = math.sqrt(ux * ux + uy * uy)
    bends = turn * turn * (math.sqrt(dx * dx + dy * dy) + travel) + 2.0 * abs(turn) * travel
    bends += abs(against) * swing_of(other, against)
    mx, my = other.c * nx + other.s * ny, other.c * ny - other.s * nx
    closes = nx * dx + ny * dy + lowest(mx, my, other, pool)
    c, s = rotation(turn)
    closes -= (c * nx - s * ny) * (dx + ux) + (s * nx + c * ny) * (dy + uy)
    c, s = rotation(against)
    closes -= lowest(c * mx + s * my, c * my - s * mx, other, pool)
    return gap - closes - 0.5 * bends


@inlined
def least_gap(
    found: Touch, way: Way, turn_a: float, turn_b: float, share: float, a: Outline, b: Outline, pool: Vectors
) -> float:  # fmt: skip
    """Return what two convex shapes are apart at least, a ``share`` of a substep from now [m].

    That is along the normal of now, which turns with the shape whose face it is of. Seen from there each
    vertex of the other one comes along it nearly as on a straight line. Taken off is half of what its speed
    may change by: so the gap in between is no smaller than on a line from that of now to this.
    """
    dx, dy, ux, uy = way.dx, way.dy, share * way.ux, share * way.uy
    turn_a, turn_b, nx, ny = share * turn_a, share * turn_b, found.nx, found.ny
    if FLIPPED <= found.one.feature < VERTICES:
        turned_way = Way(-dx, -dy, -ux, -uy)
        return _least_beside(found.gap, -nx, -ny, turned_way, turn_b, turn_a, b, a, pool)
    return _least_beside(found.gap, nx, ny, Way(dx, dy, ux, uy), turn_a, turn_b, a, b, pool)


@inlined
def sweep_outlines(
    way: Way, turn_a: float, turn_b: float, start: float, a: Outline, b: Outline, pool: Vectors
) -> float:
    """Return the share of a substep, 0 to 1 from ``start`` on, after which two outlines touch, or ``MISS``.

    They turn by ``turn_a`` and ``turn_b`` [rad] in it. The first steps are conservative advancement: the gap
    along its normal closes no faster than the way and the turning corners make it (Mirtich, 1996), nor than
    :func:`least_gap` says.
    """
    swing, t = swing_of(a, turn_a) + swing_of(b, turn_b), 0.0
    farthest, chained = math.sqrt(way.ux * way.ux + way.uy * way.uy) + swing, is_segment(a) or is_segment(b)
    for step in range(APPROACHES + REFINEMENTS):
        moved, at_a, at_b = pose_at(way, turn_a, turn_b, a, b, start + t)
        found = touch_outlines(Way(moved.dx, moved.dy, 0.0, 0.0), at_a, at_b, pool, math.inf, 0)
        gap, nx, ny = found.gap, found.nx, found.ny
        if step == 0 and gap < 0.0:
            return 0.0
        if gap <= 0.0 and found.points == 0:
            return MISS  # another segment of the chain is what it meets
        if step < APPROACHES and (gap > NEAR * farthest or found.points == 0):
            closing = swing - (nx * way.ux + ny * way.uy)
            if closing <= 0.0:
                return MISS
            advance = gap / closing
            if not chained:
                least = least_gap(found, moved, turn_a, turn_b, 1.0 - t, at_a, at_b, pool)
                if least > 0.0:
                    return MISS
                advance = max(advance, (1.0 - t) * gap / (gap - least))
            t += advance
        elif found.points == 0:
            return MISS
        else:
            later, rest = math.inf, 0.0  # of two points one may open while the other one closes
            for j in range(found.points):
                point = found.one if j == 0 else found.two
                rate = opening(point, moved, nx, ny, turn_a, turn_b)
                if rate < 0.0 and point.separation < -later * rate:
                    later, rest = -point.separation / rate, point.separation
            if later == math.inf:
                return MISS
            t += later
            if abs(rest) <= 1e-14 * farthest:
                break
        if t > 1.0 or t < 0.0:
            return MISS
    return t


@inlined
def _is_smaller(a: Outline, b: Outline) -> bool:
    """Whether A reaches less far than B; a segment of a chain never does."""
    reach_a, reach_b = swing_of(a, 1.0) + a.radius, swing_of(b, 1.0) + b.radius
    return not is_segment(a) and (is_segment(b) or reach_a < reach_b)


@inlined
def _inner_disc(outline: Outline) -> Outline:
    """Return the disc about the centre of an outline that is within it however it turns."""
    radius = INNER_SHARE * outline.thin
    return Outline(False, 1.0, 0.0, 0.0, 0.0, radius, 1, outline.first, radius)


@inlined
def is_swift(way: Way, room: float, a: Outline, b: Outline) -> bool:
    """Whether two shapes move against each other by more than the inner disc of the smaller one reaches.

    Motion by forces within the substep, up to ``room`` [m], does not count: a body at rest is not swift.
    """
    reach = room + INNER_SHARE * (a.thin if _is_smaller(a, b) else b.thin)
    return bool(way.ux * way.ux + way.uy * way.uy > reach * reach)


@inlined
def sweep_inner(
    way: Way, turn_a: float, turn_b: float, start: float, a: Outline, b: Outline, pool: Vectors
) -> tuple[float, Way, Touch]:
    """Return when the inner disc of the smaller of two shapes meets the other one, and where they touch then.

    So none passes through another one, however it turns. The time is that of :func:`sweep_outlines`; those
    that overlap at first meet then, unless they part.
    """
    inner_a, inner_b = (_inner_disc(a), b) if _is_smaller(a, b) else (a, _inner_disc(b))
    discs = inner_a.vertices == 1 and inner_b.vertices == 1
    if discs:
        x, y = way.dx + start * way.ux, way.dy + start * way.uy
        t = sweep_circle_circle(x, y, way.ux, way.uy, inner_a.radius + inner_b.radius)
    else:
        t = sweep_outlines(way, turn_a, turn_b, start, inner_a, inner_b, pool)
    meeting, met_a, met_b = pose_at(way, turn_a, turn_b, inner_a, inner_b, start + min(t, 1.0))
    if discs:
        nx, ny, gap = circle_circle(meeting.dx, meeting.dy, inner_a.radius, inner_b.radius, 0)
        at = inner_a.radius + 0.5 * gap
        none, one = Corner(0.0, 0.0, 0.0, 0), Corner(at * nx, at * ny, gap, INNER)
        return t, meeting, Touch(gap, nx, ny, 1, one, none)
    found = touch_outlines(meeting, met_a, met_b, pool, math.inf, 0)
    x, y, gap, _ = found.one
    one = Corner(x, y, max(gap, 0.0), INNER)
    if found.points == 0 or opening(one, meeting, found.nx, found.ny, turn_a, turn_b) >= 0.0:
        t = MISS
    return t, meeting, Touch(found.gap, found.nx, found.ny, 1, one, found.two)
