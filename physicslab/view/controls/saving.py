"""A new scene, and what saves the one that is shown: to its file, under a name, as a copy."""

import io
import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from physicslab.diagnostics.table_rows import TableRows
from physicslab.ecs.text import printable
from physicslab.files.listing import is_scene
from physicslab.files.replace import create_file, create_first, reason_of, replace_file
from physicslab.files.scene import SceneError, file_stem, is_step, scene_bytes
from physicslab.languages.language import language
from physicslab.languages.sentence import Sentence
from physicslab.prefabs import box
from physicslab.scenes import SCENES
from physicslab.view.window.desk import desk_of
from physicslab.view.window.naming import Naming, free_name, new_paths
from physicslab.view.window.scenes import stamp_of
from physicslab.view.window.window import Window
from physicslab.world import World

_FLOOR = (40.0, 1.0)
"""Width and height of the floor of a new scene [m]; its upper side is at y = 0."""

_UNSAVED = "\u2022"
"""The mark of unsaved work."""


def begin_new(world: World, window: Window) -> None:
    """Show an empty scene with a floor, at t = 0 and paused; undo brings unsaved work back."""
    made = World()
    width, height = _FLOOR
    box(made, (0.0, -0.5 * height), width=width, height=height, static=True, restitution=1.0, name="floor")
    made.view = -6.0, -1.5, 6.0, 5.5
    made.synchronise()
    window.scenes.next_world, window.scenes.source = made, None
    window.pace.paused, window.tool = True, "circle"
    window.notify("A new scene, at t = 0: Space lets time run", 5.0)


def name_of(world: World, window: Window) -> str:
    """Return what files of the scene are called: after its own file, or else its name or its title."""
    if isinstance(window.scenes.source, Path):
        return window.scenes.source.stem
    own = world.name not in SCENES or SCENES[world.name].title != world.title
    return (world.title if own else "") or world.name


def scene_words(world: World, window: Window) -> str:
    """Return what title bars call the scene: a dot if it has unsaved work, its title, its file."""
    if window.lesson is not None:
        return window.lesson.lesson.title
    file = window.scenes.source.name if isinstance(window.scenes.source, Path) else ""
    title = world.title or ("" if file else world.name or "Untitled scene")
    title = language(window.language).reword(title) if title else ""
    named = f"{title} ({file})" if title and file else title or file
    return f"{_UNSAVED} {named}" if window.has_unsaved else named


def new_scene_paths(directory: Path, name: str) -> Iterator[Path]:
    """Yield paths to save a scene under: its name, as far as a file may bear it, and a number from 1.

    A number at the end of the name is taken for one that was given here.
    """
    return new_paths(directory, file_stem(re.sub(r"-\d+$", "", name)), ".json")


def save(world: World, window: Window) -> None:
    """Save the scene to its file; one that has none, or whose file changed on disk, gets a name first."""
    path = window.scenes.source
    if window.scenes.naming is not None:
        save_under(world, window, window.scenes.naming.text)
    elif not isinstance(path, Path) or is_step(path):
        window.scenes.naming = Naming(_new_name(world, window))
    elif window.scenes.is_changed(path):
        words = f"{printable(path.name)} was changed by another program since it was opened"
        window.scenes.naming = Naming(_shown(path), refused=words, replaces=path)
    elif (refused := _written(world, window, path, copies=False, is_new=False)) is not None:
        window.scenes.naming = Naming(_shown(path), refused=refused)
        window.notify(refused, 6.0, failed=True)


def begin_copy(world: World, window: Window) -> None:
    """Let the user write the name of a copy."""
    window.scenes.naming = Naming(_new_name(world, window), copies=True)


def _new_name(world: World, window: Window) -> str:
    return free_name(new_scene_paths(Path.cwd(), name_of(world, window)))


def _shown(path: Path) -> str:
    """Return a path as it is written: its name alone in the working directory."""
    return path.name if path.parent == Path.cwd() else str(path)


def save_under(world: World, window: Window, name: str, over: Path | None = None) -> None:
    """Save the scene under a name; a file that is there is replaced only where it is ``over``."""
    naming = window.scenes.naming
    if naming is None:
        return
    naming.text = name
    path = naming.path((".json",), over, _why_kept)
    if path is None:
        return
    refused = _written(world, window, path, copies=naming.copies, is_new=over is None)
    if refused is None:
        window.scenes.naming = None
    else:
        naming.refused = refused


def _why_kept(path: Path) -> str:
    """Return why a file cannot be written over, empty if it can be: it is a scene."""
    return "" if path.exists() and is_scene(path) else ", and is no scene: another name is needed"


def _written(world: World, window: Window, path: Path, *, copies: bool, is_new: bool) -> str | None:
    """Save the scene to a file, whole or not at all; return why it could not be."""
    window.framing.keep_view(world)
    world.desk = desk_of(window)
    try:
        content = scene_bytes(world, str(path))
        (create_file if is_new else replace_file)(path, content)
    except (SceneError, OSError, ValueError) as error:
        return f"The scene could not be saved: {reason_of(error)}"
    window.scenes.note(path, stamp_of(path))
    if not copies:
        window.scenes.source = path
        window.scenes.saved = window.edits.history.changes
        window.dashboard.keep(world)
    told = "Saved a copy as {file}" if copies else "Saved {file}"
    saved = Sentence(told, file=printable(str(path)))
    if world.time:
        saved = Sentence("{saved}, at t = {time} s as shown", saved=saved, time=f"{world.time:.2f}")
    window.notify(saved)
    return None


def save_new(world: World, window: Window, what: str, ending: str, content: bytes) -> None:
    """Write something that belongs to a scene to a new file where the program was started; show its name."""
    stem = file_stem(f"{name_of(world, window) or 'scene'}-{what}")
    try:
        path = create_first(new_paths(Path.cwd(), stem, ending), content)
    except OSError as error:
        window.notify(f"The {what} could not be saved: {reason_of(error)}", 6.0, failed=True)
    else:
        window.notify(f"Saved {printable(str(path))}")


def save_table(
    world: World, window: Window, what: str, rows: Callable[[], Iterable[Iterable[object]]]
) -> None:
    """Write a table that belongs to a scene to a new file where the program was started."""
    text = io.StringIO()
    TableRows(text).write(rows())
    save_new(world, window, what, ".csv", text.getvalue().encode("utf-8"))
