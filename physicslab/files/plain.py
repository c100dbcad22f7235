"""Plain files, read with a limit: nothing waits for a pipe, or reads without end."""

import os
import stat
from typing import BinaryIO

from physicslab.files.checks import SceneError

FILE_LIMIT = 100 * 2**20
"""Bytes that a scene file may have."""


def read_bytes(
    path: str | os.PathLike[str], source: str, limit: int = FILE_LIMIT, what: str = "a scene file"
) -> bytes:
    """Read a plain file, and never more of it than ``limit``: what is opened may grow, or have no end.

    ``source`` is what messages call it, and ``what`` what it should be.

    Raises
    ------
    SceneError
        If it is no plain file, or larger.
    OSError
        If it cannot be read.
    """
    with open_plain(path, source, what) as file:
        content = file.read(limit + 1)
    if len(content) > limit:
        raise SceneError(f"{source}: is too large: {what} must have at most {limit:,} bytes")
    return content


def open_plain(path: str | os.PathLike[str], source: str, what: str = "a scene file") -> BinaryIO:
    """Open a plain file to read: a pipe without a writer would wait for ever. Errors: :func:`read_bytes`."""
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    if os.path.isdir(path):  # Windows would say "permission denied"
        raise SceneError(f"{source}: is a directory, not {what}")
    descriptor = os.open(path, flags)
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        raise SceneError(f"{source}: is a pipe or a device; {what} must be a plain file")
    return os.fdopen(descriptor, "rb")
