"""Meters: a number in large figures, in a corner of the window."""

from __future__ import annotations

import math

from imgui_bundle import imgui

from physicslab.components import Meter
from physicslab.components.meter import CORNERS
from physicslab.diagnostics.quantities import Reading, why_undefined
from physicslab.diagnostics.scales import scales_of
from physicslab.view.canvas.canvas import Rect
from physicslab.view.canvas.quantities import quantity, without_rounding
from physicslab.view.controls import dashboard_actions
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.dashboard import MeterShown
from physicslab.view.window.record import Key
from physicslab.view.window.window import Window
from physicslab.view.workbench.panel_places import Small
from physicslab.view.workbench.quantity_menu import build_quantities, named_key, scale_of, unit_of
from physicslab.view.workbench.small_panel import build_corners, build_title, size_of
from physicslab.world import World

__all__ = ["MeterPanels"]

_LARGE = 1.8
"""Height of the figures, in heights of the text."""
_WIDEST = "-0.0000"
"""As wide as most numbers are."""


class MeterPanels:
    """The panels of meters; each is as wide as the longest number that it has shown."""

    def __init__(self) -> None:
        self._figures: dict[int, str] = {}

    def sizes(self, ui: Ui, world: World, window: Window) -> list[Small]:
        """Return how large each meter is."""
        found, reading = [], Reading(world)
        scales = scales_of(world)
        shown = {meter.entity: _figures_of(reading, meter.key, scales) for meter in window.dashboard.meters}
        known = {entity: self._figures.get(entity, _WIDEST) for entity in shown}
        self._figures = {entity: max(known[entity], shown[entity], key=len) for entity in shown}
        for meter in window.dashboard.meters:
            imgui.push_font(ui.fonts.bold, _LARGE * ui.size)
            number = imgui.calc_text_size(self._figures[meter.entity]).x
            imgui.pop_font()
            number += imgui.get_style().item_spacing.x + imgui.calc_text_size(unit_of(meter.key)).x
            size = size_of(ui, named_key(meter.key, window), number, _LARGE * ui.size)
            found.append(Small(meter.entity, meter.corner, size))
        return found

    @staticmethod
    def build(ui: Ui, world: World, window: Window, places: dict[int, Rect]) -> None:
        """Build every meter at its place."""
        reading, scales = Reading(world), scales_of(world)
        for meter in window.dashboard.meters:
            with ui.panel(f"meter {meter.entity}", places[meter.entity], rounded=True):
                with build_title(ui, named_key(meter.key, window), f"Meter {meter.number}") as is_open:
                    if is_open:
                        _build_menu(ui, world, window, meter)
                why = why_undefined(world, meter.key[1], meter.key[0])
                if why:
                    ui.faint(f"The body is {why}" if why == "gone" else f"It {why}")
                else:
                    _build_number(ui, _figures_of(reading, meter.key, scales), unit_of(meter.key))


def _figures_of(reading: Reading, key: Key, scales: dict[str, float]) -> str:
    """Return a number as a meter shows it, without its unit."""
    value = without_rounding(reading.value(key[1], key[0]), scale_of(key, scales))
    return quantity(value, "").strip() if math.isfinite(value) else "-"


def _build_number(ui: Ui, words: str, unit: str) -> None:
    ui.words.append(f"{words} {unit}")
    imgui.push_font(ui.fonts.bold, _LARGE * ui.size)
    top, height = imgui.get_cursor_pos_y(), imgui.get_text_line_height()
    imgui.text_unformatted(words)
    imgui.pop_font()
    imgui.same_line()
    imgui.set_cursor_pos_y(top + 0.8 * (height - imgui.get_text_line_height()))
    ui.faint(unit, wrapped=False)


def _build_menu(ui: Ui, world: World, window: Window, meter: MeterShown) -> None:
    def choose(key: Key) -> None:
        made = Meter(key[1], key[0], meter.corner)
        window.do_next(dashboard_actions.change, meter.entity, made)

    build_quantities(ui, world, window, [meter.key], choose)
    ui.rule()
    corner = build_corners(ui, meter.corner, CORNERS)
    if corner is not None:
        made = Meter(meter.key[1], meter.key[0], corner)
        window.do_next(dashboard_actions.change, meter.entity, made)
    if ui.item("Remove the meter"):
        window.do_next(dashboard_actions.remove, meter.entity)
