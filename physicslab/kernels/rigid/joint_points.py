"""Rows of joints beside contacts, as points: what acts to one side only, and motors with a cap.

A limit is a contact without a tangent: its gap is what is left of a rope, or of the way or the angle to a
stop, its normal the gradient of that, and it does not bounce. A motor with a largest force is friction
without a normal: it slides as far as its speed is not the one it is to hold, and a unit of force that nothing
moves presses on it, of which its coefficient of friction makes the largest force. So both are pairs of the
laws of contacts, which have no case for them. A term that holds in any case, as a pin, is no point
(:mod:`physicslab.kernels.rigid.joined`).

Angles are multiplied by a lever of their joint, so that all rows measure metres.
"""

import math

from physicslab.kernels import Numbers, Vectors, always_inlined, inlined
from physicslab.kernels.joints.terms import ALONG_A, ANGLE, MeasuredTerm, TermEnd, measure_term
from physicslab.kernels.length import length_of
from physicslab.kernels.rigid import features as F
from physicslab.kernels.rigid.features import Points, RigidScene, measure_contact, rate_along

LEVER, OFFSET, TARGET, OWN, UNIT, TERMS, FIRST_TERM = range(3, 10)
"""The columns of the coefficients of a pair that is a row, behind its largest force as a motor, a restitution
of 0, and a size: its lever [m], 1 where it is a length; what is taken from its terms; of a motor its speed,
what a force of 1 N at it causes alone [1/kg], and the unit of force that presses on it [N]; how many terms
there are."""
MEASURE, ENDS, SCALE, ARM, AXIS, TERM = 0, 1, 3, 4, 8, 10
"""The columns of a term: what it measures; the rows of its bodies A and B; its factor, its anchors at A and B
[m], and its axis."""
NUMBERS = FIRST_TERM + 2 * TERM


@inlined
def _end(rows: int, own: Vectors, p: int, term: int, end: int, q: Numbers, v: Numbers) -> TermEnd:
    """Return the body at an end of a term, which begins at a column of row ``p``."""
    body, arm = int(own[p, term + ENDS + end]), term + ARM + 2 * end
    turn = 2 * rows + body
    return TermEnd(
        q[2 * body], q[2 * body + 1], q[turn], v[2 * body], v[2 * body + 1], v[turn], own[p, arm],
        own[p, arm + 1],
    )  # fmt: skip


@inlined
def _measure_term(
    rows: int, own: Vectors, p: int, term: int, q: Numbers, v: Numbers
) -> tuple[float, MeasuredTerm]:
    """Return a term's factor, and what it measures."""
    one = measure_term(
        int(own[p, term + MEASURE]), _end(rows, own, p, term, 0, q, v), _end(rows, own, p, term, 1, q, v),
        own[p, term + AXIS], own[p, term + AXIS + 1],
    )  # fmt: skip
    return own[p, term + SCALE], one


@always_inlined
def measure(scene: RigidScene, points: Points, i: int, q: Numbers, v: Numbers, out: Vectors) -> None:
    """Measure point number i in a state."""
    if points[i, F.FEATURE] >= F.JOINT:
        _measure_row(scene.rows, scene.coefficients, points, i, q, v, out)
    else:
        measure_contact(scene, points, i, q, v, out)


@inlined
def _measure_row(
    rows: int, own: Vectors, points: Points, i: int, q: Numbers, v: Numbers, out: Vectors
) -> None:
    """Measure point number i, which is a row of a joint, in a state."""
    p, motor = points[i, F.PAIR], points[i, F.FEATURE] == F.MOTOR
    gradient, value, rate = F.TANGENT if motor else F.NORMAL, -own[p, OFFSET], 0.0
    for column in range(F.PX + 2):
        out[i, column] = 0.0
    for t in range(int(own[p, TERMS])):
        term = FIRST_TERM + TERM * t
        scale, one = _measure_term(rows, own, p, term, q, v)
        value, rate = value + scale * one.value, rate + scale * one.rate
        scale *= own[p, LEVER]
        for end in range(2):
            body = int(own[p, term + ENDS + end])
            if body != points[i, F.ONE] and body != points[i, F.OTHER]:
                continue  # the world, beside two bodies
            at = gradient + (0 if body == points[i, F.ONE] else 3)
            x, y, turn = (one.ax, one.ay, one.turn_a) if end == 0 else (one.bx, one.by, one.turn_b)
            out[i, at] += scale * x
            out[i, at + 1] += scale * y
            out[i, at + 2] += scale * turn
    out[i, F.MARGIN] = math.inf
    speed, rate = rate_along(rows, points, out, i, gradient, v), own[p, LEVER] * rate
    if motor:
        out[i, F.VT], out[i, F.BIAS_T] = speed - own[p, LEVER] * own[p, TARGET], rate
        out[i, F.BIAS_N] = -own[p, OWN] * own[p, UNIT]
    else:
        out[i, F.GAP], out[i, F.VN], out[i, F.BIAS_N] = own[p, LEVER] * value, speed, rate


@always_inlined
def motor_rate(scene: RigidScene, points: Points, measures: Vectors, i: int) -> float:
    """Return how fast a motor that is measured moves against its force [m/s]."""
    own, p = scene.coefficients, points[i, F.PAIR]
    rate: float = measures[i, F.VT] + own[p, LEVER] * own[p, TARGET]
    return rate


@inlined
def gap_of_row(rows: int, own: Vectors, p: int, q: Numbers) -> float:
    """Return what is left to a limit at a place [m]."""
    value = -own[p, OFFSET]
    for t in range(int(own[p, TERMS])):
        scale, one = _measure_term(rows, own, p, FIRST_TERM + TERM * t, q, q)
        value += scale * one.value
    left: float = own[p, LEVER] * value
    return left


@inlined
def fastest_change(rows: int, own: Vectors, p: int, q: Numbers, rates: Numbers) -> float:
    """Return the largest rate at which a limit may come nearer, of speeds or accelerations."""
    total = 0.0
    for t in range(int(own[p, TERMS])):
        term = FIRST_TERM + TERM * t
        a, b, arm = int(own[p, term + ENDS]), int(own[p, term + ENDS + 1]), term + ARM
        spin_a, spin_b = rates[2 * rows + a], rates[2 * rows + b]
        change = abs(spin_b - spin_a)
        if own[p, term + MEASURE] != ANGLE:
            arm_a, arm_b = (
                length_of(own[p, arm], own[p, arm + 1]),
                length_of(own[p, arm + 2], own[p, arm + 3]),
            )
            if own[p, term + MEASURE] == ALONG_A:  # the axis turns about A
                arm_a = arm_b + length_of(q[2 * b] - q[2 * a], q[2 * b + 1] - q[2 * a + 1])
            change = length_of(rates[2 * b] - rates[2 * a], rates[2 * b + 1] - rates[2 * a + 1])
            change += abs(spin_a) * arm_a + abs(spin_b) * arm_b
        total += abs(own[p, term + SCALE]) * change
    return own[p, LEVER] * total  # type: ignore[no-any-return]
