"""What the menus offer: things to spawn, and scenes to open."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from physicslab.files.checks import printable
from physicslab.scenes import SCENES
from physicslab.view.controls import actions
from physicslab.view.controls.scene_files import scene_files
from physicslab.view.controls.tools import SPAWN_TOOLS, Tool
from physicslab.view.window import Window
from physicslab.world import World

__all__ = ["MENUS", "StepPlan"]


@dataclass(frozen=True, slots=True)
class StepPlan:
    """A line of a menu.

    Attributes
    ----------
    title : str
        What it says.
    choose : callable, optional
        What choosing it does; nothing where it is a heading.
    on : bool
        Whether it is what there is now.
    """

    title: str
    choose: Callable[[World, Window], None] | None = None
    on: bool = False


def _things(world: World, window: Window) -> list[StepPlan]:
    def choice(tool: Tool) -> StepPlan:
        return StepPlan(tool.title, lambda _, window: actions.choose_tool(window, tool), window.tool is tool)

    return [StepPlan("Spawn with a click"), *map(choice, SPAWN_TOOLS)]


def _scenes(world: World, window: Window) -> list[StepPlan]:
    def choice(title: str, source: str | Path) -> StepPlan:
        shown = (world.title or world.name) == title
        return StepPlan(title, lambda _, window: actions.open_scene(window, source), shown)

    try:
        files = scene_files(Path.cwd())
    except OSError as error:
        window.notify(f"Files could not be listed: {error}", failed=True)
        files = []
    built_in = [choice(scene.title, name) for name, scene in SCENES.items()]
    found = (choice(printable(path.name), path) for path in files)
    saved = [StepPlan("Files in the working directory"), *found]
    return [StepPlan("Built-in scenes"), *built_in, *(saved if files else [])]


MENUS: dict[str, Callable[[World, Window], list[StepPlan]]] = {"spawn": _things, "scenes": _scenes}
"""What each menu offers, by the name that a control opens it by."""
