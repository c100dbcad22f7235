"""Time pairwise gravity and the tree, and measure how far the tree is off.

``uv run python benchmarks/gravity.py [--sizes 1000 ...]`` prints for each number of bodies and each way in
which they lie the time of one evaluation of all forces [ms of CPU] by the direct sum, and by the tree;
directed pairs n (n - 1) a second of the direct sum (pairs counted once are half as many); and how far the
tree's forces are off, as shares of the mean force. Times are medians; direct sum and tree take turns, so that
both see the same machine.
"""

from __future__ import annotations

import argparse
import statistics
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from physicslab.kernels.forces.pairwise import attract_pairwise, depth_of_pairs
from physicslab.kernels.forces.tree_pull import MAX_ERROR, RMS_ERROR, THETA, attract_by_tree, depth_by_tree
from physicslab.lab.case import cpu_time

type Array = NDArray[np.float64]

SIZES = (1_000, 2_000, 4_000, 8_000, 16_000, 32_000, 64_000)
SOFTENING = 0.01
REPEATS = 5


def even(n: int, random: np.random.Generator) -> Array:
    """Return places evenly in a square of 2 m, (n, 2)."""
    return random.uniform(-1.0, 1.0, (n, 2))


def plummer_sphere(n: int, random: np.random.Generator) -> Array:
    """Return places of a Plummer sphere of scale 1 m, seen from one side."""
    radius = (random.uniform(1e-6, 1.0, n) ** (-2.0 / 3.0) - 1.0) ** -0.5
    across = np.sqrt(1.0 - random.uniform(-1.0, 1.0, n) ** 2)
    angle = random.uniform(0.0, 2.0 * np.pi, n)
    return np.stack((radius * across * np.cos(angle), radius * across * np.sin(angle)), 1)


def two_clusters(n: int, random: np.random.Generator) -> Array:
    """Return places in two normal clusters of 0.1 m, sqrt(10) m apart."""
    return random.normal(0.0, 0.1, (n, 2)) + np.where(np.arange(n) % 2, 0.0, 1.0)[:, None] * (3.0, 1.0)


def measure(spread: Callable[[int, np.random.Generator], Array], n: int) -> str:
    """Return one line of the table."""
    random = np.random.default_rng(n)
    x, y = np.ascontiguousarray(spread(n, random).T)
    mass = random.uniform(0.5, 1.5, n)
    direct, tree = np.zeros((2, 2, n))

    def sum_directly() -> None:
        attract_pairwise(x, y, mass, SOFTENING, True, direct[0], direct[1])

    def sum_by_tree() -> None:
        attract_by_tree(x, y, mass, SOFTENING, True, tree[0], tree[1])

    turns = [(cpu_time(sum_directly)[0], cpu_time(sum_by_tree)[0]) for _ in range(REPEATS)]
    by_pairs, by_tree = (statistics.median(column) for column in zip(*turns, strict=True))
    off, mean = np.hypot(*(tree - direct)), np.hypot(*direct).mean()
    stored, estimate = depth_of_pairs(x, y, mass, SOFTENING, True), depth_by_tree(x, y, mass, SOFTENING, True)
    return (
        f"{spread.__name__:14} {n:6} {1e3 * by_pairs:9.2f} {n * (n - 1) / by_pairs / 1e6:7.0f} "
        f"{1e3 * by_tree:8.2f} {by_pairs / by_tree:6.2f}   "
        f"{np.sqrt((off**2).mean()) / mean:7.1e} {off.max() / mean:8.1e} {abs(estimate / stored - 1.0):7.1e}"
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES)
    sizes = parser.parse_args().sizes
    for spread in (even, plummer_sphere, two_clusters):
        measure(spread, 1_000)  # compiled, and warm
    print(f"theta {THETA}: stated are {RMS_ERROR:g} by root mean square, {MAX_ERROR:g} at most")
    print("places          bodies direct ms Mpair/s  tree ms  ratio   rms off  max off  energy")
    for n in sizes:
        for spread in (even, plummer_sphere, two_clusters):
            print(measure(spread, n), flush=True)


if __name__ == "__main__":
    main()
