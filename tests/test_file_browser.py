"""Opening a file from folders: scenes with pictures, the rest greyed with the reason; by mouse and keys."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pygame
import pytest
from desk import SETTLED, Desk, bits, click, empty_world, point, sized, tap, write

from physicslab.files.listing import entries
from physicslab.files.scene import load_scene, save_scene
from physicslab.history import History

CTRL = pygame.KMOD_CTRL


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Desk]:
    inner = tmp_path / "inner"
    inner.mkdir()
    monkeypatch.chdir(tmp_path)
    save_scene(load_scene("drop"), tmp_path / "drop.json")
    save_scene(load_scene("pendulum"), inner / "clock.json")
    (tmp_path / "other.json").write_text("{}")
    (tmp_path / "notes.txt").write_text("notes")
    (tmp_path / ".hidden.json").write_text("{}")
    History(empty_world()).save(tmp_path / "done.replay")
    yield sized((1280, 800), empty_world())


def test_what_is_no_scene_says_why(desk: Desk, tmp_path: Path) -> None:
    (tmp_path / "gone.json").symlink_to(tmp_path / "nowhere")
    assert {entry.path.name: entry.why_not for entry in entries(tmp_path)} == {
        "inner": "", "drop.json": "", "other.json": "no scene", "notes.txt": "no scene",
        "done.replay": "a recording: physicslab replay plays it", "gone.json": "No such file or directory",
    }  # fmt: skip
    tap(desk, "o", CTRL)
    assert "done.replay: a recording: physicslab replay plays it" in desk.ui.words
    before = bits(desk.world), desk.world
    click(desk, "notes.txt: no scene")
    assert (bits(desk.world), desk.world) == before and desk.window.scenes.opening is not None


def test_a_scene_is_opened_by_the_mouse_from_another_folder_and_its_picture_is_seen(desk: Desk) -> None:
    tap(desk, "o", CTRL)
    click(desk, "inner/")
    left, top, width, height = desk.ui.places["clock.json"]
    point(desk, (left + width // 2, top + height // 2))
    desk.frames(SETTLED + 3)
    assert load_scene("pendulum").title in desk.ui.words and len(desk.ui.pictures) == 1
    click(desk, "clock.json")
    assert desk.world.name == "pendulum" and desk.window.scenes.opening is None


def test_a_name_in_the_folder_that_is_listed_is_opened_by_keys_alone(desk: Desk) -> None:
    tap(desk, "o", CTRL)
    write(desk, "inner")
    tap(desk, "return")
    assert desk.window.scenes.opening is not None and desk.window.scenes.opening.folder.name == "inner"
    write(desk, "clock.json")
    tap(desk, "return")
    assert desk.world.name == "pendulum"


def test_one_esc_closes_it_and_ctrl_o_too(desk: Desk) -> None:
    for key, mod in (("escape", 0), ("o", CTRL)):
        tap(desk, "o", CTRL)
        write(desk, "x")
        tap(desk, key, mod)
        assert desk.window.scenes.opening is None and not desk.window.closing


def test_a_folder_that_cannot_be_listed_says_so(desk: Desk, tmp_path: Path) -> None:
    tap(desk, "o", CTRL)
    assert desk.window.scenes.opening is not None
    desk.window.scenes.opening.folder = tmp_path / "gone"
    desk.frames(SETTLED)
    assert any(words.startswith("Cannot be listed: No such file") for words in desk.ui.words)
