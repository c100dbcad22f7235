"""The preferences of the user, from one start to the next: colours, text, level, where panels are."""

import json
import os
from pathlib import Path

from physicslab.desktop.appearance import (
    UNREADABLE,
    chosen_language,
    chosen_scale,
    chosen_theme,
    read_preferences,
)
from physicslab.ecs.text import printable
from physicslab.files.replace import rename_over, replace_file
from physicslab.view.canvas.drawable_text import encodable
from physicslab.view.controls.choosing_keys import read_choice
from physicslab.view.window.desk import LEVELS
from physicslab.view.window.recent import RecentFiles
from physicslab.view.window.window import Window

_MAX_ARRANGEMENT = 100_000
"""Characters that are taken of where panels are."""
_UNREADABLE = ".unreadable"
"""Suffix for a file that could not be read, so that it does not stand in the way again."""


def load_preferences(path: Path, window: Window) -> None:
    """Set a window up as it was left; what is not there, or is nothing that can be chosen, stays as usual.

    A file that cannot be read is put aside, and the window says so.
    """
    try:
        found = read_preferences(path)
    except FileNotFoundError:
        return
    except UNREADABLE as error:
        _put_aside(path, window, error)
        return
    window.theme, window.language = chosen_theme(found), chosen_language(found)
    level, panels = found.get("level"), found.get("panels")
    window.text_scale = chosen_scale(found, window.text_scale)
    if isinstance(level, str) and level in LEVELS:
        window.level = level
    window.welcomed = found.get("welcomed") is True
    window.reduced_motion = found.get("reduced motion") is True
    window.sounds.on = found.get("sound") is True
    window.keys.chosen, wrong = read_choice(found.get("keys", {}))
    if wrong:
        window.notify(f"Preferences: {printable(wrong)}. The usual key is taken", 8.0, failed=True)
    recent = found.get("recent")
    if isinstance(recent, list):
        window.scenes.recent = RecentFiles(Path(path) for path in recent if isinstance(path, str) and path)
    for width in window.arrangements:
        arrangement = panels.get(width) if isinstance(panels, dict) else None
        if isinstance(arrangement, str) and len(arrangement) <= _MAX_ARRANGEMENT:
            window.arrangements[width] = encodable(arrangement)


def _put_aside(path: Path, window: Window, error: Exception) -> None:
    """Rename a file that cannot be read, and say so."""
    kept = path.with_name(path.name + _UNREADABLE)
    reason = "nested too deeply" if isinstance(error, RecursionError) else printable(str(error))
    try:
        rename_over(path, kept)
        done = f"it is kept as {kept.name}, and the usual ones are taken"
    except OSError:
        done = "the usual ones are taken"
    window.notify(f"Preferences could not be read ({reason}): {done}", 8.0, failed=True)


def save_preferences(path: Path, window: Window) -> None:
    """Keep what the user chose.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    chosen = {
        "colours": window.theme.name, "text": window.text_scale, "level": window.level,
        "reduced motion": window.reduced_motion, "sound": window.sounds.on,
        "recent": [os.fspath(path) for path in window.scenes.recent.paths],
        "language": window.language, "keys": window.keys.chosen,
        "panels": window.arrangements, "welcomed": window.welcomed,
    }  # fmt: skip
    path.parent.mkdir(parents=True, exist_ok=True)
    if os.path.exists(path) and not path.is_file():  # a pipe without a reader would wait for ever
        raise OSError(f"{path} is no plain file")
    replace_file(path, (json.dumps(chosen, indent=1) + "\n").encode("utf-8"))
