"""The commands of the command line.

:mod:`physicslab.commands.usage` declares each with a function of its name; a module of that name has its
``execute(arguments) -> int``, which returns the exit status or raises :class:`CommandError`.
"""

import importlib.util
import sys
from argparse import Namespace
from contextlib import suppress
from importlib import import_module
from keyword import iskeyword
from typing import Protocol, cast

FAILED = 1
"""Exit status of a run that failed."""
USAGE = 2
"""Exit status of bad usage, or of a bad scene."""


class CommandError(Exception):
    """A command cannot go on; the message is one line for people.

    Attributes
    ----------
    status : int
        The exit status.
    """

    def __init__(self, message: str, status: int = USAGE) -> None:
        super().__init__(message)
        self.status = status


def tell(line: str) -> None:
    """Print a line on stderr, and nothing where that is closed or full.

    ``print`` takes stdout in place of a stderr that is closed, among the rows or the document there.
    """
    if sys.stderr is not None:
        with suppress(OSError):
            print(line, file=sys.stderr, flush=True)


def require(user: str, extra: str, *packages: str) -> None:
    """Refuse to go on where packages are not installed that come with an extra of this one.

    Parameters
    ----------
    user : str
        The option or the file that needs them.
    extra : str
        The extra.
    *packages : str
        The modules that it brings, by their names in Python.

    Raises
    ------
    CommandError
        If one of them is not there.
    """
    for package in packages:
        if importlib.util.find_spec(package) is None:
            remedy = f"pip install 'physicslab[{extra}]'"
            raise CommandError(f"{user}: needs the package {package}, which is not installed: {remedy}")


def require_window(user: str) -> None:
    """Refuse to go on where the packages of the window are not installed, which draw pictures as well."""
    require(user, "window", "pygame", "imgui_bundle")


class Command(Protocol):
    """The interface of a command's module."""

    def execute(self, arguments: Namespace) -> int:
        """Do it, and return the exit status."""


def command(name: str) -> Command:
    """Return the module of a command, whose name has an underscore behind a keyword of Python.

    Only now is it imported, and the physics with it.
    """
    return cast(Command, import_module(f"{__name__}.{name}{'_' * iskeyword(name)}"))
