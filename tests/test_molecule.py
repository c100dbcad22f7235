"""Molecules: the law of Lennard and Jones against plain sums and quadrature, alone and in crowds."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from physicslab import World, load_scene, save_scene
from physicslab.components import Held, Mass, Molecule, Shape, Transform, Velocity
from physicslab.diagnostics.energy import measure_account, measure_energy, measure_momentum
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.integrators import INTEGRATORS
from physicslab.kernels.forces.molecules import CUT2, SHIFT
from physicslab.lab.accuracy.catalogue import PROBLEMS
from physicslab.systems.standard import standard_systems

METHODS = tuple(name for name in INTEGRATORS if name != "exact")


def empty(**simulation: Any) -> World:
    """Return an empty world without gravity."""
    laws = PhysicsConfig(gravity_mode="none")
    return World(*standard_systems(), physics=laws, simulation=SimulationConfig(**simulation))


def molecule(
    world: World, at: tuple[float, float], depth: float = 1.0, distance: float = 0.3,
    how: tuple[float, float] = (0.0, 0.0), mass: float = 1.0,
) -> int:  # fmt: skip
    return world.spawn(Transform(at), Velocity(how), Mass(mass), Molecule(depth, distance))


def test_two_molecules_oscillate_with_the_period_of_the_quadrature() -> None:
    problem = PROBLEMS["two_molecules"]
    assert problem.finish(problem.worlds(SimulationConfig())) < 1e-12


def test_forces_and_energy_are_the_plain_sums_of_all_pairs_with_mixed_numbers() -> None:
    random, world, n = np.random.default_rng(2), empty(), 300
    depth, distance = random.uniform(0.5, 2.0, n), random.uniform(0.2, 0.4, n)
    place = np.stack(np.meshgrid(np.arange(20.0), np.arange(15.0)), axis=-1).reshape(-1, 2) * 0.35
    place += random.uniform(-0.06, 0.06, place.shape) - 3.0
    for k in range(n):
        molecule(world, tuple(place[k]), depth[k], distance[k])
    way = place - place[:, None]
    d2 = np.square(0.5 * (distance + distance[:, None]))
    share = d2 / np.where(np.eye(n) > 0, np.inf, np.square(way).sum(axis=-1))
    e, s = np.sqrt(depth * depth[:, None]), share**3
    acts = share * CUT2 > 1.0
    energy = 0.5 * np.where(acts, e * (s * s - 2.0 * s - SHIFT), 0.0).sum()
    pull = np.where(acts, -12.0 * e * (s * s - s) * share / d2, 0.0)[..., None] * way
    assert measure_energy(world).potential["molecules"] == pytest.approx(energy, rel=1e-13)
    world.step(1e-9)
    found = world.table(Velocity)["linear"][world.batch(Molecule).rows] / 1e-9
    assert found == pytest.approx(pull.sum(axis=1), rel=1e-6, abs=1e-5 * float(np.abs(pull).max()))


def test_the_energy_is_least_at_the_distance_and_continuous_at_the_cut() -> None:
    world = empty()
    molecule(world, (0.0, 0.0), 2.0)
    other = molecule(world, (0.3, 0.0), 2.0)
    assert measure_energy(world).potential["molecules"] == pytest.approx(-2.0 * (1.0 + SHIFT), rel=1e-14)
    assert pytest.approx(-0.016316891136) == SHIFT
    cut = 2.5 * 0.3 / 2.0 ** (1.0 / 6.0)
    world.component(other, Transform).position = (cut * (1.0 - 1e-9), 0.0)
    assert measure_energy(world).potential["molecules"] == pytest.approx(0.0, abs=1e-9)
    world.component(other, Transform).position = (cut * (1.0 + 1e-9), 0.0)
    assert measure_energy(world).potential["molecules"] == 0.0


@pytest.mark.parametrize("integrator", METHODS)
def test_accounts_hold_for_molecules_about_a_fixed_one(integrator: str) -> None:
    world = empty(integrator=integrator, dt=1.0 / 480.0, substeps=1)
    world.spawn(Transform(), Molecule(2.0, 0.3))
    molecule(world, (0.32, 0.0), how=(0.0, 0.5))
    molecule(world, (0.0, -0.35), how=(0.3, 0.0), mass=2.0)
    before = measure_energy(world).total
    world.run(seconds=0.5)
    account = measure_account(world)
    error = {1: 0.2, 2: 5e-2, 4: 1e-4, 6: 1e-4, 8: 1e-6}[int(INTEGRATORS[integrator].order)]
    assert measure_energy(world).total - before == pytest.approx(sum(account.energy.values()), abs=1e-14)
    assert account.energy["fields"] == 0.0 and abs(account.energy["numerical"]) < error
    assert account.momentum["fields"].magnitude > 0.01
    assert account.momentum["numerical"].magnitude < 1e-12


def test_a_crowd_keeps_energy_momentum_and_bits() -> None:
    ends = []
    for _ in range(2):
        world = load_scene("droplets")
        before = measure_energy(world)
        world.run(seconds=0.5)
        ends.append(world.table(Transform)["position"].tobytes())
        assert "molecules: symplectic" in world.plan.reason
        account = measure_account(world)
        assert abs(account.energy["numerical"]) < 1e-4 * before.kinetic
        assert measure_momentum(world).linear.magnitude < 1e-12
    assert ends[0] == ends[1]


def test_beside_contacts_a_crowd_is_moved_in_steps_that_resolve_it() -> None:
    world = World(
        *standard_systems(), physics=PhysicsConfig(gravity_mode="none", bounds=(-1.0, -1.0, 4.0, 4.0))
    )
    for k in range(36):
        one = molecule(world, (0.4 * (k % 6), 0.4 * (k // 6)), how=(0.4 * math.cos(k), 0.4 * math.sin(k)))
        world.add(one, Shape.circle(0.05))
    before = measure_energy(world).total
    world.run(seconds=0.25)
    assert "charges" not in world.plan.reason and "many molecules" in world.plan.reason
    account = measure_account(world)
    assert abs(account.energy["numerical"]) < 1e-3 * abs(before)


def test_one_alone_or_held_is_left_out_and_bad_numbers_are_refused(tmp_path: Path) -> None:
    world = empty()
    one = molecule(world, (0.0, 0.0))
    world.add(molecule(world, (0.3, 0.0), 0.5, 0.2), Held())
    world.synchronise()
    reasons = {left.name: left.reason for left in world.schedule.left_out}
    assert reasons["MoleculeSystem"] == "fewer than two molecules act on each other"
    save_scene(world, tmp_path / "two.json")
    again = load_scene(tmp_path / "two.json")
    assert len(again.batch(Molecule)) == 2
    with pytest.raises(InvalidValue, match=r"Molecule\.distance = 0.0: must be a finite number > 0 m"):
        world.component(one, Molecule).distance = 0.0
