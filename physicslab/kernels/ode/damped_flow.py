"""The flow of springs with dampers, of springs that turn bodies, and of drag, beside contacts.

It is the splitting of :mod:`physicslab.kernels.ode.spring_flow`, whose kicks are here the motion of
velocities while all places stay: it is linear in them, and followed by its Taylor series. The splitting is
symmetric, so that it is of order 4 for these kicks as well. Springs are taken eight at a time, as there.

Dampers take the integral of their power over the same series, and so does drag by the speed of what springs
hold. Bodies that only drag and gravity act on are followed each by itself
(:mod:`physicslab.kernels.ode.drag_flow`).
"""

from typing import NamedTuple

from physicslab.kernels import Numbers, Rows, Vectors, always_inlined, inlined, inlined_by_numba
from physicslab.kernels.accounts import DAMPING, book
from physicslab.kernels.arguments import Motion, Springs
from physicslab.kernels.directions import face
from physicslab.kernels.float64x8 import (
    Wide,
    choose,
    everywhere,
    mask_bits,
    put,
    put_numbers,
    put_vectors,
    root,
    sum_of,
    take,
    take_numbers,
    take_vectors,
)
from physicslab.kernels.ode import spring_flow as S
from physicslab.kernels.ode.drag_flow import fall_in_drag
from physicslab.kernels.ode.held_drag import Slowed, book_drag, slow, slow_alone, slowed_in
from physicslab.kernels.ode.spring_flow import Links, Places
from physicslab.kernels.wide_layout import WIDE

type Arms = tuple[Wide, Wide, Wide, Wide]
_AT_ONCE = 32 * WIDE
"""Slots whose series are integrated together: they stay in the nearest cache."""


class Full(NamedTuple):
    """Properties of dampers and arms beside :class:`Places` and :class:`Links`.

    ``damped`` is how many slots, from the first on, may have dampers. The rest is of p places, m bodies and n
    springs. ``spin_gain`` (m,) is the inverse inertia, 0 where no spring may turn a body; ``angle`` [rad] of
    m bodies and of more, so that they are a multiple of eight, ``facing`` the cosines and sines of as many
    and of p; ``spin`` (p,) [rad/s]. ``rate`` (p, 2) and ``spin_rate`` (p,) are the last derivatives of
    velocities that were taken, ``twist`` (p,) torques. ``damping`` (n,); ``along_x``, ``along_y`` (n,)
    directions, ``tension`` (n,) without dampers; ``opening`` (MOST_TERMS * n,) the derivatives of how fast
    springs lengthen; ``arm_a``, ``arm_b`` (2 n,) in the frames of bodies, x first, ``turned_a``, ``turned_b``
    in that of the world. What is behind ``damping`` is noted only of springs beside dampers, but for arms.
    """

    damped: int
    spin_gain: Numbers
    angle: Numbers
    facing: Vectors
    rate: Vectors
    spin: Numbers
    spin_rate: Numbers
    twist: Numbers
    damping: Numbers
    along_x: Numbers
    along_y: Numbers
    tension: Numbers
    opening: Numbers
    arm_a: Numbers
    arm_b: Numbers
    turned_a: Numbers
    turned_b: Numbers


@inlined_by_numba
def _full(numbers: Numbers, at: int, m: int, p: int, n: int, damped: int) -> Full:
    """Return the arrays that begin at a place of the numbers."""
    eights, facing = -(-m // WIDE) * WIDE, at + m + -(-m // WIDE) * WIDE
    rate = facing + 2 * (p + WIDE)
    spin, links = rate + 2 * p, rate + 5 * p
    arms = links + (4 + S.MOST_TERMS) * n
    return Full(
        damped,
        numbers[at : at + m],
        numbers[at + m : at + m + eights],
        numbers[facing:rate].reshape(p + WIDE, 2),
        numbers[rate:spin].reshape(p, 2),
        numbers[spin : spin + p],
        numbers[spin + p : spin + 2 * p],
        numbers[spin + 2 * p : links],
        numbers[links : links + n],
        numbers[links + n : links + 2 * n],
        numbers[links + 2 * n : links + 3 * n],
        numbers[links + 3 * n : links + 4 * n],
        numbers[links + 4 * n : arms],
        numbers[arms : arms + 2 * n],
        numbers[arms + 2 * n : arms + 4 * n],
        numbers[arms + 4 * n : arms + 6 * n],
        numbers[arms + 6 * n : arms + 8 * n],
    )


@always_inlined
def _turned(full: Full, rows: Rows, arm: Numbers, at: int) -> tuple[Wide, Wide]:
    """Return where eight ends are on turned bodies."""
    c, s = take_vectors(full.facing, rows, at)
    x, y = take(arm, at), take(arm, len(rows) + at)
    return c * x - s * y, s * x + c * y


@always_inlined
def _apart(places: Places, links: Links, full: Full, turns: bool, at: int) -> tuple[Wide, Wide, Arms]:
    """Return from where to where eight springs go, and where their ends are on turned bodies."""
    xa, ya = take_vectors(places.place, links.a, at)
    xb, yb = take_vectors(places.place, links.b, at)
    dx, dy = xb - xa, yb - ya
    ax = ay = bx = by = everywhere(0.0)
    if turns:
        ax, ay = _turned(full, links.a, full.arm_a, at)
        bx, by = _turned(full, links.b, full.arm_b, at)
        dx, dy = dx + (bx - ax), dy + (by - ay)
    return dx, dy, (ax, ay, bx, by)


@always_inlined
def _opening(
    linear: Vectors, angular: Numbers, links: Links, turns: bool, arms: Arms, at: int
) -> tuple[Wide, Wide]:
    """Return the velocities, or their derivatives, of the ends of eight springs at B against those at A."""
    uxa, uya = take_vectors(linear, links.a, at)
    uxb, uyb = take_vectors(linear, links.b, at)
    ux, uy = uxb - uxa, uyb - uya
    if turns:
        ax, ay, bx, by = arms
        wa, wb = take_numbers(angular, links.a, at), take_numbers(angular, links.b, at)
        ux, uy = ux + (wa * ay - wb * by), uy + (wb * bx - wa * ax)
    return ux, uy


@always_inlined
def _pull_ends(
    places: Places, links: Links, full: Full, turns: bool, arms: Arms, at: int, fx: Wide, fy: Wide
) -> None:
    """Add the pull of eight springs to both ends."""
    pull_x, pull_y = take_vectors(places.pull, links.a, at)
    put_vectors(places.pull, links.a, at, pull_x + fx, pull_y + fy)
    pull_x, pull_y = take_vectors(places.pull, links.b, at)
    put_vectors(places.pull, links.b, at, pull_x - fx, pull_y - fy)
    if turns:
        ax, ay, bx, by = arms
        put_numbers(full.twist, links.a, at, take_numbers(full.twist, links.a, at) + (ax * fy - ay * fx))
        put_numbers(full.twist, links.b, at, take_numbers(full.twist, links.b, at) - (bx * fy - by * fx))


@inlined
def _clear(places: Places, full: Full, turns: bool) -> None:
    S.clear_pull(places)
    if turns:
        for i in range(len(full.twist)):
            full.twist[i] = 0.0


@inlined
def _evaluate(places: Places, links: Links, full: Full, slowed: Slowed, turns: bool, followed: float) -> bool:
    """Compute the pull of springs, and if there are dampers of these and of drag.

    Returns whether each spring is long enough.
    """
    short, n = 0, len(links.a)
    _clear(places, full, turns)
    for at in range(0, n, WIDE):
        dx, dy, arms = _apart(places, links, full, turns, at)
        length = root(dx * dx + dy * dy)
        share = choose(length > 0.0, 1.0 / length, 0.0)
        nx, ny = dx * share, dy * share
        tension = take(links.stiffness, at) * (length - take(links.rest, at))
        pull = tension
        if full.damped > 0:
            put(full.along_x, at, nx)
            put(full.along_y, at, ny)
            put(full.tension, at, tension)
        if at < full.damped:
            if turns:
                put(full.turned_a, at, arms[0])
                put(full.turned_a, n + at, arms[1])
                put(full.turned_b, at, arms[2])
                put(full.turned_b, n + at, arms[3])
            ux, uy = _opening(places.speed, full.spin, links, turns, arms, at)
            opening = nx * ux + ny * uy
            put(full.opening, at, opening)
            pull = pull + take(full.damping, at) * opening
        _pull_ends(places, links, full, turns, arms, at, pull * nx, pull * ny)
        short |= mask_bits(length < followed * take(links.shortest, at))
    if full.damped > 0:
        slow(places, slowed, places.speed, 0)
    return short == 0


@inlined
def _resist(places: Places, links: Links, full: Full, slowed: Slowed, term: int, turns: bool) -> None:
    """Compute the pull of dampers and drag for ``full.rate``, the derivative of velocities of an order."""
    n = len(links.a)
    _clear(places, full, turns)
    for at in range(0, full.damped, WIDE):
        arms = (
            take(full.turned_a, at), take(full.turned_a, n + at), take(full.turned_b, at),
            take(full.turned_b, n + at),
        )  # fmt: skip
        ux, uy = _opening(full.rate, full.spin_rate, links, turns, arms, at)
        nx, ny = take(full.along_x, at), take(full.along_y, at)
        opening = nx * ux + ny * uy
        put(full.opening, term * n + at, opening)
        pull = take(full.damping, at) * opening
        _pull_ends(places, links, full, turns, arms, at, pull * nx, pull * ny)
    slow(places, slowed, full.rate, term)


@inlined
def _change(places: Places, full: Full, first: bool, share: float, turns: bool) -> None:
    """Change velocities by a derivative of them, which is computed from the pull.

    The first is of the velocities themselves, and gravity has part in it. ``share`` is that of the derivative
    in the change.
    """
    speed, rate = places.speed.reshape(places.speed.size), full.rate.reshape(full.rate.size)
    pull, gain, gravity = places.pull.reshape(places.pull.size), places.gain, places.gravity
    for i in range(len(gain)):
        rate[i] = pull[i] * gain[i] + gravity[i] if first else pull[i] * gain[i]
    for i in range(len(gain)):
        speed[i] += share * rate[i]
    if turns:
        for i in range(len(full.spin_gain)):
            full.spin_rate[i] = full.twist[i] * full.spin_gain[i]
            full.spin[i] += share * full.spin_rate[i]


@inlined
def _dissipated(resistance: Numbers, series: Numbers, number: int, span: float, terms: int) -> float:
    """Return the integral of c r^2 over a kick [J], summed over the first of n resistances c.

    r is the ``series`` (MOST_TERMS * n,) of how a damper opens, or of a coordinate of a velocity.
    """
    n, taken = len(resistance), everywhere(0.0)
    for begin in range(0, number, _AT_ONCE):
        first = 1.0  # span^j / j!
        for j in range(terms):
            second = first
            for k in range(j, terms):
                share = first * second * span / (j + k + 1) * (1.0 if j == k else 2.0)
                second *= span / (k + 1)
                for at in range(begin, min(begin + _AT_ONCE, number), WIDE):
                    product = take(series, j * n + at) * take(series, k * n + at)
                    taken = taken + share * take(resistance, at) * product
            first *= span / (j + 1)
    return sum_of(taken)


@inlined
def _book_held(places: Places, links: Links, full: Full, span: float, held: Rows, given: Numbers) -> None:
    """Book what springs beside dampers have given in a kick by ends that they do not move.

    ``held`` are the slots of dampers at these ends, twice the slot, and one more where B is the end: what is
    not of the spring is of the damper.
    """
    for k in range(len(held)):
        slot, at_b = held[k] // 2, held[k] % 2 == 1
        impulse = -span * full.tension[slot] if at_b else span * full.tension[slot]
        i = links.b[slot] if at_b else links.a[slot]
        x, y = impulse * full.along_x[slot], impulse * full.along_y[slot]
        turn = places.place[i, 0] * y - places.place[i, 1] * x
        for account, share in ((S.BY_SPRINGS, -1.0), (S.BY_DAMPERS, 1.0)):
            given[account] += share * x
            given[account + 1] += share * y
            given[account + 2] += share * turn


@inlined
def _book_ends(
    places: Places, full: Full, share: float, ends: Rows, to: int, turns: bool, given: Numbers
) -> None:
    """Book what a share of the pull gives by ends that nothing moves, and by bodies that nothing turns."""
    S.book_ends(places, ends, share, to, given)
    if turns:
        for i in range(len(full.spin_gain)):
            if full.spin_gain[i] == 0.0:
                given[S.BY_SPRINGS + 2] -= share * full.twist[i]
                given[S.BY_HAND] -= share * full.twist[i] * full.spin[i]


@inlined
def _kick(
    places: Places, links: Links, full: Full, slowed: Slowed, span: float, terms: int, turns: bool,
    ends: Rows, held: Rows, given: Numbers,
) -> None:  # fmt: skip
    """Change velocities by what acts for ``span`` seconds at these places, of which the pull is computed."""
    to, share = S.BY_DAMPERS if len(held) > 0 else S.BY_SPRINGS, span
    if full.damped == 0 and len(slowed.places) > 0:
        slow_alone(places, slowed, span, terms, given)
    _book_ends(places, full, share, ends, to, turns, given)
    _change(places, full, True, share, turns)
    if full.damped > 0:
        for term in range(1, terms):
            share *= span / (term + 1)
            _resist(places, links, full, slowed, term, turns)
            _book_ends(places, full, share, ends, to, turns, given)
            _change(places, full, False, share, turns)
        _book_held(places, links, full, span, held, given)
        given[S.DISSIPATED] += _dissipated(full.damping, full.opening, full.damped, span, terms)
        for rates in (slowed.rates_x, slowed.rates_y):
            given[S.DISSIPATED] += _dissipated(slowed.drag, rates, len(slowed.drag), span, terms)
        book_drag(places, slowed, span, terms, given)


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
        dx, dy, arms = _apart(places, links, full, turns, at)
        ux, uy = _opening(places.speed, full.spin, links, turns, arms, at)
        far = (ux * ux + uy * uy) * (h * h) > (dx * dx + dy * dy) * (S.MAX_TURN * S.MAX_TURN)
        fast |= mask_bits(far & (take(links.rest, at) > 0.0))
    return fast == 0


@inlined
def _terms(phase: float, series: float) -> int:
    """Return how many terms of its series a kick takes whose length times the fastest decay is ``phase``."""
    terms, rest = 1, 0.5 * phase * phase
    if phase > 0.0:  # with one, the work of dampers would be of the order of the step
        terms, rest = 2, rest * phase / 3.0
    while rest > series and terms < S.MOST_TERMS:
        terms += 1
        rest *= phase / (terms + 1)
    return terms


@inlined
def _advance(
    places: Places, links: Links, full: Full, slowed: Slowed, drifts: Numbers, kicks: Numbers, h: float,
    steps: int, followed: float, decay: float, series: float, turns: bool, ends: Rows, held: Rows,
    given: Numbers,
) -> int:  # fmt: skip
    """Advance what was gathered, as :func:`flow_forces` does: where steps meet, two kicks are one."""
    if not _follows(places, links, full, turns, h):
        return S.TURNS_FAST
    stages, evaluations = len(drifts), 0
    if places.known[0] == 0.0 or full.damped > 0:
        evaluations = 1
        if not _evaluate(places, links, full, slowed, turns, followed):
            return S.TURNS_FAST
    torque, rate = S.torque_of_gravity(places)
    for number in range(steps * stages + 1):
        stage, last = number % stages, number == steps * stages
        kick = kicks[stage] * h if number == 0 else kicks[stages] * h
        if number > 0 and not last:
            kick = kicks[stage] * h if stage > 0 else kick + kicks[0] * h
        if stage == 0 and number > 0 and not last:
            torque, rate = S.book_gravity(places, h, torque, rate, given)
        terms = _terms(abs(kick) * decay, series)
        _kick(places, links, full, slowed, kick, terms, turns, ends, held, given)
        if not last:
            _drift(places, full, drifts[stage] * h, turns)
            evaluations += 1
            if not _evaluate(places, links, full, slowed, turns, followed):
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
        full, slowed = _full(numbers, at, m, p, n, whole[9]), slowed_in(springs)
        dragged = last - alone - whole[8]
        held = whole[S.SIZES + m + 2 * n + whole[7] : dragged]
        steps, finer, made = S.steps_of(springs, span), 1, S.TURNS_FAST
        while made < 0 and finer <= S.FINEST:
            S.gather(places, motion)
            if turns:
                _take_spins(places, full, motion)
            for i in range(len(given)):
                given[i] = 0.0
            made = _advance(
                places, links, full, slowed, drifts, kicks, span / (finer * steps), finer * steps,
                S.still_followed(finer), numbers[S.DECAY], numbers[S.SERIES], turns, ends, held, given,
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
