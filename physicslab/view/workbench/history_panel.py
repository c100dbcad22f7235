"""The history: every edit and run, the last one last, and other branches; a click goes there."""

from __future__ import annotations

from imgui_bundle import ImVec2, imgui

from physicslab.view.canvas.drawable_text import shortened
from physicslab.view.controls import actions
from physicslab.view.controls.history_actions import branch_words, switch
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.window import Window
from physicslab.world import World

__all__ = ["build_history"]

_WIDTH, _HEIGHT, _LINE = 17.0, 20.0, 1.5
"""Size of the lists, and height of a line of the lower one, in heights of the text."""
_LETTERS = 34
"""How much of a branch is written in its line; the rest is in its tip."""


def build_history(ui: Ui, window: Window) -> None:
    """Build the list in a window of its own."""
    history = window.edits.history
    entries, done = history.entries, history.position
    left, top, _, _ = window.room()
    width, height = ui.fitted(_WIDTH * ui.size, _HEIGHT * ui.size)
    place = left + 0.5 * width + ui.size, top + 0.5 * height + 4.0 * ui.size
    with ui.floating("History", place, docks=True) as stays:
        if ui.button("Undo", "Undo the last edit or run (Ctrl+Z)", enabled=done > 0):
            window.do_next(actions.undo)
        imgui.same_line()
        if ui.button("Redo", "Redo what was undone (Ctrl+Y)", enabled=done < len(entries)):
            window.do_next(actions.redo)
        below = _LINE * (len(history.branches) + 2) * ui.size if history.branches else 0.0
        room = ui.extent(width, height)
        if imgui.begin_child("entries", ImVec2(room.x, max(room.y - below, 3.0 * ui.size))):
            if ui.selectable("As it was opened", on=done == 0, faint=False):
                window.do_next(_go_to, 0)
            for n, entry in enumerate(entries, start=1):
                if ui.selectable(f"{n}. {entry.words}", on=n == done, faint=not entry.done):
                    window.do_next(_go_to, n)
        imgui.end_child()
        _build_branches(ui, window)
    if not stays[0]:
        window.lists_history = False


def _build_branches(ui: Ui, window: Window) -> None:
    """Build a line for each branch: when it leaves what is listed above, and what was done in it."""
    history = window.edits.history
    if not history.branches:
        return
    ui.rule()
    ui.heading("Other branches")
    ui.tip("Edits and runs that a change in the past replaced; Ctrl+B switches from one to the next")
    for n, branch in enumerate(history.branches, start=1):
        words = branch_words(branch, history.start)
        if ui.selectable(f"{n}. {shortened(words, _LETTERS)}"):
            window.do_next(switch, branch)
        ui.tip(words)


def _go_to(world: World, window: Window, entry: int) -> None:
    """Take back or put back edits and runs until so many are done."""
    history = window.edits.history
    window.pause_for_history(world)
    while history.position > entry and history.undo() is not None:
        pass
    while history.position < entry and history.redo() is not None:
        pass
