"""The controls in one table: what keys do, and what the menus and the help show."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from operator import attrgetter
from typing import Literal

from physicslab.components import Strobe, Trail
from physicslab.view.controls import (
    actions,
    copies,
    dashboard_actions,
    file_actions,
    impact_actions,
    lesson_actions,
    making,
    measuring,
    saving,
    share_actions,
    tools,
)
from physicslab.view.controls.actions import has_gravity
from physicslab.view.controls.context import open_context
from physicslab.view.controls.drawing import click
from physicslab.view.controls.keyboard import ARROWS, enter, open_menu, walk
from physicslab.view.controls.spawning import PENDULUM
from physicslab.view.controls.tool import Tool
from physicslab.view.window.desk import SHOWN_BY
from physicslab.view.window.window import OPENED, Action, Window
from physicslab.world import World

type State = Callable[[World, Window], bool]


_LESSON = "lesson"
"""The group of what is done to an open lesson."""
_OPEN_GROUPS = ("time", "view", "window", "help", "quit", _LESSON)
"""The controls that lessons leave open: they change nothing of what is measured."""
_OPEN_KEYS = ("return", "n", "delete", "ctrl+z", "ctrl+y", "f8", "f12", "ctrl+o", "shift+s")
"""Others: edits of what the lesson has shut are refused where they are made."""
_OPEN_PANELS = ("scenes.shows_gallery", "search")
_WORDS = {path: word for word, path in SHOWN_BY.items()}


@dataclass(frozen=True, slots=True)
class Control:
    """One thing the user can do.

    Attributes
    ----------
    label : str
        The key, as on its cap.
    does : str
        Its effect, in a word or two.
    key : str
        The key's name in SDL, after ``"ctrl+"`` where that is held too; empty for the mouse.
    action, release : callable, optional
        Called when the key goes down, and when it goes up.
    also : tuple of str
        Other keys that do the same.
    group, tip : str
        In the menus: what it stands together with, and the words of its tip.
    tool : Tool, optional
        The tool of the palette that does the same.
    click : callable, optional
        Called by its line in a menu, where that differs from the key.
    state : callable, optional
        Returns whether what it turns on is on.
    panel : str
        The panel that it opens and closes, one of ``OPENED``; empty if none.
    shows : str
        The thing that it shows, by the word of scene files; empty if not kept in them.
    """

    label: str
    does: str
    key: str = ""
    action: Action | None = None
    release: Action | None = None
    also: tuple[str, ...] = ()
    group: str = ""
    tip: str = ""
    tool: Tool | None = None
    click: Action | None = None
    state: State | None = None
    panel: str = ""
    shows: str = ""

    @property
    def title(self) -> str:
        """Its words in a menu."""
        return self.does[:1].upper() + self.does[1:]

    def on(self, world: World, window: Window) -> bool:
        """Whether its line in a menu is marked."""
        return self.state is not None and self.state(world, window)

    def is_open(self, window: Window) -> bool:
        """Whether it can be used now: a lesson shuts what it does not name; without one, none is left."""
        lesson = window.lesson
        if lesson is None:
            return self.group != _LESSON
        if self.group in _OPEN_GROUPS or self.panel in _OPEN_PANELS or self.key in _OPEN_KEYS:
            return True
        if self.tool is not None and self.group == "measure":
            return lesson.opens_tool(self.tool.name)
        return bool(self.shows) and lesson.shows(self.shows)

    def pressed(self, world: World, window: Window) -> None:
        """Do what its line in a menu does."""
        self.done(self.click or self.action, world, window)

    def done(self, action: Action | None, world: World, window: Window) -> None:
        """Do an action of it, unless a lesson has it shut, which is said then."""
        if not self.is_open(window):
            window.notify("The lesson has this shut; Esc leaves the lesson")
        elif action is not None:
            action(world, window)


def _switch(
    label: str, does: str, key: str, flag: str, group: str, tip: str, said: tuple[str, str] = ("", "")
) -> Control:
    """Return what turns a flag of the window on and off, such as ``"pace.slow_motion"``.

    Where nothing in the picture shows it, ``said`` has a notice for off and one for on.
    """
    state = attrgetter(flag)

    def turn(world: World, window: Window) -> None:
        window.put(flag, not state(window))
        if words := said[bool(state(window))]:
            window.notify(words)

    return Control(
        label, does, key, turn, group=group, tip=tip,
        state=lambda _, window: bool(state(window)), panel=flag if flag in OPENED else "",
        shows=_WORDS.get(flag, ""),
    )  # fmt: skip


def _overlay(label: str, name: Literal["arrows", "impulses", "momenta"], tip: str) -> Control:
    """Return what shows or hides an overlay, whose scale is chosen as it is shown."""
    return Control(
        label, name, label.lower(), lambda world, window: window.overlays.toggle(name, world, window.camera),
        group="show", tip=tip, shows=name, state=lambda _, window: bool(getattr(window.overlays, name)),
    )  # fmt: skip


def _instrument(label: str, does: str, tool: Tool, tip: str) -> Control:
    """Return what takes the tool of an instrument in hand, or measures with it."""
    action = measuring.key_action(tool, actions.choose_tool)
    return Control(label, does, label.lower(), action, group="measure", tip=tip, tool=tool)


def _gravity_is(world: World, mode: str) -> bool:
    return has_gravity(world) and world.physics.gravity_mode == mode


CONTROLS: tuple[Control, ...] = (
    Control("Left", "drag, throw, new circle", tool=tools.HAND,
            tip="Drag and throw bodies, click or drag for a new circle"),
    Control("Right", "new box", tool=tools.DRAWING["box"], tip="New boxes: click, or drag"),
    Control("P", "pendulum", "p", lambda world, window: click(world, window, PENDULUM),
            tool=tools.DRAWING["pendulum"], tip="New pendulums: click, or drag from pin to bob"),
    Control("S", "spring: hold, drag", "s", tools.begin_by_key, tools.end_by_key,
            tool=tools.DRAWING["spring"], tip="Springs: drag from a body"),
    Control("Digits", "tools: see Draw", also=("shift+digits",), tip="The tools that draw: see the menu"),
    Control("Del", "remove", "delete", tools.remove_selected, also=("backspace",), group="edit",
            tip="Remove the selection, or the body under the cursor"),
    Control("Ctrl+D", "duplicate", "ctrl+d", copies.duplicate_selected, group="edit",
            tip="A copy beside each selected body"),
    Control("Ctrl+Shift+D", "copies ...", "ctrl+shift+d", copies.begin_copies, group="edit", panel="copying",
            tip="Copies in a row, in a grid or around a circle"),
    Control("Menu", "menu of a thing", "menu", open_context, also=("shift+f10",),
            tip="What can be done with what is under the cursor; as the right button does, held"),
    Control("Ctrl+Z", "undo", "ctrl+z", actions.undo, group="edit",
            tip="Undo one thing: the last edit, the last throw, or the run since Play"),
    Control("Ctrl+Y", "redo", "ctrl+y", actions.redo, also=("ctrl+shift+z",), group="edit",
            tip="Redo what was undone"),
    _switch("U", "history", "u", "lists_history", "edit", "The list of all edits, runs and branches"),
    Control("Ctrl+B", "another branch", "ctrl+b", actions.next_branch, group="edit",
            tip="Switch to the other branch"),
    Control("Ctrl+C", "copy", "ctrl+c", copies.copy_selected, group="edit",
            tip="Copy the selection"),
    Control("Ctrl+V", "paste", "ctrl+v", copies.paste, group="edit",
            tip="Paste the copy at the cursor"),
    Control("Ctrl+A", "select all", "ctrl+a", actions.select_all, group="edit", tip="Select all bodies"),
    Control("N", "next body", "n", actions.select_next, group="edit", tip="Select the next body"),
    Control("Arrows", "move the selection", "left", ARROWS["left"], group="edit",
            tip="Move the selection by a pixel; without one, the cursor"),
    Control("Enter", "edit, or click", "return", enter, also=("enter",), group="edit",
            tip="Edit the numbers of the selection; without one, click with the tool at the cursor"),
    Control("Shift+Arrows", "turn the selection", "shift+left", ARROWS["shift+left"],
            group="edit", tip="Turn the selection by a degree; by 15 degrees if angles snap"),
    Control("Q", "snap", "q", actions.toggle_snapping, group="edit",
            state=lambda _, window: window.snapping.on,
            tip="Places and sizes snap to the grid and to other bodies, angles to 15 degrees; also while "
                "Alt or Ctrl is held"),
    Control("R", "clear all", "r", actions.clear, group="edit", tip="Remove everything"),
    Control("Space", "pause", "space", actions.toggle_pause, group="time",
            state=lambda _, window: window.pace.paused, tip="Pause or resume"),
    Control(".", "one step", ".", actions.step_once, also=(",", "[.]"), group="time",
            tip="Pause, and make one step"),
    Control("B", "one step back", "b", actions.step_back, group="time", tip="Pause, and go back by one step"),
    Control("Ctrl+R", "start again", "ctrl+r", file_actions.restart, group="time",
            tip="Open this scene again, as at its start"),
    _switch("Tab", "slow motion", "tab", "pace.slow_motion", "time", "Slow motion: a quarter of the speed"),
    Control("[", "half the speed", "[", lambda _, window: window.pace.choose(0.5), also=("page down",),
            group="time", tip="Half the speed"),
    Control("]", "twice the speed", "]", lambda _, window: window.pace.choose(2.0), also=("page up",),
            group="time", tip="Twice the speed"),
    Control("G", "gravity", "g", actions.toggle_gravity, group="laws",
            state=lambda world, _: _gravity_is(world, "linear") and bool(world.physics.gravity),
            tip="Uniform gravity on or off"),
    Control("O", "planets", "o", actions.toggle_planets, group="laws",
            state=lambda world, _: _gravity_is(world, "planet"),
            tip="Planet mode: all bodies attract each other"),
    _overlay("V", "arrows", "Velocities, net forces, contact normals"),
    Control("T", "trails", "t", lambda world, window: window.trails.toggle(world), group="show",
            state=lambda world, _: bool(world.table(Trail).handles), tip="Trails behind moving bodies"),
    _overlay("E", "impulses", "Impulses at contacts, with numbers"),
    _instrument("D", "ruler", measuring.RULER, "A length: drag; or between two selected bodies"),
    _instrument("Y", "angle", measuring.PROTRACTOR,
                "An angle: drag one arm from the vertex, then click the end of the other"),
    _instrument("J", "gate", measuring.GATE, "A light gate: notes when bodies cross it"),
    _instrument("W", "note", measuring.NOTE, "A text at a point of the world"),
    Control("C", "stopwatch", "c", measuring.toggle_stopwatch, group="measure",
            state=lambda _, window: window.shows_stopwatch, panel="shows_stopwatch", shows="stopwatch",
            tip="The times between crossings of gates"),
    Control("X", "strobe of all that moves", "x", measuring.toggle_strobes, group="measure",
            state=lambda world, _: bool(world.table(Strobe).handles),
            tip="Pictures of all moving bodies, ten a second"),
    _switch("Z", "impacts", "z", "impacts.shown", "measure",
            "A table of all impacts; a click on a row, or on a spark, opens the collision microscope"),
    Control("Shift+Z", "pause at the next impact", "shift+z", impact_actions.pause_at_next, group="measure",
            state=lambda _, window: window.microscope.waits_for is not None,
            tip="Pause at the next impact of the selection, or of any body, and open the microscope"),
    Control("Shift+Tab", "slowly through the impact", "shift+tab", impact_actions.run_slowly, group="measure",
            state=lambda _, window: window.microscope.slow is not None,
            tip="Go to shortly before the impact in the microscope, and run slowly through it"),
    Control("A", "keep scales", "a", actions.toggle_scales, group="show",
            state=lambda _, window: window.overlays.keeps_scales,
            tip="Arrows keep their scale, so that two pictures can be compared"),
    Control("M", "graph", "m", dashboard_actions.plot_selected, group="measure",
            tip="A graph against time: of the selection, of the body at the cursor, or of the energies"),
    Control("Shift+M", "phase plot", "shift+m", dashboard_actions.plot_phase, group="measure",
            tip="The velocity of the selected body against its position"),
    Control("Ctrl+M", "meter", "ctrl+m", dashboard_actions.add_meter, group="measure",
            tip="A number in large figures: the speed of the selected body, or the total energy"),
    Control("Ctrl+Shift+M", "slider", "ctrl+shift+m", dashboard_actions.add_slider, group="measure",
            tip="Change a number by sliding: of the selection, or gravity"),
    _switch("I", "panel at the right", "i", "figures", "show", "The selection, or the world, in figures"),
    _switch("H", "grid", "h", "grid", "show", "The grid"),
    _overlay("Shift+V", "momenta",
             "The momentum of each body as an arrow; with the centre of mass, of all together"),
    _switch("Shift+C", "centre of mass", "shift+c", "overlays.centres", "show",
            "The centre of mass of all that moves, and of the selected bodies"),
    _switch("Shift+X", "parts along x and y", "shift+x", "overlays.parts", "show",
            "The parts of velocities and momenta along x and y"),
    _switch("Shift+S", "sound", "shift+s", "sounds.on", "show",
            "The sound of impacts: deep of what is large, loud by the impulse",
            ("Sound is off", "Sound is on")),
    _switch("Shift+F2", "reduced motion", "shift+f2", "reduced_motion", "window",
            "Nothing moves in the window but what moves in the world",
            ("Reduced motion is off", "Reduced motion is on")),
    Control("Middle", "pan", tool=tools.PAN, tip="Move the view by dragging"),
    Control("Wheel", "zoom"),
    Control("+", "zoom in", "=", actions.zoom_by_key(1), also=("+", "[+]"), group="view",
            click=actions.zoom_by_button(1), tip="Zoom in"),
    Control("-", "zoom out", "-", actions.zoom_by_key(-1), also=("[-]",), group="view",
            click=actions.zoom_by_button(-1), tip="Zoom out"),
    Control("F", "fit", "f", actions.fit, group="view",
            tip="Fit everything into the window"),
    Control("Home", "first view", "home", actions.first_view, group="view",
            tip="The view at the start"),
    Control("Shift+L", "leave the lesson", "shift+l", lesson_actions.leave_lesson, group=_LESSON,
            tip="Back to what was shown before; answers are kept in a file"),
    Control("Ctrl+L", "make a lesson", "ctrl+l", making.toggle_making, group="teach", panel="making.choosing",
            state=lambda _, window: window.making.choosing,
            tip="A lesson of this scene: what is predicted, measured and explained"),
    _switch("L", "scenes", "l", "scenes.shows_gallery", "file", "Choose a scene by its picture"),
    Control("Ctrl+N", "new scene", "ctrl+n", saving.begin_new, group="file",
            tip="An empty scene with a floor; Ctrl+Z brings unsaved work back"),
    Control("Ctrl+S", "save", "ctrl+s", saving.save, group="file",
            tip="Save the scene to its file; the first time under a name that you give it"),
    Control("Ctrl+Shift+S", "save a copy", "ctrl+shift+s", saving.begin_copy, group="file",
            tip="Save the scene to another file, and stay with this one"),
    Control("Ctrl+O", "open a file", "ctrl+o", file_actions.begin_open, group="file",
            state=lambda _, window: window.scenes.opening is not None,
            tip="Open a file: from a folder, by its name, or one of the last few"),
    Control("Ctrl+Shift+R", "save what was done", "ctrl+shift+r", actions.save_recording,
            group="file", tip="Save all edits and runs to a file that physicslab replay plays"),
    Control("F12", "screenshot", "f12", file_actions.request_screenshot, group="file",
            tip="Save a picture of the window"),
    Control("F9", "film", "f9", file_actions.toggle_film, group="file",
            state=lambda _, window: window.filming.running,
            tip="A film of the run so far, or of the next: GIF or MP4"),
    Control("F8", "share as a page", "f8", share_actions.toggle_sharing, group="file",
            panel="sharing.choosing", state=lambda _, window: window.sharing.running,
            tip="One file that plays the run in any browser; with sliders, if you like"),
    Control("F5", "error against run time", "f5", file_actions.study_error, group="laws",
            state=lambda _, window: window.error_study.running,
            tip="Run this scene by every method, and plot the error and the cost of each"),
    Control("Ctrl++", "larger text", "ctrl+=", lambda _, window: actions.scale_text(window, 1),
            also=("ctrl++", "ctrl+[+]"), group="window", tip="All text larger"),
    Control("Ctrl+-", "smaller text", "ctrl+-", lambda _, window: actions.scale_text(window, -1),
            also=("ctrl+[-]",), group="window", tip="All text smaller"),
    Control("F2", "other colours", "f2", actions.next_theme, group="window",
            tip="Colours: dark, light, high contrast, projector"),
    Control("F6", "next panel", "f6", walk, group="window",
            tip="Go through the buttons and fields of the next panel with Tab and arrows; Esc goes back"),
    Control("F10", "menus", "f10", open_menu, group="window",
            tip="Open the menus: arrows, Enter, Esc. So does Alt alone"),
    Control("F7", "reset layout", "f7", actions.reset_layout, group="window",
            tip="Reset the layout of windows"),
    Control("Ctrl+K", "search", "ctrl+k", actions.toggle_search, group="help", panel="search",
            tip="Find a command, a tool, a scene or a quantity by a few letters"),
    _switch("Shift+F1", "first steps", "shift+f1", "shows_cards", "help", "The cards of the first minute"),
    Control("Ctrl+F1", "tour", "ctrl+f1", actions.toggle_tour, group="help", panel="tour",
            state=lambda _, window: window.tour is not None,
            tip="Eight acts, each shown until you have done it"),
    _switch("F3", "scene in words", "f3", "shows_words", "help",
            "The scene in words, to be read out or copied: what is there, where, how it moves, its energies"),
    _switch("F1", "all keys", "f1", "help", "help", "All keys"),
    Control("Esc", "quit", "escape", actions.leave, also=("ctrl+q",), group="quit",
            tip="Quit; Ctrl+Q does so whatever is open",
            click=actions.quit_window),
)  # fmt: skip
"""Everything there is to press, in the order of the help and the menus."""

KEYS: dict[str, Action] = {
    key: partial(control.done, control.action)
    for control in CONTROLS
    for key in (control.key, *control.also)
    if key and control.action is not None
}
"""The action of each key when it is pressed, by its name in SDL."""
KEYS |= ARROWS | {"ctrl+q": actions.quit_window}
KEYS |= {key: partial(actions.choose_tool, tool=tools.TOOLS[name]) for key, name in tools.DIGITS.items()}

RELEASES: dict[str, Action] = {
    control.key: control.release for control in CONTROLS if control.release is not None
}
"""The action of each key when it is released."""


def reaches_world(keys: tuple[str, ...], window: Window) -> bool:
    """Whether a key that goes to no widget is for the world, and not for a window.

    A panel that lies over the world leaves it Esc, the keys F1 to F12, text sizes, files with Ctrl held, undo
    and redo, and its own key; a window beside it leaves it every key.

    Parameters
    ----------
    keys : tuple of str
        Its name in SDL, after ``"ctrl+"`` and ``"shift+"`` where these are held, and what else it counts as.
    """
    name = keys[0].rpartition("+")[2]
    if not window.in_front or (name[:1] == "f" and name[1:].isdigit()):
        return True
    control = next((one for key in keys for one in CONTROLS if key in (one.key, *one.also)), None)
    if control is not None and (
        control.group in ("quit", "window")
        or (control.group == "file" and "ctrl+" in keys[0])
        or control.action in (actions.undo, actions.redo)
    ):
        return True
    return control is not None and control.panel == window.in_front
