"""Light gates: what crosses them is counted once, at a moment as exact as the interpolation promises."""

from __future__ import annotations

import functools
import itertools
import math
import random
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_edits import box_of_discs, state_hash

from physicslab.components import Gate, Note, Ruler, Strobe, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.files.checks import SceneError
from physicslab.files.reader import FORMAT, read_scene
from physicslab.history import AddComponent, History, Remove, SetField, Spawn
from physicslab.prefabs import box, circle, pendulum
from physicslab.state.state import State
from physicslab.systems.gate import LIMIT, Crossing, GateSystem
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.standard import standard_systems
from physicslab.systems.strobe import StrobeSystem
from physicslab.systems.system import Stage, System, at
from physicslab.world import World

type Motion = Callable[[float], tuple[float, float, float, float]]
"""Where something is at a time and how fast it moves: x, y, vx, vy."""


class Driven(System):
    """Moves a body along a path that is known, exactly, at the end of each step."""

    needs = (Transform, Velocity)

    def __init__(self, motion: Motion) -> None:
        self.motion = motion

    @at(Stage.FINISH)
    def drive(self, state: State, h: float) -> None:
        (row,) = state.batch(Transform, Velocity).rows
        x, y, vx, vy = self.motion(state.time + h)
        state.table(Transform)["position"][row] = x, y
        state.table(Velocity)["linear"][row] = vx, vy


def driven(motion: Motion, *gates: Gate) -> tuple[World, GateSystem]:
    """Return a world with a body on a path, and gates."""
    gate = GateSystem()
    world = World(Driven(motion), gate)
    x, y, vx, vy = motion(0.0)
    world.spawn(Transform((x, y)), Velocity((vx, vy)))
    for one in gates:
        world.spawn(one)
    return world, gate


def upright(x: float, low: float = -10.0, high: float = 10.0) -> Gate:
    return Gate((x, low), (x, high))


def times(gate: GateSystem) -> list[float]:
    return [one.time for one in gate.crossings]


def agm(a: float, b: float) -> float:
    while abs(a - b) > 1e-15 * a:
        a, b = 0.5 * (a + b), math.sqrt(a * b)
    return a


# ---- the order of the interpolation ------------------------------------------------------------------------


def test_the_error_of_a_moment_falls_with_the_fourth_power_of_the_step() -> None:
    errors = []
    for h in (0.1, 0.05, 0.025):
        world, gate = driven(lambda t: (math.sin(t), 0.0, math.cos(t), 0.0), upright(0.5))
        for _ in range(round(2.0 / h)):
            world.step(h)
        assert len(gate.crossings) == 1
        errors.append(abs(gate.crossings[0].time - math.pi / 6))
        assert errors[-1] <= 1.05 * h**4 / 384 / math.cos(math.pi / 6)  # max |x''''| is below 1
    assert errors[1] < errors[0] / 6 and errors[2] < errors[1] / 6


def test_free_fall_through_two_gates_is_exact() -> None:
    gate = GateSystem()
    world = World(GravitySystem(), IntegrateSystem(), gate)
    ball = world.spawn(*circle_parts((0.0, 5.0)))
    upper, lower = world.spawn(Gate((-1, 4), (1, 4))), world.spawn(Gate((-1, 1), (1, 1)))
    world.run(seconds=2.0)
    expected = [math.sqrt(2.0 * drop / 9.81) for drop in (1.0, 4.0)]
    assert times(gate) == pytest.approx(expected, rel=1e-12)
    assert [one.gate for one in gate.crossings] == [upper, lower]
    assert [one.speed for one in gate.crossings] == pytest.approx([9.81 * t for t in expected], rel=1e-12)
    assert {(one.body, one.direction) for one in gate.crossings} == {(ball, -1)}


def circle_parts(place: tuple[float, float]) -> list[object]:
    scratch = World()
    ball = circle(scratch, place, radius=0.1)
    parts = scratch.components(ball)
    return [type(part)(**part.given()) for part in parts]


def test_the_period_of_a_simulated_pendulum() -> None:
    """The bob hangs from a stiff spring: the period is longer by half the share by which that gives way."""
    angle, length, stiffness = 0.3, 1.0, 1e6
    world = World(*standard_systems(), simulation=SimulationConfig(dt=1 / 240))
    pendulum(world, (0, 0), length=length, angle=angle, stiffness=stiffness)
    world.spawn(Gate((0, -2), (0, -0.5)))
    world.run(seconds=12.2)
    gate = world.schedule.find(GateSystem)
    assert gate is not None
    forward = [one.time for one in gate.crossings if one.direction == gate.crossings[0].direction]
    periods = np.diff(forward)
    expected = 2.0 * math.pi * math.sqrt(length / 9.81) / agm(1.0, math.cos(0.5 * angle))
    assert len(periods) == 5
    assert periods == pytest.approx(expected, rel=4.0 * 9.81 / stiffness / length)


def test_the_period_of_an_exact_pendulum_at_sixty_steps_a_second() -> None:
    """Driven along the motion of a pendulum of 0.3 rad, found by steps that are much finer."""
    angle, length, h, parts = 0.3, 1.0, 1 / 60, 64
    state, path = (angle, 0.0), []
    for n in range(60 * 5 * parts + 1):
        if n % parts == 0:
            path.append(state)
        state = _pendulum_step(state, 9.81 / length, h / parts)

    def motion(t: float) -> tuple[float, float, float, float]:
        a, w = path[round(t / h)]
        return (
            length * math.sin(a), -length * math.cos(a), length * w * math.cos(a), length * w * math.sin(a)
        )  # fmt: skip

    world, gate = driven(motion, Gate((0, -2), (0, 0)))
    for _ in range(60 * 5 - 1):
        world.step(h)
    expected = 2.0 * math.pi * math.sqrt(length / 9.81) / agm(1.0, math.cos(0.5 * angle))
    forward = [one.time for one in gate.crossings if one.direction == gate.crossings[0].direction]
    rate = math.sqrt(9.81 / length)
    # x'''' is at most about rate**4 times the amplitude, and vanishes in the middle.
    promised = 2.0 * h**4 / 384 * rate**4 * angle / (rate * angle)
    assert len(forward) == 3 and np.diff(forward) == pytest.approx(expected, abs=promised)
    assert promised < 2e-8


def _pendulum_step(state: tuple[float, float], strength: float, h: float) -> tuple[float, float]:
    """Return the state after a step of the classical method of Runge and Kutta."""

    def slope(a: float, w: float) -> tuple[float, float]:
        return w, -strength * math.sin(a)

    a, w = state
    k1 = slope(a, w)
    k2 = slope(a + 0.5 * h * k1[0], w + 0.5 * h * k1[1])
    k3 = slope(a + 0.5 * h * k2[0], w + 0.5 * h * k2[1])
    k4 = slope(a + h * k3[0], w + h * k3[1])
    da, dw = (k1[n] + 2 * k2[n] + 2 * k3[n] + k4[n] for n in (0, 1))
    return a + h / 6 * da, w + h / 6 * dw


# ---- what is counted ---------------------------------------------------------------------------------------


@given(
    st.floats(-0.99, 0.99), st.floats(0.2, 6.0), st.floats(0.02, 0.3), st.floats(0.0, 2 * math.pi),
    st.floats(0.0, 2 * math.pi),
)  # fmt: skip
def test_every_crossing_is_counted_once_within_its_step(
    place: float, rate: float, share: float, phase: float, turn: float
) -> None:
    """To and fro through a gate that stands anywhere, at any angle: as often as the path does, both ways."""
    c, s = math.cos(turn), math.sin(turn)
    h, across = share / rate, rate * math.sqrt(1.0 - place * place)

    def motion(t: float) -> tuple[float, float, float, float]:
        x, v = math.sin(rate * t + phase), rate * math.cos(rate * t + phase)
        return c * x, s * x, c * v, s * v

    ends = np.array(((place, 3.0), (place, -3.0))) @ np.array(((c, s), (-s, c)))
    world, gate = driven(motion, Gate(ends[0], ends[1]))
    steps, seen = round(1.5 * 2 * math.pi / rate / h), 0
    for _ in range(steps):
        before = world.time
        world.step(h)
        fresh, seen = gate.crossings[seen:], len(gate.crossings)
        # It is noted once the body is out of the gate, 60 micrometres on.
        assert all(before - 1e-4 / across <= one.time <= before + h * (1 + 1e-12) for one in fresh)
    end = world.time
    angle = math.asin(place)
    every = [
        (base - phase + 2 * math.pi * n) / rate for base in (angle, math.pi - angle) for n in range(-2, 8)
    ]
    expected = sorted(t for t in every if 0.0 < t < end)
    near_ends = min(min(abs(t), abs(end - t)) for t in every) < 1e-2 * h
    shallow = 1.0 - abs(place) < 0.01  # it turns within the gate, or between two samples of a step
    if not (near_ends or shallow):
        assert times(gate) == pytest.approx(expected, abs=h**4 / 100 * rate**3 / (1.0 - place**2) + 1e-9)
    directions = [one.direction for one in gate.crossings]
    assert all(a == -b for a, b in itertools.pairwise(directions))
    assert gate.count == len(gate.crossings)


def test_the_direction_is_the_side_on_which_it_comes_out() -> None:
    for speed, direction in ((2.0, -1), (-2.0, 1)):
        _, gate = stepped(uniform(speed), upright(0.0))
        assert [one.direction for one in gate.crossings] == [direction]
        assert gate.crossings[0].speed == pytest.approx(2.0) and gate.crossings[0].time == pytest.approx(0.5)


def uniform(speed: float) -> Motion:
    return lambda t: (speed * (t - 0.5), 0.0, speed, 0.0)


def stepped(motion: Motion, *gates: Gate, seconds: float = 1.0) -> tuple[World, GateSystem]:
    world, gate = driven(motion, *gates)
    for _ in range(round(60 * seconds)):
        world.step(1 / 60)
    return world, gate


def test_past_the_ends_of_a_gate_nothing_is_counted() -> None:
    for high in (-0.01, 0.01):
        _, gate = stepped(lambda t: (t - 0.5, 0.0, 1.0, 0.0), upright(0.0, -1.0, high))
        assert len(gate.crossings) == (high > 0.0)


def test_a_body_that_stops_on_the_gate_and_trembles_there_is_not_counted() -> None:
    def motion(t: float) -> tuple[float, float, float, float]:
        if t < 0.5:
            return (t - 0.5, 0.0, 1.0, 0.0)
        return (1e-6 * math.sin(300.0 * t), 0.0, 3e-4 * math.cos(300.0 * t), 0.0)

    _, gate = stepped(motion, upright(0.0, -1.0, 1.0))
    assert gate.crossings == ()


@pytest.mark.parametrize(("after", "count"), [(1.0, 1), (-1.0, 0)])
def test_a_body_that_rests_on_the_gate_counts_when_it_is_through(after: float, count: int) -> None:
    def motion(t: float) -> tuple[float, float, float, float]:
        if t < 0.25:
            return (2.0 * (t - 0.25), 0.0, 2.0, 0.0)
        return (0.0, 0.0, 0.0, 0.0) if t < 0.5 else (after * (t - 0.5), 0.0, after, 0.0)

    _, gate = stepped(motion, upright(0.0, -1.0, 1.0))
    assert len(gate.crossings) == count
    assert all(0.2 < one.time < 0.55 for one in gate.crossings)


def test_a_body_that_is_put_on_the_gate_or_moved_over_it_by_an_edit_crosses_nothing() -> None:
    gate = GateSystem()
    world = World(IntegrateSystem(), gate)
    body = world.spawn(Transform(), Velocity((1.0, 0.0)))
    world.spawn(upright(0.0))
    world.run(steps=10)
    assert gate.crossings == ()
    for x in (-1.0, 1.0, -2.0):
        world.component(body, Transform).position = (x, 0.0)
        world.run(steps=3)
    assert gate.crossings == ()


def test_a_turn_within_one_step_counts_both_ways() -> None:
    """A stone thrown up turns 1 mm above the gate: it is there for less than the two steps of a sample."""
    for above, count in ((2e-3, 2), (-1e-3, 0)):
        top = 0.5 + 1 / 240

        def motion(t: float, top: float = top) -> tuple[float, float, float, float]:
            return 0.0, -0.5 * 9.81 * (t - top) ** 2, 0.0, -9.81 * (t - top)

        _, gate = stepped(motion, Gate((-1, -above), (1, -above)))
        expected = [top + sign * math.sqrt(2 * above / 9.81) for sign in (-1, 1)] if count else []
        assert times(gate) == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize("bounce", [0.501, 0.5041, 0.512])
def test_a_blow_within_the_step_is_no_crossing_of_what_it_does_not_reach(bounce: float) -> None:
    """A ball that bounces 1 mm above a gate does not cross it, wherever in the step the blow is."""

    def motion(t: float) -> tuple[float, float, float, float]:
        sign = 1.0 if t > bounce else -1.0
        return 0.0, 1e-3 + 5.0 * abs(t - bounce), 0.0, 5.0 * sign

    _, gate = stepped(motion, Gate((-1, 0), (1, 0)))
    assert gate.crossings == ()


@pytest.mark.parametrize("height", [0.5, 0.3, 0.26, 0.2501])
@pytest.mark.parametrize("dt", [1.0 / 25.0, 1.0 / 60.0, 0.01])
def test_what_bounces_is_timed_up_to_the_impact_and_from_it_on(height: float, dt: float) -> None:
    world = World(*standard_systems(), simulation=SimulationConfig(dt=dt))
    box(world, (0.0, -0.5), width=9.0, height=1.0, static=True, restitution=0.8, friction=0.0)
    for x in (-2.0, 0.0, 2.0):  # three islands, alike
        circle(world, (x, 4.0), radius=0.25, restitution=0.8, friction=0.0)
    world.spawn(Gate((-4.0, height), (4.0, height)))
    world.run(seconds=1.2)
    gates = world.schedule.find(GateSystem)
    assert gates is not None
    g, fast = 9.81, math.sqrt(2.0 * 9.81 * 3.75)
    down, up = math.sqrt(fast**2 - 2.0 * g * (height - 0.25)), 0.8 * fast
    late = math.sqrt(up**2 - 2.0 * g * (height - 0.25))
    expected = [down / g] * 3 + [fast / g + (up - late) / g] * 3
    assert times(gates) == pytest.approx(expected, abs=1e-12)
    assert [one.speed for one in gates.crossings] == pytest.approx([down] * 3 + [late] * 3, rel=1e-9)
    assert [one.direction for one in gates.crossings] == [-1, -1, -1, 1, 1, 1]


def test_the_earlier_impact_of_another_in_the_same_step_does_not_change_a_crossing() -> None:
    world = World(*standard_systems(), simulation=SimulationConfig(dt=1.0 / 25.0))
    box(world, (0.0, -0.5), width=9.0, height=1.0, static=True, restitution=0.8, friction=0.0)
    falls = {circle(world, (x, 0.25 + h), radius=0.25, restitution=0.8, friction=0.0): h
             for x, h in ((-2.0, 3.75), (0.0, 3.77), (2.0, 3.85))}  # fmt: skip
    circle(world, (4.0, 90.0), radius=0.25)  # far from the gate
    world.spawn(Gate((-4.0, 0.26), (4.0, 0.26)))
    world.run(seconds=1.0)
    gates = world.schedule.find(GateSystem)
    assert gates is not None and gates.count == 6
    for body, h in falls.items():
        down, up = math.sqrt(2.0 * 9.81 * (h - 0.01)), 0.8 * math.sqrt(2.0 * 9.81 * h)
        late = math.sqrt(up**2 - 2.0 * 9.81 * 0.01)
        own = [one for one in gates.crossings if one.body == body]
        expected = [down / 9.81, math.sqrt(2.0 * h / 9.81) + (up - late) / 9.81]
        assert [one.time for one in own] == pytest.approx(expected, abs=1e-12)
        assert [one.speed for one in own] == pytest.approx([down, late], rel=1e-9)


def test_a_gate_that_moves_with_a_body_is_crossed_by_what_stands_still() -> None:
    gate = GateSystem()
    world = World(IntegrateSystem(), gate)
    carrier = world.spawn(Transform((-1.0, 5.0)), Velocity((2.0, 0.0)))
    still = world.spawn(Transform((0.25, 0.0)), Velocity())
    world.spawn(Gate((0.0, -10.0), (0.0, 1.0), start_body=carrier, end_body=carrier))
    world.run(seconds=1.0)
    (one,) = gate.crossings
    assert one.body == still and one.direction == 1 and one.speed == 0.0
    assert one.time == pytest.approx(0.625, rel=1e-12)


def test_a_gate_lets_go_of_a_body_that_is_removed() -> None:
    world = World(*standard_systems())
    body = world.spawn(Transform((1.0, 0.0)), Velocity())
    entity = world.spawn(Gate((0, 0), (0, 1), start_body=body))
    world.run(steps=2)
    world.remove(body)
    world.run(steps=2)
    assert world.component(entity, Gate).start_body is None


def test_a_gate_without_length_is_crossed_by_nothing() -> None:
    _, gate = stepped(lambda t: (t - 0.5, 0.0, 1.0, 0.0), Gate((0, 0), (0, 0)))
    assert gate.crossings == ()


# ---- the record --------------------------------------------------------------------------------------------


def test_it_leaves_itself_out_where_there_is_no_gate() -> None:
    world = World(*standard_systems())
    circle(world, (0, 0), radius=0.1)
    world.step()
    assert world.schedule.find(GateSystem) is None
    assert ("GateSystem", "no Gate in the scene") in [
        (one.name, one.reason) for one in world.schedule.left_out
    ]


def test_the_record_has_a_limit() -> None:
    world, gate = driven(lambda t: (math.sin(40.0 * t), 0.0, 40.0 * math.cos(40.0 * t), 0.0), upright(0.0))
    while gate.count < LIMIT + 20:
        world.step(1 / 60)
    assert len(gate.crossings) == LIMIT
    assert np.all(np.diff(times(gate)) > 0.0)


def test_the_record_goes_with_its_gate_and_comes_back_with_it() -> None:
    history, gate = swinging()
    history.step(steps=200)
    before = gate.crossings
    assert len(before) >= 3
    (entity,) = history.world.batch(Gate).entities.tolist()
    history.do(Remove(entity))
    assert gate.crossings == ()
    history.undo()
    assert gate.crossings == before


def swinging() -> tuple[History, GateSystem]:
    world = World(*standard_systems(), physics=PhysicsConfig())
    pendulum(world, (0, 0), length=0.6, angle=0.4)
    world.spawn(Gate((0, -2), (0, -0.1)))
    world.synchronise()
    gate = world.schedule.find(GateSystem)
    assert gate is not None
    return History(world), gate


@given(st.lists(st.integers(0, 400), min_size=1, max_size=6))
@settings(deadline=None, max_examples=15)
def test_going_back_in_time_gives_the_crossings_of_a_fresh_run(places: list[int]) -> None:
    history, gate = swinging()
    fresh: list[tuple[Crossing, ...]] = [gate.crossings]
    for _ in range(400):
        history.step()
        fresh.append(gate.crossings)
    assert len(fresh[-1]) >= 6
    for place in places:
        history.seek(place)
        assert gate.crossings == fresh[place] and gate.count == len(fresh[place])
    assert history.difference is None


def test_an_edit_of_the_gate_and_its_undo() -> None:
    history, gate = swinging()
    history.step(steps=100)
    before = gate.crossings
    (entity,) = history.world.batch(Gate).entities.tolist()
    history.do(SetField(entity, "Gate", "end", (0.0, -1.9)))  # it ends below the bob now
    history.step(steps=100)
    assert gate.crossings == before
    history.undo()
    history.undo()
    history.step(steps=100)
    assert len(gate.crossings) > len(before)


@given(st.integers(0, 2**32), st.lists(st.integers(0, 7), min_size=5, max_size=25))
@settings(deadline=None, max_examples=25)
def test_random_edits_of_instruments_are_undone_to_the_bit(seed: int, deeds: list[int]) -> None:
    rng = random.Random(seed)
    history = History(box_of_discs(seed % 100))
    world = history.world
    start = state_hash(world)
    for deed in deeds:
        bodies = world.batch(Transform).entities.tolist()
        made = [entity for entity in world.entities() if entity not in bodies]
        point, body = (rng.uniform(-1, 1), rng.uniform(0, 2)), rng.choice([*bodies, None])
        match deed:
            case 0:
                history.do(Spawn([Gate(point, (rng.uniform(-1, 1), 1.0), start_body=body)]))
            case 1:
                history.do(Spawn([Ruler(point, (0, 0), end_body=body)]))
            case 2:
                history.do(Spawn([Note(f"note {rng.random()}", point, place_body=body)]))
            case 3 if bodies and not world.has(bodies[0], Strobe):
                history.do(AddComponent(bodies[0], Strobe(0.01 + rng.random() / 10)))
            case 4 if bodies or made:
                history.do(Remove(rng.choice([*bodies, *made])))
            case 5:
                history.undo()
            case 6:
                history.seek(rng.randint(*history.steps_range))
            case _:
                history.step(steps=rng.randint(1, 8))
    while history.undo() is not None:
        pass
    assert state_hash(world) == start and history.difference is None


def test_a_recording_holds_gates_on_bodies_under_other_numbers(tmp_path: Path) -> None:
    world = World(*standard_systems(), physics=PhysicsConfig(gravity_mode="none"))
    gone = circle(world, (9, 9), radius=0.1)
    carrier = circle(world, (0.0, 2.0), radius=0.1, velocity=(1.0, 0.0))
    circle(world, (0.52, 0.0), radius=0.1)
    world.remove(gone)
    history = History(world)
    (gate,) = history.do(Spawn([Gate((0, 0), (0, -4))]))
    history.step(steps=5)
    for name in ("start_body", "end_body"):
        history.do(SetField(gate, "Gate", name, carrier))
    history.step(steps=60)
    system = world.schedule.find(GateSystem)
    assert system is not None and len(system.crossings) == 1
    history.save(tmp_path / "run.json")
    again = History.load(tmp_path / "run.json")
    again.seek(again.steps_range[1])
    loaded = again.world.schedule.find(GateSystem)
    assert loaded is not None and again.difference is None
    assert [(one.time, one.direction, one.speed) for one in loaded.crossings] == [
        (one.time, one.direction, one.speed) for one in system.crossings
    ]


def test_a_file_with_a_gate_on_what_has_no_place_is_refused() -> None:
    entities = [{"id": "words", "Note": {"text": "a"}}, {"id": "g", "Gate": {"end_body": "words"}}]
    with pytest.raises(SceneError) as refused:
        read_scene({"format": FORMAT, "entities": entities}, "gates.json")
    assert str(refused.value) == (
        'gates.json: entity "g": Gate.end_body = "words": must be the id of an entity with a Transform'
    )


# ---- many steps in a call ----------------------------------------------------------------------------------


def watched(kind: str) -> tuple[World, int]:
    """Return a world with a strobe and gates, one of them carried by a body that turns, and a body."""
    if kind == "smooth":
        world = World(physics=PhysicsConfig(), simulation=SimulationConfig(dt=1 / 120))
        pendulum(world, (0, 0), length=0.6, angle=0.4)
        (body,) = world.batch(Transform, Velocity).entities.tolist()
    else:
        world = World(
            physics=PhysicsConfig(bounds=(-1, -1, 1, 2)), simulation=SimulationConfig(contacts=kind)
        )
        for k in range(6):
            box(world, (-0.8 + 0.3 * k, 0.1 * k), width=0.2, height=0.2, velocity=(1.0 - 0.3 * k, 0.5))
        body = world.batch(Transform, Velocity).entities.tolist()[2]
        world.component(body, Velocity).angular = 5.0
    world.spawn(Gate((0, -2), (0, 2)))
    world.spawn(Gate((-3, -0.4), (3, -0.4)))
    world.spawn(Gate((0, 0.0), (1.0, 0), start_body=body, end_body=body))
    world.add(body, Strobe(0.013, 200))
    return world, body


@pytest.mark.parametrize("kind", ["smooth", "soft", "rigid"])
def test_one_call_of_many_steps_records_what_single_steps_do(kind: str) -> None:
    (one, _), (other, _) = watched(kind), watched(kind)
    one.run(steps=200)
    for _ in range(200):
        other.step()
    records = []
    for world in (one, other):
        gate, strobe = (world.schedule.find(kind) for kind in (GateSystem, StrobeSystem))
        assert isinstance(gate, GateSystem) and isinstance(strobe, StrobeSystem)
        records.append((gate, gate.keep(), *strobe.pictures(world)))
    (gate, kept, rows, seen), (_, expected_kept, expected_rows, expected) = records
    assert gate.count > 1 and len(seen) > 60
    assert np.array_equal(rows, expected_rows)
    assert np.allclose(seen, expected, rtol=0.0, atol=1e-11)
    assert all(map(functools.partial(np.allclose, rtol=0.0, atol=1e-9), kept, expected_kept))
    assert other.schedule.timings["GateSystem"].calls == 400
    assert one.schedule.timings["GateSystem"].calls <= (4 if kind == "smooth" else 60)
