"""What the menus offer: things to spawn, and scenes to open."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from physicslab.ecs.text import printable
from physicslab.scenes import SCENES
from physicslab.view.controls import actions, file_actions
from physicslab.view.controls.scene_files import scene_files
from physicslab.view.controls.tools import SPAWN_TOOLS, Tool
from physicslab.view.window.window import Window
from physicslab.world import World

__all__ = ["MENUS", "Choice"]


@dataclass(frozen=True, slots=True)
class Choice:
    """Something to choose: a line of a menu, or a button of a bar.

    Attributes
    ----------
    title : str
        Its words.
    choose : callable, optional
        What choosing it does; nothing where it is a heading.
    on : bool
        Whether it is what there is now.
    """

    title: str
    choose: Callable[[World, Window], None] | None = None
    on: bool = False


def _things(world: World, window: Window) -> list[Choice]:
    def choice(tool: Tool) -> Choice:
        chosen = window.tool == tool.name
        return Choice(tool.title, lambda _, window: actions.choose_tool(window, tool), chosen)

    return [Choice("Spawn with a click"), *map(choice, SPAWN_TOOLS)]


def _scenes(world: World, window: Window) -> list[Choice]:
    def choice(title: str, source: str | Path) -> Choice:
        shown = (world.title or world.name) == title
        return Choice(title, lambda _, window: file_actions.open_scene(window, source), shown)

    try:
        files = scene_files(Path.cwd())
    except OSError as error:
        window.notify(f"Files could not be listed: {error}", failed=True)
        files = []
    built_in = [choice(scene.title, name) for name, scene in SCENES.items()]
    found = (choice(printable(path.name), path) for path in files)
    saved = [Choice("Files in the working directory"), *found]
    return [Choice("Built-in scenes"), *built_in, *(saved if files else [])]


MENUS: dict[str, Callable[[World, Window], list[Choice]]] = {"spawn": _things, "scenes": _scenes}
"""What each menu offers, by the name that a control opens it by."""
