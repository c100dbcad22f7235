"""Charges: Coulomb's law, and electric and magnetic fields, in every method and beside contacts."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from attraction import attraction

from physicslab import World, load_scene, save_scene
from physicslab.components import Charge, Drag, Mass, Spring, Thrust, Transform, Velocity
from physicslab.diagnostics.energy import measure_account, measure_energy
from physicslab.diagnostics.warnings import find_warnings
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.integrators import INTEGRATORS
from physicslab.kernels.forces.inverse_square import TREE_THRESHOLD
from physicslab.lab.accuracy.catalogue import PROBLEMS
from physicslab.prefabs import box, circle
from physicslab.state.state import State
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import ForceSystem, Stage, at

METHODS = tuple(name for name in INTEGRATORS if name != "exact")
FIELDS = {"coulomb_constant": 1.5, "electric_field": (0.4, -0.2), "magnetic_field": 0.8}


def empty(laws: dict[str, Any], **simulation: Any) -> World:
    """Return an empty world without gravity."""
    physics = PhysicsConfig(**({"gravity_mode": "none"} | laws))
    return World(*standard_systems(), physics=physics, simulation=SimulationConfig(**simulation))


def charge(world: World, at: tuple[float, float], how: tuple[float, float], q: float, m: float = 1.0) -> int:
    return world.spawn(Transform(at), Velocity(how), Mass(m), Charge(q))


@pytest.mark.parametrize("name", ["cyclotron", "crossed_fields", "rutherford"])
def test_problems_with_charges_meet_their_closed_forms(name: str) -> None:
    problem = PROBLEMS[name]
    assert problem.finish(problem.worlds(SimulationConfig())) < 1e-12


@pytest.mark.parametrize("integrator", METHODS)
def test_accounts_hold_in_all_fields(integrator: str) -> None:
    world = empty(FIELDS, integrator=integrator, substeps=1)
    charge(world, (0.0, 0.0), (0.3, 0.0), 1.0)
    charge(world, (1.0, 0.4), (0.0, 0.5), 2.0, 2.0)
    world.spawn(Transform((0.0, 2.0)), Charge(0.5))  # it stays, and takes momentum
    world.run(seconds=1.0)
    account = measure_account(world)
    order = INTEGRATORS[integrator].order
    error = {1: 0.1, 2: 1e-2, 4: 1e-7, 6: 1e-7, 8: 1e-13}[int(order)]
    assert account.energy["fields"] == 0.0, "two store their energy, and one does no work"
    assert abs(account.energy["numerical"]) < error
    assert account.momentum["fields"].magnitude > 0.1
    assert account.momentum["numerical"].magnitude < 1e-14
    assert abs(account.angular_momentum["numerical"]) < (1e-5 if integrator == "rk4" else 1e-13)
    assert set(account.parts.potential) == {"coulomb", "electric_field"}


@pytest.mark.parametrize("integrator", [name for name in METHODS if INTEGRATORS[name].kicks])
def test_a_splitting_turns_velocities_exactly_whatever_the_step(integrator: str) -> None:
    world = empty({"magnetic_field": 20.0}, integrator=integrator, dt=0.25, substeps=1)
    one = charge(world, (0.0, 0.0), (3.0, 4.0), 1.0)  # five radians a step
    world.run(seconds=100.0)
    speed = world.component(one, Velocity).linear
    assert speed.magnitude == pytest.approx(5.0, rel=1e-14)
    expected = complex(3.0, 4.0) * np.exp(-2000j)
    assert (speed.x, speed.y) == pytest.approx((expected.real, expected.imag), abs=1e-11)
    # The canonical momentum m v + q B (-y, x) is kept: the field gave what the place shows.
    place, given = world.component(one, Transform).position, measure_account(world).momentum["fields"]
    assert (given.x, given.y) == pytest.approx((20.0 * place.y, -20.0 * place.x), abs=1e-12)
    assert not [warning for warning in find_warnings(world) if "order" in warning.what]


@pytest.mark.parametrize("integrator", METHODS)
def test_methods_keep_their_order_in_a_magnetic_field(integrator: str) -> None:
    method = INTEGRATORS[integrator]
    if method.chooses_steps:
        return

    def ends(steps: int) -> complex:
        world = empty({"magnetic_field": 2.0}, integrator=integrator, dt=1.0 / steps, substeps=1)
        one = charge(world, (1.0, 0.0), (0.0, 0.7), 1.0)
        world.add(one, Spring(rest_length=0.3, stiffness=9.0))
        world.run(seconds=1.0)
        return complex(*world.component(one, Transform).position)

    true = ends(4096) if method.order < 6 else ends(64)
    coarse, fine = (abs(ends(steps) - true) for steps in ((16, 32) if method.order < 6 else (4, 8)))
    assert math.log2(coarse / fine) > method.order - 0.5


@pytest.mark.parametrize(
    ("contacts", "integrator"), [("rigid", "auto"), *(("soft", name) for name in ("auto", *METHODS))]
)
def test_beside_contacts_a_magnetic_field_does_no_work(contacts: str, integrator: str) -> None:
    world = empty({"magnetic_field": 3.0}, contacts=contacts, integrator=integrator)
    ball = circle(world, (0.0, 1.2), radius=0.2, velocity=(2.0, 0.0), restitution=1.0, friction=0.0)
    box(world, (0.0, 0.0), width=9.0, height=1.0, static=True, restitution=1.0, friction=0.0)
    world.add(ball, Charge(1.0))
    world.run(seconds=10.0)
    assert world.collisions > 5
    assert world.component(ball, Velocity).linear.magnitude == pytest.approx(2.0, rel=1e-13)
    account = measure_account(world)
    assert abs(account.energy["fields"]) + abs(account.energy["numerical"]) < 1e-13
    assert account.momentum["numerical"].magnitude < 1e-12
    if contacts == "soft" and integrator == "auto":
        assert "charges move by blanes_moan: the magnetic field turns" in world.plan.reason


class Still(ForceSystem):
    """A force in Python that is zero: all bodies are kicked beside it."""

    @at(Stage.FORCE)
    def push(self, world: State, h: float) -> None:
        """Push nothing."""


def test_kicks_by_a_magnetic_field_do_no_work_but_are_wrong() -> None:
    world = empty({"magnetic_field": 1.3}, contacts="soft")
    world.install(Still())
    world.add(circle(world, (0.0, 3.0), radius=0.2, velocity=(1.0, 0.0)), Charge(1.0))
    box(world, (0.0, -9.0), width=9.0, height=1.0, static=True)
    world.run(steps=20)
    account = measure_account(world)
    assert account.energy["fields"] == 0.0
    assert account.energy["numerical"] == pytest.approx(account.change, rel=1e-12)
    assert account.change > 1e-4  # kicks at the velocity before them lengthen it: the method's error
    assert account.momentum["numerical"].magnitude < 1e-12


@pytest.mark.parametrize("softening", [0.0, 0.5])
@pytest.mark.parametrize("law", ["clamp", "plummer"])
def test_charges_of_one_sign_repel_and_softening_holds_for_them_too(softening: float, law: str) -> None:
    world = empty({"coulomb_constant": 2.0, "softening": softening, "softening_law": law})
    charge(world, (0.0, 0.0), (0.0, 0.0), 1.0)
    right = charge(world, (0.3, 0.0), (0.0, 0.0), 3.0)
    if law == "clamp":
        d = max(0.3, softening)
        force, energy = 6.0 / d**2, 6.0 * (2.0 * d - 0.3 if softening else d) / d**2
    else:
        d = math.hypot(0.3, softening)
        force, energy = 6.0 * 0.3 / d**3, 6.0 / d
    assert measure_energy(world).potential["coulomb"] == pytest.approx(energy, rel=1e-14)
    world.step(1e-9)
    assert world.component(right, Velocity).linear.x == pytest.approx(1e-9 * force, rel=1e-9)


def test_many_charges_of_both_signs_are_summed_pair_by_pair() -> None:
    n, random = TREE_THRESHOLD, np.random.default_rng(5)
    place, weight = random.normal(size=(n, 2)), np.where(np.arange(n) % 2, 1.0, -1.0)
    force = attraction(place, weight, -1.0, 0.01, True)
    assert abs(force.sum(axis=0)).max() < 1e-13 * np.abs(force).sum(), "a tree would not keep momentum so"


def test_planets_that_are_charged_fall_by_both_laws() -> None:
    laws = {"gravity_mode": "planet", "G": 3.0, "coulomb_constant": 1.0}
    world = empty(laws)
    for n, sign in enumerate((1.0, -1.0)):
        charge(world, (sign, 0.0), (0.0, sign), sign * (1.0 + n), 1.0)
    # They attract each other by 3 + 2 = 5 at 2 m: a circle needs v^2 = 5 / 4 * 1.
    for entity in world.batch(Charge).entities.tolist():
        velocity = world.component(entity, Velocity)
        velocity.linear = velocity.linear * math.sqrt(1.25)
    world.run(seconds=10.0)
    for entity in world.batch(Charge).entities.tolist():
        assert world.component(entity, Transform).position.magnitude == pytest.approx(1.0, abs=1e-13)
    assert set(world.fastest_rates) == {"GravitySystem", "CoulombSystem"}


def test_beside_contacts_each_cause_has_its_momentum() -> None:
    world = empty(FIELDS | {"gravity_mode": "linear", "magnetic_field": 0.0}, contacts="soft")
    box(world, (0.0, -5.0), width=9.0, height=1.0, static=True)
    ball = circle(world, (0.0, 0.0), radius=0.2)
    world.add(ball, Charge(2.0))
    world.add(ball, Thrust((0.0, 0.5)))
    world.spawn(Transform((0.0, 1.0)), Charge(1.0))
    world.run(seconds=0.5)
    given, velocity = measure_account(world).momentum, world.component(ball, Velocity).linear
    assert given["fields"].x == pytest.approx(velocity.x, rel=1e-12)
    assert given["thrust"].y == pytest.approx(0.25, rel=1e-12)
    assert given["fields"].y == pytest.approx(velocity.y + 9.81 * 0.5 - 0.25, rel=1e-12)
    assert given["gravity"].y == pytest.approx(-9.81 * 0.5, rel=1e-12)
    assert given["numerical"].magnitude < 1e-13


def test_scenes_without_what_acts_leave_systems_out_and_say_why() -> None:
    world = empty({})
    charge(world, (0.0, 0.0), (0.0, 0.0), 1.0)
    world.add(world.batch(Charge).entities.tolist()[0], Drag(linear=1.0))
    world.synchronise()
    reasons = {left.name: left.reason for left in world.schedule.left_out}
    assert reasons["CoulombSystem"] == "coulomb_constant is 0"
    assert reasons["ElectricFieldSystem"] == "electric_field is 0"
    assert reasons["MagneticFieldSystem"] == "magnetic_field is 0"
    world.physics = PhysicsConfig(coulomb_constant=1.0)
    world.synchronise()
    reasons = {left.name: left.reason for left in world.schedule.left_out}
    assert reasons["CoulombSystem"] == "fewer than two charges act on each other"


def test_files_keep_charges_and_laws(tmp_path: Path) -> None:
    world = empty(FIELDS)
    charge(world, (0.0, 0.0), (1.0, 0.0), 1.5e-6)
    save_scene(world, tmp_path / "fields.json")
    again = load_scene(tmp_path / "fields.json")
    assert again.physics == world.physics
    (entity,) = again.batch(Charge).entities.tolist()
    assert again.component(entity, Charge).charge == 1.5e-6
