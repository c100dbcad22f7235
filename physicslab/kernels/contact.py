"""The narrow phase: where near pairs touch, or would within a substep."""

import math

from numba import boolean, float64, int64

from physicslab.kernels import inlined, kernel
from physicslab.kernels.manifold import box_box, circle_box, circle_circle, wall_corner
from physicslab.kernels.records import Manifolds, Points
from physicslab.kernels.sweep import MISS, sweep_box_box, sweep_circle_box, sweep_circle_circle

__all__ = ["find_contacts"]

_NUMBERS = float64[::1]
_VECTORS = float64[:, ::1]
_ROWS = int64[::1]

_NEAR = 0.02
"""Share of the smaller body's size within which a pair counts as near: its points are kept though they do not touch."""
_KEEP = 0.004
"""Share of the smaller box's size that a pair of boxes may move before its points are found anew."""
_KEEP_TURN = 0.002
"""How far [rad] either may turn."""
_ROUNDING = 1e-6
"""Share of the size within which two surfaces count as just meeting."""
_STILL = 0.002
"""Share of the smaller body's size below which a substep's motion is not swept at all."""
_FAST = 0.25
"""Share of the smaller box's size beyond which a substep's motion of boxes is swept."""


@inlined
def _put(point, feature, ax, ay, bx, by, separation, old_1, n1, t1, old_2, n2, t2):
    """Fill a point, with the impulses of the old point of the same feature for warm starting."""
    point.feature = feature
    point.arm_ax, point.arm_ay, point.arm_bx, point.arm_by = ax, ay, bx, by
    point.found_separation = separation
    point.separation = separation
    if feature == old_1:
        point.normal_impulse, point.tangent_impulse = n1, t1
    elif feature == old_2:
        point.normal_impulse, point.tangent_impulse = n2, t2
    else:
        point.normal_impulse, point.tangent_impulse = 0.0, 0.0


@inlined
def _circle_pose(dx, dy, a_box, ca, sa, ax, ay, radius_a, b_box, cb, sb, bx, by, radius_b, tie):
    """Return normal from A to B, the arms to the contact point, and the separation, with B's centre at (dx, dy)."""
    if a_box:
        nx, ny, px, py, separation = circle_box(dx, dy, ca, sa, ax, ay, radius_b)
        return nx, ny, px, py, -radius_b * nx, -radius_b * ny, separation
    if b_box:
        nx, ny, px, py, separation = circle_box(-dx, -dy, cb, sb, bx, by, radius_a)
        return -nx, -ny, -radius_a * nx, -radius_a * ny, px, py, separation
    nx, ny, separation = circle_circle(dx, dy, radius_a, radius_b, tie)
    return nx, ny, radius_a * nx, radius_a * ny, -radius_b * nx, -radius_b * ny, separation


@inlined
def _with_circle(
    manifold, point, dx, dy, ux, uy, start, a_box, ca, sa, ax, ay, radius_a, b_box, cb, sb, bx, by, radius_b
):
    """Find the one point of a pair in which at least one is a circle: where they meet in this substep, or are now.

    The substep takes B from (dx, dy) + start u to (dx, dy) + (start + 1) u, seen from A.
    """
    size = min(max(ax, radius_a), max(bx, radius_b))
    tie = 7 * manifold.a + manifold.b
    nx, ny, arm_ax, arm_ay, arm_bx, arm_by, separation = _circle_pose(
        dx, dy, a_box, ca, sa, ax, ay, radius_a, b_box, cb, sb, bx, by, radius_b, tie
    )
    reach = math.sqrt(ux * ux + uy * uy)
    manifold.count, manifold.swept, manifold.size = 0, 0, 2.0 * size
    if separation > max(reach, _NEAR * size):
        return
    if reach > _STILL * size:
        # The normal is that of the moment of contact, if there is one in this substep.
        x, y = dx + start * ux, dy + start * uy
        if a_box:
            t = sweep_circle_box(x, y, ux, uy, ca, sa, ax, ay, radius_b)
        elif b_box:
            t = sweep_circle_box(-x, -y, -ux, -uy, cb, sb, bx, by, radius_a)
        else:
            t = sweep_circle_circle(x, y, ux, uy, radius_a + radius_b)
        met = False
        if t <= 1.0:
            mx, my, met_ax, met_ay, met_bx, met_by, gap = _circle_pose(
                x + t * ux, y + t * uy, a_box, ca, sa, ax, ay, radius_a, b_box, cb, sb, bx, by, radius_b, tie
            )
            met = gap > -_ROUNDING * size  # else they overlapped before the substep began
        if met:
            nx, ny, arm_ax, arm_ay, arm_bx, arm_by = mx, my, met_ax, met_ay, met_bx, met_by
            separation = gap - (start + t) * (ux * nx + uy * ny)
            manifold.swept = 1
        elif separation > _NEAR * size:
            return
        elif t == MISS:
            manifold.swept = 2
    elif separation > _NEAR * size:
        return
    manifold.normal_x, manifold.normal_y, manifold.count = nx, ny, 1
    _put(
        point, 1, arm_ax, arm_ay, arm_bx, arm_by, separation,
        point.feature, point.normal_impulse, point.tangent_impulse, -1, 0.0, 0.0,
    )  # fmt: skip


@inlined
def _with_boxes(manifold, one, two, dx, dy, ux, uy, start, ca, sa, ax, ay, cb, sb, bx, by):
    """Find the points of two boxes: as they are now, or where they meet if they are fast for their size."""
    size = 2.0 * min(min(ax, ay), min(bx, by))
    travel = math.sqrt(ux * ux + uy * uy)
    x, y, lead_x, lead_y, margin = dx, dy, 0.0, 0.0, _NEAR * size + travel
    manifold.swept, manifold.size = 0, size
    if travel > _FAST * size:
        margin = _NEAR * size
        x, y = dx + start * ux, dy + start * uy
        t = 0.0
        if box_box(x, y, ca, sa, cb, sb, ax, ay, bx, by, -math.inf)[0] > 0.0:
            t = sweep_box_box(x, y, ux, uy, ca, sa, cb, sb, ax, ay, bx, by)
        if t == MISS:
            manifold.count = 0
            return
        lead_x, lead_y = (start + t) * ux, (start + t) * uy
        x, y = dx + lead_x, dy + lead_y
        manifold.swept = 1
    f1, n1, t1 = one.feature, one.normal_impulse, one.tangent_impulse
    f2, n2, t2 = two.feature, two.normal_impulse, two.tangent_impulse
    _, nx, ny, count, x1, y1, s1, g1, x2, y2, s2, g2 = box_box(x, y, ca, sa, cb, sb, ax, ay, bx, by, margin)
    manifold.count = count
    if count > 0:
        manifold.normal_x, manifold.normal_y = nx, ny
        lead = lead_x * nx + lead_y * ny
        _put(one, g1, x1, y1, x1 - x, y1 - y, s1 - lead, f1, n1, t1, f2, n2, t2)
        if count == 2:
            _put(two, g2, x2, y2, x2 - x, y2 - y, s2 - lead, f1, n1, t1, f2, n2, t2)


@inlined
def _with_wall(manifold, one, two, x, y, ux, uy, spin, box, c, s, half_x, half_y, radius, bounds):
    """Find the points of a body and one of the world's bounds: of a box its two corners nearest to the wall."""
    wall = manifold.wall
    nx = 1.0 if wall == 0 else (-1.0 if wall == 2 else 0.0)
    ny = 1.0 if wall == 1 else (-1.0 if wall == 3 else 0.0)
    height = (x - bounds[wall]) * nx if wall == 0 or wall == 2 else (y - bounds[wall]) * ny
    travel = max(-(ux * nx + uy * ny), 0.0) + spin
    manifold.normal_x, manifold.normal_y = nx, ny
    f1, n1, t1 = one.feature, one.normal_impulse, one.tangent_impulse
    f2, n2, t2 = two.feature, two.normal_impulse, two.tangent_impulse
    manifold.count, manifold.swept = 0, 0
    manifold.size = 2.0 * (min(half_x, half_y) if box else radius)
    if not box:
        separation = height - radius
        if separation <= _NEAR * radius + travel:
            manifold.count = 1
            arm_x, arm_y = -radius * nx, -radius * ny
            _put(one, 1, x + arm_x, y + arm_y, arm_x, arm_y, separation, f1, n1, t1, f2, n2, t2)
        return
    best, second = -1, -1
    low, next_low = math.inf, math.inf
    for k in range(4):
        corner_x, corner_y = wall_corner(k, c, s, half_x, half_y)
        separation = height + corner_x * nx + corner_y * ny
        if separation < low:
            best, second, low, next_low = k, best, separation, low
        elif separation < next_low:
            second, next_low = k, separation
    margin = _NEAR * min(half_x, half_y) + travel
    if low <= margin:
        manifold.count = 1
        arm_x, arm_y = wall_corner(best, c, s, half_x, half_y)
        _put(one, best + 1, x + arm_x, y + arm_y, arm_x, arm_y, low, f1, n1, t1, f2, n2, t2)
    if next_low <= margin:
        manifold.count = 2
        arm_x, arm_y = wall_corner(second, c, s, half_x, half_y)
        _put(two, second + 1, x + arm_x, y + arm_y, arm_x, arm_y, next_low, f1, n1, t1, f2, n2, t2)


@inlined
def _refresh(manifold, points, p, dx, dy, turn_a, turn_b):
    """Update the separations of kept points for how far the pair has moved and turned, to second order."""
    for j in range(2 * p, 2 * p + manifold.count):
        point = points[j]
        ax = turn_a * (-point.arm_ay - 0.5 * turn_a * point.arm_ax)
        ay = turn_a * (point.arm_ax - 0.5 * turn_a * point.arm_ay)
        bx = turn_b * (-point.arm_by - 0.5 * turn_b * point.arm_bx)
        by = turn_b * (point.arm_bx - 0.5 * turn_b * point.arm_by)
        along = (dx + bx - ax) * manifold.normal_x + (dy + by - ay) * manifold.normal_y
        point.separation = point.found_separation + along


@inlined
def _effective_masses(manifold, points, p, inverse_mass, inverse_inertia):
    """Compute 1 / (1/m_a + 1/m_b + (r_a x n)^2 / I_a + (r_b x n)^2 / I_b), along the normal and the tangent."""
    a, b = manifold.a, manifold.b
    nx, ny = manifold.normal_x, manifold.normal_y
    linear = inverse_mass[a] + inverse_mass[b]
    for j in range(2 * p, 2 * p + manifold.count):
        point = points[j]
        turn_a, turn_b = point.arm_ax * ny - point.arm_ay * nx, point.arm_bx * ny - point.arm_by * nx
        point.normal_mass = 1.0 / (
            linear + inverse_inertia[a] * turn_a * turn_a + inverse_inertia[b] * turn_b * turn_b
        )
        turn_a, turn_b = point.arm_ax * nx + point.arm_ay * ny, point.arm_bx * nx + point.arm_by * ny
        point.tangent_mass = 1.0 / (
            linear + inverse_inertia[a] * turn_a * turn_a + inverse_inertia[b] * turn_b * turn_b
        )


@kernel(
    int64(
        Manifolds, Points, int64, _ROWS, _VECTORS, _NUMBERS, _VECTORS, _NUMBERS, _ROWS, _NUMBERS, _NUMBERS, _NUMBERS,
        _NUMBERS, _NUMBERS, _NUMBERS, _NUMBERS, _NUMBERS, float64, float64, boolean, float64, float64,
    )
)  # fmt: skip
def find_contacts(
    manifolds, points, count, touching, position, angle, linear, angular, kind, radius, width, height,
    restitution, friction, inverse_mass, inverse_inertia, bounds, bounds_restitution, bounds_friction, first, h, start,
):  # fmt: skip
    """Find or refresh the contact points of every near pair; return how many pairs have any.

    Their numbers are written to ``touching``, in order. A pair of boxes that has hardly moved keeps its points. The
    substep spans ``h`` seconds from ``start`` h before or after now: a pair that meets within it has points with the
    normal of that moment and the separation, along it, of now. ``first`` marks the first substep of a step, in which
    records of impacts begin anew.
    """
    found = 0
    for p in range(count):
        manifold = manifolds[p]
        a, b = manifold.a, manifold.b
        one, two = points[2 * p], points[2 * p + 1]
        if first and manifold.struck > 0:
            manifold.struck = 0
            one.approach_speed = one.impact_normal = one.impact_tangent = 0.0
            two.approach_speed = two.impact_normal = two.impact_tangent = 0.0
        dx, dy = position[b, 0] - position[a, 0], position[b, 1] - position[a, 1]
        ux, uy = (linear[b, 0] - linear[a, 0]) * h, (linear[b, 1] - linear[a, 1]) * h
        manifold.offset_x, manifold.offset_y = dx, dy
        a_box, b_box = kind[a] == 2, kind[b] == 2
        had_points = manifold.count > 0
        if not (a_box or b_box or had_points or manifold.wall >= 0):
            # Most near circles are too far apart for this substep: settle those without a call.
            reach = 1.02 * (radius[a] + radius[b]) + abs(ux) + abs(uy)
            if dx * dx + dy * dy > reach * reach:
                continue
        if (a_box and b_box) or (manifold.wall >= 0 and b_box):
            size = min(width[b], height[b])
            sizes = width[b] + 2.0 * height[b]
            if a_box:
                size = min(size, min(width[a], height[a]))
                sizes += 3.0 * width[a] + 5.0 * height[a]
            moved_x, moved_y = dx - manifold.base_x, dy - manifold.base_y
            turn_a, turn_b = angle[a] - manifold.base_angle_a, angle[b] - manifold.base_angle_b
            travel = abs(ux) + abs(uy)
            if (
                manifold.found == 2
                and manifold.base_sizes == sizes
                and abs(moved_x) + abs(moved_y) <= _KEEP * size
                and abs(turn_a) <= _KEEP_TURN
                and abs(turn_b) <= _KEEP_TURN
                and travel <= 0.5 * _NEAR * size
            ):
                if manifold.count > 0:
                    _refresh(manifold, points, p, moved_x, moved_y, turn_a, turn_b)
                    touching[found] = p
                    found += 1
                    if first:
                        _effective_masses(manifold, points, p, inverse_mass, inverse_inertia)
                        _mix(manifold, a, b, restitution, friction, bounds_restitution, bounds_friction)
                continue
            manifold.base_x, manifold.base_y = dx, dy
            manifold.base_angle_a, manifold.base_angle_b = angle[a], angle[b]
            manifold.base_sizes = sizes
            manifold.found = 2 if travel <= 0.5 * _NEAR * size else 1
        cb, sb = (math.cos(angle[b]), math.sin(angle[b])) if b_box else (1.0, 0.0)
        half_bx, half_by = 0.5 * width[b], 0.5 * height[b]
        if manifold.wall >= 0:
            spin = abs(angular[b]) * h * math.sqrt(half_bx * half_bx + half_by * half_by)
            _with_wall(
                manifold, one, two, position[b, 0], position[b, 1], ux, uy, spin, b_box, cb, sb,
                half_bx, half_by, radius[b], bounds,
            )  # fmt: skip
        else:
            ca, sa = (math.cos(angle[a]), math.sin(angle[a])) if a_box else (1.0, 0.0)
            half_ax, half_ay = 0.5 * width[a], 0.5 * height[a]
            if a_box and b_box:
                _with_boxes(
                    manifold, one, two, dx, dy, ux, uy, start, ca, sa, half_ax, half_ay, cb, sb, half_bx, half_by
                )
            else:
                _with_circle(
                    manifold, one, dx, dy, ux, uy, start, a_box, ca, sa, half_ax, half_ay, radius[a],
                    b_box, cb, sb, half_bx, half_by, radius[b],
                )  # fmt: skip
        if manifold.count > 0:
            _effective_masses(manifold, points, p, inverse_mass, inverse_inertia)
            _mix(manifold, a, b, restitution, friction, bounds_restitution, bounds_friction)
            touching[found] = p
            found += 1
        elif had_points:
            one.feature = two.feature = 0
            one.normal_impulse = two.normal_impulse = one.tangent_impulse = two.tangent_impulse = 0.0
    return found


@inlined
def _mix(manifold, a, b, restitution, friction, bounds_restitution, bounds_friction):
    """Combine the materials of a pair: e = min, mu = the geometric mean."""
    walled = manifold.wall >= 0
    manifold.restitution = min(bounds_restitution if walled else restitution[a], restitution[b])
    manifold.friction = math.sqrt((bounds_friction if walled else friction[a]) * friction[b])
