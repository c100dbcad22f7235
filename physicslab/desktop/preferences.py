"""What the user chose of the window, from one start to the next: colours, text, level, where panels are."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from physicslab.files.replace import replace_file
from physicslab.view.canvas.theme import THEMES
from physicslab.view.window.recent import RecentFiles
from physicslab.view.window.window import LEVELS, Window

__all__ = ["load_preferences", "save_preferences"]

_MIN_SCALE, _MAX_SCALE = 0.5, 3.0
"""The sizes of text that are taken from a file, as shares of the usual."""
_MAX_ARRANGEMENT = 100_000
"""Characters that are taken of where panels are."""


def load_preferences(path: Path, window: Window) -> None:
    """Set a window up as it was left; what is not there, or is nothing that can be chosen, stays as usual."""
    try:
        found: Any = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError):
        return
    if not isinstance(found, dict):
        return
    window.theme = next((theme for theme in THEMES if theme.name == found.get("colours")), window.theme)
    scale, level, arrangement = found.get("text"), found.get("level"), found.get("panels")
    if isinstance(scale, int | float) and _MIN_SCALE <= scale <= _MAX_SCALE:
        window.text_scale = float(scale)
    if isinstance(level, str) and level in LEVELS:
        window.level = level
    recent = found.get("recent")
    if isinstance(recent, list):
        window.recent = RecentFiles(Path(path) for path in recent if isinstance(path, str) and path)
    if isinstance(arrangement, str) and len(arrangement) <= _MAX_ARRANGEMENT:
        window.arrangement = arrangement


def save_preferences(path: Path, window: Window) -> None:
    """Keep what the user chose.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    chosen = {
        "colours": window.theme.name, "text": window.text_scale, "level": window.level,
        "recent": [os.fspath(path) for path in window.recent.paths],
        "panels": window.arrangement,
    }  # fmt: skip
    path.parent.mkdir(parents=True, exist_ok=True)
    replace_file(path, (json.dumps(chosen, indent=1) + "\n").encode("utf-8"))
