"""All keys and what they do."""

from __future__ import annotations

from imgui_bundle import imgui

from physicslab.view.controls.controls import CONTROLS
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.window import Window

__all__ = ["build_help"]

_COLUMNS = 3


def build_help(ui: Ui, window: Window) -> None:
    """Build the window of keys, in columns."""
    with ui.floating("Keys and buttons", window.middle) as stays:
        rows = -(-len(CONTROLS) // _COLUMNS)
        if imgui.begin_table("keys", 2 * _COLUMNS, imgui.TableFlags_.sizing_fixed_fit):
            for n in range(rows):
                imgui.table_next_row()
                for control in CONTROLS[n::rows]:
                    imgui.table_next_column()
                    keys = f"{control.label}, {control.also.capitalize()}" if control.also else control.label
                    ui.text(keys, ui.theme.accent)
                    imgui.table_next_column()
                    ui.text(f"{control.does}   ")
            imgui.end_table()
        ui.faint("F1 or Esc closes this")
    if not stays[0]:
        window.help = False
