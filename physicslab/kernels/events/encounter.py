"""One pair in ballistic motion: when it meets, how deep it overlaps, and where it touches then."""

import math

from physicslab.kernels import Numbers, Vectors, always_inlined, inlined
from physicslab.kernels.events.meeting import (
    Course,
    box_normal,
    meet_box_box,
    meet_circle_box,
    meet_circle_circle,
    meet_line,
)
from physicslab.kernels.events.path import place, seen_from, velocity
from physicslab.kernels.geometry.manifold import circle_box
from physicslab.kernels.geometry.outline import Outline, Way, outline_of
from physicslab.kernels.geometry.pair import touch_wall, touch_with_circle
from physicslab.kernels.geometry.shapes import BOX, Shapes
from physicslab.kernels.records import Manifold, Point

__all__ = ["gap_of", "meeting_of", "time_apart", "touch_pair"]

_ROUNDING = 1e-14
"""Share of a speed that rounding may have made."""


@inlined
def _wall_gap(
    manifold: Manifold, x: float, y: float, body: Outline, walls: Numbers
) -> tuple[float, bool, float]:
    """Return the distance from one of the bounds [m], whether its normal is along x, and of which sign."""
    wall = manifold.wall
    along_x, sign = wall == 0 or wall == 2, 1.0 if wall < 2 else -1.0
    reach = body.radius
    if body.box:
        c, s, half_x, half_y = abs(body.c), abs(body.s), body.half_x, body.half_y
        reach = c * half_x + s * half_y if along_x else s * half_x + c * half_y
    return sign * ((x if along_x else y) - walls[wall]) - reach, along_x, sign


@inlined
def _meet_wall(
    manifold: Manifold, paths: Vectors, body: Outline, walls: Numbers, now: float, low: float,
    min_speed: float,
) -> float:  # fmt: skip
    """Return in how many seconds from ``now + low`` a body meets one of the bounds."""
    b = manifold.b
    x, x_low, y, y_low = place(paths, b, now, low)
    vx, vx_low, vy, vy_low = velocity(paths, b, now, low)
    gap, along_x, sign = _wall_gap(manifold, x, y, body, walls)
    min_rate = _ROUNDING * (abs(vx) + abs(vy)) + min_speed
    if along_x:
        return meet_line(gap + sign * x_low, sign * (vx + vx_low), sign * paths[b, 8], min_rate)
    return meet_line(gap + sign * y_low, sign * (vy + vy_low), sign * paths[b, 9], min_rate)


@inlined
def meeting_of(
    manifold: Manifold, paths: Vectors, angle: Numbers, shapes: Shapes, walls: Numbers,
    now: float, low: float, span: float, min_speed: float,
) -> tuple[float, int]:  # fmt: skip
    """Return in how many seconds from ``now + low`` a pair meets, and along which normal of two boxes."""
    two = outline_of(manifold.b, angle, shapes)
    if manifold.wall >= 0:
        return _meet_wall(manifold, paths, two, walls, now, low, min_speed), 0
    one = outline_of(manifold.a, angle, shapes)
    course = seen_from(paths, manifold.a, manifold.b, now, low)
    if not (one.box or two.box):
        return meet_circle_circle(course, one.radius + two.radius, span, min_speed), 0
    if one.box and two.box:
        return meet_box_box(course, one, two, min_speed)
    # Seen from the box; where that is B, everything is turned about.
    dx, dy, ux, uy, wx, wy = course
    box, radius = (one, two.radius) if one.box else (two, one.radius)
    c, s = (box.c, box.s) if one.box else (-box.c, -box.s)
    turned = Course(
        c * dx + s * dy, c * dy - s * dx, c * ux + s * uy, c * uy - s * ux, c * wx + s * wy, c * wy - s * wx
    )
    return meet_circle_box(turned, box.half_x, box.half_y, radius, span, min_speed), 0


@inlined
def _half_extents(i: int, angle: Numbers, shapes: Shapes) -> tuple[float, float]:
    """Return how far row i reaches from its middle along x and y [m], or more."""
    if shapes.first[i] != BOX:
        return shapes.radius[i], shapes.radius[i]
    if angle[i] == 0.0:
        return shapes.half_x[i], shapes.half_y[i]
    either = shapes.half_x[i] + shapes.half_y[i]
    return either, either


@inlined
def _time_open(gap: float, speed: float, pull: float) -> float:
    """Return how long a gap stays open [s]; 0 if it is closed."""
    return meet_line(gap, speed, pull, 0.0) if gap > 0.0 else 0.0


@always_inlined
def time_apart(
    manifold: Manifold, paths: Vectors, angle: Numbers, shapes: Shapes, walls: Numbers, now: float,
    error: float,
) -> float:  # fmt: skip
    """Return for how many seconds from ``now`` on a pair surely is apart, whose place is known to ``error``.

    By the rectangles about both, along each axis: cheap, and never longer than until the pair meets.
    """
    a, b, wall = manifold.a, manifold.b, manifold.wall
    half_x, half_y = _half_extents(b, angle, shapes)
    s = now - paths[b, 10]
    x, y = (
        paths[b, 0] + s * (paths[b, 4] + 0.5 * s * paths[b, 8]),
        paths[b, 2] + s * (paths[b, 6] + 0.5 * s * paths[b, 9]),
    )
    vx, vy, wx, wy = paths[b, 4] + s * paths[b, 8], paths[b, 6] + s * paths[b, 9], paths[b, 8], paths[b, 9]
    if wall >= 0:
        sign = 1.0 if wall < 2 else -1.0
        if wall == 0 or wall == 2:
            return _time_open(sign * (x - walls[wall]) - half_x - error, sign * vx, sign * wx)
        return _time_open(sign * (y - walls[wall]) - half_y - error, sign * vy, sign * wy)
    s = now - paths[a, 10]
    x -= paths[a, 0] + s * (paths[a, 4] + 0.5 * s * paths[a, 8])
    y -= paths[a, 2] + s * (paths[a, 6] + 0.5 * s * paths[a, 9])
    other_x, other_y = _half_extents(a, angle, shapes)
    sign = math.copysign(1.0, x)
    vx, wx = vx - (paths[a, 4] + s * paths[a, 8]), wx - paths[a, 8]
    apart = _time_open(abs(x) - half_x - other_x - error, sign * vx, sign * wx)
    if apart == math.inf:
        return apart
    sign = math.copysign(1.0, y)
    vy, wy = vy - (paths[a, 6] + s * paths[a, 9]), wy - paths[a, 9]
    return max(apart, _time_open(abs(y) - half_y - other_y - error, sign * vy, sign * wy))


@inlined
def _size(body: Outline) -> float:
    """Return the smaller size of a body [m]."""
    return 2.0 * min(body.half_x, body.half_y) if body.box else 2.0 * body.radius


@inlined
def gap_of(
    manifold: Manifold, paths: Vectors, angle: Numbers, shapes: Shapes, walls: Numbers
) -> tuple[float, float]:
    """Return the gap of a pair at the start of its paths, and the size of the smaller body [m]."""
    a, b = manifold.a, manifold.b
    two = outline_of(b, angle, shapes)
    if manifold.wall >= 0:
        return _wall_gap(manifold, paths[b, 0], paths[b, 2], two, walls)[0], _size(two)
    one = outline_of(a, angle, shapes)
    size = min(_size(two), _size(one))
    dx, dy = paths[b, 0] - paths[a, 0], paths[b, 2] - paths[a, 2]
    if not (one.box or two.box):
        return math.sqrt(dx * dx + dy * dy) - one.radius - two.radius, size
    if not one.box:
        return circle_box(-dx, -dy, two, one.radius)[4], size
    if not two.box:
        return circle_box(dx, dy, one, two.radius)[4], size
    gap = -math.inf
    for k in range(8):
        nx, ny, reach = box_normal(k, one, two)
        gap = max(gap, dx * nx + dy * ny - reach)
    return gap, size


@inlined
def touch_pair(
    manifold: Manifold, first: Point, second: Point, face: int, x: float, y: float, dx: float, dy: float,
    angle: Numbers, shapes: Shapes, walls: Numbers,
) -> None:  # fmt: skip
    """Fill normal, points and arms of a pair that meets, B at (x, y) and (dx, dy) from A."""
    two = outline_of(manifold.b, angle, shapes)
    if manifold.wall >= 0:
        touch_wall(manifold, first, second, Way(x, y, 0.0, 0.0), 0.0, 0.0, two, walls, shapes.pool)
        return
    one = outline_of(manifold.a, angle, shapes)
    if one.box and two.box:
        nx, ny, _ = box_normal(face, one, two)
        _put_boxes(
            manifold,
            first,
            nx,
            ny,
            dx,
            dy,
            _extent(nx, ny, one),
            _extent(-ny, nx, one),
            _extent(-ny, nx, two),
        )
    else:
        # At any distance: the pair is known to touch.
        touch_with_circle(manifold, first, Way(dx, dy, 0.0, 0.0), 0.0, 0.0, 1e300, one, two)


@inlined
def _extent(nx: float, ny: float, box: Outline) -> float:
    """Return how far a box reaches from its middle along a direction."""
    return abs(box.c * nx + box.s * ny) * box.half_x + abs(box.c * ny - box.s * nx) * box.half_y


@inlined
def _put_boxes(
    manifold: Manifold, point: Point, nx: float, ny: float, dx: float, dy: float,
    depth: float, side_a: float, side_b: float,
) -> None:  # fmt: skip
    """Fill the one point of two boxes that do not turn: the middle of their common contact line."""
    along = dy * nx - dx * ny
    middle = 0.5 * (max(-side_a, along - side_b) + min(side_a, along + side_b))
    manifold.normal_x, manifold.normal_y, manifold.count, manifold.swept = nx, ny, 1, 0
    point.feature, point.normal_impulse, point.tangent_impulse = 1, 0.0, 0.0
    point.arm_ax, point.arm_ay = depth * nx - middle * ny, depth * ny + middle * nx
    point.arm_bx, point.arm_by = point.arm_ax - dx, point.arm_ay - dy
