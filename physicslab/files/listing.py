"""Which files of a folder are scenes, told from their beginnings, without reading them whole."""

from dataclasses import dataclass
from pathlib import Path

from physicslab.files.plain import open_plain
from physicslab.files.scene import SceneError, is_step

_MARK = b"physicslab-scene/"
"""The beginning of the format of a scene file."""
_STEP_MARK = b"StepCoreXML"
"""In the head of a world of KDE Step."""
_RECORDING = b"physicslab-recording/"
"""The beginning of the format of a recording, which holds a scene too."""
_ENDINGS = (".json", ".step", ".replay")
"""How files end that may be scenes, or recordings of them."""
_LISTED = 500
"""Files and folders that are listed."""
_HEAD = 4096
"""Bytes at the beginning of a file in which it says what it is."""


def scene_files(directory: Path) -> list[Path]:
    """Return every file that is marked as a scene, the one that was written last first.

    One that cannot be read is among them: opening it shows why.
    """

    def offered(path: Path) -> bool:
        try:
            return is_scene(path)
        except (OSError, SceneError):
            return True

    return [path for path in reversed(_by_age(directory, "json", "step")) if offered(path)]


def scenes_here() -> list[Path]:
    """Return the scene files of the working directory; none where it cannot be read."""
    try:
        return scene_files(Path.cwd())
    except OSError:
        return []


@dataclass(frozen=True, slots=True)
class Entry:
    """A file or a folder, and why it is no scene; empty for folders and scenes."""

    path: Path
    is_folder: bool
    why_not: str


def entries(folder: Path) -> list[Entry]:
    """Return the first few folders and files of a folder, by name; what begins with a dot is left out.

    Raises
    ------
    OSError
        If it cannot be listed.
    """
    found = [path for path in folder.iterdir() if not path.name.startswith(".")]
    found.sort(key=lambda path: (not path.is_dir(), path.name.casefold()))
    return [
        Entry(path, True, "") if path.is_dir() else Entry(path, False, _why_no_scene(path))
        for path in found[:_LISTED]
    ]


def _why_no_scene(path: Path) -> str:
    if path.suffix.lower() not in _ENDINGS:
        return "no scene"
    try:
        if is_scene(path):
            return ""
        return "a recording: physicslab replay plays it" if is_recording(path) else "no scene"
    except SceneError:
        return "no plain file"
    except OSError as error:
        return error.strerror or str(error)


def is_scene(path: Path) -> bool:
    """Whether a file is marked as a scene.

    Raises
    ------
    SceneError, OSError
        If it cannot be read.
    """
    head = _head(path)
    return (_MARK in head and _RECORDING not in head) or (is_step(path) and _STEP_MARK in head)


def is_recording(path: Path) -> bool:
    """Whether a file is marked as a recording; not if it cannot be read."""
    try:
        return _RECORDING in _head(path)
    except (OSError, ValueError):
        return False


def _by_age(directory: Path, *endings: str) -> list[Path]:
    files = (path for ending in endings for path in directory.glob(f"*.{ending}") if path.is_file())
    return sorted(files, key=lambda path: path.stat().st_mtime_ns)


def _head(path: Path) -> bytes:
    """Return the beginning of a plain file."""
    with open_plain(path, path.name) as file:
        return file.read(_HEAD)
