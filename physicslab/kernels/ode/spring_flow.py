"""The flow of springs and uniform gravity beside contacts, eight springs at a time.

It follows bodies whose springs are attached to their middles and have no dampers. The springs are in blocks
of eight in which no two pull at one body that can be moved, and blocks are gone through in order: what acts
on a body is always added up in the same order.
"""

import math
from typing import NamedTuple

from physicslab.kernels import Numbers, Rows, Vectors, always_inlined, inlined, inlined_by_numba
from physicslab.kernels.accounts import ENERGY, GRAVITY, HAND, SPRINGS, book
from physicslab.kernels.arguments import Motion, Springs
from physicslab.kernels.float64x8 import Wide, choose, mask_bits, put_vectors, root, take, take_vectors
from physicslab.kernels.wide_layout import WIDE

TURNS_FAST = -1
"""Result where a spring is too short, or turns too far, for steps of this length."""
MAX_TURN = 0.25
"""Angle [rad] by which a spring with a rest length may turn, or share of its length by which it may change,
in a step of the method."""
_STEP_EXCESS = 1e-9
"""Share by which a step may be longer than the longest: half substeps are rounded."""
FINEST = 64
"""Largest factor by which steps are shortened where springs turn faster, or are short."""

BY_SPRINGS, BY_GRAVITY, BY_HAND, DISSIPATED, BY_DAMPERS, GIVEN = 0, 3, 4, 5, 6, 9
"""Where in what is given are the momentum (x, y) and the angular momentum that springs bring in [N s, N m s];
the angular momentum of gravity [N m s]; the work of ends that are driven [J]; what dampers take [J]; the
momenta that they bring in."""
MOST_TERMS = 10
"""Terms of the series of a kick for which there is room."""
SIZES = 10
"""The whole numbers begin with: how many bodies move on springs, how many places there are, slots for
springs, drifts of the method; whether there are dampers or arms, and so more numbers behind
(:mod:`physicslab.kernels.ode.damped_flow`); arms; how many bodies are in drag alone, made
a multiple of eight by the row of the world; how many ends springs do
not move; how many of the bodies on springs drag slows, made a multiple of eight; how many slots, from the
first on, may have dampers. Then :attr:`Places.moving`, the springs' ends at A and B, and the ``ends`` that
springs do not move; how far terms reach, and dampers at these ends; bodies on springs that drag slows; bodies
in drag alone."""
KNOWN, WEIGHT, _GIVEN, UNIFORM, LONGEST, SHORTEST, HEAD = 0, 1, 3, 12, 14, 15, 16
"""The numbers begin with: whether the pull is known (1,), the weight of all that moves on springs (2,) [N],
what is given (GIVEN,), gravity (2,) [m/s^2], the longest step of the method [s], the share of its rest length
below which the direction of a spring changes too fast for such a step. Then those of
:class:`Places` and of :class:`Links` in order, drifts and kicks, and what dampers and drag need."""


class Places(NamedTuple):
    """Bodies that move and ends that springs are attached to, one row each.

    The rows of the world that move (m,); ``place`` and ``speed`` (m + f + 1, 2) of these, of f fixed ends,
    and of one for slots without a spring; ``pull`` of the same shape, which is [0] the force of the springs
    at ``place`` where ``known`` (1,) is not 0. Of each coordinate of what moves: ``gain`` (2 m,), the inverse
    mass [1/kg], ``gravity`` (2 m,) [m/s^2] and ``weight`` (2 m,) [N].
    """

    moving: Rows
    place: Vectors
    speed: Vectors
    pull: Vectors
    known: Numbers
    gain: Numbers
    gravity: Numbers
    weight: Numbers


class Links(NamedTuple):
    """The springs in blocks of eight: rows of :class:`Places` at A and B, numbers of each."""

    a: Rows
    b: Rows
    rest: Numbers
    stiffness: Numbers


@inlined
def gather(places: Places, motion: Motion) -> None:
    """Take the state of what moves; the pull is known no more if anything is elsewhere."""
    same = places.known[0] != 0.0
    for i in range(len(places.moving)):
        row = places.moving[i]
        x, y = motion.position[row, 0], motion.position[row, 1]
        same = same and x == places.place[i, 0] and y == places.place[i, 1]
        places.place[i, 0], places.place[i, 1] = x, y
        places.speed[i, 0], places.speed[i, 1] = motion.linear[row, 0], motion.linear[row, 1]
    places.known[0] = 1.0 if same else 0.0


@inlined
def scatter(places: Places, motion: Motion, span: float) -> None:
    """Put the state back; what moves has turned steadily for ``span`` seconds."""
    for i in range(len(places.moving)):
        row = places.moving[i]
        motion.position[row, 0], motion.position[row, 1] = places.place[i, 0], places.place[i, 1]
        motion.linear[row, 0], motion.linear[row, 1] = places.speed[i, 0], places.speed[i, 1]
        motion.angle[row] += span * motion.angular[row]


@always_inlined
def between(vectors: Vectors, links: Links, at: int) -> tuple[Wide, Wide]:
    """Return the vectors (rows, 2) at B less those at A, of eight springs."""
    xa, ya = take_vectors(vectors, links.a, at)
    xb, yb = take_vectors(vectors, links.b, at)
    return xb - xa, yb - ya


@always_inlined
def _turn_fast(places: Places, links: Links, at: int, h: float) -> int:
    """Return which of eight springs turn too far, or change too much, in ``h`` seconds, as bits."""
    (dx, dy), (vx, vy) = between(places.place, links, at), between(places.speed, links, at)
    ux, uy = vx * h, vy * h
    far = ux * ux + uy * uy > (dx * dx + dy * dy) * (MAX_TURN * MAX_TURN)
    return mask_bits(far & (take(links.rest, at) > 0.0))


@always_inlined
def steps_of(springs: Springs, span: float) -> int:
    """Return how many steps of the method ``span`` seconds are, if no spring turns fast."""
    steps: int = max(1, math.ceil(span / springs.numbers[LONGEST] * (1.0 - _STEP_EXCESS)))
    return steps


@always_inlined
def still_followed(springs: Springs, finer: int) -> float:
    """Return down to which share of its rest length steps shortened by a factor follow a spring.

    Across a spring of the rest length L that is l long, the pull changes as one of (L / l - 1) times the
    stiffness does along it.
    """
    share: float = springs.numbers[SHORTEST] * 2.0 / (1.0 + finer * finer)
    return share


@always_inlined
def pull_middles(places: Places, links: Links, at: int, fx: Wide, fy: Wide) -> None:
    """Add the pull of eight springs [N] to both ends."""
    pull_x, pull_y = take_vectors(places.pull, links.a, at)
    put_vectors(places.pull, links.a, at, pull_x + fx, pull_y + fy)
    pull_x, pull_y = take_vectors(places.pull, links.b, at)
    put_vectors(places.pull, links.b, at, pull_x - fx, pull_y - fy)


@always_inlined
def _pull(places: Places, links: Links, at: int, followed: float) -> int:
    """Add the pull of eight springs to both ends; return which are too short, as bits."""
    dx, dy = between(places.place, links, at)
    length = root(dx * dx + dy * dy)
    share = take(links.stiffness, at) * (length - take(links.rest, at)) / length
    share = choose(length > 0.0, share, 0.0)
    pull_middles(places, links, at, share * dx, share * dy)
    return mask_bits(length < followed * take(links.rest, at))


@inlined
def _kick_and_drift(places: Places, kick: float, drift: float) -> None:
    """Change velocities by the pull for ``kick`` seconds, then places for ``drift``; forget the pull."""
    place, speed = places.place.reshape(places.place.size), places.speed.reshape(places.speed.size)
    pull, gain, gravity = places.pull.reshape(places.pull.size), places.gain, places.gravity
    n = len(gain)
    for i in range(n):
        v = speed[i] + kick * (pull[i] * gain[i] + gravity[i])
        speed[i] = v
        place[i] += drift * v
        pull[i] = 0.0
    for i in range(n, len(pull)):
        pull[i] = 0.0


@inlined
def clear_pull(places: Places) -> None:
    """Set the pull of all springs to zero."""
    pull = places.pull.reshape(places.pull.size)
    for i in range(len(pull)):
        pull[i] = 0.0


@inlined
def _evaluate(places: Places, links: Links, followed: float) -> bool:
    """Compute the pull of all springs; return whether each is long enough."""
    short = 0
    for at in range(0, len(links.a), WIDE):
        short |= _pull(places, links, at, followed)
    return short == 0


@inlined
def book_ends(places: Places, ends: Rows, number: int, kick: float, to: int, given: Numbers) -> None:
    """Book what springs give in a kick by the first ends that they do not move: what acts on these, reversed.

    ``to`` is where in what is given that belongs.
    """
    for k in range(number):
        i = ends[k]
        x, y = kick * places.pull[i, 0], kick * places.pull[i, 1]
        given[to] -= x
        given[to + 1] -= y
        given[to + 2] -= places.place[i, 0] * y - places.place[i, 1] * x
        given[BY_HAND] -= x * places.speed[i, 0] + y * places.speed[i, 1]


@inlined
def torque_of_gravity(places: Places) -> tuple[float, float]:
    """Return the torque of gravity about the origin [N m], and how fast it grows."""
    place, speed, weight, half = places.place, places.speed, places.weight, len(places.moving) // 2
    torque, rate, other_torque, other_rate = 0.0, 0.0, 0.0, 0.0  # two sums: each waits for itself alone
    for i in range(half):
        j = half + i
        wx, wy, other_wx, other_wy = weight[2 * i], weight[2 * i + 1], weight[2 * j], weight[2 * j + 1]
        torque += place[i, 0] * wy - place[i, 1] * wx
        rate += speed[i, 0] * wy - speed[i, 1] * wx
        other_torque += place[j, 0] * other_wy - place[j, 1] * other_wx
        other_rate += speed[j, 0] * other_wy - speed[j, 1] * other_wx
    for i in range(2 * half, len(places.moving)):
        torque += place[i, 0] * weight[2 * i + 1] - place[i, 1] * weight[2 * i]
        rate += speed[i, 0] * weight[2 * i + 1] - speed[i, 1] * weight[2 * i]
    return torque + other_torque, rate + other_rate


@inlined
def book_gravity(
    places: Places, h: float, before: float, rate_before: float, given: Numbers
) -> tuple[float, float]:
    """Book the angular momentum that gravity gave in a step, by the corrected trapezoidal rule."""
    torque, rate = torque_of_gravity(places)
    given[BY_GRAVITY] += 0.5 * h * (before + torque) + h * h / 12.0 * (rate_before - rate)
    return torque, rate


@inlined
def _advance(
    places: Places, links: Links, drifts: Numbers, kicks: Numbers, h: float, steps: int, followed: float,
    ends: Rows, given: Numbers,
) -> int:  # fmt: skip
    """Advance what was gathered, as :func:`flow_springs` does."""
    fast, evaluations = 0, 0
    for at in range(0, len(links.a), WIDE):
        fast |= _turn_fast(places, links, at, h)
    if fast != 0:
        return TURNS_FAST
    if places.known[0] == 0.0:
        clear_pull(places)
        evaluations = 1
        if not _evaluate(places, links, followed):
            return TURNS_FAST
    torque, rate = torque_of_gravity(places)
    for _ in range(steps):
        for stage in range(len(drifts)):
            book_ends(places, ends, len(ends), kicks[stage] * h, BY_SPRINGS, given)
            _kick_and_drift(places, kicks[stage] * h, drifts[stage] * h)
            evaluations += 1
            if not _evaluate(places, links, followed):
                return TURNS_FAST
        speed, pull = places.speed.reshape(places.speed.size), places.pull.reshape(places.pull.size)
        kick = kicks[len(drifts)] * h
        book_ends(places, ends, len(ends), kick, BY_SPRINGS, given)
        for i in range(len(places.gain)):
            speed[i] += kick * (pull[i] * places.gain[i] + places.gravity[i])
        torque, rate = book_gravity(places, h, torque, rate, given)
    return evaluations


@inlined_by_numba
def flow_at(springs: Springs, number: int) -> Springs:
    """Return the arrays of one of several flows; ``whole`` begins with where those of each begin and end."""
    numbers, whole = springs
    begin, low, end, high = 2 * number, 2 * number + 1, 2 * number + 2, 2 * number + 3
    return Springs(numbers[whole[begin] : whole[end]], whole[whole[low] : whole[high]])


@inlined_by_numba
def rows_in(flow: Springs) -> tuple[Rows, Rows]:
    """Return the rows of the world that a flow moves: those on springs, and those in drag alone."""
    whole = flow.whole
    return whole[SIZES : SIZES + whole[0]], whole[len(whole) - whole[6] :]


@inlined_by_numba
def named(springs: Springs) -> tuple[Places, Links, Rows, Numbers, Numbers, Numbers, int]:
    """Return places, links, ends, what is given, drifts, kicks, and where in the numbers there are others."""
    numbers, whole = springs
    m, p, n, s = whole[0], whole[1], whole[2], whole[3]
    at, links_at, shares_at = HEAD + 6 * p, HEAD + 6 * p + 6 * m, HEAD + 6 * p + 6 * m + 2 * n
    places = Places(
        whole[SIZES : SIZES + m],
        numbers[HEAD : HEAD + 2 * p].reshape(p, 2),
        numbers[HEAD + 2 * p : HEAD + 4 * p].reshape(p, 2),
        numbers[HEAD + 4 * p : at].reshape(p, 2),
        numbers[KNOWN : KNOWN + 1],
        numbers[at : at + 2 * m],
        numbers[at + 2 * m : at + 4 * m],
        numbers[at + 4 * m : links_at],
    )
    links = Links(
        whole[SIZES + m : SIZES + m + n],
        whole[SIZES + m + n : SIZES + m + 2 * n],
        numbers[links_at : links_at + n],
        numbers[links_at + n : shares_at],
    )
    ends = whole[SIZES + m + 2 * n : SIZES + m + 2 * n + whole[7]]
    given = numbers[_GIVEN : _GIVEN + GIVEN]
    kicks_at = shares_at + s
    last = kicks_at + s + 1
    return places, links, ends, given, numbers[shares_at:kicks_at], numbers[kicks_at:last], last


@inlined
def book_given(given: Numbers, numbers: Numbers, span: float, account: Vectors) -> None:
    """Book what springs and gravity have given in ``span`` seconds."""
    book(account[SPRINGS], 0, 0.0, given[BY_SPRINGS], given[BY_SPRINGS + 1], given[BY_SPRINGS + 2])
    account[HAND, ENERGY] += given[BY_HAND]
    fallen_x, fallen_y = numbers[WEIGHT] * span, numbers[WEIGHT + 1] * span
    book(account[GRAVITY], 0, 0.0, fallen_x, fallen_y, given[BY_GRAVITY])


@inlined
def flow_springs(motion: Motion, springs: Springs, span: float, account: Vectors) -> int:
    """Move bodies on springs for ``span`` seconds; return the number of force evaluations.

    A step is kick, drift, kick, ..., drift, kick, with the method's shares of it. Energy that comes
    in at ends that springs do not move, and by gravity, is booked: its torque as the corrected trapezoidal
    rule has it, which is of the order of the method.

    Where a spring becomes so short, or turns so fast, that these do not follow it, steps are halved; where
    those of a FINEST-th do not either, nothing is changed, and :data:`TURNS_FAST` returned.
    """
    numbers, _ = springs
    places, links, ends, given, drifts, kicks, _ = named(springs)
    steps, finer, made = steps_of(springs, span), 1, TURNS_FAST
    while made < 0 and finer <= FINEST:
        gather(places, motion)
        for i in range(GIVEN):
            given[i] = 0.0
        h, followed = span / (finer * steps), still_followed(springs, finer)
        made = _advance(places, links, drifts, kicks, h, finer * steps, followed, ends, given)
        finer *= 2
    places.known[0] = 1.0 if made >= 0 else 0.0
    if made >= 0:
        scatter(places, motion, span)
        book_given(given, numbers, span, account)
    return made
