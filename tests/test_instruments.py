"""Instruments in the window: placed, clicked, dragged, written, removed, undone, saved."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pygame
import pytest
from desk import SETTLED, Desk, choose, click, click_at, empty_world, fill, point, sized, tap
from hypothesis import given, settings
from hypothesis import strategies as st

from physicslab.components import Gate, Note, Protractor, Ruler, Strobe, Transform
from physicslab.diagnostics.stopwatch import laps
from physicslab.ecs.vector import Vector2
from physicslab.files.scene import load_scene, save_scene
from physicslab.history import History
from physicslab.prefabs import box, circle, pendulum
from physicslab.state.attached import INSTRUMENTS, place_of
from physicslab.systems.gate import Crossing
from physicslab.theme import THEMES
from physicslab.view.canvas.canvas import Rect
from physicslab.view.controls.measuring import MEASURING_TOOLS
from physicslab.view.overlay.instruments import angle_between, instrument_of
from physicslab.view.workbench.instrument_panels import arrow_of, crossing_rows
from physicslab.world import World

CTRL = pygame.KMOD_CTRL


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Desk]:
    monkeypatch.chdir(tmp_path)
    desk = Desk(empty_world(gravity=(0, 0)))
    desk.frames(SETTLED)
    desk.window.pace.paused = True
    yield desk


def drag(desk: Desk, *places: tuple[float, float]) -> None:
    """Press at the first place, move along the others and let go at the last."""
    desk.move(*places[0])
    desk.press(*places[0])
    desk.frames(2)
    for place in places[1:]:
        desk.move(*place)
        desk.frames(2)
    desk.release(*places[-1])
    desk.frames(SETTLED)


def tap_at(desk: Desk, x: float, y: float) -> None:
    click_at(desk, desk.pixel(x, y))


def only(desk: Desk, kind: type[Any]) -> int:
    (entity,) = desk.world.batch(kind).entities
    return int(entity)


def near(place: Vector2, x: float, y: float, within: float = 0.006) -> bool:
    return math.hypot(place.x - x, place.y - y) <= within


# ---- placing -----------------------------------------------------------------------------------------------


def test_a_ruler_is_dragged_and_undone(desk: Desk) -> None:
    click(desk, "Ruler")
    drag(desk, (-1.0, 0.0), (0.5, 1.0), (2.0, 1.5))
    ruler = only(desk, Ruler)
    part = desk.world.component(ruler, Ruler)
    assert near(part.start, -1.0, 0.0) and near(part.end, 2.0, 1.5)
    assert desk.window.selection.entities == (ruler,)
    assert desk.ui.rows["Length"].startswith("3.35") and desk.ui.rows["From the right"].startswith("26.5")
    assert (
        desk.world.label(ruler) == "ruler 1"
        and desk.window.edits.history.entries[-1].words == "made a ruler, ruler 1"
    )
    tap(desk, "z", CTRL)
    assert not desk.world.entities()
    tap(desk, "y", CTRL)
    assert only(desk, Ruler) == ruler


def test_a_ruler_is_also_made_by_two_clicks(desk: Desk) -> None:
    click(desk, "Ruler")
    tap_at(desk, 0.0, 0.0)
    assert not desk.world.entities() and len(desk.window.measuring.spots) == 1
    tap_at(desk, 0.0, 1.0)
    assert near(desk.world.component(only(desk, Ruler), Ruler).end, 0.0, 1.0)


def test_an_angle_is_dragged_along_one_arm_and_clicked_for_the_other(desk: Desk) -> None:
    click(desk, "Angle")
    drag(desk, (0.0, 0.0), (1.0, 0.0), (2.0, 0.0))
    desk.move(1.0, 1.0)
    desk.frames(2)
    assert not desk.world.entities()
    tap_at(desk, 1.0, 1.0)
    assert float(desk.ui.rows["Angle"][:-1]) == pytest.approx(45.0, abs=0.5)
    assert near(desk.world.component(only(desk, Protractor), Protractor).second, 1.0, 1.0)


def test_an_arm_goes_along_a_slope_and_level_where_it_nearly_does(desk: Desk) -> None:
    slope = box(desk.world, (0, 0), width=4, height=0.3, angle=math.radians(21.3), static=True)
    begin(desk)
    corner = desk.world.component(slope, Transform).position + Vector2(-1.8, 0.15).rotated(math.radians(21.3))
    level, along = corner + Vector2(2.0, 0.02), corner + Vector2.from_angle(math.radians(22.0), 2.5)
    click(desk, "Angle")
    for place in (corner, level, along):
        tap_at(desk, place.x, place.y)
    assert desk.ui.rows["Angle"] == "21.30°"
    tap(desk, "z", CTRL)
    off = corner + Vector2.from_angle(math.radians(30.0), 2.5)
    for place in (corner, level, off):
        tap_at(desk, place.x, place.y)
    assert float(desk.ui.rows["Angle"][:-1]) == pytest.approx(30.0, abs=0.4)


@pytest.mark.parametrize("begun", [1, 2])
def test_escape_forgets_what_was_begun(desk: Desk, begun: int) -> None:
    click(desk, "Angle")
    for x in range(begun):
        tap_at(desk, float(x), 0.0)
    tap(desk, "escape")
    assert desk.window.measuring.spots == [] and desk.window.tool == "protractor"
    tap_at(desk, 1.0, 1.0)
    assert len(desk.window.measuring.spots) == 1


def test_shift_gives_round_angles(desk: Desk) -> None:
    click(desk, "Ruler")
    tap_at(desk, 0.0, 0.0)
    pygame.key.set_mods(pygame.KMOD_SHIFT)
    try:
        tap_at(desk, 1.0, 0.95)
    finally:
        pygame.key.set_mods(0)
    end = desk.world.component(only(desk, Ruler), Ruler).end
    assert math.degrees(end.angle) == pytest.approx(45.0, abs=1e-9)


def test_a_newcomer_sees_what_to_do_beside_the_cursor() -> None:
    for tool in MEASURING_TOOLS:
        assert tool.prompts and all(len(words) < 40 for words in tool.prompts)
    with_prompt, without = (pictured(tool) for tool in ("gate", "select"))
    assert not np.array_equal(with_prompt, without)


def test_what_to_do_is_written_within_the_room(monkeypatch: pytest.MonkeyPatch) -> None:
    desk = sized((800, 600), empty_world(gravity=(0, 0)), 1.75)
    desk.window.figures, desk.window.tool = False, "gate"
    desk.frames(SETTLED)
    seen: list[pygame.Rect] = []
    panel = desk.window.canvas.panel

    def noted(rect: Rect, *rest: Any) -> None:
        seen.append(pygame.Rect(rect))
        panel(rect, *rest)

    monkeypatch.setattr(desk.window.canvas, "panel", noted)
    left, top, width, height = desk.window.framing.room()
    for place in ((left + 2, top + 2), (left + width - 3, top + 2), (left + width - 3, top + height - 3)):
        point(desk, place)
        seen.clear()
        desk.frames()
        words = max(seen, key=lambda rect: rect.width)
        assert pygame.Rect(left, top, width, height).contains(words) and words.width > 200


def test_what_to_do_is_not_written_once_the_cursor_left_the_window() -> None:
    """It stayed at the edge, over the scale."""
    left_alone, left = pictured("select"), pictured("gate", leaves=True)
    assert np.array_equal(left_alone, left)


def pictured(tool: str, *, leaves: bool = False) -> np.ndarray:
    desk = Desk(empty_world(gravity=(0, 0)))
    desk.window.pace.paused, desk.window.tool = True, tool
    desk.move(0.0, 0.0)
    if leaves:
        pygame.event.post(pygame.Event(pygame.WINDOWLEAVE))
    desk.frames(3)
    left, top = desk.pixel(0.0, 0.0)
    surface = pygame.display.get_surface()
    assert surface is not None
    return pygame.surfarray.array3d(surface.subsurface(pygame.Rect(left, top - 60, 260, 60)))


@pytest.mark.parametrize("tool", MEASURING_TOOLS[:3])
def test_by_keys_alone(desk: Desk, tool: Any) -> None:
    """The key takes the tool, and once more puts one into the middle; arrows move it, Del removes it."""
    key = {"ruler": "d", "protractor": "y", "gate": "j"}[tool.name]
    tap(desk, key)
    assert desk.window.tool == tool.name and not desk.world.entities()
    tap(desk, key)
    (entity,) = desk.window.selection.entities
    one = instrument_of(desk.world, entity)
    assert one is not None
    for place in one.points.values():
        across, down = desk.window.camera.to_screen(place)
        left, top, width, height = desk.window.framing.room()
        assert left < across < left + width and top < down < top + height
    name = one.kind.POINTS[0]
    tap(desk, "right")
    assert place_of(desk.world, entity, one.kind, name).x == pytest.approx(one.points[name].x + 0.01)
    tap(desk, "delete")
    assert not desk.world.entities()


def test_between_two_bodies_that_are_selected(desk: Desk) -> None:
    one, two = circle(desk.world, (0, 0), radius=0.1), circle(desk.world, (3, 4), radius=0.1)
    desk.window.selection.entities = (one, two)
    tap(desk, "d")
    part = desk.world.component(only(desk, Ruler), Ruler)
    assert (part.start_body, part.end_body) == (one, two)
    assert desk.ui.rows["Length"] == "5.000 m" and desk.ui.rows["End attached to"] == f"circle {two}"
    desk.world.component(two, Transform).position = (0.0, 2.0)
    desk.window.pace.paused = False
    desk.frames(20)
    assert desk.ui.rows["Length"] == "2.000 m"


def test_an_end_in_the_middle_of_a_body_goes_with_it_and_stays_when_that_is_removed(desk: Desk) -> None:
    ball = circle(desk.world, (1, 1), radius=0.3, velocity=(0.0, 0.0))
    begin(desk)
    click(desk, "Ruler")
    drag(desk, (-1.0, 1.0), (0.5, 1.0), (1.04, 1.03))
    ruler = only(desk, Ruler)
    part = desk.world.component(ruler, Ruler)
    assert part.end_body == ball and part.end == Vector2(0.0, 0.0) and part.start_body is None
    desk.window.selection.entities = (ball,)
    tap(desk, "delete")
    part = desk.world.component(ruler, Ruler)
    assert part.end_body is None and part.end == Vector2(1.0, 1.0)
    tap(desk, "z", CTRL)
    assert desk.world.component(ruler, Ruler).end_body == ball


def test_a_body_that_goes_while_a_ruler_is_drawn_from_it(desk: Desk) -> None:
    tap_at(desk, 0.0, 0.0)  # a circle, which undo takes back
    (ball,) = desk.world.entities()
    click(desk, "Ruler")
    tap_at(desk, 0.0, 0.0)
    assert desk.window.measuring.spots[0].body == ball
    desk.window.edits.history.undo()
    tap_at(desk, 1.0, 0.0)
    part = desk.world.component(only(desk, Ruler), Ruler)
    assert part.start_body is None and near(part.start, 0.0, 0.0)


# ---- what is there -----------------------------------------------------------------------------------------


def placed(desk: Desk, *parts: Any) -> list[int]:
    made = [desk.world.spawn(part, name=f"instrument {n}") for n, part in enumerate(parts)]
    begin(desk)
    return made


def begin(desk: Desk) -> None:
    """Let history begin with what is there now."""
    desk.sandbox.history = History(desk.world)
    desk.window.follow_history(desk.sandbox.history)
    desk.frames(SETTLED)


@pytest.mark.parametrize("paused", [True, False])
def test_an_end_is_dragged_as_one_edit_also_while_time_runs(desk: Desk, paused: bool) -> None:
    (ruler,) = placed(desk, Ruler((0, 0), (2, 0)))
    click(desk, "Select")
    tap_at(desk, 1.0, 0.0)
    assert desk.window.selection.entities == (ruler,)
    desk.window.pace.paused = paused
    before = len(desk.window.edits.history.entries)
    drag(desk, (2.0, 0.0), (1.5, 1.0), (1.0, 1.0))
    part = desk.world.component(ruler, Ruler)
    assert near(part.end, 1.0, 1.0) and part.start == Vector2()
    edits = [one.words for one in desk.window.edits.history.entries[before:] if not one.steps]
    assert edits == ["moved instrument 0"]


def test_a_click_moves_nothing(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0), radius=0.2)
    (ruler,) = placed(desk, Ruler((0, 0), (2, 0), start_body=ball))
    desk.window.selection.entities = (ruler,)
    desk.frames(2)
    before = len(desk.window.edits.history.entries)
    tap_at(desk, 0.03, 0.02)
    assert len(desk.window.edits.history.entries) == before


def test_the_whole_is_dragged_by_its_line_and_notes_by_their_words(desk: Desk) -> None:
    ruler, note = placed(desk, Ruler((-1, -1), (1, -1)), Note("A note to be dragged", (0, 1)))
    click(desk, "Select")
    drag(desk, (0.3, -1.0), (0.4, -0.7), (0.8, -0.5))
    part = desk.world.component(ruler, Ruler)
    assert near(part.start, -0.5, -0.5, 0.02) and near(part.end, 1.5, -0.5, 0.02)
    drag(desk, (0.3, 0.9), (0.5, 0.6), (1.3, 0.4))
    assert near(desk.world.component(note, Note).place, 1.0, 0.5, 0.02)
    tap(desk, "z", CTRL)
    assert desk.world.component(note, Note).place == Vector2(0, 1)


def test_a_body_that_moves_is_taken_before_a_ruler_and_a_ruler_before_a_floor(desk: Desk) -> None:
    ball = circle(desk.world, (0, 1), radius=0.3)
    box(desk.world, (0, -1), width=6, height=1, static=True)
    ruler, other = placed(desk, Ruler((-2, 1), (2, 1)), Ruler((-2, -1), (2, -1)))
    click(desk, "Select")
    for y, entity in ((1.0, ball), (-1.0, other)):
        tap_at(desk, 0.1, y)
        assert desk.window.selection.entities == (entity,)
    tap_at(desk, 1.5, 1.0)
    assert desk.window.selection.entities == (ruler,)


def test_with_the_circle_in_hand_a_click_on_a_ruler_makes_no_circle(desk: Desk) -> None:
    (ruler,) = placed(desk, Ruler((-2, 0), (2, 0)))
    tap_at(desk, 0.5, 0.0)
    assert desk.world.entities() == [ruler] and desk.window.selection.entities == (ruler,)
    tap_at(desk, 0.5, 1.0)
    assert len(desk.world.entities()) == 2


def test_erase_and_next_and_the_inspector(desk: Desk) -> None:
    floor = box(desk.world, (-3, 0), width=1, height=0.2, static=True)
    ball = circle(desk.world, (-3, 2), radius=0.2)
    ruler, gate = placed(desk, Ruler((-2, 0), (2, 0)), Gate((-2, -1), (2, -1)))
    for expected in (ball, floor, ruler, gate):
        tap(desk, "n")
        assert desk.window.selection.entities == (expected,)
    assert "gate" in desk.ui.words and "Can move" not in desk.ui.words
    click(desk, "Erase")
    tap_at(desk, 0.5, 0.0)
    assert desk.world.entities() == [floor, ball, gate]


# ---- notes -------------------------------------------------------------------------------------------------


def typed(desk: Desk, text: str) -> None:
    pygame.event.post(pygame.Event(pygame.TEXTINPUT, text=text))
    desk.frames(SETTLED)


def test_a_note_is_written_where_it_stands(desk: Desk) -> None:
    click(desk, "Note")
    tap_at(desk, 0.5, 0.5)
    typed(desk, "Let go here")
    assert not desk.world.entities()
    tap(desk, "return")
    part = desk.world.component(only(desk, Note), Note)
    assert part.text == "Let go here" and near(part.place, 0.5, 0.5)
    assert desk.window.measuring.writing is None
    tap(desk, "z", CTRL)
    assert not desk.world.entities()


def test_no_word_of_a_note_is_under_a_panel(desk: Desk) -> None:
    left, top, width, height = desk.window.framing.room()
    corner = left + width - 20.0, top + height - 10.0
    (note,) = placed(desk, Note("It is written beside its place", desk.window.camera.to_world(corner)))
    desk.frames(SETTLED)
    rect = desk.window.measuring.rects[note]
    assert pygame.Rect(left, top, width, height).contains(rect) and rect[2] > 100
    desk.window.camera.centre += Vector2(-20, 0)
    desk.frames(SETTLED)
    assert desk.window.measuring.rects[note][0] > left + width, "out of sight it stays there"


def test_keys_written_into_a_note_are_no_commands(desk: Desk) -> None:
    circle(desk.world, (-2, 0), radius=0.1)
    tap(desk, "w")
    tap_at(desk, 0.5, 0.5)
    desk.frames(SETTLED)
    tap(desk, "r")  # which clears everything elsewhere
    assert len(desk.world.entities()) == 1 and desk.window.measuring.writing is not None


def test_escape_drops_a_note_and_a_click_elsewhere_keeps_it(desk: Desk) -> None:
    click(desk, "Note")
    tap_at(desk, 0.5, 0.5)
    typed(desk, "not this one")
    tap(desk, "escape")
    assert not desk.world.entities() and not is_writing(desk)
    tap_at(desk, 0.5, 0.5)
    typed(desk, "but this one")
    tap_at(desk, -2.0, -2.0)
    assert desk.world.component(only(desk, Note), Note).text == "but this one" and not is_writing(desk)
    tap_at(desk, -2.0, -2.0)
    assert is_writing(desk)
    tap(desk, "escape")
    assert len(desk.world.entities()) == 1


def is_writing(desk: Desk) -> bool:
    return desk.window.measuring.writing is not None


def test_a_note_that_is_there_is_written_again(desk: Desk) -> None:
    (note,) = placed(desk, Note("one", (0, 0)))
    click(desk, "Note")
    for text, count in (("two", 1), ("", 0)):
        tap_at(desk, 0.05, -0.05)
        tap(desk, "a", CTRL)
        desk.key_up("left ctrl")
        if text:
            typed(desk, text)
        else:
            tap(desk, "delete")
        tap(desk, "return")
        assert len(desk.world.entities()) == count
        if count:
            assert desk.world.component(note, Note).text == text


def test_a_note_too_long_is_refused_where_it_is_written(desk: Desk) -> None:
    click(desk, "Note")
    tap_at(desk, 0.0, 0.5)
    typed(desk, "x" * 401)
    tap(desk, "return")
    assert not desk.world.entities()
    assert any(words.startswith("must be a text of at most 8 lines") for words in desk.ui.words)
    assert desk.window.measuring.writing is not None and len(desk.window.measuring.writing.text) == 401


# ---- saved and loaded --------------------------------------------------------------------------------------


def test_all_of_it_is_saved_with_the_scene(desk: Desk, tmp_path: Path) -> None:
    ball = circle(desk.world, (1, 1), radius=0.1, name="ball")
    desk.world.add(ball, Strobe(0.25, 7))
    placed(
        desk, Ruler((0, 0), (0.1, 0), end_body=ball), Protractor((0, 0), (1, 0), (0, 0), second_body=ball),
        Gate((0, -1), (0, 1)), Note("one\ntwo", (2, 2), place_body=ball),
    )  # fmt: skip
    save_scene(desk.world, tmp_path / "all.json")
    again = load_scene(tmp_path / "all.json")
    for kind in (*INSTRUMENTS, Strobe):
        (one,), (two,) = desk.world.batch(kind).entities.tolist(), again.batch(kind).entities.tolist()
        assert desk.world.label(one) == again.label(two)
        assert repr(desk.world.component(one, kind).given()) == repr(again.component(two, kind).given())


finite = st.floats(-1e6, 1e6)
pairs = st.tuples(finite, finite)


@given(pairs, pairs, pairs, finite, pairs)
@settings(deadline=None, max_examples=50)
def test_points_on_a_body_turn_and_move_with_it(
    point: tuple[float, float], place: tuple[float, float], other: tuple[float, float], angle: float,
    end: tuple[float, float],
) -> None:  # fmt: skip
    world = World()
    body = world.spawn(Transform(place, angle))
    ruler = world.spawn(Ruler(point, end, start_body=body))
    expected = Vector2(*place) + Vector2(*point).rotated(angle)
    found = place_of(world, ruler, Ruler, "start")
    assert (found - expected).magnitude <= 1e-9 * (1.0 + expected.magnitude)
    assert place_of(world, ruler, Ruler, "end") == Vector2(*end)


@given(
    st.floats(0.0, 2 * math.pi), st.floats(-math.pi, math.pi), st.floats(0.01, 100.0), st.floats(0.01, 100.0)
)
def test_the_angle_does_not_depend_on_the_arms_or_on_how_it_lies(
    turn: float, angle: float, one: float, two: float
) -> None:
    points = {
        "vertex": Vector2(3.0, -2.0),
        "first": Vector2(3.0, -2.0) + Vector2.from_angle(turn, one),
        "second": Vector2(3.0, -2.0) + Vector2.from_angle(turn + angle, two),
    }
    assert angle_between(points) == pytest.approx(math.degrees(abs(angle)), abs=1e-6)


# ---- stopwatch ---------------------------------------------------------------------------------------------


def test_the_stopwatch_reads_the_period_of_a_pendulum(desk: Desk, tmp_path: Path) -> None:
    desk.window.pace.paused = False
    pendulum(desk.world, (0, 1), length=1.0, angle=0.3)
    begin(desk)
    tap(desk, "g")
    click(desk, "Gate")
    drag(desk, (0.0, -0.6), (0.0, 0.3), (0.0, 0.5))
    assert desk.window.shows_stopwatch and "Stopwatch" in desk.ui.words
    desk.frames(60 * 5)
    shown = next(words for words in desk.ui.words if words.startswith("2.0") and words.endswith(" s"))
    assert float(shown[:-2]) == pytest.approx(2.018, abs=0.006)
    assert "Period of circle" in " ".join(desk.ui.words)
    desk.window.pace.paused = True
    click(desk, "CSV of crossings")
    desk.frames(2)
    (path,) = tmp_path.glob("*.csv")
    head, *rows = path.read_text("utf-8").splitlines()
    assert head == "time [s],gate,body,direction,speed [m/s],since [s]"
    assert [head, *rows] == [",".join(map(str, row)) for row in crossing_rows(desk.world)] and len(rows) >= 4
    assert float(rows[2].split(",")[-1]) == pytest.approx(2.018, abs=0.006)


def test_laps_between_gates_and_periods_at_one() -> None:
    def crossing(time: float, gate: int, body: int = 9, direction: int = 1) -> Crossing:
        return Crossing(time, gate, body, direction, 1.0)

    swing = [crossing(t, 1, 9, 1 if n % 2 else -1) for n, t in enumerate((0.5, 1.5, 2.5, 3.5, 4.75))]
    assert [lap.seconds for lap in laps(swing, 1)] == [None, None, 2.0, 2.0, 2.25]
    race = [crossing(1.0, 1), crossing(1.1, 1, 8), crossing(1.5, 2), crossing(2.0, 2, 8), crossing(2.5, 2)]
    assert [lap.seconds for lap in laps(race, 2)] == pytest.approx([None, None, 0.5, 0.9, None])


def test_the_arrow_points_to_where_it_came_out(desk: Desk) -> None:
    gates = placed(desk, Gate((0, 0), (0, 1)), Gate((0, 0), (1, 0)), Gate((0, 0), (1, 1)))
    assert [arrow_of(desk.world, gate, 1) for gate in gates] == ["←", "↑", "↖"]
    assert [arrow_of(desk.world, gate, -1) for gate in gates] == ["→", "↓", "↘"]


# ---- strobe ------------------------------------------------------------------------------------------------


def test_strobe_of_all_that_moves_and_of_one(desk: Desk) -> None:
    balls = [circle(desk.world, (x, 0), radius=0.2, velocity=(1, 0)) for x in (-2, 0)]
    box(desk.world, (0, -2), width=4, height=0.2, static=True)
    begin(desk)
    choose(desk, "Instruments", "Strobe of all that moves")
    assert desk.world.batch(Strobe).entities.tolist() == balls
    tap(desk, "x")
    assert not len(desk.world.batch(Strobe))
    tap(desk, "z", CTRL)
    desk.key_up("left ctrl")
    assert desk.world.batch(Strobe).entities.tolist() == balls
    desk.window.selection.entities = (balls[0],)
    desk.frames(SETTLED)
    click(desk, "Strobe pictures")
    assert desk.world.batch(Strobe).entities.tolist() == balls[1:]


def test_how_many_pictures_are_kept_is_written_in_the_inspector(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0), radius=0.2, velocity=(1, 0))
    desk.world.add(ball, Strobe())
    begin(desk)
    desk.window.selection.entities = (ball,)
    desk.frames(SETTLED)
    for text, count in (("12", 12), ("12.5", 12), ("201", 12), ("4e1", 40)):
        fill(desk, "Strobe.count", text)
        assert desk.world.component(ball, Strobe).count == count


def test_copies_are_faint_and_in_the_picture_that_is_saved() -> None:
    for theme in THEMES:
        world = empty_world(gravity=(0, 0))
        ball = circle(world, (-1, 0), radius=0.2, velocity=(2, 0))
        world.add(ball, Strobe(0.5))
        desk = Desk(world)
        desk.window.theme = theme
        desk.window.camera.look_at((0.0, 0.0, 0.0, 0.0), 60.0)
        desk.frames(61)
        surface = pygame.display.get_surface()
        assert surface is not None
        colour = np.array(theme.bodies[ball % len(theme.bodies)], float)
        background = np.array(theme.background, float)
        copy = np.array(surface.get_at(desk.pixel(-0.95, 0.1))[:3], float)
        share = (copy - background) @ (colour - background) / ((colour - background) @ (colour - background))
        assert 0.08 < share < 0.3, theme.name


# ---- labels ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("size", "scale"), [((1280, 720), 1.0), ((800, 600), 1.75)])
def test_labels_cover_neither_lines_nor_each_other(size: tuple[int, int], scale: float) -> None:
    world = empty_world(gravity=(0, 0))
    ball = circle(world, (0.5, 0.5), radius=0.2)
    rulers = [
        world.spawn(Ruler((-1.5, -1.0), (1.5, -1.0))),
        world.spawn(Ruler((-1.0, -1.5), (-1.0, 1.5))),
        world.spawn(Ruler((-1.0, -1.0), (0, 0), end_body=ball)),
    ]
    desk = sized(size, world, scale)
    desk.window.figures = False
    desk.window.pace.paused = True
    desk.frames(SETTLED)
    left, top, width, height = desk.window.framing.room()
    desk.window.camera.look_at((-2.0, -2.0, 2.0, 2.0), min(width, height) / 4.5, (left, top, width, height))
    desk.frames(SETTLED)
    rects = desk.window.measuring.rects
    assert set(rects) == set(rulers)
    for one, two in combinations(rects.values(), 2):
        assert not pygame.Rect(one).colliderect(pygame.Rect(two))
    for ruler in rulers:
        start, end = (
            desk.window.camera.to_screen(place_of(world, ruler, Ruler, n)) for n in ("start", "end")
        )
        for rect in rects.values():
            assert not pygame.Rect(rect).clipline(start, end)
    assert not _covers_body(desk, rects[rulers[2]], ball)


def _covers_body(desk: Desk, rect: Rect, body: int) -> bool:
    middle = desk.window.camera.to_screen(desk.world.component(body, Transform).position)
    return pygame.Rect(rect).inflate(4, 4).collidepoint(middle)
