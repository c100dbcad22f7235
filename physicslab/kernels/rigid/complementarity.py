"""Forces of contacts that may open and slide: a linear complementarity problem, solved to rounding.

Point i has a normal and a tangential unknown, z[2 i] and z[2 i + 1]: forces, or impulses. What they cause is
w = A z + b: accelerations, or velocities. The laws are 0 <= z_n, 0 <= w_n, z_n w_n = 0, and Coulomb's
|z_t| <= mu z_n, with w_t = 0 where that holds strictly and w_t against z_t where not. In two dimensions the
cone has two edges, and all of that is linear (Acary & Brogliato, Numerical Methods for Nonsmooth Dynamical
Systems, 2008, ch. 9). A point that slides already has its edge given.

At first all points are taken to be closed; the equations are solved directly, and points whose law is
violated change over, one at a time. Where that does not end, Lemke's pivots do. Where forces are not
determined, as under a table with four legs, they are those of the least norm.
"""

import math

from physicslab.kernels import fused, inlined
from physicslab.kernels.rigid.equations import (
    CAUSED,
    CHANGE,
    FREE,
    OPEN,
    RIGHT,
    SLIDES_BACK,
    SLIDES_ON,
    STICKS,
    UNKNOWN,
    Equations,
    edge_of,
)
from physicslab.kernels.rigid.features import GIVEN, MU, STATUS
from physicslab.kernels.rigid.lemke import find_by_pivots

__all__ = [
    "FITTING", "NOT_FOUND", "REFINEMENTS", "SETTLED", "begin_equations", "refine", "settle_at_an_edge",
    "solve_complementarity", "solve_equations",
]  # fmt: skip

_ROUNDING = 1e-4
"""Share of the motion of points that slide in any case, whose rounding is in all that they touch."""
_TOLERANCE = 1e-11
"""Share of the largest free acceleration, or of the largest force, up to which a law counts as kept."""
_DAMPED = 1e-13
"""Share of the diagonal that is added to a matrix that may be singular; refinement removes its effect."""
NOT_FOUND, FITTING, SETTLED = 0, 1, 2
"""Whether forces were found."""
_OF_SUMS = 4e-16
"""Share of the sum of magnitudes by which a sum may be rounded."""
_FEW_CHANGES = 4
"""Number of changes that are tried before the pivots where they are good enough."""
_SLACKS = (1e-10, 1e-12, 1e-8, 1e-9, 1e-7)
"""Slacks of the pivots, one after the other."""
_AT_REST = 1e-7
"""Share of the largest free acceleration below which what pivots leave open or sliding may be at rest."""
_INSIDE = 1e-6
"""Share of a friction cone within which pivots leave the force on its edge: they are found with raised
sides."""
_STALLED = 1e-11
"""Share of the free rates that equations of forces may leave where M M^T serves."""
_DEPENDENT = 1e-13
"""Share of the longest row of M below which what is left of another one is rounding."""
_CONTRADICTS = 1e-6
"""Share of the right sides up to which dependent equations agree."""
REFINEMENTS = 40
"""Largest number of refinements of a solution."""


@fused
def _take_equations(equations: Equations, count: int, friction: float) -> int:
    """Write the matrix of the unknowns that are not given, M; return how many they are.

    Rows and columns are divided by the roots of the diagonal, so that masses of all sizes count alike.
    """
    n, order, a = 0, equations.order, equations.a
    for i in range(count):
        status = equations.points[i, STATUS]
        if status != OPEN:
            order[1, n] = 2 * i
            n += 1
            if status == STICKS:
                order[1, n] = 2 * i + 1
                n += 1
    for k in range(n):
        row = order[1, k]
        for j in range(n):
            column = order[1, j]
            value, status = a[row, column], equations.points[column // 2, STATUS]
            if column % 2 == 0 and status != STICKS:
                value += friction * edge_of(status, equations.measures[column // 2, MU]) * a[row, column + 1]
            equations.matrix[k, j] = value / math.sqrt(a[row, row] * a[column, column])
    return n


@fused
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


@fused
def _substitute(equations: Equations, n: int) -> None:
    """Replace the right side r by M^T (M M^T)^-1 r."""
    factor, vectors = equations.tableau, equations.vectors
    for i in range(n):
        for k in range(i):
            vectors[RIGHT, i] -= factor[i, k] * vectors[RIGHT, k]
        vectors[RIGHT, i] /= factor[i, i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            vectors[RIGHT, i] -= factor[k, i] * vectors[RIGHT, k]
        vectors[RIGHT, i] /= factor[i, i]
    for j in range(n):
        vectors[CHANGE, j] = 0.0
        for k in range(n):
            vectors[CHANGE, j] += equations.matrix[k, j] * vectors[RIGHT, k]
    for j in range(n):
        vectors[RIGHT, j] = vectors[CHANGE, j]


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
        largest = max(largest, abs(vectors[RIGHT, i]))
    for i in range(n):
        left = vectors[RIGHT, order[0, i]]
        for k in range(min(i, rank)):
            left -= factor[i, k] * vectors[CHANGE, k]
        if i >= rank and abs(left) > _CONTRADICTS * largest:
            return False
        vectors[CHANGE, i] = left / factor[i, n + 1] if i < rank else 0.0
    for k in range(rank - 1, -1, -1):
        share = 0.0
        for j in range(k, n):
            share += factor[k, j] * vectors[CHANGE, j]
        share *= factor[k, n]
        for j in range(k, n):
            vectors[CHANGE, j] -= share * factor[k, j]
    for i in range(n):
        vectors[RIGHT, i] = vectors[CHANGE, i]
    return True


@inlined
def begin_equations(equations: Equations, count: int, friction: float) -> int:
    """Factorise the equations of the points that are not open, of forces 0; return how many there are.

    Points that slide have ``friction`` (0 or 1) times their friction.
    """
    for i in range(2 * count):
        equations.vectors[UNKNOWN, i] = 0.0
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
        vectors[RIGHT, k] = -vectors[caused, row] / math.sqrt(a[row, row])
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
        vectors[CHANGE, i] = 0.0
    for k in range(n):
        row = order[1, k]
        change, status = vectors[RIGHT, k] / math.sqrt(a[row, row]), equations.points[row // 2, STATUS]
        vectors[CHANGE, row] += change
        if row % 2 == 0 and status != STICKS:
            edge = friction * edge_of(status, equations.measures[row // 2, MU])
            vectors[CHANGE, row + 1] += edge * change
    for i in range(2 * count):
        vectors[UNKNOWN, i] += vectors[CHANGE, i]
    return residual, rank


@inlined
def solve_equations(equations: Equations, count: int, friction: float) -> None:
    """Solve w = 0 for the points that are not open, along the tangent for those that stick.

    Those that slide have ``friction`` (0 or 1) times their friction.
    """
    vectors, largest, residual, rank = equations.vectors, 0.0, math.inf, 0
    for i in range(2 * count):
        largest = max(largest, abs(vectors[FREE, i]))
    n = begin_equations(equations, count, friction)
    for _ in range(REFINEMENTS):
        for k in range(n):
            row = equations.order[1, k]
            w = vectors[FREE, row]
            for j in range(2 * count):
                w += equations.a[row, j] * vectors[UNKNOWN, j]
            vectors[CAUSED, row] = w
        residual, rank = refine(equations, count, n, friction, CAUSED, largest, residual, rank)
        if residual < 0.0:
            break


@inlined
def _find_caused(equations: Equations, count: int) -> None:
    """Find what the unknowns cause, and in the row CHANGE how much of that may be rounding."""
    for i in range(2 * count):
        caused, parts = equations.vectors[FREE, i], abs(equations.vectors[FREE, i])
        for j in range(2 * count):
            part = equations.a[i, j] * equations.vectors[UNKNOWN, j]
            caused += part
            parts += abs(part)
        equations.vectors[CAUSED, i], equations.vectors[CHANGE, i] = caused, _OF_SUMS * parts


@inlined
def _closed_status(equations: Equations, i: int, opening: float, along: float) -> int:
    """Return what a point does that is to be closed: it slides where friction could not stop it alone."""
    given: int = equations.points[i, GIVEN]
    needed = abs(along) * equations.a[2 * i, 2 * i]
    if (
        given == STICKS
        and needed > equations.measures[i, MU] * max(-opening, 0.0) * equations.a[2 * i + 1, 2 * i + 1]
    ):
        return SLIDES_ON if along > 0.0 else SLIDES_BACK
    return given


@fused
def _change_most_violated(equations: Equations, count: int, w_scale: float, z_scale: float) -> bool:
    """Let the point whose law is violated most do what it must instead; return whether there is any."""
    worst, change, amount = -1, OPEN, _TOLERANCE
    vectors = equations.vectors
    for i in range(count):
        status, given, mu = equations.points[i, STATUS], equations.points[i, GIVEN], equations.measures[i, MU]
        pressed, rubbed = vectors[UNKNOWN, 2 * i] / z_scale, vectors[UNKNOWN, 2 * i + 1] / z_scale
        opening, along = vectors[CAUSED, 2 * i] / w_scale, vectors[CAUSED, 2 * i + 1] / w_scale
        if status == OPEN:
            if -opening - vectors[CHANGE, 2 * i] / w_scale > amount:
                worst, change, amount = i, _closed_status(equations, i, opening, along), -opening
        elif -pressed > amount:
            worst, change, amount = i, OPEN, -pressed
        elif given == STICKS and mu > 0.0:
            if status == STICKS:
                if abs(rubbed) - mu * pressed > amount:
                    worst, amount = i, abs(rubbed) - mu * pressed
                    change = SLIDES_ON if rubbed < 0.0 else SLIDES_BACK
            else:  # friction must not drive the sliding
                driven = -along if status == SLIDES_ON else along
                if driven - vectors[CHANGE, 2 * i + 1] / w_scale > amount:
                    worst, change, amount = i, STICKS, driven
    if worst >= 0:
        equations.points[worst, STATUS] = change
    return worst >= 0


@inlined
def _settle_by_changes(
    equations: Equations, count: int, changes: int, w_scale: float, z_scale: float
) -> bool:
    """Solve for what the points do, and change what violates its law most, until all laws are kept.

    Returns whether that took no more than so many changes.
    """
    for _ in range(changes):
        solve_equations(equations, count, 1.0)
        _find_caused(equations, count)
        if not _change_most_violated(equations, count, w_scale, z_scale):
            return True
    return False


@inlined
def _take_pivots(equations: Equations, count: int, closed: float, sticking: float) -> None:
    """Let points do what the pivots found: closed where w_n is below ``closed``, sticking likewise."""
    _find_caused(equations, count)
    vectors, points = equations.vectors, equations.points
    for i in range(count):
        pressed, rubbed = vectors[UNKNOWN, 2 * i], vectors[UNKNOWN, 2 * i + 1]
        edge = equations.measures[i, MU] * pressed
        if pressed <= 0.0 and vectors[CAUSED, 2 * i] > closed:
            points[i, STATUS] = OPEN
        elif points[i, GIVEN] != STICKS:
            points[i, STATUS] = points[i, GIVEN]
        elif abs(vectors[CAUSED, 2 * i + 1]) <= sticking or abs(rubbed) < (1.0 - _INSIDE) * edge:
            points[i, STATUS] = STICKS
        else:
            points[i, STATUS] = SLIDES_ON if rubbed < 0.0 else SLIDES_BACK


@inlined
def _largest_violation(equations: Equations, count: int, w_scale: float, z_scale: float) -> float:
    """Return the largest violation of a law by what is known, as a share of the largest of its kind."""
    vectors, worst = equations.vectors, 0.0
    for i in range(count):
        pressed, rubbed = vectors[UNKNOWN, 2 * i] / z_scale, vectors[UNKNOWN, 2 * i + 1] / z_scale
        opening = vectors[CAUSED, 2 * i] / w_scale
        worst = max(worst, -pressed, -opening, min(pressed, opening))
        worst = max(worst, abs(rubbed) - equations.measures[i, MU] * pressed)
    return worst


@inlined
def settle_at_an_edge(equations: Equations, count: int, scale: float) -> bool:
    """Find forces that solve the equations of what the points do, after others were FITTING; return if any.

    Forces are not determined then, and those of least norm leave a cone. Where one of the points that stick
    is at an edge of its cone they can be: it slides with no speed and no acceleration.
    """
    points, vectors, kept = equations.points, equations.vectors, 2 * count
    w_scale, z_scale = scale, 0.0
    for i in range(2 * count):
        w_scale, z_scale = max(w_scale, abs(vectors[FREE, i])), max(z_scale, abs(vectors[UNKNOWN, i]))
    for i in range(count):
        equations.order[0, kept + i] = points[i, STATUS]
    for i in range(count):
        for edge in (SLIDES_ON, SLIDES_BACK):
            for k in range(count):
                points[k, STATUS] = equations.order[0, kept + k]
            if points[i, STATUS] == STICKS:
                points[i, STATUS] = edge
                if _settle_by_changes(equations, count, _FEW_CHANGES, w_scale, z_scale):
                    return True
    return False


@inlined
def solve_complementarity(equations: Equations, count: int, scale: float, exactly: bool) -> int:
    """Find forces that keep all laws, and what each point does.

    A point's GIVEN is STICKS if it may stick or slide either way, else the edge of its cone. Accelerations
    or speeds below ``scale`` are measured by that. Returns NOT_FOUND; SETTLED where forces solve the
    equations of what the points do; or FITTING where they are those of the pivots, right to 1e-9, and of
    what the points do the forces of least norm would violate a law. That is tried for first where SETTLED is
    wanted ``exactly``.
    """
    points, vectors = equations.points, equations.vectors
    w_scale, z_scale, largest = 0.0, 0.0, 0.0
    for i in range(2 * count):
        vectors[UNKNOWN, i], vectors[CAUSED, i] = 0.0, vectors[FREE, i]
        largest = max(largest, abs(vectors[FREE, i]))
        # How fast a point slides that slides in any case is no measure for what rests.
        if i % 2 == 0 or points[i // 2, GIVEN] == STICKS:
            w_scale = max(w_scale, abs(vectors[FREE, i]))
            z_scale = max(z_scale, abs(vectors[FREE, i]) / equations.a[i, i])
    w_scale = max(w_scale, _ROUNDING * largest, scale)
    z_scale = z_scale if z_scale > 0.0 else 1.0
    for i in range(count):
        free_n, free_t = vectors[FREE, 2 * i], vectors[FREE, 2 * i + 1]
        points[i, STATUS] = _closed_status(equations, i, free_n, free_t) if free_n < 0.0 else points[i, GIVEN]
    if largest == 0.0:
        return SETTLED
    if _settle_by_changes(equations, count, 4 + 2 * count if exactly else _FEW_CHANGES, w_scale, z_scale):
        return SETTLED
    if exactly:  # what holds each other may rest where each of them alone would slide
        for i in range(count):
            points[i, STATUS] = points[i, GIVEN]
        if _settle_by_changes(equations, count, 2 + count, w_scale, z_scale):
            return SETTLED
    # Of what the pivots leave open or sliding, some may rest with the others: forces are of least norm then.
    for attempt in range(len(_SLACKS)):
        if not find_by_pivots(equations, count, _SLACKS[attempt]):
            continue
        for i in range(2 * count):
            z_scale = max(z_scale, abs(vectors[UNKNOWN, i]))
        limit = _AT_REST * w_scale if attempt == 0 else -1.0
        _take_pivots(equations, count, limit, limit)
        fits = _largest_violation(equations, count, w_scale, z_scale) <= _AT_REST
        if fits and (attempt >= 2 or not exactly):
            return FITTING
        if _settle_by_changes(equations, count, 2 + count, w_scale, z_scale):
            return SETTLED
    return NOT_FOUND
