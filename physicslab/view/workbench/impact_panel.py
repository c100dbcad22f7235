"""The table of impacts: sorted by a click on a heading; a click on a row opens the microscope there."""

import math
from functools import partial
from typing import Any

from imgui_bundle import ImVec2, imgui

from physicslab.diagnostics.impact_table import impact_rows
from physicslab.view.canvas.quantities import quantity, without_rounding
from physicslab.view.controls import impact_actions
from physicslab.view.controls.saving import save_table
from physicslab.view.toolkit.style import packed
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.impacts import COLUMNS
from physicslab.view.window.window import Window
from physicslab.view.workbench.collision_words import body_name
from physicslab.world import World

HEADS = ("Time", "A", "B", "Approach", "Normal", "Friction", "Contact", "μ", "e", "e found", "Energy lost")
_WIDTHS = (4.6, 5.2, 5.2, 4.8, 5.0, 5.0, 3.6, 2.4, 2.2, 3.8, 5.0)
"""Widths of the columns, in heights of the text."""
_TIPS = (
    "When it was", "The first body", "The second body: impulses are those on it",
    "How fast they approached, along the normal", "Impulse along the normal: it keeps them apart",
    "Impulse along the surface", "Whether friction stopped the sliding",
    "Friction of the pair: the root of both multiplied", "Restitution of the pair: the smaller one",
    "Speed along the normal after the impact, as a share of the approach", "Kinetic energy lost",
)  # fmt: skip
_HEIGHT = 11.0
"""Height of the table, in heights of the text."""
_SLACK = 1.5
_LEAST = 24.0
"""Width that it has beside others at least, in heights of the text."""


def build_impacts(ui: Ui, world: World, window: Window) -> None:
    """Build the table in a window of its own."""
    left, top, width, _ = window.framing.room()
    wide = sum(_widths(ui)) + len(_WIDTHS) * 2.0 * imgui.get_style().cell_padding.x + _SLACK * ui.size
    wide = min(wide, max(width, 0.6 * window.canvas.size[0]) - 2.0 * ui.size)
    place = left + 0.5 * width, top + 0.5 * (_HEIGHT + 7.5) * ui.size
    ui.stand_beside("Impacts", "below", 0.36, _LEAST)
    with ui.floating("Impacts", place, window.closing_of("impacts.shown"), docks=True):
        _build_head(ui, world, window)
        rows = window.impacts.order(window.selection.entities)
        room = ui.extent(wide, _HEIGHT * ui.size)
        size = ImVec2(max(room.x, wide) if not imgui.is_window_docked() else room.x, room.y)
        if len(rows):
            _build_table(ui, world, window, rows, size)
        else:
            with ui.wrapping(size.x):
                ui.faint(_nothing(window), wrapped=False)
            imgui.dummy(ImVec2(size.x, max(size.y - 3.0 * ui.size, 1.0)))


def _widths(ui: Ui) -> list[float]:
    """Return how wide the columns are [px]: their heads are whole in any language."""
    return [max(width * ui.size, ui.width(head)) for head, width in zip(HEADS, _WIDTHS, strict=True)]


def _nothing(window: Window) -> str:
    """Return why there are no rows."""
    impacts = window.impacts
    if len(impacts.records):
        return "None of the listed impacts is of the selection."
    return "There was no impact so far: run (Space)."


def _build_head(ui: Ui, world: World, window: Window) -> None:
    """Build how many there are, and what can be done with them."""
    impacts, count = window.impacts, len(window.impacts.records)
    if ui.checkbox("Only the selection", impacts.only_selected, "Impacts of the selected bodies alone"):
        impacts.only_selected = not impacts.only_selected
    ui.same_line_if_room("Pause at the next")
    waits = window.microscope.waits_for is not None
    tip = "Run until the next impact of the selection, or of any body, and pause there (Shift+Z)"
    ui.button("Pause at the next", tip, impact_actions.pause_at_next, on=waits)
    ui.same_line_if_room("CSV")
    table, tip = partial(impact_rows, world, window.impacts.records), "Write all of them to a file"
    ui.button("CSV of impacts", tip, save_table, "impacts", table, shown="CSV", enabled=count > 0)
    words = ui.language.say_count("{n} impact", "{n} impacts", count)
    ui.same_line_if_room(words)
    ui.faint(words, wrapped=False)


def _build_table(ui: Ui, world: World, window: Window, rows: Any, size: ImVec2) -> None:
    """Build the headings, and the rows that are in sight."""
    flags = imgui.TableFlags_
    style = flags.scroll_y | flags.scroll_x | flags.row_bg | flags.sizing_fixed_fit | flags.no_saved_settings
    if not imgui.begin_table("impacts", len(HEADS), style, size):
        return
    imgui.table_setup_scroll_freeze(0, 1)
    for head, width in zip(HEADS, _widths(ui), strict=True):
        imgui.table_setup_column(head, imgui.TableColumnFlags_.width_fixed, width)
    imgui.table_next_row(imgui.TableRowFlags_.headers)
    for n in range(len(HEADS)):
        imgui.table_next_column()
        _build_heading(ui, window, n)
    clipper = imgui.ListClipper()
    clipper.begin(len(rows))
    while clipper.step():
        for n in range(clipper.display_start, clipper.display_end):
            _build_row(ui, world, window, n, window.impacts.records[rows[n]])
    clipper.end()
    imgui.end_table()


def _build_heading(ui: Ui, window: Window, n: int) -> None:
    """Build a heading; a click sorts by it, and a second one the other way round."""
    impacts, name = window.impacts, COLUMNS[n]
    mark = "" if impacts.sorted_by != name else "(falling)" if impacts.falling else "(rising)"
    head = ui.said(HEADS[n])
    ui.words.append(f"{head} {ui.said(mark)}".strip())
    clicked, _ = imgui.selectable(f"{head}###{HEADS[n]} heading", impacts.sorted_by == name)
    ui.note(f"Sort by {HEADS[n].lower()}")
    if impacts.sorted_by == name:
        _draw_arrow(ui, upwards=not impacts.falling)
    ui.tip(f"{_TIPS[n]}. Click to sort")
    if clicked:
        impacts.falling = not impacts.falling if impacts.sorted_by == name else n > 2
        impacts.sorted_by = name


def _draw_arrow(ui: Ui, *, upwards: bool) -> None:
    """Draw a triangle at the right of the heading that was built last."""
    low, high, half = imgui.get_item_rect_min(), imgui.get_item_rect_max(), 0.22 * ui.size
    x, y = high.x - 2.0 * half, 0.5 * (low.y + high.y)
    up = half if upwards else -half
    corners = ImVec2(x - half, y + up), ImVec2(x + half, y + up), ImVec2(x, y - up)
    imgui.get_window_draw_list().add_triangle_filled(*corners, packed(ui.theme.accent))


def _build_row(ui: Ui, world: World, window: Window, n: int, record: Any) -> None:
    """Build a row; a click opens the microscope."""
    wall = int(record["wall"])
    a, b = (body_name(world, int(record[side]), wall) for side in ("entity_a", "entity_b"))
    sticks, found = record["sticks"], float(record["e_found"])
    speed, normal = float(record["approach_speed"]), float(record["normal_impulse"])
    speed = 0.0 if math.isnan(found) else speed  # of a resting pair that takes part in an impact
    cells = (
        f"{record['time']:.4f} s", a, b, quantity(speed, "m/s"), quantity(normal, "N s"),
        quantity(without_rounding(float(record["tangent_impulse"]), normal), "N s"),
        "sticks" if sticks else "slides",
        f"{record['friction']:.4g}", f"{record['restitution']:.4g}",
        "-" if math.isnan(found) else f"{round(found, 4) + 0.0:.4f}",
        quantity(without_rounding(float(record["energy_lost"]), normal * speed), "J"),
    )  # fmt: skip
    shown = window.microscope.record
    is_shown = shown is not None and all(shown[k] == record[k] for k in ("time", "entity_a", "entity_b"))
    imgui.table_next_row()
    imgui.table_next_column()
    clicked, _ = imgui.selectable(f"##row {n}", is_shown, imgui.SelectableFlags_.span_all_columns)
    ui.note(f"Impact {n + 1}")
    imgui.same_line(0.0, 0.0)
    ui.text(cells[0])
    for words in cells[1:]:
        imgui.table_next_column()
        ui.text(words)
    if clicked:
        window.do_next(impact_actions.close_up, record.copy())
