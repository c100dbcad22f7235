"""The window without a mouse: menus, panels, fields and tools, by events of keys alone."""

from __future__ import annotations

from typing import Any

import pygame
import pytest
from desk import SETTLED, Desk, click, empty_world, sized, tap, write

from physicslab.components import Mass, Shape, Spring, Transform
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import circle
from physicslab.scenes import SCENES
from physicslab.view.controls.tool import Tool
from physicslab.view.controls.tools import DRAWING, PALETTE, REMOVE


@pytest.fixture
def desk() -> Desk:
    desk = sized((1280, 720), empty_world(gravity=(0, 0)))
    tap(desk, "space")
    desk.window.camera.look_at((0.0, 0.0, 0.0, 0.0), 100.0)
    return desk


def keys(desk: Desk, *names: str) -> None:
    for name in names:
        tap(desk, name)


def has_keys(desk: Desk) -> bool:
    return desk.sandbox.interface.toolkit.has_keys


@pytest.mark.parametrize("opener", ["f10", "left alt"])
def test_a_scene_is_opened_from_the_menus(desk: Desk, opener: str) -> None:
    keys(desk, opener)
    assert has_keys(desk) and desk.ui.focused == "File"
    keys(desk, "right")
    assert desk.ui.focused == "Scenes"
    titles = [scene.title for scene in SCENES.values()]
    keys(desk, "down", "down", "down")
    assert desk.ui.focused == titles[2]
    keys(desk, "return")
    assert desk.world.title == titles[2] and not has_keys(desk)
    paused = desk.window.pace.paused
    keys(desk, "space")
    assert desk.window.pace.paused != paused


def test_a_menu_that_the_mouse_opened_goes_on_to_the_next_by_the_arrows(desk: Desk) -> None:
    """The first arrow closed it, and those after it moved the selected body."""
    ball = circle(desk.world, (0, 0))
    desk.window.selection.take(ball)
    click(desk, "File")
    for key, line in (
        ("right", "Sandbox"),
        ("right", "Make a lesson"),
        ("left", "Sandbox"),
        ("left", "Save"),
    ):
        keys(desk, key)
        desk.frames()  # the next menu opens a frame after the one before is closed
        assert line in desk.ui.places and has_keys(desk)
    keys(desk, "escape")
    assert not has_keys(desk)
    assert tuple(desk.world.component(ball, Transform).position) == (0.0, 0.0)


def test_escape_closes_the_menus_and_changes_nothing(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0))
    desk.window.selection.take(ball)
    for down in ((), ("down",), ("down", "down", "right", "down")):
        keys(desk, "f10", *down)
        assert has_keys(desk)
        keys(desk, "escape")
        assert not has_keys(desk) and desk.window.selection.entities == (ball,)
    keys(desk, "escape")
    assert desk.window.selection.entities == ()


def test_keys_of_the_world_do_nothing_while_a_menu_is_open(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0))
    desk.window.selection.take(ball)
    before = desk.world.physics, desk.window.grid, desk.window.pace.slow_motion
    for opened in ((), ("down",)):
        keys(desk, "f10", *opened)
        keys(desk, *"rgohvten", "delete", "backspace", "tab", ".", "b", "m", "home")
        keys(desk, "escape", "escape")
        desk.window.selection.take(ball)
        desk.window.closing = False
    assert desk.world.entities() == [ball] and not desk.window.dashboard.graphs
    assert (desk.world.physics, desk.window.grid, desk.window.pace.slow_motion) == before


def test_alt_with_another_key_is_for_the_desktop(desk: Desk) -> None:
    alt = pygame.key.key_code("left alt")

    def post(kind: int, **more: Any) -> None:
        pygame.event.post(pygame.Event(kind, **more))
        desk.frames(2)

    for between in ((pygame.KEYDOWN, {"key": pygame.K_TAB, "mod": pygame.KMOD_LALT, "unicode": ""}),
                    (pygame.MOUSEBUTTONDOWN, {"button": 6, "pos": (600, 300)}),
                    (pygame.WINDOWFOCUSLOST, {})):  # fmt: skip
        post(pygame.KEYDOWN, key=alt, mod=0, unicode="")
        post(between[0], **between[1])
        post(pygame.KEYUP, key=alt, mod=0, unicode="")
        desk.frames(SETTLED)
        assert not has_keys(desk)


def test_the_fields_of_what_is_selected_are_gone_through_and_changed(desk: Desk) -> None:
    ball = circle(desk.world, (1, 2), radius=0.25)
    keys(desk, "n", "return")
    assert desk.window.selection.entities == (ball,) and desk.sandbox.interface.toolkit.typing
    keys(desk, "tab")  # from its name to its place
    write(desk, "2.5")
    keys(desk, "tab")
    assert desk.world.component(ball, Transform).position == Vector2(2.5, 2)
    write(desk, "-1")
    keys(desk, "return")
    assert desk.world.component(ball, Transform).position == Vector2(2.5, -1) and has_keys(desk)
    while desk.ui.focused != "Mass.mass":
        keys(desk, "tab")
    write(desk, "3 kg")
    keys(desk, "tab")
    assert desk.world.component(ball, Mass).mass == 3.0
    keys(desk, "tab")
    pygame.event.post(pygame.Event(pygame.KEYDOWN, key=pygame.K_TAB, mod=pygame.KMOD_LSHIFT, unicode=""))
    desk.frames(SETTLED)
    steps = desk.world.steps
    write(desk, "7")
    keys(desk, "escape")
    assert not has_keys(desk) and desk.world.component(ball, Mass).mass == 3.0, "Esc restores"
    assert desk.window.selection.entities == (ball,) and not desk.window.pace.slow_motion
    keys(desk, ".")
    assert desk.world.steps == steps + 1, "keys are the world's again"


def test_keys_are_the_worlds_where_the_field_that_had_them_is_gone(desk: Desk) -> None:
    circle(desk.world, (1, 2), radius=0.25)
    keys(desk, "n", "return")
    assert has_keys(desk)
    tap(desk, "n", pygame.KMOD_LCTRL)
    desk.frames(SETTLED)
    assert not has_keys(desk)
    keys(desk, "3")
    assert desk.window.tool == "block"


def test_buttons_and_boxes_of_the_inspector_are_reached_and_pressed(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0))
    keys(desk, "n", "return")
    for _ in range(60):
        if desk.ui.focused == "Delete":
            break
        keys(desk, "tab")
    assert desk.world.entities() == [ball]
    keys(desk, "return")
    assert desk.world.entities() == []


def test_enter_shows_the_panel_that_has_the_fields(desk: Desk) -> None:
    circle(desk.world, (0, 0))
    keys(desk, "i", "n", "return")
    assert desk.window.figures and desk.sandbox.interface.toolkit.typing


def test_f6_goes_from_panel_to_panel_and_escape_to_the_world(desk: Desk) -> None:
    keys(desk, "m")
    seen = []
    for _ in range(5):
        keys(desk, "f6")
        seen.append(desk.sandbox.interface._walk._panel)
    assert len(set(seen[:4])) == 4 and seen[4] == seen[0]
    assert {"palette", "side", "transport"} < set(seen)
    keys(desk, "escape", "space")
    assert not has_keys(desk) and not desk.window.pace.paused


def test_every_tool_of_the_palette_is_taken_up(desk: Desk) -> None:
    keys(desk, "f6")
    assert desk.ui.focused == PALETTE[0].title
    for tool in PALETTE:
        keys(desk, "return")
        assert desk.window.tool == tool.name and desk.ui.focused == tool.title
        keys(desk, "down")
    keys(desk, "escape")
    assert desk.world.entities() == []


@pytest.mark.parametrize("tool", (PALETTE[0], PALETTE[5], PALETTE[-1]), ids=lambda tool: tool.name)
def test_a_tool_that_keys_have_taken_up_stays_when_they_leave_the_palette(desk: Desk, tool: Tool) -> None:
    keys(desk, "f6", *["down"] * PALETTE.index(tool), "return", "escape")
    assert desk.window.tool == tool.name and not has_keys(desk)
    assert desk.world.entities() == []


def test_a_body_is_made_moved_and_given_a_size_by_keys(desk: Desk) -> None:
    keys(desk, "return")
    (ball,) = desk.world.entities()
    shown = desk.window.camera.to_screen(desk.world.component(ball, Transform).position)
    assert shown == pytest.approx(desk.window.framing.middle, abs=1), "in the middle of the view"
    keys(desk, "n", "right", "right")
    moved = desk.window.camera.to_screen(desk.world.component(ball, Transform).position)
    assert moved[0] == pytest.approx(shown[0] + 2, abs=1e-6)
    keys(desk, "return")
    for _ in range(60):
        if desk.ui.focused == "Shape.radius":
            break
        keys(desk, "tab")
    write(desk, "0.4")
    keys(desk, "return", "escape")
    assert desk.world.component(ball, Shape).radius == 0.4


def test_arrows_move_the_cursor_where_nothing_is_selected_and_enter_clicks(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0))
    desk.window.tool = REMOVE.name
    keys(desk, "right")
    assert desk.window.points_by_key and desk.world.entities() == [ball]
    x, y = desk.pixel(0, 0)
    while desk.window.pointer[0] > x + 5:
        keys(desk, "left")
    while desk.window.pointer[0] < x - 5:
        keys(desk, "right")
    while desk.window.pointer[1] > y + 5:
        keys(desk, "up")
    while desk.window.pointer[1] < y - 5:
        keys(desk, "down")
    keys(desk, "return")
    assert desk.world.entities() == []


def test_the_cursor_stays_in_the_world_and_shift_moves_it_by_a_pixel(desk: Desk) -> None:
    left, top, width, height = desk.sandbox.interface.room()
    for _ in range(70):
        desk.key("left")
        desk.frames()
    assert desk.window.pointer[0] == left
    before = desk.window.pointer
    tap(desk, "right", pygame.KMOD_LSHIFT)
    assert desk.window.pointer == (before[0] + 1, before[1])
    assert top <= before[1] < top + height and width > 0


def test_a_spring_is_drawn_from_body_to_body_by_keys(desk: Desk) -> None:
    a, b = circle(desk.world, (-0.5, 0)), circle(desk.world, (0.5, 0))
    desk.window.tool = DRAWING["spring"].name
    desk.window.pointer, desk.window.has_pointed = desk.pixel(-0.5, 0), True
    keys(desk, "return", *["right"] * 10, "return")
    springs = [entity for entity in desk.world.entities() if desk.world.has(entity, Spring)]
    assert len(springs) == 1 and not desk.window.presses_by_key
    made = desk.world.component(springs[0], Spring)
    assert (made.a, made.b) == (a, b)


def test_a_click_gives_the_keys_back_to_the_world(desk: Desk) -> None:
    keys(desk, "f6")
    assert has_keys(desk)
    click(desk, "Measure")
    assert not has_keys(desk)
    keys(desk, "tab")
    assert desk.window.pace.slow_motion
