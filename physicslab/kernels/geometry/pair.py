"""Where one pair touches, now or within the substep: fills its manifold and points."""

import math
from typing import NamedTuple

from physicslab.kernels import Numbers, Vectors, inlined
from physicslab.kernels.geometry.cores import FACE, Touch
from physicslab.kernels.geometry.manifold import LEVEL, Corner, box_box, circle_box, circle_circle
from physicslab.kernels.geometry.margins import CONTACT_MARGIN
from physicslab.kernels.geometry.outline import Outline, Way, corner, is_segment, swing_of, turned
from physicslab.kernels.geometry.segment import touch_outlines
from physicslab.kernels.geometry.sweep import (
    MISS,
    is_swift,
    least_gap,
    opening,
    pose_at,
    sweep_box_box,
    sweep_circle_box,
    sweep_circle_circle,
    sweep_inner,
    sweep_outlines,
    sweep_turning_box,
)
from physicslab.kernels.records import Manifold, Point

_JUST_MEETING = 1e-6
"""Share of the size within which two surfaces count as just meeting."""
SWEEP_THRESHOLD = 0.002
"""Share of the smaller body's size below which a substep's motion, or that of a turning box's corners, is not
swept at all."""
WIDE_SHARE = 0.1
"""Share of the smaller body's size that a contact under load may move in a substep and be wide."""
_TURNING = 0.1
"""Share of a body's way that the corners of a box may turn meanwhile, as the next tile of a floor may."""
_STILL = 1e-9
"""Share of its way by which a point closes that was stopped, or rolls."""
_FAST = 0.25
"""Share of the smaller box's size beyond which a substep's motion of boxes is swept."""


class Impulses(NamedTuple):
    """Warm start of a point: its feature, and its impulses [N s]."""

    feature: int
    normal: float
    tangent: float


@inlined
def _impulses_of(point: Point) -> Impulses:
    """Return the impulses of a point as it is now."""
    return Impulses(point.feature, point.normal_impulse, point.tangent_impulse)


@inlined
def _put(
    point: Point, feature: int, ax: float, ay: float, bx: float, by: float, separation: float,
    one: Impulses, two: Impulses,
) -> None:  # fmt: skip
    """Fill a point, with the impulses of the old point of the same feature for warm starting."""
    point.feature = feature
    point.arm_ax, point.arm_ay, point.arm_bx, point.arm_by = ax, ay, bx, by
    point.found_separation = separation
    point.separation = separation
    point.bend = 0.0
    if feature == one.feature:
        point.normal_impulse, point.tangent_impulse = one.normal, one.tangent
    elif feature == two.feature:
        point.normal_impulse, point.tangent_impulse = two.normal, two.tangent
    else:
        point.normal_impulse, point.tangent_impulse = 0.0, 0.0


@inlined
def _circle_pose(
    dx: float, dy: float, a: Outline, b: Outline, tie: int
) -> tuple[float, float, float, float, float, float, float]:
    """Return normal, arms and separation of a pair with a circle, B's centre being at (dx, dy)."""
    if a.box:
        nx, ny, px, py, separation = circle_box(dx, dy, a, b.radius)
        return nx, ny, px, py, -b.radius * nx, -b.radius * ny, separation
    if b.box:
        nx, ny, px, py, separation = circle_box(-dx, -dy, b, a.radius)
        return -nx, -ny, -a.radius * nx, -a.radius * ny, px, py, separation
    nx, ny, separation = circle_circle(dx, dy, a.radius, b.radius, tie)
    return nx, ny, a.radius * nx, a.radius * ny, -b.radius * nx, -b.radius * ny, separation


@inlined
def _sweep_circle(x: float, y: float, way: Way, start: float, turn: float, a: Outline, b: Outline) -> float:
    """Return when a pair with a circle touches, B's centre being at (x, y) first, and its box turning."""
    if not a.box and not b.box:
        return sweep_circle_circle(x, y, way.ux, way.uy, a.radius + b.radius)
    box, radius, sign = (a, b.radius, 1.0) if a.box else (b, a.radius, -1.0)
    x, y, ux, uy = sign * x, sign * y, sign * way.ux, sign * way.uy
    if turn != 0.0:
        return sweep_turning_box(Way(x, y, ux, uy), start, box, turn, radius)
    return sweep_circle_box(x, y, ux, uy, box, radius)


@inlined
def _slides_over(nx: float, ny: float, dx: float, dy: float, way: Way, a: Outline, b: Outline) -> bool:
    """Whether a circle comes on to a corner of a box that is hardly higher than where it slides or rolls.

    The next tile of a floor is no step. ``n`` is the normal from A to B, (dx, dy) leads from A to B.
    """
    if a.box:
        box, radius, x, y, ux, uy = a, b.radius, dx, dy, way.ux, way.uy
    elif b.box:
        box, radius, x, y, ux, uy = b, a.radius, -dx, -dy, -way.ux, -way.uy
        nx, ny = -nx, -ny
    else:
        return False
    # In the frame of the box: the normal lies between those of two faces, and hardly off one of them.
    across, along = box.c * nx + box.s * ny, box.c * ny - box.s * nx
    if min(abs(across), abs(along)) == 0.0:
        return False
    px, py = abs(box.c * x + box.s * y) - box.half_x, abs(box.c * y - box.s * x) - box.half_y
    if px <= 0.0 or py <= 0.0:
        return False
    vx, vy = box.c * ux + box.s * uy, box.c * uy - box.s * ux
    toward_x = vx if across > 0.0 else -vx
    toward_y = vy if along > 0.0 else -vy
    if px < py:
        return py > (1.0 - LEVEL) * radius and toward_x < 0.0 and -toward_x > abs(toward_y)
    return px > (1.0 - LEVEL) * radius and toward_y < 0.0 and -toward_y > abs(toward_x)


@inlined
def touch_with_circle(
    manifold: Manifold, point: Point, way: Way, turn: float, start: float, speculative_margin: float,
    a: Outline, b: Outline, pool: Vectors,
) -> None:  # fmt: skip
    """Find the one point of a pair with a circle: where they meet in this substep, or are now.

    The substep takes B from d + start u to d + (start + 1) u, seen from A; a box turns by ``turn`` [rad].
    """
    dx, dy, ux, uy = way
    size = min(max(a.half_x, a.radius), max(b.half_x, b.radius))
    tie = 7 * manifold.a + manifold.b
    nx, ny, arm_ax, arm_ay, arm_bx, arm_by, separation = _circle_pose(dx, dy, a, b, tie)
    reach = math.sqrt(ux * ux + uy * uy)
    manifold.count, manifold.swept, manifold.size, manifold.gap = 0, 0, 2.0 * size, -math.inf
    near = CONTACT_MARGIN * size + speculative_margin
    # How far a corner of the box comes.
    swing = 0.0
    if turn != 0.0:
        swing = swing_of(a if a.box else b, turn)
    level = swing <= _TURNING * reach
    if swing <= _JUST_MEETING * size:
        swing = turn = 0.0
    if separation > max(reach + swing, near):
        manifold.gap = separation
        return
    fast = reach + swing > SWEEP_THRESHOLD * size
    approach = -(ux * nx + uy * ny)
    # Resting bodies touch as they do now: the normal of another moment would do work on them.
    loaded = point.normal_impulse > 0.0 and separation < near
    if not loaded and (fast or approach + swing > max(4.0 * speculative_margin, _JUST_MEETING * size)):
        # The normal is that of the moment of contact, if there is one in this substep.
        x, y = dx + start * ux, dy + start * uy
        t = _sweep_circle(x, y, way, start, turn, a, b)
        met = False
        if t <= 1.0:
            met_a, met_b = turned(a, (start + t) * turn), turned(b, (start + t) * turn)
            x, y = x + t * ux, y + t * uy
            mx, my, met_ax, met_ay, met_bx, met_by, gap = _circle_pose(x, y, met_a, met_b, tie)
            met = gap > -_JUST_MEETING * size  # else they overlapped before the substep began
            if met and level and _slides_over(mx, my, x, y, way, met_a, met_b):
                return
        if met:
            nx, ny, arm_ax, arm_ay, arm_bx, arm_by = mx, my, met_ax, met_ay, met_bx, met_by
            opening = ux * nx + uy * ny
            if a.box:
                opening -= turn * (met_ax * ny - met_ay * nx)
            else:
                opening += turn * (met_bx * ny - met_by * nx)
            separation = gap - (start + t) * opening
            manifold.swept = 1
        elif t <= 1.0 and is_swift(
            way, 2.0 * speculative_margin, a, b
        ):  # they overlapped, and may be through by now
            if (
                _touch_inner(manifold, point, point, way, turn, turn, start, 1.0, a, b, pool)
                or separation > near
            ):
                return
        elif separation > near:
            return
        elif t == MISS and fast:
            manifold.swept = 2
    elif separation > near:
        return
    if level and not loaded and manifold.swept != 1 and _slides_over(nx, ny, dx, dy, way, a, b):
        return
    manifold.normal_x, manifold.normal_y, manifold.count = nx, ny, 1
    before = _impulses_of(point)
    _put(point, 1, arm_ax, arm_ay, arm_bx, arm_by, separation, before, before)


@inlined
def sweep_any(
    way: Way, turn_a: float, turn_b: float, start: float, a: Outline, b: Outline, pool: Vectors,
    outlines: bool,
) -> tuple[float, Way, Touch]:  # fmt: skip
    """Return when two shapes meet that may touch at first, as :func:`sweep_inner` does.

    Their ``outlines`` meet, or if that is not found, or not looked for, their inner discs do.
    """
    none = Corner(0.0, 0.0, 0.0, 0)
    if a.vertices == 1 and b.vertices == 1:
        x, y = way.dx + start * way.ux, way.dy + start * way.uy
        t = sweep_circle_circle(x, y, way.ux, way.uy, a.radius + b.radius)
        x, y = x + min(t, 1.0) * way.ux, y + min(t, 1.0) * way.uy
        nx, ny, gap = circle_circle(x, y, a.radius, b.radius, 0)
        at = a.radius + 0.5 * gap
        return t, Way(x, y, way.ux, way.uy), Touch(gap, nx, ny, 1, Corner(at * nx, at * ny, gap, 1), none)
    size, swing = 2.0 * min(a.thin, b.thin), swing_of(a, turn_a) + swing_of(b, turn_b)
    travel, turning = math.sqrt(way.ux * way.ux + way.uy * way.uy) + swing, swing > _FAST * size
    t = sweep_outlines(way, turn_a, turn_b, start, a, b, pool) if outlines else 0.0
    inner, place, touch = MISS, way, Touch(math.inf, 0.0, 0.0, 0, none, none)
    if turning or t <= 1.0:
        inner, place, touch = sweep_inner(way, turn_a, turn_b, start, a, b, pool)
    if t <= 1.0 and outlines and t < inner:
        meeting, met_a, met_b = pose_at(way, turn_a, turn_b, a, b, start + t)
        found = touch_outlines(meeting, met_a, met_b, pool, _JUST_MEETING * size, 0)
        one, two = found.one, found.two
        if found.points == 2:  # what lands flat is not spun up
            one = Corner(0.5 * (one.x + two.x), 0.5 * (one.y + two.y), one.separation, one.feature)
        closes = opening(one, meeting, found.nx, found.ny, turn_a, turn_b) < -_STILL * travel
        if found.points > 0 and closes and abs(found.gap) <= _JUST_MEETING * size:
            return t, meeting, Touch(found.gap, found.nx, found.ny, 1, one, none)
    return inner, place, touch


@inlined
def _touch_inner(
    manifold: Manifold, one: Point, two: Point, way: Way, turn_a: float, turn_b: float, start: float,
    latest: float, a: Outline, b: Outline, pool: Vectors,
) -> bool:  # fmt: skip
    """Find where the inner disc of the smaller of two shapes meets the other one; return whether it does.

    Findings about their outlines are not put aside for an event after the ``latest`` share of a substep.
    """
    t, meeting, found = sweep_inner(way, turn_a, turn_b, start, a, b, pool)
    if t > latest:
        return False
    manifold.swept = 1
    before_1, before_2 = _impulses_of(one), _impulses_of(two)
    _put_points(manifold, one, two, meeting, turn_a, turn_b, start + t, found, before_1, before_2)
    return True


@inlined
def _put_points(
    manifold: Manifold, one: Point, two: Point, place: Way, turn_a: float, turn_b: float, share: float,
    found: Touch, before_1: Impulses, before_2: Impulses,
) -> None:  # fmt: skip
    """Fill a pair with the points that it has in a ``place``, a share of a substep from now."""
    manifold.normal_x, manifold.normal_y, manifold.count = found.nx, found.ny, found.points
    for j in range(found.points):
        point = found.one if j == 0 else found.two
        opens = share * opening(point, place, found.nx, found.ny, turn_a, turn_b) if share != 0.0 else 0.0
        _put(
            one if j == 0 else two, point.feature, point.x, point.y, point.x - place.dx, point.y - place.dy,
            point.separation - opens, before_1, before_2,
        )  # fmt: skip


@inlined
def _stays_apart(
    found: Touch, way: Way, turn_a: float, turn_b: float, swing: float, start: float, a: Outline, b: Outline,
    pool: Vectors,
) -> bool:  # fmt: skip
    """Whether two convex shapes stay apart along the normal of now, from ``start`` until a substep later."""
    if is_segment(a) or is_segment(b):
        return False
    gap, opens, end = found.gap, found.nx * way.ux + found.ny * way.uy, 1.0 + start
    least = _JUST_MEETING * 2.0 * min(a.thin, b.thin)
    if gap + start * (opens + swing) > least and gap + end * (opens - swing) > least:
        return True
    return bool(
        gap > least
        and least_gap(found, way, turn_a, turn_b, end, a, b, pool) > least
        and least_gap(found, way, turn_a, turn_b, start, a, b, pool) > least
    )


@inlined
def touch_rounded(
    manifold: Manifold, one: Point, two: Point, way: Way, turn_a: float, turn_b: float, start: float,
    speculative_margin: float, rest: float, a: Outline, b: Outline, pool: Vectors,
) -> None:  # fmt: skip
    """Find the points of any two shapes, of which at most one is a disc: as they are now, or where they meet.

    Both turn, by ``turn_a`` and ``turn_b`` [rad] in the substep. A second point is one that may be met in it,
    or in ``rest`` more substeps.
    """
    size = 2.0 * min(a.thin, b.thin)
    swing, swift = swing_of(a, turn_a) + swing_of(b, turn_b), is_swift(way, 2.0 * speculative_margin, a, b)
    travel = math.sqrt(way.ux * way.ux + way.uy * way.uy) + swing
    near = CONTACT_MARGIN * size + speculative_margin
    loaded = manifold.count > 0 and one.normal_impulse + two.normal_impulse > 0.0
    old = one.feature if loaded else 0  # of others a file keeps none
    before_1, before_2 = _impulses_of(one), _impulses_of(two)
    found = touch_outlines(way, a, b, pool, near + travel + rest * travel, old)
    manifold.count, manifold.swept, manifold.size, manifold.gap = 0, 0, size, found.gap
    manifold.normal_x, manifold.normal_y = found.nx, found.ny
    fast = travel > SWEEP_THRESHOLD * size and not loaded
    if found.gap > near and not ((fast or swift) and found.gap <= travel + speculative_margin):
        return
    place, share, t = way, 0.0, MISS
    if fast and not _stays_apart(found, way, turn_a, turn_b, swing, start, a, b, pool):
        t = sweep_outlines(way, turn_a, turn_b, start, a, b, pool)
        if t <= 1.0:
            meeting, met_a, met_b = pose_at(way, turn_a, turn_b, a, b, start + t)
            met = touch_outlines(meeting, met_a, met_b, pool, near + travel, 0)
            # Else they overlapped before the substep began, or turn too far in it for the sweep.
            if abs(met.gap) <= _JUST_MEETING * size:
                found, place, share = met, meeting, start + t
                manifold.swept = 1
    # The sweep is sure of shapes that hardly turn, and are apart at first.
    if swift and (swing > _FAST * size or (manifold.swept == 0 and (loaded or t <= 1.0))):
        latest = t if manifold.swept == 1 else 1.0
        if _touch_inner(manifold, one, two, way, turn_a, turn_b, start, latest, a, b, pool):
            return
    if (fast or swift) and t > 1.0:
        if found.gap > near:
            return
        manifold.swept = 2 if fast else 0
    _put_points(manifold, one, two, place, turn_a, turn_b, share, found, before_1, before_2)


@inlined
def touch_boxes(
    manifold: Manifold, one: Point, two: Point, way: Way, turn_a: float, turn_b: float, start: float,
    speculative_margin: float, rest: float, a: Outline, b: Outline, pool: Vectors,
) -> None:  # fmt: skip
    """Find the points of two boxes: as they are now, or where they meet if they are fast for their size.

    ``speculative_margin`` is how far the forces may bring them together within the substep. Boxes whose
    corners turn far in it are swept as any two shapes are. A second point is one that may be met in it, or in
    ``rest`` more substeps.
    """
    dx, dy, ux, uy = way
    size = 2.0 * min(min(a.half_x, a.half_y), min(b.half_x, b.half_y))
    travel = math.sqrt(ux * ux + uy * uy)
    x, y, lead_x, lead_y, margin = dx, dy, 0.0, 0.0, CONTACT_MARGIN * size + travel + speculative_margin
    manifold.swept, manifold.size, manifold.gap = 0, size, -math.inf
    loaded = manifold.count > 0 and one.normal_impulse + two.normal_impulse > 0.0
    swing = swing_of(a, turn_a) + swing_of(b, turn_b)
    if not loaded and swing > _FAST * size:
        touch_rounded(manifold, one, two, way, turn_a, turn_b, start, speculative_margin, rest, a, b, pool)
        return
    room = rest * (travel + swing)
    if (
        loaded
        and is_swift(way, 2.0 * speculative_margin, a, b)
        and _touch_inner(manifold, one, two, way, turn_a, turn_b, start, 1.0, a, b, pool)
    ):
        return
    if travel > _FAST * size and not loaded:
        margin = CONTACT_MARGIN * size + speculative_margin
        x, y = dx + start * ux, dy + start * uy
        t = 0.0
        if box_box(x, y, 0.0, 0.0, a, b, -math.inf, 0)[0] > 0.0:
            t = sweep_box_box(Way(x, y, ux, uy), a, b)
        elif _touch_inner(manifold, one, two, way, turn_a, turn_b, start, 1.0, a, b, pool):
            return
        if t == MISS:
            manifold.count = 0
            return
        lead_x, lead_y = (start + t) * ux, (start + t) * uy
        x, y = dx + lead_x, dy + lead_y
        manifold.swept, room = 1, 0.0
    before_1, before_2 = _impulses_of(one), _impulses_of(two)
    old = one.feature if loaded and one.feature < FACE else 0  # of others a file keeps none
    gap, nx, ny, count, first, second = box_box(x, y, ux, uy, a, b, margin + room, old)
    if gap > margin:
        count = 0
    if not manifold.swept:
        manifold.gap = gap
    manifold.count = count
    if count > 0:
        manifold.normal_x, manifold.normal_y = nx, ny
        lead = lead_x * nx + lead_y * ny
        for j in range(count):
            x1, y1, separation, feature = first if j == 0 else second
            _put(
                one if j == 0 else two, feature, x1, y1, x1 - x, y1 - y, separation - lead, before_1, before_2
            )


@inlined
def _lowest_corners(
    height: float, nx: float, ny: float, body: Outline, pool: Vectors
) -> tuple[int, int, float, float]:
    """Return the two corners of a core that are nearest to a wall, and their distances from it [m]."""
    best, second = -1, -1
    low, next_low = math.inf, math.inf
    for k in range(body.vertices):
        corner_x, corner_y = corner(k, body, pool)
        separation = height + corner_x * nx + corner_y * ny
        if separation < low:
            best, second, low, next_low = k, best, separation, low
        elif separation < next_low:
            second, next_low = k, separation
    return best, second, low, next_low


@inlined
def touch_wall(
    manifold: Manifold, one: Point, two: Point, way: Way, spin: float, speculative_margin: float,
    body: Outline, bounds: Numbers, pool: Vectors,
) -> None:  # fmt: skip
    """Find the points of a body and one of the bounds: the two corners nearest to the wall, or a disc's one.

    The body is where ``way`` begins, seen from the world's origin; ``spin`` is how far it turns a corner.
    """
    wall, (x, y, ux, uy), radius = manifold.wall, way, body.radius
    nx = 1.0 if wall == 0 else (-1.0 if wall == 2 else 0.0)
    ny = 1.0 if wall == 1 else (-1.0 if wall == 3 else 0.0)
    height = (x - bounds[wall]) * nx if wall == 0 or wall == 2 else (y - bounds[wall]) * ny
    travel = max(-(ux * nx + uy * ny), 0.0) + spin + speculative_margin
    manifold.gap = -math.inf
    manifold.normal_x, manifold.normal_y = nx, ny
    before_1, before_2 = _impulses_of(one), _impulses_of(two)
    manifold.count, manifold.swept = 0, 0
    manifold.size = 2.0 * body.thin
    margin = CONTACT_MARGIN * body.thin + travel
    best, second, low, next_low = _lowest_corners(height, nx, ny, body, pool)
    for j in range(2):
        nearest, separation = (best, low - radius) if j == 0 else (second, next_low - radius)
        if separation <= margin:
            manifold.count = j + 1
            corner_x, corner_y = corner(nearest, body, pool)
            arm_x, arm_y = corner_x - radius * nx, corner_y - radius * ny
            point = one if j == 0 else two
            _put(point, nearest + 1, x + arm_x, y + arm_y, arm_x, arm_y, separation, before_1, before_2)
