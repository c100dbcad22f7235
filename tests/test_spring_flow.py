"""Springs beside contacts: a flow of their own, eight springs at a time, with steps of one length."""

import json
import math
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import Any
from unittest.mock import patch

import numpy as np
import pytest
from desk import bits
from hypothesis import given
from hypothesis import strategies as st

from physicslab.components import Drag, Mass, Spring, Transform, Velocity
from physicslab.contacts.arguments import motion_of
from physicslab.diagnostics.energy import measure_account, measure_energy
from physicslab.ecs.config import PhysicsConfig
from physicslab.ecs.vector import Vector2
from physicslab.files.json_text import json_text
from physicslab.files.scene import read_scene, write_scene
from physicslab.integrators.implicit_midpoint import IMPLICIT_MIDPOINT
from physicslab.integrators.spring_splitting import DRIFTS, KICKS, SPRING_SPLITTING
from physicslab.kernels.arguments import Motion, Springs
from physicslab.kernels.interpreter import fallback_of
from physicslab.kernels.ode.spring_flow import TURNS_FAST, flow_springs
from physicslab.lab import worlds
from physicslab.lab.bench.moving import chains
from physicslab.lab.worlds import floor, place
from physicslab.prefabs import box, circle
from physicslab.state.packed import spring_ends
from physicslab.stepping import split_forces, spring_flow
from physicslab.stepping.kick_series import series_terms
from physicslab.stepping.soft import Soft
from physicslab.stepping.split_forces import SplitForces, SplitPart
from physicslab.stepping.spring_groups import spring_groups
from physicslab.world import World

open_space = partial(worlds.open_space, contacts="soft", collisions="step")


def far_floor(world: World) -> World:
    """Return a world in which things could touch, and do not."""
    box(world, (0.0, -1e3), width=1.0, height=1.0, static=True)
    return world


def elastic_pendulum(substeps: int) -> tuple[World, int]:
    """Return the elastic pendulum of the reference problems, of 2 m rad/s omega h a half substep of 0.5 s."""
    world = far_floor(open_space())
    world.simulation = replace(world.simulation, dt=0.5, substeps=substeps)
    bob = circle(world, (1.2, 0.0), radius=0.1, mass=1.0)
    world.add(bob, Spring(rest_length=1.0, stiffness=40.0))
    return world, bob


def chain(order: int = 1, *, discs: int = 10, height: float = 0.3, gravity: float | None = 9.81) -> World:
    """Return a bent chain of discs above a floor, spawned from one end or (-1) from the other."""
    world, random = open_space(gravity=gravity), np.random.default_rng(1)
    floor(world)
    bends = random.uniform(-0.02, 0.02, (discs, 2)).tolist()
    places = [(0.25 * i + dx, height + dy) for i, (dx, dy) in enumerate(bends)]
    row = [circle(world, at, radius=0.1, mass=0.1, angular_velocity=1.0) for at in places[::order]][::order]
    for a, b in pairwise(row):
        world.spawn(Spring(a, b, rest_length=0.25, stiffness=360.0))
    return world


def split_of(world: World) -> SplitForces:
    world.synchronise()
    stepper = world.steppers.usable[-1]
    assert isinstance(stepper, Soft) and stepper.substeps.split is not None
    return stepper.substeps.split


def follows(world: World) -> bool:
    """Whether springs are moved by a flow of their own."""
    return all(part.springs is not None for part in split_of(world).parts)


# ---- the method --------------------------------------------------------------------------------------------


def error_after_one_second(substeps: int) -> float:
    world, bob = elastic_pendulum(substeps)
    assert split_of(world).parts[0].springs is not None and split_of(world).parts[0].steps == 1
    world.run(seconds=1.0)
    at = place(world, bob)
    return math.hypot(at.x + 0.6462298902398042, at.y + 1.284530828135613)


def test_an_elastic_pendulum_is_where_the_reference_has_it() -> None:
    """By Taylor's method with 40 digits, as the reference problems have it; omega h is 0.23 and 0.11."""
    assert error_after_one_second(7) < 2e-6
    assert error_after_one_second(14) < 1e-7


def test_the_order_is_four() -> None:
    assert math.log2(error_after_one_second(32) / error_after_one_second(64)) == pytest.approx(4, abs=0.1)


def of_oscillator(z: float) -> np.ndarray[Any, Any]:
    """Return the matrix of a step of omega h = z."""
    step = np.eye(2)
    for kick, drift in zip(KICKS, (*DRIFTS, 0.0), strict=True):
        step = np.array(((1.0, drift * z), (0.0, 1.0))) @ np.array(((1.0, 0.0), (-kick * z, 1.0))) @ step
    return step


def test_linear_oscillations_are_followed_to_order_six() -> None:
    errors = []
    for z in (0.2, 0.4):
        exact = np.array(((math.cos(z), math.sin(z)), (-math.sin(z), math.cos(z))))
        errors.append(float(np.abs(of_oscillator(z) - exact).max()))
    assert math.log2(errors[1] / errors[0]) == pytest.approx(7, abs=0.1)  # a step's is of one order more


def test_what_the_method_states_of_itself_is_so() -> None:
    z = 0.26
    phase = math.acos(0.5 * float(np.trace(of_oscillator(z))))
    lost = abs(phase / z - 1.0)
    assert lost == pytest.approx(SPRING_SPLITTING.phase_share * z**SPRING_SPLITTING.phase_order, rel=0.1)
    limit = SPRING_SPLITTING.stability_limit
    assert abs(np.trace(of_oscillator(limit))) <= 2.0 < abs(np.trace(of_oscillator(1.01 * limit)))


# ---- what it is used for -----------------------------------------------------------------------------------


def with_damper(world: World) -> None:
    world.spawn(Spring(2, 3, rest_length=0.25, stiffness=360.0, damping=0.1))


def with_drag(world: World) -> None:
    world.add(2, Drag(linear=0.1))


def with_anchor(world: World) -> None:
    world.spawn(Spring(2, 3, (0.05, 0.0), rest_length=0.25, stiffness=360.0))


def with_damping(world: World) -> None:
    world.physics = replace(world.physics, linear_damping=0.1)


def with_square_drag(world: World) -> None:
    world.add(2, Drag(quadratic=0.1))


def with_turning_damped(world: World) -> None:
    world.physics = replace(world.physics, angular_damping=0.1)


def with_planets(world: World) -> None:
    world.physics = PhysicsConfig(gravity_mode="planet", G=1e-3)


@pytest.mark.parametrize("change", [with_square_drag, with_turning_damped, with_planets])
def test_what_is_no_linear_spring_is_followed_as_before(change: Callable[[World], None]) -> None:
    world = chain()
    assert follows(world) and world.plan.split_forces is SPRING_SPLITTING
    change(world)
    assert not follows(world) and world.plan.split_forces is not SPRING_SPLITTING


def test_the_reason_names_the_method_and_its_steps() -> None:
    world = chain()
    world.synchronise()
    assert (
        "spring_splitting: steps of omega h = 0.25, and dop853 where springs turn fast" in world.plan.reason
    )


def by_dop853() -> Any:
    """Let what is built within a with block be followed by dop853 alone: every spring is too short."""
    return patch.object(spring_flow, "_SHORTEST", 1e9)


def after(build: Callable[[], World], seconds: float, *, adaptive: bool = False) -> Any:
    world = build()
    with by_dop853() if adaptive else nullcontext():
        split_of(world)
    world.run(seconds=seconds)
    return np.concatenate((world.table(Transform)["position"], world.table(Velocity)["linear"]))


def test_a_chain_on_a_floor_is_where_a_far_more_accurate_method_has_it() -> None:
    """Contacts within four substeps are 3e-4 m off; the flow between them adds 2e-9."""
    assert np.abs(after(chain, 0.5) - after(chain, 0.5, adaptive=True)).max() < 1e-6
    flow, followed = (after(chain, 0.5, adaptive=way)[:12] for way in (False, True))
    assert 0.0 < np.abs(flow - followed).max() < 2e-8


def pressed() -> World:
    """Return two discs that pass each other closely, which presses the spring between them together."""
    world = far_floor(open_space(gravity=None))
    ends = [circle(world, (x, 0.0), radius=0.01, mass=1.0, velocity=(-9.0 * x, 0.1 * x)) for x in (-1.0, 1.0)]
    world.spawn(Spring(ends[0], ends[1], rest_length=2.0, stiffness=20.0))
    return world


def whirled(speed: float = 120.0) -> World:
    """Return a body that begins to go round 20 rad a step at the end of a soft spring."""
    world = far_floor(open_space(gravity=None))
    bob = circle(world, (0.1, 0.0), radius=0.01, velocity=(0.0, speed))
    world.add(bob, Spring(rest_length=0.1, stiffness=10.0))
    return world


def flung() -> World:
    return whirled(1e4)


@pytest.mark.parametrize(("build", "by_it"), [(pressed, False), (whirled, False), (flung, True)])
def test_a_spring_that_turns_or_shortens_fast_takes_shorter_steps_then_dop853(
    build: Callable[[], World], by_it: bool
) -> None:
    followed: list[int] = []
    follow = SplitPart._follow

    def counted(self: SplitPart, *arguments: Any) -> int:
        followed.append(1)
        return follow(self, *arguments)

    with patch.object(split_forces.SplitPart, "_follow", counted):
        found = after(build, 0.5)
    assert 0 < len(followed) < 240 if by_it else not followed
    assert np.abs(found - after(build, 0.5, adaptive=True)).max() < 1e-5


def test_energy_is_kept_where_a_spring_is_pressed_together() -> None:
    world = pressed()
    before = measure_energy(world).total
    world.run(seconds=5.0)
    assert measure_energy(world).total == pytest.approx(before, rel=1e-6)


def test_a_flow_that_cannot_be_made_changes_nothing() -> None:
    world = flung()
    split = split_of(world)
    with world.active():
        split.begin(world, world.simulation.dt)
        before = bits(world)
        (part,) = split.parts
        assert part.springs is not None
        flow = fallback_of(flow_springs)
        found = flow(Motion(*motion_of(world)), Springs(*part.springs.arrays), 1e-3, world.account.table)
    assert found == TURNS_FAST and not world.account.table.any()
    assert bits(world) == before


# ---- dampers, arms, drag -----------------------------------------------------------------------------------


def with_both(world: World) -> None:
    with_damper(world)
    with_anchor(world)
    world.spawn(Spring(11, 5, (0.02, 0.03), (0.0, 0.05), rest_length=1.5, stiffness=40.0, damping=0.3))


def with_all(world: World) -> None:
    with_both(world)
    with_drag(world)
    world.add(4, Drag(linear=0.3))
    with_damping(world)


@pytest.mark.parametrize("change", [with_damper, with_anchor, with_both, with_drag, with_damping, with_all])
def test_dampers_and_what_turns_bodies_are_followed_as_well(change: Callable[[World], None]) -> None:
    def build() -> World:
        world = chain(height=50.0)
        world.spawn(Spring(2, None, anchor_b=(0.0, 51.0), rest_length=1.0, stiffness=50.0, damping=0.1))
        change(world)
        return world

    world = build()
    assert follows(world) and world.plan.split_forces is SPRING_SPLITTING
    flow, followed = (after(build, 0.5, adaptive=way) for way in (False, True))
    assert 0.0 < np.abs(flow - followed).max() < 1e-5
    world.run(seconds=0.5)
    account = measure_account(world)
    assert not world.stepper.hooks  # type: ignore[union-attr]
    assert account.energy["damping"] < -1e-3
    assert abs(account.energy["numerical"]) < 1e-7
    assert abs(account.momentum["numerical"]) < 1e-12 and abs(account.angular_momentum["numerical"]) < 1e-7


@pytest.mark.parametrize("drag", [0.0, 3.0])
def test_with_a_damper_and_an_arm_the_order_is_four(drag: float) -> None:
    def at_end(substeps: int) -> Any:
        world = far_floor(open_space())
        world.simulation = replace(world.simulation, dt=0.5, substeps=substeps)
        bob = box(world, (1.2, 0.0), width=0.2, height=0.1, mass=1.0, angular_velocity=1.0)
        world.add(bob, Spring(anchor_a=(0.1, 0.05), rest_length=1.0, stiffness=40.0, damping=2.0))
        world.add(bob, Drag(linear=drag))
        with patch.object(spring_flow, "_SERIES", 1e-15):
            assert split_of(world).parts[0].springs is not None and split_of(world).parts[0].steps == 1
        world.run(seconds=1.0)
        return np.array((*place(world, bob), world.component(bob, Transform).angle))

    exact = at_end(256)
    coarse, fine = (np.abs(at_end(substeps) - exact).max() for substeps in (32, 64))
    assert math.log2(coarse / fine) == pytest.approx(4, abs=0.2)


@pytest.mark.parametrize(("drag", "damping"), [(0.6, 0.0), (0.0, 0.3), (0.4, 0.1)])
def test_an_oscillator_in_drag_is_followed_to_the_formula(drag: float, damping: float) -> None:
    """By x = e^(-rate t / 2) (cos w t + rate / 2 w sin w t), for drag, damping of all motion, and both."""
    world = far_floor(open_space(gravity=None))
    world.physics = replace(world.physics, linear_damping=damping)
    ball = circle(world, (1.0, 0.0), radius=0.1, mass=2.0)
    world.add(ball, Drag(linear=drag))
    world.add(ball, Spring(rest_length=0.0, stiffness=50.0))
    assert follows(world)
    rate = 0.5 * drag + damping
    swing = math.sqrt(25.0 - 0.25 * rate * rate)
    world.run(seconds=2.0)
    expected = math.exp(-rate) * (math.cos(2.0 * swing) + 0.5 * rate / swing * math.sin(2.0 * swing))
    assert place(world, ball).x == pytest.approx(expected, abs=3e-8)
    account = measure_account(world)
    assert abs(account.energy["numerical"]) < 1e-6 and account.energy["damping"] < -5.0
    assert account.momentum["damping"].x == pytest.approx(-2.0 * rate * (expected - 1.0), abs=1e-7)


@pytest.mark.parametrize(("linear", "quadratic"), [(2.0, 0.0), (0.0, 1.5)])
def test_drag_alone_is_followed_to_the_formula(linear: float, quadratic: float) -> None:
    world = far_floor(open_space(gravity=None))
    ball = circle(world, (0.0, 0.0), radius=0.1, mass=2.0, velocity=(10.0, 0.0), angular_velocity=1.0)
    world.add(ball, Drag(linear=2.0 * linear, quadratic=2.0 * quadratic))
    assert follows(world)
    world.run(seconds=1.0)
    way = math.log1p(quadratic * 10.0) / quadratic if quadratic else 10.0 * -math.expm1(-linear) / linear
    assert place(world, ball).x == pytest.approx(way, rel=1e-8)
    assert world.component(ball, Transform).angle == pytest.approx(1.0, rel=1e-12)
    assert abs(measure_account(world).energy["numerical"]) < 1e-5


# ---- bits --------------------------------------------------------------------------------------------------


@given(
    ends=st.lists(st.tuples(st.integers(0, 12), st.integers(0, 12)), max_size=60), moving=st.integers(0, 13)
)
def test_no_two_springs_of_a_block_pull_at_one_body(ends: list[tuple[int, int]], moving: int) -> None:
    pairs = np.array([(a, b) for a, b in ends if a != b], np.int64).reshape(-1, 2)
    moves = np.arange(13) < moving
    order = spring_flow._in_blocks(pairs[:, 0], pairs[:, 1], moving)
    assert sorted(order[order >= 0].tolist()) == list(range(len(pairs)))
    for block in order.reshape(-1, 8):
        held = [end for spring in block[block >= 0] for end in pairs[spring] if moves[end]]
        assert len(held) == len(set(held))


def test_a_run_has_the_bits_of_its_steps_and_of_a_file_between() -> None:
    whole, single = chain(), chain()
    whole.run(steps=90)
    for _ in range(45):
        single.step()
    again = read_scene(json.loads(json_text(write_scene(single))))
    for _ in range(45):
        single.step()
        again.step()
    assert whole.contacts.count > 0
    assert bits(whole) == bits(single) == bits(again)


def test_in_free_motion_the_order_of_entities_changes_no_bit() -> None:
    one, other = (chain(order, height=50.0) for order in (1, -1))
    for world in (one, other):
        world.run(seconds=1.0)
    ends = [sorted(world.table(Transform)["position"][2:12].tolist()) for world in (one, other)]
    assert follows(one) and ends[0] == ends[1]


def held_up() -> World:
    """Return a chain that hangs from a turned fixed body and a point, with a held end."""
    world = chain()
    post = world.spawn(Transform((0.0, 2.0), 0.3), name="post")
    world.spawn(Spring(post, 2, (0.1, 0.2), rest_length=1.0, stiffness=50.0), name="rope")
    world.spawn(Spring(11, None, anchor_b=(2.0, 2.0), rest_length=1.0, stiffness=50.0))
    world.add(5, Drag(linear=0.2))
    return world


def edit_gravity(world: World) -> None:
    world.physics = replace(world.physics, gravity=Vector2(1.0, -3.0))


def edit_spring(world: World) -> None:
    world.component(world.entity("rope"), Spring).stiffness = 80.0


def edit_anchor(world: World) -> None:
    world.component(world.entity("rope"), Spring).anchor_a = (0.2, -0.1)


def edit_post(world: World) -> None:
    world.component(world.entity("post"), Transform).position = (0.5, 2.5)


def edit_angle(world: World) -> None:
    world.component(world.entity("post"), Transform).angle = 1.0


def edit_place(world: World) -> None:
    world.component(5, Transform).position = (1.0, 0.6)


def edit_mass(world: World) -> None:
    world.component(6, Mass).mass = 0.3


def edit_damper(world: World) -> None:
    world.component(world.entity("rope"), Spring).damping = 0.5


def edit_drag(world: World) -> None:
    world.component(5, Drag).linear = 0.3


@pytest.mark.parametrize(
    "edit",
    [
        edit_gravity, edit_spring, edit_anchor, edit_post, edit_angle, edit_place, edit_mass, edit_damper,
        edit_drag, with_damping,
    ],
)  # fmt: skip
def test_an_edit_acts_as_in_a_world_that_begins_with_it(edit: Callable[[World], None]) -> None:
    world = held_up()
    world.run(steps=5)
    unedited = read_scene(json.loads(json_text(write_scene(world))))
    edit(world)
    fresh = read_scene(json.loads(json_text(write_scene(world))))
    for each in (world, fresh, unedited):
        each.run(steps=5)
    assert bits(world) == bits(fresh) != bits(unedited)


def test_the_bench_chains_take_few_evaluations_and_none_by_dop853() -> None:
    world = chains(10)
    world.run(steps=20)
    before = world.force_evaluations
    with patch.object(split_forces, "DOP853", None):
        world.run(steps=20)
    assert world.force_evaluations - before == 20 * (8 * 5 + 4)  # and one a substep for the contacts


# ---- groups ------------------------------------------------------------------------------------------------


def with_fast_pair(stiffness: float, damping: float) -> World:
    """Return a chain on a floor, and far above two discs on a spring of their own."""
    world = chain()
    a, b = (circle(world, (x, 50.0), radius=0.1, mass=0.01, velocity=(0.1, 0.0)) for x in (-0.51, 0.5))
    world.spawn(Spring(a, b, rest_length=1.0, stiffness=stiffness, damping=damping))
    return world


@pytest.mark.parametrize(("stiffness", "damping"), [(1e4, 0.0), (1e4, 0.5), (1.0, 2e3), (1e12, 0.0)])
def test_a_fast_spring_changes_no_bit_of_what_slow_ones_do(stiffness: float, damping: float) -> None:
    world, alone = with_fast_pair(stiffness, damping), chain()
    rows = slice(1, 12)
    for one in (world, alone):
        one.run(seconds=0.5)
    assert len(split_of(world).parts) == 2 and len(split_of(alone).parts) == 1
    for kind, field in ((Transform, "position"), (Velocity, "linear")):
        assert np.array_equal(world.table(kind)[field][rows], alone.table(kind)[field][rows])
    account, without = measure_account(world), measure_account(alone)
    stored = 0.5 * stiffness * 0.01**2  # 1e-6 J, and what it is rounded to
    assert account.energy["numerical"] == pytest.approx(
        without.energy["numerical"], abs=1e-6 + 1e-12 * stored
    )
    assert abs(account.momentum["numerical"]) < 1e-12


@pytest.mark.parametrize(("light", "arm"), [(1.0, 0.0), (0.01, 0.0), (0.01, 0.08)])
def test_rates_of_a_net_are_those_of_the_fastest_shape_that_it_may_have(light: float, arm: float) -> None:
    """Springs of random directions, and springs that act alike on both ends: the largest singular values."""
    world, random = far_floor(open_space()), np.random.default_rng(3)
    masses = [light if i == 6 else 1.0 + 0.1 * i for i in range(16)]
    net = [circle(world, (i % 4, i // 4), radius=0.1, mass=mass) for i, mass in enumerate(masses)]
    ends = [(i, i + 1) for i in range(16) if i % 4 < 3] + [(i, i + 4) for i in range(12)]
    strong = random.uniform(10.0, 100.0, len(ends))
    for (a, b), k in zip(ends, strong.tolist(), strict=True):
        world.spawn(
            Spring(net[a], net[b], (arm, 0.0), (0.0, arm), rest_length=1.0, stiffness=k, damping=1e-3 * k)
        )
    world.synchronise()
    (group,) = spring_groups(world, world.schedule.forces, np.ones(len(world.bodies.inverse_mass), np.bool_))
    moves = world.bodies.inverse_mass > 0.0
    give = [world.bodies.inverse_mass[moves], world.bodies.inverse_inertia[moves]]

    def fastest(any_way: bool) -> float:
        """Return the rate where springs have random directions, or pull alike at both ends."""
        stretch = np.zeros((len(ends), 3, 16))
        for k, (row, pair) in enumerate(zip(stretch, ends, strict=True)):
            turn, *turns = random.uniform(0.0, 2.0 * math.pi, 3)
            for end, at, sign in zip(pair, turns, (-1.0, 1.0), strict=True):
                row[:, end] = sign * math.cos(turn), sign * math.sin(turn), sign * arm * math.sin(turn - at)
                if not any_way:
                    row[:, end] = 1.0, 0.0, arm
            row *= math.sqrt(strong[k])
        scaled = stretch * np.sqrt(np.stack((give[0], *give)))
        return float(np.linalg.norm(scaled.reshape(len(ends), -1), 2))

    assert max(fastest(True) for _ in range(20)) <= group.rate
    assert fastest(False) <= group.rate < 1.03 * fastest(False)


@pytest.mark.parametrize("damping", [0.0, 2e3])
def test_springs_too_fast_for_steps_leave_the_others_in_the_loop(damping: float) -> None:
    world = with_fast_pair(1e12 if damping == 0.0 else 1.0, damping)
    loop, other = split_of(world).parts
    assert loop.springs is not None and other.springs is None
    assert other.method is IMPLICIT_MIDPOINT is world.plan.beyond
    assert "implicit_midpoint for the rest" in world.plan.reason
    again = read_scene(write_scene(world))
    for one in (world, again):
        one.run(seconds=0.2)
    assert bits(world) == bits(again)


@pytest.mark.parametrize(("bodies", "followed"), [(10, False), (200, True)])
def test_a_large_net_may_take_more_steps_than_a_small_one(bodies: int, followed: bool) -> None:
    """The other method has equations for all of it: with thousands of bodies a step took 31 s."""
    places = []
    for substeps in (4, 8):
        world = far_floor(open_space(substeps=substeps))
        net = [circle(world, (0.3 * i, 0.0), radius=0.1, mass=1.0) for i in range(bodies)]
        for a, b in pairwise(net):
            strong = 2e4 if a == net[0] else 0.0
            world.spawn(Spring(a, b, rest_length=0.25, stiffness=100.0, damping=strong))
        world.synchronise()
        rows = np.ones(len(world.bodies.inverse_mass), np.bool_)
        (group,) = spring_groups(world, world.schedule.forces, rows)
        assert (group.steps > 0) == followed
        world.run(seconds=0.1)
        places.append(world.table(Transform)["position"].copy())
    assert np.allclose(places[0], places[1], rtol=0.0, atol=1e-6)


def test_a_fast_pair_is_where_it_is_by_itself() -> None:
    """Two discs on a spring of 1e4 N/m swing by cos(w t), whatever the steps of others."""
    world = with_fast_pair(1e4, 0.0)
    world.physics = replace(world.physics, gravity=Vector2(0.0, 0.0))
    world.run(seconds=0.2)
    *_, left, right = world.batch(Velocity).entities.tolist()
    apart = place(world, right).x - place(world, left).x
    assert apart == pytest.approx(1.0 + 0.01 * math.cos(math.sqrt(2e6) * 0.2), abs=1e-6)


def test_what_drag_brakes_from_any_speed_slows_by_the_formula() -> None:
    """By v = v0 / (1 + c v0 t), from 1e9 m/s on: steps grow as it slows."""
    world = far_floor(open_space(gravity=None))
    ball = circle(world, (0.0, 0.0), radius=0.1, mass=1.0, velocity=(1e9, 0.0))
    world.add(ball, Drag(quadratic=1.0))
    world.run(seconds=1.0)
    assert world.component(ball, Velocity).linear.x == pytest.approx(1e9 / (1.0 + 1e9), rel=1e-6)
    assert place(world, ball).x == pytest.approx(math.log1p(1e9), rel=1e-6)


# ---- terms -------------------------------------------------------------------------------------------------


def damped_chain(light: float) -> World:
    """Return a chain of 64 discs with dampers, far above a floor, of which the first may be light [kg]."""
    world = far_floor(open_space())
    row = [
        circle(world, (0.25 * i, 0.02 * (i % 3)), radius=0.1, mass=0.1 if i else light, velocity=(0.0, i % 2))
        for i in range(64)
    ]
    for a, b in pairwise(row):
        world.spawn(Spring(a, b, rest_length=0.25, stiffness=30.0, damping=0.4))
    return world


def test_far_from_a_fast_damper_springs_have_as_few_terms_as_without_it() -> None:
    def terms(light: float) -> Any:
        world = damped_chain(light)
        (part,) = split_of(world).parts
        assert part.springs is not None
        h = 0.5 * world.simulation.dt / world.simulation.substeps
        springs = np.stack(spring_ends(world))
        return series_terms(world, springs, np.array((0.35 * h,)), 1e-10)[0][0]

    even, fast = terms(0.1), terms(0.002)
    assert fast[0] >= 7 > even.max()
    assert (np.diff(fast[:8]) <= 0).all() and (fast[8:] == even[8:]).all()


def test_terms_that_are_left_out_change_nothing_that_counts() -> None:
    def at_end(left_out: float) -> tuple[Any, float]:
        world = damped_chain(0.002)
        with patch.object(spring_flow, "_SERIES", left_out):
            assert follows(world)
        world.run(seconds=0.2)
        return world.table(Transform)["position"].copy(), measure_account(world).energy["damping"]

    (places, taken), (exact, all_taken) = at_end(1e-10), at_end(1e-17)
    assert all_taken < -0.1
    assert 0.0 < np.abs(places - exact).max() < 1e-10
    assert taken == pytest.approx(all_taken, rel=1e-8)
