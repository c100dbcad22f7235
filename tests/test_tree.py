"""Gravity by the tree: as near to the direct sum as documented, wherever bodies are."""

import numpy as np
import pytest
from compiled import compiled
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from physicslab.kernels.forces import pairwise, tree_pull
from physicslab.kernels.forces.tree import LEAF, levels_of
from physicslab.kernels.forces.tree_pull import MAX_ERROR, RMS_ERROR

attract_pairwise, depth_of_pairs = compiled(pairwise.attract_pairwise), compiled(pairwise.depth_of_pairs)
attract_by_tree, depth_by_tree = compiled(tree_pull.attract_by_tree), compiled(tree_pull.depth_by_tree)
type Array = NDArray[np.float64]
LAWS = ("clamp", "plummer")


def even(n: int, random: np.random.Generator) -> Array:
    return random.uniform(-1.0, 1.0, (n, 2))


def plummer_sphere(n: int, random: np.random.Generator) -> Array:
    """Return n places of a Plummer sphere of scale 1 m, seen from one side."""
    radius = (random.uniform(1e-6, 1.0, n) ** (-2.0 / 3.0) - 1.0) ** -0.5
    across = np.sqrt(1.0 - random.uniform(-1.0, 1.0, n) ** 2)
    angle = random.uniform(0.0, 2.0 * np.pi, n)
    return np.stack((radius * across * np.cos(angle), radius * across * np.sin(angle)), 1)


def two_clusters(n: int, random: np.random.Generator) -> Array:
    return random.normal(0.0, 0.1, (n, 2)) + np.where(np.arange(n) % 2, 0.0, 1.0)[:, None] * (3.0, 1.0)


def both(position: Array, mass: Array, softening: float, law: str) -> tuple[Array, Array]:
    """Return pulls on a unit mass by the direct sum and by the tree, (2, n) each."""
    x, y = np.ascontiguousarray(position.T)
    direct, tree = np.zeros((2, 2, len(x)))
    attract_pairwise(x, y, mass, softening, law == "plummer", direct[0], direct[1])
    attract_by_tree(x, y, mass, softening, law == "plummer", tree[0], tree[1])
    return direct, tree


def depths(position: Array, mass: Array, softening: float, law: str) -> tuple[float, float]:
    x, y = np.ascontiguousarray(position.T)
    plummer = law == "plummer"
    return depth_of_pairs(x, y, mass, softening, plummer), depth_by_tree(x, y, mass, softening, plummer)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("spread", [even, plummer_sphere, two_clusters])
@pytest.mark.parametrize("n", [3_000, 10_000, 30_000])
def test_forces_are_as_near_as_stated(law: str, spread, n: int) -> None:  # type: ignore[no-untyped-def]
    random = np.random.default_rng(n)
    position, mass = spread(n, random), random.uniform(0.5, 1.5, n)
    direct, tree = both(position, mass, 0.01, law)
    off, mean = np.hypot(*(tree - direct)), np.hypot(*direct).mean()
    assert np.sqrt((off**2).mean()) < RMS_ERROR * mean
    assert off.max() < MAX_ERROR * mean
    stored, by_tree = depths(position, mass, 0.01, law)
    assert by_tree == pytest.approx(stored, rel=3e-5)


@settings(max_examples=40, deadline=None)
@given(
    n=st.integers(2, 300), seed=st.integers(0, 2**32 - 1), law=st.sampled_from(LAWS),
    softening=st.sampled_from((0.0, 1e-3, 0.5)), spots=st.integers(1, 300), far=st.booleans(),
)  # fmt: skip
def test_few_bodies_bodies_on_one_spot_and_one_far_off(
    n: int, seed: int, law: str, softening: float, spots: int, far: bool
) -> None:
    random = np.random.default_rng(seed)
    position, mass = even(n, random)[random.integers(0, min(spots, n), n)], random.uniform(0.5, 2.0, n)
    if far:
        position[0] = 1e9
    direct, tree = both(position, mass, softening, law)
    assert np.hypot(*(tree - direct)).max() <= 10 * MAX_ERROR * np.hypot(*direct).mean() + 1e-300
    stored, by_tree = depths(position, mass, softening, law)
    assert by_tree == pytest.approx(stored, rel=1e-3)


@pytest.mark.parametrize("law", LAWS)
def test_one_body_at_1e9_m_spoils_nothing(law: str) -> None:
    random = np.random.default_rng(5)
    position, mass = even(5_000, random), np.ones(5_000)
    position[17] = 1e9
    direct, tree = both(position, mass, 0.01, law)
    assert np.hypot(*(tree - direct)).max() < MAX_ERROR * np.hypot(*direct).mean()


def test_within_the_softening_nothing_is_taken_whole() -> None:
    """Where all are within the softening of the clamp law, every pair is summed."""
    random = np.random.default_rng(6)
    position, mass = even(2_000, random), np.ones(2_000)
    direct, tree = both(position, mass, 10.0, "clamp")
    assert np.hypot(*(tree - direct)).max() < 1e-12 * np.hypot(*direct).max()


def test_a_pair_pulls_equally() -> None:
    _, tree = both(np.array([[0.0, 0.0], [3.0, 4.0]]), np.array([2.0, 5.0]), 0.0, "clamp")
    assert tree[:, 0] == pytest.approx([5 / 25 * 0.6, 5 / 25 * 0.8], rel=1e-15)
    assert (2.0 * tree[:, 0]).tolist() == pytest.approx((-5.0 * tree[:, 1]).tolist(), rel=1e-15)


def test_the_same_bodies_have_the_same_pulls_to_the_bit() -> None:
    random = np.random.default_rng(7)
    position, mass = plummer_sphere(20_000, random), np.ones(20_000)
    x, y = np.ascontiguousarray(position.T)
    runs = np.zeros((2, 2, 20_000))
    for run in runs:
        attract_by_tree(x, y, mass, 0.01, True, run[0], run[1])
    assert runs[0].tobytes() == runs[1].tobytes()


@pytest.mark.parametrize(
    ("n", "levels"), [(1, 0), (LEAF, 0), (LEAF + 1, 1), (4 * LEAF, 2), (4 * LEAF + 1, 3)]
)
def test_the_depth_depends_on_the_number_alone(n: int, levels: int) -> None:
    assert levels_of.py_func(n) == levels  # type: ignore[attr-defined]
