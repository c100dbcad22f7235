"""Rows of equality constraints between two bodies: what a row measures, and the forces that keep it at zero.

A row measures g, how far a point of B is from one of A along an axis [m]. J is its gradient by the
coordinates of both bodies, so that J v is how fast it grows, and its force acts by J^T. The constrained
motion solves [M J^T; J 0] [a; -lambda] = [f; -Jdot v]: with A = J M^-1 J^T, A lambda = -(J M^-1 f + Jdot v).

Rows are packed like forces (:mod:`physicslab.kernels.forces.force_calls`), in an array of numbers and one of
whole numbers, which kernels get as arrays or by pointers. Dependent rows, as those of two equal pins, get no
force: the motion is the same. A is factorised within its envelope, so that a chain costs as much as it has
links.
"""

import math
from typing import Any

from physicslab.kernels import Numbers, Rows, always_inlined, kernel
from physicslab.kernels.accounts import ENERGY, PX, PY, SPIN
from physicslab.kernels.forces.force_calls import force_kernel
from physicslab.kernels.joints.terms import ALONG, TermEnd, measure_term
from physicslab.kernels.ode.compensated import add

ROWS, COORDINATES, BOOKED, DRIVEN, RANK, FIRST = range(6)
"""The whole numbers: how many rows; how many coordinates move; the accounts of joints and of what drives
bodies, or -1; how many rows are independent, as it was found last. Then ``ENDS`` numbers a row, and where the
envelope of each begins."""
ENDS = 4
"""Where x and the angle of A are, and of B, as the packed coordinates have them; an angle of -1 never
changes."""
ARM_A, ARM_B, AXIS, GIVEN = 0, 2, 4, 6
"""The numbers of a row: the anchors at A and B in the body's own directions, or in the world's where the
angle never changes [m]; the axis, a unit vector of the world. Behind all rows are the inverse masses
of the coordinates, then their rates of damping [1/s], ``STATE`` numbers a row, and the matrix."""
JA, JB, ERROR, RATE, LAMBDA, RIGHT, DIAGONAL, CHANGE, STATE = 0, 3, 6, 7, 8, 9, 10, 11, 12
"""The state of a row: its gradient by x, y and the angle of A, and of B; the error g [m]; Jdot v [m/s^2]; the
force [N]; the right side; the diagonal of A; how the force changes."""
_DEPENDENT = 1e-12
"""Share of its diagonal below which a pivot of A is rounding: the row depends on those before it."""
_ROUNDING = 4e-16
"""Share of the largest coordinate, and of the largest speed, below which an error is rounding."""


def room_of(rows: int, coordinates: int) -> tuple[int, int]:
    """Return how many numbers and how many whole numbers so many rows and coordinates take."""
    return (GIVEN + STATE) * rows + 2 * coordinates + rows * rows, FIRST + (ENDS + 1) * rows


def forces_of(numbers: Numbers, whole: Rows) -> Numbers:
    """Return the forces (n,) [N] of the rows, as they were found last."""
    n, states = int(whole[ROWS]), GIVEN * int(whole[ROWS]) + 2 * int(whole[COORDINATES])
    return numbers[states : states + STATE * n].reshape(n, STATE)[:, LAMBDA]


@always_inlined
def first_state(whole: Any) -> Any:
    """Return where the states of the rows begin."""
    return GIVEN * whole[ROWS] + 2 * whole[COORDINATES]


@always_inlined
def _inverse(numbers: Any, whole: Any, place: Any) -> float:
    """Return the inverse mass of a coordinate; zero of what is fixed, and of an angle that never changes."""
    if 0 <= place < whole[COORDINATES]:
        return numbers[GIVEN * whole[ROWS] + place]  # type: ignore[no-any-return]
    return 0.0


@always_inlined
def _end(q: Any, v: Any, numbers: Any, whole: Any, end: int, arm: int) -> TermEnd:
    """Return a body at an end of a row, from where its places and its anchor are."""
    x, turn = whole[end], whole[end + 1]
    angle, spin = (q[turn], v[turn]) if turn >= 0 else (0.0, 0.0)
    return TermEnd(q[x], q[x + 1], angle, v[x], v[x + 1], spin, numbers[arm], numbers[arm + 1])


@always_inlined
def measure_rows(q: Any, v: Any, numbers: Any, whole: Any) -> None:
    """Find gradient, error and Jdot v of every row in a state."""
    for i in range(whole[ROWS]):
        r, w, s = GIVEN * i, FIRST + ENDS * i, first_state(whole) + STATE * i
        one = measure_term(
            ALONG, _end(q, v, numbers, whole, w, r + ARM_A), _end(q, v, numbers, whole, w + 2, r + ARM_B),
            numbers[r + AXIS], numbers[r + AXIS + 1],
        )  # fmt: skip
        numbers[s + JA], numbers[s + JA + 1], numbers[s + JA + 2] = one.ax, one.ay, one.turn_a
        numbers[s + JB], numbers[s + JB + 1], numbers[s + JB + 2] = one.bx, one.by, one.turn_b
        numbers[s + ERROR], numbers[s + RATE] = one.value, one.rate


@always_inlined
def _along(values: Any, numbers: Any, whole: Any, i: int) -> float:
    """Return the product of the gradient of row i with packed values."""
    w, s = FIRST + ENDS * i, first_state(whole) + STATE * i
    total = 0.0
    for end in range(2):
        x, turn, j = whole[w + 2 * end], whole[w + 2 * end + 1], s + JA + (JB - JA) * end
        total += numbers[j] * values[x] + numbers[j + 1] * values[x + 1]
        if turn >= 0:
            total += numbers[j + 2] * values[turn]
    return total


@always_inlined
def _response(numbers: Any, whole: Any, i: int, j: int) -> float:
    """Return how a unit force of row j accelerates row i [1/kg]: an element of A."""
    total, states = 0.0, first_state(whole)
    for one in range(2):
        x, turn = whole[FIRST + ENDS * i + 2 * one], whole[FIRST + ENDS * i + 2 * one + 1]
        mass, inertia = _inverse(numbers, whole, x), _inverse(numbers, whole, turn)
        if mass == 0.0 and inertia == 0.0:
            continue
        p = states + STATE * i + JA + (JB - JA) * one
        for other in range(2):
            if whole[FIRST + ENDS * j + 2 * other] == x:
                k = states + STATE * j + JA + (JB - JA) * other
                total += mass * (numbers[p] * numbers[k] + numbers[p + 1] * numbers[k + 1])
                total += inertia * numbers[p + 2] * numbers[k + 2]
    return total


@always_inlined
def factorise(numbers: Any, whole: Any) -> None:
    """Write A above the diagonal, and its factor L, A = L L^T, from the diagonal down."""
    n, states, rank = whole[ROWS], first_state(whole), 0
    matrix, begin = states + STATE * n, FIRST + ENDS * n
    for i in range(n):
        first = i
        for j in range(i + 1):
            response = _response(numbers, whole, i, j)
            numbers[matrix + n * j + i] = response
            numbers[matrix + n * i + j] = response
            if response != 0.0 and j < first:
                first = j
        whole[begin + i] = first
        numbers[states + STATE * i + DIAGONAL] = numbers[matrix + n * i + i]
    for i in range(n):
        for j in range(whole[begin + i], i + 1):
            left = numbers[matrix + n * i + j]
            for k in range(max(whole[begin + i], whole[begin + j]), j):
                left -= numbers[matrix + n * i + k] * numbers[matrix + n * j + k]
            if j < i:
                pivot = numbers[matrix + n * j + j]
                numbers[matrix + n * i + j] = left / pivot if pivot > 0.0 else 0.0
            elif left > _DEPENDENT * numbers[states + STATE * i + DIAGONAL]:
                numbers[matrix + n * i + i] = math.sqrt(left)
                rank += 1
            else:
                numbers[matrix + n * i + i] = 0.0
    whole[RANK] = rank


@always_inlined
def substitute(numbers: Any, whole: Any) -> None:
    """Find how the forces change from the right side; none for a dependent row."""
    n, states = whole[ROWS], first_state(whole)
    matrix, begin = states + STATE * n, FIRST + ENDS * n
    for i in range(n):
        left, pivot = numbers[states + STATE * i + RIGHT], numbers[matrix + n * i + i]
        for k in range(whole[begin + i], i):
            left -= numbers[matrix + n * i + k] * numbers[states + STATE * k + CHANGE]
        numbers[states + STATE * i + CHANGE] = left / pivot if pivot > 0.0 else 0.0
    for down in range(n):
        i = n - 1 - down
        pivot = numbers[matrix + n * i + i]
        solved = numbers[states + STATE * i + CHANGE] / pivot if pivot > 0.0 else 0.0
        numbers[states + STATE * i + CHANGE] = solved
        for k in range(whole[begin + i], i):
            numbers[states + STATE * k + CHANGE] -= numbers[matrix + n * i + k] * solved


@always_inlined
def solve(numbers: Any, whole: Any) -> None:
    """Find the forces of all rows from the right side, which is used up; refined once.

    What is light between heavy bodies gets the difference of large forces.
    """
    n, states = whole[ROWS], first_state(whole)
    matrix, begin = states + STATE * n, FIRST + ENDS * n
    for i in range(n):
        numbers[states + STATE * i + LAMBDA] = numbers[states + STATE * i + RIGHT]
    substitute(numbers, whole)
    for i in range(n):
        left = numbers[states + STATE * i + LAMBDA]
        left -= numbers[states + STATE * i + DIAGONAL] * numbers[states + STATE * i + CHANGE]
        for j in range(whole[begin + i], i):
            left -= numbers[matrix + n * j + i] * numbers[states + STATE * j + CHANGE]
        for j in range(i + 1, n):
            left -= numbers[matrix + n * i + j] * numbers[states + STATE * j + CHANGE]
        numbers[states + STATE * i + RIGHT] = left
    for i in range(n):
        numbers[states + STATE * i + LAMBDA] = numbers[states + STATE * i + CHANGE]
    substitute(numbers, whole)
    for i in range(n):
        numbers[states + STATE * i + LAMBDA] += numbers[states + STATE * i + CHANGE]


@always_inlined
def given_by_rows(q: Any, v: Any, numbers: Any, whole: Any) -> tuple[float, float, float, float]:
    """Return momentum and angular momentum that the forces of rows give in a second to what they move.

    Last, the power with which they act on what they do not move.
    """
    px, py, spin, driven, states = 0.0, 0.0, 0.0, 0.0, first_state(whole)
    for i in range(whole[ROWS]):
        s, w = states + STATE * i, FIRST + ENDS * i
        pull = numbers[s + LAMBDA]
        for end in range(2):
            x, turn, j = whole[w + 2 * end], whole[w + 2 * end + 1], s + JA + (JB - JA) * end
            fx, fy, torque = pull * numbers[j], pull * numbers[j + 1], pull * numbers[j + 2]
            if _inverse(numbers, whole, x) > 0.0:
                px += fx
                py += fy
                spin += q[x] * fy - q[x + 1] * fx
            else:
                driven += fx * v[x] + fy * v[x + 1]
            if _inverse(numbers, whole, turn) > 0.0:
                spin += torque
            elif turn >= 0:
                driven += torque * v[turn]
    return px, py, spin, driven


@always_inlined
def book_rows(q: Any, v: Any, given: Any, numbers: Any, whole: Any) -> None:
    """Add what the forces of rows give in a second to the accounts behind the clock."""
    px, py, spin, driven = given_by_rows(q, v, numbers, whole)
    account, hand = whole[BOOKED], whole[DRIVEN]
    if account >= 0:
        given[account + PX] += px
        given[account + PY] += py
        given[account + SPIN] += spin
    if hand >= 0:
        given[hand + ENERGY] -= driven


@always_inlined
def push_by_rows(target: Any, numbers: Any, whole: Any) -> None:
    """Add to velocities what the impulses of rows cause, or to accelerations what their forces do."""
    states = first_state(whole)
    for i in range(whole[ROWS]):
        s, w = states + STATE * i, FIRST + ENDS * i
        for end in range(2):
            x, turn, j = whole[w + 2 * end], whole[w + 2 * end + 1], s + JA + (JB - JA) * end
            pull = numbers[s + LAMBDA]
            target[x] += _inverse(numbers, whole, x) * numbers[j] * pull
            target[x + 1] += _inverse(numbers, whole, x) * numbers[j + 1] * pull
            if turn >= 0:
                target[turn] += _inverse(numbers, whole, turn) * numbers[j + 2] * pull


@force_kernel
def constrain(q, v, span, force, parameters, indices):  # type: ignore[no-untyped-def]
    """Add the forces of joints: those with which all rows stay as they are under the forces there by now.

    So it is the last of all forces. ``parameters`` and ``indices`` are the rows, as the module has them.
    """
    n, m = indices[ROWS], indices[COORDINATES]
    inverse, states = GIVEN * n, first_state(indices)
    damping = inverse + m
    measure_rows(q, v, parameters, indices)
    factorise(parameters, indices)
    for turn in range(2):  # what is light between heavy bodies is left with the difference of large forces
        for i in range(n):
            s, w, change = states + STATE * i, FIRST + ENDS * i, 0.0
            for end in range(2):
                x, angle, j = indices[w + 2 * end], indices[w + 2 * end + 1], s + JA + (JB - JA) * end
                for k in range(3):
                    place = x + k if k < 2 else angle
                    if 0 <= place < m:
                        gained = parameters[inverse + place] * force[place]
                        change += parameters[j + k] * (gained - parameters[damping + place] * v[place])
            parameters[s + RIGHT] = -(change + parameters[s + RATE])
        substitute(parameters, indices)
        for i in range(n):
            s, w = states + STATE * i, FIRST + ENDS * i
            pull = parameters[s + CHANGE]
            parameters[s + LAMBDA] = pull + (parameters[s + LAMBDA] if turn > 0 else 0.0)
            for end in range(2):
                x, angle, j = indices[w + 2 * end], indices[w + 2 * end + 1], s + JA + (JB - JA) * end
                force[x] += pull * parameters[j]
                force[x + 1] += pull * parameters[j + 1]
                if angle >= 0:
                    force[angle] += pull * parameters[j + 2]
    book_rows(q, v, force, parameters, indices)


@kernel
def project(q: Numbers, v: Numbers, q_low: Numbers, v_low: Numbers, numbers: Numbers, whole: Rows) -> float:
    """Move bodies by the least that closes what joints hold together, and remove their speeds apart.

    ``q_low`` and ``v_low`` (n,) are the remainders of what moves. Returns the largest error left [m]. What
    this changes of energy and momentum is an error of the method.
    """
    n, m, states, largest = whole[ROWS], whole[COORDINATES], first_state(whole), 0.0
    size, speed = 0.0, 0.0
    for i in range(m):
        size, speed = max(size, abs(q[i])), max(speed, abs(v[i]))
    for turn in range(4):
        measure_rows(q, v, numbers, whole)
        largest, fastest = 0.0, 0.0
        for i in range(n):
            error, rate = numbers[states + STATE * i + ERROR], _along(v, numbers, whole, i)
            largest, fastest = max(largest, abs(error)), max(fastest, abs(rate))
            numbers[states + STATE * i + RIGHT] = -error if turn < 3 else -rate
        limit = size if turn < 3 else speed
        if (largest if turn < 3 else fastest) <= _ROUNDING * limit:
            continue
        factorise(numbers, whole)
        solve(numbers, whole)
        for i in range(n):
            s, w = states + STATE * i, FIRST + ENDS * i
            for end in range(2):
                x, angle, j = whole[w + 2 * end], whole[w + 2 * end + 1], s + JA + (JB - JA) * end
                for k in range(3):
                    place = x + k if k < 2 else angle
                    if 0 <= place < m:
                        change = numbers[GIVEN * n + place] * numbers[j + k] * numbers[s + LAMBDA]
                        if turn < 3:
                            q[place], q_low[place] = add(q[place], q_low[place], change)
                        else:
                            v[place], v_low[place] = add(v[place], v_low[place], change)
    return largest
