"""InputSystem: SDL's events in, actions on the world and the window out; its table is in test_features."""

import pygame
import pytest
from desk import Desk, empty_world

from physicslab.components import Held, Shape, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import box, circle
from physicslab.view.controls.controls import CONTROLS, KEYS, RELEASES


@pytest.fixture
def desk() -> Desk:
    return Desk(empty_world(gravity=(0, 0)))


def test_spawned_bodies_vary(desk: Desk) -> None:
    for n in range(4):
        for y, button in ((2, "left"), (-2, "right")):
            desk.press(n, y, button)
            desk.release(n, y, button)
        desk.frames()
    shapes = [desk.world.component(entity, Shape) for entity in desk.world.entities()]
    assert len({shape.radius for shape in shapes if shape.kind == "circle"}) > 2
    assert len({shape.width for shape in shapes if shape.kind == "box"}) > 2


def test_no_ghost_is_drawn_before_the_mouse_has_moved_over_the_window(desk: Desk) -> None:
    """A window that opened under the mouse showed the next circle in the middle of its scene."""
    pygame.event.post(pygame.Event(pygame.WINDOWENTER))
    desk.move(0.0, 0.0)
    desk.frames()
    assert not desk.window.has_pointed
    desk.move(0.1, 0.0)
    desk.frames()
    assert desk.window.has_pointed


def test_drag_works_while_paused(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0))
    desk.key("space")
    desk.press(0, 0)
    desk.frames()
    desk.move(-3, 2)
    desk.frames()
    assert (desk.world.component(ball, Transform).position - Vector2(-3, 2)).magnitude < 1e-9
    desk.release(-3, 2)
    desk.frames(5)
    assert desk.world.time == 0.0
    assert not desk.world.has(ball, Held)
    assert desk.world.component(ball, Velocity).linear == Vector2(0, 0)


def test_a_held_body_follows_in_slow_motion(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0))
    desk.key("tab")
    desk.press(0, 0)
    desk.frames()
    desk.move(1, 1)
    desk.frames()
    assert (desk.world.component(ball, Transform).position - Vector2(1, 1)).magnitude < 1e-9


def test_a_button_let_go_unseen_leaves_nothing_held(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0))
    desk.press(0, 0)
    desk.frames()
    pygame.event.post(pygame.Event(pygame.MOUSEMOTION, pos=(10, 10), rel=(0, 0), buttons=(0, 0, 0)))
    desk.frames()
    assert not desk.world.has(ball, Held)


def test_walls_stay_where_they_are_and_the_user_is_informed(desk: Desk) -> None:
    wall = box(desk.world, (0, 0), static=True, name="floor")
    desk.press(0, 0)
    desk.frames()
    assert desk.world.entities() == [wall]
    assert "floor stays where it is" in desk.window.notice


def test_full_stop_makes_single_steps(desk: Desk) -> None:
    circle(desk.world, (0, 0), velocity=(1, 0))
    desk.key(".")
    desk.frames(5)
    assert desk.world.steps == 1
    desk.key(".")
    desk.key(".")
    desk.frames(5)
    assert desk.world.steps == 3
    assert desk.window.pace.paused


def test_r_clears_everything(desk: Desk) -> None:
    circle(desk.world, (0, 0))
    desk.key("p")
    desk.frames(2)
    desk.press(0, 0)
    desk.frames()
    desk.key("r")
    desk.frames()
    assert desk.world.entities() == []
    assert desk.window.hand.entity is None
    desk.release(0, 0)
    desk.frames()
    assert desk.world.entities() == []


def test_g_brings_the_earths_gravity_where_the_scene_has_none(desk: Desk) -> None:
    desk.key("g")
    desk.frames()
    assert desk.world.physics.gravity == Vector2(0, -9.81)


def test_o_lets_bodies_attract_each_other_and_goes_back() -> None:
    desk = Desk(empty_world())
    left, right = circle(desk.world, (-1, 0)), circle(desk.world, (1, 0))
    desk.key("g")
    desk.key("o")
    desk.frames(5)
    assert desk.world.physics.gravity_mode == "planet"
    assert desk.world.component(left, Velocity).linear.x > 0.0
    assert desk.world.component(right, Velocity).linear.x < 0.0
    desk.key("o")
    desk.frames()
    assert desk.world.physics.gravity_mode == "none"


def test_tab_is_a_quarter_of_the_speed(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0), velocity=(1, 0))
    desk.key("tab")
    desk.frames(60)
    assert desk.world.component(ball, Transform).position.x == pytest.approx(0.25)
    desk.key("tab")
    desk.frames(60)
    assert desk.world.component(ball, Transform).position.x == pytest.approx(1.25)


@pytest.mark.parametrize("mod", [pygame.KMOD_LALT, pygame.KMOD_LCTRL, pygame.KMOD_LMETA])
def test_keys_of_the_desktop_are_left_alone(desk: Desk, mod: int) -> None:
    desk.key("tab", mod=mod)
    desk.frames()
    assert not desk.window.pace.slow_motion


def test_wheel_zooms_at_the_cursor(desk: Desk) -> None:
    desk.move(2, 1)
    pygame.event.post(pygame.Event(pygame.MOUSEWHEEL, x=0, y=2, precise_x=0.0, precise_y=2.0, flipped=False))
    desk.frames()
    assert desk.window.camera.scale > 120.0
    assert (desk.window.place - Vector2(2, 1)).magnitude < 1e-9


def test_middle_drag_pans(desk: Desk) -> None:
    circle(desk.world, (9, 9))
    desk.press(0, 0, "middle")
    desk.move(1, 0.5)
    desk.frames()
    assert (desk.window.camera.centre - Vector2(-1, -0.5)).magnitude < 1e-9
    desk.release(0, 0, "middle")
    desk.move(3, 3)
    desk.frames()
    assert (desk.window.camera.centre - Vector2(-1, -0.5)).magnitude < 1e-9


def test_f_fits_and_home_goes_back(desk: Desk) -> None:
    for x in (-40, 40):
        circle(desk.world, (x, 3))
    desk.window.camera.zoom(30.0, (5, 5))
    desk.key("f")
    desk.frames()
    xmin, _, xmax, _ = desk.window.camera.visible
    assert xmin < -40.2 and xmax > 40.2
    desk.world.clear()
    circle(desk.world, (1, 1))
    desk.key("home")
    desk.frames()
    assert desk.window.camera.scale == 100.0
    desk.key("f")
    desk.frames()
    assert desk.window.camera.scale > 100.0


@pytest.mark.parametrize(
    "key", ["f", "home", "r", "p", ".", "tab", "g", "o", "f12", "s", "delete", "[", "]", "h", "f1"]
)
def test_every_key_works_in_an_empty_world(desk: Desk, key: str) -> None:
    desk.key(key)
    desk.frames(3)


def test_escape_and_the_close_button_close(desk: Desk) -> None:
    desk.key("escape")
    desk.frames()
    assert desk.window.closing
    desk.window.closing = False
    pygame.event.post(pygame.Event(pygame.QUIT))
    desk.frames()
    assert desk.window.closing


def test_the_table_of_controls_is_what_works(desk: Desk) -> None:
    assert len({control.label for control in CONTROLS}) == len(CONTROLS)
    assert all(control.label and control.does for control in CONTROLS)
    known = {pygame.key.name(code).lower() for name, code in vars(pygame).items() if name.startswith("K_")}
    names = [key.removeprefix("ctrl+").removeprefix("shift+") for key in (*KEYS, *RELEASES)]
    assert {name for name in names if name not in known and name != "+"} == set()
    every = [key for control in CONTROLS for key in (control.key, *control.also) if key]
    assert len(every) == len(set(every)), "no key means two things"


def test_unknown_keys_and_buttons_do_nothing(desk: Desk) -> None:
    desk.key("f7")
    pygame.event.post(pygame.Event(pygame.MOUSEBUTTONDOWN, button=6, pos=(5, 5)))
    pygame.event.post(pygame.Event(pygame.MOUSEBUTTONUP, button=6, pos=(5, 5)))
    desk.frames()
    assert desk.world.entities() == []
