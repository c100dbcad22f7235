"""The interface of a tool: the actions of a press and a release of the left button in the world."""

from __future__ import annotations

from dataclasses import dataclass

from physicslab.view.controls.spawning import Spawnable
from physicslab.view.window.window import Action

__all__ = ["Tool"]


@dataclass(frozen=True, slots=True)
class Tool:
    """The actions of a press and a release of the left button.

    Attributes
    ----------
    name, title : str
        Its icon, and what it is called.
    usage : str
        How it is used.
    press, release : callable
        What happens.
    pans, drags : bool
        Whether dragging moves the picture, and whether it is pressed at one place and let go at another.
    spawn : Spawnable, optional
        What a click on empty space makes.
    prompts : tuple of str
        What to do next, by how many points are placed; shown beside the cursor.
    """

    name: str
    title: str
    usage: str
    press: Action
    release: Action
    pans: bool = False
    drags: bool = False
    spawn: Spawnable | None = None
    prompts: tuple[str, ...] = ()
