"""A key or a click does what was meant: it closes, removes and undoes no more than that."""

from __future__ import annotations

import pygame
import pytest
from desk import SETTLED, Desk, click, click_at, empty_world, middle_of, point, sized, tap, write
from random_edits import state_hash

from physicslab import load_scene
from physicslab.components import Trail
from physicslab.prefabs import circle

CTRL = pygame.KMOD_CTRL


@pytest.fixture
def desk() -> Desk:
    """Return a window with a ball at rest, which is not selected."""
    world = empty_world(gravity=(0, 0))
    circle(world, (0, 0), name="ball")
    return Desk(world)


def test_escape_quits_at_the_second_press_once_something_was_closed(desk: Desk) -> None:
    for key in ("l", "n"):  # opens the gallery, selects the ball
        tap(desk, key)
        for _ in range(2):
            tap(desk, "escape")
            assert not desk.window.closing
        assert "Esc again" in desk.window.notice
    desk.frames(600)
    tap(desk, "escape")
    assert not desk.window.closing and "Esc again" in desk.window.notice
    tap(desk, "escape")
    assert desk.window.closing


def test_ctrl_q_quits_whatever_is_open(desk: Desk) -> None:
    tap(desk, "l")
    tap(desk, "q", CTRL)
    assert desk.window.closing


def test_leaving_says_what_would_be_lost(desk: Desk) -> None:
    tap(desk, "r")
    desk.window.scenes.next_world = empty_world()
    desk.frames(70)
    tap(desk, "escape")
    assert not desk.window.closing and "is lost" in desk.window.notice
    tap(desk, "escape")
    assert desk.window.closing


@pytest.mark.parametrize("opener", ["l", "f1"])
def test_no_key_acts_behind_what_lies_over_the_world(desk: Desk, opener: str) -> None:
    ball = desk.world.entity("ball")
    desk.window.selection.take(ball)
    tap(desk, opener)
    before = desk.world.motion_edits, desk.window.tool, desk.window.figures, desk.window.pace.paused
    for key in (
        "t",
        "r",
        "i",
        "a",
        "n",
        "g",
        "l" if opener == "f1" else "u",
        "e",
        "delete",
        "space",
        "return",
    ):
        tap(desk, key)
    tap(desk, "a", CTRL)
    tap(desk, "d", CTRL)
    assert before == (
        desk.world.motion_edits, desk.window.tool, desk.window.figures, desk.window.pace.paused
    )  # fmt: skip
    assert desk.world.entities() == [ball] and not desk.world.table(Trail).handles
    tap(desk, "escape" if opener == "l" else opener)  # letters are for the search of the gallery
    assert not desk.window.in_front
    tap(desk, "r")
    assert desk.world.entities() == []


def test_keys_are_for_the_world_after_a_click_in_a_window_beside_it(desk: Desk) -> None:
    tap(desk, "z")
    desk.frames(SETTLED)
    click(desk, "Only the selection")
    tap(desk, "i")
    assert not desk.window.figures
    tap(desk, "space")
    assert desk.window.pace.paused
    tap(desk, "r")
    assert desk.world.entities() == []


@pytest.mark.parametrize("paused", [False, True])
def test_one_undo_takes_back_the_last_edit_and_the_run_since(desk: Desk, *, paused: bool) -> None:
    desk.frames(10)
    before = state_hash(desk.world)
    tap(desk, "r")
    assert "one Ctrl+Z" in desk.window.notice and not desk.world.entities()
    desk.frames(20)
    if paused:
        tap(desk, "space")
    after = desk.world.time
    tap(desk, "z", CTRL)
    assert len(desk.world.entities()) == 1 and state_hash(desk.world) == before
    tap(desk, "y", CTRL)
    assert not desk.world.entities() and desk.world.time == pytest.approx(after)


def test_undo_takes_back_a_throw_and_leaves_what_was_made_before(desk: Desk) -> None:
    click_at(desk, desk.pixel(2.0, 2.0))
    desk.frames(10)
    made = desk.world.entities()
    start = desk.world.time
    desk.drag((2.0, 2.0), (4.0, 0.0), 5)
    desk.frames(10)
    tap(desk, "z", CTRL)
    assert desk.world.entities() == made and desk.world.time == pytest.approx(start, abs=0.02)
    tap(desk, "z", CTRL)
    assert len(desk.world.entities()) == 1


def test_with_no_edit_undo_takes_back_one_run_at_a_time(desk: Desk) -> None:
    desk.frames(12)
    tap(desk, "space")
    first = desk.world.time
    tap(desk, "space")
    desk.frames(24)
    tap(desk, "space")
    second = desk.world.time - first
    for back, ran in ((first, second), (0.0, first)):
        tap(desk, "z", CTRL)
        assert desk.world.time == back and f"ran {ran:.1f} s" in desk.window.notice


def test_a_run_from_a_pause_and_the_edit_before_it_are_undone_one_by_one(desk: Desk) -> None:
    tap(desk, "space")
    before, start = state_hash(desk.world), desk.world.time
    tap(desk, "r")
    tap(desk, "space")
    desk.frames(20)
    after = desk.world.time
    tap(desk, "z", CTRL)
    assert not desk.world.entities() and desk.world.time == start
    tap(desk, "z", CTRL)
    assert state_hash(desk.world) == before
    for moment in (start, after):
        tap(desk, "y", CTRL)
        assert not desk.world.entities() and desk.world.time == moment


def test_single_steps_and_the_edit_before_them_are_undone_one_by_one(desk: Desk) -> None:
    """Ctrl+Z after two single steps removed the ball, too, that was made before them."""
    tap(desk, "space")
    start = desk.world.time
    for many in (2, 3):
        click_at(desk, desk.pixel(-4.0 + 2.0 * many, 3.0))
        assert len(desk.world.entities()) == many
        tap(desk, ".")
        tap(desk, ".")
    after = desk.world.time
    for many, time in ((3, 0.5 * (start + after)), (2, 0.5 * (start + after)), (2, start), (1, start)):
        tap(desk, "z", CTRL)
        assert len(desk.world.entities()) == many and desk.world.time == pytest.approx(time)


def test_a_click_on_a_spark_opens_the_microscope_in_a_pause_alone() -> None:
    desk = sized((1280, 720), load_scene("drop"))
    while not desk.world.contacts.logged:
        desk.frames()
    desk.frames(3)
    record = desk.world.contacts.impacts[-1]
    for opens in (False, True):
        desk.press(float(record["x"]), float(record["y"]))
        desk.release(float(record["x"]), float(record["y"]))
        desk.frames(2)
        assert desk.window.microscope.is_open == opens
        desk.window.pace.paused = True


def test_keys_that_come_before_their_field_are_written_there(desk: Desk) -> None:
    """On a slow machine T and W of the title acted on the world, and were lost."""
    trails, tool = len(desk.world.batch(Trail)), desk.window.tool
    desk.window.selection.clear()
    desk.frames(SETTLED)
    place = middle_of(desk, "Title and notes")
    for kind in (pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP):
        pygame.event.post(pygame.Event(kind, button=1, pos=place, touch=False))
    for letter in "Two":
        pygame.event.post(pygame.Event(pygame.KEYDOWN, key=ord(letter.lower()), mod=0, unicode=letter))
        pygame.event.post(pygame.Event(pygame.TEXTINPUT, text=letter))
    desk.frames(12)
    tap(desk, "return")
    assert (desk.world.title, len(desk.world.batch(Trail)), desk.window.tool) == ("Two", trails, tool)
    tap(desk, "space")
    assert desk.window.pace.paused


@pytest.mark.parametrize("is_titled", [False, True])
def test_letters_right_after_the_key_that_opens_a_window_are_written_in_it(
    desk: Desk, is_titled: bool
) -> None:
    """Letters right after Ctrl+Shift+S were lost, or went on in the title that was being written."""
    desk.window.selection.clear()
    desk.frames(SETTLED)
    if is_titled:
        click(desk, "Title and notes")
        write(desk, "Carts")
    pygame.event.post(
        pygame.Event(pygame.KEYDOWN, key=pygame.K_s, mod=pygame.KMOD_CTRL | pygame.KMOD_SHIFT, unicode="")
    )
    for letter in "mine":
        pygame.event.post(pygame.Event(pygame.KEYDOWN, key=ord(letter), mod=0, unicode=letter))
        pygame.event.post(pygame.Event(pygame.TEXTINPUT, text=letter))
    desk.frames(12)
    naming = desk.window.scenes.naming
    assert naming is not None
    assert naming.text == "mine"
    assert not is_titled or desk.world.title == "Carts"


def test_the_letter_that_opens_the_gallery_is_not_written_in_its_search(desk: Desk) -> None:
    for letter in "lcarts":
        pygame.event.post(pygame.Event(pygame.KEYDOWN, key=ord(letter), mod=0, unicode=letter))
        pygame.event.post(pygame.Event(pygame.TEXTINPUT, text=letter))
    desk.frames(12)
    tap(desk, "return")
    assert desk.world.title == "Carts on a track"


def test_no_tip_stays_of_a_tool_that_was_clicked_before_a_scene_was_opened(desk: Desk) -> None:
    desk.frames(SETTLED)
    click(desk, "Circle")
    tap(desk, "l")
    write(desk, "five rest")
    tap(desk, "return")
    point(desk, desk.pixel(1.0, 1.0))
    desk.frames(60)
    assert not any("or click. Key" in words for words in desk.ui.words)
