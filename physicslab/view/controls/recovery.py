"""What a session that ended without closing has left."""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from pathlib import Path

from physicslab.desktop.sessions import Session
from physicslab.files.scene import load_scene
from physicslab.world import World

__all__ = ["Recovery"]


class Recovery:
    """The sessions that ended without closing, the newest on offer; nothing is opened without being asked.

    Parameters
    ----------
    abandoned : sequence of Session
        The newest first. Those that nobody decided on are offered again at the next start.
    own : path, optional
        Where this window keeps its own state.
    """

    def __init__(self, abandoned: Sequence[Session] = (), own: Path | None = None) -> None:
        self._left, self._own = list(abandoned), own

    @property
    def offered(self) -> bool:
        """Whether there is something to decide on."""
        return bool(self._left)

    @property
    def words(self) -> str:
        """What to say of the session on offer."""
        try:
            saved = time.localtime(self._left[0].path.stat().st_mtime)
        except (IndexError, OSError):
            return "The last session ended without closing"
        return f"The last session ended without closing; saved {time.strftime('%d %b %H:%M', saved)}"

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
            os.replace(session.path, self._own)
            session.end()
        self.leave()
        return world

    def discard(self) -> None:
        """Remove the session on offer for good; an older one is offered next."""
        self._left.pop(0).end()

    def leave(self) -> None:
        """Leave what nobody decided on to the next start."""
        for session in self._left:
            session.release()
        self._left = []
