"""Joints that break, and joints that contradict each other: told, and nothing else moves."""

import json
import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from physicslab import World, load_scene, save_scene
from physicslab.cli import main
from physicslab.components import Gear, Mass, Medium, Pin, Rod, Rope, Shape, Transform, Velocity, Weld
from physicslab.diagnostics.energy import measure_account
from physicslab.diagnostics.step_watch import StepWatch
from physicslab.diagnostics.warnings import find_warnings
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.prefabs import box
from physicslab.stepping.keyframe import Keyframe
from physicslab.systems.breaking import breaks_of


def swing(contacts: str = "auto") -> World:
    """Return a bob on a rope that breaks at 2.5 times its weight, let go level: it does on its way down."""
    world = World(simulation=SimulationConfig(contacts=contacts))
    if contacts == "soft":
        box(world, (0.0, -50.0), width=1.0, height=1.0, static=True)
    bob = world.spawn(Transform((1.0, 0.0)), Velocity(), Mass(2.0), Shape.circle(0.1), name="bob")
    world.spawn(Rope(b=bob, length=1.0, breaks=2.5 * 2.0 * 9.81), name="rope")
    return world


@pytest.mark.parametrize("contacts", ["auto", "soft"])
def test_a_rope_breaks_once_is_told_and_can_be_undone(contacts: str) -> None:
    world = swing(contacts)
    world.run(seconds=0.2)
    frame, watch = Keyframe(world), StepWatch(world)
    world.run(seconds=0.6)
    (broken,) = breaks_of(world.schedule.systems, world.time)
    # 3 m g sin(angle) of a pendulum that was let go level
    assert broken.force == pytest.approx(2.5 * 2.0 * 9.81, rel=0.03)
    assert "rope broke at t = 0." in watch.note_breaks()
    assert watch.note_breaks() == ""
    assert not len(world.batch(Rope))
    place = tuple(world.component(world.entity("bob"), Transform).position)
    frame.restore(world)
    assert len(world.batch(Rope)) == 1
    assert breaks_of(world.schedule.systems, world.time) == ()
    world.run(seconds=0.6)
    assert tuple(world.component(world.entity("bob"), Transform).position) == place
    assert breaks_of(world.schedule.systems, world.time) == (broken,)


@pytest.mark.parametrize("dt", [1.0 / 60.0, 1.0 / 7.0])
@pytest.mark.parametrize("kind", [Rod, Rope])
def test_an_exact_joint_breaks_at_its_own_time(kind: type[Rod] | type[Rope], dt: float) -> None:
    # 3 m g sin(angle) is 2.5 m g; the time from level to there by quadrature, angle = a u^2
    angle, g = math.asin(2.5 / 3.0), 9.81
    u, weights = np.polynomial.legendre.leggauss(60)
    u = 0.5 * (u + 1.0)
    time = weights @ (u * angle / np.sqrt(2.0 * g * np.sin(angle * u * u)))
    world = World()
    bob = world.spawn(Transform((1.0, 0.0)), Velocity(), Mass(2.0))
    world.spawn(kind(b=bob, length=1.0, breaks=2.5 * 2.0 * g))
    for _ in range(math.ceil(0.6 / dt)):
        world.step(dt)
    (broken,) = breaks_of(world.schedule.systems, world.time)
    assert broken.time == pytest.approx(time, abs=1e-11)
    assert broken.force == pytest.approx(2.5 * 2.0 * g, rel=1e-10)
    speed, left = math.sqrt(2.0 * g * math.sin(angle)), world.time - time
    falls = -math.sin(angle) - speed * math.cos(angle) * left - 0.5 * g * left * left
    assert world.component(bob, Transform).position.y == pytest.approx(falls, abs=1e-10)
    assert world.steps == math.ceil(0.6 / dt)


def test_joints_that_break_within_one_step_do_so_one_after_the_other() -> None:
    world = World()
    for x, bears in ((0.0, 1.0), (9.0, 1.000001)):
        bob = world.spawn(Transform((x + 1.0, 0.0)), Velocity(), Mass(1.0))
        world.spawn(Rod(b=bob, length=1.0, anchor_a=(x, 0.0), breaks=bears * 9.81))
    weight = world.spawn(Transform((20.0, 0.0)), Velocity(), Mass(1.0))
    world.spawn(Rope(b=weight, length=1.0, anchor_a=(20.0, 1.0), breaks=0.0), name="overloaded")
    world.run(seconds=0.5)
    broke = [one.time for one in breaks_of(world.schedule.systems, world.time)]
    assert broke[0] == pytest.approx(0.0, abs=1e-9)
    assert 0.0 < broke[2] - broke[1] < 1e-5
    assert abs(measure_account(world).energy["numerical"]) < 1e-9


def test_a_weld_breaks_by_its_torque_and_a_gear_goes_with_its_pin() -> None:
    world = World()
    arm = world.spawn(Transform((0.5, 0.0)), Velocity(), Mass(1.0), Shape.box(1.0, 0.1))
    world.spawn(Weld(b=arm, anchor_b=(-0.5, 0.0), breaks_torque=4.0), name="weld")
    pins = []
    for x in (5.0, 8.0):
        wheel = world.spawn(Transform((x, 0.0)), Velocity(), Mass(1.0, inertia=1.0))
        pins.append(world.spawn(Pin(b=wheel, anchor_a=(x, 0.0), breaks=5.0 if x == 5.0 else None)))
    world.spawn(Gear(first=pins[0], second=pins[1]))
    world.run(seconds=0.1)
    assert [one.kind for one in breaks_of(world.schedule.systems, world.time)] == ["Pin", "Weld"]
    assert [joint.kind for joint in world.joints.joints] == [Pin]


def test_the_report_has_forces_and_what_broke(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    world = swing()
    world.spawn(
        Pin(a=world.spawn(Transform((9.0, 0.0)), Velocity(), Mass(3.0)), anchor_b=(9.0, 0.0)), name="pin"
    )
    save_scene(world, tmp_path / "swing.json")
    main(["run", str(tmp_path / "swing.json"), "--seconds", "0.8", "--json", "-"])
    captured = capsys.readouterr()
    report = json.loads(captured.out)
    assert [one["label"] for one in report["broken"]] == ["rope"]
    assert "rope broke at t = " in captured.err
    assert report["joints"]["pin"]["force"] == pytest.approx([0.0, -3.0 * 9.81], abs=1e-9)
    assert report["joints"]["pin"]["torque"] == 0.0


@pytest.mark.parametrize("contacts", ["auto", "soft"])
def test_pins_that_contradict_each_other_are_told_and_nothing_explodes(contacts: str) -> None:
    world = World(simulation=SimulationConfig(contacts=contacts))
    if contacts == "soft":
        box(world, (0.0, -50.0), width=1.0, height=1.0, static=True)
    bar = world.spawn(Transform(), Velocity(), Mass(1.0), Shape.box(1.0, 0.1))
    for n, side in enumerate((-1.0, 1.0)):
        world.spawn(Pin(b=bar, anchor_a=(0.6 * side, 0.0), anchor_b=(0.5 * side, 0.0)), name=f"pin{n}")
    world.run(seconds=1.0)
    assert np.abs(world.table(Velocity)["linear"]).max() < 1e-6
    (told,) = [one for one in find_warnings(world) if "contradicts" in one.what]
    assert told.entity in ("pin0", "pin1")
    assert str(told).startswith(f"{told.entity}: contradicts other joints: not all can be kept: ")


def test_a_joint_that_holds_what_is_held_is_told() -> None:
    world = World()
    bar = world.spawn(Transform(), Velocity(), Mass(1.0), Shape.box(1.0, 0.1))
    for side in (-0.5, 0.5):
        world.spawn(Pin(b=bar, anchor_a=(side, 0.0), anchor_b=(side, 0.0)))
    world.run(seconds=0.1)
    assert [one.value for one in find_warnings(world) if "joints hold already" in one.what] == [1.0]


def test_what_joints_contradict_about_can_be_saved_and_read_again(tmp_path: Path) -> None:
    world = World()
    bob = world.spawn(Transform((1.0, 0.0)), Velocity(), Mass(1.0), name="bob")
    for side in (0.0, 5.0):
        world.spawn(Rod(None, bob, anchor_a=(side, 0.0), length=1.0))
    for _ in range(4):
        world.run(steps=3)
        save_scene(world, tmp_path / "kept.json")
        again = load_scene(tmp_path / "kept.json")
        places = [one.component(one.entity("bob"), Transform).position for one in (world, again)]
        assert places[0] == places[1]
    told = [str(advice) for advice in find_warnings(world)]
    assert any("contradicts other joints" in line for line in told) and not any(
        "substeps" in line for line in told
    )


def rods_that_break(kind: str) -> World:
    """Return a world with rods that break on the way: alone, beside what bounces, or in a heap."""
    world = World(
        physics=PhysicsConfig(bounds=None if kind == "smooth" else (-2, 0, 2, 5)),
        simulation=SimulationConfig(contacts="soft" if kind == "soft" else "auto"),
    )
    for x, bears in ((500.0, 2.5), (520.0, 2.6)) if kind != "soft" else ():
        bob = world.spawn(Transform((x + 1.0, 0.0)), Velocity(), Mass(2.0))
        world.spawn(Rod(b=bob, length=1.0, anchor_a=(x, 0.0), breaks=bears * 2.0 * 9.81))
    boxes = [box(world, (-1.5 + 0.6 * k, 0.5 + 0.2 * k), width=0.3, height=0.3) for k in range(6)]
    if kind == "soft":
        for one, other in pairwise(boxes):
            world.spawn(Rod(one, other, breaks=15.0))
    return world


@pytest.mark.parametrize("kind", ["smooth", "rigid", "soft"])
def test_joints_break_in_runs_of_many_steps_as_in_single_ones(
    kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    worlds = [rods_that_break(kind) for _ in range(2)]
    for _ in range(90):
        worlds[0].step()
    advance, calls = World.advance, 0

    def counted(world: World, h: float, steps: int) -> int:
        nonlocal calls
        calls += world is worlds[1]
        return advance(world, h, steps)

    monkeypatch.setattr(World, "advance", counted)
    worlds[1].run(steps=90)
    expected, broken = (breaks_of(world.schedule.systems, world.time) for world in worlds)
    assert 2 <= len(broken) == len(expected) and calls < 45
    for one, other in zip(broken, expected, strict=True):
        assert one[1:3] == other[1:3] and one.time == pytest.approx(other.time, abs=1e-11)
    columns = [(world.table(Transform)["position"], world.table(Velocity)["linear"]) for world in worlds]
    exact = 0.0 if kind == "soft" else 1e-9
    for one, other in zip(*columns, strict=True):
        assert np.allclose(one, other, rtol=0.0, atol=exact)


def test_a_joint_that_is_told_on_the_way_to_break_does() -> None:
    world = swing()
    world.component(world.entity("rope"), Rope).breaks = None
    world.run(seconds=0.1)
    world.component(world.entity("rope"), Rope).breaks = 1.0
    world.run(seconds=0.1)
    assert [one.label for one in breaks_of(world.schedule.systems, world.time)] == ["rope"]


def test_a_step_tried_by_soft_contacts_breaks_nothing_before_the_moment_is_found() -> None:
    """The motor pulls the ball to the bar: shorter steps of the last one are left to soft contacts."""
    ball, bar, weight = Shape.circle(0.3), Shape.capsule(0.52, 0.12), Shape.circle(0.39)
    world = World()
    world.spawn(Transform((1.2, 1.6), 2.0), Velocity((-1.3, 0.9), -3.4), Mass(0.1), ball, name="ball")
    world.spawn(Transform((2.5, 1.0), 2.8), Velocity((-0.1, -1.1), 0.9), bar, name="bar")
    world.spawn(Transform((5.1, 1.5), 1.2), Velocity((-2.2, -1.8), -7.9), Mass(1.5), weight, name="weight")
    joint = Pin("ball", "weight", (-0.9, -1.8), (-0.6, 1.9), motor_speed=4.6, breaks=4.2)
    world.spawn(joint)
    water = Shape.box(20.0, 2.0), Medium(density=1.35, quadratic=1.37)
    world.spawn(Transform((0.0, -1.0)), *water)
    for _ in range(60):
        world.step()
    assert len(world.joints) == 0
    assert world.time == pytest.approx(1.0, abs=1e-12)
