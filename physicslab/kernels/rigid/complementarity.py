"""Forces of contacts that may open and slide: a linear complementarity problem, solved to rounding.

Point i has a normal and a tangential unknown, z[2 i] and z[2 i + 1]: forces, or impulses. Their effect is
w = A z + b: accelerations, or velocities. The laws are 0 <= z_n, 0 <= w_n, z_n w_n = 0, and Coulomb's
|z_t| <= mu z_n, with w_t = 0 where that holds strictly and w_t against z_t where not. In two dimensions the
cone has two edges, and all of that is linear (Acary & Brogliato, Numerical Methods for Nonsmooth Dynamical
Systems, 2008, ch. 9). A point that slides already has its edge given.

At first all points are taken to be closed; the equations are solved directly, and points whose law is
violated change over, one at a time. Where that does not end, Lemke's pivots do. Where forces are not
determined, as under a table with four legs, they are those of the least norm.
"""

from physicslab.kernels import always_inlined, inlined
from physicslab.kernels.rigid import equations as E
from physicslab.kernels.rigid.equations import Equations
from physicslab.kernels.rigid.features import GIVEN, MU, STATUS
from physicslab.kernels.rigid.least_norm import solve_equations
from physicslab.kernels.rigid.lemke import find_by_pivots

_LEAST_SCALE = 1e-4
"""Share of the largest free rate, that of points that slide in any case too, which the scale of rates is at
least: its rounding is in all that they touch."""
_VIOLATION = 1e-11
"""Share of the largest free acceleration, or of the largest force, up to which a law counts as kept."""
NOT_FOUND, FITTING, SETTLED = 0, 1, 2
"""Whether forces were found."""
_ROUNDING_OF_SUMS = 4e-16
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


@inlined
def _find_caused(equations: Equations, count: int) -> None:
    """Find what the unknowns cause, and in the row CHANGE how much of that may be rounding."""
    for i in range(2 * count):
        caused, parts = equations.vectors[E.FREE, i], abs(equations.vectors[E.FREE, i])
        for j in range(2 * count):
            part = equations.a[i, j] * equations.vectors[E.UNKNOWN, j]
            caused += part
            parts += abs(part)
        equations.vectors[E.CAUSED, i], equations.vectors[E.CHANGE, i] = caused, _ROUNDING_OF_SUMS * parts


@inlined
def _closed_status(equations: Equations, i: int, opening: float, along: float) -> int:
    """Return what a point does that is to be closed: it slides where friction could not stop it alone."""
    given: int = equations.points[i, GIVEN]
    needed = abs(along) * equations.a[2 * i, 2 * i]
    if (
        given == E.STICKS
        and needed > equations.measures[i, MU] * max(-opening, 0.0) * equations.a[2 * i + 1, 2 * i + 1]
    ):
        return E.SLIDES_ON if along > 0.0 else E.SLIDES_BACK
    return given


@always_inlined
def _change_most_violated(equations: Equations, count: int, w_scale: float, z_scale: float) -> bool:
    """Let the point whose law is violated most do what it must instead; return whether there is any."""
    worst, change, amount = -1, E.OPEN, _VIOLATION
    vectors = equations.vectors
    for i in range(count):
        status, given, mu = equations.points[i, STATUS], equations.points[i, GIVEN], equations.measures[i, MU]
        normal, friction = vectors[E.UNKNOWN, 2 * i] / z_scale, vectors[E.UNKNOWN, 2 * i + 1] / z_scale
        opening, along = vectors[E.CAUSED, 2 * i] / w_scale, vectors[E.CAUSED, 2 * i + 1] / w_scale
        if status == E.OPEN:
            if -opening - vectors[E.CHANGE, 2 * i] / w_scale > amount:
                worst, change, amount = i, _closed_status(equations, i, opening, along), -opening
        elif -normal > amount:
            worst, change, amount = i, E.OPEN, -normal
        elif given == E.STICKS and mu > 0.0:
            if status == E.STICKS:
                if abs(friction) - mu * normal > amount:
                    worst, amount = i, abs(friction) - mu * normal
                    change = E.SLIDES_ON if friction < 0.0 else E.SLIDES_BACK
            else:  # friction must not drive the sliding
                driven = -along if status == E.SLIDES_ON else along
                if driven - vectors[E.CHANGE, 2 * i + 1] / w_scale > amount:
                    worst, change, amount = i, E.STICKS, driven
    if worst >= 0:
        equations.points[worst, STATUS] = change
    return worst >= 0


@always_inlined
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
        normal, friction = vectors[E.UNKNOWN, 2 * i], vectors[E.UNKNOWN, 2 * i + 1]
        edge = equations.measures[i, MU] * normal
        if normal <= 0.0 and vectors[E.CAUSED, 2 * i] > closed:
            points[i, STATUS] = E.OPEN
        elif points[i, GIVEN] != E.STICKS:
            points[i, STATUS] = points[i, GIVEN]
        elif abs(vectors[E.CAUSED, 2 * i + 1]) <= sticking or abs(friction) < (1.0 - _INSIDE) * edge:
            points[i, STATUS] = E.STICKS
        else:
            points[i, STATUS] = E.SLIDES_ON if friction < 0.0 else E.SLIDES_BACK


@inlined
def _largest_violation(equations: Equations, count: int, w_scale: float, z_scale: float) -> float:
    """Return the largest violation of a law by what is known, as a share of the largest of its kind."""
    vectors, worst = equations.vectors, 0.0
    for i in range(count):
        normal, friction = vectors[E.UNKNOWN, 2 * i] / z_scale, vectors[E.UNKNOWN, 2 * i + 1] / z_scale
        opening = vectors[E.CAUSED, 2 * i] / w_scale
        worst = max(worst, -normal, -opening, min(normal, opening))
        worst = max(worst, abs(friction) - equations.measures[i, MU] * normal)
    return worst


@always_inlined
def settle_at_an_edge(equations: Equations, count: int, scale: float) -> bool:
    """Find forces that solve the equations of what the points do, after others were FITTING; return if any.

    Forces are not determined then, and those of least norm leave a cone. Where one of the points that stick
    is at an edge of its cone they can be: it slides with no speed and no acceleration.
    """
    points, vectors, kept = equations.points, equations.vectors, 2 * count
    w_scale, z_scale = scale, 0.0
    for i in range(2 * count):
        w_scale, z_scale = max(w_scale, abs(vectors[E.FREE, i])), max(z_scale, abs(vectors[E.UNKNOWN, i]))
    for i in range(count):
        equations.order[0, kept + i] = points[i, STATUS]
    for i in range(count):
        for edge in (E.SLIDES_ON, E.SLIDES_BACK):
            for k in range(count):
                points[k, STATUS] = equations.order[0, kept + k]
            if points[i, STATUS] == E.STICKS:
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
        vectors[E.UNKNOWN, i], vectors[E.CAUSED, i] = 0.0, vectors[E.FREE, i]
        largest = max(largest, abs(vectors[E.FREE, i]))
        # How fast a point slides that slides in any case is no measure for what rests.
        if i % 2 == 0 or points[i // 2, GIVEN] == E.STICKS:
            w_scale = max(w_scale, abs(vectors[E.FREE, i]))
            z_scale = max(z_scale, abs(vectors[E.FREE, i]) / equations.a[i, i])
    w_scale = max(w_scale, _LEAST_SCALE * largest, scale)
    z_scale = z_scale if z_scale > 0.0 else 1.0
    for i in range(count):
        free_n, free_t = vectors[E.FREE, 2 * i], vectors[E.FREE, 2 * i + 1]
        points[i, STATUS] = _closed_status(equations, i, free_n, free_t) if free_n < 0.0 else points[i, GIVEN]
    if largest == 0.0:
        return SETTLED
    for attempt in range(-2, len(_SLACKS)):
        changes = 2 + count
        if attempt == -2:
            changes = 4 + 2 * count if exactly else _FEW_CHANGES
        elif attempt == -1:  # what holds each other may rest where each of them alone would slide
            if not exactly:
                continue
            for i in range(count):
                points[i, STATUS] = points[i, GIVEN]
        else:  # of what the pivots leave open or sliding, some may rest with the others: forces of least norm
            if not find_by_pivots(equations, count, _SLACKS[attempt]):
                continue
            for i in range(2 * count):
                z_scale = max(z_scale, abs(vectors[E.UNKNOWN, i]))
            limit = _AT_REST * w_scale if attempt == 0 else -1.0
            _take_pivots(equations, count, limit, limit)
            fits = _largest_violation(equations, count, w_scale, z_scale) <= _AT_REST
            if fits and (attempt >= 2 or not exactly):
                return FITTING
        if _settle_by_changes(equations, count, changes, w_scale, z_scale):
            return SETTLED
    return NOT_FOUND
