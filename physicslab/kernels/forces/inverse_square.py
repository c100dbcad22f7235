"""The inverse square law between bodies: gravity of planets, and Coulomb's law with its sign.

The force on a is C w_a w_b / d^2 towards b: weights w are masses and C is G, or they are charges and C is
minus Coulomb's constant. Pairs are summed in one of three ways, by how many bodies there are: a plain loop
over pairs for a few, vectors of eight bodies for more (:mod:`physicslab.kernels.forces.pairwise`), a tree for
many whose weights have one sign (:mod:`physicslab.kernels.forces.tree_pull`).
"""

import math

from physicslab.kernels import Numbers, Rows, Vectors, allocating_kernel, inlined, kernel
from physicslab.kernels.forces.pairwise import attract_pairwise, depth_of_pairs
from physicslab.kernels.forces.tree_pull import attract_by_tree, depth_by_tree

PLAIN_LIMIT = 100
"""Largest number of bodies for which pairs are summed one by one, each rounded by itself.

Vectors are faster from about 40 on (10 us instead of 20 for 100 bodies), which makes no difference in
practice, and their roots are accurate to two units in the last place only.
"""
TREE_THRESHOLD = 8_000
"""Number of bodies from which a tree sums the forces.

The tree is as fast as every pair at 3,000 bodies that are spread evenly and at 5,000 in a Plummer sphere,
and at 8,000 takes 1/2.4 and 1/1.4 of the time (``benchmarks/gravity.py``): for fewer bodies, accuracy and
momentum matter more.
"""


@inlined
def inverse_cube(r2: float, softening2: float, plummer: bool) -> float:
    """Return the factor that turns C w_a w_b (x_b - x_a) into the force on a.

    Plummer: 1 / (r^2 + s^2)^(3/2). Clamp: the magnitude is 1 / max(r, s)^2, so the factor is 1 / (max(r, s)^2
    r). Coincident bodies have no direction to pull in, and so no force.
    """
    if plummer:
        d2 = r2 + softening2
        return 1.0 / (d2 * math.sqrt(d2)) if d2 > 0.0 else 0.0
    if r2 > 0.0:
        return 1.0 / (max(r2, softening2) * math.sqrt(r2))
    return 0.0


@inlined
def _has_one_sign(weight: Numbers) -> bool:
    """Whether all are above or all below 0: only then has each group a centre from which it acts as one."""
    above, below = True, True
    for i in range(len(weight)):
        above, below = above and weight[i] > 0.0, below and weight[i] < 0.0
    return above or below


@inlined
def attract(
    x: Numbers, y: Numbers, weight: Numbers, softening: float, plummer: bool, ax: Numbers, ay: Numbers
) -> None:
    """Set ``ax``, ``ay`` [weight/m^2] to the pull of all others on a unit weight at each of many bodies."""
    if len(x) >= TREE_THRESHOLD and _has_one_sign(weight):
        attract_by_tree(x, y, weight, softening, plummer, ax, ay)
    else:
        attract_pairwise(x, y, weight, softening, plummer, ax, ay)


@allocating_kernel
def pair_potential(
    position: Vectors, weight: Numbers, rows: Rows, constant: float, softening: float, plummer: bool
) -> float:
    """Return the energy [J] that belongs to the same force law, zero at infinite distance.

    Plummer: -C w_a w_b / sqrt(r^2 + s^2). Clamp: -C w_a w_b / r beyond s; within, where the force is
    constant, the straight line that continues it: -C w_a w_b (2 s - r) / s^2.
    """
    total = 0.0
    n = len(rows)
    if n > PLAIN_LIMIT:
        x, y, weights = position[rows, 0], position[rows, 1], weight[rows]
        if n >= TREE_THRESHOLD and _has_one_sign(weights):
            return -constant * depth_by_tree(x, y, weights, softening, plummer)
        return -constant * depth_of_pairs(x, y, weights, softening, plummer)
    for p in range(n):
        i = rows[p]
        for q in range(p + 1, n):
            j = rows[q]
            dx = position[j, 0] - position[i, 0]
            dy = position[j, 1] - position[i, 1]
            r = math.sqrt(dx * dx + dy * dy)
            if plummer:
                depth = 1.0 / math.sqrt(r * r + softening * softening) if r + softening > 0.0 else 0.0
            elif r >= softening:
                depth = 1.0 / r if r > 0.0 else 0.0
            else:
                depth = (2.0 * softening - r) / (softening * softening)
            total -= constant * weight[i] * weight[j] * depth
    return total


@kernel
def fastest_fall(
    position: Vectors, yields: Numbers, pulls: Numbers, rows: Rows, constant: float, softening: float,
    plummer: bool,
) -> float:  # fmt: skip
    """Return the largest rate of a free fall of any pair [rad/s], 0 where none act on each other.

    Its square is |C| (y_a p_b + y_b p_a) / d^3: with ``pulls`` p, the size of the weight, and ``yields`` y,
    that over the mass; of gravity, where both are in proportion to the mass, the mass and 1.
    """
    fastest = 0.0
    softening2 = softening * softening
    for p in range(len(rows)):
        i = rows[p]
        for q in range(p + 1, len(rows)):
            j = rows[q]
            dx = position[j, 0] - position[i, 0]
            dy = position[j, 1] - position[i, 1]
            pull = inverse_cube(dx * dx + dy * dy, softening2, plummer)
            fastest = max(fastest, abs(constant) * (yields[i] * pulls[j] + yields[j] * pulls[i]) * pull)
    return math.sqrt(fastest)
