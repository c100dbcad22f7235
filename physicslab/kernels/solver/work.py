"""Work and impulse of contacts, and of kicks.

Impulses J that act at one moment do the work J (v + v') / 2 each, with the velocities v and v' of its point
before and after all of them. Half of what the forces of a substep give to the point's velocity is not there
yet, or not any more: with a the acceleration of the point by forces, the mean velocity within the substep is
(v + v' - a h) / 2. A body at rest then does no work: its velocity is a h before, and 0 after.
"""

from typing import NamedTuple

from physicslab.kernels import Flags, Numbers, Rows, Vectors, always_inlined, inlined, kernel
from physicslab.kernels import wide_layout as L
from physicslab.kernels.accounts import (
    ANGULAR_MOMENTUM,
    CONTACT,
    DAMPING,
    ENERGY,
    FRICTION,
    GRAVITY,
    HAND,
    JOINTS,
    book,
)
from physicslab.kernels.arguments import Acting, Contacts, Inverse, Motion, Near
from physicslab.kernels.constraint.pair import (
    along_and_across,
    impulse_at,
    inverse_mass_of,
    moments_of,
    velocity_of,
)
from physicslab.kernels.joints import blocks as B
from physicslab.kernels.joints.blocks import Tables
from physicslab.kernels.motion import damped
from physicslab.kernels.near_counts import DISC_BLOCKS, WIDE_COUNT
from physicslab.kernels.solver.constraints import Constraints, moments_about, speeds_at
from physicslab.kernels.solver.impact_log import Pose, book_outside
from physicslab.kernels.types import unsigned
from physicslab.kernels.wide.solve import slot_frame


@always_inlined
def _note(near: Near, row: int, motion: Motion, inverse: Inverse, acting: Acting, h: float) -> None:
    """Note the velocity of a body; without what ``h`` seconds of forces have given to it unless all alike."""
    x, y, spin = motion.linear[row, 0], motion.linear[row, 1], motion.angular[row]
    if acting.any and not acting.uniform and not acting.unkicked[row]:
        share = h * inverse.mass[row]
        x -= share * acting.force[row, 0]
        y -= share * acting.force[row, 1]
        spin -= h * inverse.inertia[row] * acting.torque[row]
    near.linear_before[row, 0], near.linear_before[row, 1] = x, y
    near.angular_before[row] = spin


@always_inlined
def note_velocities(
    contacts: Contacts, near: Near, motion: Motion, inverse: Inverse, acting: Acting, h: float
) -> None:
    """Note the velocities of bodies in contact before the impulses of a substep of ``h`` seconds."""
    rows = len(motion.angular)
    if near.counts[WIDE_COUNT] == 0 and 2 * contacts.number < rows:
        for k in range(contacts.number):
            manifold = contacts.manifolds[contacts.touching[k]]
            for row in (manifold.a, manifold.b):
                _note(near, row, motion, inverse, acting, h)
    elif acting.any and not acting.uniform:
        for row in range(rows):
            _note(near, row, motion, inverse, acting, h)
    else:  # in loops that are vectorised
        for row in range(rows):
            near.linear_before[row, 0] = motion.linear[row, 0]
            near.linear_before[row, 1] = motion.linear[row, 1]
        for row in range(rows):
            near.angular_before[row] = motion.angular[row]


@kernel
def note_flow(
    linear_before: Vectors, angular_before: Numbers, linear: Vectors, angular: Numbers, force: Vectors,
    torque: Numbers, inverse_mass: Numbers, inverse_inertia: Numbers, rows: Rows, unkicked: Flags,
    uniform: bool, sign: float, h: float,
) -> None:  # fmt: skip
    """Take from the velocities noted what a flow changes those of its ``rows`` by, until contacts are booked.

    Called with 1 and the time ``h`` [s] of the flow before it, and with -1 and 0 after. A note is
    less than the velocities by the kick of a substep, twice ``h``, which the bodies of a flow do not get:
    half of it is what was predicted for them. Where forces are ``uniform`` it is taken later, of all bodies.
    """
    for i in rows:
        share = h if not unkicked[i] else 2.0 * h if uniform else 0.0
        linear_before[i, 0] += sign * linear[i, 0] + share * inverse_mass[i] * force[i, 0]
        linear_before[i, 1] += sign * linear[i, 1] + share * inverse_mass[i] * force[i, 1]
        angular_before[i] += sign * angular[i] + share * inverse_inertia[i] * torque[i]


@inlined
def take_means(near: Near, motion: Motion) -> None:
    """Put in place of the velocities noted their mean with those of now."""
    size = motion.linear.size
    before, now = near.linear_before.reshape(size), motion.linear.reshape(size)
    for i in range(size):
        before[i] = 0.5 * (before[i] + now[i])
    for row in range(len(motion.angular)):
        near.angular_before[row] = 0.5 * (near.angular_before[row] + motion.angular[row])


@always_inlined
def _pull(a: int, b: int, inverse: Inverse, acting: Acting) -> tuple[float, float]:
    """Return how uniform forces accelerate B against A [m/s^2]: not at all where both can be moved."""
    force, ma, mb = acting.force, inverse.mass[a], inverse.mass[b]
    return mb * force[b, 0] - ma * force[a, 0], mb * force[b, 1] - ma * force[a, 1]


@always_inlined
def _is_driven(motion: Motion, row: int) -> bool:
    """Whether a body moves that no impulse moves."""
    return bool(motion.linear[row, 0] != 0.0 or motion.linear[row, 1] != 0.0 or motion.angular[row] != 0.0)


@always_inlined
def _book_moved(
    near: Near, motion: Motion, inverse: Inverse, a: int, b: int, x: float, y: float, px: float, py: float
) -> None:
    """Book that an impulse from outside acted where B was against A before it moved by (x, y) [m]."""
    driven = _is_driven(motion, a if inverse.mass[a] == 0.0 else b)
    near.account[HAND if driven else CONTACT, ANGULAR_MOMENTUM] -= x * py - y * px


@always_inlined
def book_solved(
    contacts: Contacts, constraints: Constraints, near: Near, motion: Motion, inverse: Inverse,
    acting: Acting, h: float, half: float,
) -> tuple[float, float]:  # fmt: skip
    """Return the work of normal and tangential impulses of scalar contacts [J] since velocities were noted.

    Bodies have moved for ``h`` seconds since, which separations follow; ``half`` of the substep [s] is how
    long uniform forces acted on the mean of the noted velocities, and not on fixed bodies. What comes from
    outside is booked by :func:`book_relaxed`, at the places that bodies have now; that these impulses acted
    before is booked here.
    """
    pressed, friction_work = 0.0, 0.0
    for k in range(contacts.number):
        p = contacts.touching[k]
        manifold, pair = contacts.manifolds[p], constraints.pairs[k]
        a, b, normal, tangent = pair.a, pair.b, 0.0, 0.0
        v, before = (
            velocity_of(motion.linear, motion.angular, a, b),
            velocity_of(near.linear_before, near.angular_before, a, b),
        )
        for j in range(pair.count):
            point, found = constraints.points[unsigned(2 * k + j)], contacts.points[unsigned(2 * p + j)]
            push, rub = point.normal_impulse, point.tangent_impulse
            speed, sliding = speeds_at(pair, point, v)
            if push != 0.0 or rub != 0.0:  # most that do not touch yet have none
                earlier, slid = speeds_at(pair, point, before)
                pressed += 0.5 * push * (earlier + speed)
                friction_work += 0.5 * rub * (slid + sliding)
            found.separation += h * (speed - found.bend)
            point.noted_normal, point.noted_tangent = push, rub
            point.noted_speed, point.noted_sliding = speed, sliding
            normal, tangent = normal + push, tangent + rub
        if pair.mass_a == 0.0 or pair.mass_b == 0.0:
            still, sign = (a, 1.0) if pair.mass_a == 0.0 else (b, -1.0)
            position, linear = motion.position, motion.linear
            x = position[b, 0] - position[a, 0] - manifold.offset_x + sign * h * linear[still, 0]
            y = position[b, 1] - position[a, 1] - manifold.offset_y + sign * h * linear[still, 1]
            if acting.uniform:
                ax, ay = _pull(a, b, inverse, acting)
                pull, across = along_and_across(pair.normal_x, pair.normal_y, ax, ay)
                pressed -= half * normal * pull
                friction_work -= half * tangent * across
            px, py = impulse_at(pair.normal_x, pair.normal_y, normal, tangent)
            _book_moved(near, motion, inverse, a, b, x, y, px, py)
    return pressed, friction_work


class Given(NamedTuple):
    """Momentum (x, y) [N s] and angular momentum about the origin [N m s] that fixed bodies give."""

    px: float
    py: float
    spin: float


@always_inlined
def _given(
    given: Given, near: Near, motion: Motion, inverse: Inverse, a: int, b: int, px: float, py: float,
    turn_a: float, turn_b: float,
) -> Given:  # fmt: skip
    """Return what is given so far and by the impulse (px, py) on B, and its opposite on A.

    ``turn_a`` and ``turn_b`` are its moments about both centres. What a driven body gives, or what keeps a
    body from turning, is booked by itself: there is little of that.
    """
    position, angle = motion.position, motion.angle
    free = inverse.mass[a] > 0.0 and inverse.mass[b] > 0.0
    if free or _is_driven(motion, a if inverse.mass[a] == 0.0 else b):
        book_outside(
            near.account, CONTACT,
            inverse_mass_of(inverse, a, b),
            Pose(position[a, 0], position[a, 1], angle[a], position[b, 0], position[b, 1], angle[b]),
            velocity_of(motion.linear, motion.angular, a, b), px, py, turn_a, turn_b,
        )  # fmt: skip
        return given
    moved, sign, turn = (b, 1.0, turn_b) if inverse.mass[b] > 0.0 else (a, -1.0, turn_a)
    spin = position[moved, 0] * py - position[moved, 1] * px
    spin += turn if inverse.inertia[moved] > 0.0 else 0.0
    return Given(given.px + sign * px, given.py + sign * py, given.spin + sign * spin)


@inlined
def _book_given(near: Near, given: Given) -> None:
    """Book what fixed bodies give."""
    book(near.account[CONTACT], 0, 0.0, given.px, given.py, given.spin)


@always_inlined
def book_relaxed(
    constraints: Constraints, near: Near, motion: Motion, inverse: Inverse
) -> tuple[float, float]:
    """Return the work of what impulses of scalar contacts have changed by since :func:`book_solved` [J].

    Book what comes from outside by the whole of them: momentum, and the work of drivers. Outside is what no
    impulse moves: fixed, held and driven bodies, and what keeps a body from turning.
    """
    pressed, friction_work, given = 0.0, 0.0, Given(0.0, 0.0, 0.0)
    for k in range(constraints.number):
        pair = constraints.pairs[k]
        a, b, normal, tangent, turn_a, turn_b = pair.a, pair.b, 0.0, 0.0, 0.0, 0.0
        v = velocity_of(motion.linear, motion.angular, a, b)
        for j in range(pair.count):
            point = constraints.points[unsigned(2 * k + j)]
            push, rub = point.normal_impulse, point.tangent_impulse
            more, also = push - point.noted_normal, rub - point.noted_tangent
            if more != 0.0 or also != 0.0:
                speed, sliding = speeds_at(pair, point, v)
                pressed += 0.5 * more * (point.noted_speed + speed)
                friction_work += 0.5 * also * (point.noted_sliding + sliding)
            moment_a, moment_b = moments_about(point, push, rub)
            normal, tangent, turn_a, turn_b = (
                normal + push,
                tangent + rub,
                turn_a + moment_a,
                turn_b + moment_b,
            )
        if pair.inertia_a == 0.0 or pair.inertia_b == 0.0:
            px, py = impulse_at(pair.normal_x, pair.normal_y, normal, tangent)
            given = _given(given, near, motion, inverse, a, b, px, py, turn_a, turn_b)
    _book_given(near, given)
    return pressed, friction_work


@always_inlined
def _slot_impulse(slots: L.Slots, at: int, point: int) -> tuple[float, float, float, float]:
    """Return the impulse at a point of a slot [N s], and its moments about both centres [N m s]."""
    frame, impulses = slot_frame(slots, at, point), at + point
    normal, tangent = slots.data[impulses + L.IMPULSE], slots.data[impulses + L.TANGENT_IMPULSE]
    px, py = impulse_at(frame.nx, frame.ny, normal, tangent)
    moment_a, moment_b = moments_of(frame, px, py)
    return px, py, moment_a, moment_b


@inlined
def book_slots(
    near: Near, motion: Motion, inverse: Inverse, acting: Acting, half: float, solved: bool
) -> tuple[float, float]:
    """Book what comes from outside by wide contacts in a substep; where it is just ``solved``, note it.

    Noted are the impulses that then act, and the place of the body that they move: their moment is
    that about where it was, and that of what they change by later about where it is then. Returns, once that
    is booked, the work of normal and of tangential impulses [J] that sweeps have booked too much:
    :func:`book_solved` says what uniform forces do in ``half`` of the substep [s].
    """
    given, pressed, friction_work = Given(0.0, 0.0, 0.0), 0.0, 0.0
    for slots in (near.discs, near.boxes):
        rows = L.rows_of(slots.kind)
        for k in range(near.counts[DISC_BLOCKS + slots.kind]):
            if not slots.outside[k]:
                continue
            for slot in range(k * L.WIDE, (k + 1) * L.WIDE):
                a, b, at = unsigned(slots.a[slot]), unsigned(slots.b[slot]), k * rows + slot - k * L.WIDE
                if slots.pair[slot] < 0 or (inverse.inertia[a] > 0.0 and inverse.inertia[b] > 0.0):
                    continue
                noted, j = near.noted, 2 * slots.pair[slot]
                px, py, turn_a, turn_b = _slot_impulse(slots, at, L.ONE)
                if slots.kind == L.BOX:
                    x, y, moment_a, moment_b = _slot_impulse(slots, at, L.TWO)
                    px, py, turn_a, turn_b = px + x, py + y, turn_a + moment_a, turn_b + moment_b
                moved, sign = (b, 1.0) if inverse.mass[a] == 0.0 else (a, -1.0)
                here_x, here_y = sign * motion.position[moved, 0], sign * motion.position[moved, 1]
                if solved:
                    noted[j, 0], noted[j, 1], noted[j, 2], noted[j, 3] = px, py, here_x, here_y
                    continue
                given = _given(given, near, motion, inverse, a, b, px, py, turn_a, turn_b)
                if inverse.mass[a] == 0.0 or inverse.mass[b] == 0.0:
                    x, y = here_x - noted[j, 2], here_y - noted[j, 3]
                    _book_moved(near, motion, inverse, a, b, x, y, noted[j, 0], noted[j, 1])
                    if acting.uniform:
                        nx, ny = slots.data[at + L.NORMAL_X], slots.data[at + L.NORMAL_Y]
                        ax, ay = _pull(a, b, inverse, acting)
                        pull, across = along_and_across(nx, ny, ax, ay)
                        push, rub = along_and_across(nx, ny, noted[j, 0], noted[j, 1])
                        pressed += half * push * pull
                        friction_work += half * rub * across
    if not solved:
        _book_given(near, given)
    return pressed, friction_work


@inlined
def book_work_of_contacts(near: Near, pressed: float, friction_work: float) -> None:
    """Book the work of normal and of tangential impulses in a substep [J].

    Friction gives no energy: where sliding turns round within a substep, or friction holds a body that is
    pushed out of an overlap, the mean speed is not that at which it acts.
    """
    taken = min(friction_work, 0.0)
    near.account[CONTACT, ENERGY] += pressed + (friction_work - taken)
    near.account[FRICTION, ENERGY] += taken


@inlined
def book_gravity(
    account: Vectors, total: float, mx: float, my: float, gx: float, gy: float, h: float
) -> None:
    """Book the impulse of uniform gravity in ``h`` seconds on a mass of such moments."""
    book(account[GRAVITY], 0, 0.0, h * total * gx, h * total * gy, h * (mx * gy - my * gx))


@kernel
def book_held(
    position: Vectors, mass: Numbers, inverse_mass: Numbers, inverse_inertia: Numbers,
    awake_inverse_mass: Numbers, forces: Vectors, uniform: bool, gx: float, gy: float, other: int, h: float,
    nodes: Tables, body: Rows, gradient: Vectors, impulse: Numbers, share: float, account: Vectors,
) -> None:  # fmt: skip
    """Book that forces pull bodies that sleep for ``h`` seconds, and joints and contacts hold them.

    The ``forces`` and torques (rows, 3) but for gravity are booked to ``other``, unless all are ``uniform``.
    The fixed ends of joints give a ``share`` of their last impulses, and contacts what is left.
    """
    px, py, spin, x, y, turn, ox, oy, around = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(len(mass)):
        if inverse_mass[i] > 0.0 and awake_inverse_mass[i] == 0.0:
            jx, jy = h * mass[i] * gx, h * mass[i] * gy
            px += jx
            py += jy
            spin += position[i, 0] * jy - position[i, 1] * jx
            if not uniform and forces[i, 0] == forces[i, 0]:
                jx, jy = h * forces[i, 0] - jx, h * forces[i, 1] - jy
                ox += jx
                oy += jy
                around += position[i, 0] * jy - position[i, 1] * jx
                if inverse_inertia[i] > 0.0:
                    around += h * forces[i, 2]
    for k in range(len(nodes) - 1):
        row = nodes[k, B.ROW]
        first, second = share * impulse[row], 0.0
        if nodes[k, B.WIDTH] == 2:
            second = share * impulse[row + 1]
        for e in range(nodes[k, B.ENDS], nodes[k + 1, B.ENDS]):
            i = body[e]
            if inverse_mass[i] > 0.0 and awake_inverse_mass[i] == 0.0:
                jx = first * gradient[e, 0] + second * gradient[e, 3]
                jy = first * gradient[e, 1] + second * gradient[e, 4]
                x += jx
                y += jy
                turn += first * gradient[e, 2] + second * gradient[e, 5]
                turn += position[i, 0] * jy - position[i, 1] * jx
    book(account[GRAVITY], 0, 0.0, px, py, spin)
    book(account[JOINTS], 0, 0.0, x, y, turn)
    book(account[other], 0, 0.0, ox, oy, around)
    book(account[CONTACT], 0, 0.0, -(px + x + ox), -(py + y + oy), -(spin + turn + around))


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
            book(account[GRAVITY], 0, 0.0, h * wx, h * wy, h * (x * wy - y * wx))
            fx, fy = force[i, 0] - wx, force[i, 1] - wy
            px += h * fx
            py += h * fy
            spin += h * (x * fy - y * fx)
            if inverse_inertia[i] > 0.0:
                spin += h * torque[i]
    book(account[other], 0, 0.0, px, py, spin)


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
        book(account[DAMPING], 0, along + across + around, px, py, x * py - y * px + turned)
