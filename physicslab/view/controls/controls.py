"""The controls in one table: what keys do, and what the hint, the help and the toolbar show."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from physicslab.components import Trail
from physicslab.view.controls import actions, file_actions
from physicslab.view.controls.actions import toggle_menu
from physicslab.view.controls.spawning import spawn_pendulum
from physicslab.view.controls.tools import (
    HAND,
    PAN,
    REMOVE,
    SPAWN_TOOLS,
    SPRING,
    Tool,
    begin_spring,
    end_spring,
    remove,
)
from physicslab.view.panels.laws import has_gravity
from physicslab.view.window.window import Window
from physicslab.world import World

__all__ = ["CONTROLS", "KEYS", "RELEASES", "Control"]

type Action = Callable[[World, Window], None]
type State = Callable[[World, Window], bool]

_BOX, _PENDULUM = (
    next(tool for tool in SPAWN_TOOLS if tool.name == name) for name in ("box", "pendulum")
)  # fmt: skip


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
    group, icon, tip : str
        On the toolbar: what it stands together with, its picture, and the words of its tip.
    tool : Tool, optional
        What its button makes of the left mouse button; where there is one, the button does nothing else.
    click : callable, optional
        What its button does, where that is not what the key does.
    state : callable, optional
        Returns whether what it turns on is on.
    menu : str
        The menu that it opens.
    """

    label: str
    does: str
    key: str = ""
    action: Action | None = None
    release: Action | None = None
    also: str = ""
    minor: bool = False
    group: str = ""
    icon: str = ""
    tip: str = ""
    tool: Tool | None = None
    click: Action | None = None
    state: State | None = None
    menu: str = ""

    def on(self, world: World, window: Window) -> bool:
        """Whether its button is marked."""
        if self.tool is not None:
            return window.tool == self.tool.name
        if self.menu:
            return window.menu == self.menu
        return self.state is not None and self.state(world, window)

    def pressed(self, world: World, window: Window) -> None:
        """Do what its button does."""
        if self.tool is not None:
            actions.choose_tool(window, HAND if window.tool == self.tool.name else self.tool)
            return
        deed = self.click or self.action
        if deed is not None:
            deed(world, window)


def _gravity_is(world: World, mode: str) -> bool:
    return has_gravity(world) and world.physics.gravity_mode == mode


CONTROLS: tuple[Control, ...] = (
    Control("Left", "drag, throw, new circle", group="tools", icon="hand", tool=HAND,
            tip="Drag and throw bodies, click for a new circle"),
    Control("Right", "new box", group="tools", icon="box", tool=_BOX, tip="New boxes where you click"),
    Control("P", "pendulum", "p", spawn_pendulum, group="tools", icon="pendulum", tool=_PENDULUM,
            tip="New pendulums where you click"),
    Control("S", "spring: hold, drag", "s", begin_spring, end_spring, group="tools", icon="spring",
            tool=SPRING, tip="Springs: drag from a body"),
    Control("Del", "remove", "delete", remove, also="backspace", group="tools", icon="remove", tool=REMOVE,
            tip="Remove what you click"),
    Control("N", "more to spawn", "n", lambda _, window: toggle_menu(window, "spawn"), minor=True,
            group="tools", icon="spawn", menu="spawn", tip="More to spawn: stacks, chains, planets, ..."),
    Control("R", "clear all", "r", actions.clear, group="tools", icon="clear",
            tip="Remove everything"),
    Control("Space", "pause", "space", actions.toggle_pause, group="time", icon="pause",
            state=lambda _, window: window.pace.paused, tip="Pause or resume"),
    Control(".", "one step", ".", actions.step, group="time", icon="step", tip="Pause, and make one step"),
    Control("Tab", "slow motion", "tab", actions.toggle_slow_motion, group="time", icon="slow",
            state=lambda _, window: window.pace.slow_motion, tip="Slow motion: a quarter of the speed"),
    Control("[", "half the speed", "[", actions.slower, minor=True, group="time", icon="slower",
            tip="Half the speed"),
    Control("]", "twice the speed", "]", actions.faster, minor=True, group="time", icon="faster",
            tip="Twice the speed"),
    Control("G", "gravity", "g", actions.toggle_gravity, group="laws", icon="gravity",
            state=lambda world, _: _gravity_is(world, "linear") and bool(world.physics.gravity),
            tip="Uniform gravity on or off"),
    Control("O", "planets", "o", actions.toggle_planets, group="laws", icon="planets",
            state=lambda world, _: _gravity_is(world, "planet"),
            tip="Planet mode: all bodies attract each other"),
    Control("V", "arrows", "v", actions.toggle_arrows, group="show", icon="arrows",
            state=lambda _, window: window.overlays.arrows, tip="Velocities, forces, contact normals"),
    Control("T", "trails", "t", actions.toggle_trails, group="show", icon="trails",
            state=lambda world, _: bool(world.table(Trail).handles), tip="Trails behind moving bodies"),
    Control("E", "impulses", "e", actions.toggle_impulses, group="show", icon="impulses",
            state=lambda _, window: window.overlays.impulses, tip="Impulses at contacts, with numbers"),
    Control("I", "figures", "i", actions.toggle_figures, minor=True, group="show", icon="figures",
            state=lambda _, window: window.figures, tip="Figures and costs at the sides"),
    Control("H", "grid", "h", actions.toggle_grid, minor=True, group="show", icon="grid",
            state=lambda _, window: window.grid, tip="The grid"),
    Control("Middle", "pan", group="view", icon="pan", tool=PAN, tip="Move the view by dragging"),
    Control("Wheel", "zoom"),
    Control("+", "zoom in", "=", actions.zoom_in, minor=True, group="view", icon="zoom in",
            click=actions.enlarge, tip="Zoom in"),
    Control("-", "zoom out", "-", actions.zoom_out, minor=True, group="view", icon="zoom out",
            click=actions.reduce, tip="Zoom out"),
    Control("F", "fit", "f", actions.fit, group="view", icon="fit", tip="Fit everything into the window"),
    Control("Home", "first view", "home", actions.go_home, minor=True, group="view", icon="home",
            tip="The view at the start"),
    Control("L", "scenes", "l", lambda _, window: toggle_menu(window, "scenes"), minor=True,
            group="file", icon="scenes", menu="scenes", tip="Choose a scene"),
    Control("Ctrl+S", "save the scene", "ctrl+s", file_actions.save, minor=True, group="file", icon="save",
            tip="Save the scene to a new file"),
    Control("Ctrl+O", "open the last scene saved", "ctrl+o", file_actions.reopen, minor=True, group="file",
            icon="open", tip="Open the scene last saved"),
    Control("F5", "error against run time", "f5", file_actions.study_error, minor=True, group="file",
            icon="plot", state=lambda _, window: window.error_study.running,
            tip="Error against run time of this scene"),
    Control("F12", "screenshot", "f12", file_actions.request_screenshot, minor=True, group="file",
            icon="screenshot", tip="Save a picture of the window"),
    Control("F2", "other colours", "f2", actions.next_theme, minor=True, group="window", icon="theme",
            tip="Colours: dark, high contrast, projector"),
    Control("F1", "all keys", "f1", actions.toggle_help, group="window", icon="keys",
            state=lambda _, window: window.help, tip="All keys"),
    Control("Esc", "quit", "escape", actions.leave, group="window", icon="quit", click=actions.close,
            tip="Quit"),
)  # fmt: skip
"""Everything there is to press, in the order of the hint, the help and the toolbar."""

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
