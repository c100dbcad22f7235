"""Impulses at settled contacts, eight at a time, by the formulas of :mod:`physicslab.kernels.impulse`."""

from physicslab.kernels import Numbers, Rows, Vectors, inlined
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

__all__ = ["DEEPER", "SOFT", "start_lanes", "sweep_lanes"]

SOFT = 0.01
"""Share of the smaller body's size that the contact spring takes away at its full rate; the load on it comes
on top."""
DEEPER = 0.15
"""Share beyond which overlap is not taken away by impulses."""


@inlined
def _total(
    impulse: float, mass: float, v: float, separation: float, size: float, inverse_h: float, push_rate: float,
    mass_scale: float, impulse_scale: float, slop: float, heaviest: float,
) -> float:  # fmt: skip
    """Return the normal impulse [N s] after one more look at a point that approaches at -v."""
    load = min(impulse, heaviest) * impulse_scale / (mass_scale * mass)
    limit = push_rate * SOFT * size + 2.0 * load
    push = max(push_rate * min(separation + slop * size, 0.0), -limit)
    push = 0.0 if separation < -DEEPER * size else push
    apart = separation > 0.0
    bias = separation * inverse_h if apart else push
    hardness = 1.0 if apart else mass_scale
    softness = 0.0 if apart else impulse_scale
    return max(impulse - mass * hardness * (v + bias) - softness * impulse, 0.0)


@inlined
def _sweep_discs(
    block: Numbers, drift: float, inverse_h: float, push_rate: float, mass_scale: float, impulse_scale: float,
    slop: float, heaviest: float,
) -> None:  # fmt: skip
    for lane in range(WIDE):
        nx, ny = block[NORMAL_X + lane], block[NORMAL_Y + lane]
        ma, mb = block[MASS_A + lane], block[MASS_B + lane]
        vax, vay, wa = block[XA + lane], block[YA + lane], block[WA + lane]
        vbx, vby, wb = block[XB + lane], block[YB + lane], block[WB + lane]
        v = nx * (vbx - vax) + ny * (vby - vay)
        separation = block[ONE + SEPARATION + lane] + drift * v
        block[ONE + SEPARATION + lane] = separation
        impulse = block[ONE + IMPULSE + lane]
        total = _total(
            impulse, block[ONE + MASS + lane], v, separation, block[SIZE + lane], inverse_h, push_rate,
            mass_scale, impulse_scale, slop, heaviest,
        )  # fmt: skip
        block[ONE + IMPULSE + lane] = total
        change = total - impulse
        px, py = change * nx, change * ny
        vax, vay, vbx, vby = vax - ma * px, vay - ma * py, vbx + mb * px, vby + mb * py
        ra, rb = block[RADIUS_A + lane], block[RADIUS_B + lane]
        v = nx * (vby - vay) - ny * (vbx - vax) - rb * wb - ra * wa
        limit = block[FRICTION + lane] * total
        rub = block[ONE + RUB + lane]
        total = min(max(rub - block[ONE + RUB_MASS + lane] * v, -limit), limit)
        block[ONE + RUB + lane] = total
        change = total - rub
        px, py = -change * ny, change * nx
        block[XA + lane], block[YA + lane] = vax - ma * px, vay - ma * py
        block[XB + lane], block[YB + lane] = vbx + mb * px, vby + mb * py
        block[WA + lane] = wa - block[INERTIA_A + lane] * ra * change
        block[WB + lane] = wb - block[INERTIA_B + lane] * rb * change


@inlined
def _sweep_boxes(
    block: Numbers, drift: float, inverse_h: float, push_rate: float, mass_scale: float, impulse_scale: float,
    slop: float, heaviest: float,
) -> None:  # fmt: skip
    for lane in range(WIDE):
        nx, ny = block[NORMAL_X + lane], block[NORMAL_Y + lane]
        ma, mb, ia, ib = (
            block[MASS_A + lane], block[MASS_B + lane], block[INERTIA_A + lane], block[INERTIA_B + lane],
        )  # fmt: skip
        vax, vay, wa = block[XA + lane], block[YA + lane], block[WA + lane]
        vbx, vby, wb = block[XB + lane], block[YB + lane], block[WB + lane]
        for point in (ONE, TWO):
            rax, ray = block[point + ARM_AX + lane], block[point + ARM_AY + lane]
            rbx, rby = block[point + ARM_BX + lane], block[point + ARM_BY + lane]
            v = nx * (vbx - wb * rby - vax + wa * ray) + ny * (vby + wb * rbx - vay - wa * rax)
            separation = block[point + SEPARATION + lane] + drift * v
            block[point + SEPARATION + lane] = separation
            impulse = block[point + IMPULSE + lane]
            mass = block[point + MASS + lane]
            total = _total(
                impulse, mass, v, separation, block[SIZE + lane], inverse_h, push_rate, mass_scale,
                impulse_scale, slop, heaviest,
            )  # fmt: skip
            total = total if mass > 0.0 else 0.0
            block[point + IMPULSE + lane] = total
            change = total - impulse
            px, py = change * nx, change * ny
            vax, vay, wa = vax - ma * px, vay - ma * py, wa - ia * (rax * py - ray * px)
            vbx, vby, wb = vbx + mb * px, vby + mb * py, wb + ib * (rbx * py - rby * px)
        for point in (ONE, TWO):
            rax, ray = block[point + ARM_AX + lane], block[point + ARM_AY + lane]
            rbx, rby = block[point + ARM_BX + lane], block[point + ARM_BY + lane]
            v = nx * (vby + wb * rbx - vay - wa * rax) - ny * (vbx - wb * rby - vax + wa * ray)
            limit = block[FRICTION + lane] * block[point + IMPULSE + lane]
            rub = block[point + RUB + lane]
            total = min(max(rub - block[point + RUB_MASS + lane] * v, -limit), limit)
            block[point + RUB + lane] = total
            change = total - rub
            px, py = -change * ny, change * nx
            vax, vay, wa = vax - ma * px, vay - ma * py, wa - ia * (rax * py - ray * px)
            vbx, vby, wb = vbx + mb * px, vby + mb * py, wb + ib * (rbx * py - rby * px)
        block[XA + lane], block[YA + lane], block[WA + lane] = vax, vay, wa
        block[XB + lane], block[YB + lane], block[WB + lane] = vbx, vby, wb


@inlined
def sweep_lanes(
    discs: Numbers, disc_blocks: int, disc_a: Rows, disc_b: Rows,
    boxes: Numbers, box_blocks: int, box_a: Rows, box_b: Rows,
    linear: Vectors, angular: Numbers, drift: float, inverse_h: float, push_rate: float, mass_scale: float,
    impulse_scale: float, slop: float, heaviest: float,
) -> None:  # fmt: skip
    """Go once through all blocks. Separations first follow ``drift`` s of the velocities that are found."""
    for k in range(disc_blocks):
        block = discs[k * DISC_ROWS : (k + 1) * DISC_ROWS]
        gather(block, k, disc_a, disc_b, linear, angular)
        _sweep_discs(block, drift, inverse_h, push_rate, mass_scale, impulse_scale, slop, heaviest)
        scatter(block, k, disc_a, disc_b, linear, angular)
    for k in range(box_blocks):
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
    discs: Numbers, disc_blocks: int, disc_a: Rows, disc_b: Rows,
    boxes: Numbers, box_blocks: int, box_a: Rows, box_b: Rows,
    linear: Vectors, angular: Numbers, carried: float,
) -> None:  # fmt: skip
    """Apply the impulses of the last substep, ``carried`` times as large, at all blocks."""
    for k in range(disc_blocks):
        block = discs[k * DISC_ROWS : (k + 1) * DISC_ROWS]
        gather(block, k, disc_a, disc_b, linear, angular)
        _start_discs(block, carried)
        scatter(block, k, disc_a, disc_b, linear, angular)
    for k in range(box_blocks):
        block = boxes[k * BOX_ROWS : (k + 1) * BOX_ROWS]
        gather(block, k, box_a, box_b, linear, angular)
        _start_boxes(block, carried)
        scatter(block, k, box_a, box_b, linear, angular)
