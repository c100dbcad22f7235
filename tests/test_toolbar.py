"""The toolbar, its tools and menus: everything that has a key can be done with the mouse."""

from collections.abc import Iterator
from pathlib import Path

import pygame
import pytest
from desk import Desk, empty_world

from physicslab.components import Held, Shape, Spring, Transform
from physicslab.files.scene import save_scene
from physicslab.prefabs import circle
from physicslab.scenes import SCENES
from physicslab.view.canvas.pygame_canvas import PygameCanvas
from physicslab.view.canvas.theme import THEMES
from physicslab.view.controls.controls import CONTROLS, Control
from physicslab.view.controls.tools import HAND, PAN, SPAWN_TOOLS, Tool
from physicslab.view.window.window import Window
from physicslab.world import World

SIZES = [(640, 480), (800, 600), (1280, 720), (1920, 1080)]


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Desk]:
    monkeypatch.chdir(tmp_path)
    yield Desk(empty_world(gravity=(0, 0)))


def sized(size: tuple[int, int]) -> Desk:
    pygame.display.init()
    pygame.display.set_mode((64, 64))
    return Desk(empty_world(), PygameCanvas(pygame.Surface(size, 0, 32)))


def click(desk: Desk, rect: tuple[int, int, int, int], button: int = 1) -> None:
    """Move to the middle of a widget, press and let go."""
    place = (rect[0] + rect[2] // 2, rect[1] + rect[3] // 2)
    pygame.event.post(pygame.Event(pygame.MOUSEMOTION, pos=place, rel=(0, 0), buttons=(0, 0, 0)))
    desk.frames()
    pygame.event.post(pygame.Event(pygame.MOUSEBUTTONDOWN, button=button, pos=place))
    desk.frames()
    pygame.event.post(pygame.Event(pygame.MOUSEBUTTONUP, button=button, pos=place))
    desk.frames(2)


def press(desk: Desk, label: str, button: int = 1) -> None:
    click(desk, desk.sandbox.toolbar.places[label], button)


def choose(desk: Desk, title: str) -> None:
    lines = desk.sandbox.toolbar.lines
    click(desk, next(rect for words, rect in lines.items() if words.removeprefix("• ") == title))


def at(desk: Desk, x: float, y: float) -> None:
    desk.press(x, y)
    desk.release(x, y)
    desk.frames()


def test_every_control_with_an_action_has_a_button_with_a_tip() -> None:
    for control in CONTROLS:
        if control.action is not None or control.tool is not None:
            assert control.icon and control.tip and control.group, control.label
    assert {control.label for control in CONTROLS if not control.icon} == {"Wheel"}, "+ and - do that"


@pytest.mark.parametrize("size", SIZES)
def test_every_button_fits_or_is_in_the_last_ones_menu(size: tuple[int, int]) -> None:
    desk = sized(size)
    desk.frames()
    places = desk.sandbox.toolbar.places
    screen = pygame.Rect(0, 0, *size)
    rects = [pygame.Rect(rect) for rect in places.values()]
    assert all(screen.contains(rect) for rect in rects)
    assert all(rect.collidelist(rects[n + 1 :]) == -1 for n, rect in enumerate(rects))
    hidden = [control for control in CONTROLS if control.icon and control.label not in places]
    if hidden:
        press(desk, "")
        assert {f"{control.tip}  ({control.label})" for control in hidden} <= {
            words.removeprefix("• ") for words in desk.sandbox.toolbar.lines
        }
        assert all(screen.contains(pygame.Rect(rect)) for rect in desk.sandbox.toolbar.lines.values())


@pytest.mark.parametrize("button", [1, 2, 3])
def test_no_click_on_a_button_reaches_the_world(desk: Desk, button: int) -> None:
    left_out = ("Esc", "R", "Ctrl+O")
    for label in [label for label in desk.sandbox.toolbar.places if label not in left_out]:
        press(desk, label, button)
        desk.window.help = False
        desk.window.error_study.stop()
    assert desk.world.entities() == []
    assert not desk.window.closing


def test_a_click_beside_the_buttons_is_the_toolbars_too(desk: Desk) -> None:
    click(desk, (2, 4, 2, 2))
    click(desk, (2, 4, 2, 2), 3)
    assert desk.world.entities() == []


def test_buttons_do_what_their_keys_do(desk: Desk) -> None:
    window = desk.window
    press(desk, "Space")
    assert window.pace.paused
    press(desk, "Space")
    press(desk, "Space")
    press(desk, ".")
    assert desk.world.steps > 0 and window.pace.paused
    press(desk, "Tab")
    assert window.pace.slow_motion
    press(desk, "O")
    assert desk.world.physics.gravity_mode == "planet"
    for label in "VTEHI":
        press(desk, label)
    assert window.overlays.arrows and window.overlays.impulses and window.trails.on
    assert not window.grid and not window.figures
    circle(desk.world, (0, 0))
    press(desk, "R")
    assert desk.world.entities() == []
    press(desk, "F12")
    assert window.wants_screenshot
    press(desk, "Esc")
    assert window.closing


def test_speeds_and_zoom_need_no_keys_and_no_wheel(desk: Desk) -> None:
    press(desk, "[")
    assert desk.window.pace.speed == 0.5
    press(desk, "]")
    press(desk, "]")
    assert desk.window.pace.speed == 2.0
    before, middle = desk.window.camera.scale, desk.window.camera.to_world(desk.window.middle)
    press(desk, "+")
    assert desk.window.camera.scale > before
    assert (desk.window.camera.to_world(desk.window.middle) - middle).magnitude < 1e-9
    press(desk, "-")
    assert desk.window.camera.scale == pytest.approx(before)


def test_the_pan_tool_moves_the_view_and_spawns_nothing(desk: Desk) -> None:
    circle(desk.world, (0, 0))
    press(desk, "Middle")
    assert desk.window.tool == PAN.name
    centre = desk.window.camera.centre
    desk.press(0, 0)
    desk.move(1, 0)
    desk.frames()
    desk.release(1, 0)
    desk.frames()
    assert desk.window.camera.centre.x == pytest.approx(centre.x - 1.0)
    assert len(desk.world.entities()) == 1 and not desk.world.table(Held).handles


@pytest.mark.parametrize("tool", SPAWN_TOOLS, ids=lambda tool: tool.name)
def test_everything_in_the_chooser_can_be_spawned_with_a_click(desk: Desk, tool: Tool) -> None:
    press(desk, "N")
    (title,) = [spawn.title for spawn in SPAWN_TOOLS if spawn is tool]
    choose(desk, title)
    assert desk.window.tool == tool.name and not desk.window.menu
    assert desk.world.entities() == []
    at(desk, 1, -0.5)
    made = desk.world.entities()
    assert made
    places = [desk.world.component(e, Transform).position for e in made if desk.world.has(e, Transform)]
    assert all(abs(place.x - 1.0) < 2.5 and abs(place.y + 0.5) < 3.0 for place in places)
    desk.frames(5)


def test_a_tool_still_drags_bodies(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0))
    press(desk, "Right")
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
    press(desk, "S")
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
    press(desk, "Del")
    at(desk, 1, 0)
    assert not desk.world.has(b, Transform) and desk.world.has(a, Transform)


def test_escape_leaves_the_menu_then_the_tool_then_the_window(desk: Desk) -> None:
    press(desk, "Right")
    press(desk, "N")
    assert desk.window.menu == "spawn"
    for expected in ("menu", "tool", "window"):
        desk.key("escape")
        desk.frames()
        assert not desk.window.menu
        assert (desk.window.tool == HAND.name) == (expected != "menu")
        assert desk.window.closing == (expected == "window")


def test_the_picker_lists_every_scene_by_its_title_and_opens_it(desk: Desk) -> None:
    press(desk, "L")
    lines = {words.removeprefix("• ") for words in desk.sandbox.toolbar.lines}
    assert {scene.title for scene in SCENES.values()} <= lines
    choose(desk, SCENES["stack"].title)
    assert desk.world.title == SCENES["stack"].title
    assert desk.sandbox.toolbar.lines == {}


def test_a_click_beside_a_menu_closes_it_and_does_nothing_else(desk: Desk) -> None:
    press(desk, "L")
    at(desk, -3, 0)
    assert not desk.window.menu and desk.world.entities() == []
    at(desk, -3, 0)
    assert len(desk.world.entities()) == 1


def test_files_are_offered_and_a_bad_one_changes_nothing(desk: Desk, tmp_path: Path) -> None:
    saved = SCENES["drop"].build()
    saved.title = "Mine"
    save_scene(saved, tmp_path / "mine.json")
    (tmp_path / "bad.json").write_text(
        '{"format": "physicslab-scene/1", "entities": [{"Mass": {"mass": -1}}]}'
    )
    (tmp_path / "other.json").write_text("{}")
    ball = circle(desk.world, (0, 0))
    press(desk, "L")
    lines = {words.removeprefix("• ") for words in desk.sandbox.toolbar.lines}
    assert {"mine.json", "bad.json"} <= lines and "other.json" not in lines
    choose(desk, "bad.json")
    assert "Not opened" in desk.window.notice and "mass" in desk.window.notice
    assert desk.window.notice_failed and desk.world.entities() == [ball]
    press(desk, "L")
    choose(desk, "mine.json")
    assert desk.world.title == "Mine"


def test_more_files_than_fit_are_on_further_pages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for n in range(120):
        (tmp_path / f"a-rather-long-name-of-a-scene-{n}.json").write_text('{"format": "physicslab-scene/1"}')
    desk = sized((640, 480))
    desk.key("l")
    desk.frames(2)
    seen: set[str] = set()
    for _ in range(12):
        lines = desk.sandbox.toolbar.lines
        assert all(pygame.Rect(0, 0, 640, 480).contains(pygame.Rect(rect)) for rect in lines.values())
        seen |= set(lines)
        click(desk, next(rect for words, rect in lines.items() if words.startswith("More (")))
    assert sum(words.endswith(".json") for words in seen) == 120


def test_a_release_over_a_button_still_lets_a_body_go(desk: Desk) -> None:
    ball = circle(desk.world, (0, 0))
    desk.press(0, 0)
    desk.frames()
    x, y, *_ = desk.sandbox.toolbar.places["Space"]
    pygame.event.post(pygame.Event(pygame.MOUSEBUTTONUP, button=1, pos=(x + 4, y + 4)))
    desk.frames()
    assert not desk.world.has(ball, Held) and not desk.window.pace.paused


def test_f2_and_its_button_go_round_the_themes(desk: Desk) -> None:
    seen = []
    for n in range(2 * len(THEMES)):
        seen.append(desk.window.theme)
        if n % 2:
            press(desk, "F2")
        else:
            desk.key("f2")
            desk.frames(30)
        surface = desk.window.canvas.surface  # type: ignore[attr-defined]
        assert surface.get_at((640, 300))[:3] in (desk.window.theme.background, desk.window.theme.grid,
                                                  desk.window.theme.axis)  # fmt: skip
        assert surface.get_at((2, 2))[:3] == desk.window.theme.panel
    assert seen == [*THEMES, *THEMES]


@pytest.mark.parametrize("size", [(1, 1), (40, 30), (200, 100), (320, 240)])
def test_menus_in_a_tiny_window_do_no_harm(size: tuple[int, int]) -> None:
    desk = sized(size)
    for menu in ("scenes", "spawn", "more"):
        desk.window.menu = menu
        desk.frames(8)


def test_the_buttons_follow_the_size_of_the_window() -> None:
    desk = sized((1280, 720))
    canvas = desk.window.canvas
    canvas.surface = pygame.Surface((800, 600), 0, 32)  # type: ignore[attr-defined]
    desk.frames(2)
    assert max(rect[0] + rect[2] for rect in desk.sandbox.toolbar.places.values()) <= 800


def test_an_idle_toolbar_looks_at_what_is_on_ten_times_a_second_at_most(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    looked = []
    on = Control.on

    def watched(control: Control, world: World, window: Window) -> bool:
        looked.append(control)
        return on(control, world, window)

    monkeypatch.setattr(Control, "on", watched)
    desk.frames(60)
    assert len(looked) <= 11 * (len(CONTROLS) + 1)
