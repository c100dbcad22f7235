"""The stages of a substep at contacts, which :mod:`physicslab.kernels.solver.soft` goes through."""

import math

from physicslab.kernels import Vectors, always_inlined, inlined_by_numba
from physicslab.kernels.arguments import (
    Acting,
    Bounds,
    Contacts,
    Inverse,
    Log,
    Materials,
    Motion,
    Near,
    Softness,
)
from physicslab.kernels.broad.near_pairs import list_near
from physicslab.kernels.geometry.apart import note_motion
from physicslab.kernels.geometry.contact import AFTER_IMPACTS, GOES_ON, find_contacts
from physicslab.kernels.geometry.shapes import Shapes
from physicslab.kernels.joints.blocks import Joints
from physicslab.kernels.near_counts import (
    ACTIVE,
    ENERGETIC,
    LEFT,
    LOGGED,
    LOWERED,
    ROUND,
    SCALAR,
    UNORDERED,
    WIDE_COUNT,
)
from physicslab.kernels.solver import impulse
from physicslab.kernels.solver.finer import SUNK, UNLIMITED
from physicslab.kernels.solver.impact import ImpactWindow, end_impacts, resolve_impacts
from physicslab.kernels.solver.meet_again import any_swift, meet_again
from physicslab.kernels.solver.separate import any_deep, separate
from physicslab.kernels.solver.work import book_slots, book_work_of_contacts, note_velocities
from physicslab.kernels.wide.refresh import refresh
from physicslab.kernels.wide.slots import wake


@inlined_by_numba
def _contacts(near: Near) -> Contacts:
    """Return the scalar pairs that touch now."""
    return Contacts(near.manifolds, near.points, near.touching, near.counts[ACTIVE])


@inlined_by_numba
def _solved(near: Near) -> Contacts:
    """Return the scalar pairs that impulses act at in this substep: none where all are left to impacts."""
    number = near.counts[ACTIVE] if near.counts[LEFT] + near.counts[WIDE_COUNT] > 0 else 0
    return Contacts(near.manifolds, near.points, near.touching, number)


@always_inlined
def find_touching(
    near: Near, motion: Motion, shapes: Shapes, materials: Materials, inverse: Inverse, bounds: Bounds,
    when: int, h: float, start: float, speculative_margin: float, substeps: int,
) -> None:  # fmt: skip
    """Find where wide contacts touch now, activate proximity pairs, then find where scalar ones touch.

    The substep spans ``h`` seconds from ``start`` h before or after now, and is one of so many ``substeps``
    of a step: ``when`` in it is that of :func:`find_contacts`. ``speculative_margin`` is how far [m] the
    forces may bring two bodies together within it.
    """
    counts, first, rest = near.counts, when <= GOES_ON, 0.0
    if counts[WIDE_COUNT] > 0:
        rest = substeps - 1.0 if first else 0.0  # of wide contacts points are found once a step
        before = counts[SCALAR]
        for slots in (near.discs, near.boxes):
            refresh(slots, near, motion, shapes, inverse, bounds, first, h, start, speculative_margin, rest)
        came = counts[SCALAR] - before
        counts[WIDE_COUNT] -= came
        if came > 0:
            counts[UNORDERED] = 1
    list_near(near, motion, h, speculative_margin)
    counts[ACTIVE] = find_contacts(
        near, counts[SCALAR], motion, shapes, materials, inverse, bounds, when, h, start, speculative_margin,
        rest, 0.0,
    )  # fmt: skip


@always_inlined
def resolve_all_impacts(
    near: Near, motion: Motion, shapes: Shapes, materials: Materials, inverse: Inverse, acting: Acting,
    bounds: Bounds, log: Log, h: float, start: float, end: float, speculative_margin: float,
) -> int:  # fmt: skip
    """Bounce what meets between ``start`` and ``end`` [s] from now; return how many impacts there were.

    Wide contacts that this wakes take part, and so do pairs that it throws together. ``ROUND`` is 1 where a
    body is still swift after one.
    """
    counts, changed, impacts, listed, sweep = near.counts, near.angular_before, 0, 0, 0
    counts[LEFT] = 0
    # Without forces there are no piles.
    window = ImpactWindow(start, end, start - 2.0 * (end - start) if acting.any else -math.inf)
    for i in range(len(changed)):
        changed[i] = -1.0
    if counts[ACTIVE] > 0:
        note_motion(near.moments, motion)
    while counts[ACTIVE] > listed:
        begun = float(sweep)
        came, counts[LEFT], energetic, lowered, sweep = resolve_impacts(
            _contacts(near), motion, shapes, inverse, acting, log, counts[LOGGED], h, window, near.moments,
            near.noted, changed, listed, sweep,
        )  # fmt: skip
        impacts += came
        counts[ENERGETIC] += energetic
        counts[LOWERED] += lowered
        counts[LOGGED] += came if len(log.impacts) > 0 else 0
        listed = counts[ACTIVE]
        if came > 0 and counts[WIDE_COUNT] > 0:
            for slots in (near.discs, near.boxes):
                wake(slots, near, motion, acting, inverse, h)
            counts[WIDE_COUNT] -= counts[ACTIVE] - listed
            counts[UNORDERED] = 1 if counts[ACTIVE] > listed else counts[UNORDERED]
        if came > 0:
            counts[ACTIVE] = find_contacts(
                near, counts[SCALAR], motion, shapes, materials, inverse, bounds, AFTER_IMPACTS, h, start / h,
                speculative_margin, 0.0, begun,
            )  # fmt: skip
    if impacts > 0:
        end_impacts(_contacts(near), motion, near.noted, changed)
    if listed > 0 and counts[LEFT] == 0:
        impulse.follow_drift(_contacts(near), motion, end)
    counts[ROUND] = 1 if impacts > 0 and any_swift(near.moments) else 0
    return impacts


@always_inlined
def resolve_later_impacts(
    near: Near, motion: Motion, shapes: Shapes, materials: Materials, inverse: Inverse, acting: Acting,
    fat: Vectors, log: Log, h: float, start: float, end: float, speculative_margin: float,
) -> int:  # fmt: skip
    """Bounce what is still swift after those impacts, until pairs must be listed again for it."""
    if near.counts[ROUND] == 0:
        return 0
    window = ImpactWindow(start, end, start)
    impacts = meet_again(
        near, motion, shapes, materials, inverse, acting, fat, log, h, window, speculative_margin
    )
    if near.counts[ROUND] == 0:  # once: each time it rounds
        impulse.measure_again(_contacts(near), motion)
    return impacts


@always_inlined
def press(
    near: Near, joints: Joints, motion: Motion, inverse: Inverse, acting: Acting, softness: Softness,
    h: float, impulse_dt: float, iterations: int, loaded: bool,
) -> float:  # fmt: skip
    """Find the impulses that keep bodies apart and joints together, and correct some of the error.

    ``impulse_dt`` is the time [s] over which the impulses act; returns the new one. Bodies may be ``loaded``
    with far heavier ones.
    """
    if near.counts[LEFT] + near.counts[WIDE_COUNT] + len(joints.impulse) == 0:
        return impulse_dt
    # Limited: the impulses of a very short time are mostly rounding, which must not be magnified.
    scale = h / max(impulse_dt, h / impulse.MAX_SUBSTEP_FACTOR) if impulse_dt > 0.0 else 1.0
    sweeps = impulse.sweeps_of(near, len(joints.impulse), iterations, loaded)
    contacts = _solved(near)
    note_velocities(contacts, near, motion, inverse, acting, h)
    sunk = SUNK if loaded and sweeps <= impulse.LOADED_SWEEPS else UNLIMITED
    impulse.solve(contacts, near, joints, motion, inverse, acting, softness, h, scale, sweeps, sunk)
    if near.counts[WIDE_COUNT] > 0:
        book_slots(near, motion, inverse, acting, 0.0, True)
    return h


@always_inlined
def relax(
    near: Near, joints: Joints, motion: Motion, shapes: Shapes, inverse: Inverse, acting: Acting,
    softness: Softness, h: float, half: float, iterations: int, loaded: bool,
) -> None:  # fmt: skip
    """Remove the velocity that came from correcting errors, ``h`` seconds after :func:`press`.

    ``half`` is half of the substep [s]. The work of all impulses is booked.
    """
    if near.counts[LEFT] + near.counts[WIDE_COUNT] + len(joints.impulse) == 0:
        return
    contacts = _solved(near)
    sweeps = impulse.sweeps_of(near, len(joints.impulse), iterations, loaded)
    pressed, friction_work = impulse.relax(contacts, near, joints, motion, inverse, acting, h, half, sweeps)
    if near.counts[WIDE_COUNT] > 0:
        push, rub = book_slots(near, motion, inverse, acting, half, False)
        pressed, friction_work = pressed - push, friction_work - rub
    book_work_of_contacts(near, pressed, friction_work)
    if any_deep(contacts, near):  # to count references to all these arrays takes as long as ten contacts
        separate(contacts, near, motion, shapes.reach, inverse.mass, acting, softness.max_push)
