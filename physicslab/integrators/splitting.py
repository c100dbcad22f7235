"""Splitting methods: drifts and kicks in turn."""

from __future__ import annotations

import numpy as np

from physicslab.integrators.integrator import Flow
from physicslab.kernels.ode.splitting import split
from physicslab.ode.system import OdeSystem
from physicslab.state.state import State

__all__ = ["splitting"]


def splitting(*, drifts: tuple[float, ...], kicks: tuple[float, ...]) -> Flow:
    """Return the flow of the method kick, drift, kick, ..., drift, kick with these shares of the step."""
    drift_shares, kick_shares = np.array(drifts), np.array(kicks)

    def flow(state: State, ode: OdeSystem, h: float, steps: int) -> int:
        eq = ode
        q_low, v_low = eq.remainders(state)
        return split(
            eq.q,
            eq.v,
            q_low,
            v_low,
            eq.inverse_mass,
            eq.damping,
            eq.calls,
            drift_shares,
            kick_shares,
            eq.places,
            h,
            steps,
        )

    return flow
