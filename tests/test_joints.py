"""Joints: pins, exact where nothing touches, soft beside contacts."""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from physicslab import World, load_scene, save_scene
from physicslab.components import Mass, Name, Pin, Shape, Spring, Transform, Velocity
from physicslab.diagnostics.energy import measure_energy
from physicslab.diagnostics.free_body import forces_on, last_step
from physicslab.diagnostics.period import period_of
from physicslab.diagnostics.reference_solution import reference_solution
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.vector import Vector2, rotated
from physicslab.files.checks import SceneError
from physicslab.files.reader import FORMAT, read_scene
from physicslab.files.writer import write_scene
from physicslab.kernels.accounts import DAMPING, ENERGY, HAND, JOINTS
from physicslab.prefabs import box
from physicslab.stepping.keyframe import Keyframe

LENGTH = 0.5


def chain(links: int, *, contacts: str = "auto", angle: float = 0.0, end: float = 1.0) -> World:
    """Return bars in a row from the origin on, a pin between any two, and one that holds the first."""
    world, last = World(simulation=SimulationConfig(contacts=contacts)), None
    along = np.array((math.cos(angle), math.sin(angle)))
    for i in range(links):
        bar = world.spawn(
            Transform(tuple((i + 0.5) * LENGTH * along), angle), Velocity(),
            Mass(end if i == links - 1 else 1.0), Shape.box(LENGTH, 0.05), name=f"bar{i}",
        )  # fmt: skip
        anchor = (0.0, 0.0) if last is None else (0.5 * LENGTH, 0.0)
        world.spawn(Pin(a=last, b=bar, anchor_a=anchor, anchor_b=(-0.5 * LENGTH, 0.0)), name=f"pin{i}")
        last = bar
    if contacts == "soft":
        box(world, (0, -50), width=1, height=1, static=True)
    return world


def stretch(world: World) -> float:
    """Return how far the points are apart that joints hold together [m]."""
    joints, transform, ends = world.joints, world.table(Transform), []
    for body, anchor in ((joints.a, joints.anchor_a), (joints.b, joints.anchor_b)):
        ends.append(transform["position"][body] + rotated(anchor, transform["angle"][body]))
    return float(np.abs(ends[1] - ends[0]).max())


def test_a_double_pendulum_of_bars_keeps_its_energy_to_1e_10() -> None:
    world = chain(2)
    world.step()
    before = measure_energy(world).total
    world.run(seconds=10.0)
    assert measure_energy(world).total == pytest.approx(before, abs=1e-10)
    assert stretch(world) < 1e-14
    assert world.stepper is not None and world.stepper.name == "flow"
    assert "their equations (4) are solved" in world.plan.reason


@pytest.mark.parametrize("method", ["rk4", "leapfrog", "implicit_midpoint"])
def test_any_method_takes_the_constrained_equations(method: str) -> None:
    world = chain(2)
    world.simulation = replace(world.simulation, integrator=method, dt=1e-3)
    before = measure_energy(world).total
    world.run(seconds=0.5)
    assert world.plan.integrator.name == method
    assert measure_energy(world).total == pytest.approx(before, abs=1e-4)
    assert stretch(world) < 1e-14


def test_the_force_in_a_pin_is_that_of_the_pendulum() -> None:
    world = chain(1, angle=-0.5 * math.pi)  # hangs at rest
    world.step()
    assert world.joints.force == pytest.approx([0.0, 9.81], abs=1e-12)
    world.component(world.entity("bar0"), Velocity).angular = 2.0
    world.component(world.entity("bar0"), Velocity).linear = (0.5, 0.0)
    world.step(1e-9)
    assert world.joints.force[1] == pytest.approx(9.81 + 0.25 * 2.0**2, rel=1e-6)


def test_redundant_joints_are_found_and_move_nothing_else() -> None:
    world = chain(1)
    bar = world.entity("bar0")
    world.spawn(Pin(a=bar, anchor_a=(0.0, 0.0), anchor_b=(0.25, 0.0)))  # the bar cannot move any more
    world.run(seconds=1.0)
    assert (int(world.joints.dependent.sum()), len(world.joints)) == (1, 4)
    assert tuple(world.component(bar, Transform).position) == pytest.approx((0.25, 0.0), abs=1e-12)


def test_a_wheel_that_is_driven_does_work_by_its_pin() -> None:
    world = World()
    world.physics = replace(world.physics, gravity_mode="none")
    wheel = world.spawn(Transform(), Velocity((0, 0), 2.0))
    weight = world.spawn(Transform((1.5, 0.0)), Velocity((0.0, 2.0)), Mass(1.0, inertia=0.1))
    world.spawn(Pin(a=wheel, b=weight, anchor_a=(1.0, 0.0), anchor_b=(-0.5, 0.0)))
    before = measure_energy(world).total
    world.run(seconds=3.0)
    gained, sums = measure_energy(world).total - before, world.account.sums
    assert abs(gained) > 0.1
    assert sums[HAND, ENERGY] == pytest.approx(gained, abs=1e-9)
    assert sums[JOINTS, ENERGY] == 0.0


@pytest.mark.parametrize("links", [1, 2])
def test_soft_pins_beside_contacts_hold_and_book_what_they_take(links: int) -> None:
    world = chain(links, contacts="soft")
    world.step()
    before = measure_energy(world).total
    world.run(seconds=3.0)
    assert world.stepper is not None and world.stepper.name == "fused_contact"
    assert stretch(world) < 1e-3
    lost = before - measure_energy(world).total
    assert 0.0 < lost < 0.5
    assert world.account.sums[:, ENERGY].sum() == pytest.approx(-lost, abs=1e-5)
    assert world.account.sums[JOINTS, ENERGY] == pytest.approx(-lost, abs=1e-5)


def test_a_pin_at_rest_carries_the_weight_below_soft_contacts() -> None:
    world = chain(3, contacts="soft", angle=-0.5 * math.pi, end=10.0)
    world.run(seconds=4.0)
    loads = [12 * 9.81, 11 * 9.81, 10 * 9.81]
    assert world.joints.force[1::2] == pytest.approx(loads, rel=2e-2)


def test_systems_called_one_by_one_give_the_bits_of_the_loop() -> None:
    from physicslab.systems.system import Stage, System, at

    class Looker(System):
        @at(Stage.SOLVE)
        def look(self, state: object, h: float) -> None:
            """Look at every substep."""

    worlds = chain(2, contacts="soft"), chain(2, contacts="soft")
    worlds[1].install(Looker())
    for world in worlds:
        for _ in range(20):
            world.step()
    tables = [world.table(Transform)["position"] for world in worlds]
    assert worlds[1].stepper is not None and worlds[1].stepper.name == "contact"
    np.testing.assert_array_equal(tables[0], tables[1])


def test_bodies_on_one_pin_pass_through_each_other_unless_they_collide() -> None:
    def turned(collide: bool) -> float:
        world = World()
        box(world, (0, 0), width=2, height=0.2, static=True, name="beam")
        arm = box(world, (-0.5, 0.6), width=1.5, height=0.2, name="arm")
        beam = world.entity("beam")
        world.spawn(Pin(a=beam, b=arm, anchor_a=(0.0, 0.6), anchor_b=(0.5, 0.0), collide=collide))
        world.run(seconds=0.6)
        return world.component(arm, Transform).angle

    assert turned(False) > 1.2
    assert turned(True) < 1.0


@pytest.mark.parametrize("contacts", ["soft", "auto"])
def test_a_loaded_and_a_restored_world_go_on_bit_for_bit(contacts: str, tmp_path: Path) -> None:
    world = chain(3, contacts=contacts)
    for _ in range(40):
        world.step()
    save_scene(world, tmp_path / "chain.json")
    frame, loaded = Keyframe(world), load_scene(tmp_path / "chain.json")
    for _ in range(40):
        world.step()
        loaded.step()
    there = world.table(Transform)["position"].copy()
    np.testing.assert_array_equal(loaded.table(Transform)["position"], there)
    frame.restore(world)
    for _ in range(40):
        world.step()
    np.testing.assert_array_equal(world.table(Transform)["position"], there)


def test_a_joint_goes_with_its_body() -> None:
    world = chain(2, contacts="soft")
    world.step()
    world.remove("bar1")
    world.step()
    assert [joint.entity for joint in world.joints.joints] == [world.entity("pin0")]
    with pytest.raises(KeyError):
        world.entity("pin1")


def test_what_a_joint_holds_together_sleeps_and_wakes_together() -> None:
    world = World(simulation=SimulationConfig(sleeping=True))
    box(world, (0, -0.5), width=20, height=1, static=True)
    left, right = (box(world, (x, 0.5), width=1, height=1) for x in (-1.5, 1.5))
    world.spawn(Pin(a=left, b=right, anchor_a=(1.5, 0.0), anchor_b=(-1.5, 0.0)), Name("pin"))
    world.run(seconds=3.0)
    rows = [world.entity_index.row_of[body] for body in (left, right)]
    assert world.sleep.asleep[rows].all()
    world.component(left, Velocity).linear = (0.0, 1.0)
    world.step()
    assert not world.sleep.asleep[rows].any()
    world.run(seconds=3.0)
    assert world.sleep.asleep[rows].all()
    world.discard("pin", Pin)
    world.synchronise()
    assert not world.sleep.asleep[rows].any(), "an edit of a joint wakes what it held"


BODIES = [
    {"id": "a", "Transform": {}, "Velocity": {}, "Mass": {}},
    {"id": "b", "Transform": {"position": [1, 0]}, "Velocity": {}, "Mass": {}},
    {"id": "note", "Note": {"text": "no place"}},
]


@pytest.mark.parametrize(
    ("pins", "words"),
    [
        ([{"a": "a", "b": "a"}], r'entity "p0": Pin.b = "a": must be another entity than a'),
        ([{}], r'entity "p0": Pin.b = null: must be a body where a is a point of the world'),
        ([{"a": "note"}], r'entity "p0": Pin.a = "note": must be the id of an entity with a Transform'),
        ([{"a": "x"}], r'entity "p0": Pin.a = "x": must be the id of an entity in this scene, or null'),
        ([{"a": "a", "anchor_a": [1e999, 0]}], r'entity "p0": Pin.anchor_a = .*: must be two finite numbers'),
        (
            [{"a": "a", "b": "b"}, {"a": "b", "b": "a"}],
            r'entity "p1": Pin.b = "a": must be other points than those that p0 joins',
        ),
    ],
)
def test_a_joint_that_joins_nothing_is_refused_by_name(pins: list[dict[str, object]], words: str) -> None:
    entities = [*BODIES, *({"id": f"p{n}", "Pin": pin} for n, pin in enumerate(pins))]
    with pytest.raises(SceneError, match=words):
        read_scene({"format": FORMAT, "entities": entities})


def test_the_same_is_refused_in_a_world() -> None:
    world = World()
    body = world.spawn(Transform(), Velocity(), Mass(), name="body")
    with pytest.raises(InvalidValue, match=r"Pin.b = 1: must be another entity than a"):
        world.spawn(Pin(a=body, b=body), name="pin")
    for name in ("one", "two"):
        world.spawn(Pin(a=body), name=name)
    with pytest.raises(InvalidValue, match=r"two: Pin.b = None: must be other points than those that one"):
        world.step()


@pytest.mark.parametrize("row", [["pin0"], ["pin0", "Rope", 1], ["bar0", "Pin", 1], ["pin0", "Pin", "x"]])
def test_impulses_of_what_is_no_joint_are_refused(row: list[object]) -> None:
    document = json.loads(json.dumps(write_scene(chain(1))))
    with pytest.raises(SceneError, match="scene: joints"):
        read_scene(document | {"joints": [row]})


def test_damping_is_part_of_the_constrained_equations() -> None:
    world = chain(1)
    world.physics = replace(world.physics, linear_damping=0.3, angular_damping=0.3)
    before = measure_energy(world).total
    world.run(seconds=2.0)
    lost = measure_energy(world).total - before
    assert stretch(world) < 1e-13
    assert world.account.sums[DAMPING, ENERGY] == pytest.approx(lost, abs=1e-10)


def test_what_joints_hold_has_no_closed_form_and_no_period_of_its_spring() -> None:
    world = World()
    bob = world.spawn(Transform((0.0, -1.0)), Velocity((0.1, 0.0)), Mass(1.0), Shape.circle(0.1))
    world.add(bob, Spring(rest_length=1.0, stiffness=50.0))
    assert period_of(world, bob) is not None
    world.spawn(Pin(b=bob, anchor_a=(0.0, -1.0)))
    assert reference_solution(world) is None
    assert period_of(world, bob) is None
    world.simulation = replace(world.simulation, integrator="exact")
    world.step()
    assert "the force of JointSystem has no closed form" in world.plan.refused


def test_forces_on_a_body_on_a_pin_sum_up_to_its_acceleration() -> None:
    world = chain(2)
    world.run(seconds=0.7)
    world.step(1e-4)
    bar = world.entity("bar0")
    forces, step = forces_on(world, bar), last_step(world, bar)
    assert [one.name for one in forces] == ["weight", "pin0", "pin1"]
    total = sum((one.force for one in forces), Vector2())
    assert step is not None
    assert tuple(total) == pytest.approx(tuple(step.inertia), rel=1e-2)


def test_the_force_of_a_joint_that_is_part_of_a_body_is_not_called_as_the_body() -> None:
    world = load_scene("pendulum")
    world.step()
    assert [one.name for one in forces_on(world, world.entity("bob"))] == ["weight", "rod"]


def test_a_light_bar_between_a_pin_and_a_heavy_one_costs_no_digits() -> None:
    world = chain(2, end=1e9)
    world.step()
    before = measure_energy(world).total
    world.run(seconds=1.0)
    assert measure_energy(world).total == pytest.approx(before, abs=1e9 * 9.81 * 1e-12)
