"""Clusters of circles against a search through all pairs."""

import numpy as np
import pytest
from compiled import compiled
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from physicslab.kernels.broad.clusters import label_clusters
from physicslab.kernels.interpreter import fallback_of

label = compiled(label_clusters)


def clusters_by_search(position: NDArray[np.float64], radius: NDArray[np.float64]) -> list[int]:
    """Return the smallest number of each circle's cluster."""
    apart = position[:, None] - position
    near = (apart**2).sum(axis=2) <= (radius[:, None] + radius) ** 2
    labels = np.arange(len(radius))
    for _ in radius:
        labels = np.array([labels[row].min() for row in near])
    found: list[int] = labels.tolist()
    return found


@settings(max_examples=60)
@given(seed=st.integers(0, 10_000), count=st.integers(1, 40), spread=st.floats(0.5, 40.0))
def test_clusters_are_those_of_a_search_through_all_pairs(seed: int, count: int, spread: float) -> None:
    random = np.random.default_rng(seed)
    position = random.uniform(0.0, spread, (count, 2)) * (1.0, 0.3)
    radius = 10.0 ** random.uniform(-2.0, 0.5, count)
    wanted = clusters_by_search(position, radius)
    for axis in (0, 1):
        for kernel in (label, fallback_of(label_clusters)):
            labels, order = np.arange(count), np.argsort(position[:, axis], kind="stable")
            kernel(order, axis, position, radius, labels)
            assert labels.tolist() == wanted


@pytest.mark.parametrize("axis", [0, 1])
def test_what_does_not_count_joins_nothing(axis: int) -> None:
    position, radius, labels = np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]), np.full(3, 0.6), np.arange(3)
    label(np.array([0, 2]), axis, position, radius, labels)
    assert labels.tolist() == [0, 1, 2]
