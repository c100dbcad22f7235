"""The work of resting contacts: friction, driven bodies, and the rest of what impulses do.

An impulse J that acts within a substep does the work J (v + v') / 2, where v and v' are the velocities of its
point before and after all impulses of the stage. Half of what the forces of the substep give to the point's
velocity is not there yet, or not any more: with a the acceleration of the point by forces, the mean velocity
within the substep is (v + v' - a h) / 2. A body at rest then does no work: its velocity is a h before, and 0
after.
"""

from physicslab.kernels import Flags, Numbers, Vectors, inlined, kernel
from physicslab.kernels.accounts import CONTACT, DAMPING, ENERGY, FRICTION, GRAVITY, HAND, PX, PY, SPIN
from physicslab.kernels.arguments import Acting, Contacts, Inverse, Motion, Near
from physicslab.kernels.motion import damped
from physicslab.kernels.near_counts import BOX_BLOCKS, DISC_BLOCKS
from physicslab.kernels.records import Point
from physicslab.kernels.wide.layout import (
    ARM_AX,
    ARM_AY,
    ARM_BX,
    ARM_BY,
    DISC,
    IMPULSE,
    NORMAL_X,
    NORMAL_Y,
    ONE,
    RADIUS_A,
    RADIUS_B,
    TANGENT_IMPULSE,
    TWO,
    WIDE,
    rows_of,
)

__all__ = [
    "book_contacts", "book_damping", "book_drivers", "book_gravity", "book_kick", "book_sliding",
    "note_sliding",
]  # fmt: skip

_SLIDING, _RUBBING = 0, 1
"""What is noted of a point: how fast it slides [m/s], and its tangential impulse [N s]."""


@inlined
def _sliding(point: Point, nx: float, ny: float, a: int, b: int, motion: Motion) -> float:
    """Return how fast B's point slides against A's, along the normal turned counter-clockwise [m/s]."""
    linear, angular = motion.linear, motion.angular
    vx = linear[b, 0] - angular[b] * point.arm_by - linear[a, 0] + angular[a] * point.arm_ay
    vy = linear[b, 1] + angular[b] * point.arm_bx - linear[a, 1] - angular[a] * point.arm_ax
    speed: float = nx * vy - ny * vx
    return speed


@inlined
def _forced(row: int, arm_x: float, arm_y: float, inverse: Inverse, acting: Acting) -> tuple[float, float]:
    """Return the acceleration that forces give to a point of a body [m/s^2]."""
    turn = acting.torque[row] * inverse.inertia[row]
    mass = inverse.mass[row]
    return acting.force[row, 0] * mass - turn * arm_y, acting.force[row, 1] * mass + turn * arm_x


@inlined
def note_sliding(
    contacts: Contacts, slips: Vectors, motion: Motion, inverse: Inverse, acting: Acting, h: float
) -> None:
    """Note how fast the points of scalar contacts slide before the impulses of a substep of ``h`` seconds.

    Without what forces have given to that in the substep.
    """
    for k in range(contacts.number):
        p = contacts.touching[k]
        manifold = contacts.manifolds[p]
        if manifold.friction == 0.0:
            continue
        a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
        for j in range(2 * p, 2 * p + manifold.count):
            point = contacts.points[j]
            sliding = _sliding(point, nx, ny, a, b, motion)
            if acting.any:
                ax, ay = _forced(a, point.arm_ax, point.arm_ay, inverse, acting)
                bx, by = _forced(b, point.arm_bx, point.arm_by, inverse, acting)
                sliding -= h * (nx * (by - ay) - ny * (bx - ax))
            slips[j, _SLIDING], slips[j, _RUBBING] = sliding, 0.0


@inlined
def book_sliding(contacts: Contacts, slips: Vectors, motion: Motion, account: Vectors) -> None:
    """Book what friction of scalar contacts takes by the impulses since the last call, or since the note.

    That is the change of each tangential impulse times the mean speed of sliding. What is now is noted.
    """
    taken = 0.0
    for k in range(contacts.number):
        p = contacts.touching[k]
        manifold = contacts.manifolds[p]
        if manifold.friction == 0.0:
            continue
        a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
        for j in range(2 * p, 2 * p + manifold.count):
            point = contacts.points[j]
            sliding = _sliding(point, nx, ny, a, b, motion)
            taken += 0.5 * (point.tangent_impulse - slips[j, _RUBBING]) * (slips[j, _SLIDING] + sliding)
            slips[j, _SLIDING], slips[j, _RUBBING] = sliding, point.tangent_impulse
    account[FRICTION, ENERGY] += taken


@inlined
def _book_driver(
    near: Near, motion: Motion, row: int, px: float, py: float, arm_x: float, arm_y: float
) -> None:
    """Book what a body that is not moved by impulses gives by the impulse (px, py) [N s] on the other one."""
    linear, angular, position = motion.linear, motion.angular, motion.position
    vx, vy = linear[row, 0] - angular[row] * arm_y, linear[row, 1] + angular[row] * arm_x
    if vx == 0.0 and vy == 0.0 and angular[row] == 0.0:
        return
    x, y = position[row, 0] + arm_x, position[row, 1] + arm_y
    spin = x * py - y * px
    near.account[HAND, ENERGY] += px * vx + py * vy
    near.account[HAND, PX] += px
    near.account[HAND, PY] += py
    near.account[HAND, SPIN] += spin
    # All impulses from outside are booked as those of contacts: these were a hand's.
    near.account[CONTACT, PX] -= px
    near.account[CONTACT, PY] -= py
    near.account[CONTACT, SPIN] -= spin


@inlined
def _book_drivers_wide(near: Near, motion: Motion, inverse: Inverse) -> None:
    """Book the work of driven bodies at wide contacts."""
    for slots in (near.discs, near.boxes):
        data = slots.data
        for k in range(near.counts[DISC_BLOCKS + slots.kind]):
            for place in range(WIDE):
                a, b, at = (
                    slots.a[k * WIDE + place],
                    slots.b[k * WIDE + place],
                    k * rows_of(slots.kind) + place,
                )
                if inverse.mass[a] > 0.0 and inverse.mass[b] > 0.0:
                    continue
                nx, ny = data[at + NORMAL_X], data[at + NORMAL_Y]
                for of in (ONE, TWO):
                    if slots.kind == DISC and of == TWO:
                        continue
                    if slots.kind == DISC:
                        ax, ay = data[at + RADIUS_A] * nx, data[at + RADIUS_A] * ny
                        bx, by = -data[at + RADIUS_B] * nx, -data[at + RADIUS_B] * ny
                    else:
                        ax, ay = data[at + of + ARM_AX], data[at + of + ARM_AY]
                        bx, by = data[at + of + ARM_BX], data[at + of + ARM_BY]
                    push, rub = data[at + of + IMPULSE], data[at + of + TANGENT_IMPULSE]
                    px, py = push * nx - rub * ny, push * ny + rub * nx
                    if inverse.mass[a] == 0.0:
                        _book_driver(near, motion, a, px, py, ax, ay)
                    else:
                        _book_driver(near, motion, b, -px, -py, bx, by)


@inlined
def book_drivers(contacts: Contacts, near: Near, motion: Motion, inverse: Inverse) -> None:
    """Book the work of bodies that move and are not moved, by the impulses of a substep."""
    for k in range(contacts.number):
        p = contacts.touching[k]
        manifold = contacts.manifolds[p]
        a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
        if inverse.mass[a] > 0.0 and inverse.mass[b] > 0.0:
            continue
        for j in range(2 * p, 2 * p + manifold.count):
            point = contacts.points[j]
            px = point.normal_impulse * nx - point.tangent_impulse * ny
            py = point.normal_impulse * ny + point.tangent_impulse * nx
            if inverse.mass[a] == 0.0:
                _book_driver(near, motion, a, px, py, point.arm_ax, point.arm_ay)
            else:
                _book_driver(near, motion, b, -px, -py, point.arm_bx, point.arm_by)
    if near.counts[DISC_BLOCKS] + near.counts[BOX_BLOCKS] > 0:
        _book_drivers_wide(near, motion, inverse)


@inlined
def book_gravity(
    account: Vectors, total: float, mx: float, my: float, gx: float, gy: float, h: float
) -> None:
    """Book the impulse of uniform gravity in ``h`` seconds on a mass of such moments."""
    account[GRAVITY, PX] += h * total * gx
    account[GRAVITY, PY] += h * total * gy
    account[GRAVITY, SPIN] += h * (mx * gy - my * gx)


@kernel
def book_kick(
    position: Vectors, force: Vectors, torque: Numbers, mass: Numbers, inverse_mass: Numbers,
    inverse_inertia: Numbers, sub_integrated: Flags, gx: float, gy: float, other: int, h: float,
    account: Vectors,
) -> None:  # fmt: skip
    """Book the impulses of ``h`` seconds of forces that kick: of uniform gravity, the rest to ``other``."""
    px, py, spin = 0.0, 0.0, 0.0
    for i in range(len(mass)):
        if inverse_mass[i] > 0.0 and not sub_integrated[i]:
            wx, wy, x, y = mass[i] * gx, mass[i] * gy, position[i, 0], position[i, 1]
            account[GRAVITY, PX] += h * wx
            account[GRAVITY, PY] += h * wy
            account[GRAVITY, SPIN] += h * (x * wy - y * wx)
            fx, fy = force[i, 0] - wx, force[i, 1] - wy
            px += h * fx
            py += h * fy
            spin += h * (x * fy - y * fx)
            if inverse_inertia[i] > 0.0:
                spin += h * torque[i]
    account[other, PX] += px
    account[other, PY] += py
    account[other, SPIN] += spin


@inlined
def _damped_change(
    v: float, a: float, decay: float, gain: float, h: float, later: float, m: float
) -> tuple[float, float]:
    """Return the impulse of damping in a kick of ``h`` seconds at the velocity v, and its work.

    ``later`` is by how much the middle of the substep comes after that of the kick [s].
    """
    end = v * decay + a * gain
    impulse = m * (end - v - a * h)
    return impulse, impulse * (0.5 * (v + end) + a * later)


@kernel
def book_damping(
    position: Vectors, linear: Vectors, angular: Numbers, force: Vectors, torque: Numbers,
    inverse_mass: Numbers, inverse_inertia: Numbers, sub_integrated: Flags, linear_damping: float,
    angular_damping: float, h: float, later: float, account: Vectors,
) -> None:  # fmt: skip
    """Book what damping takes in a kick of ``h`` seconds, before that is made.

    The middle of the substep comes ``later`` seconds after that of the kick: what forces give until then
    belongs to the mean velocity at which the impulse of damping does its work.
    """
    decay, gain = damped(linear_damping, h)
    angular_decay, angular_gain = damped(angular_damping, h)
    for i in range(len(inverse_mass)):
        if inverse_mass[i] == 0.0 or sub_integrated[i]:
            continue
        m, x, y = 1.0 / inverse_mass[i], position[i, 0], position[i, 1]
        ax, ay = force[i, 0] * inverse_mass[i], force[i, 1] * inverse_mass[i]
        px, along = _damped_change(linear[i, 0], ax, decay, gain, h, later, m)
        py, across = _damped_change(linear[i, 1], ay, decay, gain, h, later, m)
        turned, around = 0.0, 0.0
        if inverse_inertia[i] > 0.0:
            turn, inertia = torque[i] * inverse_inertia[i], 1.0 / inverse_inertia[i]
            turned, around = _damped_change(angular[i], turn, angular_decay, angular_gain, h, later, inertia)
        account[DAMPING, ENERGY] += along + across + around
        account[DAMPING, PX] += px
        account[DAMPING, PY] += py
        account[DAMPING, SPIN] += x * py - y * px + turned


@kernel
def book_contacts(
    linear: Vectors, angular: Numbers, position: Vectors, before: Vectors, before_angular: Numbers,
    force: Vectors, torque: Numbers, mass: Numbers, inertia: Numbers, inverse_mass: Numbers,
    inverse_inertia: Numbers, unkicked: Flags, h: float, booked: float, account: Vectors,
) -> None:  # fmt: skip
    """Book the work and the impulses of a stage that has changed velocities, from ``before`` to those of now.

    ``position`` is that of before, as what is moved apart is booked by itself.
    ``h`` is the time [s] for which forces act in the substep, except on rows that are ``unkicked``: 0 where
    they have no part in it. ``booked`` is the work [J] of these impulses that is in an account already.
    """
    work, px, py, spin = 0.0, 0.0, 0.0, 0.0
    for i in range(len(mass)):
        if inverse_mass[i] == 0.0:
            continue
        forced = 0.0 if unkicked[i] else h
        ax, ay = linear[i, 0] - before[i, 0], linear[i, 1] - before[i, 1]
        mx = linear[i, 0] + before[i, 0] - forced * force[i, 0] * inverse_mass[i]
        my = linear[i, 1] + before[i, 1] - forced * force[i, 1] * inverse_mass[i]
        work += 0.5 * mass[i] * (ax * mx + ay * my)
        px += mass[i] * ax
        py += mass[i] * ay
        spin += mass[i] * (position[i, 0] * ay - position[i, 1] * ax)
        if inverse_inertia[i] > 0.0:
            turned = angular[i] - before_angular[i]
            mean = angular[i] + before_angular[i] - forced * torque[i] * inverse_inertia[i]
            work += 0.5 * inertia[i] * turned * mean
            spin += inertia[i] * turned
    account[CONTACT, ENERGY] += work - booked
    account[CONTACT, PX] += px
    account[CONTACT, PY] += py
    account[CONTACT, SPIN] += spin
