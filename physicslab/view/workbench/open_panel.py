"""The file that is opened: its name is written, or one of the last few is chosen."""

from __future__ import annotations

from pathlib import Path

from imgui_bundle import imgui

from physicslab.ecs.text import printable
from physicslab.view.controls import file_actions
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.window import Window
from physicslab.world import World

__all__ = ["build_open", "recent_label"]

_WIDTH = 28.0
"""Of the field, in heights of the text."""


def recent_label(number: int, path: Path) -> str:
    """Return the words of a line of the list of files, which are numbered from 1."""
    return f"{number}. {printable(path.name)}"


def build_open(ui: Ui, window: Window) -> None:
    """Build the field, the list and the buttons, in a window of its own."""
    with ui.floating("Open a file", window.middle) as stays:
        ui.faint("A path, or the number of a line below", wrapped=False)
        if imgui.is_window_appearing():
            imgui.set_keyboard_focus_here()
        refused = window.opening_refused
        text, _ = ui.field("File to open", window.opening or "", _WIDTH * ui.size, wrong=bool(refused))
        window.opening = text
        entered = imgui.is_item_focused() and imgui.is_key_pressed(imgui.Key.enter)
        if refused:
            ui.text(refused, ui.theme.error, wrapped=True)
        for number, path in enumerate(window.recent.there, start=1):
            if ui.selectable(recent_label(number, path)):
                window.deeds.append(file_actions.opening(path))
            ui.tip(printable(str(path)))
        if ui.button("Open") or entered:
            window.deeds.append(_opening(text))
        imgui.same_line()
        if ui.button("Do not open") or not stays[0]:
            window.opening = None


def _opening(text: str) -> file_actions.Deed:
    def deed(world: World, window: Window) -> None:
        file_actions.open_named(window, text)

    return deed
