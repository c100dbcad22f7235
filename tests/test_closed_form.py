"""Closed forms: against references of twenty digits, and refused where there is none."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from physicslab.components import Held, Mass, Spring, Transform, Velocity
from physicslab.diagnostics.energy import measure_account
from physicslab.ecs.config import PhysicsConfig
from physicslab.ecs.vector import Vector2
from physicslab.ode.closed_form import NoClosedForm, closed_form
from physicslab.systems.standard import standard_systems
from physicslab.world import World


def hung(
    spring: Spring, x: object = (1, 0), v: object = (0, 0), mass: float = 1.0, **physics: object
) -> World:
    """Return a world of one body on a spring, without gravity unless it is given."""
    settings = {"gravity_mode": "none"} | physics
    world = World(*standard_systems(), physics=PhysicsConfig(**settings))  # type: ignore[arg-type]
    world.spawn(Transform(x), Velocity(v), Mass(mass), spring)  # type: ignore[arg-type]
    world.synchronise()
    return world


def state(world: World) -> tuple[float, float, float, float]:
    (entity,) = world.entities()[:1]
    return (*world.component(entity, Transform).position, *world.component(entity, Velocity).linear)


def test_free_fall_is_right_to_a_few_units_in_the_last_place() -> None:
    world = World(*standard_systems())
    world.spawn(Transform((0, 20)), Velocity((5, 0)), Mass(1))
    world.run(seconds=2.0)
    assert state(world) == pytest.approx((10.0, 0.38, 5.0, -19.62), rel=4 * 2.3e-16, abs=4 * 3.6e-15)


def test_an_oscillation_keeps_its_phase_for_a_hundred_periods() -> None:
    world = hung(Spring(rest_length=0, stiffness=39.47841760435743447534))
    world.run(seconds=100.25)
    assert state(world) == pytest.approx((0.0, 0.0, -6.283185307179586476925, 0.0), abs=1e-12)


@pytest.mark.parametrize(
    ("damping", "x", "v"),
    [
        (2.0, 0.4170406392928207180688, -3.144920733212997465045),
        (20.0, 0.007295055724436129664025, -0.06383173758881613456022),
        (100.0, 0.4981340670680452861281, -0.5032175971213715932877),
    ],
)
def test_dampers_below_at_and_above_the_critical(damping: float, x: float, v: float) -> None:
    world = hung(Spring(rest_length=0, stiffness=100, damping=damping))
    world.run(seconds=0.7)
    assert state(world) == pytest.approx((x, 0.0, v, 0.0), rel=1e-13, abs=1e-15)


@given(
    st.floats(0.1, 1e6), st.floats(0, 1e4), st.floats(1e-3, 3.0), st.floats(-1, 1), st.floats(-1, 1),
    st.floats(0, 6.3),
)  # fmt: skip
def test_two_half_ways_are_one_whole(
    k: float, c: float, t: float, place: float, speed: float, turn: float
) -> None:
    """In line, along any direction: the flow of t + t is that of 2 t."""
    line = np.array((math.cos(turn), math.sin(turn)))
    ends = []
    for parts in (1, 2):
        spring = Spring(rest_length=50, stiffness=k, damping=c)
        world = hung(spring, (50 + place) * line, speed * line)
        if world.plan.integrator.name != "exact":
            return  # thrown so hard that it may swing through the middle
        for _ in range(parts):
            world.run(seconds=2 * t / parts)
        ends.append(state(world))
    assert ends[0] == pytest.approx(ends[1], rel=1e-9, abs=1e-9 * (1 + math.sqrt(k)))


@pytest.mark.parametrize("z", [0.1, 1.0, 10.0, 100.0])
def test_stiff_springs_sag_to_their_rest_under_gravity(z: float) -> None:
    k = (z / 0.01) ** 2
    spring = Spring(rest_length=0, stiffness=k, damping=2 * 0.05 * math.sqrt(k))
    world = hung(spring, (0, 0), (0, 0), gravity_mode="linear")
    world.run(seconds=1000.0 if z < 1 else 100.0)
    assert world.plan.integrator.name == "exact"
    assert state(world)[1] == pytest.approx(-9.81 / k, rel=1e-9)


@pytest.mark.parametrize(
    ("spring", "x", "v", "why"),
    [
        (Spring(rest_length=1), (2, 0), (0, 1), "does not stay on the line"),
        (Spring(rest_length=1), (2, 0), (30, 0), "may swing through the fixed end"),
        (Spring(rest_length=0, anchor_a=(0.1, 0)), (2, 0), (0, 0), "holds its body beside the middle"),
        (Spring(rest_length=0, damping=1), (2, 0), (0, 1), "does not stay on the line"),
    ],
)
def test_where_there_is_none_it_says_why(spring: Spring, x: object, v: object, why: str) -> None:
    with pytest.raises(NoClosedForm, match=why):
        closed_form(world := hung(spring, x, v), world.schedule.forces)


def test_several_springs_of_no_length_pull_to_their_middle() -> None:
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="none"))
    body = world.spawn(Transform((5, 5)), Velocity(), Mass(2))
    for x, k in ((0, 1), (3, 2)):
        world.spawn(Spring(body, anchor_b=(x, 0), rest_length=0, stiffness=k))
    world.run(seconds=math.pi / math.sqrt(3 / 2))  # half a period leads to the other side
    assert tuple(world.component(body, Transform).position) == pytest.approx((-1.0, -5.0), abs=1e-12)


def test_what_is_held_moves_as_it_is_led_and_what_turns_keeps_turning() -> None:
    world = World(*standard_systems())
    held = world.spawn(Transform(), Velocity((2, 0), 3.0), Mass(1), Held())
    spun = world.spawn(Transform(), Velocity((0, 0), -2.0), Mass(1))
    world.run(seconds=2.0)
    assert world.component(held, Transform).position == Vector2(4, 0)
    assert world.component(held, Transform).angle == pytest.approx(6.0)
    assert world.component(spun, Transform).angle == pytest.approx(-4.0)


def test_what_moves_at_a_given_speed_works_against_its_spring() -> None:
    """Nothing else acts: it was taken for an error of the closed form."""
    world = World(*standard_systems())
    moves = world.spawn(Transform((0, 0)), Velocity((0.0, -2.0)))
    world.spawn(Spring(a=moves, anchor_b=(0.0, 3.0), rest_length=1.0, stiffness=10.0))
    world.run(seconds=0.5)
    account = measure_account(world).energy
    assert account["hand"] == pytest.approx(5.0 * (3.0**2 - 2.0**2), rel=1e-12)
    assert account["numerical"] == pytest.approx(0.0, abs=1e-12)


def test_a_run_follows_the_power_of_what_passes_the_end_of_its_spring() -> None:
    """It moves at a given speed, so no error of its motion shows it: steps of a whole run passed over it."""
    speed, past, way, damping = 5.0, 0.3, 2.0, 2.0
    world = World(*standard_systems())
    moves = world.spawn(Transform((-way, past)), Velocity((speed, 0.0)))
    world.spawn(Spring(a=moves, anchor_b=(0.0, 0.0), rest_length=1.0, stiffness=30.0, damping=damping))
    world.run(seconds=2.0 * way / speed)
    account = measure_account(world).energy
    taken = damping * speed * 2.0 * (way - past * math.atan(way / past))
    assert account["damping"] == pytest.approx(-taken, rel=1e-11)
    assert account["hand"] == pytest.approx(taken, rel=1e-11)


def test_what_turns_about_a_fixed_sun_gets_its_momentum_from_gravity() -> None:
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="planet", G=1.0))
    world.spawn(Transform((0.5, 0.0)), Mass(40.0))
    planet = world.spawn(Transform((2.0, 0.0)), Velocity((0.0, 3.0)), Mass(0.7))
    world.run(seconds=1.3)
    assert world.plan.integrator.name == "exact"
    account, (vx, vy) = measure_account(world), world.component(planet, Velocity).linear
    assert tuple(account.momentum["gravity"]) == pytest.approx((0.7 * vx, 0.7 * (vy - 3.0)), rel=1e-9)
    assert abs(account.momentum["numerical"].x) < 1e-12
    assert abs(account.angular_momentum["numerical"]) < 1e-12
