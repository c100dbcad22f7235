"""Actions on scene files, films and pictures of the window."""

from pathlib import Path

from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.text import printable
from physicslab.export.film import ENDINGS
from physicslab.files.listing import is_recording
from physicslab.files.replace import reason_of
from physicslab.files.scene import SceneError, load_scene
from physicslab.languages.sentence import Sentence
from physicslab.view.controls.lesson_actions import open_lesson
from physicslab.view.controls.saving import name_of
from physicslab.view.window.filming import FROM_NOW
from physicslab.view.window.naming import named_after
from physicslab.view.window.scenes import Opening, stamp_of
from physicslab.view.window.window import Window
from physicslab.world import World


def begin_open(world: World, window: Window) -> None:
    """Let the user choose the file that is to be opened, or no longer."""
    window.scenes.opening = Opening() if window.scenes.opening is None else None


def open_folder(world: World, window: Window, folder: Path) -> None:
    """List another folder."""
    if window.scenes.opening is not None:
        window.scenes.opening = Opening(folder=folder)


def open_named(world: World, window: Window, text: str) -> None:
    """Open the file of a name, or of the number of a line of the last few files; list a folder of a name."""
    opening, recent, text = window.scenes.opening, window.scenes.recent.there, text.strip()
    if opening is None:
        return
    if not text:
        opening.refused = "A name is needed"
        return
    try:
        path = opening.folder / Path(text).expanduser()
        if not path.exists() and text.isdecimal() and 1 <= int(text) <= len(recent):
            path = recent[int(text) - 1]
        if path.is_dir():
            open_folder(world, window, path.resolve())
            return
    except (OSError, ValueError, RuntimeError) as error:
        opening.refused = f"Not opened: {reason_of(error)}"
        return
    opening.refused = open_file(world, window, path)


def open_scene(window: Window, source: str | Path) -> str:
    """Open a built-in scene by name, or a file; where that fails, all stays as it is. Return why it did."""
    losses: list[str] = []
    stamp = stamp_of(source)  # before it is read
    try:
        opened = load_scene(source, losses)
        opened.synchronise()
    except (SceneError, InvalidValue, OSError) as error:
        reason = f"Not opened: {error}"
        if isinstance(source, Path) and is_recording(source):
            reason = f"Not opened: {printable(source.name)} is a recording: physicslab replay plays it"
        window.notify(reason, 8.0, failed=True)
        return reason
    window.scenes.next_world, window.scenes.opening = opened, None
    window.scenes.source = source
    window.scenes.note(source, stamp)
    what = printable(str(source)) if isinstance(source, Path) else Sentence(opened.title)
    if losses:
        told = "Opened {scene}; not taken: {n} (listed in the panel at the right)"
        window.notify(Sentence(told, scene=what, n=len(losses)), 8.0)
    else:
        window.notify(Sentence("Opened {scene}", scene=what))
    return ""


def open_file(world: World, window: Window, path: Path) -> str:
    """Open a file, of a scene or of a lesson, as :func:`open_scene` does."""
    if path.suffix.lower() == ".md":
        return open_lesson(world, window, str(path))
    return open_scene(window, path)


def open_from_list(world: World, window: Window, source: str | Path) -> None:
    """Open a scene, and close the gallery."""
    window.scenes.shows_gallery = False
    refused = open_file(world, window, source) if isinstance(source, Path) else open_scene(window, source)
    if window.scenes.opening is not None:
        window.scenes.opening.refused = refused


def restart(world: World, window: Window) -> None:
    """Open the scene that is shown once more, as at its start.

    One without a file goes back to its last edit, and from there to its start.
    """
    if window.scenes.source is None:
        window.pause_for_history(world)
        history = window.edits.history
        begin = history.last_edit if history.last_edit < history.step_count else 0
        history.seek(begin)
        told = "Back at the last edit: once more leads to the start"
        window.notify(told if begin else "Back at the start")
        return
    if not open_scene(window, window.scenes.source):
        window.scenes.starts_again = True
        window.notify("Started again")


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
        filming.end(window.edits.history)
        return
    filming.choosing = not filming.choosing
    if filming.choosing:
        ending = Path(filming.naming.text).suffix or ENDINGS[0]
        filming.naming = named_after(name_of(world, window), ending)
    else:
        window.notify("No film was begun")


def begin_film(world: World, window: Window) -> None:
    """Begin the film that was chosen; where it cannot be made, say why."""
    filming = window.filming
    window.put_down(world)
    path = filming.naming.path((), None, lambda _: ": another name is needed")
    if path is None:
        return
    try:
        filming.begin(path, filming.what, window.edits.history, window.framing.room(), window.pace.speed)
    except (OSError, ValueError) as error:
        reason = reason_of(error)
        filming.naming.refused = reason[:1].upper() + reason[1:]
        return
    filming.choosing = False
    if filming.what == FROM_NOW:
        waits = window.pace.paused
        window.notify("Filming: F9 ends it, Space lets time run" if waits else "Filming: F9 ends it")
    else:
        window.pace.paused = True
