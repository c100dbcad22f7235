"""Powers, forces and torques of causes, by account: added up beside the forces, integrated beside the motion.

Behind the clock, the packed coordinates have four places for each account that a world needs: the energy, the
momentum (x, y) and the angular momentum about the origin (:mod:`physicslab.kernels.accounts`). A force adds
its power [W], its force [N] and its torque [N m] to those places of ``force``, and an integrator keeps in
those of ``v`` what they amount to. They are no coordinates: no force depends on them, and no error is
estimated from them.

Powers and forces are those on the coordinates that forces move: on what has an inverse mass, or an inverse
moment of inertia.
"""

from typing import Any

from physicslab.kernels import Numbers, Rows, always_inlined, inlined
from physicslab.kernels.accounts import book
from physicslab.kernels.forces.fall_shares import fall_shares
from physicslab.kernels.forces.force_calls import force_kernel

CLOCK, END, BODIES, DAMPED, KEPT = range(5)
"""What :attr:`physicslab.ode.system.OdeSystem.places` holds: where the time is; where the accounts behind it
end; how many bodies move; the account of damping, or -1. From ``KEPT`` on, for methods that kick, there are
pairs: an account, and where the forces that it is about are kept by themselves, coordinate by coordinate."""
ACCOUNTS = 4
"""How many places an account has."""
A_MOVES, B_MOVES, A_TURNS, B_TURNS = 1, 2, 4, 8
ALL_MOVED = 15
"""Which coordinates of a spring's ends forces move; one that does not exist counts as moved."""


@inlined
def keep_pull(
    force: Any, kept: int, indices: Any, s: int, x: float, y: float, ax: float, ay: float, bx: float,
    by: float,
) -> None:  # fmt: skip
    """Keep the pull (x, y) of the damper of spring number s by itself; it acts at the arms a and b."""
    a, turn_a, b, turn_b = indices[1 + 4 * s], indices[2 + 4 * s], indices[3 + 4 * s], indices[4 + 4 * s]
    force[kept + a] += x
    force[kept + a + 1] += y
    force[kept + b] -= x
    force[kept + b + 1] -= y
    if turn_a >= 0:
        force[kept + turn_a] += ax * y - ay * x
    if turn_b >= 0:
        force[kept + turn_b] -= bx * y - by * x


@inlined
def book_open_spring(
    q: Any, v: Any, force: Any, indices: Any, s: int, moved: int, fx: float, fy: float, damper_x: float,
    damper_y: float, ax: float, ay: float, bx: float, by: float, store: int, damp: int, hand: int,
) -> None:  # fmt: skip
    """Book the momentum that spring number s brings in from outside, and the work of ends that are driven.

    The force on A is (fx, fy), of which (damper_x, damper_y) is the damper's; it acts at the arms a and b.
    ``moved`` tells which coordinates forces move.
    """
    a, turn_a, b, turn_b = indices[1 + 4 * s], indices[2 + 4 * s], indices[3 + 4 * s], indices[4 + 4 * s]
    if turn_a < 0 and turn_b < 0 and hand < 0:  # most hang by one end that moves, and turn nothing
        at, dx, dy, fx, fy = a, damper_x, damper_y, fx - damper_x, fy - damper_y
        if moved & A_MOVES == 0:
            at, dx, dy, fx, fy = b, -dx, -dy, -fx, -fy
            if moved & B_MOVES == 0:
                return
        book(force, store, 0.0, fx, fy, q[at] * fy - q[at + 1] * fx)
        if damp >= 0:
            book(force, damp, 0.0, dx, dy, q[at] * dy - q[at + 1] * dx)
        return
    torque_a, torque_b = ax * fy - ay * fx, bx * fy - by * fx
    slow_a, slow_b = ax * damper_y - ay * damper_x, bx * damper_y - by * damper_x
    px, py, spin, dx, dy, d_spin, work = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    if moved & A_MOVES:
        px, py, spin = fx, fy, q[a] * fy - q[a + 1] * fx
        dx, dy, d_spin = damper_x, damper_y, q[a] * damper_y - q[a + 1] * damper_x
    else:
        work -= fx * v[a] + fy * v[a + 1]
    if moved & B_MOVES:
        px, py, spin = px - fx, py - fy, spin - (q[b] * fy - q[b + 1] * fx)
        dx, dy = dx - damper_x, dy - damper_y
        d_spin -= q[b] * damper_y - q[b + 1] * damper_x
    else:
        work += fx * v[b] + fy * v[b + 1]
    if turn_a >= 0:
        if moved & A_TURNS:
            spin, d_spin = spin + torque_a, d_spin + slow_a
        else:
            work -= torque_a * v[turn_a]
    if turn_b >= 0:
        if moved & B_TURNS:
            spin, d_spin = spin - torque_b, d_spin - slow_b
        else:
            work += torque_b * v[turn_b]
    book(force, store, 0.0, px - dx, py - dy, spin - d_spin)
    if damp >= 0:
        book(force, damp, 0.0, dx, dy, d_spin)
    if hand >= 0:
        force[hand] += work


@force_kernel
def gather(q, v, span, force, parameters, indices):  # type: ignore[no-untyped-def]
    """Book the forces that are there by now, with a sign: before a force and after it, by its difference.

    ``parameters``: the sign; ``indices``: the account; whether the energy counts, and the momentum; where
    each force is kept by itself, or -1; how many bodies; of each where x and the angle are, -1 for one that
    is left out.
    """
    sign, account, kept = parameters[0], indices[0], indices[3]
    power, px, py, spin = 0.0, 0.0, 0.0, 0.0
    for p in range(indices[4]):
        i, turn = indices[5 + 2 * p], indices[6 + 2 * p]
        if i >= 0:
            power += force[i] * v[i] + force[i + 1] * v[i + 1]
            px += force[i]
            py += force[i + 1]
            spin += q[i] * force[i + 1] - q[i + 1] * force[i]
        if turn >= 0:
            power += force[turn] * v[turn]
            spin += force[turn]
        if kept >= 0 and i >= 0:
            force[kept + i] += sign * force[i]
            force[kept + i + 1] += sign * force[i + 1]
        if kept >= 0 and turn >= 0:
            force[kept + turn] += sign * force[turn]
    if indices[1] != 0 and kept < 0:
        force[account] += sign * power
    if indices[2] != 0:
        book(force, account, 0.0, sign * px, sign * py, sign * spin)


@force_kernel
def resist(q, v, span, force, parameters, indices):  # type: ignore[no-untyped-def]
    """Book what the damping of all motion takes.

    ``parameters``: of each coordinate its rate of damping times its mass or moment of inertia. ``indices``:
    the account, how many bodies move, and how many coordinates there are.
    """
    account, bodies = indices[0], indices[1]
    power, px, py, spin = 0.0, 0.0, 0.0, 0.0
    for p in range(bodies):
        i = 2 * p
        fx, fy = parameters[i] * v[i], parameters[i + 1] * v[i + 1]
        power += fx * v[i] + fy * v[i + 1]
        px += fx
        py += fy
        spin += q[i] * fy - q[i + 1] * fx
    for i in range(2 * bodies, indices[2]):
        torque = parameters[i] * v[i]
        power += torque * v[i]
        spin += torque
    book(force, account, -power, -px, -py, -spin)


@always_inlined
def book_damping(v: Numbers, places: Rows, q: Numbers, i: int, energy: float, impulse: float) -> None:
    """Book the energy and the impulse of damping on coordinate ``i``."""
    account = places[DAMPED]
    if i >= 2 * places[BODIES]:
        book(v, account, energy, 0.0, 0.0, impulse)
    elif i % 2 == 0:
        book(v, account, energy, impulse, 0.0, -q[i + 1] * impulse)
    else:
        book(v, account, energy, 0.0, impulse, q[i - 1] * impulse)


@always_inlined
def book_kick(
    q: Numbers, v: Numbers, places: Rows, i: int, acceleration: Numbers, inverse_mass: float, rate: float,
    kick: float, change: float,
) -> None:  # fmt: skip
    """Book on coordinate ``i`` what a kick of ``kick`` seconds does that changes its velocity by ``change``.

    Not stored are the work of damping at ``rate``, and that of forces that are kept by themselves, by
    the velocities on the way. To be called before the velocity has changed.
    """
    along = kick * v[i] + 0.5 * kick * change  # the integral of the velocity
    if rate > 0.0 and inverse_mass > 0.0:
        _, first, second = fall_shares(rate * kick)
        along = kick * (v[i] * first + acceleration[i] * kick * second)
        gained = kick * first * (acceleration[i] - rate * v[i])  # by the law, whatever the motion's change is
        work = (gained * (v[i] + 0.5 * gained) - acceleration[i] * along) / inverse_mass
        book_damping(v, places, q, i, work, -rate * along / inverse_mass)
    for k in range(KEPT, len(places), 2):
        v[places[k]] += acceleration[places[k + 1] + i] * along
