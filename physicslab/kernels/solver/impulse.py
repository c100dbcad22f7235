"""Impulses that keep resting bodies apart, and friction between sliding ones."""

import math

from physicslab.kernels import Rows, always_inlined, inlined, inlined_by_numba, kernel
from physicslab.kernels.arguments import Acting, Contacts, Inverse, Motion, Near, Softness
from physicslab.kernels.constraint.pair import frame_of, point_state, velocity_of
from physicslab.kernels.constraint.stirred import stirred_in
from physicslab.kernels.joints.blocks import Joints
from physicslab.kernels.joints.soft import (
    JointSoftness,
    begin_joints,
    book_momentum,
    book_work,
    factorise_joints,
    joint_softness,
    note_joints,
    sweep_joints,
    warm_start_joints,
)
from physicslab.kernels.near_counts import ACTIVE, WIDE_COUNT
from physicslab.kernels.records import Manifolds, Points
from physicslab.kernels.solver.constraints import Constraints, constrain, keep_impulses, stretch, warm_start
from physicslab.kernels.solver.sweep import sweep
from physicslab.kernels.solver.work import book_relaxed, book_solved, take_means
from physicslab.kernels.wide.solve import SoftConstraint, sweep_wide, warm_start_wide

MAX_SWEEPS = 16
"""Sweeps of a substep over few contacts: with a spring as stiff as they carry, cubes of 2 cm stand."""
_STIFFENED = 8
"""Sweeps up to which contacts become stiffer faster than sweeps become more."""
_CONTACT_SWEEPS = 512
"""Contacts times sweeps of a substep, where the number of sweeps is not set."""
_LEAST_SWEEPS = 2
"""Sweeps of a crowd: with one alone what lies at the bottom of a heap sinks 2.4 times as deep."""
LOADED_SWEEPS = 4
"""Sweeps of a crowd some of whose bodies are far heavier than others."""
_GIVE = 0.5
"""Share of an impulse beyond that of all forces that a deep overlap gives up in a sweep."""
HEAVY_RATIO = 10.0
"""Ratio of masses from which the lighter body of a pair may have to carry many times its weight."""
MAX_SUBSTEP_FACTOR = 16
"""Largest factor by which substeps are increased for such a pair."""


@inlined
def sweeps_of(near: Near, rows: int, iterations: int, loaded: bool) -> int:
    """Return how many sweeps a substep makes at most: ``iterations``, or by the number of contacts if 0.

    So many ``rows`` of joints are solved with them. A few are solved nearly to the end, for little more time;
    a crowd is swept twice, or some times where bodies may be ``loaded`` with far heavier ones.
    """
    if iterations > 0:
        return iterations
    number = near.counts[ACTIVE] + near.counts[WIDE_COUNT] + rows
    least = LOADED_SWEEPS if loaded else _LEAST_SWEEPS
    sweeps: int = max(least, min(MAX_SWEEPS, _CONTACT_SWEEPS // max(number, 1)))
    return sweeps


@inlined
def stiffened(sweeps: int) -> float:
    """Return how many times as stiff a contact spring so many sweeps carry as a single one does.

    Their number to the power of 5/4; beyond :data:`_STIFFENED` in proportion, as a stiffer one would feed the
    swaying of towers.
    """
    return sweeps * math.sqrt(math.sqrt(min(sweeps, _STIFFENED)))


@inlined
def pushed(sweeps: int) -> float:
    """Return the share of the push of :class:`Softness` that so many sweeps make.

    Their spring is as much stiffer, so that bodies sink as deep. Few sweeps take little of the push out of
    velocities again, and what they leave makes tall heaps heave.
    """
    return math.sqrt(min(sweeps, LOADED_SWEEPS) / LOADED_SWEEPS)


@always_inlined
def _soft_constraint(
    softness: Softness, acting: Acting, h: float, sweeps: int, sunk: float
) -> SoftConstraint:
    """Return the contact spring of :class:`Softness`, integrated implicitly over h.

    (Catto, Soft Constraints, GDC 2011.) More ``sweeps`` carry a stiffer spring (:func:`stiffened`), and push
    faster (:func:`pushed`).
    """
    force_cap = 0.0
    if acting.any:
        force = acting.force
        for i in range(len(force)):
            force_cap += h * math.sqrt(force[i, 0] * force[i, 0] + force[i, 1] * force[i, 1])
    share = pushed(sweeps)
    stiffness = softness.stiffness * stiffened(sweeps) / share
    return SoftConstraint(
        1.0 / h,
        softness.push * share / h,
        stiffness / (1.0 + stiffness),
        1.0 / (1.0 + stiffness),
        force_cap,
        _GIVE,
        sunk,
    )


@inlined_by_numba
def _of(contacts: Contacts, near: Near) -> Constraints:
    """Return the constraints of contacts."""
    return Constraints(near.constraints, near.constraint_points, contacts.number)


@always_inlined
def solve(
    contacts: Contacts, near: Near, joints: Joints, motion: Motion, inverse: Inverse, acting: Acting,
    softness: Softness, h: float, warm_start_scale: float, sweeps: int, sunk: float,
) -> None:  # fmt: skip
    """Start from the last substep's impulses, then go through all contacts, correcting overlap.

    ``warm_start_scale`` is the ratio of this substep to the last one: the impulses of resting contacts grow
    by that factor. No load presses a body in by more than ``sunk``, a share of its size. Work of those of
    contacts is booked by :func:`relax`, where points are looked at again.
    """
    joined, loose, stiff = len(joints.impulse) > 0, False, joint_softness(h)
    if joined:
        begin_joints(joints, motion, near.rotations, inverse, acting, h)
        warm_start_joints(joints, motion, inverse, warm_start_scale, h)
        factorise_joints(joints, inverse, stiff)
    constraints, soft = _of(contacts, near), _soft_constraint(softness, acting, h, sweeps, sunk)
    constrain(contacts, constraints, inverse, warm_start_scale)
    stretch(contacts, constraints, soft)
    warm_start(constraints, motion)
    crowd = near.counts[WIDE_COUNT] > 0
    if crowd:
        warm_start_wide(near, motion, warm_start_scale)
    for n in range(sweeps):
        stirred = stirred_in(n, near.stirred, crowd)
        if joined:
            loose = sweep_joints(joints, motion, inverse, stiff, stirred)
        unsettled, _, _ = sweep(constraints, motion, soft, stirred, False)
        if crowd:
            sweep_wide(near, motion, 0.0, soft, False)
        elif not (unsettled or loose):
            break
    keep_impulses(contacts, constraints)
    if joined:
        book_work(joints, motion, near.account, True)
        book_momentum(joints, motion, inverse, near.account, True)


@always_inlined
def follow_drift(contacts: Contacts, motion: Motion, h: float) -> None:
    """Bring separations up to date for a drift of h at the present velocities."""
    for k in range(contacts.number):
        p = contacts.touching[k]
        manifold = contacts.manifolds[p]
        v = velocity_of(motion.linear, motion.angular, manifold.a, manifold.b)
        for j in range(2 * p, 2 * p + manifold.count):
            point = contacts.points[j]
            point.separation += h * point_state(frame_of(manifold, point), v).v


@inlined
def measure_again(contacts: Contacts, motion: Motion) -> None:
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


@always_inlined
def relax(
    contacts: Contacts, near: Near, joints: Joints, motion: Motion, inverse: Inverse, acting: Acting,
    h: float, half: float, sweeps: int,
) -> tuple[float, float]:  # fmt: skip
    """Go through all contacts without correction, so that pushing bodies apart leaves no velocity behind.

    ``h`` is the time that bodies have moved since :func:`solve`, and the time until its next call, ``half``
    that of half a substep. Returns the work of normal and of tangential impulses [J], of those found there
    and here: each by the mean velocity of before and after all of them, or in a crowd, which has too many
    points to look at again, of before and after itself.
    """
    constraints = _of(contacts, near)
    pressed, friction_work = book_solved(contacts, constraints, near, motion, inverse, acting, h, half)
    crowd = near.counts[WIDE_COUNT] > 0
    if crowd:
        take_means(near, motion)
    rigid, drift = SoftConstraint(1.0 / h, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0), h
    stretch(contacts, constraints, rigid)
    joined, loose, stiff = len(joints.impulse) > 0, False, JointSoftness(h, 0.0, 1.0)
    if joined:
        begin_joints(joints, motion, near.rotations, inverse, acting, 0.0)
        factorise_joints(joints, inverse, stiff)
    for n in range(sweeps):
        stirred = stirred_in(n, near.stirred, crowd)
        if joined:
            if crowd and n > 0:
                note_joints(joints, motion)
            loose = sweep_joints(joints, motion, inverse, stiff, stirred)
            if crowd:
                book_work(joints, motion, near.account, False)
                book_momentum(joints, motion, inverse, near.account, False)
        unsettled, push, rub = sweep(constraints, motion, rigid, stirred, crowd)
        pressed, friction_work = pressed + push, friction_work + rub
        if crowd:
            push, rub = sweep_wide(near, motion, drift, rigid, True)
            pressed, friction_work, drift = pressed + push, friction_work + rub, 0.0
        elif not (unsettled or loose):
            break
    keep_impulses(contacts, constraints)
    push, rub = book_relaxed(constraints, near, motion, inverse)
    if joined and not crowd:
        book_work(joints, motion, near.account, False)
        book_momentum(joints, motion, inverse, near.account, False)
    if not crowd:
        pressed, friction_work = pressed + push, friction_work + rub
    return pressed, friction_work


@kernel
def deepest(manifolds: Manifolds, points: Points, touching: Rows, count: int) -> float:
    """Return the deepest overlap of all contacts [m]."""
    depth = 0.0
    for k in range(count):
        p = touching[k]
        for j in range(2 * p, 2 * p + manifolds[p].count):
            depth = max(depth, -points[j].separation)
    return depth
