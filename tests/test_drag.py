"""DragSystem: the closed forms, and that what it takes is gone."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from physicslab.components import Drag, Mass, Shape, Transform, Velocity
from physicslab.diagnostics.energy import measure_energy
from physicslab.diagnostics.warnings import find_warnings
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.systems.drag import DragSystem
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.standard import standard_systems
from physicslab.world import World


def thrown(
    drag: Drag, mass: float, velocity: tuple[float, float], integrator: str = "auto"
) -> tuple[World, int]:
    simulation = SimulationConfig(integrator=integrator)
    world = World(GravitySystem(), DragSystem(), IntegrateSystem(), simulation=simulation)
    return world, world.spawn(Transform(), Velocity(velocity), Mass(mass), drag)


def test_a_rate_beyond_all_numbers_is_without_limit() -> None:
    world, ball = thrown(Drag(linear=1e300), 1e-10, (10, 15))
    held = world.spawn(Transform(), Velocity(), Drag(quadratic=1e300))  # without a mass nothing slows it
    world.component(ball, Mass)  # what is read has a row
    rates = DragSystem().rates(world)
    assert [rates[world.entity_index.row_of[entity]] for entity in (ball, held)] == [math.inf, 0.0]


def test_linear_drag_against_the_closed_form() -> None:
    world, ball = thrown(Drag(linear=0.5), 2.0, (10, 15))
    world.run(seconds=3.0)
    assert world.plan.integrator.name == "exact"
    place, velocity = world.component(ball, Transform).position, world.component(ball, Velocity).linear
    assert tuple(place) == pytest.approx((21.10533789035941171448, -3.244647282690550860671), rel=1e-13)
    assert tuple(velocity) == pytest.approx((4.723665527410147071380, -13.61883817932736228483), rel=1e-13)


def test_quadratic_drag_against_the_closed_form() -> None:
    world, ball = thrown(Drag(quadratic=0.1), 1.0, (0, 0))
    world.run(seconds=2.0)
    assert world.plan.integrator.name == "dop853"
    assert world.component(ball, Transform).position.y == pytest.approx(-13.06611417826422700240, rel=1e-13)
    assert world.component(ball, Velocity).linear.y == pytest.approx(-9.534645904705057135767, rel=1e-13)


def test_drag_of_zero_costs_no_order_and_an_edit_brings_that_back() -> None:
    world, ball = thrown(Drag(), 1.0, (10, 15), "leapfrog")
    world.component(ball, Drag).linear = world.component(ball, Drag).quadratic = 0.0
    assert find_warnings(world) == ()
    world.step()
    world.component(ball, Drag).linear = 0.5
    world.step()
    assert [warning.what for warning in find_warnings(world)] == [
        "Drag: leapfrog has order 1 where a force depends on velocities"
    ]


@pytest.mark.parametrize("name", ["leapfrog", "rk4", "implicit_midpoint", "dop853"])
def test_every_method_comes_to_the_terminal_speed(name: str) -> None:
    world, ball = thrown(Drag(linear=1.0, quadratic=0.2), 1.0, (3, 0), name)
    world.run(seconds=40.0)
    speed = (math.sqrt(1.0 + 4 * 0.2 * 9.81) - 1.0) / (2 * 0.2)  # c v + k v^2 = m g
    assert world.component(ball, Velocity).linear.y == pytest.approx(-speed, rel=1e-9)


@given(st.floats(0, 10), st.floats(0, 10), st.floats(0.1, 10), st.floats(-30, 30), st.floats(-30, 30))
def test_it_never_gives_energy(c: float, k: float, mass: float, vx: float, vy: float) -> None:
    world, _ = thrown(Drag(linear=c, quadratic=k), mass, (vx, vy))
    before = measure_energy(world).total
    world.run(seconds=0.5)
    assert measure_energy(world).total <= before + 1e-9 * (1 + abs(before))


@pytest.mark.parametrize(
    ("contacts", "method", "error"), [("soft", "leapfrog", 1e-2), ("auto", "dop853", 1e-12)]
)
def test_it_acts_in_scenes_that_touch_too(contacts: str, method: str, error: float) -> None:
    simulation = SimulationConfig(contacts=contacts)
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="none"), simulation=simulation)
    ball = world.spawn(Transform(), Velocity((1, 0)), Mass(1), Shape.circle(0.1), Drag(linear=1.0))
    world.spawn(Transform((9, 9)), Shape.circle(0.1))
    world.run(seconds=1.0)
    assert world.plan.integrator.name == method
    assert world.component(ball, Velocity).linear.x == pytest.approx(math.exp(-1), rel=error)


@pytest.mark.parametrize("field", ["linear", "quadratic"])
def test_what_would_push_is_refused(field: str) -> None:
    with pytest.raises(InvalidValue, match=rf"Drag\.{field} = -1"):
        Drag(**{field: -1.0})
