"""Rows of equations between bodies: the forces with which joints hold, and how errors of theirs are removed.

A row's quantity g is the sum of one or two terms (:mod:`physicslab.kernels.joints.terms`) less its offset; J
is its gradient, and its force acts by J^T. ``HOLD`` keeps g at zero, ``MOTOR`` J v at its target. The motion
solves [M J^T; J 0] [a; -lambda] = [f; -Jdot v]: with A = J M^-1 J^T, A lambda = -(J M^-1 f + Jdot v);
:mod:`physicslab.kernels.joints.envelope` solves that.

Rows are packed like forces (:mod:`physicslab.kernels.forces.force_calls`), in an array of numbers and one of
whole numbers, which kernels get as arrays or by pointers.
"""

from typing import Any

from physicslab.kernels import Numbers, Rows, always_inlined, kernel
from physicslab.kernels.accounts import ENERGY, book
from physicslab.kernels.forces.force_calls import force_kernel
from physicslab.kernels.joints import layout as L
from physicslab.kernels.joints.envelope import factorise, solve, substitute
from physicslab.kernels.joints.terms import HOLD, MOTOR, TermEnd, measure_term
from physicslab.kernels.ode.compensated import add

_POSITION_ROUNDING = 4e-16
"""Share of the largest coordinate, and of the largest speed, below which an error is rounding."""
_JUMP = 1e-9
"""Share of the largest speed above which a speed that joints do not allow is no error of a method."""
_MOST = 24
"""How often errors are measured while bodies are put together; three times do unless they were far apart."""
_FAR, _HALVED = 1e-6, 1 / 64
"""Share of the largest coordinate above which errors may not grow by a correction; it is halved where they
do, down to this share of it."""


@always_inlined
def _end(q: Any, v: Any, numbers: Any, place: Any, turn: Any, anchor: int, steady: int) -> TermEnd:
    """Return a body at an end of a term, from where its places and its anchor are."""
    angle, spin = (q[turn], v[turn]) if turn >= 0 else (numbers[steady], 0.0)
    return TermEnd(
        q[place], q[place + 1], angle, v[place], v[place + 1], spin, numbers[anchor], numbers[anchor + 1]
    )


@always_inlined
def measure_rows(q: Any, v: Any, numbers: Any, whole: Any) -> None:
    """Find gradient, error and Jdot v of every row in a state. A motor has no error: it holds no place."""
    for i in range(whole[L.ROWS]):
        w, s = L.FIRST + L.PLACES * i, L.first_state(whole) + L.STATE * i
        error, rate = 0.0, 0.0
        for term in range(2):
            if whole[w + L.MEASURE + term] < 0:
                break
            r, e, j = L.GIVEN * i + L.TERM * term, w + 4 * term, s + 6 * term
            one = measure_term(
                whole[w + L.MEASURE + term],
                _end(q, v, numbers, whole[e], whole[e + 1], r + L.ANCHOR_A, r + L.ANGLE_A),
                _end(q, v, numbers, whole[e + 2], whole[e + 3], r + L.ANCHOR_B, r + L.ANGLE_A + 1),
                numbers[r + L.AXIS], numbers[r + L.AXIS + 1],
            )  # fmt: skip
            scale = numbers[r + L.SCALE]
            numbers[j], numbers[j + 1], numbers[j + 2] = scale * one.ax, scale * one.ay, scale * one.turn_a
            numbers[j + 3], numbers[j + 4] = scale * one.bx, scale * one.by
            numbers[j + 5] = scale * one.turn_b
            error += scale * one.value
            rate += scale * one.rate
        numbers[s + L.ERROR] = error - numbers[L.GIVEN * i + L.OFFSET] if whole[w + L.ROLE] == HOLD else 0.0
        numbers[s + L.RATE] = rate


@always_inlined
def along_row(values: Any, numbers: Any, whole: Any, i: int) -> float:
    """Return the product of the gradient of row i with packed values: of speeds, how fast g grows."""
    w, s, total = L.FIRST + L.PLACES * i, L.first_state(whole) + L.STATE * i, 0.0
    for end in range(L.ENDS):
        x, turn, j = whole[w + 2 * end], whole[w + 2 * end + 1], s + 3 * end
        if x < 0:
            break
        total += numbers[j] * values[x] + numbers[j + 1] * values[x + 1]
        if turn >= 0:
            total += numbers[j + 2] * values[turn]
    return total


@always_inlined
def given_by_rows(
    q: Any, v: Any, numbers: Any, whole: Any, role: int
) -> tuple[float, float, float, float, float]:
    """Return the power of the forces of rows of a role, and momentum and angular momentum that they give.

    All of that in a second, momenta to what they move; last, the power with which they act on what they do
    not move, which is part of the first.
    """
    power, px, py, spin, driven, states = 0.0, 0.0, 0.0, 0.0, 0.0, L.first_state(whole)
    for i in range(whole[L.ROWS]):
        s, w = states + L.STATE * i, L.FIRST + L.PLACES * i
        if whole[w + L.ROLE] != role:
            continue
        pull = numbers[s + L.LAMBDA]
        power += pull * along_row(v, numbers, whole, i)
        for end in range(L.ENDS):
            x, turn, j = whole[w + 2 * end], whole[w + 2 * end + 1], s + 3 * end
            if x < 0:
                break
            fx, fy, torque = pull * numbers[j], pull * numbers[j + 1], pull * numbers[j + 2]
            if L.inverse_of(numbers, whole, x) > 0.0:
                px += fx
                py += fy
                spin += q[x] * fy - q[x + 1] * fx
            else:
                driven += fx * v[x] + fy * v[x + 1]
            if L.inverse_of(numbers, whole, turn) > 0.0:
                spin += torque
            elif turn >= 0:
                driven += torque * v[turn]
    return power, px, py, spin, driven


@always_inlined
def book_rows(q: Any, v: Any, given: Any, numbers: Any, whole: Any) -> None:
    """Add what the forces of rows give in a second to the accounts behind the clock.

    Holding forces do no work but on driven bodies; the little that they do by rounding is an error.
    """
    for role in (HOLD, MOTOR):
        account = whole[L.HOLDING] if role == HOLD else whole[L.POWERED]
        if account < 0:
            continue
        power, px, py, spin, driven = given_by_rows(q, v, numbers, whole, role)
        book(given, account, power if role == MOTOR else 0.0, px, py, spin)
        if whole[L.DRIVEN] >= 0:
            given[whole[L.DRIVEN] + ENERGY] -= driven


@always_inlined
def push_by_rows(target: Any, numbers: Any, whole: Any) -> None:
    """Add to velocities what the impulses of rows cause, or to accelerations what their forces do."""
    states = L.first_state(whole)
    for i in range(whole[L.ROWS]):
        s, w = states + L.STATE * i, L.FIRST + L.PLACES * i
        for end in range(L.ENDS):
            x, turn, j = whole[w + 2 * end], whole[w + 2 * end + 1], s + 3 * end
            if x < 0:
                break
            for k in range(3):
                place = x + k if k < 2 else turn
                if 0 <= place < whole[L.COORDINATES]:
                    change = L.inverse_of(numbers, whole, place) * numbers[j + k]
                    target[place] += change * numbers[s + L.LAMBDA]


@force_kernel
def constrain(q, v, span, force, parameters, indices):  # type: ignore[no-untyped-def]
    """Add the forces of joints: those with which all rows stay as they are under the forces there by now.

    So it is the last of all forces. ``parameters`` and ``indices`` are the rows, as the module has them.
    """
    n, m = indices[L.ROWS], indices[L.COORDINATES]
    inverse, states = L.GIVEN * n, L.first_state(indices)
    damping = inverse + m
    measure_rows(q, v, parameters, indices)
    factorise(parameters, indices)
    for turn in range(2):  # what is light between heavy bodies is left with the difference of large forces
        for i in range(n):
            s, w, change = states + L.STATE * i, L.FIRST + L.PLACES * i, 0.0
            for end in range(L.ENDS):
                x, angle, j = indices[w + 2 * end], indices[w + 2 * end + 1], s + 3 * end
                if x < 0:
                    break
                for k in range(3):
                    place = x + k if k < 2 else angle
                    if 0 <= place < m:
                        gained = parameters[inverse + place] * force[place]
                        change += parameters[j + k] * (gained - parameters[damping + place] * v[place])
            parameters[s + L.RIGHT] = -(change + parameters[s + L.RATE])
        substitute(parameters, indices)
        for i in range(n):
            s, w = states + L.STATE * i, L.FIRST + L.PLACES * i
            pull = parameters[s + L.CHANGE]
            parameters[s + L.LAMBDA] = pull + (parameters[s + L.LAMBDA] if turn > 0 else 0.0)
            for end in range(L.ENDS):
                x, angle, j = indices[w + 2 * end], indices[w + 2 * end + 1], s + 3 * end
                if x < 0:
                    break
                force[x] += pull * parameters[j]
                force[x + 1] += pull * parameters[j + 1]
                if angle >= 0:
                    force[angle] += pull * parameters[j + 2]
    book_rows(q, v, force, parameters, indices)


@always_inlined
def _errors(numbers: Numbers, whole: Rows) -> float:
    """Return the largest error, and leave those to be undone as right sides."""
    largest = 0.0
    for i in range(whole[L.ROWS]):
        s = L.first_state(whole) + L.STATE * i
        largest = max(largest, abs(numbers[s + L.ERROR]))
        numbers[s + L.RIGHT] = -numbers[s + L.ERROR]
    return largest


@always_inlined
def _rates(v: Numbers, numbers: Numbers, whole: Rows) -> float:
    """Return by how much speeds miss at most what rows demand, and leave that as right sides."""
    fastest = 0.0
    for i in range(whole[L.ROWS]):
        rate = along_row(v, numbers, whole, i) - numbers[L.GIVEN * i + L.TARGET]
        fastest = max(fastest, abs(rate))
        numbers[L.first_state(whole) + L.STATE * i + L.RIGHT] = -rate
    return fastest


@always_inlined
def _solved_changes(numbers: Numbers, whole: Rows) -> None:
    """Leave in the room how coordinates change by the least that makes up for the right sides."""
    room, m = L.first_room(whole), whole[L.COORDINATES]
    factorise(numbers, whole)
    solve(numbers, whole)
    for place in range(m):
        numbers[room + place] = 0.0
    push_by_rows(numbers[room : room + m], numbers, whole)


@always_inlined
def _size(values: Numbers, count: int) -> float:
    largest = 0.0
    for i in range(count):
        largest = max(largest, abs(values[i]))
    return largest


@kernel
def project(q: Numbers, v: Numbers, q_low: Numbers, v_low: Numbers, numbers: Numbers, whole: Rows) -> float:
    """Move bodies by the least that closes what joints hold together, and remove speeds that they forbid.

    ``q_low`` and ``v_low`` (n,) are the remainders of what moves. Returns the largest error left [m or rad]:
    more than rounding where joints contradict each other. The change of energy and momentum by this is an
    error of the method.
    """
    m, room, share, before = whole[L.COORDINATES], L.first_room(whole), 1.0, 0.0
    largest, size = 0.0, _size(q, m)
    for turn in range(_MOST):
        measure_rows(q, v, numbers, whole)
        largest = _errors(numbers, whole)
        if turn > 0 and largest > max(before, _FAR * size):
            back = 0.5 * share if share > _HALVED else share
            share -= back
            for i in range(m):
                q[i], q_low[i] = add(q[i], q_low[i], -back * numbers[room + i])
            continue
        if share == 0.0 or largest <= _POSITION_ROUNDING * size or (turn > 2 and largest > 0.5 * before):
            break
        _solved_changes(numbers, whole)
        for i in range(m):
            q[i], q_low[i] = add(q[i], q_low[i], numbers[room + i])
        before, share = largest, 1.0
    if _rates(v, numbers, whole) > _POSITION_ROUNDING * _size(v, m):
        _solved_changes(numbers, whole)
        for i in range(m):
            v[i], v_low[i] = add(v[i], v_low[i], numbers[room + i])
    return largest


@kernel
def set_going(q: Numbers, v: Numbers, numbers: Numbers, whole: Rows) -> bool:
    """Change speeds that joints do not allow, by their impulses; return whether there were any.

    Such as were given, or a motor's other speed. The work of the impulses, by the mean of the speeds before
    and after, and the momenta that they give are booked behind the clock.
    """
    measure_rows(q, v, numbers, whole)
    if _rates(v, numbers, whole) <= _JUMP * _size(v, whole[L.COORDINATES]):
        return False
    _solved_changes(numbers, whole)
    for turn in range(2):
        for role in (HOLD, MOTOR):
            account = whole[L.HOLDING] if role == HOLD else whole[L.POWERED]
            if account >= 0:
                power, px, py, spin, driven = given_by_rows(q, v, numbers, whole, role)
                book(v, account, 0.5 * power, 0.5 * px, 0.5 * py, 0.5 * spin)
                if whole[L.DRIVEN] >= 0:
                    v[whole[L.DRIVEN] + ENERGY] -= 0.5 * driven
        if turn == 0:
            for i in range(whole[L.COORDINATES]):
                v[i] += numbers[L.first_room(whole) + i]
    return True
