"""What is told of joints: those in line, those that contradict each other, those that do nothing."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from physicslab import World, load_scene, save_scene
from physicslab.components import Mass, Pin, Pulley, Rod, Shape, Slot, Spring, Transform, Velocity, Weld
from physicslab.diagnostics.energy import measure_account, measure_energy
from physicslab.diagnostics.joints import joint_states
from physicslab.diagnostics.warnings import ModelWarning, WorstWarnings, find_warnings
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.files.assignments import assign
from physicslab.files.checks import SceneError
from physicslab.prefabs import box, circle
from physicslab.state import joint_figures
from physicslab.state.joint_rows import Measure, Term, measured
from physicslab.state.joints import Joints
from physicslab.state.state import State
from physicslab.stepping.flow import Flow, NotSmooth
from physicslab.stepping.plan import WITHOUT_END
from physicslab.systems.standard import standard_systems


def world_with(*joints: Any, **more: tuple[Any, ...]) -> World:
    """Return a world with a bob of 1 kg at the origin, and joints named ``joint 1`` and so on."""
    world = World(*standard_systems())
    world.spawn(Transform((0.0, 0.0)), Velocity(), Mass(1.0), name="bob")
    for name, parts in more.items():
        world.spawn(*parts, name=name)
    for number, (kind, fields) in enumerate(joints, 1):
        world.spawn(kind(**fields), name=f"joint {number}")
    return world


def told(world: World) -> list[str]:
    return [str(advice) for advice in find_warnings(world)]


def between_walls(**length: float) -> World:
    rods = [(Rod, {"a": 1, "anchor_b": (x, 0.0), **length}) for x in (2.5, -2.5)]
    return world_with(*rods)


def test_rods_in_line_that_contradict_each_other_are_told_and_the_world_goes_on() -> None:
    world = between_walls(length=1.0)
    world.run(seconds=0.5)
    assert world.plan.integrator.name == "leapfrog"
    assert "without limit" in world.plan.reason
    (advice,) = (one for one in told(world) if "joint" in one)
    assert "contradicts other joints" in advice


def test_a_body_in_line_between_rods_that_fit_stays_there() -> None:
    # Its weight needs forces without limit; soft joints give a little.
    world = between_walls()
    for _ in world.stepping(seconds=1.0, stride=20):
        x, y = world.component(1, Transform).position
        assert abs(x) < 1e-9
        assert -2e-3 < y <= 0.0
    assert max(joint.stretch for joint in joint_states(world)) < 1e-4


def test_soft_joints_go_on_from_a_file_with_the_same_bits(tmp_path: Path) -> None:
    world = between_walls()
    world.run(steps=20)
    save_scene(world, tmp_path / "line.json")
    again = load_scene(tmp_path / "line.json")
    for each in (world, again):
        each.run(steps=20)
        assert each.plan.contact_reason == WITHOUT_END
    assert world.table(Transform)["position"].tobytes() == again.table(Transform)["position"].tobytes()


def test_steps_made_before_such_a_moment_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    world, made = world_with((Rod, {"a": 1, "anchor_b": (0.0, 1.0)})), []
    flow = Flow._flow

    def fails_at_last(self: Flow, state: State, short: float, pieces: int, steps: int, **how: bool) -> None:
        if state.time > 0.5:
            raise NotSmooth("a line is reached")
        made.append(steps)
        flow(self, state, short, pieces, steps, **how)

    monkeypatch.setattr(Flow, "_flow", fails_at_last)
    world.run(steps=60)
    assert sum(made) == 32
    assert world.steps == 60
    assert world.plan.integrator.name == "leapfrog"


def test_joints_of_what_cannot_move_are_told() -> None:
    posts = {name: (Transform((x, 5.0)), Shape.circle(0.1)) for name, x in (("p", 0.0), ("q", 2.0))}
    world = world_with((Rod, {"a": 2, "b": 3, "length": 1.0}), (Pin, {"a": 1}), **posts)
    world.step()
    assert told(world) == [
        "joint 1: joins what no force moves, and does nothing; a Mass and a Velocity at one end would help"
    ]


def test_a_rod_without_length_is_told_to_have_no_direction() -> None:
    world = world_with((Rod, {"a": 1, "anchor_b": (0.0, 1.0), "length": 1e-300}))
    world.step()
    assert any(one.startswith("joint 1: has both ends in one place") for one in told(world))


def test_a_rod_or_a_spring_between_two_bodies_in_one_place_is_told_to_have_no_direction() -> None:
    """A rod alone was said to contradict other joints, and a spring nothing."""
    words = "joint 1: has both ends in one place, where a distance has no direction; places apart would help"
    for kind, name in ((Rod, "length"), (Spring, "rest_length")):
        fields = {"a": 1, "b": 2, name: 1.0}
        world = world_with((kind, fields), other=(Transform(), Velocity(), Mass(1.0)))
        world.step()
        assert told(world) == [words]
    world.component("joint 1", Spring).rest_length = 0.0
    assert not told(world)


def test_a_straight_chain_at_the_origin_is_not_far_away() -> None:
    ground = (Transform(), Shape.chain([(5.0, 0.0), (-5.0, 0.0)]))
    world = world_with((Rod, {"a": 1, "b": 2, "anchor_b": (0.0, -1.0)}), ground=ground)
    world.step()
    assert not told(world)


def test_an_axis_without_all_its_digits_is_refused() -> None:
    with pytest.raises(InvalidValue, match=r"Slot.axis = \(1e-320, 0.0\): must be a direction"):
        Slot(axis=(1e-320, 0.0))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("joint 1.Pin.motor_speed=-inf", "'-inf' is not finite"),
        ("joint 1.Pin.motor_speed=nan", "'nan' is not finite"),
        ("wheel.Shape.kind=chain", 'Shape.kind = "chain": with it radius = 0.5 must be left out'),
    ],
)
def test_assignments_are_refused_by_what_is_wrong(text: str, words: str) -> None:
    wheel = (Transform((3.0, 0.0)), Velocity(), Mass(1.0), Shape.circle(0.5))
    world = world_with((Pin, {"a": 1}), wheel=wheel)
    world.synchronise()
    with pytest.raises(SceneError) as refused:
        assign(world, [text])
    assert words in str(refused.value)


def term_of(joints: Joints, n: int) -> Term:
    (ax, ay), (bx, by), (x, y) = (
        array[n].tolist() for array in (joints.anchor_a, joints.anchor_b, joints.axis)
    )
    ends = Measure(joints.measure[n]), int(joints.a[n]), int(joints.b[n])
    return Term(*ends, (ax, ay), (bx, by), (x, y), float(joints.scale[n]))


def test_figures_of_all_joints_are_those_of_their_terms_one_by_one() -> None:
    other = (Transform((1.0, 0.5), 0.4), Velocity((0.3, 0.2), 1.0), Mass(2.0), Shape.box(1.0, 0.4))
    joints = (
        (Pin, {"a": 1, "b": 2, "anchor_b": (-0.3, 0.1), "lower": -1.0}),
        (Weld, {"a": 2, "anchor_b": (1.0, 0.5)}),
        (Slot, {"b": 1, "axis": (1.0, 1.0)}),
    )
    world = world_with(*joints, bar=other)
    world.step()
    for n, found in enumerate(joint_figures.measured_terms(world)):
        assert found == pytest.approx(measured(term_of(world.joints, n), world.entity_index)[:-1], abs=1e-15)
    on_bodies = np.zeros_like(world.bodies.force)
    for row in range(1, 3):
        on_bodies[row] = sum(joint_figures.forces_on(world, row).values())
    assert joint_figures.forces_on_all(world)[1:] == pytest.approx(on_bodies[1:])
    force = {joint.kind: np.array(tuple(joint.force)) for joint in joint_states(world)}
    assert on_bodies[2] == pytest.approx(force[Pin] - force[Weld])
    assert on_bodies[1] == pytest.approx(force[Slot] - force[Pin])


def test_a_ball_on_a_taut_bridge_leaves_it_to_soft_joints_and_loses_nothing_unsaid() -> None:
    # Ten planks in line between fixed points: their pull has no limit, so that events would never end.
    world, last = World(*standard_systems()), None
    for k in range(10):
        plank = box(world, (k - 4.5, 0.0), width=0.9, height=0.2, mass=10.0)
        begin = (0.5, 0.0) if last else (-5.0, 0.0)
        world.spawn(Pin(a=last, b=plank, anchor_a=begin, anchor_b=(-0.5, 0.0)))
        last = plank
    world.spawn(Pin(a=last, anchor_a=(0.5, 0.0), anchor_b=(5.0, 0.0)))
    circle(world, (0.3, 2.0), radius=0.5, mass=50.0)
    world.run(seconds=1.5)
    assert (world.plan.contacts, world.plan.contact_reason) == ("soft", WITHOUT_END)
    assert abs(measure_account(world).energy["numerical"]) < 1e-9
    assert max(joint.largest_stretch for joint in joint_states(world)) < 0.01
    assert all("rigid" not in advice for advice in told(world))


@pytest.mark.parametrize("touches", [False, True])
@pytest.mark.parametrize(("kind", "fields"), [(Rod, {"length": 1.0}), (Pin, {}), (Weld, {})])
def test_what_closing_a_joint_gives_that_was_put_apart_is_work_of_joints(
    kind: Any, fields: dict[str, float], touches: bool
) -> None:
    world = world_with((kind, {"b": 1, "anchor_a": (3.0, 6.0), **fields}))
    if touches:
        for x in (0.0, 9.0):
            circle(world, (x, -20.0))
    world.step()
    accounts = measure_account(world)
    assert accounts.energy["joints"] > 40.0, "1 kg was lifted by some 5 m"
    assert abs(accounts.energy["numerical"]) < 1e-9
    assert accounts.momentum["numerical"].magnitude < 1e-9


@pytest.mark.parametrize("holds", [Pin, Weld])
def test_limits_that_joints_contradict_book_no_energy_as_an_error(holds: Any) -> None:
    # Soft joints reach the limit to rounding; an exact step would then close the other joint by a jump.
    world = World(*standard_systems())
    world.spawn(Transform((0.5, 0.0)), Velocity(), Mass(1.0, 0.1))
    world.spawn(Pin(b=1, anchor_b=(-0.5, 0.0), lower=0.3, upper=1.0))
    world.spawn(holds(b=1, anchor_a=(1.0, 0.0), anchor_b=(0.5, 0.0)), name="second")
    world.run(steps=60)
    assert abs(measure_account(world).energy["numerical"]) < 1e-9
    assert any("second: contradicts other joints" in one for one in told(world))


@pytest.mark.parametrize("strongest", [1.0, 1e9])
def test_a_brake_at_a_limit_of_its_own_pin_holds_nothing_twice(strongest: float) -> None:
    world = World(*standard_systems(), simulation=SimulationConfig(contacts="soft"))
    world.spawn(Transform((0.5, 0.0)), Velocity(), Mass(1.0, 0.1))
    world.spawn(Pin(b=1, anchor_b=(-0.5, 0.0), lower=0.0, motor_speed=0.0, max_torque=strongest))
    world.run(steps=5)
    assert not told(world)


def test_what_turns_too_easily_for_its_joints_is_told_with_an_inertia_that_helps() -> None:
    def lost(inertia: float) -> tuple[float, list[str]]:
        world = World(*standard_systems())
        world.spawn(Transform((0.3, 0.0)), Velocity(), Mass(1.0, 0.1), name="arm")
        world.spawn(Transform((0.6, -0.3)), Velocity(), Mass(1.0, inertia), name="end")
        world.spawn(Pin(b=1, anchor_b=(-0.3, 0.0)))
        world.spawn(Weld(a=1, b=2, anchor_a=(0.3, 0.0), anchor_b=(0.0, 0.3)))
        world.run(seconds=2.0)
        return abs(measure_account(world).energy["numerical"]), told(world)

    error, (advice,) = lost(1e-8)
    assert error > 5e-6
    assert "(mass * arm^2 / inertia): 9e+06, well up to 1e+06; Mass.inertia = 9.09e-08 would help" in advice
    assert advice.startswith("end: turns too easily")
    error, advices = lost(9.09e-8)
    assert error < 2e-7
    assert not advices


@pytest.mark.parametrize(("size", "gives_way"), [(6, False), (12, True)])
def test_a_sheet_of_welded_boxes_gives_way_under_a_load_if_it_is_large_and_gains_nothing(
    size: int, gives_way: bool
) -> None:
    """Joints of a large sheet are solved one by one; rigid, each in turn, they gained 1e30 J in 4 s."""
    world = World(*standard_systems(), simulation=SimulationConfig(contacts="soft"))
    boxes: dict[tuple[int, int], int] = {}
    for i, j in np.ndindex(size, size):
        mass = 2000.0 if j == size - 1 else 1.0
        boxes[i, j] = world.spawn(Transform((i, -j)), Velocity(), Mass(mass), Shape.box(1.0, 1.0))
        for other, arm in (((i - 1, j), (0.5, 0.0)), ((i, j - 1), (0.0, -0.5))):
            held = {"a": boxes[other], "anchor_a": arm} if other in boxes else {"anchor_a": (i, 0.5)}
            if other in boxes or other[1] < 0:
                world.spawn(Weld(b=boxes[i, j], anchor_b=(-arm[0], -arm[1]), **held))
    before = world.energy.total
    for _ in range(10):
        world.run(steps=12)
        assert world.energy.total <= before + 1e-9 * abs(before)
    assert world.joints.blocks.gives_way.any() == gives_way
    (advice,) = [one for one in told(world) if "joint" in one]
    assert ("gives way as a spring does" if gives_way else "holds what other joints hold already") in advice


def test_a_number_as_placed_that_cannot_be_is_refused_with_the_joint_that_has_it() -> None:
    world = world_with((Rod, {"a": 1}))
    with pytest.raises(InvalidValue, match=r"^joint 1: Rod\.length = 0\.0: must be a finite number > 0 m"):
        world.synchronise()


@pytest.mark.parametrize(
    ("ratio", "hung", "warns"), [(1e3, False, False), (1e4, False, True), (1e4, True, False)]
)
def test_a_body_that_stands_with_a_far_heavier_one_welded_on_is_named(
    ratio: float, hung: bool, warns: bool
) -> None:
    world = World(*standard_systems(), simulation=SimulationConfig(contacts="soft"))
    box(world, (0.0, -0.5), width=9.0, height=1.0, static=True)
    light = box(world, (0.0, 0.5), width=1.0, height=1.0)
    heavy = box(world, (0.0, 1.5), width=1.0, height=1.0, mass=ratio)
    world.spawn(Weld(a=light, b=heavy, anchor_a=(0.0, 0.5), anchor_b=(0.0, -0.5)))
    if hung:
        world.spawn(Weld(b=heavy, anchor_a=(0.0, 1.5)))
    world.run(steps=2)
    advices = [one for one in told(world) if "welded on" in one]
    assert len(advices) == warns
    assert all("mass ratio): 1e+04" in one and 'contacts = "rigid"' in one for one in advices)


@pytest.mark.parametrize("contacts", ["soft", "rigid"])
def test_what_soft_joints_take_of_bodies_that_bounce_is_told(contacts: str) -> None:
    """Eight elastic pairs of discs on rods fly at one of their own, across the rods."""
    world = World(physics=PhysicsConfig(gravity=Vector2()), simulation=SimulationConfig(contacts=contacts))
    for n in range(8):
        for x, vx in ((-1.0, 1.0), (1.0, -1.0)):
            low = 3.0 * n if x < 0.0 else 3.0 * n + 0.4
            one, other = (
                circle(world, (x, y), radius=0.15, velocity=(vx, 0.0), restitution=1.0, friction=0.0)
                for y in (low, low + 0.5)
            )
            world.spawn(Rod(one, other))
    before = measure_energy(world).total
    world.run(seconds=1.5)
    kept = measure_energy(world).total / before
    assert kept == pytest.approx(1.0, rel=1e-9) if contacts == "rigid" else kept < 0.95
    warned = [advice for advice in find_warnings(world) if "without its joints" in str(advice)]
    assert bool(warned) == (contacts == "soft")
    if warned:
        assert warned[0].setting == 'simulation.contacts = "rigid"'


def test_what_is_light_before_a_heavy_load_is_no_contradiction_and_the_substeps_that_are_named_hold() -> None:
    """The rods were apart by metres and said to contradict each other, and no setting to help."""
    world = World(simulation=SimulationConfig(contacts="soft"))
    box(world, (0.0, -9.0), width=9.0, height=1.0, static=True)
    for x, mass, above in ((1.0, 1.0, None), (2.0, 1e6, 1)):
        circle(world, (x, 0.0), radius=0.1, mass=mass, name=f"ball {x:g}")
        world.spawn(Rod(a=above and "ball 1", b=f"ball {x:g}"))
    world.mark()
    world.run(seconds=1.0)
    (advice,) = [one for one in find_warnings(world) if "does not hold what it joins" in one.what]
    assert not [one for one in find_warnings(world) if "contradicts" in one.what]
    assert (advice.value or 0.0) > 1.0 and advice.setting == "simulation.substeps = 74"
    world.reset()
    world.simulation = replace(world.simulation, substeps=74)
    world.run(seconds=1.0)
    assert not [*find_warnings(world)] and max(joint_figures.figures_of(world).stretch) < 1e-4


@pytest.mark.parametrize("substeps", [1, 4])
def test_substeps_that_are_named_are_enough_where_a_rope_comes_to_its_wheel_at_a_speed(substeps: int) -> None:
    """Twice as many were named, and then again: joints give by the way in a substep, not by a load."""
    world = World(simulation=SimulationConfig(substeps=substeps))
    for x, mass, name in ((-1.0, 2.4, "heavy"), (1.0, 0.3, "light")):
        circle(world, (x, -3.0), radius=0.1, mass=mass, name=name)
    world.spawn(Pulley(a="heavy", b="light", wheel_a=(-1.0, 0.0), wheel_b=(1.0, 0.0), ratio=2.0), name="rope")
    world.mark()

    def advised() -> list[ModelWarning]:
        worst = WorstWarnings()
        for _ in range(120):
            world.step()
            worst.add(find_warnings(world))
        return [*worst.all]

    (advice,) = [one for one in advised() if "does not hold what it joins" in one.what]
    assert world.plan.contact_reason == WITHOUT_END
    world.reset()
    world.simulation = replace(world.simulation, substeps=int(advice.setting.split()[-1]))
    (left,) = advised()
    assert "joints are soft" in left.what and left.entity == "rope" and 0.0 < (left.value or 0.0) < 0.09
    assert abs(world.component("light", Transform).position.y) < 0.01
