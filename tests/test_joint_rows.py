"""Kinds of joints as data: their rows, what is taken as placed, what is refused, what files keep."""

import json
import math
from pathlib import Path

import esper
import numpy as np
import pytest

from physicslab import World, load_scene, save_scene
from physicslab.components import Gear, Mass, Pin, Pulley, Rod, Rope, Slot, Transform, Velocity, Weld
from physicslab.ecs.component import COMPONENTS, InvalidValue
from physicslab.files.checks import SceneError
from physicslab.files.reader import FORMAT, read_scene
from physicslab.files.writer import write_scene
from physicslab.state.joint_rows import KINDS, Measure, Role


def joined() -> World:
    """Return a world with a joint of every kind between bodies that are turned and apart."""
    world = World()
    for n in range(4):
        place = Transform((1.0 + n / 3.0, 0.1 * n * n), 0.3 * n)
        world.spawn(place, Velocity(), Mass(1.0 + n, inertia=0.5), name=f"b{n}")
    one, two, three, four = (world.entity(f"b{n}") for n in range(4))
    world.spawn(Pin(a=one, b=two, lower=-1.0, upper=2.0, motor_speed=3.0, max_torque=4.0), name="pin")
    world.spawn(Slot(a=two, b=three, axis=(3.0, 4.0), upper=5.0, motor_speed=-1.0), name="slot")
    world.spawn(Weld(a=three, b=four, anchor_a=(0.2, 0.1)), name="weld")
    world.spawn(Rod(a=one, b=three, anchor_b=(0.1, 0.0)), name="rod")
    world.spawn(Rope(b=four, anchor_a=(0.0, 3.0), breaks=7.0), name="rope")
    world.spawn(Pulley(a=one, b=four, wheel_a=(0.0, 2.0), wheel_b=(2.0, 2.0), ratio=2.0), name="pulley")
    world.spawn(Gear(first=world.entity("pin"), second=world.entity("slot"), ratio=0.5), name="gear")
    world.synchronise()
    return world


def test_each_kind_has_its_rows() -> None:
    world = joined()
    joints, rows = world.joints, {}
    for joint in joints.joints:
        rows[joint.kind] = [
            (Measure(joints.measure[n]), Role(joints.role[n]))
            for n in range(joint.first, joint.first + joint.size)
        ]
    along, hold, limit, motor = Measure.ALONG_A, Role.HOLD, Role.LIMIT, Role.MOTOR
    point = [(Measure.ALONG, hold)] * 2
    assert rows == {
        Pin: [*point, (Measure.ANGLE, limit), (Measure.ANGLE, limit), (Measure.ANGLE, motor)],
        Slot: [(along, hold), (Measure.ANGLE, hold), (along, limit), (along, motor)],
        Weld: [*point, (Measure.ANGLE, hold)],
        Rod: [(Measure.DISTANCE, hold)],
        Rope: [(Measure.DISTANCE, limit)],
        Pulley: [(Measure.DISTANCE, limit)],
        Gear: [(along, hold)],
    }  # fmt: skip
    assert rows.keys() == KINDS.keys()
    assert len(joints.a) == len(joints) + 2
    assert joints.second[joints.second >= 0].tolist() == [len(joints), len(joints) + 1]
    strongest = joints.strongest[joints.role == Role.MOTOR]
    assert strongest.tolist() == [4.0, math.inf]


def test_what_is_not_given_is_taken_as_placed() -> None:
    world = joined()
    position, angle = world.table(Transform)["position"], world.table(Transform)["angle"]
    one, three, four = (world.entity_index.row_of[world.entity(f"b{n}")] for n in (0, 2, 3))
    assert world.component(world.entity("weld"), Weld).angle == angle[four] - angle[three]
    rope = world.component(world.entity("rope"), Rope)
    assert rope.is_given("length")
    assert rope.length == pytest.approx(np.hypot(*(position[four] - (0.0, 3.0))), rel=1e-15)
    pulley = world.component(world.entity("pulley"), Pulley).length
    wheels = np.hypot(*(position[one] - (0.0, 2.0))), np.hypot(*(position[four] - (2.0, 2.0)))
    assert pulley == pytest.approx(wheels[0] + 2.0 * wheels[1], rel=1e-15)
    rod = world.component(world.entity("rod"), Rod)
    length, rod.length = rod.length, 9.0
    world.component(world.entity("b0"), Transform).position = (-5.0, 0.0)
    world.synchronise()
    joint = next(joint for joint in world.joints.joints if joint.kind is Rod)
    assert world.joints.offset[joint.first] == 9.0
    rod.length = None
    world.synchronise()
    assert world.joints.offset[joint.first] == rod.length > length


def test_a_file_keeps_every_joint_bit_for_bit(tmp_path: Path) -> None:
    world = joined()
    save_scene(world, tmp_path / "joined.json")
    loaded = load_scene(tmp_path / "joined.json")
    loaded.synchronise()
    for kind in KINDS:
        for entity in world.batch(kind).entities.tolist():
            assert repr(loaded.component(entity, kind)) == repr(world.component(entity, kind))
    for name in ("measure", "a", "b", "scale", "offset", "axis", "role", "second", "strongest"):
        np.testing.assert_array_equal(getattr(loaded.joints, name), getattr(world.joints, name))
    assert json.dumps(write_scene(loaded)) == json.dumps(write_scene(world))


def test_rows_follow_an_edit() -> None:
    world = World()
    body = world.spawn(Transform((1.0, 0.0)), Velocity(), Mass(1.0, inertia=1.0))
    pin = world.spawn(Pin(b=body, anchor_b=(-1.0, 0.0)))
    world.step()
    assert len(world.joints) == 2
    world.component(pin, Pin).upper = 1.5
    world.synchronise()
    assert world.joints.role.tolist() == [Role.HOLD, Role.HOLD, Role.LIMIT]
    assert not world.plan.smooth
    world.component(pin, Pin).upper = None
    world.step()
    assert world.plan.smooth


def test_a_gear_goes_with_its_joint() -> None:
    world = joined()
    world.remove("b2")  # and with it what joins it: the slot, and the gear of that
    world.synchronise()
    assert [joint.kind for joint in world.joints.joints] == [Pin, Rope, Pulley]


BODIES = [
    {"id": "a", "Transform": {}, "Velocity": {}, "Mass": {}},
    {"id": "b", "Transform": {"position": [1, 0]}, "Velocity": {}, "Mass": {}},
    {"id": "both", "Pin": {"a": "a"}, "Slot": {"a": "b"}},
    {"id": "p", "Pin": {"a": "a", "b": "b"}}, {"id": "s", "Slot": {"a": "a", "b": "b"}},
]  # fmt: skip


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ({"Pin": {"a": "a", "lower": 1, "upper": 0.5}},
         r'"j": Pin.upper = 0.5: must be a finite number >= lower = 1 rad, or null'),
        ({"Pin": {"a": "a", "max_torque": -1}}, r"Pin.max_torque = -1: must be .* >= 0 N m or null"),
        ({"Slot": {"a": "b", "b": "a", "axis": [0, 0]}}, r"Slot.axis = \[0.0, 0.0\]: must be a direction"),
        ({"Rod": {"a": "a", "b": "b", "length": 0}}, r"Rod.length = 0: must be a finite number > 0 m"),
        ({"Rope": {"a": "a", "b": "a"}}, r'Rope.b = "a": must be another entity than a'),
        ({"Weld": {"a": "a", "b": "b", "breaks": -2}}, r"Weld.breaks = -2: must be .* >= 0 N or null"),
        ({"Pulley": {"a": "a", "b": "b", "ratio": 0}}, r"Pulley.ratio = 0: must be a finite number > 0"),
        ({"Gear": {"first": "a", "second": "p"}}, r'Gear.first = "a": must be the id of .* with a Pin or'),
        ({"Gear": {"first": "both", "second": "p"}}, r'Gear.first = "both": must be .*, and not both'),
        ({"Gear": {"first": "p", "second": "p"}}, r'Gear.second = "p": must be another entity than first'),
        ({"Gear": {"first": "p", "second": "s", "ratio": 0}}, r"Gear.ratio = 0.0: must be .* other"),
        ({"Gear": {"first": "p"}}, r'"j": Gear needs second: an entity or null'),
    ],
)  # fmt: skip
def test_what_joins_nothing_is_refused_by_name(parts: dict[str, object], words: str) -> None:
    with pytest.raises(SceneError, match=words):
        read_scene({"format": FORMAT, "entities": [*BODIES, {"id": "j", **parts}]})


@pytest.mark.parametrize("kind", sorted(KINDS, key=str))
def test_a_joint_twice_the_same_is_refused(kind: type[object]) -> None:
    ends = {"first": "p", "second": "s"} if kind is Gear else {"a": "a", "b": "b", "anchor_a": [3, 1]}
    twice = [{"id": f"j{n}", kind.__name__: ends} for n in range(2)]
    with pytest.raises(SceneError, match=f'"j1": {kind.__name__}.* = .*j0'):
        read_scene({"format": FORMAT, "entities": [*BODIES, *twice]})
    world = read_scene({"format": FORMAT, "entities": [*BODIES[:2], *BODIES[3:], twice[0]]})
    part = world.component(world.entity("j0"), COMPONENTS[kind.__name__])
    world.spawn(type(part)(**part.given()), name="again")
    with pytest.raises(InvalidValue, match=f"again: {kind.__name__}.* = .*: must be .* j0"):
        world.step()


def test_a_rod_between_two_points_in_one_place_has_no_length() -> None:
    world = World()
    body = world.spawn(Transform((1.0, 0.0)), Velocity(), Mass())
    world.spawn(Rod(b=body, anchor_a=(1.0, 0.0)), name="rod")
    with pytest.raises(InvalidValue, match=r"Rod.length = 0.0: must be .* > 0 m.* in one place$"):
        world.step()


def test_a_file_with_such_a_rod_is_refused_when_it_is_read() -> None:
    rod = {"id": "rod", "Rod": {"a": "a", "b": "b"}}
    one, other = ({**body, "Transform": {}} for body in BODIES[:2])
    active = esper.current_world
    with pytest.raises(SceneError, match=r"^knot.json: rod: Rod.length = 0.0: must be .* in one place$"):
        read_scene({"format": FORMAT, "entities": [one, other, rod]}, "knot.json")
    assert esper.current_world == active
