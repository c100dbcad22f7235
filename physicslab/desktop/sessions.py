"""Where each window keeps its last state, and which windows ended without closing.

A session is two files in one folder: ``<token>.json``, the state, and ``<token>.lock``, which the window that
owns it keeps locked. The system lets a lock go when a process ends, however it ends, so a state whose lock is
free is that of a crash; process numbers, which come again, are not relied on.

Files come and go only under a second lock, beside the folder, which is held for some milliseconds: otherwise
a window that looks for crashes could take the lock of one that has made its file and not locked it yet.
"""

from __future__ import annotations

import contextlib
import os
import secrets
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from filelock import FileLock, Timeout
from platformdirs import user_state_path

from physicslab.files.replace import remove_leftovers

_PATIENCE = 10.0
"""How long [s] the folder's lock is waited for: with eight windows at once it is free within 0.1 s."""
_INTERVAL = 0.002
"""Time [s] between two attempts at it."""


def session_folder() -> Path:
    """Return where the system expects a program's state to be kept; the folder need not exist.

    Raises
    ------
    OSError
        If the user has no home directory.
    """
    try:
        return user_state_path("physicslab", appauthor=False) / "sessions"
    except RuntimeError as error:  # neither HOME nor a line in the list of users
        raise OSError("there is no home directory to keep it in") from error


class Session:
    """One window's place for its state, locked as long as the process lives.

    Attributes
    ----------
    path : path
        The scene file with its last state; it need not exist.
    """

    def __init__(self, folder: Path, token: str, lock: FileLock) -> None:
        self.path = folder / f"{token}.json"
        self._folder = folder
        self._lock: FileLock | None = lock

    @classmethod
    def begin(cls, folder: Path) -> Session:
        """Begin a session of this process.

        Raises
        ------
        OSError
            If nothing can be written in the folder, or it is another user's.
        """
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        _check_owned(folder)
        with _alone(folder):
            token = secrets.token_hex(8)
            lock = _locked(folder / f"{token}.lock")
        if lock is None:
            raise OSError(f"{folder}: nothing can be locked there")
        return cls(folder, token, lock)

    @classmethod
    def abandoned(cls, folder: Path) -> list[Session]:
        """Return the sessions that ended without closing, the newest first; they are this process's now.

        Other files that their writers left behind are removed.
        """
        found: list[tuple[int, Session]] = []
        with contextlib.suppress(OSError):
            if not folder.is_dir():
                return []
            _check_owned(folder)
            with _alone(folder):
                tokens = {path.stem for ending in ("json", "lock") for path in folder.glob(f"*.{ending}")}
                for token in sorted(tokens):
                    lock = _locked(folder / f"{token}.lock")
                    if lock is None:
                        continue
                    session = cls(folder, token, lock)
                    remove_leftovers(session.path)
                    try:
                        found.append((session.path.stat().st_mtime_ns, session))
                    except OSError:  # it ended before it had a state to save
                        session._remove()
        return [session for _, session in sorted(found, key=lambda pair: pair[0], reverse=True)]

    def end(self) -> None:
        """Remove the state: the window was closed as it should be."""
        if self._lock is None:
            return
        with contextlib.suppress(OSError), _alone(self._folder):
            self._remove()
            return
        # The folder cannot be locked: an empty lock file is left, which the next start removes.
        with contextlib.suppress(OSError):
            self.path.unlink(missing_ok=True)
        self.release()

    def _remove(self) -> None:
        """Remove all files of this session, whose folder is locked."""
        with contextlib.suppress(OSError):
            self.path.unlink(missing_ok=True)
        remove_leftovers(self.path)
        self.release()  # first: Windows removes no file that is open
        with contextlib.suppress(OSError):
            self.path.with_suffix(".lock").unlink(missing_ok=True)

    def release(self) -> None:
        """Leave the state to whichever window starts next."""
        if self._lock is not None:
            self._lock.release()
            self._lock = None


@contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Let no other window make or remove files of sessions within a ``with`` block.

    Raises
    ------
    OSError
        If the lock beside the folder cannot be had.
    """
    lock = FileLock(folder.with_name(f"{folder.name}.lock"), timeout=_PATIENCE, poll_interval=_INTERVAL)
    with lock:
        yield


def _locked(path: Path) -> FileLock | None:
    """Lock a file, made if it is not there; ``None`` where another process has it, or it cannot be opened."""
    lock = FileLock(path, blocking=False, thread_local=False)
    try:
        lock.acquire()
    except (OSError, Timeout):
        return None
    return lock


def _check_owned(folder: Path) -> None:
    """Refuse a folder that another user has made or may write in: a state opened from it would be theirs.

    Raises
    ------
    PermissionError
        If it is a link, not this user's, or open to others and cannot be closed to them.
    """
    if not hasattr(os, "getuid"):
        return
    status = folder.lstat()
    if not stat.S_ISDIR(status.st_mode) or status.st_uid != os.getuid():
        raise PermissionError(f"{folder} is not a directory of this user")
    if stat.S_IMODE(status.st_mode) & 0o077:
        folder.chmod(0o700)
