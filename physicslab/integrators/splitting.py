"""Splitting methods: drifts and kicks in turn."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from physicslab.kernels.ode.splitting import split
from physicslab.ode.system import OdeSystem
from physicslab.state.state import State


@dataclass(frozen=True)
class Splitting:
    """The flow of the method kick, drift, kick, ..., drift, kick.

    Bodies stay where they are during a kick, so the work of a force in it is the impulse times the mean
    velocity: an integrator whose flow is of this type has its forces that store nothing kept for that.

    Attributes
    ----------
    drifts, kicks : tuple of float
        Shares of the step, n and n + 1.
    """

    drifts: tuple[float, ...]
    kicks: tuple[float, ...]

    @cached_property
    def shares(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Drifts (n,) and kicks (n + 1,), as kernels take them."""
        return np.array(self.drifts), np.array(self.kicks)

    def __call__(self, state: State, ode: OdeSystem, h: float, steps: int) -> int:
        """Advance by so many steps of so many seconds; return the force evaluations."""
        q_low, v_low = ode.remainders(state)
        return split(
            ode.q, ode.v, q_low, v_low, ode.inverse_mass, ode.damping, ode.calls, *self.shares, ode.places,
            h, steps,
        )  # fmt: skip


def splitting(*, drifts: tuple[float, ...], kicks: tuple[float, ...]) -> Splitting:
    """Return the flow of the method kick, drift, kick, ..., drift, kick with these shares of the step."""
    return Splitting(drifts, kicks)
