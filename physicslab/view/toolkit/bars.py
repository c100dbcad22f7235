"""Bars of panels: a label and its value over a length."""

from imgui_bundle import ImVec2, imgui

from physicslab.view.canvas.theme import Colour
from physicslab.view.toolkit.style import packed
from physicslab.view.toolkit.ui import Ui


def bar(
    ui: Ui, label: str, value: str, share: float, colour: Colour, *, zero: float = 0.0, tip: str = ""
) -> None:
    """Write a label and its value over a bar as long as a share (-1 to 1), which begins at ``zero``."""
    ui.row(label, value, tip)
    width, height = imgui.get_content_region_avail().x, round(0.4 * ui.size)
    corner = imgui.get_cursor_screen_pos()
    paper = imgui.get_window_draw_list()
    paper.add_rect_filled(
        corner, ImVec2(corner.x + width, corner.y + height), packed(ui.theme.key), 0.5 * height
    )
    low, high = (min(max(end, 0.0), 1.0) * width for end in sorted((zero, zero + share)))
    if high - low >= 1.0:
        if zero == 0.0:
            high = max(high, height)  # as wide as its ends are round
        paper.add_rect_filled(
            ImVec2(corner.x + low, corner.y), ImVec2(corner.x + high, corner.y + height), packed(colour),
            0.5 * height,
        )  # fmt: skip
    if 0.0 < zero < 1.0:
        zero_line(ui, corner.x + zero * width, corner.y, height)
    imgui.dummy(ImVec2(width, height))


def zero_line(ui: Ui, x: float, top: float, height: float) -> None:
    """Draw where zero is on a bar [px]."""
    beyond = 0.15 * ui.size
    ends = ImVec2(x - 0.5, top - beyond), ImVec2(x + 0.5, top + height + beyond)
    imgui.get_window_draw_list().add_rect_filled(*ends, packed(ui.theme.text))
