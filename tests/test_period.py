"""Periods of oscillations, against closed forms and against runs."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from desk import empty_world

from physicslab.components import Charge, Drag, Mass, Pin, Rod, Spring, Transform, Velocity
from physicslab.diagnostics.period import gives_way, period_of, spring_state
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import box, circle, pendulum
from physicslab.world import World


def run_period(world: World, body: int) -> float:
    """Return the time [s] between two passages of x = 0 in the same direction."""
    crossings: list[float] = []
    before = 0.0
    for _ in range(20_000):
        world.step(0.002)
        now = world.component(body, Transform).position.x
        if before < 0.0 <= now:
            crossings.append(world.time - 0.002 * now / (now - before))
        before = now
        if len(crossings) == 3:
            return crossings[2] - crossings[1]
    raise AssertionError("it does not swing")


@pytest.mark.parametrize("angle", [0.2, 1.2, 2.4])
def test_the_period_of_a_pendulum_is_that_of_its_amplitude(angle: float) -> None:
    world = empty_world()
    bob = pendulum(world, (0, 0), length=2.0, angle=angle, stiffness=2e5)
    found = period_of(world, bob)
    assert found is not None
    assert found.seconds == pytest.approx(run_period(world, bob), rel=2e-3)
    later = period_of(world, bob)
    assert later is not None and later.seconds == pytest.approx(found.seconds, rel=2e-3), "wherever it is"


def a_rod(world: World, angle: float) -> int:
    return pendulum(world, (0, 0), length=1.5, angle=angle, mass=1.41)


def a_soft_one(world: World, angle: float) -> int:
    return pendulum(world, (0, 0), length=1.5, angle=angle, stiffness=5000.0, mass=1.41)


@pytest.mark.parametrize(("make", "agrees", "rigid"), [(a_rod, 1e-10, 1e-5), (a_soft_one, 1e-4, 5e-3)])
def test_the_period_is_that_of_the_rod_or_of_the_spring(
    make: Callable[[World, float], int], agrees: float, rigid: float
) -> None:
    world = empty_world()
    bob = make(world, math.pi / 3)
    found = period_of(world, bob)
    assert found is not None
    passed = list[float]()
    before = world.component(bob, Transform).position.x
    while len(passed) < 3:
        world.step(0.01)
        x, v = world.component(bob, Transform).position.x, world.component(bob, Velocity).linear.x
        if before < 0.0 <= x:
            # Near the lowest point x changes like sin: one step of a fourth order in time is enough.
            passed.append(world.time - x / v * (1.0 + (x / 1.5) ** 2 / 6.0))
        before = x
    measured = (passed[2] - passed[0]) / 2
    assert found.seconds == pytest.approx(measured, rel=max(agrees, 2e-6))
    assert found.seconds == pytest.approx(2.63672, rel=rigid), "of a rigid rod, by the elliptic integral"
    later = period_of(world, bob)
    assert later is not None and later.seconds == pytest.approx(found.seconds, rel=agrees)


def test_the_period_of_a_bar_on_a_pin_and_what_has_none() -> None:
    world = empty_world()
    bar = box(world, (0.0, 0.0), width=0.1, height=2.0, mass=3.0, angle=1e-4)
    pin = world.spawn(Pin(b=bar, anchor_b=(0.0, 0.9), anchor_a=(0.0, 0.9)))
    world.synchronise()
    inertia = world.component(bar, Mass).inertia + 3.0 * 0.9**2
    found = period_of(world, bar)
    assert found is not None and period_of(world, pin) == found
    assert found.seconds == pytest.approx(2 * math.pi * math.sqrt(inertia / (3.0 * 9.81 * 0.9)), rel=1e-6)
    world.component(bar, Velocity).angular = 20.0
    world.component(bar, Velocity).linear = Vector2(18.0, 0.0)
    assert period_of(world, bar) is None, "it turns over"
    world.component(bar, Velocity).angular, world.component(bar, Velocity).linear = 0.0, Vector2()
    world.component(pin, Pin).upper = 1.0
    world.synchronise()
    assert period_of(world, bar) is None, "it has a limit"
    other = circle(world, (5.0, 0.0))
    world.spawn(Rod(a=bar, b=other))
    assert period_of(world, other) is None, "two bodies move"


def test_the_weight_of_a_body_lengthens_a_spring() -> None:
    world = empty_world()
    body = circle(world, (0, 0), mass=2.0)
    assert gives_way(world, world.spawn(Spring(a=body, rest_length=2.0, stiffness=50.0))) == pytest.approx(
        2.0 * 9.81 / 50.0
    )
    assert gives_way(world, body) is None
    assert gives_way(empty_world(gravity_mode="none"), 1) is None


def test_the_period_of_a_body_on_a_spring() -> None:
    world = empty_world(gravity_mode="none")
    body = circle(world, (0.3, 0), mass=2.0)
    spring = world.spawn(Spring(a=body, anchor_b=(-1.0, 0.0), rest_length=1.0, stiffness=50.0))
    found = period_of(world, body)
    assert found is not None and found.seconds == pytest.approx(2 * math.pi * math.sqrt(2.0 / 50.0))
    assert found.seconds == pytest.approx(run_period(world, body), rel=1e-3)
    assert period_of(world, spring) == found


def test_two_bodies_on_a_spring_have_their_reduced_mass_and_a_damper_slows_them() -> None:
    world = empty_world(gravity_mode="none")
    one, two = circle(world, (0, 0), mass=1.0), circle(world, (2, 0), mass=3.0)
    spring = world.spawn(Spring(a=one, b=two, rest_length=2.0, stiffness=30.0))
    found = period_of(world, spring)
    assert found is not None and found.seconds == pytest.approx(2 * math.pi * math.sqrt(0.75 / 30.0))
    world.component(spring, Spring).damping = 6.0
    slower = period_of(world, two)
    rate = math.sqrt(30.0 / 0.75 - (6.0 / 1.5) ** 2)
    assert slower is not None and slower.seconds == pytest.approx(2 * math.pi / rate)
    world.component(spring, Spring).damping = 100.0
    assert period_of(world, two) is None


@pytest.mark.parametrize(
    ("drag", "damping", "beside"), [(0.0, 0.0, 0.0), (0.0, 0.0, 0.4), (2.0, 0.0, 0.0), (0.0, 2.0, 0.0)]
)
def test_what_turns_on_its_spring_is_faster_and_what_is_dragged_slower(
    drag: float, damping: float, beside: float
) -> None:
    """The spring was taken to hold the middle, with no drag: 40 % too long, and 3 % too short."""
    world = empty_world(gravity_mode="none", linear_damping=damping)
    crate = box(world, (0.0, 0.0), width=1.0, height=1.0, mass=1.0)
    world.add(crate, Drag(linear=drag))
    world.add(crate, Spring(anchor_a=(0.0, beside), anchor_b=(3.0, beside), rest_length=3.0, stiffness=20.0))
    world.component(crate, Transform).position = Vector2(-0.001, 0.0)
    found = period_of(world, crate)
    assert found is not None
    rate = 20.0 * (1.0 + beside**2 * 6.0) - (0.5 * (drag + damping)) ** 2
    assert found.seconds == pytest.approx(2.0 * math.pi / math.sqrt(rate), rel=1e-9)
    assert found.seconds == pytest.approx(run_period(world, crate), rel=1e-3)


@pytest.mark.parametrize(("drag", "damper", "true"), [(2.0, 0.0, 5.634423638), (0.5, 0.6, 5.296307347)])
def test_drag_on_one_of_two_bodies_slows_them_by_what_it_takes(
    drag: float, damper: float, true: float
) -> None:
    """Both were taken to be dragged as much: 12 % too long. Roots of s²(s + d) + (1 + c s)(2 s + d)."""
    world = empty_world(gravity_mode="none")
    one, two = circle(world, (0.0, 0.0), mass=1.0), circle(world, (3.1, 0.0), mass=1.0)
    world.add(one, Drag(linear=drag))
    world.add(one, Spring(b=two, rest_length=3.0, stiffness=1.0, damping=damper))
    found = period_of(world, two)
    assert found is not None and found.seconds == pytest.approx(true, rel=1e-8)


def test_damping_of_motion_and_of_turning_slow_each_its_own() -> None:
    """Of s²(s + 3) + k (s + g (s + 3)), g the share of turning."""
    world = empty_world(gravity_mode="none", linear_damping=3.0)
    crate = box(world, (-0.001, 0.0), width=1.0, height=1.0, mass=1.0)
    world.add(crate, Spring(anchor_a=(0.0, 0.4), anchor_b=(3.0, 0.4), rest_length=3.0, stiffness=20.0))
    found = period_of(world, crate)
    assert found is not None and found.seconds == pytest.approx(1.040940008, rel=1e-8)


def test_a_rate_beyond_all_numbers_is_no_period() -> None:
    world = empty_world(gravity_mode="none")
    ball = circle(world, (0.0, 0.0), mass=1e-200)
    world.add(ball, Spring(anchor_b=(3.0, 0.0), rest_length=3.0, stiffness=1e200))
    assert period_of(world, ball) is None


def test_a_charge_in_a_magnetic_field_has_no_period_of_its_spring() -> None:
    world = empty_world(gravity_mode="none", magnetic_field=5.0)
    ball = circle(world, (0.0, 0.0), radius=0.1)
    world.add(ball, Spring(anchor_b=(3.0, 0.0), rest_length=2.9, stiffness=20.0))
    assert period_of(world, ball) is not None
    world.add(ball, Charge(1.0))
    assert period_of(world, ball) is None


def test_a_charged_pendulum_in_a_field_has_no_period_of_its_weight_alone() -> None:
    world = empty_world(electric_field=Vector2(0.0, -9.81))  # it swings faster by the root of two
    bob = pendulum(world, (0.0, 0.0), length=1.0, angle=0.2)
    assert period_of(world, bob) is not None
    world.add(bob, Charge(1.0))
    assert period_of(world, bob) is None


def test_what_is_not_periodic_has_no_period() -> None:
    world = empty_world()
    free = circle(world, (5, 5))
    assert period_of(world, free) is None
    bob = pendulum(world, (0, 0), length=2.0, stiffness=1e5)
    world.component(bob, Velocity).linear = Vector2(30.0, 0.0)
    assert period_of(world, bob) is None, "it turns over"
    world.component(bob, Velocity).linear = Vector2()
    assert period_of(world, bob) is not None
    world.spawn(Spring(a=bob, b=free))
    assert period_of(world, bob) is None, "two springs"


def test_a_spring_is_read_off() -> None:
    world = empty_world(gravity_mode="none")
    body = world.spawn(Transform((0, 0)), Velocity((2.0, 0.0)), Mass(1.0))
    spring = world.spawn(Spring(a=body, anchor_b=(3.0, 4.0), rest_length=4.0, stiffness=10.0, damping=5.0))
    found = spring_state(world, spring)
    assert found is not None
    assert (found.length, found.extension, found.energy) == pytest.approx((5.0, 1.0, 5.0))
    assert found.force == pytest.approx(10.0 - 5.0 * 2.0 * 0.6)
    assert spring_state(world, body) is None
