"""The balance of a world before and after each step: what was booked between is what changed it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from physicslab.components import Held, Mass, Transform, Velocity
from physicslab.kernels import direct_entry, energy
from physicslab.state.account import Balance
from physicslab.state.state import State
from physicslab.systems.system import ForceSystem

__all__ = ["balance_of", "held_in", "motion_arguments"]


def held_in(state: State) -> tuple[int, ...]:
    """Return the entities that a hand holds."""
    return tuple(state.table(Held).handles)


def motion_arguments(state: State) -> tuple[Any, ...]:
    """Return what :func:`physicslab.kernels.energy.motion_totals` takes."""
    velocity, mass, transform = state.table(Velocity), state.table(Mass), state.table(Transform)
    return (
        transform["position"], velocity["linear"], velocity["angular"], mass["mass"], mass["inertia"],
        state.bodies.inverse_mass, state.bodies.inverse_inertia,
    )  # fmt: skip


def balance_of(
    state: State, forces: Sequence[ForceSystem], potential: dict[str, float] | None = None
) -> Balance:
    """Return energy and momentum as they are now; all rows and masses must be up to date.

    What each force stores [J] is added to ``potential`` by the force's name, where that is given.
    """
    kept = state.account.columns
    if kept[0] == state.entity_index.revision and kept[1][-2] is state.bodies.inverse_mass:
        found = direct_entry(energy.motion_totals)(*kept[1])
    else:
        state.compile((energy.motion_totals,))
        arguments = motion_arguments(state)
        found = energy.motion_totals(*arguments)
        state.account.columns = state.entity_index.revision, arguments
    translation, rotation, px, py, spin, mx, my = found
    total = translation + rotation
    for force in forces:
        if force.potential is None:
            continue
        g = force.uniform_acceleration(state) if force.is_engine else None
        stored = force.potential_energy(state) if g is None else -(g.x * mx + g.y * my)
        total += stored
        if potential is not None:
            potential[force.potential] = potential.get(force.potential, 0.0) + stored
    return Balance(total, px, py, spin)
