"""What the left mouse button does in the world: one tool at a time, named in the window."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from physicslab.view.controls.picking import body_at
from physicslab.view.controls.spawning import CIRCLE, SPAWNS, Spawn
from physicslab.view.window.edits import announce_edit
from physicslab.view.window.window import Window
from physicslab.world import World

__all__ = [
    "HAND", "PAN", "REMOVE", "SPAWN_TOOLS", "SPRING", "TOOLS", "Tool", "begin_spring", "end_spring", "remove",
]  # fmt: skip

type Deed = Callable[[World, Window], None]


@dataclass(frozen=True, slots=True)
class Tool:
    """What a press and a release of the left button do.

    Attributes
    ----------
    name, title : str
        Its icon, and what it is called.
    usage : str
        How it is used.
    press, release : callable
        What happens.
    pans : bool
        Whether dragging moves the picture.
    """

    name: str
    title: str
    usage: str
    press: Deed
    release: Deed
    pans: bool = False


def _nothing(world: World, window: Window) -> None:
    """Do nothing."""


def let_go(world: World, window: Window) -> None:
    """Let go of what is held."""
    window.hand.release(world, window.place, window.now, window.pace.paused)


def remove(world: World, window: Window) -> None:
    """Remove the body under the cursor; its springs go with it."""
    entity = body_at(world, window.camera, window.pointer)
    if entity is None:
        window.notify("Nothing to remove: put the cursor on a body")
        return
    if window.hand.entity == entity:
        window.hand.drop(world)
    world.remove(entity)
    announce_edit(world)


def begin_spring(world: World, window: Window) -> None:
    """Begin a spring at the body under the cursor."""
    entity = body_at(world, window.camera, window.pointer)
    if entity is not None:
        window.spring_tool.begin(world, entity, window.place)
    elif window.tool == SPRING.name:
        window.notify("A spring begins on a body: press on one, and drag to where it shall end")
    else:
        window.notify(
            "A spring begins on a body: put the cursor on one, hold S, and drag to where it shall end"
        )


def end_spring(world: World, window: Window) -> None:
    """End the spring at the body under the cursor, or at that point of the world."""
    target = body_at(world, window.camera, window.pointer)
    refused = window.spring_tool.end(world, target, window.place)
    if refused:
        window.notify(refused)
    else:
        announce_edit(world)


def spawning(spawn: Spawn) -> Tool:
    """Return the tool that takes hold of bodies, and spawns where there is none."""

    def press(world: World, window: Window) -> None:
        entity = body_at(world, window.camera, window.pointer)
        if entity is None:
            spawn.spawn(world, window)
        elif not window.hand.take(world, entity, window.place, window.now):
            window.notify(f"{world.label(entity)} is static: it stays where it is")

    usage = f"{spawn.title}: click {spawn.place}. Bodies can still be dragged."
    return Tool(spawn.name, spawn.title, usage, press, let_go)


HAND = spawning(CIRCLE)
"""The tool at the start: that of a new window."""
SPAWN_TOOLS = (HAND, *(spawning(spawn) for spawn in SPAWNS[1:]))
"""A tool for each thing there is to spawn."""
SPRING = Tool("spring", "Spring", "Spring: press on a body, drag, let go.", begin_spring, end_spring)
REMOVE = Tool("remove", "Remove", "Remove: click a body; its springs go with it.", remove, _nothing)
PAN = Tool("pan", "Move the view", "Move the view: drag anywhere.", _nothing, _nothing, pans=True)
TOOLS = {tool.name: tool for tool in (*SPAWN_TOOLS, SPRING, REMOVE, PAN)}
"""Every tool, by the name that ``Window.tool`` holds."""
