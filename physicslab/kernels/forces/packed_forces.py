"""Gravity, springs and drag over packed coordinates, as :mod:`physicslab.kernels.forces.force_calls` has it.

Each works by the same formulas as the loop over columns in the module of that force. Where one is given the
place of an account (:mod:`physicslab.kernels.forces.budget`), it also adds there what it gives in a second;
a place of -1 is none. Where it keeps its force by itself, it books no energy.
"""

from typing import Any

import numpy as np

from physicslab.kernels import allocating, always_inlined
from physicslab.kernels.accounts import book
from physicslab.kernels.forces.budget import book_open_spring, keep_pull
from physicslab.kernels.forces.drag import drag_factor
from physicslab.kernels.forces.force_calls import force_kernel
from physicslab.kernels.forces.inverse_square import PLAIN_LIMIT, attract, inverse_cube
from physicslab.kernels.forces.springs import mean_spring_pull, pull_ends, spring_pull, turn_over, turned


@force_kernel
def uniform_gravity(q, v, span, force, parameters, indices):  # type: ignore[no-untyped-def]
    """Add m g, or q E. ``parameters``: gx, gy, the masses, and their sum.

    ``indices``: how many, where x of each is, and the account of gravity.
    """
    n, gx, gy = indices[0], parameters[0], parameters[1]
    account, half = indices[1 + n], n // 2
    mx, my, other_mx, other_my = 0.0, 0.0, 0.0, 0.0  # two sums: each waits for its own last addition alone
    for p in range(half):
        i, mass = indices[1 + p], parameters[2 + p]
        j, other = indices[1 + half + p], parameters[2 + half + p]
        force[i] += mass * gx
        force[i + 1] += mass * gy
        force[j] += other * gx
        force[j + 1] += other * gy
        mx += mass * q[i]
        my += mass * q[i + 1]
        other_mx += other * q[j]
        other_my += other * q[j + 1]
    if n > 2 * half:
        i, mass = indices[n], parameters[1 + n]
        force[i] += mass * gx
        force[i + 1] += mass * gy
        mx += mass * q[i]
        my += mass * q[i + 1]
    if account < 0:
        return
    spin = (mx + other_mx) * gy - (my + other_my) * gx
    book(force, account, 0.0, parameters[2 + n] * gx, parameters[2 + n] * gy, spin)


@allocating
def _attract_packed(q, force, parameters, indices):  # type: ignore[no-untyped-def]
    """Add the attraction of more than a few, as :func:`inverse_square` has it, by columns of them."""
    n = indices[0]
    x, y, weight, ax, ay = np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    for p in range(n):
        i = indices[3 + p]
        x[p], y[p], weight[p] = q[i], q[i + 1], parameters[2 + p]
    attract(x, y, weight, parameters[1], indices[1] != 0, ax, ay)
    for p in range(n):
        i = indices[3 + p]
        force[i] += parameters[0] * weight[p] * ax[p]
        force[i + 1] += parameters[0] * weight[p] * ay[p]


@force_kernel
def inverse_square(q, v, span, force, parameters, indices):  # type: ignore[no-untyped-def]
    """Add the force C w_a w_b / d^2 of every pair, an attraction where that is positive.

    ``parameters``: C, softening, the weights, then of each y and p as of
    :func:`physicslab.kernels.forces.inverse_square.fastest_fall`. ``indices``: how many; whether Plummer's
    law holds; where among the parameters the square of the fastest rate is that any call found, where bodies
    are few; then where x of each is.
    """
    n, plummer = indices[0], indices[1] != 0
    constant, softening = parameters[0], parameters[1]
    if n > PLAIN_LIMIT:
        _attract_packed(q, force, parameters, indices)  # type: ignore[no-untyped-call]
        return
    softening2, steepest = softening * softening, 0.0
    for p in range(n):
        i = indices[3 + p]
        x, y, weight = q[i], q[i + 1], constant * parameters[2 + p]
        yields, pulls = parameters[2 + n + p], parameters[2 + 2 * n + p]
        fx, fy = 0.0, 0.0
        for other in range(p + 1, n):
            j = indices[3 + other]
            dx, dy = q[j] - x, q[j + 1] - y
            pull = inverse_cube(dx * dx + dy * dy, softening2, plummer)
            rate2 = yields * parameters[2 + 2 * n + other] + parameters[2 + n + other] * pulls
            steepest = max(steepest, rate2 * pull)
            f = weight * parameters[2 + other] * pull
            fx += f * dx
            fy += f * dy
            force[j] -= f * dx
            force[j + 1] -= f * dy
        force[i] += fx
        force[i + 1] += fy
    place = indices[2]
    parameters[place] = max(parameters[place], abs(constant) * steepest)


@always_inlined
def _pull(q: Any, v: Any, span: float, force: Any, parameters: Any, indices: Any, s: int) -> Any:
    """Add the pull of spring number s to both ends.

    Returns the force on A, the damper's part of it, the power that it takes, and both arms [m] at which the
    force acts.
    """
    w, p = 1 + 4 * s, 7 * s
    a, turn_a, b, turn_b = indices[w], indices[w + 1], indices[w + 2], indices[w + 3]
    ax, ay, bx, by = parameters[p], parameters[p + 1], parameters[p + 2], parameters[p + 3]
    spin_a, spin_b, near_a, near_b, give_a, give_b = 0.0, 0.0, 1.0, 1.0, 1.0, 1.0
    if turn_a >= 0:
        ax, ay = turned(q[turn_a], ax, ay)
        near_a, give_a = turn_over(span * v[turn_a])
        spin_a = give_a * v[turn_a]
    if turn_b >= 0:
        bx, by = turned(q[turn_b], bx, by)
        near_b, give_b = turn_over(span * v[turn_b])
        spin_b = give_b * v[turn_b]
    dx = q[b] + near_b * bx - q[a] - near_a * ax
    dy = q[b + 1] + near_b * by - q[a + 1] - near_a * ay
    vx = v[b] - spin_b * by - v[a] + spin_a * ay
    vy = v[b + 1] + spin_b * bx - v[a + 1] - spin_a * ax
    rest, stiffness, damping = parameters[p + 4], parameters[p + 5], parameters[p + 6]
    if span == 0.0:
        fx, fy, nx, ny, rate = spring_pull(dx, dy, vx, vy, rest, stiffness, damping)
    else:
        fx, fy, nx, ny, rate = mean_spring_pull(dx, dy, vx, vy, span, rest, stiffness, damping)
    pull_ends(force, a, turn_a, b, turn_b, fx, fy, give_a, ax, ay, give_b, bx, by)
    slowed = damping * rate
    return fx, fy, slowed * nx, slowed * ny, slowed * rate, give_a * ax, give_a * ay, give_b * bx, give_b * by


@force_kernel
def springs(q, v, span, force, parameters, indices):  # type: ignore[no-untyped-def]
    """Add the pull of springs and dampers to both ends.

    ``indices``: how many, then four a spring: where x and the angle are at A, and at B; an angle of -1 is one
    that never changes. ``parameters``: seven a spring: the anchors at A and B in the body's own directions,
    or in the world's where the angle never changes [m], rest length, stiffness, damping. Over a span, what
    the springs store changes by just the work done, of the turning ends as well.

    Behind the indices of the springs are the accounts of springs, damping and hand, where the forces of
    dampers are kept by themselves, and how many springs have an end that forces do not move in all its
    coordinates; of each of these its number, and which they do move
    (:func:`physicslab.kernels.forces.budget.book_open_spring`).
    """
    n, lost, first = indices[0], 0.0, 0
    behind = 1 + 4 * n
    store, damp, hand, kept, count = (
        indices[behind], indices[behind + 1], indices[behind + 2], indices[behind + 3], indices[behind + 4]
    )  # fmt: skip
    if store < 0:
        count = 0
    for turn in range(count + 1):
        end = indices[behind + 5 + 2 * turn] if turn < count else n
        if damp < 0:
            for s in range(first, end):
                _pull(q, v, span, force, parameters, indices, s)
        else:
            for s in range(first, end):
                _, _, x, y, power, ax, ay, bx, by = _pull(q, v, span, force, parameters, indices, s)
                lost += power
                if kept >= 0:
                    keep_pull(force, kept, indices, s, x, y, ax, ay, bx, by)
        if turn < count:
            fx, fy, x, y, power, ax, ay, bx, by = _pull(q, v, span, force, parameters, indices, end)
            lost += power
            if kept >= 0:
                keep_pull(force, kept, indices, end, x, y, ax, ay, bx, by)
            moved = indices[behind + 6 + 2 * turn]
            book_open_spring(
                q, v, force, indices, end, moved, fx, fy, x, y, ax, ay, bx, by, store, damp, hand
            )
            first = end + 1
    if damp >= 0 and kept < 0:
        force[damp] -= lost


@force_kernel
def drag(q, v, span, force, parameters, indices):  # type: ignore[no-untyped-def]
    """Add -(c + k |v|) v. ``parameters``: c and k of each.

    ``indices``: how many, where x of each is, the account of damping, how many of them forces move, which
    come first, and where their drag is kept by itself.
    """
    n = indices[0]
    account, kept = indices[1 + n], indices[3 + n]
    booked = indices[2 + n] if account >= 0 else 0
    power, px, py, spin = 0.0, 0.0, 0.0, 0.0
    for p in range(n):
        i = indices[1 + p]
        f = drag_factor(v[i], v[i + 1], parameters[2 * p], parameters[2 * p + 1])
        fx, fy = f * v[i], f * v[i + 1]
        force[i] -= fx
        force[i + 1] -= fy
        if p < booked:
            power += fx * v[i] + fy * v[i + 1]
            px += fx
            py += fy
            spin += q[i] * fy - q[i + 1] * fx
            if kept >= 0:
                force[kept + i] -= fx
                force[kept + i + 1] -= fy
    if account >= 0:
        book(force, account, -power if kept < 0 else 0.0, -px, -py, -spin)
