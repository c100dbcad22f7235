"""Meters and sliders: a number in large figures, and one that is changed between two values."""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

from imgui_bundle import imgui

from physicslab.components import Meter, Slider, Transform
from physicslab.components.meter import CORNERS
from physicslab.components.slider import GRAVITY, SLIDER_FIELDS
from physicslab.diagnostics.quantities import Reading, why_undefined
from physicslab.ecs.fields import InvalidValue
from physicslab.languages.sentence import Sentence
from physicslab.view.canvas.canvas import Rect
from physicslab.view.canvas.drawable_text import drawable, shortened
from physicslab.view.canvas.quantities import quantity, without_rounding, written_unit
from physicslab.view.controls import dashboard_actions
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.dashboard import MeterShown, SliderShown
from physicslab.view.window.record import Key
from physicslab.view.window.window import Window
from physicslab.view.workbench.graph_readings import build_quantities, named_key, scale_of, unit_of
from physicslab.view.workbench.number_field import NumberFields, shown_number
from physicslab.view.workbench.panel_places import Small
from physicslab.world import World

_MENU = "..."
_LETTERS = 34
"""Letters of a title."""


def size_of(ui: Ui, title: str, width: float, height: float) -> tuple[int, int]:
    """Return the width and height of a small panel [px] with a title above something so large.

    A ``height`` of 0 puts it beside the title.
    """
    style = imgui.get_style()
    head = ui.width(_words(title)) + style.item_spacing.x + _menu_width()
    inside = max(width, head) if height else head + style.item_spacing.x + width
    high = imgui.get_frame_height() + (style.item_spacing.y + height if height else 0.0)
    return round(inside + 2.0 * style.window_padding.x), round(high + 2.0 * style.window_padding.y)


@contextmanager
def build_title(ui: Ui, title: str, label: str, beside: float = 0.0) -> Iterator[bool]:
    """Write the title, with a button of a menu at the right; the yielded value says whether it is open.

    It is cut where room for it ends, of which something takes so much ``beside`` it [px].
    """
    style = imgui.get_style()
    room = _menu_at() - beside - style.item_spacing.x - style.window_padding.x
    ui.lead(_cut(ui, _words(title), room), _menu_at())
    tip = f"{label}: what it shows, and where"
    with ui.list(f"Menu of {label.lower()}", tip, shown=_MENU) as is_open:
        yield is_open


def build_corners(ui: Ui, now: str) -> str | None:
    """Build a menu of corners; return the one that was chosen."""
    chosen = None
    with ui.menu("Place") as is_open:
        for corner in CORNERS if is_open else ():
            if ui.item(corner.capitalize(), on=corner == now):
                chosen = corner
    return chosen


def _menu_width() -> float:
    return float(imgui.calc_text_size(_MENU).x + 2.0 * imgui.get_style().frame_padding.x)


def _menu_at() -> float:
    """Return where the button of the menu begins in a panel [px]."""
    return float(imgui.get_window_width() - _menu_width() - imgui.get_style().window_padding.x)


def _words(title: str) -> str:
    return drawable(shortened(title, _LETTERS))


def _cut(ui: Ui, words: str, room: float) -> str:
    """Return words without as many of their last letters as there is no room for [px]."""
    room += 1.0  # a panel is so many whole pixels wide
    if ui.width(words) <= room:
        return words
    words = ui.said(words)
    return next((cut for n in range(len(words), 0, -1) if ui.width(cut := shortened(words, n)) <= room), "")


# ---- meters ------------------------------------------------------------------------------------------------


_LARGE = 1.8
"""Height of the figures, in heights of the text."""
_WIDEST = "-0.0000"
"""As wide as most numbers are."""


class MeterPanels:
    """The panels of meters; each is as wide as the longest number that it has shown."""

    def __init__(self) -> None:
        self._figures: dict[int, str] = {}
        self._beside: dict[int, float] = {}  # how wide numbers beside titles are [px]

    def sizes(self, ui: Ui, world: World, window: Window, *, flat: bool) -> list[Small]:
        """Return how large each meter is; one that is ``flat`` has its number beside its title."""
        if not window.dashboard.meters:
            return []
        self._beside, found, reading = {}, [], Reading(world)
        scales = window.scales
        shown = {meter.entity: _figures_of(reading, meter.key, scales) for meter in window.dashboard.meters}
        known = {entity: self._figures.get(entity, _WIDEST) for entity in shown}
        self._figures = {entity: max(known[entity], shown[entity], key=len) for entity in shown}
        for meter in window.dashboard.meters:
            imgui.push_font(ui.fonts.bold, ui.size if flat else _LARGE * ui.size)
            number = imgui.calc_text_size(self._figures[meter.entity]).x
            imgui.pop_font()
            number += imgui.get_style().item_spacing.x + imgui.calc_text_size(unit_of(meter.key)).x
            if flat:
                self._beside[meter.entity] = number + imgui.get_style().item_spacing.x
            size = size_of(ui, named_key(meter.key, window), number, 0.0 if flat else _LARGE * ui.size)
            found.append(Small(meter.entity, meter.corner, size))
        return found

    def build(self, ui: Ui, world: World, window: Window, places: dict[int, Rect]) -> None:
        """Build every meter at its place."""
        if not window.dashboard.meters:
            return
        reading, scales = Reading(world), window.scales
        for meter in window.dashboard.meters:
            with ui.panel(f"meter {meter.entity}", places[meter.entity], rounded=True):
                title, beside = named_key(meter.key, window), self._beside.get(meter.entity, 0.0)
                with build_title(ui, title, f"Meter {meter.number}", beside) as is_open:
                    if is_open:
                        _build_menu(ui, world, window, meter)
                if beside:
                    imgui.same_line(_menu_at() - beside)
                why = why_undefined(world, meter.key[1], meter.key[0])
                if why:
                    ui.faint(f"The body is {why}" if why == "gone" else f"It {why}", wrapped=not self._beside)
                else:
                    large = ui.size if self._beside else _LARGE * ui.size
                    _build_number(ui, _figures_of(reading, meter.key, scales), unit_of(meter.key), large)


def _figures_of(reading: Reading, key: Key, scales: dict[str, float]) -> str:
    """Return a number as a meter shows it, without its unit."""
    value = without_rounding(reading.value(key[1], key[0]), scale_of(key, scales))
    return quantity(value, "").strip() if math.isfinite(value) else "-"


def _build_number(ui: Ui, words: str, unit: str, size: float) -> None:
    """Write a number in figures of a height [px], and its unit."""
    words = ui.said(words)
    ui.words.append(f"{words} {unit}")
    imgui.push_font(ui.fonts.bold, size)
    top, height = imgui.get_cursor_pos_y(), imgui.get_text_line_height()
    imgui.text_unformatted(words)
    imgui.pop_font()
    imgui.same_line()
    imgui.set_cursor_pos_y(top + 0.8 * (height - imgui.get_text_line_height()))
    ui.faint(unit, wrapped=False)


def _build_menu(ui: Ui, world: World, window: Window, meter: MeterShown) -> None:
    def change(key: Key, corner: str = meter.corner) -> None:
        window.do_next(dashboard_actions.change, meter.entity, Meter(key[1], key[0], corner))

    build_quantities(ui, world, window, [meter.key], change)
    ui.rule()
    corner = build_corners(ui, meter.corner)
    if corner is not None:
        change(meter.key, corner)
    ui.item("Remove the meter", dashboard_actions.remove, meter.entity)


# ---- sliders -----------------------------------------------------------------------------------------------


_WIDTH, _VALUE = 7.5, 5.0
"""Width of a slider, and room for its number, in heights of the text."""
_ENDS = (("low", "From"), ("high", "To"))


class SliderPanels:
    """The panels of sliders. A slider that is held stands where it was moved to."""

    def __init__(self) -> None:
        self._held: dict[int, float] = {}

    def sizes(self, ui: Ui, window: Window) -> list[Small]:
        """Return how large each slider is."""
        width, height = (_WIDTH + _VALUE) * ui.size, imgui.get_frame_height()
        return [
            Small(one.entity, one.corner, size_of(ui, _title(one, window), width, height))
            for one in window.dashboard.sliders
        ]

    def build(
        self, ui: Ui, numbers: NumberFields, world: World, window: Window, places: dict[int, Rect]
    ) -> None:
        """Build every slider at its place."""
        self._held = {one.entity: self._held[one.entity] for one in window.dashboard.sliders
                      if one.entity in self._held}  # fmt: skip
        for slider in window.dashboard.sliders:
            with ui.panel(f"slider {slider.entity}", places[slider.entity], rounded=True):
                with build_title(ui, _title(slider, window), f"Slider {slider.number}") as is_open:
                    if is_open:
                        _build_slider_menu(ui, numbers, world, window, slider)
                self._build_slider(ui, world, window, slider)

    def _build_slider(self, ui: Ui, world: World, window: Window, slider: SliderShown) -> None:
        now = _value(world, slider)
        if isinstance(now, str):
            ui.faint(now)
            return
        value = self._held.get(slider.entity, now)
        words = quantity(value, written_unit(slider.unit)).strip()
        label, width = f"Slider {slider.number}", imgui.get_content_region_avail().x - _VALUE * ui.size
        moved = ui.slider(label, value, slider.low, slider.high, "", width)
        ui.tip(f"From {slider.low:g} to {slider.high:g} {written_unit(slider.unit)}".strip())
        if moved is not None:
            moved = _rounded(moved, slider)
            self._held[slider.entity] = moved
            if moved != value:
                window.do_next(dashboard_actions.slide, slider, moved)
        if not imgui.is_item_active():
            self._held.pop(slider.entity, None)
        imgui.same_line()
        ui.text(words)


def _build_slider_menu(
    ui: Ui, numbers: NumberFields, world: World, window: Window, slider: SliderShown
) -> None:
    given: dict[str, Any] = {
        "changes": slider.changes, "entity": slider.target, "low": slider.low, "high": slider.high,
        "corner": slider.corner,
    }  # fmt: skip

    def change(**changes: Any) -> None:
        made = Slider(**(given | changes))  # raises where they are refused
        window.do_next(dashboard_actions.change, slider.entity, made)

    for name, words in _ENDS:
        spec = next(spec for spec in Slider.FIELDS if spec.name == name)
        ui.lead(words, 3.0 * ui.size)
        key, width = f"{name} of slider {slider.number}", 6.0 * ui.size
        commit = partial(_change_end, change, slider, name)
        refusal = numbers.build(ui, key, given[name], spec, width, commit)
        imgui.same_line()
        ui.faint(written_unit(slider.unit), wrapped=False)
        ui.refusal(refusal)
    ui.rule()
    _build_choice(ui, world, window, slider, change)
    corner = build_corners(ui, slider.corner)
    if corner is not None:
        change(corner=corner)
    ui.item("Remove the slider", dashboard_actions.remove, slider.entity)


def _change_end(change: Any, slider: SliderShown, name: str, new: float) -> None:
    """Change the end of a range; where it is beyond the other end, say so of the end that was written."""
    if name == "low" and new >= slider.high:
        raise InvalidValue("Slider", name, new, f"a finite number < {slider.high:g} {slider.unit}")
    change(**{name: new})


def _build_choice(ui: Ui, world: World, window: Window, slider: SliderShown, change: Any) -> None:
    """Build the menus of what a slider can change: of its entity, of the selection, and gravity."""
    if ui.item("Gravity", on=slider.changes == GRAVITY):
        low, high = dashboard_actions.usual_range(world, GRAVITY, None)
        change(changes=GRAVITY, entity=None, low=low, high=high)
    there = world.entity_index.row_of
    chosen = [entity for entity in (slider.target, *window.selection.entities) if entity in there]
    moving = world.batch(Transform).entities[:12].tolist()
    for entity in dict.fromkeys((*chosen, *moving)):
        if entity is None:
            continue
        with ui.menu(world.label(entity), f"numbers of {entity}") as is_open:
            for name, (kind, spec) in SLIDER_FIELDS.items() if is_open else ():
                if not world.has(entity, kind):
                    continue
                is_now = (slider.changes, slider.target) == (name, entity)
                if ui.item(f"{_plain(name)} [{written_unit(spec.unit) or 'no unit'}]", on=is_now):
                    low, high = dashboard_actions.usual_range(world, name, entity)
                    change(changes=name, entity=entity, low=low, high=high)


def _title(slider: SliderShown, window: Window) -> str:
    if slider.changes == GRAVITY:
        return "Gravity"
    body, changes = window.dashboard.label(slider.target), Sentence(_plain(slider.changes))
    return Sentence("{body}: {quantity}", body=body, quantity=changes)


def _plain(changes: str) -> str:
    """Return the name of a field as people read it.

    >>> _plain("Spring.rest_length"), _plain("Velocity.angular")
    ('rest length', 'angular velocity')
    """
    if changes == "Velocity.angular":
        return "angular velocity"
    return changes.partition(".")[2].replace("_", " ")


def _value(world: World, slider: SliderShown) -> float | str:
    """Return the number that a slider changes, or why there is none."""
    if slider.changes == GRAVITY:
        return -world.physics.gravity.y
    kind, spec = SLIDER_FIELDS[slider.changes]
    if slider.target not in world.entity_index.row_of:
        return "The body is gone"
    assert slider.target is not None
    if not world.has(slider.target, kind):
        return f"It has no {kind.__name__}"
    return float(getattr(world.component(slider.target, kind), spec.name))


def _rounded(value: float, slider: SliderShown) -> float:
    """Return a number in as many figures as a slider can be set to, and within its ends."""
    value = float(shown_number(value, 4))
    return min(max(value, slider.low), slider.high)
