"""The equations of points that touch: what unit forces cause, and what each point does."""

from typing import NamedTuple

from physicslab.kernels import Vectors, inlined
from physicslab.kernels.rigid.features import Points

OPEN, STICKS, SLIDES_ON, SLIDES_BACK = 0, 1, 2, 3
"""State of a point. One that slides on has z_t = -mu z_n, one that slides back z_t = +mu z_n."""
FREE, UNKNOWN, CAUSED, RIGHT, CHANGE, VECTORS = range(6)
"""Rows of vectors: what happens without contact forces, these, what happens with them, a right side, a change
of forces."""


class Equations(NamedTuple):
    """Points that touch, and room for their equations.

    ``points`` and ``measures`` (n, ...); ``a`` (2 n, 2 n): what unit forces cause; ``vectors`` (VECTORS, 2
    n); ``matrix`` (2 n, 2 n) and ``order`` (2, 4 n) for the solution; ``tableau`` (4 n, 8 n + 2) for
    pivots.
    """

    points: Points
    measures: Vectors
    a: Vectors
    vectors: Vectors
    matrix: Vectors
    order: Points
    tableau: Vectors


@inlined
def edge_of(status: int, mu: float) -> float:
    """Return z_t / z_n of a point that slides."""
    return -mu if status == SLIDES_ON else (mu if status == SLIDES_BACK else 0.0)
