"""Molecules: the Lennard-Jones force between near ones, found by cells, over packed coordinates.

The energy of a pair is e (s^2 - 2 s) with s = (d / r)^6: it is least, -e, at the distance d, and zero at
sigma = d / 2^(1/6). Beyond 2.5 sigma there is no force; the energy is shifted by that there, so that it is
continuous (Allen & Tildesley, Computer Simulation of Liquids, 2017, 5.2). For unlike molecules e is the
geometric mean and d the arithmetic one (Lorentz, Ann. Phys. 248 (1881) 127; Berthelot, C. R. Acad. Sci. 126
(1898) 1703).
"""

import math

import numpy as np

from physicslab.kernels import allocating, inlined
from physicslab.kernels.forces.force_calls import force_kernel

CUT2 = 2.5**2 / 2.0 ** (1.0 / 3.0)
"""The square of the distance from which on two do not act on each other, in units of d^2."""
_CUT_S = CUT2**-3.0
SHIFT = _CUT_S * _CUT_S - 2.0 * _CUT_S
"""The energy at that distance, in units of e: -0.0163. The force there is 0.039 e / sigma, and jumps to 0."""
STORED, REACH, FIRST = range(3)
"""The parameters begin with the energy that was found [J], and the largest distance of two that act [m]."""
_FARTHEST = 1e9
"""All that is beyond so many cells from the origin is in the one there."""
_ROW = 1 << 32
"""Cells in a row of the grid, so that each has a number of its own."""


@inlined
def _cell(place: float, reach: float) -> int:
    """Return the number of the cell along an axis."""
    share = place / reach
    return math.floor(share) if -_FARTHEST < share < _FARTHEST else 0


@inlined
def _hash(cx: int, cy: int, size: int) -> int:
    """Return the place of a cell among ``size``, a power of two."""
    return (cx * 73856093 ^ cy * 19349663) & (size - 1)


@allocating
def _act(q, force, parameters, indices):  # type: ignore[no-untyped-def]
    """Add the forces of all pairs, and note their energy.

    Molecules are put into the cells of a grid as wide as the largest reach, in order of a hash of the cell:
    each looks for others in its own cell and in four of those around it, so that each pair is met once.
    """
    n, reach = indices[0], parameters[REACH]
    size = 2
    while size < 2 * n:
        size *= 2
    first, hashed = np.zeros(size + 1, np.int64), np.empty(n, np.int64)
    for p in range(n):
        i = indices[1 + p]
        hashed[p] = _hash(_cell(q[i], reach), _cell(q[i + 1], reach), size)
        first[hashed[p] + 1] += 1
    for k in range(size):
        first[k + 1] += first[k]
    filled, own = first.copy(), np.empty(n, np.int64)
    x, y, depth, half = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    cells, pull_x, pull_y = np.empty(n, np.int64), np.zeros(n), np.zeros(n)
    for p in range(n):
        i, k = indices[1 + p], filled[hashed[p]]
        filled[hashed[p]] += 1
        own[k], x[k], y[k] = i, q[i], q[i + 1]
        depth[k], half[k] = parameters[FIRST + 2 * p], parameters[FIRST + 1 + 2 * p]
        cells[k] = _cell(x[k], reach) * _ROW + _cell(y[k], reach)
    stored = 0.0
    for a in range(n):
        fx, fy, own_x, own_y = 0.0, 0.0, _cell(x[a], reach), _cell(y[a], reach)
        for beside in range(5):
            # The cell itself, then that above, and the three to the right.
            cx = own_x + (0 if beside < 2 else 1)
            cy = own_y + (beside if beside < 2 else beside - 3)
            at, cell = _hash(cx, cy, size), cx * _ROW + cy
            for b in range(a + 1 if beside == 0 else first[at], first[at + 1]):
                dx, dy, d = x[b] - x[a], y[b] - y[a], half[a] + half[b]
                r2, d2 = dx * dx + dy * dy, d * d
                if cells[b] != cell or not 0.0 < r2 < CUT2 * d2:
                    continue
                share = d2 / r2
                s, e = share * share * share, depth[a] * depth[b]
                f = 12.0 * e * (s * s - s) / r2
                stored += e * (s * s - 2.0 * s - SHIFT)
                fx -= f * dx
                fy -= f * dy
                pull_x[b] += f * dx
                pull_y[b] += f * dy
        pull_x[a] += fx
        pull_y[a] += fy
    for k in range(n):
        force[own[k]] += pull_x[k]
        force[own[k] + 1] += pull_y[k]
    parameters[STORED] = stored


@force_kernel
def molecules(q, v, span, force, parameters, indices):  # type: ignore[no-untyped-def]
    """Add the force of every two that are near each other.

    ``parameters``: STORED, REACH; of each the root of its depth and half of its distance. ``indices``: how
    many, and where x of each is.
    """
    _act(q, force, parameters, indices)  # type: ignore[no-untyped-call]
