"""Sobol's sequence: points that fill a cube more evenly than random ones do."""

import numpy as np
from numpy.typing import NDArray

BITS = 32
_TABLE = (
    (0, 0, (1,)), (1, 0, (1,)), (2, 1, (1, 3)), (3, 1, (1, 3, 1)), (3, 2, (1, 1, 1)), (4, 1, (1, 1, 3, 3)),
    (4, 4, (1, 3, 5, 13)), (5, 2, (1, 1, 5, 5, 17)), (5, 4, (1, 1, 5, 5, 5)), (5, 7, (1, 1, 7, 11, 19)),
    (5, 11, (1, 1, 5, 1, 1)), (5, 13, (1, 1, 1, 3, 11)), (5, 14, (1, 3, 5, 5, 31)),
    (6, 1, (1, 3, 3, 9, 7, 49)), (6, 13, (1, 1, 1, 15, 21, 21)), (6, 16, (1, 3, 1, 13, 27, 49)),
    (6, 19, (1, 1, 1, 15, 7, 5)), (6, 22, (1, 3, 1, 15, 13, 25)), (6, 25, (1, 1, 5, 5, 19, 61)),
    (7, 1, (1, 3, 7, 11, 23, 15, 103)), (7, 4, (1, 3, 7, 13, 13, 15, 69)),
)  # fmt: skip
"""Degree and inner coefficients of a primitive polynomial, and first direction numbers, for each dimension:
S. Joe and F. Y. Kuo, SIAM J. Sci. Comput. 30 (2008), 2635. The first dimension is van der Corput's."""
DIMENSIONS = len(_TABLE)


def sobol(points: NDArray[np.int64], dimension: int) -> NDArray[np.int64]:
    """Return a coordinate of points of the sequence, as whole numbers of 2^-32.

    Parameters
    ----------
    points : int64 array (n,)
        The points, by their numbers from 0, below 2^32, in any order.
    dimension : int
        Which coordinate, below ``DIMENSIONS``.

    Examples
    --------
    >>> (sobol(np.arange(4), 0) / 2**BITS).tolist(), (sobol(np.arange(4), 1) / 2**BITS).tolist()
    ([0.0, 0.5, 0.75, 0.25], [0.0, 0.5, 0.25, 0.75])
    """
    gray, found = points ^ (points >> 1), np.zeros_like(points)
    for bit, direction in enumerate(_directions(dimension)):
        found ^= np.where((gray >> bit) & 1, direction, 0)
    return found


def _directions(dimension: int) -> list[int]:
    """Return the direction numbers of a dimension, each of ``BITS`` bits."""
    degree, inner, first = _TABLE[dimension]
    if not degree:
        return [1 << (BITS - 1 - bit) for bit in range(BITS)]
    found = [number << (BITS - 1 - bit) for bit, number in enumerate(first)]
    for bit in range(degree, BITS):
        number = found[bit - degree] ^ (found[bit - degree] >> degree)
        for k in range(1, degree):
            if (inner >> (degree - 1 - k)) & 1:
                number ^= found[bit - k]
        found.append(number)
    return found
