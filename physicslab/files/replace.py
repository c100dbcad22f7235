"""Writing a file so that it is there whole, or as it was before."""

import contextlib
import glob
import itertools
import os
import secrets
import stat
import tempfile
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

ENDING = ".physicslab-tmp"
"""How files end that are being written; one that is there for long was left by a process that was killed."""
_CAN_BE_HELD = os.name == "nt"
"""Whether a file that another program holds open cannot be replaced: on Windows, while a scanner reads it."""
_PATIENCE, _PAUSE = 1.0, 0.05
"""How long [s] one is waited for, and between two attempts."""
_ABANDONED = 7.0 * 24.0 * 3600.0
"""Age [s] from which on such a file is taken for one that was left behind: a long run may write a row seldom,
and clocks are set."""


def reason_of(error: Exception) -> str:
    """Return in a few words why a file could not be read or written."""
    return (error.strerror if isinstance(error, OSError) else None) or str(error)


def replace_file(path: str | os.PathLike[str], content: bytes) -> None:
    """Write ``content`` to a file; if anything fails, the file stays as it was.

    Raises
    ------
    OSError
        If the file cannot be written.

    See Also
    --------
    replacing : How it is written.
    """
    with replacing(path) as fresh, open(fresh, "wb") as file:
        file.write(content)


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[str | os.PathLike[str]]:
    """Give the path to open for writing a file whole; if the ``with`` block fails, the file stays as it was.

    The bytes go to a new file beside it and to the disk; then that takes the old one's place. Links are
    followed, and what is no ordinary file (a device, a pipe) is written to as it is. A process that is killed
    meanwhile leaves the new file behind, ``.<name>.<16 digits>.physicslab-tmp``; the next that writes a file
    in the same folder removes it once it is a week old.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    check_writable(path)
    if os.path.exists(path) and not os.path.isfile(path):
        yield path
        return
    target = Path(os.path.realpath(path))
    _remove(target.parent, ".*.", _ABANDONED)
    with _beside(target) as fresh:
        with open(fresh, "xb"):
            pass
        yield fresh
        with open(fresh, "rb+") as written:
            os.fsync(written.fileno())
        if target.exists():
            os.chmod(fresh, stat.S_IMODE(target.stat().st_mode))
        rename_over(fresh, target)


def rename_over(fresh: str | os.PathLike[str], target: str | os.PathLike[str]) -> None:
    """Give a file the place of another, which on Windows takes a second attempt while that one is held.

    Raises
    ------
    OSError
        If it cannot have it.
    """
    deadline = time.monotonic() + _PATIENCE
    while True:
        try:
            return os.replace(fresh, target)
        except PermissionError as error:
            if not _CAN_BE_HELD:
                raise
            if time.monotonic() > deadline:
                held = "another program holds it open, or it may not be written"
                raise PermissionError(error.errno, held, os.fspath(target)) from error
        time.sleep(_PAUSE)


def create_file(path: Path, content: bytes) -> None:
    """Write a new file whole, under a name that nothing has: of two that try at once, one succeeds.

    Raises
    ------
    FileExistsError
        If the name is taken, be it by a link that leads nowhere; what has it stays as it was.
    OSError
        If the file cannot be written.
    """
    if os.path.lexists(path):
        raise FileExistsError(f"{path} exists")
    _remove(path.parent, ".*.", _ABANDONED)
    with _beside(path) as fresh:
        with open(fresh, "xb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        try:
            os.link(fresh, path)  # fails where the name is taken, which a renaming does not
        except FileExistsError:
            raise
        except (OSError, NotImplementedError):  # a file system without hard links
            with open(path, "xb"):
                pass
            rename_over(fresh, path)


def create_first(paths: Iterable[Path], content: bytes) -> Path:
    """Write a new file under the first of some names that nothing has, and return it.

    Several programs that do so at once under the same names get names of their own.

    Raises
    ------
    OSError
        If the file cannot be written, or every name is taken.
    """
    for path in paths:
        with contextlib.suppress(FileExistsError):
            create_file(path, content)
            return path
    raise FileExistsError("every name is taken")


def with_numbers(path: Path) -> Iterator[Path]:
    """Yield a path, and then the same with -2, -3 and so on before its ending."""
    yield path
    for number in itertools.count(2):
        yield path.with_stem(f"{path.stem}-{number}")


@contextmanager
def _beside(target: Path) -> Iterator[Path]:
    """Give the name of a new file beside another; what has it after the ``with`` block is removed."""
    fresh = target.with_name(f"{_beginning(target)}{secrets.token_hex(8)}{ENDING}")
    try:
        yield fresh
    finally:
        fresh.unlink(missing_ok=True)


def remove_leftovers(path: Path) -> None:
    """Remove the remains of killed processes that were writing this file."""
    _remove(path.parent, glob.escape(_beginning(path)), 0.0)


def _remove(folder: Path, beginning: str, age: float) -> None:
    """Remove what was being written in a folder, if its name begins so and it is ``age`` seconds old."""
    for left in folder.glob(f"{beginning}{'[0-9a-f]' * 16}{ENDING}"):
        with contextlib.suppress(OSError):
            if time.time() - left.stat().st_mtime >= age:
                left.unlink()


def _beginning(path: Path) -> str:
    # A part of a long name suffices: the system has a limit, in bytes, and a letter may take four.
    return f".{path.name[:40]}."


def check_writable(path: str | os.PathLike[str]) -> None:
    """Raise the ``OSError`` that writing this file would, without touching it."""
    if os.path.isdir(path):
        raise IsADirectoryError(f"{path} is a directory")
    if os.path.basename(path) == "":
        raise NotADirectoryError(f"{path} is the name of a directory")
    if os.path.exists(path):  # of the path itself: /dev/stdout leads to a pipe, which has no other name
        if not os.access(path, os.W_OK):
            raise PermissionError(f"{path} may not be written")
        if not os.path.isfile(path):
            return
    parent = Path(os.path.realpath(path)).parent
    if not parent.is_dir():
        raise FileNotFoundError(f"there is no directory {parent}")
    if not os.access(parent, os.W_OK):
        raise PermissionError(f"nothing may be written in {parent}")
    with contextlib.suppress(FileNotFoundError):
        os.stat(path)  # a name may be too long
    with tempfile.TemporaryFile(dir=parent):
        pass  # some directories hold what they like, whatever their permissions say
