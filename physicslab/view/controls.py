"""The controls in one table: what the input system obeys and the controls hint shows."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from physicslab.view import actions
from physicslab.view.window import Window
from physicslab.world import World

__all__ = ["CONTROLS", "KEYS", "Control"]

type Action = Callable[[World, Window], None]


@dataclass(frozen=True, slots=True)
class Control:
    """One thing the user can do.

    Attributes
    ----------
    label : str
        What is pressed, as on the cap of a key.
    does : str
        What it does, in a word or two.
    key : str
        The key's name in SDL, empty for the mouse.
    action : callable, optional
        What is called when the key goes down.
    """

    label: str
    does: str
    key: str = ""
    action: Action | None = None


CONTROLS: tuple[Control, ...] = (
    Control("Left", "drag, throw, new circle"),
    Control("Right", "new box"),
    Control("P", "pendulum", "p", actions.spawn_pendulum),
    Control("Space", "pause", "space", actions.toggle_pause),
    Control(".", "one step", ".", actions.step),
    Control("Tab", "slow motion", "tab", actions.toggle_slow_motion),
    Control("G", "gravity", "g", actions.toggle_gravity),
    Control("O", "planets", "o", actions.toggle_planets),
    Control("T", "trails", "t", actions.toggle_trails),
    Control("R", "clear all", "r", actions.clear),
    Control("Wheel", "zoom"),
    Control("Middle", "pan"),
    Control("F", "fit", "f", actions.fit),
    Control("Home", "first view", "home", actions.go_home),
    Control("F12", "screenshot", "f12", actions.ask_screenshot),
    Control("Esc", "quit", "escape", actions.close),
)
"""Everything there is to press, in the order of the hint."""

KEYS: dict[str, Action] = {control.key: control.action for control in CONTROLS if control.action is not None}
"""What each key does, by its name in SDL."""
