"""Uniform and pairwise gravity.

Pairs are summed in one of three ways, by how many bodies there are: a plain loop over pairs for a few,
vectors of eight bodies for more (:mod:`physicslab.kernels.forces.pairwise`), a tree for many
(:mod:`physicslab.kernels.forces.tree_pull`).
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


@kernel
def uniform_gravity(force: Vectors, mass: Numbers, inverse_mass: Numbers, gx: float, gy: float) -> None:
    """Add m g to the force on every row that forces can move."""
    for i in range(len(mass)):
        if inverse_mass[i] > 0.0:
            force[i, 0] += mass[i] * gx
            force[i, 1] += mass[i] * gy


@kernel
def uniform_potential(position: Vectors, mass: Numbers, inverse_mass: Numbers, gx: float, gy: float) -> float:
    """Return the sum of -m g . x [J], zero at the origin."""
    total = 0.0
    for i in range(len(mass)):
        if inverse_mass[i] > 0.0:
            total -= mass[i] * (gx * position[i, 0] + gy * position[i, 1])
    return total


@inlined
def inverse_cube(r2: float, softening2: float, plummer: bool) -> float:
    """Return the factor that turns G m_a m_b (x_b - x_a) into the force on a.

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
def attract(
    x: Numbers, y: Numbers, mass: Numbers, softening: float, plummer: bool, ax: Numbers, ay: Numbers
) -> None:
    """Set ``ax``, ``ay`` [kg/m^2] to the pull of all others on a unit mass at each of many bodies."""
    if len(x) >= TREE_THRESHOLD:
        attract_by_tree(x, y, mass, softening, plummer, ax, ay)
    else:
        attract_pairwise(x, y, mass, softening, plummer, ax, ay)


@allocating_kernel
def planet_potential(
    position: Vectors, mass: Numbers, rows: Rows, G: float, softening: float, plummer: bool
) -> float:
    """Return the energy [J] that belongs to the same force law, zero at infinite distance.

    Plummer: -G m_a m_b / sqrt(r^2 + s^2). Clamp: -G m_a m_b / r beyond s; within, where the force is
    constant, the straight line that continues it: -G m_a m_b (2 s - r) / s^2.
    """
    total = 0.0
    n = len(rows)
    if n > PLAIN_LIMIT:
        x, y, weight = position[rows, 0], position[rows, 1], mass[rows]
        if n >= TREE_THRESHOLD:
            return -G * depth_by_tree(x, y, weight, softening, plummer)
        return -G * depth_of_pairs(x, y, weight, softening, plummer)
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
            total -= G * mass[i] * mass[j] * depth
    return total


@kernel
def fastest_fall(
    position: Vectors, mass: Numbers, rows: Rows, G: float, softening: float, plummer: bool
) -> float:
    """Return the largest sqrt(|G| (m_a + m_b) / d^3) of any pair [rad/s], 0 where no two attract."""
    fastest = 0.0
    softening2 = softening * softening
    for p in range(len(rows)):
        i = rows[p]
        for q in range(p + 1, len(rows)):
            j = rows[q]
            dx = position[j, 0] - position[i, 0]
            dy = position[j, 1] - position[i, 1]
            pull = inverse_cube(dx * dx + dy * dy, softening2, plummer)
            fastest = max(fastest, abs(G) * (mass[i] + mass[j]) * pull)
    return math.sqrt(fastest)
