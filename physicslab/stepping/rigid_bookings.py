"""What impulses and corrections of rigid contacts have given, by the change of the motion that they made."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physicslab.kernels.accounts import CONTACT, ENERGY, IMPACTS, OVERLAP, PX, PY, SPIN
from physicslab.ode.system import OdeSystem
from physicslab.state.state import State

__all__ = ["ImpulseBook", "book_overlap"]

type Numbers = NDArray[np.float64]


def _momenta(ode: OdeSystem, q: Numbers, v: Numbers) -> Numbers:
    """Return momentum (x, y) and angular momentum about the origin of what forces move (3,)."""
    clock = ode.layout.clock
    free = ode.inverse_mass > 0.0
    p = np.where(free, v[:clock] / np.where(free, ode.inverse_mass, 1.0), 0.0)
    n = 2 * len(ode.layout.moving)
    x, y, px, py = q[:n:2], q[1:n:2], p[:n:2], p[1:n:2]
    return np.array((px.sum(), py.sum(), (x * py - y * px).sum() + p[n:].sum()))


class ImpulseBook:
    """Books the impulses of a short step, from its beginning.

    They act half-way through the forces of the step (Moreau's midpoint rule): with the mean of the velocities
    at its beginning and at its end. So a body at rest is given no work, though its velocity comes and goes.

    Parameters
    ----------
    state : State
        Whose account.
    ode : OdeSystem
        The motion, as it is at the beginning.
    impacts : int
        How many impacts there were before.
    """

    def __init__(self, state: State, ode: OdeSystem, impacts: int) -> None:
        self._sums, self._ode, self._impacts = state.account.sums, ode, impacts
        self._start, self._booked = ode.v.copy(), self._sums.copy()

    def kicked(self) -> None:
        """Note the velocities that the forces have made."""
        self._kicked = self._ode.v.copy()

    def close(self, impacts: int) -> None:
        """Book what impulses have done since, but for what they have booked themselves.

        Where nothing bounced, what was taken for impacts is that of contacts.
        """
        ode, v, sums = self._ode, self._ode.v, self._sums
        booked = sums - self._booked
        if impacts == self._impacts:
            sums[CONTACT] += booked[IMPACTS]
            sums[IMPACTS] -= booked[IMPACTS]
        clock, slot = ode.layout.clock, ode.slots[CONTACT]
        free = ode.inverse_mass > 0.0
        change, mean = (v - self._kicked)[:clock][free], 0.5 * (v + self._start)[:clock][free]
        rest = -booked.sum(axis=0)
        rest[ENERGY] += float((change * mean) @ (1.0 / ode.inverse_mass[free]))
        rest[[PX, PY, SPIN]] += _momenta(ode, ode.q, v) - _momenta(ode, ode.q, self._kicked)
        v[slot : slot + len(rest)] += rest


def book_overlap(state: State, ode: OdeSystem, place: Numbers, speed: Numbers, energy: float) -> None:
    """Book that bodies were moved apart, from a place and a speed, which changed the energy [J]."""
    row = state.account.sums[OVERLAP]
    row[ENERGY] += energy
    row[[PX, PY, SPIN]] += _momenta(ode, ode.q, ode.v) - _momenta(ode, place, speed)
