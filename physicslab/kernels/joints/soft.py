"""Joints beside soft contacts: impulses that hold bodies together, limit and drive them.

Errors of places are corrected like those of a spring of 60 Hz with twice the critical damping, at most as
fast as substeps can follow (Catto, Soft Constraints, GDC 2011; Solver2D, 2024); impulses of a block of rows
are solved at once (:mod:`physicslab.kernels.joints.blocks`), and with contacts in turn. A limit that is not
reached yet may be approached up to it within the substep. Which limits act and which motors are at their
strongest is found by trying: an impulse beyond its bound is set to it, and the others are solved again.
"""

import math
from typing import NamedTuple

from physicslab.kernels import Vectors, always_inlined, inlined
from physicslab.kernels.accounts import ENERGY, HAND, JOINTS, MOTORS, book
from physicslab.kernels.arguments import Acting, Inverse, Motion
from physicslab.kernels.constraint.stirred import SETTLED, Stirred, is_stirred, stir
from physicslab.kernels.joints import blocks as B
from physicslab.kernels.joints.blocks import Joints, can_move, factorise, substitute_back, substitute_forward
from physicslab.kernels.joints.terms import HOLD, LIMIT, MOTOR, TermEnd, measure_turned
from physicslab.kernels.types import unsigned

_FASTEST, _DAMPING, _OF_SUBSTEPS = 60.0, 2.0, 0.25
"""The frequency [Hz] of the correction and its damping ratio; at most that share of the rate of substeps."""
_TRIALS = 64
"""How often a block is solved again in a sweep, as bounds of impulses turn out to act, or not to. With 12, a
heap of 40 ragdolls with a motor of 1 N m as a brake in each joint still moved at 1 m/s after 14 s: bounds
that were found last were kept, but pins not solved again with them."""


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
def _speeds(joints: Joints, k: int, motion: Motion) -> tuple[float, float]:
    """Return how fast the quantities of a node grow [m/s or rad/s]."""
    g, linear, first, second = joints.gradient, motion.linear, 0.0, 0.0
    for e in range(joints.nodes[k, B.ENDS], joints.nodes[k + 1, B.ENDS]):
        body = unsigned(joints.body[e])
        x, y, spin = linear[body, 0], linear[body, 1], motion.angular[body]
        first += g[e, 0] * x + g[e, 1] * y + g[e, 2] * spin
        second += g[e, 3] * x + g[e, 4] * y + g[e, 5] * spin
    return first, second


@always_inlined
def _apply(joints: Joints, k: int, motion: Motion, inverse: Inverse, first: float, second: float) -> None:
    """Change velocities by the impulses of a node."""
    g, linear = joints.gradient, motion.linear
    for e in range(joints.nodes[k, B.ENDS], joints.nodes[k + 1, B.ENDS]):
        body = unsigned(joints.body[e])
        mass, inertia = inverse.mass[body], inverse.inertia[body]
        linear[body, 0] += mass * (first * g[e, 0] + second * g[e, 3])
        linear[body, 1] += mass * (first * g[e, 1] + second * g[e, 4])
        motion.angular[body] += inertia * (first * g[e, 2] + second * g[e, 5])


@always_inlined
def _impulses(joints: Joints, k: int) -> tuple[float, float]:
    """Return the impulses of a node."""
    row = joints.nodes[k, B.ROW]
    second = joints.impulse[row + 1] if joints.nodes[k, B.WIDTH] == 2 else 0.0
    return joints.impulse[row], second


@always_inlined
def _set_impulses(joints: Joints, k: int, first: float, second: float) -> None:
    """Set the impulses of a node."""
    row = joints.nodes[k, B.ROW]
    joints.impulse[row] = first
    if joints.nodes[k, B.WIDTH] == 2:
        joints.impulse[row + 1] = second


@always_inlined
def _end(motion: Motion, body: int, anchors: Vectors, n: int) -> TermEnd:
    """Return a body at an end of a term."""
    position, linear = motion.position, motion.linear
    return TermEnd(
        position[body, 0], position[body, 1], motion.angle[body], linear[body, 0], linear[body, 1],
        motion.angular[body], anchors[n, 0], anchors[n, 1],
    )  # fmt: skip


@always_inlined
def _turn(rotations: Vectors, body: int, angle: float) -> None:
    """Keep the cosine and the sine of a body's angle."""
    if rotations[body, 0] != angle:
        rotations[body, 0] = angle
        rotations[body, 1], rotations[body, 2] = math.cos(angle), math.sin(angle)


@always_inlined
def _measure(joints: Joints, k: int, t: int, motion: Motion, rotations: Vectors) -> None:
    """Add what a term measures, and its gradient, to those of its node."""
    terms, g = joints.terms, joints.gradient
    n, place = terms[t, B.TERM], terms[t, B.PLACE]
    i, j, scale, e = joints.a[n], joints.b[n], joints.scale[n], terms[t, B.END_A]
    _turn(rotations, i, motion.angle[i])
    _turn(rotations, j, motion.angle[j])
    one = measure_turned(
        joints.measure[n], _end(motion, i, joints.anchor_a, n), _end(motion, j, joints.anchor_b, n),
        rotations[i, 1], rotations[i, 2], rotations[j, 1], rotations[j, 2],
        joints.axis[n, 0], joints.axis[n, 1],
    )  # fmt: skip
    joints.state[k, B.ERROR + place] += scale * one.value
    if e >= 0:
        g[e, 3 * place] += scale * one.ax
        g[e, 3 * place + 1] += scale * one.ay
        g[e, 3 * place + 2] += scale * one.turn_a
    e = terms[t, B.END_B]
    if e >= 0:
        g[e, 3 * place] += scale * one.bx
        g[e, 3 * place + 1] += scale * one.by
        g[e, 3 * place + 2] += scale * one.turn_b


@always_inlined
def _given(joints: Joints, k: int, inverse: Inverse, acting: Acting) -> tuple[float, float]:
    """Return how forces accelerate the quantities of a node."""
    g, force, first, second = joints.gradient, acting.force, 0.0, 0.0
    for e in range(joints.nodes[k, B.ENDS], joints.nodes[k + 1, B.ENDS]):
        body = unsigned(joints.body[e])
        if not acting.unkicked[body]:
            x, y = inverse.mass[body] * force[body, 0], inverse.mass[body] * force[body, 1]
            spin = inverse.inertia[body] * acting.torque[body]
            first += g[e, 0] * x + g[e, 1] * y + g[e, 2] * spin
            second += g[e, 3] * x + g[e, 4] * y + g[e, 5] * spin
    return first, second


@inlined
def begin_joints(
    joints: Joints, motion: Motion, rotations: Vectors, inverse: Inverse, acting: Acting, h: float
) -> None:
    """Measure all rows where bodies are, and note speeds and impulses.

    The speeds are less than now by what ``h`` seconds of forces give (:mod:`physicslab.kernels.solver.work`).
    """
    nodes, state, g = joints.nodes, joints.state, joints.gradient
    for k in range(len(state)):
        for e in range(nodes[k, B.ENDS], nodes[k + 1, B.ENDS]):
            g[e, 0] = g[e, 1] = g[e, 2] = g[e, 3] = g[e, 4] = g[e, 5] = 0.0
        state[k, B.ERROR] = state[k, B.ERROR + 1] = 0.0
        for t in range(nodes[k, B.TERMS], nodes[k + 1, B.TERMS]):
            _measure(joints, k, t, motion, rotations)
        row = nodes[k, B.ROW]
        for place in range(nodes[k, B.WIDTH]):
            state[k, B.ERROR + place] -= joints.offset[row + place]
            if joints.role[row] != MOTOR:
                error = state[k, B.ERROR + place]
                off = -error if joints.role[row] == LIMIT else abs(error)
                joints.largest[row + place] = max(joints.largest[row + place], off)
        first, second = _speeds(joints, k, motion)
        if acting.any:
            given, also = _given(joints, k, inverse, acting)
            first, second = first - h * given, second - h * also
        state[k, B.BEFORE], state[k, B.BEFORE + 1] = first, second
        state[k, B.NOTED], state[k, B.NOTED + 1] = _impulses(joints, k)


@always_inlined
def _bounded(joints: Joints, k: int, impulse: float) -> float:
    """Return the impulse of a node, which a limit only pushes and a motor has not without bounds."""
    role, cap = joints.role[joints.nodes[k, B.ROW]], joints.state[k, B.CAP]
    if role == HOLD:
        return impulse
    return max(0.0 if role == LIMIT else -cap, min(cap, impulse))  # type: ignore[no-any-return]


@inlined
def warm_start_joints(joints: Joints, motion: Motion, inverse: Inverse, scale: float, h: float) -> None:
    """Apply the impulses of the last substep, ``scale`` times as large, as far as ``h`` seconds allow.

    Ends that are both driven keep none, which would go on doing work; what sleeps keeps its own.
    """
    for k in range(len(joints.state)):
        joints.state[k, B.CAP] = h * joints.strongest[joints.nodes[k, B.ROW]]
        first, second = _impulses(joints, k)
        moves = joints.state[k, B.BEFORE] != 0.0 or joints.state[k, B.BEFORE + 1] != 0.0
        if moves and not can_move(joints, k, inverse):
            first = second = 0.0
        first, second = _bounded(joints, k, scale * first), scale * second
        _set_impulses(joints, k, first, second)
        _apply(joints, k, motion, inverse, first, second)


@inlined
def _limit_correction(joints: Joints, first: int, end: int, inverse: Inverse, soft: JointSoftness) -> None:
    """Lessen the errors of a block where correcting them gives bodies more energy than its springs have.

    A straight chain that is too long for its fixed ends can close its gaps by bending alone: the straighter
    it is, the faster its links would have to move, without a bound. A light link may hold a heavy body: its
    spring is as stiff as for the heaviest body of the block.
    """
    nodes, state, stored, stiffness = joints.nodes, joints.state, 0.0, soft.rate / (soft.h * soft.spring)
    lightest, heaviest = 0.0, math.inf
    for k in range(first, end):
        role = joints.role[nodes[k, B.ROW]]
        state[k, B.CHANGE] = state[k, B.CHANGE + 1] = 0.0
        if state[k, B.STATE] != B.ACTIVE or role == MOTOR or (role == LIMIT and state[k, B.ERROR] > 0.0):
            continue
        for e in range(nodes[k, B.ENDS], nodes[k + 1, B.ENDS]):
            mass = inverse.mass[joints.body[e]]
            if mass > 0.0:
                lightest, heaviest = max(lightest, mass), min(heaviest, mass)
        for place in range(nodes[k, B.WIDTH]):
            error, diagonal = state[k, B.ERROR + place], state[k, B.DIAGONAL + place]
            state[k, B.CHANGE + place] = -soft.rate * error
            if diagonal > 0.0:
                stored += stiffness * error * error / diagonal
    if stored == 0.0:
        return
    stored *= lightest / heaviest
    given = substitute_forward(joints, first, end)
    if given > stored:
        share = math.sqrt(stored / given)
        for k in range(first, end):
            if joints.role[nodes[k, B.ROW]] == HOLD or state[k, B.ERROR] < 0.0:
                state[k, B.ERROR] *= share
                state[k, B.ERROR + 1] *= share


@inlined
def factorise_joints(joints: Joints, inverse: Inverse, soft: JointSoftness) -> None:
    """Choose the nodes that act as far as is known, and factorise all blocks; limit what is corrected."""
    for k in range(len(joints.state)):
        row, acts = joints.nodes[k, B.ROW], can_move(joints, k, inverse)
        if joints.role[row] == LIMIT:
            acts = acts and joints.impulse[row] > 0.0
        elif joints.role[row] == MOTOR:
            acts = acts and abs(joints.impulse[row]) < joints.state[k, B.CAP]
        joints.state[k, B.STATE] = B.ACTIVE if acts else B.OFF
    for block in range(len(joints.groups) - 1):
        first, end = joints.groups[block, B.FIRST], joints.groups[block + 1, B.FIRST]
        factorise(joints, block, inverse, soft.spring)
        if soft.rate > 0.0:
            _limit_correction(joints, first, end, inverse, soft)


@always_inlined
def _wanted(joints: Joints, k: int, place: int, soft: JointSoftness) -> float:
    """Return how fast a quantity of a node is to grow [m/s or rad/s]."""
    row, error = joints.nodes[k, B.ROW], joints.state[k, B.ERROR + place]
    if joints.role[row] == MOTOR:
        return joints.target[row]  # type: ignore[no-any-return]
    if joints.role[row] == LIMIT and error > 0.0:
        return -error / soft.h  # type: ignore[no-any-return]
    return -soft.rate * error  # type: ignore[no-any-return]


@always_inlined
def _set_bounds(joints: Joints, block: int, motion: Motion, inverse: Inverse) -> bool:
    """Set impulses to their bounds that would go beyond; return whether any was."""
    state, found = joints.state, False
    for n in range(joints.groups[block, B.BOUNDED], joints.groups[block + 1, B.BOUNDED]):
        k = joints.bounded[n]
        if state[k, B.STATE] == B.OFF:
            continue
        now = joints.impulse[joints.nodes[k, B.ROW]]
        target = now + state[k, B.CHANGE]
        bound = _bounded(joints, k, target)
        if bound != target:
            _apply(joints, k, motion, inverse, bound - now, 0.0)
            joints.impulse[joints.nodes[k, B.ROW]], state[k, B.STATE], found = bound, B.OFF, True
    return found


@always_inlined
def _free(joints: Joints, block: int, motion: Motion, inverse: Inverse, soft: JointSoftness) -> bool:
    """Let nodes act again whose bound does not hold any more; return whether any does."""
    state, found = joints.state, False
    for n in range(joints.groups[block, B.BOUNDED], joints.groups[block + 1, B.BOUNDED]):
        k = joints.bounded[n]
        if state[k, B.STATE] != B.OFF:
            continue
        speed, _ = _speeds(joints, k, motion)
        left, row = _wanted(joints, k, 0, soft) - speed, joints.nodes[k, B.ROW]
        inwards = left > 0.0 if joints.role[row] == LIMIT else left * joints.impulse[row] < 0.0
        if joints.role[row] == MOTOR and joints.impulse[row] == 0.0:
            inwards = left != 0.0 and joints.strongest[row] > 0.0
        if inwards and can_move(joints, k, inverse):
            state[k, B.STATE], found = B.ACTIVE, True
    return found


@always_inlined
def _solve_once(joints: Joints, first: int, end: int, motion: Motion, soft: JointSoftness) -> None:
    """Find by how much the impulses of a block's active nodes are to change."""
    state = joints.state
    for k in range(first, end):
        if state[k, B.STATE] == B.ACTIVE:
            speed, also = _speeds(joints, k, motion)
            held, second = _impulses(joints, k) if soft.rate > 0.0 else (0.0, 0.0)
            state[k, B.CHANGE] = _wanted(joints, k, 0, soft) - speed - state[k, B.GIVES] * held
            state[k, B.CHANGE + 1] = _wanted(joints, k, 1, soft) - also - state[k, B.GIVES + 1] * second
    substitute_forward(joints, first, end)
    substitute_back(joints, first, end)


@inlined
def _solve_block(joints: Joints, block: int, motion: Motion, inverse: Inverse, soft: JointSoftness) -> bool:
    """Solve the rows of a block at once; return whether impulses still change."""
    first, end = joints.groups[block, B.FIRST], joints.groups[block + 1, B.FIRST]
    state, changed, size, trials = joints.state, 0.0, 0.0, 0
    while trials < _TRIALS:
        trials += 1
        _solve_once(joints, first, end, motion, soft)
        if trials < _TRIALS and _set_bounds(joints, block, motion, inverse):
            factorise(joints, block, inverse, soft.spring)
            changed = 1.0
            continue
        for k in range(first, end):
            if state[k, B.STATE] == B.ACTIVE:
                before, held = _impulses(joints, k)
                now, other = _bounded(joints, k, before + state[k, B.CHANGE]), held + state[k, B.CHANGE + 1]
                _set_impulses(joints, k, now, other)
                _apply(joints, k, motion, inverse, now - before, other - held)
                changed += abs(now - before) + abs(other - held)
                size += abs(now) + abs(other)
        if not _free(joints, block, motion, inverse, soft):
            break
        factorise(joints, block, inverse, soft.spring)
        changed += size
    return changed > SETTLED * size


@inlined
def sweep_joints(
    joints: Joints, motion: Motion, inverse: Inverse, soft: JointSoftness, stirred: Stirred
) -> bool:
    """Solve the blocks of stirred bodies once; return whether impulses still change, which stirs theirs."""
    unsettled, nodes, groups = False, joints.nodes, joints.groups
    for block in range(len(groups) - 1):
        first, end = nodes[groups[block, B.FIRST], B.ENDS], nodes[groups[block + 1, B.FIRST], B.ENDS]
        due = False
        for e in range(first, end):
            due = due or is_stirred(stirred, joints.body[e])
        if due and _solve_block(joints, block, motion, inverse, soft):
            unsettled = True
            for e in range(first, end):
                body = joints.body[e]
                stir(stirred, body, inverse.mass[body], inverse.inertia[body])
    return unsettled


@inlined
def note_joints(joints: Joints, motion: Motion) -> None:
    """Note speeds and impulses as they are now."""
    state = joints.state
    for k in range(len(state)):
        state[k, B.BEFORE], state[k, B.BEFORE + 1] = _speeds(joints, k, motion)
        state[k, B.NOTED], state[k, B.NOTED + 1] = _impulses(joints, k)


@inlined
def book_work(joints: Joints, motion: Motion, account: Vectors, whole: bool) -> None:
    """Book the work of the impulses, by the mean of the speeds that were noted and of those now.

    Taken of the ``whole`` impulses, or of their change since they were noted.
    """
    state = joints.state
    for k in range(len(state)):
        impulse, second = _impulses(joints, k)
        speed, also = _speeds(joints, k, motion)
        made = (impulse - (0.0 if whole else state[k, B.NOTED])) * (state[k, B.BEFORE] + speed)
        made += (second - (0.0 if whole else state[k, B.NOTED + 1])) * (state[k, B.BEFORE + 1] + also)
        cause = MOTORS if joints.role[joints.nodes[k, B.ROW]] == MOTOR else JOINTS
        account[cause, ENERGY] += 0.5 * made


@inlined
def book_momentum(joints: Joints, motion: Motion, inverse: Inverse, account: Vectors, whole: bool) -> None:
    """Book the momentum that fixed ends give by impulses where bodies are, and the work of what drives these.

    Taken of the ``whole`` impulses, or of their change since they were noted.
    """
    position, linear, state, g = motion.position, motion.linear, joints.state, joints.gradient
    for k in range(len(state)):
        first, second = _impulses(joints, k)
        if not whole:
            first, second = first - state[k, B.NOTED], second - state[k, B.NOTED + 1]
        x, y, spin, driven = 0.0, 0.0, 0.0, 0.0
        for e in range(joints.nodes[k, B.ENDS], joints.nodes[k + 1, B.ENDS]):
            body = unsigned(joints.body[e])
            px = first * g[e, 0] + second * g[e, 3]
            py = first * g[e, 1] + second * g[e, 4]
            turn = first * g[e, 2] + second * g[e, 5]
            if inverse.mass[body] > 0.0:
                x, y = x + px, y + py
                spin += position[body, 0] * py - position[body, 1] * px
            else:
                driven += px * linear[body, 0] + py * linear[body, 1]
            if inverse.inertia[body] > 0.0:
                spin += turn
            else:
                driven += turn * motion.angular[body]
        cause = MOTORS if joints.role[joints.nodes[k, B.ROW]] == MOTOR else JOINTS
        book(account[cause], 0, 0.0, x, y, spin)
        account[HAND, ENERGY] -= driven
