"""The scene that a window shows, the files of scenes, and the names that are being written for them."""

import os
from dataclasses import dataclass, field
from pathlib import Path

from physicslab.history import Changes, History
from physicslab.view.window.naming import Naming
from physicslab.view.window.recent import RecentFiles, Recovery
from physicslab.world import World

type Stamp = tuple[int, int, int]
"""Time of writing [ns], bytes and number of a file: another program that writes it changes one of them."""


def working_folder() -> Path:
    """Return the working directory, or the root where it was removed."""
    try:
        return Path.cwd()
    except OSError:
        return Path("/")


@dataclass(slots=True)
class Opening(Naming):
    """The name of a file that is to be opened, and the folder that is listed."""

    folder: Path = field(default_factory=working_folder)


@dataclass(frozen=True, slots=True)
class Left:
    """A scene that another one took the place of, or may take; ``history`` has its world."""

    history: History
    source: str | Path | None
    saved: Changes

    @property
    def is_edited(self) -> bool:
        """Whether anything was done to it by hand since it was opened or saved."""
        return not self.history.changes.is_like(self.saved)


class Scenes:
    """The scene that is shown, with its file; those that were shown before, and those that can be.

    Attributes
    ----------
    source : str or path, optional
        The built-in scene or the file that is shown: restarting opens it again, saving writes the file.
    saved : Changes
        Edits at the time when it was opened or saved last.
    naming, opening : Naming, Opening, optional
        The name that is being written for the scene, and the file that is being chosen; ``None`` if none is.
    shows_gallery : bool
        Whether the gallery of scenes is shown.
    tag : str
        The tag whose scenes it shows when it opens, or all.
    next_world, starts_again : World, optional, bool
        The world that is to be shown from the next frame on, and whether it is the present scene once more.
    left : Left, optional
        The scene that was shown before, where it has unsaved edits; undo at the start brings it back.
    recent, recovery : RecentFiles, Recovery
        The files that were opened or saved last; what sessions that ended without closing have left.
    """

    def __init__(self) -> None:
        self.source: str | Path | None = None
        self.saved = Changes()
        self.naming: Naming | None = None
        self.opening: Opening | None = None
        self.shows_gallery = self.starts_again = False
        self.tag = ""
        self.next_world: World | None = None
        self.left: Left | None = None
        self.recent, self.recovery = RecentFiles(), Recovery()
        self._seen: dict[Path, Stamp] = {}

    def note(self, source: str | Path, stamp: Stamp | None) -> None:
        """Note that a file was read or written, and how it was then; built-in scenes are in no file."""
        if isinstance(source, Path):
            self.recent.note(source)
            if stamp is not None:
                self._seen[source.absolute()] = stamp

    def is_changed(self, path: Path) -> bool:
        """Whether another program has written a file since it was noted; one that is gone has no changes."""
        now, seen = stamp_of(path), self._seen.get(path.absolute())
        return None not in (now, seen) and now != seen


def stamp_of(path: str | Path) -> Stamp | None:
    """Return how a file is now; ``None`` if there is none."""
    try:
        found = os.stat(path)
    except (OSError, ValueError):
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino
