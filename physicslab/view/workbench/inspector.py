"""The selection, in numbers that can be changed, and in values derived from them."""

from collections.abc import Sequence
from functools import partial

import numpy as np
from imgui_bundle import imgui

from physicslab.components import Held, MadeOf, Mass, Material, Name, Shape, Spring, Transform, Velocity
from physicslab.components.made_of import SUBSTANCES
from physicslab.components.material import friction_of_pair, restitution_of_pair
from physicslab.components.name import why_no_id
from physicslab.diagnostics.free_body import LastStep
from physicslab.diagnostics.joints import JointState, joint_states
from physicslab.diagnostics.period import SpringState, gives_way, period_of, spring_state
from physicslab.diagnostics.scales import scales_of
from physicslab.ecs.component import COMPONENTS, Component
from physicslab.ecs.fields import Field, InvalidValue
from physicslab.ecs.vector import Vector2
from physicslab.languages.sentence import Sentence
from physicslab.view.canvas.quantities import quantity, vector_quantity, without_rounding
from physicslab.view.controls.copies import duplicate_selected
from physicslab.view.controls.dashboard_actions import plot_selected
from physicslab.view.controls.joining import attachments
from physicslab.view.controls.tools import remove_selected
from physicslab.view.overlay.forces import Measured
from physicslab.view.overlay.instruments import readings_of
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window import changing
from physicslab.view.window.materials import UNSPECIFIED, choose_material, made_of, materials
from physicslab.view.window.window import Window
from physicslab.view.workbench.component_rows import ORDER, ComponentRows
from physicslab.view.workbench.number_field import NumberFields
from physicslab.view.workbench.trust_badge import build_body_digits
from physicslab.world import World

# ---- derived values: they are shown and cannot be changed --------------------------------------------------


_ZERO_FORCE_SHARE = 1e-9
"""A sum of forces below this share of the largest is treated as zero."""


def build_derived(ui: Ui, world: World, entity: int, *, is_brief: bool) -> None:
    """Write the speed, momentum, energies and period of a body, or the state of a spring.

    Parts are left out if ``is_brief``.
    """
    if world.has(entity, Spring):
        _build_spring(ui, spring_state(world, entity))
        give = gives_way(world, entity)
        if give is not None:
            tip = "The weight of what hangs from it lengthens it by this much, a wide swing by more"
            ui.row("Gives way", quantity(give, "m"), tip)
    for joint in joint_states(world):
        if joint.entity == entity:
            _build_joint(ui, joint)
    if world.has(entity, Velocity):
        _build_motion(ui, world, entity, is_brief=is_brief)
    period = period_of(world, entity)
    if period is not None:
        ui.row("Period", quantity(period.seconds, "s"), period.law)


def _build_motion(ui: Ui, world: World, entity: int, *, is_brief: bool) -> None:
    velocity = world.component(entity, Velocity)
    scales = scales_of(world)
    linear = velocity.linear if without_rounding(velocity.linear.magnitude, scales["m/s"]) else Vector2()
    angular = without_rounding(velocity.angular, scales["rad/s"])
    ui.rule(0.2)
    speed = linear.magnitude
    if not world.has(entity, Mass):
        return
    mass = world.component(entity, Mass)
    row = world.entity_index.row_of[entity]
    ui.row("Momentum", quantity(mass.mass * speed, "kg m/s"))
    if not is_brief:
        ui.row("as a vector", vector_quantity(mass.mass * linear, "kg m/s"), lesser=True)
    energy = without_rounding(0.5 * mass.mass * speed**2, scales["J"])
    inverse = float(world.bodies.inverse_inertia[row])
    spin = without_rounding(0.5 * angular**2 / inverse, scales["J"]) if inverse > 0.0 else 0.0
    ui.row("Kinetic energy", quantity(energy + spin, "J"))
    if spin and np.isfinite(spin) and not is_brief:
        ui.row("of turning", quantity(spin, "J"), lesser=True)


def _build_spring(ui: Ui, state: SpringState | None) -> None:
    if state is None:
        return
    ui.rule(0.2)
    ui.row("Length", quantity(state.length, "m"))
    longer = quantity(without_rounding(state.extension, state.length), "m")
    ui.row("Longer by", longer, "than at rest; negative if it is shorter")
    pulls = "pulls its ends together" if state.force >= 0.0 else "pushes its ends apart"
    ui.row("Spring force", quantity(abs(state.force), "N"), pulls)
    ui.row("Energy stored", quantity(state.energy, "J"))


def _build_joint(ui: Ui, joint: JointState) -> None:
    ui.rule(0.2)
    name = joint.kind.__name__
    if joint.has_force:
        ui.row(f"{name} force", quantity(joint.force.magnitude, "N"), vector_quantity(joint.force, "N"))
    if joint.has_torque:
        ui.row(f"{name} torque", quantity(joint.torque, "N m"))
    tip = "How far lengths and places are from what it holds: the error of the method"
    ui.row("Stretch left", quantity(without_rounding(joint.stretch, 1.0), "m"), tip)


def build_forces(ui: Ui, measured: Measured, *, is_brief: bool) -> None:
    """Write the forces on a body and their sum, beside its mass times its acceleration; then the impulses.

    The forces are those that the free-body diagram (V) draws. Where it is brief, impulses are left out.
    """
    step = measured.step
    if not measured.forces and step is None:
        return
    ui.rule(0.2)
    ui.faint("Forces on it")
    for one in measured.forces:
        ui.row(one.name.capitalize(), quantity(one.force.magnitude, "N"), vector_quantity(one.force, "N"))
    total = measured.net
    largest = max((one.force.magnitude for one in measured.forces), default=0.0)
    _vector_row(ui, "Sum", total, largest, "N", "The sum of all forces")
    if step is None:
        return
    largest = max(largest, step.inertia.magnitude)
    tip = "Mass times mean acceleration in the last step, without impacts"
    _vector_row(ui, "m a", step.inertia, largest, "N", tip)
    tip = "The sum is of now, the acceleration of the last step"
    _vector_row(ui, "Difference", total - step.inertia, largest, "N", tip)
    if not is_brief:
        _build_impulses(ui, step)


def build_pairs(ui: Ui, measured: Measured) -> None:
    """Write the friction and the restitution of each pair of surfaces that a body is one of."""
    for one in measured.forces:
        if one.pair is not None:
            other, friction, restitution = one.pair
            mu, e = f"{friction:.4g}", f"{restitution:.4g}"
            ui.faint(Sentence("With {body}: μ = {mu}, e = {e}", body=other, mu=mu, e=e))
            ui.tip("For this pair μ is the root of both frictions multiplied, e the smaller restitution")


def build_pair(ui: Ui, world: World, one: int, other: int) -> None:
    """Write the friction and the restitution of two bodies, if both have a surface."""
    if not all(world.has(entity, Material) for entity in (one, other)):
        return
    a, b = (world.component(entity, Material) for entity in (one, other))
    mu = friction_of_pair(a.friction, b.friction)
    e = restitution_of_pair(a.restitution, b.restitution)
    ui.rule(0.2)
    ui.row("μ of the pair", f"{mu:.4g}", "The root of both frictions multiplied")
    ui.row("e of the pair", f"{e:.4g}", "The smaller restitution")


def _build_impulses(ui: Ui, step: LastStep) -> None:
    """Write the impulses of the last step, their sum, and the change of momentum."""
    ui.gap(0.2)
    ui.faint(f"Impulses in the last step, of {quantity(step.dt, 's')}")
    parts = step.impulses
    largest = max((impulse.magnitude for impulse in parts.values()), default=0.0)
    largest = max(largest, step.change.magnitude)
    for name, impulse in parts.items():
        _vector_row(ui, name.capitalize(), impulse, largest, "N s", "")
    _vector_row(ui, "Sum of impulses", sum(parts.values(), Vector2()), largest, "N s", "All of the above")
    _vector_row(ui, "Change of momentum", step.change, largest, "kg m/s", "From before the step to after it")
    tip = "The difference: forces of contacts and springs are not the same all through a step"
    _vector_row(ui, "Not accounted for", step.difference, largest, "N s", tip)


def _vector_row(ui: Ui, label: str, value: Vector2, largest: float, unit: str, tip: str) -> None:
    """Write how large a vector is; rounding beside the ``largest`` is treated as zero."""
    shown = value.magnitude if value.magnitude > _ZERO_FORCE_SHARE * largest else 0.0
    words = f"{tip}: {vector_quantity(value, unit)}" if tip else vector_quantity(value, unit)
    ui.row(label, quantity(shown, unit), words)


# ---- the panel ---------------------------------------------------------------------------------------------


_LABELS = 0.36
"""Share of the panel's width that labels take."""
_SECOND_COLUMN = 0.52
"""The begin of the second column of boxes to tick, as a share of the panel's width."""
_NAME = Field("id", "text", owner="Name", meaning="its name; without one it is called by its kind")
_MADE_OF = Field("made of", "choice", meaning="sets density, restitution, friction and colour")
_SWITCHES = (
    ("Velocity", "Can move", "Without it the body is fixed"),
    ("Mass", "Has mass", "A body that can move and has none is infinitely heavy"),
    ("Drag", "Air resistance", "A force against its motion"),
    ("Trail", "Leaves a trail", "Shows where it was"),
    ("Strobe", "Strobe pictures", "Its outline every 0.1 s stays in the picture"),
)
"""Components that are one click away; all others are in a list."""


def build_inspector(ui: Ui, numbers: NumberFields, world: World, window: Window) -> None:
    """Build the rows of the selection. One body: all its fields; several: what they have in common."""
    chosen, is_brief = window.selection.entities, window.level == "Explore"
    world.synchronise()
    first, is_one = chosen[-1], len(chosen) == 1
    numbers.share, numbers.selected = _LABELS, len(chosen)
    ui.heading(world.label(first) if is_one else f"{len(chosen)} selected")
    words = _kind(world, first) if is_one else "One number for all, or one for each from left to right: 1; 2"
    ui.same_line_if_room(words)
    ui.faint(words)
    if is_one:
        _build_name(ui, numbers, world, window, first)
    kinds = [type(part) for part in world.components(first) if isinstance(part, Component)]
    kinds = [kind for kind in kinds if kind is not Held and _all_have(world, chosen, kind)]
    rows = ComponentRows(ui, numbers, world, window)
    if is_one:
        rows.build_hanging(first)
        rows.build_slope(first)
    for kind in sorted(kinds, key=lambda kind: ORDER.get(kind, len(ORDER))):
        if kind is MadeOf:
            continue
        rows.build(kind)
        if kind is Velocity and is_one:
            rows.build_throw(first)
        if kind is Shape:
            _build_material(ui, numbers, world, window)
    if is_one:
        for label, value in readings_of(world, first):
            ui.row(label, value)
        build_derived(ui, world, first, is_brief=is_brief)
        build_body_digits(ui, world, window, first)
        if not is_brief or window.overlays.arrows:
            build_forces(ui, window.measured, is_brief=window.level != "Engineer")
        build_pairs(ui, window.measured)
    elif len(chosen) == 2:
        build_pair(ui, world, *chosen)
    _build_components(ui, world, window)
    _build_buttons(ui, world, window)


def _all_have(world: World, entities: Sequence[int], kind: type[Component]) -> bool:
    """Whether each of some entities has a component."""
    rows = world.entity_index.rows_of(np.array(entities, np.int64))
    return bool(world.table(kind).present[rows].all())


def _differing(world: World, entities: Sequence[int], kind: type[Component], field: str) -> list[int]:
    """Return one of some entities for each value of a field that is among them, or for none."""
    rows = world.entity_index.rows_of(np.array(entities, np.int64))
    return [entities[n] for n in np.unique(world.table(kind)[field][rows], return_index=True)[1]]


def _build_name(ui: Ui, numbers: NumberFields, world: World, window: Window, entity: int) -> None:
    """Build the row of a name."""

    def commit(name: str) -> None:
        if name:
            _check_name(world, entity, name)
        window.do_first(changing.name_entity, entity, name)

    held = world.component(entity, Name).id if world.has(entity, Name) else ""
    numbers.row(ui, "Name", "Name", _NAME, held, commit)


def _build_material(ui: Ui, numbers: NumberFields, world: World, window: Window) -> None:
    """Build the list of materials, and the name of one of one's own."""
    chosen = window.selection.entities
    names = {made_of(world, entity) for entity in _differing(world, chosen, MadeOf, "material")}
    now = names.pop() if len(names) == 1 else None
    numbers.label(ui, "MadeOf", "Made of", _MADE_OF)
    picked = ui.choice("MadeOf", now, lambda: materials(world), shown=now or UNSPECIFIED)
    if now in SUBSTANCES:
        ui.tip(SUBSTANCES[now].source)
    if picked != now and picked is not None:
        window.do_first(choose_material, chosen, picked)
    elif picked != now:
        window.do_first(changing.take, chosen, MadeOf)
    if now is not None and now not in SUBSTANCES:
        numbers.row(
            ui, "MadeOf.material", "called", MadeOf.FIELDS[0], now,
            lambda name: window.do_first(choose_material, chosen, MadeOf(name).material),
        )  # fmt: skip


def _build_components(ui: Ui, world: World, window: Window) -> None:
    """Build what components can be added, and which can be taken away."""
    chosen = window.selection.entities
    if not _all_have(world, chosen, Transform):
        return
    ui.rule(0.2)
    width = imgui.get_content_region_avail().x
    for n, (name, words, tip) in enumerate(_SWITCHES):
        if n % 2 and _SECOND_COLUMN * width + ui.checkbox_width(words) <= width:
            imgui.same_line(_SECOND_COLUMN * width + imgui.get_style().window_padding.x)
        kind = COMPONENTS[name]
        on = _all_have(world, chosen, kind)
        if ui.checkbox(words, on, tip):
            if on:
                window.do_next(changing.take, chosen, kind)
            else:
                window.do_next(changing.give, chosen, partial(_made, kind))
    with ui.list("Add ...", "Properties that can be added") as shown:
        for words, (meaning, make) in (changing.addable(world, chosen) if shown else {}).items():
            ui.item(f"add {words}", changing.give, chosen, make, tip=meaning, shown=f"{words}: {meaning}")
    imgui.same_line()
    with ui.list("Take away ...", "Properties that it has") as shown:
        for words, (meaning, kind) in (changing.removable(world, chosen) if shown else {}).items():
            ui.item(f"no {words}", changing.take, chosen, kind, tip=meaning, shown=f"{words}: {meaning}")
    ui.same_line_if_room("Plot")
    ui.button("Plot", "Its speed and position against time", plot_selected)


def _build_buttons(ui: Ui, world: World, window: Window) -> None:
    ui.gap(0.2)
    joints = attachments(world, window.selection.entities)
    if joints:
        words = "Join ..." if len(window.selection.entities) > 1 else "Hang, pin ..."
        with ui.list(words, "Rods, ropes, springs, pins, motors, welds") as shown:
            for label, (tip, action) in (joints if shown else {}).items():
                ui.item(label, action, tip=tip)
        ui.same_line_if_room("Duplicate")
    buttons = {
        "Duplicate": ("A copy beside it (Ctrl+D)", duplicate_selected),
        "Delete": ("Remove the selection (Del)", remove_selected),
        "Done": ("Select nothing (Esc)", lambda _, window: window.selection.clear()),
    }
    for n, (words, (tip, action)) in enumerate(buttons.items()):
        if n:
            ui.same_line_if_room(words)
        ui.button(words, tip, action)


def _made(kind: type[Component], entity: int) -> Component:
    return kind()


def _check_name(world: World, entity: int, name: str) -> None:
    """Raise ``InvalidValue`` for a name that an entity cannot have."""
    allowed = why_no_id(name)
    if allowed is None:
        try:
            other = world.entity(name)
        except KeyError:
            return
        if other == entity:
            return
        allowed = "a unique name: another entity has this one"
    raise InvalidValue("Name", "id", name, allowed)


def _kind(world: World, entity: int) -> str:
    """Return what an entity is, in words."""
    if world.has(entity, Shape):
        shape = Sentence(world.component(entity, Shape).kind)
    elif world.has(entity, Transform):
        shape = Sentence("point")
    else:
        kinds = [type(part) for part in world.components(entity) if isinstance(part, Component)]
        return changing.plain_kind(kinds[0]).lower() if kinds else "nothing that is seen"
    if not world.has(entity, Velocity):
        return Sentence("{shape}, stays where it is", shape=shape)
    if world.has(entity, Mass):
        return Sentence("{shape}, moves", shape=shape)
    return Sentence("{shape}, moves as it was set, infinitely heavy", shape=shape)
