"""What follows from the fields of an entity: it is shown and cannot be changed."""

from __future__ import annotations

import math

import numpy as np

from physicslab.components import Mass, Spring, Velocity
from physicslab.diagnostics.period import SpringState, period_of, spring_state
from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.quantities import quantity, vector_quantity
from physicslab.view.toolkit.ui import Ui
from physicslab.view.window.measured import Measured
from physicslab.world import World

__all__ = ["build_derived", "build_forces"]

_AT_REST = 1e-10
"""A speed [m/s], [rad/s] below this is rounding, and shown as none."""
_ROUNDING = 1e-9
"""A sum of forces below this share of the largest is none."""


def build_derived(ui: Ui, world: World, entity: int, *, is_brief: bool) -> None:
    """Write the speed, momentum, energies and period of a body, or what a spring does.

    Where it is brief, parts are left out.
    """
    if world.has(entity, Spring):
        _build_spring(ui, spring_state(world, entity))
    if world.has(entity, Velocity):
        _build_motion(ui, world, entity, is_brief=is_brief)
    period = period_of(world, entity)
    if period is not None:
        ui.row("Period", quantity(period.seconds, "s"), period.law)


def _build_motion(ui: Ui, world: World, entity: int, *, is_brief: bool) -> None:
    velocity = world.component(entity, Velocity)
    linear = velocity.linear if velocity.linear.magnitude > _AT_REST else Vector2()
    angular = velocity.angular if abs(velocity.angular) > _AT_REST else 0.0
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
    energy = 0.5 * mass.mass * speed**2
    inverse = float(world.bodies.inverse_inertia[row])
    spin = 0.5 * angular**2 / inverse if inverse > 0.0 else 0.0
    ui.row("Kinetic energy", quantity(energy + spin, "J"))
    if spin and np.isfinite(spin) and not is_brief:
        ui.row("of turning", quantity(spin, "J"), lesser=True)


def _build_spring(ui: Ui, state: SpringState | None) -> None:
    if state is None:
        return
    ui.gap(0.2)
    ui.rule()
    ui.row("Length", quantity(state.length, "m"))
    ui.row("Longer by", quantity(state.extension, "m"), "than at rest; negative where it is shorter")
    pulls = "pulls its ends together" if state.force >= 0.0 else "pushes its ends apart"
    ui.row("Spring force", quantity(abs(state.force), "N"), pulls)
    ui.row("Energy stored", quantity(state.energy, "J"))


def build_forces(ui: Ui, measured: Measured) -> None:
    """Write the forces on a body, and their sum: those that the free-body diagram (V) draws."""
    if not measured.forces:
        return
    ui.gap(0.2)
    ui.rule()
    ui.faint("Forces on it")
    for one in measured.forces:
        ui.row(one.name.capitalize(), quantity(one.force.magnitude, "N"), vector_quantity(one.force, "N"))
    total, largest = measured.net, max(one.force.magnitude for one in measured.forces)
    net = total.magnitude if total.magnitude > _ROUNDING * largest else 0.0
    ui.row("Sum", quantity(net, "N"), vector_quantity(total, "N"))
