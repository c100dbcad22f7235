"""The implicit midpoint rule, more implicit where something resists motion, by Newton's method."""

import math
from typing import NamedTuple

import numpy as np

from physicslab.kernels import Numbers, Rows, Vectors, allocating, allocating_kernel, inlined
from physicslab.kernels.clock import step_grid
from physicslab.kernels.forces.budget import CLOCK, DAMPED
from physicslab.kernels.forces.force_calls import Calls, accelerate_over
from physicslab.kernels.ode.compensated import add
from physicslab.kernels.ode.dop853 import all_finite, largest

_MAX_ITERATIONS = 40
_PARTS = 1024
"""Largest number of parts of a step that is halved where Newton's method does not converge."""
_SLOW = 2
"""Number of iterations with an old matrix, after which it is computed in each: stiff rods turn meanwhile."""
_FAR = 1e-6
"""Relative change beyond which the old matrix is not reused with dampers: they turn meanwhile."""
_SMALL = 1e-3
"""The length scale [m] where all coordinates are zero."""
_EPSILON = 2.220446049250313e-16


class Unknowns(NamedTuple):
    """A step to be solved: the state and the laws, and the room for Newton's method.

    Attributes
    ----------
    q, v, stage_q : float64 arrays (size,)
        The state at the beginning, as :func:`implicit_midpoint` takes it, and where forces are evaluated.
    inverse_mass, damping, calls, resistances, order, band
        As :func:`implicit_midpoint` takes them; n is the length of ``inverse_mass``.
    x, shifted : float64 arrays (m,)
        The unknowns: the mean velocity u; where something resists motion, then y, the end velocity less u.
        And room for residuals.
    stack, acceleration : float64 arrays (3 size,), (size,)
        y, u and v one after the other; and what forces make of them.
    matrix, pivots : float64 array (m, 3 band + 1), int64 array (m,)
        The factors of the slope.
    """

    q: Numbers
    v: Numbers
    stage_q: Numbers
    inverse_mass: Numbers
    damping: Numbers
    calls: Calls
    resistances: Calls
    order: Rows
    band: int
    x: Numbers
    shifted: Numbers
    stack: Numbers
    acceleration: Numbers
    matrix: Vectors
    pivots: Rows


@inlined
def _factorise(matrix: Vectors, pivots: Rows, band: int) -> None:
    """Turn a matrix with ``band`` diagonals on either side into its triangular factors, in place.

    Row i of ``matrix`` (n, 3 band + 1) holds columns i - band to i + 2 band: exchanged rows reach so far.
    """
    n = len(pivots)
    for k in range(n):
        foot, end = min(k + band + 1, n), min(k + 2 * band + 1, n)
        best = k
        for i in range(k + 1, foot):
            if abs(matrix[i, k - i + band]) > abs(matrix[best, k - best + band]):
                best = i
        pivots[k] = best
        if best != k:
            for j in range(k, end):
                here, there = j - k + band, j - best + band
                matrix[k, here], matrix[best, there] = matrix[best, there], matrix[k, here]
        for i in range(k + 1, foot):
            share = matrix[i, k - i + band] / matrix[k, band]
            matrix[i, k - i + band] = share
            for j in range(k + 1, end):
                matrix[i, j - i + band] -= share * matrix[k, j - k + band]


@inlined
def _solve(matrix: Vectors, pivots: Rows, band: int, right: Numbers) -> None:
    """Solve with the factors, in place."""
    n = len(pivots)
    for k in range(n):
        best = pivots[k]
        right[k], right[best] = right[best], right[k]
        for i in range(k + 1, min(k + band + 1, n)):
            right[i] -= matrix[i, k - i + band] * right[k]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, min(k + 2 * band + 1, n)):
            right[k] -= matrix[k, j - k + band] * right[j]
        right[k] /= matrix[k, band]


@inlined
def _miss(of: Unknowns, x: Numbers, h: float, miss: Numbers, given: Numbers) -> None:
    """Compute the residual of the equations of the step at ``x`` into ``miss`` (m,).

    ``given`` takes what causes give in a second, or a part of that.
    """
    q, v, stack, acceleration = of.q, of.v, of.stack, of.acceleration
    n, size = len(of.inverse_mass), len(q)
    mean = stack[size : 2 * size]
    for i in range(n):
        mean[i] = x[i]
        of.stage_q[i] = q[i] + 0.5 * h * x[i]
    accelerate_over(of.stage_q, mean, h, acceleration, of.inverse_mass, of.damping, of.calls)
    for i in range(len(given)):
        given[i] = acceleration[size - len(given) + i]
    if len(x) == n:
        for i in range(n):
            miss[i] = v[i] + 0.5 * h * acceleration[i] - x[i]
        return
    for i in range(n):
        miss[n + i] = h * acceleration[i] - (x[i] - v[i]) - x[n + i]
        stack[i], stack[2 * size + i] = x[n + i], v[i]
    accelerate_over(of.stage_q, stack, h, acceleration, of.inverse_mass, of.damping, of.resistances)
    for i in range(n):
        miss[i] = x[n + i] - h * acceleration[i] - (x[i] - v[i])


@allocating
def _differentiate(of: Unknowns, h: float, miss: Numbers) -> int:
    """Fill in minus the slope of :func:`_miss` by differences, and return the evaluations.

    Columns further apart than the band is wide share no row, so they are shifted together (Curtis, Powell &
    Reid, J. Inst. Maths Applics 13 (1974) 117).
    """
    x, order, band, shifted = of.x, of.order, of.band, of.shifted
    n = len(order)
    # Places move by sqrt(epsilon) of themselves.
    shift = 1.5e-8 * max(largest(x, n) + largest(of.q, len(of.inverse_mass)) / h, _SMALL / h)
    stride = min(2 * band + 1, n)
    # A rotation curves so much within the shift that strong dampers need central differences.
    both = n > len(of.inverse_mass)
    moved, below, none = x.copy(), miss.copy(), np.empty(0)
    for first in range(stride):
        for j in range(first, n, stride):
            moved[order[j]] = x[order[j]] + shift
        _miss(of, moved, h, shifted, none)
        if both:
            for j in range(first, n, stride):
                moved[order[j]] = x[order[j]] - shift
            _miss(of, moved, h, below, none)
        for j in range(first, n, stride):
            moved[order[j]] = x[order[j]]
            for i in range(max(j - 2 * band, 0), max(j - band, 0)):
                of.matrix[i, j - i + band] = 0.0
            for i in range(max(j - band, 0), min(j + band + 1, n)):
                slope = (below[order[i]] - shifted[order[i]]) / (2.0 * shift if both else shift)
                of.matrix[i, j - i + band] = slope
    return 2 * stride if both else stride


@inlined
def _newton(of: Unknowns, h: float, miss: Numbers, known: bool, given: Numbers) -> tuple[int, int]:
    """Solve for ``of.x``, beginning with what is in it; return iterations (-1: none fits) and evaluations.

    ``known`` means that the factors at hand may still be good enough.
    """
    x, n, residual = of.x, len(of.order), of.shifted
    before, evaluations, far = math.inf, 0, False
    for iteration in range(1, _MAX_ITERATIONS + 1):
        _miss(of, x, h, miss, given)
        evaluations += 1
        if (iteration == 1 and not known) or iteration > _SLOW or far:
            evaluations += _differentiate(of, h, miss)
            _factorise(of.matrix, of.pivots, of.band)
        for i in range(n):
            residual[i] = miss[of.order[i]]
        _solve(of.matrix, of.pivots, of.band, residual)
        change = largest(residual, n)
        for i in range(n):
            x[of.order[i]] += residual[i]
        # Below this times epsilon, coordinates cannot resolve a difference.
        size = largest(x, n) + largest(of.q, len(of.inverse_mass)) / h
        if change <= 4.0 * _EPSILON * size or (change >= 0.5 * before and change <= 1e-10 * size):
            return (iteration if all_finite(x, residual, n) else -1), evaluations
        if not math.isfinite(change):
            break
        before, far = change, n > len(of.inverse_mass) and change > _FAR * size
    return -1, evaluations


@inlined
def _search(of: Unknowns, h: float, miss: Numbers, known: bool, given: Numbers) -> tuple[int, int]:
    """Solve for ``of.x`` as :func:`_newton` does, from where there is a solution nearby.

    Where a spring oscillates many times a step, v has another direction at the end of each and leads far
    away: the search begins where the bodies are. Where that fails, it begins with v, as on a fast rod.
    """
    evaluations = 0
    for guess in range(2):
        for i in range(len(of.order)):
            of.x[i] = guess * of.v[i] if i < len(of.inverse_mass) else 0.0
        iterations, tried = _newton(of, h, miss, known and guess == 0, given)
        evaluations += tried
        if iterations > 0:
            return iterations, evaluations
    return -1, evaluations


@inlined
def _work_beside_mean(v: Numbers, x: Numbers, inverse_mass: Numbers) -> float:
    """Return the work [J] of the change of velocities, by the mean of both ends less that of the step."""
    n, work = len(inverse_mass), 0.0
    for i in range(n):
        if inverse_mass[i] > 0.0:
            work += 0.5 * (x[i] - v[i] + x[n + i]) * (v[i] - x[i] + x[n + i]) / inverse_mass[i]
    return work


@allocating_kernel
def implicit_midpoint(
    q: Numbers, v: Numbers, q_low: Numbers, v_low: Numbers, inverse_mass: Numbers, damping: Numbers,
    calls: Calls, resistances: Calls, places: Rows, order: Rows, band: int, h: float, steps: int,
) -> int:  # fmt: skip
    """Advance by ``steps`` steps of ``h`` seconds.

    Returns the number of force evaluations, or -1 if Newton's method finds no solution, not even of a small
    part of a step. With the mean velocity u of the step and a, the acceleration over it, the velocity goes
    from v to v + h a and the place from q to q + h u, where u - v = (1 + Z) (v + h a - u). Z = h W C is what
    ``resistances`` and ``damping`` make of the matrix C of damping and the inverse masses W; with none,
    u = v + h/2 a. ``order`` is the order of u, and of y = v + h a - u behind it where there is a Z, in which
    coupled ones are within ``band`` of each other. Sums are compensated: ``q_low`` and ``v_low`` (n,) are the
    remainders of what moves, and are carried on. Forces are those of the time in the middle of the step.

    Behind the clock, v takes what causes give (:mod:`physicslab.kernels.forces.budget`) at the mean
    velocity. Where that is not the mean of both ends, dampers and drag have done the work that this makes.
    """
    n, m, clock = len(inverse_mass), len(order), places[CLOCK]
    (begin, first), given = step_grid(q[clock], h), np.zeros(len(q) - clock - 1)
    stage_q, x, miss = q.copy(), np.zeros(m), np.empty(m)
    of = Unknowns(
        q, v, stage_q, inverse_mass, damping, calls, resistances, order, band, x, np.empty(m),
        np.zeros(3 * len(q)), np.empty(len(q)), np.zeros((m, 3 * band + 1)), np.zeros(m, np.int64),
    )  # fmt: skip
    evaluations, known = 0, False
    for step in range(steps):
        done, part = 0, _PARTS
        while done < _PARTS:
            span = h * part / _PARTS
            stage_q[clock] = begin + (first + step + (done + 0.5 * part) / _PARTS) * h
            iterations, tried = _search(of, span, miss, known, given)
            evaluations += tried
            if iterations < 0 and part == 1:
                return -1
            known = part == _PARTS and 0 < iterations <= _SLOW
            if iterations < 0:
                part //= 2
                continue
            for i in range(len(given)):
                v[clock + 1 + i] += span * given[i]
            if m > n and places[DAMPED] >= 0:
                v[places[DAMPED]] += _work_beside_mean(v, x, inverse_mass)
            for i in range(n):
                q[i], q_low[i] = add(q[i], q_low[i], span * x[i])
                v[i], v_low[i] = add(v[i], v_low[i], x[i] - v[i] + (x[n + i] if m > n else x[i] - v[i]))
            done += part
            if done % (2 * part) == 0:
                part *= 2
    return evaluations
