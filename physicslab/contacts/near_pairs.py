"""The list of near pairs, with their records carried over, and those of them that are solved in slots."""

import mmap
import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Material
from physicslab.contacts.arguments import inverse_in, materials_of, motion_of, near_in, shapes_of
from physicslab.kernels import direct_entry
from physicslab.kernels.broad import near_pairs
from physicslab.kernels.near_counts import FOLLOWED
from physicslab.kernels.records import MANIFOLD, POINT
from physicslab.kernels.wide import graph_colour, restore_slots, slots
from physicslab.kernels.wide.graph_colour import MIN_WIDE
from physicslab.kernels.wide.slots import COLOURS
from physicslab.kernels.wide_layout import WIDE
from physicslab.state.state import State

_RECORDS, _BODIES = 5, 10_000
"""Records a body, of so many bodies at most, for which there is room at first, in each of two sets. Memory
that is not touched takes none; to grow is to touch all of it again, which takes as long as a step or two."""


def partition(
    state: State, couples: NDArray[np.uint32], found: int, pairs: NDArray[np.int64], walls: int,
    fat: NDArray[np.float64],
) -> None:  # fmt: skip
    """Take a new list of near pairs: ``found`` of bodies, in no order, and ``walls`` of the bounds.

    Pairs without a record get none until they come near. ``fat`` (8, rows) is what the broad phase keeps of
    each body's fat box.
    """
    contacts = state.contacts
    _make_table(state)
    if len(contacts.activation_distance) < found:
        contacts.proximity = np.zeros(4 * found, np.uint32)
        contacts.activation_distance = np.zeros(2 * found)
    count, contacts.proximity_count = direct_entry(near_pairs.partition)(
        couples, found, pairs, walls, shapes_of(state), fat, state.bodies.inverse_mass,
        state.entity_index.entities, contacts.manifolds, contacts.recorded, contacts.stale, contacts.table,
        contacts.proximity, contacts.activation_distance,
    )  # fmt: skip
    _relist(state, pairs, count, noted=True)


def list_all(state: State, pairs: NDArray[np.int64], count: int) -> None:
    """Take a new sorted list of ``count`` near pairs (a, b, wall), each with its record.

    Pairs listed before stay as they are. Which pairs touch is found afterwards.
    """
    _make_table(state)
    state.contacts.proximity_count = 0
    _relist(state, pairs, count, noted=False)


def _zeros(count: int, record: np.dtype[Any]) -> NDArray[Any]:
    """Return zeros (count,), no page of which is touched before it is used, as numpy's may be."""
    own = {} if sys.platform == "win32" else {"flags": mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS}  # after a fork
    return np.frombuffer(mmap.mmap(-1, count * record.itemsize, **own), record)


def _make_table(state: State) -> None:
    """Make room to look up every record."""
    contacts = state.contacts
    if len(contacts.table) < 4 * contacts.recorded:
        contacts.table = np.zeros(8 * contacts.recorded, np.int64)


def _relist(state: State, pairs: NDArray[np.int64], count: int, *, noted: bool) -> None:
    contacts, entities = state.contacts, state.entity_index.entities
    if contacts.stale:
        contacts.sync()
        # Rows may have changed: contacts that had a slot get it again.
        contacts.restoring |= contacts.wide.filled > 0
        contacts.wide.reset(len(entities))
    needed = count + contacts.proximity_count
    if len(contacts.spare_manifolds) < needed:
        room = max(2 * needed, _RECORDS * min(len(entities), _BODIES))
        contacts.spare_manifolds, contacts.spare_points = _zeros(room, MANIFOLD), _zeros(2 * room, POINT)
    direct_entry(near_pairs.carry_over)(
        pairs, count, entities, contacts.manifolds, contacts.points, contacts.recorded, contacts.table, noted,
        contacts.spare_manifolds, contacts.spare_points,
    )  # fmt: skip
    contacts.manifolds, contacts.spare_manifolds = contacts.spare_manifolds, contacts.manifolds
    contacts.points, contacts.spare_points = contacts.spare_points, contacts.points
    contacts.recorded, contacts.active, contacts.stale = count, 0, False
    contacts.replaced += 1
    contacts.counts[FOLLOWED] = 0  # records have other numbers
    if len(contacts.touching) < needed:
        room = len(contacts.manifolds)
        contacts.touching, contacts.scalar, contacts.sleeping = np.zeros((3, room), np.int64)
    if contacts.restoring:
        fill_again(state)
    elif contacts.wide.filled:
        contacts.wide.filled = sum(
            slots.follow_pairs(constraints.slots, constraints.count, contacts.manifolds, count)
            for constraints in contacts.wide.kinds
        )
    contacts.list_scalar(len(entities))


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
            motion_of(state), shapes_of(state), materials_of(state), inverse_in(state), h, state.substeps,
        )  # fmt: skip
        if came != graph_colour.FULL:
            break
        for constraints in wide.kinds:
            constraints.make_room(constraints.count + contacts.active // WIDE + COLOURS)
        contacts.replaced += 1
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
        _find_reshaped_again(state)
        wide.reset(rows)
        fill_again(state)
        contacts.list_scalar(rows)


def _find_reshaped_again(state: State) -> None:
    """Let the points be found again of bodies whose outline was edited."""
    wide, near = state.contacts.wide, state.contacts.manifolds[: state.contacts.recorded]
    outlines = np.stack(_columns(state)[4:], axis=1)
    if len(wide.made_of) == len(outlines):
        reshaped = (wide.made_of[:, 4:] != outlines).any(axis=1)
        found_again = reshaped[near["a"]] | reshaped[near["b"]]
        near["found"][found_again], near["slot"][found_again] = 0, -1


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


def _columns(state: State) -> tuple[NDArray[Any], ...]:
    material, bodies, shapes = state.table(Material), state.bodies, state.bodies.shapes
    return (
        bodies.inverse_mass, bodies.inverse_inertia, material["restitution"], material["friction"],
        shapes.half_x, shapes.half_y, shapes.radius, shapes.first,
    )  # fmt: skip
