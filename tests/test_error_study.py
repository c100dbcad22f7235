"""F5: error against run time of the scene in the window."""

import json
import sys
import time
from collections import Counter
from pathlib import Path
from typing import Any

import pygame
import pytest
from desk import SETTLED, Desk, click, click_at, empty_world, point, sized, tap
from imgui_bundle import implot
from recording import RecordingCanvas

from physicslab.files.scene import load_scene
from physicslab.prefabs import pendulum
from physicslab.view.window.lab_process import ErrorStudy


def run(asked: str, integrator: str, cpu_ms: float | None, error: float | None) -> dict[str, object]:
    failure = "" if error is not None else "it fell over"
    return {
        "asked": asked, "integrator": integrator, "cpu_ms": cpu_ms, "error": error,
        "step": "0.01 s", "substeps": 8, "tolerance": 1e-9, "failure": failure, "at_most": error == 1e-7,
    }  # fmt: skip


FOUND = {
    "kind": "an estimate",
    "estimate": {"variants": [{"name": "nudged", "spread": {"position": 3e-12}}]},
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
scene, shown, option, report = sys.argv[1:]
assert (shown, option) == ("--progress", "--json")
assert json.loads(pathlib.Path(scene).read_text())["format"] == "physicslab-scene/1"
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
    study = desk.window.error_study
    assert study.running or study.shown or study.failure
    until = time.monotonic() + 60.0
    while desk.window.error_study.running and time.monotonic() < until:
        time.sleep(0.02)
        desk.frames()
    assert not desk.window.error_study.running


def test_the_key_measures_in_another_process_and_shows_the_plot(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lines: dict[str, tuple[list[float], list[float]]] = {}
    usual = implot.plot_line

    def plotted(name: str, costs: Any, errors: Any, *given: Any) -> None:
        lines[name] = list(costs), list(errors)
        usual(name, costs, errors, *given)

    monkeypatch.setattr(implot, "plot_line", plotted)
    desk, _ = desk_with(tmp_path, f"pathlib.Path(report).write_text({json.dumps({'scenes': [FOUND]})!r})")
    measured(desk)
    desk.frames(SETTLED)
    words = desk.ui.words
    assert {"Error against run time", "rk4", "auto: exact"} <= set(words)
    assert "leapfrog" not in words and "leapfrog" not in lines
    assert any("after 5 s" in shown and "Compared with the tightest method" in shown for shown in words)
    samples = desk.window.error_study.samples
    assert {"rk4, at most", "at most 1·10⁻⁷ m", "0.001 m"} <= set(words)
    names = Counter(f"{s.name}, at most" if s.at_most else s.name for s in samples)
    assert {name: len(costs) for name, (costs, _) in lines.items()} == names
    for name, (costs, errors) in lines.items():
        assert costs == sorted(costs) and all(error > 0.0 for error in errors), "logarithms are drawn"
        runs = {(s.cpu_ms, s.error) for s in samples if s.name == name.removesuffix(", at most")}
        assert all((cost, error) in runs or error < 1e-16 for cost, error in zip(costs, errors, strict=True))
    desk.key("escape")
    desk.frames(SETTLED)
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


@pytest.mark.parametrize("size", [(640, 480), (1280, 720)])
def test_the_plot_lies_within_the_window_and_its_button_closes_it(
    tmp_path: Path, size: tuple[int, int]
) -> None:
    desk = sized(size, text_scale=1.75)
    deed = f"pathlib.Path(report).write_text({json.dumps({'scenes': [FOUND]})!r})"
    desk.window.error_study = lab(tmp_path, deed)
    pendulum(desk.world, (0, 0))
    measured(desk)
    desk.frames(2 * SETTLED)
    bodies = len(desk.world.entities())
    screen, plot = pygame.Rect(0, 0, *size), pygame.Rect(desk.sandbox.interface.covered[-1])
    assert screen.contains(plot) and plot.width > 0.5 * size[0]
    within = pygame.Rect(desk.ui.places["Plot of errors"])
    assert screen.contains(within) and within.height > 5.0 * desk.ui.size, "not a sliver"
    click_at(desk, plot.center)
    assert [desk.window.error_study.shown] == [True]
    click(desk, "Close")
    assert [desk.window.error_study.shown] == [False]
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


def test_while_it_is_measured_a_bar_shows_how_far_it_is_and_a_button_stops_it(tmp_path: Path) -> None:
    written = "sys.stderr.write('\\racc: 7 %\\x1b[K\\racc: 42 %\\x1b[K'); sys.stderr.flush(); time.sleep(600)"
    desk, _ = desk_with(tmp_path, written)
    desk.key("f5")
    until = time.monotonic() + 60.0
    while desk.window.error_study.share == 0.0 and time.monotonic() < until:
        time.sleep(0.02)
        desk.frames()
    desk.frames(SETTLED)
    assert desk.ui.rows["Measuring this scene with every method"] == "42%"
    click(desk, "Stop")
    assert [desk.window.error_study.running] == [False]


def test_a_run_of_the_table_can_be_used_and_taken_back(tmp_path: Path) -> None:
    desk, _ = desk_with(tmp_path, f"pathlib.Path(report).write_text({json.dumps({'scenes': [FOUND]})!r})")
    measured(desk)
    desk.frames(2 * SETTLED)
    desk.key("space")
    desk.frames()
    before = desk.world.simulation
    click(desk, "Use run 3")  # by time, the second is rk4's faster one, the third its slower one
    after = desk.world.simulation
    assert (after.integrator, after.substeps, after.tolerance) == ("rk4", 8, 1e-9)
    assert after.dt == before.dt
    desk.key("z", pygame.KMOD_LCTRL)
    desk.frames(SETTLED)  # a key soon after a click waits for a field that it may open
    assert desk.world.simulation == before


@pytest.mark.parametrize("grown, chaotic", [(0.0, False), (5e-8, False), (5e-7, False), (0.2, True)])
def test_a_chaotic_scene_is_called_so(tmp_path: Path, grown: float, chaotic: bool) -> None:
    rows = [run("rk4", "rk4", 0.1, 1e-3), run("leapfrog", "leapfrog", 10.0, 1e-7)]
    variants = {"variants": [{"name": "nudged", "spread": {"position": grown}}]}
    report = json.dumps({"scenes": [FOUND | {"rows": rows, "estimate": variants}]})
    desk, _ = desk_with(tmp_path, f"pathlib.Path(report).write_text({report!r})")
    measured(desk)
    desk.frames(SETTLED)
    assert any("This scene is chaotic" in words for words in desk.ui.words) is chaotic


@pytest.mark.parametrize("horizon", [None, 3.25, 27.7])
def test_the_horizon_of_a_chaotic_scene_is_shown_in_plain_words(
    tmp_path: Path, horizon: float | None
) -> None:
    report = json.dumps({"scenes": [FOUND | {"horizon_s": horizon}]})
    desk, _ = desk_with(tmp_path, f"pathlib.Path(report).write_text(json.dumps(json.loads({report!r})))")
    measured(desk)
    desk.frames(SETTLED)
    seen = [words for words in desk.ui.words if "It has no error but a horizon" in words]
    assert len(seen) == (horizon is not None)
    assert all(f"{horizon:.3g} s from the start" in words and "energy" in words for words in seen)


def test_a_click_on_a_mark_of_the_plot_takes_its_method_and_step(tmp_path: Path) -> None:
    """The middle run of the plot, by its time, is found where ImPlot draws it."""
    rows = [run("rk4", "rk4", 1.0, 1e-3), run("leapfrog", "leapfrog", 100.0, 1e-7)]
    rows[1] |= {"substeps": 5, "tolerance": 1e-6}
    report = json.dumps({"scenes": [FOUND | {"rows": rows}]})
    desk, _ = desk_with(tmp_path, f"pathlib.Path(report).write_text({report!r})")
    measured(desk)
    desk.frames(2 * SETTLED)
    tap(desk, "space")
    before = desk.world.simulation
    left, top, width, height = desk.ui.places["leapfrog 2"]
    point(desk, (left + width // 2, top + height // 2))
    desk.frames(SETTLED)
    assert "A click runs this scene by leapfrog 0.01 s" in desk.ui.words
    click_at(desk, (left + width // 2, top + height // 2))
    after = desk.world.simulation
    assert (after.integrator, after.substeps, after.tolerance) == ("leapfrog", 5, 1e-6)
    tap(desk, "z", pygame.KMOD_LCTRL)
    assert desk.world.simulation == before


def test_the_table_is_saved_as_csv(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    desk, _ = desk_with(tmp_path, f"pathlib.Path(report).write_text({json.dumps({'scenes': [FOUND]})!r})")
    measured(desk)
    desk.frames(2 * SETTLED)
    click(desk, "CSV of all runs")
    (path,) = tmp_path.glob("*-errors-1.csv")
    head, *rows = path.read_text("utf-8").splitlines()
    assert head.startswith("chosen,method,") and len(rows) == 3
    assert rows[0] == "rk4,rk4,0.01 s,8,1e-09,0.1,0.001,"
    assert rows[1] == "rk4,rk4,0.01 s,8,1e-09,10.0,1e-07,at most"


def test_a_plot_without_any_growth_of_rounding_and_without_errors_is_shown(tmp_path: Path) -> None:
    """Nothing grows, and the least error is 0: neither has a logarithm, and 0 is no chaos."""
    nudged = {"variants": [{"name": "nudged", "spread": {"position": 0.0}}]}
    for horizon in (None, 3.0):
        found = FOUND | {"estimate": nudged, "horizon_s": horizon}
        desk, _ = desk_with(tmp_path, f"pathlib.Path(report).write_text({json.dumps({'scenes': [found]})!r})")
        measured(desk)
        desk.frames(SETTLED)
        assert desk.window.error_study.shown and not desk.window.error_study.rounding_shows
        assert desk.window.error_study.chaotic == (horizon is not None)
        assert not any("One rounding at the start moves" in words for words in desk.ui.words)
