"""IntegrateSystem and the integrators: exact where they claim to be, and of the order they claim."""

import dataclasses
import itertools
import math

import numpy as np
import pytest

from physicslab.components import Mass, Spring, Transform, Velocity
from physicslab.diagnostics.energy import measure_energy
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.integrators import INTEGRATORS
from physicslab.integrators.integrator import Flow, Splitting
from physicslab.kernels.ode.splitting import split
from physicslab.state.masses import Diverged
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.spring import SpringSystem
from physicslab.systems.system import Stage, System, at
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


FIXED = [name for name, method in INTEGRATORS.items() if not method.chooses_steps]


def elastic_pendulum(integrator: str, substeps: int, tolerance: float = 1e-16) -> tuple[World, int]:
    """Return the elastic pendulum of the reference problems, stepped 0.5 s at a time, and its bob."""
    simulation = SimulationConfig(dt=0.5, substeps=substeps, integrator=integrator, tolerance=tolerance)
    world = World(GravitySystem(), SpringSystem(), IntegrateSystem(), simulation=simulation)
    spring = Spring(rest_length=1, stiffness=40)
    return world, world.spawn(Transform((1.2, 0)), Velocity(), Mass(1), spring)


def error_after_one_second(world: World, bob: int) -> float:
    """Return how far the elastic pendulum is from where it should be at t = 1 s [m]."""
    world.run(seconds=1.0)
    place = world.component(bob, Transform).position
    return math.hypot(place.x + 0.6462298902398042, place.y + 1.284530828135613)


def measured_order(name: str) -> float:
    """Return the order of a method: steps are halved until rounding would be seen, or there are very many."""
    parts, error = 4, math.inf
    while error > 1e-11 and parts <= 4096:
        before, error = error, error_after_one_second(*elastic_pendulum(name, parts))
        parts *= 2
    return math.log2(before / error)


@pytest.mark.parametrize("name", FIXED)
def test_the_order_is_the_order_measured(name: str) -> None:
    assert measured_order(name) == pytest.approx(INTEGRATORS[name].order, abs=0.1)


def triple_jump(drifts: tuple[float, ...], order: int) -> tuple[float, ...]:
    """Return three steps of a symmetric method in place of one, of an order that is higher by two."""
    outer = 1.0 / (2.0 - 2.0 ** (1.0 / (order + 1)))
    return tuple(scale * drift for scale in (outer, 1.0 - 2.0 * outer, outer) for drift in drifts)


RUTH_3 = Splitting(drifts=(2 / 3, -2 / 3, 1.0), kicks=(7 / 24, 3 / 4, -1 / 24, 0.0))
_DRIFTS = triple_jump(triple_jump(triple_jump((1.0,), 2), 4), 6)
_KICKS = tuple((before + after) / 2 for before, after in itertools.pairwise((0.0, *_DRIFTS, 0.0)))
YOSHIDA_8 = Splitting(drifts=_DRIFTS, kicks=_KICKS)


@pytest.mark.parametrize(("order", "flow"), [(3, RUTH_3), (8, YOSHIDA_8)])
def test_any_order_can_be_measured(order: int, flow: Flow, monkeypatch: pytest.MonkeyPatch) -> None:
    method = dataclasses.replace(INTEGRATORS["rk4"], flow=flow, kernels=(split,))
    monkeypatch.setitem(INTEGRATORS, "rk4", method)
    assert measured_order("rk4") == pytest.approx(order, abs=0.1)


def test_the_adaptive_method_has_its_order_where_each_step_is_one() -> None:
    errors = []
    for steps in (20, 40):
        world, bob = elastic_pendulum("dop853", 1, tolerance=1e-2)
        for _ in range(steps):
            world.step(1.0 / steps)
        assert world.force_evaluations == 13 * steps  # one for the start, twelve for the step
        place = world.component(bob, Transform).position
        errors.append(math.hypot(place.x + 0.6462298902398042, place.y + 1.284530828135613))
    assert math.log2(errors[0] / errors[1]) == pytest.approx(INTEGRATORS["dop853"].order, abs=0.1)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-9, 1e-12])
def test_the_adaptive_method_keeps_to_its_tolerance(tolerance: float) -> None:
    error = error_after_one_second(*elastic_pendulum("dop853", 1, tolerance=tolerance))
    assert error < 100 * tolerance


@pytest.mark.parametrize("name", FIXED)
def test_the_stability_limit_is_where_it_says(name: str) -> None:
    limit = INTEGRATORS[name].stability_limit / 2  # of h, for omega = 2
    tried = ((0.97 * limit, True), (1.03 * limit, False)) if limit < math.inf else ((1.0, True), (1e4, True))
    for h, bounded in tried:
        world, body = oscillator(name)
        world.simulation = dataclasses.replace(world.simulation, dt=h)
        try:
            for _ in range(400):
                world.step()
        except Diverged:
            assert not bounded
        else:
            assert (abs(world.component(body, Transform).position.x) < 50) == bounded


@pytest.mark.parametrize("name", [name for name, method in INTEGRATORS.items() if method.symplectic])
def test_energy_stays_near_where_it_was_with_symplectic_methods(name: str) -> None:
    world, _ = oscillator(name)
    drift = []
    for _ in world.stepping(steps=5000):
        drift.append(measure_energy(world).total / 2 - 1)
    assert np.abs(drift[-1000:]).max() < 1.01 * np.abs(drift[:1000]).max() + 1e-12 < 0.2


def area(name: str) -> float:
    """Return the determinant of a long step of the elastic pendulum, by differences: 1 keeps areas."""

    def end(shift: np.ndarray) -> np.ndarray:
        simulation = SimulationConfig(dt=0.2, substeps=1, integrator=name)
        world = World(GravitySystem(), SpringSystem(), IntegrateSystem(), simulation=simulation)
        x, y, vx, vy = np.array((1.2, 0.3, 0.5, -0.4)) + shift
        bob = world.spawn(Transform((x, y)), Velocity((vx, vy)), Mass(1), Spring(rest_length=1, stiffness=40))
        world.step()
        place, linear = world.component(bob, Transform).position, world.component(bob, Velocity).linear
        return np.array((*place, *linear))

    columns = [(end(1e-5 * unit) - end(-1e-5 * unit)) / 2e-5 for unit in np.eye(4)]
    return float(np.linalg.det(np.array(columns)))


@pytest.mark.parametrize("name", FIXED)
def test_symplectic_methods_keep_areas_and_the_others_do_not(name: str) -> None:
    kept = abs(area(name) - 1) < 1e-7
    assert kept == INTEGRATORS[name].symplectic


def test_leapfrog_runs_backwards_to_where_it_came_from() -> None:
    physics, simulation = (
        PhysicsConfig(gravity_mode="planet", softening=0.1),
        SimulationConfig(integrator="leapfrog"),
    )
    world = World(GravitySystem(), SpringSystem(), IntegrateSystem(), physics=physics, simulation=simulation)
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


@pytest.mark.parametrize("name", [name for name, method in INTEGRATORS.items() if method.substep])
def test_every_plan_stands_for_the_whole_substep(name: str) -> None:
    for stage in (Stage.KICK, Stage.DRIFT, Stage.SOLVE, Stage.FORCE):
        assert sum(share for named, share in INTEGRATORS[name].substep if named is stage) == 1.0


def test_forces_are_evaluated_as_often_as_is_said() -> None:
    for name in ("symplectic_euler", "leapfrog", "rk4"):
        world, _ = oscillator(name, 3)
        world.run(steps=5)
        assert world.force_evaluations == 5 * 3 * INTEGRATORS[name].evaluations
    world, _ = oscillator("blanes_moan", 3)
    world.run(steps=5)
    assert world.force_evaluations == 5 * 3 * 11 + 1  # the last of a step serves the next


@pytest.mark.parametrize("name", ["symplectic_euler", "leapfrog"])
def test_a_compiled_run_agrees_with_the_stages_step_by_step(name: str) -> None:
    class Onlooker(System):
        @at(Stage.KICK)
        def look(self, world: World, h: float) -> None:
            """Do nothing, within the step: the stages have to be gone through one by one."""

    ends = []
    for watched in (False, True):
        world, bob = elastic_pendulum(name, 8)
        if watched:
            world.install(Onlooker())
        world.run(seconds=5.0)
        assert world.plan.smooth != watched
        ends.append((*world.component(bob, Transform).position, *world.component(bob, Velocity).linear))
    assert ends[0] == pytest.approx(ends[1], abs=1e-12)


@pytest.mark.parametrize("name", FIXED)
def test_a_run_and_its_steps_one_by_one_agree(name: str) -> None:
    ends = []
    for at_once in (True, False):
        world, bob = elastic_pendulum(name, 64)
        if at_once:
            world.run(steps=20)
        else:
            for _ in range(20):
                world.step()
        assert (world.time, world.steps) == (10.0, 20)
        ends.append((*world.component(bob, Transform).position, *world.component(bob, Velocity).linear))
    assert ends[0] == pytest.approx(ends[1], abs=1e-11)


def test_a_bob_thrown_off_its_line_is_no_longer_solved_in_closed_form() -> None:
    world = World(SpringSystem(), IntegrateSystem())
    bob = world.spawn(Transform((1.5, 0)), Velocity(), Mass(1), Spring(rest_length=1, stiffness=0.5))
    world.step()
    assert world.plan.integrator.name == "exact"
    world.component(bob, Velocity).linear = Vector2(0, 1)
    world.step()
    assert world.plan.integrator.name == "dop853"


def test_planets_that_meet_in_a_point_stop_the_run_and_say_why() -> None:
    physics = PhysicsConfig(gravity_mode="planet")
    world = World(GravitySystem(), IntegrateSystem(), physics=physics)
    for x in (-1, 1):
        world.spawn(Transform((x, 0)), Velocity(), Mass(1))
    with pytest.raises(ArithmeticError, match="softening > 0"):
        world.run(seconds=10)
