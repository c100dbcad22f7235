"""The preferences that the first picture shows already: colours and language. It imports no numba."""

import json
from pathlib import Path
from typing import Any

from physicslab.desktop.sessions import session_folder
from physicslab.files.checks import SceneError
from physicslab.files.plain import read_bytes
from physicslab.languages.catalogue import SOURCE, languages
from physicslab.theme import DARK, THEMES, Theme

UNREADABLE = OSError, SceneError, ValueError, RecursionError
"""The errors of :func:`read_preferences`."""
_MAX_BYTES = 1_000_000
_MIN_SCALE, _MAX_SCALE = 0.5, 3.0
"""The sizes of text that are taken from a file, as shares of the usual."""


def preferences_path() -> Path:
    """Return where preferences are kept; raise ``OSError`` if the user has no home directory."""
    return session_folder().with_name("preferences.json")


def read_preferences(path: Path) -> dict[str, Any]:
    """Return the preferences in a file; raise one of ``UNREADABLE`` if it holds none."""
    found = json.loads(read_bytes(path, path.name, _MAX_BYTES, "a file of preferences").decode("utf-8"))
    if not isinstance(found, dict):
        raise ValueError("it holds no object")
    return found


def chosen_theme(preferences: dict[str, Any]) -> Theme:
    """Return the colours that were chosen, or the usual ones."""
    return next((theme for theme in THEMES if theme.name == preferences.get("colours")), DARK)


def chosen_scale(preferences: dict[str, Any], usual: float) -> float:
    """Return how many times as large as usual text is chosen to be, or the ``usual`` scale of the display."""
    scale = preferences.get("text")
    return float(scale) if isinstance(scale, int | float) and _MIN_SCALE <= scale <= _MAX_SCALE else usual


def chosen_language(preferences: dict[str, Any]) -> str:
    """Return the code of the language that was chosen, or that of the program's own texts."""
    return next((code for code in languages() if code == preferences.get("language")), SOURCE)
