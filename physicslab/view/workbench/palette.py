"""The tools at the left: what the mouse does in the world."""

from imgui_bundle import ImVec2, imgui

from physicslab.view.canvas.canvas import Rect
from physicslab.view.controls import actions
from physicslab.view.controls.tool import ICONS, Tool
from physicslab.view.controls.tools import MORE_TOOLS, PALETTE
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.window import Window

_LOWEST = 1.1
"""Height of a button at least, in heights of the text."""
_YIELDING = ("protractor", "note", "chain", "gate", "block", "ruler")
"""Tools that are not in sight where there is little room, the first ones first."""


def build_palette(ui: Ui, rect: Rect, window: Window) -> None:
    """Build a button for each tool, with its icon and its name; the tool in hand is marked."""
    with ui.panel("palette", rect, padded=False):
        imgui.push_style_var(imgui.StyleVar_.button_text_align, ImVec2(0.0, 0.5))
        room, gap = imgui.get_content_region_avail(), imgui.get_style().item_spacing.y
        least = _LOWEST * ui.size
        shown = _shown(int((room.y + gap) / (least + gap)) - 1)
        buttons = len(shown) + 1
        height = min(1.9 * ui.size, max((room.y - (buttons - 1) * gap) // buttons, least))
        behind = [tool for tool in (*PALETTE, *MORE_TOOLS) if tool not in shown]
        size = room.x, height
        for tool in shown:
            ui.button(
                tool.title, tool.usage, actions.choose_tool, tool, shown=_words(tool),
                on=window.tool == tool.name, size=size,
            )  # fmt: skip
        hidden = next((tool for tool in behind if tool.name == window.tool), None)
        words = f"{ICONS['more']}  More" if hidden is None else _words(hidden)
        tip = "More to put into the world"
        with ui.list("More", tip, shown=words, on=hidden is not None, size=size) as is_open:
            for tool in behind if is_open else ():
                ui.item(tool.title, actions.choose_tool, tool, on=window.tool == tool.name, tip=tool.usage)
        imgui.pop_style_var()


def _shown(room: int) -> list[Tool]:
    """Return the tools for which there is room in sight; the others are behind one more button."""
    out_of_sight = _YIELDING[: max(len(PALETTE) - room, 0)]
    return [tool for tool in PALETTE if tool.name not in out_of_sight]


def _words(tool: Tool) -> str:
    return f"{ICONS[tool.name]}  {tool.title}"
