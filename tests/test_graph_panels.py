"""How graphs look: their pictures, their places, and how many points are drawn."""

from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pygame
import pytest
from desk import SETTLED, Desk, button_down, button_up, click, empty_world, point, sized, tap
from plotting import CTRL, SHIFT, ball_of, drawn_lines, graph_of, pause

from physicslab.view.canvas.canvas import Rect
from physicslab.view.controls import dashboard_actions, file_actions
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
    panel = desk.sandbox.interface.covered[4]
    assert np.allclose(panel[2:], picture.get_size(), atol=2)
    within = pygame.Rect(panel).contains(pygame.Rect(plot))
    colours = {
        tuple(picture.get_at((x, y)))[:3] for x in range(0, picture.get_width(), 2) for y in range(40, 200, 2)
    }
    assert within and desk.window.theme.body(ball) in colours
    assert "Saved" in desk.window.notice


def test_a_full_disk_is_one_plain_sentence(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(path: Path, content: bytes) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(file_actions, "create_file", full)
    ball_of(desk)
    tap(desk, "m")
    desk.window.do_next(dashboard_actions.save_table, graph_of(desk))
    desk.frames(2)
    assert desk.window.notice == "The graph could not be saved: No space left on device"


def overlap(a: Rect, b: Rect) -> bool:
    return pygame.Rect(a).colliderect(pygame.Rect(b))


@pytest.mark.parametrize("count", [1, 2, 4])
@pytest.mark.parametrize(
    ("size", "text"), [((1280, 720), 1.0), ((1280, 720), 1.75), ((800, 600), 1.75), ((1920, 1080), 1.0)]
)
def test_panels_lie_over_nothing(size: tuple[int, int], text: float, count: int) -> None:
    desk = sized(size, empty_world(gravity=(0, 0)), text)
    for _ in range(count):
        tap(desk, "m")
    tap(desk, "m", CTRL)
    tap(desk, "m", CTRL | SHIFT)
    desk.frames(SETTLED)
    covered = desk.sandbox.interface.covered
    around = desk.sandbox.interface.layout
    panels = [
        rect for rect in covered if all(abs(rect[n] - fixed[n]) > 1 for fixed in around.panels for n in (3,))
    ]
    is_folded = "Open graph 1" in desk.ui.places
    assert len(panels) == (2 if is_folded else count) + 2, covered
    for a, b in combinations([*panels, *around.panels], 2):
        assert not overlap(a, b) or a in around.panels, (a, b)
    whole = pygame.Rect(0, 0, *size)
    assert all(whole.contains(pygame.Rect(rect)) for rect in panels)


def test_where_one_graph_has_room_the_others_are_bars_that_open() -> None:
    desk = sized((800, 600), empty_world(), 1.75)
    tap(desk, "m")
    tap(desk, "m")
    assert "Plot of graph 2" in desk.ui.places and "Plot of graph 1" not in desk.ui.places
    click(desk, "Open graph 1")
    assert "Plot of graph 1" in desk.ui.places and "Open graph 2" in desk.ui.places


def test_where_no_graph_has_room_a_button_makes_some() -> None:
    desk = sized((640, 480), empty_world(), 1.75)
    tap(desk, "m")
    assert not any("Plot" in label for label in desk.ui.places)
    click(desk, "Show graphs")
    assert "Plot of graph 1" in desk.ui.places and not desk.window.figures


def test_a_graph_that_was_moved_by_hand_stays_where_it_was_put(desk: Desk) -> None:
    ball_of(desk)
    tap(desk, "m")
    pause(desk)
    plot = desk.ui.places["Plot of graph 1"]
    start = plot[0], desk.ui.places["Lines of graph 1"][1] - 20  # on its title
    point(desk, start)
    button_down(desk, start)
    for n in range(1, 5):
        point(desk, (start[0] - 60 * n, start[1] + 30 * n), (1, 0, 0))
    button_up(desk, (start[0] - 240, start[1] + 120))
    moved = desk.ui.places["Plot of graph 1"]
    assert np.allclose(moved[:2], (plot[0] - 240, plot[1] + 120), atol=2)
    tap(desk, "m")
    assert desk.ui.places["Plot of graph 1"] == moved
    assert desk.ui.places["Plot of graph 2"][1] == plot[1]


def test_the_stopwatch_opens_beside_a_graph(desk: Desk) -> None:
    tap(desk, "m")
    graph = next(
        rect for rect in desk.sandbox.interface.covered if rect[0] > 500 and rect[1] > 25 and rect[3] < 400
    )
    tap(desk, "c")
    button = desk.ui.places["CSV of crossings"]
    assert button[0] < graph[0] and desk.window.shows_stopwatch
    stopwatch = next(rect for rect in desk.sandbox.interface.covered if overlap(rect, button))
    assert not overlap(stopwatch, graph)


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
