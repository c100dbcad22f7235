"""Where settled contacts touch now, eight at a time; those that have settled no longer are set loose."""

from physicslab.kernels import Numbers, Rows, Vectors, fused, inlined, kernel
from physicslab.kernels.block_lanes import Masks, give_up, store_lane
from physicslab.kernels.block_layout import (
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
    WA,
    WB,
    WIDE,
    XA,
    XB,
    YA,
    YB,
)  # fmt: skip
from physicslab.kernels.records import Manifolds, Points

__all__ = ["deepest_lane", "gather", "refresh", "scatter"]

_DEEP = 0.1
"""Share of the smaller size: what overlaps more is taken apart by moving, which lanes know nothing of."""


@fused
def gather(block: Numbers, k: int, a: Rows, b: Rows, vectors: Vectors, numbers: Numbers) -> None:
    """Bring together the places and angles, or the velocities, of the bodies of block k."""
    rows_a, rows_b = a[k * WIDE : (k + 1) * WIDE], b[k * WIDE : (k + 1) * WIDE]
    for lane in range(WIDE):
        i, j = rows_a[lane], rows_b[lane]
        block[XA + lane], block[YA + lane], block[WA + lane] = vectors[i, 0], vectors[i, 1], numbers[i]
        block[XB + lane], block[YB + lane], block[WB + lane] = vectors[j, 0], vectors[j, 1], numbers[j]


@fused
def scatter(block: Numbers, k: int, a: Rows, b: Rows, linear: Vectors, angular: Numbers) -> None:
    """Give the bodies of block k their velocities back; what nothing moves has the one it had."""
    rows_a, rows_b = a[k * WIDE : (k + 1) * WIDE], b[k * WIDE : (k + 1) * WIDE]
    for lane in range(WIDE):
        i, j = rows_a[lane], rows_b[lane]
        linear[i, 0], linear[i, 1], angular[i] = block[XA + lane], block[YA + lane], block[WA + lane]
        linear[j, 0], linear[j, 1], angular[j] = block[XB + lane], block[YB + lane], block[WB + lane]


@inlined
def _restless(block: Numbers, still: float, h: float) -> float:
    """Mark in row ``WA`` the lanes whose bodies move too fast for their size, ``still`` of it a substep."""
    moving = 0.0
    for lane in range(WIDE):
        ux, uy = (block[XB + lane] - block[XA + lane]) * h, (block[YB + lane] - block[YA + lane]) * h
        limit = still * block[SIZE + lane]
        fast = 1.0 if ux * ux + uy * uy > limit * limit else 0.0
        block[WA + lane] = fast
        moving += fast
    return moving


@inlined
def _refresh_discs(block: Numbers, near: float, fall: float) -> float:
    """Find normals and separations of a block of discs; mark what is apart or overlaps much in row ``WA``."""
    lost = 0.0
    for lane in range(WIDE):
        dx, dy = block[XB + lane] - block[XA + lane], block[YB + lane] - block[YA + lane]
        distance = (dx * dx + dy * dy) ** 0.5
        size = block[SIZE + lane]
        separation = distance - block[RADIUS_A + lane] - block[RADIUS_B + lane]
        gone = separation > 0.5 * near * size + fall
        bad = 1.0 if gone | (separation < -_DEEP * size) | (distance == 0.0) else 0.0
        bad = bad if block[RADIUS_A + lane] > 0.0 else 0.0
        scale = 1.0 / distance if distance > 0.0 else 0.0
        block[NORMAL_X + lane], block[NORMAL_Y + lane] = dx * scale, dy * scale
        block[ONE + SEPARATION + lane] = separation
        block[WA + lane] = bad
        lost += bad
    return lost


@fused
def _separation(
    block: Numbers, point: int, lane: int, x: float, y: float, nx: float, ny: float, turn_a: float,
    turn_b: float,
) -> float:  # fmt: skip
    """Return the separation of a point, to second order in how far the pair has moved and turned."""
    rax, ray = block[point + ARM_AX + lane], block[point + ARM_AY + lane]
    rbx, rby = block[point + ARM_BX + lane], block[point + ARM_BY + lane]
    ax, ay = turn_a * (-ray - 0.5 * turn_a * rax), turn_a * (rax - 0.5 * turn_a * ray)
    bx, by = turn_b * (-rby - 0.5 * turn_b * rbx), turn_b * (rbx - 0.5 * turn_b * rby)
    separation: float = block[point + FOUND + lane] + (x + bx - ax) * nx + (y + by - ay) * ny
    return separation


@inlined
def _refresh_boxes(block: Numbers, keep: float, keep_turn: float) -> float:
    """Update the separations of a block of boxes; mark in row ``WA`` whose points must be found anew."""
    lost = 0.0
    for lane in range(WIDE):
        nx, ny = block[NORMAL_X + lane], block[NORMAL_Y + lane]
        x = block[XB + lane] - block[XA + lane] - block[BASE_X + lane]
        y = block[YB + lane] - block[YA + lane] - block[BASE_Y + lane]
        turn_a, turn_b = block[WA + lane] - block[ANGLE_A + lane], block[WB + lane] - block[ANGLE_B + lane]
        size = block[SIZE + lane]
        one = _separation(block, ONE, lane, x, y, nx, ny, turn_a, turn_b)
        two = _separation(block, TWO, lane, x, y, nx, ny, turn_a, turn_b)
        block[ONE + SEPARATION + lane], block[TWO + SEPARATION + lane] = one, two
        moved = (abs(x) + abs(y) > keep * size) | (abs(turn_a) > keep_turn) | (abs(turn_b) > keep_turn)
        bad = 1.0 if moved | (one < -_DEEP * size) | (two < -_DEEP * size) else 0.0
        block[WA + lane] = bad
        lost += bad
    return lost


@kernel
def refresh(
    kind: int, data: Numbers, blocks: int, a: Rows, b: Rows, pair: Rows, colour: Rows, used: Masks,
    manifolds: Manifolds, points: Points, loose: Rows, loose_count: int,
    position: Vectors, angle: Numbers, linear: Vectors, angular: Numbers,
    first: bool, h: float, still: float, near: float, fall: float, keep: float, keep_turn: float,
) -> int:  # fmt: skip
    """Find where the contacts of all blocks of a kind touch now; return how many pairs are loose.

    What is too fast (looked at in the ``first`` substep of a step), has come apart, overlaps deeply, or whose
    points must be found anew is written to its records and added to ``loose``.
    """
    rows = DISC_ROWS if kind == DISC else BOX_ROWS
    for k in range(blocks):
        block = data[k * rows : (k + 1) * rows]
        if first:
            gather(block, k, a, b, linear, angular)
            slow = 0.5 * still if kind == DISC else 0.5 * near
            if _restless(block, slow, h) > 0.0:
                loose_count = _set_loose(
                    data, rows, k, a, b, pair, colour, used, manifolds, points, loose, loose_count
                )
        gather(block, k, a, b, position, angle)
        lost = _refresh_discs(block, near, fall) if kind == DISC else _refresh_boxes(block, keep, keep_turn)
        if lost > 0.0:
            loose_count = _set_loose(
                data, rows, k, a, b, pair, colour, used, manifolds, points, loose, loose_count
            )
    return loose_count


@inlined
def _set_loose(
    data: Numbers, rows: int, k: int, a: Rows, b: Rows, pair: Rows, colour: Rows, used: Masks,
    manifolds: Manifolds, points: Points, loose: Rows, loose_count: int,
) -> int:  # fmt: skip
    """Give the marked lanes of a block back to their records; return how many pairs are loose."""
    for lane in range(WIDE):
        p = pair[k * WIDE + lane]
        if p >= 0 and data[k * rows + WA + lane] > 0.0:
            store_lane(data, rows, k * WIDE + lane, p, manifolds, points)
            manifolds[p].lane = -1
            loose[loose_count] = p
            loose_count += 1
            give_up(data, rows, k * WIDE + lane, a, b, pair, colour, used)
    return loose_count


@kernel
def deepest_lane(kind: int, data: Numbers, blocks: int) -> float:
    """Return the deepest overlap in all blocks of a kind [m]."""
    rows, depth = (DISC_ROWS if kind == DISC else BOX_ROWS), 0.0
    for k in range(blocks):
        for lane in range(WIDE):
            depth = max(depth, -data[k * rows + ONE + SEPARATION + lane])
            if kind == BOX:
                depth = max(depth, -data[k * rows + TWO + SEPARATION + lane])
    return depth
