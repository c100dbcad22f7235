"""Splitting methods where joints hold bodies: kicks along what joints allow, drifts along their curves.

The Hamiltonian is split as without joints. In a kick bodies stay where they are, and their velocities change
by the forces less what joints take of these. In a drift they move freely on what joints allow: that is
followed by dop853 to rounding, as an arc in a magnetic field is. Both are exact flows of mechanical systems,
the kinetic energy is quadratic in the momenta as ever, and so a method keeps its order, that of Blanes and
Moan too, and stays symplectic (Hairer, Lubich & Wanner, Geometric Numerical Integration, 2006, VII.1.4).
"""

from collections.abc import Sequence

import numpy as np

from physicslab.kernels.forces.budget import END, KEPT
from physicslab.kernels.forces.force_calls import add_forces
from physicslab.kernels.joints import layout
from physicslab.kernels.joints.terms import HOLD
from physicslab.kernels.ode.dop853 import dop853
from physicslab.ode.system import NOTHING_WANTED, OdeSystem

_TOLERANCE, _MOST = 1e-15, 100_000
"""Error of a drift, and its largest number of evaluations."""


def follows_joints(ode: OdeSystem) -> bool:
    """Whether joints hold what moves, and all other forces depend on places and the time alone."""
    if not ode.joined or len(ode.damping) or len(ode.gyration) or len(ode.places) > KEPT:
        return False
    whole = ode.joints[1]
    rows = whole[layout.FIRST :][: layout.PLACES * int(whole[layout.ROWS])].reshape(-1, layout.PLACES)
    return bool((rows[:, layout.ROLE] == HOLD).all()) and not ode.interpreted


def split_along_joints(
    ode: OdeSystem, drifts: Sequence[float], kicks: Sequence[float], h: float, steps: int
) -> int:
    """Advance by ``steps`` steps of ``h`` seconds, kick, drift, ..., kick; return the force evaluations.

    The number is negative where a drift could not be made.
    """
    n, clock, evaluations = ode.layout.moving_count, ode.layout.clock, 0
    behind, joint = slice(clock + 1, int(ode.places[END])), ode.calls[-1:]
    kick, known, start = np.zeros(len(ode.q)), False, ode.q[clock]
    low = np.zeros(n), np.zeros(n)
    for step in range(steps):
        for stage, share in enumerate(kicks):
            if share != 0.0:
                if not known:
                    kick, bend = np.zeros((2, len(ode.q)))
                    add_forces(ode.q, ode.v, kick, ode.calls)
                    add_forces(ode.q, ode.v, bend, joint)  # what bends their way is of the drift
                    kick -= bend
                    known, evaluations = True, evaluations + 1
                ode.v[:n] += share * h * ode.inverse_mass * kick[:n]
                ode.v[behind] += share * h * kick[behind]
            if stage == len(drifts) or drifts[stage] == 0.0:
                continue
            span, booked, known = drifts[stage] * h, ode.v[behind].copy(), False
            sign = 1.0 if span > 0.0 else -1.0
            ode.v[:n] *= sign
            made = dop853(
                ode.q, ode.v, *low, ode.inverse_mass, ode.damping, joint, ode.places, abs(span), _TOLERANCE,
                abs(span), _MOST, 0, np.zeros(1), 0.0, *NOTHING_WANTED,
            )  # fmt: skip
            if made < 0:
                return made
            ode.v[:n] *= sign
            ode.v[behind] = booked + sign * (ode.v[behind] - booked)
            ode.q[clock] = start + (step + sum(drifts[: stage + 1])) * h
            evaluations += made
    ode.q[clock] = start + steps * h
    return evaluations
