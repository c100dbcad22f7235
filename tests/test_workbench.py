"""The panels around the world: all that has a key can be done with the mouse, and nothing is in the way."""

from collections.abc import Iterator
from itertools import combinations, pairwise
from pathlib import Path

import pygame
import pytest
from desk import (
    MENUS,
    SETTLED,
    Desk,
    button_down,
    button_up,
    choose,
    click,
    click_at,
    empty_world,
    middle_of,
    point,
    sized,
    tap,
    write,
)  # fmt: skip
from imgui_bundle import imgui
from written import watch

from physicslab.components import Held, Shape, Spring, Transform
from physicslab.desktop.sessions import Session
from physicslab.ecs.vector import Vector2
from physicslab.files.scene import load_scene, save_scene
from physicslab.languages.language import language
from physicslab.prefabs import box, circle
from physicslab.scenes import SCENES
from physicslab.theme import THEMES
from physicslab.view.controls import lesson_actions
from physicslab.view.controls.controls import CONTROLS, Control
from physicslab.view.controls.spawning import BODIES, GROUPS
from physicslab.view.controls.tool import Tool
from physicslab.view.controls.tools import DRAWING, HAND, MORE_TOOLS, PALETTE, PAN, TOOL_GROUPS, TOOLS
from physicslab.view.window.desk import LEVELS
from physicslab.view.window.recent import Recovery
from physicslab.view.window.window import Window
from physicslab.world import World

SIZES = [(640, 480), (800, 600), (1280, 720), (1920, 1080)]
SCALES = [1.0, 1.75]
ROW = ("Restart", "Step back", "Pause", "Play", "Step", "Speed", "Time line")
"""What stands in the transport."""
BY_DRAGGING = {"Arrows", "Menu"}
"""Controls that do what the mouse does by dragging, or with its right button held."""
TRANSPORT = {"Space", ".", "B", "Ctrl+R", "Tab", "[", "]"}
"""Controls of the transport: the tests below do each of them by the mouse."""


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Desk]:
    monkeypatch.chdir(tmp_path)
    desk = Desk(empty_world(gravity=(0, 0)))
    desk.frames(SETTLED)
    yield desk


def title_of(label: str) -> str:
    return next(control.title for control in CONTROLS if control.label == label)


def do(desk: Desk, label: str) -> None:
    """Do by a menu what a key does."""
    group = next(control.group for control in CONTROLS if control.label == label)
    menu = {"file": "File", "quit": "File", "edit": "Edit", "laws": "World", "help": "Help"}.get(
        group, "View"
    )
    choose(desk, menu, title_of(label))


def take_up(desk: Desk, tool: Tool) -> None:
    choose(desk, *(("More", tool.title) if tool in MORE_TOOLS else (tool.title,)))


def at(desk: Desk, x: float, y: float) -> None:
    click_at(desk, desk.pixel(x, y))


def rects(desk: Desk) -> dict[str, pygame.Rect]:
    return {label: pygame.Rect(rect) for label, rect in desk.ui.places.items()}


# ---- all can be reached ----------------------------------------------------------------------------------


def lines_of(desk: Desk, menu: str) -> list[Control]:
    """Return the controls of which a menu has a line."""
    closed = desk.ui.places
    click(desk, menu)
    places = desk.ui.places
    click(desk, menu)
    return [control for control in CONTROLS if places.get(control.title) != closed.get(control.title)]


def test_every_control_with_an_action_can_be_reached_by_the_mouse(desk: Desk) -> None:
    listed = [control.label for menu in MENUS for control in lines_of(desk, menu)]
    for control in CONTROLS:
        by_tool = control.tool is not None and control.tool in TOOLS.values()
        reached = control.label in {*listed, *TRANSPORT, *BY_DRAGGING} or by_tool
        assert reached or control.action is None, control.label
    assert len(listed) == len(set(listed)), "no line is there twice"


def test_lines_of_menus_do_what_stands_in_them(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    done: list[str] = []
    monkeypatch.setattr(Control, "pressed", lambda control, world, window: done.append(control.label))
    lesson_actions.open_lesson(desk.world, desk.window, "collision")
    desk.frames(SETTLED)
    for menu in MENUS:
        for control in [control for control in lines_of(desk, menu) if control.is_open(desk.window)]:
            choose(desk, menu, control.title)
            assert done[-1] == control.label
    assert len(done) == len(set(done)) > 30


def test_lines_of_menus_show_their_keys_and_what_is_on(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: dict[str, tuple[str, bool]] = {}
    item = imgui.menu_item

    def watched(label: str, keys: str, on: bool, enabled: bool) -> tuple[bool, bool]:
        seen[label.partition("###")[0]] = keys, on
        return item(label, keys, on, enabled)

    monkeypatch.setattr(imgui, "menu_item", watched)
    for expected in (True, False):
        click(desk, "View")
        assert seen[title_of("H")] == ("H", expected)
        click(desk, title_of("H"))
    for control in CONTROLS:
        if control.title in seen:
            assert seen[control.title][0] == control.label


@pytest.mark.parametrize("tool", TOOLS.values(), ids=lambda tool: tool.name)
def test_every_tool_can_be_taken_up_and_its_usage_is_told(desk: Desk, tool: Tool) -> None:
    take_up(desk, tool)
    assert desk.window.tool == tool.name and desk.window.notice == tool.usage
    assert desk.world.entities() == []


SPAWNING = [DRAWING[one.name] for one in (*BODIES, *GROUPS) if not one.is_open]


@pytest.mark.parametrize("tool", SPAWNING, ids=lambda tool: tool.name)
def test_every_thing_there_is_can_be_spawned_with_a_click(desk: Desk, tool: Tool) -> None:
    take_up(desk, tool)
    at(desk, 1, -0.5)
    made = desk.world.entities()
    assert made
    places = [desk.world.component(e, Transform).position for e in made if desk.world.has(e, Transform)]
    assert all(abs(place.x - 1.0) < 2.5 and abs(place.y + 0.5) < 3.0 for place in places)


def test_the_transport_does_what_its_keys_do(desk: Desk) -> None:
    window = desk.window
    click(desk, "Pause")
    assert [window.pace.paused] == [True] and "Play" in desk.ui.places and "Pause" not in desk.ui.places
    steps = desk.world.steps
    click(desk, "Step")
    assert desk.world.steps == steps + 1
    click(desk, "Step back")
    assert desk.world.steps == steps
    click(desk, "Play")
    assert not window.pace.paused
    for words, speed in (("1/4x", 0.25), ("4x", 4.0), ("1x", 1.0), ("1/16x", 0.0625)):
        choose(desk, "Speed", f"Speed: {words}")
        assert window.pace.speed == speed and words in desk.ui.words
    tap(desk, "tab")
    assert window.pace.slow_motion and "1/4x" in desk.ui.words
    choose(desk, "Speed", "Speed: 1x")
    assert window.pace.speed == 1.0 and not window.pace.slow_motion


def test_restarting_opens_the_scene_as_it_was(desk: Desk) -> None:
    choose(desk, "Scenes", SCENES["stack"].title)
    circle(desk.world, (3, 3))
    desk.frames(5)
    click(desk, "Restart")
    assert len(desk.world.entities()) == len(SCENES["stack"].build().entities())
    assert desk.world.time < 0.2 and desk.window.notice.startswith("Started again")


def test_menus_do_what_keys_do(desk: Desk) -> None:
    window = desk.window
    do(desk, "O")
    assert desk.world.physics.gravity_mode == "planet"
    for label in "VTEHI":
        do(desk, label)
    assert window.overlays.arrows and window.overlays.impulses and window.trails.on
    assert not window.grid and not window.figures and "Explore" not in desk.ui.places
    circle(desk.world, (0, 0))
    do(desk, "R")
    assert desk.world.entities() == []
    do(desk, "F12")
    assert window.wants_screenshot
    do(desk, "F1")
    assert window.help and "Keys and buttons" in desk.ui.words
    do(desk, "F1")
    before, middle = window.camera.scale, window.camera.to_world(window.framing.middle)
    do(desk, "+")
    assert window.camera.scale > before
    assert (window.camera.to_world(window.framing.middle) - middle).magnitude < 1e-9
    do(desk, "-")
    assert window.camera.scale == pytest.approx(before)
    window.tool = PAN.name
    do(desk, "Esc")
    assert not window.closing, "what was made is not saved: it is pressed again"
    do(desk, "Esc")
    assert window.closing, "the line of the menu quits, whatever Esc would leave first"


def test_the_size_of_text_is_chosen_in_the_menu_and_by_keys(desk: Desk) -> None:
    height = desk.ui.places["Select"][3]
    do(desk, "Ctrl++")
    assert desk.window.text_scale == 1.15 and desk.ui.places["Select"][3] > height
    tap(desk, "-", pygame.KMOD_LCTRL)
    assert desk.window.text_scale == 1.0 and desk.ui.places["Select"][3] == height
    for _ in range(12):
        tap(desk, "=", pygame.KMOD_LCTRL)
    assert desk.window.text_scale == 2.0


def test_every_level_shows_more_and_is_marked(desk: Desk) -> None:
    circle(desk.world, (0, 0))
    rows = []
    for level in LEVELS:
        click(desk, level)
        desk.frames(30)
        assert desk.window.level == level
        rows.append(set(desk.ui.rows))
    assert rows[0] < rows[1] < rows[2]
    assert "Angular momentum" in rows[1] - rows[0] and "Together" in rows[2] - rows[1]
    click(desk, "Explore")
    assert set(desk.ui.rows) == rows[0]


def test_gravity_is_chosen_by_the_name_of_a_planet(desk: Desk) -> None:
    for name, mode, pull in (
        ("Moon", "linear", 1.62), ("Jupiter", "linear", 24.79), ("between bodies", "planet", 24.79),
        ("none", "none", 24.79), ("Earth", "linear", 9.81),
    ):  # fmt: skip
        edits = desk.world.motion_edits
        choose(desk, "Gravity", f"Gravity: {name}")
        physics = desk.world.physics
        assert (physics.gravity_mode, -physics.gravity.y) == (mode, pull)
        assert desk.world.motion_edits > edits and name in desk.ui.words


def test_f2_and_its_line_go_round_the_themes(desk: Desk) -> None:
    seen = []
    for n in range(2 * len(THEMES)):
        seen.append(desk.window.theme)
        if n % 2:
            do(desk, "F2")
        else:
            tap(desk, "f2")
        theme, surface = desk.window.theme, desk.window.canvas.surface  # type: ignore[attr-defined]
        assert surface.get_at((640, 300))[:3] in (theme.background, theme.grid, theme.axis)
        assert surface.get_at((600, 12))[:3] == theme.panel
    assert seen == [*THEMES, *THEMES]


# ---- nothing is in the way -------------------------------------------------------------------------------


def shown(level: str, size: tuple[int, int], scale: float) -> Desk:
    """Return a desk with a body selected, or figures, at a level."""
    world = load_scene("pendulum")
    desk = sized(size, world, scale)
    desk.window.level = level
    desk.frames(30)
    return desk


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("size", SIZES)
def test_nothing_overlaps_and_nothing_is_cut(
    size: tuple[int, int], scale: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    written = watch(monkeypatch)
    desk = shown("Explore", size, scale)
    for level in LEVELS:
        desk.window.level = level
        desk.frames(30)
        written.check()
        check_panels(desk)
    for entity in desk.world.entities():
        desk.window.selection.take(entity)
        desk.frames(SETTLED)
        written.check()
        check_panels(desk)
    desk.window.selection.clear()
    desk.window.scenes.recovery = offer(tmp_path)
    desk.frames(2 * SETTLED)
    written.check()
    check_panels(desk)
    desk.window.scenes.recovery.leave()
    desk.window.help = True
    desk.frames(2 * SETTLED)
    written.check()
    screen = pygame.Rect(0, 0, *size)
    assert all(screen.contains(pygame.Rect(rect)) for rect in desk.sandbox.interface.covered)
    desk.window.help = False
    for menu in (*MENUS, "More"):
        if menu not in desk.ui.places:  # there is no room beside the others
            click(desk, "...")
        click(desk, menu)
        written.check()
        lines = rects(desk)
        assert all(screen.contains(pygame.Rect(rect)) for rect in desk.sandbox.interface.covered), menu
        assert all(line.width > 0 for line in lines.values())
        tap(desk, "escape")


@pytest.mark.parametrize("width", [640, 800])
def test_menus_without_room_are_in_the_last_one(width: int) -> None:
    """In German with text of 200 % Help was cut off at 800 px."""
    desk = sized((width, 600), text_scale=2.0)
    desk.window.language = "de"
    desk.frames(SETTLED)
    assert all(rect.right <= width for rect in rects(desk).values())
    assert {"File", "..."} <= desk.ui.places.keys() and "Help" not in desk.ui.places
    for label in ("...", "Help", "All keys"):
        click(desk, label)
    assert desk.window.help


def check_panels(desk: Desk) -> None:
    """Check that the panels lie beside each other, and each widget within its panel."""
    layout = desk.sandbox.interface.layout
    panels = [pygame.Rect(rect) for rect in desk.sandbox.interface.covered]
    screen = pygame.Rect(0, 0, *desk.window.canvas.size)
    assert all(screen.contains(panel) for panel in panels)
    for one, two in combinations(panels, 2):
        assert not one.colliderect(two), f"{one} lies over {two}"
    side = pygame.Rect(layout.side)
    for label, rect in rects(desk).items():
        if label not in ROW and rect.left >= side.left and rect.top >= side.top:  # it scrolls
            assert rect.right <= side.right, label
        else:
            assert any(panel.contains(rect) for panel in panels), f"{label} at {rect} is cut"
    beside = {label: rect for label, rect in rects(desk).items() if label in ROW or rect.left < side.left}
    inside = {label: rect for label, rect in rects(desk).items() if label not in beside}
    for (a, one), (b, two) in (*combinations(beside.items(), 2), *combinations(inside.items(), 2)):
        assert not one.inflate(-2, -2).colliderect(two.inflate(-2, -2)), f"{a} lies over {b}"


@pytest.mark.parametrize("size", SIZES)
def test_every_widget_is_hit_where_it_is_drawn(size: tuple[int, int]) -> None:
    desk = sized(size)
    toolkit = desk.sandbox.interface.toolkit
    for label in desk.ui.places:
        assert toolkit.covers(middle_of(desk, label)), label


def test_the_world_has_two_thirds_of_the_usual_window() -> None:
    desk = sized((1280, 720))
    assert desk.window.figures, "with the panel at the right"
    assert 1.0 - covered_share(desk) >= 0.65
    *_, width, height = desk.sandbox.interface.room()
    assert width * height >= 0.65 * 1280 * 720


def covered_share(desk: Desk) -> float:
    """Return which share of the window panels cover, pixel by pixel."""
    width, height = desk.window.canvas.size
    mask = pygame.mask.Mask((width, height))
    for rect in desk.sandbox.interface.covered:
        mask.draw(pygame.mask.Mask(rect[2:], fill=True), rect[:2])
    return mask.count() / (width * height)


def test_the_picture_of_the_world_is_fitted_to_its_room() -> None:
    desk = sized((1280, 720), load_scene("newtons_cradle"))
    tap(desk, "f")
    left, top, width, height = desk.sandbox.interface.room()
    for entity in desk.world.entities():
        if desk.world.has(entity, Transform):
            x, y = desk.window.camera.to_screen(desk.world.component(entity, Transform).position)
            assert left <= x <= left + width and top <= y <= top + height


@pytest.mark.parametrize("size", [(1, 1), (40, 30), (200, 100), (320, 240)])
def test_a_tiny_window_does_no_harm(size: tuple[int, int]) -> None:
    desk = sized(size)
    for n in range(3):
        desk.window.help = n == 1
        if desk.world.entities():
            desk.window.selection.take(desk.world.entities()[0])
        desk.frames(8)
        circle(desk.world, (0, 0))
    for menu in ("File", "..."):
        click(desk, menu)


def test_panels_follow_the_size_of_the_window() -> None:
    desk = sized((1280, 720))
    desk.window.canvas.surface = pygame.Surface((800, 600), 0, 32)  # type: ignore[attr-defined]
    desk.frames(3)
    assert all(rect.right <= 800 and rect.bottom <= 600 for rect in rects(desk).values())


# ---- whose event it is -----------------------------------------------------------------------------------


@pytest.mark.parametrize(("button", "first"), [("left", 0), ("middle", 1), ("right", 2)])
def test_no_click_on_a_panel_reaches_the_world(desk: Desk, button: str, first: int) -> None:
    """Every widget is clicked, each with one of the buttons."""
    ball = circle(desk.world, (0, 0))
    desk.window.selection.take(ball)
    desk.frames(SETTLED)
    centre = desk.window.camera.centre
    window = Window(desk.window.canvas)
    changes = ("Delete", "Duplicate", "Hang, pin ...", "Plot", "Restart", "Step back", "Time line")
    for label in [label for label in desk.ui.places if label not in changes][first::3]:
        click(desk, label, button)
        tap(desk, "escape")
        desk.window.closing = desk.window.pace.paused = False
        desk.window.tool = window.tool
        desk.window.selection.take(ball)
        desk.frames(2)
        made = desk.world.entities()
        assert made == [ball], label
    assert not desk.world.table(Held).handles and desk.window.camera.centre == centre


@pytest.mark.parametrize("button", ["left", "middle", "right"])
def test_a_click_between_widgets_of_a_panel_is_the_panels_too(desk: Desk, button: str) -> None:
    layout = desk.sandbox.interface.layout
    for left, top, width, height in (layout.menu, layout.palette, layout.transport, layout.side):
        for place in ((left + 2, top + height - 2), (left + width - 2, top + height - 2)):
            assert all(not rect.collidepoint(place) for rect in rects(desk).values())
            click_at(desk, place, button)
    assert desk.world.entities() == []


def test_the_wheel_over_a_panel_does_not_zoom(desk: Desk) -> None:
    scale = desk.window.camera.scale
    for place, same in ((middle_of(desk, "Gravity"), True), (desk.pixel(0, 0), False)):
        point(desk, place)
        pygame.event.post(pygame.Event(pygame.MOUSEWHEEL, x=0, y=1, precise_x=0.0, precise_y=1.0))
        desk.frames(2)
        assert (desk.window.camera.scale == scale) == same


def test_a_drag_that_began_in_the_world_goes_on_over_panels_and_ends_there(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0))
    point(desk, desk.pixel(0, 0))
    button_down(desk, desk.pixel(0, 0))
    over = middle_of(desk, "Pause")
    point(desk, over, (1, 0, 0))
    desk.frames(3)
    assert desk.world.has(ball, Held)
    there = desk.world.component(ball, Transform).position
    assert (there - desk.window.camera.to_world(over)).magnitude < 0.01
    button_up(desk, over)
    assert not desk.world.has(ball, Held) and not desk.window.pace.paused, "and the button was not pressed"


def test_a_press_on_a_panel_that_ends_in_the_world_does_nothing_there(desk: Desk) -> None:
    point(desk, middle_of(desk, "Pause"))
    button_down(desk, middle_of(desk, "Pause"))
    point(desk, desk.pixel(0, 0), (1, 0, 0))
    button_up(desk, desk.pixel(0, 0))
    assert desk.world.entities() == [] and not desk.window.pace.paused
    at(desk, 0, 0)
    assert len(desk.world.entities()) == 1, "and the world has the next"


def test_a_button_that_was_let_go_while_the_window_was_away_is_not_held(desk: Desk) -> None:
    button_down(desk, middle_of(desk, "Pause"))
    pygame.event.post(pygame.Event(pygame.WINDOWFOCUSLOST))
    desk.frames(2)
    assert not desk.sandbox.interface.toolkit.dragging
    ball = circle(desk.world, (0, 0))
    point(desk, desk.pixel(2, 1))
    assert tuple(desk.window.pointer) == desk.pixel(2, 1)
    at(desk, 0, 0)
    assert desk.world.entities() == [ball] and not desk.window.pace.paused


def test_keys_typed_into_a_field_do_nothing_else(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0))
    desk.window.selection.take(ball)
    desk.frames(SETTLED)
    click(desk, "Mass.mass")
    before = desk.window.camera.scale, desk.window.grid, desk.world.physics
    write(desk, "rgohvtei p.,+-=[]f")
    for name in ("space", "tab", "backspace", "delete", "home"):
        tap(desk, name)
        if name == "tab":
            click(desk, "Mass.mass")
    assert (desk.window.camera.scale, desk.window.grid, desk.world.physics) == before
    assert desk.world.entities() == [ball] and not desk.window.pace.paused
    assert not desk.window.pace.slow_motion and not desk.window.overlays.arrows
    tap(desk, "escape")
    assert desk.window.selection.entities == (ball,), "Esc leaves the field first"
    tap(desk, "space")
    assert desk.window.pace.paused, "afterwards keys are the world's again"


def test_tab_is_slow_motion_after_a_click_on_a_panel(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0))
    desk.window.selection.take(ball)
    desk.frames(SETTLED)
    click(desk, "Measure")
    tap(desk, "tab")
    assert desk.window.pace.slow_motion and not desk.sandbox.interface.toolkit.typing


# ---- menus and scenes ------------------------------------------------------------------------------------


@pytest.mark.parametrize("opener", [*MENUS, "More", "Speed", "Gravity"])
@pytest.mark.parametrize("button", ["left", "right"])
def test_a_click_beside_a_menu_closes_it_and_does_nothing_else(desk: Desk, opener: str, button: str) -> None:
    closed = set(desk.ui.places)
    click(desk, opener)
    assert set(desk.ui.places) > closed
    click_at(desk, desk.pixel(1.5, -2.5), button)
    assert set(desk.ui.places) == closed and desk.world.entities() == []
    click_at(desk, desk.pixel(1.5, -2.5), button)
    assert len(desk.world.entities()) == 1


def test_escape_leaves_the_menu_then_the_tool_then_the_window(desk: Desk) -> None:
    click(desk, "Box")
    click(desk, "Scenes")
    closed = "A ball on a floor"
    assert closed in desk.ui.places
    for expected in ("menu", "tool", "question", "window"):
        tap(desk, "escape")
        assert closed not in desk.ui.places
        assert (desk.window.tool == HAND.name) == (expected != "menu")
        assert desk.window.closing == (expected == "window")


def test_escape_leaves_the_help_then_what_is_selected(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0))
    desk.window.selection.take(ball)
    desk.window.help = True
    desk.frames(SETTLED)
    tap(desk, "escape")
    assert [desk.window.help, *desk.window.selection.entities] == [False, ball]
    tap(desk, "escape")
    assert [*desk.window.selection.entities, desk.window.closing] == [False]


def test_every_scene_is_listed_by_its_title_and_opens(desk: Desk) -> None:
    click(desk, "Scenes")
    assert {scene.title for scene in SCENES.values()} <= set(desk.ui.places)
    tap(desk, "escape")
    for name in ("stack", "newtons_cradle"):
        choose(desk, "Scenes", SCENES[name].title)
        assert desk.world.title == SCENES[name].title and SCENES[name].title in desk.ui.words
        assert SCENES["drop"].title not in desk.ui.places, "the menu is closed"


def test_files_are_offered_and_a_bad_one_changes_nothing(desk: Desk, tmp_path: Path) -> None:
    saved = SCENES["drop"].build()
    saved.title = "Mine"
    save_scene(saved, tmp_path / "mine.json")
    (tmp_path / "bad.json").write_text(
        '{"format": "physicslab-scene/1", "entities": [{"Mass": {"mass": -1}}]}'
    )
    (tmp_path / "other.json").write_text("{}")
    ball = circle(desk.world, (0, 0))
    click(desk, "Scenes")
    assert {"mine.json", "bad.json"} <= set(desk.ui.places) and "other.json" not in desk.ui.places
    click(desk, "bad.json")
    assert "Not opened" in desk.window.notice and "mass" in desk.window.notice
    assert desk.window.notice_failed and desk.world.entities() == [ball]
    choose(desk, "Scenes", "mine.json")
    assert desk.world.title == "Mine"


def test_more_files_than_fit_are_reached_by_the_wheel(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for n in range(60):
        save_scene(SCENES["drop"].build(), tmp_path / f"a-rather-long-name-of-a-scene-{n}.json")
    desk = sized((640, 480))
    click(desk, "Scenes")
    screen, last = pygame.Rect(0, 0, 640, 480), "a-rather-long-name-of-a-scene-0.json"
    assert len([label for label in desk.ui.places if label.endswith(".json")]) == 60
    assert not screen.contains(rects(desk)[last])
    point(desk, middle_of(desk, "a-rather-long-name-of-a-scene-59.json"))  # own files come first
    for _ in range(60):
        if screen.contains(rects(desk)[last]):
            break
        pygame.event.post(pygame.Event(pygame.MOUSEWHEEL, x=0, y=-2, precise_x=0.0, precise_y=-2.0))
        desk.frames(2)
    assert screen.contains(rects(desk)[last])
    click(desk, last)
    assert desk.window.scenes.source == tmp_path / last


# ---- tools -----------------------------------------------------------------------------------------------


def test_the_pan_tool_moves_the_view_and_spawns_nothing(desk: Desk) -> None:
    circle(desk.world, (0, 0))
    take_up(desk, PAN)
    centre = desk.window.camera.centre
    desk.press(0, 0)
    desk.move(1, 0)
    desk.frames()
    desk.release(1, 0)
    desk.frames()
    assert desk.window.camera.centre.x == pytest.approx(centre.x - 1.0)
    assert len(desk.world.entities()) == 1 and not desk.world.table(Held).handles


def test_a_tool_still_drags_bodies(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0))
    click(desk, "Box")
    desk.press(0, 0)
    desk.frames()
    assert desk.world.has(ball, Held)
    desk.release(0, 0)
    desk.frames()
    assert desk.world.entities() == [ball]
    at(desk, 2, 1)
    assert {desk.world.component(e, Shape).kind for e in desk.world.entities()} == {"circle", "box"}


def test_a_spring_is_drawn_with_the_mouse_alone(desk: Desk) -> None:
    a, b = circle(desk.world, (-1, 0)), circle(desk.world, (1, 0))
    click(desk, "Spring")
    desk.press(-1, 0)
    desk.frames()
    desk.move(1, 0)
    desk.frames()
    desk.release(1, 0)
    desk.frames()
    springs = [e for e in desk.world.entities() if desk.world.has(e, Spring)]
    assert len(springs) == 1
    spring = desk.world.component(springs[0], Spring)
    assert (spring.a, spring.b) == (a, b)
    click(desk, "Erase")
    at(desk, 1, 0)
    assert not desk.world.has(b, Transform) and desk.world.has(a, Transform)


def test_tools_stand_in_groups(desk: Desk) -> None:
    def edges(tool: Tool) -> tuple[int, int]:
        _, top, _, height = desk.ui.places[tool.title]
        return top, top + height

    apart = [edges(b)[0] - edges(a)[1] for a, b in pairwise(PALETTE)]
    begins = {group[0] for group in TOOL_GROUPS[1:]}
    between = [gap for gap, tool in zip(apart, PALETTE[1:], strict=True) if tool in begins]
    within = [gap for gap, tool in zip(apart, PALETTE[1:], strict=True) if tool not in begins]
    assert min(between) >= max(within) + 0.4 * desk.sandbox.interface.text


def test_the_tool_in_hand_is_marked(desk: Desk) -> None:
    accent, surface = desk.window.theme.accent, desk.window.canvas.surface  # type: ignore[attr-defined]
    for tool in PALETTE:
        take_up(desk, tool)
        point(desk, desk.pixel(0, 0))
        desk.frames(SETTLED)  # pictures that are not under the cursor are painted in turn
        marked = []
        for other in PALETTE:
            left, top, width, _ = desk.ui.places[other.title]
            if surface.get_at((left + width - 5, top + 5))[:3] == accent:
                marked.append(other)
        assert marked == [tool]
    take_up(desk, MORE_TOOLS[0])
    assert any(MORE_TOOLS[0].title in words for words in desk.ui.words), "it is named where More was"


# ---- selection -------------------------------------------------------------------------------------------


def with_shift(desk: Desk, x: float, y: float) -> None:
    pygame.key.set_mods(pygame.KMOD_LSHIFT)
    try:
        at(desk, x, y)
    finally:
        pygame.key.set_mods(0)


def test_a_click_selects_shift_adds_and_empty_space_clears(desk: Desk) -> None:
    click(desk, "Select")
    a, b, c = circle(desk.world, (-2, 0)), box(desk.world, (2, 0)), box(desk.world, (0, -2), static=True)
    selection = desk.window.selection
    at(desk, -2, 0)
    assert [*selection.entities] == [a]
    at(desk, 2, 0)
    assert [*selection.entities] == [b]
    with_shift(desk, -2, 0)
    with_shift(desk, 0, -2)
    assert [*selection.entities] == [b, a, c] and "3 selected" in desk.ui.words
    with_shift(desk, -2, 0)
    assert [*selection.entities] == [b, c]
    with_shift(desk, 3, 3)
    assert [*selection.entities] == [b, c], "Shift and a click beside change nothing"
    at(desk, 3, 2)
    assert [*selection.entities] == [] and desk.world.entities() == [a, b, c]


def test_what_is_selected_is_outlined_and_let_go_of_when_it_is_removed(desk: Desk) -> None:
    a = circle(desk.world, (0, 0), radius=0.5)
    surface, accent = desk.window.canvas.surface, desk.window.theme.accent  # type: ignore[attr-defined]
    click(desk, "Select")

    def outlined() -> bool:
        x, y = desk.pixel(0.5, 0)
        return any(surface.get_at((x + n, y))[:3] == accent for n in range(2, 8))

    assert not outlined()
    at(desk, 0, 0)
    desk.world.component(a, Transform).position = Vector2(0, 0)
    desk.frames()
    assert outlined()
    click(desk, "Delete")
    assert desk.world.entities() == [] and desk.window.selection.entities == ()
    assert "Kinetic energy" in desk.ui.rows, "the panel shows the world again"


def test_a_selection_does_not_outlive_its_world(desk: Desk) -> None:
    desk.window.selection.take(circle(desk.world, (0, 0)))
    desk.frames(SETTLED)
    choose(desk, "Scenes", SCENES["stack"].title)
    assert desk.window.selection.entities == ()


# ---- the offer after a crash -----------------------------------------------------------------------------


def offer(folder: Path) -> Recovery:
    """Leave a session behind as a crash does, and return the offer of it."""
    session = Session.begin(folder)
    save_scene(load_scene("stack"), session.path)
    session.release()
    return Recovery(Session.abandoned(folder))


def test_the_world_lies_below_the_offer(tmp_path: Path) -> None:
    desk = sized((1280, 720), load_scene("stack"))
    desk.window.framing.fit(desk.world)
    before = desk.window.framing.room()
    desk.window.scenes.recovery = offer(tmp_path)
    desk.frames(SETTLED)
    _, top, _, height = desk.ui.places["Discard"]
    room = desk.window.framing.room()
    assert room[1] >= top + height and room[1] + room[3] == before[1] + before[3]
    assert desk.window.camera.to_screen(Vector2(0.0, 0.0))[1] > top + height
    desk.window.scenes.recovery.leave()
    desk.frames(SETTLED)
    assert desk.window.framing.room() == before


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("size", SIZES)
def test_the_offer_lies_over_no_words(size: tuple[int, int], scale: float, tmp_path: Path) -> None:
    desk = sized(size, None, scale)
    desk.window.scenes.recovery = offer(tmp_path)
    desk.window.pace.paused = True
    desk.frames(3 * SETTLED)
    left, top, width, height = desk.sandbox.interface.visible
    assert desk.window.scenes.recovery.words in desk.ui.words
    for label in ("Restore it", "Discard"):
        rect = rects(desk)[label]
        assert rect.bottom <= top and left <= rect.left and rect.right <= left + width
    assert all(not pygame.Rect(taken).colliderect(pygame.Rect(left, top - height, width, height))
               for taken in desk.window.overlays.covered
               if tuple(taken) not in map(tuple, desk.sandbox.interface.covered))  # fmt: skip
    click(desk, "Discard")
    assert not desk.window.scenes.recovery.offered and "Discard" not in desk.ui.places
    assert desk.sandbox.interface.visible[1] < top and not list(tmp_path.iterdir())


def test_an_offer_of_several_sessions_says_so(desk: Desk, tmp_path: Path) -> None:
    """After *Discard* the older one was offered in the same words, as if it had not been discarded."""
    offer(tmp_path).leave()
    recovery = desk.window.scenes.recovery = offer(tmp_path)
    desk.frames(SETTLED)
    assert recovery.words.startswith("2 sessions are kept, the last as of ")
    assert language("de").reword(recovery.words).startswith("2 Sitzungen sind aufgehoben")
    click(desk, "Discard")
    assert recovery.words.startswith("Your last session is kept")
    recovery.leave()


def test_a_click_beside_the_offer_leaves_it(desk: Desk, tmp_path: Path) -> None:
    desk.window.scenes.recovery = offer(tmp_path / "state")
    desk.frames(SETTLED)
    at(desk, 0, 0)
    tap(desk, "space")
    assert desk.window.scenes.recovery.offered and desk.window.pace.paused, "keys stay with the scene"
    desk.window.scenes.recovery.leave()


# ---- idle ------------------------------------------------------------------------------------------------


def test_panels_of_an_idle_window_are_built_a_few_times_a_second(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    looked = []
    on = Control.on

    def watched(control: Control, world: World, window: Window) -> bool:
        looked.append(control)
        return on(control, world, window)

    monkeypatch.setattr(Control, "on", watched)
    toolkit = desk.sandbox.interface.toolkit
    desk.frames(10)
    built, painted = toolkit.built, toolkit.pictures.painted
    desk.frames(60)
    assert toolkit.built - built <= 6 and not looked
    tap(desk, "space")
    desk.frames(30)
    painted = toolkit.pictures.painted
    desk.frames(60)
    assert toolkit.pictures.painted == painted, "nothing changes while time stands still"
