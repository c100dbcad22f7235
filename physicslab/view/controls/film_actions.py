"""What the user can do to have a film."""

from __future__ import annotations

from pathlib import Path

from physicslab.export.film import ENDINGS
from physicslab.files.new_scene import file_stem
from physicslab.view.controls.scene_files import new_paths
from physicslab.view.window.filming import FROM_NOW
from physicslab.view.window.window import Window
from physicslab.world import World

__all__ = ["begin_film", "toggle_film"]


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
