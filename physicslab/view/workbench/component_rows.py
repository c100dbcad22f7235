"""The rows of a component's fields: one for each, whatever it holds, of one entity or of several at once."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from imgui_bundle import imgui

from physicslab.components import Drag, Mass, Material, Shape, Spring, Trail, Transform, Velocity
from physicslab.diagnostics.scales import scales_of
from physicslab.ecs.component import Component
from physicslab.ecs.fields import Field
from physicslab.ecs.quantity_text import points_text
from physicslab.ecs.vector import Vector2
from physicslab.history import SetField
from physicslab.state.joint_rows import KINDS
from physicslab.view.canvas.quantities import without_rounding
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.changing import change_fields, set_end
from physicslab.view.window.window import Picking, Window
from physicslab.view.workbench.number_field import ABSENT, NumberFields
from physicslab.world import World

_VARIOUS = "various"
_LESSER = ("inertia", "fixed_rotation")
"""Fields that have no row where few figures are wanted."""
_MAX_LISTED = 60
"""How many entities a list shows; others are clicked in the world."""

type Kind = type[Component]


@dataclass(frozen=True, slots=True)
class ComponentRows:
    """Builds the rows of the components of the selection, and makes edits of what is written there."""

    ui: Ui
    numbers: NumberFields
    world: World
    window: Window

    def build(self, kind: Kind) -> None:
        """Build a row for each field of a component that all of the selection has."""
        ui, world, window = self.ui, self.world, self.window
        held = [world.component(entity, kind) for entity in window.selection.entities]
        rows = [spec for spec in kind.FIELDS if all(_is_shown(spec, part) for part in held)]
        scales = scales_of(world) if kind in (Transform, Velocity) else {}
        if window.level == "Explore":
            rows = [spec for spec in rows if spec.name not in _LESSER]
        if rows:
            ui.gap(0.2)
        for spec in rows:
            key, scale = f"{kind.__name__}.{spec.name}", scales.get(spec.unit, 0.0)
            values = [getattr(part, spec.name) for part in held]
            match spec.kind:
                case "vector":
                    values = [Vector2(*(without_rounding(part, scale) for part in value)) for value in values]
                    self._vector(kind, spec, key, values)
                case "flag":
                    words = _label(spec) if _common(values) is not None else f"{_label(spec)} ({_VARIOUS})"
                    on = all(value is True for value in values)
                    if ui.checkbox(words, on, spec.meaning):
                        self._set(kind, spec, not on)
                case "choice":
                    now = _common(values) or _VARIOUS
                    self.numbers.label(ui, key, _label(spec), spec)
                    if (chosen := ui.choice(key, now, spec.choices)) != now:
                        self._set(kind, spec, chosen)
                case "entity":
                    if len(values) == 1:
                        self._entity(kind, spec, key, values[0])
                case "points":
                    shared = _common(values)
                    self._number(kind, spec, key, None if shared is None else points_text(shared))
                case _:
                    if spec.unit in scales:
                        values = [without_rounding(value, scale) for value in values]
                    if spec.derived == ABSENT:
                        values = [
                            value if part.is_given(spec.name) else ABSENT
                            for value, part in zip(values, held, strict=True)
                        ]
                    self._number(kind, spec, key, _common(values))

    def _number(self, kind: Kind, spec: Field, key: str, now: Any) -> None:
        def commit(new: object) -> None:
            if new is not None:
                spec.check(new)
            for entity in self.window.selection.entities:  # some fields depend on others: a radius is above 0
                kind(**(self.world.component(entity, kind).given() | {spec.name: new}))
            self._set(kind, spec, new)

        if spec.unit != "rad" or self.window.level != "Explore":
            self.numbers.row(self.ui, key, _label(spec), spec, now, commit)
            return
        degrees = math.degrees(now) if isinstance(now, float) else now

        def commit_degrees(new: float | None) -> None:
            commit(None if new is None else math.radians(new))

        self.numbers.row(self.ui, key, _label(spec), replace(spec, unit="deg"), degrees, commit_degrees)

    def _vector(self, kind: Kind, spec: Field, key: str, values: Sequence[Vector2]) -> None:
        def commit(axis: int, new: float) -> None:
            spec.check((new, new))

            def moved(entity: int) -> Vector2:
                vector = getattr(self.window.edits.world.component(entity, kind), spec.name)
                return Vector2(new, vector.y) if axis == 0 else Vector2(vector.x, new)

            self._change(kind, spec, moved)

        parts = _common([value.x for value in values]), _common([value.y for value in values])
        self.numbers.vector_row(self.ui, key, _label(spec), spec, parts, commit)

    def _entity(self, kind: Kind, spec: Field, key: str, end: int | None) -> None:
        """Build the list of the bodies that a field can name; one can be clicked in the world as well."""
        ui, world, window = self.ui, self.world, self.window
        (entity,), none = window.selection.entities, _ABSENT.get(key, "none")
        if kind in KINDS and not world.has(entity, Transform):
            none = "a fixed point"
        self.numbers.label(ui, key, _label(spec), spec)
        room = imgui.get_content_region_avail().x - 3.6 * ui.size
        now = none if end is None else world.label(end)
        picked = ui.choice(key, end, lambda: _ends(world, entity, none), width=room, shown=now)
        imgui.same_line()
        if ui.button(f"{key} click", "Click the body in the world", shown="Click"):
            window.picking = Picking(entity, kind, spec.name)
            window.notify("Click the body; empty space for none", 6.0)
        if picked != end:
            window.do_first(set_end, entity, kind, spec.name, picked)

    def _set(self, kind: Kind, spec: Field, value: object) -> None:
        self._change(kind, spec, lambda entity: value)

    def _change(self, kind: Kind, spec: Field, value_of: Callable[[int], object]) -> None:
        """Give the field of all that is selected a value, before the click that ended the writing is done."""
        chosen, name = self.window.selection.entities, kind.__name__

        def change(world: World, window: Window) -> None:
            changes = [SetField(entity, name, spec.name, value_of(entity)) for entity in chosen]
            change_fields(world, window, changes)

        self.window.do_first(change)


def _ends(world: World, entity: int, none: str) -> dict[int | None, str]:
    """Return the names of what has a place, but for one entity, after the word for none."""
    bodies = [other for other in world.batch(Transform).entities.tolist() if other != entity]
    return {None: none} | {other: world.label(other) for other in sorted(bodies)[:_MAX_LISTED]}


def _common(values: Sequence[Any]) -> Any:
    """Return the value that all have, or ``None``."""
    return values[0] if all(value == values[0] for value in values) else None


def _is_shown(spec: Field, held: Component) -> bool:
    """Whether a field has a row: sizes of the other kind of shape and what cannot change have none."""
    if isinstance(held, Shape):
        return spec.name in Shape.HAS[held.kind]
    return spec.kind == "entity" or not spec.fixed


def _label(spec: Field) -> str:
    return _NAMES.get((spec.owner, spec.name), spec.name.replace("_", " ").capitalize())


ORDER: dict[Kind, int] = {
    kind: n
    for n, kind in enumerate((Transform, Velocity, Mass, Shape, Material, Drag, Spring, *KINDS, Trail))
}
"""In which order components are shown; others come after these."""
_JOINED = {
    "lower": "From limit", "upper": "To limit", "motor_speed": "Motor speed", "max_torque": "Motor at most",
    "max_force": "Motor at most", "breaks": "Breaks at", "breaks_torque": "or at",
}  # fmt: skip
_JOINING: tuple[type[Component], ...] = (Spring, *KINDS)
"""The components with two ends."""
_NAMES = {
    ("Velocity", "linear"): "Velocity", ("Velocity", "angular"): "Turning",
    **{
        (kind.__name__, field): words
        for kind in _JOINING
        for field, words in (("a", "From"), ("b", "To"), ("anchor_a", "Holds at"), ("anchor_b", "Other end"))
    },
    **{
        (kind.__name__, spec.name): _JOINED[spec.name]
        for kind in KINDS
        for spec in kind.FIELDS
        if spec.name in _JOINED
    },
    ("Slot", "axis"): "Way", ("Slot", "turns"): "What slides turns",
    ("Gear", "first"): "First joint", ("Gear", "second"): "Second joint",
    ("Pulley", "wheel_a"): "First wheel", ("Pulley", "wheel_b"): "Second wheel",
    ("Mass", "fixed_rotation"): "Keeps its angle",
    ("Drag", "linear"): "Drag of v", ("Drag", "quadratic"): "Drag of v²", ("Trail", "length"): "Trail of",
}  # fmt: skip
"""Plainer names for the labels, by component and field."""
_ABSENT = {
    f"{kind.__name__}.{field}": words
    for kind in _JOINING
    for field, words in (("a", "itself"), ("b", "a fixed point"))
}
"""The meaning of an absent entity, by component and field."""
