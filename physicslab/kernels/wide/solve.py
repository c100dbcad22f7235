"""Impulses at wide contacts, eight at a time, by the formulas of ``kernels/solver/impulse.py``."""

from typing import NamedTuple

from physicslab.kernels import Numbers, Vectors, always_inlined, inlined
from physicslab.kernels import wide_layout as L
from physicslab.kernels.arguments import Motion, Near
from physicslab.kernels.constraint.pair import (
    ContactFrame,
    PairInverseMass,
    PairVelocity,
    after_impulse,
    along_and_across,
    impulse_at,
    moment_arms,
    moments_of,
    response,
)
from physicslab.kernels.float64x8 import (
    Wide,
    choose,
    everywhere,
    fetch,
    greater,
    lesser,
    put,
    put_numbers,
    put_vectors,
    sum_of,
    take,
    take_numbers,
    take_vectors,
)
from physicslab.kernels.near_counts import BOX_BLOCKS, DISC_BLOCKS

SOFT = 0.02
"""Share of the smaller body's size that the contact spring corrects at its full rate, in addition to what the
load causes."""
_NO_OVERLAP = 1e-9
"""Share that does not count as overlap: rounding may put a corner of a box on a floor below its surface."""
DEEPER = 0.15
"""Share beyond which overlap is not corrected by impulses."""
_CACHED = 384
"""Blocks up to which they stay in the nearer caches from one sweep to the next."""


class SoftConstraint(NamedTuple):
    """How contacts are corrected in an iteration.

    One over the substep [1/s], the share of the overlap that is corrected a second, the shares of the
    effective mass and of the impulse so far that take part, the impulse of all forces [N s], and the share
    that a deep overlap gives up in a sweep of what presses it by more than that. Last, the share of the
    smaller body beyond which no load presses it in: from there on the spring is as stiff as the load needs.
    """

    inverse_h: float
    push_rate: float
    mass_scale: float
    impulse_scale: float
    force_cap: float
    give: float
    sunk: float


class Mean(NamedTuple):
    """Velocities (rows, 2) [m/s] and angular velocities [rad/s], the mean of before and after impulses."""

    linear: Vectors
    angular: Numbers


type Work = tuple[Wide, Wide]
"""Work of normal and of tangential impulses [J], slot by slot."""


class ContactSpring[N: (float, Wide)](NamedTuple):
    """How the normal impulse of a point answers to its velocity and to itself, for the separation of now.

    The effective mass that takes part [kg], and what closes a gap [N s]; what pushes out overlap, negative,
    and its limit where no load presses [N s]; how much of an impulse the spring gives back at most [N s]; and
    the share that it gives up of what is beyond the impulse of all forces.
    """

    gain: N
    closing: N
    push: N
    limit: N
    given: N
    give: N


@always_inlined
def spring_of[N: (float, Wide)](mass: N, separation: N, size: N, soft: SoftConstraint) -> ContactSpring[N]:
    """Return the spring of a point, by its effective mass [kg] and the size of the smaller body [m].

    An overlap is held by a stiff, overdamped spring that corrects ``push_rate`` of the overlap a second,
    no faster than balances twice the load: else a pile of overlapping bodies would burst. Bodies that are
    apart may close the separation within the substep, and not more. Deep overlap gives way to what no force
    presses: a driven body would press what it cannot move ever harder, until that flies to the side.
    """
    soft_mass = soft.mass_scale * mass
    apart, deep = separation > -_NO_OVERLAP * size, separation < -DEEPER * size
    push = soft_mass * soft.push_rate * lesser(separation, 0.0)
    most = soft_mass * size * soft.push_rate
    return ContactSpring(
        choose(apart, mass, soft_mass),
        choose(apart, -mass * (separation * soft.inverse_h), 0.0),
        choose(apart, 0.0, choose(deep, 0.0, push)),
        most * SOFT,
        choose(apart, 0.0, most * soft.sunk),
        choose(deep, soft.give, 0.0),
    )


@always_inlined
def free_impulse[N: (float, Wide)](impulse: N, v: N, spring: ContactSpring[N], soft: SoftConstraint) -> N:
    """Return the normal impulse [N s] that an iteration gives a point which approaches at -v [m/s].

    It may come to pull.
    """
    load = lesser(impulse, soft.force_cap) * (2.0 * soft.impulse_scale)
    push = greater(spring.push, -(spring.limit + load))
    given = lesser(soft.impulse_scale * impulse, spring.given)
    yielding = spring.give * greater(impulse - soft.force_cap, 0.0)
    free: N = impulse + (spring.closing - push - given - yielding) - spring.gain * v
    return free


@always_inlined
def two_normals[N: (float, Wide)](
    impulse1: N, impulse2: N, free1: N, free2: N, between1: N, between2: N
) -> tuple[N, N]:
    """Return the changes of the normal impulses of two points that act on each other [N s].

    ``free1`` and ``free2`` are those of :func:`free_impulse` for each by itself; ``between1`` is how much
    less the first one takes for each N s at the second. Each is solved before the other, and the mean of both
    is taken: what is symmetric stays so. Solved exactly, points that are nearly one would be given large
    opposite impulses, and heaps of mixed bodies would never rest.
    """
    before1, before2 = greater(free1, 0.0), greater(free2, 0.0)
    after1 = greater(free1 + between1 * impulse2 - between1 * before2, 0.0)
    after2 = greater(free2 + between2 * impulse1 - between2 * before1, 0.0)
    total1: N = 0.5 * (before1 + after1)
    total2: N = 0.5 * (before2 + after2)
    return total1 - impulse1, total2 - impulse2


@always_inlined
def held_by_friction[N: (float, Wide)](free: N, limit: N) -> N:
    """Return a tangential impulse [N s], of which friction gives at most ``limit``."""
    held: N = lesser(greater(free, -limit), limit)
    return held


@always_inlined
def two_frictions[N: (float, Wide)](
    impulse1: N, impulse2: N, free1: N, free2: N, limit1: N, limit2: N, across1: N, across2: N
) -> tuple[N, N]:
    """Return the changes of the tangential impulses of two points [N s], which are treated alike.

    ``free1`` and ``free2`` are those that stop each by itself. See :func:`two_normals`.
    """
    before1, before2 = held_by_friction(free1, limit1), held_by_friction(free2, limit2)
    after1 = held_by_friction(free1 + across1 * impulse2 - across1 * before2, limit1)
    after2 = held_by_friction(free2 + across2 * impulse1 - across2 * before1, limit2)
    total1: N = 0.5 * (before1 + after1)
    total2: N = 0.5 * (before2 + after2)
    return total1 - impulse1, total2 - impulse2


@always_inlined
def work_of[N: (float, Wide)](
    along: N, impulse: N, turn_a: N, turn_b: N, mass: N, inertia_a: N, inertia_b: N
) -> N:
    """Return the work of impulses on a pair along one direction [J]: each at its point's mean velocity.

    ``along`` is that at the velocities before. ``impulse`` and the moments ``turn_a`` and ``turn_b``, of all
    of them together, change the velocities; ``mass`` is the sum of both inverse masses [1/kg].
    """
    changed: N = mass * (impulse * impulse) + inertia_a * (turn_a * turn_a) + inertia_b * (turn_b * turn_b)
    return along + 0.5 * changed


@always_inlined
def _free_impulse(
    data: Numbers, point: int, size: Wide, v: Wide, drift: float, soft: SoftConstraint
) -> tuple[Wide, Wide]:
    """Update the separations of points by the velocity; return free impulses, and the masses in them."""
    separation = take(data, point + L.SEPARATION)
    if drift != 0.0:
        separation = separation + drift * v
        put(data, point + L.SEPARATION, separation)
    spring = spring_of(take(data, point + L.MASS), separation, size, soft)
    return free_impulse(take(data, point + L.IMPULSE), v, spring, soft), spring.gain


@always_inlined
def _free_friction(data: Numbers, point: int, v: Wide) -> tuple[Wide, Wide, Wide]:
    """Return tangential impulses, those that would stop points that slide at v, and the masses of these."""
    impulse, mass = take(data, point + L.TANGENT_IMPULSE), take(data, point + L.TANGENT_MASS)
    return impulse, impulse - mass * v, mass


@always_inlined
def _velocities(slots: L.Slots, k: int, linear: Vectors, angular: Numbers) -> PairVelocity[Wide]:
    """Return the velocities and angular velocities of A and of B in a block."""
    ax, ay = take_vectors(linear, slots.a, k * L.WIDE)
    bx, by = take_vectors(linear, slots.b, k * L.WIDE)
    wa, wb = take_numbers(angular, slots.a, k * L.WIDE), take_numbers(angular, slots.b, k * L.WIDE)
    return PairVelocity(ax, ay, wa, bx, by, wb)


@always_inlined
def mean_velocities(slots: L.Slots, k: int, mean: Mean) -> PairVelocity[Wide]:
    """Return the mean velocities in a block, of before and after impulses."""
    return _velocities(slots, k, mean.linear, mean.angular)


@always_inlined
def _put_velocities(slots: L.Slots, k: int, motion: Motion, v: PairVelocity[Wide]) -> None:
    """Write the velocities of A and of B in a block."""
    put_vectors(motion.linear, slots.a, k * L.WIDE, v.ax, v.ay)
    put_vectors(motion.linear, slots.b, k * L.WIDE, v.bx, v.by)
    put_numbers(motion.angular, slots.a, k * L.WIDE, v.wa)
    put_numbers(motion.angular, slots.b, k * L.WIDE, v.wb)


@always_inlined
def _sweep_discs(
    slots: L.Slots, k: int, motion: Motion, mean: Mean, drift: float, soft: SoftConstraint, booked: bool
) -> Work:
    """Solve a block of discs; normal impulses turn no disc, so friction does not depend on them.

    Where it is ``booked`` this returns the work of the sweep's impulses; where there is a ``drift`` also that
    of those so far, at the ``mean`` velocities.
    """
    data, at = slots.data, k * L.DISC_ROWS
    v = _velocities(slots, k, motion.linear, motion.angular)
    nx, ny = take(data, at + L.NORMAL_X), take(data, at + L.NORMAL_Y)
    ra, rb = take(data, at + L.RADIUS_A), take(data, at + L.RADIUS_B)
    impulse, tangent = take(data, at + L.ONE + L.IMPULSE), take(data, at + L.ONE + L.TANGENT_IMPULSE)
    approach, across = along_and_across(nx, ny, v.bx - v.ax, v.by - v.ay)
    across = across - rb * v.wb - ra * v.wa
    free, _ = _free_impulse(data, at + L.ONE, take(data, at + L.SIZE), approach, drift, soft)
    pressing = greater(free, 0.0)
    push = pressing - impulse
    put(data, at + L.ONE + L.IMPULSE, pressing)
    held = held_by_friction(
        tangent - take(data, at + L.ONE + L.TANGENT_MASS) * across, take(data, at + L.FRICTION) * pressing
    )
    friction_impulse = held - tangent
    put(data, at + L.ONE + L.TANGENT_IMPULSE, held)
    px, py = impulse_at(nx, ny, push, friction_impulse)
    ma, mb = take(data, at + L.MASS_A), take(data, at + L.MASS_B)
    ia, ib = take(data, at + L.INERTIA_A), take(data, at + L.INERTIA_B)
    answer = PairInverseMass(ma, ia * ra, mb, ib * rb)  # of discs, to a tangential impulse
    after = after_impulse(v, answer, px, py, friction_impulse, -friction_impulse)
    _put_velocities(slots, k, motion, after)
    pressed, friction_work = everywhere(0.0), everywhere(0.0)
    if booked:
        pressed = push * (approach + 0.5 * (ma + mb) * push)
        friction_work = work_of(
            friction_impulse * across, friction_impulse, ra * friction_impulse, rb * friction_impulse,
            ma + mb, ia, ib,
        )  # fmt: skip
    if drift != 0.0:
        u = mean_velocities(slots, k, mean)
        along, across = along_and_across(nx, ny, u.bx - u.ax, u.by - u.ay)
        pressed = pressed + impulse * along
        friction_work = friction_work + tangent * (across - rb * u.wb - ra * u.wa)
    return pressed, friction_work


@always_inlined
def _frame(data: Numbers, point: int, nx: Wide, ny: Wide) -> ContactFrame[Wide]:
    """Return normals, and the arms of points."""
    ax, ay = take(data, point + L.ARM_AX), take(data, point + L.ARM_AY)
    return ContactFrame(nx, ny, ax, ay, take(data, point + L.ARM_BX), take(data, point + L.ARM_BY))


@always_inlined
def slot_frame(slots: L.Slots, at: int, point: int) -> ContactFrame[float]:
    """Return the normal and the arms of a point, ``ONE`` or ``TWO``, of a single slot that is at ``at``."""
    data, base = slots.data, at + point
    nx, ny = data[at + L.NORMAL_X], data[at + L.NORMAL_Y]
    if slots.kind == L.DISC:
        ra, rb = data[at + L.RADIUS_A], data[at + L.RADIUS_B]
        return ContactFrame(nx, ny, ra * nx, ra * ny, -rb * nx, -rb * ny)
    ax, ay = data[base + L.ARM_AX], data[base + L.ARM_AY]
    return ContactFrame(nx, ny, ax, ay, data[base + L.ARM_BX], data[base + L.ARM_BY])


@always_inlined
def _sweep_boxes(
    slots: L.Slots, k: int, motion: Motion, mean: Mean, drift: float, soft: SoftConstraint, booked: bool
) -> Work:
    """Solve a block of boxes: both normal impulses, then both points' friction.

    Velocities at the points are computed once; the effect of one point's impulse on the other's velocity is
    added (by the effective mass between them), which is a shorter dependency than the bodies' velocities.
    Returns what :func:`_sweep_discs` does.
    """
    data, at = slots.data, k * L.BOX_ROWS
    v = _velocities(slots, k, motion.linear, motion.angular)
    nx, ny = take(data, at + L.NORMAL_X), take(data, at + L.NORMAL_Y)
    ma, mb = take(data, at + L.MASS_A), take(data, at + L.MASS_B)
    ia, ib = take(data, at + L.INERTIA_A), take(data, at + L.INERTIA_B)
    size, friction = take(data, at + L.SIZE), take(data, at + L.FRICTION)
    mass = PairInverseMass(ma, ia, mb, ib)
    n1a, n1b, t1a, t1b = moment_arms(_frame(data, at + L.ONE, nx, ny))
    n2a, n2b, t2a, t2b = moment_arms(_frame(data, at + L.TWO, nx, ny))
    along, across = along_and_across(nx, ny, v.bx - v.ax, v.by - v.ay)
    approach1, approach2 = along + v.wb * n1b - v.wa * n1a, along + v.wb * n2b - v.wa * n2a
    free1, gain1 = _free_impulse(data, at + L.ONE, size, approach1, drift, soft)
    free2, gain2 = _free_impulse(data, at + L.TWO, size, approach2, drift, soft)
    impulse1, impulse2 = take(data, at + L.ONE + L.IMPULSE), take(data, at + L.TWO + L.IMPULSE)
    between = response(ma + mb, ia, ib, n1a, n1b, n2a, n2b)
    push1, push2 = two_normals(impulse1, impulse2, free1, free2, between * gain1, between * gain2)
    put(data, at + L.ONE + L.IMPULSE, impulse1 + push1)
    put(data, at + L.TWO + L.IMPULSE, impulse2 + push2)
    turn_a, turn_b = n1a * push1 + n2a * push2, n1b * push1 + n2b * push2
    wa, wb = v.wa - ia * turn_a, v.wb + ib * turn_b
    pressed, friction_work = everywhere(0.0), everywhere(0.0)
    if booked:
        pressed = work_of(
            push1 * approach1 + push2 * approach2, push1 + push2, turn_a, turn_b, ma + mb, ia, ib
        )
    sliding1, sliding2 = across + wb * t1b - wa * t1a, across + wb * t2b - wa * t2a
    tangent1, stop1, mass1 = _free_friction(data, at + L.ONE, sliding1)
    tangent2, stop2, mass2 = _free_friction(data, at + L.TWO, sliding2)
    between = response(ma + mb, ia, ib, t1a, t1b, t2a, t2b)
    friction1, friction2 = two_frictions(
        tangent1, tangent2, stop1, stop2, friction * (impulse1 + push1), friction * (impulse2 + push2),
        between * mass1, between * mass2,
    )  # fmt: skip
    put(data, at + L.ONE + L.TANGENT_IMPULSE, tangent1 + friction1)
    put(data, at + L.TWO + L.TANGENT_IMPULSE, tangent2 + friction2)
    push, friction_impulse = push1 + push2, friction1 + friction2
    px, py = impulse_at(nx, ny, push, friction_impulse)
    turn_a, turn_b = t1a * friction1 + t2a * friction2, t1b * friction1 + t2b * friction2
    turned = PairVelocity(v.ax, v.ay, wa, v.bx, v.by, wb)
    _put_velocities(slots, k, motion, after_impulse(turned, mass, px, py, turn_a, turn_b))
    if booked:
        friction_work = work_of(
            friction1 * sliding1 + friction2 * sliding2, friction_impulse, turn_a, turn_b, ma + mb, ia, ib
        )
    if drift != 0.0:
        u = mean_velocities(slots, k, mean)
        along, across = along_and_across(nx, ny, u.bx - u.ax, u.by - u.ay)
        pressed = pressed + impulse1 * (along + u.wb * n1b - u.wa * n1a)
        pressed = pressed + impulse2 * (along + u.wb * n2b - u.wa * n2a)
        friction_work = friction_work + tangent1 * (across + u.wb * t1b - u.wa * t1a)
        friction_work = friction_work + tangent2 * (across + u.wb * t2b - u.wa * t2a)
    return pressed, friction_work


@always_inlined
def _fetch_next(slots: L.Slots, number: int, blocks: int, rows: int) -> None:
    """Fetch the block after the one at hand, where there are more than the nearest caches hold."""
    if blocks > _CACHED:
        k = slots.order[min(number + 1, blocks - 1)]
        for row in range(0, min(rows, L.SWEPT), L.WIDE):
            fetch(slots.data, k * rows + row)
        fetch(slots.a, k * L.WIDE)
        fetch(slots.b, k * L.WIDE)


@inlined
def sweep_wide(
    near: Near, motion: Motion, drift: float, soft: SoftConstraint, booked: bool
) -> tuple[float, float]:
    """Solve all blocks once. Separations are first advanced by ``drift`` s at the present velocities.

    Returns the work of normal and of tangential impulses [J]: where it is ``booked`` that of this sweep's,
    and where there is a drift that of those before it, at the mean velocities that ``near.linear_before`` and
    the angular ones hold.
    """
    pressed, friction_work = everywhere(0.0), everywhere(0.0)
    mean = Mean(near.linear_before, near.angular_before)
    for number in range(near.counts[DISC_BLOCKS]):
        _fetch_next(near.discs, number, near.counts[DISC_BLOCKS], L.DISC_ROWS)
        one, other = _sweep_discs(near.discs, near.discs.order[number], motion, mean, drift, soft, booked)
        pressed, friction_work = pressed + one, friction_work + other
    for number in range(near.counts[BOX_BLOCKS]):
        _fetch_next(near.boxes, number, near.counts[BOX_BLOCKS], L.BOX_ROWS)
        one, other = _sweep_boxes(near.boxes, near.boxes.order[number], motion, mean, drift, soft, booked)
        pressed, friction_work = pressed + one, friction_work + other
    return sum_of(pressed), sum_of(friction_work)


@always_inlined
def _warm_start(
    data: Numbers, point: int, nx: Wide, ny: Wide, warm_start_scale: float
) -> tuple[Wide, Wide, Wide]:
    """Scale the impulses of a point; return their sum [N s], and the tangential one."""
    impulse, friction_impulse = take(data, point + L.IMPULSE), take(data, point + L.TANGENT_IMPULSE)
    if warm_start_scale != 1.0:
        impulse, friction_impulse = warm_start_scale * impulse, warm_start_scale * friction_impulse
        put(data, point + L.IMPULSE, impulse)
        put(data, point + L.TANGENT_IMPULSE, friction_impulse)
    px, py = impulse_at(nx, ny, impulse, friction_impulse)
    return px, py, friction_impulse


@always_inlined
def _start_discs(slots: L.Slots, k: int, motion: Motion, warm_start_scale: float) -> None:
    data, at = slots.data, k * L.DISC_ROWS
    v = _velocities(slots, k, motion.linear, motion.angular)
    px, py, friction_impulse = _warm_start(
        data, at + L.ONE, take(data, at + L.NORMAL_X), take(data, at + L.NORMAL_Y), warm_start_scale
    )
    ma, mb = take(data, at + L.MASS_A), take(data, at + L.MASS_B)
    ra, rb = take(data, at + L.RADIUS_A), take(data, at + L.RADIUS_B)
    answer = PairInverseMass(ma, take(data, at + L.INERTIA_A) * ra, mb, take(data, at + L.INERTIA_B) * rb)
    after = after_impulse(v, answer, px, py, friction_impulse, -friction_impulse)
    _put_velocities(slots, k, motion, after)


@always_inlined
def _start_boxes(slots: L.Slots, k: int, motion: Motion, warm_start_scale: float) -> None:
    data, at = slots.data, k * L.BOX_ROWS
    v = _velocities(slots, k, motion.linear, motion.angular)
    nx, ny = take(data, at + L.NORMAL_X), take(data, at + L.NORMAL_Y)
    x1, y1, _ = _warm_start(data, at + L.ONE, nx, ny, warm_start_scale)
    x2, y2, _ = _warm_start(data, at + L.TWO, nx, ny, warm_start_scale)
    turn1_a, turn1_b = moments_of(_frame(data, at + L.ONE, nx, ny), x1, y1)
    turn2_a, turn2_b = moments_of(_frame(data, at + L.TWO, nx, ny), x2, y2)
    mass = PairInverseMass(
        take(data, at + L.MASS_A),
        take(data, at + L.INERTIA_A),
        take(data, at + L.MASS_B),
        take(data, at + L.INERTIA_B),
    )
    after = after_impulse(v, mass, x1 + x2, y1 + y2, turn1_a + turn2_a, turn1_b + turn2_b)
    _put_velocities(slots, k, motion, after)


@inlined
def warm_start_wide(near: Near, motion: Motion, warm_start_scale: float) -> None:
    """Apply the impulses of the last substep, ``warm_start_scale`` times as large, at all blocks."""
    for number in range(near.counts[DISC_BLOCKS]):
        _fetch_next(near.discs, number, near.counts[DISC_BLOCKS], L.DISC_ROWS)
        _start_discs(near.discs, near.discs.order[number], motion, warm_start_scale)
    for number in range(near.counts[BOX_BLOCKS]):
        _fetch_next(near.boxes, number, near.counts[BOX_BLOCKS], L.BOX_ROWS)
        _start_boxes(near.boxes, near.boxes.order[number], motion, warm_start_scale)
