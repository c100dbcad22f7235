"""How many terms of the series of a kick springs have part in, by the rates of what is around them."""

import math

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Spring
from physicslab.kernels.ode.spring_flow import MOST_TERMS
from physicslab.kernels.wide_layout import WIDE
from physicslab.state.state import State
from physicslab.stepping.spring_groups import Net, drag_per_mass


def series_terms(
    state: State, springs: NDArray[np.int64], kicks: NDArray[np.float64], left_out: float
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return how many terms kicks have of springs (k, n), and of the drag of rows (k, rows); at least one.

    The ``kicks`` (k,) are in seconds, the ``springs`` (3, n) are rows of springs and of their ends.
    Derivatives of velocities are at most what dampers make of velocities of 1/2 if all of them act alike. In
    terms by which a spring changes the velocities of its ends, or drag that of a row, by less than the share
    ``left_out`` it takes no part: the farther a body is from fast ones, the fewer terms it has.
    """
    net, damping = Net.of(state, springs), state.table(Spring)["damping"][springs[0]]
    drag = drag_per_mass(state, np.arange(len(net.gain) // 2))
    slowed, speed = np.concatenate((drag, 0.0 * drag)), np.repeat((0.5, 0.0), len(drag))
    give = (net.arm**2 * net.gain[net.ends]).reshape(4, -1).max(axis=0)
    needed = np.ones((len(kicks), len(damping)), np.int64), np.ones((len(kicks), len(drag)), np.int64)
    for term in range(1, MOST_TERMS):
        speed = net.gain * net.pulled(damping * net.stretched(speed)) + slowed * speed
        share = np.abs(kicks[:, np.newaxis]) ** (term + 1) / math.factorial(term + 1)
        rates = give * damping * net.stretched(speed), drag * speed[: len(drag)]
        for found, rate in zip(needed, rates, strict=True):
            # with one term, the work of dampers would be of the order of the step
            found[share * rate > (left_out if term > 1 else 0.0)] = term + 1
    return needed


def reach_of_terms(
    springs: NDArray[np.int64], slots: NDArray[np.int64], slowed: NDArray[np.int64],
    places: NDArray[np.int64], bodies: int, first_of_ends: NDArray[np.int64],
) -> NDArray[np.int64]:  # fmt: skip
    """Return of how many slots, bodies, held ends and slowed places each term is (k, 4, MOST_TERMS).

    Parameters
    ----------
    springs : int array (k, n)
        How many terms k kicks have of each slot.
    slots : int array (2, n)
        The places of its ends: those of bodies come first.
    slowed : int array (k, d)
        How many terms they have of what drag slows; all of it takes part in as many.
    places : int array (d,)
        Where it is.
    bodies : int
        How many bodies there are.
    first_of_ends : int array (e,)
        The first slot of each end that springs do not move, in order.
    """
    reach = np.zeros((len(springs), 4, MOST_TERMS), np.int64)
    ends = np.where(slots < bodies, slots + 1, 0).max(axis=0)
    by_slot = np.maximum.accumulate(np.append(0, ends))
    for kick, (of_slots, of_drag) in enumerate(zip(springs, slowed, strict=True)):
        for term in range(MOST_TERMS):
            last = len(np.trim_zeros(of_slots > term, "b"))
            dragged = places if (of_drag > term).any() else places[:0]
            slot = -(-last // WIDE) * WIDE
            first = np.where(dragged < bodies, dragged + 1, by_slot[slot]).max(initial=by_slot[slot])
            held = np.searchsorted(first_of_ends, slot)
            reach[kick, :, term] = slot, first, held, len(dragged)
    return reach
