"""What springs and drag act on beside contacts moves as their forces have it, however stiff they are."""

import math
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pytest
from desk import bits
from hypothesis import example, given, settings
from hypothesis import strategies as st

from physicslab import load_scene
from physicslab.components import Charge, Drag, Held, Mass, Molecule, Shape, Spring, Transform, Velocity
from physicslab.diagnostics.energy import measure_account, measure_energy, measure_momentum
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.files.scene import read_scene, write_scene
from physicslab.integrators.dop853 import DOP853
from physicslab.integrators.implicit_midpoint import IMPLICIT_MIDPOINT
from physicslab.integrators.spring_splitting import SPRING_SPLITTING
from physicslab.lab import worlds
from physicslab.lab.worlds import floor, place
from physicslab.prefabs import box, circle
from physicslab.stepping.soft import Soft
from physicslab.world import World

open_space = partial(worlds.open_space, contacts="soft")


def far_floor(world: World) -> World:
    """Return a world in which things could touch, and do not."""
    box(world, (0.0, -1e3), width=1.0, height=1.0, static=True)
    return world


def hung(stiffness: float, damping: float = 0.0) -> tuple[World, int]:
    world = far_floor(open_space(gravity=None))
    bob = circle(world, (0.0, -1.01), radius=0.1, velocity=(0.01, 0.0))
    world.add(bob, Spring(rest_length=1.0, stiffness=stiffness, damping=damping))
    return world, bob


@pytest.mark.parametrize(
    ("stiffness", "method"), [(50.0, SPRING_SPLITTING), (1e6, SPRING_SPLITTING), (1e12, IMPLICIT_MIDPOINT)]
)
def test_the_method_goes_by_the_stiffness_and_the_reason_says_so(stiffness: float, method: object) -> None:
    world, _ = hung(stiffness)
    world.synchronise()
    assert world.plan.split_forces is not None
    assert world.plan.split_forces is method
    assert "between contacts bodies with springs or drag move by" in world.plan.reason
    assert ("too fast to be followed" in world.plan.reason) == (method is IMPLICIT_MIDPOINT)


def test_dampers_and_linear_drag_are_followed_by_the_same_splitting_and_drag_by_the_square_is_not() -> None:
    world, bob = hung(50.0, damping=1.0)
    world.add(bob, Drag(linear=0.1))
    world.synchronise()
    assert world.plan.split_forces is SPRING_SPLITTING
    world.component(bob, Drag).quadratic = 0.1
    world.synchronise()
    assert world.plan.split_forces is DOP853


def test_a_method_chosen_by_name_is_used() -> None:
    world = far_floor(open_space(integrator="leapfrog"))
    circle(world, (0.0, 0.0), radius=0.1)
    world.spawn(Spring(2, None, stiffness=10.0))
    world.synchronise()
    assert world.plan.split_forces is None
    assert not world.bodies.sub_integrated.any()


def test_what_no_spring_holds_is_not_sub_integrated() -> None:
    world, bob = hung(50.0)
    free = circle(world, (5.0, 0.0), radius=0.1)
    world.synchronise()
    assert world.bodies.sub_integrated[world.entity_index.row_of[bob]]
    assert not world.bodies.sub_integrated[world.entity_index.row_of[free]]


@given(rate=st.floats(0.1, 6000.0), start=st.floats(0.001, 0.4))
@example(rate=331.30859375, start=0.001953125)  # a floor 1 km away was the measure of errors
@pytest.mark.parametrize("contacts", ["soft", "auto"])
@settings(max_examples=15, deadline=None)
def test_an_oscillation_is_that_of_the_formula(contacts: str, rate: float, start: float) -> None:
    world = far_floor(open_space(gravity=None, contacts=contacts))
    bob = circle(world, (1.0 + start, 0.0), radius=0.1)
    world.add(bob, Spring(rest_length=1.0, stiffness=rate**2))
    world.run(seconds=0.5)
    assert place(world, bob).x == pytest.approx(1.0 + start * math.cos(0.5 * rate), abs=1e-8 * rate * start)


def test_the_scene_beside_it_moves_as_it_would_without() -> None:
    def fallen(sub_integrated: bool) -> float:
        world = far_floor(open_space())
        ball = circle(world, (0.0, 0.0), radius=0.1)
        if sub_integrated:
            circle(world, (5.0, 0.0), radius=0.1)
            world.spawn(Spring(3, None, anchor_b=(5.0, 1.0), rest_length=1.0, stiffness=1e4))
        world.run(seconds=1.0)
        return place(world, ball).y

    assert fallen(True) == fallen(False)


@pytest.mark.parametrize("stiffness", [10.0, 1e3, 1e5, 1e7, 1e9])
@pytest.mark.parametrize("contacts", ["soft", "auto"])
def test_what_a_spring_presses_on_the_floor_stays_there(contacts: str, stiffness: float) -> None:
    world = open_space(contacts=contacts)
    floor(world)
    block = box(world, (0.0, 0.5), width=1.0, height=1.0, mass=1.0)
    world.add(block, Spring(None, None, (0.0, 0.0), (0.0, 2.5), 2.0 + 100.0 / stiffness, stiffness))
    world.run(seconds=3.0)
    assert place(world, block).y == pytest.approx(0.5, abs=0.003)
    assert place(world, block).x == pytest.approx(0.0, abs=1e-4)
    assert world.component(block, Velocity).linear.magnitude < 1e-4


@pytest.mark.parametrize("contacts", ["soft", "auto"])
def test_drag_brings_a_body_to_its_limit_beside_contacts(contacts: str) -> None:
    for coefficient in (0.5, 1e6, 1e12):
        world = far_floor(open_space(contacts=contacts))
        ball = circle(world, (0.0, 0.0), radius=0.1, mass=1.0)
        world.add(ball, Drag(linear=coefficient))
        lowest = 0.0
        for _ in world.stepping(seconds=20.0 if coefficient < 1.0 else 1.0):
            lowest = min(lowest, world.component(ball, Velocity).linear.y)
        limit = -9.81 / coefficient
        assert lowest >= limit * (1.0 + 1e-9)
        assert world.component(ball, Velocity).linear.y == pytest.approx(limit, rel=1e-3)


def test_two_bodies_on_a_spring_keep_their_momentum_through_collisions() -> None:
    world = open_space(gravity=None)
    a = circle(world, (0.0, 0.0), radius=0.2, mass=1.0, velocity=(4.0, 0.0))
    b = circle(world, (1.0, 0.0), radius=0.2, mass=3.0)
    circle(world, (3.0, 0.1), radius=0.4, mass=2.0, restitution=1.0)
    world.spawn(Spring(a, b, rest_length=1.0, stiffness=1e4))
    before = measure_momentum(world)
    world.run(seconds=6.0)
    after = measure_momentum(world)
    assert world.collisions > 0
    assert after.linear.x == pytest.approx(before.linear.x, rel=1e-12)
    assert after.linear.y == pytest.approx(before.linear.y, rel=1e-12)
    assert after.angular == pytest.approx(before.angular, abs=1e-3)  # overlapping, the two arms differ


def test_an_elastic_bob_that_hits_a_wall_keeps_its_energy() -> None:
    world = open_space()
    box(world, (-0.7, -1.0), width=1.0, height=4.0, static=True, restitution=1.0, friction=0.0)
    bob = circle(world, (0.8, -0.6), radius=0.2, restitution=1.0, friction=0.0)
    world.add(bob, Spring(rest_length=1.0, stiffness=1e4))
    before = measure_energy(world).total
    world.run(seconds=10.0)
    assert world.collisions > 5
    assert measure_energy(world).total == pytest.approx(before, abs=0.005 * abs(before))


def test_a_held_end_pulls_the_other_along() -> None:
    world = far_floor(open_space(gravity=None))
    hand = circle(world, (0.0, 0.0), radius=0.1)
    load = circle(world, (1.0, 0.0), radius=0.1)
    world.add(hand, Held())
    world.component(hand, Velocity).linear = (-1.0, 0.0)
    world.spawn(Spring(hand, load, rest_length=1.0, stiffness=1e4, damping=50.0))
    world.run(seconds=2.0)
    assert place(world, hand).x == pytest.approx(-2.0)
    assert place(world, load).x == pytest.approx(-1.0, abs=0.01)


def test_a_spring_changed_by_hand_is_followed_from_the_next_step() -> None:
    world, bob = hung(50.0)
    world.run(steps=2)
    world.component(bob, Spring).stiffness = 1e12
    world.step()
    assert world.plan.split_forces is IMPLICIT_MIDPOINT


def test_planets_on_springs_beside_contacts_are_all_followed() -> None:
    world = open_space(physics=PhysicsConfig(gravity_mode="planet", G=1.0))
    a = circle(world, (0.0, 0.0), radius=0.1, mass=1.0)
    b = circle(world, (2.0, 0.0), radius=0.1, mass=1.0)
    circle(world, (0.0, 5.0), radius=0.1, mass=1.0)
    world.spawn(Spring(a, b, rest_length=1.8, stiffness=100.0))
    before = measure_energy(world).total
    world.run(seconds=2.0)
    assert world.bodies.sub_integrated[1:4].all()
    assert measure_energy(world).total == pytest.approx(before, rel=1e-9)


@pytest.mark.parametrize("part", [Molecule(depth=1.0, distance=0.4), Charge(0.1)])
def test_what_is_no_molecule_and_has_no_charge_is_not_followed_with_those(part: Any) -> None:
    world = far_floor(open_space(gravity=None))
    world.physics = replace(world.physics, coulomb_constant=1.0)
    bodies = [circle(world, (0.5 * n, 0.0), radius=0.1) for n in range(4)]
    for body in bodies[:2]:
        world.add(body, type(part)(**{spec.name: getattr(part, spec.name) for spec in part.FIELDS}))
    world.add(bodies[0], Drag(linear=0.1))
    world.synchronise()
    rows = [world.entity_index.row_of[body] for body in bodies]
    assert world.bodies.sub_integrated[rows].tolist() == [True, True, False, False]


def test_the_same_scene_gives_the_same_bits() -> None:
    ends = []
    for _ in range(2):
        world, _ = hung(1e5, damping=3.0)
        floor(world, place(world, 2))
        world.run(seconds=1.0)
        ends.append(world.table(Transform)["position"].copy())
    assert np.array_equal(ends[0], ends[1])


def test_a_heavy_load_makes_substeps_finer_and_its_taking_away_coarser() -> None:
    world = open_space()
    floor(world)
    box(world, (0.0, 0.5), width=1.0, height=1.0, mass=1.0)
    load = box(world, (0.0, 1.5), width=1.0, height=1.0, mass=1e3)
    world.run(steps=10)
    assert world.substeps > world.simulation.substeps
    world.remove(load)
    world.run(steps=2)
    assert world.substeps == world.simulation.substeps


def test_what_rests_on_a_heavy_body_makes_no_substep_shorter() -> None:
    world = open_space()
    floor(world)
    box(world, (0.0, 0.5), width=1.0, height=1.0, mass=1e6)
    box(world, (0.0, 1.5), width=1.0, height=1.0, mass=1.0)
    world.run(steps=10)
    assert world.substeps == world.simulation.substeps
    assert world.component(2, Mass).mass == 1e6


def test_drag_that_grows_weak_is_the_same_after_a_file_was_read() -> None:
    """Which velocities are predicted depends on the present speed, not on that when the method was chosen."""

    def scene() -> World:
        world = open_space()
        world.physics = PhysicsConfig(gravity=Vector2(3.0, -0.001))
        world.simulation = replace(world.simulation, substeps=2, tolerance=1e-17)
        place_a, place_b = (-5.683359695054904, 8.313973959108061), (-2.4772582822726985, 7.352490614885854)
        world.spawn(
            Transform(place_a), Velocity((20.94073693253929, 0.0), 1.430870345505193),
            Mass(0.32792148824543155, inertia=0.017708834973736542),
            Shape.box(1.0625406781016786, 0.5283128537814351),
        )  # fmt: skip
        world.spawn(
            Transform(place_b), Velocity((0.0, 18.537204971876044)),
            Mass(0.2620544512615156, inertia=0.01401296614622271, fixed_rotation=True),
            Shape.box(0.9313780570931447, 0.5283128537814351),
            Drag(linear=0.1563714654652965, quadratic=1.6433704962900513),
        )  # fmt: skip
        return world

    whole, first = scene(), scene()
    whole.run(steps=120)
    first.run(steps=60)
    again = read_scene(write_scene(first))
    again.run(steps=60)
    assert bits(again) == bits(whole)


def test_dampers_of_what_is_sub_integrated_are_not_evaluated_again_for_their_work() -> None:
    world = load_scene("spring_chain")
    world.run(steps=3)
    assert isinstance(world.stepper, Soft) and world.stepper.substeps.split is not None
    assert "along the way" not in "".join(world.stepper.hooks), "their flow books it"
    account = measure_account(world)
    assert not world.stepper.hooks
    assert account.energy["damping"] < 0.0
    assert abs(account.energy["numerical"]) < 1e-5 * -account.energy["damping"]


@pytest.mark.parametrize("quadratic", [1e6, 1e9, 1e12, 1e15])
def test_what_falls_at_its_terminal_speed_goes_on_with_it_and_nothing_else_does(quadratic: float) -> None:
    """At 1e12 kg/m a frame took 3 s; at 1e15 the other body went on at the speed that it had."""
    world = World(simulation=SimulationConfig(contacts="soft", collisions="step"))
    box(world, (0.0, -9.0), width=9.0, height=1.0, static=True)
    ball = circle(world, (0.0, 5.0), radius=0.2, mass=1.0, velocity=(3.0, 0.0))
    other = circle(world, (1.0, 5.0), radius=0.2, mass=1.0, velocity=(0.0, -1.0))
    for body, drag in ((ball, quadratic), (other, 0.5)):
        world.add(body, Drag(quadratic=drag))
    world.run(steps=2)
    before = world.component(ball, Transform).position
    world.run(steps=30)
    falls = math.sqrt(9.81 / quadratic)
    assert world.component(ball, Velocity).linear.y == pytest.approx(-falls, rel=1e-13)
    fallen = world.component(ball, Transform).position - before
    assert tuple(fallen) == pytest.approx((0.0, -0.5 * falls), rel=1e-9, abs=1e-12)
    terminal = math.sqrt(2.0 * 9.81)
    at = terminal * math.tanh(math.atanh(1.0 / terminal) + 9.81 * world.time / terminal)
    assert world.component(other, Velocity).linear.y == pytest.approx(-at, rel=1e-9)
    account = measure_account(world)
    assert abs(account.energy["numerical"]) < 1e-6 and account.momentum["numerical"].magnitude < 1e-10
