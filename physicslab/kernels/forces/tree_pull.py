"""Gravity of many bodies by a tree: near ones singly, far groups by their mass and second moments.

After Barnes and Hut, Nature 324 (1986) 446. All bodies of a leaf share one list of what pulls on them: a
node whose bodies are within b of its centre of mass is taken whole if b < :data:`THETA` d, d being the least
distance from there to the leaf's box, and, for the clamp law, if all its bodies are further off than the
softening. With d^2 = r^2 + s^2 under Plummer's law (d = r under the other) and second moments S about the
centre of mass, it pulls with x (M/d^3 + (7.5 x.S x/d^2 - 1.5 tr S)/d^5) - 3 S x/d^5, x leading there.

Accuracy: against the direct sum, as shares of the mean pull, :data:`RMS_ERROR` at most by root mean square
and :data:`MAX_ERROR` for any one body, on squares filled evenly, on Plummer spheres and on two clusters
(``benchmarks/gravity.py``; held by ``tests/test_tree.py``). These are measured: a bound that holds for any
arrangement is 4 (b/d)^3 / (1 - b/d)^2 of M/d^2 for each node (Salmon and Warren, J. Comput. Phys. 111 (1994)
136), which here is at most 0.029. A group does not pull as it is pulled: momentum is kept as well as forces
are right, and not to rounding.
"""

import math

import numpy as np

from physicslab.kernels import Numbers, Rows, Vectors, allocating, inlined_loosely
from physicslab.kernels.forces import tree
from physicslab.kernels.forces.pairwise import depth_of, depth_terms, inverse_root, pull_of, pull_terms

THETA = 0.17
"""How wide a node may be that is taken whole: its radius by its distance. Errors go as its power 3.5."""
RMS_ERROR, MAX_ERROR = 1e-4, 1e-3


@inlined_loosely
def _choose(
    nodes: Vectors, levels: int, leaf: int, clear: float, stack: Rows, whole: Rows, opened: Rows
) -> tuple[int, int]:
    """List what pulls on a leaf: nodes taken whole, and leaves whose bodies pull singly; how many of each.

    ``clear`` [m] is how far off all bodies of a node must be for it to be taken whole.
    """
    home = nodes[(1 << levels) - 1 + leaf]
    wholes, opens, depth = 0, 0, 1
    stack[0] = 0
    while depth > 0:
        depth -= 1
        k = stack[depth]
        dx = max(home[tree.LOW_X] - nodes[k, tree.X], nodes[k, tree.X] - home[tree.HIGH_X], 0.0)
        dy = max(home[tree.LOW_Y] - nodes[k, tree.Y], nodes[k, tree.Y] - home[tree.HIGH_Y], 0.0)
        distance, radius = math.sqrt(dx * dx + dy * dy), nodes[k, tree.RADIUS]
        if radius < THETA * distance and distance > radius + clear:
            whole[wholes] = k
            wholes += 1
        elif k >= (1 << levels) - 1:
            opened[opens] = k - ((1 << levels) - 1)
            opens += 1
        else:
            stack[depth], stack[depth + 1] = 2 * k + 2, 2 * k + 1
            depth += 2
    return wholes, opens


@inlined_loosely
def _pull_of_nodes(far: Vectors, count: int, at_x: float, at_y: float, added: float) -> tuple[float, float]:
    """Return the pull [kg/m^2] of the first ``count`` nodes of ``far`` (6, n) on a unit mass."""
    fx, fy = 0.0, 0.0
    for j in range(count):
        dx, dy = far[1, j] - at_x, far[2, j] - at_y
        u = inverse_root(dx * dx + dy * dy + added)
        u2 = u * u
        u3 = u * u2
        u5 = u3 * u2
        sx, sy = far[3, j] * dx + far[4, j] * dy, far[4, j] * dx + far[5, j] * dy
        along = far[0, j] * u3 + u5 * (7.5 * (dx * sx + dy * sy) * u2 - 1.5 * (far[3, j] + far[5, j]))
        fx += along * dx - 3.0 * u5 * sx
        fy += along * dy - 3.0 * u5 * sy
    return fx, fy


@inlined_loosely
def _depth_of_nodes(far: Vectors, count: int, at_x: float, at_y: float, added: float) -> float:
    """Return the depth [kg/m] that belongs to :func:`_pull_of_nodes`."""
    total = 0.0
    for j in range(count):
        dx, dy = far[1, j] - at_x, far[2, j] - at_y
        u = inverse_root(dx * dx + dy * dy + added)
        u3 = u * u * u
        q = far[3, j] * dx * dx + 2.0 * far[4, j] * dx * dy + far[5, j] * dy * dy
        total += far[0, j] * u + 0.5 * u3 * (3.0 * q * u * u - far[3, j] - far[5, j])
    return total


@allocating
def _room(n: int, levels: int) -> tuple[Rows, Vectors, Vectors, Vectors, Rows]:
    """Return room for the tree of n bodies, the two lists of what pulls on a leaf, and the search for it."""
    leaves = 1 << levels
    nodes, far, near = np.empty((2 * leaves - 1, tree.COLUMNS)), np.empty((6, leaves)), np.empty((3, n))
    return np.arange(n), nodes, far, near, np.empty(levels + 2 + 2 * leaves, np.int64)


@inlined_loosely
def _collect(
    x: Numbers, y: Numbers, mass: Numbers, order: Rows, nodes: Vectors, levels: int, leaf: int, clear: float,
    scratch: Rows, far: Vectors, near: Vectors,
) -> tuple[int, int, int]:  # fmt: skip
    """Fill in what pulls on a leaf: nodes into ``far`` (6, leaves), bodies into ``near`` (3, n).

    Return how many of each, and where in ``near`` the leaf's own bodies begin.
    """
    n, leaves, deep = len(x), 1 << levels, levels + 2
    whole, opened = scratch[deep : deep + leaves], scratch[deep + leaves :]
    wholes, opens = _choose(nodes, levels, leaf, clear, scratch[:deep], whole, opened)
    for j in range(wholes):
        for column in range(6):
            far[column, j] = nodes[whole[j], tree.MASS + column]
    count, own = 0, 0
    for other in opened[:opens]:
        own = count if other == leaf else own
        for i in order[(other * n) >> levels : ((other + 1) * n) >> levels]:
            near[0, count], near[1, count], near[2, count] = x[i], y[i], mass[i]
            count += 1
    return wholes, count, own


@allocating
def attract_by_tree(
    x: Numbers, y: Numbers, mass: Numbers, softening: float, plummer: bool, ax: Numbers, ay: Numbers
) -> None:
    """Set ``ax``, ``ay`` [kg/m^2] to the pull of all others on a unit mass at each of (n,) bodies."""
    added, cap = pull_terms(softening, plummer)
    n, levels = len(x), tree.levels_of(len(x))
    order, nodes, far, near, scratch = _room(n, levels)
    tree.grow(x, y, mass, order, nodes, levels)
    for leaf in range(1 << levels):
        wholes, nears, _ = _collect(
            x, y, mass, order, nodes, levels, leaf, 0.0 if plummer else softening, scratch, far, near
        )
        near_x, near_y, near_mass = near[0, :nears], near[1, :nears], near[2, :nears]
        for i in order[(leaf * n) >> levels : ((leaf + 1) * n) >> levels]:
            fx, fy = pull_of(near_x, near_y, near_mass, x[i], y[i], added, cap)
            gx, gy = _pull_of_nodes(far, wholes, x[i], y[i], added)
            ax[i], ay[i] = fx + gx, fy + gy


@allocating
def depth_by_tree(x: Numbers, y: Numbers, mass: Numbers, softening: float, plummer: bool) -> float:
    """Return the sum of m_a m_b times the depth [kg^2/m] over every pair of (n,) bodies."""
    added, near2, inverse = depth_terms(softening, plummer)
    n, levels = len(x), tree.levels_of(len(x))
    order, nodes, far, near, scratch = _room(n, levels)
    tree.grow(x, y, mass, order, nodes, levels)
    total = 0.0
    for leaf in range(1 << levels):
        wholes, nears, own = _collect(
            x, y, mass, order, nodes, levels, leaf, 0.0 if plummer else softening, scratch, far, near
        )
        for i in order[(leaf * n) >> levels : ((leaf + 1) * n) >> levels]:
            depth = _depth_of_nodes(far, wholes, x[i], y[i], added)
            for first, last in ((0, own), (own + 1, nears)):  # all but the body itself
                depth += depth_of(
                    near[0, first:last], near[1, first:last], near[2, first:last], x[i], y[i], added, near2,
                    inverse,
                )  # fmt: skip
            own += 1
            total += 0.5 * mass[i] * depth
    return total
