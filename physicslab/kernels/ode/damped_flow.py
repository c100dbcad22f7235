"""The flow of springs with dampers, of springs that turn bodies, and of drag, beside contacts.

It is the splitting of :mod:`physicslab.kernels.ode.spring_flow`, whose kicks are here the motion of
velocities while all places stay: it is linear in them, and followed by its Taylor series. The splitting is
symmetric, so that it is of order 4 for these kicks as well. Springs are taken eight at a time, as there.
Those that need most terms come first: a term is one of the first slots and of the first bodies.

Dampers take the integral of their power over the same series, and so does drag by the speed of what springs
hold. Bodies that only drag and gravity act on are followed each by itself
(:mod:`physicslab.kernels.ode.drag_flow`).
"""

import itertools
import math

import numpy as np

from physicslab.kernels import Numbers, Rows, Vectors, always_inlined, inlined
from physicslab.kernels.accounts import DAMPING, book
from physicslab.kernels.arguments import Motion, Springs
from physicslab.kernels.directions import face
from physicslab.kernels.float64x8 import choose, everywhere, mask_bits, put, root, sum_of, take
from physicslab.kernels.ode import spring_flow as S
from physicslab.kernels.ode.drag_flow import fall_in_drag
from physicslab.kernels.ode.held_drag import Slowed, slow, slow_alone, slowed_in
from physicslab.kernels.ode.spring_ends import Full, apart, full_in, opening_of, pull_ends
from physicslab.kernels.ode.spring_flow import Links, Places
from physicslab.kernels.wide_layout import WIDE

_PRODUCTS = np.zeros((S.MOST_TERMS + 1, 2 * S.MOST_TERMS))
"""Shares in the work of dampers of the product of two derivatives of velocities, by how many terms a series
has and by the order of both together: the integral of t^order times the sum of 1 / (j! k!) over all j + k
that are the order. It is the same product for all j and k above 0, as dampers resist both ends alike."""
for _j, _k in itertools.product(range(1, S.MOST_TERMS), repeat=2):
    _share = 1.0 / (math.factorial(_j) * math.factorial(_k) * (_j + _k + 1))
    _PRODUCTS[max(_j, _k) + 1 :, _j + _k] += _share


@inlined
def _clear(places: Places, full: Full, turns: bool, bodies: int, ends: Rows, number: int) -> None:
    """Set the pull on the first bodies, and on the first ends that springs do not move, to zero."""
    pull = places.pull.reshape(places.pull.size)
    for i in range(2 * bodies):
        pull[i] = 0.0
    for k in range(number):
        places.pull[ends[k], 0] = places.pull[ends[k], 1] = 0.0
    if turns:
        for i in range(bodies):
            full.twist[i] = 0.0


@inlined
def _evaluate(
    places: Places, links: Links, full: Full, slowed: Slowed, turns: bool, followed: float, ends: Rows
) -> bool:
    """Compute the pull of springs, and if there are dampers of these and of drag.

    Returns whether each spring is long enough.
    """
    short, n, taken = 0, len(links.a), everywhere(0.0)
    _clear(places, full, turns, len(places.moving), ends, len(ends))
    for at in range(0, n, WIDE):
        dx, dy, arms = apart(places, links, full, turns, at)
        length = root(dx * dx + dy * dy)
        share = choose(length > 0.0, 1.0 / length, 0.0)
        nx, ny = dx * share, dy * share
        tension = take(links.stiffness, at) * (length - take(links.rest, at))
        fx, fy = tension * nx, tension * ny
        if at < full.damped:
            if turns:
                put(full.turned_a, at, arms[0])
                put(full.turned_a, n + at, arms[1])
                put(full.turned_b, at, arms[2])
                put(full.turned_b, n + at, arms[3])
            ux, uy = opening_of(places.speed, full.spin, links, turns, arms, at)
            opening = nx * ux + ny * uy
            resisted = take(full.damping, at) * opening
            put(full.along_x, at, nx)
            put(full.along_y, at, ny)
            put(full.first, at, opening)
            taken = taken + resisted * opening
            fx, fy = fx + resisted * nx, fy + resisted * ny
        pull_ends(places, links, full, turns, arms, at, fx, fy)
        short |= mask_bits(length < followed * take(links.rest, at))
    if full.damped > 0:
        full.sums[0] = sum_of(taken)
        if len(slowed.places) > 0:
            slow(places, slowed, places.speed, full.sums, True, len(slowed.places))
    return short == 0


@inlined
def _resist(
    places: Places, links: Links, full: Full, slowed: Slowed, reach: int, turns: bool, ends: Rows
) -> None:
    """Compute the pull of dampers and drag for ``full.rate``, the derivative of velocities of an order.

    ``reach`` is where in :attr:`Full.reach` it stands how far that goes.
    """
    n, by_first, by_last, by_itself = len(links.a), everywhere(0.0), everywhere(0.0), everywhere(0.0)
    bodies, number = full.reach[reach + S.MOST_TERMS], full.reach[reach + 2 * S.MOST_TERMS]
    _clear(places, full, turns, bodies, ends, number)
    for at in range(0, full.reach[reach], WIDE):
        ax = ay = bx = by = everywhere(0.0)
        if turns:
            ax, ay = take(full.turned_a, at), take(full.turned_a, n + at)
            bx, by = take(full.turned_b, at), take(full.turned_b, n + at)
        ux, uy = opening_of(full.rate, full.spin_rate, links, turns, (ax, ay, bx, by), at)
        nx, ny = take(full.along_x, at), take(full.along_y, at)
        opening = nx * ux + ny * uy
        resisted = take(full.damping, at) * opening
        by_first = by_first + resisted * take(full.first, at)
        by_last = by_last + resisted * take(full.opening, at)
        by_itself = by_itself + resisted * opening
        put(full.opening, at, opening)
        pull_ends(places, links, full, turns, (ax, ay, bx, by), at, resisted * nx, resisted * ny)
    full.sums[0], full.sums[1], full.sums[2] = sum_of(by_first), sum_of(by_last), sum_of(by_itself)
    if len(slowed.places) > 0:
        slow(places, slowed, full.rate, full.sums, False, full.reach[reach + 3 * S.MOST_TERMS])


@inlined
def _change(places: Places, full: Full, first: bool, share: float, turns: bool, bodies: int) -> None:
    """Change velocities of the first bodies by a derivative of them, which is computed from the pull.

    The first is of the velocities themselves, and gravity has part in it. ``share`` is that of the derivative
    in the change.
    """
    speed, rate = places.speed.reshape(places.speed.size), full.rate.reshape(full.rate.size)
    pull, gain, gravity = places.pull.reshape(places.pull.size), places.gain, places.gravity
    for i in range(2 * bodies):
        rate[i] = pull[i] * gain[i] + gravity[i] if first else pull[i] * gain[i]
    for i in range(2 * bodies):
        speed[i] += share * rate[i]
    if turns:
        for i in range(bodies):
            full.spin_rate[i] = full.twist[i] * full.spin_gain[i]
            full.spin[i] += share * full.spin_rate[i]


@always_inlined
def _arm(full: Full, rows: Rows, arm: Numbers, slot: int) -> tuple[float, float]:
    """Return where one end is on a turned body."""
    c, s = full.facing[rows[slot], 0], full.facing[rows[slot], 1]
    x, y = arm[slot], arm[len(rows) + slot]
    return c * x - s * y, s * x + c * y


@inlined
def _book_held(places: Places, links: Links, full: Full, span: float, held: Rows, given: Numbers) -> None:
    """Book what springs beside dampers have given in a kick by ends that they do not move.

    ``held`` are the slots of dampers at these ends, twice the slot, and one more where B is the end: what is
    not of the spring is of the damper.
    """
    for k in range(len(held)):
        slot, at_b = held[k] // 2, held[k] % 2 == 1
        a, b = links.a[slot], links.b[slot]
        (ax, ay), (bx, by) = _arm(full, links.a, full.arm_a, slot), _arm(full, links.b, full.arm_b, slot)
        dx = places.place[b, 0] + bx - places.place[a, 0] - ax
        dy = places.place[b, 1] + by - places.place[a, 1] - ay
        length = math.sqrt(dx * dx + dy * dy)
        share = links.stiffness[slot] * (length - links.rest[slot]) / length if length > 0.0 else 0.0
        impulse, i = (-span * share, b) if at_b else (span * share, a)
        x, y = impulse * dx, impulse * dy
        turn = places.place[i, 0] * y - places.place[i, 1] * x
        for account, part in ((S.BY_SPRINGS, -1.0), (S.BY_DAMPERS, 1.0)):
            given[account] += part * x
            given[account + 1] += part * y
            given[account + 2] += part * turn


@inlined
def _book_ends(
    places: Places, full: Full, share: float, ends: Rows, number: int, to: int, turns: bool, bodies: int,
    given: Numbers,
) -> None:  # fmt: skip
    """Book what a share of the pull gives by the first ends that springs do not move or bodies not turn."""
    S.book_ends(places, ends, number, share, to, given)
    if turns:
        for i in range(bodies):
            if full.spin_gain[i] == 0.0:
                given[S.BY_SPRINGS + 2] -= share * full.twist[i]
                given[S.BY_HAND] -= share * full.twist[i] * full.spin[i]


@always_inlined
def _terms(reach: Rows, at: int) -> int:
    """Return how many terms a series has: at least one."""
    terms = 1
    while terms < S.MOST_TERMS and reach[at + terms] > 0:
        terms += 1
    return terms


@inlined
def _kick(
    places: Places, links: Links, full: Full, slowed: Slowed, span: float, number: int, turns: bool,
    ends: Rows, held: Rows, given: Numbers,
) -> None:  # fmt: skip
    """Change velocities by what acts for ``span`` seconds at these places, of which the pull is computed.

    ``number`` is which kick of a step it is, that where two steps meet after all of these. Dampers take the
    integral of c r^2, r being the series of how fast they open: of products of its derivatives with the
    first and the last one, as all of the same order in sum are the same (:data:`_PRODUCTS`).
    """
    to, share, bodies = S.BY_DAMPERS if len(held) > 0 else S.BY_SPRINGS, span, len(places.moving)
    slots, sums = 4 * S.MOST_TERMS * number, full.sums
    drags = slots + 3 * S.MOST_TERMS
    of_drag = _terms(full.reach, drags)
    terms = max(of_drag, _terms(full.reach, slots))
    if full.damped == 0 and len(slowed.places) > 0:
        slow_alone(places, slowed, span, of_drag, given)
    _book_ends(places, full, share, ends, len(ends), to, turns, bodies, given)
    _change(places, full, True, share, turns, bodies)
    if full.damped > 0:
        taken, power = span * sums[0], 1.0
        _book_drag(sums, share, given)
        for term in range(1, terms):
            share *= span / (term + 1)
            bodies = full.reach[slots + S.MOST_TERMS + term]
            held_ends = full.reach[slots + 2 * S.MOST_TERMS + term]
            _resist(places, links, full, slowed, slots + term, turns, ends)
            _book_ends(places, full, share, ends, held_ends, to, turns, bodies, given)
            _change(places, full, False, share, turns, bodies)
            _book_drag(sums, share, given)
            power *= span * span
            odd, even = _PRODUCTS[terms, 2 * term - 1], _PRODUCTS[terms, 2 * term]
            taken += 2.0 * share * sums[0] + power * (odd * sums[1] + span * even * sums[2])
        given[S.DISSIPATED] += taken
        _book_held(places, links, full, span, held, given)


@always_inlined
def _book_drag(sums: Numbers, share: float, given: Numbers) -> None:
    """Book the impulse that drag by a derivative of velocities has a share in."""
    given[S.BY_DAMPERS] -= share * sums[3]
    given[S.BY_DAMPERS + 1] -= share * sums[4]
    given[S.BY_DAMPERS + 2] -= share * sums[5]


@inlined
def _drift(places: Places, full: Full, span: float, turns: bool) -> None:
    """Move and turn what moves for ``span`` seconds."""
    place, speed = places.place.reshape(places.place.size), places.speed.reshape(places.speed.size)
    for i in range(len(places.gain)):
        place[i] += span * speed[i]
    if turns:
        for i in range(len(full.spin_gain)):
            full.angle[i] += span * full.spin[i]
        face(full.angle, full.facing)


@inlined
def _follows(places: Places, links: Links, full: Full, turns: bool, h: float) -> bool:
    """Whether no spring turns too far, or changes too much, in ``h`` seconds."""
    fast = 0
    for at in range(0, len(links.a), WIDE):
        dx, dy, arms = apart(places, links, full, turns, at)
        ux, uy = opening_of(places.speed, full.spin, links, turns, arms, at)
        far = (ux * ux + uy * uy) * (h * h) > (dx * dx + dy * dy) * (S.MAX_TURN * S.MAX_TURN)
        fast |= mask_bits(far & (take(links.rest, at) > 0.0))
    return fast == 0


@inlined
def _advance(
    places: Places, links: Links, full: Full, slowed: Slowed, drifts: Numbers, kicks: Numbers, h: float,
    steps: int, followed: float, turns: bool, ends: Rows, held: Rows, given: Numbers,
) -> int:  # fmt: skip
    """Advance what was gathered, as :func:`flow_forces` does: where steps meet, two kicks are one."""
    if not _follows(places, links, full, turns, h):
        return S.TURNS_FAST
    stages, evaluations = len(drifts), 0
    if places.known[0] == 0.0 or full.damped > 0:
        evaluations = 1
        if not _evaluate(places, links, full, slowed, turns, followed, ends):
            return S.TURNS_FAST
    torque, rate = S.torque_of_gravity(places)
    for number in range(steps * stages + 1):
        stage, last = number % stages, number == steps * stages
        which, kick = stages if last else stage, kicks[stages if last else stage] * h
        if stage == 0 and number > 0 and not last:
            which, kick = stages + 1, kicks[stages] * h + kick
            torque, rate = S.book_gravity(places, h, torque, rate, given)
        _kick(places, links, full, slowed, kick, which, turns, ends, held, given)
        if not last:
            _drift(places, full, drifts[stage] * h, turns)
            evaluations += 1
            if not _evaluate(places, links, full, slowed, turns, followed, ends):
                return S.TURNS_FAST
    S.book_gravity(places, h, torque, rate, given)
    return evaluations


@inlined
def _take_spins(places: Places, full: Full, motion: Motion) -> None:
    """Take the turning of what moves; the pull is known no more if anything is turned otherwise."""
    same = places.known[0] != 0.0
    for i in range(len(full.spin_gain)):
        row = places.moving[i]
        same = same and motion.angle[row] == full.angle[i]
        full.angle[i], full.spin[i] = motion.angle[row], motion.angular[row]
    face(full.angle, full.facing)
    places.known[0] = 1.0 if same else 0.0


@inlined
def _put_spins(places: Places, full: Full, motion: Motion) -> None:
    for i in range(len(full.spin_gain)):
        row = places.moving[i]
        motion.angle[row], motion.angular[row] = full.angle[i], full.spin[i]


@inlined
def flow_forces(motion: Motion, springs: Springs, span: float, account: Vectors) -> int:
    """Move bodies on springs and in drag for ``span`` seconds; return the number of force evaluations.

    Plain springs between middles are left to :func:`flow_springs`, which says how fast springs are followed.
    """
    numbers, whole = springs
    m, p, n = whole[0], whole[1], whole[2]
    turns, alone, last, made = whole[5] != 0, whole[6], len(whole), 0
    if whole[4] == 0:
        made = S.flow_springs(motion, springs, span, account)
    else:
        places, links, ends, given, drifts, kicks, at = S.named(springs)
        dragged, reach = last - alone - whole[8], S.SIZES + m + 2 * n + whole[7]
        behind = reach + 4 * S.MOST_TERMS * (len(kicks) + 1)
        held = whole[behind:dragged]
        full, slowed = full_in(numbers, at, m, p, n, whole[9], whole[reach:behind]), slowed_in(springs)
        steps, finer, made = S.steps_of(springs, span), 1, S.TURNS_FAST
        while made < 0 and finer <= S.FINEST:
            S.gather(places, motion)
            if turns:
                _take_spins(places, full, motion)
            for i in range(len(given)):
                given[i] = 0.0
            made = _advance(
                places, links, full, slowed, drifts, kicks, span / (finer * steps), finer * steps,
                S.still_followed(springs, finer), turns, ends, held, given,
            )  # fmt: skip
            finer *= 2
        places.known[0] = 1.0 if made >= 0 else 0.0
        if made >= 0:
            if turns:
                _put_spins(places, full, motion)
            S.scatter(places, motion, 0.0 if turns else span)
            S.book_given(given, numbers, span, account)
            book(
                account[DAMPING], 0, -given[S.DISSIPATED], given[S.BY_DAMPERS], given[S.BY_DAMPERS + 1],
                given[S.BY_DAMPERS + 2],
            )  # fmt: skip
    if made >= 0 and alone > 0:
        drag = numbers[len(numbers) - 3 * alone :]
        fall_in_drag(
            motion, whole[last - alone :], drag, numbers[S.UNIFORM], numbers[S.UNIFORM + 1], span, account
        )
    return made
