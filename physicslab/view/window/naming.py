"""The name that is being written for a file: of a scene, of a film, of a page."""

import itertools
import os
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from physicslab.ecs.text import printable
from physicslab.files.replace import reason_of
from physicslab.files.scene import file_stem


def _why_kept(path: Path) -> str:
    return "" if path.is_file() else ": another name is needed"


@dataclass(slots=True)
class Naming:
    """A name that is being written for a file, or of one that is to be opened.

    Attributes
    ----------
    text : str
        The name so far.
    copies : bool
        Whether it is for a copy of the scene: the window then stays with the file that it has.
    refused : str
        Why nothing could be done with it; empty if nothing was refused.
    replaces : path, optional
        The file that is written over where the user says so.
    entered : bool
        Whether Enter was pressed: where it is refused, the writing goes on.
    """

    text: str = ""
    copies: bool = False
    refused: str = ""
    replaces: Path | None = None
    entered: bool = False

    def write(self, text: str) -> None:
        """Take another name, of which nothing was said yet."""
        if text != self.text:
            self.text, self.refused, self.replaces = text, "", None

    def path(
        self, endings: tuple[str, ...], over: Path | None, why_kept: Callable[[Path], str] = _why_kept
    ) -> Path | None:
        """Return where the file is to be written; ``None`` if it cannot be: ``refused`` says why.

        Parameters
        ----------
        endings : tuple of str
            Those that its name may have, in small letters; it gets the first where it has another.
            If there are none, any name will do.
        over : path, optional
            The file that is written over.
        why_kept : callable
            Returns why a file that is there cannot be written over, empty where the user is asked.
        """
        self.refused, self.replaces = "", None
        text = self.text.strip()
        if not text:
            self.refused = "A name is needed"
            return None
        try:
            path = Path.cwd() / Path(text).expanduser()
            if path.is_dir():
                self.refused = f"{printable(text)} is a folder: a name is needed"
                return None
            if endings and path.suffix.lower() not in endings:
                path = path.with_name(f"{path.name}{endings[0]}")
            if os.path.lexists(path) and path != over:
                kept = why_kept(path)
                self.replaces = None if kept else path
                self.refused = f"{printable(path.name)} is there already{kept}"
                return None
        except (OSError, ValueError, RuntimeError) as error:
            self.refused = f"It could not be saved: {reason_of(error)}"
            return None
        return path


def new_paths(directory: Path, stem: str, ending: str) -> Iterator[Path]:
    """Yield paths of a stem, numbered from 1."""
    return (directory / f"{stem}-{number}{ending}" for number in itertools.count(1))


def free_name(paths: Iterable[Path]) -> str:
    """Return the name of the first of some paths at which there is nothing."""
    return next(path.name for path in paths if not os.path.lexists(path))


def named_after(what: str, ending: str) -> Naming:
    """Return the first free name of a file that is called after something, in the working directory."""
    return Naming(free_name(new_paths(Path.cwd(), file_stem(what), ending)))
