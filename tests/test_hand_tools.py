"""Removing bodies, drawing springs with the mouse, and the help panel."""

import math

import pygame
import pytest
from desk import FRAME, Desk, bits, click_at, empty_world, tap, write
from test_hud import frame, recorded

from physicslab.components import Held, Mass, Rod, Rope, Spring, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.history import RemoveComponent
from physicslab.prefabs import box, circle, pendulum
from physicslab.view.controls.controls import CONTROLS
from physicslab.view.window.handles import arrow_of


def springs(desk: Desk) -> list[Spring]:
    world = desk.world
    return [world.component(e, Spring) for e in world.entities() if world.has(e, Spring)]


@pytest.fixture
def desk() -> Desk:
    return Desk(empty_world(gravity=(0, 0)))


@pytest.mark.parametrize("key", ["delete", "backspace"])
def test_delete_removes_the_body_under_the_cursor_and_its_springs(desk: Desk, key: str) -> None:
    ball, other = circle(desk.world, (0, 0)), circle(desk.world, (2, 0))
    pendulum(desk.world, (-3, 1), stiffness=5000.0)
    desk.world.spawn(Spring(a=ball, b=other))
    desk.move(0.1, 0)
    desk.key(key)
    desk.frames(2)
    assert not desk.world.has(ball, Transform) and desk.world.has(other, Transform)
    assert len(springs(desk)) == 1
    desk.move(5, 3)
    desk.key(key)
    desk.frames()
    assert len(desk.world.entities()) == 2 and "Nothing to remove" in desk.window.notice


def test_a_static_body_and_one_in_the_hand_can_be_removed(desk: Desk) -> None:
    box(desk.world, (0, 0), static=True)
    circle(desk.world, (3, 0))
    desk.move(0, 0)
    desk.key("delete")
    desk.press(3, 0)
    desk.frames()
    desk.key("delete")
    desk.frames()
    desk.release(3, 0)
    desk.frames()
    assert desk.world.entities() == [] and desk.window.hand.entity is None


@pytest.mark.parametrize("paused", [True, False])
def test_a_body_in_the_hand_takes_typed_numbers(paused: bool) -> None:
    """Its velocity took three acts: to select it, and its field, and the number."""
    world = empty_world(gravity=(0, 0))
    ball = circle(world, (0, 0), mass=1.0)
    desk = Desk(world)
    desk.window.pace.paused = paused
    desk.press(0.1, 0)
    desk.frames()
    write(desk, "5 x")
    tap(desk, "return")
    assert "5 x is no speed" in desk.window.notice and desk.window.hand.entity in (ball,)
    write(desk, "2 m/s, 90 deg, 3 kg")
    assert desk.window.tool == "circle", "digits choose no tools meanwhile"
    assert desk.world.component(ball, Mass).mass == 1.0
    tap(desk, "return")
    desk.release(0.1, 0)
    desk.frames(3)
    assert desk.world.component(ball, Mass).mass == 3.0 and desk.window.hand.entity not in (ball,)
    assert tuple(desk.world.component(ball, Velocity).linear) == pytest.approx((0.0, 2.0), abs=1e-12)
    desk.press(*desk.world.component(ball, Transform).position)
    desk.frames()
    write(desk, "-3 kg")
    tap(desk, "return")
    assert (
        "must be a finite number > 0 kg" in desk.window.notice
        and desk.world.component(ball, Mass).mass == 3.0
    )


def test_what_is_typed_is_taken_back_with_the_way_of_the_hand() -> None:
    world = empty_world(gravity=(0, 0))
    ball = circle(world, (0, 0), mass=1.0)
    desk = Desk(world)
    desk.window.pace.paused = True
    desk.frames()
    before = bits(world)
    desk.press(0, 0)
    desk.frames()
    desk.move(1, 1)
    desk.frames()
    write(desk, "2 m/s, 3 kg")
    tap(desk, "return")
    desk.release(1, 1)
    desk.frames()
    assert tuple(world.component(ball, Velocity).linear) == (2.0, 0.0)
    assert world.component(ball, Transform).position.x == pytest.approx(1.0)
    tap(desk, "z", pygame.KMOD_CTRL)
    assert bits(desk.world) == before and world.component(ball, Mass).mass == 1.0


def test_numbers_typed_to_a_fixed_body_or_given_up_change_nothing(desk: Desk) -> None:
    ball, wall = circle(desk.world, (0, 0)), box(desk.world, (3, 0), static=True)
    desk.window.pace.paused = True
    desk.press(3, 0)
    desk.frames()
    write(desk, "3 m/s")
    tap(desk, "return")
    desk.release(3, 0)
    desk.frames()
    assert not desk.world.has(wall, Velocity) and "it is fixed" in desk.window.notice
    desk.press(0, 0)
    desk.frames()
    write(desk, "3 m/s")
    desk.release(0, 0)
    desk.frames()
    assert not desk.window.sketch.typed and not desk.world.component(ball, Velocity).linear


def draw_spring(desk: Desk, start: tuple[float, float], end: tuple[float, float]) -> None:
    desk.move(*start)
    desk.key("s")
    desk.frames()
    desk.move(*end)
    desk.frames()
    desk.key_up("s")
    desk.frames()


def test_s_from_one_body_to_another_is_a_spring_at_rest(desk: Desk) -> None:
    a, b = circle(desk.world, (-1, 0), mass=1.0), circle(desk.world, (2, 0), mass=3.0)
    draw_spring(desk, (-1, 0), (2, 0))
    (spring,) = springs(desk)
    assert (spring.a, spring.b) == (a, b)
    assert spring.rest_length == pytest.approx(3.0)
    reduced = 1.0 * 3.0 / 4.0
    assert math.sqrt(spring.stiffness / reduced) / (2 * math.pi) == pytest.approx(2.0), "2 Hz"
    desk.frames(30)
    assert desk.world.component(a, Transform).position.x == pytest.approx(-1.0)


def test_springs_hold_where_they_were_put(desk: Desk) -> None:
    block = box(desk.world, (0, 0), width=1.0, height=0.4)
    desk.world.component(block, Transform).angle = math.pi / 2
    draw_spring(desk, (0.1, 0.4), (3, 2))
    (spring,) = springs(desk)
    assert spring.b is None
    assert (spring.anchor_a - Vector2(0.4, -0.1)).magnitude < 1e-9
    assert (spring.anchor_b - Vector2(3, 2)).magnitude < 1e-9
    assert spring.rest_length == pytest.approx(math.hypot(2.9, 1.6))


def test_a_spring_to_a_wall_moves_and_one_between_walls_is_refused(desk: Desk) -> None:
    box(desk.world, (0, 0), static=True)
    box(desk.world, (3, 0), static=True)
    circle(desk.world, (0, 2), mass=1.0)
    draw_spring(desk, (0, 0), (3, 0))
    assert not springs(desk) and "neither of its ends" in desk.window.notice
    draw_spring(desk, (0, 0), (0, 2))
    (spring,) = springs(desk)
    assert 0.0 < spring.stiffness < 1e4
    desk.frames(10)


def test_a_spring_needs_two_ends(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0))
    draw_spring(desk, (3, 2), (3, 1))
    assert not springs(desk) and "holds a body" in desk.window.notice
    draw_spring(desk, (0, 0), (0.05, 0))
    assert not springs(desk)
    draw_spring(desk, (3, 2), (0, 0))
    (spring,) = springs(desk)
    assert (spring.a, spring.b) == (ball, None) and tuple(spring.anchor_b) == pytest.approx((3, 2))


@pytest.mark.parametrize("how", ["clear", "remove", "focus"])
def test_what_was_begun_is_forgotten(desk: Desk, how: str) -> None:
    circle(desk.world, (0, 0))
    desk.move(0, 0)
    desk.key("s")
    desk.frames()
    if how == "focus":
        pygame.event.post(pygame.Event(pygame.WINDOWFOCUSLOST))
    else:
        desk.key("r" if how == "clear" else "delete")
    desk.move(2, 2)
    desk.frames()
    desk.key_up("s")
    desk.frames(2)
    assert not springs(desk) and not desk.window.sketch.grips


def test_a_dashed_line_shows_where_the_spring_would_be() -> None:
    world = empty_world(gravity=(0, 0))
    circle(world, (0, 0))
    desk, canvas = recorded(world)
    desk.move(0, 0)
    desk.key("s")
    desk.move(2, 1)
    frame(desk, canvas)
    (line,) = [call for call in canvas.called("lines") if call["colour"] == desk.window.theme.accent]
    assert tuple(line["start"][0]) == desk.pixel(0, 0)
    assert tuple(line["end"][-1]) == desk.pixel(2, 1)
    desk.key_up("s")
    desk.window.tool = "select"  # or a ghost shows what a click would make
    frame(desk, canvas)
    assert not [call for call in canvas.called("lines") if call["colour"] == desk.window.theme.accent]


def test_f1_shows_every_key_and_escape_leaves_the_help_alone(desk: Desk) -> None:
    tap(desk, "f1")
    words = desk.ui.words
    for control in CONTROLS:
        assert any(shown.strip() == control.does for shown in words), control.does
        assert any(shown.startswith(control.label) for shown in words), control.label
    assert "Del, Backspace" in words
    tap(desk, "escape")
    assert [desk.window.help, desk.window.closing] == [False, False]
    tap(desk, "f1")
    tap(desk, "f1")
    assert not desk.window.help
    for _ in range(2):  # the first may have been meant for what was closed
        tap(desk, "escape")
    assert desk.window.closing


def test_the_help_is_closed_by_its_corner_and_a_click_on_it_does_nothing_behind_it(desk: Desk) -> None:
    tap(desk, "f1")
    left, top, width, height = desk.sandbox.interface.covered[-1]
    click_at(desk, (left + width // 2, top + height // 2))
    assert [desk.window.help, *desk.world.entities()] == [True]
    click_at(desk, (left + width - 14, top + 14))
    assert not desk.window.help and desk.world.entities() == []


# ---- an edit by a key while something is held is one act, and one undo takes it back -----------------------


def holding() -> tuple[Desk, int]:
    """Return a desk where time stands still and a ball is held that was moved a little, and the ball."""
    world = empty_world()
    ball = circle(world, (0.013, 0.517))
    desk = Desk(world)
    desk.window.tool = "select"
    desk.window.pace.halt()
    desk.press(0.05, 0.5)
    desk.frames(2)
    desk.move(0.08, 0.52)
    desk.frames(2)
    assert desk.window.hand.entity == ball
    return desk, ball


@pytest.mark.parametrize(("key", "mod"), [("g", 0), ("left", 0), ("left", pygame.KMOD_SHIFT)])
def test_one_undo_takes_back_an_edit_while_something_is_held(key: str, mod: int) -> None:
    desk, ball = holding()
    before, laws = bits(desk.world), desk.world.physics
    desk.key(key, mod)
    desk.frames(3)
    done, count = (bits(desk.world), desk.world.physics), len(desk.window.edits.history.entries)
    assert done != (before, laws), "the hand does not take back what the key did"
    desk.key("z", pygame.KMOD_CTRL)
    desk.frames()
    assert (bits(desk.world), desk.world.physics) == (before, laws) and not desk.world.has(ball, Held)
    assert len(desk.window.edits.history.entries) == count
    desk.key("y", pygame.KMOD_CTRL)
    desk.frames()
    assert (bits(desk.world), desk.world.physics) == done


def test_the_hand_goes_on_from_where_an_edit_has_put_what_it_holds() -> None:
    desk, ball = holding()
    desk.key("left")
    desk.frames()
    nudged = desk.world.component(ball, Transform).position
    desk.move(0.08, 1.52)
    desk.frames()
    assert (desk.world.component(ball, Transform).position - nudged - Vector2(0.0, 1.0)).magnitude < 1e-9
    desk.release(0.08, 1.52)
    desk.frames()
    undone = [desk.window.edits.history.undo(runs=False) for _ in range(3)]
    assert undone == ["moved by hand", "moved circle 1", "moved by hand"]


def test_what_is_held_for_an_edit_is_held_again_before_time_goes_on() -> None:
    desk, ball = holding()
    desk.window.pace.paused = False
    desk.frames()
    desk.key("g")
    desk.frames()
    assert desk.world.has(ball, Held) and desk.world.component(ball, Velocity).linear == Vector2()
    desk.key("left")
    desk.release(0.08, 0.52)
    desk.frames()
    assert not desk.world.has(ball, Held) and desk.window.hand.entity is None


def test_what_an_edit_takes_from_the_hand_is_not_held_again() -> None:
    desk, ball = holding()
    desk.window.edits.do(RemoveComponent(ball, "Velocity"))
    desk.frames()
    assert desk.window.hand.entity is None


def test_a_pause_while_something_is_held_does_not_divide_what_the_hand_does() -> None:
    desk, ball = holding()
    for x in (1.0, 1.2):
        desk.key("space")
        desk.move(x, 0.5)
        desk.frames(3)
    desk.release(1.2, 0.5)
    desk.frames()
    assert desk.world.component(ball, Transform).position.x > 1.0
    desk.key("z", pygame.KMOD_CTRL)
    desk.frames()
    assert desk.world.component(ball, Transform).position == Vector2(0.013, 0.517)
    assert not desk.world.has(ball, Held)


def test_a_pin_that_is_dragged_while_time_runs_is_an_act_of_its_own() -> None:
    world = empty_world(gravity_mode="none")
    ball = circle(world, (0.0, 0.0))
    spring = world.spawn(Spring(a=ball, anchor_b=(0.0, 2.0), rest_length=2.0))
    desk = Desk(world)
    desk.window.tool = "select"
    desk.drag((0.0, 0.0), (0.0, 0.0), 5)
    desk.frames(3)
    thrown = world.time
    desk.press(0.0, 2.0)
    desk.move(0.5, 2.0)
    desk.frames(3)
    desk.release(0.5, 2.0)
    desk.frames()
    assert world.component(spring, Spring).anchor_b != Vector2(0.0, 2.0)
    desk.key("z", pygame.KMOD_CTRL)
    desk.frames()
    assert world.component(spring, Spring).anchor_b == Vector2(0.0, 2.0) and world.time == thrown


@pytest.mark.parametrize("steps", [1, 6])
def test_what_joints_hold_follows_the_hand_as_fast_where_frames_are_slow(steps: int) -> None:
    """It was pulled once a frame: with ten frames a second it was 0.3 m off after a second."""
    world = empty_world()
    ball = circle(world, (0.0, -1.0), radius=0.2)
    world.spawn(Rope(b=ball, length=3.0))
    desk = Desk(world)
    desk.window.tool = "select"
    desk.press(0.0, -1.0)
    desk.frames(elapsed=steps * FRAME)
    desk.move(1.5, 0.5)
    desk.frames(60 // steps, elapsed=steps * FRAME)
    assert (world.component(ball, Transform).position - Vector2(1.5, 0.5)).magnitude < 0.02


@pytest.mark.parametrize("way", [1.0, 2.0, 4.0])
def test_what_joints_hold_comes_to_rest_where_a_hand_is_that_jumps(way: float) -> None:
    """It was braked by half of the force that pulled, and went 0.6 m too far in a jump of 2 m."""
    world = empty_world()
    ball = circle(world, (0.0, 0.0), radius=0.2)
    world.spawn(Rod(b=ball, anchor_b=(0.0, 0.0), anchor_a=(0.0, 3.0), length=3.0))
    desk = Desk(world)
    desk.window.tool = "select"
    desk.press(0.0, 0.0)
    desk.frames(5)
    angle = way / 3.0
    goal = Vector2(3.0 * math.sin(angle), 3.0 - 3.0 * math.cos(angle))
    desk.move(goal.x, goal.y)
    farthest = 0.0
    for _ in range(120):
        desk.frames()
        place = world.component(ball, Transform).position
        farthest = max(farthest, math.atan2(place.x, 3.0 - place.y) * 3.0)
    assert farthest < way + 0.02 and (place - goal).magnitude < 0.02


# ---- what is dragged while time stands still is never lost, and is one act ---------------------------------


@pytest.fixture
def dragging() -> tuple[Desk, int]:
    """Return a desk where the handle of a ball's velocity is being dragged, and the ball."""
    world = empty_world(gravity_mode="none")
    ball = circle(world, (0.0, 0.0))
    desk = Desk(world)
    desk.window.tool = "select"
    desk.window.pace.halt()
    desk.window.selection.take(ball)
    place = arrow_of(world, ball, desk.window.camera)
    desk.press(place.x, place.y)
    desk.move(1.0, 0.0)
    desk.frames()
    assert desk.window.handles.dragged == "velocity" and world.component(ball, Velocity).linear.x > 1.0
    return desk, ball


def test_a_key_pressed_in_a_drag_does_not_undo_the_drag(dragging: tuple[Desk, int]) -> None:
    desk, ball = dragging
    pulled = desk.world.component(ball, Velocity).linear
    desk.key("g")
    desk.frames()
    desk.release(1.0, 0.0)
    desk.frames()
    assert desk.world.component(ball, Velocity).linear == pulled
    undone = [desk.window.edits.history.undo(runs=False) for _ in range(3)]
    assert "gravity" in str(undone[0]) and undone[1] is not None and undone[2] is None
    assert desk.world.component(ball, Velocity).linear == Vector2()


def test_undo_in_a_drag_takes_back_the_drag_and_redo_brings_it_again(dragging: tuple[Desk, int]) -> None:
    desk, ball = dragging
    pulled = desk.world.component(ball, Velocity).linear
    desk.key("z", pygame.KMOD_CTRL)
    desk.move(2.0, 0.0)
    desk.frames()
    desk.release(2.0, 0.0)
    desk.frames()
    assert desk.world.component(ball, Velocity).linear == Vector2()
    desk.key("y", pygame.KMOD_CTRL)
    desk.frames()
    assert desk.world.component(ball, Velocity).linear == pulled


def test_a_step_in_a_drag_is_made_again_as_it_was(dragging: tuple[Desk, int]) -> None:
    desk, ball = dragging
    desk.key(".")
    desk.frames(2)
    desk.release(1.0, 0.0)
    desk.frames()
    history, place = desk.window.edits.history, desk.world.component(ball, Transform).position
    assert desk.world.steps == 1 and place.x > 0.0
    assert not [played for _, played in history.again() if played.columns]
    history.seek(0)
    history.seek(1)
    assert desk.world.component(ball, Transform).position == place
