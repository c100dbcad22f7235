"""The list of near pairs: taken over from a search, with the record of each pair."""

import numpy as np
from numpy.typing import NDArray

from physicslab.contacts import wide
from physicslab.contacts.arguments import shapes_of
from physicslab.kernels.broad import near_pairs
from physicslab.kernels.records import MANIFOLD, POINT
from physicslab.kernels.wide import slots
from physicslab.state.state import State


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
    count, contacts.proximity_count = near_pairs.partition(
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
        room = needed + needed // 4  # a record takes 400 bytes, and there are two sets of them
        contacts.spare_manifolds, contacts.spare_points = np.zeros(room, MANIFOLD), np.zeros(2 * room, POINT)
    near_pairs.carry_over(
        pairs, count, entities, contacts.manifolds, contacts.points, contacts.recorded, contacts.table, noted,
        contacts.spare_manifolds, contacts.spare_points,
    )  # fmt: skip
    contacts.manifolds, contacts.spare_manifolds = contacts.spare_manifolds, contacts.manifolds
    contacts.points, contacts.spare_points = contacts.spare_points, contacts.points
    contacts.recorded, contacts.active, contacts.stale = count, 0, False
    if len(contacts.touching) < needed:
        contacts.touching, contacts.scalar, contacts.sleeping = np.zeros((3, needed + needed // 4), np.int64)
    if contacts.restoring:
        wide.fill_again(state)
    elif contacts.wide.filled:
        contacts.wide.filled = sum(
            slots.follow_pairs(constraints.slots, constraints.count, contacts.manifolds, count)
            for constraints in contacts.wide.kinds
        )
    contacts.list_scalar(len(entities))
