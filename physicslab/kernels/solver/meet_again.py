"""Bodies that are still swift after an impact are swept again, from then to the end of the substep.

The sweeps of a substep go by the velocities from before its impacts. A body that an impact throws back, or
spins up, may come to another wall within the same substep, or to the same one with its next corner. So pairs
of such bodies are looked at again, the earliest meeting of each body first, until none meets any more.

An impact may throw a body out of its fat box, towards bodies that are not listed as near: pairs are then
listed again first, so that which ones meet goes by places and velocities alone.
"""

import math
from typing import NamedTuple

from physicslab.kernels import Vectors, inlined
from physicslab.kernels.arguments import Acting, Inverse, Log, Materials, Motion, Near
from physicslab.kernels.broad.fat_boxes import all_inside
from physicslab.kernels.broad.near_pairs import activate, sort_scalar
from physicslab.kernels.constraint.pair import ContactFrame, point_velocity, velocity_of
from physicslab.kernels.geometry.contact import list_touching
from physicslab.kernels.geometry.outline import Way, kept_outline, on_segment
from physicslab.kernels.geometry.pair import sweep_any
from physicslab.kernels.geometry.shapes import Shapes
from physicslab.kernels.geometry.sweep import is_swift
from physicslab.kernels.near_counts import ACTIVE, LOGGED, PROXIMITY, RECORDED, ROUND, SCALAR, UNORDERED
from physicslab.kernels.records import Manifold
from physicslab.kernels.solver.impact import ImpactWindow, resolve_at

_ROUNDS, _OUTLINES, _ELASTIC = 320, 8, 312
"""Largest number of times that pairs are looked at again in a substep; of those, how many times the outlines
of turning ones are, and not their inner discs alone, as a corner may roll on a wall; and how many times
restitution counts: what is left then is caught between walls. A body of 1 kg that one of 10^5 kg drives
against a wall bounces 270 times in a substep."""
_TURNS = 1e-9
"""Turn in a substep [rad] below which no corner rolls."""
SINCE, NEXT = range(2)
"""The columns of ``Near.moments``."""


@inlined
def any_swift(moments: Vectors) -> bool:
    """Whether a swift body has had an impact in this substep."""
    latest = -math.inf
    for i in range(len(moments)):
        latest = max(latest, moments[i, SINCE])
    return latest > -math.inf


@inlined
def is_outdated(
    near: Near, motion: Motion, shapes: Shapes, fat: Vectors, h: float, speculative_margin: float
) -> bool:
    """Whether pairs are to be listed again before what is still swift meets others.

    Not where no fat boxes are given: a system of one's own lists pairs, or acts between the impacts.
    """
    given = near.counts[ROUND] > 0 and fat.shape[1] > 0
    return given and not all_inside(motion, shapes, fat, h, speculative_margin)


class Meeting(NamedTuple):
    """When a pair meets [s from now]; the normal and the arms of that moment."""

    time: float
    at: ContactFrame[float]


@inlined
def _meeting(
    manifold: Manifold,
    since: float,
    motion: Motion,
    shapes: Shapes,
    rotations: Vectors,
    h: float,
    end: float,
    outlines: bool,
) -> Meeting:
    """Return when a pair meets after the time ``since`` from now; infinity if not until ``end``."""
    a, b, position, linear, angular = manifold.a, manifold.b, motion.position, motion.linear, motion.angular
    way = Way(
        position[b, 0] - position[a, 0], position[b, 1] - position[a, 1],
        (linear[b, 0] - linear[a, 0]) * h, (linear[b, 1] - linear[a, 1]) * h,
    )  # fmt: skip
    outline_a = on_segment(kept_outline(a, motion.angle, shapes, rotations), manifold.wall)
    outline_b = on_segment(kept_outline(b, motion.angle, shapes, rotations), manifold.wall)
    if not is_swift(way, 0.0, outline_a, outline_b):
        return Meeting(math.inf, ContactFrame(0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    turn_a, turn_b = h * angular[a], h * angular[b]
    rolls = abs(turn_a) + abs(turn_b) > _TURNS
    share, place, found = sweep_any(
        way, turn_a, turn_b, since / h, outline_a, outline_b, shapes.pool, outlines or not rolls
    )
    x, y = found.one.x, found.one.y
    at = ContactFrame(found.nx, found.ny, x, y, x - place.dx, y - place.dy)
    t = since + share * h
    if share > 1.0 or t > end:
        return Meeting(math.inf, at)
    vx, vy = point_velocity(at, velocity_of(linear, angular, a, b))
    return Meeting(t if vx * at.nx + vy * at.ny < 0.0 else math.inf, at)


@inlined
def _forget_changed(near: Near, end: float, known: int) -> None:
    """Forget when those pairs meet that have come, or of which a body has had an impact in the last round.

    All are kept in the first ``known`` records. Those that cannot meet do so at infinity.
    """
    moments, noted = near.moments, near.noted
    for number in range(near.counts[SCALAR]):
        p = near.scalar[number]
        manifold = near.manifolds[p]
        a, b = manifold.a, manifold.b
        since = max(moments[a, SINCE], moments[b, SINCE])
        if since == -math.inf or manifold.count < 0 or manifold.wall > -1 or since >= end:
            noted[2 * p, 0] = math.inf
        elif p >= known or min(moments[a, NEXT], moments[b, NEXT]) == -math.inf:
            noted[2 * p, 0] = math.nan
    for i in range(len(moments)):
        moments[i, NEXT] = math.inf


@inlined
def _note_meetings(
    near: Near, motion: Motion, shapes: Shapes, inverse: Inverse, h: float, end: float, outlines: bool,
    known: int,
) -> bool:  # fmt: skip
    """Note when pairs of bodies that have met before meet again, and when each body first does so.

    It is known of those in the first ``known`` records, where no impact has changed their motion.
    """
    manifolds, moments, noted, any_meets = near.manifolds, near.moments, near.noted, False
    _forget_changed(near, end, known)
    for number in range(near.counts[SCALAR]):
        p = near.scalar[number]
        t = noted[2 * p, 0]
        if t == math.inf:
            continue
        manifold = manifolds[p]
        a, b = manifold.a, manifold.b
        if math.isnan(t):
            since = max(moments[a, SINCE], moments[b, SINCE])
            t, at = _meeting(manifold, since, motion, shapes, near.rotations, h, end, outlines)
            noted[2 * p, 0], noted[2 * p, 1], noted[2 * p, 2] = t, at.nx, at.ny
            noted[2 * p + 1, 0], noted[2 * p + 1, 1] = at.arm_ax, at.arm_ay
            noted[2 * p + 1, 2], noted[2 * p + 1, 3] = at.arm_bx, at.arm_by
            if t == math.inf:
                continue
        any_meets = True
        for row in (a, b):
            if inverse.mass[row] > 0.0:
                moments[row, NEXT] = min(moments[row, NEXT], t)
    return any_meets


@inlined
def _list_near(near: Near, motion: Motion, h: float, speculative_margin: float) -> None:
    """Give records to the pairs that bodies which have had an impact may make at their velocities of now."""
    counts = near.counts
    counts[PROXIMITY], counts[RECORDED], counts[SCALAR] = activate(
        near.proximity, near.activation_distance, counts[PROXIMITY], near.manifolds, near.points,
        counts[RECORDED], near.scalar, counts[SCALAR], near.entities, motion.position, motion.linear, h,
        speculative_margin, near.touching[counts[ACTIVE] :],
    )  # fmt: skip


@inlined
def _bounce_first(
    near: Near, motion: Motion, materials: Materials, inverse: Inverse, acting: Acting, log: Log,
    elastic: bool, forced: bool,
) -> int:  # fmt: skip
    """Bounce those noted pairs that are the first to meet for both bodies; return how many impacts it was."""
    moments, noted, impacts = near.moments, near.noted, 0
    for number in range(near.counts[SCALAR]):
        p = near.scalar[number]
        manifold, t = near.manifolds[p], noted[2 * p, 0]
        a, b = manifold.a, manifold.b
        if t == math.inf or t > min(moments[a, NEXT], moments[b, NEXT]):
            continue
        at = ContactFrame(
            noted[2 * p, 1], noted[2 * p, 2], noted[2 * p + 1, 0], noted[2 * p + 1, 1],
            noted[2 * p + 1, 2], noted[2 * p + 1, 3],
        )  # fmt: skip
        e = min(materials.restitution[a], materials.restitution[b]) if elastic else 0.0
        mu = math.sqrt(materials.friction[a] * materials.friction[b])
        manifold.restitution, manifold.friction = e, mu
        near.apart[p].clearance = -math.inf  # it is looked at when the next step begins
        impacts += resolve_at(
            manifold, near.points[2 * p], at, t, motion, inverse, acting, forced, log,
            near.counts[LOGGED] + impacts,
        )  # fmt: skip
        for row in (a, b):
            if inverse.mass[row] > 0.0:
                moments[row, SINCE], moments[row, NEXT] = t, -math.inf  # no second one in this round
    return impacts


@inlined
def _leave_to_solver(near: Near) -> None:
    """Let the solver not push along normals of other moments."""
    moments = near.moments
    for number in range(near.counts[SCALAR]):
        p = near.scalar[number]
        manifold = near.manifolds[p]
        if manifold.swept == 1 and max(moments[manifold.a, SINCE], moments[manifold.b, SINCE]) > -math.inf:
            near.points[2 * p].ahead = near.points[2 * p + 1].ahead = 1


@inlined
def meet_again(
    near: Near, motion: Motion, shapes: Shapes, materials: Materials, inverse: Inverse, acting: Acting,
    fat: Vectors, log: Log, h: float, window: ImpactWindow, speculative_margin: float,
) -> int:  # fmt: skip
    """Bounce what meets another time in the substep after an impact; return how many impacts there were.

    It ends after the last round, and ``ROUND`` is 0 then, or before the one to which pairs are to be listed
    again, since an impact has thrown a body out of its fat box.
    """
    counts, moments, impacts, known = near.counts, near.moments, 0, 0
    if counts[UNORDERED] != 0:
        sort_scalar(near.manifolds, near.scalar, counts[SCALAR], len(motion.angle))
        counts[UNORDERED] = 0
    list_touching(near, inverse)
    while counts[ROUND] > 0:
        _list_near(near, motion, h, speculative_margin)
        rounds = counts[ROUND] - 1
        more = rounds < _ROUNDS and _note_meetings(
            near, motion, shapes, inverse, h, window.end, rounds < _OUTLINES, known
        )
        known = counts[RECORDED] if rounds + 1 != _OUTLINES else 0
        if more:
            came = _bounce_first(
                near, motion, materials, inverse, acting, log, rounds < _ELASTIC, window.start < 0.0
            )
            impacts += came
            counts[LOGGED] += came if len(log.impacts) > 0 else 0
            counts[ROUND] += 1
            if is_outdated(near, motion, shapes, fat, h, speculative_margin):
                break
        else:
            if rounds > 0:
                _leave_to_solver(near)
            counts[ROUND] = 0
            for i in range(len(moments)):
                moments[i, SINCE] = -math.inf
    return impacts
