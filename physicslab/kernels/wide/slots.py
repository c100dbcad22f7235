"""Which wide contact is in which slot of which block: filling, storing and emptying slots."""

import math
from typing import Annotated

import numpy as np
from numba import uint64
from numpy.typing import NDArray

from physicslab.kernels import Flags, Numbers, Rows, Vectors, allocating, allocating_kernel, inlined, kernel
from physicslab.kernels.narrow.contact import follow_pose
from physicslab.kernels.records import Manifolds, Points
from physicslab.kernels.wide.layout import (
    ARM_AX,
    ARM_AY,
    ARM_BX,
    ARM_BY,
    BOX_ROWS,
    DISC,
    DISC_ROWS,
    FOUND,
    IMPULSE,
    MASS,
    NORMAL_X,
    NORMAL_Y,
    ONE,
    RADIUS_A,
    RADIUS_B,
    SEPARATION,
    SIZE,
    TANGENT_IMPULSE,
    TANGENT_MASS,
    TWO,
    WIDE,
)  # fmt: skip

__all__ = [
    "ACTIVE",
    "BOX_BLOCKS",
    "COLOURS",
    "COUNTED",
    "DISC_BLOCKS",
    "LEFT",
    "LOGGED",
    "PROXIMITY",
    "RECORDED",
    "SCALAR",
    "SLEEPING",
    "UNORDERED",
    "WIDE_COUNT",
    "Masks",
    "Slots",
    "clear_slot",
    "empty_slot",
    "follow_pairs",
    "list_scalar",
    "release",
    "store",
    "store_slot",
    "wake",
]  # fmt: skip

COLOURS = 64
"""Largest number of blocks that may move one body; its further contacts stay scalar."""
Masks = Annotated[NDArray[np.uint64], uint64[::1]]
"""A uint64 array (n,), bit by bit."""
Slots = tuple[Numbers, Rows, Rows, Rows, Rows, Masks, Rows]
"""The blocks of a kind: data, rows of A and B, pairs, colours, the colours of each body, their order."""
COUNTED = 11
(
    PROXIMITY, RECORDED, SCALAR, SLEEPING, ACTIVE, LEFT, WIDE_COUNT, DISC_BLOCKS, BOX_BLOCKS, UNORDERED,
    LOGGED,
) = range(COUNTED)  # fmt: skip
"""Counts that kernels keep: near pairs without records; those with records; of these the scalar ones, those
that sleep, those that touch, those that impacts have left to the solver; slots in use; blocks of discs and of
boxes; whether scalar pairs are out of order; and all impacts logged so far."""


@inlined
def clear_slot(data: Numbers, rows: int, k: int, slot: int, a: Rows, b: Rows, pair: Rows) -> None:
    """Empty slot number ``slot`` of block k: it moves no body, and no check ever selects it."""
    block = data[k * rows : (k + 1) * rows]
    for row in range(0, rows, WIDE):
        block[row + slot] = 0.0
    block[SIZE + slot] = block[NORMAL_X + slot] = block[ONE + SEPARATION + slot] = 1.0
    if rows == DISC_ROWS:
        block[RADIUS_A + slot] = block[RADIUS_B + slot] = -0.5
    else:
        block[TWO + SEPARATION + slot] = block[ONE + FOUND + slot] = block[TWO + FOUND + slot] = 1.0
    a[k * WIDE + slot] = b[k * WIDE + slot] = 0
    pair[k * WIDE + slot] = -1


@inlined
def store_slot(data: Numbers, rows: int, slot: int, p: int, manifolds: Manifolds, points: Points) -> None:
    """Write what the slot holds, impulses above all, into the records of its pair."""
    at = slot // WIDE * rows + slot % WIDE
    manifold = manifolds[p]
    for j in range(manifold.count):
        point = points[2 * p + j]
        base = at + (ONE if j == 0 else TWO)
        point.normal_impulse, point.tangent_impulse = data[base + IMPULSE], data[base + TANGENT_IMPULSE]
        point.separation = data[base + SEPARATION]
    if rows == DISC_ROWS:
        nx, ny, point = data[at + NORMAL_X], data[at + NORMAL_Y], points[2 * p]
        manifold.normal_x, manifold.normal_y = nx, ny
        point.arm_ax, point.arm_ay = data[at + RADIUS_A] * nx, data[at + RADIUS_A] * ny
        point.arm_bx, point.arm_by = -data[at + RADIUS_B] * nx, -data[at + RADIUS_B] * ny
        point.normal_mass, point.tangent_mass = data[at + ONE + MASS], data[at + ONE + TANGENT_MASS]


@kernel
def store(data: Numbers, rows: int, blocks: int, pair: Rows, manifolds: Manifolds, points: Points) -> None:
    """Write what every slot holds into the records of its pair; the slots stay in use."""
    for slot in range(blocks * WIDE):
        if pair[slot] >= 0:
            store_slot(data, rows, slot, pair[slot], manifolds, points)


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
def release(
    kind: int, data: Numbers, blocks: int, a: Rows, b: Rows, pair: Rows, colour: Rows, used: Masks,
    manifolds: Manifolds, points: Points, asleep: Flags,
) -> int:  # fmt: skip
    """Write the slots of sleeping bodies to their records and empty them; return how many."""
    rows, released = (DISC_ROWS if kind == DISC else BOX_ROWS), 0
    for slot in range(blocks * WIDE):
        p = pair[slot]
        if p >= 0 and (asleep[a[slot]] or asleep[b[slot]]):
            store_slot(data, rows, slot, p, manifolds, points)
            manifolds[p].slot = -1
            empty_slot(data, rows, slot, a, b, pair, colour, used)
            released += 1
    return released


@allocating_kernel
def follow_pairs(
    kind: int, data: Numbers, blocks: int, a: Rows, b: Rows, pair: Rows, colour: Rows, used: Masks,
    manifolds: Manifolds, pairs: int,
) -> int:  # fmt: skip
    """Find the new numbers of the slots' pairs after a broad phase; return how many slots are in use.

    A slot whose pair is not near any more is emptied.
    """
    rows, kept = (DISC_ROWS if kind == DISC else BOX_ROWS), 0
    before = pair[: blocks * WIDE].copy()
    for slot in range(blocks * WIDE):
        pair[slot] = -1
    for p in range(pairs):
        slot = manifolds[p].slot
        if slot >= 0 and slot % 2 == kind:
            pair[slot // 2] = p
            kept += 1
    for slot in range(blocks * WIDE):
        if before[slot] >= 0 and pair[slot] < 0:
            empty_slot(data, rows, slot, a, b, pair, colour, used)
    return kept


@inlined
def empty_slot(
    data: Numbers, rows: int, slot: int, a: Rows, b: Rows, pair: Rows, colour: Rows, used: Masks
) -> None:
    """Empty a slot, and free its colour for the bodies."""
    k = slot // WIDE
    bit = np.uint64(1) << np.uint64(colour[k])
    used[a[slot]] &= ~bit
    used[b[slot]] &= ~bit
    clear_slot(data, rows, k, slot % WIDE, a, b, pair)


@inlined
def _resting_speed(a: int, b: int, linear: Vectors, force: Vectors, inverse_mass: Numbers, h: float) -> float:
    """Return the speed up to which an approach counts as rest: what forces cause in two substeps [m/s]."""
    speed = abs(linear[a, 0]) + abs(linear[a, 1]) + abs(linear[b, 0]) + abs(linear[b, 1])
    pull_a = math.sqrt(force[a, 0] * force[a, 0] + force[a, 1] * force[a, 1]) * inverse_mass[a]
    pull_b = math.sqrt(force[b, 0] * force[b, 0] + force[b, 1] * force[b, 1]) * inverse_mass[b]
    limit: float = 1e-9 * speed + 2.0 * h * max(pull_a, pull_b)
    return limit


@inlined
def _measure_now(
    kind: int, data: Numbers, at: int, manifolds: Manifolds, points: Points, p: int,
    position: Vectors, angle: Numbers,
) -> None:  # fmt: skip
    """Bring the separations of a pair that had a slot up to date after impacts have moved bodies.

    A slot has no offset: that of the record is as old as the contact.
    """
    manifold, one = manifolds[p], points[2 * p]
    i, j = manifold.a, manifold.b
    dx, dy = position[j, 0] - position[i, 0], position[j, 1] - position[i, 1]
    if kind == DISC:
        along = dx * manifold.normal_x + dy * manifold.normal_y
        one.separation = along - data[at + RADIUS_A] - data[at + RADIUS_B]
    else:
        turn_a, turn_b = angle[i] - manifold.base_angle_a, angle[j] - manifold.base_angle_b
        follow_pose(manifold, points, p, dx - manifold.base_x, dy - manifold.base_y, turn_a, turn_b)
    manifold.offset_x, manifold.offset_y = dx, dy


@allocating
def wake(
    kind: int, data: Numbers, blocks: int, a: Rows, b: Rows, pair: Rows, colour: Rows, used: Masks,
    manifolds: Manifolds, points: Points, scalar: Rows, scalar_count: int, touching: Rows, count: int,
    position: Vectors, angle: Numbers, linear: Vectors, angular: Numbers, force: Vectors,
    inverse_mass: Numbers, h: float,
) -> tuple[int, int]:  # fmt: skip
    """Make those contacts scalar that may bounce, approach faster than rest, and have a body with an impact.

    Returns how many pairs are scalar, and how many of them touch.
    """
    rows = DISC_ROWS if kind == DISC else BOX_ROWS
    had_impact = np.zeros(len(angular), np.bool_)
    for k in range(count):
        manifold = manifolds[touching[k]]
        if manifold.impact_count > 0:
            had_impact[manifold.a] = had_impact[manifold.b] = True
    for slot in range(blocks * WIDE):
        p = pair[slot]
        if p < 0 or not (had_impact[a[slot]] | had_impact[b[slot]]) or manifolds[p].restitution == 0.0:
            continue
        at, i, j = slot // WIDE * rows + slot % WIDE, a[slot], b[slot]
        nx, ny = data[at + NORMAL_X], data[at + NORMAL_Y]
        lowest = 0.0
        for k in range(manifolds[p].count):
            base = at + (ONE if k == 0 else TWO)
            if kind == DISC:
                rax, ray = data[at + RADIUS_A] * nx, data[at + RADIUS_A] * ny
                rbx, rby = -data[at + RADIUS_B] * nx, -data[at + RADIUS_B] * ny
            else:
                rax, ray = data[base + ARM_AX], data[base + ARM_AY]
                rbx, rby = data[base + ARM_BX], data[base + ARM_BY]
            vx = linear[j, 0] - angular[j] * rby - linear[i, 0] + angular[i] * ray
            vy = linear[j, 1] + angular[j] * rbx - linear[i, 1] - angular[i] * rax
            lowest = min(lowest, vx * nx + vy * ny)
        if lowest < 0.0 and lowest < -_resting_speed(i, j, linear, force, inverse_mass, h):
            store_slot(data, rows, slot, p, manifolds, points)
            _measure_now(kind, data, at, manifolds, points, p, position, angle)
            manifolds[p].slot = -1
            scalar[scalar_count], touching[count] = p, p
            scalar_count, count = scalar_count + 1, count + 1
            empty_slot(data, rows, slot, a, b, pair, colour, used)
    return scalar_count, count
