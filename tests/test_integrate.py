"""IntegrateSystem and the integrators: exact where they claim to be, and of the order they claim."""

import math

import numpy as np
import pytest

from physicslab.components import Mass, Spring, Transform, Velocity
from physicslab.config import PhysicsConfig, SimulationConfig
from physicslab.diagnostics import measure_energy
from physicslab.integrators import INTEGRATORS, choose
from physicslab.schedule import Stage
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.spring import SpringSystem
from physicslab.vector import Vector2
from physicslab.world import World


def oscillator(integrator: str, substeps: int = 1) -> tuple[World, int]:
    """Return a world of one body at x = 1 on a spring with omega = 2, and the body."""
    simulation = SimulationConfig(dt=0.1, substeps=substeps, integrator=integrator)
    world = World(SpringSystem(), IntegrateSystem(), simulation=simulation)
    body = world.spawn(Transform((1, 0)), Velocity(), Mass(1), Spring(rest_length=0, stiffness=4))
    return world, body


def test_every_body_moves_and_turns_at_its_velocity() -> None:
    world = World(IntegrateSystem())
    mover = world.spawn(Transform((1, 2), 3), Velocity((4, -8), 0.5))
    rock = world.spawn(Transform((1, 2), 3))
    world.step(0.5)
    assert world.component(mover, Transform).position == Vector2(3, -2)
    assert world.component(mover, Transform).angle == 3.25
    assert world.component(rock, Transform).position == Vector2(1, 2)


def test_free_flight_is_exact_with_leapfrog() -> None:
    world = World(GravitySystem(), IntegrateSystem(), simulation=SimulationConfig(integrator="leapfrog"))
    ball = world.spawn(Transform((0, 0)), Velocity((3, 40)), Mass(2))
    world.run(steps=1000)
    t = 1000 / 60
    transform, velocity = world.component(ball, Transform), world.component(ball, Velocity)
    assert transform.position.x == pytest.approx(3 * t, rel=1e-12)
    assert transform.position.y == pytest.approx(40 * t - 9.81 / 2 * t * t, rel=1e-12)
    assert velocity.linear.y == pytest.approx(40 - 9.81 * t, rel=1e-12)


@pytest.mark.parametrize("substeps", [1, 3, 8])
def test_symplectic_euler_falls_short_by_the_formula(substeps: int) -> None:
    simulation = SimulationConfig(dt=0.02, substeps=substeps, integrator="symplectic_euler")
    world = World(GravitySystem(), IntegrateSystem(), simulation=simulation)
    ball = world.spawn(Transform(), Velocity(), Mass())
    world.run(steps=50)
    t, h = 1.0, 0.02 / substeps
    error = world.component(ball, Transform).position.y + 9.81 / 2 * t * t
    assert error == pytest.approx(-9.81 * h * t / 2, rel=1e-9)


@pytest.mark.parametrize("name", INTEGRATORS)
def test_the_order_is_the_order_measured(name: str) -> None:
    substeps, errors = [4, 8, 16, 32], []
    for parts in substeps:
        world, body = oscillator(name, parts)
        world.run(seconds=1.3)
        x, v = world.component(body, Transform).position.x, world.component(body, Velocity).linear.x
        errors.append(math.hypot(x - math.cos(2.6), v + 2 * math.sin(2.6)))
    orders = -np.diff(np.log(errors)) / math.log(2)
    assert orders == pytest.approx(INTEGRATORS[name].order, abs=0.03)


@pytest.mark.parametrize("name", INTEGRATORS)
def test_the_stability_limit_is_where_it_says(name: str) -> None:
    limit = INTEGRATORS[name].stability_limit / 2  # of h, for omega = 2
    for h, bounded in ((0.97 * limit, True), (1.03 * limit, False)):
        world, body = oscillator(name)
        for _ in range(200):
            world.step(h)
        assert (abs(world.component(body, Transform).position.x) < 50) == bounded


@pytest.mark.parametrize("name", INTEGRATORS)
def test_energy_stays_near_where_it_was(name: str) -> None:
    world, _ = oscillator(name)
    drift = []
    for _ in world.stepping(steps=5000):
        drift.append(measure_energy(world).total / 2 - 1)
    assert np.abs(drift[-1000:]).max() < 1.01 * np.abs(drift[:1000]).max() < 0.2
    assert INTEGRATORS[name].symplectic


def test_leapfrog_runs_backwards_to_where_it_came_from() -> None:
    physics = PhysicsConfig(gravity_mode="planet", softening=0.1)
    world = World(GravitySystem(), SpringSystem(), IntegrateSystem(), physics=physics)
    random = np.random.default_rng(2)
    places = random.normal(size=(4, 2))
    for place in places:
        world.spawn(Transform(place), Velocity(-place), Mass(1))
    world.spawn(Spring(1, 2, rest_length=0.5, stiffness=10))
    world.run(steps=200)
    linear = world.table(Velocity)["linear"]
    assert np.abs(world.table(Transform)["position"][1:5] - places).max() > 0.1
    linear *= -1
    world.run(steps=200)
    assert world.table(Transform)["position"][1:5] == pytest.approx(places, abs=1e-9)
    assert linear[1:5] == pytest.approx(places, abs=1e-9)


@pytest.mark.parametrize("method", INTEGRATORS.values(), ids=INTEGRATORS)
def test_every_plan_stands_for_the_whole_substep(method: object) -> None:
    plan = INTEGRATORS[getattr(method, "name")].substep  # noqa: B009
    for stage in (Stage.KICK, Stage.DRIFT, Stage.SOLVE, Stage.FORCE):
        assert sum(share for named, share in plan if named is stage) == 1.0


def test_forces_are_evaluated_as_often_as_is_said() -> None:
    for name, method in INTEGRATORS.items():
        world, _ = oscillator(name, 3)
        world.run(steps=5)
        assert world.force_evaluations == 5 * 3 * method.evaluations


def test_auto_says_what_it_chose_and_why() -> None:
    method, reason = choose("auto", can_touch=True)
    assert (method.name, reason) == ("leapfrog", "bodies can touch")
    assert choose("auto", can_touch=False)[1].startswith("nothing can touch")
    assert choose("symplectic_euler", can_touch=False) == (INTEGRATORS["symplectic_euler"], "asked for")
    with pytest.raises(LookupError, match='integrator "rk5" is not there yet; there are "auto", '):
        choose("rk5", can_touch=False)
