"""The narrow phase: where near pairs touch, or would within a substep."""

import math

from physicslab.kernels import Rows, Vectors, always_inlined, inlined
from physicslab.kernels.arguments import Bounds, Inverse, Materials, Motion, Near
from physicslab.kernels.constraint.pair import frame_of, inverse_mass_of, moment_arms, response
from physicslab.kernels.geometry import apart, pair
from physicslab.kernels.geometry.bend import note_bends
from physicslab.kernels.geometry.cores import VERTICES
from physicslab.kernels.geometry.margins import (
    ACTIVATION_RATIO,
    CACHE_TOLERANCE,
    CACHE_TURN_TOLERANCE,
    CONTACT_MARGIN,
    TOLERANCE_WITHIN_STEP,
)
from physicslab.kernels.geometry.outline import Way, is_segment, kept_outline, on_segment, swing_of
from physicslab.kernels.geometry.shapes import Shapes, has_own_way, is_chain, segment_of
from physicslab.kernels.near_counts import ACTIVE, FOLLOWED, SCALAR
from physicslab.kernels.records import Manifold, Point, Points

_ROWS_FOUND_AGAIN = 64
"""Number of bodies up to which points of boxes are found again after any motion."""
_NO_MOTION = 1e-9
"""Share of these tolerances that is no motion."""
AS_FOUND = 3
"""What ``found`` is of a pair with a disc whose point was found in its base pose, and is no later one's."""
BEGINS, GOES_ON, WITHIN, AFTER_IMPACTS = range(4)
"""When contacts are found: in the first substep of a step, which is the first of a call or goes on from
another step of it; in a later substep; or again, after impacts have changed velocities."""
_APART, _KEPT, _OUTDATED = range(3)
"""Knowledge of a pair of boxes: they have no points; their points are kept; it is out of date."""


@inlined
def follow_pose(
    manifold: Manifold, points: Points, p: int, dx: float, dy: float, turn_a: float, turn_b: float
) -> None:
    """Update the separations of kept points for how far the pair has moved and turned, to second order."""
    for j in range(2 * p, 2 * p + manifold.count):
        point = points[j]
        ax = turn_a * (-point.arm_ay - 0.5 * turn_a * point.arm_ax)
        ay = turn_a * (point.arm_ax - 0.5 * turn_a * point.arm_ay)
        bx = turn_b * (-point.arm_by - 0.5 * turn_b * point.arm_bx)
        by = turn_b * (point.arm_bx - 0.5 * turn_b * point.arm_by)
        along = (dx + bx - ax) * manifold.normal_x + (dy + by - ay) * manifold.normal_y
        point.separation = point.found_separation + along


@always_inlined
def effective_masses(manifold: Manifold, points: Points, p: int, inverse: Inverse) -> None:
    """Compute 1 / (1/m_a + 1/m_b + (r_a x n)^2 / I_a + (r_b x n)^2 / I_b), for normal and tangent."""
    mass = inverse_mass_of(inverse, manifold.a, manifold.b)
    both, ia, ib = mass.a + mass.b, mass.inertia_a, mass.inertia_b
    for j in range(2 * p, 2 * p + manifold.count):
        point = points[j]
        na, nb, ta, tb = moment_arms(frame_of(manifold, point))
        point.normal_mass = 1.0 / response(both, ia, ib, na, nb, na, nb)
        point.tangent_mass = 1.0 / response(both, ia, ib, ta, tb, ta, tb)


@inlined
def mix(manifold: Manifold, materials: Materials, bounds: Bounds) -> None:
    """Combine the materials of a pair: e = min, mu = the geometric mean."""
    a, b, restitution, friction = manifold.a, manifold.b, materials.restitution, materials.friction
    walled = manifold.wall >= 0
    manifold.restitution = min(bounds.restitution if walled else restitution[a], restitution[b])
    manifold.friction = math.sqrt((bounds.friction if walled else friction[a]) * friction[b])


@always_inlined
def _clearance_of_disc(
    manifold: Manifold, way: Way, motion: Motion, shapes: Shapes, bounds: Bounds, speculative_margin: float
) -> float:
    """Return how much nearer a disc would have to come to another one, or to a wall, to be looked at [m].

    -infinity where it is in this substep, which few near ones are.
    """
    a, b, wall, travel = manifold.a, manifold.b, manifold.wall, abs(way.ux) + abs(way.uy)
    if wall < 0:
        reach = ACTIVATION_RATIO * (shapes.radius[a] + shapes.radius[b]) + travel + speculative_margin
        square = way.dx * way.dx + way.dy * way.dy
        return math.sqrt(square) - reach + travel if square > reach * reach else -math.inf
    away = motion.position[b, wall % 2] - bounds.walls[wall]
    clear = (away if wall < 2 else -away) - shapes.radius[b]
    margin = ACTIVATION_RATIO * CONTACT_MARGIN * shapes.radius[b] + speculative_margin
    return clear - margin if clear - margin > travel else -math.inf


@inlined
def note_pose(manifold: Manifold, dx: float, dy: float, angle_a: float, angle_b: float) -> None:
    """Record the pose in which the points of a pair are found."""
    manifold.base_x, manifold.base_y = dx, dy
    manifold.base_angle_a, manifold.base_angle_b = angle_a, angle_b


@inlined
def forget_points(one: Point, two: Point) -> None:
    """Clear what the points of a pair that has none any more would be warm-started with."""
    one.feature = two.feature = one.ahead = two.ahead = 0
    one.normal_impulse = two.normal_impulse = one.tangent_impulse = two.tangent_impulse = 0.0


@always_inlined
def slides_on(manifold: Manifold, one: Point, two: Point, travel: float) -> bool:
    """Whether a pair has other points on a chain soon: it moves by ``travel`` [m], or is where that turns."""
    on_bend = one.feature >= VERTICES or (manifold.count == 2 and two.feature >= VERTICES)
    return bool(manifold.wall < -1 and (on_bend or travel > pair.SWEEP_THRESHOLD * manifold.size))


@always_inlined
def _to_be_swept(manifold: Manifold, points: Points, p: int, travel: float, size: float) -> bool:
    """Whether a pair that moves by ``travel`` [m] in a substep may have points of a later moment in it."""
    one, two = points[2 * p], points[2 * p + 1]
    loose = one.normal_impulse + (two.normal_impulse if manifold.count == 2 else 0.0) == 0.0
    meets = manifold.swept == 1 or (loose and travel > pair.SWEEP_THRESHOLD * size)
    return bool(meets or slides_on(manifold, one, two, travel))


@always_inlined
def _vertices_of(shapes: Shapes, i: int, wall: int) -> float:
    """Return a number that depends on the vertices of row i, or on the segment of a chain that is named."""
    at, pool = shapes.first[i], shapes.pool
    if is_chain(shapes, i):
        at += segment_of(wall)
    mixed: float = shapes.reach[i] + shapes.thin[i]
    if shapes.vertices[i] > 1:
        mixed += 0.19 * pool[at, 0] + 0.23 * pool[at, 1] + 0.29 * pool[at + 1, 0] + 0.31 * pool[at + 1, 1]
    return mixed


@always_inlined
def mixed_sizes(manifold: Manifold, shapes: Shapes, turns: bool) -> float:
    """Return a number that depends on the outlines of a pair, for the field ``base_sizes`` of its record.

    The pair ``turns`` where one is a disc, or where either is no disc and no box.
    """
    a, b, half_x, half_y = manifold.a, manifold.b, shapes.half_x, shapes.half_y
    mixed: float = 2.0 * half_x[b] + 4.0 * half_y[b]
    if manifold.wall < 0:
        mixed += 6.0 * half_x[a] + 10.0 * half_y[a]
    if turns:
        if not (has_own_way(shapes, a) and has_own_way(shapes, b)):  # of the same extents there are many
            mixed += 13.0 * _vertices_of(shapes, a, manifold.wall)
            mixed += 17.0 * _vertices_of(shapes, b, manifold.wall)
        mixed += 7.0 * shapes.radius[a] + 11.0 * shapes.radius[b]
    return mixed


@always_inlined
def _swings(shapes: Shapes, a: int, b: int, turn_a: float, turn_b: float) -> float:
    """Return how far corners of both come at most, which turn [rad]."""
    half_x, half_y = shapes.half_x, shapes.half_y
    both: float = abs(turn_a) * (half_x[a] + half_y[a]) + abs(turn_b) * (half_x[b] + half_y[b])
    return both


@always_inlined
def _clearance(
    manifold: Manifold, way: Way, motion: Motion, shapes: Shapes, size: float, speculative_margin: float
) -> float:
    """Return how much nearer a pair with corners would have to come, at least, to have points [m].

    It goes by the gap in its base pose, and by how far it has moved and turned since.
    """
    a, b, angle = manifold.a, manifold.b, motion.angle
    x, y = way.dx - manifold.base_x, way.dy - manifold.base_y
    moved = abs(x) + abs(y)
    if manifold.wall == -1 and not (has_own_way(shapes, a) and has_own_way(shapes, b)):
        # It is a gap of convex shapes along the normal.
        moved = -(x * manifold.normal_x + y * manifold.normal_y)
    turned = _swings(shapes, a, b, angle[a] - manifold.base_angle_a, angle[b] - manifold.base_angle_b)
    nearest: float = manifold.gap - moved - turned - 0.0025 * size
    return nearest - CONTACT_MARGIN * size - speculative_margin


@always_inlined
def _look_up(
    manifold: Manifold, points: Points, p: int, way: Way, motion: Motion, shapes: Shapes,
    h: float, speculative_margin: float, tolerance: float, turns: bool, disc: bool,
) -> tuple[int, float]:  # fmt: skip
    """Use what was found of a pair with corners, if they have hardly moved against each other.

    That there are no points is kept of any pair with corners, points where neither is a ``disc``. Where the
    pair ``turns``, its points may be those of a later moment in the substep.
    ``tolerance`` is a share of :data:`CACHE_TOLERANCE` and :data:`CACHE_TURN_TOLERANCE`. Returns what is
    known of them now, and the size [m] of the smaller one. Where nothing is known, their present pose is
    recorded, for which their points are to be found.
    """
    a, b, half_x, radius, angle = manifold.a, manifold.b, shapes.half_x, shapes.radius, motion.angle
    own_ways = has_own_way(shapes, a) and has_own_way(shapes, b)
    size, of_both = 2.0 * shapes.thin[b], mixed_sizes(manifold, shapes, turns)
    if manifold.wall < 0:
        size = min(size, 2.0 * shapes.thin[a])
    travel = abs(way.ux) + abs(way.uy)
    swing = _swings(shapes, a, b, h * motion.angular[a], h * motion.angular[b])
    ahead = travel + swing
    if turns:
        travel = ahead
        if own_ways:
            size = min(max(half_x[a], radius[a]), max(half_x[b], radius[b]))
    moved_x, moved_y = way.dx - manifold.base_x, way.dy - manifold.base_y
    turn_a, turn_b = angle[a] - manifold.base_angle_a, angle[b] - manifold.base_angle_b
    slow = travel <= 0.5 * CONTACT_MARGIN * size
    if manifold.found == 2 and manifold.base_sizes == of_both:
        if manifold.count == 0:
            if manifold.wall == -1 and not own_ways:
                ahead = abs(way.ux * manifold.normal_x + way.uy * manifold.normal_y) + swing
            if _clearance(manifold, way, motion, shapes, size, speculative_margin) > ahead:
                return _APART, size
        elif (
            not disc
            and abs(moved_x) + abs(moved_y) <= tolerance * CACHE_TOLERANCE * size
            and abs(turn_a) <= tolerance * CACHE_TURN_TOLERANCE
            and abs(turn_b) <= tolerance * CACHE_TURN_TOLERANCE
            and slow
            and not (turns and _to_be_swept(manifold, points, p, travel, size))
        ):
            follow_pose(manifold, points, p, moved_x, moved_y, turn_a, turn_b)
            return _KEPT, size
    note_pose(manifold, way.dx, way.dy, angle[a], angle[b])
    manifold.base_sizes = of_both
    manifold.found = 2 if slow else 1
    return _OUTDATED, size


@always_inlined
def _in_place(
    manifold: Manifold, point: Point, way: Way, motion: Motion, shapes: Shapes, speculative_margin: float
) -> bool:
    """Whether a pair with a disc is, to the last bit, where its point was found, and presses on it.

    To find it again would give the same.
    """
    a, b, angle, vertices = manifold.a, manifold.b, motion.angle, shapes.vertices
    return bool(
        manifold.found == AS_FOUND
        and way.dx == manifold.base_x
        and way.dy == manifold.base_y
        and (vertices[a] < 2 or angle[a] == manifold.base_angle_a)
        and (vertices[b] < 2 or angle[b] == manifold.base_angle_b)
        and point.normal_impulse > 0.0
        and point.found_separation < CONTACT_MARGIN * 0.5 * manifold.size + speculative_margin
    )


@always_inlined
def touch(
    manifold: Manifold, one: Point, two: Point, way: Way, motion: Motion, shapes: Shapes, bounds: Bounds,
    rotations: Vectors, h: float, start: float, speculative_margin: float, rest: float,
) -> None:  # fmt: skip
    """Find the points of a pair, of whatever shapes: what is fast for discs and boxes is chosen here.

    They are kept for this substep and ``rest`` more, in which a second one may be met.
    """
    b = manifold.b
    body = kept_outline(b, motion.angle, shapes, rotations)
    if manifold.wall >= 0:
        spin = swing_of(body, motion.angular[b] * h)
        place = Way(motion.position[b, 0], motion.position[b, 1], way.ux, way.uy)
        pair.touch_wall(manifold, one, two, place, spin, speculative_margin, body, bounds.walls, shapes.pool)
        return
    other = kept_outline(manifold.a, motion.angle, shapes, rotations)
    turn_a = h * motion.angular[manifold.a] if other.vertices > 1 else 0.0
    turn_b = h * motion.angular[b] if body.vertices > 1 else 0.0
    if not (has_own_way(shapes, manifold.a) and has_own_way(shapes, b)):
        pair.touch_rounded(
            manifold, one, two, way, turn_a, turn_b, start, speculative_margin, rest,
            on_segment(other, manifold.wall), on_segment(body, manifold.wall), shapes.pool,
        )  # fmt: skip
        if manifold.wall < -1 and manifold.count > 0 and manifold.swept != 1:
            chain_is_a = is_segment(other)
            segment, moved, turn = (other, body, turn_b) if chain_is_a else (body, other, turn_a)
            note_bends(
                manifold, one, two, way, turn, h, speculative_margin, chain_is_a,
                on_segment(segment, manifold.wall), moved, shapes.pool,
            )  # fmt: skip
    elif other.box and body.box:
        pair.touch_boxes(
            manifold, one, two, way, turn_a, turn_b, start, speculative_margin, rest, other, body, shapes.pool
        )
    else:
        turn = turn_a if other.box else turn_b
        pair.touch_with_circle(manifold, one, way, turn, start, speculative_margin, other, body, shapes.pool)


@always_inlined
def _list_pair(
    touching: Rows, p: int, manifold: Manifold, inverse: Inverse, found: int, held: int
) -> tuple[int, int]:  # fmt: skip
    """Write pair ``p`` after the ``found`` ones, or before those from ``held`` on if one body is fixed."""
    if inverse.mass[manifold.a] > 0.0 and inverse.mass[manifold.b] > 0.0:
        touching[found] = p
        return found + 1, held
    touching[held - 1] = p
    return found, held - 1


@inlined
def _put_last(touching: Rows, found: int, held: int, count: int) -> int:
    """Put the pairs from ``held`` on, which were written from the end, after those found; return how many."""
    at_end = count - held
    for k in range(at_end // 2):
        touching[held + k], touching[count - 1 - k] = touching[count - 1 - k], touching[held + k]
    for k in range(at_end):
        touching[found + k] = touching[held + k]
    return found + at_end


@inlined
def list_touching(near: Near, inverse: Inverse) -> None:
    """List the scalar pairs with points again, in the order of :func:`find_contacts`."""
    count, found = near.counts[SCALAR], 0
    held = count
    for number in range(count):
        p = near.scalar[number]
        manifold = near.manifolds[p]
        if manifold.count > 0:
            found, held = _list_pair(near.touching, p, manifold, inverse, found, held)
    near.counts[ACTIVE] = _put_last(near.touching, found, held, count)


@inlined
def _has_few_rows(entities: Rows) -> bool:
    """Whether a world has at most :data:`_ROWS_FOUND_AGAIN` rows, blank ones left out: they change no bits.

    At most half of all rows are blank.
    """
    rows = len(entities)
    if rows <= _ROWS_FOUND_AGAIN or rows > 2 * _ROWS_FOUND_AGAIN + 1:
        return rows <= _ROWS_FOUND_AGAIN
    filled = 1  # row 0 is the world
    for i in range(rows):
        filled += 1 if entities[i] > 0 else 0
    return filled <= _ROWS_FOUND_AGAIN


@inlined
def find_contacts(
    near: Near, count: int, motion: Motion, shapes: Shapes, materials: Materials, inverse: Inverse,
    bounds: Bounds, when: int, h: float, start: float, speculative_margin: float, rest: float, sweep: float,
) -> int:  # fmt: skip
    """Find or refresh the contact points of the ``count`` scalar pairs; return how many have any.

    Their numbers are written to ``near.touching``, in order, those with fixed bodies last. A pair of boxes
    that has hardly moved keeps its points. The substep spans ``h`` seconds from ``start`` h before or after
    now: a pair that meets within it has points with the normal of that moment and the separation, along it,
    of now. Pairs whose count is negative are moved by event-driven stepping, and passed over. ``when`` it is
    says whether records of impacts are cleared, as a step begins, and whether only those pairs without points
    are looked at of which an impact has changed a body, from its ``sweep`` on. ``speculative_margin`` is how
    far [m] the forces may bring two bodies together within the substep; ``rest`` more may follow before
    points are found again.
    """
    position, linear, touching = motion.position, motion.linear, near.touching
    found, held, far, first, again = 0, count, 0, when <= GOES_ON, when == AFTER_IMPACTS
    if when == BEGINS:
        near.counts[FOLLOWED] = 0
    apart.look_at_new(near)
    if near.counts[FOLLOWED] > 0 and not again:
        apart.follow(near.travels, motion, shapes, h)
    # The arms of kept points are those of the pose in which they were found.
    tolerance = 1.0 if first else TOLERANCE_WITHIN_STEP
    if _has_few_rows(near.entities):
        tolerance = _NO_MOTION
    for number in range(count):
        p = near.scalar[number]
        if again:
            if not apart.may_be_thrown_together(near, p, sweep):
                continue
            if not apart.is_sure_to_be_listed(near.manifolds[p], near, shapes, bounds, h, speculative_margin):
                continue
        elif apart.stays_apart(near, p):
            continue
        manifold, one, two = near.manifolds[p], near.points[2 * p], near.points[2 * p + 1]
        had_points, size = manifold.count > 0, 0.0
        if manifold.count < 0:
            continue
        a, b = manifold.a, manifold.b
        if first and manifold.impact_count > 0:
            manifold.impact_count = 0
            one.approach_speed = one.impact_normal = one.impact_tangent = 0.0
            two.approach_speed = two.impact_normal = two.impact_tangent = 0.0
        way = Way(
            position[b, 0] - position[a, 0], position[b, 1] - position[a, 1],
            (linear[b, 0] - linear[a, 0]) * h, (linear[b, 1] - linear[a, 1]) * h,
        )  # fmt: skip
        vertices, walled = shapes.vertices, manifold.wall >= 0
        polygons = int(vertices[a] > 1) + int(vertices[b] > 1)
        rounded = not (has_own_way(shapes, a) and has_own_way(shapes, b))
        circular = not walled and polygons == 1
        round_pair = not had_points and polygons == 0
        if round_pair:
            clearance = _clearance_of_disc(manifold, way, motion, shapes, bounds, speculative_margin)
            if clearance > -math.inf:
                apart.note(near, p, a, b, clearance if manifold.impact_count == 0 else -math.inf, motion)
                far += 1
                continue
        manifold.offset_x, manifold.offset_y = way.dx, way.dy
        known = _OUTDATED
        with_disc = not walled and polygons < 2
        if with_disc and not first and _in_place(manifold, one, way, motion, shapes, speculative_margin):
            one.separation = one.found_separation
            known = _KEPT
        elif polygons > 0:
            known, size = _look_up(
                manifold, near.points, p, way, motion, shapes, h, speculative_margin, tolerance,
                circular or rounded, circular,
            )  # fmt: skip
        if known == _OUTDATED:
            touch(
                manifold, one, two, way, motion, shapes, bounds, near.rotations, h, start, speculative_margin,
                rest,
            )  # fmt: skip
            if with_disc:
                if not circular:
                    note_pose(manifold, way.dx, way.dy, 0.0, 0.0)
                manifold.found = AS_FOUND if manifold.count > 0 and manifold.swept == 0 else 0
            if polygons > 0 and manifold.count == 0:
                manifold.found = 2  # how far they are apart is known, however fast they are
        if manifold.count > 0:
            if first or known == _OUTDATED:
                effective_masses(manifold, near.points, p, inverse)
            if first or not had_points:
                mix(manifold, materials, bounds)
            apart.note_touching(near, p)
            if again:  # what passes by without touching is left to the next substep
                touching[near.counts[ACTIVE] + found] = p
                one.ahead = two.ahead = 1 if manifold.swept == 2 else 0
                found += 1 - one.ahead
            else:
                found, held = _list_pair(touching, p, manifold, inverse, found, held)
        else:
            if had_points:
                forget_points(one, two)
            clearance = -math.inf
            if polygons > 0:
                clearance = _clearance(manifold, way, motion, shapes, size, speculative_margin)
                far += 1
            # A pair that has bounced is looked at when the next step begins.
            apart.note(near, p, a, b, clearance if manifold.impact_count == 0 else -math.inf, motion)
    if again:
        return int(near.counts[ACTIVE] + found)
    if near.counts[FOLLOWED] == 0:
        apart.begin_to_follow(near, motion, far)
    return _put_last(touching, found, held, count)
