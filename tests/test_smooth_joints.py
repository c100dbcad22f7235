"""Joints where nothing touches: every kind holds, motors keep their speed, and the books agree."""

from __future__ import annotations

import math

import numpy as np
import pytest

from physicslab import World
from physicslab.components import Gear, Mass, Pin, Rod, Slot, Spring, Transform, Velocity, Weld
from physicslab.diagnostics.energy import measure_account, measure_energy
from physicslab.diagnostics.joints import joint_states
from physicslab.diagnostics.warnings import find_warnings
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.kernels.accounts import ANGULAR_MOMENTUM, ENERGY, GRAVITY, HAND, JOINTS, MOTORS, PX
from physicslab.kernels.joints import layout
from physicslab.stepping.flow import Flow


def body(world: World, x: float, y: float, vx: float = 0.0, vy: float = 0.0, spin: float = 0.0) -> int:
    """Return a body of 1 kg and 0.5 kg m^2."""
    return world.spawn(Transform((x, y)), Velocity((vx, vy), spin), Mass(1.0, inertia=0.5))


def largest_error(world: World) -> float:
    """Return how far apart joints are that hold [m or rad]."""
    return max(max(joint.stretch, joint.twist) for joint in joint_states(world))


def swinging(kind: str) -> World:
    """Return two bodies that swing on a rod, and are joined by something else."""
    world = World()
    a, b = body(world, 1.0, 0.0), body(world, 1.8, 0.3, 0.5, -0.2, 1.0)
    world.spawn(Rod(b=a))
    joint = {
        "rod": Rod(a, b, anchor_b=(0.1, 0.0)),
        "pin": Pin(a, b, anchor_a=(0.4, 0.1), anchor_b=(-0.4, -0.2)),
        "weld": Weld(a, b, anchor_a=(0.4, 0.1), anchor_b=(-0.4, -0.2)),
        "slot": Slot(a, b, axis=(0.8, 0.3)),
        "turning slot": Slot(a, b, axis=(0.8, 0.3), turns=True),
    }[kind]
    world.spawn(joint)
    return world


@pytest.mark.parametrize("kind", ["rod", "pin", "weld", "slot", "turning slot"])
def test_every_joint_holds_to_rounding_and_does_no_work(kind: str) -> None:
    world = swinging(kind)
    world.step()  # speeds that the joint does not allow are gone
    before = measure_energy(world).total
    world.run(seconds=2.0)
    assert world.stepper is not None and world.stepper.name == "flow"
    assert largest_error(world) < 1e-14
    assert measure_energy(world).total == pytest.approx(before, abs=1e-12)


@pytest.mark.parametrize("kind", ["pin", "weld", "rod"])
def test_speeds_that_a_joint_does_not_allow_are_lost_in_an_impulse_that_is_booked(kind: str) -> None:
    world = swinging(kind)
    world.synchronise()
    before = measure_energy(world).total
    world.step()
    lost = before - measure_energy(world).total
    assert lost > 0.01
    assert world.account.sums[JOINTS, ENERGY] == pytest.approx(-lost, rel=1e-12)


def test_a_driven_slider_crank_moves_as_its_kinematics_say_and_the_motor_pays() -> None:
    world, speed, arm = World(), 3.0, 1.5
    crank, rod, slider = (
        body(world, 0.25, 0.0),
        body(world, 0.5 + 0.5 * arm, 0.0),
        body(world, 0.5 + arm, 0.0),
    )
    world.spawn(Pin(b=crank, anchor_b=(-0.25, 0.0), motor_speed=speed))
    world.spawn(Pin(crank, rod, anchor_a=(0.25, 0.0), anchor_b=(-0.5 * arm, 0.0)))
    world.spawn(Pin(rod, slider, anchor_a=(0.5 * arm, 0.0)))
    world.spawn(Slot(b=slider))
    world.synchronise()
    before = measure_energy(world).total
    world.run(seconds=2.0)
    phase = speed * world.time
    place = 0.5 * math.cos(phase) + math.sqrt(arm**2 - (0.5 * math.sin(phase)) ** 2)
    assert world.component(slider, Transform).position.x == pytest.approx(place, abs=1e-13)
    assert world.component(crank, Velocity).angular == pytest.approx(speed, abs=1e-13)
    sums = world.account.sums
    assert sums[MOTORS, ENERGY] == pytest.approx(measure_energy(world).total - before, abs=1e-12)
    assert sums[JOINTS, ENERGY] == pytest.approx(0.0, abs=1e-13)


def test_a_gear_passes_on_torque_and_turns_by_its_ratio() -> None:
    world = World()
    weight, wheel, other = body(world, 0.3, 0.0), body(world, 0.0, 0.0), body(world, 2.0, 0.0)
    world.spawn(Weld(wheel, weight, anchor_a=(0.3, 0.0)))
    first, second = world.spawn(Pin(b=wheel)), world.spawn(Pin(b=other, anchor_a=(2.0, 0.0)))
    world.spawn(Gear(first=first, second=second, ratio=-2.0))
    world.synchronise()
    before = measure_energy(world).total
    world.run(seconds=3.0)
    turned = [world.component(one, Transform).angle for one in (wheel, other)]
    assert abs(turned[0]) > 0.5
    assert turned[1] == pytest.approx(-2.0 * turned[0], abs=1e-14)
    assert measure_energy(world).total == pytest.approx(before, abs=1e-12)
    # At rest in its highest place, beside a gear of twice the speed: (I + m r^2 + 4 I_2) a = m g r.
    world = World()
    wheel, other = world.spawn(Transform(), Velocity(), Mass(1.0, inertia=0.59)), body(world, 2.0, 0.0)
    first, second = (
        world.spawn(Pin(b=wheel, anchor_b=(-0.3, 0.0))),
        world.spawn(Pin(b=other, anchor_a=(2.0, 0.0))),
    )
    world.spawn(Gear(first=first, second=second, ratio=-2.0))
    world.step(1e-6)
    spin = world.component(wheel, Velocity).angular
    assert spin == pytest.approx(-9.81 * 0.3 / (0.59 + 0.09 + 4 * 0.5) * 1e-6, rel=1e-9)


def test_a_motor_that_moves_a_driven_platform_is_paid_by_both() -> None:
    world = World()
    turntable = world.spawn(Transform(), Velocity((0.0, 0.0), 1.0))
    arm = body(world, 1.5, 0.0)
    world.spawn(Pin(turntable, arm, anchor_a=(1.0, 0.0), anchor_b=(-0.5, 0.0), motor_speed=2.0))
    world.synchronise()
    before = measure_energy(world).total
    world.run(seconds=0.7)
    gained, sums = measure_energy(world).total - before, world.account.sums
    assert abs(sums[MOTORS, ENERGY]) > 0.1 and abs(sums[HAND, ENERGY]) > 0.1
    assert sums[:, ENERGY].sum() == pytest.approx(gained, abs=1e-12)
    assert world.component(arm, Transform).angle == pytest.approx(3.0 * world.time, abs=1e-13)
    assert sums[GRAVITY, PX] == 0.0 and sums[MOTORS, ANGULAR_MOMENTUM] != 0.0


def joined_chain(order: np.ndarray) -> World:
    """Return a chain of 40 links that hangs from the origin; its pins are made in an order."""
    world = World()
    links = [body(world, 0.5 + i, 0.0) for i in range(len(order))]
    for i in order.tolist():
        ends = {"a": links[i - 1], "anchor_a": (0.5, 0.0)} if i else {}
        world.spawn(Pin(b=links[i], anchor_b=(-0.5, 0.0), **ends))
    return world


def test_a_chain_costs_as_much_as_it_has_links_in_whatever_order_it_was_joined() -> None:
    orders = np.arange(40), np.random.default_rng(1).permutation(40)
    worlds = [joined_chain(order) for order in orders]
    for world in worlds:
        world.run(seconds=0.1)
        flow = world.stepper
        assert isinstance(flow, Flow)
        whole = flow._ode.joints[1]
        assert whole[layout.ENTRIES] <= 4 * 80
    tables = [world.table(Transform)["position"] for world in worlds]
    np.testing.assert_allclose(tables[0], tables[1], atol=1e-12)


def test_a_joint_too_many_is_found_and_moves_nothing_else() -> None:
    worlds = swinging("weld"), swinging("weld")
    worlds[1].synchronise()
    worlds[1].spawn(Rod(*worlds[1].batch(Mass).entities.tolist()))
    for world in worlds:
        world.run(seconds=1.0)
    assert (int(worlds[1].joints.dependent.sum()), len(worlds[1].joints)) == (1, 5)
    (told,) = find_warnings(worlds[1])
    assert told.value == 1.0 and "other joints hold already" in told.what
    assert told.number in [joint.entity for joint in worlds[1].joints.joints]
    assert not find_warnings(worlds[0])
    places = [world.table(Transform)["position"][1:3] for world in worlds]
    np.testing.assert_allclose(places[0], places[1], atol=1e-13)


@pytest.mark.parametrize("far", [None, (5000.0, 0.0)])
@pytest.mark.parametrize("apart", [1e-3, 1e-7])
def test_an_edit_that_parts_a_joint_is_closed_on_account_of_joints_whatever_is_far(
    far: tuple[float, float] | None, apart: float
) -> None:
    world = World(physics=PhysicsConfig(gravity_mode="planet", G=1e-12))
    bob = body(world, 1.0, 0.0)
    world.spawn(Rod(b=bob))
    world.spawn(Spring(bob, anchor_b=(2.0, 0.0), rest_length=0.5))
    if far is not None:
        body(world, *far)
    world.step()
    world.component(bob, Transform).position = 1.0 + apart, 0.0
    world.step()
    account = measure_account(world).energy
    assert account["joints"] == pytest.approx(-account["edits"], rel=1e-6)
    assert account["joints"] > 40.0 * apart
    assert abs(account["numerical"]) < 1e-12


def test_rods_that_contradict_each_other_explode_nothing() -> None:
    world = World()
    a, b = body(world, 1.0, 0.0), body(world, 1.5, 0.5)
    for end in (a, b):
        world.spawn(Rod(b=end, length=1.0))
    world.spawn(Rod(a, b, length=3.0))  # a triangle of 1, 1 and 3 m
    for _ in range(60):
        world.step()
    assert largest_error(world) > 0.1
    assert "contradicts other joints" in find_warnings(world)[0].what
    assert measure_energy(world).kinetic < 1e3
    assert np.abs(world.table(Transform)["position"]).max() < 5.0


@pytest.mark.parametrize(("spin", "dt"), [(3.0, 1 / 60), (3.0, 1.5), (300.0, 1 / 60), (3e-3, 100.0)])
def test_a_linkage_turns_as_often_at_any_speed_and_step(spin: float, dt: float) -> None:
    world, rods = World(simulation=SimulationConfig(dt=dt), physics=PhysicsConfig(gravity_mode="none")), []
    for x in (0.0, 1.0):
        rods.append(body(world, x, 1.0, vx=-spin, spin=spin))
        world.spawn(Pin(b=rods[-1], anchor_a=(x, 0.0), anchor_b=(0.0, -1.0)))
    top = body(world, 0.5, 1.0, vx=-spin)
    for x, rod in zip((-0.5, 0.5), rods, strict=True):
        world.spawn(Pin(rod, top, anchor_b=(x, 0.0)))
    steps = math.ceil(60.0 / spin / dt)
    world.run(steps=steps)
    for rod in rods:
        assert world.component(rod, Transform).angle == pytest.approx(spin * steps * dt, abs=1e-8), (
            "20 times flat"
        )
    assert world.component(top, Transform).angle == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("dt", [1 / 60, 1.5])
def test_a_linkage_passes_where_it_lies_flat_and_goes_on_as_it_came(dt: float) -> None:
    world, rods = World(simulation=SimulationConfig(dt=dt)), []
    for x in (0.0, 1.0):
        rods.append(body(world, x, 1.0, vx=-3.0, spin=3.0))
        world.spawn(Pin(b=rods[-1], anchor_a=(x, 0.0), anchor_b=(0.0, -1.0)))
    top = body(world, 0.5, 1.0, vx=-3.0)
    for x, rod in zip((-0.5, 0.5), rods, strict=True):
        world.spawn(Pin(rod, top, anchor_b=(x, 0.0)))
    world.synchronise()
    before = measure_energy(world).total
    world.run(seconds=1.5)
    angles = [world.component(rod, Transform).angle for rod in rods]
    assert angles[0] > 1.6 * math.pi, "flat twice"
    assert angles[1] == pytest.approx(angles[0], abs=1e-13)
    assert world.component(top, Transform).angle == pytest.approx(0.0, abs=1e-13)
    assert measure_energy(world).total == pytest.approx(before, abs=1e-7)


@pytest.mark.parametrize(("method", "order"), [("symplectic_euler", 1), ("leapfrog", 2), ("blanes_moan", 6)])
def test_splitting_methods_keep_their_orders_and_accounts_on_joints(method: str, order: int) -> None:
    def swung(integrator: str, steps: int) -> World:
        world = World(simulation=SimulationConfig(integrator=integrator, dt=0.5 / steps, substeps=1))
        a, b = body(world, 1.0, 0.0), body(world, 2.0, 0.0)
        world.spawn(Rod(b=a))
        world.spawn(Pin(a=a, b=b, anchor_a=(1.0, 0.0)))
        world.run(steps=steps)
        return world

    def places(world: World) -> np.ndarray:
        return world.table(Transform)["position"][1:3].copy()

    right, worlds = places(swung("dop853", 30)), [swung(method, steps) for steps in (10, 20)]
    coarse, fine = (float(np.abs(places(world) - right).max()) for world in worlds)
    assert np.log2(coarse / fine) == pytest.approx(order, abs=0.3)
    assert not find_warnings(worlds[1])
    accounts = measure_account(worlds[1])
    assert accounts.momentum["numerical"].magnitude < 1e-12
    assert abs(accounts.angular_momentum["numerical"]) < 1e-12
    assert largest_error(worlds[1]) < 1e-14


def test_a_run_in_one_call_may_cost_as_much_as_its_steps() -> None:
    world = World()
    light = world.spawn(Transform((1, 0)), Velocity(), Mass(1.0))
    heavy = world.spawn(Transform((2, 0)), Velocity(), Mass(1e5))
    world.spawn(Rod(None, light))
    world.spawn(Rod(light, heavy))
    world.run(steps=90)  # it was charged for what earlier steps had cost, and went on with soft joints
    assert world.plan.integrator.name == "dop853"
    account = measure_account(world).energy
    assert account["joints"] == 0.0 and abs(account["numerical"]) < 1e-7, "of 2 MJ"
