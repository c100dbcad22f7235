"""Runs that are recorded: the bits of any run, instants that are right, moments found to rounding."""

import csv
import html
import importlib
import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from desk import bits

from physicslab import (
    InvalidValue,
    PhysicsConfig,
    Run,
    SimulationConfig,
    World,
    box,
    circle,
    ensemble,
    load_scene,
)  # fmt: skip
from physicslab.components import Drag, Mass, Name, Rod, Spring, Transform, Velocity
from physicslab.diagnostics.energy import measure_energy
from physicslab.scenes import SCENES
from physicslab.state.state import State
from physicslab.stepping.islands import Islands
from physicslab.stepping.rigid_motion import RigidMotion
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.system import ForceSystem, Stage, at

EXACT = ("drop", "bounces", "stack", "newtons_cradle", "pyramid", "pile", "gas", "ragdoll")
"""Scenes whose motion has the same bits however it is divided."""


def thrown(**laws: Any) -> World:
    world = World(physics=PhysicsConfig(**laws))
    circle(world, (0.0, 1.0), radius=0.1, velocity=(7.0, 3.0), name="ball")
    return world


@pytest.mark.parametrize("name", SCENES)
def test_a_recorded_run_has_the_bits_of_a_run(name: str) -> None:
    world, other = load_scene(name), load_scene(name)
    run = world.record(0.7, every=0.1)
    other.run(seconds=0.7)
    assert bits(world) == bits(other) and world.time == other.time and world.collisions == other.collisions
    assert world.account.sums == pytest.approx(other.account.sums, rel=1e-9, abs=1e-9)
    assert run.times == pytest.approx(np.arange(8) * 0.1, abs=1e-12) and np.isfinite(run.motion).all()
    rows = world.batch(Transform, Velocity).rows
    assert np.array_equal(run.motion[-1, :, 0:2], world.table(Transform)["position"][rows])
    assert np.array_equal(run.motion[-1, :, 5], world.table(Velocity)["angular"][rows])


@pytest.mark.parametrize("name", SCENES)
def test_an_instant_is_the_state_after_its_steps(name: str) -> None:
    world, other = load_scene(name), load_scene(name)
    run = world.record(0.5, every=0.1)
    for number, _ in enumerate(other.stepping(seconds=0.5, stride=6), start=1):
        position = other.table(Transform)["position"][other.batch(Transform, Velocity).rows]
        if name in EXACT:
            assert np.array_equal(run.motion[number, :, 0:2], position)
        assert run.motion[number, :, 0:2] == pytest.approx(position, abs=1e-9)
        assert run.times[number] == pytest.approx(other.time, abs=1e-13)


class Counted(ForceSystem):
    """A spring to the origin, in Python, which counts how often it is evaluated."""

    needs = (Velocity, Mass)
    evaluations = 0

    @at(Stage.FORCE)
    def pull(self, world: State, h: float) -> None:
        self.evaluations += 1
        rows = world.batch(*self.needs).rows
        world.bodies.force[rows] -= 4.0 * world.table(Transform)["position"][rows]


def held(tolerance: float) -> tuple[World, Counted]:
    spring = Counted()
    simulation = SimulationConfig(integrator="dop853", tolerance=tolerance)
    world = World(spring, IntegrateSystem(), simulation=simulation)
    world.spawn(Transform((1.0, 0.0)), Velocity((0.0, 2.0)), Mass(1.0), Name("ball"))
    return world, spring


@pytest.mark.parametrize("rate", [3.0, 80.0, 200.0, 500.0])
@pytest.mark.parametrize("every", [None, 0.1])
def test_instants_of_steps_that_are_divided_are_those_that_are_due(rate: float, every: float | None) -> None:
    laws = PhysicsConfig(gravity_mode="none")
    world = World(physics=laws, simulation=SimulationConfig(dt=1.0 / 30.0))
    bob = world.spawn(Transform((1.0, 0.0)), Velocity((0.0, rate)), Mass(1.0), Name("bob"))
    world.spawn(Rod(b=bob))
    run = world.record(0.3, every=every)
    stride = 1 if every is None else 3
    assert run.times == pytest.approx(np.arange(9 // stride + 1) * stride / 30.0, abs=1e-15)
    assert run.columns["bob.x"] == pytest.approx(np.cos(rate * run.times), abs=1e-9)
    assert run.columns["bob.vy"] == pytest.approx(rate * run.columns["bob.x"], abs=1e-9 * rate)


@pytest.mark.parametrize("tolerance", [1e-5, 1e-8, 1e-11, 1e-14])
def test_instants_within_the_steps_of_a_method_are_as_good_as_these(tolerance: float) -> None:
    world, _ = held(tolerance)
    run = world.record(3.0)
    assert world.plan.integrator.name == "dop853"
    x, y = run.columns["ball.x"], run.columns["ball.y"]
    assert x == pytest.approx(np.cos(2.0 * run.times), abs=40.0 * tolerance + 1e-15)
    assert y == pytest.approx(np.sin(2.0 * run.times), abs=40.0 * tolerance + 1e-15)
    assert run.columns["ball.vy"] == pytest.approx(2.0 * x, abs=100.0 * tolerance + 2e-15)


def test_instants_cost_no_steps_of_a_method() -> None:
    (world, spring), (other, alone) = held(1e-8), held(1e-8)
    world.record(5.0)
    other.run(seconds=5.0)
    assert bits(world) == bits(other) and len(world.record(5.0).times) == 301
    assert alone.evaluations > 200 and spring.evaluations < 2 * 1.3 * alone.evaluations


def test_an_orbit_is_recorded_as_exactly_as_it_is_followed() -> None:
    def planets() -> World:
        world = World(physics=PhysicsConfig(gravity_mode="planet"))
        world.spawn(Transform((0.0, 0.0)), Velocity(), Mass(1.0), Name("sun"))
        world.spawn(Transform((0.2, 0.0)), Velocity((0.0, 3.0)), Mass(1e-9), Name("planet"))
        return world

    world, other = planets(), planets()
    run = world.record(12.0)
    assert world.plan.smooth and world.plan.integrator.name == "exact"
    assert run.energies["world.energy"] == pytest.approx(run.energies["world.energy"][0], rel=2e-14)
    places = [other.component("planet", Transform).position.x for _ in other.stepping(seconds=12.0)]
    assert run.columns["planet.x"][1:] == pytest.approx(np.array(places), abs=1e-13)


@pytest.mark.parametrize("every", [None, 0.05])
def test_islands_are_recorded_without_a_call_for_each_instant(
    every: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    def apart() -> World:
        world = World()
        box(world, (0.0, -0.5), width=400.0, height=1.0, static=True)
        for n in range(3):
            circle(world, (60.0 * n, 2.0), radius=0.3, velocity=(0.5, 0.0), restitution=0.7)
        hung = world.spawn(Transform((-80.0, 30.0)), Velocity(), Mass(1.0))
        world.add(hung, Spring(a=hung, anchor_b=(-80.0, 33.0), rest_length=2.0, stiffness=50.0, damping=0.1))
        return world

    calls = 0
    advance = Islands.advance

    def counted(islands: Islands, *arguments: Any) -> Any:
        nonlocal calls
        calls += 1
        return advance(islands, *arguments)

    world, other, single = apart(), apart(), apart()
    monkeypatch.setattr(Islands, "advance", counted)
    run = world.record(1.0, every=every)
    assert len(world.islands.members) == 4 and calls < 5
    other.run(seconds=1.0)
    assert bits(world) == bits(other)
    for number, _ in enumerate(single.stepping(seconds=1.0, stride=1 if every is None else 3), start=1):
        rows = single.batch(Transform, Velocity).rows
        assert run.motion[number, :, 0:2] == pytest.approx(
            single.table(Transform)["position"][rows], abs=1e-12
        )


def test_smooth_islands_that_arise_on_the_way_are_not_divided() -> None:
    def swinging() -> World:
        world = World()
        box(world, (0, -0.5), width=40, height=1, static=True)
        box(world, (0, 0.25), name="box")
        world.spawn(Transform((0, 1.6)), Velocity((2, 0)), Mass(), name="bob")
        world.spawn(Rod("box", "bob", length=1.35, breaks=5.0))
        world.spawn(Spring("bob", anchor_b=(0, 3), rest_length=1.0, stiffness=40))
        world.synchronise()
        assert not world.islands.members
        return world

    world, other = swinging(), swinging()
    run = world.record(20.0)
    other.run(seconds=20.0)
    assert [island.touches for island in other.islands.members] == [True, False]
    assert bits(world) == bits(other) and len(run.times) == 1201


@pytest.mark.parametrize("every", [None, 0.05])
def test_what_rests_is_recorded_without_steps_of_it(
    every: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    world, other = load_scene("stack"), load_scene("stack")
    rest, rested = RigidMotion.rest, 0

    def counted(motion: RigidMotion, h: float) -> None:
        nonlocal rested
        rested += 1
        rest(motion, h)

    monkeypatch.setattr(RigidMotion, "rest", counted)
    run = world.record(2.0, every=every)
    assert rested > 100 and run.times == pytest.approx(np.linspace(0.0, 2.0, len(run.times)))
    other.run(seconds=2.0)
    assert bits(world) == bits(other) and (run.motion[-20:] == run.motion[-1]).all()


def test_instants_that_cannot_be_as_near_as_asked_for_are_told(caplog: pytest.LogCaptureFixture) -> None:
    """Of a millisecond there was one a step of 17, without a word."""
    world = thrown()
    world.simulation = SimulationConfig(dt=0.02)
    for every, apart, dt in (
        (0.001, 0.02, "0.001"),
        (0.05, 0.06, "0.0166666667"),
        (0.04, 0, ""),
        (2.0, 0, ""),
    ):
        caplog.clear()
        world.record(1.0, every=every)
        what = f"record: every = {every} s is no whole number of steps: instants are {apart} s apart"
        assert caplog.messages == ([f"{what}; simulation.dt = {dt} would help"] if apart else [])


@pytest.mark.parametrize(("seconds", "every"), [(0.305, None), (0.3, 0.04), (0.30001, 0.1), (0.001, 1.0)])
def test_a_run_that_is_no_multiple_of_its_steps_ends_with_its_end(
    seconds: float, every: float | None
) -> None:
    world = thrown()
    run = world.record(seconds, every=every)
    x, t = run.columns["ball.x"], run.columns["time"]
    assert t[-1] == world.time == seconds and t[0] == 0.0 and (np.diff(t) > 0.0).all()
    assert x == pytest.approx(7.0 * t, abs=1e-14)
    assert run.columns["ball.y"] == pytest.approx(1.0 + 3.0 * t - 0.5 * 9.81 * t * t, abs=1e-14)


def test_a_body_that_nothing_turns_turns_steadily_between_samples() -> None:
    world = thrown(angular_damping=0.5)
    world.component("ball", Velocity).angular = 2.0
    run = world.record(1.0)
    t = run.times
    assert run.columns["ball.omega"] == pytest.approx(2.0 * np.exp(-0.5 * t), rel=1e-13)
    assert run.columns["ball.angle"] == pytest.approx(4.0 * -np.expm1(-0.5 * t), rel=1e-13)


@pytest.mark.parametrize(
    ("until", "expected"),
    [
        ("ball.x >= 8", 8.0 / 7.0),
        ("ball.x >= 80 cm", 0.8 / 7.0),
        ("ball.y < 0", (3.0 + math.sqrt(9.0 + 2.0 * 9.81)) / 9.81),
        ("ball.vy <= 0 m/s and ball.x > 1 m", 3.0 / 9.81),
        ("time > 0.3 s", 0.3),
        ("ball.y > 5", None),
        ("ball.x >= 0", 0.0),
    ],
)
def test_a_moment_is_found_to_rounding(until: str, expected: float | None) -> None:
    world = thrown()
    run = world.record(3.0, until=until)
    assert (run.found is None) == (expected is None)
    assert world.time == run.times[-1] == pytest.approx(3.0 if expected is None else expected, abs=2e-15)
    assert run.motion[-1, 0, 0] == world.component("ball", Transform).position.x
    assert run.times == pytest.approx(np.append(np.arange(len(run.times) - 1) / 60.0, world.time), abs=1e-14)
    world.run(seconds=0.5)
    assert world.component("ball", Transform).position.x == pytest.approx(7.0 * world.time, rel=1e-14)


def test_a_moment_within_drag_is_that_of_the_formula() -> None:
    world = thrown()
    world.add("ball", Drag(linear=0.5))
    run = world.record(5.0, every=1.0, until="ball.x >= 6 m")
    assert run.found == pytest.approx(-math.log(1.0 - 6.0 * 0.5 / 7.0) / 0.5, rel=1e-14)
    assert len(run.times) == 3


def test_an_impact_is_found_as_a_change_of_velocity_and_is_logged_once() -> None:
    world = load_scene("drop")
    run = world.record(3.0, until="ball.vy > 0")
    fall = math.sqrt(2.0 * 3.75 / 9.81)
    assert run.found == pytest.approx(fall, abs=1e-12)
    assert run.impacts["time"] == pytest.approx([fall], rel=1e-14)
    assert world.collisions == 1 == len(world.impacts["time"])


def test_energies_can_be_waited_for() -> None:
    world = load_scene("drop")
    run = world.record(3.0, until="world.kinetic >= 3 J")
    assert world.energy.kinetic == pytest.approx(3.0, rel=1e-14) == run.energies["world.kinetic"][-1]


@pytest.mark.parametrize(
    ("until", "words"),
    [
        ("ball.x", "is no condition"),
        ("ball.x = 3", "a moment is found by < or >"),
        ("bal.x > 3", "must begin with one of ball, world"),
        ("ball.z > 3", "ball has x, y, angle, vx"),
        ("ball.x > 3 s", "m and s cannot be compared"),
        ("max(ball.x) > 3", "is no number"),
        ("", "a number is needed"),
    ],
)
def test_what_is_no_condition_is_refused_before_a_step(until: str, words: str) -> None:
    world = thrown()
    with pytest.raises(InvalidValue) as refused:
        world.record(1.0, until=until)
    assert str(refused.value).startswith(f"record.until = {until!r}: must be a condition")
    assert words in str(refused.value) and world.time == 0.0
    world.record(0.1)
    assert world.time == 0.1


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"seconds": -1.0}, "run.seconds = -1.0"),
        ({"seconds": 1.0, "every": 0.0}, "record.every = 0.0"),
        ({"seconds": 1.0, "every": "1 m"}, "is in m; this is in s"),
    ],
)
def test_times_are_checked(wrong: dict[str, Any], words: str) -> None:
    with pytest.raises(InvalidValue, match=words):
        thrown().record(**wrong)


def test_impacts_and_accounts_are_those_of_the_run() -> None:
    world = load_scene("drop")
    world.run(seconds=1.0)
    run = world.record(2.0)
    assert list(run.impacts["a"]) == ["floor"] and list(run.impacts["b"]) == ["ball"]
    assert run.impacts["energy_lost"].sum() == pytest.approx(-run.account["impacts"], rel=1e-12)
    assert run.impacts["speed_after"] == pytest.approx(
        -run.impacts["restitution"] * run.impacts["speed_before"]
    )
    energy = run.energies["world.energy"]
    assert energy[-1] - energy[0] == pytest.approx(sum(run.account.values()), rel=1e-12)
    assert energy[-1] == measure_energy(world).total == world.energy.total
    world.reset()
    assert run.energies["world.energy"] is energy, "a run stays as it is"


def test_soft_contacts_have_their_impacts_too() -> None:
    world = load_scene("gas")
    assert len(world.record(0.1).impacts["time"]) == world.collisions > 0
    assert not world.contacts.read


@pytest.fixture
def run() -> Run:
    return thrown().record(0.5, every=0.1)


def test_a_run_is_saved_with_every_bit(run: Run, tmp_path: Path) -> None:
    run.save(tmp_path / "run.npz")
    with np.load(tmp_path / "run.npz") as kept:
        assert {name: kept[name].tolist() for name in kept} == {k: v.tolist() for k, v in run.table.items()}
    run.save(str(tmp_path / "run.csv"))
    heading, *rows = csv.reader((tmp_path / "run.csv").read_text("utf-8").splitlines())
    assert heading[:3] == ["time [s]", "ball.x [m]", "ball.y [m]"] and heading[-1] == "world.energy [J]"
    columns = np.array(rows, float).T
    assert all(np.array_equal(*pair) for pair in zip(columns, run.table.values(), strict=True))
    with pytest.raises(ValueError, match=r"must end with one of \.npz, \.csv, \.parquet"):
        run.save(tmp_path / "run.xlsx")


def test_headings_are_no_formulas(tmp_path: Path) -> None:
    world = World()
    circle(world, (0.0, 1.0), name="=1+1")
    world.record(0.1).save(tmp_path / "run.csv")
    assert (tmp_path / "run.csv").read_text("utf-8").startswith("time [s],'=1+1.x [m],")
    out = tmp_path / "sweep.csv"
    for _ in range(2):  # the second time it is read
        found = ensemble(
            thrown(), {"ball.Mass.mass": [1.0]}, measure={"=1+1": "ball.x"}, seconds=0.1, executor="serial",
            out=out,
        )  # fmt: skip
        assert found.columns["=1+1"].tolist() == pytest.approx([0.7])
    assert out.read_text("utf-8").startswith("ball.Mass.mass,'=1+1,")


def test_tables_of_other_libraries_have_the_units(run: Run, tmp_path: Path) -> None:
    pandas, xarray, parquet = map(pytest.importorskip, ("pandas", "xarray", "pyarrow.parquet"))
    table = run.to_pandas()
    assert isinstance(table, pandas.DataFrame) and table["ball.x"].tolist() == run.columns["ball.x"].tolist()
    assert table.attrs["units"]["ball.vx"] == "m/s" and table.attrs["units"]["world.energy"] == "J"
    dataset = run.to_xarray()
    assert isinstance(dataset, xarray.Dataset) and dict(dataset.sizes) == {"time": 6, "body": 1}
    assert dataset["vy"].attrs["units"] == "m/s" and float(dataset["x"].sel(body="ball")[-1]) == 3.5
    run.save(tmp_path / "run.parquet")
    kept = parquet.read_table(tmp_path / "run.parquet")
    assert kept["ball.y"].to_pylist() == run.columns["ball.y"].tolist()
    assert kept.schema.field("ball.omega").metadata == {b"unit": b"rad/s"}


@pytest.mark.parametrize(
    ("call", "library"), [("to_pandas", "pandas"), ("to_xarray", "xarray"), ("save", "pyarrow")]
)
def test_a_library_that_is_missing_is_named_in_one_line(
    run: Run, call: str, library: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(ImportError, match=f"{call} needs {library}, which is not installed: pip install"):
        getattr(run, call)(*([tmp_path / "run.parquet"] if call == "save" else []))


def test_a_notebook_shows_the_player_of_a_run(run: Run) -> None:
    shown = run._repr_html_()
    assert shown.startswith("<iframe srcdoc=") and shown.count("<iframe") == 1
    page = html.unescape(shown.split('"')[1])
    assert page.encode() == run.page() and "ball" in page and "http" not in page.split("<script>")[-1]


def test_a_world_shows_what_a_person_asks_for() -> None:
    world = load_scene("drop")
    shown = dir(world)
    assert len(shown) < 35 and all(hasattr(world, name) for name in shown)
    assert {"energy", "momentum", "impacts", "describe", "record", "run"} <= set(shown)
    assert world.momentum.linear.x == 1.0 and len(world.impacts["time"]) == 0
    assert world.describe("de") != world.describe() == importlib.import_module("physicslab").describe(world)
