"""How graphs look: their pictures, their places, and how many points are drawn."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pygame
import pytest
from desk import SETTLED, Desk, click, empty_world, sized, tap
from plotting import ball_of, drawn_lines, graph_of, pause

from physicslab import load_scene
from physicslab.components import Graph, GraphLine, Velocity
from physicslab.files import replace
from physicslab.history import Spawn
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.controls import dashboard_actions
from physicslab.view.controls.lesson_actions import choose_language
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.record import line_to_show


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Desk:
    monkeypatch.chdir(tmp_path)
    return sized((1280, 720), empty_world(gravity=(0, 0)))


def test_the_picture_of_a_graph_is_its_panel(desk: Desk, tmp_path: Path) -> None:
    ball = ball_of(desk)
    tap(desk, "m")
    desk.frames(40)
    click(desk, "More of graph 1")
    click(desk, "Save as a picture (PNG)")
    desk.frames(3)
    (path,) = tmp_path.glob("*.png")
    picture = pygame.image.load(path)
    plot = desk.ui.places["Plot of graph 1"]
    assert picture.get_width() > plot[2] and picture.get_height() > plot[3]
    colours = {
        tuple(picture.get_at((x, y)))[:3] for x in range(0, picture.get_width(), 2) for y in range(40, 200, 2)
    }
    assert desk.window.theme.body(ball) in colours
    assert "Saved" in desk.window.notice


def test_ticks_have_the_decimal_mark_of_the_language(desk: Desk) -> None:
    ball_of(desk)
    tap(desk, "m")
    desk.frames(4)
    english = ticks(desk)
    assert any("." in one for one in english) and not any("," in one for one in english)
    choose_language(desk.world, desk.window, "de")
    desk.frames(3)
    german = ticks(desk)
    assert any("," in one for one in german) and not any("." in one for one in german)
    assert len(set(german)) > 5
    assert "Zeit [s]" in desk.ui.words
    assert any(one.startswith("Diagramm 1: ") for one in desk.ui.words)


@pytest.mark.parametrize(
    ("names", "heading"),
    [
        (["kinetic energy", "potential energy", "total energy"], "energy [J]"), (["x", "y"], "x, y [m]"),
        (["velocity x", "velocity y"], "velocity [m/s]"), (["speed"], "speed [m/s]"),
    ],
)  # fmt: skip
def test_an_axis_of_several_quantities_of_a_kind_has_the_name_of_the_kind(
    desk: Desk, names: list[str], heading: str
) -> None:
    ball = ball_of(desk)
    (graph,) = desk.window.edits.do(Spawn([Graph()], None))
    for name in names:
        desk.window.edits.do(Spawn([GraphLine(graph=graph, quantity=name, body=ball)], None))
    desk.frames(SETTLED)
    assert heading in desk.ui.words


def ticks(desk: Desk) -> list[str]:
    """Return the numbers that stand at the axes of plots."""
    return [one for one in desk.ui.words if re.fullmatch(r"-?\d+(?:[.,]\d+)?", one)]


def test_a_full_disk_is_one_plain_sentence(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(path: Path, content: bytes) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(replace, "create_file", full)
    ball_of(desk)
    tap(desk, "m")
    desk.window.do_next(dashboard_actions.save_table, graph_of(desk))
    desk.frames(2)
    assert desk.window.notice == "The graph could not be saved: No space left on device"


def test_no_more_points_are_drawn_than_can_be_seen(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    ball = ball_of(desk)
    tap(desk, "m")
    pause(desk)
    record, count = desk.window.dashboard.record, 20_000
    for n in range(count):
        record.add(100.0 + n / 60.0, n, {(ball, name): float(np.sin(n)) for name in ("x", "y", "speed")})
    drawn = drawn_lines(monkeypatch)
    reduced: list[int] = []

    def reduce(x: np.ndarray, y: np.ndarray, *seen: Any) -> tuple[np.ndarray, np.ndarray]:
        reduced.append(len(x))
        return line_to_show(x, y, *seen)

    monkeypatch.setattr("physicslab.view.workbench.graph_plot.line_to_show", reduce)
    desk.sandbox.interface.toolkit.wake()
    desk.frames(SETTLED)
    width = desk.ui.places["Plot of graph 1"][2]
    assert drawn and max(len(x) for x, _ in drawn) <= 4 * (width + 2)
    made = len(reduced)
    for _ in range(3):
        desk.sandbox.interface.toolkit.wake()
        desk.frames(SETTLED)
    assert len(reduced) == made  # what does not change is not made again


def test_in_a_small_window_a_plot_beside_the_stopwatch_is_readable_and_its_hint_whole(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A plot of three lines was 40 px high there, and the German hint ran out of the window."""
    wide: dict[str, bool] = {}
    text = Ui.text

    def note(ui: Ui, words: str, *given: Any, wrapped: bool = False) -> None:
        wide[words] = not wrapped
        text(ui, words, *given, wrapped=wrapped)

    monkeypatch.setattr(Ui, "text", note)
    world = load_scene("newtons_cradle")
    graph = world.spawn(Graph())
    for body in world.batch(Velocity).entities[:3].tolist():
        world.spawn(GraphLine(graph, "velocity x", body))
    desk = sized((800, 600), world, 1.5)
    desk.window.shows_stopwatch = True
    desk.frames(SETTLED)
    assert desk.ui.places["Plot of graph 1"][3] >= 5 * desk.sandbox.interface.text
    assert not wide["Draw a gate for bodies to cross"]


def test_in_a_small_window_no_line_below_a_plot_is_seen_in_half() -> None:
    desk = sized((800, 600), load_scene("pendulum"), 1.5)
    _, top, _, height = desk.ui.places["Plot of graph 1"]
    left, bottom = desk.ui.places["Lines of graph 1"][0], desk.sandbox.interface.layout.transport[1]
    canvas = desk.window.canvas
    assert isinstance(canvas, PygameCanvas)
    below = pygame.surfarray.array3d(canvas.surface)[left : left + 90, top + height : bottom]
    rows = (np.abs(below.astype(int) - np.array(desk.window.theme.panel)).max(axis=2) > 100).any(axis=0)
    assert not rows[-round(1.2 * desk.sandbox.interface.text) :].any()
