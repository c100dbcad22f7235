"""Where a command's documents go: a file, or stdout for ``-``."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import BinaryIO, TextIO

from physicslab.commands.command_error import FAILED, CommandError
from physicslab.files.checks import printable
from physicslab.files.replace import check_writable, replace_file

__all__ = ["Output"]


class Output:
    """One destination that the user named.

    Making one checks that it can be written, so that a long run is not lost to a misspelt directory.

    Parameters
    ----------
    option : str
        The option that named it, for messages.
    path : str
        A path, or ``-`` for stdout.

    Raises
    ------
    CommandError
        If it cannot be written.
    """

    def __init__(self, option: str, path: str) -> None:
        self.path = path
        self.to_stdout = path == "-"
        self._label = f"{option} {printable(path)}"
        if self.to_stdout:
            return
        try:
            check_writable(path)
        except (OSError, ValueError) as error:  # ValueError: a null character in the name
            raise CommandError(f"{self._label}: cannot be written: {_reason(error)}") from error

    def is_same_as(self, path: str) -> bool:
        """Whether this is the same file as ``path``."""
        return not self.to_stdout and os.path.realpath(self.path) == os.path.realpath(path)

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
            raise CommandError(f"{self._label}: cannot be written: {_reason(error)}", FAILED) from error

    @contextmanager
    def stream(self) -> Iterator[TextIO]:
        """Open for text that is written bit by bit; what was written stays, however the run ends."""
        if self.to_stdout:
            text = io.TextIOWrapper(_stdout(), encoding="utf-8", newline="")
            try:
                yield text
                text.flush()
            finally:
                text.detach()
            return
        try:
            file = open(self.path, "w", encoding="utf-8", newline="")  # noqa: SIM115
        except OSError as error:
            raise CommandError(f"{self._label}: cannot be written: {_reason(error)}") from error
        try:
            with file:
                yield file
        except BrokenPipeError:
            raise
        except OSError as error:
            raise CommandError(f"{self._label}: cannot be written: {_reason(error)}", FAILED) from error


def _stdout() -> BinaryIO:
    if sys.stdout is None:
        raise CommandError("-: stdout is closed")
    sys.stdout.flush()
    return sys.stdout.buffer


def _reason(error: Exception) -> str:
    return (error.strerror if isinstance(error, OSError) else None) or str(error)
