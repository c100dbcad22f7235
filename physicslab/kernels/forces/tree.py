"""A tree of halves over bodies in a plane: every node is cut at the median of its longer side.

Its depth depends on the number of bodies alone, wherever they are: bodies on one spot, or one at 1e9 m, make
it no deeper. With 2^L leaves, node k of level l holds the bodies from k n >> l to (k + 1) n >> l of
``order``, and its halves are nodes 2 k and 2 k + 1 of level l + 1. Levels are stored one after the other, the
root first.
"""

import math

import numpy as np

from physicslab.kernels import Numbers, Rows, Vectors, allocating, inlined

LEAF = 24
"""Bodies in a leaf, at most; at least half as many where there are more."""
LOW_X, HIGH_X, LOW_Y, HIGH_Y, MASS, X, Y, XX, XY, YY, RADIUS = range(11)
"""Columns of a node: its box, mass, centre, second moments about that [kg m^2], the furthest body [m]."""
COLUMNS = 11


@inlined
def levels_of(n: int) -> int:
    """Return L of the tree of n bodies."""
    levels = 0
    while ((n - 1) >> levels) + 1 > LEAF:
        levels += 1
    return levels


@inlined
def _divide(key: Numbers, order: Rows, first: int, last: int, middle: int) -> None:
    """Exchange places of ``first`` to ``last`` - 1 until no key before ``middle`` exceeds one from it on.

    Hoare's selection (Comm. ACM 4 (1961) 321). The pivot is picked by a fixed sequence of odd jumps: no
    arrangement that a scene is likely to have makes it slow, and the same bodies give the same tree.
    """
    low, high, jump = first, last - 1, 0
    while low < high:
        jump = (jump * 1103515245 + 12345) & 0x7FFFFFFF
        pivot = key[low + jump % (high - low + 1)]
        i, j = low, high
        while i <= j:
            while key[i] < pivot:
                i += 1
            while key[j] > pivot:
                j -= 1
            if i <= j:
                key[i], key[j] = key[j], key[i]
                order[i], order[j] = order[j], order[i]
                i += 1
                j -= 1
        if middle <= j:
            high = j
        elif middle >= i:
            low = i
        else:
            return


@inlined
def _measure(node: Numbers, x: Numbers, y: Numbers, mass: Numbers, order: Rows) -> None:
    """Set the columns of a node that holds the bodies ``order``."""
    low_x, high_x, low_y, high_y = np.inf, -np.inf, np.inf, -np.inf
    total, mx, my = 0.0, 0.0, 0.0
    # The centre is computed relative to this: far from the origin digits are lost.
    x0, y0 = x[order[0]], y[order[0]]
    for i in order:
        low_x, high_x = min(low_x, x[i]), max(high_x, x[i])
        low_y, high_y = min(low_y, y[i]), max(high_y, y[i])
        total += mass[i]
        mx += mass[i] * (x[i] - x0)
        my += mass[i] * (y[i] - y0)
    x0, y0 = x0 + mx / total, y0 + my / total
    xx, xy, yy, furthest = 0.0, 0.0, 0.0, 0.0
    for i in order:
        dx, dy = x[i] - x0, y[i] - y0
        xx += mass[i] * dx * dx
        xy += mass[i] * dx * dy
        yy += mass[i] * dy * dy
        furthest = max(furthest, dx * dx + dy * dy)
    node[LOW_X], node[HIGH_X], node[LOW_Y], node[HIGH_Y] = low_x, high_x, low_y, high_y
    node[MASS], node[X], node[Y] = total, x0, y0
    node[XX], node[XY], node[YY], node[RADIUS] = xx, xy, yy, math.sqrt(furthest)


@allocating
def grow(x: Numbers, y: Numbers, mass: Numbers, order: Rows, nodes: Vectors, levels: int) -> None:
    """Sort ``order`` (n,) into the tree, and set ``nodes`` (2^(levels + 1) - 1, 11), the root first."""
    n = len(x)
    key = np.empty(n)
    for level in range(levels + 1):
        for k in range(1 << level):
            first, last = (k * n) >> level, ((k + 1) * n) >> level
            node = nodes[(1 << level) - 1 + k]
            _measure(node, x, y, mass, order[first:last])
            if level < levels:
                wide = node[HIGH_X] - node[LOW_X] >= node[HIGH_Y] - node[LOW_Y]
                for i in range(first, last):
                    key[i] = x[order[i]] if wide else y[order[i]]
                _divide(key, order, first, last, ((2 * k + 1) * n) >> (level + 1))
