"""Impulses at settled contacts, eight at a time, by the formulas of :mod:`physicslab.kernels.impulse`."""

from physicslab.kernels import Numbers, Rows, Vectors, fused, inlined
from physicslab.kernels.block_contact import gather, scatter
from physicslab.kernels.block_layout import (
    ARM_AX,
    ARM_AY,
    ARM_BX,
    ARM_BY,
    BOX_ROWS,
    DISC_ROWS,
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
    RUB,
    RUB_MASS,
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

__all__ = ["DEEPER", "SOFT", "pressed", "start_lanes", "sweep_lanes"]

SOFT = 0.01
"""Share of the smaller body's size that the contact spring takes away at its full rate; the load on it comes
on top."""
DEEPER = 0.15
"""Share beyond which overlap is not taken away by impulses."""


@fused
def pressed(
    impulse: float, mass: float, v: float, separation: float, size: float, inverse_h: float, push_rate: float,
    mass_scale: float, impulse_scale: float, slop: float, heaviest: float,
) -> float:  # fmt: skip
    """Return the normal impulse [N s] after one more look at a point that approaches at -v [m/s].

    Below the slop the contact is a stiff, overdamped spring that takes ``push_rate`` of the overlap a second;
    no faster than what balances twice the load, or a pile of overlapping bodies would fly apart. A positive
    separation may be closed within the time that the impulses stand for, and not more.
    """
    most = mass * push_rate * SOFT * size + 2.0 * min(impulse, heaviest) * impulse_scale / mass_scale
    push = max(mass * push_rate * min(separation + slop * size, 0.0), -most)
    push = 0.0 if separation < -DEEPER * size else push
    soft = impulse - mass_scale * (mass * v + push) - impulse_scale * impulse
    hard = impulse - mass * (v + separation * inverse_h)
    return max(hard if separation > 0.0 else soft, 0.0)


@fused
def _pushed(
    block: Numbers, point: int, lane: int, v: float, drift: float, inverse_h: float,
    push_rate: float, mass_scale: float, impulse_scale: float, slop: float, heaviest: float,
) -> float:  # fmt: skip
    """Let the separation follow the velocity, set the normal impulse anew; return its change [N s]."""
    separation = block[point + SEPARATION + lane] + drift * v
    block[point + SEPARATION + lane] = separation
    impulse, mass = block[point + IMPULSE + lane], block[point + MASS + lane]
    total = pressed(
        impulse, mass, v, separation, block[SIZE + lane], inverse_h, push_rate, mass_scale, impulse_scale,
        slop, heaviest,
    )  # fmt: skip
    block[point + IMPULSE + lane] = total
    change: float = total - impulse
    return change


@fused
def _rubbed(block: Numbers, point: int, lane: int, v: float) -> float:
    """Set the impulse across anew, mu times the normal one at the most; return its change [N s]."""
    limit, rub = block[FRICTION + lane] * block[point + IMPULSE + lane], block[point + RUB + lane]
    total = min(max(rub - block[point + RUB_MASS + lane] * v, -limit), limit)
    block[point + RUB + lane] = total
    change: float = total - rub
    return change


@inlined
def _sweep_discs(
    block: Numbers, drift: float, inverse_h: float, push_rate: float, mass_scale: float,
    impulse_scale: float, slop: float, heaviest: float,
) -> None:  # fmt: skip
    """Go through a block of discs; pushes turn no disc, so that friction sees nothing of them."""
    for lane in range(WIDE):
        nx, ny = block[NORMAL_X + lane], block[NORMAL_Y + lane]
        ra, rb = block[RADIUS_A + lane], block[RADIUS_B + lane]
        vx, vy = block[XB + lane] - block[XA + lane], block[YB + lane] - block[YA + lane]
        across = nx * vy - ny * vx - rb * block[WB + lane] - ra * block[WA + lane]
        push = _pushed(
            block, ONE, lane, nx * vx + ny * vy, drift, inverse_h, push_rate, mass_scale,
            impulse_scale, slop, heaviest,
        )  # fmt: skip
        rub = _rubbed(block, ONE, lane, across)
        px, py = push * nx - rub * ny, push * ny + rub * nx
        block[XA + lane] -= block[MASS_A + lane] * px
        block[YA + lane] -= block[MASS_A + lane] * py
        block[XB + lane] += block[MASS_B + lane] * px
        block[YB + lane] += block[MASS_B + lane] * py
        block[WA + lane] -= block[INERTIA_A + lane] * ra * rub
        block[WB + lane] -= block[INERTIA_B + lane] * rb * rub


@inlined
def _sweep_boxes(
    block: Numbers, drift: float, inverse_h: float, push_rate: float, mass_scale: float,
    impulse_scale: float, slop: float, heaviest: float,
) -> None:  # fmt: skip
    """Go through a block of boxes: both pushes, then both points' friction.

    Velocities at the points are worked out once; what an impulse does to the next point's is added to it (the
    effective masses between them), for a processor waits less for that than for the bodies' velocities.
    """
    for lane in range(WIDE):
        nx, ny = block[NORMAL_X + lane], block[NORMAL_Y + lane]
        ma, mb = block[MASS_A + lane], block[MASS_B + lane]
        ia, ib = block[INERTIA_A + lane], block[INERTIA_B + lane]
        vx, vy = block[XB + lane] - block[XA + lane], block[YB + lane] - block[YA + lane]
        wa, wb = block[WA + lane], block[WB + lane]
        ax, ay, bx, by = (
            block[ONE + ARM_AX + lane], block[ONE + ARM_AY + lane],
            block[ONE + ARM_BX + lane], block[ONE + ARM_BY + lane],
        )  # fmt: skip
        n1a, n1b, t1a, t1b = ax * ny - ay * nx, bx * ny - by * nx, ax * nx + ay * ny, bx * nx + by * ny
        ax, ay, bx, by = (
            block[TWO + ARM_AX + lane], block[TWO + ARM_AY + lane],
            block[TWO + ARM_BX + lane], block[TWO + ARM_BY + lane],
        )  # fmt: skip
        n2a, n2b, t2a, t2b = ax * ny - ay * nx, bx * ny - by * nx, ax * nx + ay * ny, bx * nx + by * ny
        along, across = nx * vx + ny * vy, nx * vy - ny * vx
        push1 = _pushed(
            block, ONE, lane, along + wb * n1b - wa * n1a, drift, inverse_h, push_rate, mass_scale,
            impulse_scale, slop, heaviest,
        )  # fmt: skip
        felt = push1 * (ma + mb + ia * n1a * n2a + ib * n1b * n2b)
        push2 = _pushed(
            block, TWO, lane, along + wb * n2b - wa * n2a + felt, drift, inverse_h, push_rate,
            mass_scale, impulse_scale, slop, heaviest,
        )  # fmt: skip
        turned_a, turned_b = ia * (n1a * push1 + n2a * push2), ib * (n1b * push1 + n2b * push2)
        wa, wb = wa - turned_a, wb + turned_b
        rub1 = _rubbed(block, ONE, lane, across + wb * t1b - wa * t1a)
        felt = rub1 * (ma + mb + ia * t1a * t2a + ib * t1b * t2b)
        rub2 = _rubbed(block, TWO, lane, across + wb * t2b - wa * t2a + felt)
        push, rub = push1 + push2, rub1 + rub2
        px, py = push * nx - rub * ny, push * ny + rub * nx
        block[XA + lane] -= ma * px
        block[YA + lane] -= ma * py
        block[XB + lane] += mb * px
        block[YB + lane] += mb * py
        block[WA + lane] = wa - ia * (t1a * rub1 + t2a * rub2)
        block[WB + lane] = wb + ib * (t1b * rub1 + t2b * rub2)


@inlined
def sweep_lanes(
    discs: Numbers, disc_blocks: int, disc_order: Rows, disc_a: Rows, disc_b: Rows,
    boxes: Numbers, box_blocks: int, box_order: Rows, box_a: Rows, box_b: Rows,
    linear: Vectors, angular: Numbers, drift: float, inverse_h: float, push_rate: float,
    mass_scale: float, impulse_scale: float, slop: float, heaviest: float,
) -> None:  # fmt: skip
    """Go once through all blocks. Separations first follow ``drift`` s of the velocities that are found."""
    for number in range(disc_blocks):
        k = disc_order[number]
        block = discs[k * DISC_ROWS : (k + 1) * DISC_ROWS]
        gather(block, k, disc_a, disc_b, linear, angular)
        _sweep_discs(block, drift, inverse_h, push_rate, mass_scale, impulse_scale, slop, heaviest)
        scatter(block, k, disc_a, disc_b, linear, angular)
    for number in range(box_blocks):
        k = box_order[number]
        block = boxes[k * BOX_ROWS : (k + 1) * BOX_ROWS]
        gather(block, k, box_a, box_b, linear, angular)
        _sweep_boxes(block, drift, inverse_h, push_rate, mass_scale, impulse_scale, slop, heaviest)
        scatter(block, k, box_a, box_b, linear, angular)


@inlined
def _start_discs(block: Numbers, carried: float) -> None:
    for lane in range(WIDE):
        nx, ny = block[NORMAL_X + lane], block[NORMAL_Y + lane]
        impulse, rub = carried * block[ONE + IMPULSE + lane], carried * block[ONE + RUB + lane]
        block[ONE + IMPULSE + lane], block[ONE + RUB + lane] = impulse, rub
        px, py = impulse * nx - rub * ny, impulse * ny + rub * nx
        ma, mb = block[MASS_A + lane], block[MASS_B + lane]
        block[XA + lane] -= ma * px
        block[YA + lane] -= ma * py
        block[XB + lane] += mb * px
        block[YB + lane] += mb * py
        block[WA + lane] -= block[INERTIA_A + lane] * block[RADIUS_A + lane] * rub
        block[WB + lane] -= block[INERTIA_B + lane] * block[RADIUS_B + lane] * rub


@inlined
def _start_boxes(block: Numbers, carried: float) -> None:
    for lane in range(WIDE):
        nx, ny = block[NORMAL_X + lane], block[NORMAL_Y + lane]
        x, y, turn_a, turn_b = 0.0, 0.0, 0.0, 0.0
        for point in (ONE, TWO):
            impulse, rub = carried * block[point + IMPULSE + lane], carried * block[point + RUB + lane]
            block[point + IMPULSE + lane], block[point + RUB + lane] = impulse, rub
            px, py = impulse * nx - rub * ny, impulse * ny + rub * nx
            turn_a += block[point + ARM_AX + lane] * py - block[point + ARM_AY + lane] * px
            turn_b += block[point + ARM_BX + lane] * py - block[point + ARM_BY + lane] * px
            x, y = x + px, y + py
        ma, mb = block[MASS_A + lane], block[MASS_B + lane]
        block[XA + lane] -= ma * x
        block[YA + lane] -= ma * y
        block[WA + lane] -= block[INERTIA_A + lane] * turn_a
        block[XB + lane] += mb * x
        block[YB + lane] += mb * y
        block[WB + lane] += block[INERTIA_B + lane] * turn_b


@inlined
def start_lanes(
    discs: Numbers, disc_blocks: int, disc_order: Rows, disc_a: Rows, disc_b: Rows,
    boxes: Numbers, box_blocks: int, box_order: Rows, box_a: Rows, box_b: Rows,
    linear: Vectors, angular: Numbers, carried: float,
) -> None:  # fmt: skip
    """Apply the impulses of the last substep, ``carried`` times as large, at all blocks."""
    for number in range(disc_blocks):
        k = disc_order[number]
        block = discs[k * DISC_ROWS : (k + 1) * DISC_ROWS]
        gather(block, k, disc_a, disc_b, linear, angular)
        _start_discs(block, carried)
        scatter(block, k, disc_a, disc_b, linear, angular)
    for number in range(box_blocks):
        k = box_order[number]
        block = boxes[k * BOX_ROWS : (k + 1) * BOX_ROWS]
        gather(block, k, box_a, box_b, linear, angular)
        _start_boxes(block, carried)
        scatter(block, k, box_a, box_b, linear, angular)
