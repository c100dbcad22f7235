"""One pair in ballistic motion: when it meets, how deep it overlaps, and where it touches then.

Seen from A, the centre of B cannot come within an outline: an edge for each face of either core, as far out
as both reach against each other there, and where they are rounded an arc about each meeting of two vertices.
The pair meets where the course of B crosses one of them (the Minkowski difference of both shapes).
"""

import math
from typing import NamedTuple

from physicslab.kernels import Numbers, Vectors, always_inlined, inlined
from physicslab.kernels.events import meeting
from physicslab.kernels.events.links import curvature_of, gap_to_link, meet_link, touch_link
from physicslab.kernels.events.meeting import Course
from physicslab.kernels.events.path import place, seen_from, velocity
from physicslab.kernels.geometry.links import box_of
from physicslab.kernels.geometry.shapes import MOST_VERTICES, Shapes, face, is_chain, segment_of, vertex
from physicslab.kernels.geometry.vertex_cone import beside_vertex
from physicslab.kernels.records import Manifold, Point

_ARC = 2 * MOST_VERTICES
"""Where features of two vertices begin. Those before are edges: of A's faces, then of B's."""


class Support(NamedTuple):
    """How far a core reaches against a direction from its centre, and between which lengths across it [m]."""

    reach: float
    low: float
    high: float


class Edge(NamedTuple):
    """An edge of the outline, of a face of ONE, in its own directions.

    Its normal; how far the face is from the centre; between which lengths along the tangent it is; how OTHER
    reaches against it [m].
    """

    nx: float
    ny: float
    distance: float
    start: float
    end: float
    other: Support


@always_inlined
def _rotation(shapes: Shapes, i: int, angle: Numbers) -> tuple[float, float]:
    """Return cosine and sine of a body's angle; those of 0 where it does not matter."""
    return (1.0, 0.0) if shapes.vertices[i] < 2 else (math.cos(angle[i]), math.sin(angle[i]))


@always_inlined
def _seen(course: Course, c: float, s: float) -> Course:
    """Return a course in directions that are turned by an angle of this cosine and sine."""
    dx, dy, ux, uy, wx, wy = course
    return Course(
        c * dx + s * dy, c * dy - s * dx, c * ux + s * uy, c * uy - s * ux, c * wx + s * wy, c * wy - s * wx
    )


@always_inlined
def _support(shapes: Shapes, i: int, x: float, y: float) -> Support:
    """Return how the core of row i reaches against a direction (x, y) of its own; the tangent is (-y, x)."""
    nearest, low, high, seam = math.inf, 0.0, 0.0, meeting.SEAM * shapes.reach[i]
    for k in range(shapes.vertices[i]):
        vx, vy = vertex(shapes, i, k)
        height, side = x * vx + y * vy, x * vy - y * vx
        if height < nearest - seam:
            nearest, low, high = height, side, side
        elif height <= nearest + seam:
            nearest, low, high = min(nearest, height), min(low, side), max(high, side)
    return Support(-nearest, low, high)


@always_inlined
def _edge(shapes: Shapes, one: int, k: int, other: int, c: float, s: float) -> Edge:
    """Return the edge of face k of ONE, where OTHER is turned against ONE by this cosine and sine."""
    nx, ny, distance, length = face(shapes, one, k)
    x, y = vertex(shapes, one, k)
    start = nx * y - ny * x
    return Edge(
        nx, ny, distance, start, start + length, _support(shapes, other, nx * c + ny * s, ny * c - nx * s)
    )


@always_inlined
def _apart(edge: Edge, x: float, y: float, rounding: float) -> float:
    """Return how far a centre of OTHER is outside an edge [m], of shapes rounded by so much together."""
    return edge.nx * x + edge.ny * y - edge.distance - rounding - edge.other.reach


@always_inlined
def _is_beside(edge: Edge, x: float, y: float, seam: float) -> bool:
    """Whether OTHER is beside the face, and not beyond one of its ends."""
    along = edge.nx * y - edge.ny * x
    return along + edge.other.high >= edge.start - seam and along + edge.other.low <= edge.end + seam


@always_inlined
def _between(
    shapes: Shapes, a: int, i: int, b: int, j: int, lie: tuple[float, float, float, float]
) -> tuple[float, float]:
    """Return the way from vertex i of A to vertex j of B, seen from A [m], as B lies there."""
    (x, y, c, s), (ax, ay), (bx, by) = lie, vertex(shapes, a, i), vertex(shapes, b, j)
    return x + c * bx - s * by - ax, y + s * bx + c * by - ay


@inlined
def _least(pair: tuple[float, float]) -> float:
    return min(pair[0], pair[1])


@inlined
def _is_between(
    shapes: Shapes, a: int, i: int, b: int, j: int, x: float, y: float, c: float, s: float, seam: float
) -> bool:
    """Whether two vertices, (x, y) apart seen from A, are beyond all the faces that meet at them."""
    if shapes.vertices[a] > 1 and _least(beside_vertex(shapes, a, i, x, y)) < -seam:
        return False
    back_x, back_y = -c * x - s * y, s * x - c * y
    return shapes.vertices[b] == 1 or _least(beside_vertex(shapes, b, j, back_x, back_y)) >= -seam


@inlined
def _nearest(
    shapes: Shapes, a: int, b: int, course: Course, c: float, s: float
) -> tuple[float, int, float, float]:
    """Return the gap [m] of a pair, negative where it overlaps, at which feature, and its two rates there."""
    rounding, beside = shapes.radius[a] + shapes.radius[b], True
    gap, feature, speed, pull = -math.inf, -1, 0.0, 0.0
    for side in range(2):
        one, other, turn = (a, b, s) if side == 0 else (b, a, -s)
        to = course if side == 0 else _seen(course, -c, -s)
        for k in range(shapes.vertices[one] if shapes.vertices[one] > 1 else 0):
            edge = _edge(shapes, one, k, other, c, turn)
            apart = _apart(edge, to.dx, to.dy, rounding)
            if apart > gap:
                gap, feature, beside = apart, side * MOST_VERTICES + k, _is_beside(edge, to.dx, to.dy, 0.0)
                speed, pull = edge.nx * to.ux + edge.ny * to.uy, edge.nx * to.wx + edge.ny * to.wy
    for i in range(shapes.vertices[a] if rounding > 0.0 and not (beside and feature >= 0) else 0):
        for j in range(shapes.vertices[b]):
            x, y = _between(shapes, a, i, b, j, (course.dx, course.dy, c, s))
            distance = math.sqrt(x * x + y * y)
            if distance - rounding > gap and _is_between(shapes, a, i, b, j, x, y, c, s, 0.0):
                gap, feature = distance - rounding, _ARC + MOST_VERTICES * i + j
                if distance > 0.0:
                    speed = (x * course.ux + y * course.uy) / distance
                    pull = (x * course.wx + y * course.wy) / distance
    return gap, feature, speed, pull


@always_inlined
def _lie(
    manifold: Manifold, course: Course, angle: Numbers, shapes: Shapes
) -> tuple[Course, float, float, float, float]:
    """Return a course seen from A, how B is turned against A, and how A is: cosines and sines."""
    (ca, sa), (cb, sb) = _rotation(shapes, manifold.a, angle), _rotation(shapes, manifold.b, angle)
    return _seen(course, ca, sa), ca * cb + sa * sb, ca * sb - sa * cb, ca, sa


@inlined
def _wall_normal(wall: int) -> tuple[float, float]:
    """Return the normal of one of the bounds, which leads inwards."""
    sign = 1.0 if wall < 2 else -1.0
    return (sign, 0.0) if wall == 0 or wall == 2 else (0.0, sign)


@inlined
def _to_wall(
    manifold: Manifold, x: float, y: float, angle: Numbers, shapes: Shapes, walls: Numbers
) -> tuple[float, Support]:
    """Return how far a body at (x, y) is from one of the bounds [m], and how its core reaches there."""
    b, wall = manifold.b, manifold.wall
    (nx, ny), (c, s) = _wall_normal(wall), _rotation(shapes, b, angle)
    support = _support(shapes, b, c * nx + s * ny, c * ny - s * nx)
    height = nx * (x - walls[wall]) if wall == 0 or wall == 2 else ny * (y - walls[wall])
    return height - shapes.radius[b] - support.reach, support


@inlined
def _meet_wall(
    manifold: Manifold, paths: Vectors, angle: Numbers, shapes: Shapes, walls: Numbers, now: float,
    low: float, min_speed: float,
) -> float:  # fmt: skip
    """Return in how many seconds from ``now + low`` a body meets one of the bounds."""
    b = manifold.b
    x, x_low, y, y_low = place(paths, b, now, low)
    vx, vx_low, vy, vy_low = velocity(paths, b, now, low)
    (nx, ny), (gap, _) = _wall_normal(manifold.wall), _to_wall(manifold, x, y, angle, shapes, walls)
    speed = nx * (vx + vx_low) + ny * (vy + vy_low)
    pull = nx * paths[b, 8] + ny * paths[b, 9]
    min_rate = meeting.ROUNDING * (abs(vx) + abs(vy)) + min_speed
    return meeting.meet_line(gap + (nx * x_low + ny * y_low), speed, pull, min_rate)


@always_inlined
def _is_linked(manifold: Manifold) -> bool:
    """Whether a pair is a body and a link of a chain, of which its ``wall`` is the number."""
    return bool(manifold.wall < -1)


@inlined
def _on_chain(
    manifold: Manifold, seen: Course, angle: Numbers, shapes: Shapes
) -> tuple[int, int, int, Course, tuple[float, float]]:
    """Return the chain, the link and the body of a pair; the body's course and turn, seen from the chain."""
    a, b, (dx, dy, ux, uy, wx, wy) = manifold.a, manifold.b, seen
    chain, body, sign = (a, b, 1.0) if is_chain(shapes, a) else (b, a, -1.0)
    (c, s), (cb, sb) = _rotation(shapes, chain, angle), _rotation(shapes, body, angle)
    course = Course(sign * dx, sign * dy, sign * ux, sign * uy, sign * wx, sign * wy)
    turn = c * cb + s * sb, c * sb - s * cb
    return chain, segment_of(manifold.wall), body, _seen(course, c, s), turn


@inlined
def bend_of(manifold: Manifold, feature: int, shapes: Shapes) -> float:
    """Return by how much the path of a pair's bodies along each other bends, where one is a chain [1/m]."""
    if not _is_linked(manifold):
        return 0.0
    chain, body = (manifold.a, manifold.b) if is_chain(shapes, manifold.a) else (manifold.b, manifold.a)
    return curvature_of(shapes, chain, segment_of(manifold.wall), body, feature)


@inlined
def meeting_of(
    manifold: Manifold, paths: Vectors, angle: Numbers, shapes: Shapes, walls: Numbers,
    now: float, low: float, span: float, min_speed: float,
) -> tuple[float, int]:  # fmt: skip
    """Return in how many seconds from ``now + low`` a pair meets, up to ``span``, and at which feature."""
    if manifold.wall >= 0:
        return _meet_wall(manifold, paths, angle, shapes, walls, now, low, min_speed), 0
    a, b = manifold.a, manifold.b
    seen = seen_from(paths, a, b, now, low)
    if _is_linked(manifold):
        chain, k, body, way, turned = _on_chain(manifold, seen, angle, shapes)
        return meet_link(shapes, chain, k, body, way, turned, span, min_speed)
    course, c, s, _, _ = _lie(manifold, seen, angle, shapes)
    rounding, seam = shapes.radius[a] + shapes.radius[b], meeting.SEAM * (shapes.reach[a] + shapes.reach[b])
    min_rate = meeting.ROUNDING * (abs(course.ux) + abs(course.uy)) + min_speed
    best, feature, widest = math.inf, -1, -math.inf
    for side in range(2):
        one, other, turn = (a, b, s) if side == 0 else (b, a, -s)
        to = course if side == 0 else _seen(course, -c, -s)
        for k in range(shapes.vertices[one] if shapes.vertices[one] > 1 else 0):
            edge = _edge(shapes, one, k, other, c, turn)
            gap = _apart(edge, to.dx, to.dy, rounding)
            widest = max(widest, gap)
            speed, pull = edge.nx * to.ux + edge.ny * to.uy, edge.nx * to.wx + edge.ny * to.wy
            t = meeting.cross_line(gap, speed, pull, seam, min_rate)
            if t < best and t <= span:
                x, y = meeting.place_at(to, t)
                if _is_beside(edge, x, y, seam):
                    best, feature = t, side * MOST_VERTICES + k
    if widest <= 0.0 and shapes.vertices[a] + shapes.vertices[b] > 2:
        gap, nearest, speed, pull = _nearest(shapes, a, b, course, c, s)
        if gap <= 0.0:  # they overlap: the nearest place of the outline decides
            if speed < -min_rate:
                return 0.0, nearest
            if pull < 0.0 and speed * speed < -2.0 * pull * -gap:
                return max(speed, 0.0) / -pull, nearest
    for i in range(shapes.vertices[a] if rounding > 0.0 else 0):
        for j in range(shapes.vertices[b]):
            x, y = _between(shapes, a, i, b, j, (course.dx, course.dy, c, s))
            way = Course(x, y, course.ux, course.uy, course.wx, course.wy)
            t = meeting.meet_circle(way, rounding, min(best, span), min_speed, 1.0)
            if t < best:
                x, y = meeting.place_at(way, t)
                if _is_between(shapes, a, i, b, j, x, y, c, s, seam):
                    best, feature = t, _ARC + MOST_VERTICES * i + j
    return best, feature


@inlined
def _reaches(shapes: Shapes, i: int, angle: Numbers) -> tuple[float, float]:
    """Return how far row i reaches from its middle along x and y [m], or more."""
    radius, reach = shapes.radius[i], shapes.reach[i]
    if shapes.vertices[i] > 1 and angle[i] != 0.0:
        return reach, reach
    return shapes.half_x[i] + radius, shapes.half_y[i] + radius


@inlined
def _time_open(gap: float, speed: float, pull: float) -> float:
    """Return how long a gap stays open [s]; 0 if it is closed."""
    return meeting.meet_line(gap, speed, pull, 0.0) if gap > 0.0 else 0.0


@always_inlined
def time_apart(
    manifold: Manifold, paths: Vectors, angle: Numbers, shapes: Shapes, walls: Numbers, now: float,
    error: float,
) -> float:  # fmt: skip
    """Return for how many seconds from ``now`` on a pair surely is apart, whose place is known to ``error``.

    By the rectangles about both, along each axis: cheap, and never longer than until the pair meets.
    """
    a, b, wall = manifold.a, manifold.b, manifold.wall
    half_x, half_y = _reaches(shapes, b, angle)
    s = now - paths[b, 10]
    x = paths[b, 0] + s * (paths[b, 4] + 0.5 * s * paths[b, 8])
    y = paths[b, 2] + s * (paths[b, 6] + 0.5 * s * paths[b, 9])
    vx, vy, wx, wy = paths[b, 4] + s * paths[b, 8], paths[b, 6] + s * paths[b, 9], paths[b, 8], paths[b, 9]
    if wall >= 0:
        sign = 1.0 if wall < 2 else -1.0
        if wall == 0 or wall == 2:
            return _time_open(sign * (x - walls[wall]) - half_x - error, sign * vx, sign * wx)
        return _time_open(sign * (y - walls[wall]) - half_y - error, sign * vy, sign * wy)
    s = now - paths[a, 10]
    x -= paths[a, 0] + s * (paths[a, 4] + 0.5 * s * paths[a, 8])
    y -= paths[a, 2] + s * (paths[a, 6] + 0.5 * s * paths[a, 9])
    other_x, other_y = _reaches(shapes, a, angle)
    if _is_linked(manifold):
        on_a = is_chain(shapes, a)
        chain, body = (a, b) if on_a else (b, a)
        low_x, low_y, high_x, high_y = box_of(shapes, chain, segment_of(wall))
        middle_x, middle_y = 0.5 * (low_x + high_x), 0.5 * (low_y + high_y)
        half_x, half_y = _reaches(shapes, body, angle)
        other_x, other_y = 0.5 * (high_x - low_x), 0.5 * (high_y - low_y)
        if angle[chain] != 0.0:
            c, sine = math.cos(angle[chain]), math.sin(angle[chain])
            middle_x, middle_y = c * middle_x - sine * middle_y, sine * middle_x + c * middle_y
            other_x = other_y = other_x + other_y
        x, y = (x - middle_x, y - middle_y) if on_a else (x + middle_x, y + middle_y)
    sign = math.copysign(1.0, x)
    vx, wx = vx - (paths[a, 4] + s * paths[a, 8]), wx - paths[a, 8]
    apart = _time_open(abs(x) - half_x - other_x - error, sign * vx, sign * wx)
    if apart == math.inf:
        return apart
    sign = math.copysign(1.0, y)
    vy, wy = vy - (paths[a, 6] + s * paths[a, 9]), wy - paths[a, 9]
    return max(apart, _time_open(abs(y) - half_y - other_y - error, sign * vy, sign * wy))


@inlined
def gap_of(
    manifold: Manifold, paths: Vectors, angle: Numbers, shapes: Shapes, walls: Numbers
) -> tuple[float, float]:
    """Return the gap of a pair at the start of its paths, and the size of the smaller body [m]."""
    a, b = manifold.a, manifold.b
    size = 2.0 * shapes.thin[b]
    if manifold.wall >= 0:
        return _to_wall(manifold, paths[b, 0], paths[b, 2], angle, shapes, walls)[0], size
    course = Course(paths[b, 0] - paths[a, 0], paths[b, 2] - paths[a, 2], 0.0, 0.0, 0.0, 0.0)
    if _is_linked(manifold):
        chain, k, body, way, turned = _on_chain(manifold, course, angle, shapes)
        return gap_to_link(shapes, chain, k, body, way, turned)[0], 2.0 * shapes.thin[body]
    seen, c, s, _, _ = _lie(manifold, course, angle, shapes)
    return _nearest(shapes, a, b, seen, c, s)[0], min(size, 2.0 * shapes.thin[a])


@inlined
def touch_pair(
    manifold: Manifold, point: Point, feature: int, x: float, y: float, seen: Course,
    angle: Numbers, shapes: Shapes, walls: Numbers,
) -> None:  # fmt: skip
    """Fill normal, point and arms of a pair that meets at a feature, B at (x, y) and ``seen`` from A.

    Where faces meet, the point is the middle of their common stretch: bodies that cannot turn need no two.
    """
    a, b = manifold.a, manifold.b
    manifold.count, manifold.swept = 1, 0
    point.feature, point.normal_impulse, point.tangent_impulse = 1, 0.0, 0.0
    if manifold.wall >= 0:
        (nx, ny), (_, support) = _wall_normal(manifold.wall), _to_wall(manifold, x, y, angle, shapes, walls)
        depth, middle = support.reach + shapes.radius[b], 0.5 * (support.low + support.high)
        point.arm_bx, point.arm_by = -depth * nx - middle * ny, -depth * ny + middle * nx
        point.arm_ax, point.arm_ay = x + point.arm_bx, y + point.arm_by
        manifold.normal_x, manifold.normal_y = nx, ny
        return
    if _is_linked(manifold):
        chain, k, body, way, lies = _on_chain(manifold, seen, angle, shapes)
        nx, ny, px, py = touch_link(shapes, chain, k, body, feature, way.dx, way.dy, lies)
        ca, sa = _rotation(shapes, chain, angle)
        nx, ny, px, py = ca * nx - sa * ny, sa * nx + ca * ny, ca * px - sa * py, sa * px + ca * py
        if chain == a:
            point.arm_ax, point.arm_ay, point.arm_bx, point.arm_by = seen.dx + px, seen.dy + py, px, py
            manifold.normal_x, manifold.normal_y = nx, ny
        else:
            point.arm_ax, point.arm_ay, point.arm_bx, point.arm_by = px, py, px - seen.dx, py - seen.dy
            manifold.normal_x, manifold.normal_y = -nx, -ny
        return
    course, c, s, ca, sa = _lie(manifold, seen, angle, shapes)
    if feature >= _ARC:
        i, j = (feature - _ARC) // MOST_VERTICES, (feature - _ARC) % MOST_VERTICES
        px, py = _between(shapes, a, i, b, j, (course.dx, course.dy, c, s))
        distance = math.sqrt(px * px + py * py)
        nx, ny = px / distance, py / distance
        (ax, ay), (vx, vy) = vertex(shapes, a, i), vertex(shapes, b, j)
        ax, ay = ax + shapes.radius[a] * nx, ay + shapes.radius[a] * ny
        bx = c * vx - s * vy - shapes.radius[b] * nx
        by = s * vx + c * vy - shapes.radius[b] * ny
    else:
        turned = feature >= MOST_VERTICES
        one, other, turn = (b, a, -s) if turned else (a, b, s)
        to = _seen(course, -c, -s) if turned else course
        edge = _edge(shapes, one, feature % MOST_VERTICES, other, c, turn)
        nx, ny, along = edge.nx, edge.ny, edge.nx * to.dy - edge.ny * to.dx
        middle = 0.5 * (max(edge.start, along + edge.other.low) + min(edge.end, along + edge.other.high))
        depth, across = edge.distance + shapes.radius[one], middle - along
        back = -edge.other.reach - shapes.radius[other]
        ax, ay = depth * nx - middle * ny, depth * ny + middle * nx
        bx, by = back * nx - across * ny, back * ny + across * nx
        if turned:  # seen from B until here
            ax, ay, bx, by = c * bx - s * by, s * bx + c * by, c * ax - s * ay, s * ax + c * ay
            nx, ny = -(c * nx - s * ny), -(s * nx + c * ny)
    manifold.normal_x, manifold.normal_y = ca * nx - sa * ny, sa * nx + ca * ny
    point.arm_ax, point.arm_ay = ca * ax - sa * ay, sa * ax + ca * ay
    point.arm_bx, point.arm_by = ca * bx - sa * by, sa * bx + ca * by
