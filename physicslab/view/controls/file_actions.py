"""Actions on scene files, films and pictures of the window."""

import itertools
import re
from collections.abc import Callable, Iterator
from pathlib import Path

from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.text import printable
from physicslab.export.film import ENDINGS
from physicslab.files.replace import create_file
from physicslab.files.scene import (
    SceneError,
    file_stem,
    is_step,
    load_scene,
    open_plain,
    save_new_scene,
    save_scene,
)
from physicslab.view.window.filming import FROM_NOW
from physicslab.view.window.window import Window
from physicslab.world import World

# ---- which files there are ---------------------------------------------------------------------------------


_MARK = b"physicslab-scene/"
"""The beginning of the format of a scene file."""
_STEP_MARK = b"StepCoreXML"
"""In the head of a world of KDE Step."""
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

    return [path for path in reversed(_by_age(directory, "json", "step")) if offered(path)]


def newest_scene(directory: Path) -> Path | None:
    """Return the scene file that was written last, or ``None`` if there is none.

    If no file is marked as a scene, it is the newest JSON file: opening it shows its error.

    Raises
    ------
    OSError
        If a file cannot be read.
    """
    files = _by_age(directory, "json")
    scenes = [path for path in files if _is_marked(path)]
    candidates = scenes or files
    return candidates[-1] if candidates else None


def is_recording(path: Path) -> bool:
    """Whether a file is marked as a recording; not if it cannot be read."""
    try:
        return _RECORDING in _head(path)
    except (OSError, ValueError):
        return False


def _by_age(directory: Path, *endings: str) -> list[Path]:
    files = (path for ending in endings for path in directory.glob(f"*.{ending}") if path.is_file())
    return sorted(files, key=lambda path: path.stat().st_mtime_ns)


def _is_marked(path: Path) -> bool:
    head = _head(path)
    return (_MARK in head and _RECORDING not in head) or (is_step(path) and _STEP_MARK in head)


def _head(path: Path) -> bytes:
    """Return the beginning of a plain file."""
    with open_plain(path, path.name) as file:
        return file.read(_HEAD)


# ---- actions -----------------------------------------------------------------------------------------------


def save(world: World, window: Window) -> None:
    """Save the world to a new scene file where the program was started."""
    try:
        path = save_new_scene(world, new_scene_paths(Path.cwd(), world.name))
    except (SceneError, OSError) as error:
        window.notify(f"The scene could not be saved: {error}", 6.0, failed=True)
    else:
        window.scene_file = path
        window.recent.note(path)
        window.unchanged = world.motion_edits
        window.notify(f"Saved {printable(str(path))}")


def begin_save_as(world: World, window: Window) -> None:
    """Let the user write the name under which the scene is to be saved."""
    window.naming_refused = ""
    window.naming = next(path.name for path in new_scene_paths(Path.cwd(), world.name) if not path.exists())


def save_under(world: World, window: Window, name: str) -> None:
    """Save the world under a name; a file that is there is replaced only if the scene came from it."""
    text = name.strip()
    if not text:
        window.naming_refused = "A name is needed"
        return
    try:
        path = Path.cwd() / Path(text).expanduser()
        if path.is_dir():
            window.naming_refused = f"{text} is a directory: a name is needed"
            return
        path = path if path.suffix else path.with_suffix(".json")
        if path.exists() and path != window.scene_file:
            window.naming_refused = f"{path.name} is there already"
            return
        save_scene(world, path)
    except (SceneError, OSError, ValueError, RuntimeError) as error:
        window.naming_refused = f"It could not be saved: {error}"
        return
    window.naming, window.scene_file, window.source = None, path, path
    window.recent.note(path)
    window.unchanged = world.motion_edits
    window.notify(f"Saved {printable(str(path))}")


def reopen(world: World, window: Window) -> None:
    """Open the scene file last saved or opened, or else the newest; where that fails, all stays as it is."""
    try:
        path = window.scene_file or newest_scene(Path.cwd())
    except OSError as error:
        window.notify(f"Not opened: {error}", 8.0, failed=True)
        return
    if path is None:
        window.notify(f"There is no scene file in {Path.cwd()}: Ctrl+S saves one", failed=True)
    else:
        open_scene(window, path)


def begin_open(world: World, window: Window) -> None:
    """Let the user write the name of the file that is to be opened, or no longer."""
    window.opening_refused = ""
    window.opening = "" if window.opening is None else None


def open_named(world: World, window: Window, text: str) -> None:
    """Open the file of a name, or of the number of a line of the last few files."""
    recent, text = window.recent.there, text.strip()
    if not text:
        window.opening_refused = "A name is needed"
        return
    try:
        path = Path.cwd() / Path(text).expanduser()
        if not path.exists() and text.isdecimal() and 1 <= int(text) <= len(recent):
            path = recent[int(text) - 1]
    except (OSError, ValueError, RuntimeError) as error:
        window.opening_refused = f"Not opened: {error}"
        return
    window.opening_refused = open_scene(window, path)


def open_scene(window: Window, source: str | Path) -> str:
    """Open a built-in scene by name, or a file; where that fails, all stays as it is. Return why it did."""
    losses: list[str] = []
    try:
        opened = load_scene(source, losses)
        opened.synchronise()
    except (SceneError, InvalidValue, OSError) as error:
        reason = f"Not opened: {error}"
        if isinstance(source, Path) and is_recording(source):
            reason = f"Not opened: {printable(source.name)} is a recording: physicslab replay plays it"
        window.notify(reason, 8.0, failed=True)
        return reason
    window.next_world, window.opening = opened, None
    window.source = source
    if isinstance(source, Path):
        window.scene_file = source
        window.recent.note(source)
    what = printable(str(source)) if isinstance(source, Path) else opened.title
    more = f"; not taken: {len(losses)} (listed in the panel at the right)" if losses else ""
    window.notify(f"Opened {what}{more}", 8.0 if losses else 3.0)
    return ""


def open_from_list(world: World, window: Window, source: str | Path) -> None:
    """Open a scene, and close the gallery."""
    window.shows_gallery = False
    open_scene(window, source)


def restart(world: World, window: Window) -> None:
    """Open the scene that is shown once more, as it was at its start."""
    if window.source is None:
        window.notify("This scene has no start to go back to: it was not opened from a file", failed=True)
        return
    open_scene(window, window.source)
    if window.next_world is not None:
        window.notify("Started again")


def save_new(world: World, window: Window, what: str, ending: str, content: bytes) -> None:
    """Write something that belongs to a scene to a new file where the program was started; show its name."""
    for path in new_paths(Path.cwd(), file_stem(f"{world.name or 'scene'}-{what}"), ending):
        try:
            create_file(path, content)
        except FileExistsError:
            continue
        except OSError as error:
            window.notify(f"The {what} could not be saved: {error.strerror or error}", 6.0, failed=True)
            return
        window.notify(f"Saved {printable(str(path))}")
        return


def save_table(world: World, window: Window, what: str, table: Callable[[], str]) -> None:
    """Write a table that belongs to a scene to a new file where the program was started."""
    save_new(world, window, what, ".csv", table().encode("utf-8"))


def request_screenshot(world: World, window: Window) -> None:
    """Let a picture of the window be kept as soon as this frame is drawn."""
    window.wants_screenshot = True


def study_error(world: World, window: Window) -> None:
    """Measure error against run time of the scene as it is now; show it when that is done."""
    if window.error_study.running:
        window.error_study.stop()
        window.notify("Measuring error against run time: stopped")
        return
    try:
        window.error_study.start(world)
    except (OSError, SceneError) as error:
        window.notify(f"Error against run time could not be measured: {error}", failed=True)


def toggle_film(world: World, window: Window) -> None:
    """Let the user choose a film, or no longer; end the one that is being made."""
    filming = window.filming
    if filming.running:
        filming.end()
        return
    filming.choosing, filming.refused = not filming.choosing, ""
    if filming.choosing:
        paths = new_paths(Path.cwd(), file_stem(world.name), Path(filming.name).suffix or ENDINGS[0])
        filming.name = next(path.name for path in paths if not path.exists())


def begin_film(world: World, window: Window) -> None:
    """Begin the film that was chosen; where it cannot be made, say why."""
    filming, name = window.filming, window.filming.name.strip()
    window.hand.drop(world)
    window.edits.take_back_shown()
    try:
        path = Path.cwd() / Path(name).expanduser()
        if not name or path.is_dir():
            raise ValueError("A name is needed")
        if path.exists():
            raise ValueError(f"There is a file {path.name} already")
        filming.begin(path, filming.what, window.edits.history, window.room(), window.pace.speed)
    except (OSError, ValueError, RuntimeError) as error:
        reason = (error.strerror if isinstance(error, OSError) else None) or str(error)
        filming.refused = reason[:1].upper() + reason[1:]
        return
    filming.choosing = False
    if filming.what == FROM_NOW:
        window.notify("Filming: F9 ends it" + (", Space lets time run" if window.pace.paused else ""))
    else:
        window.pace.paused = True
