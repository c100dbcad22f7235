"""What the labs have in common: catalogues, jobs, tables and documents; and scenes in which bodies move."""

import dataclasses
import json
import math
from collections.abc import Iterator

import numpy as np
import pytest

from physicslab import cli
from physicslab.components import Transform
from physicslab.lab.accuracy.catalogue import PROBLEMS
from physicslab.lab.bench.catalogue import SCENES, by_default
from physicslab.lab.bench.engine import OurEngine, TurningGravity
from physicslab.lab.bench.measure import measure_scene
from physicslab.lab.bench.moving import MOVING
from physicslab.lab.bench.result import SceneResult
from physicslab.lab.bench.scene import BenchScene
from physicslab.lab.case import Case, Catalogue, attempt, run_jobs
from physicslab.lab.document import lab_document, machine
from physicslab.lab.peers.peer import find_contacts
from physicslab.lab.stability.catalogue import CASES
from physicslab.lab.table import Columns, table
from physicslab.state.masses import Diverged


def test_jobs_run_one_after_the_other_and_count_by_their_weight() -> None:
    events: list[str] = []

    def job(name: str) -> Iterator[float | str]:
        events.append(f"begin {name}")
        yield 0.5
        events.append(f"end {name}")
        yield name

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
    ("command", "names"),
    [("stability", list(CASES)), ("bench", list(SCENES)), ("accuracy", list(PROBLEMS))],
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


def test_scenes_that_move_are_run_only_where_they_are_named() -> None:
    moving = {scene.name for scene in MOVING}
    assert moving == {"funnel", "funnel_floor", "heap", "chains", "tumbler"}
    assert not moving & {scene.name for scene in by_default()}
    assert moving == {scene.name for scene in SCENES.select("moving")}


@pytest.mark.parametrize("scene", MOVING, ids=lambda scene: scene.name)
def test_scenes_that_move_are_the_same_each_time(scene: BenchScene) -> None:
    worlds = scene.build(), scene.build()
    one, two = (world.table(Transform)["position"] for world in worlds)
    assert np.array_equal(one, two)
    find_contacts(worlds[0])
    assert np.count_nonzero(worlds[0].bodies.inverse_mass) == scene.size
    assert worlds[0].contacts.max_penetration <= 0.0, "nothing overlaps at the start"


def test_gravity_turns_with_the_time_of_the_steps() -> None:
    tumbler = SCENES["tumbler"]
    assert tumbler.gravity_at is not None
    engine = TurningGravity(OurEngine(SCENES["circles_10"].build()), tumbler.gravity_at)
    for _ in range(31):
        engine.step()
    gravity = engine.look().physics.gravity
    angle = math.radians(-90.0 + 15.0)  # half a second after the first step
    assert tuple(gravity) == pytest.approx((9.81 * math.cos(angle), 9.81 * math.sin(angle)))
    small = dataclasses.replace(
        SCENES["circles_10_stepped"], gravity_at=tumbler.gravity_at, seconds=0.1, steps=3, quality=()
    )
    *_, result = measure_scene(small)
    assert isinstance(result, SceneResult) and result.ours.step is not None and not result.ours.failure
