"""Pins beside rigid contacts: impacts go through them at once, forces to rounding."""

import math
from dataclasses import replace

import numpy as np
import pytest

from physicslab import World
from physicslab.components import Mass, Material, Pin, Shape, Transform, Velocity
from physicslab.diagnostics.energy import measure_energy
from physicslab.ecs.vector import Vector2
from physicslab.kernels.accounts import ANGULAR_MOMENTUM, ENERGY, IMPACTS, JOINTS, PX
from physicslab.stepping.accounting import balance_of
from physicslab.stepping.rigid import Rigid


def weightless() -> World:
    world = World()
    world.physics = replace(world.physics, gravity_mode="none")
    return world


def is_rigid(world: World) -> bool:
    """Whether the last step was one of rigid contacts, made from event to event."""
    rigid = world.stepper
    return isinstance(rigid, Rigid) and not rigid.by_impulses and not rigid.left_to_soft


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
def test_a_bar_on_a_pin_leaves_a_stop_with_e_times_its_spin(restitution: float) -> None:
    world = weightless()
    material = {"restitution": restitution, "friction": 0.0}
    bar = world.spawn(
        Transform((0.5, 0)), Velocity((0, 1.0), 2.0), Mass(1.0), Shape.box(1.0, 0.1), Material(**material)
    )
    world.spawn(Pin(b=bar, anchor_b=(-0.5, 0)))
    world.spawn(Transform((0.5, 1.0)), Shape.circle(0.3), Material(**material))
    world.run(seconds=0.6)
    assert is_rigid(world)
    assert world.component(bar, Velocity).angular == pytest.approx(-2.0 * restitution, abs=1e-12)
    inertia = (1.0 + 0.01) / 12 + 0.25
    lost = 0.5 * inertia * 4.0 * (1.0 - restitution**2)
    assert world.account.sums[IMPACTS, ENERGY] == pytest.approx(-lost, abs=1e-12)
    assert world.account.sums[JOINTS, ENERGY] == 0.0
    assert world.account.sums[JOINTS, ANGULAR_MOMENTUM] == pytest.approx(0.0, abs=1e-14), (
        "the pin is at the origin"
    )


def test_what_hits_one_of_two_bars_moves_both_and_loses_nothing() -> None:
    world, bodies = weightless(), []
    for x, mass in ((0.5, 1.0), (1.5, 2.0)):
        at = Transform((x, 0.0)), Velocity(), Mass(mass), Shape.box(1.0, 0.1)
        bodies.append(world.spawn(*at, Material(restitution=1.0, friction=0.3)))
    ball = Transform((0.3, 0.5)), Velocity((0, -3.0)), Mass(0.7), Shape.circle(0.2)
    world.spawn(*ball, Material(restitution=1.0, friction=0.3))
    world.spawn(Pin(a=bodies[0], b=bodies[1], anchor_a=(0.5, 0), anchor_b=(-0.5, 0)))
    world.synchronise()
    before = np.array(balance_of(world, world.schedule.forces))
    world.step(0.15)
    assert is_rigid(world)
    assert world.collisions == 1
    after = np.array(balance_of(world, world.schedule.forces))
    assert after == pytest.approx(before, abs=1e-12)
    assert abs(world.component(bodies[1], Velocity).angular) > 0.01, "the impulse went through the pin"


def test_a_wagon_rolls_down_as_its_wheels_demand() -> None:
    world, slope = World(), 0.2
    world.physics = replace(world.physics, gravity=Vector2(9.81 * math.sin(slope), -9.81 * math.cos(slope)))
    rough = {"restitution": 0.0, "friction": 1.0}
    world.spawn(Transform((0, -0.5)), Shape.box(40, 1.0), Material(**rough))
    wagon = world.spawn(Transform((0, 0.5)), Velocity(), Mass(2.0), Shape.box(2.0, 0.3), Material(**rough))
    for x in (-0.8, 0.8):
        at = Transform((x, 0.3)), Velocity(), Mass(0.5), Shape.circle(0.3)
        wheel = world.spawn(*at, Material(**rough))
        world.spawn(Pin(a=wagon, b=wheel, anchor_a=(x, -0.2)))
    world.step()
    before = measure_energy(world).total
    world.run(seconds=1.0)
    assert is_rigid(world)
    expected = 9.81 * math.sin(slope) * 3.0 / (3.0 + 2 * 0.5 * 0.5) * world.time
    assert world.component(wagon, Velocity).linear.x == pytest.approx(expected, rel=1e-12)
    assert measure_energy(world).total == pytest.approx(before, abs=1e-11)
    # The wheels carry the wagon, and each is rolled by what its pin adds to its weight.
    assert world.joints.force[1::2].sum() == pytest.approx(-2.0 * 9.81 * math.cos(slope), rel=1e-11)
    turns = 0.25 * 9.81 * math.sin(slope) * 3.0 / 3.5 - 0.5 * 9.81 * math.sin(slope)
    pulls = turns + 0.5 * 9.81 * math.sin(slope) * 3.0 / 3.5
    assert world.joints.force[0::2] == pytest.approx([pulls, pulls], rel=1e-10)


def test_a_body_that_joints_hold_in_full_gets_no_force_from_the_floor() -> None:
    world = World()
    world.spawn(Transform((0, -0.5)), Shape.box(20, 1))
    crate = world.spawn(Transform((0, 0.5)), Velocity(), Mass(1.0), Shape.box(1, 1))
    for x in (-0.5, 0.5):
        world.spawn(Pin(b=crate, anchor_a=(x, 1.0), anchor_b=(x, 0.5)))
    world.run(seconds=0.2)
    assert is_rigid(world)
    assert tuple(world.component(crate, Transform).position) == pytest.approx((0.0, 0.5), abs=1e-13)
    assert world.joints.force[1::2].sum() == pytest.approx(9.81, rel=1e-12)


def test_momentum_that_a_pin_takes_in_an_impact_is_booked() -> None:
    world = weightless()
    bar = world.spawn(
        Transform((0.5, 0)), Velocity(), Mass(1.0), Shape.box(1.0, 0.1), Material(restitution=1)
    )
    ball = Transform((0.9, 0.4)), Velocity((0.5, -2.0)), Mass(0.3), Shape.circle(0.1)
    world.spawn(*ball, Material(restitution=1.0, friction=0.5))
    world.spawn(Pin(b=bar, anchor_b=(-0.5, 0)))
    world.synchronise()
    before = np.array(balance_of(world, world.schedule.forces))
    world.step(0.3)
    change = np.array(balance_of(world, world.schedule.forces)) - before
    assert world.collisions == 1
    assert abs(change[PX]) > 0.01
    assert world.account.sums[:, :].sum(axis=0) == pytest.approx(change, abs=1e-12)
