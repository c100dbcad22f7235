"""Sliders: a number of an entity, or gravity, changed between two values."""

from __future__ import annotations

from typing import Any

from imgui_bundle import imgui

from physicslab.components import Slider, Transform
from physicslab.components.meter import CORNERS
from physicslab.components.slider import GRAVITY, SLIDER_FIELDS
from physicslab.ecs.fields import Field
from physicslab.view.canvas.canvas import Rect
from physicslab.view.canvas.quantities import quantity, written_unit
from physicslab.view.controls import dashboard_actions
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.dashboard import SliderShown
from physicslab.view.window.window import Window
from physicslab.view.workbench.number_field import NumberFields, shown_number
from physicslab.view.workbench.panel_places import Small
from physicslab.view.workbench.small_panel import build_corners, build_title, size_of
from physicslab.world import World

__all__ = ["SliderPanels"]

_WIDTH, _VALUE = 7.5, 5.0
"""Width of a slider, and room for its number, in heights of the text."""
_ENDS = (("low", "From"), ("high", "To"))


class SliderPanels:
    """The panels of sliders. A number is kept while the slider is held, and changed once it is let go."""

    def __init__(self) -> None:
        self._held: dict[int, float] = {}
        self._numbers = NumberFields()

    def finish(self) -> str:
        """Take over what is half written in a field; return why it is refused, empty where it is not."""
        return self._numbers.finish()

    def sizes(self, ui: Ui, window: Window) -> list[Small]:
        """Return how large each slider is."""
        width, height = (_WIDTH + _VALUE) * ui.size, imgui.get_frame_height()
        return [
            Small(one.entity, one.corner, size_of(ui, _title(one, window), width, height))
            for one in window.dashboard.sliders
        ]

    def build(self, ui: Ui, world: World, window: Window, places: dict[int, Rect]) -> None:
        """Build every slider at its place."""
        self._held = {one.entity: self._held[one.entity] for one in window.dashboard.sliders
                      if one.entity in self._held}  # fmt: skip
        for slider in window.dashboard.sliders:
            with ui.panel(f"slider {slider.entity}", places[slider.entity], rounded=True):
                with build_title(ui, _title(slider, window), f"Slider {slider.number}") as is_open:
                    if is_open:
                        self._build_menu(ui, world, window, slider)
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
        held = imgui.is_item_active()
        imgui.same_line()
        ui.text(words)
        if moved is not None:
            moved = _rounded(moved, slider)
            self._held[slider.entity] = moved
            if moved != value:
                window.do_next(dashboard_actions.slide, slider, moved, held=True)
        if not held and slider.entity in self._held:
            last = self._held.pop(slider.entity)
            window.do_next(dashboard_actions.slide, slider, last, held=False)

    def _build_menu(self, ui: Ui, world: World, window: Window, slider: SliderShown) -> None:
        given: dict[str, Any] = {
            "changes": slider.changes, "entity": slider.target, "low": slider.low, "high": slider.high,
            "corner": slider.corner,
        }  # fmt: skip

        def change(**changes: Any) -> None:
            made = Slider(**(given | changes))  # raises where they are refused
            window.do_next(dashboard_actions.change, slider.entity, made)

        for name, words in _ENDS:
            spec = next(spec for spec in Slider.FIELDS if spec.name == name)
            imgui.align_text_to_frame_padding()
            ui.faint(words, wrapped=False)
            imgui.same_line(3.0 * ui.size)
            refusal = self._build_end(ui, slider, spec, given[name], change)
            if refusal:
                ui.text(refusal, ui.theme.error, wrapped=True)
        ui.rule()
        _build_choice(ui, world, window, slider, change)
        corner = build_corners(ui, slider.corner, CORNERS)
        if corner is not None:
            change(corner=corner)
        if ui.item("Remove the slider"):
            window.do_next(dashboard_actions.remove, slider.entity)

    def _build_end(self, ui: Ui, slider: SliderShown, spec: Field, value: float, change: Any) -> str:
        key = f"{spec.name} of slider {slider.number}"
        refusal = self._numbers.build(
            ui, key, value, spec, 6.0 * ui.size, lambda new: change(**{spec.name: new})
        )
        imgui.same_line()
        ui.faint(written_unit(slider.unit), wrapped=False)
        return refusal


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
    return f"{window.dashboard.label(slider.target)}: {_plain(slider.changes)}"


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
