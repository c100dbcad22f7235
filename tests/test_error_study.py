"""F5: error against run time of the scene in the window."""

import json
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from desk import Desk, empty_world
from recording import RecordingCanvas

from physicslab.files.scene import load_scene
from physicslab.prefabs import pendulum
from physicslab.view.panels.error_study import ErrorStudy


def run(asked: str, integrator: str, cpu_ms: float | None, error: float | None) -> dict[str, object]:
    failure = "" if error is not None else "it fell over"
    return {
        "asked": asked, "integrator": integrator, "cpu_ms": cpu_ms, "error": error,
        "step": "0.01 s", "failure": failure,
    }  # fmt: skip


FOUND = {
    "kind": "an estimate",
    "seconds": 5.0,
    "reference": "the tightest method",
    "rows": [
        run("rk4", "rk4", 0.1, 1e-3),
        run("rk4", "rk4", 10.0, 1e-7),
        run("auto", "exact", 0.01, 0.0),
        run("leapfrog", "leapfrog", None, None),
    ],
}

PROGRAM = """
import json, pathlib, sys, time
scene, option, report = sys.argv[1:]
assert option == "--json" and json.loads(pathlib.Path(scene).read_text())["format"] == "physicslab-scene/1"
{deed}
"""


def lab(tmp_path: Path, deed: str) -> ErrorStudy:
    """Return a study whose laboratory is a program of the test."""
    program = tmp_path / "lab.py"
    program.write_text(PROGRAM.format(deed=deed))
    return ErrorStudy((sys.executable, str(program)))


def desk_with(tmp_path: Path, deed: str) -> tuple[Desk, RecordingCanvas]:
    world, canvas = empty_world(), RecordingCanvas((1280, 720))
    pendulum(world, (0, 0))
    desk = Desk(world, canvas)
    desk.window.error_study = lab(tmp_path, deed)
    return desk, canvas


def measured(desk: Desk) -> None:
    """Ask for it with the key, and wait until it is there."""
    desk.key("f5")
    desk.frames()
    assert desk.window.error_study.running
    until = time.monotonic() + 60.0
    while desk.window.error_study.running and time.monotonic() < until:
        time.sleep(0.02)
        desk.frames()
    assert not desk.window.error_study.running


def test_the_key_measures_in_another_process_and_shows_the_plot(tmp_path: Path) -> None:
    desk, canvas = desk_with(
        tmp_path, f"pathlib.Path(report).write_text({json.dumps({'scenes': [FOUND]})!r})"
    )
    measured(desk)
    canvas.calls.clear()
    desk.frames()
    assert {"Error against run time", "rk4", "auto: exact", "run time, ms", "error, m"} <= set(canvas.words)
    assert "leapfrog" not in canvas.words
    assert any("an estimate; distances after 5 s from the tightest method" in words for words in canvas.words)
    joined = next(call for call in canvas.called("lines") if call["width"] == 1.5)
    (slow, exact) = joined["start"][0], joined["end"][0]
    assert slow[0] < exact[0] and slow[1] < exact[1]  # more work, less error: to the right and down
    inside = (joined["start"] > 0) & (joined["start"] < (1280, 720))
    assert np.all(inside)
    desk.key("escape")
    desk.frames()
    assert not desk.window.error_study.shown and not desk.window.closing


def test_a_laboratory_that_fails_is_reported_in_its_own_words(tmp_path: Path) -> None:
    desk, _ = desk_with(tmp_path, "sys.exit('physicslab: the scene is too strange')")
    measured(desk)
    desk.frames()
    assert "physicslab: the scene is too strange" in desk.window.notice
    assert not desk.window.error_study.shown


def test_pressing_again_stops_it_and_leaves_nothing_behind(tmp_path: Path) -> None:
    desk, _ = desk_with(tmp_path, "time.sleep(600)")
    desk.key("f5")
    desk.frames()
    study = desk.window.error_study
    assert study._place is not None
    place = Path(study._place.name)
    assert place.exists()
    desk.key("f5")
    desk.frames()
    assert not study.running and not place.exists()
    assert "stopped" in desk.window.notice


def test_a_click_closes_the_plot_and_makes_no_circle(tmp_path: Path) -> None:
    desk, _ = desk_with(tmp_path, f"pathlib.Path(report).write_text({json.dumps({'scenes': [FOUND]})!r})")
    measured(desk)
    bodies = len(desk.world.entities())
    desk.press(2, 2)
    desk.release(2, 2)
    desk.frames(2)
    assert not desk.window.error_study.shown
    assert len(desk.world.entities()) == bodies


@pytest.mark.parametrize("name", ["two_planets"])
def test_the_real_laboratory_measures_a_scene(name: str) -> None:
    study = ErrorStudy()
    study.start(load_scene(name))
    until = time.monotonic() + 120.0
    while not study.poll() and time.monotonic() < until:
        time.sleep(0.1)
    assert study.failure == ""
    assert {sample.integrator for sample in study.samples} >= {"leapfrog", "rk4", "dop853"}
