"""Ropes, limits and motors with a largest force: events at their closed-form times, and what they take."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from physicslab import World
from physicslab.components import Mass, Material, Pin, Pulley, Rope, Shape, Slot, Transform, Velocity
from physicslab.diagnostics.energy import measure_account, measure_energy
from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.files.scene import load_scene, save_scene
from physicslab.kernels.accounts import CONTACT, ENERGY, HAND, JOINTS, MOTORS, PX
from physicslab.kernels.rigid.touching import TOUCH
from physicslab.stepping import rigid_motion
from physicslab.stepping.accounting import balance_of
from physicslab.stepping.plan import WITHOUT_END
from physicslab.stepping.rigid import Rigid

G = 9.81
_MOTION = ((Transform, "position"), (Transform, "angle"), (Velocity, "linear"), (Velocity, "angular"))


def empty(gravity: float = G) -> World:
    world = World()
    world.physics = replace(world.physics, gravity=Vector2(0.0, -gravity))
    return world


def went_by_events(world: World) -> bool:
    """Whether every step was one of rigid contacts, made from event to event."""
    rigid = world.stepper
    return isinstance(rigid, Rigid) and not rigid.by_impulses and not rigid.left_to_soft


def turn(world: World, body: int, spin: float, arm: float = 0.0) -> None:
    """Let a body turn about a point that is so far behind its centre."""
    angle = world.component(body, Transform).angle
    world.component(body, Velocity).angular = spin
    world.component(body, Velocity).linear = Vector2(-math.sin(angle), math.cos(angle)) * (spin * arm)


def run(world: World, seconds: float, put: float = 0.0) -> None:
    """Run, and demand that energy and momentum change by what accounts say, to rounding.

    Two corners meet in one moment if their gaps differ by less than ``put`` [m], and bodies are moved by that
    little. No cause does so: it is an error of the method, of at most their weight times that way.
    """
    world.synchronise()
    booked = world.account.sums.sum(axis=0) - np.array(balance_of(world, world.schedule.forces))
    world.run(seconds=seconds)
    after = world.account.sums.sum(axis=0) - np.array(balance_of(world, world.schedule.forces))
    weight = G * float(world.table(Mass)["mass"].sum())
    assert after == pytest.approx(booked, abs=3e-11 + put * weight)


# ---- ropes -------------------------------------------------------------------------------------------------


def slack_pendulum() -> tuple[World, int]:
    """Return a point on a rope of 1 m, let go .6 m beside where that is fastened."""
    world = empty()
    bob = world.spawn(Transform((0.6, 0.0)), Velocity(), Mass(2.0))
    world.spawn(Rope(b=bob, length=1.0))
    return world, bob


def test_a_rope_goes_taut_at_its_time_and_takes_what_moves_along_it() -> None:
    world, bob = slack_pendulum()
    taut = math.sqrt(1.6 / G)
    run(world, taut - 1e-9)
    assert world.account.sums[JOINTS, ENERGY] == 0.0
    assert world.component(bob, Velocity).linear.y == pytest.approx(-G * taut, rel=1e-8)
    run(world, 2e-9)
    speed = 0.8 * G * taut
    assert world.account.sums[JOINTS, ENERGY] == pytest.approx(-(speed**2), abs=1e-11)
    assert went_by_events(world)
    velocity = world.component(bob, Velocity).linear
    assert 0.6 * velocity.x - 0.8 * velocity.y == pytest.approx(0.0, abs=1e-8)
    energy = measure_energy(world).total
    run(world, 1.0)
    assert math.hypot(*world.component(bob, Transform).position) <= 1.0 + 1e-13
    assert measure_energy(world).total == pytest.approx(energy, abs=1e-12)


def test_a_rope_that_swings_too_slowly_over_the_top_goes_slack_when_nothing_pulls() -> None:
    world = empty()
    # 3 g sin = v^2 - 2 g, from below: slack at an angle above the horizontal whose sine is 1/3.
    bob = world.spawn(Transform((0.0, -1.0)), Velocity((math.sqrt(3.0 * G), 0.0)), Mass(0.5))
    world.spawn(Rope(b=bob, length=1.0))
    run(world, 0.6)
    position, velocity = world.component(bob, Transform).position, world.component(bob, Velocity).linear
    assert went_by_events(world)
    assert world.joints.force[0] == 0.0
    # It flies from there on: along a parabola with the speed of that point.
    sine, speed = 1.0 / 3.0, math.sqrt(G / 3.0)
    cosine = math.sqrt(1.0 - sine**2)
    flown = (velocity.y - speed * cosine) / -G
    assert velocity.x == pytest.approx(-speed * sine, abs=1e-10)
    assert position.x == pytest.approx(cosine - speed * sine * flown, abs=1e-10)
    assert position.y == pytest.approx(sine + speed * cosine * flown - 0.5 * G * flown**2, abs=1e-10)


def test_what_hangs_at_rest_stays_there_and_costs_a_piece_a_step() -> None:
    world = empty()
    block = world.spawn(Transform((0.3, -2.5)), Velocity(), Mass(3.0), Shape.box(1.0, 1.0))
    world.spawn(Rope(b=block, anchor_a=(0.3, 0.0), anchor_b=(0.0, 0.5), length=2.0))
    run(world, 1.0)
    assert went_by_events(world)
    assert tuple(world.component(block, Transform).position) == (0.3, -2.5)
    assert world.joints.force[0] == pytest.approx(3.0 * G, rel=1e-13)
    assert world.force_evaluations <= 60


def test_what_hits_a_block_on_a_rope_pulls_at_the_rope_in_the_same_moment() -> None:
    world = empty(0.0)
    hard = Material(restitution=1.0, friction=0.0)
    block = world.spawn(Transform((0.0, -1.0)), Velocity(), Mass(1.0), Shape.box(0.4, 0.4), hard)
    world.spawn(Rope(b=block, length=1.0))
    ball = world.spawn(
        Transform((0.0, -0.5)), Velocity((0.0, -2.0)), Mass(3.0), Shape.circle(0.1), Material(restitution=1)
    )
    run(world, 0.3)
    # The rope holds the block: the ball meets a wall.
    assert went_by_events(world)
    assert world.collisions == 1
    assert world.component(ball, Velocity).linear.y == pytest.approx(2.0, abs=1e-12)
    assert tuple(world.component(block, Velocity).linear) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert world.account.sums[JOINTS, PX + 1] == pytest.approx(12.0, abs=1e-12)


def test_two_bodies_that_part_on_a_rope_go_on_together() -> None:
    world = empty(0.0)
    one = world.spawn(Transform((-0.25, 0.0)), Velocity((-1.0, 0.5)), Mass(1.0))
    other = world.spawn(Transform((0.25, 0.0)), Velocity((3.0, 0.5)), Mass(3.0))
    world.spawn(Rope(a=one, b=other, length=1.0))
    run(world, 1.0)
    # Along the rope both have 2 m/s from .125 s on; across it nothing changes.
    assert went_by_events(world)
    for body in (one, other):
        assert tuple(world.component(body, Velocity).linear) == pytest.approx((2.0, 0.5), abs=1e-12)
    assert world.account.sums[JOINTS, ENERGY] == pytest.approx(-0.5 * 0.75 * 16.0, abs=1e-12)


def test_what_a_moving_hook_begins_to_pull_is_paid_for_by_what_moves_the_hook() -> None:
    world, rough = empty(), {"friction": 0.4, "restitution": 0.0}
    world.spawn(Transform((0.0, -0.5)), Shape.box(20.0, 1.0), Material(**rough))
    at = Transform((0.0, 0.25)), Velocity(), Mass(2.0)
    crate = world.spawn(*at, Shape.box(0.5, 0.5), Material(**rough))
    hook = world.spawn(Transform((1.0, 0.25)), Velocity((1.0, 0.0)))
    world.spawn(Rope(a=hook, b=crate, anchor_b=(0.25, 0.0), length=1.0))
    run(world, 1.0)
    # Taut at .25 s: 2 N s at 1 m/s, of which one half is lost, then against friction.
    assert went_by_events(world)
    assert world.account.sums[HAND, ENERGY] == pytest.approx(2.0 + 0.8 * G * 0.75, abs=1e-12)
    assert world.account.sums[JOINTS, ENERGY] == pytest.approx(-1.0, abs=1e-12)
    assert world.joints.force[0] == pytest.approx(0.8 * G, rel=1e-12)


# ---- limits ------------------------------------------------------------------------------------------------


def bar_on_a_pin(angle: float, **pin: Any) -> tuple[World, int]:
    """Return a bar of 1 m on a pin at one end, level at an angle of 0."""
    world = empty()
    at = Transform((0.5 * math.cos(angle), 0.5 * math.sin(angle)), angle)
    bar = world.spawn(at, Velocity(), Mass(1.0), Shape.box(1.0, 0.1))
    world.spawn(Pin(b=bar, anchor_b=(-0.5, 0.0), **pin))
    return world, bar


def test_a_bar_falls_on_its_lower_limit_and_rests_there() -> None:
    world, bar = bar_on_a_pin(0.5, lower=-0.3)
    inertia = (1.0 + 0.01) / 12.0 + 0.25
    spin = math.sqrt(G * (math.sin(0.5) + math.sin(0.3)) / inertia)
    # The time by the integral of d theta over the spin, substituted to be smooth at the start.
    s = (np.polynomial.legendre.leggauss(40)[0] + 1.0) * 0.5
    weights = 0.5 * np.polynomial.legendre.leggauss(40)[1]
    fallen = 0.8 * s**2
    rate = np.sqrt(G * (math.sin(0.5) - np.sin(0.5 - fallen)) / inertia)
    hit = float(np.sum(weights * 1.6 * s / rate))
    run(world, hit - 1e-9)
    assert world.component(bar, Velocity).angular == pytest.approx(-spin, rel=1e-7)
    assert world.account.sums[JOINTS, ENERGY] == 0.0
    run(world, 2e-9)
    assert world.account.sums[JOINTS, ENERGY] == pytest.approx(-0.5 * inertia * spin**2, abs=1e-11)
    world.run(seconds=1.0)
    assert went_by_events(world)
    assert world.component(bar, Transform).angle == pytest.approx(-0.3, abs=1e-14)
    assert world.component(bar, Velocity).angular == 0.0
    assert world.joints.force[2] == pytest.approx(0.5 * G * math.cos(0.3), rel=1e-12)


def test_a_limit_is_left_as_soon_as_something_lifts_the_bar() -> None:
    world, bar = bar_on_a_pin(0.0, lower=0.0)
    world.run(seconds=0.1)
    assert world.component(bar, Velocity).angular == 0.0
    turn(world, bar, 1.0, 0.5)
    world.run(seconds=0.02)
    assert world.component(bar, Transform).angle > 0.015
    assert went_by_events(world)


def test_a_bar_beyond_its_limit_is_brought_back_softly_and_rests_there() -> None:
    world, bar = bar_on_a_pin(-0.2, lower=0.0)
    world.step()
    rigid = world.steppers.usable[0]
    assert isinstance(rigid, Rigid) and rigid.why_soft.startswith("bodies overlap, or are beyond what joints")
    world.run(seconds=0.3)
    assert isinstance(world.stepper, Rigid)
    assert world.component(bar, Transform).angle == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("turns", [False, True])
def test_a_slider_is_stopped_at_the_end_of_its_slot(turns: bool) -> None:
    world = empty(0.0)
    body = world.spawn(Transform((0.0, 0.0)), Velocity((3.0, 0.0)), Mass(2.0), Shape.box(0.4, 0.2))
    world.spawn(Slot(b=body, axis=(1.0, 0.0), lower=-0.5, upper=0.75, turns=turns))
    run(world, 0.25 - 1e-9)
    assert world.component(body, Velocity).linear.x == 3.0
    run(world, 2e-9)
    assert world.component(body, Velocity).linear.x == pytest.approx(0.0, abs=1e-12)
    assert world.account.sums[JOINTS, ENERGY] == pytest.approx(-9.0, abs=1e-12)
    run(world, 0.2)
    assert went_by_events(world)
    assert world.component(body, Transform).position.x == pytest.approx(0.75, abs=1e-11)


# ---- motors ------------------------------------------------------------------------------------------------


def test_a_motor_reaches_its_speed_at_its_time_and_holds_it() -> None:
    world = empty(0.0)
    wheel = world.spawn(Transform((0.0, 0.0)), Velocity(), Mass(2.0), Shape.circle(0.5))
    world.spawn(Pin(b=wheel, motor_speed=6.0, max_torque=0.5))
    inertia = 0.5 * 2.0 * 0.25
    reached = 6.0 * inertia / 0.5
    run(world, 0.5 * reached)
    assert world.component(wheel, Velocity).angular == pytest.approx(3.0, rel=1e-12)
    assert world.joints.force[2] == pytest.approx(0.5, rel=1e-12)
    run(world, 0.5 * reached + 1.0)
    assert went_by_events(world)
    assert world.component(wheel, Velocity).angular == pytest.approx(6.0, rel=1e-14)
    assert world.component(wheel, Transform).angle == pytest.approx(3.0 * reached + 6.0, rel=1e-12)
    assert world.joints.force[2] == pytest.approx(0.0, abs=1e-12)
    assert world.account.sums[MOTORS, ENERGY] == pytest.approx(0.5 * inertia * 36.0, rel=1e-12)


def test_a_motor_holds_a_bar_until_its_weight_is_too_much() -> None:
    # It lifts the bar from below at .5 rad/s; the weight's torque reaches the cap at 30 degrees from below.
    world, bar = bar_on_a_pin(-0.5 * math.pi, motor_speed=0.5, max_torque=0.25 * G)
    turn(world, bar, 0.5, 0.5)
    stalled = math.pi / 3.0
    run(world, stalled - 1e-6)
    assert world.component(bar, Velocity).angular == pytest.approx(0.5, rel=1e-13)
    assert world.joints.force[2] == pytest.approx(0.5 * G * math.sin(0.5 * (stalled - 1e-6)), rel=1e-11)
    work = 0.5 * G * (1.0 - math.cos(0.5 * (stalled - 1e-6)))
    assert world.account.sums[MOTORS, ENERGY] == pytest.approx(work, rel=1e-12)
    run(world, 2e-6)
    assert world.joints.force[2] == pytest.approx(0.25 * G, rel=1e-13)
    spin = world.component(bar, Velocity).angular
    assert 0.5 - 1e-10 < spin < 0.5
    run(world, 0.5)
    assert world.component(bar, Velocity).angular < 0.5 - 1e-3
    assert world.joints.force[2] == pytest.approx(0.25 * G, rel=1e-13)
    assert went_by_events(world)


def test_a_brake_stops_a_wheel_and_keeps_it() -> None:
    world = empty(0.0)
    wheel = world.spawn(Transform((0.0, 0.0)), Velocity(angular=4.0), Mass(2.0), Shape.circle(0.5))
    world.spawn(Pin(b=wheel, motor_speed=0.0, max_torque=1.0))
    run(world, 3.0)
    assert went_by_events(world)
    assert world.component(wheel, Velocity).angular == pytest.approx(0.0, abs=1e-15)
    assert world.component(wheel, Transform).angle == pytest.approx(2.0, abs=1e-13)
    assert world.account.sums[MOTORS, ENERGY] == pytest.approx(-2.0, abs=1e-12)


# ---- pulleys -----------------------------------------------------------------------------------------------


def atwood(first: float, second: float, height: float = 50.0) -> tuple[World, int, int]:
    """Return two masses over two wheels, at rest, the first so high above a floor."""
    world = empty()
    one, other = (
        world.spawn(Transform((x, 0.0)), Velocity(), Mass(mass), Shape.box(0.4, 0.4), Material(restitution=0))
        for x, mass in ((-1.0, first), (1.0, second))
    )
    world.spawn(Pulley(a=one, b=other, wheel_a=(-1.0, 4.0), wheel_b=(1.0, 4.0)))
    world.spawn(Transform((-1.0, -height - 0.7)), Shape.box(1.0, 1.0))
    return world, one, other


def test_atwood() -> None:
    world, first, second = atwood(3.0, 2.0)
    run(world, 0.5)
    assert went_by_events(world)
    assert world.component(first, Velocity).linear.y == pytest.approx(-0.2 * G * 0.5, rel=1e-12)
    assert world.component(second, Transform).position.y == pytest.approx(0.1 * G * 0.25, rel=1e-12)
    assert world.joints.force[0] == pytest.approx(12.0 / 5.0 * G, rel=1e-12)


def test_a_mass_that_lands_lets_the_other_fly_until_the_rope_is_taut_again() -> None:
    world, first, second = atwood(3.0, 2.0, 0.5)
    landed = math.sqrt(1.0 / (0.2 * G))
    speed = 0.2 * G * landed
    run(world, landed + 1e-9)
    assert world.component(first, Velocity).linear.y == pytest.approx(0.0, abs=1e-10)
    assert world.component(second, Velocity).linear.y == pytest.approx(speed, rel=1e-7)
    again = 2.0 * speed / G
    run(world, again - 2e-9)
    assert world.component(second, Velocity).linear.y == pytest.approx(-speed, rel=1e-7)
    assert world.account.sums[JOINTS, ENERGY] == 0.0
    run(world, 2e-9)
    # Both go on with the momentum of the second: 2 of 5 kg.
    assert went_by_events(world)
    assert world.component(first, Velocity).linear.y == pytest.approx(0.4 * speed, rel=1e-7)
    assert world.account.sums[JOINTS, ENERGY] == pytest.approx(-(speed**2) * (1.0 - 0.4), rel=1e-9)


# ---- any of them -------------------------------------------------------------------------------------------


@settings(max_examples=10)
@example(2, [0.0, 0.0, 0.5, -1.0, 0.0, 0.375] + [0.0] * 18, True, True)  # lands on two corners at once
@given(
    st.integers(2, 4), st.lists(st.floats(-1.0, 1.0), min_size=24, max_size=24), st.booleans(), st.booleans()
)
def test_no_chain_of_ropes_makes_energy_or_grows(
    links: int, numbers: list[float], shaped: bool, pinned: bool
) -> None:
    def made() -> World:
        world, before = empty(), None
        for i in range(links):
            x, y, vx, vy, spin, mass = numbers[6 * i : 6 * i + 6]
            parts = [Shape.box(0.3, 0.2), Material(restitution=0.3)] if shaped else []
            at = Transform((0.6 * (i + 1) + 0.1 * x, 0.1 * y)), Velocity((vx, vy), spin), Mass(1.5 + mass)
            body = world.spawn(*at, *parts)
            world.spawn(Rope(a=before, b=body, anchor_b=(0.05, 0.1) if shaped else (0, 0), length=0.9))
            before = body
        if pinned:
            bar = world.spawn(Transform((0.2, -0.8)), Velocity(), Mass(1.0), Shape.box(0.8, 0.1))
            world.spawn(
                Pin(b=bar, anchor_a=(0.2, -0.8), lower=-0.2, upper=0.3, motor_speed=1.0, max_torque=0.5)
            )
        return world

    world = made()
    run(world, 0.4, put=TOUCH * 0.2 if shaped else 0.0)
    given_in = world.account.sums[MOTORS, ENERGY]
    lost = world.account.sums[[JOINTS, CONTACT], ENERGY]
    assert lost.max() <= 1e-10
    assert measure_energy(world).total <= given_in + measure_energy(made()).total + 1e-10
    joints, position, angle = (
        world.joints,
        world.table(Transform)["position"],
        world.table(Transform)["angle"],
    )
    for joint in joints.joints:
        if joint.kind is Rope:
            ends = []
            for body, anchor in ((joints.a, joints.anchor_a), (joints.b, joints.anchor_b)):
                x, y = anchor[joint.first]
                c, s = math.cos(angle[body[joint.first]]), math.sin(angle[body[joint.first]])
                ends.append(position[body[joint.first]] + np.array((c * x - s * y, s * x + c * y)))
            assert math.hypot(*(ends[1] - ends[0])) <= 0.9 * (1.0 + 1e-9)
    again = made()
    again.run(seconds=0.4)
    assert again.table(Transform)["position"].tobytes() == position.tobytes()


def test_single_steps_a_run_and_a_saved_scene_give_the_same_bits(tmp_path: Path) -> None:
    worlds = []
    for _ in range(3):
        world, _ = bar_on_a_pin(0.4, lower=-0.3, upper=0.6, motor_speed=2.0, max_torque=7.0)
        ball = world.spawn(Transform((0.4, 0.9)), Velocity(), Mass(0.5), Shape.circle(0.1), Material(0.5))
        world.spawn(Rope(b=ball, anchor_a=(0.0, 0.9), length=0.45))
        worlds.append(world)
    for _ in range(60):
        worlds[0].step()
    worlds[1].run(steps=60)
    worlds[2].run(steps=25)
    save_scene(worlds[2], tmp_path / "scene.json")
    worlds[2] = load_scene(tmp_path / "scene.json")
    worlds[2].run(steps=35)
    assert went_by_events(worlds[1])
    states = {b"".join(world.table(kind)[name].tobytes() for kind, name in _MOTION) for world in worlds}
    assert len(states) == 1


def test_short_steps_hold_what_events_would() -> None:
    """Where events accumulate, the rest of a step is made by impulses: limits hold, caps are caps."""
    world, bar = bar_on_a_pin(0.0, lower=-0.2, motor_speed=-1.0, max_torque=1.5)
    world.simulation = replace(world.simulation, contacts="rigid")
    world.synchronise()
    rigid = next(stepper for stepper in world.steppers.usable if isinstance(stepper, Rigid))
    inertia = (1.0 + 0.01) / 12.0 + 0.25
    with patch.object(rigid_motion, "_MAX_EVENTS", 0):
        world.run(seconds=0.05)
        assert rigid.by_impulses == 3
        spin = world.component(bar, Velocity).angular
        assert spin == pytest.approx(-(0.5 * G + 1.5) / inertia * 0.05, rel=1e-3)
        angle = world.component(bar, Transform).angle
        assert world.account.sums[MOTORS, ENERGY] == pytest.approx(-1.5 * angle, rel=1e-2)
        world.run(seconds=0.4)
    assert world.component(bar, Transform).angle == pytest.approx(-0.2, abs=1e-6)
    assert world.component(bar, Velocity).angular == pytest.approx(0.0, abs=1e-6)


def test_where_events_accumulate_auto_takes_soft_joints_from_there_on() -> None:
    ways = []
    for single in (True, False):
        world, bar = bar_on_a_pin(0.0, lower=-0.2, motor_speed=-1.0, max_torque=1.5)
        world.run(steps=2)
        with patch.object(rigid_motion, "_MAX_EVENTS", 0):
            for _ in range(30 if single else 1):
                world.run(steps=1 if single else 30)
        assert (world.plan.contacts, world.plan.contact_reason) == ("soft", WITHOUT_END)
        assert world.component(bar, Transform).angle == pytest.approx(-0.2, abs=1e-4)
        assert world.steps == 32
        ways.append(world.table(Transform)["angle"].tobytes())
    assert ways[0] == ways[1]


# ---- which worlds ------------------------------------------------------------------------------------------


def test_the_reason_for_rigid_and_for_soft_names_the_joint() -> None:
    world, _ = slack_pendulum()
    world.synchronise()
    assert world.plan.contacts == "rigid"
    assert world.plan.contact_reason.startswith("a Rope has a limit")
    world.simulation = replace(world.simulation, contacts="soft")
    world.synchronise()
    assert (world.plan.contacts, world.plan.contact_reason) == ("soft", "asked for")
    world.simulation = replace(world.simulation, contacts="auto")
    for i in range(12):
        world.spawn(Transform((float(i), 5.0)), Velocity(), Mass(1.0))
    world.synchronise()
    assert (world.plan.contacts, world.plan.contact_reason) == ("soft", "more than 12 bodies move")


def test_contacts_hold_what_an_edit_keeps_from_turning_beside_its_motor() -> None:
    """The motor divided by what it could turn, which was nothing: the weight was an error of the method."""
    world = World(simulation=SimulationConfig(contacts="rigid", collisions="step"))
    world.spawn(Transform((0.0, -0.5)), Shape.box(9.0, 1.0))
    one, other = (
        world.spawn(Transform((x, 0.5)), Velocity(), Mass(1.0), Shape.box(1.0, 1.0)) for x in (0.0, 1.3)
    )
    world.component(other, Mass).fixed_rotation = True
    world.spawn(Pin(a=one, b=other, anchor_a=(1.3, 0.0), motor_speed=1.0, max_torque=5.0))
    world.run(seconds=0.5)
    world.component(one, Mass).fixed_rotation = True
    world.run(seconds=0.5)
    assert isinstance(world.stepper, Rigid) and not world.stepper.by_impulses
    account = measure_account(world)
    assert account.momentum["contact"].y == pytest.approx(2.0 * 9.81 * world.time, rel=1e-9)
    assert account.momentum["numerical"].magnitude < 1e-12
