"""Joints as soft constraints: impulses that hold bodies together, beside those of contacts.

A row is a spring and damper of 60 Hz, overdamped, integrated implicitly, and at most as fast as substeps can
follow (Catto, Soft Constraints, GDC 2011; Solver2D, 2024). Impulses act on B, and on A with the other sign.
"""

import math
from typing import NamedTuple

from physicslab.kernels import Numbers, Rows, Vectors, always_inlined, inlined
from physicslab.kernels.accounts import ENERGY, HAND, JOINTS, PX, PY, SPIN
from physicslab.kernels.arguments import Acting, Inverse, Motion
from physicslab.kernels.joints.terms import ALONG, TermEnd, measure_term

_FASTEST, _DAMPING, _OF_SUBSTEPS = 60.0, 2.0, 0.25
"""The frequency [Hz] of the constraint and its damping ratio; at most that share of the rate of substeps."""
_SETTLED = 1e-10
"""Share of an impulse by which it may still change where sweeps come to their end."""
_SINGULAR = 1e-12
"""Share of the product of its diagonal below which the determinant of two rows is rounding."""
ACROSS_A, ACROSS_B, ERROR, BEFORE, NOTED, MEASURED = range(6)
"""What is measured of a row: r x n of both arms [m], the error [m], its speed before the impulses [m/s], and
its impulse then [N s]."""


class Joints(NamedTuple):
    """The rows of joints (n,): bodies, how many are solved as one, anchors and axes, impulses, measures."""

    a: Rows
    b: Rows
    block: Rows
    anchor_a: Vectors
    anchor_b: Vectors
    axis: Vectors
    impulse: Numbers
    measured: Vectors


class JointSoftness(NamedTuple):
    """The rate [1/s] at which errors are corrected, the share of an impulse made, and that of it given up."""

    rate: float
    mass_scale: float
    impulse_scale: float


JointsTuple = tuple[Rows, Rows, Rows, Vectors, Vectors, Vectors, Numbers, Vectors]
"""The rows without names."""


@inlined
def joint_softness(h: float, sweeps: int) -> JointSoftness:
    """Return the spring of a row in a substep of ``h`` seconds; more sweeps carry a stiffer one."""
    omega = 2.0 * math.pi * min(_FASTEST, _OF_SUBSTEPS / h)
    damped = 2.0 * _DAMPING + h * omega
    stiffness = h * omega * damped * sweeps * math.sqrt(math.sqrt(sweeps))
    return JointSoftness(omega / damped, stiffness / (1.0 + stiffness), 1.0 / (1.0 + stiffness))


@always_inlined
def _speed(joints: Joints, i: int, linear: Vectors, angular: Numbers) -> float:
    """Return how fast the error of a row grows [m/s], or of forces and torques what they give to it."""
    a, b, nx, ny = joints.a[i], joints.b[i], joints.axis[i, 0], joints.axis[i, 1]
    along = nx * (linear[b, 0] - linear[a, 0]) + ny * (linear[b, 1] - linear[a, 1])
    turning = angular[b] * joints.measured[i, ACROSS_B] - angular[a] * joints.measured[i, ACROSS_A]
    return along + turning  # type: ignore[no-any-return]


@always_inlined
def _apply(joints: Joints, i: int, motion: Motion, inverse: Inverse, impulse: float) -> None:
    """Change velocities by an impulse of a row."""
    a, b, px, py = joints.a[i], joints.b[i], impulse * joints.axis[i, 0], impulse * joints.axis[i, 1]
    motion.linear[a, 0] -= inverse.mass[a] * px
    motion.linear[a, 1] -= inverse.mass[a] * py
    motion.angular[a] -= inverse.inertia[a] * impulse * joints.measured[i, ACROSS_A]
    motion.linear[b, 0] += inverse.mass[b] * px
    motion.linear[b, 1] += inverse.mass[b] * py
    motion.angular[b] += inverse.inertia[b] * impulse * joints.measured[i, ACROSS_B]


@always_inlined
def _response(joints: Joints, i: int, j: int, inverse: Inverse) -> float:
    """Return how an impulse of row j changes the speed of row i, both of the same bodies [1/kg]."""
    a, b, axis, measured = joints.a[i], joints.b[i], joints.axis, joints.measured
    along = axis[i, 0] * axis[j, 0] + axis[i, 1] * axis[j, 1]
    turning = inverse.inertia[a] * measured[i, ACROSS_A] * measured[j, ACROSS_A]
    turning += inverse.inertia[b] * measured[i, ACROSS_B] * measured[j, ACROSS_B]
    return (inverse.mass[a] + inverse.mass[b]) * along + turning  # type: ignore[no-any-return]


@always_inlined
def _end(motion: Motion, body: int, anchors: Vectors, i: int) -> TermEnd:
    """Return a body at an end of row i."""
    position, linear = motion.position, motion.linear
    return TermEnd(
        position[body, 0], position[body, 1], motion.angle[body], linear[body, 0], linear[body, 1],
        motion.angular[body], anchors[i, 0], anchors[i, 1],
    )  # fmt: skip


@inlined
def begin_joints(joints: Joints, motion: Motion, inverse: Inverse, acting: Acting, h: float) -> None:
    """Measure all rows where bodies are, and note speeds and impulses.

    The speeds are less than now by what ``h`` seconds of forces give (:mod:`physicslab.kernels.solver.work`).
    """
    axis, measured = joints.axis, joints.measured
    for i in range(len(joints.impulse)):
        a, b = joints.a[i], joints.b[i]
        at_a, at_b = _end(motion, a, joints.anchor_a, i), _end(motion, b, joints.anchor_b, i)
        one = measure_term(ALONG, at_a, at_b, axis[i, 0], axis[i, 1])
        across_a, across_b = -one.turn_a, one.turn_b
        measured[i, ACROSS_A], measured[i, ACROSS_B], measured[i, ERROR] = across_a, across_b, one.value
        given = 0.0
        if acting.any and h > 0.0:
            force, torque, nx, ny = acting.force, acting.torque, axis[i, 0], axis[i, 1]
            if not acting.unkicked[b]:
                given += inverse.mass[b] * (nx * force[b, 0] + ny * force[b, 1])
                given += inverse.inertia[b] * torque[b] * across_b
            if not acting.unkicked[a]:
                given -= inverse.mass[a] * (nx * force[a, 0] + ny * force[a, 1])
                given -= inverse.inertia[a] * torque[a] * across_a
        measured[i, BEFORE] = _speed(joints, i, motion.linear, motion.angular) - h * given
        measured[i, NOTED] = joints.impulse[i]


@inlined
def warm_start_joints(joints: Joints, motion: Motion, inverse: Inverse, scale: float) -> None:
    """Apply the impulses of the last substep, ``scale`` times as large."""
    for i in range(len(joints.impulse)):
        joints.impulse[i] *= scale
        _apply(joints, i, motion, inverse, joints.impulse[i])


@inlined
def sweep_joints(joints: Joints, motion: Motion, inverse: Inverse, soft: JointSoftness) -> tuple[bool, float]:
    """Solve all rows once; return whether impulses still change, and their work by each one's mean speed."""
    unsettled, work, i, impulse, measured = False, 0.0, 0, joints.impulse, joints.measured
    while i < len(impulse):
        j = i + joints.block[i] - 1
        if inverse.mass[joints.a[i]] + inverse.mass[joints.b[i]] == 0.0:
            i = j + 1  # fixed bodies, or bodies that sleep, whose impulses are kept
            continue
        one, between, other = _response(joints, i, i, inverse), 0.0, 0.0
        v1, v2 = _speed(joints, i, motion.linear, motion.angular), 0.0
        wanted1, wanted2 = v1 + soft.rate * measured[i, ERROR], 0.0
        p1 = wanted1 / one if one > 0.0 else 0.0
        p2 = 0.0
        if j > i:
            between, other = _response(joints, i, j, inverse), _response(joints, j, j, inverse)
            v2 = _speed(joints, j, motion.linear, motion.angular)
            wanted2 = v2 + soft.rate * measured[j, ERROR]
            determinant = one * other - between * between
            if determinant > _SINGULAR * one * other:
                p1 = (other * wanted1 - between * wanted2) / determinant
                p2 = (one * wanted2 - between * wanted1) / determinant
            elif other > one:
                p1, p2 = 0.0, wanted2 / other
        change1 = -soft.mass_scale * p1 - soft.impulse_scale * impulse[i]
        change2 = 0.0
        impulse[i] += change1
        _apply(joints, i, motion, inverse, change1)
        if j > i:
            change2 = -soft.mass_scale * p2 - soft.impulse_scale * impulse[j]
            impulse[j] += change2
            _apply(joints, j, motion, inverse, change2)
        work += change1 * (v1 + 0.5 * (one * change1 + between * change2))
        work += change2 * (v2 + 0.5 * (between * change1 + other * change2))
        limit = _SETTLED * (abs(impulse[i]) + abs(impulse[j]))
        unsettled = unsettled or abs(change1) + abs(change2) > limit
        i = j + 1
    return unsettled, work


@inlined
def work_of_joints(joints: Joints, motion: Motion, whole: bool) -> float:
    """Return the work of the impulses [J], by the mean of the speeds that were noted and of those now.

    Of the ``whole`` impulses, or of what they have changed by since they were noted.
    """
    work = 0.0
    for i in range(len(joints.impulse)):
        impulse = joints.impulse[i] - (0.0 if whole else joints.measured[i, NOTED])
        speed = _speed(joints, i, motion.linear, motion.angular)
        work += 0.5 * impulse * (joints.measured[i, BEFORE] + speed)
    return work


@inlined
def book_momentum(joints: Joints, motion: Motion, inverse: Inverse, account: Vectors, whole: bool) -> None:
    """Book the momentum that fixed ends give by impulses where bodies are, and the work of what drives these.

    Of the ``whole`` impulses, or of what they have changed by since they were noted.
    """
    position, linear, angular = motion.position, motion.linear, motion.angular
    for i in range(len(joints.impulse)):
        impulse = joints.impulse[i] - (0.0 if whole else joints.measured[i, NOTED])
        px, py = impulse * joints.axis[i, 0], impulse * joints.axis[i, 1]
        for end in range(2):
            body = joints.b[i] if end == 1 else joints.a[i]
            sign, across = (1.0, ACROSS_B) if end == 1 else (-1.0, ACROSS_A)
            turn = sign * impulse * joints.measured[i, across]
            if inverse.mass[body] > 0.0:
                account[JOINTS, PX] += sign * px
                account[JOINTS, PY] += sign * py
                account[JOINTS, SPIN] += sign * (position[body, 0] * py - position[body, 1] * px)
            else:
                account[HAND, ENERGY] -= sign * (px * linear[body, 0] + py * linear[body, 1])
            if inverse.inertia[body] > 0.0:
                account[JOINTS, SPIN] += turn
            else:
                account[HAND, ENERGY] -= turn * angular[body]
