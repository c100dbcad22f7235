"""The rows of a component's fields, and of numbers as people think of them: a slope, a throw, degrees."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from imgui_bundle import imgui
from numpy.typing import NDArray

from physicslab.components import Drag, Mass, Material, Shape, Spring, Trail, Transform, Velocity
from physicslab.ecs.component import Component
from physicslab.ecs.fields import LENGTH_LIMIT, Field
from physicslab.ecs.value_text import points_text
from physicslab.ecs.vector import Vector2
from physicslab.history import AddComponent, Command, SetField
from physicslab.languages.sentence import Sentence
from physicslab.state.joint_rows import KINDS
from physicslab.view.canvas.quantities import ROUNDING, without_rounding, without_turns
from physicslab.view.controls.tool import ICONS
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.changing import change_in_place, set_end
from physicslab.view.window.context import Picking
from physicslab.view.window.plain_numbers import hang, hanging_of, incline, slope_of, way_of
from physicslab.view.window.window import Window
from physicslab.view.workbench.number_field import ABSENT, NumberFields
from physicslab.world import World

_VARIOUS = "various"
_LESSER = ("inertia", "fixed_rotation", "colour", "collide", "breaks", "breaks_torque")
"""Fields that have no row where few figures are wanted."""
_AIM = 2.6
"""Width of the button beside a list of bodies, in heights of the text."""
_MAX_LISTED = 60
"""How many entities a list shows; others are clicked in the world."""

_LENGTH = Field(
    "length", "number", unit="m", above=0.0, limit=LENGTH_LIMIT, meaning="from its pin to its middle"
)
_ANGLE = Field("angle", "number", unit="deg", meaning="from straight down, counter-clockwise")
_SLOPE = Field(
    "slope", "number", unit="deg", above=0.0, maximum=89.0, meaning="how steep it is; its foot stays"
)
_SPEED = Field(
    "speed", "number", unit="m/s", meaning="how fast, and where to: counter-clockwise from the right"
)
_DIRECTION = Field("direction", "number", unit="deg", meaning="counter-clockwise from the right")
"""Numbers as people think of them."""

type Kind = type[Component]


@dataclass(frozen=True, slots=True)
class ComponentRows:
    """Builds the rows of the selection, and makes edits of what is written there.

    They are those of the fields of its components; of one body those of a pendulum, a slope and a throw too.
    """

    ui: Ui
    numbers: NumberFields
    world: World
    window: Window

    def build(self, kind: Kind) -> None:
        """Build a row for each field of a component that all of the selection has."""
        ui, world, window = self.ui, self.world, self.window
        chosen = window.selection.entities
        first, columns = world.component(chosen[0], kind), world.table(kind)
        picked = world.entity_index.rows_of(np.array(chosen, np.int64))
        rows = [spec for spec in kind.FIELDS if kind is not Shape or self._is_of_all(spec, picked)]
        scales = window.scales if kind in (Transform, Velocity) else {}
        if window.level == "Explore":
            rows = [spec for spec in rows if spec.name not in _LESSER]
        if rows:
            ui.gap(0.2)
        if window.level == "Explore" and [spec.name for spec in rows] == ["width", "height"]:
            self._pair(kind, rows, [_common(columns[spec.name][picked]) for spec in rows])
            return
        for spec in rows:
            key, scale = f"{kind.__name__}.{spec.name}", scales.get(spec.unit, 0.0)
            column = columns[spec.name][picked]
            is_common = bool((column == column[0]).all())
            match spec.kind:
                case "vector":
                    column = np.where(np.abs(column) <= ROUNDING * scale, 0.0, column)
                    self._vector(kind, spec, key, (_common(column[:, 0]), _common(column[:, 1])))
                case "flag":
                    on = bool(column.all())
                    words = _label(spec) if is_common else f"{_label(spec)} ({_VARIOUS})"
                    if ui.checkbox(words, on, spec.meaning):
                        self._set(kind, spec, not on)
                case "choice":
                    now = getattr(first, spec.name) if is_common else _VARIOUS
                    self.numbers.label(ui, key, _label(spec), spec)
                    if (chosen_one := ui.choice(key, now, spec.choices)) != now:
                        self._set(kind, spec, chosen_one)
                case "entity":
                    if len(chosen) == 1:
                        self._entity(kind, spec, key, getattr(first, spec.name))
                case "points":
                    shared = points_text(getattr(first, spec.name)) if is_common else None
                    self._number(kind, spec, key, shared)
                case "number" | "whole":
                    given = columns[f"{spec.name}_given"][picked] if spec.derived == ABSENT else None
                    if given is not None and not given.any():
                        self._number(kind, spec, key, ABSENT)
                        continue
                    if given is not None and not given.all():
                        self._number(kind, spec, key, None)
                        continue
                    if spec.unit in scales:
                        column = np.where(np.abs(column) <= ROUNDING * scale, 0.0, column)
                    now = _common(column)
                    if isinstance(now, str):
                        column = np.degrees(column) if self._in_degrees(spec) else column
                        spec, now = _with_mean(spec, column), _common(column)
                    self._number(kind, spec, key, now)
                case _:
                    self._number(kind, spec, key, getattr(first, spec.name) if is_common else None)

    def _is_of_all(self, spec: Field, picked: NDArray[np.int64]) -> bool:
        """Whether shapes of each kind among the selection have a size."""
        kinds = np.unique(self.world.table(Shape)["kind"][picked]).tolist()
        names = next(one.choices for one in Shape.FIELDS if one.name == "kind")
        return all(spec.name in Shape.HAS[names[kind - 1]] for kind in kinds)

    def _pair(self, kind: Kind, specs: Sequence[Field], now: Sequence[Any]) -> None:
        """Build one row for two numbers of the same unit."""
        parts = [
            (f"{kind.__name__}.{spec.name}", spec, value, partial(self._commit, kind, spec))
            for spec, value in zip(specs, now, strict=True)
        ]
        words = ", ".join(spec.name for spec in specs).capitalize()
        self.numbers.pair_row(self.ui, words, words, parts)

    def _commit(self, kind: Kind, spec: Field, new: object) -> None:
        """Give a number to all that is selected, or to each its own, or raise ``InvalidValue``."""
        given = self._for_each(new)
        for entity, one in given.items():
            if one is not None:
                spec.check(one)
            # Some fields depend on others: a radius is above 0.
            kind(**(self.world.component(entity, kind).given() | {spec.name: one}))
        self._change(kind, spec, given.__getitem__)

    def _for_each(self, new: object) -> dict[int, Any]:
        """Return what each of the selection gets: of several numbers its own, from left to right."""
        chosen, table = self.window.selection.entities, self.world.table(Transform)
        if not isinstance(new, tuple):
            return dict.fromkeys(chosen, new)
        rows = self.world.entity_index.rows_of(np.array(chosen, np.int64))
        order = np.argsort(table["position"][rows, 0], kind="stable")
        return {chosen[n]: one for n, one in zip(order.tolist(), new, strict=True)}

    def _in_degrees(self, spec: Field) -> bool:
        return spec.unit == "rad" and self.window.level != "Engineer"

    def _number(self, kind: Kind, spec: Field, key: str, now: Any) -> None:
        commit = partial(self._commit, kind, spec)
        if not self._in_degrees(spec):
            self.numbers.row(self.ui, key, _label(spec), spec, now, commit)
            return
        degrees = without_turns(math.degrees(now)) if isinstance(now, float) else now

        def commit_degrees(new: float | tuple[float, ...] | None) -> None:
            if isinstance(new, tuple):
                commit(tuple(map(math.radians, new)))
            else:
                commit(None if new is None else math.radians(new))

        self.numbers.row(self.ui, key, _label(spec), replace(spec, unit="deg"), degrees, commit_degrees)

    def _vector(self, kind: Kind, spec: Field, key: str, now: tuple[Any, Any]) -> None:
        def commit(axis: int, new: float | tuple[float, ...]) -> None:
            given = self._for_each(new)
            for one in given.values():
                spec.check((one, one))

            def moved(entity: int) -> Vector2:
                vector, own = (
                    getattr(self.window.edits.world.component(entity, kind), spec.name),
                    given[entity],
                )
                return Vector2(own, vector.y) if axis == 0 else Vector2(vector.x, own)

            self._change(kind, spec, moved)

        self.numbers.vector_row(self.ui, key, _label(spec), spec, now, commit)

    def _entity(self, kind: Kind, spec: Field, key: str, end: int | None) -> None:
        """Build the list of the bodies that a field can name; one can be clicked in the world as well."""
        ui, world, window = self.ui, self.world, self.window
        (entity,), none = window.selection.entities, _ABSENT.get(key, "none")
        if kind in KINDS and not world.has(entity, Transform):
            none = "fixed point"
        self.numbers.label(ui, key, _label(spec), spec)
        room = imgui.get_content_region_avail().x - _AIM * ui.size
        now = none if end is None else world.label(end)
        picked = ui.choice(key, end, lambda: _ends(world, entity, none), width=room, shown=now)
        imgui.same_line()
        if ui.button(f"{key} click", "Click the body in the world", shown=ICONS["aim"]):
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
            if spec.fixed:  # the component is made again
                held = ((one, world.component(one, kind).given()) for one in chosen)
                made = [AddComponent(one, kind(**given | {spec.name: value_of(one)})) for one, given in held]
                window.edits.do_all(made)
                return
            changes = [SetField(entity, name, spec.name, value_of(entity)) for entity in chosen]
            change_in_place(world, window, changes)

        self.window.do_first(change)

    def build_hanging(self, body: int) -> None:
        """Build length and angle of a pendulum."""
        hanging = hanging_of(self.world, body)
        if hanging is None:
            return
        length, degrees = hanging.arm.magnitude, math.degrees(hanging.angle)

        def commit_length(new: float) -> None:
            _LENGTH.check(new)
            self._do(hang(self.world, hanging, new, hanging.angle), "length of the pendulum")

        def commit_angle(new: float) -> None:
            self._do(hang(self.world, hanging, length, math.radians(new)), "angle of the pendulum")

        parts = [
            ("Pendulum.length", _LENGTH, length, commit_length),
            ("Pendulum.angle", _ANGLE, without_rounding(degrees, 360.0), commit_angle),
        ]
        words = "From its pin" if hanging.kind is Spring else "Pendulum"  # a cart is not one
        self.numbers.pair_row(self.ui, "Pendulum", words, parts)

    def build_slope(self, body: int) -> None:
        """Build the angle of a ramp."""
        slope = slope_of(self.world, body)
        if slope is None:
            return

        def commit(new: float) -> None:
            _SLOPE.check(new)
            self._do(incline(self.world, body, slope, math.radians(new)), "angle of the slope")

        self.numbers.row(self.ui, "Slope", "Slope", _SLOPE, math.degrees(slope.angle), commit)

    def build_throw(self, body: int) -> None:
        """Build speed and direction of a body."""
        velocity = self.world.component(body, Velocity).linear
        speed = without_rounding(velocity.magnitude, self.window.scales["m/s"])
        degrees = without_rounding(math.degrees(velocity.angle), 360.0) if speed else 0.0

        def commit(speed: float, degrees: float) -> None:
            _SPEED.check(speed)
            self._do([SetField(body, "Velocity", "linear", way_of(speed, degrees))], "")

        parts = [
            ("Throw.speed", _SPEED, speed, lambda new: commit(new, degrees)),
            ("Throw.direction", _DIRECTION, degrees, lambda new: commit(speed, new)),
        ]
        self.numbers.pair_row(self.ui, "Throw", "Speed, to", parts)

    def _do(self, commands: Sequence[Command], words: str) -> None:
        """Make one edit, before the click that ended the writing is done; or say why it is refused."""
        self.window.do_first(change_in_place, commands, words)


def _ends(world: World, entity: int, none: str) -> dict[int | None, str]:
    """Return the names of what has a place, but for one entity, after the word for none."""
    bodies = [other for other in world.batch(Transform).entities.tolist() if other != entity]
    return {None: none} | {other: world.label(other) for other in sorted(bodies)[:_MAX_LISTED]}


def _common(column: NDArray[Any]) -> Any:
    """Return the number that all have, or between which they are, in words."""
    low, high = column.min().item(), column.max().item()
    return low if low == high else Sentence("{least} to {most}", least=f"{low:.3g}", most=f"{high:.3g}")


def _with_mean(spec: Field, column: NDArray[Any]) -> Field:
    """Return a field whose tip has the mean of several numbers."""
    return replace(spec, meaning=f"{spec.meaning}; their mean is {column.mean():.4g}")


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
    "collide": "Its ends touch each other",
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
    ("Layer", "number"): "Layer", ("Layer", "touches"): "Touches layer", ("MadeOf", "material"): "Made of",
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
    for field, words in (("a", "itself"), ("b", "fixed point"))
}
"""The meaning of an absent entity, by component and field."""
