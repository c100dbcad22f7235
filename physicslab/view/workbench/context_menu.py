"""The menu of a body, a joint or a spring, and that of empty space: what can be done with it."""

import math
from collections.abc import Mapping
from functools import partial

from imgui_bundle import ImVec2, ImVec4, imgui

from physicslab.components import Colour, Layer, Pin, Spring, Transform, Velocity, Weld
from physicslab.components.colour import COLOURS, rgb_of
from physicslab.components.layer import NONE
from physicslab.components.made_of import SUBSTANCES
from physicslab.diagnostics.joints import joint_states
from physicslab.history import SetField
from physicslab.languages.sentence import Sentence
from physicslab.state.joint_rows import KINDS
from physicslab.view.canvas.quantities import quantity
from physicslab.view.controls import copies
from physicslab.view.controls.actions import choose_tool, select_all
from physicslab.view.controls.dashboard_actions import plot_selected
from physicslab.view.controls.drawing import click
from physicslab.view.controls.drawn import Drawn
from physicslab.view.controls.joining import attachments
from physicslab.view.controls.spawning import BODIES, GROUPS
from physicslab.view.controls.tools import DRAWING, remove_selected
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window import changing
from physicslab.view.window.materials import choose_colour, choose_layer, choose_material, made_of, materials
from physicslab.view.window.window import Window
from physicslab.world import World

_LAYERS = 4
_SPEEDS = (0.5, 1.0, 2.0, 5.0)
"""Speeds of motors to choose from [rad/s, m/s]."""
_LIMITS, _STRENGTHS = (15.0, 45.0, 90.0), (1.5, 3.0)
"""Angles [deg], and how many times its present force a joint may bear."""
_PUT_DOWN = ("wall", "dominoes", "brush", "stack", "pyramid")
_POPUP = "context"


def build_context(ui: Ui, world: World, window: Window) -> None:
    """Build the menu, if one is open."""
    context = window.context
    if context is None:
        return
    if not context.is_shown:
        imgui.open_popup(_POPUP)
        context.is_shown = True
    imgui.set_next_window_pos(ImVec2(*context.pixel), imgui.Cond_.appearing)
    if not imgui.begin_popup(_POPUP):
        window.context = None
        return
    if context.entity is None:
        _of_space(ui, window, context.pixel)
    elif all(map(world.entities().__contains__, window.selection.entities)):
        chosen = window.selection.entities
        ui.faint(world.label(chosen[0]) if len(chosen) == 1 else f"{len(chosen)} selected", wrapped=False)
        ui.rule()
        if context.is_body:
            _of_bodies(ui, world, window)
        elif len(chosen) == 1:
            _of_joint(ui, world, chosen[0])
        ui.item("Remove it", remove_selected, shown="Remove", keys="Del")
    imgui.end_popup()


def _of_bodies(ui: Ui, world: World, window: Window) -> None:
    chosen = window.selection.entities
    if all(world.has(entity, Velocity) for entity in chosen):
        ui.item("Hold it", changing.take, chosen, Velocity, shown="Hold where it is", tip="It cannot move")
        ui.item("Glue to the world", _glue, chosen, tip="A weld: its force and torque are measured")
    else:
        ui.item("Let it move", changing.give, chosen, lambda entity: Velocity())
    joints = attachments(world, chosen)
    if joints:
        with ui.menu("Join" if len(chosen) > 1 else "Hang, pin") as shown:
            for label, (tip, action) in (joints if shown else {}).items():
                ui.item(label, action, tip=tip)
    with ui.menu("Material") as shown:
        for name in materials(world) if shown else ():
            if name is not None:
                on = {made_of(world, entity) for entity in chosen} == {name}
                tip = SUBSTANCES[name].source if name in SUBSTANCES else "Density, e and μ as they are"
                ui.item(f"of {name}", choose_material, chosen, name, shown=name.capitalize(), on=on, tip=tip)
    with ui.menu("Colour") as shown:
        for name, colour in (COLOURS if shown else {}).items():
            red, green, blue = (part / 255.0 for part in rgb_of(colour))
            imgui.color_button(f"##{name}", ImVec4(red, green, blue, 1.0), 0, ImVec2(ui.size, ui.size))
            imgui.same_line()
            ui.item(name, choose_colour, chosen, colour)
        if shown and any(world.has(entity, Colour) for entity in chosen):
            ui.item("By its number", choose_colour, chosen, None)
    with ui.menu("Layer") as shown:
        if shown:
            _build_layers(ui, chosen)
    ui.rule()
    ui.item("Plot it", plot_selected, shown="Plot", keys="M")
    ui.item("Copy", copies.copy_selected, keys="Ctrl+C")
    ui.item("Duplicate it", copies.duplicate_selected, shown="Duplicate", keys="Ctrl+D")
    ui.item("Copies ...", copies.begin_copies, tip="In a row, in a grid, around a circle")
    ui.rule()


def _of_joint(ui: Ui, world: World, entity: int) -> None:
    """Build the motor, the limits and the strength of a joint, as far as it has them."""
    kind = next((kind for kind in KINDS if world.has(entity, kind)), None)
    if kind is not None or world.has(entity, Spring):
        ui.item("Plot its force", plot_selected, keys="M", tip="Against time, in a graph")
    if kind is None:
        return
    joint, name = world.component(entity, kind), kind.__name__
    fields = {spec.name: spec for spec in kind.FIELDS}
    if "motor_speed" in fields:
        unit = fields["motor_speed"].unit
        now = joint.motor_speed if joint.is_given("motor_speed") else None
        with ui.menu("Motor") as shown:
            for speed in (None, *_SPEEDS) if shown else ():
                words = "Off" if speed is None else f"{speed:g} {unit}"
                ui.item(
                    f"Motor: {words}", _set, entity, name, {"motor_speed": speed}, shown=words,
                    on=now == speed,
                )  # fmt: skip
            if shown and now:
                ui.item("Motor: back", _set, entity, name, {"motor_speed": -now}, shown="The other way round")
    if kind is Pin:
        with ui.menu("Limits") as shown:
            for degrees in (None, *_LIMITS) if shown else ():
                words = "None" if degrees is None else f"{degrees:g}° to either side of here"
                ui.item(f"Limits: {words}", _limit, entity, degrees, shown=words)
    if "breaks" in fields:
        force = next((one.force.magnitude for one in joint_states(world) if one.entity == entity), 0.0)
        with ui.menu("Breaks") as shown:
            ways = {"Never": None} | {
                f"At {n:g} times its force now": n * force for n in _STRENGTHS if force > 0.0
            }
            for words, most in (ways if shown else {}).items():
                tip = "" if most is None else quantity(most, "N")
                ui.item(f"Breaks: {words}", _set, entity, name, {"breaks": most}, shown=words, tip=tip)
    ui.rule()


def _set(world: World, window: Window, entity: int, kind: str, fields: Mapping[str, float | None]) -> None:
    """Give fields of a joint other values, or none, as one edit."""
    window.edits.do_all([SetField(entity, kind, field, value) for field, value in fields.items()])


def _limit(world: World, window: Window, entity: int, degrees: float | None) -> None:
    """Let a pin turn so far to either side of where it is; ``None`` lets it turn all round."""
    pin = world.component(entity, Pin)
    changes = [SetField(entity, "Pin", field, None) for field in ("lower", "upper")]
    if degrees is not None:
        first = pin.a or (entity if world.has(entity, Transform) else None)
        angle_a, angle_b = (
            0.0 if end is None else world.component(end, Transform).angle for end in (first, pin.b)
        )
        turned, most = angle_b - angle_a, math.radians(degrees)
        changes.append(SetField(entity, "Pin", "lower", turned - most))
        changes.append(SetField(entity, "Pin", "upper", turned + most))
    window.edits.do_all(changes, "limits of a pin")


def _build_layers(ui: Ui, chosen: tuple[int, ...]) -> None:
    ui.item("Touches all", choose_layer, chosen, None, tip="In no layer")
    for n in range(1, _LAYERS + 1):
        tip = "It touches bodies of this layer, and those in none"
        ui.item(f"Layer {n}", choose_layer, chosen, Layer(n), tip=tip)
    tip = "It passes through all bodies; the walls of the world hold it"
    ui.item("Touches no body", choose_layer, chosen, Layer(1, NONE), tip=tip)


def _glue(world: World, window: Window, entities: tuple[int, ...]) -> None:
    """Weld bodies to the world, each where it is."""
    changing.give(world, window, entities, partial(_weld, world))


def _weld(world: World, entity: int) -> Weld:
    return next(make for words, make in changing.makers(world, Weld))(entity)  # type: ignore[return-value]


def _click(world: World, window: Window, drawn: Drawn, pixel: tuple[float, float]) -> None:
    """Make something where the menu was opened."""
    window.pointer = pixel
    click(world, window, drawn)


def _paste(world: World, window: Window, pixel: tuple[float, float]) -> None:
    window.pointer = pixel
    copies.paste(world, window)


def _of_space(ui: Ui, window: Window, pixel: tuple[float, float]) -> None:
    if window.copied:
        ui.item("Paste here", _paste, pixel, shown="Paste", keys="Ctrl+V")
        ui.rule()
    for drawn in BODIES:
        if drawn.by_click and not drawn.is_open:
            ui.item(f"{drawn.title} here", _click, drawn, pixel)
    ui.rule()
    for drawn in GROUPS:
        if drawn.name in _PUT_DOWN:
            tool = DRAWING[drawn.name]
            shown = Sentence("{thing} ...", thing=Sentence(drawn.title))
            ui.item(shown, choose_tool, tool, shown=shown, tip=tool.usage)
    ui.rule()
    ui.item("Select everything", select_all, shown="Select all", keys="Ctrl+A")
