"""Drag by the speed of what springs hold: part of the kicks of :mod:`physicslab.kernels.ode.damped_flow`."""

from typing import NamedTuple

from physicslab.kernels import Numbers, Rows, Vectors, inlined, inlined_by_numba
from physicslab.kernels.arguments import Springs
from physicslab.kernels.float64x8 import everywhere, put, put_vectors, sum_of, take, take_vectors
from physicslab.kernels.ode.spring_flow import BY_DAMPERS, DISSIPATED, MOST_TERMS, UNIFORM, Places
from physicslab.kernels.wide_layout import WIDE


class Slowed(NamedTuple):
    """Which places of :class:`Places` drag slows (d,), by how much [kg/s], and their inverse masses [1/kg].

    They are a multiple of eight: no drag acts on the last, at the place of no spring. Then the velocities at
    the start of a kick and their derivatives of each order, x and y (MOST_TERMS * d,), which only dampers
    need, and the acceleration of gravity (2,) [m/s^2].
    """

    places: Rows
    drag: Numbers
    gain: Numbers
    rates_x: Numbers
    rates_y: Numbers
    gravity: Numbers


@inlined_by_numba
def slowed_in(springs: Springs) -> Slowed:
    """Return the arrays of what springs hold and drag slows, which stand before those of drag alone."""
    numbers, whole = springs
    d, alone = whole[8], whole[6]
    last = len(numbers) - 3 * alone
    rates = last - 2 * MOST_TERMS * d
    return Slowed(
        whole[len(whole) - alone - d : len(whole) - alone],
        numbers[rates - 2 * d : rates - d],
        numbers[rates - d : rates],
        numbers[rates : rates + MOST_TERMS * d],
        numbers[rates + MOST_TERMS * d : last],
        numbers[UNIFORM : UNIFORM + 2],
    )


@inlined
def slow(places: Places, slowed: Slowed, velocity: Vectors, term: int) -> None:
    """Add drag by velocities, or by their derivative of an order, and note these."""
    d = len(slowed.places)
    for at in range(0, d, WIDE):
        x, y = take_vectors(velocity, slowed.places, at)
        put(slowed.rates_x, term * d + at, x)
        put(slowed.rates_y, term * d + at, y)
        pull_x, pull_y = take_vectors(places.pull, slowed.places, at)
        drag = take(slowed.drag, at)
        put_vectors(places.pull, slowed.places, at, pull_x - drag * x, pull_y - drag * y)


@inlined
def slow_alone(places: Places, slowed: Slowed, span: float, terms: int, given: Numbers) -> None:
    """Take from velocities what drag takes in a kick where no damper acts, and book it.

    Velocities go by v + a p, p = (1 - e^(-rate t)) / rate, of which the integrals of p and of its square are
    needed, as series.
    """
    taken, px, py, turned = everywhere(0.0), everywhere(0.0), everywhere(0.0), everywhere(0.0)
    for at in range(0, len(slowed.places), WIDE):
        vx, vy = take_vectors(places.speed, slowed.places, at)
        ax, ay = take_vectors(places.pull, slowed.places, at)
        drag, gain = take(slowed.drag, at), take(slowed.gain, at)
        rate = drag * gain
        ax, ay = ax * gain + slowed.gravity[0] - rate * vx, ay * gain + slowed.gravity[1] - rate * vy
        share, power = everywhere(0.5 * span * span), 4.0  # (-rate)^(n - 2) span^n / n!, and 2^n
        once, twice = everywhere(0.0), everywhere(0.0)
        for n in range(2, terms + 2):
            once, twice = once + share, twice + share * ((power - 2.0) * span / (n + 1))
            share, power = share * rate * (-span / (n + 1)), 2.0 * power
        to_x, to_y = span * vx + ax * once, span * vy + ay * once
        put_vectors(places.speed, slowed.places, at, vx - rate * to_x, vy - rate * to_y)
        squares = span * (vx * vx + vy * vy) + 2.0 * once * (vx * ax + vy * ay)
        taken = taken + drag * (squares + twice * (ax * ax + ay * ay))
        x, y = take_vectors(places.place, slowed.places, at)
        to_x, to_y = drag * to_x, drag * to_y
        px, py, turned = px + to_x, py + to_y, turned + (x * to_y - y * to_x)
    given[DISSIPATED] += sum_of(taken)
    given[BY_DAMPERS] -= sum_of(px)
    given[BY_DAMPERS + 1] -= sum_of(py)
    given[BY_DAMPERS + 2] -= sum_of(turned)


@inlined
def book_drag(places: Places, slowed: Slowed, span: float, terms: int, given: Numbers) -> None:
    """Book the impulses of drag in a kick: of each place the integral of its velocity, by the series."""
    d = len(slowed.places)
    px, py, turned = everywhere(0.0), everywhere(0.0), everywhere(0.0)
    for at in range(0, d, WIDE):
        x, y, share = everywhere(0.0), everywhere(0.0), span
        for term in range(terms):
            x = x + share * take(slowed.rates_x, term * d + at)
            y = y + share * take(slowed.rates_y, term * d + at)
            share *= span / (term + 2)
        drag = take(slowed.drag, at)
        x, y = -(drag * x), -(drag * y)
        place_x, place_y = take_vectors(places.place, slowed.places, at)
        px, py, turned = px + x, py + y, turned + (place_x * y - place_y * x)
    given[BY_DAMPERS] += sum_of(px)
    given[BY_DAMPERS + 1] += sum_of(py)
    given[BY_DAMPERS + 2] += sum_of(turned)
