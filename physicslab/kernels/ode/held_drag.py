"""Drag by the speed of what springs hold: part of the kicks of :mod:`physicslab.kernels.ode.damped_flow`."""

from typing import NamedTuple

from physicslab.kernels import Numbers, Rows, Vectors, inlined, inlined_by_numba
from physicslab.kernels.arguments import Springs
from physicslab.kernels.ode.spring_flow import BY_DAMPERS, MOST_TERMS, Places


class Slowed(NamedTuple):
    """Which places of :class:`Places` drag slows (d,), and by how much [kg/s].

    Then the velocities at the start of a kick and their derivatives of each order (MOST_TERMS * d, 2).
    """

    places: Rows
    drag: Numbers
    rates: Vectors


@inlined_by_numba
def slowed_in(springs: Springs) -> Slowed:
    """Return the arrays of what springs hold and drag slows, which stand before those of drag alone."""
    numbers, whole = springs
    d, alone = whole[8], whole[6]
    last = len(numbers) - 3 * alone
    rates = last - 2 * MOST_TERMS * d
    return Slowed(
        whole[len(whole) - alone - d : len(whole) - alone],
        numbers[rates - d : rates],
        numbers[rates:last].reshape(MOST_TERMS * d, 2),
    )


@inlined
def slow(places: Places, slowed: Slowed, velocity: Vectors, term: int) -> None:
    """Add drag by velocities, or by their derivative of an order, and note these."""
    d = len(slowed.places)
    for k in range(d):
        i = slowed.places[k]
        x, y = velocity[i, 0], velocity[i, 1]
        slowed.rates[term * d + k, 0], slowed.rates[term * d + k, 1] = x, y
        places.pull[i, 0] -= slowed.drag[k] * x
        places.pull[i, 1] -= slowed.drag[k] * y


@inlined
def book_drag(places: Places, slowed: Slowed, span: float, terms: int, given: Numbers) -> None:
    """Book the impulses of drag in a kick: of each place the integral of its velocity, by the series."""
    d = len(slowed.places)
    for k in range(d):
        i, x, y, share = slowed.places[k], 0.0, 0.0, span
        for term in range(terms):
            x += share * slowed.rates[term * d + k, 0]
            y += share * slowed.rates[term * d + k, 1]
            share *= span / (term + 2)
        x, y = -slowed.drag[k] * x, -slowed.drag[k] * y
        given[BY_DAMPERS] += x
        given[BY_DAMPERS + 1] += y
        given[BY_DAMPERS + 2] += places.place[i, 0] * y - places.place[i, 1] * x
