"""Where wide contacts touch now, eight at a time; those that are not steady any more become scalar."""

from physicslab.kernels import Numbers, Rows, Vectors, fused, inlined, kernel
from physicslab.kernels.records import Manifolds, Points
from physicslab.kernels.wide.float64x8 import (
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
from physicslab.kernels.wide.layout import (
    ANGLE_A,
    ANGLE_B,
    ARM_AX,
    ARM_AY,
    ARM_BX,
    ARM_BY,
    BASE_X,
    BASE_Y,
    BOX,
    BOX_ROWS,
    DISC,
    DISC_ROWS,
    FOUND,
    NORMAL_X,
    NORMAL_Y,
    ONE,
    RADIUS_A,
    RADIUS_B,
    SEPARATION,
    SIZE,
    TWO,
    WIDE,
)  # fmt: skip
from physicslab.kernels.wide.slots import Masks, empty_slot, store_slot

__all__ = ["deepest_wide", "refresh"]

_DEEP = 0.1
"""Share of the smaller size: deeper overlap is resolved by moving bodies, which only scalar contacts do."""
_ONE_SPOT = 1e-300
"""Distance [m] below which there is no direction."""


@fused
def _restless(
    data: Numbers, at: int, a: Rows, b: Rows, slot: int, linear: Vectors, still: float, h: float
) -> int:
    """Return the slots whose bodies move more than ``still`` of their size a substep, as bits."""
    vax, vay = take_vectors(linear, a, slot)
    vbx, vby = take_vectors(linear, b, slot)
    ux, uy, limit = (vbx - vax) * h, (vby - vay) * h, still * take(data, at + SIZE)
    return mask_bits(ux * ux + uy * uy > limit * limit)


@fused
def _refresh_discs(
    data: Numbers,
    at: int,
    a: Rows,
    b: Rows,
    slot: int,
    position: Vectors,
    near: float,
    speculative_margin: float,
) -> int:
    """Find normals and separations of a block of discs; return which are apart or overlap much."""
    xa, ya = take_vectors(position, a, slot)
    xb, yb = take_vectors(position, b, slot)
    dx, dy = xb - xa, yb - ya
    distance = root(dx * dx + dy * dy)
    size, ra, rb = take(data, at + SIZE), take(data, at + RADIUS_A), take(data, at + RADIUS_B)
    separation = distance - ra - rb
    scale = choose(distance > 0.0, 1.0 / distance, 0.0)
    put(data, at + NORMAL_X, dx * scale)
    put(data, at + NORMAL_Y, dy * scale)
    put(data, at + ONE + SEPARATION, separation)
    apart, on_one_spot = separation > 0.5 * near * size + speculative_margin, distance < _ONE_SPOT
    return mask_bits((apart | on_one_spot | (separation < -_DEEP * size)) & (ra > 0.0))


@fused
def _separation(
    data: Numbers, point: int, x: Wide, y: Wide, nx: Wide, ny: Wide, turn_a: Wide, turn_b: Wide
) -> Wide:
    """Return the separations of points, to second order in how far the pairs have moved and turned."""
    rax, ray = take(data, point + ARM_AX), take(data, point + ARM_AY)
    rbx, rby = take(data, point + ARM_BX), take(data, point + ARM_BY)
    ax, ay = turn_a * (-ray - 0.5 * turn_a * rax), turn_a * (rax - 0.5 * turn_a * ray)
    bx, by = turn_b * (-rby - 0.5 * turn_b * rbx), turn_b * (rbx - 0.5 * turn_b * rby)
    separation = take(data, point + FOUND) + (x + bx - ax) * nx + (y + by - ay) * ny
    put(data, point + SEPARATION, separation)
    return separation


@fused
def _refresh_boxes(
    data: Numbers, at: int, a: Rows, b: Rows, slot: int, position: Vectors, angle: Numbers,
    keep: float, keep_turn: float,
) -> int:  # fmt: skip
    """Update the separations of a block of boxes; return which points must be found again."""
    xa, ya = take_vectors(position, a, slot)
    xb, yb = take_vectors(position, b, slot)
    nx, ny = take(data, at + NORMAL_X), take(data, at + NORMAL_Y)
    x, y = xb - xa - take(data, at + BASE_X), yb - ya - take(data, at + BASE_Y)
    turn_a = take_numbers(angle, a, slot) - take(data, at + ANGLE_A)
    turn_b = take_numbers(angle, b, slot) - take(data, at + ANGLE_B)
    one = _separation(data, at + ONE, x, y, nx, ny, turn_a, turn_b)
    two = _separation(data, at + TWO, x, y, nx, ny, turn_a, turn_b)
    size = take(data, at + SIZE)
    moved = (
        (size_of(x) + size_of(y) > keep * size)
        | (size_of(turn_a) > keep_turn)
        | (size_of(turn_b) > keep_turn)
    )
    deep = -_DEEP * size
    return mask_bits(moved | (one < deep) | (two < deep))


@inlined
def refresh(
    kind: int, data: Numbers, blocks: int, a: Rows, b: Rows, pair: Rows, colour: Rows, used: Masks,
    manifolds: Manifolds, points: Points, scalar: Rows, scalar_count: int,
    position: Vectors, angle: Numbers, linear: Vectors, angular: Numbers,
    first: bool, h: float, still: float, near: float, speculative_margin: float, keep: float,
    keep_turn: float,
) -> int:  # fmt: skip
    """Find where the contacts of all blocks of a kind touch now; return how many pairs are scalar.

    What is too fast (looked at in the ``first`` substep of a step), has come apart, overlaps deeply, or whose
    points must be found again is written to its records and added to ``scalar``.
    """
    rows = DISC_ROWS if kind == DISC else BOX_ROWS
    slow = 0.5 * still if kind == DISC else 0.5 * near
    for k in range(blocks):
        at, slot = k * rows, k * WIDE
        lost = _restless(data, at, a, b, slot, linear, slow, h) if first else 0
        if kind == DISC:
            lost |= _refresh_discs(data, at, a, b, slot, position, near, speculative_margin)
        else:
            lost |= _refresh_boxes(data, at, a, b, slot, position, angle, keep, keep_turn)
        if lost != 0:
            scalar_count = _set_scalar(
                data, rows, k, lost, a, b, pair, colour, used, manifolds, points, scalar, scalar_count
            )
    return scalar_count


@inlined
def _set_scalar(
    data: Numbers, rows: int, k: int, lost: int, a: Rows, b: Rows, pair: Rows, colour: Rows, used: Masks,
    manifolds: Manifolds, points: Points, scalar: Rows, scalar_count: int,
) -> int:  # fmt: skip
    """Write the slots of a block that are ``lost`` to their records; return how many pairs are scalar."""
    for slot in range(WIDE):
        p = pair[k * WIDE + slot]
        if p >= 0 and (lost >> slot) & 1:
            store_slot(data, rows, k * WIDE + slot, p, manifolds, points)
            manifolds[p].slot = -1
            scalar[scalar_count] = p
            scalar_count += 1
            empty_slot(data, rows, k * WIDE + slot, a, b, pair, colour, used)
    return scalar_count


@kernel
def deepest_wide(kind: int, data: Numbers, blocks: int) -> float:
    """Return the deepest overlap in all blocks of a kind [m]."""
    rows, depth = (DISC_ROWS if kind == DISC else BOX_ROWS), 0.0
    for k in range(blocks):
        for slot in range(WIDE):
            depth = max(depth, -data[k * rows + ONE + SEPARATION + slot])
            if kind == BOX:
                depth = max(depth, -data[k * rows + TWO + SEPARATION + slot])
    return depth
