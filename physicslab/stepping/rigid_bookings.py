"""Work of corrections of rigid contacts, by the change of the motion that they made."""

import numpy as np
from numpy.typing import NDArray

from physicslab.kernels.accounts import ANGULAR_MOMENTUM, ENERGY, OVERLAP, PX, PY
from physicslab.ode.system import OdeSystem
from physicslab.state.state import State

type Numbers = NDArray[np.float64]
"""An array of coordinates, of speeds, or of sums (n,)."""


def _momenta(ode: OdeSystem, q: Numbers, v: Numbers) -> Numbers:
    """Return momentum (x, y) and angular momentum about the origin of what forces move (3,)."""
    clock = ode.layout.clock
    free = ode.inverse_mass > 0.0
    p = np.where(free, v[:clock] / np.where(free, ode.inverse_mass, 1.0), 0.0)
    n = 2 * len(ode.layout.moving)
    x, y, px, py = q[:n:2], q[1:n:2], p[:n:2], p[1:n:2]
    return np.array((px.sum(), py.sum(), (x * py - y * px).sum() + p[n:].sum()))


def book_overlap(state: State, ode: OdeSystem, place: Numbers, speed: Numbers, energy: float) -> None:
    """Book that bodies were moved apart, from a place (n,) and a speed (n,), which changed the energy [J]."""
    row = state.account.sums[OVERLAP]
    row[ENERGY] += energy
    row[[PX, PY, ANGULAR_MOMENTUM]] += _momenta(ode, ode.q, ode.v) - _momenta(ode, place, speed)
