"""What the labs have in common: catalogues, jobs, tables and documents; and scenes in which bodies move."""

import dataclasses
import json
import math
from collections.abc import Callable
from functools import partial

import numpy as np
import pytest

from physicslab import cli
from physicslab.components import Mass, Name, Transform, Velocity
from physicslab.desktop.timed_window import InWindow
from physicslab.lab.accuracy.catalogue import PROBLEMS
from physicslab.lab.bench.catalogue import SCENES, by_default, discs
from physicslab.lab.bench.engine import Engine, prepared
from physicslab.lab.bench.measure import measure_scene
from physicslab.lab.bench.moving import FUNNELS, MOVING, chains, funnel, heap, tumbler
from physicslab.lab.bench.scene import BenchScene
from physicslab.lab.case import Case, Catalogue, attempt
from physicslab.lab.jobs import Job, result_of, run_jobs
from physicslab.lab.peers.peer import find_contacts
from physicslab.lab.report import Columns, lab_document, machine, table
from physicslab.lab.stability.catalogue import CASES
from physicslab.state.masses import Diverged
from physicslab.world import World


def test_jobs_run_one_after_the_other_and_count_by_their_weight() -> None:
    events: list[str] = []

    def job(name: str) -> Job[str]:
        events.append(f"begin {name}")
        yield 0.5
        events.append(f"end {name}")
        return name

    found = list(run_jobs([(1.0, job("small")), (3.0, job("large"))]))
    assert found == [0.0, 0.125, "small", 0.25, 0.625, "large"]
    assert events == ["begin small", "end small", "begin large", "end large"]


def test_a_family_is_preferred_to_a_case_of_its_name() -> None:
    cases = Catalogue([Case(name=name, title="", group=group) for name, group in (("a", "a"), ("b", "a"))])
    assert [case.name for case in cases.select("a")] == ["a", "b"]
    assert [case.name for case in cases.select("b")] == ["b"]
    assert cases.names == ["a", "b"]


@pytest.mark.parametrize("error", [Diverged("at t = 1"), OverflowError("too large"), ZeroDivisionError("0")])
def test_a_measurement_that_cannot_be_computed_has_a_reason(error: Exception) -> None:
    def measure() -> float:
        raise error

    assert attempt(measure) == (None, str(error))
    assert attempt(lambda: math.nan) == (None, "the figure is not finite")


def test_an_arithmetic_error_ends_its_case_and_not_the_command(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    broken = dataclasses.replace(CASES["damper_1e6"], name="broken", measure=lambda: 1.0 / 0.0)
    monkeypatch.setitem(CASES, "broken", broken)
    assert cli.main(["stability", "broken", "damper_1e6", "--json", "-"]) == 1
    out, err = capsys.readouterr()
    assert err == "physicslab: 1 of 2 cases fall short: broken\n"
    assert [case["failure"] for case in json.loads(out)["cases"]] == ["float division by zero", ""]


def test_columns_are_aligned_before_and_after_their_rows_are_known() -> None:
    rows = [("name", "figure"), ("long name", "1"), ("x", "")]
    assert table(rows, indent=" ") == " name       figure\n long name       1\n x"
    assert "\n".join(Columns((9, 6)).line(row) for row in rows) == table(rows)


def test_every_document_names_its_format_and_the_machine() -> None:
    document = lab_document("x", figures=[1.0])
    assert document == {"format": "physicslab-x/1", "machine": machine(), "figures": [1.0]}


@pytest.mark.parametrize(
    ("command", "names"), [("stability", list(CASES)), ("bench", list(SCENES)), ("accuracy", list(PROBLEMS))]
)
def test_names_are_listed_and_nothing_is_run(
    command: str, names: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main([command, "--list"]) == 0
    listed = [line.split()[0] for line in capsys.readouterr().out.splitlines()]
    assert set(names) <= set(listed)
    assert cli.main([command, "--help"]) == 0
    shown = capsys.readouterr().out
    assert "--list" in shown and len(shown.splitlines()) < 35


def test_scenes_that_move_are_run_where_none_is_named() -> None:
    moving = {scene.name for scene in MOVING}
    assert moving == {"funnel", "funnel_open", "heap", "chains", "tumbler"}
    assert moving <= {scene.name for scene in by_default()}
    assert moving == {scene.name for scene in SCENES.select("moving")}


@pytest.mark.parametrize("scene", [*MOVING, FUNNELS[0]], ids=lambda scene: scene.name)
def test_scenes_that_move_are_the_same_each_time(scene: BenchScene) -> None:
    worlds = scene.build(), scene.build()
    one, two = (world.table(Transform)["position"] for world in worlds)
    assert np.array_equal(one, two)
    find_contacts(worlds[0])
    assert np.count_nonzero(worlds[0].bodies.inverse_mass) == scene.size
    assert worlds[0].contacts.max_penetration <= 0.0, "nothing overlaps at the start"


def test_every_scene_states_its_contacts() -> None:
    smallest = {scene.group: scene for scene in reversed(SCENES.values()) if scene.group != "moving"}
    worlds = {name: scene.build() for name, scene in smallest.items()}
    worlds |= {"heap": heap(20), "chains": chains(2), "tumbler": tumbler(20), "funnel": funnel(20)}
    assert {"pyramids", "piles", "gases", "ten_discs", "funnels", "edits"} <= set(worlds)
    for name, world in worlds.items():
        assert (world.simulation.contacts, world.simulation.collisions) == ("soft", "step"), name
    file = SCENES["circles_10_auto"].build().simulation
    assert (file.contacts, file.collisions, file.sleeping) == ("auto", "auto", "auto")


def small_of_each_kind() -> list[BenchScene]:
    """Return scenes of every kind that moves or is edited, of few bodies."""
    builds: dict[str, Callable[[], World]] = {
        "funnel": partial(funnel, 40), "funnel_open": partial(funnel, 40, floored=False),
        "heap": partial(heap, 40), "chains": partial(chains, 2, 3), "tumbler": partial(tumbler, 40),
    }  # fmt: skip
    builds |= {scene.name: partial(discs, 40) for scene in SCENES.select("edits")}
    small = partial(dataclasses.replace, seconds=0.1, steps=12)
    return [small(SCENES[name], build=build) for name, build in builds.items()]


@pytest.mark.parametrize("scene", small_of_each_kind(), ids=lambda scene: scene.name)
def test_scenes_that_move_are_timed(scene: BenchScene) -> None:
    found = result_of(measure_scene(scene)).ours
    assert found.step_ms is not None and found.first_seconds_ms is not None and not found.failure
    assert set(found.quality) == {quality.name for quality in scene.quality}
    for quality in scene.quality:
        if quality.name not in ("kinetic energy at rest", "drift at rest"):  # they still fall
            assert (found.quality[quality.name] or 0.0) <= quality.limit


def test_edits_reach_their_body_before_every_step() -> None:
    found = {}
    for scene in SCENES.select("edits"):
        assert scene.edit is not None
        world = discs(10)
        body = world.batch(Transform, Velocity).entities[-1]
        mass, x = world.component(body, Mass).mass, world.component(body, Transform).position.x
        scene.edit(world, 0)
        after = world.component(body, Mass).mass, world.component(body, Transform).position.x
        name = world.component(body, Name).id if world.has(body, Name) else ""
        found[scene.name] = name, after[0] / mass, after[1] - x
        scene.edit(world, 1)
        assert world.component(body, Mass).mass == pytest.approx(mass, rel=1e-15)
        assert world.component(body, Transform).position.x == pytest.approx(x, abs=1e-15)
    assert found == {
        "edit_name": ("disc 0", 1.0, 0.0),
        "edit_mass": ("", pytest.approx(1.1), 0.0),
        "edit_position": ("", 1.0, pytest.approx(1e-3)),
    }


def test_a_scene_is_stepped_in_a_window() -> None:
    scene = dataclasses.replace(SCENES["circles_10_window"], seconds=0.1, steps=12)
    assert scene.in_window
    engines: list[InWindow] = []

    def in_window(world: World) -> InWindow:
        engines.append(InWindow(world))
        return engines[-1]

    assert result_of(measure_scene(scene, make=in_window)).ours.step_ms is not None
    (engine,) = engines
    assert engine.world.schedule.timings["RenderSystem"].calls > 0, "frames are drawn between turns"


def test_gravity_turns_with_the_time_of_the_steps() -> None:
    engine = prepared(Engine(SCENES["circles_10"].build()), SCENES["tumbler"])
    for _ in range(31):
        engine.advance()
    gravity = engine.look().physics.gravity
    angle = math.radians(-90.0 + 15.0)  # half a second after the first step
    assert tuple(gravity) == pytest.approx((9.81 * math.cos(angle), 9.81 * math.sin(angle)))
