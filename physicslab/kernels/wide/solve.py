"""Impulses at settled contacts, eight at a time, by the formulas of ``kernels/solver/impulse.py``."""

from physicslab.kernels import Numbers, Rows, Vectors, fused, inlined
from physicslab.kernels.wide.float64x8 import (
    Wide,
    choose,
    greater,
    least,
    put,
    put_numbers,
    put_vectors,
    take,
    take_numbers,
    take_vectors,
)
from physicslab.kernels.wide.layout import (
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
    WIDE,
)  # fmt: skip

__all__ = ["DEEPER", "SOFT", "pressed", "start_lanes", "sweep_lanes"]

SOFT = 0.01
"""Share of the smaller body's size that the contact spring takes away at its full rate; the load on it comes
on top."""
_ROUNDING = 1e-12
"""Share that is no overlap: of the corners of a box that is put on a floor, one may lie in it by rounding."""
DEEPER = 0.15
"""Share beyond which overlap is not taken away by impulses."""


@fused
def pressed[N: (float, Wide)](
    impulse: N, mass: N, v: N, separation: N, size: N, inverse_h: float, push_rate: float,
    mass_scale: float, impulse_scale: float, slop: float, heaviest: float,
) -> N:  # fmt: skip
    """Return the normal impulse [N s] after one more look at a point that approaches at -v [m/s].

    Below the slop the contact is a stiff, overdamped spring that takes ``push_rate`` of the overlap a second;
    no faster than what balances twice the load, or a pile of overlapping bodies would fly apart. What is
    apart may close the separation within the time that the impulses stand for, and not more.
    """
    load = least(impulse, heaviest) * (2.0 * impulse_scale / mass_scale)
    most = mass * size * (push_rate * SOFT) + load
    push = greater(mass * push_rate * least(separation + slop * size, 0.0), -most)
    push = choose(separation < -DEEPER * size, 0.0, push)
    soft = impulse - mass_scale * (mass * v + push) - impulse_scale * impulse
    hard = impulse - mass * (v + separation * inverse_h)
    total: N = greater(choose(separation > -_ROUNDING * size, hard, soft), 0.0)
    return total


@fused
def _pushed(
    data: Numbers, point: int, size: Wide, v: Wide, drift: float, inverse_h: float,
    push_rate: float, mass_scale: float, impulse_scale: float, slop: float, heaviest: float,
) -> Wide:  # fmt: skip
    """Let the separations follow the velocity, set the normal impulses anew; return their change [N s]."""
    separation = take(data, point + SEPARATION)
    if drift != 0.0:
        separation = separation + drift * v
        put(data, point + SEPARATION, separation)
    impulse, mass = take(data, point + IMPULSE), take(data, point + MASS)
    total = pressed(
        impulse, mass, v, separation, size, inverse_h, push_rate, mass_scale, impulse_scale, slop, heaviest
    )
    put(data, point + IMPULSE, total)
    return total - impulse


@fused
def _rubbed(data: Numbers, point: int, friction: Wide, v: Wide) -> Wide:
    """Set the impulses across anew, mu times the normal ones at the most; return their change [N s]."""
    limit, rub = friction * take(data, point + IMPULSE), take(data, point + RUB)
    total: Wide = least(greater(rub - take(data, point + RUB_MASS) * v, -limit), limit)
    put(data, point + RUB, total)
    return total - rub


@fused
def _sweep_discs(
    data: Numbers, at: int, a: Rows, b: Rows, lane: int, linear: Vectors, angular: Numbers,
    drift: float, inverse_h: float, push_rate: float,
    mass_scale: float, impulse_scale: float, slop: float, heaviest: float,
) -> None:  # fmt: skip
    """Go through a block of discs; pushes turn no disc, so that friction sees nothing of them."""
    vax, vay = take_vectors(linear, a, lane)
    vbx, vby = take_vectors(linear, b, lane)
    wa, wb = take_numbers(angular, a, lane), take_numbers(angular, b, lane)
    nx, ny = take(data, at + NORMAL_X), take(data, at + NORMAL_Y)
    ra, rb = take(data, at + RADIUS_A), take(data, at + RADIUS_B)
    vx, vy = vbx - vax, vby - vay
    push = _pushed(
        data, at + ONE, take(data, at + SIZE), nx * vx + ny * vy, drift, inverse_h, push_rate, mass_scale,
        impulse_scale, slop, heaviest,
    )  # fmt: skip
    across = nx * vy - ny * vx - rb * wb - ra * wa
    rub = _rubbed(data, at + ONE, take(data, at + FRICTION), across)
    px, py = push * nx - rub * ny, push * ny + rub * nx
    ma, mb = take(data, at + MASS_A), take(data, at + MASS_B)
    put_vectors(linear, a, lane, vax - ma * px, vay - ma * py)
    put_vectors(linear, b, lane, vbx + mb * px, vby + mb * py)
    put_numbers(angular, a, lane, wa - take(data, at + INERTIA_A) * ra * rub)
    put_numbers(angular, b, lane, wb - take(data, at + INERTIA_B) * rb * rub)


@fused
def _levers(data: Numbers, point: int, nx: Wide, ny: Wide) -> tuple[Wide, Wide, Wide, Wide]:
    """Return how far normal and tangent pass by both centres [m]: r_a x n, r_b x n, r_a x t, r_b x t."""
    ax, ay = take(data, point + ARM_AX), take(data, point + ARM_AY)
    bx, by = take(data, point + ARM_BX), take(data, point + ARM_BY)
    return ax * ny - ay * nx, bx * ny - by * nx, ax * nx + ay * ny, bx * nx + by * ny


@fused
def _sweep_boxes(
    data: Numbers, at: int, a: Rows, b: Rows, lane: int, linear: Vectors, angular: Numbers,
    drift: float, inverse_h: float, push_rate: float,
    mass_scale: float, impulse_scale: float, slop: float, heaviest: float,
) -> None:  # fmt: skip
    """Go through a block of boxes: both pushes, then both points' friction.

    Velocities at the points are worked out once; what an impulse does to the next point's is added to it (the
    effective masses between them), for a processor waits less for that than for the bodies' velocities.
    """
    vax, vay = take_vectors(linear, a, lane)
    vbx, vby = take_vectors(linear, b, lane)
    wa, wb = take_numbers(angular, a, lane), take_numbers(angular, b, lane)
    nx, ny = take(data, at + NORMAL_X), take(data, at + NORMAL_Y)
    ma, mb = take(data, at + MASS_A), take(data, at + MASS_B)
    ia, ib = take(data, at + INERTIA_A), take(data, at + INERTIA_B)
    size, friction = take(data, at + SIZE), take(data, at + FRICTION)
    n1a, n1b, t1a, t1b = _levers(data, at + ONE, nx, ny)
    n2a, n2b, t2a, t2b = _levers(data, at + TWO, nx, ny)
    vx, vy = vbx - vax, vby - vay
    along, across = nx * vx + ny * vy, nx * vy - ny * vx
    push1 = _pushed(
        data, at + ONE, size, along + wb * n1b - wa * n1a, drift, inverse_h, push_rate, mass_scale,
        impulse_scale, slop, heaviest,
    )  # fmt: skip
    felt = push1 * (ma + mb + ia * n1a * n2a + ib * n1b * n2b)
    push2 = _pushed(
        data, at + TWO, size, along + wb * n2b - wa * n2a + felt, drift, inverse_h, push_rate,
        mass_scale, impulse_scale, slop, heaviest,
    )  # fmt: skip
    wa, wb = wa - ia * (n1a * push1 + n2a * push2), wb + ib * (n1b * push1 + n2b * push2)
    rub1 = _rubbed(data, at + ONE, friction, across + wb * t1b - wa * t1a)
    felt = rub1 * (ma + mb + ia * t1a * t2a + ib * t1b * t2b)
    rub2 = _rubbed(data, at + TWO, friction, across + wb * t2b - wa * t2a + felt)
    push, rub = push1 + push2, rub1 + rub2
    px, py = push * nx - rub * ny, push * ny + rub * nx
    put_vectors(linear, a, lane, vax - ma * px, vay - ma * py)
    put_vectors(linear, b, lane, vbx + mb * px, vby + mb * py)
    put_numbers(angular, a, lane, wa - ia * (t1a * rub1 + t2a * rub2))
    put_numbers(angular, b, lane, wb + ib * (t1b * rub1 + t2b * rub2))


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
        _sweep_discs(
            discs, k * DISC_ROWS, disc_a, disc_b, k * WIDE, linear, angular,
            drift, inverse_h, push_rate, mass_scale, impulse_scale, slop, heaviest,
        )  # fmt: skip
    for number in range(box_blocks):
        k = box_order[number]
        _sweep_boxes(
            boxes, k * BOX_ROWS, box_a, box_b, k * WIDE, linear, angular,
            drift, inverse_h, push_rate, mass_scale, impulse_scale, slop, heaviest,
        )  # fmt: skip


@fused
def _started(data: Numbers, point: int, nx: Wide, ny: Wide, carried: float) -> tuple[Wide, Wide, Wide]:
    """Carry over the impulses of a point; return both together [N s], and the one across."""
    impulse, rub = take(data, point + IMPULSE), take(data, point + RUB)
    if carried != 1.0:
        impulse, rub = carried * impulse, carried * rub
        put(data, point + IMPULSE, impulse)
        put(data, point + RUB, rub)
    return impulse * nx - rub * ny, impulse * ny + rub * nx, rub


@fused
def _start_discs(
    data: Numbers, at: int, a: Rows, b: Rows, lane: int, linear: Vectors, angular: Numbers, carried: float
) -> None:
    vax, vay = take_vectors(linear, a, lane)
    vbx, vby = take_vectors(linear, b, lane)
    wa, wb = take_numbers(angular, a, lane), take_numbers(angular, b, lane)
    px, py, rub = _started(data, at + ONE, take(data, at + NORMAL_X), take(data, at + NORMAL_Y), carried)
    ma, mb = take(data, at + MASS_A), take(data, at + MASS_B)
    ra, rb = take(data, at + RADIUS_A), take(data, at + RADIUS_B)
    put_vectors(linear, a, lane, vax - ma * px, vay - ma * py)
    put_vectors(linear, b, lane, vbx + mb * px, vby + mb * py)
    put_numbers(angular, a, lane, wa - take(data, at + INERTIA_A) * ra * rub)
    put_numbers(angular, b, lane, wb - take(data, at + INERTIA_B) * rb * rub)


@fused
def _turning(data: Numbers, point: int, px: Wide, py: Wide) -> tuple[Wide, Wide]:
    """Return the moments of an impulse about both centres [N m s]."""
    turn_a = take(data, point + ARM_AX) * py - take(data, point + ARM_AY) * px
    turn_b = take(data, point + ARM_BX) * py - take(data, point + ARM_BY) * px
    return turn_a, turn_b


@fused
def _start_boxes(
    data: Numbers, at: int, a: Rows, b: Rows, lane: int, linear: Vectors, angular: Numbers, carried: float
) -> None:
    vax, vay = take_vectors(linear, a, lane)
    vbx, vby = take_vectors(linear, b, lane)
    wa, wb = take_numbers(angular, a, lane), take_numbers(angular, b, lane)
    nx, ny = take(data, at + NORMAL_X), take(data, at + NORMAL_Y)
    x1, y1, _ = _started(data, at + ONE, nx, ny, carried)
    x2, y2, _ = _started(data, at + TWO, nx, ny, carried)
    turn1_a, turn1_b = _turning(data, at + ONE, x1, y1)
    turn2_a, turn2_b = _turning(data, at + TWO, x2, y2)
    px, py = x1 + x2, y1 + y2
    ma, mb = take(data, at + MASS_A), take(data, at + MASS_B)
    put_vectors(linear, a, lane, vax - ma * px, vay - ma * py)
    put_vectors(linear, b, lane, vbx + mb * px, vby + mb * py)
    put_numbers(angular, a, lane, wa - take(data, at + INERTIA_A) * (turn1_a + turn2_a))
    put_numbers(angular, b, lane, wb + take(data, at + INERTIA_B) * (turn1_b + turn2_b))


@inlined
def start_lanes(
    discs: Numbers, disc_blocks: int, disc_order: Rows, disc_a: Rows, disc_b: Rows,
    boxes: Numbers, box_blocks: int, box_order: Rows, box_a: Rows, box_b: Rows,
    linear: Vectors, angular: Numbers, carried: float,
) -> None:  # fmt: skip
    """Apply the impulses of the last substep, ``carried`` times as large, at all blocks."""
    for number in range(disc_blocks):
        k = disc_order[number]
        _start_discs(discs, k * DISC_ROWS, disc_a, disc_b, k * WIDE, linear, angular, carried)
    for number in range(box_blocks):
        k = box_order[number]
        _start_boxes(boxes, k * BOX_ROWS, box_a, box_b, k * WIDE, linear, angular, carried)
