"""What the user chose of the window is there at the next start; a broken file changes nothing."""

from pathlib import Path

import pytest
from recording import RecordingCanvas

from physicslab.desktop.preferences import load_preferences, save_preferences
from physicslab.view.canvas.theme import DARK, PROJECTOR
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
        "", "{", "[]", "7", '{"text": 1e99}', '{"text": "large"}', '{"level": "All"}', '{"level": []}',
        '{"colours": {"a": 1}}', '{"text": NaN}', '{"text": true, "colours": null}',
    ],
)  # fmt: skip
def test_what_is_no_choice_is_left_out(text: str, tmp_path: Path) -> None:
    path, opened = tmp_path / "preferences.json", window()
    path.write_text(text, "utf-8")
    load_preferences(path, opened)
    load_preferences(tmp_path / "none.json", opened)
    assert (opened.theme, opened.text_scale, opened.level) == (DARK, 1.0, "Explore")
