"""Files that were opened or saved last: listed, opened by mouse and by keyboard, kept to the next start."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pygame
import pytest
from desk import SETTLED, Desk, bits, click, empty_world, middle_of, point, tap, write
from recording import RecordingCanvas

from physicslab.desktop.preferences import load_preferences, save_preferences
from physicslab.files.scene import load_scene, save_scene
from physicslab.view.controls import file_actions, saving
from physicslab.view.window.window import Window

OPEN = pygame.KMOD_CTRL


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Desk]:
    monkeypatch.chdir(tmp_path)
    for name in ("drop", "stack"):
        save_scene(load_scene(name), tmp_path / f"{name}.json")
    desk = Desk(empty_world())
    desk.frames(SETTLED)
    yield desk


def drop(desk: Desk, path: Path) -> None:
    pygame.event.post(pygame.Event(pygame.DROPFILE, file=str(path)))
    desk.frames(SETTLED)


def test_what_was_opened_and_saved_is_in_the_menu_the_last_first(desk: Desk, tmp_path: Path) -> None:
    drop(desk, tmp_path / "drop.json")
    drop(desk, tmp_path / "stack.json")
    saving.begin_copy(desk.world, desk.window)
    saving.save_under(desk.world, desk.window, "stack-1")
    names = [path.name for path in desk.window.scenes.recent.there]
    assert names == ["stack-1.json", "stack.json", "drop.json"]
    drop(desk, tmp_path / "stack.json")
    (tmp_path / "stack-1.json").unlink()
    click(desk, "File")
    point(desk, middle_of(desk, "Recent files"))
    desk.frames(40)
    lines = [label for label in desk.ui.places if label[:3] in ("1. ", "2. ", "3. ")]
    assert lines == ["1. stack.json", "2. drop.json"]
    click(desk, "2. drop.json")
    desk.frames(SETTLED)
    assert desk.world.name == "drop"


def test_a_file_is_opened_by_keyboard_alone(desk: Desk, tmp_path: Path) -> None:
    drop(desk, tmp_path / "drop.json")
    drop(desk, tmp_path / "stack.json")
    for text, name in (("2", "drop"), ("stack.json", "stack"), (str(tmp_path / "drop.json"), "drop")):
        tap(desk, "o", OPEN)
        assert "File to open" in desk.ui.places
        write(desk, text)
        tap(desk, "return")
        desk.frames(SETTLED)
        assert desk.world.name == name and desk.window.scenes.opening is None
        assert "File to open" not in desk.ui.places
    tap(desk, "o", OPEN)
    tap(desk, "escape")
    tap(desk, "escape")
    assert desk.window.scenes.opening is None and not desk.window.closing and desk.world.name == "drop"


@pytest.mark.parametrize("text", ["", "none.json", "7", "a\0b", "~nobody-at-all/x"])
def test_what_cannot_be_opened_is_said_at_the_field(text: str, desk: Desk) -> None:
    before = bits(desk.world)
    tap(desk, "o", OPEN)
    if text.isprintable():
        write(desk, text)
        tap(desk, "return")
    else:
        file_actions.open_named(desk.world, desk.window, text)
    desk.frames(SETTLED)
    assert desk.window.scenes.opening is not None
    refused = desk.window.scenes.opening.refused
    assert refused and "\n" not in refused
    assert any(refused[:20] in words for words in desk.ui.words)
    assert bits(desk.world) == before and desk.window.scenes.recent.paths == []


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"no scene",
        b"\xff\xfe\x00",
        b"[]",
        b'{"format": "physicslab-scene/1"',
        b'{"format": "other"}',
        None,
    ],
)
def test_a_file_that_is_no_scene_dropped_on_the_window_changes_nothing(
    content: bytes | None, desk: Desk, tmp_path: Path
) -> None:
    path = tmp_path / "dropped.json"
    if content is None:
        path.mkdir()
    else:
        path.write_bytes(content)
    before = bits(desk.world)
    drop(desk, path)
    assert desk.window.notice.startswith("Not opened: ") and "\n" not in desk.window.notice
    assert desk.window.notice_failed and bits(desk.world) == before and desk.window.scenes.recent.paths == []


def test_ten_files_are_kept_from_one_start_to_the_next(tmp_path: Path) -> None:
    path, chosen, next_one = (
        tmp_path / "preferences.json",
        Window(RecordingCanvas((640, 480))),
        Window(RecordingCanvas((640, 480))),
    )
    for number in range(12):
        (tmp_path / f"{number}.json").write_text("{}")
        chosen.scenes.recent.note(tmp_path / f"{number}.json")
    save_preferences(path, chosen)
    load_preferences(path, next_one)
    (tmp_path / "5.json").unlink()
    stems = [found.stem for found in next_one.scenes.recent.there]
    assert stems == ["11", "10", "9", "8", "7", "6", "4", "3", "2"]
    for broken in ('{"recent": 7}', '{"recent": [1, null, "", "x\\u0000y"]}'):
        path.write_text(broken)
        load_preferences(path, next_one)
        assert next_one.scenes.recent.there == [] or broken == '{"recent": 7}'
