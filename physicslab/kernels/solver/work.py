"""What contacts do to energy and momentum, and what kicks do.

Impulses J that act at one moment do the work J (v + v') / 2 each, with the velocities v and v' of its point
before and after all of them. Half of what the forces of a substep give to the point's velocity is not there
yet, or not any more: with a the acceleration of the point by forces, the mean velocity within the substep is
(v + v' - a h) / 2. A body at rest then does no work: its velocity is a h before, and 0 after.
"""

from physicslab.kernels import Flags, Numbers, Vectors, always_inlined, inlined, kernel
from physicslab.kernels.accounts import CONTACT, DAMPING, ENERGY, GRAVITY, HAND, PX, PY, SPIN
from physicslab.kernels.arguments import Acting, Contacts, Inverse, Motion, Near
from physicslab.kernels.constraint.pair import PairInverseMass, PairVelocity
from physicslab.kernels.motion import damped
from physicslab.kernels.near_counts import DISC_BLOCKS, WIDE_COUNT
from physicslab.kernels.records import Point
from physicslab.kernels.solver.impact_log import Pose, book_outside
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
    "book_damping", "book_gravity", "book_kick", "book_relaxed", "book_slots", "book_solved",
    "note_velocities", "take_means",
]  # fmt: skip


@inlined
def _note(near: Near, row: int, motion: Motion, inverse: Inverse, acting: Acting, h: float) -> None:
    """Note the velocity of a body, without what ``h`` seconds of forces have given to it."""
    x, y, spin = motion.linear[row, 0], motion.linear[row, 1], motion.angular[row]
    if acting.any and not acting.unkicked[row]:
        share = h * inverse.mass[row]
        x -= share * acting.force[row, 0]
        y -= share * acting.force[row, 1]
        spin -= h * inverse.inertia[row] * acting.torque[row]
    near.linear_before[row, 0], near.linear_before[row, 1] = x, y
    near.angular_before[row] = spin


@inlined
def _note_all(near: Near, motion: Motion, inverse: Inverse, acting: Acting, h: float) -> None:
    """Note all velocities, in loops that are vectorised."""
    size = motion.linear.size
    before, now, force = (
        near.linear_before.reshape(size),
        motion.linear.reshape(size),
        acting.force.reshape(size),
    )
    for i in range(size):
        before[i] = now[i]
    for row in range(len(motion.angular)):
        near.angular_before[row] = motion.angular[row]
    if acting.any:
        for row in range(len(motion.angular)):
            span = 0.0 if acting.unkicked[row] else h
            before[2 * row] -= span * inverse.mass[row] * force[2 * row]
            before[2 * row + 1] -= span * inverse.mass[row] * force[2 * row + 1]
            near.angular_before[row] -= span * inverse.inertia[row] * acting.torque[row]


@always_inlined
def note_velocities(
    contacts: Contacts, near: Near, motion: Motion, inverse: Inverse, acting: Acting, h: float
) -> None:
    """Note the velocities of bodies in contact before the impulses of a substep of ``h`` seconds."""
    if near.counts[WIDE_COUNT] > 0:
        _note_all(near, motion, inverse, acting, h)
        return
    for k in range(contacts.number):
        manifold = contacts.manifolds[contacts.touching[k]]
        _note(near, manifold.a, motion, inverse, acting, h)
        _note(near, manifold.b, motion, inverse, acting, h)


@inlined
def take_means(near: Near, motion: Motion) -> None:
    """Put in place of the velocities noted their mean with those of now."""
    size = motion.linear.size
    before, now = near.linear_before.reshape(size), motion.linear.reshape(size)
    for i in range(size):
        before[i] = 0.5 * (before[i] + now[i])
    for row in range(len(motion.angular)):
        near.angular_before[row] = 0.5 * (near.angular_before[row] + motion.angular[row])


@inlined
def _relative(point: Point, a: int, b: int, linear: Vectors, angular: Numbers) -> tuple[float, float]:
    """Return the velocity of B's point against A's [m/s]."""
    vx = linear[b, 0] - angular[b] * point.arm_by - linear[a, 0] + angular[a] * point.arm_ay
    vy = linear[b, 1] + angular[b] * point.arm_bx - linear[a, 1] - angular[a] * point.arm_ax
    return vx, vy


@inlined
def _book_moved(
    near: Near, motion: Motion, inverse: Inverse, a: int, b: int, x: float, y: float, px: float, py: float
) -> None:
    """Book that an impulse from outside acted where B was against A before it moved by (x, y) [m]."""
    still = a if inverse.mass[a] == 0.0 else b
    linear = motion.linear
    driven = linear[still, 0] != 0.0 or linear[still, 1] != 0.0 or motion.angular[still] != 0.0
    near.account[HAND if driven else CONTACT, SPIN] -= x * py - y * px


@always_inlined
def book_solved(
    contacts: Contacts, near: Near, motion: Motion, inverse: Inverse, h: float
) -> tuple[float, float]:
    """Return the work of normal and tangential impulses of scalar contacts [J] since velocities were noted.

    Bodies have moved for ``h`` seconds since, which separations follow. What comes from outside is booked by
    :func:`book_relaxed`, at the places that bodies have now; that these impulses acted before is booked here.
    """
    pressed, rubbed = 0.0, 0.0
    for k in range(contacts.number):
        p = contacts.touching[k]
        manifold = contacts.manifolds[p]
        a, b, nx, ny, px, py = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y, 0.0, 0.0
        for j in range(2 * p, 2 * p + manifold.count):
            point = contacts.points[j]
            vx, vy = _relative(point, a, b, motion.linear, motion.angular)
            push, rub, along, across = (
                point.normal_impulse,
                point.tangent_impulse,
                nx * vx + ny * vy,
                nx * vy - ny * vx,
            )
            if push != 0.0 or rub != 0.0:  # most that do not touch yet have none
                ux, uy = _relative(point, a, b, near.linear_before, near.angular_before)
                pressed += 0.5 * push * (nx * ux + ny * uy + along)
                rubbed += 0.5 * rub * (nx * uy - ny * ux + across)
            point.separation += h * along
            near.noted[j, 0], near.noted[j, 1], near.noted[j, 2], near.noted[j, 3] = push, rub, along, across
            px += push * nx - rub * ny
            py += push * ny + rub * nx
        if inverse.mass[a] == 0.0 or inverse.mass[b] == 0.0:
            still, sign = (a, 1.0) if inverse.mass[a] == 0.0 else (b, -1.0)
            position, linear = motion.position, motion.linear
            x = position[b, 0] - position[a, 0] - manifold.offset_x + sign * h * linear[still, 0]
            y = position[b, 1] - position[a, 1] - manifold.offset_y + sign * h * linear[still, 1]
            _book_moved(near, motion, inverse, a, b, x, y, px, py)
    return pressed, rubbed


@inlined
def _masses(a: int, b: int, inverse: Inverse) -> PairInverseMass[float]:
    return PairInverseMass(inverse.mass[a], inverse.inertia[a], inverse.mass[b], inverse.inertia[b])


@inlined
def _pose(a: int, b: int, motion: Motion) -> Pose:
    position, angle = motion.position, motion.angle
    return Pose(position[a, 0], position[a, 1], angle[a], position[b, 0], position[b, 1], angle[b])


@inlined
def _speeds(a: int, b: int, motion: Motion) -> PairVelocity[float]:
    linear, angular = motion.linear, motion.angular
    return PairVelocity(linear[a, 0], linear[a, 1], angular[a], linear[b, 0], linear[b, 1], angular[b])


@always_inlined
def book_relaxed(contacts: Contacts, near: Near, motion: Motion, inverse: Inverse) -> tuple[float, float]:
    """Return the work of what impulses of scalar contacts have changed by since :func:`book_solved` [J].

    Book what comes from outside by the whole of them: momentum, and the work of drivers. Outside is what no
    impulse moves: fixed, held and driven bodies, and what keeps a body from turning.
    """
    pressed, rubbed = 0.0, 0.0
    for k in range(contacts.number):
        p = contacts.touching[k]
        manifold = contacts.manifolds[p]
        a, b, nx, ny = manifold.a, manifold.b, manifold.normal_x, manifold.normal_y
        px, py, turn_a, turn_b = 0.0, 0.0, 0.0, 0.0
        for j in range(2 * p, 2 * p + manifold.count):
            point, noted = contacts.points[j], near.noted
            push, rub = point.normal_impulse, point.tangent_impulse
            more, also = push - noted[j, 0], rub - noted[j, 1]
            if more != 0.0 or also != 0.0:
                vx, vy = _relative(point, a, b, motion.linear, motion.angular)
                pressed += 0.5 * more * (noted[j, 2] + nx * vx + ny * vy)
                rubbed += 0.5 * also * (noted[j, 3] + nx * vy - ny * vx)
            x, y = push * nx - rub * ny, push * ny + rub * nx
            px, py = px + x, py + y
            turn_a += point.arm_ax * y - point.arm_ay * x
            turn_b += point.arm_bx * y - point.arm_by * x
        if inverse.inertia[a] == 0.0 or inverse.inertia[b] == 0.0:
            book_outside(
                near.account, CONTACT, _masses(a, b, inverse), _pose(a, b, motion), _speeds(a, b, motion),
                px, py, turn_a, turn_b,
            )  # fmt: skip
    return pressed, rubbed


@inlined
def book_slots(near: Near, motion: Motion, inverse: Inverse, solved: bool) -> None:
    """Book what comes from outside by wide contacts in a substep; where it is just ``solved``, note it.

    What is noted are the impulses that then act, and the place of the body that they move: their moment is
    that about where it was, and that of what they change by later about where it is then.
    """
    for slots in (near.discs, near.boxes):
        data, rows = slots.data, rows_of(slots.kind)
        for k in range(near.counts[DISC_BLOCKS + slots.kind]):
            if not slots.outside[k]:
                continue
            for slot in range(k * WIDE, (k + 1) * WIDE):
                a, b, at = slots.a[slot], slots.b[slot], k * rows + slot - k * WIDE
                if slots.pair[slot] < 0 or (inverse.inertia[a] > 0.0 and inverse.inertia[b] > 0.0):
                    continue
                nx, ny, noted, j = data[at + NORMAL_X], data[at + NORMAL_Y], near.noted, 2 * slots.pair[slot]
                push, rub = data[at + ONE + IMPULSE], data[at + ONE + TANGENT_IMPULSE]
                px, py = push * nx - rub * ny, push * ny + rub * nx
                if slots.kind == DISC:
                    turn_a, turn_b = data[at + RADIUS_A] * rub, -data[at + RADIUS_B] * rub
                else:
                    turn_a = data[at + ONE + ARM_AX] * py - data[at + ONE + ARM_AY] * px
                    turn_b = data[at + ONE + ARM_BX] * py - data[at + ONE + ARM_BY] * px
                    push, rub = data[at + TWO + IMPULSE], data[at + TWO + TANGENT_IMPULSE]
                    x, y = push * nx - rub * ny, push * ny + rub * nx
                    px, py = px + x, py + y
                    turn_a += data[at + TWO + ARM_AX] * y - data[at + TWO + ARM_AY] * x
                    turn_b += data[at + TWO + ARM_BX] * y - data[at + TWO + ARM_BY] * x
                moved, sign = (b, 1.0) if inverse.mass[a] == 0.0 else (a, -1.0)
                here_x, here_y = sign * motion.position[moved, 0], sign * motion.position[moved, 1]
                if solved:
                    noted[j, 0], noted[j, 1], noted[j, 2], noted[j, 3] = px, py, here_x, here_y
                    continue
                book_outside(
                    near.account, CONTACT, _masses(a, b, inverse), _pose(a, b, motion), _speeds(a, b, motion),
                    px, py, turn_a, turn_b,
                )  # fmt: skip
                if inverse.mass[a] == 0.0 or inverse.mass[b] == 0.0:
                    x, y = here_x - noted[j, 2], here_y - noted[j, 3]
                    _book_moved(near, motion, inverse, a, b, x, y, noted[j, 0], noted[j, 1])


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
