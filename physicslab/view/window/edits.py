"""What every tool of the window does after it has changed the world by hand."""

from __future__ import annotations

from physicslab.world import World

__all__ = ["announce_edit"]


def announce_edit(world: World) -> None:
    """Note that the world was edited, so that what is measured of it begins again.

    The energy that an edit brings in or takes out is no error of the simulation. Every tool, key and button
    that changes bodies, springs or laws calls this; what only changes the picture does not.
    """
    world.edited()
