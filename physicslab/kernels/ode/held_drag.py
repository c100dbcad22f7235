"""Drag by the speed of what springs hold: part of the kicks of :mod:`physicslab.kernels.ode.damped_flow`."""

from typing import NamedTuple

from physicslab.kernels import Numbers, Rows, Vectors, inlined, inlined_by_numba
from physicslab.kernels.arguments import Springs
from physicslab.kernels.float64x8 import everywhere, put, put_vectors, sum_of, take, take_vectors
from physicslab.kernels.ode.spring_flow import BY_DAMPERS, DISSIPATED, UNIFORM, Places
from physicslab.kernels.wide_layout import WIDE


class Slowed(NamedTuple):
    """Which places of :class:`Places` drag slows (d,), by how much [kg/s], and their inverse masses [1/kg].

    They are a multiple of eight: no drag acts on the last, at the place of no spring. Then the velocities at
    the start of a kick and their last derivatives, x and y (2 d,), which only dampers need, and the
    acceleration of gravity (2,) [m/s^2].
    """

    places: Rows
    drag: Numbers
    gain: Numbers
    first: Numbers
    rates: Numbers
    gravity: Numbers


@inlined_by_numba
def slowed_in(springs: Springs) -> Slowed:
    """Return the arrays of what springs hold and drag slows, which stand before those of drag alone."""
    numbers, whole = springs
    d, alone = whole[8], whole[6]
    last = len(numbers) - 3 * alone
    rates = last - 4 * d
    return Slowed(
        whole[len(whole) - alone - d : len(whole) - alone],
        numbers[rates - 2 * d : rates - d],
        numbers[rates - d : rates],
        numbers[rates : rates + 2 * d],
        numbers[rates + 2 * d : last],
        numbers[UNIFORM : UNIFORM + 2],
    )


@inlined
def slow(places: Places, slowed: Slowed, velocity: Vectors, sums: Numbers, first: bool, number: int) -> None:
    """Add drag at the first of places by velocities, or by a derivative of them, to the pull and to ``sums``.

    The first of these are products of derivatives, as dampers have them
    (:mod:`physicslab.kernels.ode.damped_flow`); then the force of drag and its torque about the origin.
    """
    d, by_first, by_last, by_itself = len(slowed.places), everywhere(0.0), everywhere(0.0), everywhere(0.0)
    fx, fy, turned = everywhere(0.0), everywhere(0.0), everywhere(0.0)
    for at in range(0, number, WIDE):
        x, y = take_vectors(velocity, slowed.places, at)
        drag = take(slowed.drag, at)
        drag_x, drag_y = drag * x, drag * y
        by_itself = by_itself + (drag_x * x + drag_y * y)
        if first:
            put(slowed.first, at, x)
            put(slowed.first, d + at, y)
        else:
            by_first = by_first + (drag_x * take(slowed.first, at) + drag_y * take(slowed.first, d + at))
            by_last = by_last + (drag_x * take(slowed.rates, at) + drag_y * take(slowed.rates, d + at))
        put(slowed.rates, at, x)
        put(slowed.rates, d + at, y)
        pull_x, pull_y = take_vectors(places.pull, slowed.places, at)
        put_vectors(places.pull, slowed.places, at, pull_x - drag_x, pull_y - drag_y)
        place_x, place_y = take_vectors(places.place, slowed.places, at)
        fx, fy, turned = fx + drag_x, fy + drag_y, turned + (place_x * drag_y - place_y * drag_x)
    sums[0] += sum_of(by_itself) if first else sum_of(by_first)
    sums[1] += sum_of(by_last)
    sums[2] += sum_of(by_itself)
    sums[3], sums[4], sums[5] = sum_of(fx), sum_of(fy), sum_of(turned)


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
