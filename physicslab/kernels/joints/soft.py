"""Joints beside soft contacts: impulses that hold bodies together, limit and drive them.

Errors of places are corrected like those of a spring of 60 Hz with twice the critical damping, at most as
fast as substeps can follow (Catto, Soft Constraints, GDC 2011; Solver2D, 2024); impulses of a block of rows
are solved at once (:mod:`physicslab.kernels.joints.blocks`), and with contacts in turn. A limit that is not
reached yet may be approached up to it within the substep. Which limits act and which motors are at their
strongest is found by trying: an impulse beyond its bound is set to it, and the others are solved again.
"""

import math
from typing import NamedTuple

from physicslab.kernels import Numbers, Vectors, always_inlined, inlined
from physicslab.kernels.accounts import ENERGY, HAND, JOINTS, MOTORS, PX, PY, SPIN
from physicslab.kernels.arguments import Acting, Inverse, Motion
from physicslab.kernels.joints.blocks import (
    A_TURN,
    A_X,
    A_Y,
    ACTIVE,
    B_TURN,
    B_X,
    B_Y,
    BEFORE,
    CHANGE,
    DIAGONAL,
    ERROR,
    GIVES,
    NOTED,
    OFF,
    STATE,
    Joints,
    can_move,
    factorise,
    substitute,
)
from physicslab.kernels.joints.terms import TermEnd, measure_term

HOLD, LIMIT, MOTOR = range(3)
"""What a row demands (:class:`physicslab.state.joint_rows.Role`)."""
_FASTEST, _DAMPING, _OF_SUBSTEPS = 60.0, 2.0, 0.25
"""The frequency [Hz] of the correction and its damping ratio; at most that share of the rate of substeps."""
_SETTLED = 1e-10
"""Share of an impulse by which it may still change where sweeps come to their end."""
_TRIALS = 12
"""How often a block is solved again in a sweep, as bounds of impulses turn out to act, or not to."""


class JointSoftness(NamedTuple):
    """The time of a substep [s], the rate of correction [1/s], how soft a dependent row is."""

    h: float
    rate: float
    spring: float


@inlined
def joint_softness(h: float) -> JointSoftness:
    """Return the spring that corrects errors in a substep of ``h`` seconds."""
    omega = 2.0 * math.pi * min(_FASTEST, _OF_SUBSTEPS / h)
    damped = 2.0 * _DAMPING + h * omega
    return JointSoftness(h, omega / damped, 1.0 / (h * omega * damped))


@always_inlined
def _along(joints: Joints, k: int, linear: Vectors, angular: Numbers) -> float:
    """Return the product of the gradient of a term with velocities."""
    a, b, at = joints.a[k], joints.b[k], joints.measured
    at_a = at[k, A_X] * linear[a, 0] + at[k, A_Y] * linear[a, 1] + at[k, A_TURN] * angular[a]
    at_b = at[k, B_X] * linear[b, 0] + at[k, B_Y] * linear[b, 1] + at[k, B_TURN] * angular[b]
    return at_a + at_b  # type: ignore[no-any-return]


@always_inlined
def _speed(joints: Joints, i: int, motion: Motion) -> float:
    """Return how fast the quantity of a row grows [m/s or rad/s]."""
    total, k = 0.0, i
    while k >= 0:
        total += _along(joints, k, motion.linear, motion.angular)
        k = joints.second[i] if k == i else -1
    return total


@always_inlined
def _push(joints: Joints, k: int, motion: Motion, inverse: Inverse, impulse: float) -> None:
    """Change velocities by an impulse at a term."""
    a, b, at = joints.a[k], joints.b[k], joints.measured
    motion.linear[a, 0] += inverse.mass[a] * impulse * at[k, A_X]
    motion.linear[a, 1] += inverse.mass[a] * impulse * at[k, A_Y]
    motion.angular[a] += inverse.inertia[a] * impulse * at[k, A_TURN]
    motion.linear[b, 0] += inverse.mass[b] * impulse * at[k, B_X]
    motion.linear[b, 1] += inverse.mass[b] * impulse * at[k, B_Y]
    motion.angular[b] += inverse.inertia[b] * impulse * at[k, B_TURN]


@always_inlined
def _apply(joints: Joints, i: int, motion: Motion, inverse: Inverse, impulse: float) -> None:
    """Change velocities by an impulse of a row."""
    k = i
    while k >= 0:
        _push(joints, k, motion, inverse, impulse)
        k = joints.second[i] if k == i else -1


@always_inlined
def _end(motion: Motion, body: int, anchors: Vectors, i: int) -> TermEnd:
    """Return a body at an end of a term."""
    position, linear = motion.position, motion.linear
    return TermEnd(
        position[body, 0], position[body, 1], motion.angle[body], linear[body, 0], linear[body, 1],
        motion.angular[body], anchors[i, 0], anchors[i, 1],
    )  # fmt: skip


@always_inlined
def _given(joints: Joints, k: int, inverse: Inverse, acting: Acting) -> float:
    """Return how forces accelerate the measure of a term."""
    at, force, torque, given = joints.measured, acting.force, acting.torque, 0.0
    for end in range(2):
        body = joints.b[k] if end == 1 else joints.a[k]
        if not acting.unkicked[body]:
            pull = at[k, 3 * end] * force[body, 0] + at[k, 3 * end + 1] * force[body, 1]
            given += inverse.mass[body] * pull + inverse.inertia[body] * torque[body] * at[k, 3 * end + 2]
    return given


@inlined
def begin_joints(joints: Joints, motion: Motion, inverse: Inverse, acting: Acting, h: float) -> None:
    """Measure all terms where bodies are, and note speeds and impulses.

    The speeds are less than now by what ``h`` seconds of forces give (:mod:`physicslab.kernels.solver.work`).
    """
    at, scale = joints.measured, joints.scale
    for k in range(len(scale)):
        ends = _end(motion, joints.a[k], joints.anchor_a, k), _end(motion, joints.b[k], joints.anchor_b, k)
        one = measure_term(joints.measure[k], ends[0], ends[1], joints.axis[k, 0], joints.axis[k, 1])
        at[k, A_X], at[k, A_Y], at[k, A_TURN] = scale[k] * one.ax, scale[k] * one.ay, scale[k] * one.turn_a
        at[k, B_X], at[k, B_Y], at[k, B_TURN] = scale[k] * one.bx, scale[k] * one.by, scale[k] * one.turn_b
        at[k, ERROR] = scale[k] * one.value
    for i in range(len(joints.impulse)):
        k, given = joints.second[i], 0.0
        at[i, ERROR] += (at[k, ERROR] if k >= 0 else 0.0) - joints.offset[i]
        k = i if acting.any and h > 0.0 else -1
        while k >= 0:
            given += _given(joints, k, inverse, acting)
            k = joints.second[i] if k == i else -1
        at[i, BEFORE], at[i, NOTED] = _speed(joints, i, motion) - h * given, joints.impulse[i]
        if joints.role[i] != MOTOR:
            off = -at[i, ERROR] if joints.role[i] == LIMIT else abs(at[i, ERROR])
            joints.largest[i] = max(joints.largest[i], off)


@always_inlined
def _bounded(joints: Joints, i: int, impulse: float, h: float) -> float:
    """Return the impulse of a row, which a limit only pushes and a motor has not without bounds."""
    if joints.role[i] == HOLD:
        return impulse
    cap = h * joints.strongest[i]
    return max(0.0 if joints.role[i] == LIMIT else -cap, min(cap, impulse))  # type: ignore[no-any-return]


@inlined
def warm_start_joints(joints: Joints, motion: Motion, inverse: Inverse, scale: float, h: float) -> None:
    """Apply the impulses of the last substep, ``scale`` times as large."""
    for i in range(len(joints.impulse)):
        joints.impulse[i] = _bounded(joints, i, scale * joints.impulse[i], h)
        _apply(joints, i, motion, inverse, joints.impulse[i])


@inlined
def _limit_correction(joints: Joints, first: int, end: int, inverse: Inverse, soft: JointSoftness) -> None:
    """Lessen the errors of a block where correcting them gives bodies more energy than its springs have.

    A straight chain that is too long for its fixed ends can close its gaps by bending alone: the straighter
    it is, the faster its links would have to move, without a bound. What a light link holds may be heavy: its
    spring is as stiff as for the heaviest body of the block.
    """
    at, stored, given, stiffness = joints.measured, 0.0, 0.0, soft.rate / (soft.h * soft.spring)
    lightest, heaviest = 0.0, math.inf
    for n in range(first, end):
        i = joints.order[n]
        corrected = at[i, STATE] == ACTIVE and joints.role[i] != MOTOR and at[i, DIAGONAL] > 0.0
        if not corrected or (joints.role[i] == LIMIT and at[i, ERROR] > 0.0):
            at[i, CHANGE] = 0.0
            continue
        for body in (joints.a[i], joints.b[i]):
            if inverse.mass[body] > 0.0:
                lightest = max(lightest, inverse.mass[body])
                heaviest = min(heaviest, inverse.mass[body])
        at[i, CHANGE] = -soft.rate * at[i, ERROR]
        stored += stiffness * at[i, ERROR] * at[i, ERROR] / at[i, DIAGONAL]
    if stored == 0.0:
        return
    stored *= lightest / heaviest
    substitute(joints, first, end)
    for n in range(first, end):
        given -= soft.rate * at[joints.order[n], ERROR] * at[joints.order[n], CHANGE]
    if given > stored:
        share = math.sqrt(stored / given)
        for n in range(first, end):
            i = joints.order[n]
            if joints.role[i] == HOLD or at[i, ERROR] < 0.0:
                at[i, ERROR] *= share


@inlined
def factorise_joints(joints: Joints, inverse: Inverse, soft: JointSoftness) -> None:
    """Choose the rows that act as far as is known, and factorise all blocks; limit what is corrected."""
    first, at = 0, joints.measured
    for i in range(len(joints.impulse)):
        acts = can_move(joints, i, inverse)
        if joints.role[i] == LIMIT:
            acts = acts and joints.impulse[i] > 0.0
        elif joints.role[i] == MOTOR:
            acts = acts and abs(joints.impulse[i]) < soft.h * joints.strongest[i]
        at[i, STATE] = ACTIVE if acts else OFF
    for block in range(len(joints.ends)):
        factorise(joints, first, joints.ends[block], inverse, soft.spring)
        if soft.rate > 0.0:
            _limit_correction(joints, first, joints.ends[block], inverse, soft)
        first = joints.ends[block]


@always_inlined
def _wanted(joints: Joints, i: int, soft: JointSoftness) -> float:
    """Return how fast the quantity of a row is to grow [m/s or rad/s]."""
    if joints.role[i] == MOTOR:
        return joints.target[i]  # type: ignore[no-any-return]
    error = joints.measured[i, ERROR]
    if joints.role[i] == LIMIT and error > 0.0:
        return -error / soft.h  # type: ignore[no-any-return]
    return -soft.rate * error  # type: ignore[no-any-return]


@always_inlined
def _set_bounds(joints: Joints, first: int, end: int, motion: Motion, inverse: Inverse, h: float) -> bool:
    """Set impulses to their bounds that would go beyond; return whether any was."""
    at, found = joints.measured, False
    for n in range(first, end):
        i = joints.order[n]
        if joints.role[i] == HOLD or at[i, STATE] == OFF:
            continue
        target = joints.impulse[i] + at[i, CHANGE]
        bound = _bounded(joints, i, target, h)
        if bound != target:
            _apply(joints, i, motion, inverse, bound - joints.impulse[i])
            joints.impulse[i], at[i, STATE], found = bound, OFF, True
    return found


@always_inlined
def _free(
    joints: Joints, first: int, end: int, motion: Motion, inverse: Inverse, soft: JointSoftness
) -> bool:
    """Let rows act again whose bound does not hold any more; return whether any does."""
    at, found = joints.measured, False
    for n in range(first, end):
        i = joints.order[n]
        if joints.role[i] == HOLD or at[i, STATE] != OFF:
            continue
        left = _wanted(joints, i, soft) - _speed(joints, i, motion)
        inwards = left > 0.0 if joints.role[i] == LIMIT else left * joints.impulse[i] < 0.0
        if joints.role[i] == MOTOR and joints.impulse[i] == 0.0:
            inwards = left != 0.0 and joints.strongest[i] > 0.0
        if inwards and can_move(joints, i, inverse):
            at[i, STATE], found = ACTIVE, True
    return found


@inlined
def _solve_block(
    joints: Joints, first: int, end: int, motion: Motion, inverse: Inverse, soft: JointSoftness
) -> bool:
    """Solve the rows of a block at once; return whether impulses still change."""
    at, impulse, changed, size, trials = joints.measured, joints.impulse, 0.0, 0.0, 0
    while trials < _TRIALS:
        trials += 1
        for n in range(first, end):
            i = joints.order[n]
            at[i, CHANGE] = 0.0
            if at[i, STATE] == ACTIVE:
                gives = at[i, GIVES] * impulse[i] if soft.rate > 0.0 else 0.0
                at[i, CHANGE] = _wanted(joints, i, soft) - _speed(joints, i, motion) - gives
        substitute(joints, first, end)
        if trials < _TRIALS and _set_bounds(joints, first, end, motion, inverse, soft.h):
            factorise(joints, first, end, inverse, soft.spring)
            changed = 1.0
            continue
        for n in range(first, end):
            i = joints.order[n]
            if at[i, STATE] == ACTIVE:
                before = impulse[i]
                impulse[i] = _bounded(joints, i, before + at[i, CHANGE], soft.h)
                _apply(joints, i, motion, inverse, impulse[i] - before)
                changed += abs(impulse[i] - before)
                size += abs(impulse[i])
        if not _free(joints, first, end, motion, inverse, soft):
            break
        factorise(joints, first, end, inverse, soft.spring)
        changed += size
    return changed > _SETTLED * size


@inlined
def sweep_joints(joints: Joints, motion: Motion, inverse: Inverse, soft: JointSoftness) -> bool:
    """Solve all blocks once; return whether impulses still change."""
    unsettled, first = False, 0
    for block in range(len(joints.ends)):
        loose = _solve_block(joints, first, joints.ends[block], motion, inverse, soft)
        unsettled, first = unsettled or loose, joints.ends[block]
    return unsettled


@inlined
def note_joints(joints: Joints, motion: Motion) -> None:
    """Note speeds and impulses as they are now."""
    at = joints.measured
    for i in range(len(joints.impulse)):
        at[i, BEFORE], at[i, NOTED] = _speed(joints, i, motion), joints.impulse[i]


@inlined
def book_work(joints: Joints, motion: Motion, account: Vectors, whole: bool) -> None:
    """Book the work of the impulses, by the mean of the speeds that were noted and of those now.

    Of the ``whole`` impulses, or of what they have changed by since they were noted.
    """
    at = joints.measured
    for i in range(len(joints.impulse)):
        impulse = joints.impulse[i] - (0.0 if whole else at[i, NOTED])
        cause = MOTORS if joints.role[i] == MOTOR else JOINTS
        account[cause, ENERGY] += 0.5 * impulse * (at[i, BEFORE] + _speed(joints, i, motion))


@inlined
def book_momentum(joints: Joints, motion: Motion, inverse: Inverse, account: Vectors, whole: bool) -> None:
    """Book the momentum that fixed ends give by impulses where bodies are, and the work of what drives these.

    Of the ``whole`` impulses, or of what they have changed by since they were noted.
    """
    position, linear, angular, at = motion.position, motion.linear, motion.angular, joints.measured
    for n in range(2 * len(joints.impulse)):
        i = n // 2
        k = joints.second[i] if n % 2 == 1 else i
        if k < 0:
            continue
        impulse = joints.impulse[i] - (0.0 if whole else at[i, NOTED])
        cause = MOTORS if joints.role[i] == MOTOR else JOINTS
        for end in range(2):
            body = joints.b[k] if end == 1 else joints.a[k]
            px, py, turn = (
                impulse * at[k, 3 * end],
                impulse * at[k, 3 * end + 1],
                impulse * at[k, 3 * end + 2],
            )
            if inverse.mass[body] > 0.0:
                account[cause, PX] += px
                account[cause, PY] += py
                account[cause, SPIN] += position[body, 0] * py - position[body, 1] * px
            else:
                account[HAND, ENERGY] -= px * linear[body, 0] + py * linear[body, 1]
            if inverse.inertia[body] > 0.0:
                account[cause, SPIN] += turn
            else:
                account[HAND, ENERGY] -= turn * angular[body]
