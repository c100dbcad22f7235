"""Impacts: approaching bodies bounce, each pair at its own time within the substep."""

import math
from typing import NamedTuple

from physicslab.kernels import Numbers, Vectors, always_inlined, inlined
from physicslab.kernels.accounts import IMPACTS
from physicslab.kernels.arguments import Acting, Contacts, Inverse, Log, Motion
from physicslab.kernels.constraint.impact_law import (
    ENERGETIC,
    LOWERED,
    NEWTON,
    ImpactImpulses,
    pair_response,
    point_response,
    solve_impact,
    solve_impact_of_two,
)
from physicslab.kernels.constraint.pair import (
    ContactFrame,
    PairInverseMass,
    PairVelocity,
    after_impulse_at,
    frame_of,
    inverse_mass_of,
    point_state,
    put_velocity,
    velocity_of,
)
from physicslab.kernels.geometry.apart import SINCE
from physicslab.kernels.geometry.cores import FACE
from physicslab.kernels.geometry.impact_pose import is_known, meeting_at
from physicslab.kernels.geometry.shapes import Shapes
from physicslab.kernels.geometry.sweep import INNER_SHARE
from physicslab.kernels.records import Manifold, Point
from physicslab.kernels.solver.impact_log import ImpactPoints, Pose, book_impact, pair_of, write_impact
from physicslab.kernels.solver.impulse import measure_again

_MAX_SWEEPS = 32
"""Largest number of sweeps over the impacts of a substep; those left are treated as inelastic."""

A, B, LEFT_TO_SOLVER, SWEPT = range(4)
"""Notes of a pair while impacts are resolved: its bodies; whether its impulses are the solver's; and whether
its point is one of a later moment in the substep."""
_NEW = 2.0
"""In place of that last one of a pair that has not been looked at yet."""


class ImpactWindow(NamedTuple):
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
    a: int, b: int, old: PairVelocity[float], new: PairVelocity[float], motion: Motion, t: float
) -> None:
    """Move A and B to where they would be, had their velocities changed at the time t from now, not now.

    Each has moved with the old velocity until t and moves with the new one from there on: x -= t (v_new -
    v_old).
    """
    position, angle = motion.position, motion.angle
    position[a, 0] -= t * (new.ax - old.ax)
    position[a, 1] -= t * (new.ay - old.ay)
    angle[a] -= t * (new.wa - old.wa)
    position[b, 0] -= t * (new.bx - old.bx)
    position[b, 1] -= t * (new.by - old.by)
    angle[b] -= t * (new.wb - old.wb)


@inlined
def _meeting_time(separation: float, v: float, pull: float, window: ImpactWindow, loaded: bool) -> float:
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
def _frame(manifold: Manifold, point: Point, motion: Motion, shapes: Shapes, t: float) -> ContactFrame[float]:
    """Return the normal and the arms of a point at the time t from now."""
    if is_known(manifold, point, motion, shapes):
        return frame_of(manifold, point)
    return meeting_at(manifold, point, motion, shapes, t)


@inlined
def _note_point(point: Point, v: float, normal: float, tangent: float) -> None:
    """Note the approach at which impulses of an impact act at a point, and add those."""
    point.approach_speed = max(point.approach_speed, -v)
    point.impact_normal += normal
    point.impact_tangent += tangent


@always_inlined
def _exchange(
    manifold: Manifold, one: Point, two: Point, meets_1: bool, meets_2: bool, motion: Motion, shapes: Shapes,
    mass: PairInverseMass[float], before: PairVelocity[float], t: float,
) -> tuple[ImpactPoints, float, int]:  # fmt: skip
    """Resolve the impact of a pair at the time t, with normal, arms and the speeds ``before`` of that time.

    Returns the points with their impulses, all 0 where it turns away until then, the approach speed at the
    first of them [m/s], and which law they obey.
    """
    e, mu = manifold.restitution, manifold.friction
    point = one if meets_1 else two
    frame = _frame(manifold, point, motion, shapes, t)
    at = point_state(frame, before)
    if meets_1 and meets_2:
        frame2 = _frame(manifold, two, motion, shapes, t)
        at2 = point_state(frame2, before)
        impulses, used = solve_impact_of_two(pair_response(at, at2, mass), e, mu)
        _note_point(one, at.v, impulses.normal1, impulses.tangent1)
        _note_point(two, at2.v, impulses.normal2, impulses.tangent2)
        v = at.v if impulses.normal1 >= impulses.normal2 else at2.v
        return ImpactPoints(frame, frame2, impulses), -v, LOWERED if used < e else NEWTON
    if at.v >= 0.0:  # it turns away until then
        return ImpactPoints(frame, frame, ImpactImpulses(0.0, 0.0, 0.0, 0.0)), 0.0, NEWTON
    normal, tangent, law = solve_impact(point_response(at, mass), e, mu)
    _note_point(point, at.v, normal, tangent)
    return ImpactPoints(frame, frame, ImpactImpulses(normal, tangent, 0.0, 0.0)), -at.v, law


@inlined
def _meeting_times(
    manifold: Manifold, one: Point, two: Point, motion: Motion, approach: Approach, window: ImpactWindow
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
def _gained(
    v: PairVelocity[float], a: int, b: int, mass: PairInverseMass[float], acting: Acting, t: float
) -> PairVelocity[float]:
    """Return velocities, with what the forces add to them within the time t."""
    if not acting.any or t == 0.0:
        return v
    force, torque, ma, mb = acting.force, acting.torque, t * mass.a, t * mass.b
    return PairVelocity(
        v.ax + ma * force[a, 0], v.ay + ma * force[a, 1], v.wa + t * mass.inertia_a * torque[a],
        v.bx + mb * force[b, 0], v.by + mb * force[b, 1], v.wb + t * mass.inertia_b * torque[b],
    )  # fmt: skip


@always_inlined
def _note(
    manifold: Manifold, points: ImpactPoints, approach: float, old: PairVelocity[float],
    before: PairVelocity[float], after: PairVelocity[float], motion: Motion, mass: PairInverseMass[float],
    t: float, law: int, log: Log, number: int,
) -> None:  # fmt: skip
    """Book an impact that has taken place at the time t from now, and write it to the log if that has length.

    Until then bodies move with their ``old`` speeds; ``before`` and ``after`` are those of the moment.
    """
    a, b, position, angle = manifold.a, manifold.b, motion.position, motion.angle
    pose = Pose(
        position[a, 0] + t * old.ax, position[a, 1] + t * old.ay, angle[a] + t * old.wa,
        position[b, 0] + t * old.bx, position[b, 1] + t * old.by, angle[b] + t * old.wb,
    )  # fmt: skip
    book_impact(log.account, points, pose, before, after, mass, IMPACTS)
    if len(log.impacts) > 0:
        write_impact(
            log.impacts, number, pair_of(manifold), log.time + t, approach, points, pose, before, after, mass,
            law, True,
        )  # fmt: skip


@inlined
def _is_swift(row: int, motion: Motion, shapes: Shapes, inverse: Inverse, acting: Acting, h: float) -> bool:
    """Whether a body moves by more than its inner disc reaches in a substep, and not by its forces alone."""
    x, y, reach = h * motion.linear[row, 0], h * motion.linear[row, 1], INNER_SHARE * shapes.thin[row]
    if acting.any:
        fx, fy = acting.force[row, 0], acting.force[row, 1]
        reach += h * h * inverse.mass[row] * math.sqrt(fx * fx + fy * fy)
    return bool(x * x + y * y > reach * reach)


@inlined
def resolve_at(
    manifold: Manifold, point: Point, frame: ContactFrame[float], t: float, motion: Motion, inverse: Inverse,
    acting: Acting, forced: bool, log: Log, number: int,
) -> int:  # fmt: skip
    """Bounce a pair at the time ``t`` from now, where a ``frame`` says; return how many impacts that was."""
    a, b, since = manifold.a, manifold.b, t if forced else 0.0
    mass, old = inverse_mass_of(inverse, a, b), velocity_of(motion.linear, motion.angular, a, b)
    before = _gained(old, a, b, mass, acting, since)
    at = point_state(frame, before)
    if at.v >= 0.0:
        return 0
    normal, tangent, law = solve_impact(point_response(at, mass), manifold.restitution, manifold.friction)
    _note_point(point, at.v, normal, tangent)
    new = after_impulse_at(old, mass, frame, normal, tangent)
    points = ImpactPoints(frame, frame, ImpactImpulses(normal, tangent, 0.0, 0.0))
    after = _gained(new, a, b, mass, acting, since)
    _note(manifold, points, -at.v, old, before, after, motion, mass, t, law, log, number)
    put_velocity(motion.linear, motion.angular, a, b, new)
    _shift(a, b, old, new, motion, t)
    manifold.impact_count += 1
    return 1


@inlined
def _resolve_pair(
    manifold: Manifold, one: Point, two: Point, motion: Motion, shapes: Shapes, inverse: Inverse,
    acting: Acting, t1: float, t2: float, h: float, forced: bool, moments: Vectors, log: Log, number: int,
) -> tuple[bool, int]:  # fmt: skip
    """Bounce a pair of which one point meets, or both do, at ``t1`` and ``t2`` from now.

    Half-way through leapfrog's substep velocities are those of now, and are ``forced`` until then: normal
    and friction impulses are those for the speeds of the moment. Returns whether it did, and by which law.
    """
    meets_1, meets_2 = abs(t1) < math.inf, abs(t2) < math.inf
    t = min(t1, t2) if meets_1 and meets_2 else (t1 if meets_1 else t2)
    a, b, since = manifold.a, manifold.b, t if forced else 0.0
    mass, old = inverse_mass_of(inverse, a, b), velocity_of(motion.linear, motion.angular, a, b)
    before = _gained(old, a, b, mass, acting, since)
    points, approach, law = _exchange(manifold, one, two, meets_1, meets_2, motion, shapes, mass, before, t)
    met = points.impulses.normal1 + points.impulses.normal2 > 0.0
    if met:
        new = after_impulse_at(old, mass, points.one, points.impulses.normal1, points.impulses.tangent1)
        if meets_1 and meets_2:
            new = after_impulse_at(new, mass, points.two, points.impulses.normal2, points.impulses.tangent2)
        after = _gained(new, a, b, mass, acting, since)
        _note(manifold, points, approach, old, before, after, motion, mass, t, law, log, number)
        put_velocity(motion.linear, motion.angular, a, b, new)
        _shift(a, b, old, new, motion, t)
        for row in (a, b):
            if inverse.mass[row] > 0.0 and _is_swift(row, motion, shapes, inverse, acting, h):
                moments[row, SINCE] = max(moments[row, SINCE], t)
    if manifold.swept == 1 and manifold.restitution > 0.0:
        # Its normal is not that of now: the solver must not push along it.
        one.ahead = two.ahead = 1
    return met, law


@always_inlined
def _forced(
    manifold: Manifold, load: float, motion: Motion, inverse: Inverse, acting: Acting, h: float
) -> tuple[float, float]:
    """Return how B accelerates against A along the normal, and the speed up to which an approach is rest.

    ``load`` is the change of speed [m/s] that the pair's contact made in the last substep: in a pile it is
    not the pair's own weight that presses it together. The solver makes slow approaches of inelastic pairs
    inelastic as well, and all of them at once.
    """
    a, b, linear, force = manifold.a, manifold.b, motion.linear, acting.force
    # An approach must at least exceed rounding.
    speed = abs(linear[a, 0]) + abs(linear[a, 1]) + abs(linear[b, 0]) + abs(linear[b, 1])
    if not acting.any:
        return 0.0, 1e-9 * speed
    ax, ay = force[a, 0] * inverse.mass[a], force[a, 1] * inverse.mass[a]
    bx, by = force[b, 0] * inverse.mass[b], force[b, 1] * inverse.mass[b]
    pull = (bx - ax) * manifold.normal_x + (by - ay) * manifold.normal_y
    pressed = max(-h * pull, load)
    if manifold.restitution == 0.0:
        pressed = h * math.sqrt(max(ax * ax + ay * ay, bx * bx + by * by))
    return pull, 1e-9 * speed + 2.0 * pressed


@inlined
def _list_rows(contacts: Contacts, listed: int, noted: Vectors) -> None:
    """Note the bodies of the pairs from ``listed`` on side by side, and that these are new."""
    for k in range(listed, contacts.number):
        manifold = contacts.manifolds[contacts.touching[k]]
        noted[2 * k, A], noted[2 * k, B] = float(manifold.a), float(manifold.b)
        noted[2 * k, SWEPT] = _NEW


@always_inlined
def _resolve_once(
    contacts: Contacts, motion: Motion, shapes: Shapes, inverse: Inverse, acting: Acting, log: Log,
    logged: int, h: float, window: ImpactWindow, moments: Vectors, noted: Vectors, changed: Numbers,
    sweep: int,
) -> tuple[int, int, int, int, bool]:  # fmt: skip
    """Resolve the pairs one after the other; inelastic ones are resolved once, in their first ``sweep``.

    Pairs of which no body has had an impact since the sweep before are as they were, and passed over.
    Returns how many bounced, how many are left to the solver, how many obeyed Stronge's law, how many had
    their restitution lowered, and whether any may bounce again.
    """
    bounced, left, energetic, lowered, elastic, again = 0, 0, 0, 0, sweep > 0, sweep > 0
    for k in range(contacts.number):
        a, b = int(noted[2 * k, A]), int(noted[2 * k, B])
        if again and max(changed[a], changed[b]) < sweep - 1 and noted[2 * k, SWEPT] == 0.0:
            left += int(noted[2 * k, LEFT_TO_SOLVER])
            continue
        new = noted[2 * k, SWEPT] == _NEW
        noted[2 * k, LEFT_TO_SOLVER], noted[2 * k, SWEPT] = 1.0, 0.0
        p = contacts.touching[k]
        manifold = contacts.manifolds[p]
        if again and manifold.restitution == 0.0 and not new:
            left += 1
            continue
        elastic = elastic or manifold.restitution > 0.0
        # Most pairs rest: these are handled here without a call.
        one, two = contacts.points[2 * p], contacts.points[2 * p + 1]
        if manifold.swept == 1 and one.feature >= FACE:
            noted[2 * k, SWEPT] = 1.0
            if again and max(moments[a, SINCE], moments[b, SINCE]) > -math.inf:  # it is swept again
                one.ahead = two.ahead = 1
                noted[2 * k, LEFT_TO_SOLVER] = 0.0
                continue
        one.ahead = two.ahead = 0
        v = velocity_of(motion.linear, motion.angular, a, b)
        v1, v2 = point_state(frame_of(manifold, one), v).v, 0.0
        overlap, loaded = one.separation < 0.0, one.normal_impulse > 0.0
        if manifold.count == 2:
            v2 = point_state(frame_of(manifold, two), v).v
            overlap, loaded = overlap or two.separation < 0.0, loaded or two.normal_impulse > 0.0
        if v1 >= 0.0 and v2 >= 0.0:
            solved = 1 if acting.any or overlap or loaded else 0
            noted[2 * k, LEFT_TO_SOLVER] = float(solved)
            left += solved
            continue
        load = one.normal_impulse / one.normal_mass
        if manifold.count == 2:
            load = max(load, two.normal_impulse / two.normal_mass)
        pull, resting_speed = _forced(manifold, load, motion, inverse, acting, h)
        if v1 >= -resting_speed - 2.0 * one.bend and v2 >= -resting_speed - 2.0 * two.bend:
            left += 1
            continue
        if window.start >= 0.0:  # in symplectic Euler the forces have acted already
            pull = 0.0
        if manifold.swept == 2 and max(changed[a], changed[b]) < 0.0:
            one.ahead = two.ahead = 1
            noted[2 * k, LEFT_TO_SOLVER] = 0.0
            continue
        t1, t2 = _meeting_times(manifold, one, two, motion, Approach(v1, v2, pull, resting_speed), window)
        if abs(t1) < math.inf or abs(t2) < math.inf:
            met, law = _resolve_pair(
                manifold, one, two, motion, shapes, inverse, acting, t1, t2, h, window.start < 0.0, moments,
                log, logged + bounced,
            )  # fmt: skip
            for row in (a, b):
                if met and (inverse.mass[row] > 0.0 or inverse.inertia[row] > 0.0):
                    changed[row] = float(sweep)
            if manifold.swept == 2 and not met:  # it passes by at its new velocities as well
                one.ahead = two.ahead = 1
            bounced += 1 if met else 0
            manifold.impact_count += 1 if met else 0
            energetic += 1 if law == ENERGETIC else 0
            lowered += 1 if law == LOWERED else 0
        solved = 1 - (min(one.ahead, two.ahead) if manifold.count == 2 else one.ahead)
        noted[2 * k, LEFT_TO_SOLVER] = float(solved)
        left += solved
    return bounced, left, energetic, lowered, elastic


@inlined
def end_impacts(contacts: Contacts, motion: Motion, noted: Vectors, changed: Numbers) -> None:
    """Bring separations up to date, and leave inelastic pairs to the solver whose bodies have had an impact.

    These may meet sooner by now.
    """
    for k in range(contacts.number):
        p = contacts.touching[k]
        hit = max(changed[int(noted[2 * k, A])], changed[int(noted[2 * k, B])]) >= 0.0
        if hit and contacts.manifolds[p].restitution == 0.0:
            contacts.points[2 * p].ahead = contacts.points[2 * p + 1].ahead = 0
    measure_again(contacts, motion)


@always_inlined
def resolve_impacts(
    contacts: Contacts, motion: Motion, shapes: Shapes, inverse: Inverse, acting: Acting, log: Log,
    logged: int, h: float, window: ImpactWindow, moments: Vectors, noted: Vectors, changed: Numbers,
    listed: int, sweep: int,
) -> tuple[int, int, int, int, int]:  # fmt: skip
    """Bounce the pairs that meet in this substep, each at its own time.

    The ``window`` is that of the substep. An impact at the time t takes normal, arms and speeds of that time,
    by :mod:`physicslab.kernels.constraint.impact_law`, and leaves the bodies where they would be had they
    bounced then: exact for constant forces, it keeps energy (e = 1), momentum and angular momentum.

    A pair approaches if it is faster than what presses it together can cause in two substeps: slower pairs
    are in resting contact, which the solver handles. Pairs are resolved one after the other, in order, until
    none meets any more; inelastic ones only once, for the solver removes what is left of their approach.

    In ``moments`` it is noted when swift bodies did (:mod:`physicslab.kernels.solver.meet_again`); ``noted``
    (points, 4) is room, and ``changed`` (rows,) has in which sweep each body had an impact last, negative if
    none. Pairs from ``listed`` on are new since those before were gone through, up to ``sweep``. Impacts go
    into ``log``, from ``logged`` on. Returns how many there were, how many pairs are left to the solver, how
    many impacts obeyed Stronge's law, or had their restitution lowered, as Newton's would have made energy,
    and the next sweep.
    """
    impacts, left, energetic, lowered, last = 0, contacts.number, 0, 0, sweep + _MAX_SWEEPS
    _list_rows(contacts, listed, noted)
    while sweep < last:
        bounced, left, stronge, less, elastic = _resolve_once(
            contacts, motion, shapes, inverse, acting, log, logged + impacts, h, window, moments, noted,
            changed, sweep,
        )  # fmt: skip
        sweep += 1
        impacts += bounced
        energetic += stronge
        lowered += less
        if bounced == 0:
            break
        if not elastic:
            left = contacts.number
            break
    return impacts, left, energetic, lowered, sweep
