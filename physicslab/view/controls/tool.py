"""The interface of a tool: the actions of a press and a release of the left button; its icon."""

from dataclasses import dataclass

import pygame

from physicslab.view.controls.drawn import Drawn
from physicslab.view.window.window import Action, Window
from physicslab.world import World


def _nothing(world: World, window: Window) -> None:
    """Do nothing."""


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
        Called when the button goes down and up.
    pans, drags : bool
        Whether dragging moves the picture, and whether it is pressed at one place and let go at another.
    draws : Drawn, optional
        The thing that it draws.
    prompts : tuple of str
        Prompts beside the cursor, by how many points are placed.
    """

    name: str
    title: str
    usage: str
    press: Action = _nothing
    release: Action = _nothing
    pans: bool = False
    drags: bool = False
    draws: Drawn | None = None
    prompts: tuple[str, ...] = ()

    @property
    def icon(self) -> str:
        """Its icon; that of others behind one button where it has none of its own."""
        return ICONS.get(self.name, ICONS["more"])

    @property
    def cursor(self) -> int:
        """How the cursor looks with it, one of those of the system."""
        if self.pans:
            return pygame.SYSTEM_CURSOR_SIZEALL
        if self.name == "remove":
            return pygame.SYSTEM_CURSOR_NO
        return pygame.SYSTEM_CURSOR_CROSSHAIR if self.draws or self.drags else pygame.SYSTEM_CURSOR_ARROW


ICONS = {
    "select": "\uf25a", "circle": "\uf111", "box": "\uf0c8", "capsule": "\uf46b", "block": "\uf068",
    "beam": "\uf7a4", "polygon": "\uf5ee", "ramp": "\uf0d8",
    "pendulum": "\uf5cd", "chain": "\uf0c1", "spring": "\uf83e", "rod": "\uf715", "rope": "\uf4d7",
    "pin": "\uf192", "motor": "\uf863", "slot": "\uf337", "weld": "\uf46a", "pulley": "\uf655",
    "gear": "\uf013", "belt": "\uf363", "remove": "\uf12d", "ruler": "\uf545",
    "protractor": "\uf568", "gate": "\uf11e", "note": "\uf249", "pan": "\uf0b2",
    "more": "\uf141", "brush": "\uf1fc", "wall": "\uf00a", "dominoes": "\uf7a5", "stack": "\uf5fd",
    "pyramid": "\uf6fc", "heap": "\uf1ce", "pit": "\uf01c",
    "binary": "\uf753", "play": "\uf04b", "pause": "\uf04c", "step": "\uf051", "back": "\uf048",
    "restart": "\uf2f9", "undo": "\uf0e2", "redo": "\uf01e", "aim": "\uf05b",
}  # fmt: skip
"""Each icon by its name; most names are those of tools."""
