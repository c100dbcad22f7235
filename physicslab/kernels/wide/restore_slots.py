"""What a slot holds of its pair: filled in from the records, and whether it is still up to date."""

import math

import numpy as np

from physicslab.kernels import Numbers, Rows, Vectors, inlined, kernel
from physicslab.kernels.narrow.contact import effective_masses
from physicslab.kernels.records import Manifold, Manifolds, Point, Points
from physicslab.kernels.wide.layout import (
    ANGLE_A,
    ANGLE_B,
    ARM_AX,
    ARM_AY,
    ARM_BX,
    ARM_BY,
    BASE_X,
    BASE_Y,
    BOX_ROWS,
    DISC,
    DISC_ROWS,
    FOUND,
    FRICTION,
    IMPULSE,
    INERTIA_A,
    INERTIA_B,
    MASS,
    MASS_A,
    MASS_B,
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
from physicslab.kernels.wide.slots import Masks, clear_slot

__all__ = ["fill_slot", "outdated", "remember", "restore_slots"]


@inlined
def _fill_common(
    data: Numbers, at: int, manifold: Manifold, inverse_mass: Numbers, inverse_inertia: Numbers
) -> None:
    a, b = manifold.a, manifold.b
    data[at + NORMAL_X], data[at + NORMAL_Y] = manifold.normal_x, manifold.normal_y
    data[at + FRICTION], data[at + SIZE] = manifold.friction, manifold.size
    data[at + MASS_A], data[at + MASS_B] = inverse_mass[a], inverse_mass[b]
    data[at + INERTIA_A], data[at + INERTIA_B] = inverse_inertia[a], inverse_inertia[b]


@inlined
def _fill_point(data: Numbers, at: int, point: Point) -> None:
    data[at + IMPULSE], data[at + TANGENT_IMPULSE] = point.normal_impulse, point.tangent_impulse
    data[at + MASS], data[at + TANGENT_MASS] = point.normal_mass, point.tangent_mass
    data[at + SEPARATION] = point.separation


@inlined
def _fill_arms(data: Numbers, at: int, point: Point) -> None:
    data[at + ARM_AX], data[at + ARM_AY] = point.arm_ax, point.arm_ay
    data[at + ARM_BX], data[at + ARM_BY] = point.arm_bx, point.arm_by
    data[at + FOUND] = point.found_separation


@inlined
def fill_slot(
    kind: int, data: Numbers, slot: int, a: Rows, b: Rows, pair: Rows, used: Masks, colour: int,
    manifolds: Manifolds, points: Points, p: int,
    radius: Numbers, restitution: Numbers, friction: Numbers,
    inverse_mass: Numbers, inverse_inertia: Numbers,
) -> None:  # fmt: skip
    """Put a pair into a free slot of a block of that colour."""
    rows = DISC_ROWS if kind == DISC else BOX_ROWS
    at = slot // WIDE * rows + slot % WIDE
    manifold, one, two = manifolds[p], points[2 * p], points[2 * p + 1]
    i, j = manifold.a, manifold.b
    manifold.restitution = min(restitution[i], restitution[j])
    manifold.friction = math.sqrt(friction[i] * friction[j])
    if kind == DISC:
        manifold.size, manifold.swept = 2.0 * min(radius[i], radius[j]), 0
    else:
        effective_masses(manifold, points, p, inverse_mass, inverse_inertia)
    _fill_common(data, at, manifold, inverse_mass, inverse_inertia)
    _fill_point(data, at + ONE, one)
    if kind == DISC:
        ra, rb, linear = radius[i], radius[j], inverse_mass[i] + inverse_mass[j]
        data[at + RADIUS_A], data[at + RADIUS_B] = ra, rb
        data[at + ONE + MASS] = 1.0 / linear
        data[at + ONE + TANGENT_MASS] = 1.0 / (
            linear + inverse_inertia[i] * ra * ra + inverse_inertia[j] * rb * rb
        )
    else:
        data[at + BASE_X], data[at + BASE_Y] = manifold.base_x, manifold.base_y
        data[at + ANGLE_A], data[at + ANGLE_B] = manifold.base_angle_a, manifold.base_angle_b
        _fill_arms(data, at + ONE, one)
        if manifold.count == 2:
            _fill_point(data, at + TWO, two)
            _fill_arms(data, at + TWO, two)
    a[slot], b[slot], pair[slot] = i, j, p
    bit = np.uint64(1) << np.uint64(colour)
    used[i] |= bit
    used[j] |= bit
    manifold.slot = 2 * slot + kind


@kernel
def restore_slots(
    kind: int, data: Numbers, a: Rows, b: Rows, pair: Rows, colour: Rows, used: Masks,
    manifolds: Manifolds, points: Points, pairs: int,
    shape: Rows, radius: Numbers, restitution: Numbers, friction: Numbers,
    inverse_mass: Numbers, inverse_inertia: Numbers,
) -> tuple[int, int]:  # fmt: skip
    """Put the pairs whose records name a slot back there; return how many blocks and slots there are.

    A pair that cannot be there, as in a file that was edited by hand, stays scalar.
    """
    rows, blocks, restored = (DISC_ROWS if kind == DISC else BOX_ROWS), 0, 0
    for p in range(pairs):
        if manifolds[p].slot >= 0 and manifolds[p].slot % 2 == kind:
            blocks = max(blocks, manifolds[p].slot // 2 // WIDE + 1)
    for k in range(blocks):
        for slot in range(WIDE):
            clear_slot(data, rows, k, slot, a, b, pair)
    for p in range(pairs):
        named = manifolds[p].slot
        if named >= 0 and named % 2 == kind:
            slot, manifold = named // 2, manifolds[p]
            i, j, wanted = manifold.a, manifold.b, 1 if kind == DISC else 2
            bit = np.uint64(1) << np.uint64(colour[slot // WIDE])
            taken = (used[i] if inverse_mass[i] > 0.0 else np.uint64(0)) | (
                used[j] if inverse_mass[j] > 0.0 else np.uint64(0)
            )
            fits = pair[slot] < 0 and taken & bit == np.uint64(0) and manifold.wall < 0
            fits = fits and shape[i] == wanted and shape[j] == wanted and manifold.count > 0
            if not fits or inverse_mass[i] + inverse_mass[j] == 0.0:
                manifold.slot = -1
                continue
            fill_slot(
                kind, data, slot, a, b, pair, used, colour[slot // WIDE], manifolds, points, p,
                radius, restitution, friction, inverse_mass, inverse_inertia,
            )  # fmt: skip
            restored += 1
    return blocks, restored


@kernel
def remember(
    made_of: Vectors, inverse_mass: Numbers, inverse_inertia: Numbers, restitution: Numbers,
    friction: Numbers, radius: Numbers, width: Numbers, height: Numbers,
) -> None:  # fmt: skip
    """Write what slots hold of each body into ``made_of`` (rows, 7)."""
    for i in range(len(made_of)):
        made_of[i, 0], made_of[i, 1], made_of[i, 2] = inverse_mass[i], inverse_inertia[i], restitution[i]
        made_of[i, 3], made_of[i, 4] = friction[i], radius[i]
        made_of[i, 5], made_of[i, 6] = width[i], height[i]


@kernel
def outdated(
    made_of: Vectors, inverse_mass: Numbers, inverse_inertia: Numbers, restitution: Numbers,
    friction: Numbers, radius: Numbers, width: Numbers, height: Numbers,
) -> bool:  # fmt: skip
    """Whether any of that has been changed since :func:`remember`."""
    if len(made_of) != len(inverse_mass):
        return True
    for i in range(len(made_of)):
        if (
            (made_of[i, 0] != inverse_mass[i]) | (made_of[i, 1] != inverse_inertia[i])
            | (made_of[i, 2] != restitution[i]) | (made_of[i, 3] != friction[i])
            | (made_of[i, 4] != radius[i]) | (made_of[i, 5] != width[i]) | (made_of[i, 6] != height[i])
        ):  # fmt: skip
            return True
    return False
