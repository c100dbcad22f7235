"""Where wide contacts touch now, eight at a time; those that are not steady any more become scalar."""

from physicslab.kernels import Numbers, always_inlined, inlined, kernel
from physicslab.kernels import wide_layout as L
from physicslab.kernels.arguments import Bounds, Inverse, Motion, Near
from physicslab.kernels.float64x8 import (
    Wide,
    choose,
    mask_bits,
    put,
    root,
    size_of,
    take,
    take_numbers,
    take_vectors,
)
from physicslab.kernels.geometry import contact
from physicslab.kernels.geometry.margins import (
    CACHE_TOLERANCE,
    CACHE_TURN_TOLERANCE,
    CONTACT_MARGIN,
    WIDE_TOLERANCE,
)
from physicslab.kernels.geometry.outline import Way
from physicslab.kernels.geometry.pair import SWEEP_THRESHOLD, WIDE_SHARE
from physicslab.kernels.geometry.shapes import Shapes
from physicslab.kernels.near_counts import DISC_BLOCKS, SCALAR
from physicslab.kernels.wide.restore_slots import fill_points
from physicslab.kernels.wide.slots import empty_slot, set_scalar, store_slot
from physicslab.kernels.wide.within_step import bounces_within, put_on_surfaces

_WITHIN_STEP = 100.0
"""Multiple of the tolerances of points beyond which a wide contact becomes scalar within a step."""
_ONE_SPOT = 1e-300
"""Distance [m] below which there is no direction."""


@always_inlined
def _restless(slots: L.Slots, k: int, motion: Motion, h: float) -> int:
    """Return the slots of a block whose bodies move too far for their size in a substep, as bits.

    Bodies that do not press on each other may meet within it, and bounce at a time and with a normal that are
    to be found.
    """
    vax, vay = take_vectors(motion.linear, slots.a, k * L.WIDE)
    vbx, vby = take_vectors(motion.linear, slots.b, k * L.WIDE)
    at = k * L.rows_of(slots.kind)
    size = take(slots.data, at + L.SIZE)
    pressed = take(slots.data, at + L.ONE + L.IMPULSE)
    limit = CONTACT_MARGIN * size
    if slots.kind == L.DISC:
        limit = choose(take(slots.data, at + L.RESTITUTION) > 0.0, SWEEP_THRESHOLD * size, limit)
    else:
        pressed = pressed + take(slots.data, at + L.TWO + L.IMPULSE)
    limit = choose(pressed > 0.0, WIDE_SHARE * size, limit)
    ux, uy = (vbx - vax) * h, (vby - vay) * h
    return mask_bits(ux * ux + uy * uy > limit * limit)


@always_inlined
def _refresh_discs(slots: L.Slots, k: int, motion: Motion, speculative_margin: float) -> int:
    """Find normals and separations of a block of discs; return which are apart."""
    data, at = slots.data, k * L.DISC_ROWS
    xa, ya = take_vectors(motion.position, slots.a, k * L.WIDE)
    xb, yb = take_vectors(motion.position, slots.b, k * L.WIDE)
    dx, dy = xb - xa, yb - ya
    distance = root(dx * dx + dy * dy)
    size, ra, rb = take(data, at + L.SIZE), take(data, at + L.RADIUS_A), take(data, at + L.RADIUS_B)
    separation = distance - ra - rb
    scale = choose(distance > 0.0, 1.0 / distance, 0.0)
    put(data, at + L.NORMAL_X, dx * scale)
    put(data, at + L.NORMAL_Y, dy * scale)
    put(data, at + L.ONE + L.SEPARATION, separation)
    apart = separation > 0.5 * CONTACT_MARGIN * size + speculative_margin
    on_one_spot = distance < _ONE_SPOT
    return mask_bits((apart | on_one_spot) & (ra > 0.0))


@always_inlined
def _follow(
    data: Numbers, point: int, x: Wide, y: Wide, nx: Wide, ny: Wide, turn_a: Wide, turn_b: Wide
) -> None:
    """Update the separations of points, to second order in how far the pairs have moved and turned."""
    rax, ray = take(data, point + L.ARM_AX), take(data, point + L.ARM_AY)
    rbx, rby = take(data, point + L.ARM_BX), take(data, point + L.ARM_BY)
    ax, ay = turn_a * (-ray - 0.5 * turn_a * rax), turn_a * (rax - 0.5 * turn_a * ray)
    bx, by = turn_b * (-rby - 0.5 * turn_b * rbx), turn_b * (rbx - 0.5 * turn_b * rby)
    separation = take(data, point + L.FOUND) + (x + bx - ax) * nx + (y + by - ay) * ny
    put(data, point + L.SEPARATION, separation)


@always_inlined
def _refresh_boxes(slots: L.Slots, k: int, motion: Motion, tolerance: float) -> int:
    """Update the separations of a block with boxes; return whose points to find again.

    ``tolerance`` is a share of :data:`CACHE_TOLERANCE` and :data:`CACHE_TURN_TOLERANCE`.
    """
    data, at = slots.data, k * L.BOX_ROWS
    xa, ya = take_vectors(motion.position, slots.a, k * L.WIDE)
    xb, yb = take_vectors(motion.position, slots.b, k * L.WIDE)
    nx, ny = take(data, at + L.NORMAL_X), take(data, at + L.NORMAL_Y)
    x, y = xb - xa - take(data, at + L.BASE_X), yb - ya - take(data, at + L.BASE_Y)
    turn_a = take_numbers(motion.angle, slots.a, k * L.WIDE) - take(data, at + L.ANGLE_A)
    turn_b = take_numbers(motion.angle, slots.b, k * L.WIDE) - take(data, at + L.ANGLE_B)
    turn_a, turn_b = turn_a * take(data, at + L.TURNS_A), turn_b * take(data, at + L.TURNS_B)
    _follow(data, at + L.ONE, x, y, nx, ny, turn_a, turn_b)
    _follow(data, at + L.TWO, x, y, nx, ny, turn_a, turn_b)
    size = take(data, at + L.SIZE)
    moved = (
        (size_of(x) + size_of(y) > tolerance * CACHE_TOLERANCE * size)
        | (size_of(turn_a) > tolerance * CACHE_TURN_TOLERANCE)
        | (size_of(turn_b) > tolerance * CACHE_TURN_TOLERANCE)
    )
    return mask_bits(moved)


@inlined
def _find_again(
    slots: L.Slots, slot: int, near: Near, motion: Motion, shapes: Shapes, inverse: Inverse,
    bounds: Bounds, h: float, start: float, speculative_margin: float, rest: float,
) -> bool:  # fmt: skip
    """Find the points of a slot's pair in its present pose; return whether it keeps its slot."""
    p = slots.pair[slot]
    manifold, one, two = near.manifolds[p], near.points[2 * p], near.points[2 * p + 1]
    a, b, position, linear = manifold.a, manifold.b, motion.position, motion.linear
    store_slot(slots, slot, near.manifolds, near.points)
    way = Way(
        position[b, 0] - position[a, 0], position[b, 1] - position[a, 1],
        (linear[b, 0] - linear[a, 0]) * h, (linear[b, 1] - linear[a, 1]) * h,
    )  # fmt: skip
    manifold.offset_x, manifold.offset_y = way.dx, way.dy
    turned = near.rotations
    contact.touch(manifold, one, two, way, motion, shapes, bounds, turned, h, start, speculative_margin, rest)
    slides = contact.slides_on(manifold, one, two, abs(way.ux) + abs(way.uy))
    bounces = bounces_within(manifold, one, two, motion, h + rest * h)
    if manifold.count == 0 or manifold.swept != 0 or slides or bounces:
        if manifold.count == 0:
            contact.forget_points(one, two)
        manifold.found, manifold.slot = 0, -1
        empty_slot(slots, slot)
        return False
    put_on_surfaces(manifold, one, two)
    contact.note_pose(manifold, way.dx, way.dy, motion.angle[a], motion.angle[b])
    contact.effective_masses(manifold, near.points, p, inverse)
    fill_points(slots, slot, manifold, one, two)
    return True


@inlined
def refresh(
    slots: L.Slots, near: Near, motion: Motion, shapes: Shapes, inverse: Inverse,
    bounds: Bounds, first: bool, h: float, start: float, speculative_margin: float, rest: float,
) -> None:  # fmt: skip
    """Find where the contacts of all blocks of a kind touch now.

    A pair that is too fast (looked at in the ``first`` substep of a step), or has come apart is
    written to its records and added to the scalar pairs. The points of a pair with a box are followed; where
    it has moved, they are found again in the first substep, and it keeps its slot.
    """
    tolerance = WIDE_TOLERANCE if first else _WITHIN_STEP
    for k in range(near.counts[DISC_BLOCKS + slots.kind]):
        lost, moved = _restless(slots, k, motion, h) if first else 0, 0
        if slots.kind == L.DISC:
            lost |= _refresh_discs(slots, k, motion, speculative_margin)
        else:
            moved = _refresh_boxes(slots, k, motion, tolerance)
            lost |= 0 if first else moved
        if lost != 0:
            _lose(slots, k, lost, near)
        if first and moved & ~lost != 0:
            for place in range(L.WIDE):
                slot = k * L.WIDE + place
                p = slots.pair[slot]
                if p < 0 or not (moved >> place) & 1:
                    continue
                if not _find_again(
                    slots, slot, near, motion, shapes, inverse, bounds, h, start, speculative_margin, rest
                ):
                    near.scalar[near.counts[SCALAR]] = p
                    near.counts[SCALAR] += 1


@inlined
def _lose(slots: L.Slots, k: int, lost: int, near: Near) -> None:
    """Make the slots of a block that are ``lost`` scalar."""
    for place in range(L.WIDE):
        slot = k * L.WIDE + place
        p = slots.pair[slot]
        if p >= 0 and (lost >> place) & 1:
            near.scalar[near.counts[SCALAR]] = p
            near.counts[SCALAR] += 1
            set_scalar(slots, slot, near.manifolds, near.points)


@kernel
def deepest_wide(kind: int, data: Numbers, blocks: int) -> float:
    """Return the deepest overlap in all blocks of a kind [m]."""
    rows, depth = L.rows_of(kind), 0.0
    for k in range(blocks):
        for slot in range(L.WIDE):
            depth = max(depth, -data[k * rows + L.ONE + L.SEPARATION + slot])
            if kind == L.BOX:
                depth = max(depth, -data[k * rows + L.TWO + L.SEPARATION + slot])
    return depth
