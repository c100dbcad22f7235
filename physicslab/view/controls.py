"""The controls in one table: what the input system obeys and the controls hint shows."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from physicslab.view import actions
from physicslab.view.window import Window
from physicslab.world import World

__all__ = ["CONTROLS", "KEYS", "RELEASES", "Control"]

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
        The key's name in SDL, after ``"ctrl+"`` where that is held too; empty for the mouse.
    action, release : callable, optional
        What is called when the key goes down, and when it goes up.
    also : str
        Another key that does the same.
    minor : bool
        Whether it is left to the help panel, so that the hint stays short.
    """

    label: str
    does: str
    key: str = ""
    action: Action | None = None
    release: Action | None = None
    also: str = ""
    minor: bool = False


CONTROLS: tuple[Control, ...] = (
    Control("Left", "drag, throw, new circle"),
    Control("Right", "new box"),
    Control("P", "pendulum", "p", actions.spawn_pendulum),
    Control("S", "spring: hold, drag", "s", actions.begin_spring, actions.end_spring),
    Control("Del", "remove", "delete", actions.remove, also="backspace"),
    Control("Space", "pause", "space", actions.toggle_pause),
    Control(".", "one step", ".", actions.step),
    Control("Tab", "slow motion", "tab", actions.toggle_slow_motion),
    Control("[", "half the speed", "[", actions.slower, minor=True),
    Control("]", "twice the speed", "]", actions.faster, minor=True),
    Control("G", "gravity", "g", actions.toggle_gravity),
    Control("O", "planets", "o", actions.toggle_planets),
    Control("V", "arrows", "v", actions.toggle_arrows),
    Control("T", "trails", "t", actions.toggle_trails),
    Control("E", "impulses", "e", actions.toggle_impulses),
    Control("R", "clear all", "r", actions.clear),
    Control("Wheel", "zoom"),
    Control("Middle", "pan"),
    Control("F", "fit", "f", actions.fit),
    Control("Home", "first view", "home", actions.go_home, minor=True),
    Control("H", "grid", "h", actions.toggle_grid, minor=True),
    Control("Ctrl+S", "save the scene", "ctrl+s", actions.save, minor=True),
    Control("Ctrl+O", "open the last scene saved", "ctrl+o", actions.reopen, minor=True),
    Control("F12", "screenshot", "f12", actions.ask_screenshot, minor=True),
    Control("F1", "all keys", "f1", actions.toggle_help),
    Control("Esc", "quit", "escape", actions.leave),
)
"""Everything there is to press, in the order of the hint."""

KEYS: dict[str, Action] = {
    key: control.action
    for control in CONTROLS
    for key in (control.key, control.also)
    if key and control.action is not None
}
"""What each key does when it goes down, by its name in SDL."""

RELEASES: dict[str, Action] = {
    control.key: control.release for control in CONTROLS if control.release is not None
}
"""What each key does when it goes up."""
