"""Ends of eight springs at once, on bodies that turn too: where they are, how fast they part, their pull."""

from typing import NamedTuple

from physicslab.kernels import Numbers, Rows, Vectors, always_inlined, inlined_by_numba
from physicslab.kernels.float64x8 import Wide, everywhere, put_numbers, take, take_numbers, take_vectors
from physicslab.kernels.ode.spring_flow import Links, Places, between, pull_middles
from physicslab.kernels.wide_layout import WIDE

type Arms = tuple[Wide, Wide, Wide, Wide]


class Full(NamedTuple):
    """Properties of dampers and arms beside :class:`Places` and :class:`Links`.

    ``damped`` is how many slots, from the first on, may have dampers; ``reach`` (4 MOST_TERMS k,) tells, of
    each term of the series of k kicks, of how many slots, bodies, ends that springs do not move, and slowed
    places it is, from the first on.
    The rest is of p places, m bodies and n springs. ``spin_gain`` (m,) is the inverse inertia, 0 where no
    spring may turn a body; ``angle`` [rad] of m bodies and of more, so that they are a multiple of eight,
    ``facing`` the cosines and sines of as many and of p; ``spin`` (p,) [rad/s]. ``rate`` (p, 2) and
    ``spin_rate`` (p,) are the last derivatives of velocities that were taken, ``twist`` (p,) torques.
    ``damping`` (n,); ``along_x``, ``along_y`` (n,) directions, ``first`` and ``opening`` (n,) how fast
    springs lengthen, and its last derivative.
    ``arm_a``, ``arm_b`` (2 n,) are in the frames of bodies, x first, ``turned_a``, ``turned_b`` in that of
    the world. From ``along_x`` to ``opening`` nothing is noted but of dampers. ``sums`` (6,) are of the last
    derivative: its products with the first, with the one before and with itself times the resistance of
    dampers and drag, and the force [N] (x, y) and torque of drag by it.
    """

    damped: int
    reach: Rows
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
    first: Numbers
    opening: Numbers
    arm_a: Numbers
    arm_b: Numbers
    turned_a: Numbers
    turned_b: Numbers
    sums: Numbers


@inlined_by_numba
def full_in(numbers: Numbers, at: int, m: int, p: int, n: int, damped: int, reach: Rows) -> Full:
    """Return the arrays that begin at a place of the numbers."""
    eights, facing = -(-m // WIDE) * WIDE, at + m + -(-m // WIDE) * WIDE
    rate = facing + 2 * (p + WIDE)
    spin, links = rate + 2 * p, rate + 5 * p
    arms = links + 5 * n
    return Full(
        damped,
        reach,
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
        numbers[arms + 8 * n : arms + 8 * n + 6],
    )


@always_inlined
def _turned(full: Full, rows: Rows, arm: Numbers, at: int) -> tuple[Wide, Wide]:
    """Return where eight ends are on turned bodies."""
    c, s = take_vectors(full.facing, rows, at)
    x, y = take(arm, at), take(arm, len(rows) + at)
    return c * x - s * y, s * x + c * y


@always_inlined
def apart(places: Places, links: Links, full: Full, turns: bool, at: int) -> tuple[Wide, Wide, Arms]:
    """Return from where to where eight springs go, and where their ends are on turned bodies."""
    dx, dy = between(places.place, links, at)
    ax = ay = bx = by = everywhere(0.0)
    if turns:
        ax, ay = _turned(full, links.a, full.arm_a, at)
        bx, by = _turned(full, links.b, full.arm_b, at)
        dx, dy = dx + (bx - ax), dy + (by - ay)
    return dx, dy, (ax, ay, bx, by)


@always_inlined
def opening_of(
    linear: Vectors, angular: Numbers, links: Links, turns: bool, arms: Arms, at: int
) -> tuple[Wide, Wide]:
    """Return the velocities, or their derivatives, of the ends of eight springs at B against those at A."""
    ux, uy = between(linear, links, at)
    if turns:
        ax, ay, bx, by = arms
        wa, wb = take_numbers(angular, links.a, at), take_numbers(angular, links.b, at)
        ux, uy = ux + (wa * ay - wb * by), uy + (wb * bx - wa * ax)
    return ux, uy


@always_inlined
def pull_ends(
    places: Places, links: Links, full: Full, turns: bool, arms: Arms, at: int, fx: Wide, fy: Wide
) -> None:
    """Add the pull of eight springs to both ends."""
    pull_middles(places, links, at, fx, fy)
    if turns:
        ax, ay, bx, by = arms
        put_numbers(full.twist, links.a, at, take_numbers(full.twist, links.a, at) + (ax * fy - ay * fx))
        put_numbers(full.twist, links.b, at, take_numbers(full.twist, links.b, at) - (bx * fy - by * fx))
