"""What was done: every edit and run, the last one last; a click goes back to it."""

from __future__ import annotations

from collections.abc import Callable

from imgui_bundle import imgui

from physicslab.view.controls import actions
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.window import Window
from physicslab.world import World

__all__ = ["build_history"]

_WIDTH, _HEIGHT = 17.0, 20.0
"""Of the list, in heights of the text."""


def build_history(ui: Ui, window: Window) -> None:
    """Build the list in a window of its own."""
    history = window.edits.history
    entries, done = history.entries, history.position
    left, top, _, _ = window.room()
    width, height = ui.fitted(_WIDTH * ui.size, _HEIGHT * ui.size)
    place = left + 0.5 * width + ui.size, top + 0.5 * height + 4.0 * ui.size
    with ui.floating("History", place, docks=True) as stays:
        if ui.button("Undo", "Take back the last edit or run (Ctrl+Z)", enabled=done > 0):
            window.deeds.append(actions.undo)
        imgui.same_line()
        if ui.button("Redo", "Put back what was taken back (Ctrl+Y)", enabled=done < len(entries)):
            window.deeds.append(actions.redo)
        if imgui.begin_child("entries", ui.extent(width, height)):
            if ui.selectable("As it was opened", on=done == 0, faint=False):
                window.deeds.append(_going(0))
            for n, entry in enumerate(entries, start=1):
                if ui.selectable(f"{n}. {entry.words}", on=n == done, faint=not entry.done):
                    window.deeds.append(_going(n))
        imgui.end_child()
    if not stays[0]:
        window.lists_history = False


def _going(entry: int) -> Callable[[World, Window], None]:
    """Return what takes back or puts back edits and runs until so many are done."""

    def deed(world: World, window: Window) -> None:
        history = window.edits.history
        window.hand.drop(world)
        window.pace.paused = True
        while history.position > entry and history.undo() is not None:
            pass
        while history.position < entry and history.redo() is not None:
            pass

    return deed
