"""One pair in ballistic motion: when it meets, how deep it overlaps, and where it touches then."""

import math

from physicslab.kernels import Numbers, Rows, Vectors, inlined
from physicslab.kernels.events.meeting import (
    box_normal,
    meet_box_box,
    meet_circle_box,
    meet_circle_circle,
    meet_line,
)
from physicslab.kernels.events.path import place, seen_from, velocity
from physicslab.kernels.narrow.manifold import circle_box
from physicslab.kernels.narrow.pair import touch_wall, touch_with_circle
from physicslab.kernels.records import Manifold, Point

__all__ = ["gap_of", "meeting_of", "touch_pair"]

_ROUNDING = 1e-14
"""Share of a speed that rounding may have made."""


@inlined
def _wall_gap(
    manifold: Manifold, x: float, y: float, angle: Numbers, kind: Rows, radius: Numbers,
    width: Numbers, height: Numbers, bounds: Numbers,
) -> tuple[float, bool, float]:  # fmt: skip
    """Return the distance from one of the bounds [m], whether its normal is along x, and of which sign."""
    b, wall = manifold.b, manifold.wall
    along_x, sign = wall == 0 or wall == 2, 1.0 if wall < 2 else -1.0
    reach = radius[b]
    if kind[b] == 2:
        c, s = 0.5 * abs(math.cos(angle[b])), 0.5 * abs(math.sin(angle[b]))
        reach = c * width[b] + s * height[b] if along_x else s * width[b] + c * height[b]
    return sign * ((x if along_x else y) - bounds[wall]) - reach, along_x, sign


@inlined
def meeting_of(
    manifold: Manifold, paths: Vectors, angle: Numbers, kind: Rows, radius: Numbers,
    width: Numbers, height: Numbers, bounds: Numbers, now: float, low: float, span: float, min_speed: float,
) -> tuple[float, int]:  # fmt: skip
    """Return in how many seconds from ``now + low`` a pair meets, and along which normal of two boxes."""
    a, b = manifold.a, manifold.b
    if manifold.wall >= 0:
        x, x_low, y, y_low = place(paths, b, now, low)
        vx, vx_low, vy, vy_low = velocity(paths, b, now, low)
        gap, along_x, sign = _wall_gap(manifold, x, y, angle, kind, radius, width, height, bounds)
        least = _ROUNDING * (abs(vx) + abs(vy)) + min_speed
        if along_x:
            return meet_line(gap + sign * x_low, sign * (vx + vx_low), sign * paths[b, 8], least), 0
        return meet_line(gap + sign * y_low, sign * (vy + vy_low), sign * paths[b, 9], least), 0
    dx, dy, ux, uy, wx, wy = seen_from(paths, a, b, now, low)
    half_ax, half_ay, half_bx, half_by = 0.5 * width[a], 0.5 * height[a], 0.5 * width[b], 0.5 * height[b]
    if kind[a] == 1 and kind[b] == 1:
        return meet_circle_circle(dx, dy, ux, uy, wx, wy, radius[a] + radius[b], span, min_speed), 0
    if kind[a] == 2 and kind[b] == 2:
        return meet_box_box(
            dx, dy, ux, uy, wx, wy, math.cos(angle[a]), math.sin(angle[a]),
            math.cos(angle[b]), math.sin(angle[b]), half_ax, half_ay, half_bx, half_by, min_speed,
        )  # fmt: skip
    if kind[a] == 2:
        c, s, half_x, half_y, reach = math.cos(angle[a]), math.sin(angle[a]), half_ax, half_ay, radius[b]
    else:
        c, s, half_x, half_y, reach = -math.cos(angle[b]), -math.sin(angle[b]), half_bx, half_by, radius[a]
    return meet_circle_box(
        c * dx + s * dy, c * dy - s * dx, c * ux + s * uy, c * uy - s * ux, c * wx + s * wy, c * wy - s * wx,
        half_x, half_y, reach, span, min_speed,
    ), 0  # fmt: skip


@inlined
def gap_of(
    manifold: Manifold, paths: Vectors, angle: Numbers, kind: Rows, radius: Numbers,
    width: Numbers, height: Numbers, bounds: Numbers,
) -> tuple[float, float]:  # fmt: skip
    """Return the gap of a pair at the start of its paths, and the size of the smaller body [m]."""
    a, b = manifold.a, manifold.b
    size_b = 2.0 * radius[b] if kind[b] == 1 else min(width[b], height[b])
    if manifold.wall >= 0:
        x, y = paths[b, 0], paths[b, 2]
        return _wall_gap(manifold, x, y, angle, kind, radius, width, height, bounds)[0], size_b
    size = min(size_b, 2.0 * radius[a] if kind[a] == 1 else min(width[a], height[a]))
    dx, dy = paths[b, 0] - paths[a, 0], paths[b, 2] - paths[a, 2]
    half_ax, half_ay, half_bx, half_by = 0.5 * width[a], 0.5 * height[a], 0.5 * width[b], 0.5 * height[b]
    ca, sa, cb, sb = math.cos(angle[a]), math.sin(angle[a]), math.cos(angle[b]), math.sin(angle[b])
    if kind[a] == 1 and kind[b] == 1:
        return math.sqrt(dx * dx + dy * dy) - radius[a] - radius[b], size
    if kind[a] == 1:
        return circle_box(-dx, -dy, cb, sb, half_bx, half_by, radius[a])[4], size
    if kind[b] == 1:
        return circle_box(dx, dy, ca, sa, half_ax, half_ay, radius[b])[4], size
    gap = -math.inf
    for k in range(8):
        nx, ny, reach = box_normal(k, ca, sa, cb, sb, half_ax, half_ay, half_bx, half_by)
        gap = max(gap, dx * nx + dy * ny - reach)
    return gap, size


@inlined
def touch_pair(
    manifold: Manifold, one: Point, two: Point, face: int, x: float, y: float, dx: float, dy: float,
    angle: Numbers, kind: Rows, radius: Numbers, width: Numbers, height: Numbers, bounds: Numbers,
) -> None:  # fmt: skip
    """Fill normal, points and arms of a pair that meets, B at (x, y) and (dx, dy) from A."""
    a, b = manifold.a, manifold.b
    a_box, b_box = kind[a] == 2, kind[b] == 2
    half_ax, half_ay, half_bx, half_by = 0.5 * width[a], 0.5 * height[a], 0.5 * width[b], 0.5 * height[b]
    ca, sa, cb, sb = math.cos(angle[a]), math.sin(angle[a]), math.cos(angle[b]), math.sin(angle[b])
    if manifold.wall >= 0:
        touch_wall(
            manifold, one, two, x, y, 0.0, 0.0, 0.0, 0.0, b_box, cb, sb, half_bx, half_by, radius[b], bounds
        )
    elif a_box and b_box:
        nx, ny, _ = box_normal(face, ca, sa, cb, sb, half_ax, half_ay, half_bx, half_by)
        _put_boxes(
            manifold, one, nx, ny, dx, dy,
            _extent(nx, ny, ca, sa, half_ax, half_ay), _extent(-ny, nx, ca, sa, half_ax, half_ay),
            _extent(-ny, nx, cb, sb, half_bx, half_by),
        )  # fmt: skip
    else:
        # At any distance: the pair is known to touch.
        touch_with_circle(
            manifold, one, dx, dy, 0.0, 0.0, 0.0, 1e300, a_box, ca, sa, half_ax, half_ay, radius[a],
            b_box, cb, sb, half_bx, half_by, radius[b],
        )  # fmt: skip


@inlined
def _extent(nx: float, ny: float, c: float, s: float, half_x: float, half_y: float) -> float:
    """Return how far a box reaches from its middle along a direction."""
    return abs(c * nx + s * ny) * half_x + abs(c * ny - s * nx) * half_y


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
