"""Slots filled in from the records of their pairs, and whether they are still up to date."""

import math

import numpy as np

from physicslab.kernels import Flags, Numbers, Plain, Rows, Vectors, inlined, kernel
from physicslab.kernels import wide_layout as L
from physicslab.kernels.arguments import Inverse, Materials
from physicslab.kernels.geometry.contact import effective_masses, mixed_sizes
from physicslab.kernels.geometry.shapes import Shapes, ShapesTuple, has_own_way, named_shapes
from physicslab.kernels.records import Manifold, Manifolds, Point, Points
from physicslab.kernels.wide.slots import clear_slot, store_slot


@inlined
def _fill_common(data: Numbers, at: int, manifold: Manifold, inverse: Inverse) -> None:
    a, b = manifold.a, manifold.b
    data[at + L.NORMAL_X], data[at + L.NORMAL_Y] = manifold.normal_x, manifold.normal_y
    data[at + L.FRICTION], data[at + L.SIZE] = manifold.friction, manifold.size
    data[at + L.MASS_A], data[at + L.MASS_B] = inverse.mass[a], inverse.mass[b]
    data[at + L.INERTIA_A], data[at + L.INERTIA_B] = inverse.inertia[a], inverse.inertia[b]


@inlined
def _fill_point(data: Numbers, at: int, point: Point) -> None:
    data[at + L.IMPULSE], data[at + L.TANGENT_IMPULSE] = point.normal_impulse, point.tangent_impulse
    data[at + L.MASS], data[at + L.TANGENT_MASS] = point.normal_mass, point.tangent_mass
    data[at + L.SEPARATION] = point.separation


@inlined
def _fill_arms(data: Numbers, at: int, point: Point) -> None:
    data[at + L.ARM_AX], data[at + L.ARM_AY] = point.arm_ax, point.arm_ay
    data[at + L.ARM_BX], data[at + L.ARM_BY] = point.arm_bx, point.arm_by
    data[at + L.FOUND] = point.found_separation


@inlined
def fill_slot(
    slots: L.Slots, slot: int, colour: int, manifolds: Manifolds, points: Points, p: int,
    shapes: Shapes, materials: Materials, inverse: Inverse,
) -> None:  # fmt: skip
    """Put a pair into a free slot of a block of that colour."""
    data, at = slots.data, slot // L.WIDE * L.rows_of(slots.kind) + slot % L.WIDE
    manifold, one, two = manifolds[p], points[2 * p], points[2 * p + 1]
    i, j, radius = manifold.a, manifold.b, shapes.radius
    manifold.restitution = min(materials.restitution[i], materials.restitution[j])
    manifold.friction = math.sqrt(materials.friction[i] * materials.friction[j])
    if slots.kind == L.DISC:
        manifold.size, manifold.swept = 2.0 * min(radius[i], radius[j]), 0
    else:
        effective_masses(manifold, points, p, inverse)
    _fill_common(data, at, manifold, inverse)
    _fill_point(data, at + L.ONE, one)
    if slots.kind == L.DISC:
        ra, rb, linear = radius[i], radius[j], inverse.mass[i] + inverse.mass[j]
        data[at + L.RADIUS_A], data[at + L.RADIUS_B], data[at + L.RESTITUTION] = ra, rb, manifold.restitution
        data[at + L.ONE + L.MASS] = 1.0 / linear
        data[at + L.ONE + L.TANGENT_MASS] = 1.0 / (
            linear + inverse.inertia[i] * ra * ra + inverse.inertia[j] * rb * rb
        )
    else:
        data[at + L.BASE_X], data[at + L.BASE_Y] = manifold.base_x, manifold.base_y
        data[at + L.ANGLE_A], data[at + L.ANGLE_B] = manifold.base_angle_a, manifold.base_angle_b
        data[at + L.TURNS_A] = 1.0 if shapes.vertices[i] > 1 else 0.0
        data[at + L.TURNS_B] = 1.0 if shapes.vertices[j] > 1 else 0.0
        _fill_arms(data, at + L.ONE, one)
        if manifold.count == 2:
            _fill_point(data, at + L.TWO, two)
            _fill_arms(data, at + L.TWO, two)
    slots.a[slot], slots.b[slot], slots.pair[slot] = i, j, p
    if inverse.inertia[i] == 0.0 or inverse.inertia[j] == 0.0:
        slots.outside[slot // L.WIDE] = True
    bit = np.uint64(1) << np.uint64(colour)
    slots.used[i] |= bit
    slots.used[j] |= bit
    manifold.slot = 2 * slot + slots.kind


@inlined
def fill_points(slots: L.Slots, slot: int, manifold: Manifold, one: Point, two: Point) -> None:
    """Write the points of a pair with a box, found again, into the slot that it has."""
    data, at = slots.data, slot // L.WIDE * L.rows_of(slots.kind) + slot % L.WIDE
    data[at + L.NORMAL_X], data[at + L.NORMAL_Y] = manifold.normal_x, manifold.normal_y
    data[at + L.BASE_X], data[at + L.BASE_Y] = manifold.base_x, manifold.base_y
    data[at + L.ANGLE_A], data[at + L.ANGLE_B] = manifold.base_angle_a, manifold.base_angle_b
    _fill_point(data, at + L.ONE, one)
    _fill_arms(data, at + L.ONE, one)
    if manifold.count == 2:
        _fill_point(data, at + L.TWO, two)
        _fill_arms(data, at + L.TWO, two)
    else:
        for row in range(0, L.BASE_X - L.TWO, L.WIDE):
            data[at + L.TWO + row] = 0.0
        data[at + L.TWO + L.SEPARATION] = data[at + L.TWO + L.FOUND] = 1.0


@inlined
def is_of_kind(kind: int, shapes: Shapes, i: int, j: int) -> bool:
    """Whether blocks of a kind are for pairs of such shapes: of discs, or of all others with any."""
    one, other = shapes.vertices[i], shapes.vertices[j]
    if one == 1 and other == 1:
        return kind == L.DISC
    return kind != L.DISC and one != 0 and other != 0


@inlined
def _is_of_outlines(manifold: Manifold, shapes: Shapes) -> bool:
    """Whether the points of a pair in a slot, which are no bounds', are of the outlines of now.

    A file keeps no pose of a disc beside a shape with corners: their points are found again in any case.
    """
    i, j = manifold.a, manifold.b
    with_disc = (shapes.vertices[i] > 1) != (shapes.vertices[j] > 1)
    turns = with_disc or not (has_own_way(shapes, i) and has_own_way(shapes, j))
    blank = manifold.found != 2 and manifold.base_sizes == 0.0
    return bool(blank or manifold.base_sizes == mixed_sizes(manifold, shapes, turns))


@inlined
def _may_hold(slots: L.Slots, slot: int, manifold: Manifold, shapes: Shapes, inverse_mass: Numbers) -> bool:
    """Whether a pair can be in the slot that its record names."""
    i, j = manifold.a, manifold.b
    bit = np.uint64(1) << np.uint64(slots.colour[slot // L.WIDE])
    taken = (slots.used[i] if inverse_mass[i] > 0.0 else np.uint64(0)) | (
        slots.used[j] if inverse_mass[j] > 0.0 else np.uint64(0)
    )
    fits = slots.pair[slot] < 0 and taken & bit == np.uint64(0) and manifold.wall < 0
    fits = fits and is_of_kind(slots.kind, shapes, i, j) and manifold.count > 0
    fits = fits and (slots.kind == L.DISC or _is_of_outlines(manifold, shapes))
    return bool(fits and inverse_mass[i] + inverse_mass[j] != 0.0)


@kernel
def restore_slots(
    plain: Plain[L.Slots], manifolds: Manifolds, points: Points, pairs: int, plain_shapes: ShapesTuple,
    plain_materials: Plain[Materials], plain_inverse: Plain[Inverse],
) -> tuple[int, int]:  # fmt: skip
    """Put the pairs whose records name a slot back there; return how many blocks and slots there are.

    A pair that cannot be there, as in a file that was edited by hand, stays scalar.
    """
    slots, shapes, materials = L.Slots(*plain), named_shapes(plain_shapes), Materials(*plain_materials)
    inverse, blocks, restored = Inverse(*plain_inverse), 0, 0
    for p in range(pairs):
        if manifolds[p].slot >= 0 and manifolds[p].slot % 2 == slots.kind:
            blocks = max(blocks, manifolds[p].slot // 2 // L.WIDE + 1)
    for slot in range(blocks * L.WIDE):
        clear_slot(slots, slot)
    for p in range(pairs):
        manifold = manifolds[p]
        if manifold.slot < 0 or manifold.slot % 2 != slots.kind:
            continue
        slot = manifold.slot // 2
        if _may_hold(slots, slot, manifold, shapes, inverse.mass):
            fill_slot(
                slots, slot, slots.colour[slot // L.WIDE], manifolds, points, p, shapes, materials, inverse
            )
            restored += 1
        else:
            manifold.slot = -1
    return blocks, restored


@kernel
def remember(
    made_of: Vectors, inverse_mass: Numbers, inverse_inertia: Numbers, restitution: Numbers,
    friction: Numbers, half_x: Numbers, half_y: Numbers, radius: Numbers, first: Rows,
) -> None:  # fmt: skip
    """Write what slots hold of each body into ``made_of`` (rows, 8)."""
    for i in range(len(made_of)):
        made_of[i, 0], made_of[i, 1], made_of[i, 2] = inverse_mass[i], inverse_inertia[i], restitution[i]
        made_of[i, 3], made_of[i, 4] = friction[i], half_x[i]
        made_of[i, 5], made_of[i, 6], made_of[i, 7] = half_y[i], radius[i], first[i]


@kernel
def outdated(
    made_of: Vectors, changed: Flags, inverse_mass: Numbers, inverse_inertia: Numbers, restitution: Numbers,
    friction: Numbers, half_x: Numbers, half_y: Numbers, radius: Numbers, first: Rows,
) -> int:  # fmt: skip
    """Mark the bodies of which any of that has been ``changed`` (rows,) since :func:`remember`.

    Returns 0 where there are none; 1 where the contacts of none are to be in other slots; else 2: there are
    other rows, or a body has another outline, or can be moved where it could not, or the other way round.
    """
    if len(made_of) != len(inverse_mass):
        return 2
    found = 0
    for i in range(len(made_of)):
        fixed = (made_of[i, 0] == 0.0) != (inverse_mass[i] == 0.0)
        sized = (made_of[i, 4] != half_x[i]) | (made_of[i, 5] != half_y[i]) | (made_of[i, 6] != radius[i])
        sized |= made_of[i, 7] != first[i]
        weighs = (made_of[i, 0] != inverse_mass[i]) | (made_of[i, 1] != inverse_inertia[i])
        changed[i] = weighs | (made_of[i, 2] != restitution[i]) | (made_of[i, 3] != friction[i])
        found = max(found, 2 if fixed | sized else (1 if changed[i] else 0))
    return found


@kernel
def update_slots(
    plain: Plain[L.Slots], blocks: int, changed: Flags, manifolds: Manifolds, points: Points,
    plain_shapes: ShapesTuple, plain_materials: Plain[Materials], plain_inverse: Plain[Inverse],
) -> None:  # fmt: skip
    """Fill the slots of the ``changed`` bodies again, with their impulses, masses and materials of now."""
    slots, shapes, materials = L.Slots(*plain), named_shapes(plain_shapes), Materials(*plain_materials)
    inverse = Inverse(*plain_inverse)
    for slot in range(blocks * L.WIDE):
        p = slots.pair[slot]
        if p >= 0 and (changed[slots.a[slot]] or changed[slots.b[slot]]):
            store_slot(slots, slot, manifolds, points)
            fill_slot(
                slots, slot, slots.colour[slot // L.WIDE], manifolds, points, p, shapes, materials, inverse
            )
