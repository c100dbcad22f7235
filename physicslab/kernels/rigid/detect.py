"""Which points of a pair touch, or would next: at most two, however its shapes lie."""

import math

from physicslab.kernels import Numbers, Vectors, inlined
from physicslab.kernels.rigid.features import (
    BOX,
    CENTRE,
    CORNER,
    FEATURE,
    HEIGHT,
    KIND,
    ONE,
    OTHER,
    PAIR,
    VERTEX,
    WALL,
    WIDTH,
    Points,
    Scene,
    face_of,
    vertex_of,
)

__all__ = ["TIE", "find_points", "seen_from"]

TIE = 1e-9
"""Share of the size within which two faces are equally far, or one takes over from a corner, so that speeds
decide."""
Lie = tuple[float, float, float, float]
"""Centre of a box in another one's directions, from its centre [m]; cosine and sine of the angle between
them."""


@inlined
def _write(points: Points, n: int, pair: int, one: int, feature: int, other: int, vertex: int) -> int:
    points[n, PAIR], points[n, ONE], points[n, OTHER] = pair, one, other
    points[n, FEATURE], points[n, VERTEX] = feature, vertex
    return n + 1


@inlined
def seen_from(q: Numbers, rows: int, row: int, x: float, y: float) -> tuple[float, float]:
    """Return a place of the world in a body's own directions, from its centre [m]."""
    c, s = math.cos(q[2 * rows + row]), math.sin(q[2 * rows + row])
    dx, dy = x - q[2 * row], y - q[2 * row + 1]
    return c * dx + s * dy, c * dy - s * dx


@inlined
def _corner(q: Numbers, rows: int, outlines: Vectors, row: int, vertex: int) -> tuple[float, float]:
    """Return where a corner of a box is [m]."""
    ux, uy, _ = vertex_of(outlines, row, vertex)
    c, s = math.cos(q[2 * rows + row]), math.sin(q[2 * rows + row])
    return q[2 * row] + c * ux - s * uy, q[2 * row + 1] + s * ux + c * uy


@inlined
def _disc_to_box(
    points: Points, n: int, pair: int, q: Numbers, v: Numbers, rows: int, outlines: Vectors, box: int,
    disc: int, tie: float,
) -> int:  # fmt: skip
    """Find the face or the corner of a box that is nearest to a disc.

    On the line between them, where one takes over from the other, it is that towards which the disc moves.
    """
    x, y = seen_from(q, rows, box, q[2 * disc], q[2 * disc + 1])
    over_x, over_y = abs(x) - 0.5 * outlines[box, WIDTH], abs(y) - 0.5 * outlines[box, HEIGHT]
    if min(abs(over_x), abs(over_y)) <= tie:
        c, s, spin = math.cos(q[2 * rows + box]), math.sin(q[2 * rows + box]), v[2 * rows + box]
        vx, vy = v[2 * disc] - v[2 * box], v[2 * disc + 1] - v[2 * box + 1]
        rate_x, rate_y = c * vx + s * vy + spin * y, c * vy - s * vx - spin * x
        over_x = over_x if abs(over_x) > tie else (rate_x if x > 0.0 else -rate_x)
        over_y = over_y if abs(over_y) > tie else (rate_y if y > 0.0 else -rate_y)
    if over_x > 0.0 and over_y > 0.0:
        corner = (0 if x > 0.0 else 1) if y > 0.0 else (3 if x > 0.0 else 2)
        return _write(points, n, pair, box, CORNER + corner, disc, CENTRE)
    face = (0 if x > 0.0 else 2) if over_x > over_y else (1 if y > 0.0 else 3)
    return _write(points, n, pair, box, face, disc, CENTRE)


@inlined
def _box_to_wall(
    points: Points, n: int, pair: int, q: Numbers, rows: int, outlines: Vectors, box: int, wall: int
) -> int:
    """Find the two corners of a box that are nearest to a wall."""
    axis, sign = (0 if wall == 0 or wall == 2 else 1), (1.0 if wall < 2 else -1.0)
    first, second, low, next_low = 0, 0, math.inf, math.inf
    for vertex in range(4):
        place = _corner(q, rows, outlines, box, vertex)
        height = sign * (place[0] if axis == 0 else place[1])
        if height < low:
            second, next_low = first, low
            first, low = vertex, height
        elif height < next_low:
            second, next_low = vertex, height
    n = _write(points, n, pair, 0, WALL + wall, box, min(first, second))
    return _write(points, n, pair, 0, WALL + wall, box, max(first, second))


@inlined
def _lie(
    q: Numbers, rows: int, one: int, other: int
) -> tuple[tuple[float, float, float, float], tuple[float, float, float, float]]:
    """Return how OTHER lies, seen from ONE, and how ONE does, seen from OTHER."""
    angle, angle_other = q[2 * rows + one], q[2 * rows + other]
    c, s, co, so = math.cos(angle), math.sin(angle), math.cos(angle_other), math.sin(angle_other)
    dx, dy = q[2 * other] - q[2 * one], q[2 * other + 1] - q[2 * one + 1]
    turn_c, turn_s = c * co + s * so, c * so - s * co
    there = (c * dx + s * dy, c * dy - s * dx, turn_c, turn_s)
    return there, (-co * dx - so * dy, so * dx - co * dy, turn_c, -turn_s)


@inlined
def _nearest_corner(lie: Lie, outlines: Vectors, one: int, face: int, other: int) -> tuple[float, int]:
    """Return how far all of OTHER is from a face of ONE [m], and its corner that is nearest."""
    x, y, c, s = lie
    fx, fy, distance, _ = face_of(outlines, one, face)
    along, across = fx * c + fy * s, fy * c - fx * s  # the normal, seen from OTHER
    nearest = 0 if across <= 0.0 else 3
    if along > 0.0:
        nearest = 1 if across <= 0.0 else 2
    reach = 0.5 * (abs(along) * outlines[other, WIDTH] + abs(across) * outlines[other, HEIGHT])
    return fx * x + fy * y - reach - distance, nearest


@inlined
def _farthest_face(
    q: Numbers, v: Numbers, rows: int, outlines: Vectors, one: int, other: int, lie: Lie, tie: float
) -> tuple[int, float]:
    """Return the face of ONE from which all of OTHER is farthest, and how far [m].

    Of faces that are equally far, as where two corners meet, the one that recedes faster: only there could
    they pass each other, and a box that slides over the joint of two tiles is not stopped by the side of
    the next.
    """
    best, farthest, count = 0, -math.inf, 0
    for face in range(4):
        gap, _ = _nearest_corner(lie, outlines, one, face, other)
        if gap > farthest:
            best, farthest = face, gap
    for face in range(4):
        gap, _ = _nearest_corner(lie, outlines, one, face, other)
        count += gap > farthest - tie
    if count == 1:
        return best, farthest
    fastest = -math.inf
    for face in range(4):
        gap, _ = _nearest_corner(lie, outlines, one, face, other)
        if gap > farthest - tie:
            rate = _face_rate(q, v, rows, outlines, one, face, other, lie)
            if rate > fastest:
                best, fastest = face, rate
    return best, farthest


@inlined
def _face_rate(
    q: Numbers, v: Numbers, rows: int, outlines: Vectors, one: int, face: int, other: int, lie: Lie
) -> float:
    """Return how fast the nearest corner of OTHER recedes from a face of ONE [m/s]."""
    fx, fy, _, _ = face_of(outlines, one, face)
    _, vertex = _nearest_corner(lie, outlines, one, face, other)
    x, y = _corner(q, rows, outlines, other, vertex)
    c, s = math.cos(q[2 * rows + one]), math.sin(q[2 * rows + one])
    nx, ny = c * fx - s * fy, s * fx + c * fy
    vx = v[2 * other] - v[2 * rows + other] * (y - q[2 * other + 1])
    vy = v[2 * other + 1] + v[2 * rows + other] * (x - q[2 * other])
    vx -= v[2 * one] - v[2 * rows + one] * (y - q[2 * one + 1])
    vy -= v[2 * one + 1] + v[2 * rows + one] * (x - q[2 * one])
    rate: float = nx * vx + ny * vy
    return rate


@inlined
def _facing(q: Numbers, rows: int, one: int, face: int, other: int) -> int:
    """Return the face of OTHER that lies most against a face of ONE."""
    turn = q[2 * rows + other] - q[2 * rows + one] - 0.5 * math.pi * face
    opposite = math.floor((math.pi - turn) / (0.5 * math.pi) + 0.5)
    face_of_other: int = opposite % 4
    return face_of_other


@inlined
def _box_to_box(
    points: Points, n: int, pair: int, q: Numbers, v: Numbers, rows: int, outlines: Vectors,
    a: int, b: int, tie: float,
) -> tuple[int, float]:  # fmt: skip
    """Find the ends of the stretch along which two boxes face each other, and how far they are apart [m]."""
    b_from_a, a_from_b = _lie(q, rows, a, b)
    face_a, gap_a = _farthest_face(q, v, rows, outlines, a, b, b_from_a, tie)
    face_b, gap_b = _farthest_face(q, v, rows, outlines, b, a, a_from_b, tie)
    one, other, face, lie, lie_back = a, b, face_a, b_from_a, a_from_b
    instead = gap_b > gap_a + tie
    if abs(gap_b - gap_a) <= tie:
        rate = _face_rate(q, v, rows, outlines, a, face_a, b, b_from_a)
        instead = _face_rate(q, v, rows, outlines, b, face_b, a, a_from_b) > rate + tie
    if instead:
        one, other, face, lie, lie_back = b, a, face_b, a_from_b, b_from_a
    against = _facing(q, rows, one, face, other)
    for k in range(2):
        vertex = (against + 3) % 4 if k == 0 else against
        if _within(lie, outlines, one, face, other, vertex) >= -tie:
            n = _write(points, n, pair, one, face, other, vertex)
    for k in range(2):
        vertex = (face + 3) % 4 if k == 0 else face
        if _within(lie_back, outlines, other, against, one, vertex) > tie:
            n = _write(points, n, pair, other, against, one, vertex)
    return n, max(gap_a, gap_b)


@inlined
def _within(lie: Lie, outlines: Vectors, one: int, face: int, other: int, vertex: int) -> float:
    """Return how far a corner of OTHER is from the nearer end of a face of ONE, along it [m]."""
    fx, fy, _, half = face_of(outlines, one, face)
    ux, uy, _ = vertex_of(outlines, other, vertex)
    x, y, c, s = lie
    x, y = x + c * ux - s * uy, y + s * ux + c * uy
    return half - abs(fx * y - fy * x)


@inlined
def find_points(scene: Scene, p: int, q: Numbers, v: Numbers, points: Points) -> tuple[int, float]:
    """Write the points where pair ``p`` touches, or would; return how many they are.

    And, of two boxes, a distance that they have at least where it is positive [m]; infinity of other pairs,
    which have the smallest gap of their points.
    """
    rows, outlines, tie = scene.rows, scene.outlines, TIE * scene.coefficients[p, 2]
    a, b, wall = scene.pairs[p, 0], scene.pairs[p, 1], scene.pairs[p, 2]
    if wall >= 0:
        if outlines[b, KIND] == BOX:
            return _box_to_wall(points, 0, p, q, rows, outlines, b, wall), math.inf
        return _write(points, 0, p, 0, WALL + wall, b, CENTRE), math.inf
    if outlines[a, KIND] == BOX and outlines[b, KIND] == BOX:
        return _box_to_box(points, 0, p, q, v, rows, outlines, a, b, tie)
    if outlines[a, KIND] == BOX:
        return _disc_to_box(points, 0, p, q, v, rows, outlines, a, b, tie), math.inf
    if outlines[b, KIND] == BOX:
        return _disc_to_box(points, 0, p, q, v, rows, outlines, b, a, tie), math.inf
    return _write(points, 0, p, a, CENTRE, b, CENTRE), math.inf
