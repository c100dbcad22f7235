"""All keys and what they do."""

from __future__ import annotations

from collections.abc import Sequence

from imgui_bundle import imgui

from physicslab.view.controls.controls import CONTROLS, Control
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.window import Window

__all__ = ["build_help"]

_MAX_COLUMNS = 4
"""How many columns there may be, if they fit."""
_SHARE = 0.94
"""How much of the window's width they may take."""
_GAP = "   "


def build_help(ui: Ui, window: Window) -> None:
    """Build the window of keys, in columns."""
    lines = [(_keys(control), f"{control.does}{_GAP}") for control in CONTROLS]
    room = _SHARE * window.canvas.size[0]
    columns = next((n for n in range(_MAX_COLUMNS, 1, -1) if _width(lines, n) <= room), 1)
    with ui.floating("Keys and buttons", window.middle, docks=True) as stays:
        rows = -(-len(lines) // columns)
        if imgui.begin_table("keys", 2 * columns, imgui.TableFlags_.sizing_fixed_fit):
            for n in range(rows):
                imgui.table_next_row()
                for keys, does in lines[n::rows]:
                    imgui.table_next_column()
                    ui.text(keys, ui.theme.accent)
                    imgui.table_next_column()
                    ui.text(does)
            imgui.end_table()
        ui.faint("F1 or Esc closes this")
    if not stays[0]:
        window.help = False


def _keys(control: Control) -> str:
    others = [key.capitalize() for key in control.also if key.isalpha()]
    return ", ".join([control.label, *others])


def _width(lines: Sequence[tuple[str, str]], columns: int) -> float:
    """Return how wide a table of so many columns is [px]."""
    rows, style = -(-len(lines) // columns), imgui.get_style()
    width = 2 * style.window_padding.x
    for n in range(columns):
        for words in zip(*lines[n * rows : (n + 1) * rows], strict=True):
            width += max(imgui.calc_text_size(text).x for text in words) + 2 * style.cell_padding.x
    return float(width)
