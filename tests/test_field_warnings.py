"""Fields that cancel or have no direction: what they cost, and what is told."""

from collections.abc import Callable
from typing import Any

import pytest

from physicslab import World
from physicslab.components import (
    Charge,
    Drag,
    Mass,
    Medium,
    Molecule,
    Shape,
    Spring,
    Thrust,
    Transform,
    Velocity,
)
from physicslab.diagnostics.warnings import find_warnings
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.systems.standard import standard_systems

WEIGHTLESS: dict[str, Any] = {"gravity": (0.0, 0.0)}


def world_of(physics: dict[str, Any] | None = None, **simulation: Any) -> World:
    laws, settings = PhysicsConfig(**(physics or {})), SimulationConfig(**simulation)
    return World(*standard_systems(), physics=laws, simulation=settings)


def on_a_spring() -> World:
    world, k = world_of(), 100.0
    body = (Transform((0.0, -0.5)), Velocity(), Mass(1.0), Drag(linear=4.0, quadratic=0.2))
    bob = world.spawn(*body, name="bob")
    world.spawn(Spring(a=bob, anchor_b=(0.0, 1.0 + 9.81 / k), rest_length=1.0, stiffness=k), name="spring")
    return world


def between_charges() -> World:
    world = world_of(WEIGHTLESS | {"coulomb_constant": 1.0})
    for x in (-1.0, 1.0):
        world.spawn(Transform((x, 0.0)), Charge(1.0))
    body = (Transform((0.1, 0.0)), Velocity(), Mass(1.0), Charge(1.0), Drag(linear=4.0, quadratic=0.2))
    world.spawn(*body, name="bob")
    return world


def afloat() -> World:
    world = world_of()
    world.spawn(Transform((0.0, -5.0)), Shape.box(20.0, 10.0), Medium(1000.0, viscosity=2000.0), name="pool")
    body = (Transform((0.0, 0.05)), Velocity(), Mass(125.0), Shape.box(0.5, 0.5))
    world.spawn(*body, name="bob")
    return world


@pytest.mark.parametrize("build", [on_a_spring, between_charges, afloat])
def test_what_comes_to_rest_at_the_origin_costs_little(build: Callable[[], World]) -> None:
    # There is neither a coordinate nor a speed to measure errors by, but the rounding of forces that cancel.
    world = build()
    world.run(seconds=7.0)
    before = world.force_evaluations
    world.run(seconds=1.0)
    assert world.force_evaluations - before < 15_000
    x, y = world.component(world.entity("bob"), Transform).position
    assert abs(x) < 1e-5
    assert abs(y) < 1e-5
    assert not find_warnings(world)


@pytest.mark.parametrize("kind", ["charge", "molecule", "planet"])
@pytest.mark.parametrize(("near", "told"), [(0.0, True), (1e-200, True), (0.7, False)])
def test_two_in_one_place_are_told_by_name(kind: str, near: float, told: bool) -> None:
    part = {"charge": (Charge, 1.0), "molecule": (Molecule, 1.0, 0.8), "planet": (Drag,)}[kind]
    laws = WEIGHTLESS | {"coulomb_constant": 1.0}
    world = world_of({"gravity_mode": "planet", "G": 1.0} if kind == "planet" else laws)
    for name, x in (("one", 0.0), ("other", near), ("third", 3.0)):
        make: Any = part[0]
        world.spawn(Transform((x, 0.0)), Velocity(), Mass(1.0), make(*part[1:]), name=name)
    world.step()
    found = [str(advice) for advice in find_warnings(world) if "in the place of" in advice.what]
    assert len(found) == told
    assert all("one: " in words and "as other is nearer" in words for words in found)


def test_softened_attraction_has_no_need_of_a_direction() -> None:
    world = world_of(WEIGHTLESS | {"coulomb_constant": 1.0, "softening": 0.1})
    for name in ("one", "other"):
        world.spawn(Transform(), Velocity(), Mass(1.0), Charge(1.0), name=name)
    world.step()
    assert not find_warnings(world)


def test_a_thrust_on_what_cannot_move_is_told() -> None:
    world = world_of()
    world.spawn(Transform(), Thrust((1.0, 0.0)), name="wall")
    world.spawn(Transform((3.0, 0.0)), Velocity(), Mass(1.0), Thrust((1.0, 0.0)), name="rocket")
    world.step()
    (advice,) = find_warnings(world)
    assert str(advice).startswith("wall: has a Thrust that moves nothing")


def test_a_charge_on_which_no_field_acts_is_told_with_the_constant_of_nature() -> None:
    world = world_of()
    for x in (0.0, 1.0):
        world.spawn(Transform((x, 0.0)), Velocity(), Mass(1.0), Charge(1e-5), name=f"charge {x}")
    world.step()
    (advice,) = find_warnings(world)
    assert str(advice).startswith("charge 0.0: has a Charge on which no field acts")
    assert advice.setting == "physics.coulomb_constant = 8.9876e+09"
    for law in ({"coulomb_constant": 1.0}, {"magnetic_field": 1.0}, {"electric_field": (0.0, 1.0)}):
        world.physics = PhysicsConfig(**law)
        world.step()
        assert not any("no field acts" in str(one) for one in find_warnings(world))


def test_steps_that_take_very_many_evaluations_are_told() -> None:
    world = world_of(WEIGHTLESS, dt=1.0, integrator="dop853")
    body = (Transform((1.0, 0.0)), Velocity((1.0, 0.0)), Mass(1.0), Drag(linear=2e4, quadratic=1.0))
    world.spawn(*body, name="bob")
    world.step()
    (advice,) = find_warnings(world)
    assert advice.value == world.force_evaluations
    assert advice.setting == 'simulation.integrator = "implicit_midpoint"'
