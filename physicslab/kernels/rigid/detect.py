"""Which points of a pair touch, or would next: at most two, however its shapes lie."""

import math

from physicslab.kernels import Numbers, inlined
from physicslab.kernels.geometry.shapes import Shapes, face, is_chain, vertex
from physicslab.kernels.geometry.vertex_cone import beside_vertex
from physicslab.kernels.rigid import features as F
from physicslab.kernels.rigid.chain_points import find_chain_points
from physicslab.kernels.rigid.features import Points, RigidScene

TIE = 1e-9
"""Share of the size within which two faces are equally far, or one takes over from a corner, so that speeds
decide."""
Lie = tuple[float, float, float, float]
"""Centre of a body in another one's directions, from its centre [m]; cosine and sine of the angle between
them."""


@inlined
def _write(points: Points, n: int, pair: int, one: int, feature: int, other: int, vertex: int) -> int:
    points[n, F.PAIR], points[n, F.ONE], points[n, F.OTHER] = pair, one, other
    points[n, F.FEATURE], points[n, F.VERTEX] = feature, vertex
    return n + 1


@inlined
def seen_from(q: Numbers, rows: int, row: int, x: float, y: float) -> tuple[float, float]:
    """Return a place of the world in a body's own directions, from its centre [m]."""
    c, s = math.cos(q[2 * rows + row]), math.sin(q[2 * rows + row])
    dx, dy = x - q[2 * row], y - q[2 * row + 1]
    return c * dx + s * dy, c * dy - s * dx


@inlined
def _lie(q: Numbers, rows: int, one: int, other: int) -> tuple[Lie, Lie]:
    """Return how OTHER lies, seen from ONE, and how ONE does, seen from OTHER."""
    angle, angle_other = q[2 * rows + one], q[2 * rows + other]
    c, s, co, so = math.cos(angle), math.sin(angle), math.cos(angle_other), math.sin(angle_other)
    dx, dy = q[2 * other] - q[2 * one], q[2 * other + 1] - q[2 * one + 1]
    turn_c, turn_s = c * co + s * so, c * so - s * co
    there = (c * dx + s * dy, c * dy - s * dx, turn_c, turn_s)
    return there, (-co * dx - so * dy, so * dx - co * dy, turn_c, -turn_s)


@inlined
def _place(lie: Lie, shapes: Shapes, other: int, k: int) -> tuple[float, float]:
    """Return where vertex k of OTHER is, seen from ONE [m]."""
    x, y, c, s = lie
    ux, uy = vertex(shapes, other, k)
    return x + c * ux - s * uy, y + s * ux + c * uy


@inlined
def _rates(
    scene: RigidScene, q: Numbers, v: Numbers, one: int, other: int, lie: Lie, k: int
) -> tuple[float, float]:
    """Return how fast vertex k of OTHER moves, seen from ONE, in its own directions [m/s]."""
    rows, (ux, uy) = scene.rows, vertex(scene.shapes, other, k)
    co, so = math.cos(q[2 * rows + other]), math.sin(q[2 * rows + other])
    spin, own = v[2 * rows + other], v[2 * rows + one]
    vx = v[2 * other] - spin * (so * ux + co * uy) - v[2 * one]
    vy = v[2 * other + 1] + spin * (co * ux - so * uy) - v[2 * one + 1]
    c, s = math.cos(q[2 * rows + one]), math.sin(q[2 * rows + one])
    x, y = _place(lie, scene.shapes, other, k)
    return c * vx + s * vy + own * y, c * vy - s * vx - own * x


@inlined
def _to_wall(points: Points, pair: int, q: Numbers, scene: RigidScene, row: int, wall: int) -> int:
    """Find the two vertices of a body that are nearest to a wall, or its only one."""
    axis, sign = (0 if wall == 0 or wall == 2 else 1), (1.0 if wall < 2 else -1.0)
    first, second, low, next_low = 0, 0, math.inf, math.inf
    c, s = math.cos(q[2 * scene.rows + row]), math.sin(q[2 * scene.rows + row])
    for k in range(scene.shapes.vertices[row]):
        ux, uy = vertex(scene.shapes, row, k)
        x, y = q[2 * row] + c * ux - s * uy, q[2 * row + 1] + s * ux + c * uy
        height = sign * (x if axis == 0 else y)
        if height < low:
            second, next_low = first, low
            first, low = k, height
        elif height < next_low:
            second, next_low = k, height
    n = _write(points, 0, pair, 0, F.WALL + wall, row, min(first, second))
    return n if first == second else _write(points, n, pair, 0, F.WALL + wall, row, max(first, second))


@inlined
def _nearest_vertex(lie: Lie, shapes: Shapes, one: int, k: int, other: int) -> tuple[float, int]:
    """Return how far the core of OTHER is from face k of ONE [m], and its vertex that is nearest."""
    x, y, c, s = lie
    fx, fy, distance, _ = face(shapes, one, k)
    along, across = fx * c + fy * s, fy * c - fx * s  # the normal, seen from OTHER
    nearest, least = 0, math.inf
    for j in range(shapes.vertices[other]):
        ux, uy = vertex(shapes, other, j)
        height = along * ux + across * uy
        if height < least:
            nearest, least = j, height
    return fx * x + fy * y + least - distance, nearest


@inlined
def _face_rate(scene: RigidScene, q: Numbers, v: Numbers, one: int, k: int, other: int, lie: Lie) -> float:
    """Return how fast the nearest vertex of OTHER recedes from face k of ONE [m/s]."""
    fx, fy, _, _ = face(scene.shapes, one, k)
    _, nearest = _nearest_vertex(lie, scene.shapes, one, k, other)
    rate_x, rate_y = _rates(scene, q, v, one, other, lie, nearest)
    rate: float = fx * rate_x + fy * rate_y
    return rate


@inlined
def _farthest_face(
    scene: RigidScene, q: Numbers, v: Numbers, one: int, other: int, lie: Lie, tie: float
) -> tuple[int, float]:
    """Return the face of ONE from which the core of OTHER is farthest, and how far [m].

    Among faces that are equally far, as where two corners meet, the one that recedes faster: only there could
    they pass each other, and a box that slides over the joint of two tiles is not stopped by the side of
    the next. A core of one vertex has no face.
    """
    best, farthest, second, faces = 0, -math.inf, -math.inf, scene.shapes.vertices[one]
    for k in range(faces if faces > 1 else 0):
        gap, _ = _nearest_vertex(lie, scene.shapes, one, k, other)
        if gap > farthest:
            best, farthest, second = k, gap, farthest
        else:
            second = max(second, gap)
    if not second > farthest - tie:
        return best, farthest
    fastest = -math.inf
    for k in range(faces):
        gap, _ = _nearest_vertex(lie, scene.shapes, one, k, other)
        if gap > farthest - tie:
            rate = _face_rate(scene, q, v, one, k, other, lie)
            if rate > fastest:
                best, fastest = k, rate
    return best, farthest


@inlined
def _facing(lie: Lie, shapes: Shapes, one: int, k: int, other: int) -> int:
    """Return the face of OTHER that lies most against face k of ONE."""
    _, _, c, s = lie
    fx, fy, _, _ = face(shapes, one, k)
    along, across, best, least = fx * c + fy * s, fy * c - fx * s, 0, math.inf
    for j in range(shapes.vertices[other]):
        gx, gy, _, _ = face(shapes, other, j)
        if along * gx + across * gy < least:
            best, least = j, along * gx + across * gy
    return best


@inlined
def _within(
    scene: RigidScene, q: Numbers, v: Numbers, one: int, k: int, other: int, j: int, lie: Lie, tie: float
) -> float:
    """Return how far vertex j of OTHER is from the nearer end of face k of ONE, along it [m].

    Where one of the two is rounded, no more than a ``tie`` is decided by how fast that distance grows [m/s].
    """
    shapes = scene.shapes
    fx, fy, _, length = face(shapes, one, k)
    ux, uy = vertex(shapes, one, k)
    x, y = _place(lie, shapes, other, j)
    start = fx * uy - fy * ux
    passed, left = (fx * y - fy * x) - start, start + length - (fx * y - fy * x)
    within: float = min(passed, left)
    if abs(within) <= tie and shapes.radius[one] + shapes.radius[other] > 0.0:
        rate_x, rate_y = _rates(scene, q, v, one, other, lie, j)
        along = fx * rate_y - fy * rate_x
        within = along if passed < left else -along
    return within


@inlined
def _beyond(distance: float, rate: float, tie: float) -> float:
    """Return a distance, or the rate at which it grows where it is no more than a ``tie``."""
    return rate if abs(distance) <= tie else distance


@inlined
def _is_outside(
    scene: RigidScene, q: Numbers, v: Numbers, one: int, i: int, other: int, j: int, lie: Lie, tie: float
) -> bool:
    """Whether vertex j of OTHER is beyond, or leaves, both faces of ONE that meet at vertex i."""
    if scene.shapes.vertices[one] == 1:
        return True
    ux, uy = vertex(scene.shapes, one, i)
    x, y = _place(lie, scene.shapes, other, j)
    near, far = beside_vertex(scene.shapes, one, i, x - ux, y - uy)
    if min(abs(near), abs(far)) <= tie:
        rate_x, rate_y = _rates(scene, q, v, one, other, lie, j)
        near_rate, far_rate = beside_vertex(scene.shapes, one, i, rate_x, rate_y)
        near, far = _beyond(near, near_rate, tie), _beyond(far, far_rate, tie)
    return near > 0.0 and far > 0.0


@inlined
def _nearest_vertices(lie: Lie, shapes: Shapes, one: int, other: int) -> tuple[int, int]:
    """Return the vertices of ONE and of OTHER that are nearest to each other."""
    best, best_other, least = 0, 0, math.inf
    for j in range(shapes.vertices[other]):
        x, y = _place(lie, shapes, other, j)
        for i in range(shapes.vertices[one]):
            ux, uy = vertex(shapes, one, i)
            square = (x - ux) * (x - ux) + (y - uy) * (y - uy)
            if square < least:
                best, best_other, least = i, j, square
    return best, best_other


@inlined
def _to_faces(
    scene: RigidScene, points: Points, p: int, q: Numbers, v: Numbers, a: int, b: int, lie: Lie,
    lie_back: Lie, tie: float,
) -> tuple[int, float]:  # fmt: skip
    """Find the ends of the stretch along which two bodies face each other.

    Returns how many there are, and a distance that the two have at least, where it is positive [m].
    """
    shapes = scene.shapes
    face_a, gap_a = _farthest_face(scene, q, v, a, b, lie, tie)
    face_b, gap_b = _farthest_face(scene, q, v, b, a, lie_back, tie)
    one, other, k, there, back = a, b, face_a, lie, lie_back
    instead = gap_b > gap_a + tie
    if abs(gap_b - gap_a) <= tie:
        rate = _face_rate(scene, q, v, a, face_a, b, lie)
        instead = _face_rate(scene, q, v, b, face_b, a, lie_back) > rate + tie
    if instead:
        one, other, k, there, back = b, a, face_b, lie_back, lie
    n, count, rounding = 0, shapes.vertices[other], shapes.radius[a] + shapes.radius[b]
    against = _facing(there, shapes, one, k, other) if count > 1 else 0
    least = 0.0 if rounding > 0.0 else -tie
    for turn in range(min(count, 2)):
        j = (against + turn) % count
        if _within(scene, q, v, one, k, other, j, there, tie) >= least:
            n = _write(points, n, p, one, k, other, j)
    least = 0.0 if rounding > 0.0 else tie
    for turn in range(2 if count > 1 else 0):
        i = (k + turn) % shapes.vertices[one]
        if _within(scene, q, v, other, against, one, i, back, tie) > least:
            n = _write(points, n, p, other, against, one, i)
    return n, max(gap_a, gap_b) - rounding


@inlined
def find_points(scene: RigidScene, p: int, q: Numbers, v: Numbers, points: Points) -> tuple[int, float]:
    """Write the points where pair ``p`` touches, or would; return how many they are.

    And a distance that the two have at least where it is positive [m]; infinity where the smallest gap of
    their points is that.
    """
    shapes, tie = scene.shapes, TIE * scene.coefficients[p, 2]
    a, b, wall = scene.pairs[p, 0], scene.pairs[p, 1], scene.pairs[p, 2]
    if wall >= F.FIRST_ROW:
        return _write(points, 0, p, a, F.WALL + wall, b, 0), math.inf
    if wall >= 0:
        return _to_wall(points, p, q, scene, b, wall), math.inf
    if is_chain(shapes, a) or is_chain(shapes, b):
        return find_chain_points(scene, p, q, v, points, tie)
    if shapes.vertices[a] == 1:
        a, b = (a, b) if shapes.vertices[b] == 1 else (b, a)
    if shapes.vertices[a] == 1:
        return _write(points, 0, p, a, F.CORNER, b, 0), math.inf
    lie, lie_back = _lie(q, scene.rows, a, b)
    if shapes.radius[a] + shapes.radius[b] > 0.0:
        i, j = _nearest_vertices(lie, shapes, a, b)
        outside = _is_outside(scene, q, v, a, i, b, j, lie, tie)
        if outside and _is_outside(scene, q, v, b, j, a, i, lie_back, tie):
            return _write(points, 0, p, a, F.CORNER + i, b, j), math.inf
    n, apart = _to_faces(scene, points, p, q, v, a, b, lie, lie_back, tie)
    return n, math.inf if shapes.vertices[b] == 1 else apart
