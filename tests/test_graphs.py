"""Graphs, meters and sliders in the window: made, changed, undone, saved, looked into."""

import json
import re
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pygame
import pytest
from desk import SETTLED, Desk, click, click_at, empty_world, point, sized, tap
from imgui_bundle import implot

from physicslab.components import Graph, GraphLine, Mass, Meter, Shape, Slider, Spring, Transform, Velocity
from physicslab.files.scene import SceneError, load_scene, save_scene
from physicslab.history import AddComponent, History, SetField, Spawn
from physicslab.prefabs import circle
from physicslab.view.canvas.canvas import Rect
from physicslab.view.controls import actions, file_actions, measuring_actions
from physicslab.view.window.measuring import GraphShown
from physicslab.view.window.plot_data import line_to_show
from physicslab.world import World

CTRL, SHIFT = pygame.KMOD_LCTRL, pygame.KMOD_LSHIFT


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Desk:
    monkeypatch.chdir(tmp_path)
    return sized((1280, 720), empty_world(gravity=(0, 0)))


def ball_of(desk: Desk, name: str = "ball", y: float = 0.0) -> int:
    parts = [Transform((0, y)), Velocity((2, 0)), Mass(1.0), Shape.circle(0.3)]
    (ball,) = desk.window.edits.do(Spawn(parts, name))
    desk.window.selection.take(ball)
    desk.frames()
    return ball


def graph_of(desk: Desk) -> GraphShown:
    (graph,) = desk.window.measuring.graphs
    return graph


def in_plot(desk: Desk, across: float, up: float = 0.5, number: int = 1) -> tuple[int, int]:
    left, top, width, height = desk.ui.places[f"Plot of graph {number}"]
    return round(left + across * width), round(top + (1.0 - up) * height)


def drawn_lines(monkeypatch: pytest.MonkeyPatch) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return a list to which the points of every line are added that is plotted."""
    drawn: list[tuple[np.ndarray, np.ndarray]] = []
    plot_line = implot.plot_line

    def note(name: str, x: np.ndarray, y: np.ndarray, look: implot.Spec) -> None:
        drawn.append((x, y))
        plot_line(name, x, y, look)

    monkeypatch.setattr(implot, "plot_line", note)
    return drawn


def pause(desk: Desk) -> None:
    desk.window.pace.paused = True
    desk.frames(SETTLED)


# Making, undoing, keeping


def test_m_plots_what_is_selected_and_it_is_written_as_a_table(desk: Desk, tmp_path: Path) -> None:
    ball = ball_of(desk)
    tap(desk, "m")
    desk.frames(31)
    record = desk.window.measuring.record
    x, times = record.values((ball, "x")), record.times
    assert len(times) >= 30 and np.allclose(np.diff(x), 2.0 * np.diff(times), atol=1e-9)
    assert [line.key for line in graph_of(desk).lines] == [(ball, "x"), (ball, "y"), (ball, "speed")]
    click(desk, "More of graph 1")
    click(desk, "Save as a table (CSV)")
    desk.frames(2)
    (path,) = tmp_path.glob("*.csv")
    head, first, *_ = path.read_text("utf-8").splitlines()
    assert head == "time [s],ball: x [m],ball: y [m],ball: speed [m/s]"
    assert [float(value) for value in first.split(",")][3] == pytest.approx(2.0)


def test_a_graph_is_taken_back_and_put_back_with_its_samples(desk: Desk) -> None:
    ball = ball_of(desk)
    pause(desk)
    tap(desk, "m")
    assert "Graph 1: ball" in desk.ui.words
    tap(desk, "z", CTRL)
    assert not desk.window.measuring.graphs and "Graph 1: ball" not in desk.ui.words
    tap(desk, "y", CTRL)
    assert [line.key[0] for line in graph_of(desk).lines] == [ball] * 3
    assert desk.window.edits.history.entries[-1].words == "plotted ball"


def test_closing_a_graph_is_an_edit_that_takes_its_lines_with_it(desk: Desk) -> None:
    ball_of(desk)
    tap(desk, "m")
    desk.window.deeds.append(measuring_actions.close_graph(graph_of(desk)))
    desk.frames(2)
    assert not desk.world.batch(Graph).entities.size and not desk.world.batch(GraphLine).entities.size
    pause(desk)
    while desk.window.measuring.graphs == ():
        tap(desk, "z", CTRL)
    assert len(graph_of(desk).lines) == 3


def test_a_saved_scene_opens_with_its_panels(desk: Desk, tmp_path: Path) -> None:
    ball_of(desk)
    for key, held in (("m", 0), ("m", SHIFT), ("m", CTRL), ("m", CTRL | SHIFT)):
        tap(desk, key, held)
    assert len(desk.window.measuring.graphs) == 2 and "Slider 1" in desk.ui.places
    path = tmp_path / "with-graphs.json"
    save_scene(desk.world, path)
    file_actions.open_scene(desk.window, path)
    desk.frames(SETTLED)
    ball = desk.world.entity("ball")
    graphs = desk.window.measuring.graphs
    assert [graph.across for graph in graphs] == [None, (ball, "x")]
    assert [line.key for line in graphs[1].lines] == [(ball, "velocity x")]
    assert "ball: speed" in desk.ui.words and "ball: mass" in desk.ui.words


def test_of_several_bodies_the_speeds_are_in_one_graph(desk: Desk) -> None:
    a, b = ball_of(desk, "a"), circle(desk.world, (0, 2), velocity=(0, 3), name="b")
    desk.window.selection.take(b, add=True)
    tap(desk, "m")
    assert [line.key for line in graph_of(desk).lines] == [(a, "speed"), (b, "speed")]
    assert "a: speed" in desk.ui.words and "b: speed" in desk.ui.words
    assert "3.000 m/s" in desk.ui.words


def test_lines_of_the_world_and_of_bodies_are_chosen_in_a_menu(desk: Desk) -> None:
    ball = ball_of(desk)
    tap(desk, "m")
    click(desk, "Lines of graph 1")
    click(desk, "The world")
    click(desk, "total energy [J]")
    assert (None, "total energy") in graph_of(desk).keys
    click(desk, "Lines of graph 1")
    click(desk, "ball")
    click(desk, "speed [m/s]")
    assert (ball, "speed") not in graph_of(desk).keys
    assert desk.window.edits.history.entries[-1].words.startswith(("took speed of ball", "ran"))


def test_any_quantity_can_stand_across(desk: Desk) -> None:
    ball = ball_of(desk)
    tap(desk, "m")
    click(desk, "Across graph 1")
    click(desk, "ball")
    click(desk, "y [m]")
    assert graph_of(desk).across == (ball, "y") and "y [m]" in desk.ui.words
    click(desk, "Across graph 1")
    click(desk, "Time [s]")
    assert graph_of(desk).across is None


def test_a_phase_plot_is_velocity_against_place(monkeypatch: pytest.MonkeyPatch) -> None:
    desk = sized((1280, 720), load_scene("pendulum"))
    desk.window.selection.take(desk.world.entity("bob"))
    drawn = drawn_lines(monkeypatch)
    tap(desk, "m", SHIFT)
    desk.frames(200)
    x, v = drawn[-1]
    record, bob = desk.window.measuring.record, desk.world.entity("bob")
    assert len(x) > 150 and np.array_equal(v, record.values((bob, "velocity x"))[: len(v)])
    assert np.array_equal(x, record.values((bob, "x"))[: len(x)]) and (np.diff(x) < 0).any()


# Time


def test_nothing_is_recorded_again_in_the_past_and_later_samples_stay_until_then(desk: Desk) -> None:
    ball = ball_of(desk)
    tap(desk, "m")
    desk.frames(20)
    before = desk.window.measuring.record.times.copy()
    actions.seek(desk.window, desk.window.edits.history.step_count - 8)
    desk.frames(3)
    assert np.array_equal(desk.window.measuring.record.times, before)
    desk.window.edits.do(SetField(ball, "Velocity", "linear", (1.0, 0.0)))
    desk.window.pace.paused = False
    desk.frames(3)
    times = desk.window.measuring.record.times
    assert times[-1] < before[-1] and (np.diff(times) > 0).all()


def test_a_graph_stays_while_the_time_before_it_is_looked_at(desk: Desk) -> None:
    ball_of(desk)
    desk.frames(20)
    tap(desk, "m")
    desk.frames(10)
    actions.seek(desk.window, desk.window.edits.history.step_count - 20)
    desk.frames(SETTLED)
    assert not desk.world.batch(Graph).entities.size and "Graph 1: ball" in desk.ui.words
    click(desk, "Across graph 1")
    click(desk, "ball")
    click(desk, "x [m]")
    assert "made later" in desk.window.notice and desk.window.edits.history.branches == ()


def test_cursors_are_set_by_clicks_and_give_slope_and_area_in_words(desk: Desk) -> None:
    ball_of(desk)
    tap(desk, "m")
    desk.frames(60)
    pause(desk)
    click_at(desk, in_plot(desk, 0.25))
    a, b = desk.window.measuring.marks
    assert a is not None and b is None and "Shift-click: B" in desk.ui.words
    pygame.key.set_mods(SHIFT)
    try:
        desk.frames(30)  # or the two would be a double click
        click_at(desk, in_plot(desk, 0.75))
    finally:
        pygame.key.set_mods(0)
    a, b = desk.window.measuring.marks
    assert a is not None and b is not None and b > a
    words = " / ".join(desk.ui.words)
    assert "slope 2.000 m/s, area" in words and "slope 0 m/s², area" in words
    x = desk.window.measuring.record.values((graph_of(desk).lines[0].key[0], "x"))
    times = desk.window.measuring.record.times
    between = (times >= a - 1e-9) & (times <= b + 1e-9)
    area = np.trapezoid(x[between], times[between])
    assert f"area {area:.4f} m s" in words or f"area {area:.3f} m s" in words
    assert f"mark at {a:.3f} s" in words and f"mark at {b:.3f} s" in words
    click(desk, "Clear cursors in graph 1")
    assert desk.window.measuring.marks == [None, None]


def test_the_moment_under_the_cursor_is_that_of_every_graph_and_of_the_time_line(desk: Desk) -> None:
    ball_of(desk)
    tap(desk, "m")
    desk.window.selection.clear()
    tap(desk, "m")
    desk.frames(60)
    pause(desk)
    point(desk, in_plot(desk, 0.5, number=2))
    desk.frames(SETTLED)
    pointed = desk.window.measuring.pointed
    assert pointed is not None and 0.1 < pointed < desk.world.time - 0.1
    assert desk.ui.words.count(f"t {pointed:.3f} s") == 2 and f"mark at {pointed:.3f} s" in desk.ui.words
    point(desk, (300, 300))
    desk.frames(SETTLED)
    assert desk.window.measuring.pointed is None


def test_a_double_click_goes_to_the_moment_and_so_does_the_button_of_a_cursor(desk: Desk) -> None:
    ball_of(desk)
    tap(desk, "m")
    desk.frames(60)
    pause(desk)
    place = in_plot(desk, 0.5)
    click_at(desk, place)
    for kind in (pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP):
        pygame.event.post(pygame.Event(kind, button=1, pos=place, touch=False))
        desk.frames(2)
    mark = desk.window.measuring.marks[0]
    assert mark is not None and desk.world.time == pytest.approx(mark)
    assert desk.window.edits.history.step_count < desk.window.edits.history.steps_range[1]
    actions.seek(desk.window, 10**9)
    desk.frames(SETTLED)
    assert desk.world.time > mark
    click(desk, "Go to A in graph 1")
    assert desk.world.time == pytest.approx(mark)


def test_axes_follow_until_they_are_moved_by_hand(desk: Desk) -> None:
    ball_of(desk)
    tap(desk, "m")
    desk.frames(30)
    point(desk, in_plot(desk, 0.5))
    assert not desk.window.measuring.free_axes
    pygame.event.post(pygame.Event(pygame.MOUSEWHEEL, x=0, y=1, precise_x=0.0, precise_y=1.0))
    desk.frames(SETTLED)
    assert desk.window.measuring.free_axes == {graph_of(desk).entity}
    click(desk, "Follow graph 1")
    assert not desk.window.measuring.free_axes


# Bodies that are gone, and other runs


def test_the_line_of_a_removed_body_stays_and_says_so(desk: Desk, tmp_path: Path) -> None:
    ball = ball_of(desk)
    tap(desk, "m")
    tap(desk, "m", CTRL)
    desk.frames(20)
    desk.window.selection.take(ball)
    tap(desk, "delete")
    desk.frames(20)
    record = desk.window.measuring.record
    assert np.isfinite(record.values((ball, "x"))).sum() > 10 and np.isnan(record.values((ball, "x"))[-1])
    words = " / ".join(desk.ui.words)
    assert "Graph 1: ball" in words and "(gone)" in words and "The body is gone" in words
    path = tmp_path / "gone.json"
    save_scene(desk.world, path)
    again = load_scene(path)
    assert len(again.batch(Graph).entities) == 1 and not len(again.batch(GraphLine).entities)
    click(desk, "Lines of graph 1")
    click(desk, "Remove: ball: speed")
    assert len(graph_of(desk).lines) == 2


def test_the_run_before_is_a_ghost_and_the_graph_comes_along(desk: Desk) -> None:
    file_actions.open_scene(desk.window, "pendulum")
    desk.frames(2)
    desk.window.selection.take(desk.world.entity("bob"))
    own = len(desk.world.batch(Graph).entities)
    tap(desk, "m")
    desk.frames(30)
    for _ in range(2):
        before = desk.window.measuring.record
        tap(desk, "r", CTRL)
        desk.frames(10)
        assert len(desk.world.batch(Graph).entities) == own + 1
        bob = desk.world.entity("bob")
        ghost = desk.window.measuring.before.values((bob, "x"))
        assert len(ghost) == len(before) and desk.window.measuring.record is not before
        assert "x before" in desk.ui.words
        desk.frames(20)


def test_another_scene_has_no_graph_of_the_last_one(desk: Desk) -> None:
    ball_of(desk)
    tap(desk, "m")
    file_actions.open_scene(desk.window, "drop")
    desk.frames(SETTLED)
    assert not desk.window.measuring.graphs and not len(desk.window.measuring.before)


# Meters and sliders


def test_a_meter_shows_a_number_with_its_unit_and_can_show_another(desk: Desk) -> None:
    ball_of(desk)
    tap(desk, "m", CTRL)
    assert "2.000 m/s" in desk.ui.words
    click(desk, "Menu of meter 1")
    click(desk, "ball")
    click(desk, "kinetic energy [J]")
    assert desk.window.measuring.meters[0].key[1] == "kinetic energy"
    click(desk, "Menu of meter 1")
    click(desk, "Place")
    click(desk, "Top left")
    assert desk.window.measuring.meters[0].corner == "top left"
    click(desk, "Menu of meter 1")
    click(desk, "Remove the meter")
    assert not desk.world.batch(Meter).entities.size
    pause(desk)
    tap(desk, "z", CTRL)
    tap(desk, "z", CTRL)
    assert desk.world.batch(Meter).entities.size


def slide(desk: Desk, label: str, share: float, between: int = 3) -> None:
    """Press the slider in its middle, move to a share of its width, and let go there."""
    left, top, width, height = desk.ui.places[label]
    start, end = (left + width // 2, top + height // 2), (left + round(share * width), top + height // 2)
    point(desk, start)
    pygame.event.post(pygame.Event(pygame.MOUSEBUTTONDOWN, pos=start, button=1, touch=False))
    desk.frames(2)
    for n in range(1, 4):
        place = start[0] + (end[0] - start[0]) * n // 3, start[1]
        point(desk, place, (1, 0, 0))
        desk.frames(between)
    pygame.event.post(pygame.Event(pygame.MOUSEBUTTONUP, pos=end, button=1, touch=False))
    desk.frames(SETTLED)


def test_a_slider_is_one_edit_while_time_stands_still(desk: Desk) -> None:
    ball = ball_of(desk)
    pause(desk)
    tap(desk, "m", CTRL | SHIFT)
    entries = len(desk.window.edits.history.entries)
    mass = mass_of(desk, ball)
    slide(desk, "Slider 1", 0.8)
    assert mass_of(desk, ball) > mass and len(desk.window.edits.history.entries) == entries + 1
    tap(desk, "z", CTRL)
    assert mass_of(desk, ball) == mass


def mass_of(desk: Desk, ball: int) -> float:
    return desk.world.component(ball, Mass).mass


def test_a_slider_for_gravity_works_while_time_runs_and_the_run_is_the_same_again(
    desk: Desk, tmp_path: Path
) -> None:
    ball_of(desk)
    desk.window.selection.clear()
    tap(desk, "m", CTRL | SHIFT)
    desk.frames(5)
    slide(desk, "Slider 1", 0.9)
    assert 15.0 < -desk.world.physics.gravity.y <= 20.0
    desk.frames(20)
    pause(desk)
    history, last = desk.window.edits.history, desk.window.edits.history.step_count
    place = desk.world.component(desk.world.entity("ball"), Transform).position
    assert place.y < 0.0
    history.save(tmp_path / "slid.json")
    history.seek(0)
    history.seek(last)
    assert history.difference is None
    assert desk.world.component(desk.world.entity("ball"), Transform).position == place
    again = History.load(tmp_path / "slid.json")
    again.seek(again.steps_range[1])
    assert again.difference is None
    assert again.world.component(again.world.entity("ball"), Transform).position == place


def test_the_slider_of_a_spring_is_for_its_stiffness_and_can_be_given_other_ends(desk: Desk) -> None:
    ball = ball_of(desk)
    desk.window.edits.do(AddComponent(ball, Spring(anchor_b=(0, 2), stiffness=40.0)))
    pause(desk)
    tap(desk, "m", CTRL | SHIFT)
    slider = desk.window.measuring.sliders[0]
    assert (slider.changes, slider.low, slider.high) == ("Spring.stiffness", 0.0, 200.0)
    desk.window.deeds.append(
        measuring_actions.changing(slider.entity, Slider("Spring.stiffness", ball, 10.0, 50.0))
    )
    desk.frames(SETTLED)
    slide(desk, "Slider 1", 1.0)
    assert desk.world.component(ball, Spring).stiffness == 50.0
    desk.window.selection.take(ball)
    tap(desk, "delete")
    assert "The body is gone" in desk.ui.words


# Pictures, and how it looks


def test_the_picture_of_a_graph_is_its_panel(desk: Desk, tmp_path: Path) -> None:
    ball_of(desk)
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
    assert within and desk.window.theme.bodies[0] in colours
    assert "Saved" in desk.window.notice


def test_a_full_disk_is_one_plain_sentence(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(path: Path, content: bytes) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(measuring_actions, "create_file", full)
    ball_of(desk)
    tap(desk, "m")
    desk.window.deeds.append(measuring_actions.save_table(graph_of(desk)))
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


def test_no_more_points_are_drawn_than_can_be_seen(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    ball = ball_of(desk)
    tap(desk, "m")
    pause(desk)
    record, count = desk.window.measuring.record, 20_000
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


# Files


def scene_with(**entities: object) -> str:
    document = {
        "format": "physicslab-scene/1",
        "entities": [
            {"id": "ball", "Transform": {}},
            {"id": "plot", "Graph": {}},
            *({"id": name, **parts} for name, parts in entities.items()),  # type: ignore[dict-item]
        ],
    }
    return json.dumps(document)


WITH = "must be the id of an entity with a"
LINE: dict[str, object] = {"graph": "plot", "quantity": "x", "body": "ball"}
MASS: dict[str, object] = {"changes": "Mass.mass", "entity": "ball"}
REFUSED: list[tuple[str, dict[str, object], str]] = [
    ("GraphLine", LINE | {"quantity": "sped"}, '.quantity = "sped": must be one of "x"'),
    ("GraphLine", LINE | {"graph": "nothing"}, '.graph = "nothing": must be the id of an entity'),
    ("GraphLine", LINE | {"graph": "ball"}, f'.graph = "ball": {WITH} Graph'),
    ("GraphLine", LINE | {"graph": None}, ".graph = null: must be an entity with a Graph"),
    ("GraphLine", LINE | {"body": None}, '.quantity = "x": must be one of "momentum x"'),
    ("GraphLine", LINE | {"body": "plot"}, f'.body = "plot": {WITH} Transform'),
    ("GraphLine", {"graph": "plot"}, " needs quantity"),
    ("Graph", {"across": "sped"}, '.across = "sped": must be one of "time"'),
    ("Graph", {"across": "x"}, '.across = "x": must be "time", or one of'),
    ("Meter", {"quantity": "speed"}, '.quantity = "speed": must be one of'),
    ("Meter", {"quantity": "momentum", "corner": "middle"}, '.corner = "middle": must be one of "bottom'),
    ("Slider", {"changes": "gravity", "low": 3, "high": 2}, ".high = 2.0: must be a finite number > 3 m/s^2"),
    ("Slider", MASS | {"low": 1}, f'.entity = "ball": {WITH} Mass'),
    ("Slider", MASS, ".low = 0.0: must be a finite number >= 1e-300 kg, as Mass.mass is"),
    ("Slider", {"changes": "Mass.mass"}, ".entity = null: must be an entity with a Mass for Mass.mass"),
]


@pytest.mark.parametrize(("kind", "fields", "words"), REFUSED)
def test_a_bad_instrument_is_refused_in_one_line(
    kind: str, fields: dict[str, object], words: str, tmp_path: Path
) -> None:
    path = tmp_path / "bad.json"
    path.write_text(scene_with(one={kind: fields}), "utf-8")
    with pytest.raises(SceneError, match=re.escape(f'bad.json: entity "one": {kind}{words}')) as caught:
        load_scene(path)
    assert "\n" not in str(caught.value)


def test_what_refers_to_nothing_in_a_world_is_not_shown_and_not_saved(tmp_path: Path) -> None:
    world = empty_world()
    ball = circle(world, (0, 0), name="ball")
    graph = world.spawn(Graph())
    world.spawn(GraphLine(99, "x", ball))
    world.spawn(GraphLine(graph, "x", 77))
    world.spawn(Meter("speed", ball))
    desk = sized((1280, 720), world)
    desk.frames(5)
    assert [line.key for line in graph_of(desk).lines] == [(77, "x")]
    save_scene(world, tmp_path / "some.json")
    again: World = load_scene(tmp_path / "some.json")
    assert len(again.batch(Graph).entities) == len(again.batch(Meter).entities) == 1
    assert not len(again.batch(GraphLine).entities)


def test_instruments_change_no_motion() -> None:
    plain, measured = load_scene("newtons_cradle"), load_scene("newtons_cradle")
    measured.spawn(Graph())
    measured.spawn(Meter("total energy"))
    for world in (plain, measured):
        world.run(seconds=1.0)
    places = [world.table(Transform)["position"][world.batch(Transform).rows] for world in (plain, measured)]
    assert np.array_equal(places[0], places[1])
