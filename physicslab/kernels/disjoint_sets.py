"""Disjoint sets of numbers, as an array in which each has a smaller one of its set, or is the smallest."""

from physicslab.kernels import Rows, inlined


@inlined
def root_of(parent: Rows, i: int) -> int:
    """Return the smallest number of the set of i; ways to it are halved."""
    while parent[i] != i:
        parent[i] = parent[parent[i]]
        i = parent[i]
    return i


@inlined
def join_sets(parent: Rows, i: int, j: int) -> None:
    """Make one set of those of i and j."""
    i, j = root_of(parent, i), root_of(parent, j)
    if i != j:
        parent[max(i, j)] = min(i, j)
