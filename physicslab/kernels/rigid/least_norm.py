"""Forces that solve the equations of points that are closed, of least norm where these are singular.

M z = r says what closed points keep: no normal rate, and no tangential one where they stick. First
M^T (M M^T)^-1 r, refined; where that does not suffice M^T = Q R P (Golub & Van Loan, Matrix Computations,
2013, ch. 5), whose condition is only the root of that of M M^T.
"""

import math

from physicslab.kernels import always_inlined, inlined
from physicslab.kernels.rigid import equations as E
from physicslab.kernels.rigid.equations import Equations
from physicslab.kernels.rigid.features import MU, STATUS

_DAMPED = 1e-13
"""Share of the diagonal that is added to a matrix that may be singular; refinement removes its effect."""
_STALLED = 1e-11
"""Share of the free rates that equations of forces may leave where M M^T serves."""
_DEPENDENT = 1e-13
"""Share of the longest row of M below which what is left of another one is rounding."""
_CONTRADICTS = 1e-6
"""Share of the right sides up to which dependent equations agree."""
REFINEMENTS = 40
"""Largest number of refinements of a solution."""


@always_inlined
def _take_equations(equations: Equations, count: int, friction: float) -> int:
    """Write the matrix of the unknowns that are not given, M; return how many they are.

    Rows and columns are divided by the roots of the diagonal, so that masses of all sizes count alike.
    """
    n, order, a = 0, equations.order, equations.a
    for i in range(count):
        status = equations.points[i, STATUS]
        if status != E.OPEN:
            order[1, n] = 2 * i
            n += 1
            if status == E.STICKS:
                order[1, n] = 2 * i + 1
                n += 1
    for k in range(n):
        row = order[1, k]
        for j in range(n):
            column = order[1, j]
            value, status = a[row, column], equations.points[column // 2, STATUS]
            if column % 2 == 0 and status != E.STICKS:
                edge = E.edge_of(status, equations.measures[column // 2, MU])
                value += friction * edge * a[row, column + 1]
            equations.matrix[k, j] = value / math.sqrt(a[row, row] * a[column, column])
    return n


@always_inlined
def _factorise(equations: Equations, n: int) -> None:
    """Write the Cholesky factor of M M^T, slightly damped, into the tableau."""
    matrix, factor, largest = equations.matrix, equations.tableau, 0.0
    for i in range(n):
        for j in range(i + 1):
            product = 0.0
            for k in range(n):
                product += matrix[i, k] * matrix[j, k]
            factor[i, j] = product
        largest = max(largest, factor[i, i])
    for i in range(n):
        factor[i, i] += _DAMPED * largest
        for j in range(i + 1):
            value = factor[i, j]
            for k in range(j):
                value -= factor[i, k] * factor[j, k]
            if i == j:
                factor[i, i] = math.sqrt(max(value, _DAMPED * largest))
            else:
                factor[i, j] = value / factor[j, j]


@always_inlined
def _substitute(equations: Equations, n: int) -> None:
    """Replace the right side r by M^T (M M^T)^-1 r."""
    factor, vectors = equations.tableau, equations.vectors
    for i in range(n):
        for k in range(i):
            vectors[E.RIGHT, i] -= factor[i, k] * vectors[E.RIGHT, k]
        vectors[E.RIGHT, i] /= factor[i, i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            vectors[E.RIGHT, i] -= factor[k, i] * vectors[E.RIGHT, k]
        vectors[E.RIGHT, i] /= factor[i, i]
    for j in range(n):
        vectors[E.CHANGE, j] = 0.0
        for k in range(n):
            vectors[E.CHANGE, j] += equations.matrix[k, j] * vectors[E.RIGHT, k]
    for j in range(n):
        vectors[E.RIGHT, j] = vectors[E.CHANGE, j]


@inlined
def _factorise_orthogonally(equations: Equations, n: int) -> int:
    """Write the triangle and the reflections of M^T = Q R P into the tableau; return the rank of M.

    M itself loses half as many digits as M M^T: what is light between heavy bodies costs more than there are.
    Row i of the tableau has row P_i of R^T, then the direction of reflection i; behind them are 2 / v^2 and
    the diagonal of R.
    """
    factor, order, first = equations.tableau, equations.order, 0.0
    for i in range(n):
        order[0, i] = i
        for k in range(n):
            factor[i, k] = equations.matrix[i, k]
    for k in range(n):
        longest, square = k, -1.0
        for i in range(k, n):
            norm = 0.0
            for j in range(k, n):
                norm += factor[i, j] * factor[i, j]
            if norm > square:
                longest, square = i, norm
        first = math.sqrt(square) if k == 0 else first
        if math.sqrt(square) <= _DEPENDENT * first:
            return k
        order[0, k], order[0, longest] = order[0, longest], order[0, k]
        for j in range(n):
            factor[k, j], factor[longest, j] = factor[longest, j], factor[k, j]
        diagonal = -math.copysign(math.sqrt(square), factor[k, k])
        factor[k, k] -= diagonal
        factor[k, n] = -1.0 / (diagonal * factor[k, k])
        factor[k, n + 1] = diagonal
        for i in range(k + 1, n):
            share = 0.0
            for j in range(k, n):
                share += factor[k, j] * factor[i, j]
            share *= factor[k, n]
            for j in range(k, n):
                factor[i, j] -= share * factor[k, j]
    return n


@inlined
def _substitute_orthogonally(equations: Equations, n: int, rank: int) -> bool:
    """Replace the right side r by the shortest x with M x = r; return whether there is any."""
    factor, order, vectors, largest = equations.tableau, equations.order, equations.vectors, 0.0
    for i in range(n):
        largest = max(largest, abs(vectors[E.RIGHT, i]))
    for i in range(n):
        left = vectors[E.RIGHT, order[0, i]]
        for k in range(min(i, rank)):
            left -= factor[i, k] * vectors[E.CHANGE, k]
        if i >= rank and abs(left) > _CONTRADICTS * largest:
            return False
        vectors[E.CHANGE, i] = left / factor[i, n + 1] if i < rank else 0.0
    for k in range(rank - 1, -1, -1):
        share = 0.0
        for j in range(k, n):
            share += factor[k, j] * vectors[E.CHANGE, j]
        share *= factor[k, n]
        for j in range(k, n):
            vectors[E.CHANGE, j] -= share * factor[k, j]
    for i in range(n):
        vectors[E.RIGHT, i] = vectors[E.CHANGE, i]
    return True


@inlined
def begin_equations(equations: Equations, count: int, friction: float) -> int:
    """Factorise the equations of the points that are not open, of forces 0; return how many there are.

    Points that slide have ``friction`` (0 or 1) times their friction.
    """
    for i in range(2 * count):
        equations.vectors[E.UNKNOWN, i] = 0.0
    n = _take_equations(equations, count, friction)
    _factorise(equations, n)
    return n


@inlined
def refine(
    equations: Equations, count: int, n: int, friction: float, caused: int, largest: float, previous: float,
    rank: int,
) -> tuple[float, int]:  # fmt: skip
    """Change the forces so that what they cause, row ``caused`` of the vectors, vanishes.

    Returns the largest of it, or -1 where it is rounding of ``largest``, or not half of the ``previous`` one:
    then forces stay. The change is of the form M^T u, so that forces are of least norm where the equations
    are singular. ``rank`` is 0 while M M^T serves; where that does not suffice M takes over, and its rank is
    returned.
    """
    vectors, order, a, residual = equations.vectors, equations.order, equations.a, 0.0
    for k in range(n):
        row = order[1, k]
        vectors[E.RIGHT, k] = -vectors[caused, row] / math.sqrt(a[row, row])
        residual = max(residual, abs(vectors[caused, row]))
    if residual <= 2e-16 * largest or not residual < math.inf:
        return -1.0, rank
    if residual >= 0.5 * previous:
        if rank > 0 or friction == 0.0 or residual <= _STALLED * largest:
            return -1.0, rank
        rank = _factorise_orthogonally(equations, n)
    if rank == 0:
        _substitute(equations, n)
    elif not _substitute_orthogonally(equations, n, rank):
        return -1.0, rank
    for i in range(2 * count):
        vectors[E.CHANGE, i] = 0.0
    for k in range(n):
        row = order[1, k]
        change, status = vectors[E.RIGHT, k] / math.sqrt(a[row, row]), equations.points[row // 2, STATUS]
        vectors[E.CHANGE, row] += change
        if row % 2 == 0 and status != E.STICKS:
            edge = friction * E.edge_of(status, equations.measures[row // 2, MU])
            vectors[E.CHANGE, row + 1] += edge * change
    for i in range(2 * count):
        vectors[E.UNKNOWN, i] += vectors[E.CHANGE, i]
    return residual, rank


@inlined
def solve_equations(equations: Equations, count: int, friction: float) -> None:
    """Solve w = 0 for the points that are not open, along the tangent for those that stick.

    Those that slide have ``friction`` (0 or 1) times their friction.
    """
    vectors, largest, residual, rank = equations.vectors, 0.0, math.inf, 0
    for i in range(2 * count):
        largest = max(largest, abs(vectors[E.FREE, i]))
    n = begin_equations(equations, count, friction)
    for _ in range(REFINEMENTS):
        for k in range(n):
            row = equations.order[1, k]
            w = vectors[E.FREE, row]
            for j in range(2 * count):
                w += equations.a[row, j] * vectors[E.UNKNOWN, j]
            vectors[E.CAUSED, row] = w
        residual, rank = refine(equations, count, n, friction, E.CAUSED, largest, residual, rank)
        if residual < 0.0:
            break
