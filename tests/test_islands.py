"""Islands: the bits of some bodies are those that they have alone, whatever is far away."""

import dataclasses
from collections.abc import Callable, Sequence
from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from physicslab import World, load_scene, save_scene
from physicslab.components import (
    Charge,
    Drag,
    Mass,
    Material,
    Pin,
    Shape,
    Spring,
    Thrust,
    Transform,
    Velocity,
)
from physicslab.contacts.report import contacts_of
from physicslab.diagnostics.contact_warnings import contact_graph
from physicslab.diagnostics.energy import Audit
from physicslab.diagnostics.precision import find_imprecise
from physicslab.diagnostics.step_warnings import lost_phase
from physicslab.diagnostics.step_watch import StepWatch
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.files.checks import SceneError
from physicslab.files.scene import read_scene
from physicslab.files.writer import write_scene
from physicslab.history import History, Remove, RemoveComponent
from physicslab.kernels.accounts import EDITS
from physicslab.lab.accuracy.variants import VARIANTS, refined, with_ids
from physicslab.prefabs import box
from physicslab.state.masses import Diverged
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import Stage, System, at

FAR = 500.0
NO_GRAVITY = PhysicsConfig(gravity_mode="none")


def floor(world: World) -> None:
    world.spawn(
        Transform((0, -0.5)), Shape(kind="box", width=4000, height=1), Material(0.4, 0.5), name="floor"
    )


def disc(world: World, x: float, y: float, vx: float = 0.0, vy: float = 0.0) -> int:
    return world.spawn(
        Transform((x, y)), Velocity((vx, vy)), Mass(1.0), Shape(kind="circle", radius=0.3), Material(0.5, 0.4)
    )


def few(world: World, x: float = 0.0) -> list[int]:
    """Drop three boxes and a disc onto each other."""
    boxes = [
        world.spawn(
            Transform((x + 0.2 * k, 0.5 + 0.9 * k), 0.1 * k), Velocity((0.3, 0.0)), Mass(1.0 + k),
            Shape(kind="box", width=0.7, height=0.5), Material(0.4, 0.5),
        )
        for k in range(3)
    ]  # fmt: skip
    return [*boxes, disc(world, x - 0.8, 1.5, 1.0)]


def crowd(world: World, x: float = FAR, count: int = 14) -> list[int]:
    return [disc(world, x + 0.7 * (k % 4), 0.4 + 0.7 * (k // 4)) for k in range(count)]


def pendulum(world: World, x: float) -> list[int]:
    held = Spring(anchor_b=(x, 5.0), rest_length=0.0, stiffness=20.0)
    return [world.spawn(Transform((x + 1.0, 4.0)), Velocity((0.0, 0.5)), Mass(1.0), held)]


def motion(world: World, bodies: Sequence[int]) -> NDArray[np.float64]:
    rows = world.entity_index.rows_of(np.array(bodies))
    transform, velocity = world.table(Transform), world.table(Velocity)
    columns = (
        transform["position"],
        transform["angle"][:, None],
        velocity["linear"],
        velocity["angular"][:, None],
    )
    return np.concatenate([column[rows] for column in columns], axis=1)


def sizes(world: World) -> list[int]:
    return [len(island.entities) for island in world.islands.members]


type Add = Callable[[World], Sequence[int]]


def same_alone(make: Add, far: Callable[[World], object], steps: int) -> tuple[World, World, bool]:
    """Return a world of bodies on a floor, one of the same and what is far, and whether they move alike."""
    worlds, moved = (World(), World()), list[NDArray[np.float64]]()
    for world in worlds:
        floor(world)
        bodies = make(world)
        if world is worlds[1]:
            far(world)
        world.run(steps=steps)
        moved.append(motion(world, bodies))
    return *worlds, np.array_equal(moved[0], moved[1])


@pytest.mark.parametrize(
    "far", [crowd, lambda world: [disc(world, FAR, 3.0)], lambda world: pendulum(world, FAR)]
)
def test_the_bits_of_an_island_are_those_that_it_has_alone(far: Add) -> None:
    alone, beside, same = same_alone(few, far, 90)
    assert len(sizes(beside)) == 2
    assert sizes(alone) == []
    assert same
    assert alone.stepper is not None
    assert beside.islands.members[0].world.stepper_for(0.01).name == alone.stepper.name == "rigid"


def test_what_touches_nothing_has_the_bits_of_a_run_of_its_own_beside_a_floor() -> None:
    _, beside, same = same_alone(lambda world: pendulum(world, FAR), crowd, 90)
    assert sizes(beside)
    assert same


def test_single_steps_have_the_bits_of_a_run() -> None:
    worlds = World(), World()
    bodies = []
    for world in worlds:
        floor(world)
        bodies.append([*few(world), *crowd(world)])
    worlds[0].run(steps=40)
    for _ in range(40):
        worlds[1].step()
    assert np.array_equal(motion(worlds[0], bodies[0]), motion(worlds[1], bodies[1]))
    assert worlds[0].collisions == worlds[1].collisions


def smooth_and_touching() -> World:
    """Return a charge that circles, a disc that falls, and a driven body, which belongs to both islands."""
    world = World(physics=PhysicsConfig(magnetic_field=3.0, electric_field=Vector2(0.2, -2.8)))
    disc(world, 0.5, 3.7, 0.3)
    disc(world, 0.5, 5.7)
    world.spawn(Transform((0.6, 1.6)), Velocity((1.0, 0.0)), Mass(1.0), Charge(1.0))
    world.spawn(Transform((-0.15, 1.0), 0.2), Velocity((-0.87, 0.46)))
    return world


def test_smooth_motion_beside_contacts_is_divided_nowhere_in_a_run() -> None:
    at_once, in_parts = smooth_and_touching(), smooth_and_touching()
    at_once.run(steps=60)
    for _ in in_parts.stepping(steps=60, stride=60, patience=600.0):
        pass
    assert [type(part.stepper).__name__ for part in at_once.parts].count("Flow") == 1
    assert np.array_equal(motion(at_once, at_once.entities()), motion(in_parts, in_parts.entities()))


@pytest.mark.parametrize("steps", [11, 23])
def test_a_file_keeps_the_remainders_of_a_driven_body_in_each_island(steps: int) -> None:
    world = smooth_and_touching()
    world.run(steps=steps)
    again = read_scene(write_scene(world))
    for one in (world, again):
        one.run(steps=60)
    assert np.array_equal(motion(world, world.entities()), motion(again, again.entities()))
    document = write_scene(world)
    driven = [row for island in document["islands"] for row in island.get("driven", [])]
    assert driven and all(len(row) == 7 for row in driven)
    driven[0][4] = 1e-9
    with pytest.raises(SceneError, match="remainders of at most the last digit of x, y and angle"):
        read_scene(document)


def passing(world: World) -> list[int]:
    """Let a disc hit another, that flies on to a third."""
    return [disc(world, 0.0, 0.0, 8.0), disc(world, 16.0, 0.0), disc(world, 34.0, 0.0)]


def test_islands_that_meet_are_one_and_come_apart_again() -> None:
    world = World(physics=NO_GRAVITY)
    passing(world)
    disc(world, FAR, 0.0)
    met: list[list[int]] = []
    for _ in world.stepping(seconds=8.0, stride=8):
        if not met or sizes(world) != met[-1]:
            met.append(sizes(world))
    assert met == [[1, 1, 1, 1], [2, 1, 1], [1, 1, 1, 1], [1, 2, 1]]
    assert world.collisions == 2
    assert world.account.sums[:, 1].sum() == pytest.approx(0.0)


def test_islands_that_meet_have_the_bits_that_they_have_alone() -> None:
    alone, beside = World(physics=NO_GRAVITY), World(physics=NO_GRAVITY)
    own, same = passing(alone), passing(beside)
    crowd(beside)
    alone.run(steps=240)
    beside.run(steps=240)
    assert np.array_equal(motion(alone, own), motion(beside, same))


def test_all_islands_may_become_one() -> None:
    world = World(physics=NO_GRAVITY)
    left, right = disc(world, 0.0, 0.0, 5.0), disc(world, 30.0, 0.0, -5.0)
    world.step()
    assert sizes(world) == [1, 1]
    world.run(seconds=3.5)
    assert sizes(world) == []
    assert world.collisions == 1
    assert world.islands.why_one
    assert world.component(left, Velocity).linear.x < 0.0 < world.component(right, Velocity).linear.x


def test_ten_pendulums_are_ten_closed_forms() -> None:
    world = World()
    bodies = [pendulum(world, 3.0 * k)[0] for k in range(10)]
    world.run(seconds=5.0)
    assert sizes(world) == [1] * 10
    assert {island.world.plan.integrator.name for island in world.islands.members} == {"exact"}
    alone = World()
    own = pendulum(alone, 6.0)
    alone.run(seconds=5.0)
    assert np.array_equal(motion(alone, own)[0], motion(world, bodies)[2])


def test_springs_couple_over_any_distance() -> None:
    world = World()
    floor(world)
    near, far = disc(world, 0.0, 0.3), disc(world, FAR, 0.3)
    world.spawn(Spring(a=near, b=far, rest_length=FAR, stiffness=10.0))
    world.step()
    assert sizes(world) == []
    assert "coupled" in world.islands.why_one


def test_a_marble_that_flies_far_away_and_back_is_an_island_in_between() -> None:
    world = World()
    floor(world)
    few(world)
    marble = world.spawn(
        Transform((6.0, 0.3)),
        Velocity((20.0, 40.0)),
        Mass(0.1),
        Shape("circle", radius=0.1),
        Material(1.0, 0.0),
    )
    world.spawn(Spring(a=marble, rest_length=0.0, stiffness=0.02, anchor_b=(6.0, 0.3)))
    met: list[list[int]] = []
    for _ in world.stepping(seconds=10.0, stride=6):
        if not met or sizes(world) != met[-1]:
            met.append(sizes(world))
    assert met[:3] == [[], [4, 1], []]


def test_a_pin_makes_one_island_and_its_force_is_read_in_the_whole_world() -> None:
    worlds = World(), World()
    for world in worlds:
        floor(world)
        a, b = disc(world, 0.0, 4.0), disc(world, 1.0, 4.0)
        world.spawn(Pin(a=a, b=b, anchor_b=(-1.0, 0.0)))
        world.spawn(Pin(a=a, anchor_b=(0.0, 4.0)))
    crowd(worlds[1])
    for world in worlds:
        world.run(steps=50)
    assert sizes(worlds[1]) == [2, 14]
    assert np.array_equal(motion(worlds[0], [2, 3]), motion(worlds[1], [2, 3]))
    assert worlds[0].joints.force.any()
    assert np.array_equal(worlds[0].joints.force, worlds[1].joints.force)


def test_sleep_of_a_far_crowd_is_seen_in_the_whole_world_and_an_edit_wakes_it() -> None:
    world = World(simulation=SimulationConfig(sleeping=True))
    floor(world)
    discs = [disc(world, FAR + 0.7 * k, 0.3) for k in range(14)]
    wild = disc(world, 0.0, 3.0)
    world.run(seconds=1.5)
    assert sizes(world) == [14, 1]
    assert world.sleep.count == 14
    world.component(discs[3], Velocity).linear = Vector2(2.0, 0.0)
    world.run(steps=30)
    assert world.sleep.count < 14
    assert world.component(wild, Transform).position.y < 3.0
    world.remove(discs[0])
    world.run(steps=2)
    assert len(sizes(world)) == 2


def test_a_driven_platform_belongs_to_every_island() -> None:
    alone, beside = World(), World()
    for world in (alone, beside):
        world.spawn(
            Transform((0.0, -0.5)),
            Velocity((0.5, 0.0)),
            Shape(kind="box", width=4000, height=1),
            Material(0.4, 0.5),
        )
        few(world)
    crowd(beside)
    alone.run(steps=60)
    beside.run(steps=60)
    assert sizes(beside) == [4, 14]
    assert np.array_equal(motion(alone, [2, 3, 4, 5]), motion(beside, [2, 3, 4, 5]))
    change = beside.account.last.energy - (beside.account.start or beside.account.last).energy
    assert beside.account.sums[:, 0].sum() == pytest.approx(change, abs=1e-8)


ALL_SOFT = [
    SimulationConfig(contacts="soft", collisions="step"),
    SimulationConfig(sleeping=True, collisions="step"),
    SimulationConfig(integrator="leapfrog"),
]
"""Settings with which what can touch has soft contacts, wherever it is."""


@pytest.mark.parametrize("simulation", ALL_SOFT)
def test_small_islands_without_a_better_stepper_are_one_world(simulation: SimulationConfig) -> None:
    """Each was a call of its own: 31 discs in six islands took four times as long as together."""
    world = World(simulation=simulation)
    floor(world)
    for n in range(4):
        few(world, n * FAR)
    world.run(steps=3)
    assert sizes(world) == []
    assert world.islands.why_one == "with soft contacts islands are advanced together"
    assert world.islands.steps_ahead(world, world.simulation.dt) > 1_000  # they are not looked for again


@pytest.mark.parametrize("simulation", ALL_SOFT)
def test_of_soft_islands_those_of_unlike_masses_and_what_only_flies_are_apart(
    simulation: SimulationConfig,
) -> None:
    world = World(simulation=simulation)
    floor(world)
    calm = [body for n in (0, 1) for body in few(world, n * FAR)]
    loaded = [*few(world, 2 * FAR), box(world, (2 * FAR, 3.0), width=0.4, height=0.4, mass=500.0)]
    world.spawn(Transform((0.0, 9.0)), Velocity((0.5, 0.0)), Mass(1.0))  # no Shape
    world.run(steps=3)
    assert sizes(world) == [len(calm), len(loaded), 1]


def small_disc(world: World) -> int:
    """Add a disc that falls by an eighth of its size in a substep."""
    return world.spawn(Transform((2 * FAR, 1.0)), Velocity(), Mass(1e-4), Shape.circle(7e-4))


def driven_disc(world: World) -> int:
    one = disc(world, 2 * FAR, 0.5)
    world.add(one, Thrust((3.0, 0.0), frequency=1.5))
    return one


@pytest.mark.parametrize("add", [small_disc, driven_disc])
def test_of_soft_islands_those_whose_steps_take_longer_are_apart_and_cost_others_no_bit(
    add: Callable[[World], int],
) -> None:
    alone, world = (World(simulation=ALL_SOFT[0]) for _ in range(2))
    for each in (alone, world):
        floor(each)
        calm = [body for n in (0, 1) for body in few(each, n * FAR)]
    one = add(world)
    for each in (alone, world):
        each.run(steps=60)
    assert sizes(world) == [len(calm), 1]
    rest, other = world.parts
    assert (
        rest.substeps == alone.substeps and rest.stepper is not None and rest.stepper.name == "fused_contact"
    )
    assert other.substeps > rest.substeps or (other.stepper is not None and other.stepper.name == "contact")
    assert np.array_equal(motion(world, calm), motion(alone, calm))
    assert motion(world, [one])[0, 1] > 0.0


def test_unlike_masses_are_not_apart_from_fewer_others() -> None:
    world = World(simulation=ALL_SOFT[0])
    floor(world)
    few(world)
    for n in (1, 2):
        few(world, n * FAR)
        box(world, (n * FAR, 3.0), width=0.4, height=0.4, mass=500.0)
    world.run(steps=3)
    assert sizes(world) == []
    assert world.islands.why_one == "with soft contacts islands are advanced together"


def pile(world: World, x: float, count: int) -> None:
    for n in range(count):
        box(world, (x + 0.1 * (n % 2), 0.3 + 0.5 * n), width=0.6, height=0.5)


@pytest.mark.parametrize(
    ("counts", "apart", "why"),
    [
        ((6, 6, 6), [6, 6, 6], ""),
        ((10, 10, 10, 10), [], "rigid contacts in all islands would take longer than in one of 12 bodies"),
        ((3, 10, 10), [3, 20], ""),
        ((12, 1), [12, 1], ""),
    ],
)
def test_rigid_islands_together_take_no_longer_than_one_of_twelve_bodies(
    counts: tuple[int, ...], apart: list[int], why: str
) -> None:
    """Four piles of ten boxes took 58 ms a step; as one world with soft contacts they take 0.13."""
    world = World()
    floor(world)
    for number, count in enumerate(counts):
        pile(world, number * FAR, count)
    world.synchronise()
    assert sizes(world) == apart
    assert world.islands.why_one == why
    assert [part.rigid_contacts for part in world.parts] == [n <= 12 for n in sorted(apart or [40])[::-1]]


def test_islands_that_fly_between_impacts_are_apart_however_many() -> None:
    world = World()
    floor(world)
    for n in range(4):
        for k in range(8):
            disc(world, n * FAR + 1.5 * k, 3.0 + 0.3 * k)
    for n in (4, 5):  # piles that are costly together
        pile(world, n * FAR, 11)
    world.synchronise()
    assert sizes(world) == [8, 8, 8, 8, 22]
    assert [part.plan.collisions for part in world.parts] == ["step", *["exact"] * 4]


def test_rigid_contacts_that_are_asked_for_are_so_in_every_island() -> None:
    world = World(simulation=SimulationConfig(contacts="rigid"))
    floor(world)
    for n in range(3):
        pile(world, n * FAR, 11)
    world.synchronise()
    assert sizes(world) == [11] * 3


def test_planets_are_one_island_and_the_reason_is_told() -> None:
    world = World(physics=PhysicsConfig(gravity_mode="planet"))
    disc(world, 0.0, 0.0)
    disc(world, FAR, 0.0)
    world.step()
    assert sizes(world) == []
    assert world.islands.why_one == "GravitySystem acts between all bodies"


class Wind(System):
    """Blows on everything."""

    @at(Stage.DRIFT)
    def blow(self, state: World, h: float) -> None:
        state.table(Velocity)["linear"][1:, 0] += 0.1 * h


def test_a_system_that_acts_within_the_step_sees_one_world() -> None:
    world = World(*standard_systems(), Wind())
    disc(world, 0.0, 0.0)
    disc(world, FAR, 0.0)
    world.step()
    assert sizes(world) == []
    assert world.islands.why_one == "Wind acts within the step"


def test_what_is_told_of_a_world_is_so_of_its_islands() -> None:
    world = World()
    box(world, (0, -0.5), width=2000, height=1, static=True)
    for k in range(13):
        box(world, (40.0 * k, 0.5), width=1, height=1)
    world.synchronise()
    assert world.plan.contacts == "soft", "of 13 bodies, were they one"
    assert len(world.plans) == 13 and {plan.contacts for plan in world.plans} == {"rigid"}
    said = StepWatch(world).note(1, 5.0)
    assert "rigid contacts go from one event to the next" in said
    document = with_ids(write_scene(world))
    made = {variant.name for variant in VARIANTS if variant.make(document, world) is not None}
    assert "eighth of the step" in made
    assert made.isdisjoint({"half step", "stiffer", "rigid"}), "no contact gives way"


def test_the_refined_variant_of_islands_takes_shorter_steps_in_each() -> None:
    world = World()
    for x, stiffness in ((0.0, 40.0), (100.0, 4000.0)):
        spring = Spring(anchor_b=(x, 0), rest_length=1, stiffness=stiffness)
        world.spawn(Transform((x + 1.2, 0)), Velocity(), Mass(1.0), spring)
    world.synchronise()
    variant = refined(with_ids(write_scene(world)), world, 2.0)
    steps = [(plan.integrator.name, plan.substeps) for plan in world.plans]
    assert [(plan.integrator.name, plan.substeps) for plan in variant.plans] == steps
    assert variant.simulation.dt == 0.5 * world.simulation.dt and steps[1] == ("blanes_moan", 3)
    world.run(seconds=2.0)
    lost = [lost_phase(part) for part in world.parts]
    assert lost[0] is None and lost[1] is not None and lost_phase(world) is None
    (warning,) = find_imprecise(world, Audit(world))
    assert warning.value == lost[1][1]


def test_accounts_counts_and_the_log_are_those_of_all_islands() -> None:
    alone, beside = World(), World()
    for world in (alone, beside):
        floor(world)
        world.contacts.read = True
        few(world)
    few(beside, FAR)
    alone.run(seconds=1.0)
    beside.run(seconds=1.0)
    assert beside.collisions == 2 * alone.collisions > 0
    assert beside.contacts.count == 2 * alone.contacts.count > 0
    assert len(beside.contacts.impacts) == 2 * len(alone.contacts.impacts)
    assert (np.diff(beside.contacts.impacts["time"]) >= 0.0).all()
    assert beside.account.sums[:, 0] == pytest.approx(
        2.0 * alone.account.sums[:, 0],
        abs=1e-6,  # far places are rounded more
    )
    change = beside.account.last.energy - (beside.account.start or beside.account.last).energy
    assert beside.account.sums[:, 0].sum() == pytest.approx(change, abs=1e-7)


def test_an_edit_reaches_its_island_and_is_booked_once() -> None:
    worlds = World(), World()
    for world in worlds:
        floor(world)
        few(world)
    few(worlds[1], FAR)
    for world in worlds:
        world.run(steps=30)
        world.table(Velocity)["linear"][2, 1] += 3.0
        world.run(steps=30)
    bodies = worlds[0].entities()[1:]
    assert np.array_equal(motion(worlds[0], bodies), motion(worlds[1], bodies))
    edits = [world.account.sums[EDITS, 0] for world in worlds]
    assert edits[1] == pytest.approx(edits[0])
    assert edits[0] > 1.0


def two_crowds() -> World:
    world = World(physics=dataclasses.replace(PhysicsConfig(), gravity=Vector2(0.0, -9.81)))
    floor(world)
    few(world)
    crowd(world)
    disc(world, -30.0, 0.31, 12.0)  # rolls into the few after two seconds and a half
    return world


def test_a_saved_world_goes_on_with_all_bits(tmp_path: Path) -> None:
    world, path = two_crowds(), tmp_path / "scene.json"
    for seconds, expected in ((1.0, 3), (2.0, 2)):
        world.run(seconds=seconds)
        assert len(sizes(world)) == expected
        save_scene(world, path)
        again = load_scene(path)
        again.synchronise()
        assert sizes(again) == sizes(world)
        world.run(steps=30)
        again.run(steps=30)
        bodies = world.entities()[1:]
        assert np.array_equal(motion(world, bodies), motion(again, again.entities()[1:]))


def test_seeking_across_islands_that_meet_gives_the_same_bits() -> None:
    world = two_crowds()
    history = History(world)
    history.step(steps=60)
    bodies, early = world.entities()[1:], motion(world, world.entities()[1:])
    history.step(steps=140)
    late, count = motion(world, bodies), sizes(world)
    history.seek(60)
    assert np.array_equal(motion(world, bodies), early)
    assert len(sizes(world)) == 3
    history.seek(200)
    assert np.array_equal(motion(world, bodies), late)
    assert sizes(world) == count
    assert history.difference is None


def test_what_is_undone_is_undone_in_the_islands() -> None:
    world = World()
    floor(world)
    balls = [disc(world, x, 3.0) for x in (0.0, FAR, 2.0 * FAR)]
    history = History(world)
    for edit in (RemoveComponent(balls[0], "Material"), Remove(balls[2])):
        history.step(steps=3)
        history.do(edit)
    rubs = []
    for _ in range(3):  # the body, three steps, the component
        history.undo()
        assert sizes(world) == [1, 1, 1]
        parts = [island.state for island in world.islands.members]
        rubs.append(
            [
                bool(part.table(Material).present[part.entity_index.row_of[ball]])
                for part, ball in zip(parts, balls, strict=True)
            ]
        )
    assert rubs == [[False, True, True], [False, True, True], [True, True, True]]


def test_an_edit_that_is_taken_back_and_made_again_reaches_its_island() -> None:
    """The second was taken for what the islands had left: they went on with the value in between."""
    world = World()
    floor(world)
    balls = [disc(world, x, 3.0) for x in (0.0, FAR, 2.0 * FAR)]
    velocity = world.component(balls[2], Velocity)
    velocity.linear = Vector2(66.0, 85.0)
    world.run(steps=3)
    moved = velocity.linear
    for value in (Vector2(), moved):
        velocity.linear = value
        world.synchronise()
    world.run(steps=1)
    assert velocity.linear.x == 66.0


def test_a_world_that_is_still_one_goes_on_from_a_file_within_a_step_of_another_length() -> None:
    """Impulses of the shortened step were taken for those of a whole one, where a new world has islands."""
    world = World(simulation=SimulationConfig(contacts="soft"))
    floor(world)
    bodies = [*few(world), disc(world, 1.5, 0.3, 30.0)]
    world.run(seconds=1.805)
    scene = write_scene(world)
    assert scene["islands"] == []
    loaded = read_scene(scene)
    for each in (world, loaded):
        each.run(steps=3)
    assert np.array_equal(motion(world, bodies), motion(loaded, bodies))


def test_a_file_of_islands_is_written_alike_where_one_has_touched_nothing_yet() -> None:
    world = World()
    floor(world)
    disc(world, -FAR, 3.0)
    for n in range(14):
        disc(world, 0.6 * n, 3.0)
    world.step(1.0 / 480.0)
    document = write_scene(world)
    assert len(document["islands"]) == 2
    assert write_scene(read_scene(document)) == document


def test_a_step_that_diverges_in_one_island_is_made_in_none() -> None:
    world = World()
    floor(world)
    bodies = few(world)
    wild = world.spawn(Transform((FAR, 3.0)), Velocity(), Mass(1.0))
    world.run(steps=20)
    assert len(sizes(world)) == 2
    before, time, dt = motion(world, [*bodies, wild]), world.time, world.simulation.dt
    world.component(wild, Velocity).linear = Vector2(1e302, 0.0)
    with pytest.raises(Diverged):
        world.step()
    assert world.time == time
    assert np.array_equal(motion(world, bodies), before[:4])
    world.component(wild, Velocity).linear = Vector2(
        7e300, 0.0
    )  # it leaves what a file may hold in the ninth
    with pytest.raises(Diverged, match="Transform is beyond"):
        world.run(steps=20)
    assert world.time == pytest.approx(time + 8 * dt)
    assert not np.array_equal(motion(world, bodies), before[:4])
    world.component(wild, Velocity).linear = Vector2()
    world.run(steps=5)
    assert len(sizes(world)) == 2


SHAPELESS, CHAINED = 4, 3


def random_scene(world: World, seed: int) -> list[int]:
    """Drop 2 to 12 bodies of random kinds between two walls; in some scenes springs or drag act on them."""
    random = np.random.default_rng(seed)
    kind, spread = random.integers(0, 5), random.choice([2.0, 5.0, 12.0])
    restitution = float(random.choice([0.0, 0.3, 0.6, 0.9, 1.0]))
    for x in (-20.0, 20.0):
        world.spawn(Transform((x, 10.0)), Shape(kind="box", width=1, height=22), Material(0.5, 0.5))
    bodies: list[int] = []
    for k in range(int(random.integers(2, 13))):
        place = random.uniform(-spread, spread), 0.6 + 0.9 * k + random.uniform(0.0, 0.3)
        is_disc = random.random() < 0.5 or kind == 0
        shape = (
            Shape(kind="circle", radius=random.uniform(0.1, 0.5))
            if is_disc
            else Shape(kind="box", width=random.uniform(0.3, 1.0), height=random.uniform(0.3, 0.8))
        )
        components = [
            Transform(place, random.uniform(0.0, 3.0)),
            Velocity(tuple(random.uniform(-2.0, 2.0, 2)), random.uniform(-2.0, 2.0)),
            Mass(random.uniform(0.5, 2.0)),
            Material(restitution, float(random.choice([0.0, 0.3, 0.8]))),
            *([] if kind == SHAPELESS else [shape]),
            *([Drag(linear=0.1)] if random.random() < 0.1 else []),
        ]
        bodies.append(world.spawn(*components))
    if kind in (CHAINED, SHAPELESS):
        for a, b in pairwise(bodies):
            if random.random() < 0.6:
                stiffness, damping = random.uniform(20.0, 200.0), float(random.choice([0.0, 0.5]))
                world.spawn(Spring(a=a, b=b, rest_length=1.0, stiffness=stiffness, damping=damping))
        world.spawn(Spring(a=bodies[0], anchor_b=(0.0, 8.0), rest_length=2.0, stiffness=100.0))
    return bodies


def thirteen(world: World) -> None:
    """Drop thirteen boxes onto each other: more than rigid contacts are taken for."""
    random = np.random.default_rng(98)
    for k in range(13):
        world.spawn(
            Transform((FAR + random.uniform(-3.0, 3.0), 0.6 + k)), Velocity((random.uniform(-1.0, 1.0), 0.0)),
            Mass(1.0), Shape(kind="box", width=0.6, height=0.5), Material(0.4, 0.4),
        )  # fmt: skip


def orbits(world: World) -> None:
    """Let bodies go round fixed points, and two round each other, by springs: planets attract all."""
    for k in range(4):
        held = Spring(anchor_b=(FAR, 8.0), rest_length=0.0, stiffness=3.0 + k)
        world.spawn(Transform((FAR + 1.0 + k, 8.0)), Velocity((0.0, 1.0)), Mass(1.0), held)
    one = world.spawn(Transform((FAR + 1.0, 20.0)), Velocity((0.0, 1.0)), Mass(2.0))
    other = world.spawn(Transform((FAR - 1.0, 20.0)), Velocity((0.0, -1.0)), Mass(2.0))
    world.spawn(Spring(a=one, b=other, rest_length=0.5, stiffness=5.0))


@pytest.mark.slow
@pytest.mark.parametrize("far", [lambda world: crowd(world, count=500), thirteen, orbits])
def test_random_scenes_have_the_bits_that_they_have_alone(
    far: Callable[[World], object], pytestconfig: pytest.Config
) -> None:
    for seed in range(round(200 * pytestconfig.getoption("effort"))):
        assert same_alone(partial(random_scene, seed=seed), far, 150)[2], seed


def read_contacts(world: World) -> bool:
    """Whether the body spawned last but one of the pile lies on what is below it."""
    pile = int(world.entity_index.entities[-2])
    return [contact.b for contact in contacts_of(world, pile)] == [pile]


def read_graph(world: World) -> bool:
    """Whether the graph of contacts has all that touch."""
    return len(contact_graph(world).touching) > 64


@pytest.mark.parametrize("read", [read_contacts, read_graph])
def test_contacts_that_are_read_first_after_a_run_are_all_there(read: Callable[[World], bool]) -> None:
    """They are brought from the islands as they are read, into larger arrays than those of before."""
    world = World(simulation=SimulationConfig(sleeping=False))
    floor(world)
    for n in range(72):
        box(world, (0.9 * (n % 12) + 0.05 * (n // 12), 0.5 + n // 12), width=0.8, height=1.0)
    disc(world, FAR, 0.3)
    world.run(steps=30)
    assert len(world.islands.members) == 2 and world.contacts.source is not None
    assert read(world)
    assert len(world.contacts.manifolds) > 64
