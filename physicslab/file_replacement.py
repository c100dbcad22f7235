"""Writing a file so that it is there whole, or as it was before."""

from __future__ import annotations

import os
import secrets
import stat
from pathlib import Path

__all__ = ["check_writable", "replace_file"]


def replace_file(path: str | os.PathLike[str], content: bytes) -> None:
    """Write ``content`` to a file; if anything fails, the file stays as it was.

    The bytes go to a new file beside it and to the disk; then that takes the old one's place. Links are
    followed, and what is no ordinary file (a device, a pipe) is written to as it is.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    check_writable(path)
    if os.path.exists(path) and not os.path.isfile(path):
        Path(path).write_bytes(content)
        return
    target = Path(os.path.realpath(path))
    fresh = target.with_name(f".{secrets.token_hex(8)}.tmp")
    try:
        with open(fresh, "xb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        if target.exists():
            os.chmod(fresh, stat.S_IMODE(target.stat().st_mode))
        os.replace(fresh, target)
    finally:
        fresh.unlink(missing_ok=True)


def check_writable(path: str | os.PathLike[str]) -> None:
    """Raise the ``OSError`` that writing this file would, without touching it."""
    if os.path.isdir(path):
        raise IsADirectoryError(f"{path} is a directory")
    if os.path.exists(path):  # asked of the path itself: /dev/stdout leads to a pipe, which has no other name
        if not os.access(path, os.W_OK):
            raise PermissionError(f"{path} may not be written")
        return
    parent = Path(os.path.realpath(path)).parent
    if not parent.is_dir():
        raise FileNotFoundError(f"there is no directory {parent}")
    if not os.access(parent, os.W_OK):
        raise PermissionError(f"nothing may be written in {parent}")
