"""Windows are docked to the sides of the world by dragging their titles, and are there at the next start."""

from __future__ import annotations

from pathlib import Path

import pygame
import pytest
from desk import SETTLED, Desk, Place, button_down, button_up, click_at, point, sized, tap
from imgui_bundle import imgui

from physicslab import load_scene
from physicslab.components import Transform
from physicslab.desktop.preferences import load_preferences, save_preferences
from physicslab.view.canvas.canvas import Rect
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.controls.impact_actions import close_up

SIZE = (1280, 720)
GRAPH = "###graph"
"""What is in the name of every graph's window."""


def window_of(desk: Desk, title: str) -> imgui.internal.Window:
    """Return a window of the toolkit by a part of its name, after the frames of an event."""
    desk.frames(SETTLED)
    desk.sandbox.interface.toolkit.enter()
    windows = imgui.get_current_context().windows
    return next(window for window in windows if title in window.name and window.active)


def rect_of(desk: Desk, title: str) -> pygame.Rect:
    window = window_of(desk, title)
    return pygame.Rect(round(window.pos.x), round(window.pos.y), round(window.size.x), round(window.size.y))


def bodies(desk: Desk) -> list[int]:
    return [entity for entity in desk.world.entities() if desk.world.has(entity, Transform)]


def drag(desk: Desk, start: Place, end: Place) -> None:
    point(desk, start)
    button_down(desk, start)
    for n in range(1, 9):
        way = (start[0] + (end[0] - start[0]) * n // 8, start[1] + (end[1] - start[1]) * n // 8)
        point(desk, way, (1, 0, 0))
    button_up(desk, end)
    desk.frames(SETTLED)


def dock(desk: Desk, title: str, to: Place) -> None:
    rect = rect_of(desk, title)
    drag(desk, (rect.left + 40, rect.top + 10), to)


def left_of(room: Rect) -> Place:
    """Return where the mark is on which a window is dropped to be docked at the left."""
    return room[0] + 18, room[1] + room[3] // 2


def below(room: Rect) -> Place:
    return room[0] + room[2] // 2, room[1] + room[3] - 18


def at_middle(room: Rect) -> Place:
    return room[0] + room[2] // 2, room[1] + room[3] // 2


@pytest.fixture
def desk() -> Desk:
    """Return a window with the history and a graph over the world, where they were dragged."""
    desk = sized(SIZE)
    for key, title, place in (("m", GRAPH, (700, 300)), ("u", "History", (400, 300))):
        tap(desk, key)
        dock(desk, title, place)
    return desk


def test_windows_stand_beside_the_world_at_first_and_the_world_makes_room() -> None:
    desk = sized(SIZE)
    interface = desk.sandbox.interface
    usual = interface.room()
    assert usual == interface.layout.room and interface.visible == interface.layout.visible
    for key in ("m", "m", "z", "u", "c"):
        tap(desk, key)
        desk.frames(SETTLED)
    world = pygame.Rect(interface.room())
    titles = ("###graph 1", "Impacts", "History", "Stopwatch")
    windows = [window_of(desk, title) for title in titles]
    assert all(window.dock_id for window in windows) and world.w > 0.3 * usual[2] and world.h > 0.3 * usual[3]
    assert not any(world.colliderect(pygame.Rect(rect)) for rect in interface.covered)


@pytest.mark.parametrize(
    ("keys", "size", "text"), [
        ("zmc", SIZE, 1.0), ("mmzuc", SIZE, 1.0), ("mmzuc", (1920, 1080), 1.0), ("cmz", (800, 600), 1.5),
        ("mzu", (640, 480), 1.0),
    ],
)  # fmt: skip
def test_docked_windows_leave_the_world_half_of_the_width_and_of_the_height(
    keys: str, size: tuple[int, int], text: float
) -> None:
    """The microscope stood in a column of its own: the world had 240 of 920 px."""
    desk = sized(size, load_scene("newtons_cradle"), text)
    desk.frames(60)
    tap(desk, "space")
    interface = desk.sandbox.interface
    _, _, width, height = interface.layout.visible
    for key in keys:
        tap(desk, key)
    desk.frames(SETTLED)
    close_up(desk.world, desk.window, desk.window.impacts.records[0].copy())
    desk.frames(SETTLED)
    _, _, across, down = interface.visible
    assert across >= 0.5 * width - 2 and down >= 0.5 * height - 2
    assert not window_of(desk, "Collision microscope").hidden, "what opens is in front of the tabs"


def test_a_tip_lies_beside_the_docked_window_that_it_is_for() -> None:
    """It covered the first rows of the table of impacts."""
    desk = sized(SIZE, load_scene("newtons_cradle"))
    tap(desk, "z")
    desk.frames(SETTLED)
    left, top, width, height = desk.ui.places["Pause at the next"]
    point(desk, (left + width // 2, top + height // 2))
    desk.frames(60)
    tip = window_of(desk, "##Tooltip")
    assert not tip.hidden and tip.pos.y + tip.size.y <= rect_of(desk, "Impacts").top


@pytest.mark.parametrize(("size", "text"), [((800, 600), 1.75), ((640, 480), 1.0), ((1280, 720), 1.75)])
def test_in_small_windows_nothing_lies_over_the_world(size: tuple[int, int], text: float) -> None:
    desk = sized(size, None, text)
    for key in ("m", "c", "z"):
        tap(desk, key)
    desk.frames(SETTLED)
    world = pygame.Rect(desk.sandbox.interface.room())
    assert world.w > 0.3 * size[0] and world.h > 0.3 * size[1]
    assert not any(world.colliderect(pygame.Rect(rect)) for rect in desk.sandbox.interface.covered)
    assert "Only the selection" in desk.ui.places, "what opens is in front of the tabs"


def test_larger_text_docks_windows_again_where_they_would_leave_the_world_no_width() -> None:
    desk = sized((1280, 720))
    for key in ("m", "z", "u", "c"):
        tap(desk, key)
    drag(desk, (desk.sandbox.interface.room()[2] + desk.sandbox.interface.room()[0] + 1, 300), (300, 300))
    desk.window.text_scale = 2.0
    desk.frames(2 * SETTLED)
    assert desk.sandbox.interface.room()[2] > 0.3 * 1280


def test_a_graph_that_had_no_room_stands_at_its_side_once_there_is_room_again() -> None:
    desk = sized(SIZE)
    tap(desk, "m")
    before, canvas = rect_of(desk, GRAPH), desk.window.canvas
    assert isinstance(canvas, PygameCanvas)
    for size, text in (((640, 480), 1.0), ((640, 480), 1.6), ((800, 600), 2.0), (SIZE, 1.0)):
        canvas.surface = pygame.Surface(size, 0, 32)
        desk.window.text_scale = text
        desk.frames(2 * SETTLED)
    assert window_of(desk, GRAPH).dock_id and rect_of(desk, GRAPH) == before


def test_a_window_that_was_not_shown_while_the_layout_was_reset_is_docked_when_it_opens(desk: Desk) -> None:
    tap(desk, "u")
    tap(desk, "f7")
    desk.frames(SETTLED)
    tap(desk, "u")
    assert window_of(desk, "History").dock_id


def test_what_is_in_the_middle_stays_there_while_the_world_makes_room() -> None:
    desk = sized(SIZE)
    desk.window.camera.zoom(2.0, desk.window.framing.middle)
    before = desk.window.camera.to_world(desk.window.framing.middle)
    tap(desk, "m")
    desk.frames(SETTLED)
    after = desk.window.camera.to_world(desk.window.framing.middle)
    assert (after - before).magnitude < 2.0 / desk.window.camera.scale


def test_a_window_is_docked_beside_the_world_and_the_world_makes_room(desk: Desk) -> None:
    interface, room = desk.sandbox.interface, desk.sandbox.interface.room()
    dock(desk, "History", left_of(room))
    left, top, width, height = interface.room()
    beside = rect_of(desk, "History")
    assert (top, height, left + width) == (room[1], room[3], room[0] + room[2])
    assert beside.left == room[0] and beside.right <= left < room[0] + room[2] // 2
    dock(desk, GRAPH, below(room))
    lower = rect_of(desk, GRAPH)
    left, top, width, height = interface.room()
    assert lower.top >= top + height > room[1] and lower.bottom == room[1] + room[3]
    world, panels = pygame.Rect(interface.room()), [pygame.Rect(rect) for rect in interface.covered]
    assert not any(world.colliderect(panel) for panel in panels)
    assert sum(panel.w * panel.h for panel in panels) == SIZE[0] * SIZE[1] - world.w * world.h


def test_clicks_beside_what_is_docked_are_the_worlds_and_on_it_they_are_not(desk: Desk) -> None:
    dock(desk, "History", left_of(desk.sandbox.interface.room()))
    tap(desk, "m")
    point(desk, rect_of(desk, GRAPH).center)
    click_at(desk, rect_of(desk, "History").center)
    assert bodies(desk) == []
    left, top, _, height = desk.sandbox.interface.room()
    click_at(desk, (left + 20, top + height // 2))
    assert len(bodies(desk)) == 1
    place = desk.world.component(bodies(desk)[0], Transform).position
    assert desk.window.camera.to_screen(place)[0] == pytest.approx(left + 20, abs=2)


def test_windows_are_tabs_of_each_other(desk: Desk) -> None:
    dock(desk, "History", left_of(desk.sandbox.interface.room()))
    dock(desk, GRAPH, rect_of(desk, "History").center)
    assert window_of(desk, GRAPH).dock_id == window_of(desk, "History").dock_id != 0
    assert rect_of(desk, GRAPH) == rect_of(desk, "History")


@pytest.mark.parametrize(("key", "title"), [("u", "History"), ("c", "Stopwatch")])
def test_a_window_that_opens_again_joins_what_stands_at_its_side_by_now(key: str, title: str) -> None:
    desk = sized(SIZE)
    for pressed in (key, "m", "m", key):  # the graphs came while it was closed
        tap(desk, pressed)
        desk.frames(SETTLED)
        if pressed == key and not desk.window.dashboard.graphs:
            tap(desk, key)
            desk.frames(SETTLED)
    assert rect_of(desk, title).left == rect_of(desk, GRAPH).left, "one column, not two"
    assert desk.sandbox.interface.room()[2] > SIZE[0] // 3


def test_a_new_graph_comes_to_the_front_though_another_tab_was_clicked() -> None:
    desk = sized(SIZE)
    for _ in range(3):
        tap(desk, "m")
        desk.frames(SETTLED)
    windows = [window for window in imgui.get_current_context().windows if GRAPH in window.name]
    shown = next(window for window in windows if window.dock_id == windows[-1].dock_id and not window.hidden)
    click_at(desk, (round(shown.pos.x) + 20, round(shown.pos.y + 0.9 * shown.size.y)))
    tap(desk, "m")
    desk.frames(SETTLED + 2)
    newest = window_of(desk, f"{GRAPH} {desk.window.dashboard.graphs[-1].entity}")
    assert newest.dock_id == shown.dock_id and not newest.hidden and shown.hidden


def test_no_window_can_be_docked_over_the_world(desk: Desk) -> None:
    room = desk.sandbox.interface.room()
    dock(desk, "History", at_middle(room))
    assert window_of(desk, "History").dock_id == 0 and desk.sandbox.interface.room() == room


def test_closing_what_is_docked_gives_its_room_back_and_opening_takes_it_again(desk: Desk) -> None:
    room = desk.sandbox.interface.room()
    dock(desk, "History", left_of(room))
    smaller = desk.sandbox.interface.room()
    for expected in (room, smaller):
        tap(desk, "u")
        assert desk.sandbox.interface.room() == expected


def test_the_edge_between_a_docked_window_and_the_world_can_be_dragged(desk: Desk) -> None:
    dock(desk, "History", left_of(desk.sandbox.interface.room()))
    left, top, width, height = desk.sandbox.interface.room()
    drag(desk, (left - 1, top + height // 2), (left + 79, top + height // 2))
    assert desk.sandbox.interface.room() == (left + 80, top, width - 80, height)
    assert bodies(desk) == []


def test_what_is_docked_is_docked_at_the_next_start_and_a_key_puts_it_back(
    desk: Desk, tmp_path: Path
) -> None:
    usual = desk.sandbox.interface.room()
    dock(desk, "History", left_of(usual))
    chosen = desk.sandbox.interface.room()
    save_preferences(tmp_path / "preferences.json", desk.window)
    again = sized(SIZE)
    load_preferences(tmp_path / "preferences.json", again.window)
    tap(again, "u")
    assert again.sandbox.interface.room() == chosen
    tap(again, "f7")
    left, _, width, _ = again.sandbox.interface.room()
    assert left == usual[0] and width < usual[2], "it stands at the right, as at first"


def test_windows_that_were_shut_when_the_layout_was_reset_are_docked_after_the_next_start(
    desk: Desk, tmp_path: Path
) -> None:
    tap(desk, "u")  # shut
    tap(desk, "f7")
    save_preferences(tmp_path / "preferences.json", desk.window)
    again = sized(SIZE)
    load_preferences(tmp_path / "preferences.json", again.window)
    usual = again.sandbox.interface.room()
    tap(again, "u")
    left, _, width, _ = again.sandbox.interface.room()
    assert left == usual[0] and width < usual[2]


def test_a_window_that_was_shown_in_a_narrow_world_alone_is_docked_in_a_wide_one(tmp_path: Path) -> None:
    desk = sized(SIZE)
    tap(desk, "u")
    tap(desk, "u")  # the wide arrangement is not that of the beginning
    canvas = desk.window.canvas
    assert isinstance(canvas, PygameCanvas)
    canvas.surface = pygame.Surface((640, 480), 0, 32)
    desk.frames(SETTLED)
    tap(desk, "z")
    tap(desk, "z")
    canvas.surface = pygame.Surface(SIZE, 0, 32)
    desk.frames(SETTLED)
    save_preferences(tmp_path / "preferences.json", desk.window)
    again = sized(SIZE)
    load_preferences(tmp_path / "preferences.json", again.window)
    again.frames(SETTLED)
    height = again.sandbox.interface.room()[3]
    tap(again, "z")
    assert again.sandbox.interface.room()[3] < height


def test_a_window_that_was_docked_in_a_large_window_is_within_a_small_one(desk: Desk) -> None:
    room = desk.sandbox.interface.room()
    drag(desk, (rect_of(desk, "History").left + 40, rect_of(desk, "History").top + 10), (900, 640))
    small = sized((640, 480))
    small.window.arrangements["narrow"] = desk.window.arrangements["wide"]
    tap(small, "u")
    assert pygame.Rect(0, 0, 640, 480).contains(rect_of(small, "History"))
    assert desk.sandbox.interface.room() == room


BROKEN = (
    "no words of it", "[Window][History]\nPos=a,b\nSize=-1,-1\nDockId=0xFFFFFFFF,9999\n",
    "[Window][History]\nPos=2000000000,-2000000000\nSize=2000000000,2000000000\n",
    "[Docking][Data]\nDockNode ID=0x1 Parent=0x2\nDockNode ID=0x2 Parent=0x1\n",
    "[Docking][Data]\nDockSpace ID=0x1AD5562B Window=0xFE9B5E5A Split=X\nDockNode ID=0x1 Parent=0x1AD5562B\n",
    "\x00[[[]]\n[Window\n]",
)  # fmt: skip


@pytest.mark.parametrize("text", BROKEN)
def test_a_broken_arrangement_does_no_harm(text: str) -> None:
    desk = sized(SIZE)
    desk.window.arrangements["wide"] = text
    tap(desk, "u")
    _, _, width, height = desk.sandbox.interface.room()
    assert width > 0 and height > 0
    assert pygame.Rect(0, 0, *SIZE).contains(rect_of(desk, "History"))
    tap(desk, "f7")
    assert desk.sandbox.interface.room()[0] == desk.sandbox.interface.layout.room[0]
