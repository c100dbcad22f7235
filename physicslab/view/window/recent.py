"""Files of earlier sessions: opened or saved last, and left by sessions that ended without closing."""

import time
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Protocol

from physicslab.files.replace import rename_over
from physicslab.files.scene import load_scene
from physicslab.world import World

_LIMIT = 10
"""How many are kept."""


class RecentFiles:
    """Files that were opened or saved, the last one first; each is there once.

    Parameters
    ----------
    paths : iterable of path
        Those of earlier sessions.

    Attributes
    ----------
    paths : list of path
        All that are kept, gone or not: a file of a disk that is not there now may be there again.
    """

    def __init__(self, paths: Iterable[Path] = ()) -> None:
        self.paths = list(dict.fromkeys(paths))[:_LIMIT]

    def note(self, path: Path) -> None:
        """Put a file first."""
        path = path.absolute()
        self.paths = [path, *(other for other in self.paths if other != path)][:_LIMIT]

    @property
    def there(self) -> list[Path]:
        """Those that can be found now."""
        return [path for path in self.paths if _is_there(path)]


def _is_there(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


class AbandonedSession(Protocol):
    """The state that a session has left, and the lock on it."""

    @property
    def path(self) -> Path:
        """The scene file that holds the state."""

    def end(self) -> None:
        """Remove the state for good."""

    def release(self) -> None:
        """Leave the state to the next start."""


class Recovery:
    """The sessions that ended without closing, the newest on offer; none is opened before it is chosen.

    Parameters
    ----------
    abandoned : sequence of AbandonedSession
        The newest first. Those on which no decision was made are offered again at the next start.
    own : path, optional
        Where this window keeps its own state.
    """

    def __init__(self, abandoned: Sequence[AbandonedSession] = (), own: Path | None = None) -> None:
        self._left, self._own = list(abandoned), own

    @property
    def offered(self) -> bool:
        """Whether there is something to decide on."""
        return bool(self._left)

    @property
    def words(self) -> str:
        """The message about the session on offer."""
        try:
            saved = time.localtime(self._left[0].path.stat().st_mtime)
        except (IndexError, OSError):
            return "Your last session is kept"
        when = time.strftime("%Y-%m-%d %H:%M", saved)
        if len(self._left) > 1:
            return f"{len(self._left)} sessions are kept, the last as of {when}"
        return f"Your last session is kept, as of {when}"

    def restore(self) -> World:
        """Return the world of the session on offer.

        Its file becomes that of this window, so that it is not lost if this one ends badly too.

        Raises
        ------
        SceneError, InvalidValue, OSError
            If it cannot be read; it stays on offer.
        """
        session = self._left[0]
        world = load_scene(session.path)
        world.synchronise()
        if self._own is not None:
            rename_over(session.path, self._own)
            session.end()
        self.leave()
        return world

    def discard(self) -> None:
        """Remove the session on offer for good; an older one is offered next."""
        self._left.pop(0).end()

    def leave(self) -> None:
        """Leave the sessions on which no decision was made to the next start."""
        for session in self._left:
            session.release()
        self._left = []
