"""Where one pair touches, now or within the substep: fills its manifold and points."""

import math

from physicslab.kernels import Numbers, inlined
from physicslab.kernels.narrow.manifold import box_box, circle_box, circle_circle, wall_corner
from physicslab.kernels.narrow.sweep import MISS, sweep_box_box, sweep_circle_box, sweep_circle_circle
from physicslab.kernels.records import Manifold, Point

__all__ = ["CONTACT_MARGIN", "SWEEP_THRESHOLD", "touch_boxes", "touch_wall", "touch_with_circle"]

CONTACT_MARGIN = 0.02
"""Share of the smaller body's size within which a pair counts as near: its points are kept though they do
not touch."""
_ROUNDING = 1e-6
"""Share of the size within which two surfaces count as just meeting."""
SWEEP_THRESHOLD = 0.002
"""Share of the smaller body's size below which a substep's motion is not swept at all."""
_FAST = 0.25
"""Share of the smaller box's size beyond which a substep's motion of boxes is swept."""


@inlined
def _put(
    point: Point,
    feature: int,
    ax: float,
    ay: float,
    bx: float,
    by: float,
    separation: float,
    old_1: int,
    n1: float,
    t1: float,
    old_2: int,
    n2: float,
    t2: float,
) -> None:
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
def _circle_pose(
    dx: float,
    dy: float,
    a_box: bool,
    ca: float,
    sa: float,
    ax: float,
    ay: float,
    radius_a: float,
    b_box: bool,
    cb: float,
    sb: float,
    bx: float,
    by: float,
    radius_b: float,
    tie: int,
) -> tuple[float, float, float, float, float, float, float]:
    """Return normal, arms and separation of a pair with a circle, B's centre being at (dx, dy)."""
    if a_box:
        nx, ny, px, py, separation = circle_box(dx, dy, ca, sa, ax, ay, radius_b)
        return nx, ny, px, py, -radius_b * nx, -radius_b * ny, separation
    if b_box:
        nx, ny, px, py, separation = circle_box(-dx, -dy, cb, sb, bx, by, radius_a)
        return -nx, -ny, -radius_a * nx, -radius_a * ny, px, py, separation
    nx, ny, separation = circle_circle(dx, dy, radius_a, radius_b, tie)
    return nx, ny, radius_a * nx, radius_a * ny, -radius_b * nx, -radius_b * ny, separation


@inlined
def touch_with_circle(
    manifold: Manifold,
    point: Point,
    dx: float,
    dy: float,
    ux: float,
    uy: float,
    start: float,
    speculative_margin: float,
    a_box: bool,
    ca: float,
    sa: float,
    ax: float,
    ay: float,
    radius_a: float,
    b_box: bool,
    cb: float,
    sb: float,
    bx: float,
    by: float,
    radius_b: float,
) -> None:
    """Find the one point of a pair with a circle: where they meet in this substep, or are now.

    The substep takes B from (dx, dy) + start u to (dx, dy) + (start + 1) u, seen from A.
    """
    size = min(max(ax, radius_a), max(bx, radius_b))
    tie = 7 * manifold.a + manifold.b
    nx, ny, arm_ax, arm_ay, arm_bx, arm_by, separation = _circle_pose(
        dx, dy, a_box, ca, sa, ax, ay, radius_a, b_box, cb, sb, bx, by, radius_b, tie
    )
    reach = math.sqrt(ux * ux + uy * uy)
    manifold.count, manifold.swept, manifold.size = 0, 0, 2.0 * size
    near = CONTACT_MARGIN * size + speculative_margin
    if separation > max(reach, near):
        return
    if reach > SWEEP_THRESHOLD * size:
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
        elif separation > near:
            return
        elif t == MISS:
            manifold.swept = 2
    elif separation > near:
        return
    manifold.normal_x, manifold.normal_y, manifold.count = nx, ny, 1
    _put(
        point, 1, arm_ax, arm_ay, arm_bx, arm_by, separation,
        point.feature, point.normal_impulse, point.tangent_impulse, -1, 0.0, 0.0,
    )  # fmt: skip


@inlined
def touch_boxes(
    manifold: Manifold,
    one: Point,
    two: Point,
    dx: float,
    dy: float,
    ux: float,
    uy: float,
    start: float,
    speculative_margin: float,
    ca: float,
    sa: float,
    ax: float,
    ay: float,
    cb: float,
    sb: float,
    bx: float,
    by: float,
) -> None:
    """Find the points of two boxes: as they are now, or where they meet if they are fast for their size.

    ``speculative_margin`` is how far the forces may bring them together within the substep.
    """
    size = 2.0 * min(min(ax, ay), min(bx, by))
    travel = math.sqrt(ux * ux + uy * uy)
    x, y, lead_x, lead_y, margin = dx, dy, 0.0, 0.0, CONTACT_MARGIN * size + travel + speculative_margin
    manifold.swept, manifold.size, manifold.gap = 0, size, -math.inf
    if travel > _FAST * size:
        margin = CONTACT_MARGIN * size + speculative_margin
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
    gap, nx, ny, count, x1, y1, s1, g1, x2, y2, s2, g2 = box_box(x, y, ca, sa, cb, sb, ax, ay, bx, by, margin)
    if not manifold.swept:
        manifold.gap = gap
    manifold.count = count
    if count > 0:
        manifold.normal_x, manifold.normal_y = nx, ny
        lead = lead_x * nx + lead_y * ny
        _put(one, g1, x1, y1, x1 - x, y1 - y, s1 - lead, f1, n1, t1, f2, n2, t2)
        if count == 2:
            _put(two, g2, x2, y2, x2 - x, y2 - y, s2 - lead, f1, n1, t1, f2, n2, t2)


@inlined
def touch_wall(
    manifold: Manifold,
    one: Point,
    two: Point,
    x: float,
    y: float,
    ux: float,
    uy: float,
    spin: float,
    speculative_margin: float,
    box: bool,
    c: float,
    s: float,
    half_x: float,
    half_y: float,
    radius: float,
    bounds: Numbers,
) -> None:
    """Find the points of a body and one of the bounds: of a box, the two corners nearest to the wall."""
    wall = manifold.wall
    nx = 1.0 if wall == 0 else (-1.0 if wall == 2 else 0.0)
    ny = 1.0 if wall == 1 else (-1.0 if wall == 3 else 0.0)
    height = (x - bounds[wall]) * nx if wall == 0 or wall == 2 else (y - bounds[wall]) * ny
    travel = max(-(ux * nx + uy * ny), 0.0) + spin + speculative_margin
    manifold.gap = -math.inf
    manifold.normal_x, manifold.normal_y = nx, ny
    f1, n1, t1 = one.feature, one.normal_impulse, one.tangent_impulse
    f2, n2, t2 = two.feature, two.normal_impulse, two.tangent_impulse
    manifold.count, manifold.swept = 0, 0
    manifold.size = 2.0 * (min(half_x, half_y) if box else radius)
    if not box:
        separation = height - radius
        if separation <= CONTACT_MARGIN * radius + travel:
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
    margin = CONTACT_MARGIN * min(half_x, half_y) + travel
    if low <= margin:
        manifold.count = 1
        arm_x, arm_y = wall_corner(best, c, s, half_x, half_y)
        _put(one, best + 1, x + arm_x, y + arm_y, arm_x, arm_y, low, f1, n1, t1, f2, n2, t2)
    if next_low <= margin:
        manifold.count = 2
        arm_x, arm_y = wall_corner(second, c, s, half_x, half_y)
        _put(two, second + 1, x + arm_x, y + arm_y, arm_x, arm_y, next_low, f1, n1, t1, f2, n2, t2)
