"""Impacts: approaching bodies bounce, each pair at its own time within the substep."""

import math
from typing import NamedTuple

from physicslab.kernels import fused, inlined
from physicslab.kernels.arguments import Acting, Contacts, Inverse, Log, Motion
from physicslab.kernels.records import Manifold, Point
from physicslab.kernels.solver.impact_log import write_impact
from physicslab.kernels.solver.impulse import apply_impulse, follow_drift, relative_velocity

__all__ = ["bounce", "friction_impulse", "resolve_impacts"]

_MAX_SWEEPS = 32
"""Largest number of sweeps over the impacts of a substep; those left are treated as inelastic."""


class Window(NamedTuple):
    """When a substep begins and ends, and from when on a pair may meet late: times from now [s]."""

    start: float
    end: float
    earliest: float


class Approach(NamedTuple):
    """How a pair approaches: the speeds of its points [m/s] and their acceleration [m/s^2] along the normal.

    Then the speed up to which that counts as rest.
    """

    v1: float
    v2: float
    pull: float
    resting_speed: float


@inlined
def _shift(
    a: int, b: int, before: tuple[float, float, float, float, float, float], motion: Motion, t: float
) -> None:
    """Move A and B to where they would be, had their velocities changed at the time t from now, not now.

    Each has moved with the old velocity until t and moves with the new one from there on: x -= t (v_new -
    v_old).
    """
    position, angle, linear, angular = motion
    position[a, 0] -= t * (linear[a, 0] - before[0])
    position[a, 1] -= t * (linear[a, 1] - before[1])
    angle[a] -= t * (angular[a] - before[2])
    position[b, 0] -= t * (linear[b, 0] - before[3])
    position[b, 1] -= t * (linear[b, 1] - before[4])
    angle[b] -= t * (angular[b] - before[5])


@inlined
def _meeting_time(separation: float, v: float, pull: float, window: Window, loaded: bool) -> float:
    """Return the t in a window at which separation + v t + pull t^2 / 2 = 0, for an approach v < 0.

    Infinity where that is later. Where it is earlier than its start, an impact with a third body has made
    them approach too late to be found in time, and they meet now. But if it is not after the ``earliest``, or
    if they were in ``loaded`` contact in the last substep, it is no impact but the load of other bodies in a
    pile, which must not bounce: minus infinity.
    """
    root = v * v - 2.0 * pull * separation
    if root < 0.0 and separation > 0.0:  # the forces keep them apart
        return math.inf
    t = 2.0 * separation / (-v + math.sqrt(root)) if root >= 0.0 else -math.inf  # without cancellation
    if t > window.end:
        return math.inf
    # A meeting at the boundary of two substeps belongs to the later one.
    if t >= window.start - 1e-6 * (window.end - window.start):
        return t
    return -math.inf if loaded or t <= window.earliest else 0.0


@inlined
def _bounce_two(
    manifold: Manifold, one: Point, two: Point, v1: float, v2: float, inverse: Inverse
) -> tuple[float, float]:
    """Return the normal impulses that turn both approach speeds of a contact into e times themselves.

    The two are solved together, so that a box that lands flat does not start to turn. Where one impulse would
    pull, the other acts alone.
    """
    a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
    turn_a1, turn_b1 = one.arm_ax * ny - one.arm_ay * nx, one.arm_bx * ny - one.arm_by * nx
    turn_a2, turn_b2 = two.arm_ax * ny - two.arm_ay * nx, two.arm_bx * ny - two.arm_by * nx
    k11, k22 = 1.0 / one.normal_mass, 1.0 / two.normal_mass
    k12 = inverse.mass[a] + inverse.mass[b] + inverse.inertia[a] * turn_a1 * turn_a2
    k12 += inverse.inertia[b] * turn_b1 * turn_b2
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
    manifold: Manifold, one: Point, two: Point, meets_1: bool, meets_2: bool, v1: float, v2: float,
    inverse: Inverse,
) -> tuple[float, float]:  # fmt: skip
    """Return the normal impulses on B of an impact at the approach speeds v1 and v2 of its points [N s]."""
    if meets_1 and meets_2:
        return _bounce_two(manifold, one, two, v1, v2, inverse)
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
def _hit(manifold: Manifold, point: Point, j: float, v: float, motion: Motion, inverse: Inverse) -> None:
    """Apply a normal impulse and its friction: what stops the sliding, at most mu times j."""
    a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
    apply_impulse(point, j * nx, j * ny, a, b, motion, inverse)
    point.approach_speed = max(point.approach_speed, -v)
    point.impact_normal += j
    if manifold.friction > 0.0:
        vx, vy = relative_velocity(point, a, b, motion)
        along = friction_impulse(manifold, point, j, vy * nx - vx * ny)
        apply_impulse(point, -along * ny, along * nx, a, b, motion, inverse)
        point.impact_tangent += along


@inlined
def _meeting_times(
    manifold: Manifold, one: Point, two: Point, motion: Motion, approach: Approach, window: Window
) -> tuple[float, float]:
    """Return when both points of a pair meet [s from now]; not finite for one that does not.

    Points that meet after this substep are marked as ``ahead``.
    """
    a, b = manifold.a, manifold.b
    moved_x = motion.position[b, 0] - motion.position[a, 0] - manifold.offset_x
    moved_y = motion.position[b, 1] - motion.position[a, 1] - manifold.offset_y
    moved = moved_x * manifold.normal_x + moved_y * manifold.normal_y
    span, pull = window.end - window.start, approach.pull
    # Half-way through leapfrog's substep, positions do not contain the effect of the forces yet.
    moved += 0.125 * pull * span * span
    t1 = t2 = -math.inf
    if approach.v1 < -approach.resting_speed:
        t1 = _meeting_time(one.separation + moved, approach.v1, pull, window, one.normal_impulse > 0.0)
        one.ahead = 1 if t1 == math.inf else 0
    if approach.v2 < -approach.resting_speed:
        t2 = _meeting_time(two.separation + moved, approach.v2, pull, window, two.normal_impulse > 0.0)
        two.ahead = 1 if t2 == math.inf else 0
    return t1, t2


@inlined
def _resolve_pair(
    manifold: Manifold, one: Point, two: Point, motion: Motion, inverse: Inverse,
    approach: Approach, window: Window, log: Log, number: int,
) -> bool:  # fmt: skip
    """Bounce one pair if it meets within the window; return whether it did."""
    if manifold.swept == 2:
        one.ahead = 1
        return False
    t1, t2 = _meeting_times(manifold, one, two, motion, approach, window)
    meets_1, meets_2 = abs(t1) < math.inf, abs(t2) < math.inf
    if not (meets_1 or meets_2):
        return False
    t = min(t1, t2) if meets_1 and meets_2 else (t1 if meets_1 else t2)
    # The speeds at the time of contact, not those of now.
    v1, v2 = approach.v1 + approach.pull * t, approach.v2 + approach.pull * t
    a, b, position, linear, angular = manifold.a, manifold.b, motion.position, motion.linear, motion.angular
    before = (linear[a, 0], linear[a, 1], angular[a], linear[b, 0], linear[b, 1], angular[b])
    earlier = one.impact_normal + two.impact_normal, one.impact_tangent + two.impact_tangent
    j1, j2 = bounce(manifold, one, two, meets_1, meets_2, v1, v2, inverse)
    if j1 > 0.0:
        _hit(manifold, one, j1, v1, motion, inverse)
    if j2 > 0.0:
        _hit(manifold, two, j2, v2, motion, inverse)
    if (j1 > 0.0 or j2 > 0.0) and len(log.impacts) > 0:
        where, v = (one, v1) if j1 >= j2 else (two, v2)
        x, y = position[b, 0] + t * before[3], position[b, 1] + t * before[4]
        write_impact(
            log.impacts, number, manifold, one, two, where, log.time + t, x, y, -v, earlier[0], earlier[1]
        )
    _shift(a, b, before, motion, t)
    if manifold.swept == 1 and manifold.restitution > 0.0:
        # Its normal is not that of now: the solver must not push along it.
        one.ahead = two.ahead = 1
    return j1 > 0.0 or j2 > 0.0


@fused
def _forced(
    manifold: Manifold, motion: Motion, inverse: Inverse, acting: Acting, h: float
) -> tuple[float, float]:
    """Return how B accelerates against A along the normal, and the speed up to which an approach is rest."""
    a, b, linear, force = manifold.a, manifold.b, motion.linear, acting.force
    # An approach must at least exceed rounding.
    speed = abs(linear[a, 0]) + abs(linear[a, 1]) + abs(linear[b, 0]) + abs(linear[b, 1])
    if not acting.any:
        return 0.0, 1e-9 * speed
    ax, ay = force[a, 0] * inverse.mass[a], force[a, 1] * inverse.mass[a]
    bx, by = force[b, 0] * inverse.mass[b], force[b, 1] * inverse.mass[b]
    strongest = math.sqrt(max(ax * ax + ay * ay, bx * bx + by * by))
    pull = (bx - ax) * manifold.normal_x + (by - ay) * manifold.normal_y
    return pull, 1e-9 * speed + 2.0 * h * strongest


@fused
def _resolve_once(
    contacts: Contacts, motion: Motion, inverse: Inverse, acting: Acting, log: Log, logged: int, h: float,
    window: Window, again: bool,
) -> tuple[int, int]:  # fmt: skip
    """Resolve the pairs one after the other; return how many bounced, and how many are left to the solver.

    Inelastic ones are resolved once, and not ``again``.
    """
    bounced, left = 0, 0
    for k in range(contacts.number):
        p = contacts.touching[k]
        manifold = contacts.manifolds[p]
        if again and manifold.restitution == 0.0:
            left += 1
            continue
        # Most pairs rest: these are handled here without a call.
        a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
        one, two = contacts.points[2 * p], contacts.points[2 * p + 1]
        one.ahead = two.ahead = 0
        vx, vy = relative_velocity(one, a, b, motion)
        v1, v2 = vx * nx + vy * ny, 0.0
        overlap, loaded = one.separation < 0.0, one.normal_impulse > 0.0
        if manifold.count == 2:
            vx, vy = relative_velocity(two, a, b, motion)
            v2 = vx * nx + vy * ny
            overlap, loaded = overlap or two.separation < 0.0, loaded or two.normal_impulse > 0.0
        if v1 >= 0.0 and v2 >= 0.0:
            left += 1 if acting.any or overlap or loaded else 0
            continue
        pull, resting_speed = _forced(manifold, motion, inverse, acting, h)
        if v1 >= -resting_speed and v2 >= -resting_speed:
            left += 1
            continue
        if window.start >= 0.0:  # in symplectic Euler the forces have acted already
            pull = 0.0
        approach = Approach(v1, v2, pull, resting_speed)
        if _resolve_pair(manifold, one, two, motion, inverse, approach, window, log, logged + bounced):
            bounced += 1
            manifold.impact_count += 1
        left += 1 - one.ahead
    return bounced, left


@inlined
def resolve_impacts(
    contacts: Contacts, motion: Motion, inverse: Inverse, acting: Acting, log: Log, logged: int,
    h: float, start: float, end: float,
) -> tuple[int, int]:  # fmt: skip
    """Bounce the pairs that meet in this substep, each at its own time.

    The substep spans the times ``start`` to ``end`` from now. An impact at the time t takes the speeds of
    that time, j = -(1 + e) v_n / effective mass with friction up to mu j, and leaves the bodies where they
    would be had they bounced then: that is exact for constant forces, and keeps energy (e = 1), momentum and
    angular momentum.

    A pair approaches if it is faster than what the forces can cause in two substeps: slower pairs are in
    resting contact, which the solver handles. Pairs are resolved one after the other, in order, until none
    meets any more; inelastic ones only once, for the solver removes what is left of their approach.

    Impacts go into ``log``, unless it has no length, from number ``logged`` on. Returns how many there were,
    and how many pairs are left to the solver.
    """
    impacts, left = 0, contacts.number
    # Without forces there are no piles.
    window = Window(start, end, start - 2.0 * (end - start) if acting.any else -math.inf)
    for sweep in range(_MAX_SWEEPS):
        bounced, left = _resolve_once(
            contacts, motion, inverse, acting, log, logged + impacts, h, window, sweep > 0
        )
        impacts += bounced
        if bounced == 0:
            break
    if impacts:
        _measure_again(contacts, motion)
    if left == 0:
        follow_drift(contacts, motion, end)
    return impacts, left


@inlined
def _measure_again(contacts: Contacts, motion: Motion) -> None:
    """Bring separations up to date after impacts have moved bodies."""
    position = motion.position
    for k in range(contacts.number):
        p = contacts.touching[k]
        manifold = contacts.manifolds[p]
        x = position[manifold.b, 0] - position[manifold.a, 0]
        y = position[manifold.b, 1] - position[manifold.a, 1]
        moved = (x - manifold.offset_x) * manifold.normal_x + (y - manifold.offset_y) * manifold.normal_y
        for j in range(2 * p, 2 * p + manifold.count):
            contacts.points[j].separation += moved
        manifold.offset_x, manifold.offset_y = x, y
