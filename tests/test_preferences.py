"""What the user chose of the window is there at the next start; a broken file changes nothing."""

import os
from pathlib import Path

import pytest
from deadline import deadline
from recording import RecordingCanvas

from physicslab.desktop.preferences import load_preferences, save_preferences
from physicslab.theme import DARK, PROJECTOR
from physicslab.view.window.window import Window


def window() -> Window:
    return Window(RecordingCanvas((1280, 720)))


def test_colours_text_and_level_are_kept(tmp_path: Path) -> None:
    path, chosen, next_one = tmp_path / "new" / "preferences.json", window(), window()
    chosen.theme, chosen.text_scale, chosen.level = PROJECTOR, 1.5, "Engineer"
    save_preferences(path, chosen)
    load_preferences(path, next_one)
    assert (next_one.theme, next_one.text_scale, next_one.level) == (PROJECTOR, 1.5, "Engineer")


@pytest.mark.parametrize(
    "text",
    [
        '{"panels": "\\ud800"}', '{"panels": "a\\u0000b"}', '{"recent": ["\\ud800", 3, "a\\u0000"]}',
        '{"text": 1e99}', '{"text": "large"}', '{"level": "All"}', '{"level": []}',
        '{"colours": {"a": 1}}', '{"text": NaN}', '{"text": true, "colours": null}',
    ],
)  # fmt: skip
def test_what_is_no_choice_is_left_out(text: str, tmp_path: Path) -> None:
    path, opened = tmp_path / "preferences.json", window()
    path.write_text(text, "utf-8")
    load_preferences(path, opened)
    load_preferences(tmp_path / "none.json", opened)
    assert (opened.theme, opened.text_scale, opened.level) == (DARK, 1.0, "Explore")


@pytest.mark.parametrize(
    "how",
    ["", "{", "[]", "7", "[" * 200_000, "9" * 10_000, "\ud800", " " * 2_000_000, "pipe", "zeros", "folder"],
)
def test_what_cannot_be_read_is_put_aside_and_told(how: str, tmp_path: Path) -> None:
    path, opened = tmp_path / "preferences.json", window()
    with deadline("preferences", seconds=5):
        if how == "pipe":
            os.mkfifo(path)
        elif how == "zeros":
            path.symlink_to("/dev/zero")
        elif how == "folder":
            path.mkdir()
        else:
            path.write_bytes(how.encode("utf-8", "surrogatepass"))
        load_preferences(path, opened)
        assert "could not be read" in opened.notice and "\n" not in opened.notice
        assert [left.name for left in tmp_path.iterdir()] == ["preferences.json.unreadable"]
        save_preferences(path, opened)
        again = window()
        load_preferences(path, again)
    assert not again.notice and again.arrangements == opened.arrangements


def test_one_that_cannot_be_put_aside_stops_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, opened = tmp_path / "preferences.json", window()
    os.mkfifo(path)

    def refuse(*_: object) -> None:
        raise PermissionError

    monkeypatch.setattr(os, "replace", refuse)
    with deadline("preferences", seconds=5):
        load_preferences(path, opened)
        assert "could not be read" in opened.notice
        with pytest.raises(OSError, match="no plain file"):
            save_preferences(path, opened)
