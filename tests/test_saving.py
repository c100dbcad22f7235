"""Ctrl+S and Ctrl+O: scene files from the window, and back into it."""

import os
from pathlib import Path

import pygame
import pytest
from desk import Desk, bits, empty_world
from test_hud import frame, recorded

from physicslab.components import Held, Velocity
from physicslab.files.scene import load_scene, save_scene
from physicslab.prefabs import circle
from physicslab.view.controls.file_actions import new_scene_paths, newest_scene

CTRL = pygame.KMOD_LCTRL


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_saving_and_opening_brings_back_every_bit(folder: Path) -> None:
    desk = Desk(load_scene("newtons_cradle"))
    desk.key("space")
    desk.frames(3)
    desk.key(".")
    desk.key("s", CTRL)
    desk.frames()
    saved, state = desk.world, bits(load_scene(folder / "newtons_cradle-1.json"))
    assert str(folder / "newtons_cradle-1.json") in desk.window.notice
    desk.key("r")
    desk.frames()
    desk.key("o", CTRL)
    desk.frames()
    assert desk.world is not saved and bits(desk.world) == state
    assert "Opened" in desk.window.notice
    assert {"InputSystem", "RenderSystem", "HudSystem"} <= {s.name for s in desk.world.schedule.running}
    desk.key("space")
    desk.frames(10)
    assert bits(desk.world) != state, "the world that was opened runs"


def test_nothing_is_ever_overwritten(folder: Path) -> None:
    desk = Desk(load_scene("drop"))
    for _ in range(3):
        desk.key("s", CTRL)
    desk.frames()
    assert sorted(path.name for path in folder.iterdir()) == ["drop-1.json", "drop-2.json", "drop-3.json"]


@pytest.mark.parametrize(
    ("name", "file"),
    [("", "scene-1.json"), ("a/b c", "a-b-c-1.json"), ("drop-7", "drop-1.json"), ("../..", "scene-1.json")],
)
def test_names_of_scenes_as_names_of_files(folder: Path, name: str, file: str) -> None:
    assert next(new_scene_paths(folder, name)) == folder / file


def test_the_newest_scene_is_opened_where_none_was_saved(folder: Path) -> None:
    for age, name in enumerate(("drop", "pendulum")):
        save_scene(load_scene(name), folder / f"{name}.json")
        os.utime(folder / f"{name}.json", (1000 - age, 1000 - age))
    (folder / "package.json").write_text("{}")
    assert newest_scene(folder) == folder / "drop.json"
    desk = Desk(empty_world())
    desk.key("o", CTRL)
    desk.frames()
    assert desk.world.name == "drop"


@pytest.mark.parametrize(
    "text", ["not json at all", '{"format": "physicslab-scene/1", "entities": [{"Mas": 1}]}']
)
def test_a_bad_file_is_reported_and_nothing_is_lost(folder: Path, text: str) -> None:
    (folder / "bad.json").write_text(text)
    world = empty_world(gravity=(0, 0))
    ball = circle(world, (0, 0))
    desk, canvas = recorded(world)
    desk.press(0, 0)
    desk.key("o", CTRL)
    frame(desk, canvas)
    assert desk.world is world and world.has(ball, Held)
    assert "Not opened" in desk.window.notice and "bad.json" in desk.window.notice
    (reported,) = [t for t in canvas.called("text") if t["words"].startswith("Not opened")]
    assert reported["style"].colour == desk.window.theme.error


def test_no_file_is_reported() -> None:
    desk = Desk(empty_world())
    desk.key("o", CTRL)
    desk.frames()
    assert "There is no scene file" in desk.window.notice and desk.window.notice_failed


def test_a_world_that_no_file_can_hold_is_reported(folder: Path) -> None:
    world = empty_world()
    ball = circle(world, (0, 0))
    desk = Desk(world)
    desk.key("space")
    desk.frames()
    world.table(Velocity)["linear"][world.entity_index.row_of[ball]] = float("nan")
    desk.key("s", CTRL)
    desk.frames()
    assert "could not be saved" in desk.window.notice
    assert not list(folder.iterdir())


def test_a_folder_that_cannot_be_written_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*arguments: object) -> None:
        raise PermissionError("nothing may be written here")

    monkeypatch.setattr("physicslab.view.controls.file_actions.save_new_scene", refuse)
    desk = Desk(empty_world())
    desk.key("s", CTRL)
    desk.frames()
    assert "could not be saved: nothing may be written here" in desk.window.notice


def test_what_is_held_is_let_go_when_another_world_comes() -> None:
    world = empty_world()
    ball = circle(world, (0, 0))
    desk = Desk(world)
    desk.key("s", CTRL)
    desk.press(0, 0)
    desk.frames()
    desk.key("o", CTRL)
    desk.frames(3)
    assert desk.window.hand.entity is None and not world.has(ball, Held)
    desk.release(0, 0)
    desk.frames()
    assert len(desk.world.entities()) == 1


def test_s_and_o_alone_save_and_open_nothing(folder: Path) -> None:
    desk = Desk(empty_world())
    desk.key("s")
    desk.key_up("s")
    desk.key("o")
    desk.frames()
    assert not list(folder.iterdir())
    assert desk.world.physics.gravity_mode == "planet"
