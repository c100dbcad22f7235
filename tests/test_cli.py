"""The command line: what it writes where, and how it refuses."""

import csv
import dataclasses
import errno
import io
import json
import math
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import physicslab
from physicslab import cli, load_scene, save_scene
from physicslab.__main__ import run
from physicslab.commands import progress
from physicslab.commands.measured_run import MeasuredRun
from physicslab.commands.output import Output
from physicslab.commands.usage import COMMANDS
from physicslab.components.quantities import ENERGY_CAUSES
from physicslab.diagnostics.run_report import find_not_finite
from physicslab.lab.accuracy.catalogue import PROBLEMS
from physicslab.lab.accuracy.contacts.catalogue import CONTACTS
from physicslab.lab.stability.catalogue import CASES
from physicslab.scenes import SCENES

ROOT = Path(__file__).parent.parent
NO_HANGUP = pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="there is no such signal here")


def document(capsys: pytest.CaptureFixture[str], *arguments: str) -> dict[str, Any]:
    """Run a command that writes JSON to stdout; return what it wrote."""
    assert cli.main([*arguments, "--json", "-"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    read: dict[str, Any] = json.loads(out, parse_constant=lambda word: pytest.fail(f"{word} in JSON"))
    return read


def complaint(capsys: pytest.CaptureFixture[str], *arguments: str, status: int = 2) -> str:
    """Run a command that must fail with this status; return its one line."""
    assert cli.main(arguments) == status
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1 and err.startswith("physicslab: ")
    return err.removeprefix("physicslab: ").rstrip("\n")


def test_the_summary_of_a_scene_that_has_a_past_says_from_when_to_when(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    world = load_scene("drop")
    world.run(seconds=1.25)
    save_scene(world, tmp_path / "later.json")
    assert cli.main(["run", str(tmp_path / "later.json"), "--seconds", "0.5"]) == 0
    assert "  time        1.25 s to 1.75 s in 30 steps of 0.0166667 s" in capsys.readouterr().out


def test_run_writes_the_document_of_the_contract(capsys: pytest.CaptureFixture[str]) -> None:
    report = document(capsys, "run", "drop", "--seconds", "1")
    assert list(report) == [
        "scene", "time", "steps", "dt", "substeps", "integrator", "integrator_reason", "collision_method",
        "collision_reason", "contact_model", "contact_reason", "summation", "interpreted",
        "force_evaluations", "wall_s", "compile_s", "interpreted_steps", "interpreted_s", "stepper",
        "reason_codes", "steppers_left_out", "islands", "islands_reason", "systems", "left_out", "energy",
        "account", "momentum_account",
        "angular_momentum_account", "momentum", "angular_momentum",
        "candidate_pairs", "contacts", "asleep", "contact_forces", "collisions", "max_penetration",
        "divided", "advice", "advice_codes", "entities",
    ]  # fmt: skip
    assert (report["scene"], report["time"], report["steps"]) == ("drop", 1.0, 60)
    assert (report["dt"], report["substeps"], report["integrator"]) == (1 / 60, 4, "exact")
    assert report["integrator_reason"].startswith("between impacts bodies move in closed form")
    assert report["force_evaluations"] == 0
    assert 0.0 < report["wall_s"] < 10.0
    gravity = next(system for system in report["systems"] if system["name"] == "GravitySystem")
    assert gravity["calls"] > 0 and gravity["ms"] == 0.0  # its cost is part of the event loop's
    spring = {"name": "SpringSystem", "reason": "no Spring in the scene"}
    assert {**spring, "code": "no_component", "values": {"components": "Spring"}} in report["left_out"]
    assert set(report["energy"]) == {
        "initial", "final", "kinetic_linear", "kinetic_angular", "potential_gravity", "potential_spring",
        "exchanged", "max_relative_drift", "max_relative_change", "changed_by",
    }  # fmt: skip
    assert report["energy"]["initial"] == 39.74
    assert list(report["entities"]) == ["floor", "ball"]
    assert list(report["entities"]["ball"]) == ["position", "angle", "linear", "angular"]
    assert report["entities"]["floor"]["linear"] == [0.0, 0.0]
    assert report["collisions"] == 1


@pytest.mark.parametrize("scene", ["drop", "newtons_cradle", "resonance", "two_planets", "pendulum"])
def test_each_system_is_among_those_that_run_or_those_left_out(
    scene: str, capsys: pytest.CaptureFixture[str]
) -> None:
    report = document(capsys, "run", scene, "--steps", "2")
    found = [part["name"] for key in ("systems", "left_out") for part in report[key]]
    assert sorted(found) == sorted(system.name for system in load_scene(scene).schedule.systems)
    calls = {system["name"]: system["calls"] for system in report["systems"]}
    assert calls.get("SpringSystem", 2) > 0  # rigid contacts did not name springs, drag, drives and fluids


def test_the_numbers_are_those_of_the_world(capsys: pytest.CaptureFixture[str]) -> None:
    from physicslab.components import Transform
    from physicslab.diagnostics.energy import measure_energy, measure_momentum

    report = document(capsys, "run", "spring_chain", "--seconds", "2.5")
    world = load_scene("spring_chain")
    for _ in world.stepping(seconds=2.5, stride=1):
        pass
    bob = next(entity for entity in world.entities() if world.label(entity) == "circle 3")
    assert report["entities"]["circle 3"]["position"] == list(world.component(bob, Transform).position)
    energy = measure_energy(world)
    assert report["energy"]["final"] == energy.total
    assert report["energy"]["potential_spring"] == energy.potential["spring"] > 0.0
    assert report["momentum"] == list(measure_momentum(world).linear)
    assert report["angular_momentum"] == measure_momentum(world).angular
    assert report["force_evaluations"] == world.force_evaluations


def test_time_is_exactly_as_requested(capsys: pytest.CaptureFixture[str]) -> None:
    report = document(capsys, "run", "drop", "--seconds", "0.1", "--dt", "0.03")
    assert (report["time"], report["steps"], report["dt"]) == (0.1, 4, 0.03)
    report = document(capsys, "run", "stack", "--contacts", "soft", "--steps", "7", "--substeps", "2")
    assert (report["steps"], report["substeps"], report["force_evaluations"]) == (7, 2, 14)
    report = document(capsys, "run", "drop", "--steps", "0")
    assert (report["steps"], report["time"], report["energy"]["max_relative_drift"]) == (0, 0.0, 0.0)
    assert document(capsys, "run", "pendulum")["time"] == 10.0


def test_the_method_can_be_chosen(capsys: pytest.CaptureFixture[str]) -> None:
    report = document(capsys, "run", "pendulum", "--steps", "5", "--integrator", "symplectic_euler")
    assert (report["integrator"], report["integrator_reason"]) == ("symplectic_euler", "asked for")


def test_errors_and_penetration_are_the_largest_of_the_run(capsys: pytest.CaptureFixture[str]) -> None:
    report = document(capsys, "run", "dominoes", "--seconds", "3")
    energy = report["energy"]
    assert {"impacts", "friction"} & set(energy["changed_by"]) and "edits" not in energy["changed_by"]
    assert energy["max_relative_change"] > 0.5 and energy["final"] < 0.9 * energy["initial"]
    assert 0.0 <= energy["max_relative_drift"] < 0.01, "what impacts and friction took is no error"
    world, deepest = load_scene("dominoes"), 0.0
    for _ in world.stepping(seconds=3):
        deepest = max(deepest, world.contacts.max_penetration)
    assert report["max_penetration"] == deepest > world.contacts.max_penetration


def test_bodies_are_named_without_doubt(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = tmp_path / "twins.json"
    entities = [{"id": "entity 2", "Transform": {}}, {"Transform": {}}, {"id": "note"}]
    path.write_text(json.dumps({"format": "physicslab-scene/1", "entities": entities}))
    report = document(capsys, "run", str(path), "--steps", "1")
    assert list(report["entities"]) == ["entity 2", "entity 2 (2)"]
    assert report["scene"] == "twins"


def test_a_scene_goes_on_from_its_own_time(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    world = load_scene("pendulum")
    world.run(seconds=1.0)
    save_scene(world, tmp_path / "later.json")
    report = document(capsys, "run", str(tmp_path / "later.json"), "--seconds", "0.5")
    assert report["time"] == 1.5


def test_run_reports_how_many_sleep(capsys: pytest.CaptureFixture[str]) -> None:
    report = document(capsys, "run", "pyramid", "--seconds", "6")
    assert (report["asleep"], report["contacts"]) == (465, 900)
    assert cli.main(["run", "pyramid", "--seconds", "6"]) == 0
    assert "asleep      465 of 466 bodies, at rest" in capsys.readouterr().out


def test_run_writes_a_row_a_step_and_body(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["run", "drop", "--steps", "3", "--csv", "-"]) == 0
    rows = list(csv.reader(io.StringIO(capsys.readouterr().out)))
    assert rows[0] == [
        "time [s]", "entity", "x [m]", "y [m]", "angle [rad]", "vx [m/s]", "vy [m/s]", "omega [rad/s]",
        "kinetic linear [J]", "kinetic angular [J]", "potential gravity [J]", "potential spring [J]",
        "energy [J]", "px [kg m/s]", "py [kg m/s]", "angular momentum [kg m^2/s]",
        *(f"account {cause} [J]" for cause in ENERGY_CAUSES), "error of energy [J]",
    ]  # fmt: skip
    assert [row[1] for row in rows[1:]] == 4 * ["floor", "ball"]
    assert [float(row[0]) for row in rows[1::2]] == [0.0, 1 / 60, 2 / 60, 3 / 60]
    assert rows[2][:8] == ["0.0", "ball", "-3.0", "4.0", "0.0", "1.0", "0.0", "0.0"]
    assert float(rows[4][6]) == pytest.approx(-9.81 / 60, rel=1e-12)


def test_files_are_written_and_the_summary_goes_to_stdout(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    report, table = tmp_path / "run.json", tmp_path / "run.csv"
    assert cli.main(["run", "drop", "--steps", "5", "--json", str(report), "--csv", str(table)]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    assert out.startswith("drop: A ball on a floor\n")
    assert "SpringSystem: no Spring in the scene" in out
    assert json.loads(report.read_text())["steps"] == 5
    assert len(table.read_text().splitlines()) == 1 + 6 * 2
    assert sorted(os.listdir(tmp_path)) == ["run.csv", "run.json"]


def test_a_picture_is_drawn_without_a_window(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "picture.png"
    assert cli.main(["run", "drop", "--steps", "5", "--png", str(path)]) == 0
    assert path.read_bytes().startswith(b"\x89PNG\r\n\x1a\n")
    assert capsys.readouterr().err == ""


def test_scenes_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["scenes"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(SCENES)
    assert next(line for line in lines if line.startswith("gas")).split()[1] == "2000"
    listed = document(capsys, "scenes")["scenes"]
    assert [scene["name"] for scene in listed] == list(SCENES)
    assert {
        "name": "drop", "title": "A ball on a floor", "bodies": 2, "description": SCENES["drop"].description,
    } in listed  # fmt: skip


MASS = "ball.Mass.mass"
VARIED = ["--vary", f"{MASS}=1:2:2"]
OPENED = ["sweep", "drop", *VARIED, "--open", "1"]
USAGE = [
    (["run"], "the following arguments are required: SCENE"),
    (["run", "drop", "--dt", "0"], "argument --dt: '0': must be a finite number > 0 s"),
    (["run", "drop", "--dt", "nan"], "argument --dt: 'nan': must be a finite number > 0 s"),
    (["run", "drop", "--dt", "fast"], "argument --dt: 'fast': must be a finite number > 0 s"),
    (["run", "drop", "--dt", "1e999"], "argument --dt: '1e999': must be a finite number > 0 s"),
    (["run", "drop", "--seconds", "-1"], "argument --seconds: '-1': must be a finite number >= 0 s"),
    (["run", "drop", "--seconds", "inf"], "argument --seconds: 'inf': must be a finite number >= 0 s"),
    (["run", "drop", "--seconds", "1e300"], "--seconds 1e+300: must be at most 1e+15 steps of dt"),
    (["run", "drop", "--seconds", "1e300", "--dt", "1e-30"], "--seconds 1e+300: must be at most 1e+15 steps"),
    (["run", "drop", "--steps", "1.5"], "argument --steps: '1.5': must be a whole number >= 0"),
    (["run", "drop", "--steps", "-1"], "argument --steps: '-1': must be a whole number >= 0"),
    (["run", "drop", "--steps", "9" * 400], "must be a whole number >= 0, at most 1e+15"),
    (["run", "drop", "--substeps", "0"], "argument --substeps: '0': must be a whole number >= 1"),
    (["run", "drop", "--substeps", "100000"], "--substeps 100000: must be a whole number"),
    (["run", "drop", "--integrator", "magic"], '--integrator "magic": must be one of "auto", '),
    (["run", "drop", "--seconds", "1", "--steps", "1"], "not allowed with argument"),
    (["run", "drop", "--sec", "1"], 'unrecognized arguments: --sec 1; did you mean "--seconds"?'),
    (["run", "drop", "--seconds=--"], "argument --seconds: '--': must be a finite number >= 0 s"),
    (["run", "drop", "--set=--"], '--set "--": must be ID.Component.field=VALUE'),
    (
        ["run", "drop", "--set", "physcs.gravity=1"],
        'must be ID.Component.field=VALUE; did you mean "physics"?',
    ),
    (["run", "drop", "--json", "-", "--csv", "-"], "--json and --csv cannot both go to -"),
    (
        ["run", "drop", "--json", "none/x.json"],
        "--json none/x.json: cannot be written: there is no directory",
    ),
    (["run", "drop", "--csv", "/"], "--csv /: cannot be written: / is a directory"),
    (["run", "drop", "--csv", "x/"], "--csv x/: cannot be written: x/ is the name of a directory"),
    (["lesson", "--language", ""], "argument --language: '': must be the code of a language, as de"),
    (["run", "drop", "--png", "a\0b"], "--png a\\x00b: cannot be written"),
    *((["run", "drop", "--png", name], f"--png {name}: must end in .png") for name in ("x.jpg", "x.PDF")),
    (["run", "drp"], 'drp: no such file, and no built-in scene; did you mean "drop"?'),
    (["run", "a\nb"], "a\\nb: no such file"),
    (["run", "."], ".: is a directory, not a scene file"),
    (["scenes", "all"], "unrecognized arguments: all"),
    (["scenes", "--json", "none/x.json"], "--json none/x.json: cannot be written"),
    (["newtons_crade"], 'did you mean "newtons_cradle"?'),
    (["nowhere.json"], "nowhere.json: no such file"),
    (["drop", "--fast"], "unrecognized arguments: --fast"),
    (["swep", "drop"], 'swep: is no command; did you mean "sweep"?'),
    (
        ["sweep", "drop", "--vary", f"{MASS}=1:2:2", "--set", f"{MASS}=3", "--measure", "time"],
        '--set: entity "ball": Mass.mass: is varied too; a field must be set or varied',
    ),
    (
        ["sweep", "drop", "--vary", f"{MASS}=1e308:-1e308:3", "--measure", "time"],
        'Mass.mass = "1e308:-1e308:3": must be two numbers that differ, and a count from 2',
    ),
    (
        ["sweep", "drop", "--vary", f"{MASS}=1:2:{'9' * 5000}", "--measure", "time"],
        "must be two numbers that differ, and a count from 2",
    ),
    (["sweep", "drop", *VARIED, "--measure", "1e309"], "measure \"1e309\": '1e309' is not finite"),
    (
        ["sweep", "drop", *VARIED, "--measure", "ball"],
        "measure \"ball\": 'ball' is no quantity: ball has x, y, angle, ",
    ),
    *(
        ([*OPENED, *option], f"{option[0]}: must go without --open, which makes no run")
        for option in (
            ("--out", "x.npz"),
            ("--map", "x.png"),
            ("--measure", "time"),
            ("--workers", "2"),
            ("--dask", "tcp://x:1"),
            ("--until", "time > 1"),
        )
    ),
    *(
        (["sweep", "drop", *VARIED, "--measure", "time", "--map", name], f"--map {name}: must end in .png")
        for name in ("x.jpg", "png", "-")
    ),
    (
        ["export", "drop", "--html", "x", "--vary", f"{MASS}=1:2:2", "--set", f"{MASS}=3"],
        '--set: entity "ball": Mass.mass: is varied too; a field must be set or varied',
    ),
    (["bench", "pilez"], '"pilez": is no scene; did you mean "pile"'),
    (["stability", "springz"], '"springz": is no case; did you mean "springs"?'),
    (
        ["stability", "qqqq"],
        '"qqqq": is no case; there are the groups springs, dampers, chains, joints, fields, stacks, ',
    ),
    (
        ["kernels", "import", "/dev/zero"],
        "/dev/zero: is a pipe or a device; an archive of kernels must be a plain",
    ),
    (["stability", "--json", "none/x.json", "far"], "--json none/x.json: cannot be written"),
]


@pytest.mark.parametrize(("arguments", "line"), USAGE, ids=[" ".join(map(ascii, a)) for a, _ in USAGE])
def test_bad_usage_is_refused_in_one_line(
    arguments: list[str], line: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert line in complaint(capsys, *arguments)


def test_a_bad_scene_is_refused_in_one_line(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = tmp_path / "bad.json"
    entities = [{"id": "ball", "Transform": {}, "Mass": {"mass": -1}}]
    path.write_text(json.dumps({"format": "physicslab-scene/1", "entities": entities}))
    line = f'{path}: entity "ball": Mass.mass = -1: must be a finite number > 0 kg'
    assert complaint(capsys, "run", str(path)) == line
    assert complaint(capsys, str(path)) == line, "before any window opens"


def test_a_run_does_not_write_over_its_own_scene(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    save_scene(load_scene("drop"), path)
    before = path.read_bytes()
    assert complaint(capsys, "run", str(path), "--json", str(path)).endswith("is the scene itself")
    assert "cannot both go to" in complaint(
        capsys, "run", "drop", "--csv", str(tmp_path / "x"), "--json", str(tmp_path / "x")
    )
    assert path.read_bytes() == before


def test_a_run_that_diverges_says_where_and_when(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)  # where the last good state is saved
    world = load_scene("resonance")
    spring = world.component(world.entity("1 Hz"), physicslab.components.Spring)
    spring.stiffness = 1e9
    world.simulation = dataclasses.replace(world.simulation, integrator="leapfrog")
    save_scene(world, tmp_path / "stiff.json")
    report, table = tmp_path / "run.json", tmp_path / "run.csv"
    line = complaint(
        capsys, "run", str(tmp_path / "stiff.json"), "--json", str(report), "--csv", str(table), status=1
    )
    # Whether a speed or an energy is seen first depends on the last digits.
    assert line.startswith("resonance: ") and "finite at t = " in line
    assert not report.exists(), "a report of a run that failed would be taken for one that did not"
    rows = table.read_text().splitlines()
    assert len(rows) > 2, "what led there can be looked at"
    assert all(math.isfinite(float(value)) for value in rows[-1].split(",")[2:])


def test_no_report_holds_what_is_not_a_number(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)  # where the last good state is saved
    ball = {"id": "ball", "Transform": {}, "Velocity": {"linear": [1e200, 0]}, "Mass": {}}
    scene = {"format": "physicslab-scene/1", "physics": {"gravity_mode": "none"}, "entities": [ball]}
    (tmp_path / "fast.json").write_text(json.dumps(scene))
    line = complaint(capsys, "run", str(tmp_path / "fast.json"), "--json", "-", status=1)
    assert line.startswith("fast: ") and "finite at t = " in line
    ball |= {"Transform": {"position": [0, -1e299]}, "Velocity": {}, "Mass": {"mass": 1e9}}
    (tmp_path / "far.json").write_text(json.dumps({"format": "physicslab-scene/1", "entities": [ball]}))
    line = complaint(capsys, "run", str(tmp_path / "far.json"), status=1)
    assert line.startswith("far: ") and "finite at t = " in line
    assert find_not_finite({"a": [{"b": 1.0}, {"b": math.inf}]}) == "a.1.b"


def test_how_collisions_are_found_is_said_with_the_reason(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    report = document(capsys, "run", "drop", "--steps", "1")
    assert report["collision_method"] == "exact"
    assert report["collision_reason"] == "few bodies, which bounce"
    report = document(capsys, "run", "stack", "--contacts", "soft", "--steps", "1")
    assert (report["collision_method"], report["integrator"]) == ("step", "leapfrog")
    assert "is a box that may turn" in report["collision_reason"]
    assert (report["contact_model"], report["contact_reason"]) == ("soft", "asked for")
    report = document(capsys, "run", "stack", "--steps", "1")
    assert (report["stepper"]["name"], report["integrator"]) == ("rigid", "dop853")
    assert "is a box that may turn" in report["collision_reason"]
    assert report["collision_reason"].endswith("; rigid contacts locate their own events")
    assert (report["contact_model"], report["contact_reason"]) == ("rigid", "few bodies touch")
    assert cli.main(["run", "stack", "--steps", "1"]) == 0
    assert "\n  touching    rigid contacts: few bodies touch\n" in capsys.readouterr().out
    path = tmp_path / "exact.json"
    scene = {"format": "physicslab-scene/1", "simulation": {"collisions": "exact"}, "entities": []}
    path.write_text(json.dumps(scene))
    report = document(capsys, "run", str(path), "--steps", "1")
    assert (report["collision_method"], report["collision_reason"]) == ("none", "nothing can touch")
    assert (report["contact_model"], report["contact_reason"]) == ("none", "nothing can touch")


def test_a_run_of_no_steps_writes_the_start(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    table = tmp_path / "run.csv"
    assert document(capsys, "run", "drop", "--steps", "0", "--csv", str(table))["steps"] == 0
    assert table.read_text().count("\n") == 3


def test_an_interrupted_run_ends_quietly(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(MeasuredRun, "_measure", interrupt)
    path = tmp_path / "run.json"
    assert complaint(capsys, "run", "drop", "--json", str(path), status=130) == (
        "interrupted; drop: at t = 0.0166666667 s, after 1 of 600 steps"
    )
    assert os.listdir(tmp_path) == []


def test_an_interrupted_import_is_not_tried_again(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The refusals are a part of the package, and numpy cannot be imported again: it ended in a traceback."""

    def interrupt(*_: object) -> int:
        raise KeyboardInterrupt

    monkeypatch.setattr(cli, "_dispatch", interrupt)
    monkeypatch.setattr(cli, "_refusals", lambda: pytest.fail("imported"))
    assert complaint(capsys, "scenes", status=130) == "interrupted"


@pytest.mark.parametrize(("name", "said"), [("SIGINT", "interrupted"), ("SIGTERM", "ended by SIGTERM")])
def test_an_interrupt_that_comes_in_a_callback_is_not_forgotten(
    name: str, said: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    number = getattr(signal, name)
    before = signal.getsignal(number)

    class Dropped:
        def __del__(self) -> None:
            signal.raise_signal(number)

    def go_on(*_: object) -> None:
        Dropped()
        for _count in range(1000):
            time.sleep(0.01)

    monkeypatch.setattr(MeasuredRun, "_measure", go_on)
    monkeypatch.setattr(sys, "argv", ["physicslab", "run", "drop"])
    where = "drop: at t = 0.0166666667 s, after 1 of 600 steps"
    assert run() == 128 + number and capsys.readouterr().err == f"physicslab: {said}; {where}\n"
    assert signal.getsignal(number) == before


@pytest.mark.parametrize("name", ["SIGTERM", pytest.param("SIGHUP", marks=NO_HANGUP)])
def test_rows_until_a_signal_are_kept(
    name: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The file that was being written stayed behind under a name of its own."""
    advance, number = MeasuredRun._advance, getattr(signal, name)

    def signalled(run: MeasuredRun, *arguments: Any) -> bool:
        if run.record.steps == 3:
            signal.raise_signal(number)
        return advance(run, *arguments)

    monkeypatch.setattr(MeasuredRun, "_advance", signalled)
    monkeypatch.setattr(sys, "argv", ["physicslab", "run", "drop", "--csv", str(tmp_path / "a.csv")])
    before = signal.signal(number, signal.SIG_DFL)  # under nohup one is ignored, and the program goes on
    try:
        assert run() == 128 + number
    finally:
        signal.signal(number, before)
    where = "drop: at t = 0.05 s, after 3 of 600 steps"
    assert capsys.readouterr().err == f"physicslab: ended by {name}; {where}\n"
    assert os.listdir(tmp_path) == ["a.csv"]
    assert (tmp_path / "a.csv").read_text().count("\n") == 1 + 2 * 4, "floor and ball, at each of four times"


def test_a_full_disk_is_said(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("physicslab.commands.output.replace_file", full)
    line = complaint(capsys, "run", "drop", "--steps", "1", "--json", "run.json", status=1)
    assert line == "--json run.json: cannot be written: No space left on device"


def test_help_is_no_failure(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["--help"]) == 0
    lines = capsys.readouterr().out.splitlines()
    listed = lines[lines.index("commands:") + 1 :]
    assert [line.split()[0] for line in listed] == list(COMMANDS)
    assert listed[0] == "  run        Run a scene without a window, and say what came of it."
    assert cli.main(["run", "--help"]) == 0
    assert "--substeps N" in capsys.readouterr().out


@pytest.mark.parametrize("name", COMMANDS)
def test_help_fits_on_a_screen(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main([name, "--help"]) == 0
    assert len(capsys.readouterr().out.splitlines()) <= 45


def test_names_are_listed_where_help_says_so(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["stability", "--list"]) == 0
    cases = [line.split()[:2] for line in capsys.readouterr().out.splitlines()]
    assert [name for name, _ in cases] == list(CASES) and ["spring_1_rest", "springs"] in cases
    assert cli.main(["accuracy", "--list"]) == 0
    assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == [*PROBLEMS, *CONTACTS]


def test_without_packages_one_line_says_what_to_do() -> None:
    done = process("-S", "-E", "main.py", "scenes")
    line = r"physicslab: the package \w+ is not installed: 'uv run main\.py' fetches what is needed, .*\n"
    assert (done.returncode, done.stdout) == (2, "") and re.fullmatch(line, done.stderr)


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere there is always a screen")
def test_without_a_screen_one_line_says_so() -> None:
    screens = ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER", "SDL_VIDEO_DRIVER")
    environment = {name: value for name, value in os.environ.items() if name not in screens}
    for scene in ([], ["drop"]):
        done = process("main.py", *scene, env=environment)
        assert (done.returncode, done.stdout) == (2, "")
        said = [line for line in done.stderr.splitlines() if line.startswith("physicslab: ")]
        assert len(said) == 1 and said[0].startswith("physicslab: no window can be opened: ")
        assert said[0].endswith("; physicslab run SCENE needs none")


def test_progress_is_for_terminals_and_long_runs() -> None:
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    for stream, after in ((Terminal(), "\rdrop: 50 %\x1b[K\r\x1b[K"), (io.StringIO(), "")):
        line = progress.Progress("drop", stream, clock=iter([0.0, 0.5, 1.5, 1.5, 1.55]).__next__)
        line.show(0.1)
        assert stream.getvalue() == ""
        line.show(0.5)
        line.show(0.6)  # too soon after the last
        line.clear()
        line.clear()
        assert stream.getvalue() == after


def test_an_output_identifies_its_file(tmp_path: Path) -> None:
    output = Output("--json", str(tmp_path / "a"))
    assert output.is_same_as(str(tmp_path / "b" / ".." / "a"))
    assert not output.is_same_as(str(tmp_path / "b"))
    assert not Output("--json", "-").is_same_as(str(tmp_path / "a"))
    assert Output("--json", "-").is_same_as("-")
    assert not Output("--json", os.devnull).is_same_as("-")


def test_a_scene_or_nothing_opens_the_window(monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str | None] = []

    def open_window(scene: str | None) -> int:
        opened.append(scene)
        return 3

    app = SimpleNamespace(open_window=open_window, NoScreen=OSError)
    monkeypatch.setitem(sys.modules, "physicslab.desktop.app", app)
    assert cli.main([]) == 3
    assert cli.main(["drop"]) == 3
    assert cli.main(["nothing"]) == 2
    assert opened == [None, "drop"]


def process(*arguments: str, **options: Any) -> subprocess.CompletedProcess[str]:
    """Run Python in a process of its own."""
    return subprocess.run(
        [sys.executable, *arguments], cwd=ROOT, capture_output=True, text=True, timeout=120, **options
    )


def test_main_py_is_the_same_program() -> None:
    done = process("main.py", "run", "two_planets", "--steps", "3", "--json", "-")
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads(done.stdout)["steps"] == 3
    done = process("main.py", "run", "nothing")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("physicslab: nothing: no such file") and done.stderr.count("\n") == 1


def test_a_reader_that_leaves_is_no_traceback() -> None:
    command = f"{sys.executable} main.py run gas --steps 40 --csv - | head -1; echo ${{PIPESTATUS[0]}}"
    done = process("-c", "import os, sys; os.execvp('bash', ['bash', '-c', sys.argv[1]])", command)
    assert done.stdout.splitlines()[1] == "141"
    assert done.stderr == ""


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["scenes"], "No space left on device"),
        (["--help"], "No space left on device"),
        (["run", "drop", "--csv", "-"], "--csv -: cannot be written: No space left on device"),
    ],
)
def test_a_full_stdout_is_said(arguments: list[str], line: str) -> None:
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "main.py", *arguments], cwd=ROOT, stdout=full, stderr=subprocess.PIPE, text=True
        )
    assert (done.returncode, done.stderr) == (1, f"physicslab: {line}\n")


@pytest.mark.parametrize("gone", ["closed", "full"])
def test_an_error_that_stderr_cannot_take_is_not_among_the_results(
    gone: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    class Full(io.StringIO):
        def write(self, text: str) -> int:
            raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(sys, "stderr", None if gone == "closed" else Full())
    assert cli.main(["run", "nothing"]) == 2
    assert capsys.readouterr().out == ""


@pytest.mark.skipif(not Path("/dev/stdout").exists(), reason="needs /dev/stdout")
def test_a_pipe_with_a_path_is_written_to_as_it_is() -> None:
    done = process("main.py", "scenes", "--json", "/dev/stdout")
    assert (done.returncode, done.stderr) == (0, "")
    assert '"name": "drop"' in done.stdout


def test_nothing_without_a_window_imports_pygame_or_scipy() -> None:
    """SciPy's linear algebra, which numba looks for where it is installed, took a fifth of each start."""
    code = """
import sys
import time
import physicslab
from physicslab import cli
assert cli.main(["scenes"]) == 0
assert cli.main(["run", "drop", "--steps", "2"]) == 0
sys.exit(any(name.startswith(("pygame", "scipy.linalg")) and module for name, module in sys.modules.items()))
"""
    done = process("-c", code)
    assert (done.returncode, done.stderr) == (0, "")


def test_the_package_exports_the_names_of_the_contract() -> None:
    assert set(physicslab.__all__) >= {
        "InvalidValue", "SceneError", "Vector2", "World", "load_scene", "save_scene",
    }  # fmt: skip
    for name in physicslab.__all__:
        assert getattr(physicslab, name).__doc__


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
def test_a_full_disk_is_reported_with_the_file_that_did_not_fit(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["run", "drop", "--seconds", "5", "--csv", "/dev/full"]) == 1
    message = capsys.readouterr().err
    assert "--csv /dev/full: cannot be written: No space left on device" in message
    assert message.count("\n") == 1
