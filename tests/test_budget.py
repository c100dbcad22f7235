"""Runs that take long or leave the range of numbers: stopped, with what was reached and where."""

import csv
import json
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from physicslab.cli import main
from physicslab.commands import measured_run
from physicslab.components import Transform
from physicslab.diagnostics.step_watch import StepWatch
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.config import SimulationConfig
from physicslab.files.scene import load_scene
from physicslab.history import History
from physicslab.world import World

BALL: dict[str, Any] = {
    "id": "ball", "Transform": {"position": [0, 2]}, "Velocity": {}, "Mass": {"mass": 2},
    "Shape": {"kind": "circle", "radius": 0.5},
}  # fmt: skip


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_run_stops_when_its_time_is_up_and_keeps_what_it_reached(
    capsys: pytest.CaptureFixture[str],
) -> None:
    load_scene("gas").run(steps=2)  # kernels are there
    command = ["run", "gas", "--seconds", "1e8", "--at-most", ".3", "--json", "o.json", "--csv", "o.csv"]
    assert main(command) == 1
    said = capsys.readouterr()
    report = json.loads(Path("o.json").read_text())
    assert said.err == f"physicslab: gas: {report['stopped']}\n" and said.out.startswith("gas: ")
    reached = f"at t = {report['time']:.9g} s, after {report['steps']} of 6000000000 steps"
    assert report["stopped"] == f"stopped after 0.3 s of wall clock (--at-most) {reached}"
    with Path("o.csv").open(newline="") as file:
        assert float(list(csv.reader(file))[-1][0]) == report["time"] > 0.0
    world = load_scene("gas")
    world.run(steps=report["steps"])
    places = [report["entities"][world.label(entity)]["position"] for entity in world.entities()]
    assert places == [list(world.component(entity, Transform).position) for entity in world.entities()]


def test_a_run_in_python_has_a_budget_too() -> None:
    world, other = load_scene("newtons_cradle"), load_scene("newtons_cradle")
    world.run(steps=30, at_most=100.0)
    other.run(steps=30)
    places = [each.table(Transform)["position"].tobytes() for each in (world, other)]
    assert places[0] == places[1] and world.steps == other.steps == 30
    told = r"^run: stopped after 1e-09 s of wall clock \(at_most\) at t = .* s, after .* of 1000000000 steps$"
    with pytest.raises(TimeoutError, match=told):
        world.run(steps=10**9, at_most=1e-9)
    assert 30 < world.steps < 10**6
    with pytest.raises(InvalidValue, match=r"run.at_most = 0: must be a finite number > 0 s"):
        world.run(steps=1, at_most=0)


def test_a_run_within_its_budget_is_as_any_other(capsys: pytest.CaptureFixture[str]) -> None:
    load_scene("stack").run(seconds=3.0)  # kernels are there: a first call that loads one is slow
    for budget in ([], ["--at-most", "100"]):
        assert main(["run", "stack", "--seconds", "3", "--json", f"{len(budget)}.json", *budget]) == 0
    assert capsys.readouterr().err == ""
    one, two = (json.loads(Path(name).read_text()) for name in ("0.json", "2.json"))
    assert one["entities"] == two["entities"] and one["steps"] == two["steps"] == 180
    assert "stopped" not in two


@pytest.mark.parametrize(("scene", "seconds"), [("pendulum", "50"), ("drop", "50"), ("stack", "30")])
def test_a_budget_changes_no_bit(scene: str, seconds: str) -> None:
    for name, budget in (("none", []), ("some", ["--at-most", "100"])):
        assert main(["run", scene, "--seconds", seconds, "--json", f"{name}.json", *budget]) == 0
    none, some = (json.loads(Path(f"{name}.json").read_text()) for name in ("none", "some"))
    assert none["entities"] == some["entities"] and none["energy"] == some["energy"]


@pytest.mark.parametrize("value", ["0", "-1", "nan", "inf", "soon"])
def test_a_budget_that_is_no_time_is_refused(value: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "drop", "--at-most", value]) == 2
    assert f"argument --at-most: '{value}': must be a finite number > 0 s" in capsys.readouterr().err


def test_a_slow_step_is_reported_once_with_its_place_and_its_reason() -> None:
    world = World(simulation=SimulationConfig(collisions="exact"))
    world.synchronise()
    watch = StepWatch(world)
    assert watch.note(1, 0.5) == "" and not watch.warnings, "half a second is nothing to speak of"
    world.time, world.force_evaluations = 0.5, 40_000
    line = watch.note(2, 5.0)
    assert line.startswith("the step to t = 0.5 s took 2.5 s: forces change so fast that")
    assert "20000" in line.replace("2e+04", "20000")
    assert watch.note(1, 7.0) == "", "one line is enough"
    (advice,) = watch.warnings
    assert advice.value == 7.0 and "there is much to compute" in advice.what


def test_a_storm_of_impacts_is_called_so() -> None:
    world = load_scene("drop")
    world.synchronise()
    watch = StepWatch(world)
    world.collisions += 5_000
    assert "one impact follows another (5e+03 impacts)" in watch.note(1, 2.0)
    (advice,) = watch.warnings
    assert advice.setting == 'simulation.collisions = "step"'


def narrow() -> dict[str, Any]:
    """Return a scene in which a ball leaves a slot hardly wider than itself, to and fro, within a step."""
    smooth = {"restitution": 1.0, "friction": 0.0}
    wall = {"Shape": {"kind": "box", "width": 2.0, "height": 1.0}, "Material": smooth}
    walls = [{"id": f"wall {x}", "Transform": {"position": [x, 0]}} | wall for x in (-1.500001, 1.500001)]
    ball = {
        "id": "ball", "Transform": {"position": [0, 0.45]}, "Velocity": {"linear": [0.3, -60]}, "Mass": {},
        "Shape": {"kind": "circle", "radius": 0.5}, "Material": smooth,
    }  # fmt: skip
    return {
        "format": "physicslab-scene/1", "physics": {"gravity_mode": "none"},
        "simulation": {"collisions": "exact"}, "entities": [*walls, ball],
    }  # fmt: skip


def test_run_reports_a_storm_of_impacts_within_one_of_many_compiled_steps(
    capsys: pytest.CaptureFixture[str],
) -> None:
    Path("narrow.json").write_text(json.dumps(narrow()))
    assert main(["run", "narrow.json", "--steps", "20000", "--json", "o.json"]) == 0
    report = json.loads(Path("o.json").read_text())
    (advice,) = report["advice"]
    assert advice["entity"] == "ball" and "storm of impacts" in advice["what"] and advice["value"] >= 1000
    line = capsys.readouterr().err
    assert line.count("\n") == 1 and line.startswith("physicslab: narrow: at t = ") and "ball" in line
    assert main(["run", "drop", "--seconds", "60", "--json", "o.json"]) == 0
    assert json.loads(Path("o.json").read_text())["advice"] == [] and capsys.readouterr().err == ""


@pytest.mark.parametrize("waits", [False, True])
def test_run_says_where_it_is_slow_and_not_that_it_waited_for_another_program(
    waits: bool, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    stepping, late = World.stepping, {"perf_counter": 0.0, "thread_time": 0.0}

    def sluggish(world: World, **options: Any) -> Iterator[int]:
        for done in stepping(world, **options):
            if done == 3:
                late["perf_counter"], late["thread_time"] = 1.1, 0.0 if waits else 1.1
            yield done

    def clock(name: str) -> Callable[[], float]:
        return lambda: float(getattr(time, name)()) + late[name]

    monkeypatch.setattr(World, "stepping", sluggish)
    monkeypatch.setattr(measured_run, "time", SimpleNamespace(**{name: clock(name) for name in late}))
    assert main(["run", "stack", "--steps", "5", "--json", "o.json"]) == 0
    line = capsys.readouterr().err
    if waits:
        assert line == "" and json.loads(Path("o.json").read_text())["advice"] == []
        return
    assert (
        line.startswith("physicslab: stack: slow: the step to t = 0.05 s took 1.") and line.count("\n") == 1
    )
    assert line.endswith('simulation.contacts = "soft" would help\n')
    advice = json.loads(Path("o.json").read_text())["advice"]
    why = "rigid contacts go from one event to the next"
    assert [found["what"] for found in advice] == [f"a step takes long: {why}"]


OVERFLOWS = [
    ({"Velocity": {"linear": [1e200, 0]}}, "ball: Velocity.linear = [1e+200, 0] m/s: its kinetic energy"),
    (
        {"Velocity": {"angular": 1e170}},
        "ball: Velocity.angular = 1e+170 rad/s: its kinetic energy of rotation",
    ),
    (
        {"Transform": {"position": [0, 1e299]}, "Velocity": {"linear": [1e12, 0]}},
        "ball: Transform.position = [0, 1e+299] m: its angular momentum about the origin",
    ),
]


@pytest.mark.parametrize(("changes", "line"), OVERFLOWS)
def test_a_sum_that_is_not_finite_names_its_entity_and_its_time(
    changes: dict[str, Any], line: str, capsys: pytest.CaptureFixture[str]
) -> None:
    scene = {
        "format": "physicslab-scene/1",
        "entities": [{"id": "other", "Transform": {}}, {**BALL, **changes}],
    }
    Path("far.json").write_text(json.dumps(scene))
    assert main(["run", "far.json"]) == 1
    said = capsys.readouterr().err
    assert said.startswith(
        f"physicslab: far: {line} is not finite at t = 0 s; the last good state, of t = 0 s"
    )


def test_the_time_of_an_overflow_is_when_it_came(capsys: pytest.CaptureFixture[str]) -> None:
    scene = {
        "format": "physicslab-scene/1", "entities": [BALL],
        "physics": {"gravity": [1e153, 0.0]}, "simulation": {"dt": 1.0},
    }  # fmt: skip
    Path("fall.json").write_text(json.dumps(scene))
    assert main(["run", "fall.json", "--seconds", "1000"]) == 1
    said = capsys.readouterr().err
    assert said.startswith("physicslab: fall: ball: ") and " is not finite at t = " in said
    when = float(said.split(" at t = ")[1].split(" s;")[0])
    # v = g t, and m v^2 / 2 leaves the numbers at 1.34e154 m/s.
    assert 13.4 < when < 16.0


@pytest.mark.parametrize("length", [240, 900])
def test_a_long_name_is_shortened_in_messages(length: int, capsys: pytest.CaptureFixture[str]) -> None:
    fast = {**BALL, "Velocity": {"linear": [1e200, 0]}}
    scene = {"format": "physicslab-scene/1", "name": "x" * length, "entities": [fast]}
    Path("long.json").write_text(json.dumps(scene))
    assert main(["run", "long.json"]) == 1
    said = capsys.readouterr().err
    assert said.startswith(f"physicslab: {'x' * 57}...: ball: ") and "-before-divergence.json" in said
    Path("long.json").write_text(json.dumps({**scene, "name": "x" * 10**7}))
    assert main(["run", "long.json"]) == 2
    assert len(capsys.readouterr().err) < 300


def test_a_replay_stops_when_its_time_is_up(capsys: pytest.CaptureFixture[str]) -> None:
    history = History(load_scene("drop"))
    history.step(steps=50)
    history.save("r.json")
    assert main(["replay", "r.json", "--at-most", "1e-9", "--json", "o.json"]) == 1
    report = json.loads(Path("o.json").read_text())
    assert "after 1 of 50 steps" in report["stopped"] and report["same"]
    assert f"physicslab: r.json: {report['stopped']}" in capsys.readouterr().err
    assert main(["replay", "r.json", "--at-most", "100"]) == 0


@pytest.mark.parametrize("kind", ["html", "gif"])
def test_an_export_stops_when_its_time_is_up_and_keeps_what_it_reached(
    kind: str, capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["export", "drop", f"--{kind}", f"o.{kind}", "--seconds", "5", "--at-most", "1e-9"]
    assert main(command) == 1
    error = capsys.readouterr().err
    assert "drop: stopped after 1e-09 s of wall clock (--at-most) at t = " in error
    assert Path(f"o.{kind}").stat().st_size > 0
