"""Which contacts get slots: those that move little, each in a block that moves no body twice."""

import numpy as np

from physicslab.kernels import Flags, Numbers, Plain, Rows, Vectors, inlined, kernel
from physicslab.kernels import near_counts as N
from physicslab.kernels.arguments import Inverse, Materials, Motion, Near, named_near
from physicslab.kernels.broad.near_pairs import sort_scalar
from physicslab.kernels.geometry.contact import note_pose, slides_on
from physicslab.kernels.geometry.margins import CONTACT_MARGIN
from physicslab.kernels.geometry.pair import SWEEP_THRESHOLD, WIDE_SHARE
from physicslab.kernels.geometry.shapes import Shapes, ShapesTuple, named_shapes
from physicslab.kernels.records import Manifold, Manifolds, Point
from physicslab.kernels.wide.restore_slots import fill_slot, is_of_kind
from physicslab.kernels.wide.slots import COLOURS, clear_slot, list_scalar
from physicslab.kernels.wide.within_step import bounces_within, put_on_surfaces
from physicslab.kernels.wide_layout import BOX, WIDE, Masks, Slots, rows_of

MIN_WIDE = 64
"""Smallest number of contacts for which blocks are made: solving fewer takes less time than sorting them."""
ADDED, SPARSE, FULL = range(3)
"""Results of :func:`add_constraints`: all steady contacts have slots; blocks must be rebuilt; or enlarged."""
_SPARSE = 0.5
"""Share of slots in use below which blocks are rebuilt."""
_ENTRY = 0.5
"""Share of the speed at which a contact loses its slot, up to which it gets one."""

_OF_FIXED = 48
"""The first colour of contacts with fixed bodies: they are solved last, and so are the most exact."""


@inlined
def _is_steady(manifold: Manifold, one: Point, two: Point, linear: Vectors, h: float) -> bool:
    """Whether a contact may be in a block: it is slow for its size, and meets no later than now."""
    if manifold.swept != 0 or manifold.impact_count != 0 or one.ahead != 0:
        return False
    if manifold.count == 2 and two.ahead != 0:
        return False
    a, b = manifold.a, manifold.b
    ux, uy = (linear[b, 0] - linear[a, 0]) * h, (linear[b, 1] - linear[a, 1]) * h
    slow = SWEEP_THRESHOLD
    if one.normal_impulse > 0.0 or (manifold.count == 2 and two.normal_impulse > 0.0):
        slow = WIDE_SHARE
    elif manifold.found == 2 or manifold.restitution == 0.0:
        slow = CONTACT_MARGIN
    slow *= _ENTRY
    return bool(ux * ux + uy * uy <= slow * slow * manifold.size * manifold.size)


@inlined
def _survey(blocks: int, slots: Slots, opened: Rows) -> tuple[int, int]:
    """Find the first block of each colour that has room, the first empty one, and how many are needed.

    None of this depends on what was there before: a world read from a file continues alike.
    """
    pair, colour = slots.pair, slots.colour
    opened[:] = -1
    last = 0
    first_empty = -1
    for k in range(blocks):
        free = 0
        for slot in range(k * WIDE, (k + 1) * WIDE):
            free += 1 if pair[slot] < 0 else 0
        if free == WIDE:
            colour[k] = -1
            if first_empty < 0:
                first_empty = k
            continue
        last = k + 1
        if free > 0 and opened[colour[k]] < 0:
            opened[colour[k]] = k
    return last, first_empty if 0 <= first_empty < last else last


@inlined
def _free_slot(home: int, blocks: int, c: int, slots: Slots) -> int:
    """Return the first free slot of the blocks of a colour from ``home`` on, or -1."""
    for k in range(home, blocks):
        if slots.colour[k] == c:
            for slot in range(k * WIDE, (k + 1) * WIDE):
                if slots.pair[slot] < 0:
                    return slot
    return -1


@inlined
def _may_enter(
    slots: Slots, near: Near, p: int, motion: Motion, shapes: Shapes, asleep: Flags, h: float, substeps: int
) -> bool:
    """Whether a contact is steady, for a step of so many ``substeps``, and of the kind of these blocks.

    One with a body that is ``asleep``, which it is about to wake, stays scalar.
    """
    manifold = near.manifolds[p]
    i, j = manifold.a, manifold.b
    if manifold.wall >= 0 or not is_of_kind(slots.kind, shapes, i, j):
        return False
    one, two, linear = near.points[2 * p], near.points[2 * p + 1], motion.linear
    travel = h * (abs(linear[j, 0] - linear[i, 0]) + abs(linear[j, 1] - linear[i, 1]))
    if asleep[i] or asleep[j] or slides_on(manifold, one, two, travel):
        return False
    bounces = bounces_within(manifold, one, two, motion, substeps * h)
    return _is_steady(manifold, one, two, motion.linear, h) and not bounces


@inlined
def _first_colour(used: Masks, i: int, j: int, inverse_mass: Numbers) -> int:
    """Return the first colour that no contact of either body has, or COLOURS; fixed bodies have none."""
    taken = used[i] if inverse_mass[i] > 0.0 else np.uint64(0)
    if inverse_mass[j] > 0.0:
        taken |= used[j]
    c = 0 if inverse_mass[i] > 0.0 and inverse_mass[j] > 0.0 else _OF_FIXED
    while c < COLOURS and (taken >> np.uint64(c)) & np.uint64(1) != np.uint64(0):
        c += 1
    return c


@inlined
def _assign_colours(
    slots: Slots, blocks: int, opened: Rows, near: Near, motion: Motion, shapes: Shapes, materials: Materials,
    inverse: Inverse, asleep: Flags, h: float, substeps: int,
) -> tuple[int, int]:  # fmt: skip
    """Put the steady contacts of one kind into blocks; return how many blocks there are, and how many came.

    Two contacts of a body never share a block: each has one of ``COLOURS``, the first that neither of its
    bodies has been given. ``opened`` (COLOURS,) is the block of each colour that may have room. A contact for
    which there is no room stays scalar.
    """
    rows, came = rows_of(slots.kind), 0
    blocks, empty = _survey(blocks, slots, opened)
    for k in range(near.counts[N.ACTIVE]):
        p = near.touching[k]
        manifold = near.manifolds[p]
        if not _may_enter(slots, near, p, motion, shapes, asleep, h, substeps):
            continue
        c = _first_colour(slots.used, manifold.a, manifold.b, inverse.mass)
        if c == COLOURS:
            continue
        slot = _free_slot(opened[c], blocks, c, slots) if opened[c] >= 0 else -1
        if slot < 0:
            home = empty
            if (home + 1) * rows > len(slots.data):
                continue
            for free in range(home * WIDE, (home + 1) * WIDE):
                clear_slot(slots, free)
            slots.colour[home], slot = c, home * WIDE
            blocks = max(blocks, home + 1)
            empty += 1
            while empty < blocks and slots.colour[empty] >= 0:
                empty += 1
        opened[c] = slot // WIDE
        if slots.kind == BOX:
            put_on_surfaces(manifold, near.points[2 * p], near.points[2 * p + 1])
        if slots.kind == BOX and manifold.found != 2:
            manifold.found = 2
            note_pose(
                manifold, manifold.offset_x, manifold.offset_y, motion.angle[manifold.a],
                motion.angle[manifold.b],
            )  # fmt: skip
        fill_slot(slots, slot, c, near.manifolds, near.points, p, shapes, materials, inverse)
        came += 1
    return blocks, came


@kernel
def sort_blocks(blocks: int, colour: Rows, order: Rows) -> None:
    """Write the blocks in the order of their colours.

    Blocks of one colour share no body that moves: none has to wait for the result of the one before.
    """
    found = 0
    for c in range(-1, COLOURS):
        for k in range(blocks):
            if colour[k] == c:
                order[found] = k
                found += 1


@inlined
def _keep_scalar(manifolds: Manifolds, touching: Rows, count: int) -> int:
    """Remove the pairs that have slots from the list of those that touch; return how many are left."""
    kept = 0
    for k in range(count):
        p = touching[k]
        if manifolds[p].slot < 0:
            touching[kept] = p
            kept += 1
    return kept


@inlined
def _trimmed(blocks: int, pair: Rows) -> int:
    """Return how many blocks there are without the empty ones at the end."""
    while blocks > 0:
        for slot in range((blocks - 1) * WIDE, blocks * WIDE):
            if pair[slot] >= 0:
                return blocks
        blocks -= 1
    return blocks


@inlined
def _has_room(slots: Slots, blocks: int, active: int) -> bool:
    """Whether there is room for so many contacts, whatever colours they get."""
    return blocks + active // WIDE + COLOURS <= len(slots.colour)


@inlined
def add_to_blocks(
    near: Near, opened: Rows, sleeping: Rows, inactive: Flags, asleep: Flags,
    motion: Motion, shapes: Shapes, materials: Materials, inverse: Inverse, h: float, substeps: int,
) -> int:  # fmt: skip
    """Put steady contacts into blocks, as :func:`add_constraints` describes."""
    counts, discs, boxes = near.counts, near.discs, near.boxes
    before = counts[N.DISC_BLOCKS], counts[N.BOX_BLOCKS]
    counts[N.DISC_BLOCKS] = _trimmed(counts[N.DISC_BLOCKS], discs.pair)
    counts[N.BOX_BLOCKS] = _trimmed(counts[N.BOX_BLOCKS], boxes.pair)
    # At once: where this returns early, the next call finds nothing to drop.
    if counts[N.DISC_BLOCKS] != before[0]:
        sort_blocks(counts[N.DISC_BLOCKS], discs.colour, discs.order)
    if counts[N.BOX_BLOCKS] != before[1]:
        sort_blocks(counts[N.BOX_BLOCKS], boxes.colour, boxes.order)
    active, room = counts[N.ACTIVE], WIDE * (counts[N.DISC_BLOCKS] + counts[N.BOX_BLOCKS])
    if room > 2 * COLOURS * WIDE and counts[N.WIDE_COUNT] < _SPARSE * room:
        return SPARSE
    came = 0
    if active > 0 and (counts[N.WIDE_COUNT] > 0 or active >= MIN_WIDE):
        if not (
            _has_room(discs, counts[N.DISC_BLOCKS], active) and _has_room(boxes, counts[N.BOX_BLOCKS], active)
        ):
            return FULL
        for slots in (discs, boxes):
            which = N.DISC_BLOCKS + slots.kind
            counts[which], more = _assign_colours(
                slots, counts[which], opened, near, motion, shapes, materials, inverse, asleep, h, substeps
            )
            came += more
    if came > 0:
        sort_blocks(counts[N.DISC_BLOCKS], discs.colour, discs.order)
        sort_blocks(counts[N.BOX_BLOCKS], boxes.colour, boxes.order)
        counts[N.WIDE_COUNT] += came
        counts[N.ACTIVE] = _keep_scalar(near.manifolds, near.touching, active)
        counts[N.SCALAR], counts[N.SLEEPING] = list_scalar(
            near.manifolds, counts[N.RECORDED], inactive, near.scalar, sleeping
        )
        sort_scalar(near.manifolds, near.scalar, counts[N.SCALAR], len(motion.angle))
        counts[N.UNORDERED] = 0
    return ADDED


@kernel
def add_constraints(
    plain_near: Plain[Near], opened: Rows, sleeping: Rows, inactive: Flags, asleep: Flags,
    plain_motion: Plain[Motion], plain_shapes: ShapesTuple, plain_materials: Plain[Materials],
    plain_inverse: Plain[Inverse], h: float, substeps: int,
) -> int:  # fmt: skip
    """Put steady contacts into blocks; return what must be done first if that is not possible.

    It is the first of so many ``substeps`` of a step. ``counts`` are those of
    :mod:`physicslab.kernels.wide.slots`. Returns ``ADDED``, or ``SPARSE`` where too many slots are empty, or
    ``FULL`` where there is no room for those that may come. Empty blocks at the end are dropped in any case,
    so that the result does not depend on the past.
    """
    return add_to_blocks(
        named_near(plain_near), opened, sleeping, inactive, asleep, Motion(*plain_motion),
        named_shapes(plain_shapes), Materials(*plain_materials), Inverse(*plain_inverse), h, substeps,
    )  # fmt: skip
