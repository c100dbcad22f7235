"""What a tool is: what a press and a release of the left button do in the world."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from physicslab.view.controls.spawning import Spawnable
from physicslab.view.window.window import Window
from physicslab.world import World

__all__ = ["Deed", "Tool"]

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
    spawn : Spawnable, optional
        What a click on empty space makes.
    prompts : tuple of str
        What to do next, by how many points are placed; shown beside the cursor.
    """

    name: str
    title: str
    usage: str
    press: Deed
    release: Deed
    pans: bool = False
    spawn: Spawnable | None = None
    prompts: tuple[str, ...] = ()
