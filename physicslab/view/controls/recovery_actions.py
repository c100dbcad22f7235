"""What can be done with what a session that ended without closing has left."""

from __future__ import annotations

from physicslab.ecs.fields import InvalidValue
from physicslab.files.scene import SceneError
from physicslab.view.window.window import Window
from physicslab.world import World

__all__ = ["discard_session", "restore_session"]


def restore_session(world: World, window: Window) -> None:
    """Open what the session on offer has left; where that fails, all stays as it is."""
    try:
        window.next_world = window.recovery.restore()
    except (SceneError, InvalidValue, OSError) as error:
        window.notify(f"Not restored: {error}", 8.0, failed=True)
    else:
        window.pace.paused = True
        window.notify("Restored, and paused: Space goes on")


def discard_session(world: World, window: Window) -> None:
    """Remove what the session on offer has left."""
    window.recovery.discard()
