"""What every tool of the window does when it changes the world by hand."""

from __future__ import annotations

from typing import Any

from physicslab.components import Velocity
from physicslab.world import World

__all__ = ["announce_edit", "set_field"]


def announce_edit(world: World) -> None:
    """Note that the world was edited, so that what is measured of it begins again.

    The energy that an edit brings in or takes out is no error of the simulation. Every tool, key and button
    that changes bodies, springs or laws calls this; what only changes the picture does not.
    """
    world.edited()


def set_field(world: World, entity: int, component: type[Any], name: str, value: object) -> None:
    """Give a field of a component a value.

    Raises
    ------
    InvalidValue
        If the field cannot hold it; nothing is changed then.
    """
    held = world.component(entity, component)
    before = getattr(held, name)
    setattr(held, name, value)
    try:
        if hasattr(held, "validate"):
            held.validate()
    except ValueError:
        setattr(held, name, before)
        raise
    announce_edit(world)


def moves(world: World, entity: int) -> bool:
    """Whether an entity is a body that can move."""
    return world.has(entity, Velocity)
