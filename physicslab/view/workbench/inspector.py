"""What is selected, in numbers that can be changed: made from the fields of its components."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from imgui_bundle import imgui

from physicslab.components import Drag, Held, Mass, Material, Name, Shape, Spring, Trail, Transform, Velocity
from physicslab.diagnostics.free_body import forces_on, net_force
from physicslab.ecs.component import Component
from physicslab.ecs.fields import Field
from physicslab.ecs.vector import Vector2
from physicslab.history import AddComponent, Group, RemoveComponent, SetField
from physicslab.view.canvas.quantities import quantity, vector_quantity
from physicslab.view.controls.actions import duplicate_selected, plot_selected
from physicslab.view.controls.tools import remove_selected
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.placing import refused_change
from physicslab.view.window.window import Window
from physicslab.view.workbench.number_field import NumberFields
from physicslab.world import World

__all__ = ["Inspector"]

_LEFT_OUT = (Name, Held)
"""Components without rows of their own: a name is the title, a hand is seen."""
_OPTIONAL: tuple[type[Component], ...] = (Velocity, Mass, Material, Drag, Trail)
"""Components that can be added and removed here."""
_LABELS = 0.36
"""Share of the panel's width that labels take."""


class Inspector:
    """The rows of what is selected. One body: all its fields; several: what they have in common."""

    def __init__(self) -> None:
        self._numbers = NumberFields(_LABELS)
        self._shown: tuple[object, ...] = ()

    def build(self, ui: Ui, world: World, window: Window) -> None:
        """Build it for what is selected."""
        chosen = window.selection.entities
        if self._shown != (world, chosen):
            self._shown = world, chosen
            self._numbers.clear()
        first = chosen[-1]
        ui.heading(_title(world, first) if len(chosen) == 1 else f"{len(chosen)} selected")
        ui.faint(_kind(world, first) if len(chosen) == 1 else "Changes go to all of them")
        kinds = [
            type(held)
            for held in world.components(first)
            if not isinstance(held, _LEFT_OUT) and all(world.has(other, type(held)) for other in chosen)
        ]
        for kind in sorted(kinds, key=lambda kind: _ORDER.get(kind, len(_ORDER))):
            self._build_component(ui, world, window, kind)
        if len(chosen) == 1:
            self._build_now(ui, world, first)
            if window.level != "Explore" or window.overlays.arrows:
                self._build_forces(ui, world, first)
            self._build_optional(ui, world, window, first)
        self._build_buttons(ui, window)

    def finish(self, window: Window) -> str:
        """Take over what is half written in a field, and return why it is refused; empty where it is not.

        What was written of bodies that are shown no more is dropped.
        """
        if self._shown != (window.edits.world, window.selection.entities):
            self._numbers.clear()
        return self._numbers.finish()

    # ---- fields --------------------------------------------------------------------------------------------

    def _build_component(self, ui: Ui, world: World, window: Window, kind: type[Component]) -> None:
        held = world.component(window.selection.entities[-1], kind)
        rows = [spec for spec in kind.FIELDS if _is_shown(spec, held)]
        if not rows:
            return
        ui.gap(0.2)
        for spec in rows:
            if spec.kind == "vector":
                self._build_vector(ui, window, kind, spec, getattr(held, spec.name))
            elif spec.kind == "number":
                self._build_number(ui, world, window, kind, spec, getattr(held, spec.name))
            elif spec.kind == "flag" and ui.checkbox(
                _label(spec), bool(getattr(held, spec.name)), spec.meaning
            ):
                self._set(window, kind, spec, not getattr(held, spec.name))

    def _build_number(
        self, ui: Ui, world: World, window: Window, kind: type[Component], spec: Field, value: float
    ) -> None:
        def commit(new: float) -> None:
            spec.check(new)
            held = world.component(window.selection.entities[-1], kind)
            kind(**(held.given() | {spec.name: new}))  # some fields depend on others: a radius is above 0
            self._set(window, kind, spec, new)

        self._numbers.row(ui, f"{kind.__name__}.{spec.name}", _label(spec), spec, value, commit)

    def _build_vector(
        self, ui: Ui, window: Window, kind: type[Component], spec: Field, value: Vector2
    ) -> None:
        def commit(axis: int, new: float) -> None:
            spec.check((value.x, new) if axis else (new, value.y))
            self._set_part(window, kind, spec, axis, new)

        self._numbers.vector_row(
            ui, f"{kind.__name__}.{spec.name}", _label(spec), spec, (value.x, value.y), commit
        )

    @staticmethod
    def _set(window: Window, kind: type[Component], spec: Field, value: object) -> None:
        def deed(world: World, window: Window) -> None:
            _change(window, [SetField(e, kind.__name__, spec.name, value) for e in window.selection.entities])

        window.deeds.insert(0, deed)  # before the click that ended the writing

    @staticmethod
    def _set_part(window: Window, kind: type[Component], spec: Field, axis: int, new: float) -> None:
        def deed(world: World, window: Window) -> None:
            changes = []
            for entity in window.selection.entities:
                vector = getattr(world.component(entity, kind), spec.name)
                parts = (new, vector.y) if axis == 0 else (vector.x, new)
                changes.append(SetField(entity, kind.__name__, spec.name, Vector2(*parts)))
            _change(window, changes)

        window.deeds.insert(0, deed)

    # ---- what follows from them ----------------------------------------------------------------------------

    @staticmethod
    def _build_now(ui: Ui, world: World, entity: int) -> None:
        """Write what follows from the fields: it cannot be changed."""
        if not world.has(entity, Velocity):
            return
        velocity = world.component(entity, Velocity)
        ui.gap(0.2)
        ui.rule()
        speed = velocity.linear.magnitude
        ui.row("Speed", quantity(speed, "m/s"))
        if speed > 0.0:
            ui.row(
                "Direction", f"{math.degrees(velocity.linear.angle):.1f}°", "counter-clockwise from the right"
            )
        if not world.has(entity, Mass):
            return
        mass = world.component(entity, Mass)
        row = world.entity_index.row_of[entity]
        ui.row("Momentum", quantity(mass.mass * speed, "kg m/s"))
        ui.row("as a vector", vector_quantity(mass.mass * velocity.linear, "kg m/s"), lesser=True)
        energy = 0.5 * mass.mass * speed**2
        inverse = float(world.bodies.inverse_inertia[row])
        spin = 0.5 * velocity.angular**2 / inverse if inverse > 0.0 else 0.0
        ui.row("Kinetic energy", quantity(energy + spin, "J"))
        if spin and np.isfinite(spin):
            ui.row("of turning", quantity(spin, "J"), lesser=True)

    @staticmethod
    def _build_forces(ui: Ui, world: World, entity: int) -> None:
        """Write the forces on it, and their sum: what a free-body diagram shows (V draws it)."""
        forces = forces_on(world, entity)
        if not forces:
            return
        ui.gap(0.2)
        ui.rule()
        ui.faint("Forces on it")
        for one in forces:
            ui.row(one.name.capitalize(), quantity(one.force.magnitude, "N"), vector_quantity(one.force, "N"))
        total, largest = net_force(forces), max(one.force.magnitude for one in forces)
        net = total.magnitude if total.magnitude > 1e-9 * largest else 0.0
        ui.row("Sum", quantity(net, "N"), vector_quantity(total, "N"))

    def _build_optional(self, ui: Ui, world: World, window: Window, entity: int) -> None:
        """Build a box to tick for each component that the body may have or not."""
        if world.has(entity, Spring) and not world.has(entity, Transform):
            return
        ui.gap(0.2)
        ui.rule()
        for kind, words, tip in _SWITCHES:
            if ui.checkbox(words, world.has(entity, kind), tip):
                window.deeds.append(_switching(entity, kind))

    @staticmethod
    def _build_buttons(ui: Ui, window: Window) -> None:
        ui.gap(0.2)
        if ui.button("Duplicate", "Another one beside it (Ctrl+D)"):
            window.deeds.append(duplicate_selected)
        imgui.same_line()
        if ui.button("Delete", "Remove what is selected (Del)"):
            window.deeds.append(remove_selected)
        imgui.same_line()
        if ui.button("Plot", "Its speed and place against time"):
            window.deeds.append(plot_selected)
        imgui.same_line()
        if ui.button("Done", "Select nothing (Esc)"):
            window.deeds.append(lambda _, window: window.selection.clear())


def _switching(entity: int, kind: type[Component]) -> Callable[[World, Window], None]:
    def deed(world: World, window: Window) -> None:
        has = world.has(entity, kind)
        window.edits.do(RemoveComponent(entity, kind.__name__) if has else AddComponent(entity, kind()))

    return deed


def _change(window: Window, changes: Sequence[SetField]) -> None:
    """Make one edit of a change to each of what is selected."""
    for change in changes:
        refused = _refused(window.edits.world, change)
        if refused:
            window.notify(f"{change.words(window.edits.world)}: {refused}", 6.0, failed=True)
            return
    if changes:
        one = changes[0]
        window.edits.do(one if len(changes) == 1 else Group(one.words(window.edits.world), changes))


def _refused(world: World, change: SetField) -> str:
    """Return why a place or a size cannot be given to a body; of other fields nothing."""
    kind = next((kind for kind in (Transform, Shape) if kind.__name__ == change.component), None)
    return "" if kind is None else refused_change(world, change.entity, kind, change.field, change.value)


def _title(world: World, entity: int) -> str:
    return world.component(entity, Name).id if world.has(entity, Name) else f"Body {entity}"


def _kind(world: World, entity: int) -> str:
    """Return what an entity is, in words."""
    if world.has(entity, Shape):
        shape = "circle" if world.component(entity, Shape).kind == "circle" else "box"
    else:
        shape = "point" if world.has(entity, Transform) else "spring"
    if not world.has(entity, Transform):
        return shape
    if not world.has(entity, Velocity):
        return f"{shape}, stays where it is"
    return f"{shape}, moves" if world.has(entity, Mass) else f"{shape}, moves as it was set, infinitely heavy"


def _is_shown(spec: Field, held: Component) -> bool:
    """Whether a field has a row: sizes of the other kind of shape and what cannot change have none."""
    if isinstance(held, Shape):
        return spec.name in Shape.SIZES[held.kind]
    return spec.kind in ("number", "vector", "flag") and not spec.fixed


def _label(spec: Field) -> str:
    return _NAMES.get(spec.name, spec.name.replace("_", " ").capitalize())


_ORDER: dict[type[Component], int] = {
    kind: n for n, kind in enumerate((Transform, Velocity, Mass, Shape, Material, Drag, Spring, Trail))
}
_NAMES = {
    "linear": "Velocity", "angular": "Turning", "mass": "Mass", "inertia": "Inertia",
    "fixed_rotation": "Keeps its angle", "anchor_a": "Holds at", "anchor_b": "Other end",
    "rest_length": "Rest length", "quadratic": "Drag of v²",
}  # fmt: skip
"""Plainer names for the labels."""
_SWITCHES: tuple[tuple[type[Component], str, str], ...] = (
    (Velocity, "Can move", "Without it the body stays where it is"),
    (Mass, "Has mass", "A body that can move and has none is infinitely heavy"),
    (Drag, "Air resistance", "A force against its motion"),
    (Trail, "Leaves a trail", "Shows where it was"),
)
