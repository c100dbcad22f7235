"""Ensembles: rows of a space, measures of runs, and results that are found again."""

import csv
import itertools
import os
import re
import shutil
import sys
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from physicslab import SceneError, World, ensemble, load_scene
from physicslab.cli import main
from physicslab.components import Mass, Material, Transform
from physicslab.ensembles import sink
from physicslab.ensembles.runs import task_of
from physicslab.ensembles.sobol import DIMENSIONS, sobol
from physicslab.ensembles.space import space_of
from physicslab.ensembles.task import Runner
from physicslab.files.places import entity_names
from physicslab.prefabs import box, circle

E, M = "ball.Material.restitution", "ball.Mass.mass"
DRAWN: dict[str, Any] = {
    E: ("uniform", 0.2, 0.9),
    M: ("normal", 2.0, 0.1),
    "ball.Velocity.linear.x": ("sobol", 0, 1),
}


def height_at_end(world: World) -> float:
    return world.component("ball", Transform).position.y


def bits(columns: Mapping[str, Any]) -> dict[str, Any]:
    return {name: column.tolist() for name, column in columns.items() if name != "wall_s"}


@given(st.integers(0, 2**63), st.lists(st.integers(0, 60), min_size=2, max_size=6))
def test_the_numbers_of_a_row_depend_on_the_seed_and_on_its_place_alone(seed: int, cuts: list[int]) -> None:
    world = load_scene("drop")
    space = space_of(world, {**DRAWN, "physics.G": [1.0, 2.0, 3.0]}, 20, seed, 1, 0.0)
    whole = space.columns(0, len(space))
    for first, last in itertools.pairwise(sorted({0, len(space), *cuts})):
        for name, column in space.columns(first, last).items():
            assert column.tobytes() == whole[name][first:last].tobytes()
    other = space_of(world, dict(reversed(DRAWN.items())), 40, seed, 1, 0.0).columns(0, 20)
    for name in DRAWN:
        assert other[name].tobytes() == whole[name][:20].tobytes(), "more samples, other fields beside it"


def test_a_grid_has_every_combination_and_the_last_field_changes_fastest() -> None:
    space = {E: [0.5, 0.7], M: ["200 g", 3], "simulation.integrator": ["auto", "exact"]}
    result = ensemble("drop", space, measure="ball.y", seconds=0.1, executor="serial")
    assert len(result) == 8 and not result.failures
    assert result.columns[E].tolist() == [0.5] * 4 + [0.7] * 4
    assert result.columns[M].tolist() == [0.2, 0.2, 3.0, 3.0] * 2
    assert result.columns["simulation.integrator"].tolist() == ["auto", "exact"] * 4


def test_twins_differ_from_the_first_by_the_jitter() -> None:
    task = task_of(
        "drop",
        {M: [1.0, 2.0]},
        measure="ball.y",
        seconds=1,
        replicas=3,
        jitter={"ball.Transform.position[1]": "1 nm"},
    )
    columns = task.space.columns(0, 6)
    assert columns["replica"].tolist() == [0, 1, 2, 0, 1, 2] and columns[M].tolist() == [1.0] * 3 + [2.0] * 3
    moved = columns["ball.Transform.position[1]"] - 4.0
    assert moved[[0, 3]].tolist() == [0.0, 0.0] and (np.abs(moved[[1, 2, 4, 5]]) < 1e-8).all()
    assert len({*moved.tolist()}) == 5


SWEPT = (
    ("drop", {E: [0.0, 0.5, 0.9], "ball.Velocity.linear[0]": [0.0, 1.0, -2.0]}),
    ("drop", {"ball.Transform.position.y": [0.25, 4.0], "physics.gravity.y": [-9.81, 0.0, -1.0]}),
    ("drop", {"physics.linear_damping": [0.0, 0.5], "physics.gravity.x": [0.0, 2.0]}),
    ("drop", {"simulation.substeps": [1, 3], "ball.Shape.radius": [0.1, "30 cm"]}),
    ("drop", {"ball.Mass.inertia": [0.1, 1.0], "simulation.contacts": ["soft", "rigid"]}),
)


@pytest.mark.parametrize(("scene", "space"), SWEPT)
def test_a_row_has_the_bits_of_a_scene_with_these_values(scene: str, space: dict[str, Any]) -> None:
    measure = {"y": "ball.y", "vx": "ball.linear.x", "n": "collisions", "error": "numerical"}
    result = ensemble(scene, space, measure=measure, seconds=1.1, executor="serial")
    assert not result.failures
    for row in range(len(result)):
        world = result.world(row)
        world.run(seconds=1.1)
        assert result.columns["y"][row] == height_at_end(world)
        assert result.columns["n"][row] == world.collisions


def _numbers(world: World) -> list[str]:
    """Return some fields of each moving body and spring that can be varied."""
    found = []
    for name, entity in entity_names(world).items():
        kinds = {type(part).__name__ for part in world.components(entity)}
        if {"Velocity", "Mass"} <= kinds and re.fullmatch(r"\w+", name):
            found += [f"{name}.Velocity.linear.x", f"{name}.Mass.mass"]
            found += [f"{name}.Material.restitution"] * ("Material" in kinds)
        found += [f"{name}.Spring.stiffness"] * ("Spring" in kinds and bool(re.fullmatch(r"\w+", name)))
    return found


@pytest.mark.slow
@pytest.mark.parametrize(
    "scene", ["newtons_cradle", "pendulum", "two_planets", "billiards", "spring_chain", "carts"]
)
def test_rows_of_other_scenes_have_the_bits_of_fresh_worlds(scene: str) -> None:
    world = load_scene(scene)
    for path in ["physics.gravity.x", "physics.linear_damping", *_numbers(world)[:6]]:
        task = task_of(scene, {path: [0.2, 0.9]}, measure="numerical", seconds=0.5)
        result = ensemble(scene, {path: [0.2, 0.9]}, measure="numerical", seconds=0.5, executor="serial")
        assert not result.failures, (path, result.failures)
        for row in range(2):
            fresh = task.world(row)
            fresh.run(seconds=0.5)
            from physicslab.diagnostics.quantities import Reading

            assert result.columns["numerical"][row] == Reading(fresh).value("error of energy"), path


def test_rows_of_several_islands_have_the_bits_of_fresh_worlds_and_keep_their_islands() -> None:
    world = World()
    box(world, (0, -0.5), width=200, height=1, static=True)
    for name, x in (("a", 0.0), ("b", 0.3), ("c", 30.0), ("d", 33.0)):
        box(world, (x, 1.5 if name == "b" else 0.5), width=1, height=1, mass=1, name=name)
    measures = {f"{name}.{axis}": f"{name}.{axis}" for name in "abcd" for axis in "xy"}
    space: dict[str, Any] = {
        "c.Velocity.linear.x": [0.0, 1.0, -40.0, 0.5],
        "b.Material.restitution": [0.0, 0.5],
    }
    laws = {"physics.gravity.y": [-9.0, 0.0], "physics.linear_damping": [0.0, 0.5, 0.0]}
    for row, found_y in enumerate(
        ensemble(world, laws, measure="b.y", seconds=0.5, executor="serial").columns["b.y"]
    ):
        other = task_of(world, laws, measure="b.y", seconds=0.5).world(row)
        other.run(seconds=0.5)
        assert found_y == other.component("b", Transform).position.y
    task = task_of(world, space, measure=measures, seconds=0.5)
    runner, parts = Runner(task), []
    for row in range(8):
        found = runner.block(row, row + 1)
        parts.append([island.world for island in runner._world.islands.members])
        fresh = task.world(row)
        fresh.run(seconds=0.5)
        ends = [fresh.component(name, Transform).position for name in "abcd"]
        assert found.values[0].tolist() == [number for end in ends for number in (end.x, end.y)], row
    assert len(parts[0]) == 2 and parts[0] == parts[1] == parts[2] == parts[3]
    assert parts[4] != parts[0], "what runs to the others is one island with them"


def test_measures_are_expressions_of_a_run_and_functions_of_its_end() -> None:
    measure: dict[str, Any] = {
        "end": "end.ball.y", "position": "ball.position.y", "greatest": "max(ball.y)",
        "least": "min(ball.vy)", "fastest": "max(ball.vy)", "first": "first_impact.time",
        "of two": "max(ball.y, 3 m)", "lost": "account.impacts", "number": "collisions",
        "function": height_at_end,
    }  # fmt: skip
    columns = ensemble("drop", {E: [0.7]}, measure=measure, seconds=1.5, executor="serial").columns
    found = {name: column[0] for name, column in columns.items()}
    assert found["end"] == found["position"] == found["function"] < 3.0 == found["of two"]
    assert found["greatest"] == 4.0 and found["number"] == 1.0
    assert found["first"] == pytest.approx(np.sqrt(2 * 3.75 / 9.81), rel=1e-12)
    assert found["least"] == pytest.approx(-np.sqrt(2 * 9.81 * 3.75), abs=9.81 / 60)
    assert found["fastest"] == pytest.approx(-0.7 * found["least"], abs=2 * 9.81 / 60), "an impact is no peak"
    assert found["lost"] == pytest.approx(-9.81 * 3.75 * (1 - 0.7**2) - 1 / 6, rel=1e-9), "it leaves rolling"


def test_ids_that_are_no_plain_words_are_written_as_they_are_or_in_quotes() -> None:
    world = World()
    for x, name in enumerate(("ball", "ball 2", "ball-3", "4", "a.b", "class", "salt and = pepper")):
        circle(world, (x, 5), radius=0.1, name=name)
    measure: dict[str, Any] = {
        "plain": "2 ball.x + ball 2.x", "quoted": '"ball 2".position.x', "dashed": "ball-3.x - ball.x",
        "number": "max(4.x)", "dotted": "a.b.x", "word": "class.x",
    }  # fmt: skip
    columns = ensemble(world, {"ball 2.Mass.mass": [2]}, measure=measure, steps=3, executor="serial").columns
    assert [columns[name][0] for name in measure] == [1.0, 1.0, 2.0, 3.0, 4.0, 5.0]
    for condition in ("ball 2.y < 4.9", 'ball 2.x > 0 and "salt and = pepper".y < 4.9 m'):
        found = world.copy().record(1.0, until=condition).found
        assert found == pytest.approx(np.sqrt(2 * 0.1 / 9.81), rel=1e-14)


def test_ids_that_have_a_meaning_of_their_own_are_measured_or_refused() -> None:
    world = World()
    for x, name in enumerate(("end", 'the "big" one', "max", "first_impacts", "world", "first_impact")):
        circle(world, (x, 5), radius=0.1, name=name)
    measure: dict[str, Any] = {
        "end": "end.x", "of the end": "end.end.x", "raw": 'the "big" one.x', "quoted": '"the ""big"" one".x',
        "function": "max(max.x)", "near": "first_impacts.x", "world": "collisions",
    }  # fmt: skip
    space = {"end.Mass.mass": [2]}
    columns = ensemble(world, space, measure=measure, steps=3, executor="serial").columns
    assert [columns[name][0] for name in measure] == [0.0, 0.0, 1.0, 1.0, 2.0, 3.0, 0.0]
    for name in ("world.x", "world.kinetic", "first_impact.x"):  # the one or the other could be meant
        own = name.partition(".")[0]
        with pytest.raises(SceneError, match=f"'{name}': an entity is called {own} as well; give it another"):
            ensemble(world, space, measure=name, steps=3, executor="serial")


@pytest.mark.notebook
def test_a_bar_shows_how_many_runs_are_made(capsys: pytest.CaptureFixture[str]) -> None:
    space = {E: ("uniform", 0.2, 0.9)}
    ensemble("drop", space, samples=30, measure="ball.y", seconds=0.1, executor="serial", progress=True)
    shown = capsys.readouterr().err
    assert "100%" in shown and "30/30" in shown


def test_a_bar_without_its_package_is_refused_before_anything_begins(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    with pytest.raises(ImportError, match=r"progress=True needs tqdm\.auto, which is not installed"):
        ensemble("drop", {E: [0.5]}, measure="ball.y", seconds=0.1, executor="serial", progress=True)
    shares: list[float] = []
    ensemble("drop", {E: [0.5]}, measure="ball.y", seconds=0.1, executor="serial", progress=shares.append)
    assert shares == [1.0]


@pytest.mark.parametrize("executor", ["serial", "threads"])
def test_a_run_ends_with_a_condition_as_a_record_does(executor: str) -> None:
    measure = {
        "t": "time",
        "x": "ball.x",
        "top": "max(ball.y)",
        "first": "first_impact.time",
        "n": "collisions",
    }
    until = "ball.vy > 0 and ball.x >= -1 m"
    columns = ensemble(
        "drop", {E: [0.5, 0.8]}, measure=measure, seconds=4, until=until, executor=executor
    ).columns
    for row, restitution in enumerate((0.5, 0.8)):
        world = load_scene("drop")
        world.component("ball", Material).restitution = restitution
        run = world.record(4.0, until=until)
        ends = run.found, run.columns["ball.x"][-1], 4.0, run.impacts["time"][0], world.collisions
        assert tuple(columns[name][row] for name in measure) == ends
    late = ensemble("drop", {E: [0.5, 0.8]}, measure="ball.x", seconds=0.5, until=until, executor=executor)
    assert np.isnan(late.columns["ball.x"]).all()
    assert set(late.failures.values()) == {f'until "{until}": does not begin to hold within 0.5 s'}


@pytest.mark.parametrize("scene", ["drop", "pendulum", "two_planets"])
def test_measures_of_the_whole_run_are_those_of_its_record(scene: str) -> None:
    world = load_scene(scene)
    body = next(name for name in world.record(0.0).bodies if name.isidentifier())
    measure = {"top": f"max({body}.y)", "at": f"at(0.7 s, {body}.vx)", "mean": f"mean({body}.x)"}
    columns = ensemble(
        scene, {f"{body}.Mass.mass": [1.5]}, measure=measure, seconds=1.33, executor="serial"
    ).columns
    world.reset()
    world.component(body, Mass).mass = 1.5
    run = world.record(1.33)
    times = run.times
    assert columns["top"][0] >= run.columns[f"{body}.y"].max()
    assert columns["at"][0] == pytest.approx(np.interp(0.7, times, run.columns[f"{body}.vx"]), abs=2e-2)
    world.reset()
    world.simulation = replace(world.simulation, dt=world.simulation.dt / 100.0)
    world.component(body, Mass).mass = 1.5
    fine = world.record(1.33)
    mean = np.trapezoid(fine.columns[f"{body}.x"], fine.times) / fine.times[-1]
    assert columns["mean"][0] == pytest.approx(mean, rel=1e-7)


def test_what_has_no_value_is_nan_and_a_run_that_cannot_be_is_kept_with_its_reason() -> None:
    space = {M: ("normal", 1.0, 1.0)}
    measure = {"when": "when(ball.y > 100 m)", "first": "first_impact.time", "y": "ball.y"}
    result = ensemble("drop", space, samples=12, seed=1, measure=measure, seconds=0.1, executor="serial")
    mass = result.columns[M]
    assert 0 < (mass < 0).sum() < 12
    for row, why in result.failures.items():
        refused = f'entity "ball": Mass.mass = {float(mass[row])!r}: must be a finite number > 0 kg'
        assert (refused if mass[row] < 0 else "that does not happen 1 times within the run") in why
    assert np.array_equal(np.isnan(result.columns["y"]), mass < 0)
    assert np.isnan(result.columns["first"]).all(), "the ball is in the air still"


@pytest.mark.parametrize("ending", ["npz", "csv"])
def test_rows_that_were_made_before_a_crash_are_not_made_again(
    ending: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sink, "PART", 20)
    arguments: dict[str, Any] = dict(samples=70, measure={"y": "ball.y"}, steps=2, executor="serial")
    whole = ensemble("drop", DRAWN, **arguments)
    out = tmp_path / f"sweep.{ending}"

    def crash(share: float) -> None:
        if share > 0.5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as interrupted:
        ensemble("drop", DRAWN, out=out, progress=crash, **arguments)
    (note,) = interrupted.value.__notes__
    assert re.fullmatch(r"after \d+ of 70 runs; the same call goes on there", note)
    parts = sorted((tmp_path / f"sweep.{ending}.parts").iterdir())
    assert not out.exists() and len(parts) >= 1
    shares: list[float] = []
    result = ensemble("drop", DRAWN, out=out, progress=shares.append, **arguments)
    assert shares[0] > 0.5 and bits(result.columns) == bits(whole.columns)
    assert not (tmp_path / f"sweep.{ending}.parts").exists()
    if ending == "npz":
        with np.load(out) as kept:
            assert kept["y"].tobytes() == whole.columns["y"].tobytes() and not kept["failure"].any()
    else:
        rows = list(csv.DictReader(out.read_text().splitlines()))
        assert [float(row["y"]) for row in rows] == whole.columns["y"].tolist()


@pytest.mark.parametrize("ending", ["npz", "csv", pytest.param("parquet", marks=pytest.mark.cluster)])
def test_a_finished_file_is_read_in_place_of_another_run(
    ending: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / f"sweep.{ending}"
    space = {M: ("normal", 1.0, 1.0), "simulation.integrator": ["auto", "exact"]}
    arguments: dict[str, Any] = dict(samples=9, seed=1, steps=2, executor="serial", out=out)
    made = ensemble("drop", space, measure={"y": "ball.y", "when": "first_impact.time"}, **arguments)
    content = out.read_bytes()
    assert made.found == 0 and made.failures and np.isnan(made.columns["when"]).all()
    with monkeypatch.context() as forbid:
        forbid.setattr(sink.Sink, "put", None)
        again = ensemble("drop", space, measure={"y": "ball.y", "when": "first_impact.time"}, **arguments)
    assert again.found == len(again) == 18 and again.failures == made.failures
    assert {*again.columns} == {*made.columns} and out.read_bytes() == content
    for name, column in made.columns.items():
        assert [*map(repr, again.columns[name].tolist())] == [*map(repr, column.tolist())]
    other = ensemble("drop", space, measure={"y": "ball.x", "when": "first_impact.time"}, **arguments)
    assert other.found == 0 and np.nanmax(other.columns["y"]) < 0.0, "another measure of the same name"
    out.write_bytes(out.read_bytes() + b"\n")
    edited = ensemble("drop", space, measure={"y": "ball.x", "when": "first_impact.time"}, **arguments)
    assert edited.found == 0, "the file is not as it was written"


def test_two_sweeps_to_one_file_do_not_lose_rows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The one that ended first removed the parts of both: the other wrote a file of NaN, and said nothing."""
    monkeypatch.setattr(sink, "PART", 2)
    arguments: dict[str, Any] = dict(steps=1, executor="serial", out=tmp_path / "a.npz")
    space = {M: [1.0, 2.0, 3.0]}
    others: list[str] = []

    def other(share: float) -> None:
        with pytest.raises(OSError, match=r"a\.npz: another sweep to this file is under way$") as refused:
            ensemble("drop", space, measure="ball.x", **arguments)
        others.append(str(refused.value))

    made = ensemble("drop", space, measure="ball.y", progress=other, **arguments)
    assert others and np.isfinite(made.columns["ball.y"]).all()
    assert {path.name for path in tmp_path.iterdir()} == {"a.npz", "a.npz.key"}

    def lose(share: float) -> None:
        shutil.rmtree(tmp_path / "a.npz.parts")

    with pytest.raises(OSError, match=r"2 rows that were kept in .* are gone; the same sweep once"):
        ensemble("drop", space, measure="ball.x", progress=lose, **arguments)


def test_strange_files_in_the_folder_of_parts_are_kept(tmp_path: Path) -> None:
    folder = tmp_path / "a.npz.parts"
    (folder / "mine").mkdir(parents=True)
    strange = {"notes.txt", "part-000000.npz.bak", ".part-000000.npz.tmp", "part-1.npz"}
    for name in strange:
        (folder / name).touch()
    (folder / f".part-000000.npz.{'0a' * 8}.physicslab-tmp").touch()
    ensemble("drop", {M: [1.0]}, measure="ball.y", steps=1, executor="serial", out=tmp_path / "a.npz")
    assert {path.name for path in folder.iterdir()} == {*strange, "mine"}, "ours are gone, theirs are not"


def test_a_part_that_a_crash_has_torn_is_made_again(tmp_path: Path) -> None:
    part = tmp_path / "a.npz.parts" / "part-000000.npz"
    part.parent.mkdir()
    part.write_bytes(b"PK\3\4 the rest was not written")
    made = ensemble("drop", {M: [1.0]}, measure="ball.y", steps=1, executor="serial", out=tmp_path / "a.npz")
    assert made.found == 0 and not part.parent.exists()


def test_a_full_disk_is_said_with_the_name_of_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(sink, "replace_file", full)
    out = str(tmp_path / "a.npz")
    command = ["sweep", "drop", "--vary", f"{M}=1:2:2", "--measure", "ball.y", "--seconds", ".1"]
    assert main([*command, "--workers", "1", "--out", out]) == 1
    line = f"physicslab: drop: out {out}: cannot be written: No space left on device\n"
    assert capsys.readouterr().err.endswith(line)


def test_fields_of_whole_numbers_are_varied(tmp_path: Path) -> None:
    out = tmp_path / "a.npz"
    command = ["sweep", "drop", "--measure", "ball.y", "--seconds", ".1", "--workers", "1"]
    assert main([*command, "--vary", "simulation.substeps=1:4:4", "--out", str(out)]) == 0
    with np.load(out) as kept:
        assert kept["simulation.substeps"].tolist() == [1, 2, 3, 4] and not kept["failure"].any()
    assert main([*command, "--vary", "simulation.substeps=1:4:3"]) == 2


def test_a_sweep_of_which_every_run_failed_has_failed(capsys: pytest.CaptureFixture[str]) -> None:
    command = ["sweep", "drop", "--measure", "time", "--seconds", ".1", "--workers", "1"]
    assert main([*command, "--vary", f"{M}=1:2:2", "--until", "ball.y > 99"]) == 1
    out, err = capsys.readouterr()
    assert "2 of them with a failure" in out and err == "physicslab: drop: every run failed\n"
    assert main([*command, "--vary", f"{M}=1:2:2", "--measure", "last_impact.x"]) == 0
    assert "\n  last_impact.x: no run gave it a value\n" in capsys.readouterr().out


def test_parts_of_another_sweep_are_not_taken(tmp_path: Path) -> None:
    arguments: dict[str, Any] = dict(samples=50, steps=2, executor="serial", out=tmp_path / "a.npz")

    def crash(share: float) -> None:
        if share == 1.0:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ensemble("drop", DRAWN, measure="ball.y", progress=crash, **arguments)
    shares: list[float] = []
    found = ensemble("drop", DRAWN, measure="ball.x", progress=shares.append, **arguments)
    assert shares[0] < 1.0 and found.columns["ball.x"].max() < 0.0, "it begins at -3 m"


@pytest.mark.slow
def test_serial_threads_and_processes_have_the_same_bits() -> None:
    arguments: dict[str, Any] = dict(
        samples=np.int64(300), measure={"y": "ball.y", "f": height_at_end}, seconds=1.0
    )
    serial = ensemble("drop", DRAWN, executor="serial", **arguments)
    for kind in ("threads", "processes"):
        other = ensemble("drop", DRAWN, executor=kind, workers=2, **arguments)
        assert bits(other.columns) == bits(serial.columns)


@pytest.mark.peers
def test_sobol_points_are_those_of_scipy() -> None:
    from scipy.stats import qmc

    points = qmc.Sobol(DIMENSIONS, scramble=False, bits=32).random_base2(8)
    ours = np.stack([sobol(np.arange(256), dimension) for dimension in range(DIMENSIONS)], axis=1) / 2.0**32
    assert np.array_equal(points, ours)


REFUSED: tuple[tuple[Any, dict[str, Any], str], ...] = (
    ({"bal.Mass.mass": [1]}, {}, 'there is no such entity; must be one of floor, ball; did you mean "ball"?'),
    ({"ball.Mass.mas": [1]}, {}, "Mass.mas: unknown field"),
    ({"mass": [1]}, {}, 'space "mass": must be ID.Component.field'),
    ([M], {}, "must be a dict of fields and their values"),
    ({M: ("unifrom", 1, 2)}, {"samples": 3}, "a law must be one of uniform, normal, sobol, rows"),
    ({M: [1]}, {"workers": 0}, "workers = 0: must be a whole number >= 1"),
    ({M: [1]}, {"workers": 10**9}, "workers = 1000000000: must be a whole number >= 1, at most 1,000"),
    ({M: ("uniform", 1, 2)}, {"samples": 10**30}, "must be a whole number >= 1, at most 1,000,000,000"),
    ({M: [1]}, {"replicas": 10**30, "jitter": 1e-9}, "must be a whole number >= 1, at most 1,000,000,000"),
    ({M: [10**400]}, {}, "int too large to convert to float; must be a finite number > 0 kg"),
    ({3: [1]}, {}, "space: 3: must be ID.Component.field"),
    ({M: [1]}, {"measure": {"": "ball.y"}}, "must be an expression, a function of the world, or a dict"),
    ({M: [1]}, {"workers": "2"}, 'workers = "2": must be a whole number >= 1'),
    ({M: [1]}, {"measure": None}, "measure null: must be an expression, a function of the world, or a dict"),
    ({M: [1]}, {"measure": ["ball.y"]}, "must be an expression, a function of the world, or a dict"),
    ({"ball.Mass.mass": [-1.0]}, {}, "Mass.mass = -1.0: must be a finite number > 0 kg"),
    ({"ball.Mass.mass": ["2 m"]}, {}, "'2 m' is in m; this is in kg"),
    ({"ball.Mass.mass": []}, {}, "must be at least one value"),
    ({"ball.Velocity.linear": [1]}, {}, "must be a part of it, .x or .y"),
    ({"ball.Velocity.linear.z": [1]}, {}, "Velocity.linear.z: must be linear.x or linear.y"),
    ({"physics.gravity.q": [1]}, {}, "physics.gravity.q: must be gravity.x or gravity.y"),
    ({"ball.Velocity.linear[2]": [1]}, {}, "Velocity.linear.2: must be linear.x or linear.y"),
    ({"ball.Mass.mass": ("uniform", 2, 1)}, {"samples": 3}, "must have two numbers a < b"),
    ({"ball.Mass.mass": ("uniform", 1, 2)}, {}, "samples: must be given"),
    ({"ball.Mass.mass": [1, 2]}, {"samples": 3}, "samples: no field is drawn at random"),
    ({"simulation.substeps": ("uniform", 1, 2)}, {"samples": 3}, "takes a list of values"),
    ({M: [1, 2]}, {"replicas": 2}, "replicas: must have a jitter"),
    ({M: [1, 2]}, {"jitter": 1e-9}, "jitter: needs replicas"),
    ({M: ("rows", [1, 2]), E: ("rows", [0.1])}, {}, "must all have as many values"),
    ({"ball.Velocity.linear.x": [1], "ball.Velocity.linear[0]": [1]}, {}, "is given twice"),
    ({M: [1]}, {"measure": "ball.q"}, "measure \"ball.q\": 'ball.q' is no quantity"),
    ({M: [1]}, {"measure": "ball.x +"}, "is no number"),
    ({M: [1]}, {"measure": "max(ball.x"}, "'max(ball.x' is no number: a \")\" is missing"),
    ({M: [1]}, {"measure": "ball.x)"}, "'ball.x)' is no number: a \"(\" is missing"),
    ({M: [1]}, {"measure": "ball.x + ball.vx"}, "m and m/s cannot be added"),
    ({M: [1]}, {"measure": "__import__(ball.x)"}, "'__import__' is no function"),
    ({M: [1]}, {"measure": "at(1 kg, ball.x)"}, "the time is in kg; must be in s"),
    ({M: [1]}, {"measure": "1/0"}, "measure \"1/0\": '1/0' is not finite"),
    ({M: [1]}, {"measure": "ball.x/(2 - 2)"}, "is not finite"),
    ({M: [1]}, {"measure": "max(ball.x + sqrt(-1))"}, "is no number"),
    ({M: [1]}, {"measure": "bal.y"}, 'must begin with one of floor, ball, world; did you mean "ball"?'),
    ({M: [1]}, {"measure": "'ball'.y"}, "is no number"),
    ({M: [1]}, {"measure": "ball.y.real()"}, "is no function"),
    ({M: [1]}, {"measure": "f(1).y()"}, "'f(1).y()' is no number"),
    ({M: [1]}, {"measure": '"ball.y'}, "is no number"),
    ({M: [1]}, {"measure": "first_impact.q"}, "an impact has time, x, y, speed, energy_lost"),
    ({M: [1]}, {"measure": {"f": lambda world: 1.0}}, "a function of a module"),
    ({M: [1]}, {"measure": {M: "ball.x"}}, "is the name of another column"),
    ({M: [1]}, {"until": "ball.x"}, "until \"ball.x\": must be a condition, as 'ball.x >= 8 m' is one"),
    ({M: [1]}, {"until": "bal.x > 1"}, "'bal.x' is no quantity"),
    (
        {M: [1]},
        {"until": "ball.x > 1", "measure": "max(world.kinetic)"},
        "with until, what looks at the whole",
    ),
    ({M: [1]}, {"out": "there/is/none.csv"}, "cannot be written"),
    ({M: [1]}, {"out": "x.txt"}, "must end in .npz, .csv, .parquet"),
    ({M: [1]}, {"measure": {3: "ball.y"}}, "a dict of them by their names"),
    ({M: [True]}, {}, "Mass.mass = true: must be a finite number > 0 kg"),
    ({M: np.array([True])}, {}, "Mass.mass = "),
    ({M: [b"1"]}, {}, "must be a finite number > 0 kg"),
    ({M: ("uniform", False, b"1")}, {}, "Mass.mass = false: must be a finite number > 0 kg"),
    ({M: ("normal", 2, True)}, {"samples": 3}, "Mass.mass = true: must be a finite number > 0 kg"),
    ({M: [1]}, {"replicas": 2, "jitter": {M: b"1"}}, "must be a finite number > 0 kg"),
    ({M: [1]}, {"executor": 3}, "executor 3: must be one of processes, threads, serial, or an Executor"),
    ({M: ("uniform", 1, 2)}, {"samples": np.int64(0)}, "must be a whole number >= 1"),
    ({M: [1]}, {"executor": "process"}, "must be one of processes, threads, serial, or an Executor"),
)


@pytest.mark.parametrize(("space", "more", "line"), REFUSED, ids=[ascii(n) for n in range(len(REFUSED))])
def test_what_cannot_be_is_refused_by_name_before_anything_begins(
    space: Any, more: dict[str, Any], line: str
) -> None:
    arguments = {"measure": "ball.y", "seconds": 1.0, "executor": "serial", **more}
    with pytest.raises(SceneError) as refused:
        ensemble("drop", space, **arguments)
    assert line in str(refused.value) and "\n" not in str(refused.value)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_where_no_file_or_parts_can_be_is_refused_before_a_row_is_made(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.npz")
    (tmp_path / "file.npz.parts").touch()
    for name, why in (
        ("pipe.npz", "must be a plain file"),
        ("file.npz", "cannot be written: there is no directory"),
    ):
        with pytest.raises(SceneError, match=why):
            ensemble("drop", {M: [1]}, measure=_never, steps=1, executor="serial", out=tmp_path / name)


def _never(world: Any) -> float:
    raise AssertionError("a row was made")
