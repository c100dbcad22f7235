"""Which worlds have rigid contacts, what they do where events accumulate, and what lies beside them."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from desk import bits

from physicslab import World
from physicslab.components import Drag, Held, Mass, Material, Shape, Spring, Transform, Velocity
from physicslab.diagnostics.energy import measure_account, measure_energy
from physicslab.diagnostics.warnings import find_warnings
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.files.json_text import json_text
from physicslab.files.scene import load_scene, read_scene, save_scene, write_scene
from physicslab.lab.bench.catalogue import SCENES
from physicslab.prefabs import box, circle, container
from physicslab.stepping.rigid import Rigid
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import ForceSystem, Stage, System, at

G = 9.81


def laboratory(contacts: str, **physics: Any) -> World:
    return World(
        *standard_systems(), physics=PhysicsConfig(**physics), simulation=SimulationConfig(contacts=contacts)
    )


def row_of_boxes(count: int) -> World:
    world = laboratory("auto")
    box(world, (0, -0.5), width=100, height=1, static=True)
    for i in range(count):
        box(world, (2.0 * i, 0.5), width=1, height=1)
    return world


def test_auto_takes_rigid_contacts_where_few_bodies_touch() -> None:
    chosen = []
    for world in (row_of_boxes(12), row_of_boxes(13)):
        world.synchronise()
        chosen.append((world.plan.contacts, world.plan.contact_reason))
    assert chosen == [("rigid", "few bodies touch"), ("soft", "more than 12 bodies can touch")]


def test_auto_leaves_stiff_springs_to_soft_contacts() -> None:
    world = row_of_boxes(2)
    world.spawn(Spring(2, 3, rest_length=2.0, stiffness=1e7))
    world.synchronise()
    assert world.plan.contacts == "soft"
    assert world.plan.contact_reason.startswith("forces act at 4.47e+03 rad/s")


@pytest.mark.parametrize("stated", ["auto", "rigid", "soft"])
def test_a_file_states_its_contacts_and_one_that_does_not_has_auto(stated: str, tmp_path: Path) -> None:
    world = row_of_boxes(1)
    world.simulation = replace(world.simulation, contacts=stated)
    save_scene(world, tmp_path / "scene.json")
    document = json.loads((tmp_path / "scene.json").read_text())
    assert (
        document["simulation"]["contacts"]
        == stated
        == load_scene(tmp_path / "scene.json").simulation.contacts
    )
    del document["simulation"]["contacts"]
    assert read_scene(document).simulation.contacts == "auto"


@pytest.mark.parametrize(
    ("setting", "reason"),
    [
        ({"sleeping": True}, "sleeping was asked for, and with rigid contacts nothing sleeps"),
        ({"collisions": "step"}, "collisions within steps were asked for, and rigid contacts locate them"),
        ({"integrator": "leapfrog"}, "leapfrog was asked for, and rigid contacts go by dop853"),
    ],
)
def test_auto_overrules_no_wish_that_only_soft_contacts_fulfil(setting: dict[str, Any], reason: str) -> None:
    world = row_of_boxes(2)
    world.simulation = replace(world.simulation, **setting)
    world.synchronise()
    assert (world.plan.contacts, world.plan.contact_reason) == ("soft", reason)


def test_a_system_that_acts_within_the_step_has_soft_contacts_and_is_named() -> None:
    class Wind(System):
        @at(Stage.KICK)
        def blow(self, world: World, h: float) -> None:
            world.table(Velocity)["linear"][world.entity_index.row_of[2], 0] += h

    world = row_of_boxes(1)
    world.install(Wind())
    world.step()
    assert (world.plan.contacts, world.plan.contact_reason) == ("soft", "Wind acts within the step")


def test_a_body_that_is_held_counts_and_the_model_does_not_change_when_it_is_let_go() -> None:
    world = row_of_boxes(13)
    world.add(2, Held())
    world.synchronise()
    assert (world.plan.contacts, world.plan.contact_reason) == ("soft", "more than 12 bodies can touch")


def test_what_was_chosen_for_an_earlier_motion_outlives_a_file() -> None:
    """Drag that would now be too fast for rigid contacts: the present speed is not that of the choice."""
    world = row_of_boxes(1)
    world.add(2, Drag(0.0, 2.0))
    world.run(steps=5)
    assert world.plan.contacts == "rigid"
    fast = world.table(Velocity)["linear"]
    fast[world.entity_index.row_of[2]] = (1e4, 0.0)
    saved = read_scene(json.loads(json_text(write_scene(world))))
    for one in (world, saved):
        one.run(steps=20)
        assert one.plan.contacts == "rigid"
    assert bits(world) == bits(saved)


def test_speeds_whose_squares_are_not_finite_are_left_to_soft_contacts() -> None:
    """Every speed counted as none, and the fast body stood still."""
    world = laboratory("auto", gravity_mode="none")
    box(world, (0, -9), width=1, height=1, static=True)
    circle(world, (0, 0), velocity=(1e200, 0.0))
    world.step()
    assert world.component(2, Velocity).linear.x == 1e200
    assert rigid_of(world).why_soft == "squares of speeds or accelerations are not finite"


def test_forces_at_the_end_of_a_step_can_be_read() -> None:
    world = row_of_boxes(1)
    world.step()
    assert world.stepper is not None and world.stepper.name == "rigid"
    world.add_up_forces()
    assert world.bodies.force[world.entity_index.row_of[2]] == pytest.approx((0.0, -G), abs=1e-12)


def test_a_force_on_what_is_fixed_moves_it_no_more_than_in_soft_contacts() -> None:
    class Blast(ForceSystem):
        needs = (Velocity,)

        @at(Stage.FORCE)
        def push(self, world: World, h: float) -> None:
            world.bodies.force[world.entity_index.row_of[1]] = math.inf

    world = row_of_boxes(1)
    world.install(Blast())
    world.run(steps=3)
    assert world.stepper is not None and world.stepper.name == "rigid"
    assert tuple(world.component(1, Transform).position) == (0.0, -0.5)
    assert tuple(world.component(2, Transform).position) == pytest.approx((0.0, 0.5), abs=1e-15)


def into_a_corner(contacts: str) -> World:
    world = laboratory(contacts)
    box(world, (0, -0.5), width=20, height=1, static=True, restitution=0.5, friction=0.1)
    box(world, (3.5, 1.5), width=1, height=5, static=True, restitution=0.5, friction=0.1)
    circle(
        world, (0.1, 0.5), radius=0.5, velocity=(2, 0), angular_velocity=-4.0, restitution=0.5, friction=0.1
    )
    return world


def test_what_rests_beside_exact_collisions_is_rigid() -> None:
    """A disc rolls into a corner: the wall's friction lifts it by mu (1 + e) v = 0.3 m/s."""
    world, alone, steppers = into_a_corner("auto"), into_a_corner("rigid"), set()
    world.contacts.read = True
    for _ in range(90):
        world.step()
        alone.step()
        assert world.stepper is not None
        steppers.add(world.stepper.name)
        if world.contacts.logged:
            break
    hit = world.contacts.log[world.contacts.logged - 1]["time"]
    assert hit == pytest.approx(2.4 / 2.0, abs=1e-12)
    expected = 0.1 * 1.5 * 2.0 - G * (world.time - hit)
    assert world.component(3, Velocity).linear.y == pytest.approx(expected, abs=1e-12)
    assert steppers == {"rigid"} and world.plan.collisions == "exact"
    for _ in range(60):
        world.step()
        alone.step()
        assert world.stepper is not None
        steppers.add(world.stepper.name)
    assert steppers == {"rigid", "event_driven"}
    place, other = world.component(3, Transform), alone.component(3, Transform)
    assert (place.position - other.position).magnitude < 1e-9
    assert place.angle == pytest.approx(other.angle, abs=1e-9)


@pytest.mark.parametrize("steps", [1, 7, 90])
def test_a_run_of_exact_collisions_beside_rigid_ones_has_the_bits_of_steps(steps: int) -> None:
    one, other = (laboratory("auto") for _ in range(2))
    for world in (one, other):
        box(world, (0, -0.5), width=20, height=1, static=True, restitution=0.5)
        for i in range(3):
            circle(world, (2.0 * i, 0.4 + 0.3 * i), radius=0.2, restitution=0.5)
        world.run(steps=20)
    one.run(steps=steps)
    for _ in range(steps):
        other.step()
    for column in ("position", "angle"):
        assert one.table(Transform)[column].tobytes() == other.table(Transform)[column].tobytes()
    assert one.collisions == other.collisions and one.contacts.logged == other.contacts.logged


@pytest.mark.parametrize("speed", [50, 500, 1e5, 1e6])
@pytest.mark.parametrize("moving", [False, True], ids=["static", "moving"])
@pytest.mark.parametrize("kind", ["circle", "box"])
@pytest.mark.parametrize("e", [0.0, 0.5])
def test_nothing_passes_through_a_thin_wall(speed: float, moving: bool, kind: str, e: float) -> None:
    world = laboratory("rigid", gravity_mode="none")
    shape = Shape.circle(0.05) if kind == "circle" else Shape.box(0.1, 0.1)
    bullet = world.spawn(Transform((-3, 0)), Velocity((speed, 0)), Mass(1), shape, Material(e, 0))
    parts = (Velocity((-1, 0)), Mass(10)) if moving else ()
    wall = world.spawn(Transform((0, 0)), Shape.box(0.005, 2), Material(e, 0), *parts)
    energy = measure_energy(world).total
    for _ in range(30):
        world.step()
        assert world.component(bullet, Transform).position.x < world.component(wall, Transform).position.x
    assert measure_energy(world).total <= energy * (1 + 1e-9)
    assert rigid_of(world).left_to_soft == rigid_of(world).by_impulses == 0


def rigid_of(world: World) -> Rigid:
    return next(stepper for stepper in world.steppers.usable if isinstance(stepper, Rigid))


def test_a_step_longer_than_the_scenes_own_is_divided() -> None:
    long, short = load_scene("slope"), load_scene("slope")
    long.step(0.5)
    short.run(seconds=0.5)
    assert (long.step_divisions, long.steps, long.time) == (30, 1, 0.5)
    apart = long.table(Transform)["position"] - short.table(Transform)["position"]
    assert np.abs(apart).max() < 1e-12


def heap(seed: int) -> World:
    """Return twelve boxes and discs that fall into a groove: more events than a step has room for."""
    random, world = np.random.default_rng(seed), laboratory("rigid")
    for side in (-1, 1):
        box(world, (1.6 * side, 1.0), width=4, height=0.3, angle=0.7 * side, static=True, friction=0.3)
    for i in range(12):
        size, place = random.uniform(0.15, 0.3), (float(random.uniform(-0.4, 0.4)), 1.2 + 0.4 * i)
        surface: Any = {"restitution": 0.4, "friction": 0.5, "mass": float(random.uniform(0.3, 3.0))}
        if i % 2:
            circle(world, place, radius=0.5 * size, **surface)
        else:
            box(world, place, width=size, height=0.8 * size, angle=float(random.uniform(-1, 1)), **surface)
    return world


def test_where_events_accumulate_the_step_is_finished_by_impulses_and_that_is_told() -> None:
    by_impulses = 0
    for seed in (3, 5):
        world = heap(seed)
        energy, booked = measure_energy(world).total, 0.0
        for _ in range(120):
            world.step()
            added, booked = rigid_of(world).energy_added - booked, rigid_of(world).energy_added
            assert measure_energy(world).total <= energy + added + 1e-9 * abs(energy)
            energy = measure_energy(world).total
        assert rigid_of(world).left_to_soft == 0, rigid_of(world).why_soft
        told = [warning for warning in find_warnings(world) if "by impulses in 32 parts" in warning.what]
        assert len(told) == (rigid_of(world).by_impulses > 0)
        by_impulses += rigid_of(world).by_impulses
    assert by_impulses > 0


def test_ten_discs_in_a_pit_come_to_rest_and_their_forces_are_found() -> None:
    """By impulses they settle; moved apart at each of their short steps they never did, at 9 ms a step."""
    world = SCENES["circles_10_auto"].build()
    world.run(seconds=3.0)
    (rigid,) = (stepper for stepper in world.steppers.usable if isinstance(stepper, Rigid))
    before = rigid.by_impulses
    world.run(seconds=1.0)
    assert measure_energy(world).kinetic == 0.0 and rigid.by_impulses == before


_WEDGED = (
    (-1.2622358165351204, 0.20225435205180226, 0.31415996941281565),
    (0.16434855925640648, 0.20225431708677066, 1.5707958606855117),
    (0.7867076342310028, 0.20225426417979642, 1.5707964328612574),
    (1.2622358709262116, 0.2022542485937369, 0.3141592653589794),
    (-0.786707700785249, 0.20225424859373684, -0.9424777960769377),
    (-0.31117965467346337, 0.2022544026469263, 2.8274323398662964),
    (0.4755280338389309, 0.4761691426773718, -0.31415973146836407),
)
"""Where pentagons are that fell into a box [m, m, rad]: gaps of 1e-7 m, over which they fall in turn."""


def wedged() -> World:
    world = World()
    container(world, width=3.0, height=6.0)
    angles = [0.4 * math.pi * k for k in range(5)]
    pentagon = [(0.25 * math.cos(angle), 0.25 * math.sin(angle)) for angle in angles]
    for x, y, angle in _WEDGED:
        world.spawn(Transform((x, y), angle), Velocity(), Mass(1.0), Shape.polygon(pentagon))
    world.synchronise()
    return world


def test_what_impulses_hold_at_rest_rests_without_them() -> None:
    """It was let fall by 1e-7 m and held again in each step, for as long as it lay there."""
    world = wedged()
    rows = world.batch(Velocity).rows
    before = bits(world)
    world.step()
    assert rigid_of(world).by_impulses == 1
    evaluations = world.force_evaluations
    world.run(steps=300)
    assert world.force_evaluations == evaluations and rigid_of(world).by_impulses == 1
    assert bits(world) == before and not world.table(Velocity)["linear"][rows].any()
    account = measure_account(world)
    assert account.energy["numerical"] == pytest.approx(0.0, abs=1e-12)
    assert account.momentum["contact"].y == pytest.approx(7.0 * G * 301 / 60, rel=1e-9)
    assert abs(account.momentum["numerical"].y) < 1e-9 and abs(account.angular_momentum["numerical"]) < 1e-9


def test_what_impulses_have_held_falls_where_its_support_is_gone() -> None:
    world = wedged()
    world.run(steps=5)
    *_, last = world.batch(Velocity).entities.tolist()
    below = world.batch(Velocity).entities.tolist()[:6]
    for entity in below:
        world.remove(entity)
    world.run(steps=10)
    assert world.component(last, Velocity).linear.y == pytest.approx(-G * 10 / 60, rel=1e-9)


def wedged_beside_a_mover(contacts: str = "auto") -> World:
    """Return the same with what moves far from it, so that the heap is held by impulses in each step."""
    world = wedged()
    world.spawn(Transform((90.0, 0.0)), Velocity((0.1, 0.0)), Shape.circle(0.5))
    world.simulation = replace(world.simulation, contacts=contacts)
    return world


def test_what_is_wedged_for_long_goes_on_with_soft_contacts() -> None:
    """Each step by impulses took longer than a frame; a thirteenth body made it a hundred times as fast."""
    world = wedged_beside_a_mover()
    world.run(steps=6)
    assert world.plan.contacts == "rigid" and rigid_of(world).by_impulses == 6
    loaded, copied, singly = read_scene(write_scene(world)), world.copy(), wedged_beside_a_mover()
    for each in (world, loaded, copied):
        each.run(steps=30)
    for _ in range(36):
        singly.step()
    assert world.plan.contacts == "soft"
    assert world.plan.contact_reason == "rigid contacts lead from one event to the next without end"
    assert bits(world) == bits(loaded) == bits(copied) == bits(singly)
    again = read_scene(write_scene(world))
    for each in (world, again):
        each.run(steps=5)
    assert bits(world) == bits(again) and again.plan.contacts == "soft"
    positions = world.table(Transform)["position"][world.batch(Velocity, Mass).rows]
    assert np.abs(positions - np.array(_WEDGED)[:, :2]).max() < 1e-3


def test_what_is_wedged_stays_rigid_where_that_is_chosen() -> None:
    world = wedged_beside_a_mover("rigid")
    world.run(steps=16)
    assert world.plan.contacts == "rigid" and rigid_of(world).by_impulses == 16
