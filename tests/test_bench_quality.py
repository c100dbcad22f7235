"""What the benchmark measures beside times, its targets, and the engine that it compiles."""

import dataclasses
import math
import os
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from desk import bits

from physicslab import cli
from physicslab.components import Spring, Transform, Velocity
from physicslab.ecs.config import PhysicsConfig
from physicslab.ecs.vector import Vector2
from physicslab.lab.bench import whole_runs
from physicslab.lab.bench.catalogue import SCENES, gas_scene, pile_scene
from physicslab.lab.bench.engine import Engine
from physicslab.lab.bench.measure import Judge, measure_scene
from physicslab.lab.bench.moving import _in_funnel, funnel
from physicslab.lab.bench.random_scenes import random_scene
from physicslab.lab.bench.result import EngineResult, SceneResult, Spread
from physicslab.lab.bench.scene import BenchScene, at_rest, largest_overlap, lost, within
from physicslab.lab.bench.targets import checks
from physicslab.lab.bench.whole_runs import WholeReport, alike_jobs, measure_whole, whole_text
from physicslab.lab.jobs import result_of
from physicslab.lab.peers.box2d3_built import BuildError, built_box2d
from physicslab.lab.peers.mirrors import PymunkMirror
from physicslab.lab.worlds import open_space, place
from physicslab.prefabs import box, circle

SMALL = BenchScene(
    name="small", title="a funnel of 30", group="moving", size=30, build=partial(funnel, 30),
    seconds=0.5, steps=24,
    quality=(largest_overlap(0.06), *at_rest(1.0, 1.0), lost(within(100.0, floor=-2.0))),
)  # fmt: skip


def judged(scene: BenchScene) -> tuple[Judge, Engine, dict[str, float | None]]:
    result = SceneResult(scene)
    result.engines["PhysicsLab"] = EngineResult("PhysicsLab")
    return Judge(result), Engine(scene.build()), result.ours.quality


def test_looking_at_an_engine_changes_no_bit_of_it() -> None:
    judge, engine, found = judged(SMALL)
    alone = SMALL.build()
    judge.begin([engine])
    for _ in range(90):
        engine.step()
        judge.look([engine], "throughout")
        judge.look([engine], "end")
    for _ in range(90):
        alone.step()
    assert bits(engine.world) == bits(alone)
    assert set(found) == {quality.name for quality in SMALL.quality}


def test_the_largest_overlap_of_all_looks_is_kept() -> None:
    judge, engine, found = judged(SMALL)
    judge.begin([engine])
    place = engine.world.table(Transform)["position"]
    rows = engine.world.batch(Transform, Velocity).rows
    judge.look([engine], "throughout")
    assert found["largest overlap"] == 0.0
    apart = place[rows[0]].copy()
    place[rows[0]] = place[rows[1]]
    judge.look([engine], "throughout")
    deepest = found["largest overlap"]
    assert deepest is not None and deepest > 0.1
    place[rows[0]] = apart
    judge.look([engine], "throughout")
    assert found["largest overlap"] == deepest


def test_drift_and_lost_bodies_are_counted_since_the_timing_began() -> None:
    judge, engine, found = judged(SMALL)
    world = engine.world
    rows = world.batch(Transform, Velocity).rows
    judge.begin([engine])
    world.table(Transform)["position"][rows] += 5.0  # before the timing
    judge.begin([engine])
    world.table(Transform)["position"][rows, 0] += 0.25
    world.table(Velocity)["linear"][rows[0]] = (3.0, 4.0)
    judge.look([engine], "end")
    assert found["drift at rest"] == pytest.approx(0.25)
    assert found["lost bodies"] == 0.0
    mass = 1.0 / world.bodies.inverse_mass[rows[0]]
    assert found["kinetic energy at rest"] == pytest.approx(12.5 * mass)
    world.table(Transform)["position"][rows[:3]] = ((0.0, -2.5), (101.0, 0.0), (-101.0, 3.0))
    judge.look([engine], "end")
    assert found["lost bodies"] == 3.0


@pytest.mark.parametrize(
    "name", ["funnel", "funnel_open", "tumbler", "heap", "chains", "pile_1000", "gas_1000"]
)
def test_bodies_beyond_the_walls_of_a_scene_are_lost(name: str) -> None:
    scene = SCENES[name]
    (quality,) = (quality for quality in scene.quality if quality.name == "lost bodies")
    world = scene.build()
    world.synchronise()
    judge, engine, found = judged(scene)
    judge.begin([engine])
    judge.look([engine], "end")
    assert found["lost bodies"] == 0.0, "at the start all are inside"
    rows = engine.world.batch(Transform, Velocity).rows
    engine.world.table(Transform)["position"][rows[:2]] = ((1e3, 1.0), (-20.0, 0.5))
    expected = {"funnel": 2, "funnel_open": 2, "chains": 1}.get(name, 2)
    judge.look([engine], "end")
    assert found["lost bodies"] == expected and expected > quality.limit


def timed(name: str, ours_ms: float, others_ms: dict[str, float]) -> SceneResult:
    """Return the results of a scene whose steps all take the same in an engine."""
    result = SceneResult(dataclasses.replace(SCENES[name], quality=()))
    for engine, ms in {"PhysicsLab": ours_ms, **others_ms}.items():
        spread, ratio = Spread.of(np.full(10, ms)), ms / ours_ms
        result.engines[engine] = EngineResult(
            engine, spread, first_seconds_ms=spread, times_ours=ratio, times_ours_first_seconds=ratio
        )
    return result


def test_scenes_of_many_bodies_are_held_against_pymunk_and_box2d_in_c() -> None:
    found = checks([timed("funnel", 2.0, {"pymunk": 3.2, "Box2D 3 C AVX2": 1.5, "Box2D 3": 9.0})], [], [])
    figures = {check.what: check.figure for check in found}
    assert len(figures) == 6
    for when in ("first 2 s", "then"):
        assert figures[f"{when}: pymunk / PhysicsLab"] == pytest.approx(1.6)
        assert figures[f"{when}: PhysicsLab / Box2D 3 C AVX2"] == pytest.approx(4.0 / 3.0)
        assert figures[f"{when}: p99 / median"] == 1.0
    assert [check.what for check in found if not check.met] == [
        "first 2 s: PhysicsLab / Box2D 3 C AVX2", "then: PhysicsLab / Box2D 3 C AVX2",
    ]  # fmt: skip


def test_single_steps_of_ten_discs_have_a_limit_in_microseconds() -> None:
    for name in ("circles_10_stepped", "circles_10_window"):
        (slow,), (fast,) = (checks([timed(name, ms, {})], [], []) for ms in (0.0201, 0.0199))
        assert (slow.met, fast.met) == (False, True)
    (run,) = checks([timed("circles_10", 0.01, {"pymunk": 0.008})], [], [])
    assert run.figure == pytest.approx(1.25) and not run.met


def test_what_a_peer_failed_in_is_no_ratio() -> None:
    scene = dataclasses.replace(gas_scene(10), seconds=0.1, steps=3)
    result = result_of(measure_scene(scene))
    assert (result.ours.times_ours_first_seconds, result.ours.times_ours) == (1.0, 1.0)
    assert checks([result], [], []) == []


@pytest.mark.parametrize(
    ("files", "compiler", "reason"),
    [
        ({}, "cc", "no checkout of Box2D 3"),
        ({"include/box2d/box2d.h": ""}, "no-such-compiler", "no compiler: no-such-compiler"),
        ({"include/box2d/box2d.h": "#error too old"}, "cc", "too old"),
    ],
)
def test_sources_that_cannot_be_compiled_are_refused_in_one_line(
    files: dict[str, str], compiler: str, reason: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    for name, text in files.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True)
        path.write_text(text)
    monkeypatch.setenv("CC", compiler)
    with pytest.raises(BuildError):
        built_box2d(tmp_path, tmp_path)
    assert cli.main(["bench", "circles_10", "--box2d", str(tmp_path)]) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.startswith("physicslab: --box2d: ") and err.count("\n") == 1
    assert reason in err or (compiler == "cc" and "no compiler" in err)


@pytest.fixture(scope="module")
def box2d(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Box2D 3 in C, from the sources that the environment's ``BOX2D_SOURCES`` names."""
    sources = os.environ.get("BOX2D_SOURCES")
    if not sources:
        pytest.skip("BOX2D_SOURCES names no checkout of Box2D 3")
    return built_box2d(Path(sources), tmp_path_factory.mktemp("box2d"))


@pytest.mark.peers
def test_box2d_in_c_has_what_the_world_has(box2d: Any) -> None:
    world = open_space()
    body = box(
        world,
        (1, 2),
        width=1,
        height=0.5,
        angle=0.3,
        velocity=(1, 2),
        angular_velocity=3,
        mass=7,
        friction=0.6,
    )
    still = box(world, (-5, 0), width=2, height=1, static=True)
    mirror = box2d(world)
    assert mirror.state(body) == pytest.approx((1, 2, 1, 2, 0.3, 3), abs=1e-6)
    assert mirror.state(still)[:2] == pytest.approx((-5, 0))
    mirror.run(1.0 / 600.0, 60)
    mirror.write_back()
    assert place(world, body).x == pytest.approx(1.1, abs=1e-4)
    assert place(world, body).y == pytest.approx(2.2 - 0.5 * 9.81 * 0.01, abs=1e-3)
    speed = mirror.state(body)[3]
    mirror.set_gravity(Vector2(0.0, 6.0))
    mirror.step(0.1)
    assert mirror.state(body)[3] - speed == pytest.approx(0.6, abs=1e-5)


@pytest.mark.peers
def test_box2d_in_c_is_timed_beside_others(box2d: Any) -> None:
    scene = dataclasses.replace(pile_scene(20), seconds=2.0, steps=12)
    other = result_of(measure_scene(scene, (box2d,))).engines[box2d.title]
    assert other.step_ms is not None and other.times_ours is not None and not other.failure
    assert other.quality["deepest overlap"] == pytest.approx(0.0, abs=0.02)
    assert other.quality["lost bodies"] == 0.0


def _judged(overlap: float | None, failure: str = "") -> EngineResult:
    return EngineResult("", quality={"largest overlap": overlap}, failure=failure)


@pytest.mark.parametrize(
    ("other", "ours", "alike"),
    [
        (_judged(0.02), 0.02, True), (_judged(0.021), 0.02, False), (_judged(0.009), 0.001, True),
        (_judged(0.011), 0.001, False), (_judged(None), 0.02, False), (_judged(0.0, "NaN"), 0.02, False),
    ],
)  # fmt: skip
def test_a_peer_is_alike_if_no_figure_is_worse(other: EngineResult, ours: float, alike: bool) -> None:
    assert whole_runs._is_alike(other, _judged(ours)) is alike


@pytest.mark.peers
def test_a_peer_that_overlaps_deeper_is_run_in_shorter_steps_until_it_does_not() -> None:
    found = result_of(measure_whole(*random_scene(62, 10), (PymunkMirror,)))
    ours, other = found.result.ours, found.result.engines["pymunk"]
    assert not whole_runs._is_alike(other, ours) and other.times_ours is not None
    assert other.alike is not None and other.alike.is_reached and other.alike.finer > 1
    assert other.alike.times_ours > other.times_ours
    report = WholeReport("62:10", ["pymunk"], [found])
    assert f"steps of 1/{other.alike.finer} of the usual" in whole_text(report)
    (engine,) = [engine for engine in report.document["scenes"][0]["engines"] if engine["name"] == "pymunk"]
    assert engine["alike"] == dataclasses.asdict(other.alike)


@pytest.mark.peers
def test_scenes_of_the_benchmark_are_run_at_like_quality_to_their_end() -> None:
    scene = dataclasses.replace(pile_scene(20), seconds=0.5, steps=10)
    ((_, job),) = alike_jobs([scene], (PymunkMirror,))
    found = result_of(job)
    other = found.result.engines["pymunk"]
    assert other.alike is not None and set(other.quality) == {"largest overlap", "joint off"}
    assert found.features == [] and f"(1/{other.alike.finer})" in whole_text(
        WholeReport("", ["pymunk"], [found])
    )


@pytest.mark.peers
def test_springs_and_bounds_are_there_in_c(box2d: Any) -> None:
    laws = PhysicsConfig(gravity_mode="none", bounds=(-2.0, -2.0, 2.0, 2.0), bounds_restitution=1.0)
    world = open_space(physics=laws)
    ball = circle(world, (1, 0), radius=0.1, mass=2.0)
    world.add(ball, Spring(None, None, anchor_b=(0.0, 0.0), rest_length=0.5, stiffness=8.0))
    quick = circle(world, (-1, 1.5), radius=0.1, velocity=(0, 30), restitution=1.0)
    mirror = box2d(world)
    half = round(math.pi / 2.0 * 600)  # half a period of omega = 2
    mirror.run(1.0 / 600.0, half)
    assert mirror.state(ball)[0] == pytest.approx(0.0, abs=0.05), "on the other side of the rest length"
    assert abs(mirror.state(quick)[1]) < 2.0 and abs(mirror.state(quick)[3]) > 10.0, "it goes to and fro"


def test_the_command_line_takes_sources_without_peers(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    used: list[tuple[Path, Path]] = []

    def built(sources: Path, folder: Path) -> type:
        used.append((sources, folder))
        raise BuildError("as far as this goes")

    monkeypatch.setattr("physicslab.commands.bench.built_box2d", built)
    assert cli.main(["bench", "circles_10", "--box2d", str(tmp_path)]) == 2
    assert used[0][0] == tmp_path and not used[0][1].exists()


def test_what_fell_out_of_an_open_funnel_may_be_anywhere_below() -> None:
    places = np.array(((300.0, -900.0), (0.0, 5.0), (6.0, 0.5), (31.0, -5.0), (0.0, -13.0)))
    inside = partial(_in_funnel, places, count=3_000)
    assert inside(floored=False).tolist() == [True, True, False, True, True]
    assert inside(floored=True).tolist() == [False, True, False, False, False]
