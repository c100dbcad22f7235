"""A page that the window makes of its scene, in a process of its own: ``physicslab export``."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from physicslab.view.window.lab_process import LabProcess, own_command
from physicslab.view.window.naming import Naming

_COMMAND, _LESSON = own_command("export"), own_command("lesson")
FROM_START, FROM_EDIT, FROM_NOW = "From the start", "From the last edit", "From now on"
WHOLE_LESSON = "The whole lesson"
"""The start of a page or a lesson, or its contents."""
SLIDERS = 2
"""How many quantities the sliders of a page may change."""


@dataclass(slots=True)
class Slid:
    """A quantity that a slider of the page is to change.

    Attributes
    ----------
    path : str
        Which, as ``--vary`` takes it; empty for none.
    span : str
        Its first value, its last and how many, as ``1:5:9``.
    refused : str
        Why no page could be made with these, empty where one could.
    """

    path: str = ""
    span: str = "1:5:9"
    refused: str = ""


def beginnings(last_edit: int) -> tuple[str, ...]:
    """Return where a page or a lesson may begin, by the steps before the last edit: the best one first."""
    return (FROM_EDIT, FROM_START, FROM_NOW) if last_edit else (FROM_START, FROM_NOW)


class Sharing(LabProcess):
    """Makes a page of a scene while the window goes on.

    Attributes
    ----------
    choosing : bool
        Whether the panel is shown in which it is chosen.
    naming : Naming
        The name of its file, and why it could not be begun or made.
    seconds : str
        How long the run is to be [s].
    begins : str
        ``FROM_START``, ``FROM_EDIT`` or ``FROM_NOW``, or ``WHOLE_LESSON``.
    slid : list of Slid
        Fields of its sliders.
    path : path
        Where it is written.
    """

    option = "--html"

    def __init__(self, command: tuple[str, ...] = _COMMAND) -> None:
        super().__init__(command)
        self.choosing = False
        self.naming, self.seconds, self.begins = Naming(), "10", FROM_START
        self.slid = [Slid() for _ in range(SLIDERS)]
        self.path = Path()

    def make(self, write: Callable[[Path], object], path: Path) -> None:
        """Begin to make the page that is chosen of the scene that ``write`` writes to a path."""
        self.path = path
        vary = [text for one in self.slid if one.path for text in ("--vary", f"{one.path}={one.span}")]
        self.begin(write, "--seconds", self.seconds, *vary)

    def make_lesson(self, lesson: str, code: str, path: Path) -> None:
        """Begin to make the page of a lesson, of a name or a file, in one of its languages."""
        self.path = path
        self._empty()
        self._run(*_LESSON, lesson, "--language", code, "--progress", "--page", str(self._report))

    @staticmethod
    def read(report: Path) -> dict[str, Any]:
        """Return the page."""
        return {"page": report.read_bytes()}
