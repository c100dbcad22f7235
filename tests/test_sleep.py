"""Islands and sleeping: which bodies may stop being simulated, and what wakes them."""

import json
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from desk import bits
from hypothesis import given, settings
from hypothesis import strategies as st
from kept_contacts import kept_contacts

from physicslab.components import Drag, Held, Mass, Material, Rod, Shape, Spring, Thrust, Transform, Velocity
from physicslab.contacts.islands import export_rests, wake
from physicslab.contacts.report import contact_between, list_contacts
from physicslab.diagnostics.energy import measure_account, measure_energy, measure_momentum
from physicslab.diagnostics.free_body import contact_forces
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.files.json_text import json_text
from physicslab.files.scene import load_scene, read_scene, save_scene, write_scene
from physicslab.lab.worlds import floor, open_space
from physicslab.prefabs import box, circle, container, pendulum, pile, stack
from physicslab.state.state import State
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import ForceSystem, Stage, System, at
from physicslab.world import World


def resting_boxes(*places: float, friction: float = 0.5, **simulation: object) -> tuple[World, list[int]]:
    """Return a floor, and boxes of 1 m on it."""
    world = open_space(**{"sleeping": True, **simulation})  # type: ignore[arg-type]
    floor(world, friction=friction)
    boxes = [box(world, (x, 0.5), width=1.0, height=1.0, friction=friction) for x in places]
    return world, boxes


def sleeping_boxes(*places: float, friction: float = 0.5) -> tuple[World, list[int]]:
    """Return the same when all boxes sleep."""
    world, boxes = resting_boxes(*places, friction=friction)
    world.run(seconds=1.0)
    assert sleepers(world) == set(boxes)
    return world, boxes


def sleepers(world: World) -> set[int]:
    """Return the entities that sleep."""
    assert world.sleep.count == np.count_nonzero(world.sleep.asleep)
    return set(world.entity_index.entities[world.sleep.asleep].tolist())


# ---- which worlds sleep -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("sleeping", "boxes", "asleep"), [("auto", 64, 0), ("auto", 65, 65), (True, 1, 1), (False, 65, 0)]
)
def test_a_default_is_not_a_wish_and_a_file_keeps_each(sleeping: bool | str, boxes: int, asleep: int) -> None:
    world, _ = resting_boxes(*(1.5 * place for place in range(-32, boxes - 32)), sleeping=sleeping)
    assert SimulationConfig().sleeping == "auto"
    document = json.loads(json_text(write_scene(world)))
    assert document["simulation"]["sleeping"] is sleeping or sleeping == "auto"
    loaded = read_scene(document)
    assert loaded.simulation.sleeping == sleeping
    loaded.run(seconds=1.0)
    assert len(sleepers(loaded)) == asleep


def test_a_world_that_has_become_one_of_few_bodies_wakes() -> None:
    world, boxes = resting_boxes(*(1.5 * place for place in range(-32, 33)), sleeping="auto")
    world.run(seconds=1.0)
    assert len(sleepers(world)) == 65
    world.remove(boxes[0])
    world.step()
    assert not sleepers(world)
    reasons = {left.name: left.reason for left in world.schedule.left_out}
    assert reasons["SleepSystem"] == "at most 64 bodies can move: simulating them costs little"


# ---- falling asleep ----------------------------------------------------------------------------------------


def test_half_a_second_of_rest_and_not_less() -> None:
    world, boxes = resting_boxes(0.0)
    world.run(steps=29)
    assert not sleepers(world)
    world.step()
    assert sleepers(world) == set(boxes)
    velocity = world.component(boxes[0], Velocity)
    assert (velocity.linear, velocity.angular) == (Vector2(), 0.0)


def test_a_sleeping_body_stays_where_it_is_and_its_contacts_are_still_reported() -> None:
    world, (first,) = sleeping_boxes(0.0)
    before, contact = bits(world), contact_between(world, 1, first)
    world.run(seconds=5.0)
    assert bits(world) == before
    assert contact is not None and contact_between(world, 1, first) == contact
    weight = sum(point.normal_impulse for point in contact.points) * 4 * 60
    assert weight == pytest.approx(9.81, rel=1e-3)
    assert world.contacts.count == 1 and world.contacts.max_penetration == contact.depth


def test_a_whole_island_sleeps_or_none_of_it() -> None:
    world, boxes = resting_boxes(0.0, 0.0)
    world.component(boxes[1], Transform).position = Vector2(0.0, 1.5)
    late = box(world, (0.0, 4.0), width=0.2, height=0.2, restitution=0.9, friction=0.5)
    world.component(boxes[1], Material).restitution = 0.9
    for _ in range(600):
        world.step()
        asleep = sleepers(world)
        assert asleep in (set(), set(boxes), {*boxes, late})
        touching = {end for contact in list_contacts(world) for end in (contact.a, contact.b)}
        if late in touching:
            assert (late in asleep) == (boxes[0] in asleep)
    assert asleep == {*boxes, late}


def test_two_that_do_not_touch_sleep_each_for_itself() -> None:
    world, boxes = resting_boxes(-5.0, 5.0)
    world.component(boxes[0], Velocity).linear = Vector2(2.0, 0.0)
    world.run(seconds=0.6)
    assert sleepers(world) == {boxes[1]}


def test_a_puck_on_ice_never_freezes() -> None:
    world, (puck,) = resting_boxes(0.0, friction=0.0)
    world.component(puck, Velocity).linear = Vector2(0.01, 0.0)
    world.run(seconds=10.0)
    assert not sleepers(world)
    assert world.component(puck, Transform).position.x == pytest.approx(0.1, rel=1e-9)


def test_a_slow_gas_never_freezes() -> None:
    laws = PhysicsConfig(gravity_mode="none", bounds=(-2.0, -2.0, 2.0, 2.0), bounds_friction=0.5)
    world = open_space(physics=laws, sleeping=True, collisions="step")
    for x in range(-3, 4):
        circle(world, (0.5 * x, 0.0), radius=0.2, velocity=(0.01 * x, 0.005), friction=0.5, restitution=1.0)
    world.run(seconds=10.0)
    assert not sleepers(world)


@pytest.mark.parametrize("lean", [0.002, 0.01, 0.05])
def test_a_box_on_its_edge_tips_over_before_it_sleeps(lean: float) -> None:
    world, (tipping,) = resting_boxes(0.0)
    transform = world.component(tipping, Transform)
    transform.angle, transform.position = 0.25 * math.pi + lean, Vector2(0.0, math.sqrt(0.5))
    world.run(seconds=6.0)
    assert sleepers(world) == {tipping}
    turned = transform.angle / (0.5 * math.pi)
    assert abs(turned - round(turned)) < 1e-3 and transform.position.y == pytest.approx(0.5, abs=2e-3)


def test_what_rides_on_a_lift_stays_awake_until_it_stands() -> None:
    world = open_space(sleeping=True)
    lift = world.spawn(
        Transform((0.0, -0.5)), Velocity((0.0, 0.02)), Shape.box(4.0, 1.0), Material(friction=0.5)
    )
    rider = box(world, (0.0, 0.5), width=1.0, height=1.0, friction=0.5)
    world.run(seconds=3.0)
    assert not sleepers(world)
    world.component(lift, Velocity).linear = Vector2()
    world.run(seconds=1.5)
    assert sleepers(world) == {rider}
    world.component(lift, Velocity).linear = Vector2(0.0, 0.5)
    world.run(seconds=1.0)
    assert not sleepers(world)
    assert world.component(rider, Transform).position.y == pytest.approx(0.5 + 0.06 + 0.5, abs=0.01)


def test_a_lift_that_starts_in_a_file_wakes_what_stands_on_it() -> None:
    world = open_space(sleeping=True)
    lift = world.spawn(Transform((0.0, -0.5)), Velocity(), Shape.box(4.0, 1.0), Material(friction=0.5))
    rider = box(world, (0.0, 0.5), width=1.0, height=1.0, friction=0.5)
    world.run(seconds=1.0)
    assert sleepers(world) == {rider}
    world.component(lift, Velocity).linear = Vector2(0.0, 0.3)
    again = read_scene(write_scene(world))
    for each in (world, again):
        each.run(seconds=0.25)
        assert not sleepers(each)
    assert bits(again) == bits(world)


@pytest.mark.parametrize("part", [Spring(anchor_b=(0.0, 3.0), stiffness=1.0), Drag(linear=0.1)])
def test_no_body_sleeps_on_which_a_spring_or_drag_acts(part: Spring | Drag) -> None:
    world, boxes = resting_boxes(0.0, 5.0)
    world.add(boxes[0], part)
    world.run(seconds=2.0)
    assert sleepers(world) <= {boxes[1]}
    if isinstance(part, Spring):
        assert sleepers(world) == {boxes[1]}


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"sleeping": False}, "sleeping is switched off"),
        ({"physics": PhysicsConfig(gravity_mode="planet")}, "planets attract each other"),
    ],
)
def test_it_is_left_out_with_a_reason(change: dict[str, object], reason: str) -> None:
    world = open_space(**{"sleeping": True, **change})  # type: ignore[arg-type]
    floor(world)
    box(world, (0.0, 0.5), width=1.0, height=1.0, friction=0.5)
    world.run(seconds=1.0)
    assert {left.name: left.reason for left in world.schedule.left_out}["SleepSystem"] == reason
    assert not sleepers(world)


def test_no_body_sleeps_where_impacts_are_located() -> None:
    world = open_space(sleeping=True, collisions="exact")
    floor(world, friction=0.5, restitution=0.5)
    circle(world, (0.0, 0.3), radius=0.25, friction=0.5, restitution=0.5)
    world.run(seconds=3.0)
    assert world.plan.collisions == "exact"
    reasons = {left.name: left.reason for left in world.schedule.left_out}
    assert reasons["SleepSystem"] == "impacts are located exactly"


def test_a_discs_pile_sleeps_out_of_its_blocks_and_wakes_into_them() -> None:
    world = open_space(sleeping=True)
    container(world, width=3.0, height=6.0)
    pile(world, 120, columns=12)
    world.run(seconds=4.0)
    contacts = world.contacts
    assert world.sleep.count == 120
    assert (contacts.wide.filled, contacts.active, contacts.scalar_count) == (0, 0, 0)
    assert contacts.count == contacts.sleeping_count > 200
    wake(world, world.sleep.asleep.copy())
    assert contacts.count > 200
    world.run(steps=2)
    assert contacts.wide.filled > 0.7 * contacts.count > 140


# ---- waking ------------------------------------------------------------------------------------------------


def impact_count(sleeping: bool) -> tuple[World, int, int]:
    """Return a box on a floor with hardly any friction, at rest for a second, and a ball about to hit it."""
    world, (target,) = resting_boxes(0.0, friction=1e-9, sleeping=sleeping)
    world.component(target, Material).restitution = 0.5
    world.run(seconds=1.0)
    ball = circle(world, (-1.0, 0.5), radius=0.3, velocity=(6.0, 0.0), mass=0.5, restitution=0.5)
    return world, target, ball


def test_a_blow_wakes_and_finds_the_bodys_own_mass() -> None:
    world, target, ball = impact_count(sleeping=True)
    awake, other, its_ball = impact_count(sleeping=False)
    assert sleepers(world) == {target}
    before = measure_momentum(world).linear.x
    for each in (world, awake):
        each.run(seconds=0.15)
    assert not sleepers(world)
    assert measure_momentum(world).linear.x == pytest.approx(before, rel=1e-6)
    for mine, theirs in ((target, other), (ball, its_ball)):
        speed, expected = (
            world.component(mine, Velocity).linear.x, awake.component(theirs, Velocity).linear.x
        )  # fmt: skip
        assert speed == pytest.approx(expected, abs=1e-3)
    assert world.component(target, Velocity).linear.x == pytest.approx(6.0 * 1.5 / 3.0, abs=1e-3)


def test_a_touch_far_up_wakes_all_of_a_tower_and_nothing_else() -> None:
    world, (beside,) = resting_boxes(20.0)
    tower = stack(world, 5)
    world.run(seconds=3.0)
    assert sleepers(world) == {beside, *tower}
    late = box(world, (0.1, 6.0), width=0.4, height=0.4, friction=0.5)
    while world.steps < 400 and tower[0] in sleepers(world):
        world.step()
    assert sleepers(world) == {beside}
    world.run(seconds=5.0)
    assert sleepers(world) == {beside, late, *tower}


def test_what_is_spawned_elsewhere_wakes_nothing() -> None:
    world, boxes = sleeping_boxes(0.0)
    circle(world, (8.0, 5.0), radius=0.2)
    box(world, (-8.0, 5.0), width=1.0, height=1.0, static=True)
    world.spawn(Transform((0.0, 0.5)), Velocity())
    world.run(steps=10)
    assert sleepers(world) == set(boxes)


def test_what_is_spawned_beside_a_joint_wakes_nothing() -> None:
    world, boxes = resting_boxes(0.0)
    pendulum(world, (-5.0, 5.0), length=1.0, angle=0.5)
    world.run(seconds=1.0)
    assert sleepers(world) == set(boxes)
    circle(world, (8.0, 5.0), radius=0.2)
    world.synchronise()
    assert sleepers(world) == set(boxes), "the table of joints has another length, and the same joint"


def change_velocity(world: World, first: int) -> None:
    world.component(first, Velocity).linear = Vector2(0.0, 1.0)


def change_place(world: World, first: int) -> None:
    world.component(first, Transform).position = Vector2(0.0, 2.0)


def change_angle(world: World, first: int) -> None:
    world.component(first, Transform).angle = 0.1


def change_size(world: World, first: int) -> None:
    world.component(first, Shape).width = 0.5


def change_mass(world: World, first: int) -> None:
    world.component(first, Mass).mass = 2.0


def change_material(world: World, first: int) -> None:
    world.component(first, Material).friction = 0.1


def hold(world: World, first: int) -> None:
    world.add(first, Held())


def add_spring(world: World, first: int) -> None:
    world.spawn(Spring(first, anchor_b=(0.0, 3.0), stiffness=1.0))


def change_laws(world: World, first: int) -> None:
    world.physics = replace(world.physics, gravity=Vector2(0.0, -5.0))


def change_steps(world: World, first: int) -> None:
    world.simulation = replace(world.simulation, substeps=5)


def move_floor(world: World, first: int) -> None:
    world.component(1, Transform).position = Vector2(0.0, -0.6)


def shrink_floor(world: World, first: int) -> None:
    world.component(1, Shape).width = 30.0


def grease_floor(world: World, first: int) -> None:
    world.component(1, Material).friction = 0.01


def remove_floor(world: World, first: int) -> None:
    world.remove(1)


def free_floor(world: World, first: int) -> None:
    world.add(1, Velocity())
    world.add(1, Mass(1.0))


def hollow_floor(world: World, first: int) -> None:
    world.discard(1, Shape)


def spawn_wall(world: World, first: int) -> None:
    box(world, (0.9, 0.5), width=1.0, height=1.0, static=True)


EDITS: list[Callable[[World, int], None]] = [
    change_velocity, change_place, change_angle, change_size, change_mass, change_material, hold, add_spring,
    change_laws, change_steps, move_floor, shrink_floor, grease_floor, remove_floor, free_floor, hollow_floor,
    spawn_wall,
]  # fmt: skip


@pytest.mark.parametrize("edit", EDITS, ids=lambda edit: edit.__name__)
def test_an_edit_wakes_what_it_affects(edit: Callable[[World, int], None]) -> None:
    world, (first,) = sleeping_boxes(0.0)
    edit(world, first)
    world.step()
    assert first not in sleepers(world)


@pytest.mark.parametrize("edit", [change_velocity, change_place, hold, spawn_wall])
def test_an_edit_of_one_body_lets_others_sleep(edit: Callable[[World, int], None]) -> None:
    world, (first, second) = sleeping_boxes(0.0, 8.0)
    edit(world, first)
    world.step()
    assert sleepers(world) == {second}


def test_removing_a_support_wakes_what_lay_on_it() -> None:
    world, (beside,) = resting_boxes(20.0)
    tower = stack(world, 4)
    world.run(seconds=3.0)
    world.remove(tower[0])
    world.step()
    assert sleepers(world) == {beside}
    world.run(seconds=3.0)
    assert world.component(tower[1], Transform).position.y == pytest.approx(0.5, abs=0.01)


def test_a_wall_that_a_system_moves_within_steps_wakes_what_leaned_on_it() -> None:
    class Mover(System):
        by = 0.0

        @at(Stage.PREPARE)
        def move(self, world: World, h: float) -> None:
            world.table(Transform)["position"][1, 1] += self.by

    world, boxes = resting_boxes(0.0)
    mover = Mover()
    world.install(mover)
    world.run(seconds=1.0)
    assert sleepers(world) == set(boxes)
    mover.by = -0.01
    world.run(steps=2)
    assert not sleepers(world)


class Wind(ForceSystem):
    """Pushes everything to the right with a given force."""

    strength = 0.0

    @at(Stage.FORCE)
    def blow(self, world: World, h: float) -> None:
        world.bodies.force[2:, 0] += self.strength


def test_a_force_wakes() -> None:
    wind = Wind()
    world = World(*standard_systems(), wind, simulation=SimulationConfig(sleeping=True))
    floor(world)
    first = box(world, (0.0, 0.5), width=1.0, height=1.0, friction=0.5)
    wind.strength = 0.5
    world.run(seconds=1.0)
    assert sleepers(world) == {first}
    world.run(seconds=1.0)
    assert sleepers(world) == {first}
    wind.strength = 20.0
    world.step()
    assert not sleepers(world)
    world.run(seconds=1.0)
    assert world.component(first, Velocity).linear.x > 5.0


def test_a_hand_that_comes_by_wakes_what_it_pushes() -> None:
    world, (first, second) = sleeping_boxes(0.0, 3.0)
    world.add(second, Held())
    world.component(second, Velocity).linear = Vector2(-2.0, 0.0)
    world.run(seconds=2.0)
    assert not sleepers(world)
    assert world.component(first, Transform).position.x < -1.5


def test_a_step_that_diverges_leaves_everybody_awake() -> None:
    world, boxes = sleeping_boxes(0.0)
    before = bits(world)
    doomed = circle(world, (9.0, 3.0), radius=0.1, velocity=(0.0, 1.7e308))
    world.component(doomed, Transform).position = Vector2(9.0, 1e300)
    with pytest.raises(ArithmeticError):
        world.run(seconds=2.0)
    assert not sleepers(world)
    world.remove(doomed)
    world.run(seconds=2.0)
    assert sleepers(world) == set(boxes)
    assert np.allclose(np.frombuffer(before)[:4], np.frombuffer(bits(world))[:4])


# ---- steps that are passed over ----------------------------------------------------------------------------


def test_where_everybody_sleeps_no_substep_is_made() -> None:
    world, _ = sleeping_boxes(0.0, 4.0)
    calls = {name: timing.calls for name, timing in world.schedule.timings.items()}
    evaluations, time = world.force_evaluations, world.time
    world.run(seconds=2.0)
    assert world.time == pytest.approx(time + 2.0) and world.steps == 180
    assert world.force_evaluations == evaluations
    for name in ("ResolveSystem", "GravitySystem", "IntegrateSystem", "BroadPhaseSystem"):
        assert world.schedule.timings[name].calls == calls[name]


def test_a_foreign_system_is_called_while_all_bodies_sleep() -> None:
    wind = Wind()
    world = World(*standard_systems(), wind, simulation=SimulationConfig(sleeping=True))
    floor(world)
    box(world, (0.0, 0.5), width=1.0, height=1.0, friction=0.5)
    world.run(seconds=1.0)
    calls = world.schedule.timings["Wind"].calls
    world.run(steps=3)
    assert world.schedule.timings["Wind"].calls == calls + 12


# ---- files -------------------------------------------------------------------------------------------------


def assert_goes_on_alike(world: World, steps: int) -> World:
    """Assert that a world read from its file goes on with the same bits; return it."""
    document = write_scene(world)
    again = read_scene(json.loads(json_text(document)))
    assert json_text(write_scene(again)) == json_text(document)
    for _ in range(steps):
        world.step()
        again.step()
        assert bits(again) == bits(world)
    assert json_text(write_scene(again)) == json_text(write_scene(world))
    assert (again.contacts.count, again.sleep.count) == (world.contacts.count, world.sleep.count)
    return again


@pytest.mark.parametrize("before", [20, 45, 70, 150])
def test_a_world_in_which_some_sleep_goes_on_from_a_file_bit_for_bit(before: int) -> None:
    world, _ = resting_boxes(-4.0, 4.0)
    stack(world, 3)
    circle(world, (4.2, 6.0), radius=0.3, friction=0.5, restitution=0.4)
    world.run(steps=before)
    again = assert_goes_on_alike(world, 150)
    assert list_contacts(again) == list_contacts(world)


def test_a_pile_beside_a_sleeping_one_goes_on_from_a_file_bit_for_bit() -> None:
    world = open_space(sleeping=True)
    for middle, columns, higher in ((-4.0, 10, 0.0), (4.0, 10, 12.0)):
        container(world, (middle, 0.0), width=3.0, height=6.0)
        pile(world, 120, (middle, higher), columns=columns)
    while world.sleep.count < 120:
        world.step()
    assert world.contacts.wide.filled > 0 and world.sleep.count < 240
    assert_goes_on_alike(world, 60)


def test_a_fresh_world_has_no_rests_in_its_file() -> None:
    world, _ = resting_boxes(0.0)
    assert "rests" not in write_scene(world)
    world.run(steps=3)
    assert [len(rest) for rest in write_scene(world)["rests"]] == [3]
    world.run(seconds=1.0)
    assert [len(rest) for rest in write_scene(world)["rests"]] == [4]


def test_a_body_that_sleeps_in_the_air_in_a_file_wakes() -> None:
    world, (first,) = sleeping_boxes(0.0)
    document = write_scene(world)
    document["entities"][1]["Transform"]["position"] = [0.0, 3.0]
    again = read_scene(document)
    again.run(seconds=0.5)
    assert again.component(first, Transform).position.y < 2.5


def test_an_edit_before_a_file_is_written_is_not_lost() -> None:
    world, (first,) = sleeping_boxes(0.0)
    change_place(world, first)
    again = read_scene(write_scene(world))
    for each in (world, again):
        each.run(seconds=0.25)
    assert bits(again) == bits(world) and not sleepers(world)


# ---- properties --------------------------------------------------------------------------------------------

bodies = st.tuples(
    st.booleans(), st.floats(-3.0, 3.0), st.floats(0.3, 4.0), st.floats(0.1, 0.6), st.floats(0.1, 0.6),
    st.floats(-2.0, 2.0), st.floats(0.0, 0.6), st.floats(0.0, 1.0),
)  # fmt: skip


def thrown(given: list[tuple[float, ...]]) -> World:
    """Return bodies thrown together within bounds, late ones and heavy ones among them."""
    laws = PhysicsConfig(bounds=(-3.5, 0.0, 3.5, 8.0))
    world = open_space(physics=laws, sleeping=True, collisions="step")
    for disc, x, y, width, height, vx, restitution, friction in given:
        common = {"velocity": (vx, 0.0), "restitution": restitution, "friction": friction}
        if disc:
            circle(world, (x, y), radius=0.5 * width, **common)  # type: ignore[arg-type]
        else:
            box(world, (x, y), width=width, height=height, **common)  # type: ignore[arg-type]
    return world


class Onlooker(System):
    """Looks at every step, so that each is made stage by stage."""

    @at(Stage.FINISH)
    def look(self, world: World, h: float) -> None:
        """See that it is there."""


@settings(max_examples=15)
@given(st.lists(bodies, min_size=1, max_size=8), bodies)
def test_runs_steps_and_files_agree_while_bodies_sleep_and_wake(
    given: list[tuple[float, ...]], late: tuple[float, ...]
) -> None:
    stepped, ran = thrown(given), thrown(given)
    stepped.install(Onlooker())
    for world in (stepped, ran):
        world.run(steps=150)
        circle(world, (late[1], 5.0), radius=0.5 * late[3], velocity=(late[5], 0.0), friction=late[7])
        world.run(steps=60)
    assert bits(stepped) == bits(ran)
    assert kept_contacts(stepped.contacts) == kept_contacts(ran.contacts)
    assert export_rests(stepped) == export_rests(ran)
    again = read_scene(json.loads(json_text(write_scene(ran))))
    for world in (again, ran):
        world.run(steps=60)
    assert bits(again) == bits(ran)


@settings(max_examples=15)
@given(st.lists(bodies, min_size=1, max_size=8))
def test_sleeping_bodies_have_no_velocity_and_are_supported(given: list[tuple[float, ...]]) -> None:
    world = thrown(given)
    for _ in world.stepping(steps=240, stride=5):
        asleep, velocity = world.sleep.asleep, world.table(Velocity)
        assert not velocity["linear"][asleep].any() and not velocity["angular"][asleep].any()
        assert not (world.sleep.rest[asleep] > 0.0).any()
        near = world.contacts.manifolds[: world.contacts.recorded]
        touching = near[near["count"] > 0]
        one, other = asleep[touching["a"]], asleep[touching["b"]]
        movable = world.bodies.inverse_mass > 0.0
        both = movable[touching["a"]] & movable[touching["b"]]
        assert (one == other)[both].all()
        assert np.isin(np.flatnonzero(asleep), np.concatenate((touching["a"], touching["b"]))).all()


def test_falling_asleep_costs_no_more_energy_than_the_speed_allows() -> None:
    world = open_space(sleeping=True)
    floor(world)
    stack(world, 6)
    while not world.sleep.count:
        before = measure_energy(world).total
        world.step()
    assert abs(measure_energy(world).total - before) < 6 * 0.5 * 0.05**2


# ---- motion that friction does not stop --------------------------------------------------------------------


def test_a_disc_that_rolls_slowly_rolls_on() -> None:
    world = open_space(sleeping=True, collisions="step")
    floor(world, friction=0.5)
    disc = circle(world, (0.0, 0.5), radius=0.5, velocity=(0.02, 0.0), friction=0.5)
    world.component(disc, Velocity).angular = -0.04
    world.run(seconds=10.0)
    assert not sleepers(world)
    assert world.component(disc, Transform).position.x == pytest.approx(0.2, rel=1e-3)


@pytest.mark.parametrize("slope", [1e-4, 1e-3])
def test_a_disc_on_the_slightest_slope_rolls_down(slope: float) -> None:
    world = open_space(sleeping=True, collisions="step")
    box(world, (0.0, -0.5), width=60.0, height=1.0, angle=-slope, static=True, friction=0.5)
    disc = circle(world, (0.0, 0.5 + 0.5 * slope * slope), radius=0.5, friction=0.5)
    world.run(seconds=5.0)
    assert not sleepers(world)
    way = 0.5 * 9.81 * math.sin(slope) / 1.5 * 25.0
    assert world.component(disc, Transform).position.x == pytest.approx(way, rel=0.05)


def test_a_box_with_hardly_any_friction_slides_all_of_its_way() -> None:
    world, (slow,) = resting_boxes(0.0, friction=1e-3)
    world.component(slow, Velocity).linear = Vector2(0.045, 0.0)
    way = 0.045**2 / (2.0 * 1e-3 * 9.81)
    world.run(seconds=6.0)
    assert world.component(slow, Transform).position.x == pytest.approx(way, rel=1e-2)
    assert sleepers(world) == {slow}, "it has stopped, and friction holds it"


def test_a_box_that_gravity_accelerates_along_a_surface_stays_awake() -> None:
    slope, friction = 1e-4, 9e-5
    world = open_space(sleeping=True)
    box(world, (0.0, -0.5), width=60.0, height=1.0, angle=-slope, static=True, friction=friction)
    sliding = box(world, (0.0, 0.25), width=0.5, height=0.5, angle=-slope, friction=friction)
    world.run(seconds=3.0)
    assert not sleepers(world)
    way = 0.5 * 9.81 * (math.sin(slope) - friction * math.cos(slope)) * 9.0
    assert world.component(sliding, Transform).position.x == pytest.approx(way, rel=0.2)


def test_discs_in_a_corner_and_on_level_ground_fall_asleep_and_not_on_a_slope() -> None:
    def world_with(pull: float) -> tuple[World, set[int]]:
        laws = PhysicsConfig(gravity=Vector2(pull, -9.0))
        world = open_space(physics=laws, sleeping=True, collisions="step")
        floor(world, friction=0.5)
        box(world, (3.0, 0.5), width=1.0, height=3.0, static=True, friction=0.5)
        for x in (2.2, -3.0):
            circle(world, (x, 0.3), radius=0.3, friction=0.5)
        world.run(seconds=1.0)
        return world, sleepers(world)

    assert world_with(0.0)[1] == {3, 4}
    assert world_with(0.01)[1] == {3}


class Idle(System):
    """Does nothing within a substep, so that its stages are run one by one."""

    @at(Stage.KICK)
    def look(self, world: State, h: float) -> None:
        """Do nothing."""


@pytest.mark.parametrize("idle", [False, True])
def test_gravity_pulls_and_contacts_hold_what_sleeps(idle: bool) -> None:
    world = World(simulation=SimulationConfig(sleeping=True, contacts="soft"))
    box(world, (0.0, -0.5), width=9.0, height=1.0, static=True)
    for k in range(3):
        box(world, (3.0, 0.25 + 0.5 * k), width=0.5, height=0.5, mass=2.0)
    circle(world, (3.1, 9.0), radius=0.2, mass=0.5)  # wakes them when it lands
    if idle:
        world.install(Idle())
    counts = []
    for _ in range(20):
        world.run(seconds=0.2)
        counts.append(world.sleep.count)
        account = measure_account(world)
        assert account.momentum["gravity"].y == pytest.approx(-6.5 * 9.81 * world.time, rel=1e-12)
        assert account.angular_momentum["gravity"] == pytest.approx(
            -9.81 * world.time * (6.0 * 3.0 + 0.5 * 3.1), rel=1e-2
        )
        assert account.momentum["numerical"].magnitude < 1e-11
    assert {0, 3} <= {*counts}, "they sleep, and wake"


@pytest.mark.parametrize("idle", [False, True])
@pytest.mark.parametrize("speed", [0.0, 1.0])
def test_joints_hold_what_hangs_and_sleeps(idle: bool, speed: float) -> None:
    world = World(simulation=SimulationConfig(sleeping=True, contacts="soft"))
    box(world, (0.0, -0.5), width=9.0, height=1.0, static=True, friction=0.0 if speed else 0.5)
    slider = box(world, (0.0, 0.25), width=0.5, height=0.5, mass=2.0, velocity=(speed, 0.0))
    bob = circle(world, (-2.0, 2.0), radius=0.2, mass=1.5)
    world.spawn(Rod(anchor_a=(-2.0, 4.0), b=bob))
    if idle:
        world.install(Idle())
    for _ in range(8):
        world.run(seconds=0.15)
        account = measure_account(world)
        assert account.momentum["joints"].y == pytest.approx(1.5 * 9.81 * world.time, rel=1e-9)
        assert account.angular_momentum["joints"] == pytest.approx(-3.0 * 9.81 * world.time, rel=1e-9)
        assert account.momentum["contact"].y == pytest.approx(2.0 * 9.81 * world.time, rel=1e-6)
        assert account.momentum["numerical"].magnitude < 1e-11
    assert sleepers(world) == ({bob} if speed else {slider, bob})


@pytest.mark.parametrize("idle", [False, True])
def test_what_wakes_in_a_substep_has_its_forces_and_its_damping_in_the_accounts(idle: bool) -> None:
    """Half a kick of thrust was booked as gravity, and what damping takes of it as an error of the method."""
    laws = PhysicsConfig(linear_damping=0.5, angular_damping=0.5)
    world = World(physics=laws, simulation=SimulationConfig(sleeping=True, contacts="soft"))
    box(world, (0.0, -0.5), width=9.0, height=1.0, static=True, friction=0.9)
    crate = box(world, (0.0, 0.5), width=1.0, height=1.0, friction=0.9)
    world.add(crate, Thrust(force=(2.0, 0.0), torque=0.1))
    ball = circle(world, (0.0, 2.0), radius=0.2, velocity=(0.0, 8.0))
    if idle:
        world.install(Idle())
    while crate not in sleepers(world):
        world.step()
    while sleepers(world):
        world.step()
    account, mass = measure_account(world), world.component(ball, Mass).mass
    assert account.momentum["thrust"].x == pytest.approx(2.0 * world.time, rel=1e-12)
    pull = -9.81 * world.time * (mass + world.component(crate, Mass).mass)
    assert tuple(account.momentum["gravity"]) == pytest.approx((0.0, pull), abs=1e-10)
    assert account.momentum["numerical"].magnitude < 1e-10
    assert account.angular_momentum["thrust"] == pytest.approx(-0.9 * world.time, rel=1e-4)


@pytest.mark.parametrize("awake", [False, True])
def test_joints_of_a_file_hold_what_sleeps_there(awake: bool, tmp_path: Path) -> None:
    """Contacts had all of it in the accounts until a kernel measured the joints."""
    world = World(simulation=SimulationConfig(sleeping=True, contacts="soft"))
    box(world, (0.0, -0.5), width=9.0, height=1.0, static=True)
    bob = circle(world, (-2.0, 2.0), radius=0.2, mass=1.5)
    world.spawn(Rod(anchor_a=(-2.0, 4.0), b=bob))
    world.run(seconds=1.0)
    assert sleepers(world) == {bob}
    save_scene(world, tmp_path / "asleep.json")
    loaded = load_scene(tmp_path / "asleep.json")
    if awake:
        circle(loaded, (2.0, 9.0), radius=0.2)
    loaded.run(seconds=0.5)
    account = measure_account(loaded)
    assert account.momentum["joints"].y == pytest.approx(1.5 * 9.81 * 0.5, rel=1e-9)
    assert account.momentum["contact"].magnitude < 1e-9


@pytest.mark.parametrize("idle", [False, True])
@pytest.mark.parametrize(("alone", "fixed"), [(False, False), (True, False), (True, True)])
def test_all_forces_pull_what_sleeps_in_the_accounts(idle: bool, alone: bool, fixed: bool) -> None:
    """Thrust on a body that sleeps was booked to nothing, and friction did not hold it."""
    world = World(simulation=SimulationConfig(sleeping=True, contacts="soft"))
    box(world, (0.0, -0.5), width=9.0, height=1.0, static=True, friction=0.9)
    crate = box(world, (0.0, 0.5), width=1.0, height=1.0, friction=0.9)
    world.add(crate, Thrust(force=(2.0, 0.0), torque=3.0 if fixed else 0.0))
    world.component(crate, Mass).fixed_rotation = fixed  # no torque turns it
    if not alone:
        circle(world, (3.0, 90.0), radius=0.2)
    if idle:
        world.install(Idle())
    world.run(seconds=2.0)
    assert sleepers(world) == {crate}
    account = measure_account(world)
    assert account.momentum["thrust"].x == pytest.approx(4.0, rel=1e-9)
    assert account.momentum["contact"].x == pytest.approx(-4.0, rel=1e-6)
    assert account.angular_momentum["thrust"] == pytest.approx(-0.5 * 4.0, rel=1e-4)
    assert account.momentum["numerical"].magnitude < 1e-11


def test_forces_on_what_sleeps_are_the_same_after_a_shorter_step() -> None:
    """In slow motion a disc at rest was pressed by four times its weight."""
    world = load_scene("sandbox")
    world.run(seconds=8.0)
    asleep = world.entity_index.rows_of(np.array(sorted(sleepers(world))))
    before = contact_forces(world)[asleep]
    world.step(0.25 * world.simulation.dt)
    assert len(asleep) > 5 and np.allclose(contact_forces(world)[asleep], before, rtol=1e-9, atol=1e-9)
    weight = world.table(Mass)["mass"][asleep] * 9.81
    assert before[:, 1] == pytest.approx(weight, rel=1e-3)
    for contact in list_contacts(world):
        if contact.a in sleepers(world) or contact.b in sleepers(world):
            usual = world.simulation.dt / world.simulation.substeps
            assert all(
                one.normal_force == pytest.approx(one.normal_impulse / usual) for one in contact.points
            )
