"""Shared parts of the commands of the labs: names of cases, progress, tables, documents and plots."""

import sys
from argparse import Namespace
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TextIO

from physicslab.commands import CommandError
from physicslab.commands.output import JsonOutput, Output, picture_directory
from physicslab.commands.progress import Progress
from physicslab.ecs.text import printable, suggestion
from physicslab.files.checks import shown
from physicslab.lab.case import Case, Catalogue
from physicslab.lab.jobs import Job, run_jobs
from physicslab.lab.report import table


def list_cases[AnyCase: Case](catalogue: Catalogue[AnyCase]) -> int:
    """Print a line for each case: name, family and title; return the exit status."""
    print(table([(case.name, case.family, case.title) for case in catalogue.values()], words=(0, 1, 2)))
    return 0


def chosen_cases[AnyCase: Case](
    names: Iterable[str], catalogue: Catalogue[AnyCase], unknown: Callable[[str], AnyCase | None]
) -> list[AnyCase]:
    """Return the cases of these names, each once.

    Parameters
    ----------
    unknown : callable
        Takes a name that is not in the catalogue; returns a case made of it, or ``None`` for one that is
        dealt with otherwise, or raises :class:`CommandError`.
    """
    chosen: dict[str, AnyCase] = {}
    for name in names:
        if found := catalogue.select(name):
            chosen |= {case.name: case for case in found}
        elif (case := unknown(name)) is not None:
            chosen[name] = case
    return list(chosen.values())


def unknown_name(name: str, kind: str, names: Iterable[str], known: str) -> CommandError:
    """Return the error for a name that there is not, with the likeliest of ``names`` or else ``known``."""
    return CommandError(f"{shown(name)}: is no {kind}{suggestion(name, names) or '; ' + known}")


class LabRun:
    """One run of a lab's command: its outputs are checked when it is made, before any work.

    Parameters
    ----------
    label : str
        The command's name.
    arguments : Namespace
        The parsed arguments.
    example : str
        A name that a plot may have.

    Raises
    ------
    CommandError
        If an output cannot be written.
    """

    def __init__(self, label: str, arguments: Namespace, example: str = "") -> None:
        self._label = label
        self._json = JsonOutput(arguments.json)
        self.write = self._json.write
        self._progress: bool = arguments.progress
        plot = getattr(arguments, "plot", None)
        self._pictures = None if plot is None else picture_directory(plot, f"{example}.png")

    def show(self, text: str, stream: TextIO | None = None) -> None:
        """Print a text to stdout or another stream, unless stdout is for the document alone."""
        if self._json.leaves_stdout:
            print("\n".join(map(printable, text.split("\n"))), file=stream, flush=True)

    def results[Result](self, jobs: Sequence[tuple[float, Job[Result]]]) -> Iterator[Result]:
        """Yield the result of each job, and show on the terminal how far all are."""
        return self.shown(run_jobs(jobs))

    def shown[Result](self, work: Iterable[float | Result]) -> Iterator[Result]:
        """Yield the results of work, and show on the terminal the shares of it that are done."""
        with Progress(self._label, sys.stderr, always=self._progress) as progress:
            for found in work:
                if isinstance(found, float):
                    progress.show(found)
                else:
                    progress.clear()
                    yield found

    def draw(self, name: str, picture: Callable[[], bytes]) -> None:
        """Write a plot, if ``--plot`` was given; only then is ``picture`` called."""
        if self._pictures is not None:
            Output("--plot", str(self._pictures / f"{name}.png")).write(picture())
