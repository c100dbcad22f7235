"""Rows of joints beside contacts, as points: what acts to one side only, and motors with a cap.

A limit is a contact without a tangent: its gap is what is left of a rope, or of the way or the angle to a
stop, its normal the gradient of that, and it does not bounce. A motor with a largest force is friction
without a normal: it slides as far as its speed is not the one it is to hold, and a unit of force that nothing
moves presses on it, of which its coefficient of friction makes the largest force. So both are pairs of the
laws of contacts, which have no case for them. What is kept in any case, as a pin, is no point
(:mod:`physicslab.kernels.rigid.joined`).

Angles are multiplied by a lever of their joint, so that all rows measure metres.
"""

import math

from physicslab.kernels import Numbers, Vectors, inlined
from physicslab.kernels.joints.terms import ALONG_A, ANGLE, TermEnd, measure_term
from physicslab.kernels.rigid.features import (
    BIAS_N,
    BIAS_T,
    FEATURE,
    GAP,
    JOINT,
    MARGIN,
    NORMAL,
    ONE,
    OTHER,
    PX,
    TANGENT,
    VN,
    VT,
    Points,
    Scene,
    measure_contact,
    rate_along,
)

__all__ = [
    "FIRST_ENDS", "FIRST_TERM", "LEVER", "MOTOR", "NUMBERS", "OFFSET", "OWN", "ROLE", "TARGET", "TERM",
    "TERMS", "TERM_ENDS", "UNIT", "WHOLE", "fastest_change", "gap_of_row", "is_motor", "measure",
    "motor_rate",
]  # fmt: skip

ROLE, TERMS, FIRST_ENDS = range(3)
"""The whole numbers of a row: 1 for a limit, 2 for a motor; how many terms; of each term what it measures,
and the rows of its bodies A and B."""
MOTOR, TERM_ENDS = 2, 3
WHOLE = FIRST_ENDS + 2 * TERM_ENDS
LEVER, OFFSET, TARGET, OWN, UNIT, FIRST_TERM = range(6)
"""The numbers of a row: its lever [m], 1 where it is a length; what is taken from its terms; of a motor its
speed, what a force of 1 N at it causes alone [1/kg], and the unit of force that presses on it [N]. Then of
each term its factor, its anchors at A and B [m], and its axis."""
TERM, ARM, AXIS = 7, 1, 5
NUMBERS = FIRST_TERM + 2 * TERM


@inlined
def is_motor(scene: Scene, points: Points, i: int) -> bool:
    """Whether a point is a motor with a cap."""
    motor: bool = points[i, FEATURE] >= JOINT and scene.row_ends[points[i, FEATURE] - JOINT, ROLE] == MOTOR
    return motor


@inlined
def _end(scene: Scene, r: int, term: int, end: int, q: Numbers, v: Numbers) -> TermEnd:
    """Return the body at an end of a row's term."""
    body = scene.row_ends[r, FIRST_ENDS + TERM_ENDS * term + 1 + end]
    arm, turn = FIRST_TERM + TERM * term + ARM + 2 * end, 2 * scene.rows + body
    return TermEnd(
        q[2 * body], q[2 * body + 1], q[turn], v[2 * body], v[2 * body + 1], v[turn],
        scene.row_numbers[r, arm], scene.row_numbers[r, arm + 1],
    )  # fmt: skip


@inlined
def measure(scene: Scene, points: Points, i: int, q: Numbers, v: Numbers, out: Vectors) -> None:
    """Measure point number i in a state."""
    if points[i, FEATURE] >= JOINT:
        _measure_row(scene, points, i, q, v, out)
    else:
        measure_contact(scene, points, i, q, v, out)


@inlined
def _measure_row(scene: Scene, points: Points, i: int, q: Numbers, v: Numbers, out: Vectors) -> None:
    """Measure point number i, which is a row of a joint, in a state."""
    r, numbers, rows = points[i, FEATURE] - JOINT, scene.row_numbers, scene.rows
    motor = is_motor(scene, points, i)
    gradient, value, rate = TANGENT if motor else NORMAL, -numbers[r, OFFSET], 0.0
    for column in range(PX + 2):
        out[i, column] = 0.0
    for t in range(scene.row_ends[r, TERMS]):
        first, kind = FIRST_TERM + TERM * t, FIRST_ENDS + TERM_ENDS * t
        one = measure_term(
            scene.row_ends[r, kind], _end(scene, r, t, 0, q, v), _end(scene, r, t, 1, q, v),
            numbers[r, first + AXIS], numbers[r, first + AXIS + 1],
        )  # fmt: skip
        scale = numbers[r, first]
        value, rate = value + scale * one.value, rate + scale * one.rate
        scale *= numbers[r, LEVER]
        for end in range(2):
            body = scene.row_ends[r, kind + 1 + end]
            if body != points[i, ONE] and body != points[i, OTHER]:
                continue  # the world, beside two bodies
            at = gradient + (0 if body == points[i, ONE] else 3)
            x, y, turn = (one.ax, one.ay, one.turn_a) if end == 0 else (one.bx, one.by, one.turn_b)
            out[i, at] += scale * x
            out[i, at + 1] += scale * y
            out[i, at + 2] += scale * turn
    out[i, MARGIN] = math.inf
    speed, rate = rate_along(rows, points, out, i, gradient, v), numbers[r, LEVER] * rate
    if motor:
        out[i, VT], out[i, BIAS_T] = speed - numbers[r, LEVER] * numbers[r, TARGET], rate
        out[i, BIAS_N] = -numbers[r, OWN] * numbers[r, UNIT]
    else:
        out[i, GAP], out[i, VN], out[i, BIAS_N] = numbers[r, LEVER] * value, speed, rate


@inlined
def motor_rate(scene: Scene, points: Points, measures: Vectors, i: int) -> float:
    """Return how fast a motor that is measured moves against its force [m/s]."""
    r = points[i, FEATURE] - JOINT
    rate: float = measures[i, VT] + scene.row_numbers[r, LEVER] * scene.row_numbers[r, TARGET]
    return rate


@inlined
def gap_of_row(scene: Scene, r: int, q: Numbers) -> float:
    """Return what is left to a limit at a place [m]; zero for a motor."""
    if scene.row_ends[r, ROLE] == MOTOR:
        return 0.0
    value = -scene.row_numbers[r, OFFSET]
    for t in range(scene.row_ends[r, TERMS]):
        first = FIRST_TERM + TERM * t
        one = measure_term(
            scene.row_ends[r, FIRST_ENDS + TERM_ENDS * t],
            _end(scene, r, t, 0, q, q), _end(scene, r, t, 1, q, q),
            scene.row_numbers[r, first + AXIS], scene.row_numbers[r, first + AXIS + 1],
        )  # fmt: skip
        value += scene.row_numbers[r, first] * one.value
    left: float = scene.row_numbers[r, LEVER] * value
    return left


@inlined
def fastest_change(scene: Scene, r: int, q: Numbers, rates: Numbers) -> float:
    """Return the largest rate at which a limit may come nearer, of speeds or accelerations; 0 for a motor."""
    total, rows, numbers = 0.0, scene.rows, scene.row_numbers
    if scene.row_ends[r, ROLE] == MOTOR:
        return total
    for t in range(scene.row_ends[r, TERMS]):
        first, kind = FIRST_TERM + TERM * t, FIRST_ENDS + TERM_ENDS * t
        a, b = scene.row_ends[r, kind + 1], scene.row_ends[r, kind + 2]
        spin_a, spin_b = rates[2 * rows + a], rates[2 * rows + b]
        change = abs(spin_b - spin_a)
        if scene.row_ends[r, kind] != ANGLE:
            at_a, at_b = first + ARM, first + ARM + 2
            arm_a = _length(numbers[r, at_a], numbers[r, at_a + 1])
            arm_b = _length(numbers[r, at_b], numbers[r, at_b + 1])
            if scene.row_ends[r, kind] == ALONG_A:  # the axis turns about A
                arm_a = arm_b + _length(q[2 * b] - q[2 * a], q[2 * b + 1] - q[2 * a + 1])
            change = _length(rates[2 * b] - rates[2 * a], rates[2 * b + 1] - rates[2 * a + 1])
            change += abs(spin_a) * arm_a + abs(spin_b) * arm_b
        total += abs(numbers[r, first]) * change
    return numbers[r, LEVER] * total  # type: ignore[no-any-return]


@inlined
def _length(x: float, y: float) -> float:
    return math.sqrt(x * x + y * y)
