"""Impacts: approaching bodies bounce, each pair at its own time within the substep."""

import math

from physicslab.kernels import Numbers, Rows, Vectors, inlined
from physicslab.kernels.records import Impacts, Manifold, Manifolds, Point, Points
from physicslab.kernels.solver.impact_log import write_impact
from physicslab.kernels.solver.impulse import apply_impulse, follow_drift, relative_velocity

__all__ = ["bounce", "friction_impulse", "resolve_impacts"]

_MAX_SWEEPS = 32
"""Largest number of sweeps over the impacts of a substep; those left are treated as inelastic."""


@inlined
def _shift(
    a: int,
    b: int,
    before: tuple[float, float, float, float, float, float],
    position: Vectors,
    angle: Numbers,
    linear: Vectors,
    angular: Numbers,
    t: float,
) -> None:
    """Move A and B to where they would be, had their velocities changed at the time t from now, not now.

    Each has moved with the old velocity until t and moves with the new one from there on: x -= t (v_new -
    v_old).
    """
    position[a, 0] -= t * (linear[a, 0] - before[0])
    position[a, 1] -= t * (linear[a, 1] - before[1])
    angle[a] -= t * (angular[a] - before[2])
    position[b, 0] -= t * (linear[b, 0] - before[3])
    position[b, 1] -= t * (linear[b, 1] - before[4])
    angle[b] -= t * (angular[b] - before[5])


@inlined
def _meeting_time(
    separation: float, v: float, pull: float, start: float, end: float, earliest: float, loaded: bool
) -> float:
    """Return the t up to ``end`` at which separation + v t + pull t^2 / 2 = 0, for an approach v < 0.

    Infinity where that is later. Where it is earlier than ``start``, an impact with a third body has made
    them approach too late to be found in time, and they meet now. But if it is ``earliest``, or if they were
    in ``loaded`` contact in the last substep, it is not an impact but the load of other bodies in a pile,
    which must not bounce: minus infinity.
    """
    root = v * v - 2.0 * pull * separation
    if root < 0.0 and separation > 0.0:  # the forces keep them apart
        return math.inf
    t = 2.0 * separation / (-v + math.sqrt(root)) if root >= 0.0 else -math.inf  # without cancellation
    if t > end:
        return math.inf
    # A meeting at the boundary of two substeps belongs to the later one.
    if t >= start - 1e-6 * (end - start):
        return t
    return -math.inf if loaded or t <= earliest else 0.0


@inlined
def _bounce_two(
    manifold: Manifold,
    one: Point,
    two: Point,
    v1: float,
    v2: float,
    inverse_mass: Numbers,
    inverse_inertia: Numbers,
) -> tuple[float, float]:
    """Return the normal impulses that turn both approach speeds of a contact into e times themselves.

    The two are solved together, so that a box that lands flat does not start to turn. Where one impulse would
    pull, the other acts alone.
    """
    a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
    turn_a1, turn_b1 = one.arm_ax * ny - one.arm_ay * nx, one.arm_bx * ny - one.arm_by * nx
    turn_a2, turn_b2 = two.arm_ax * ny - two.arm_ay * nx, two.arm_bx * ny - two.arm_by * nx
    k11, k22 = 1.0 / one.normal_mass, 1.0 / two.normal_mass
    k12 = inverse_mass[a] + inverse_mass[b] + inverse_inertia[a] * turn_a1 * turn_a2
    k12 += inverse_inertia[b] * turn_b1 * turn_b2
    r1, r2 = -(1.0 + manifold.restitution) * v1, -(1.0 + manifold.restitution) * v2
    determinant = k11 * k22 - k12 * k12
    if determinant > 1e-9 * k11 * k22:
        j1 = (k22 * r1 - k12 * r2) / determinant
        j2 = (k11 * r2 - k12 * r1) / determinant
        if j1 >= 0.0 and j2 >= 0.0:
            return j1, j2
    if r1 >= r2:
        return r1 / k11, 0.0
    return 0.0, r2 / k22


@inlined
def bounce(
    manifold: Manifold,
    one: Point,
    two: Point,
    meets_1: bool,
    meets_2: bool,
    v1: float,
    v2: float,
    inverse_mass: Numbers,
    inverse_inertia: Numbers,
) -> tuple[float, float]:
    """Return the normal impulses on B of an impact at the approach speeds v1 and v2 of its points [N s]."""
    if meets_1 and meets_2:
        return _bounce_two(manifold, one, two, v1, v2, inverse_mass, inverse_inertia)
    if meets_1:
        return -(1.0 + manifold.restitution) * v1 * one.normal_mass, 0.0
    return 0.0, -(1.0 + manifold.restitution) * v2 * two.normal_mass


@inlined
def friction_impulse(manifold: Manifold, point: Point, j: float, sliding: float) -> float:
    """Return the impulse that stops the sliding, at most mu times the normal impulse j [N s]."""
    limit = manifold.friction * j
    along: float = min(max(-point.tangent_mass * sliding, -limit), limit)
    return along


@inlined
def _hit(
    manifold: Manifold,
    point: Point,
    j: float,
    v: float,
    linear: Vectors,
    angular: Numbers,
    inverse_mass: Numbers,
    inverse_inertia: Numbers,
) -> None:
    """Apply a normal impulse and its friction: what stops the sliding, at most mu times j."""
    a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
    apply_impulse(point, j * nx, j * ny, a, b, linear, angular, inverse_mass, inverse_inertia)
    point.approach_speed = max(point.approach_speed, -v)
    point.impact_normal += j
    if manifold.friction > 0.0:
        vx, vy = relative_velocity(point, a, b, linear, angular)
        along = friction_impulse(manifold, point, j, vy * nx - vx * ny)
        apply_impulse(point, -along * ny, along * nx, a, b, linear, angular, inverse_mass, inverse_inertia)
        point.impact_tangent += along


@inlined
def _resolve_pair(
    manifold: Manifold,
    one: Point,
    two: Point,
    position: Vectors,
    angle: Numbers,
    linear: Vectors,
    angular: Numbers,
    inverse_mass: Numbers,
    inverse_inertia: Numbers,
    v1: float,
    v2: float,
    pull: float,
    resting_speed: float,
    start: float,
    end: float,
    earliest: float,
    log: Impacts,
    number: int,
    time: float,
) -> bool:
    """Bounce one pair if it meets between ``start`` and ``end`` from now; return whether it did."""
    a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
    if manifold.swept == 2:
        one.ahead = 1
        return False
    moved_x = position[b, 0] - position[a, 0] - manifold.offset_x
    moved_y = position[b, 1] - position[a, 1] - manifold.offset_y
    moved = moved_x * nx + moved_y * ny
    # Half-way through leapfrog's substep, positions do not contain the effect of the forces yet.
    moved += 0.125 * pull * (end - start) * (end - start)
    t1 = t2 = -math.inf
    if v1 < -resting_speed:
        t1 = _meeting_time(one.separation + moved, v1, pull, start, end, earliest, one.normal_impulse > 0.0)
        one.ahead = 1 if t1 == math.inf else 0
    if v2 < -resting_speed:
        t2 = _meeting_time(two.separation + moved, v2, pull, start, end, earliest, two.normal_impulse > 0.0)
        two.ahead = 1 if t2 == math.inf else 0
    meets_1, meets_2 = abs(t1) < math.inf, abs(t2) < math.inf
    if not (meets_1 or meets_2):
        return False
    t = min(t1, t2) if meets_1 and meets_2 else (t1 if meets_1 else t2)
    # The speeds at the time of contact, not those of now.
    v1, v2 = v1 + pull * t, v2 + pull * t
    before = (linear[a, 0], linear[a, 1], angular[a], linear[b, 0], linear[b, 1], angular[b])
    earlier = one.impact_normal + two.impact_normal, one.impact_tangent + two.impact_tangent
    j1, j2 = bounce(manifold, one, two, meets_1, meets_2, v1, v2, inverse_mass, inverse_inertia)
    if j1 > 0.0:
        _hit(manifold, one, j1, v1, linear, angular, inverse_mass, inverse_inertia)
    if j2 > 0.0:
        _hit(manifold, two, j2, v2, linear, angular, inverse_mass, inverse_inertia)
    if (j1 > 0.0 or j2 > 0.0) and len(log) > 0:
        where, approach = (one, v1) if j1 >= j2 else (two, v2)
        x, y = position[b, 0] + t * before[3], position[b, 1] + t * before[4]
        write_impact(
            log, number, manifold, one, two, where, time + t, x, y, -approach, earlier[0], earlier[1]
        )
    _shift(a, b, before, position, angle, linear, angular, t)
    if (
        manifold.swept == 1 and manifold.restitution > 0.0
    ):  # its normal is not that of now: the solver must not push along it
        one.ahead = two.ahead = 1
    return j1 > 0.0 or j2 > 0.0


@inlined
def _forced(
    a: int,
    b: int,
    nx: float,
    ny: float,
    linear: Vectors,
    force: Vectors,
    inverse_mass: Numbers,
    has_forces: bool,
    h: float,
) -> tuple[float, float]:
    """Return how B accelerates against A along the normal, and the speed up to which an approach is rest."""
    # An approach must at least exceed rounding.
    speed = abs(linear[a, 0]) + abs(linear[a, 1]) + abs(linear[b, 0]) + abs(linear[b, 1])
    if not has_forces:
        return 0.0, 1e-9 * speed
    ax, ay = force[a, 0] * inverse_mass[a], force[a, 1] * inverse_mass[a]
    bx, by = force[b, 0] * inverse_mass[b], force[b, 1] * inverse_mass[b]
    strongest = math.sqrt(max(ax * ax + ay * ay, bx * bx + by * by))
    return (bx - ax) * nx + (by - ay) * ny, 1e-9 * speed + 2.0 * h * strongest


@inlined
def resolve_impacts(
    manifolds: Manifolds,
    points: Points,
    touching: Rows,
    count: int,
    position: Vectors,
    angle: Numbers,
    linear: Vectors,
    angular: Numbers,
    force: Vectors,
    inverse_mass: Numbers,
    inverse_inertia: Numbers,
    has_forces: bool,
    h: float,
    start: float,
    end: float,
    log: Impacts,
    logged: int,
    time: float,
) -> tuple[int, int]:
    """Bounce the pairs that meet in this substep, each at its own time.

    The substep spans the times ``start`` to ``end`` from now. An impact at the time t takes the speeds of
    that time, j = -(1 + e) v_n / effective mass with friction up to mu j, and leaves the bodies where they
    would be had they bounced then: that is exact for constant forces, and keeps energy (e = 1), momentum and
    angular momentum.

    A pair approaches if it is faster than what the forces can cause in two substeps: slower pairs are in
    resting contact, which the solver handles. Pairs are resolved one after the other, in order, until none
    meets any more; inelastic ones only once, for the solver removes what is left of their approach.

    Impacts go into ``log``, unless it has no length, from number ``logged`` on, with times from ``time`` [s],
    which is now.
    """
    impacts, left = 0, count
    earliest = start - 2.0 * (end - start) if has_forces else -math.inf  # without forces there are no piles
    for sweep in range(_MAX_SWEEPS):
        bounced, left = 0, 0
        for k in range(count):
            p = touching[k]
            manifold = manifolds[p]
            if sweep > 0 and manifold.restitution == 0.0:
                left += 1
                continue
            # Most pairs rest: these are handled here without a call.
            a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
            one, two = points[2 * p], points[2 * p + 1]
            one.ahead = two.ahead = 0
            vx, vy = relative_velocity(one, a, b, linear, angular)
            v1, v2 = vx * nx + vy * ny, 0.0
            overlap, loaded = one.separation < 0.0, one.normal_impulse > 0.0
            if manifold.count == 2:
                vx, vy = relative_velocity(two, a, b, linear, angular)
                v2 = vx * nx + vy * ny
                overlap, loaded = overlap or two.separation < 0.0, loaded or two.normal_impulse > 0.0
            if v1 >= 0.0 and v2 >= 0.0:
                left += 1 if has_forces or overlap or loaded else 0
                continue
            pull, resting_speed = _forced(a, b, nx, ny, linear, force, inverse_mass, has_forces, h)
            if v1 >= -resting_speed and v2 >= -resting_speed:
                left += 1
                continue
            if start >= 0.0:  # in symplectic Euler the forces have acted already
                pull = 0.0
            if _resolve_pair(
                manifold, one, two, position, angle, linear, angular, inverse_mass, inverse_inertia,
                v1, v2, pull, resting_speed, start, end, earliest, log, logged + impacts + bounced, time,
            ):  # fmt: skip
                bounced += 1
                manifold.impact_count += 1
            left += 1 - one.ahead
        impacts += bounced
        if bounced == 0:
            break
    if impacts:
        _measure_again(manifolds, points, touching, count, position)
    if left == 0:
        follow_drift(manifolds, points, touching, count, linear, angular, end)
    return impacts, left


@inlined
def _measure_again(
    manifolds: Manifolds, points: Points, touching: Rows, count: int, position: Vectors
) -> None:
    """Bring separations up to date after impacts have moved bodies."""
    for k in range(count):
        p = touching[k]
        manifold = manifolds[p]
        x = position[manifold.b, 0] - position[manifold.a, 0]
        y = position[manifold.b, 1] - position[manifold.a, 1]
        moved = (x - manifold.offset_x) * manifold.normal_x + (y - manifold.offset_y) * manifold.normal_y
        for j in range(2 * p, 2 * p + manifold.count):
            points[j].separation += moved
        manifold.offset_x, manifold.offset_y = x, y
