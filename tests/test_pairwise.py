"""Pairwise gravity in vectors: the reference formula, its energy, and that it is in vectors."""

import ctypes
import re
from typing import Any

import numba
import numpy as np
import pytest
from attraction import attraction
from compiled import compiled
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from physicslab.kernels import FASTMATH
from physicslab.kernels.forces import packed_forces, pairwise
from physicslab.kernels.forces.inverse_square import TREE_THRESHOLD, pair_potential

inverse_root = compiled(pairwise.inverse_root)

type Array = NDArray[np.float64]
LAWS = ("clamp", "plummer")


def crowd(seed: int, n: int, scale: float = 1.0) -> tuple[Array, Array]:
    """Return places [m] and masses [kg] of n bodies, some of them on one spot."""
    random = np.random.default_rng(seed)
    position = random.normal(0.0, scale, (n, 2))
    position[random.integers(0, n, n // 10)] = position[0]
    return position, random.uniform(0.5, 2.0, n)


def reference(position: Array, mass: Array, softening: float, law: str) -> tuple[Array, Array, float]:
    """Return forces and the sums of their magnitudes [N], and the energy [J], with G = 1, by the formula."""
    way = position[None] - position[:, None]
    r = np.hypot(way[..., 0], way[..., 1])
    np.fill_diagonal(r, np.inf)
    s = softening
    with np.errstate(divide="ignore", invalid="ignore"):
        if law == "plummer":
            factor, depth = (r * r + s * s) ** -1.5, 1.0 / np.hypot(r, s)
        else:
            factor = 1.0 / (np.maximum(r, s) ** 2 * r)
            depth = np.where(r >= s, 1.0 / r, (2.0 * s - r) / (s * s or 1.0))
        products = mass[:, None] * mass
        factor, depth = np.where(r > 0.0, factor, 0.0), np.where(np.isfinite(depth), depth, 0.0)
        size = np.where(r > 0.0, products * factor * np.where(np.isfinite(r), r, 0.0), 0.0)
    force = (products * factor)[..., None] * way
    return force.sum(1), size.sum(1), -0.5 * float((products * depth).sum())


def forces(position: Array, mass: Array, softening: float, law: str, G: float = 1.0) -> Array:
    return attraction(position, mass, G, softening, law == "plummer")


def energy(position: Array, mass: Array, softening: float, law: str) -> float:
    rows = np.arange(len(mass))
    return pair_potential(position, mass, rows, 1.0, softening, law == "plummer")


@given(st.floats(1e-149, 1e290))
def test_the_root_is_right_to_four_units_in_the_last_place(d2: float) -> None:
    assert inverse_root(d2) == pytest.approx(d2**-0.5, rel=8.9e-16)


@pytest.mark.parametrize("law", LAWS)
@settings(max_examples=25, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1), n=st.sampled_from((2, 3, 63, 100, 101, 128, 129, 200, 321)),
    softening=st.sampled_from((0.0, 1e-6, 0.1, 10.0)), scale=st.sampled_from((1e-9, 1.0, 1e11)),
)  # fmt: skip
def test_forces_and_energy_are_those_of_the_formula(
    law: str, seed: int, n: int, softening: float, scale: float
) -> None:
    position, mass = crowd(seed, n, scale)
    softening *= scale
    expected, size, stored = reference(position, mass, softening, law)
    got = forces(position, mass, softening, law)
    assert (np.hypot(*(got - expected).T) <= 1e-14 * size).all()
    assert energy(position, mass, softening, law) == pytest.approx(stored, rel=1e-13)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("n", [50, 150, TREE_THRESHOLD])
def test_compiled_integrators_have_the_same_forces(law: str, n: int) -> None:
    position, mass = crowd(3, n)
    place = 2 * np.random.default_rng(4).permutation(n)
    q, force = np.zeros((2, 2 * n))
    q[place], q[place + 1] = position.T
    numbers = np.concatenate(((2.0, 0.1), mass, mass, np.ones(n), (0.0,)))
    whole = np.concatenate(((n, law == "plummer", 2 + 3 * n), place))
    address = ctypes.c_void_p
    pull = ctypes.CFUNCTYPE(None, address, address, ctypes.c_double, address, address, address)(
        packed_forces.inverse_square.address
    )
    pull(q.ctypes.data, q.ctypes.data, 0.0, force.ctypes.data, numbers.ctypes.data, whole.ctypes.data)
    expected = forces(position, mass, 0.1, law, G=2.0)
    got = np.stack((force[place], force[place + 1]), 1)
    assert np.abs(got - expected).max() <= 1e-13 * np.abs(expected).max()


@pytest.mark.parametrize("law", LAWS)
def test_momentum_is_kept_to_rounding(law: str) -> None:
    position, mass = crowd(1, 1_000)
    force = forces(position, mass, 0.01, law)
    assert abs(force.sum(0)).max() < 1e-13 * np.abs(force).sum()


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("softening", [0.0, 0.5])
@pytest.mark.parametrize("n", [101, 128, TREE_THRESHOLD])
def test_bodies_on_one_spot_do_not_pull(law: str, softening: float, n: int) -> None:
    position, mass = np.full((n, 2), 3.0), np.ones(n)
    assert not forces(position, mass, softening, law).any()
    assert np.isfinite(energy(position, mass, softening, law))


@pytest.mark.parametrize("n", [101, TREE_THRESHOLD])
def test_what_is_not_a_number_stays_so(n: int) -> None:
    position, mass = crowd(2, n)
    position[7, 0] = np.nan
    assert np.isnan(forces(position, mass, 0.1, "plummer")).any()


def test_the_inner_loop_is_in_vectors() -> None:
    """No square root and no division is left in it, and its multiplications are of packed numbers."""
    between: Any = pairwise._attract_between
    made = numba.njit(error_model="numpy", fastmath=FASTMATH)(
        between.py_func
    )  # code from a cache is not shown
    made(np.zeros(2 * 5 * pairwise.TILE), 0, 5 * pairwise.TILE, 0.1, np.inf)
    [assembly] = made.inspect_asm().values()
    packed = re.findall(r"\b(?:v?mulpd|vfn?m(?:add|sub)\d+pd|fml[as]\.2d|fmul\.2d|fmul\tv)", assembly)
    assert len(packed) > 10
    assert not re.search(r"sqrt|div[ps]d|fdiv", assembly)
