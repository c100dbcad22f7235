"""Wide contacts: put into blocks of eight, and kept up to date with masses and materials."""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Material
from physicslab.contacts.arguments import inverse_in, materials_of, motion_of, near_in, shapes_of
from physicslab.kernels.wide import graph_colour, restore_slots
from physicslab.kernels.wide.graph_colour import MIN_WIDE
from physicslab.kernels.wide.layout import WIDE
from physicslab.kernels.wide.slots import COLOURS
from physicslab.state.state import State


def add_constraints(state: State, h: float) -> None:
    """Put steady contacts into blocks."""
    contacts, wide = state.contacts, state.contacts.wide
    if not wide.filled and contacts.active < MIN_WIDE:
        return
    state.compile(wide.kernels)
    known = wide.filled > 0
    while True:
        came = graph_colour.add_constraints(
            near_in(state), contacts.opened, contacts.sleeping, contacts.inactive, state.sleep.asleep,
            motion_of(state), shapes_of(state), materials_of(state), inverse_in(state), h,
        )  # fmt: skip
        if came != graph_colour.FULL:
            break
        for constraints in wide.kinds:
            constraints.make_room(constraints.count + contacts.active // WIDE + COLOURS)
    if came == graph_colour.SPARSE:
        contacts.dissolve(len(state.entity_index))
    if wide.filled and not known:
        _remember(state)


def refill(state: State) -> None:
    """Update the masses, sizes and materials in slots, if one of them was changed."""
    contacts, wide = state.contacts, state.contacts.wide
    if not wide.filled:
        return
    found = restore_slots.outdated(wide.made_of, wide.changed, *_columns(state))
    if found == 1:
        bodies = state.bodies
        for constraints in wide.kinds:
            restore_slots.update_slots(
                constraints.slots, constraints.count, wide.changed, contacts.manifolds, contacts.points,
                shapes_of(state), materials_of(state), (bodies.inverse_mass, bodies.inverse_inertia),
            )  # fmt: skip
        _remember(state)
    elif found:
        rows = len(state.entity_index)
        contacts.sync()
        wide.reset(rows)
        fill_again(state)
        contacts.list_scalar(rows)


def fill_again(state: State) -> None:
    """Put the contacts whose records name a slot, as those of a file do, back into it."""
    contacts, bodies = state.contacts, state.bodies
    contacts.restoring = False
    near, asleep = contacts.manifolds[: contacts.recorded], state.sleep.asleep
    near["slot"][asleep[near["a"]] | asleep[near["b"]]] = -1  # sleeping contacts have none
    state.compile(contacts.wide.kernels)
    for constraints in contacts.wide.kinds:
        constraints.count, restored = restore_slots.restore_slots(
            constraints.slots, contacts.manifolds, contacts.points, contacts.recorded,
            shapes_of(state), materials_of(state), (bodies.inverse_mass, bodies.inverse_inertia),
        )  # fmt: skip
        constraints.sort()
        contacts.wide.filled += restored
    _remember(state)


def _remember(state: State) -> None:
    """Record the masses, sizes and materials that slots contain."""
    columns, wide = _columns(state), state.contacts.wide
    wide.made_of, wide.changed = (
        np.zeros((len(columns[0]), len(columns))),
        np.zeros(len(columns[0]), np.bool_),
    )
    restore_slots.remember(wide.made_of, *columns)


def _columns(state: State) -> tuple[NDArray[np.float64], ...]:
    material, bodies, shapes = state.table(Material), state.bodies, state.bodies.shapes
    return (
        bodies.inverse_mass, bodies.inverse_inertia, material["restitution"], material["friction"],
        shapes.half_x, shapes.half_y, shapes.radius,
    )  # fmt: skip
