"""Where each window keeps its last state, and which windows ended without closing.

A session is two files in one folder: ``<token>.json``, the state, and ``<token>.lock``, which the window that
owns it keeps locked. The system lets a lock go when a process ends, however it ends, so a state whose lock is
free is that of a crash; process numbers, which come again, are not relied on.
"""

from __future__ import annotations

import contextlib
import os
import secrets
import sys
from pathlib import Path
from typing import IO

from physicslab.files.replace import remove_leftovers

__all__ = ["Session", "session_folder"]

_ATTEMPTS = 3
"""A window that starts at the same moment may take a fresh lock for an abandoned one."""


def session_folder() -> Path:
    """Return where the system wants a program's state to be kept; the folder need not exist."""
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
        return base / "physicslab" / "sessions"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Application Support" / "physicslab" / "sessions"
    given = os.environ.get("XDG_STATE_HOME", "")
    # A path that is not absolute is to be passed over, says the XDG Base Directory Specification.
    base = Path(given) if os.path.isabs(given) else Path.home() / ".local" / "state"
    return base / "physicslab" / "sessions"


class Session:
    """One window's place for its state, locked as long as the process lives.

    Attributes
    ----------
    path : path
        The scene file with its last state; it need not exist.
    """

    def __init__(self, folder: Path, token: str, lock: IO[bytes]) -> None:
        self.path = folder / f"{token}.json"
        self._lock_path = folder / f"{token}.lock"
        self._lock: IO[bytes] | None = lock

    @classmethod
    def begin(cls, folder: Path) -> Session:
        """Begin a session of this process.

        Raises
        ------
        OSError
            If nothing can be written in the folder.
        """
        folder.mkdir(parents=True, exist_ok=True)
        for _ in range(_ATTEMPTS):
            token = secrets.token_hex(8)
            lock = _locked(folder / f"{token}.lock")
            if lock is not None:
                return cls(folder, token, lock)
        raise OSError(f"{folder}: nothing can be written or locked there")

    @classmethod
    def abandoned(cls, folder: Path) -> list[Session]:
        """Return the sessions that ended without closing, the newest first; they are this process's now.

        What else their writers left behind is removed.
        """
        found: list[tuple[int, Session]] = []
        with contextlib.suppress(OSError):
            for lock_path in sorted(folder.glob("*.lock")):
                lock = _locked(lock_path)
                if lock is None:
                    continue
                session = cls(folder, lock_path.stem, lock)
                remove_leftovers(session.path)
                try:
                    found.append((session.path.stat().st_mtime_ns, session))
                except OSError:  # it ended before it had a state to save
                    session.end()
        return [session for _, session in sorted(found, key=lambda pair: pair[0], reverse=True)]

    def end(self) -> None:
        """Remove the state: the window was closed as it should be."""
        with contextlib.suppress(OSError):
            self.path.unlink(missing_ok=True)
        remove_leftovers(self.path)
        self.release()  # first: Windows removes no file that is open
        with contextlib.suppress(OSError):
            self._lock_path.unlink(missing_ok=True)

    def release(self) -> None:
        """Leave the state to whichever window starts next."""
        if self._lock is not None:
            self._lock.close()
            self._lock = None


def _locked(path: Path) -> IO[bytes] | None:
    """Open a file and lock it; ``None`` where another process has it, or it cannot be opened."""
    try:
        file = open(path, "ab")  # noqa: SIM115
    except OSError:
        return None
    try:
        if sys.platform == "win32":
            import msvcrt

            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(file.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        file.close()
        return None
    return file
