"""What is written beside a plot: each line with its value, slopes and areas between two moments."""

from __future__ import annotations

import numpy as np
from imgui_bundle import ImVec2, imgui

from physicslab.components.quantities import QUANTITIES
from physicslab.diagnostics.quantities import why_undefined
from physicslab.view.canvas.drawable_text import drawable
from physicslab.view.canvas.quantities import quantity
from physicslab.view.canvas.theme import Colour
from physicslab.view.canvas.units import product, quotient, written_unit
from physicslab.view.controls import measuring_actions
from physicslab.view.toolkit.style import packed
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.measuring import GraphShown
from physicslab.view.window.plot_data import area_between, slope_between
from physicslab.view.window.record import Key
from physicslab.view.window.window import Window
from physicslab.view.workbench.quantity_menu import unit_of
from physicslab.world import World

__all__ = ["build_moment", "build_readings", "build_spans", "colour_of", "line_name"]

_VALUE = "-0.0000"
"""As wide as most values are: what follows stays in its place while they change."""
_MARK = 1.1
"""Length of the mark in a line's colour, in heights of the text."""


def colour_of(ui: Ui, number: int) -> Colour:
    """Return the colour of a graph's line, by its place from 0."""
    return ui.theme.bodies[number % len(ui.theme.bodies)]


def line_name(graph: GraphShown, key: Key, window: Window) -> str:
    """Return what a line is called: its body too, where lines are of several."""
    alone = len({other[0] for other in graph.keys}) == 1
    return drawable(key[1] if alone else f"{window.measuring.label(key[0])}: {key[1]}")


def build_readings(ui: Ui, world: World, window: Window, graph: GraphShown) -> None:
    """Write every line with its colour, and its value at the moment under the cursor or at that shown."""
    measuring = window.measuring
    time = world.time if measuring.pointed is None else measuring.pointed
    row = measuring.record.nearest(time)
    if not graph.lines:
        ui.faint("Lines: choose what is plotted")
        return
    style = imgui.get_style()
    used, room = 0.0, imgui.get_content_region_avail().x
    for colour, key in _entries(ui, graph):
        name, value = line_name(graph, key, window), _value(world, window, key, row)
        usual = f"{_VALUE} {unit_of(key)}"
        width = (_MARK + 0.4) * ui.size if colour is not None else 0.0
        width += imgui.calc_text_size(f"{name} ").x
        width += max(imgui.calc_text_size(usual).x, imgui.calc_text_size(value).x)
        if used and used + width <= room:
            imgui.same_line(used + style.window_padding.x)
        else:
            used = 0.0
        used += width + 0.8 * ui.size
        _entry(ui, colour, name, value)


def build_moment(ui: Ui, world: World, window: Window, used: float) -> None:
    """Write of which moment the values are, at the right of a row of which so much is used [px]."""
    record, pointed = window.measuring.record, window.measuring.pointed
    row = record.nearest(world.time if pointed is None else pointed)
    if row is None:
        return
    words = f"t {record.times[row]:.3f} s"
    style, room = imgui.get_style(), imgui.get_content_region_avail().x
    width = imgui.calc_text_size(words).x
    if used + style.item_spacing.x + width > room:
        ui.text(words)
        return
    imgui.same_line(room - width + style.window_padding.x)
    imgui.align_text_to_frame_padding()
    ui.text(words)


def _entries(ui: Ui, graph: GraphShown) -> list[tuple[Colour | None, Key]]:
    """Return what is across, and every line with its colour."""
    across: list[tuple[Colour | None, Key]] = [] if graph.across is None else [(None, graph.across)]
    return [*across, *((colour_of(ui, n), line.key) for n, line in enumerate(graph.lines))]


def _entry(ui: Ui, colour: Colour | None, name: str, value: str) -> None:
    if colour is not None:
        corner, height = imgui.get_cursor_screen_pos(), imgui.get_text_line_height()
        low = ImVec2(corner.x, corner.y + 0.5 * height - 0.1 * ui.size)
        high = ImVec2(corner.x + _MARK * ui.size, low.y + 0.2 * ui.size)
        imgui.get_window_draw_list().add_rect_filled(low, high, packed(colour), 0.1 * ui.size)
        imgui.dummy(ImVec2(_MARK * ui.size, height))
        imgui.same_line(0.0, 0.4 * ui.size)
    ui.faint(name, wrapped=False)
    imgui.same_line(0.0, imgui.calc_text_size(" ").x)
    ui.text(value)


def _value(world: World, window: Window, key: Key, row: int | None) -> str:
    """Return a value in words: why there is none, where there is none."""
    value = np.nan if row is None else float(window.measuring.record.values(key)[row])
    why = why_undefined(world, key[1], key[0])
    if np.isnan(value):
        return f"({why})" if why else "not recorded"
    words = quantity(value, unit_of(key))
    return f"{words} (gone)" if why == "gone" else words


def build_spans(ui: Ui, window: Window, graph: GraphShown, *, measure: bool = False) -> float:
    """Write what lies between the cursors A and B, with buttons that go there; return how high that is [px].

    With ``measure`` nothing is drawn.
    """
    lines = _spans(window, graph)
    spacing = imgui.get_style().item_spacing.y
    width = imgui.get_content_region_avail().x
    height = imgui.get_frame_height() + spacing
    for _, words in lines:
        height += imgui.calc_text_size(words, wrap_width=width).y + spacing
    if measure:
        return height
    marks = window.measuring.marks
    for n, (name, time) in enumerate(zip("AB", marks, strict=True)):
        if n:
            imgui.same_line()
        label = f"Go to {name} in graph {graph.number}"
        if ui.button(label, "Pause, and go to this moment", shown=f"Go to {name}", enabled=time is not None):
            assert time is not None
            window.deeds.append(measuring_actions.go_to(time))
    imgui.same_line()
    if ui.button(f"Clear cursors in graph {graph.number}", "Take A and B away", shown="Clear"):
        marks[:] = [None, None]
    for colour, words in lines:
        ui.text(words, colour, wrapped=True)
    return height


def _spans(window: Window, graph: GraphShown) -> list[tuple[Colour | None, str]]:
    """Return in words the moments of the cursors, and for each line its slope and its area between them."""
    measuring = window.measuring
    record, (a, b) = measuring.record, measuring.marks
    first = "  ".join(f"{name} {time:.3f} s" for name, time in zip("AB", (a, b), strict=True) if time is not None)
    if a is None or b is None:
        return [(None, f"{first}   Shift-click sets B" if b is None else f"{first}   a click sets A")]
    rows = record.nearest(a), record.nearest(b)
    if rows[0] is None or rows[1] is None:
        return [(None, first)]
    lines: list[tuple[Colour | None, str]] = [(None, f"{first}   B - A {b - a:.3f} s")]
    across = record.times if graph.across is None else record.values(graph.across)
    unit = "s" if graph.across is None else QUANTITIES[graph.across[1]].unit
    for line in graph.lines:
        values, own = record.values(line.key), QUANTITIES[line.key[1]].unit
        slope = _words(slope_between(across, values, *rows), quotient(own, unit))
        area = _words(area_between(across, values, *rows), product(own, unit))
        lines.append((None, f"{line_name(graph, line.key, window)}: slope {slope}, area {area}"))
    return lines


def _words(value: float, unit: str) -> str:
    return "not defined" if np.isnan(value) else quantity(value, written_unit(unit)).rstrip()
