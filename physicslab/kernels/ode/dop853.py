"""Dormand and Prince's method of order 8, which chooses its own steps."""

import math

import numpy as np

from physicslab.kernels import Numbers, Rows, Vectors, allocating_kernel, always_inlined, inlined
from physicslab.kernels.accounts import ANGULAR_MOMENTUM, PX, PY
from physicslab.kernels.forces.budget import ACCOUNTS, CLOCK, END
from physicslab.kernels.forces.force_calls import Calls, accelerate
from physicslab.kernels.ode.compensated import add, add_pair
from physicslab.kernels.ode.dop853_tableau import (
    ESTIMATE_3,
    ESTIMATE_5,
    FIRST,
    LAST,
    NODES,
    NODES_LOW,
    STAGES,
    WEIGHTS,
    WEIGHTS_LOW,
    WITHIN,
)

TOO_SHORT = -1
"""Result where no step is short enough."""
NOT_FINITE = -2
"""Result where the forces at the start are not finite."""
EXHAUSTED = -3
"""Result where more force evaluations were made than are allowed."""
_SAFETY, _MAX_GROWTH, _MIN_GROWTH = 0.9, 6.0, 0.2
"""Safety factor of a step, and the limits of its growth and shrinkage at once."""
_LEADS = 1e-4
"""Share of the largest coordinate that must be covered in a step for speeds to be measured by themselves."""
_MIN_STEP = 1e-13
"""The shortest step, as a share of the time to go; shorter ones would never finish."""
_NEAR = 0.1
"""Distance of two bodies, as a share of their distance from the origin, below which it is moved to them."""
_NOISE = 1e-11
"""Share of the largest coordinate or speed above which an estimate is not taken for rounding."""
_STEEP = 100.0
"""How much worse an error of place may be than the error of speed that it makes in a free fall."""
_SHORT = 0.25
"""Share of a period below which steps need to be no better than forces are rounded."""
_MAX_FALL = 0.5
"""Largest share of the time of the fastest free fall, 1 / sqrt(G (m_a + m_b) / d^3), that a step may take:
the stages of longer ones may step over a close passage, and their error estimate with them."""


@inlined
def largest(values: Numbers, n: int) -> float:
    """Return the largest magnitude among the first ``n``."""
    found = 0.0
    for i in range(n):
        found = max(found, abs(values[i]))
    return found


@always_inlined
def make_stages(
    q: Numbers, v: Numbers, stage_q: Numbers, stage_v: Numbers, acceleration: Numbers, rates: Vectors,
    pushes: Vectors, inverse_mass: Numbers, damping: Numbers, calls: Calls, clock: int, booked: int, h: float,
    first: int, end: int,
) -> None:  # fmt: skip
    """Compute stages ``first`` to ``end - 1`` of a step from (q, v).

    ``rates`` and ``pushes`` (n, 16) take how much q' has changed since the start of the step, and v', of each
    stage; those of the stages before ``first`` are there. ``stage_q`` and ``stage_v`` are left at the last
    stage. Neither the speed at the start nor the weights are rounded where it would act alike in every step.
    Below the n coordinates, ``pushes`` takes as many as are ``booked`` behind the clock.
    """
    n = len(inverse_mass)
    for stage in range(first, end):
        stage_q[clock] = q[clock] + NODES[stage] * h
        for i in range(n):
            moved = NODES_LOW[stage] * v[i] + WEIGHTS[stage, 0] * rates[i, 0]
            pushed, pushed_low = WEIGHTS[stage, 0] * pushes[i, 0], WEIGHTS_LOW[stage, 0] * pushes[i, 0]
            for other in range(FIRST[stage], stage):
                moved += WEIGHTS[stage, other] * rates[i, other]
                pushed += WEIGHTS[stage, other] * pushes[i, other]
                pushed_low += WEIGHTS_LOW[stage, other] * pushes[i, other]
            rates[i, stage] = h * (pushed + pushed_low)
            stage_q[i] = q[i] + h * (NODES[stage] * v[i] + moved)
            stage_v[i] = v[i] + rates[i, stage]
        accelerate(stage_q, stage_v, acceleration, inverse_mass, damping, calls)
        for i in range(n):
            pushes[i, stage] = acceleration[i]
        for i in range(booked):
            pushes[n + i, stage] = acceleration[clock + 1 + i]


@inlined
def total(values: Numbers) -> tuple[float, float]:
    """Return the weighted sum of the stages, and what rounding leaves out of it."""
    indices, low = add(0.0, WEIGHTS_LOW[LAST, 0] * values[0], WEIGHTS[LAST, 0] * values[0])
    for stage in range(FIRST[LAST], LAST):
        indices, low = add(
            indices, low + WEIGHTS_LOW[LAST, stage] * values[stage], WEIGHTS[LAST, stage] * values[stage]
        )
    return indices, low


@inlined
def step_error(
    rates: Vectors, pushes: Vectors, h: float, q_scale: float, v_scale: float, tolerance: float
) -> float:
    """Return the estimated error of a step, 1 where it is just tolerated.

    It is measured against the largest coordinate and the largest speed of all.
    """
    fifth, third = 0.0, 0.0
    n = len(rates)
    for i in range(n):
        for values, scale in ((rates, q_scale), (pushes, v_scale)):
            high, low = ESTIMATE_5[0] * values[i, 0], ESTIMATE_3[0] * values[i, 0]
            for stage in range(FIRST[LAST], LAST):
                high += ESTIMATE_5[stage] * values[i, stage]
                low += ESTIMATE_3[stage] * values[i, stage]
            if scale > 0.0:
                high, low = high / scale, low / scale
                fifth += high * high
                third += low * low
    if fifth == 0.0 and third == 0.0:
        return 0.0
    return abs(h) * fifth / math.sqrt((fifth + 0.01 * third) * 2 * n) / tolerance


@inlined
def first_step(
    pushes: Vectors, n: int, q_scale: float, v_scale: float, span: float, tolerance: float
) -> float:
    """Return a careful guess at a first step [s] from the state and its acceleration (stage 0)."""
    push = 0.0
    for i in range(n):
        push = max(push, abs(pushes[i, 0]))
    guess = math.inf
    if q_scale > 0.0:
        if v_scale > 0.0:
            guess = min(guess, q_scale / v_scale)
        if push > 0.0:
            guess = min(guess, math.sqrt(q_scale / push))
    elif v_scale > 0.0 and push > 0.0:
        guess = max(v_scale / push, 1e-6 * span)
    return min(guess * math.pow(tolerance, 0.125), span)


@inlined
def all_finite(q: Numbers, v: Numbers, n: int) -> bool:
    """Whether every one of the first ``n`` numbers of both is finite; :func:`largest` may overlook NaN."""
    finite = True
    for i in range(n):
        finite = finite and math.isfinite(q[i]) and math.isfinite(v[i])
    return finite


@inlined
def _body_of_nearest(q: Numbers, bodies: int) -> int:
    """Return a body of the pair that is nearest for its distance from the origin, or -1 if none is near."""
    found, share = -1, _NEAR * _NEAR
    for i in range(bodies):
        x, y = q[2 * i], q[2 * i + 1]
        far = x * x + y * y
        for j in range(i + 1, bodies):
            dx, dy = q[2 * j] - x, q[2 * j + 1] - y
            apart = dx * dx + dy * dy
            if apart < share * far:
                found, share = i, apart / far
    return found


@inlined
def _move_origin(q: Numbers, q_low: Numbers, bodies: int, origin: Numbers, x: float, y: float) -> None:
    """Move the origin by (x, y), and keep in ``origin`` (4,) where it is: x and y, then their remainders."""
    for i in range(bodies):
        q[2 * i], q_low[2 * i] = add_pair(q[2 * i], q_low[2 * i], -x, 0.0)
        q[2 * i + 1], q_low[2 * i + 1] = add_pair(q[2 * i + 1], q_low[2 * i + 1], -y, 0.0)
    origin[0], origin[2] = add_pair(origin[0], origin[2], x, 0.0)
    origin[1], origin[3] = add_pair(origin[1], origin[3], y, 0.0)


@inlined
def _restore_origin(q: Numbers, q_low: Numbers, bodies: int, origin: Numbers) -> None:
    """Move the origin back to where it was at first."""
    for i in range(bodies):
        q[2 * i], q_low[2 * i] = add_pair(q[2 * i], q_low[2 * i], origin[0], origin[2])
        q[2 * i + 1], q_low[2 * i + 1] = add_pair(q[2 * i + 1], q_low[2 * i + 1], origin[1], origin[3])


@inlined
def _move_torques(pushes: Vectors, n: int, booked: int, x: float, y: float) -> None:
    """Take the torques of the first stage of a step about (x, y) instead of the origin."""
    for account in range(n, n + booked, ACCOUNTS):
        pushes[account + ANGULAR_MOMENTUM, 0] -= x * pushes[account + PY, 0] - y * pushes[account + PX, 0]


@inlined
def _book(
    v: Numbers, pushes: Vectors, n: int, clock: int, booked: int, origin: Numbers, taken: float
) -> None:
    """Book what causes have given in a step; their torques were about ``origin``."""
    for i in range(booked):
        # Stages 1 to 4 have no weight; in two sums, as each addition waits for the one before.
        early = WEIGHTS[LAST, 0] * pushes[n + i, 0]
        late = WEIGHTS[LAST, 8] * pushes[n + i, 8]
        for stage in range(5, 8):
            early += WEIGHTS[LAST, stage] * pushes[n + i, stage]
            late += WEIGHTS[LAST, stage + 4] * pushes[n + i, stage + 4]
        given = early + late
        v[clock + 1 + i] += taken * given
        pushes[n + i, 0] = pushes[n + i, LAST]
        if i % ACCOUNTS == PX:
            v[clock + 1 + i - PX + ANGULAR_MOMENTUM] -= origin[1] * taken * given
        elif i % ACCOUNTS == PY:
            v[clock + 1 + i - PY + ANGULAR_MOMENTUM] += origin[0] * taken * given


@inlined
def _bend(rates: Vectors, pushes: Vectors, h: float, bends: Vectors) -> None:
    """Find the terms (n, 14) by which the motion within a step departs from a steady one."""
    for i in range(len(bends)):
        for values, first in ((rates, 0), (pushes, 7)):
            # Rates are without the speed at the start: they begin with zero.
            begins = 0.0 if first == 0 else h * values[i, 0]
            gained, _ = total(values[i])
            ends = h * values[i, LAST]
            bends[i, first] = h * gained
            bends[i, first + 1] = begins - h * gained
            bends[i, first + 2] = 2.0 * h * gained - begins - ends
            for term in range(4):
                bend = WITHIN[term, 0] * values[i, 0]
                for stage in range(FIRST[LAST], STAGES):
                    bend += WITHIN[term, stage] * values[i, stage]
                bends[i, first + 3 + term] = h * bend


@inlined
def _place_within(
    q: Numbers, v: Numbers, q_low: Numbers, v_low: Numbers, bends: Vectors, h: float, share: float,
    bodies: int, origin: Numbers, q_sample: Numbers, v_sample: Numbers,
) -> None:  # fmt: skip
    """Write where all is, and how fast (n,), after a share of a step of ``h`` seconds from (q, v)."""
    rest = 1.0 - share
    for i in range(len(bends)):
        moved, gained = 0.0, 0.0
        for term in range(6, -1, -1):
            along = share if term % 2 == 0 else rest
            moved, gained = along * (moved + bends[i, term]), along * (gained + bends[i, 7 + term])
        q_sample[i] = q[i] + (share * h * v[i] + moved + q_low[i])
        v_sample[i] = v[i] + (gained + v_low[i])
        if i < 2 * bodies:
            q_sample[i] += origin[i % 2]


@allocating_kernel
def dop853(
    q: Numbers, v: Numbers, q_low: Numbers, v_low: Numbers, inverse_mass: Numbers, damping: Numbers,
    calls: Calls, places: Rows, span: float, tolerance: float, period: float, max_evaluations: int,
    bodies: int, steepness: Numbers, floor: float, after: Numbers, q_samples: Vectors, v_samples: Vectors,
) -> int:  # fmt: skip
    """Advance by ``span`` seconds; return the number of force evaluations, or why it failed (negative).

    Within any ``period`` seconds of it at most ``max_evaluations`` force evaluations are made: a long span
    may take many, but none of its parts may run without end.

    A step is made again, shorter, where its error is estimated to be more than ``tolerance`` of the largest
    coordinate or speed: of those that were reached, or that the step reaches by the velocities and forces at
    its start. What its stages reach is no measure, as in a step beyond the limit of stability it grows with
    the error. With tolerances of at most 0.01 every such step is made again: its error is at least half of
    what it amplifies. Sums are compensated: ``q_low`` and ``v_low`` (n,) are the remainders of what moves,
    and are carried on.

    ``steepness`` (1,) is where forces note the square of the fastest rate of a free fall [1/s^2], if any
    does. It bounds the step, and errors of place count by what they change in the forces; the largest is
    left there.

    ``floor`` [m/s^2] is how far rounding puts off accelerations where large forces cancel. Steps shorter than
    a part of the period need to be no better than that: what comes to rest at the origin leaves neither
    coordinate nor speed to measure errors by.

    ``q_samples`` and ``v_samples`` (m, n) receive coordinates and rates at times ``after`` the start (m,)
    [s], ascending and within the span. They are found to order 7 by three more evaluations for a step within
    which one is due, which are not counted: the motion keeps its bits. Their error, besides that of the steps
    before, is at most some four times the tolerance.

    Where no force depends on the origin, ``bodies`` is how many pairs of coordinates the first ones are, and
    else 0: in a close passage the origin is moved there, so that the distance has all its digits.

    Behind the clock, v takes what causes give (:mod:`physicslab.kernels.forces.budget`).
    """
    n, clock = len(inverse_mass), places[CLOCK]
    start, booked = q[clock], places[END] - places[CLOCK] - 1
    stage_q, stage_v, acceleration = q.copy(), v.copy(), np.empty(len(q))
    rates, pushes = np.zeros((n, STAGES)), np.zeros((n + booked, STAGES))
    q_scale, v_scale, steepest = largest(q, n), largest(v, n), steepness[0]
    steepness[0] = 0.0
    make_stages(
        q, v, stage_q, stage_v, acceleration, rates, pushes, inverse_mass, damping, calls, clock, booked, 0.0,
        0, 1,
    )  # fmt: skip
    if not all_finite(acceleration, stage_v, n):
        return NOT_FINITE
    evaluations, done, done_low = 1, 0.0, 0.0
    h = first_step(pushes, n, q_scale, v_scale, span, tolerance)
    grow, last_error, last_taken, noise = _MAX_GROWTH, math.inf, 1.0, _NOISE / tolerance
    last_fall2 = steepness[0]
    spent, mark = 0, 0.0
    origin, moved_origin = np.zeros(4), False
    sample, bends = 0, np.zeros((n if len(after) else 0, 14))
    while True:
        left = (span - done) - done_low
        if left <= 0.0:
            break
        near = _body_of_nearest(q, bodies)
        if near >= 0:
            _move_torques(pushes, n, booked, q[2 * near], q[2 * near + 1])
            _move_origin(q, q_low, bodies, origin, q[2 * near], q[2 * near + 1])
            moved_origin, q_scale = True, largest(q, n)
        last = h >= left
        taken = left if last else min(h, 0.5 * left) if h > 0.9 * left else h
        if taken < _MIN_STEP * span and not last:
            evaluations = TOO_SHORT
            break
        if done - mark >= period:
            spent, mark = 0, done
        if spent > max_evaluations - LAST:
            evaluations = EXHAUSTED
            break
        steepness[0] = 0.0
        make_stages(
            q, v, stage_q, stage_v, acceleration, rates, pushes,
            inverse_mass, damping, calls, clock, booked, taken, 1, LAST + 1,
        )  # fmt: skip
        fall2 = max(last_fall2, steepness[0])
        evaluations += LAST
        spent += LAST
        push = 0.0
        for i in range(n):
            push = max(push, abs(pushes[i, 0]))
        q_end, v_end = max(q_scale, largest(stage_q, n)), max(v_scale, largest(stage_v, n))
        v_reach = min(v_end, v_scale + taken * push)
        q_reach = min(q_end, q_scale + taken * v_reach)
        fall = math.sqrt(fall2)
        counts = min(q_reach, _STEEP * v_reach / fall) if fall > 0.0 else q_reach
        # Where all is at rest, the measure is the distance that an error of the speed makes within the step.
        speed = max(v_reach, _LEADS * counts / taken)
        if taken < _SHORT * period:
            speed = max(speed, floor * taken / tolerance)
            counts = max(counts, floor * taken * taken / tolerance)
        error = step_error(rates, pushes, taken, counts, speed, tolerance)
        if not (math.isfinite(error) and all_finite(stage_q, stage_v, n)):
            h, grow = _MIN_GROWTH * taken, 1.0
            last_error = math.inf
            continue
        factor = min(max(_SAFETY * math.pow(error, -0.125), _MIN_GROWTH), grow) if error > 0.0 else grow
        h = factor * taken
        # Rounding decreases as the step, a kink of the force as its square: no shorter step is better.
        rounding = error < noise and error > last_error * math.pow(taken / last_taken, 1.5)
        leaps = taken * fall > _MAX_FALL
        if fall > 0.0:
            h = min(h, _SAFETY * _MAX_FALL / fall)
        if leaps or (error > 1.0 and not rounding):
            grow, last_error, last_taken = 1.0, error, taken
            continue
        if rounding:
            h = taken
        last_fall2, steepest = steepness[0], max(steepest, fall2)
        grow, last_error = _MAX_GROWTH, math.inf
        if sample < len(after) and (after[sample] - done) - done_low <= taken:
            make_stages(
                q, v, stage_q, stage_v, acceleration, rates, pushes,
                inverse_mass, damping, calls, clock, booked, taken, LAST + 1, STAGES,
            )  # fmt: skip
            _bend(rates, pushes, taken, bends)
            while sample < len(after) and (after[sample] - done) - done_low <= taken:
                share = ((after[sample] - done) - done_low) / taken
                _place_within(
                    q, v, q_low, v_low, bends, taken, share, bodies, origin, q_samples[sample],
                    v_samples[sample],
                )  # fmt: skip
                sample += 1
        for i in range(n):
            moved, moved_low = total(rates[i])
            pushed, pushed_low = total(pushes[i])
            moved, moved_low = add(v[i], v_low[i] + moved_low, moved)
            q_low[i] += taken * moved_low
            v_low[i] += taken * pushed_low
            q[i], q_low[i] = add(q[i], q_low[i], taken * moved)
            v[i], v_low[i] = add(v[i], v_low[i], taken * pushed)
            pushes[i, 0] = pushes[i, LAST]
        _book(v, pushes, n, clock, booked, origin, taken)
        done, done_low = add(done, done_low, taken)
        q[clock] = start + done
        if last:
            break
        q_scale, v_scale = q_end, v_end
    steepness[0] = steepest
    if moved_origin:
        _restore_origin(q, q_low, bodies, origin)
    return evaluations
