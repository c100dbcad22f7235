"""Lemke's algorithm: complementary pivots, which end where the laws of contact can be kept at all.

In standard form, w = M x + q with x, w >= 0 and x w = 0, a point that may stick has four unknowns: its
normal force, friction to either side, and the acceleration of sliding (Stewart & Trinkle, Int. J. Num.
Meth. Eng. 39 (1996) 2673); one that slides in any case has its normal force alone. A covering variable
makes all right sides positive; pivots drive it out (Cottle, Pang & Stone, The Linear Complementarity
Problem, 1992, 4.4).
"""

import math

from physicslab.kernels import always_inlined, inlined
from physicslab.kernels.rigid.equations import FREE, STICKS, UNKNOWN, Equations, edge_of
from physicslab.kernels.rigid.features import GIVEN, MU

_APART = 1e-9
"""Share by which right sides are raised, every one differently: equal ones would let the
pivots go round in circles. Only what each point does is taken from here; the forces are then found
exactly."""
_GOLDEN = 0.6180339887498949
_NOTHING = 1e-13
"""Share of the largest number of its column below which a number is no pivot."""


@inlined
def _scaled_friction(equations: Equations, i: int) -> float:
    """Return the coefficient of friction between scaled unknowns."""
    ratio = equations.a[2 * i + 1, 2 * i + 1] / equations.a[2 * i, 2 * i]
    friction: float = equations.measures[i, MU] * math.sqrt(ratio)
    return friction


@inlined
def _coefficient(equations: Equations, row: int, j: int) -> tuple[float, float, float]:
    """Return what the normal force of point j, and friction to either side, cause in a row of the matrix.

    Unknowns and rows are scaled by the roots of the diagonal, so that bodies of all masses count alike.
    """
    a = equations.a
    own = math.sqrt(a[row, row])
    normal = a[row, 2 * j] / (own * math.sqrt(a[2 * j, 2 * j]))
    tangent = a[row, 2 * j + 1] / (own * math.sqrt(a[2 * j + 1, 2 * j + 1]))
    if equations.points[j, GIVEN] != STICKS:
        return (
            normal + edge_of(equations.points[j, GIVEN], _scaled_friction(equations, j)) * tangent,
            0.0,
            0.0,
        )
    return normal, tangent, -tangent


@always_inlined
def _write_tableau(equations: Equations, count: int) -> int:
    """Write w - M x - d x0 = q, rows of unknowns beside each other; return how many unknowns there are."""
    size, tableau = 0, equations.tableau
    for i in range(count):
        size += 4 if equations.points[i, GIVEN] == STICKS else 1
    row = 0
    for i in range(count):
        sides = 4 if equations.points[i, GIVEN] == STICKS else 1
        for side in range(sides):
            for column in range(2 * size + 2):
                tableau[row, column] = 0.0
            tableau[row, row] = 1.0
            sign = -1.0 if side == 2 else 1.0
            source = 2 * i if side == 0 else 2 * i + 1
            column = size
            for j in range(count):
                mine = i == j
                parts = 4 if equations.points[j, GIVEN] == STICKS else 1
                if side == 3:  # mu z_n less both frictions
                    if mine:
                        tableau[row, column] = -_scaled_friction(equations, i)
                        tableau[row, column + 1] = tableau[row, column + 2] = 1.0
                else:
                    normal, left, right = _coefficient(equations, source, j)
                    tableau[row, column] = -sign * normal
                    if parts == 4:
                        tableau[row, column + 1], tableau[row, column + 2] = -sign * left, -sign * right
                        tableau[row, column + 3] = -1.0 if mine and side > 0 else 0.0
                column += parts
            tableau[row, 2 * size] = -1.0
            tableau[row, 2 * size + 1] = (
                0.0
                if side == 3
                else sign * equations.vectors[FREE, source] / math.sqrt(equations.a[source, source])
            )
            row += 1
    return size


@inlined
def _pivot(equations: Equations, size: int, row: int, column: int) -> None:
    """Bring a column into the basis at a row."""
    tableau = equations.tableau
    factor = 1.0 / tableau[row, column]
    for k in range(2 * size + 2):
        tableau[row, k] *= factor
    for other in range(size):
        share = tableau[other, column]
        if other != row and share != 0.0:
            for k in range(2 * size + 2):
                tableau[other, k] -= share * tableau[row, k]
    equations.order[0, row] = column


@always_inlined
def _leaving(equations: Equations, size: int, column: int, slack: float) -> int:
    """Return the row whose variable reaches zero first as a column grows, -1 if none does.

    Among those that reach it within a ``slack`` of their values, the one with the largest pivot (Harris), as
    small pivots are mostly rounding; the covering variable before all.
    """
    tableau, best, first, largest = equations.tableau, -1, math.inf, 0.0
    for row in range(size):
        largest = max(largest, abs(tableau[row, column]))
    for row in range(size):
        pivot = tableau[row, column]
        if pivot > _NOTHING * largest:
            first = min(first, (max(tableau[row, 2 * size + 1], 0.0) + slack) / pivot)
    for row in range(size):
        pivot = tableau[row, column]
        if pivot > _NOTHING * largest and max(tableau[row, 2 * size + 1], 0.0) / pivot <= first:
            if equations.order[0, row] == 2 * size:
                return row
            if best < 0 or pivot > tableau[best, column]:
                best = row
    return best


@always_inlined
def find_by_pivots(equations: Equations, count: int, slack: float) -> bool:
    """Find forces that keep all laws but for a share ``slack`` of the largest right side.

    They are left as the unknowns. Returns whether any were found: rounding can hide them, and another slack
    show them.
    """
    size, tableau, vectors = _write_tableau(equations, count), equations.tableau, equations.vectors
    row, scale = 0, 0.0
    for k in range(size):
        scale = max(scale, abs(tableau[k, 2 * size + 1]))
    for k in range(size):
        equations.order[0, k] = k
        own = 1e-4 * scale + abs(tableau[k, 2 * size + 1])
        tableau[k, 2 * size + 1] += _APART * own * (1.0 + (_GOLDEN * k) % 1.0)
        if tableau[k, 2 * size + 1] < tableau[row, 2 * size + 1]:
            row = k
    if tableau[row, 2 * size + 1] < 0.0:
        leaving, entering = row, 2 * size
        for _ in range(50 * size + 50):
            left = equations.order[0, leaving]
            _pivot(equations, size, leaving, entering)
            if left == 2 * size:
                break
            entering = left + size if left < size else left - size
            leaving = _leaving(equations, size, entering, slack * scale)
            if leaving < 0:
                return False
    column = size
    for i in range(count):
        sticks = equations.points[i, GIVEN] == STICKS
        pressed, friction = 0.0, 0.0
        for row in range(size):
            place = equations.order[0, row] - column
            if place == 0:
                pressed = tableau[row, 2 * size + 1]
            elif sticks and (place == 1 or place == 2):
                friction += (1.0 if place == 1 else -1.0) * tableau[row, 2 * size + 1]
        pressed /= math.sqrt(equations.a[2 * i, 2 * i])
        friction /= math.sqrt(equations.a[2 * i + 1, 2 * i + 1])
        edge = edge_of(equations.points[i, GIVEN], equations.measures[i, MU])
        vectors[UNKNOWN, 2 * i], vectors[UNKNOWN, 2 * i + 1] = pressed, friction if sticks else edge * pressed
        column += 4 if sticks else 1
    return True
