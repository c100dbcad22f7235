"""The implicit midpoint rule, by Newton's method with a banded matrix."""

import math

import numpy as np

from physicslab.kernels import Numbers, Rows, Vectors, inlined, kernel
from physicslab.kernels.compensated import add
from physicslab.kernels.dop853 import largest
from physicslab.kernels.force_calls import Calls, accelerate_over

__all__ = ["implicit_midpoint"]

_MOST_ITERATIONS = 40
_PARTS = 1024
"""Into how many parts a step may be divided, by halves, where Newton's method finds no end."""
_SLOW = 2
"""After so many iterations with an old matrix it is worked out anew in each: stiff rods turn as they go."""
_SMALL = 1e-3
"""The size of things [m] where all coordinates are zero."""
_EPSILON = 2.220446049250313e-16


@inlined
def _factorise(matrix: Vectors, pivots: Rows, band: int) -> None:
    """Turn a matrix (n, n) with ``band`` diagonals on either side into its triangular factors, in place."""
    n = len(pivots)
    for k in range(n):
        foot, end = min(k + band + 1, n), min(k + 2 * band + 1, n)
        best = k
        for i in range(k + 1, foot):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        pivots[k] = best
        if best != k:
            for j in range(k, end):
                matrix[k, j], matrix[best, j] = matrix[best, j], matrix[k, j]
        for i in range(k + 1, foot):
            share = matrix[i, k] / matrix[k, k]
            matrix[i, k] = share
            for j in range(k + 1, end):
                matrix[i, j] -= share * matrix[k, j]


@inlined
def _solve(matrix: Vectors, pivots: Rows, band: int, right: Numbers) -> None:
    """Solve with the factors, in place."""
    n = len(pivots)
    for k in range(n):
        best = pivots[k]
        right[k], right[best] = right[best], right[k]
        for i in range(k + 1, min(k + band + 1, n)):
            right[i] -= matrix[i, k] * right[k]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, min(k + 2 * band + 1, n)):
            right[k] -= matrix[k, j] * right[j]
        right[k] /= matrix[k, k]


@inlined
def _at_middle(
    q: Numbers, u: Numbers, stage_q: Numbers, acceleration: Numbers,
    inverse_mass: Numbers, damping: Numbers, calls: Calls, h: float,
) -> None:  # fmt: skip
    """Work out the acceleration over the step, in whose middle the velocity is ``u``."""
    for i in range(len(inverse_mass)):
        stage_q[i] = q[i] + 0.5 * h * u[i]
    accelerate_over(stage_q, u, h, acceleration, inverse_mass, damping, calls)


@inlined
def _differentiate(
    q: Numbers, u: Numbers, stage_q: Numbers, acceleration: Numbers, shifted: Numbers,
    inverse_mass: Numbers, damping: Numbers, calls: Calls, h: float,
    order: Rows, band: int, matrix: Vectors,
) -> int:  # fmt: skip
    """Fill in d(u - h/2 a)/du by differences, and return the evaluations.

    Columns further apart than the band is wide share no row, so they are shifted together (Curtis, Powell &
    Reid, J. Inst. Maths Applics 13 (1974) 117).
    """
    n = len(order)
    # Places move by sqrt(epsilon) of themselves.
    shift = 1.5e-8 * max(largest(u, n) + largest(q, n) / h, _SMALL / h)
    stride = min(2 * band + 1, n)
    moved = u.copy()
    for first in range(stride):
        for j in range(first, n, stride):
            moved[order[j]] += shift
        _at_middle(q, moved, stage_q, shifted, inverse_mass, damping, calls, h)
        for j in range(first, n, stride):
            moved[order[j]] = u[order[j]]
            for i in range(max(j - 2 * band, 0), min(j + 2 * band + 1, n)):
                matrix[i, j] = 0.0
            for i in range(max(j - band, 0), min(j + band + 1, n)):
                slope = (shifted[order[i]] - acceleration[order[i]]) / shift
                matrix[i, j] = (1.0 if i == j else 0.0) - 0.5 * h * slope
    return stride


@inlined
def _newton(
    q: Numbers, v: Numbers, u: Numbers, stage_q: Numbers, acceleration: Numbers, shifted: Numbers,
    residual: Numbers, inverse_mass: Numbers, damping: Numbers, calls: Calls, h: float,
    order: Rows, band: int, matrix: Vectors, pivots: Rows, known: bool,
) -> tuple[int, int]:  # fmt: skip
    """Solve for ``u``, beginning with what is in it; return the iterations (-1: no end) and evaluations.

    ``known`` says that ``matrix`` and ``pivots`` hold factors that may still do.
    """
    n = len(inverse_mass)
    before, evaluations = math.inf, 0
    for iteration in range(1, _MOST_ITERATIONS + 1):
        _at_middle(q, u, stage_q, acceleration, inverse_mass, damping, calls, h)
        evaluations += 1
        if (iteration == 1 and not known) or iteration > _SLOW:
            evaluations += _differentiate(
                q, u, stage_q, acceleration, shifted, inverse_mass, damping, calls, h, order, band, matrix
            )
            _factorise(matrix, pivots, band)
        for i in range(n):
            j = order[i]
            residual[i] = v[j] + 0.5 * h * acceleration[j] - u[j]
        _solve(matrix, pivots, band, residual)
        change = largest(residual, n)
        for i in range(n):
            u[order[i]] += residual[i]
        size = largest(u, n) + largest(q, n) / h  # below this times epsilon, places cannot tell
        if change <= 4.0 * _EPSILON * size or (change >= 0.5 * before and change <= 1e-10 * size):
            return iteration, evaluations
        if not math.isfinite(change):
            break
        before = change
    return -1, evaluations


@inlined
def _search(
    q: Numbers, v: Numbers, u: Numbers, stage_q: Numbers, acceleration: Numbers, shifted: Numbers,
    residual: Numbers, inverse_mass: Numbers, damping: Numbers, calls: Calls, h: float,
    order: Rows, band: int, matrix: Vectors, pivots: Rows, known: bool,
) -> tuple[int, int]:  # fmt: skip
    """Solve for ``u`` as :func:`_newton` does, from where there is a solution nearby.

    Where a spring swings many times a step, v is another way at the end of each and leads far away: the
    search begins where the bodies are. Where that finds nothing, v may, as on a rod that turns fast.
    """
    evaluations = 0
    for guess in range(2):
        for i in range(len(inverse_mass)):
            u[i] = guess * v[i]
        iterations, tried = _newton(
            q, v, u, stage_q, acceleration, shifted, residual, inverse_mass, damping, calls, h,
            order, band, matrix, pivots, known and guess == 0,
        )  # fmt: skip
        evaluations += tried
        if iterations > 0:
            return iterations, evaluations
    return -1, evaluations


@kernel
def implicit_midpoint(
    q: Numbers, v: Numbers, inverse_mass: Numbers, damping: Numbers, calls: Calls,
    order: Rows, band: int, h: float, steps: int,
) -> int:  # fmt: skip
    """Advance by ``steps`` steps of ``h`` seconds.

    Returns the number of force evaluations, or -1 if Newton's method finds no solution, not even of a small
    part of a step. The velocity u at the middle solves u = v + h/2 a(q + h/2 u, u), where a is the
    acceleration over the step. ``order`` (n,) is the order of the coordinates in which those that hang
    together lie within ``band`` of each other. Sums are compensated.
    """
    n = len(inverse_mass)
    stage_q, u, residual = q.copy(), v.copy(), np.empty(n)
    acceleration, shifted = np.empty(len(q)), np.empty(len(q))
    matrix, pivots = np.zeros((n, n)), np.zeros(n, np.int64)
    q_low, v_low = np.zeros(n), np.zeros(n)
    evaluations, known = 0, False
    for _ in range(steps):
        done, part = 0, _PARTS
        while done < _PARTS:
            span = h * part / _PARTS
            iterations, tried = _search(
                q, v, u, stage_q, acceleration, shifted, residual, inverse_mass, damping, calls, span,
                order, band, matrix, pivots, known,
            )  # fmt: skip
            evaluations += tried
            if iterations < 0 and part == 1:
                return -1
            known = part == _PARTS and 0 < iterations <= _SLOW
            if iterations < 0:
                part //= 2
                continue
            for i in range(n):
                q[i], q_low[i] = add(q[i], q_low[i], span * u[i])
                v[i], v_low[i] = add(v[i], v_low[i], 2.0 * (u[i] - v[i]))
            done += part
            if done % (2 * part) == 0:
                part *= 2
    return evaluations
