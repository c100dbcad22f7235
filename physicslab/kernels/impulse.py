"""Impulses at contacts: impacts that bounce, and the forces that keep resting bodies apart."""

import math

from numba import boolean, float64, int64, void

from physicslab.kernels import inlined, kernel
from physicslab.kernels.records import Manifolds, Points

__all__ = ["deepest", "relax", "separate", "solve", "strike"]

_NUMBERS = float64[::1]
_VECTORS = float64[:, ::1]
_ROWS = int64[::1]

_SOFT = 0.01
"""Share of the smaller body's size that the contact spring takes away at its full rate; the load on it comes on top."""
_DEEP = 0.1
"""Share beyond which overlap is taken away by moving."""
_SWEEPS = 32
"""How often the impacts of a substep are gone through before what is left is treated as inelastic."""


@inlined
def _apply(point, px, py, a, b, linear, angular, inverse_mass, inverse_inertia):
    """Change the velocities of A by the impulse -(px, py) [N s] at the point and those of B by (px, py)."""
    linear[a, 0] -= inverse_mass[a] * px
    linear[a, 1] -= inverse_mass[a] * py
    angular[a] -= inverse_inertia[a] * (point.arm_ax * py - point.arm_ay * px)
    linear[b, 0] += inverse_mass[b] * px
    linear[b, 1] += inverse_mass[b] * py
    angular[b] += inverse_inertia[b] * (point.arm_bx * py - point.arm_by * px)


@inlined
def _relative_velocity(point, a, b, linear, angular):
    """Return the velocity of B's contact point against A's [m/s]."""
    vx = linear[b, 0] - angular[b] * point.arm_by - linear[a, 0] + angular[a] * point.arm_ay
    vy = linear[b, 1] + angular[b] * point.arm_bx - linear[a, 1] - angular[a] * point.arm_ax
    return vx, vy


@inlined
def _shift(a, b, before, position, angle, linear, angular, t):
    """Move A and B to where they would be, had their velocities changed at the time t from now, not now.

    Each has moved with the old velocity until t and moves with the new one from there on: x -= t (v_new - v_old).
    """
    position[a, 0] -= t * (linear[a, 0] - before[0])
    position[a, 1] -= t * (linear[a, 1] - before[1])
    angle[a] -= t * (angular[a] - before[2])
    position[b, 0] -= t * (linear[b, 0] - before[3])
    position[b, 1] -= t * (linear[b, 1] - before[4])
    angle[b] -= t * (angular[b] - before[5])


@inlined
def _meeting_time(separation, v, pull, start, end):
    """Return the first t in [start, end] at which separation + v t + pull t^2 / 2 = 0, for an approach v < 0.

    Infinity where that is later; 0 where it was earlier, for the two then have overlapped for longer.
    """
    root = v * v - 2.0 * pull * separation
    if root < 0.0:  # the forces keep them apart, or have held them together for longer
        return math.inf if separation > 0.0 else 0.0
    t = 2.0 * separation / (-v + math.sqrt(root))  # the form without cancellation
    if t > end:
        return math.inf
    # A meeting at the very seam of two substeps belongs to the later one.
    return t if t >= start - 1e-6 * (end - start) else 0.0


@inlined
def _bounce_two(manifold, one, two, v1, v2, inverse_mass, inverse_inertia):
    """Return the normal impulses that turn both approach speeds of a two-point contact into e times themselves.

    The two are solved together, so that a box that lands flat does not start to turn. Where one impulse would pull,
    the other acts alone.
    """
    a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
    turn_a1, turn_b1 = one.arm_ax * ny - one.arm_ay * nx, one.arm_bx * ny - one.arm_by * nx
    turn_a2, turn_b2 = two.arm_ax * ny - two.arm_ay * nx, two.arm_bx * ny - two.arm_by * nx
    k11, k22 = 1.0 / one.normal_mass, 1.0 / two.normal_mass
    k12 = inverse_mass[a] + inverse_mass[b] + inverse_inertia[a] * turn_a1 * turn_a2
    k12 += inverse_inertia[b] * turn_b1 * turn_b2
    r1, r2 = -(1.0 + manifold.restitution) * v1, -(1.0 + manifold.restitution) * v2
    determinant = k11 * k22 - k12 * k12
    if determinant > 1e-9 * k11 * k22:
        j1 = (k22 * r1 - k12 * r2) / determinant
        j2 = (k11 * r2 - k12 * r1) / determinant
        if j1 >= 0.0 and j2 >= 0.0:
            return j1, j2
    if r1 >= r2:
        return r1 / k11, 0.0
    return 0.0, r2 / k22


@inlined
def _hit(manifold, point, j, v, linear, angular, inverse_mass, inverse_inertia):
    """Apply a normal impulse and the friction that goes with it: what stops the sliding, mu times j at the most."""
    a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
    _apply(point, j * nx, j * ny, a, b, linear, angular, inverse_mass, inverse_inertia)
    point.approach_speed = max(point.approach_speed, -v)
    point.impact_normal += j
    if manifold.friction > 0.0:
        vx, vy = _relative_velocity(point, a, b, linear, angular)
        limit = manifold.friction * j
        rub = min(max(-point.tangent_mass * (vy * nx - vx * ny), -limit), limit)
        _apply(point, -rub * ny, rub * nx, a, b, linear, angular, inverse_mass, inverse_inertia)
        point.impact_tangent += rub


@inlined
def _strike_pair(
    manifold, one, two, position, angle, linear, angular, inverse_mass, inverse_inertia,
    v1, v2, pull, resting_speed, start, end,
):  # fmt: skip
    """Bounce one pair if it meets between ``start`` and ``end`` from now; return whether it did."""
    a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
    if manifold.swept == 2:
        one.ahead = 1
        return False
    moved_x = position[b, 0] - position[a, 0] - manifold.offset_x
    moved_y = position[b, 1] - position[a, 1] - manifold.offset_y
    moved = moved_x * nx + moved_y * ny
    # Half-way through leapfrog's substep, positions lack what the forces have done to them so far.
    moved += 0.125 * pull * (end - start) * (end - start)
    t1 = t2 = math.inf
    if v1 < -resting_speed:
        t1 = _meeting_time(one.separation + moved, v1, pull, start, end)
        one.ahead = 1 if t1 == math.inf else 0
    if v2 < -resting_speed:
        t2 = _meeting_time(two.separation + moved, v2, pull, start, end)
        two.ahead = 1 if t2 == math.inf else 0
    t = min(t1, t2)
    if t == math.inf:
        return False
    # The speeds at the time of contact, not those of now.
    v1, v2 = v1 + pull * t, v2 + pull * t
    before = (linear[a, 0], linear[a, 1], angular[a], linear[b, 0], linear[b, 1], angular[b])
    j1 = j2 = 0.0
    if t1 < math.inf and t2 < math.inf:
        j1, j2 = _bounce_two(manifold, one, two, v1, v2, inverse_mass, inverse_inertia)
    elif t1 < math.inf:
        j1 = -(1.0 + manifold.restitution) * v1 * one.normal_mass
    else:
        j2 = -(1.0 + manifold.restitution) * v2 * two.normal_mass
    if j1 > 0.0:
        _hit(manifold, one, j1, v1, linear, angular, inverse_mass, inverse_inertia)
    if j2 > 0.0:
        _hit(manifold, two, j2, v2, linear, angular, inverse_mass, inverse_inertia)
    _shift(a, b, before, position, angle, linear, angular, t)
    if manifold.swept == 1:  # its normal is not that of now: the solver must not push along it
        one.ahead = two.ahead = 1
    return j1 > 0.0 or j2 > 0.0


@inlined
def _forced(a, b, nx, ny, linear, force, inverse_mass, has_forces, h):
    """Return how B accelerates against A along the normal, and the speed below which an approach is no impact."""
    # At the least, an approach must be more than rounding.
    speed = abs(linear[a, 0]) + abs(linear[a, 1]) + abs(linear[b, 0]) + abs(linear[b, 1])
    if not has_forces:
        return 0.0, 1e-9 * speed
    ax, ay = force[a, 0] * inverse_mass[a], force[a, 1] * inverse_mass[a]
    bx, by = force[b, 0] * inverse_mass[b], force[b, 1] * inverse_mass[b]
    strongest = math.sqrt(max(ax * ax + ay * ay, bx * bx + by * by))
    return (bx - ax) * nx + (by - ay) * ny, 1e-9 * speed + 2.0 * h * strongest


@kernel(
    int64(
        Manifolds, Points, _ROWS, int64, _VECTORS, _NUMBERS, _VECTORS, _NUMBERS, _VECTORS, _NUMBERS, _NUMBERS,
        boolean, float64, float64, float64,
    )
)  # fmt: skip
def strike(
    manifolds, points, touching, count, position, angle, linear, angular, force, inverse_mass, inverse_inertia,
    has_forces, h, start, end,
):  # fmt: skip
    """Bounce the pairs that meet in this substep, each at its own time; return how many impacts there were.

    The substep spans the times ``start`` to ``end`` from now. An impact at the time t takes the speeds of that time,
    j = -(1 + e) v_n / effective mass with friction up to mu j, and leaves the bodies where they would be had they
    bounced then: that is exact for constant forces, and keeps energy (e = 1), momentum and angular momentum.

    A pair approaches if it is faster than what the forces can bring about in two substeps: less than that is resting
    contact, which the solver handles. Pairs are taken one after the other, in order, until none is left that meets;
    inelastic ones only once, for what is left of their approach the solver takes away.
    """
    impacts = 0
    for sweep in range(_SWEEPS):
        bounced = 0
        for k in range(count):
            p = touching[k]
            manifold = manifolds[p]
            if sweep > 0 and manifold.restitution == 0.0:
                continue
            # Most pairs rest: what follows settles those without a call.
            a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
            one, two = points[2 * p], points[2 * p + 1]
            one.ahead = two.ahead = 0
            vx, vy = _relative_velocity(one, a, b, linear, angular)
            v1, v2 = vx * nx + vy * ny, 0.0
            if manifold.count == 2:
                vx, vy = _relative_velocity(two, a, b, linear, angular)
                v2 = vx * nx + vy * ny
            if v1 >= 0.0 and v2 >= 0.0:
                continue
            pull, resting_speed = _forced(a, b, nx, ny, linear, force, inverse_mass, has_forces, h)
            if v1 >= -resting_speed and v2 >= -resting_speed:
                continue
            if start >= 0.0:  # in symplectic Euler the forces have acted already
                pull = 0.0
            if _strike_pair(
                manifold, one, two, position, angle, linear, angular, inverse_mass, inverse_inertia,
                v1, v2, pull, resting_speed, start, end,
            ):  # fmt: skip
                bounced += 1
                manifold.struck += 1
        impacts += bounced
        if bounced == 0:
            break
    if impacts:
        _measure_again(manifolds, points, touching, count, position)
    return impacts


@inlined
def _measure_again(manifolds, points, touching, count, position):
    """Bring separations up to date after impacts have moved bodies."""
    for k in range(count):
        p = touching[k]
        manifold = manifolds[p]
        x = position[manifold.b, 0] - position[manifold.a, 0]
        y = position[manifold.b, 1] - position[manifold.a, 1]
        moved = (x - manifold.offset_x) * manifold.normal_x + (y - manifold.offset_y) * manifold.normal_y
        for j in range(2 * p, 2 * p + manifold.count):
            points[j].separation += moved
        manifold.offset_x, manifold.offset_y = x, y


@inlined
def _sweep(
    manifolds, points, touching, count, linear, angular, inverse_mass, inverse_inertia,
    inverse_h, push_rate, mass_scale, impulse_scale, slop,
):  # fmt: skip
    """Go once through all contacts, each against the velocities that the others left; friction goes by the newest
    normal impulse.

    Below the slop the contact is a stiff, overdamped spring that takes push_rate of the overlap a second. A positive separation may be closed within the time that the impulses stand for, and not more.
    """
    for k in range(count):
        p = touching[k]
        manifold = manifolds[p]
        a, b = manifold.a, manifold.b
        nx, ny = manifold.normal_x, manifold.normal_y
        ma, mb, ia, ib = inverse_mass[a], inverse_mass[b], inverse_inertia[a], inverse_inertia[b]
        vax, vay, wa = linear[a, 0], linear[a, 1], angular[a]
        vbx, vby, wb = linear[b, 0], linear[b, 1], angular[b]
        for j in range(2 * p, 2 * p + manifold.count):
            point = points[j]
            rax, ray, rbx, rby = point.arm_ax, point.arm_ay, point.arm_bx, point.arm_by
            if point.ahead:
                continue
            vn = nx * (vbx - wb * rby - vax + wa * ray) + ny * (vby + wb * rbx - vay - wa * rax)
            separation = point.separation
            if separation > 0.0:
                bias, hardness, softness = separation * inverse_h, 1.0, 0.0
            else:
                # No faster than what balances twice the load, or a pile of overlapping bodies would fly apart.
                load = impulse_scale * point.normal_impulse / (mass_scale * point.normal_mass)
                limit = push_rate * _SOFT * manifold.size + 2.0 * load
                bias = max(push_rate * min(separation + slop, 0.0), -limit)
                hardness, softness = mass_scale, impulse_scale
            change = -point.normal_mass * hardness * (vn + bias) - softness * point.normal_impulse
            total = max(point.normal_impulse + change, 0.0)
            change = total - point.normal_impulse
            point.normal_impulse = total
            px, py = change * nx, change * ny
            vax, vay, wa = vax - ma * px, vay - ma * py, wa - ia * (rax * py - ray * px)
            vbx, vby, wb = vbx + mb * px, vby + mb * py, wb + ib * (rbx * py - rby * px)
        if manifold.friction > 0.0:
            for j in range(2 * p, 2 * p + manifold.count):
                point = points[j]
                rax, ray, rbx, rby = point.arm_ax, point.arm_ay, point.arm_bx, point.arm_by
                vt = nx * (vby + wb * rbx - vay - wa * rax) - ny * (vbx - wb * rby - vax + wa * ray)
                limit = manifold.friction * point.normal_impulse
                total = min(max(point.tangent_impulse - point.tangent_mass * vt, -limit), limit)
                change = total - point.tangent_impulse
                point.tangent_impulse = total
                px, py = -change * ny, change * nx
                vax, vay, wa = vax - ma * px, vay - ma * py, wa - ia * (rax * py - ray * px)
                vbx, vby, wb = vbx + mb * px, vby + mb * py, wb + ib * (rbx * py - rby * px)
        linear[a, 0], linear[a, 1], angular[a] = vax, vay, wa
        linear[b, 0], linear[b, 1], angular[b] = vbx, vby, wb


@kernel(
    void(
        Manifolds, Points, _ROWS, int64, _VECTORS, _NUMBERS, _NUMBERS, _NUMBERS,
        float64, int64, float64, float64, float64,
    )
)  # fmt: skip
def solve(
    manifolds, points, touching, count, linear, angular, inverse_mass, inverse_inertia,
    h, iterations, hertz, damping_ratio, slop,
):  # fmt: skip
    """Start from the impulses of the last substep, then go through all contacts with the correction of overlap.

    The contact spring of frequency ``hertz`` is integrated implicitly over h (Catto, Soft Constraints, GDC 2011):
    with omega = 2 pi hertz and q = 2 zeta + h omega, it takes omega / q of the overlap a second.
    """
    for k in range(count):
        p = touching[k]
        manifold = manifolds[p]
        nx, ny = manifold.normal_x, manifold.normal_y
        for j in range(2 * p, 2 * p + manifold.count):
            point = points[j]
            if point.ahead:
                point.normal_impulse = point.tangent_impulse = 0.0
                continue
            px = point.normal_impulse * nx - point.tangent_impulse * ny
            py = point.normal_impulse * ny + point.tangent_impulse * nx
            _apply(point, px, py, manifold.a, manifold.b, linear, angular, inverse_mass, inverse_inertia)
    omega = 2.0 * math.pi * min(hertz, 0.25 / h)
    q = 2.0 * damping_ratio + h * omega
    stiffness = h * omega * q
    for _ in range(iterations):
        _sweep(
            manifolds, points, touching, count, linear, angular, inverse_mass, inverse_inertia,
            1.0 / h, omega / q, stiffness / (1.0 + stiffness), 1.0 / (1.0 + stiffness), slop,
        )  # fmt: skip


@kernel(
    void(
        Manifolds, Points, _ROWS, int64, _VECTORS, _NUMBERS, _NUMBERS, _NUMBERS, float64, int64
    )
)
def relax(manifolds, points, touching, count, linear, angular, inverse_mass, inverse_inertia, h, iterations):
    """Go through all contacts without correction, so that pushing bodies apart leaves no velocity behind.

    ``h`` is the time that bodies have moved since :func:`solve`, and the time until its next call.
    """
    for k in range(count):
        p = touching[k]
        manifold = manifolds[p]
        for j in range(2 * p, 2 * p + manifold.count):
            point = points[j]
            vx, vy = _relative_velocity(point, manifold.a, manifold.b, linear, angular)
            point.separation += h * (vx * manifold.normal_x + vy * manifold.normal_y)
    for _ in range(iterations):
        _sweep(
            manifolds, points, touching, count, linear, angular, inverse_mass, inverse_inertia,
            1.0 / h, 0.0, 1.0, 0.0, 0.0,
        )  # fmt: skip


@kernel(void(Manifolds, Points, _ROWS, int64, _VECTORS, _NUMBERS, float64))
def separate(manifolds, points, touching, count, position, inverse_mass, farthest):
    """Move bodies that overlap deeply apart, a fifth of the way, by no more than ``farthest`` [m] each.

    Only positions change: however many bodies lie on one spot, coming apart gives them no speed.
    """
    deep = False
    for k in range(count):
        manifold = manifolds[touching[k]]
        for j in range(2 * touching[k], 2 * touching[k] + manifold.count):
            deep = deep or points[j].separation < -_DEEP * manifold.size
    if not deep:
        return
    before = position.copy()
    for k in range(count):
        p = touching[k]
        manifold = manifolds[p]
        if manifold.swept == 1:
            continue
        a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
        lowest = points[2 * p].separation
        if manifold.count == 2:
            lowest = min(lowest, points[2 * p + 1].separation)
        moved_x = position[b, 0] - before[b, 0] - position[a, 0] + before[a, 0]
        moved_y = position[b, 1] - before[b, 1] - position[a, 1] + before[a, 1]
        depth = -(lowest + moved_x * nx + moved_y * ny) - _DEEP * manifold.size
        if depth > 0.0:
            share = 0.2 * depth / (inverse_mass[a] + inverse_mass[b])
            position[a, 0] -= share * inverse_mass[a] * nx
            position[a, 1] -= share * inverse_mass[a] * ny
            position[b, 0] += share * inverse_mass[b] * nx
            position[b, 1] += share * inverse_mass[b] * ny
    for i in range(len(inverse_mass)):
        x, y = position[i, 0] - before[i, 0], position[i, 1] - before[i, 1]
        way = math.sqrt(x * x + y * y)
        if way > farthest:
            position[i, 0] = before[i, 0] + x * farthest / way
            position[i, 1] = before[i, 1] + y * farthest / way


@kernel(float64(Manifolds, Points, _ROWS, int64))
def deepest(manifolds, points, touching, count):
    """Return the deepest overlap of all contacts [m]."""
    depth = 0.0
    for k in range(count):
        p = touching[k]
        for j in range(2 * p, 2 * p + manifolds[p].count):
            depth = max(depth, -points[j].separation)
    return depth


