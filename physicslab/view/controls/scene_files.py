"""Scene files of the window: where it saves them, and which it opens."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from pathlib import Path

from physicslab.files.new_scene import file_stem
from physicslab.files.scene import SceneError, open_plain

__all__ = ["is_recording", "new_paths", "new_scene_paths", "newest_scene", "scene_files"]

_MARK = b"physicslab-scene/"
"""The beginning of the format of a scene file."""
_HEAD = 4096
"""Bytes at the beginning of a file in which it says what it is."""
_RECORDING = b"physicslab-recording/"
"""And that of a recording, which holds a scene too."""


def new_scene_paths(directory: Path, name: str) -> Iterator[Path]:
    """Yield paths to save a scene under: its name, as far as a file may bear it, and a number from 1.

    A number at the end of the name is taken for one that was given here.
    """
    return new_paths(directory, file_stem(re.sub(r"-\d+$", "", name)), ".json")


def new_paths(directory: Path, stem: str, ending: str) -> Iterator[Path]:
    """Yield paths of a stem, numbered from 1."""
    return (directory / f"{stem}-{number}{ending}" for number in itertools.count(1))


def scene_files(directory: Path) -> list[Path]:
    """Return every file that is marked as a scene, the one that was written last first.

    One that cannot be read is among them: opening it shows why.
    """

    def offered(path: Path) -> bool:
        try:
            return _is_marked(path)
        except (OSError, SceneError):
            return True

    return [path for path in reversed(_by_age(directory)) if offered(path)]


def newest_scene(directory: Path) -> Path | None:
    """Return the scene file that was written last, or ``None`` if there is none.

    If no file is marked as a scene, it is the newest JSON file: opening it shows its error.

    Raises
    ------
    OSError
        If a file cannot be read.
    """
    files = _by_age(directory)
    scenes = [path for path in files if _is_marked(path)]
    candidates = scenes or files
    return candidates[-1] if candidates else None


def is_recording(path: Path) -> bool:
    """Whether a file is marked as a recording; not if it cannot be read."""
    try:
        return _RECORDING in _head(path)
    except (OSError, ValueError):
        return False


def _by_age(directory: Path) -> list[Path]:
    return sorted(filter(Path.is_file, directory.glob("*.json")), key=lambda path: path.stat().st_mtime_ns)


def _is_marked(path: Path) -> bool:
    head = _head(path)
    return _MARK in head and _RECORDING not in head


def _head(path: Path) -> bytes:
    """Return the beginning of a plain file."""
    with open_plain(path, path.name) as file:
        return file.read(_HEAD)
