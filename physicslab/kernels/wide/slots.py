"""Which wide contact is in which slot of which block: filling, storing and emptying slots."""

import math

import numpy as np

from physicslab.kernels import Flags, Plain, Rows, allocating, allocating_kernel, inlined, kernel
from physicslab.kernels import wide_layout as L
from physicslab.kernels.arguments import Acting, Inverse, Motion, Near
from physicslab.kernels.constraint.pair import point_state, velocity_of
from physicslab.kernels.geometry.contact import AS_FOUND, follow_pose
from physicslab.kernels.near_counts import ACTIVE, DISC_BLOCKS, SCALAR
from physicslab.kernels.records import Manifolds, Points
from physicslab.kernels.wide.solve import slot_frame

COLOURS = 64
"""Largest number of blocks that may move one body; its further contacts stay scalar."""


@inlined
def clear_slot(slots: L.Slots, slot: int) -> None:
    """Clear a slot: it moves no body, and no check ever selects it."""
    rows = L.rows_of(slots.kind)
    k, place = slot // L.WIDE, slot % L.WIDE
    block = slots.data[k * rows : (k + 1) * rows]
    for row in range(0, rows, L.WIDE):
        block[row + place] = 0.0
    block[L.SIZE + place] = block[L.NORMAL_X + place] = block[L.ONE + L.SEPARATION + place] = 1.0
    if slots.kind == L.DISC:
        block[L.RADIUS_A + place] = block[L.RADIUS_B + place] = -0.5
    else:
        block[L.TWO + L.SEPARATION + place] = block[L.ONE + L.FOUND + place] = block[
            L.TWO + L.FOUND + place
        ] = 1.0
    slots.a[slot] = slots.b[slot] = 0
    slots.pair[slot] = -1


@inlined
def store_slot(slots: L.Slots, slot: int, manifolds: Manifolds, points: Points) -> None:
    """Write what the slot holds, impulses above all, into the records of its pair."""
    data, p = slots.data, slots.pair[slot]
    at = slot // L.WIDE * L.rows_of(slots.kind) + slot % L.WIDE
    manifold = manifolds[p]
    manifold.offset_x = manifold.offset_y = 0.0  # a slot has none: it would be as old as the contact
    for j in range(manifold.count):
        point = points[2 * p + j]
        base = at + (L.ONE if j == 0 else L.TWO)
        point.normal_impulse, point.tangent_impulse = data[base + L.IMPULSE], data[base + L.TANGENT_IMPULSE]
        point.separation = data[base + L.SEPARATION]
    if slots.kind == L.DISC:
        nx, ny, point = data[at + L.NORMAL_X], data[at + L.NORMAL_Y], points[2 * p]
        point.found_separation = point.separation
        manifold.normal_x, manifold.normal_y = nx, ny
        point.arm_ax, point.arm_ay = data[at + L.RADIUS_A] * nx, data[at + L.RADIUS_A] * ny
        point.arm_bx, point.arm_by = -data[at + L.RADIUS_B] * nx, -data[at + L.RADIUS_B] * ny
        point.normal_mass, point.tangent_mass = data[at + L.ONE + L.MASS], data[at + L.ONE + L.TANGENT_MASS]


@kernel
def store(plain: Plain[L.Slots], blocks: int, manifolds: Manifolds, points: Points) -> None:
    """Write what every slot holds into the records of its pair; the slots stay in use."""
    slots = L.Slots(*plain)
    for slot in range(blocks * L.WIDE):
        if slots.pair[slot] >= 0:
            store_slot(slots, slot, manifolds, points)


@kernel
def list_scalar(
    manifolds: Manifolds, pairs: int, inactive: Flags, scalar: Rows, sleeping: Rows
) -> tuple[int, int]:
    """Write the pairs that have no slot, in the order of their records; return how many there are.

    Pairs of which both bodies are ``inactive`` (rows,), an array that may be empty, need no work: those with
    points are written to ``sleeping``; their number is returned as well.
    """
    found, rest = 0, 0
    for p in range(pairs):
        if manifolds[p].slot >= 0:
            continue
        if len(inactive) > 0 and inactive[manifolds[p].a] and inactive[manifolds[p].b]:
            if manifolds[p].count > 0:
                sleeping[rest] = p
                rest += 1
            continue
        scalar[found] = p
        found += 1
    return found, rest


@kernel
def release(plain: Plain[L.Slots], blocks: int, manifolds: Manifolds, points: Points, asleep: Flags) -> int:
    """Write the slots of sleeping bodies to their records and empty them; return how many."""
    slots, released = L.Slots(*plain), 0
    for slot in range(blocks * L.WIDE):
        if slots.pair[slot] >= 0 and (asleep[slots.a[slot]] or asleep[slots.b[slot]]):
            set_scalar(slots, slot, manifolds, points)
            released += 1
    return released


@allocating_kernel
def follow_pairs(plain: Plain[L.Slots], blocks: int, manifolds: Manifolds, pairs: int) -> int:
    """Find the new numbers of the slots' pairs after a broad phase; return how many slots are in use.

    A slot whose pair is not near any more is emptied.
    """
    slots, kept = L.Slots(*plain), 0
    before = slots.pair[: blocks * L.WIDE].copy()
    for slot in range(blocks * L.WIDE):
        slots.pair[slot] = -1
    for p in range(pairs):
        slot = manifolds[p].slot
        if slot >= 0 and slot % 2 == slots.kind:
            slots.pair[slot // 2] = p
            kept += 1
    for slot in range(blocks * L.WIDE):
        if before[slot] >= 0 and slots.pair[slot] < 0:
            empty_slot(slots, slot)
    return kept


@inlined
def empty_slot(slots: L.Slots, slot: int) -> None:
    """Empty a slot, and free its colour for the bodies."""
    bit = np.uint64(1) << np.uint64(slots.colour[slot // L.WIDE])
    slots.used[slots.a[slot]] &= ~bit
    slots.used[slots.b[slot]] &= ~bit
    clear_slot(slots, slot)


@inlined
def set_scalar(slots: L.Slots, slot: int, manifolds: Manifolds, points: Points) -> None:
    """Write a slot to the records of its pair, which is scalar from now on, and empty it."""
    store_slot(slots, slot, manifolds, points)
    manifold = manifolds[slots.pair[slot]]
    manifold.slot = -1
    if manifold.found == AS_FOUND:  # the slot's normal may be of a later pose
        manifold.found = 0
    empty_slot(slots, slot)


@inlined
def _resting_speed(a: int, b: int, motion: Motion, acting: Acting, inverse: Inverse, h: float) -> float:
    """Return the speed up to which an approach counts as rest: what forces cause in two substeps [m/s]."""
    linear, force = motion.linear, acting.force
    speed = abs(linear[a, 0]) + abs(linear[a, 1]) + abs(linear[b, 0]) + abs(linear[b, 1])
    pull_a = math.sqrt(force[a, 0] * force[a, 0] + force[a, 1] * force[a, 1]) * inverse.mass[a]
    pull_b = math.sqrt(force[b, 0] * force[b, 0] + force[b, 1] * force[b, 1]) * inverse.mass[b]
    limit: float = 1e-9 * speed + 2.0 * h * max(pull_a, pull_b)
    return limit


@inlined
def _approach(slots: L.Slots, slot: int, count: int, motion: Motion) -> float:
    """Return the lowest speed along the normal of the ``count`` points of a slot, or 0 [m/s]."""
    at = slot // L.WIDE * L.rows_of(slots.kind) + slot % L.WIDE
    v, lowest = velocity_of(motion.linear, motion.angular, slots.a[slot], slots.b[slot]), 0.0
    for k in range(count):
        lowest = min(lowest, point_state(slot_frame(slots, at, L.ONE if k == 0 else L.TWO), v).v)
    return lowest


@inlined
def _measure_now(slots: L.Slots, slot: int, manifolds: Manifolds, points: Points, motion: Motion) -> None:
    """Bring the separations of a pair that had a slot up to date after impacts have moved bodies.

    A slot has no offset: that of the record is as old as the contact.
    """
    data, position, angle, p = slots.data, motion.position, motion.angle, slots.pair[slot]
    manifold, one = manifolds[p], points[2 * p]
    i, j = manifold.a, manifold.b
    dx, dy = position[j, 0] - position[i, 0], position[j, 1] - position[i, 1]
    at = slot // L.WIDE * L.rows_of(slots.kind) + slot % L.WIDE
    if slots.kind == L.DISC:
        along = dx * manifold.normal_x + dy * manifold.normal_y
        one.separation = along - data[at + L.RADIUS_A] - data[at + L.RADIUS_B]
    else:
        turn_a = data[at + L.TURNS_A] * (angle[i] - manifold.base_angle_a)
        turn_b = data[at + L.TURNS_B] * (angle[j] - manifold.base_angle_b)
        follow_pose(manifold, points, p, dx - manifold.base_x, dy - manifold.base_y, turn_a, turn_b)
    manifold.offset_x, manifold.offset_y = dx, dy


@allocating
def wake(slots: L.Slots, near: Near, motion: Motion, acting: Acting, inverse: Inverse, h: float) -> None:
    """Make those contacts scalar that may bounce, approach faster than rest, and have a body with an impact.

    They are added to the scalar pairs and to those of them that touch.
    """
    counts, manifolds = near.counts, near.manifolds
    had_impact = np.zeros(len(motion.angle), np.bool_)
    for k in range(counts[ACTIVE]):
        manifold = manifolds[near.touching[k]]
        if manifold.impact_count > 0:
            had_impact[manifold.a] = had_impact[manifold.b] = True
    for slot in range(counts[DISC_BLOCKS + slots.kind] * L.WIDE):
        p, i, j = slots.pair[slot], slots.a[slot], slots.b[slot]
        if p < 0 or not (had_impact[i] | had_impact[j]) or manifolds[p].restitution == 0.0:
            continue
        lowest = _approach(slots, slot, manifolds[p].count, motion)
        if lowest < 0.0 and lowest < -_resting_speed(i, j, motion, acting, inverse, h):
            near.scalar[counts[SCALAR]] = near.touching[counts[ACTIVE]] = p
            counts[SCALAR] += 1
            counts[ACTIVE] += 1
            store_slot(slots, slot, manifolds, near.points)
            _measure_now(slots, slot, manifolds, near.points, motion)
            manifolds[p].slot = -1
            empty_slot(slots, slot)
