"""No click, key or file ends the window or changes a scene that it was not meant for."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pygame
import pytest
from deadline import deadline
from desk import Desk, click, empty_world, sized, tap, write
from random_events import HOSTILE_NAMES, Hands, hostile_folder, with_hostile_words

from physicslab import World, load_scene
from physicslab.components import Mass, Name, Slider, Spring, Transform
from physicslab.ecs.vector import Vector2
from physicslab.prefabs import circle
from physicslab.view.controls import file_actions
from physicslab.view.controls.tools import TOOLS
from physicslab.view.toolkit.windows import widget_label
from physicslab.view.window.context import Picking
from physicslab.view.window.impacts import COLUMNS, ImpactList
from physicslab.view.window.lab_process import LabProcess

LEFT, SIDE = 1, 6


@pytest.fixture(scope="module")
def shared() -> Iterator[Desk]:
    yield sized((1280, 900))


@pytest.fixture
def desk(shared: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Desk:
    """Return the window of all these tests, in an empty folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(LabProcess, "begin", lambda *_: None)
    show(shared, empty_world())
    return shared


def show(desk: Desk, world: World) -> World:
    desk.window.scenes.next_world = world
    desk.frames(4)
    desk.window.pace.halt()
    return world


def post(kind: int, **what: Any) -> None:
    pygame.event.post(pygame.Event(kind, **what))


def click_pixel(desk: Desk, place: tuple[int, int]) -> None:
    for kind in (pygame.MOUSEBUTTONDOWN, pygame.MOUSEBUTTONUP):
        post(kind, button=LEFT, pos=place, touch=False)
        desk.frames(2)


@pytest.mark.skipif(sys.platform != "linux", reason="names that are not UTF-8, and pipes")
@pytest.mark.parametrize(
    ("seed", "count"),
    [
        (4, 45),
        *(pytest.param(seed, 250, marks=(pytest.mark.slow, pytest.mark.seeds)) for seed in range(100, 110)),
    ],
)
def test_random_events_end_nothing(
    seed: int, count: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(LabProcess, "begin", lambda *_: None)
    files = hostile_folder(tmp_path)
    hands = Hands(sized((960, 600), with_hostile_words(load_scene("spring_chain"))), files, seed)
    for _ in range(count):
        hands.act()
    assert not list(tmp_path.rglob("*.physicslab-tmp")), "what was written is there whole"


# ---- what a widget is called is not its identity -----------------------------------------------------------


def test_labels_are_told_apart_whatever_they_hold() -> None:
    names = [os.fsdecode(name) for name in HOSTILE_NAMES] + ["a", "a\0", "a#b", "a##b", "a###b", "###b", "b"]
    labels = [widget_label(name, name) for name in names]
    assert len({label.rpartition("###")[2] for label in labels}) == len(names)
    for label in labels:
        label.encode()
        assert "\0" not in label and label.count("##") == 1, "only the mark itself parts words from identity"


@pytest.mark.skipif(sys.platform != "linux", reason="names that are not UTF-8")
def test_the_gallery_the_menu_and_the_list_show_files_of_any_name(desk: Desk, tmp_path: Path) -> None:
    for path in hostile_folder(tmp_path):
        if path.is_file():
            desk.window.scenes.recent.note(path)
    tap(desk, "l")
    desk.frames(len(HOSTILE_NAMES) + 4)
    assert any("caf" in words for words in desk.ui.words)
    tap(desk, "escape")
    tap(desk, "o", pygame.KMOD_CTRL)
    desk.frames(len(HOSTILE_NAMES))
    assert sum("caf" in words for words in desk.ui.words) == 2, "among the last few, and in its folder"
    desk.window.scenes.opening = None


def test_the_end_of_a_spring_is_chosen_by_what_it_is_and_not_by_what_it_is_called(desk: Desk) -> None:
    world = show(desk, empty_world())
    bodies = [circle(world, (float(n), 0.0)) for n in range(3)]
    spring = world.spawn(Spring(a=bodies[0], b=bodies[1], rest_length=1.0, stiffness=1.0))
    world.add(bodies[2], Name("fixed point"))
    desk.window.selection.take(spring)
    desk.frames(6)
    click(desk, "Spring.b")
    options = [label for label in desk.ui.places if label == "Spring.b: fixed point"]
    assert options, "the words stand there twice: for the body, and for none"
    tap(desk, "escape")
    world.add(spring, Spring(a=bodies[0], b=bodies[2], rest_length=1.0, stiffness=1.0))
    desk.frames(4)
    click(desk, "Spring.b")
    click(desk, "Spring.b: fixed point")
    assert desk.world.component(spring, Spring).b is None, "the first line is none at all"


# ---- what was begun ends with its scene or its entity ------------------------------------------------------


def picking(desk: Desk) -> World:
    world = show(desk, load_scene("spring_chain"))
    desk.window.selection.take(world.batch(Spring).entities.tolist()[0])
    desk.frames(6)
    click(desk, next(label for label in desk.ui.places if label.endswith(" click")))
    assert desk.window.picking is not None
    return world


def springs(world: World) -> list[str]:
    return [repr(world.component(entity, Spring)) for entity in world.batch(Spring).entities.tolist()]


def test_a_pending_pick_changes_no_other_scene(desk: Desk) -> None:
    picking(desk)
    world = show(desk, load_scene("newtons_cradle"))
    before = springs(world)
    place = world.component(world.batch(Transform).entities.tolist()[2], Transform).position
    click_pixel(desk, desk.pixel(place.x, place.y))
    assert springs(world) == before and desk.window.picking is None


@pytest.mark.parametrize("key", ["r", "delete"])
def test_a_pending_pick_ends_with_its_spring(key: str, desk: Desk) -> None:
    picking(desk)
    tap(desk, key)
    assert desk.window.picking is None
    desk.window.picking = Picking(987654, Spring, "b")  # gone in the same frame as the click comes
    click_pixel(desk, (500, 300))
    assert desk.window.picking is None


def test_a_slider_that_is_held_changes_no_other_scene(desk: Desk) -> None:
    def scene() -> tuple[World, int]:
        world = empty_world()
        body = circle(world, (0.0, 0.0))
        world.spawn(Slider("Mass.mass", body, 1.0, 9.0))
        return world, body

    world, _ = scene()
    show(desk, world)
    left, top, width, height = desk.ui.places["Slider 1"]
    place = left + width // 2, top + height // 2
    post(pygame.MOUSEMOTION, pos=place, rel=(0, 0), buttons=(0, 0, 0), touch=False)
    desk.frames(2)
    post(pygame.MOUSEBUTTONDOWN, button=LEFT, pos=place, touch=False)
    desk.frames(3)
    other, body = scene()
    mass = other.component(body, Mass).mass
    show(desk, other)
    post(pygame.MOUSEBUTTONUP, button=LEFT, pos=place, touch=False)
    desk.frames(4)
    assert other.component(body, Mass).mass == mass


def test_what_is_half_written_is_written_into_no_other_scene(desk: Desk) -> None:
    desk.window.level, desk.window.figures = "Engineer", True
    show(desk, load_scene("drop"))
    desk.window.tool = "select"
    desk.frames(4)
    click(desk, "dt")
    write(desk, "0.5")
    other = show(desk, load_scene("pendulum"))
    before, edits = other.simulation.dt, other.motion_edits
    click_pixel(desk, (600, 700))
    desk.window.level = "Explore"
    assert (other.simulation.dt, other.motion_edits) == (before, edits)


def test_a_pin_that_is_dragged_moves_none_of_another_scene(desk: Desk) -> None:
    def scene() -> tuple[World, int]:
        world = empty_world(gravity_mode="none")
        body = circle(world, (0.0, 0.0))
        return world, world.spawn(Spring(a=body, anchor_b=(0.0, 2.0), rest_length=2.0))

    world, _ = scene()
    show(desk, world)
    desk.window.tool = "select"
    x, y = desk.pixel(0.0, 2.0)
    for kind, place in ((pygame.MOUSEBUTTONDOWN, (x, y)), (pygame.MOUSEMOTION, (x + 40, y))):
        post(kind, pos=place, button=LEFT, rel=(0, 0), buttons=(1, 0, 0), touch=False)
        desk.frames()
    assert desk.window.pins.dragged is not None
    other, spring = scene()
    show(desk, other)
    post(pygame.MOUSEMOTION, pos=(x + 80, y), rel=(0, 0), buttons=(1, 0, 0), touch=False)
    desk.frames()
    post(pygame.MOUSEBUTTONUP, pos=(x + 80, y), button=LEFT, touch=False)
    desk.frames()
    assert other.component(spring, Spring).anchor_b == Vector2(0.0, 2.0)


def test_the_errors_of_one_scene_are_not_shown_for_another(desk: Desk) -> None:
    desk.window.error_study.shown = True
    show(desk, load_scene("drop"))
    assert not desk.window.error_study.shown


# ---- what ended the window ---------------------------------------------------------------------------------


def test_a_table_of_no_impacts_is_sorted_and_chosen_from() -> None:
    impacts = ImpactList()
    impacts.only_selected = True
    for impacts.sorted_by in COLUMNS:
        assert impacts.order([3]).tolist() == [] and impacts.beside(0.0, 1, [3]) is None


def test_a_side_button_pans_nothing(desk: Desk) -> None:
    desk.window.tool = "pan"
    for kind, button in (
        (pygame.MOUSEMOTION, 0),
        (pygame.MOUSEBUTTONDOWN, LEFT),
        (pygame.MOUSEBUTTONDOWN, SIDE),
    ):
        post(kind, pos=(500, 300), button=button, rel=(0, 0), buttons=(0, 0, 0), touch=False)
        desk.frames()
    before = desk.window.camera.centre
    post(pygame.MOUSEMOTION, pos=(520, 310), rel=(20, 10), buttons=(1, 0, 0), touch=False)
    desk.frames()
    assert desk.window.camera.centre != before, "the left button goes on"
    post(pygame.MOUSEBUTTONUP, pos=(520, 310), button=LEFT, touch=False)
    desk.frames()


def test_tab_after_a_press_in_the_world_ended_the_writing(desk: Desk) -> None:
    tap(desk, "w")
    click_pixel(desk, (400, 200))
    write(desk, "abc")
    post(pygame.MOUSEBUTTONDOWN, button=2, pos=(500, 400), touch=False)
    desk.frames()
    tap(desk, "tab")
    post(pygame.MOUSEBUTTONUP, button=2, pos=(500, 400), touch=False)
    desk.frames()


@pytest.mark.parametrize("tool", TOOLS)
def test_points_snap_too(tool: str, desk: Desk) -> None:
    desk.window.tool, desk.window.snapping.on = tool, True
    post(pygame.MOUSEMOTION, pos=(500, 300), rel=(0, 0), buttons=(0, 0, 0), touch=False)
    desk.frames(2)
    desk.window.snapping.on = False


def test_no_key_ends_the_window_in_a_folder_that_was_removed(
    desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    for name in ("n", "o", "l", "s", "shift+s"):
        *held, key = name.split("+")
        tap(desk, key, pygame.KMOD_CTRL | (pygame.KMOD_SHIFT if held else 0))
    assert not desk.window.closing and desk.window.notice_failed
    desk.window.scenes.naming = desk.window.scenes.opening = None
    desk.window.scenes.shows_gallery = False


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no pipes with names")
def test_what_never_ends_or_never_begins_is_refused_at_once(desk: Desk, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.json")
    (tmp_path / "zeros.json").symlink_to("/dev/zero")
    for path in (tmp_path / "pipe.json", tmp_path / "zeros.json"):
        with deadline(path.name, seconds=10):
            post(pygame.DROPFILE, file=str(path), window=None)
            desk.frames(4)
            file_actions.begin_open(desk.world, desk.window)
            opening = desk.window.scenes.opening
            assert opening is not None
            file_actions.open_named(desk.world, desk.window, str(path))
            assert "must be a plain file" in desk.window.notice and "must be" in opening.refused
            desk.frames(3)
            desk.window.scenes.opening = None
            tap(desk, "l")
            tap(desk, "l")
