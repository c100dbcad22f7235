"""Values derived from the fields of an entity: they are shown and cannot be changed."""

from __future__ import annotations

import math

import numpy as np

from physicslab.components import Mass, Spring, Velocity
from physicslab.diagnostics.free_body import LastStep
from physicslab.diagnostics.period import SpringState, gives_way, period_of, spring_state
from physicslab.diagnostics.scales import scales_of
from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.quantities import quantity, vector_quantity, without_rounding
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.measured import Measured
from physicslab.world import World

__all__ = ["build_derived", "build_forces", "build_pairs"]

_ROUNDING = 1e-9
"""A sum of forces below this share of the largest is treated as zero."""


def build_derived(ui: Ui, world: World, entity: int, *, is_brief: bool) -> None:
    """Write the speed, momentum, energies and period of a body, or the state of a spring.

    Parts are left out if ``is_brief``.
    """
    if world.has(entity, Spring):
        _build_spring(ui, spring_state(world, entity))
        give = gives_way(world, entity)
        if give is not None:
            tip = "This rod is a stiff spring: weight lengthens it by this much, a wide swing by more"
            ui.row("Gives way", quantity(1e3 * give, "mm"), tip)
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
    ui.gap(0.2)
    ui.rule()
    speed = linear.magnitude
    ui.row("Speed", quantity(speed, "m/s"))
    if speed > 0.0 and not is_brief:
        ui.row("Direction", f"{math.degrees(linear.angle):.1f}°", "counter-clockwise from the right")
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
    ui.gap(0.2)
    ui.rule()
    ui.row("Length", quantity(state.length, "m"))
    ui.row(
        "Longer by",
        quantity(without_rounding(state.extension, state.length), "m"),
        "than at rest; negative if it is shorter",
    )
    pulls = "pulls its ends together" if state.force >= 0.0 else "pushes its ends apart"
    ui.row("Spring force", quantity(abs(state.force), "N"), pulls)
    ui.row("Energy stored", quantity(state.energy, "J"))


def build_forces(ui: Ui, measured: Measured, *, is_brief: bool) -> None:
    """Write the forces on a body and their sum, beside its mass times its acceleration; then the impulses.

    The forces are those that the free-body diagram (V) draws. Where it is brief, impulses are left out.
    """
    step = measured.step
    if not measured.forces and step is None:
        return
    ui.gap(0.2)
    ui.rule()
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
            ui.faint(f"With {other}: mu = {friction:.4g}, e = {restitution:.4g}")
            ui.tip("For this pair mu is the root of both frictions multiplied, e the smaller restitution")


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
    shown = value.magnitude if value.magnitude > _ROUNDING * largest else 0.0
    words = f"{tip}: {vector_quantity(value, unit)}" if tip else vector_quantity(value, unit)
    ui.row(label, quantity(shown, unit), words)
