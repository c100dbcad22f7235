"""Joints beside soft contacts: every kind, its limits and motors, heavy loads, and where its work goes."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from numpy.typing import NDArray
from random_edits import bits

from physicslab import World, load_scene, save_scene
from physicslab.components import (
    Gear,
    Held,
    Layer,
    Mass,
    Pin,
    Pulley,
    Rod,
    Rope,
    Shape,
    Slot,
    Transform,
    Velocity,
    Weld,
)
from physicslab.components.layer import NONE
from physicslab.contacts.arguments import inverse_in, joints_in, motion_of, near_in, shapes_of
from physicslab.diagnostics.energy import measure_account, measure_energy, measure_momentum
from physicslab.diagnostics.joints import JointState, joint_states
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.vector import Vector2
from physicslab.history import History, SetField
from physicslab.kernels.accounts import ANGULAR_MOMENTUM, ENERGY, JOINTS, MOTORS
from physicslab.kernels.solver.finer import needed_factor
from physicslab.prefabs import box, circle
from physicslab.state.joint_order import Blocks, order_rows
from physicslab.state.joint_rows import Measure, Row, Term
from physicslab.systems.resolve import ResolveSystem

G = 9.81


def bench(*, gravity: float = G) -> World:
    """Return a world with soft contacts, and a rock far away."""
    world = World(
        physics=PhysicsConfig(gravity=Vector2(0.0, -gravity)), simulation=SimulationConfig(contacts="soft")
    )
    box(world, (0.0, -500.0), width=1.0, height=1.0, static=True)
    return world


def bars(world: World, count: int, kind: type[Any], end: float = 1.0, angle: float = 0.0) -> int:
    """Spawn bars of .5 m in a row from the origin on, joined; return the last, of ``end`` kg."""
    last: int | None = None
    along = np.array((math.cos(angle), math.sin(angle)))
    for n in range(count):
        place = Transform(tuple((0.5 * n + 0.25) * along), angle)
        bar = world.spawn(place, Velocity(), Mass(end if n == count - 1 else 1.0), Shape.box(0.5, 0.05))
        at = (0.0, 0.0) if last is None else (0.25, 0.0)
        world.spawn(kind(a=last, b=bar, anchor_a=at, anchor_b=(-0.25, 0.0)))
        last = bar
    assert last is not None
    return last


def test_a_cloth_of_rods_is_solved_at_once_and_hardly_stretches() -> None:
    """Its 1,104 rods, solved in turn, let the corners by which it hangs stretch by 15 %."""
    world, size = bench(), 24
    discs = {
        at: circle(world, (0.5 * at[0], -0.5 * at[1]), radius=0.05, mass=1.0) for at in np.ndindex(size, size)
    }
    for (i, j), disc in discs.items():
        for other in ((i - 1, j), (i, j - 1)):
            if other in discs:
                world.spawn(Rod(discs[other], disc))
    for i in (0, size - 1):
        world.spawn(Rod(None, discs[i, 0], anchor_a=(0.5 * i, 0.5)))
    for _ in range(10):
        world.run(steps=6)
        assert max(joint.stretch for joint in joint_states(world)) < 0.01 * 0.5
    assert not world.joints.blocks.gives_way.any()


def state_of(world: World, kind: type[Any]) -> JointState:
    return next(joint for joint in joint_states(world) if joint.kind is kind)


def largest(world: World) -> float:
    """Return the largest stretch that there was [m]."""
    return max(joint.largest_stretch for joint in joint_states(world))


def test_a_chain_of_100_links_carries_10_000_times_the_mass_of_one() -> None:
    world = bench()
    bars(world, 100, Pin, end=1e4, angle=-0.5 * math.pi)
    world.component(world.entities()[-2], Velocity).linear = (0.5, 0.0)
    world.run(seconds=0.2)
    assert largest(world) < 0.01 * 0.5


def needed(world: World) -> int:
    """Return how many times as many substeps the next step needs."""
    plan, spring = (4, 0, 1 / 240, 1 / 60, 0.0, 1 / 60, 0, 1 / 240, 1), ResolveSystem().softness(world)
    bodies = motion_of(world), shapes_of(world), inverse_in(world), world.bodies.force
    return needed_factor(near_in(world), joints_in(world), *bodies, plan, spring, 0.0)


@pytest.mark.parametrize(("heavy", "spin", "factor"), [(20.0, 60.0, 8), (1e4, 60.0, 8), (5.0, 60.0, 1)])
def test_links_that_whip_get_shorter_substeps(heavy: float, spin: float, factor: int) -> None:
    world = bench()
    bar = bars(world, 2, Pin, end=heavy)
    circle(world, (0.0, 50.0), radius=1.0, mass=1e3)  # which they do not hold
    world.step()
    assert needed(world) == 1
    world.component(bar, Velocity).angular = spin
    assert needed(world) == factor
    world.component(bar, Velocity).angular = 1e5
    assert needed(world) == (16 if factor > 1 else 1)


def test_a_cantilever_of_ten_welds_does_not_sag() -> None:
    world = bench()
    last = bars(world, 10, Weld)
    world.run(seconds=0.5)
    assert abs(world.component(last, Transform).position.y) < 1e-9
    assert state_of(world, Weld).torque == pytest.approx(10.0 * G * 2.5, rel=1e-9)


def test_a_bridge_carries_a_ball_of_a_ton() -> None:
    world = bench()
    last = bars(world, 10, Pin)
    world.spawn(Pin(b=last, anchor_a=(5.0, 0.0), anchor_b=(0.25, 0.0)))
    ball = circle(world, (2.5, 1.05), radius=1.0, mass=1000.0)
    world.run(seconds=1.0)
    assert largest(world) < 0.01 * 0.5
    assert world.component(ball, Transform).position.y > 0.5


def test_a_motor_turns_with_its_torque_up_to_its_speed_and_books_its_work() -> None:
    world = bench(gravity=0.0)
    wheel = world.spawn(Transform(), Velocity(), Mass(1.0, inertia=2.0))
    world.spawn(Pin(b=wheel, motor_speed=3.0, max_torque=4.0))
    world.run(seconds=0.5)
    assert world.component(wheel, Velocity).angular == pytest.approx(1.0, rel=1e-12)
    assert state_of(world, Pin).torque == pytest.approx(4.0)
    world.run(seconds=1.5)
    assert world.component(wheel, Velocity).angular == pytest.approx(3.0, rel=1e-12)
    assert world.account.sums[MOTORS, ENERGY] == pytest.approx(9.0, rel=1e-12)
    assert world.account.sums[MOTORS, ANGULAR_MOMENTUM] == pytest.approx(6.0, rel=1e-12)
    assert world.account.sums[JOINTS, ENERGY] == pytest.approx(0.0, abs=1e-12)


def test_a_motor_that_is_blocked_gives_its_strongest_force_and_no_work() -> None:
    world = bench()
    lift = world.spawn(Transform(), Velocity(), Mass(2.0), Shape.box(0.5, 0.5))
    world.spawn(Slot(b=lift, axis=(0.0, 1.0), upper=0.1, motor_speed=0.5, max_force=50.0))
    world.run(seconds=1.0)
    held = state_of(world, Slot)
    assert world.component(lift, Transform).position.y == pytest.approx(0.1, abs=1e-9)
    assert held.force.y == pytest.approx(2.0 * G, rel=1e-9)
    before = world.account.sums[MOTORS, ENERGY]
    world.run(seconds=1.0)
    assert world.account.sums[MOTORS, ENERGY] == before


def test_a_limit_stops_a_fall_without_bounce() -> None:
    world = bench()
    bar = world.spawn(Transform((0.5, 0.0)), Velocity(), Mass(1.0), Shape.box(1.0, 0.1))
    world.spawn(Pin(b=bar, anchor_b=(-0.5, 0.0), lower=-0.5))
    lowest = 0.0
    for _ in range(60):
        world.step()
        lowest = min(lowest, world.component(bar, Transform).angle)
    assert lowest == pytest.approx(-0.5, abs=1e-3)
    assert world.component(bar, Velocity).angular == pytest.approx(0.0, abs=1e-12)
    assert state_of(world, Pin).torque == pytest.approx(0.5 * G * math.cos(0.5), rel=1e-6)


def test_a_rope_is_slack_and_then_holds() -> None:
    world = bench()
    bob = world.spawn(Transform((0.0, -0.2)), Velocity(), Mass(2.0), Shape.circle(0.1))
    world.spawn(Rope(b=bob, length=1.0))
    world.run(seconds=0.2)
    assert state_of(world, Rope).force.magnitude == 0.0
    world.run(seconds=1.0)
    assert world.component(bob, Transform).position.y == pytest.approx(-1.0, abs=1e-6)
    assert state_of(world, Rope).force.y == pytest.approx(2.0 * G, rel=1e-9)
    assert world.account.sums[JOINTS, ENERGY] == pytest.approx(-2.0 * G * 0.8, rel=1e-6)


def test_a_pulley_is_an_atwood_machine() -> None:
    world = bench()
    one, other = (world.spawn(Transform((x, -2.0)), Velocity(), Mass(m)) for x, m in ((-1, 2.0), (1, 1.0)))
    world.spawn(Pulley(a=one, b=other, wheel_a=(-1.0, 0.0), wheel_b=(1.0, 0.0)))
    world.run(seconds=0.5)
    assert world.component(other, Velocity).linear.y == pytest.approx(world.time * G / 3.0, rel=1e-12)
    assert state_of(world, Pulley).force.y == pytest.approx(4.0 * G / 3.0, rel=1e-9)


def test_a_train_of_gears_of_1_to_1000() -> None:
    world, pins = bench(), []
    world.simulation = SimulationConfig(contacts="soft", integrator="leapfrog")
    for n in range(4):
        wheel = world.spawn(Transform((3.0 * n, 0.0)), Velocity(), Mass(1.0, inertia=1.0), Shape.circle(1.0))
        pins.append(world.spawn(Pin(b=wheel, anchor_a=(3.0 * n, 0.0))))
        if n:
            world.spawn(Gear(first=pins[n - 1], second=pins[n], ratio=-10.0))
    world.component(wheel, Velocity).angular = 1000.0
    world.run(seconds=1.0)
    spins = [float(v) for v in world.table(Velocity)["angular"] if v]
    assert spins[1] / spins[0] == pytest.approx(-10.0, rel=1e-9)
    assert spins[3] / spins[0] == pytest.approx(-1000.0, rel=1e-9)


def pair(kind: type[Any], world: World, ends: tuple[int, int | None]) -> None:
    """Join two bodies at points beside their middles."""
    a, b = ends
    at = {} if kind is Pulley else {"anchor_a": (0.3, 0.1), "anchor_b": (-0.4, 0.2)}
    extra: dict[type[Any], dict[str, Any]] = {
        Pin: {"lower": -0.5, "upper": 0.7, "motor_speed": 2.0, "max_torque": 1.0},
        Slot: {"axis": (1.0, 0.5), "upper": 2.5, "motor_speed": 1.0, "max_force": 3.0},
        Pulley: {"wheel_a": (0.0, 3.0), "wheel_b": (2.0, 3.0), "ratio": 1.5},
    }
    world.spawn(kind(a=a, b=b, **at, **extra.get(kind, {})))


def balance(world: World) -> NDArray[np.float64]:
    """Return the energy, the momentum and the angular momentum of a world (4,)."""
    momentum = measure_momentum(world)
    return np.array((measure_energy(world).total, *momentum.linear, momentum.angular))


@given(
    kind=st.sampled_from([Pin, Slot, Weld, Rod, Rope, Pulley]),
    speeds=st.lists(st.floats(-3.0, 3.0), min_size=6, max_size=6),
    mass=st.floats(1e-3, 1e3), fixed=st.booleans(),
)  # fmt: skip
@example(kind=Rod, speeds=[0.0, 0.0, 0.0, -3.0, 0.0, 1.0], mass=1.0, fixed=True)
def test_every_change_of_energy_and_momentum_is_booked(
    kind: type[Any], speeds: list[float], mass: float, fixed: bool
) -> None:
    # They do not touch: a soft contact changes the angular momentum of the two (docs/physics-and-error.md).
    world = bench(gravity=0.0 if fixed else G)
    one = world.spawn(
        Transform(),
        Velocity((speeds[0], speeds[1]), speeds[2]),
        Mass(1.0),
        Shape.box(1.0, 0.4),
        Layer(touches=NONE),
    )
    other = world.spawn(
        Transform((2.0, 0.0)), Velocity((speeds[3], speeds[4]), speeds[5]), Mass(mass), Shape.box(0.5, 0.5)
    )
    pair(kind, world, (one, None if fixed and kind is not Pulley else other))
    before = balance(world)
    world.run(seconds=0.4)
    scale = 1.0 + mass * (1.0 + sum(v * v for v in speeds))
    booked = world.account.sums.sum(axis=0)
    assert balance(world) - before == pytest.approx(booked, abs=1e-11 * scale)
    if kind is not Pulley:  # into the wheel of which a light body is hurled
        assert state_of(world, kind).stretch < 0.01


def links(ends: Sequence[tuple[int, int]]) -> Blocks:
    """Return the blocks of rods between bodies, of which those from 1 on move."""
    rows = [Row((Term(Measure.DISTANCE, *pair),)) for pair in ends]
    moves = [False] + [True] * (1 + max(end for pair in ends for end in pair))
    return order_rows(rows, [range(n, n + 1) for n in range(len(rows))], moves)


@pytest.mark.parametrize("count", [1, 7])
def test_the_matrix_of_a_tree_has_no_more_numbers_than_pairs_of_joints_at_a_body(count: int) -> None:
    chain = links([(n, n + 1) for n in range(count)] + [(100, 101)])
    assert sorted(chain.nodes[:-1, 0].tolist()) == list(range(count + 1))
    assert sorted(np.diff(chain.groups[:, 0]).tolist()) == [1, count]
    assert len(chain.entries) - 1 == len(chain.shared) == count - 1
    assert len(chain.targets) == 0
    star = links([(1, n) for n in range(2, 2 + count)])
    assert len(star.entries) - 1 == count * (count - 1) // 2
    hub = links([(1, n) for n in range(2, 2000)])
    assert len(hub.groups) - 1 == 1998, "too much to be solved at once"


@given(
    st.sets(
        st.tuples(st.integers(0, 6), st.integers(0, 6)).filter(lambda pair: pair[0] < pair[1]), min_size=1
    ),
    st.lists(st.floats(-1.0, 1.0), min_size=14, max_size=14),
)
def test_no_rod_of_a_net_grows_after_a_step(ends: set[tuple[int, int]], speeds: list[float]) -> None:
    # Loops fill the matrix, and rods beyond those that a net needs depend on others.
    world, bodies = bench(gravity=0.0), list[int]()
    for n in range(7):
        place = Transform((3.0 * math.cos(n * n), 2.0 * math.sin(3.0 * n)))
        pushed = Velocity((speeds[2 * n], speeds[2 * n + 1]))
        bodies.append(world.spawn(place, pushed, Mass(1.0 + n), Shape.circle(0.01), Layer(touches=NONE)))
    for a, b in sorted(ends):
        world.spawn(Rod(bodies[a], bodies[b]))
    world.step()
    for a, b in ends:
        one, other = (world.component(bodies[end], Transform).position for end in (a, b))
        v, w = (world.component(bodies[end], Velocity).linear for end in (a, b))
        along = (other - one) * (1.0 / (other - one).magnitude)
        assert (w - v).dot(along) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("span", [3.04, 3.2, 3.36])
def test_a_chain_that_does_not_fit_between_its_ends_gains_no_more_than_its_springs_have(span: float) -> None:
    world, end = bench(), (-0.5 * span, 0.0)
    before: int | None = None
    for n in range(8):
        plank = box(world, ((n - 3.5) * span / 8, 0.0), width=0.4, height=0.1, mass=2.0)
        world.spawn(Pin(before, plank, end, (-0.2, 0.0)))
        before, end = plank, (0.2, 0.0)
    world.spawn(Pin(None, before, (0.5 * span, 0.0), end))
    stretch = abs(span - 3.2) / 8
    springs = 0.5 * 9 * 2.0 * (2.0 * math.pi * 60.0 * stretch) ** 2
    for _ in range(30):
        world.step()
        assert measure_account(world).now.energy <= springs + 1.0
    assert max(joint.stretch for joint in joint_states(world)) <= max(0.0, span - 3.2) / 3 + 0.01


def test_a_joint_between_a_hand_and_the_world_does_no_work() -> None:
    """The impulse of before it was held stayed, and the hand seemed to work against it: 3 J in a second."""
    world = bench()
    ball = circle(world, (0.0, 2.0), radius=0.2, mass=1.0)
    world.spawn(Rod(None, ball, anchor_a=(0.0, 3.0)))
    world.run(steps=4)
    world.add(ball, Held())
    world.component(ball, Velocity).linear = (0.5, 1.0)
    before = measure_account(world).energy
    world.run(steps=6)
    after = measure_account(world).energy
    assert (after["joints"], after["hand"]) == (before["joints"], before["hand"])


@pytest.mark.parametrize("contacts", ["auto", "soft"])
@pytest.mark.parametrize("kind", [Rope, Rod, Pin])
def test_joints_that_an_edit_has_put_far_apart_leave_what_rests_at_rest(kind: Any, contacts: str) -> None:
    """Springs of soft joints had turned the disc by radians in a step, and left 236 J in it."""
    world = World(physics=PhysicsConfig(gravity_mode="none"), simulation=SimulationConfig(contacts=contacts))
    a, b, *_ = (
        world.spawn(Transform((x, 0.3 * (x == 2.2))), Velocity(), Mass(mass), Shape.circle(0.25))
        for x, mass in ((0.0, 1.0), (2.2, 2.0), (3.2, 1.0), (3.7, 1.0))
    )
    more = {"anchor_b": (-1.35, 0.0)} if kind is Pin else {"length": 1.35}
    world.spawn(kind(a, b, anchor_a=(0.0, 0.2), **more))
    world.run(seconds=0.5)
    assert measure_energy(world).total < 1e-20
    (state,) = joint_states(world)
    assert state.stretch < 1e-6


@pytest.mark.parametrize("integrator", ["auto", "leapfrog"])
@pytest.mark.parametrize("beside", [False, True])
def test_an_edit_that_puts_joints_far_apart_is_closed_at_once_in_every_copy(
    beside: bool, integrator: Any, tmp_path: Path
) -> None:
    """Copies, files, redone runs and new islands took the edited places for those of the last step: 480 J."""
    laws = PhysicsConfig(gravity=Vector2(0, -1.6), linear_damping=2.0)
    world = World(physics=laws, simulation=SimulationConfig(dt=0.005, substeps=8, integrator=integrator))
    heavy = box(world, (2.19, 1.78), width=0.73, height=0.35, mass=30, angle=-0.876, velocity=(1.45, 0.18))
    light = box(world, (0.256, 0.512), width=0.55, height=0.58, mass=0.1, angle=-0.88, velocity=(2.19, -1.06))
    last = world.spawn(Transform((-0.77, 0.064)), Velocity((1.17, 1.63), 2.0), Mass(1.0, 1.0))
    world.spawn(Rod(light, heavy, anchor_a=(-0.008, 0)))
    world.spawn(Rope(light, last, anchor_a=(0.1136, 0)))
    for place in range(8 * beside):
        box(world, (95 + 1.3 * place, 0.5), width=1, height=1)
    history = History(world)
    history.step(steps=5)
    history.do(SetField(last, "Transform", "position", (1.506, 2.8)))
    save_scene(world, tmp_path / "edited.json")
    others = [world.copy(), load_scene(tmp_path / "edited.json")]
    history.step(steps=2)
    assert world.component(light, Velocity).angular == pytest.approx(-2.24, abs=0.01)
    assert measure_account(world).energy["joints"] == pytest.approx(-0.043, abs=0.001)
    end = bits(world)
    history.undo()
    history.redo()
    assert bits(world) == end
    for other in others:
        other.run(steps=2)
        assert bits(other) == end
