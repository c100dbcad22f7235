"""Graphs in the window: made, undone, saved, looked into."""

from pathlib import Path

import numpy as np
import pygame
import pytest
from desk import SETTLED, Desk, click, click_at, empty_world, point, sized, tap
from plotting import CTRL, SHIFT, ball_of, drawn_lines, graph_of, in_plot, pause

from physicslab import World
from physicslab.components import Graph, GraphLine, Name, Rod, Spring, Transform
from physicslab.files.scene import load_scene, save_scene
from physicslab.history import SetField
from physicslab.prefabs import circle
from physicslab.theme import DARK, THEMES, Theme, contrast
from physicslab.view.controls import actions, dashboard_actions, file_actions
from physicslab.view.window.dashboard import GraphShown, LineShown
from physicslab.view.workbench.graph_readings import colours_of


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Desk:
    monkeypatch.chdir(tmp_path)
    return sized((1280, 720), empty_world(gravity=(0, 0)))


# Making, undoing, keeping


def test_m_plots_what_is_selected_and_it_is_written_as_a_table(desk: Desk, tmp_path: Path) -> None:
    ball = ball_of(desk)
    tap(desk, "m")
    desk.frames(31)
    record = desk.window.dashboard.record
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


def test_m_over_a_body_plots_it_where_nothing_is_selected(desk: Desk) -> None:
    """It took two acts, and in a window whose graph is there one elsewhere."""
    ball = ball_of(desk)
    desk.window.selection.clear()
    pause(desk)
    desk.move(*desk.world.component(ball, Transform).position)
    tap(desk, "m")
    assert [line.key for line in graph_of(desk).lines] == [(ball, "x"), (ball, "y"), (ball, "speed")]


def test_a_graph_is_taken_back_and_put_back_with_its_samples(desk: Desk) -> None:
    ball = ball_of(desk)
    pause(desk)
    tap(desk, "m")
    assert "Graph 1: ball" in desk.ui.words
    tap(desk, "z", CTRL)
    assert not desk.window.dashboard.graphs and "Graph 1: ball" not in desk.ui.words
    tap(desk, "y", CTRL)
    assert [line.key[0] for line in graph_of(desk).lines] == [ball] * 3
    assert desk.window.edits.history.entries[-1].words == "plotted ball"


def test_closing_a_graph_is_an_edit_that_takes_its_lines_with_it(desk: Desk) -> None:
    ball_of(desk)
    tap(desk, "m")
    desk.window.do_next(dashboard_actions.close_graph, graph_of(desk))
    desk.frames(2)
    assert not desk.world.batch(Graph).entities.size and not desk.world.batch(GraphLine).entities.size
    pause(desk)
    while desk.window.dashboard.graphs == ():
        tap(desk, "z", CTRL)
    assert len(graph_of(desk).lines) == 3


def test_a_saved_scene_opens_with_its_panels(desk: Desk, tmp_path: Path) -> None:
    ball_of(desk)
    for key, held in (("m", 0), ("m", SHIFT), ("m", CTRL), ("m", CTRL | SHIFT)):
        tap(desk, key, held)
    assert len(desk.window.dashboard.graphs) == 2 and "Slider 1" in desk.ui.places
    path = tmp_path / "with-graphs.json"
    save_scene(desk.world, path)
    file_actions.open_scene(desk.window, path)
    desk.frames(SETTLED)
    ball = desk.world.entity("ball")
    graphs = desk.window.dashboard.graphs
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


def test_the_force_of_a_joint_and_of_a_spring_is_plotted_from_the_first_step() -> None:
    """A bob of 2 kg at rest on a rod, and one on a spring, each pulled by its weight of 20 N."""
    world = empty_world(gravity=(0.0, -10.0))
    bobs = [circle(world, (x, 0.0), mass=2.0) for x in (-1.0, 1.0)]
    rod = world.spawn(Rod(b=bobs[0], anchor_a=(-1.0, 2.0)), Name("rod"))
    spring = world.spawn(
        Spring(bobs[1], None, anchor_b=(1.0, 2.0), rest_length=1.5, stiffness=40.0), Name("spring")
    )
    desk = sized((1280, 720), world)
    desk.frames(30)
    pause(desk)
    desk.window.selection.take(rod)
    desk.window.selection.take(spring, add=True)
    tap(desk, "m")
    desk.frames(SETTLED)
    while desk.window.dashboard.past is not None:  # it is filled for some ms a frame
        desk.frames()
    graph, record = graph_of(desk), desk.window.dashboard.record
    assert [line.key for line in graph.lines] == [(rod, "joint force"), (spring, "spring force")]
    for line in graph.lines:
        values = record.values(line.key)
        assert len(values) > 20 and np.allclose(values, 20.0, atol=1e-6), "the past too"
    assert {"rod: joint force", "spring: spring force"} <= set(desk.ui.words)
    click(desk, "Lines of graph 1")
    click(desk, "rod")
    click(desk, "joint torque [N m]")
    assert (rod, "joint torque") in graph_of(desk).keys


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
    record, bob = desk.window.dashboard.record, desk.world.entity("bob")
    shown = ~np.isnan(record.values((bob, "velocity x")))
    assert len(x) > 150 and np.array_equal(v, record.values((bob, "velocity x"))[shown][: len(v)])
    assert np.array_equal(x, record.values((bob, "x"))[shown][: len(x)]) and (np.diff(x) < 0).any()


# Time


def test_nothing_is_recorded_again_in_the_past_and_later_samples_stay_until_then(desk: Desk) -> None:
    ball = ball_of(desk)
    tap(desk, "m")
    desk.frames(20)
    before = desk.window.dashboard.record.times.copy()
    actions.seek(desk.world, desk.window, desk.window.edits.history.step_count - 8)
    desk.frames(3)
    assert np.array_equal(desk.window.dashboard.record.times, before)
    desk.window.edits.do(SetField(ball, "Velocity", "linear", (1.0, 0.0)))
    desk.window.pace.paused = False
    desk.frames(3)
    times = desk.window.dashboard.record.times
    assert times[-1] < before[-1] and (np.diff(times) > 0).all()


def test_a_graph_stays_while_the_time_before_it_is_looked_at(desk: Desk) -> None:
    ball_of(desk)
    desk.frames(20)
    tap(desk, "m")
    desk.frames(10)
    actions.seek(desk.world, desk.window, desk.window.edits.history.step_count - 20)
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
    a, b = desk.window.dashboard.marks
    assert a is not None and b is None and "Shift-click: B" in desk.ui.words
    pygame.key.set_mods(SHIFT)
    try:
        desk.frames(30)  # or the two would be a double click
        click_at(desk, in_plot(desk, 0.75))
    finally:
        pygame.key.set_mods(0)
    a, b = desk.window.dashboard.marks
    assert a is not None and b is not None and b > a
    words = " / ".join(desk.ui.words)
    assert "slope 2.000 m/s, area" in words and "slope 0 m/s², area" in words
    x = desk.window.dashboard.record.values((graph_of(desk).lines[0].key[0], "x"))
    times = desk.window.dashboard.record.times
    between = (times >= a - 1e-9) & (times <= b + 1e-9)
    area = np.trapezoid(x[between], times[between])
    assert f"area {area:.4f} m s" in words or f"area {area:.3f} m s" in words
    assert f"mark at {a:.3f} s" in words and f"mark at {b:.3f} s" in words
    click(desk, "Clear cursors in graph 1")
    assert desk.window.dashboard.marks == [None, None]


def test_the_moment_under_the_cursor_is_that_of_every_graph_and_of_the_time_line(desk: Desk) -> None:
    ball_of(desk)
    tap(desk, "m")
    desk.window.selection.clear()
    tap(desk, "m")
    desk.frames(60)
    pause(desk)
    point(desk, in_plot(desk, 0.5, number=2))
    desk.frames(SETTLED)
    pointed = desk.window.dashboard.pointed
    assert pointed is not None and 0.1 < pointed < desk.world.time - 0.1
    assert desk.ui.words.count(f"t {pointed:.3f} s") == 2 and f"mark at {pointed:.3f} s" in desk.ui.words
    point(desk, (300, 300))
    desk.frames(SETTLED)
    assert desk.window.dashboard.pointed is None


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
    mark = desk.window.dashboard.marks[0]
    assert mark is not None and desk.world.time == pytest.approx(mark)
    assert desk.window.edits.history.step_count < desk.window.edits.history.steps_range[1]
    actions.seek(desk.world, desk.window, 10**9)
    desk.frames(SETTLED)
    assert desk.world.time > mark
    click(desk, "Go to A in graph 1")
    assert desk.world.time == pytest.approx(mark)


def test_axes_follow_until_they_are_moved_by_hand(desk: Desk) -> None:
    ball_of(desk)
    tap(desk, "m")
    desk.frames(30)
    point(desk, in_plot(desk, 0.5))
    assert not desk.window.dashboard.free_axes
    pygame.event.post(pygame.Event(pygame.MOUSEWHEEL, x=0, y=1, precise_x=0.0, precise_y=1.0))
    desk.frames(SETTLED)
    assert desk.window.dashboard.free_axes == {graph_of(desk).entity}
    click(desk, "Follow graph 1")
    assert not desk.window.dashboard.free_axes


# Bodies that are gone, and other runs


def test_the_line_of_a_removed_body_stays_and_says_so(desk: Desk, tmp_path: Path) -> None:
    ball = ball_of(desk)
    tap(desk, "m")
    tap(desk, "m", CTRL)
    desk.frames(20)
    desk.window.selection.take(ball)
    tap(desk, "delete")
    desk.frames(20)
    record = desk.window.dashboard.record
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
        before = desk.window.dashboard.record
        tap(desk, "r", CTRL)
        desk.frames(10)
        assert len(desk.world.batch(Graph).entities) == own + 1
        bob = desk.world.entity("bob")
        ghost = desk.window.dashboard.before.values((bob, "x"))
        assert len(ghost) == len(before) and desk.window.dashboard.record is not before
        assert "x before" in desk.ui.words
        desk.frames(20)


def test_another_scene_has_no_graph_of_the_last_one(desk: Desk) -> None:
    ball_of(desk)
    tap(desk, "m")
    file_actions.open_scene(desk.window, "drop")
    desk.frames(SETTLED)
    assert not desk.window.dashboard.graphs and not len(desk.window.dashboard.before)


@pytest.mark.parametrize("name", ["a##b", "###", "x%sy", "\U0001f600 ball", "very " * 30 + "long"])
def test_any_name_can_be_plotted(desk: Desk, name: str) -> None:
    ball = ball_of(desk, name)
    for key, held in (("m", 0), ("m", SHIFT), ("m", CTRL), ("m", CTRL | SHIFT)):
        tap(desk, key, held)
    click(desk, "Lines of graph 1")
    desk.frames(10)
    assert (ball, "speed") in desk.window.dashboard.graphs[0].keys
    assert desk.window.dashboard.record.times.size > 5


def test_a_graph_knows_what_was_before_it_and_every_step_of_it() -> None:
    desk = Desk(load_scene("drop"))
    desk.window.pace.chosen = 4.0
    desk.frames(40)
    ball = desk.world.entity("ball")
    desk.window.selection.take(ball)
    tap(desk, "m")
    desk.frames(60)
    history, record = desk.sandbox.history, desk.window.dashboard.record
    assert desk.window.dashboard.past is None
    assert record.steps.tolist() == list(range(1, history.step_count + 1)), (
        "one sample a step, from the first"
    )
    height = record.values((ball, "y"))
    for step in (1, 77, history.step_count):
        history.seek(step)
        assert height[step - 1] == desk.world.component(ball, Transform).position.y


def test_the_only_moment_of_a_run_is_a_point(desk: Desk) -> None:
    pause(desk)
    ball_of(desk)
    tap(desk, "m")
    desk.frames(SETTLED)
    assert len(desk.window.dashboard.record.times) == 1
    *_, uppermost = colours_of(desk.world, desk.window.theme, graph_of(desk))
    left, top, width, height = desk.ui.places["Plot of graph 1"]
    pixels = pygame.surfarray.array3d(desk.window.canvas.surface)  # type: ignore[attr-defined]
    plot = pixels[left : left + width, top : top + height].astype(int)
    near = np.abs(plot - np.array(uppermost)).max(axis=2) < 40
    assert 20 < np.count_nonzero(near) < 400


def test_a_line_has_the_colour_of_its_body_and_the_next_of_the_same_a_tint() -> None:
    one, two = (LineShown(20 + n, (body, "speed")) for n, body in enumerate((5, 9)))
    graph = GraphShown(1, 1, None, "right", (two, one, LineShown(23, (9, "x"))))
    colours = colours_of(World(), DARK, graph)
    assert colours[:2] == [DARK.body(9), DARK.body(5)]
    assert colours[2] not in DARK.bodies and len(set(colours)) == 3


@pytest.mark.parametrize("theme", THEMES, ids=lambda theme: theme.name)
def test_three_lines_of_a_body_are_told_apart(theme: Theme) -> None:
    for body in range(len(theme.bodies)):
        lines = tuple(LineShown(20 + n, (body, name)) for n, name in enumerate(("x", "y", "speed")))
        own, pale, dim = colours_of(World(), theme, GraphShown(1, 1, None, "right", lines))
        assert contrast(dim, own) > 1.7 and contrast(dim, pale) > 2.0
        assert contrast(dim, theme.panel) > 3.0 and own != pale
