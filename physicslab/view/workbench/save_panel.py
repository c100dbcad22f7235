"""The name under which a scene is saved."""

from __future__ import annotations

from imgui_bundle import imgui

from physicslab.view.controls import file_actions
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.window import Window
from physicslab.world import World

__all__ = ["build_save"]

_WIDTH = 24.0
"""Of the field, in heights of the text."""


def build_save(ui: Ui, window: Window) -> None:
    """Build the field and its buttons, in a window of its own."""
    with ui.floating("Save as", window.middle) as stays:
        ui.faint("A file in the working directory, or a path", wrapped=False)
        if imgui.is_window_appearing():
            imgui.set_keyboard_focus_here()
        refused = bool(window.naming_refused)
        text, _ = ui.field("File name", window.naming or "", _WIDTH * ui.size, wrong=refused)
        window.naming = text
        entered = imgui.is_item_focused() and imgui.is_key_pressed(imgui.Key.enter)
        if window.naming_refused:
            ui.text(window.naming_refused, ui.theme.error, wrapped=True)
        if ui.button("Save") or entered:
            window.deeds.append(_saving(text))
        imgui.same_line()
        if ui.button("Cancel") or not stays[0]:
            window.naming = None


def _saving(text: str) -> file_actions.Deed:
    def deed(world: World, window: Window) -> None:
        file_actions.save_under(world, window, text)

    return deed
