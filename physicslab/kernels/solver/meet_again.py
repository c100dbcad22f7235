"""Bodies that are still swift after an impact are swept again, from then to the end of the substep.

The sweeps of a substep go by the velocities from before its impacts. A body that an impact throws back, or
spins up, may come to another wall within the same substep, or to the same one with its next corner. So pairs
of such bodies are looked at again, the earliest meeting of each body first, until none meets any more. All of
them are once; then, round by round, those of the bodies that the last round has changed.

An impact may throw a body out of its fat box, towards bodies that are not listed as near: pairs are then
listed again first, so that which ones meet goes by places and velocities alone.
"""

import math
from typing import NamedTuple

import numpy as np

from physicslab.kernels import Rows, Vectors, allocating, inlined
from physicslab.kernels.arguments import Acting, Inverse, Log, Materials, Motion, Near
from physicslab.kernels.broad.fat_boxes import all_inside, left
from physicslab.kernels.broad.near_pairs import comes_near, give_record, list_near, merge_tail, rank_of
from physicslab.kernels.constraint.pair import ContactFrame, point_velocity, velocity_of
from physicslab.kernels.geometry.apart import NEXT, SINCE
from physicslab.kernels.geometry.contact import list_touching
from physicslab.kernels.geometry.outline import Way, kept_outline, on_segment
from physicslab.kernels.geometry.pair import sweep_any
from physicslab.kernels.geometry.shapes import Shapes
from physicslab.kernels.geometry.sweep import MISS, is_swift, sweep_circle_circle
from physicslab.kernels.near_counts import LOGGED, PROXIMITY, RECORDED, ROUND, SCALAR
from physicslab.kernels.records import Manifold
from physicslab.kernels.solver.impact import ImpactWindow, resolve_at

_ROUNDS, _OUTLINES, _ELASTIC = 320, 8, 312
"""Largest number of times that pairs are looked at again in a substep; of those, how many times the outlines
of turning ones are, and not their inner discs alone, as a corner may roll on a wall; and how many times
restitution counts: what is left then is caught between walls. A body of 1 kg that one of 10^5 kg drives
against a wall bounces 270 times in a substep."""
_TURNS = 1e-9
"""Turn in a substep [rad] below which no corner rolls."""
_ROUNDING = 1.0 + 1e-9
"""By how many times as large circles no outline passes for rounding."""
_RECORDED = 0xFFFFFFFF
"""In place of the second row of a proximity pair: it has the record whose number is in place of the first."""


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
    x, y = way.dx + since / h * way.ux, way.dy + since / h * way.uy
    reach = _ROUNDING * (shapes.reach[a] + shapes.reach[b])
    if x * x + y * y > reach * reach and sweep_circle_circle(x, y, way.ux, way.uy, reach) == MISS:
        return Meeting(
            math.inf, ContactFrame(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        )  # circles around them do not meet
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
def _note_meeting(
    near: Near, p: int, motion: Motion, shapes: Shapes, h: float, end: float, outlines: bool
) -> bool:
    """Note when a pair meets of which a body has met another before; return whether it does."""
    manifold, moments, noted = near.manifolds[p], near.moments, near.noted
    since = max(moments[manifold.a, SINCE], moments[manifold.b, SINCE])
    if since == -math.inf or manifold.count < 0 or manifold.wall > -1 or since >= end:
        return False
    t, at = _meeting(manifold, since, motion, shapes, near.rotations, h, end, outlines)
    noted[2 * p, 0], noted[2 * p, 1], noted[2 * p, 2] = t, at.nx, at.ny
    noted[2 * p + 1, 0], noted[2 * p + 1, 1] = at.arm_ax, at.arm_ay
    noted[2 * p + 1, 2], noted[2 * p + 1, 3] = at.arm_bx, at.arm_by
    return t < math.inf


@inlined
def _look_at_all(near: Near, motion: Motion, shapes: Shapes, h: float, end: float, outlines: bool) -> int:
    """Write which pairs meet to ``near.touching``, in order; return how many."""
    found = 0
    for number in range(near.counts[SCALAR]):
        p = near.scalar[number]
        if _note_meeting(near, p, motion, shapes, h, end, outlines):
            near.touching[found] = p
            found += 1
    return found


@inlined
def _link(near: Near, inverse: Inverse, first: Rows, links: Rows) -> None:
    """Fill ``links`` with the pairs of each body that can be moved: those of row i begin at ``first[i]``.

    A pair without a record is a negative number: -1 less its place among these.
    """
    counts, manifolds, proximity = near.counts, near.manifolds, near.proximity
    for fills in range(2):  # how many each has, and then which
        for number in range(counts[SCALAR]):
            p = near.scalar[number]
            manifold = manifolds[p]
            if manifold.wall < 0 and manifold.count >= 0:
                for row in (manifold.a, manifold.b):
                    if inverse.mass[row] > 0.0:
                        first[row] += 1 - 2 * fills
                        if fills == 1:
                            links[first[row]] = p
        for k in range(counts[PROXIMITY]):
            for row in (np.int64(proximity[2 * k]), np.int64(proximity[2 * k + 1])):
                if inverse.mass[row] > 0.0:
                    first[row] += 1 - 2 * fills
                    if fills == 1:
                        links[first[row]] = -1 - k
        if fills == 0:
            for i in range(1, len(first)):
                first[i] += first[i - 1]


@inlined
def _bounce_first(
    near: Near, found: int, motion: Motion, materials: Materials, inverse: Inverse, acting: Acting, log: Log,
    elastic: bool, forced: bool, changed: Rows,
) -> tuple[int, int]:  # fmt: skip
    """Bounce those of the ``found`` pairs that are the first to meet for both bodies.

    Returns how many impacts it was, and how many bodies they have ``changed``.
    """
    moments, noted, impacts, many = near.moments, near.noted, 0, 0
    for n in range(found):
        manifold = near.manifolds[near.touching[n]]
        moments[manifold.a, NEXT] = moments[manifold.b, NEXT] = math.inf
    for n in range(found):
        p = near.touching[n]
        manifold = near.manifolds[p]
        for row in (manifold.a, manifold.b):
            if inverse.mass[row] > 0.0:
                moments[row, NEXT] = min(moments[row, NEXT], noted[2 * p, 0])
    for n in range(found):
        p = near.touching[n]
        manifold, t = near.manifolds[p], noted[2 * p, 0]
        a, b = manifold.a, manifold.b
        if t > min(moments[a, NEXT], moments[b, NEXT]):
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
                changed[many] = row
                many += 1
    return impacts, many


@inlined
def _drop_changed(near: Near, found: int) -> int:
    """Drop those of the ``found`` pairs of which a body this round has changed; return how many stay."""
    kept = 0
    for n in range(found):
        p = near.touching[n]
        manifold = near.manifolds[p]
        if min(near.moments[manifold.a, NEXT], near.moments[manifold.b, NEXT]) > -math.inf:
            near.touching[kept] = p
            kept += 1
    return kept


@inlined
def _record_of(near: Near, k: int, motion: Motion, h: float, speculative_margin: float) -> int:
    """Return the record of proximity pair ``k``, which may get one now: -1 if not.

    Where it has one, that stands in its place, until :func:`_close_up` removes it from among the others.
    """
    counts, proximity, position, linear = near.counts, near.proximity, motion.position, motion.linear
    if proximity[2 * k + 1] == _RECORDED:
        return int(proximity[2 * k])
    places, velocities = position.reshape(position.size), linear.reshape(linear.size)
    if not comes_near(proximity, near.activation_distance, k, places, velocities, h, speculative_margin):
        return -1
    p: int = counts[RECORDED]
    give_record(proximity, k, near.manifolds, near.points, p, near.entities)
    proximity[2 * k], proximity[2 * k + 1] = p, _RECORDED
    near.scalar[counts[SCALAR]] = p
    counts[RECORDED], counts[SCALAR] = p + 1, counts[SCALAR] + 1
    return p


@inlined
def _close_up(near: Near) -> None:
    """Remove the proximity pairs that have got records."""
    proximity, kept = near.proximity, 0
    for k in range(near.counts[PROXIMITY]):
        if proximity[2 * k + 1] != _RECORDED:
            proximity[2 * kept], proximity[2 * kept + 1] = proximity[2 * k], proximity[2 * k + 1]
            near.activation_distance[kept] = near.activation_distance[k]
            kept += 1
    near.counts[PROXIMITY] = kept


@inlined
def _put_in(near: Near, p: int, found: int) -> None:
    """Put a pair in its place among the ``found`` ones, in the order of rows."""
    rows, place = len(near.entities), found
    rank = rank_of(near.manifolds, p, rows)
    while place > 0 and rank_of(near.manifolds, near.touching[place - 1], rows) > rank:
        near.touching[place] = near.touching[place - 1]
        place -= 1
    near.touching[place] = p


@allocating
def _bounce_in_rounds(
    near: Near, found: int, motion: Motion, shapes: Shapes, materials: Materials, inverse: Inverse,
    acting: Acting, fat: Vectors, log: Log, h: float, window: ImpactWindow, speculative_margin: float,
) -> tuple[int, bool]:  # fmt: skip
    """Bounce the ``found`` pairs and those that meet after them, the first of each body in each round.

    After a round only pairs of bodies that it has changed are looked at. Returns how many impacts there were,
    and whether it ended because a body has left its fat box.
    """
    counts, moments, impacts, left_box = near.counts, near.moments, 0, False
    rows, recorded, listed = len(motion.angle), counts[RECORDED], counts[SCALAR]
    first = np.zeros(rows + 1, np.int64)
    links = np.empty(2 * (counts[SCALAR] + counts[PROXIMITY]), np.int64)
    changed = np.empty(rows, np.int64)
    _link(near, inverse, first, links)
    for i in range(rows):
        moments[i, NEXT] = math.inf
    while found > 0:
        rounds = counts[ROUND] - 1
        came, many = _bounce_first(
            near, found, motion, materials, inverse, acting, log, rounds < _ELASTIC, window.start < 0.0,
            changed,
        )  # fmt: skip
        impacts += came
        counts[LOGGED] += came if len(log.impacts) > 0 else 0
        rounds += 1
        counts[ROUND] = rounds + 1
        found = _drop_changed(near, found)
        for n in range(many):
            left_box |= fat.shape[1] > 0 and left(changed[n], motion, shapes, fat, h, 0.0, speculative_margin)
        if left_box or rounds == _ROUNDS:
            break
        for n in range(many):
            row = changed[n]
            for link in range(first[row], first[row + 1]):
                p = links[link]
                if p < 0:
                    p = _record_of(near, -1 - p, motion, h, speculative_margin)
                if p < 0 or (row == near.manifolds[p].b and moments[near.manifolds[p].a, NEXT] == -math.inf):
                    continue  # the other body is changed, too
                if _note_meeting(near, p, motion, shapes, h, window.end, rounds < _OUTLINES):
                    _put_in(near, p, found)
                    found += 1
        for n in range(many):
            moments[changed[n], NEXT] = math.inf
        if rounds == _OUTLINES:
            merge_tail(near.manifolds, near.scalar, listed, counts[SCALAR], rows)
            listed = counts[SCALAR]
            found = _look_at_all(near, motion, shapes, h, window.end, False)
    merge_tail(near.manifolds, near.scalar, listed, counts[SCALAR], rows)
    if counts[RECORDED] > recorded:
        _close_up(near)
    return impacts, left_box


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
    counts, moments, impacts, goes_on = near.counts, near.moments, 0, False
    list_near(near, motion, h, speculative_margin)
    rounds, found = counts[ROUND] - 1, 0
    if rounds < _ROUNDS:
        found = _look_at_all(near, motion, shapes, h, window.end, rounds < _OUTLINES)
    if found > 0:
        impacts, goes_on = _bounce_in_rounds(
            near, found, motion, shapes, materials, inverse, acting, fat, log, h, window, speculative_margin
        )
    if not goes_on:
        if counts[ROUND] > 1:
            _leave_to_solver(near)
        counts[ROUND] = 0
        for i in range(len(moments)):
            moments[i, SINCE] = -math.inf
    list_touching(near, inverse)
    return impacts
