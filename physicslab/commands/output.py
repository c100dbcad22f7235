"""Destinations of a command's documents: a file, or stdout for ``-``."""

import io
import os
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, TextIO

from physicslab.commands import FAILED, CommandError, require
from physicslab.ecs.text import printable, shortened
from physicslab.files.checks import shown
from physicslab.files.json_text import json_bytes
from physicslab.files.replace import check_writable, reason_of, replace_file, replacing


class Output:
    """One destination that the user named.

    Making one checks that it can be written, so that a long run is not lost to a misspelt directory.

    Parameters
    ----------
    option : str
        The option that named it, for messages.
    path : str
        A path, or ``-`` for stdout.

    Attributes
    ----------
    label : str
        Option and path, for messages.

    Raises
    ------
    CommandError
        If it cannot be written.
    """

    def __init__(self, option: str, path: str) -> None:
        self.path = path
        self.to_stdout = path == "-"
        self.label = f"{option} {shortened(printable(path), 200)}"
        if self.to_stdout:
            return
        if not path:
            raise CommandError(f'{option} "": must be a path, or - for stdout')
        try:
            check_writable(path)
        except (OSError, ValueError) as error:  # ValueError: a null character in the name
            raise CommandError(f"{self.label}: cannot be written: {reason_of(error)}") from error

    def is_same_as(self, path: str) -> bool:
        """Whether this is the same file as ``path``, under whatever name; ``-`` is stdout."""
        if "\0" in path:  # no file has such a name: opening it is refused in words
            return False
        if os.path.realpath(self.path) == os.path.realpath(path):
            return True
        own, other, nowhere = map(_identity, (self.path, path, os.devnull))
        if own is None or other is None or not os.path.samestat(own, other):
            return False
        return nowhere is None or not os.path.samestat(own, nowhere)

    def refuse_same(self, path: str, what: str) -> None:
        """Raise :class:`CommandError` where this is the file that is read, ``what`` in words."""
        if self.is_same_as(path):
            raise CommandError(f"{self.label}: is {what} itself")

    def write(self, content: bytes) -> None:
        """Write all of a document: a file is replaced whole, or left as it was.

        Raises
        ------
        CommandError
            If it cannot be written.
        """
        try:
            if self.to_stdout:
                stream = _stdout()
                stream.write(content)
                stream.flush()
            else:
                replace_file(self.path, content)
        except BrokenPipeError:
            raise
        except OSError as error:
            raise CommandError(f"{self.label}: cannot be written: {reason_of(error)}", FAILED) from error

    @contextmanager
    def stream(self) -> Iterator[TextIO]:
        """Open for text that is written bit by bit; what was written stays, however the run ends.

        A file takes the place of an older one at the end. If writing fails, or the process is killed, the
        older one is still there.
        """
        ended: BaseException | None = None
        try:
            with self._text() as text:
                try:
                    yield text
                except OSError:
                    raise
                except BaseException as error:  # the run ended early: its rows are kept all the same
                    ended = error
        except BrokenPipeError:
            raise
        except OSError as error:
            raise CommandError(f"{self.label}: cannot be written: {reason_of(error)}", FAILED) from error
        if ended is not None:
            raise ended

    @contextmanager
    def _text(self) -> Iterator[TextIO]:
        """Open for text: stdout, which stays open, or what takes the place of the file at the end."""
        if not self.to_stdout:
            with replacing(self.path) as fresh, open(fresh, "w", encoding="utf-8", newline="") as file:
                yield file
            return
        text = io.TextIOWrapper(_stdout(), encoding="utf-8", newline="")
        try:
            yield text
        finally:
            text.detach()  # which flushes it


class JsonOutput:
    """The document of ``--json``, of a command that prints a text where stdout is not for the document.

    Parameters
    ----------
    path : str, optional
        The path given with it; ``None`` where there is none, and nothing is written.
    source, what : str
        The file that is read, and what it is, where there is one: it cannot be written over.

    Attributes
    ----------
    is_given : bool
        Whether there is a document to write.
    leaves_stdout : bool
        Whether a text may be printed.

    Raises
    ------
    CommandError
        If it cannot be written, or is the file that is read.
    """

    def __init__(self, path: str | None, source: str = "", what: str = "") -> None:
        self._output = None if path is None else Output("--json", path)
        self.is_given, self.leaves_stdout = path is not None, path != "-"
        if self._output is not None and source:
            self._output.refuse_same(source, what)

    def write(self, document: Mapping[str, object]) -> None:
        """Write the document, if the option was given."""
        if self._output is not None:
            self._output.write(json_bytes(document))


def picture_directory(path: str, example: str) -> Path:
    """Return where pictures go, made if it was not there; refuse it if nothing can draw or write them.

    Parameters
    ----------
    path : str
        The path given with ``--plot``.
    example : str
        A name that a picture may have, to try whether files can be written there.

    Raises
    ------
    CommandError
        If it cannot be written, or there is no matplotlib.
    """
    require("--plot", "plot", "matplotlib")
    directory = Path(path)
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        raise CommandError(f"--plot {shown(path)}: cannot be written: {reason_of(error)}") from error
    Output("--plot", str(directory / example))  # whether files can be written there
    return directory


def _identity(path: str) -> os.stat_result | None:
    """Return the device and the number of a file, which all its names share; ``None`` where it has none."""
    try:
        return os.fstat(sys.stdout.fileno()) if path == "-" else os.stat(path)
    except (OSError, ValueError, AttributeError):  # not there; or stdout is no file, or closed
        return None


def _stdout() -> BinaryIO:
    if sys.stdout is None:
        raise CommandError("-: stdout is closed")
    sys.stdout.flush()
    return sys.stdout.buffer
