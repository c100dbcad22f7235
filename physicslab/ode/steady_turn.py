"""Bodies that no force turns: their angles go on by themselves, beside the coordinates of a flow."""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform, Velocity
from physicslab.kernels.accounts import ANGULAR_MOMENTUM, DAMPING, ENERGY
from physicslab.state.state import State


def steady_turn(
    state: State, rows: NDArray[np.int64], after: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return angles [rad] and rates [rad/s] (n, rows) of what no force turns, after times [s] (n,)."""
    spin, angle = state.table(Velocity)["angular"][rows], state.table(Transform)["angle"][rows]
    c, time = state.physics.angular_damping, after[:, None]
    if not c:
        return angle + spin * time, np.repeat(spin[None], len(after), axis=0)
    free = state.bodies.inverse_mass[rows] > 0.0
    turned = spin * np.where(free, -np.expm1(-c * time) / c, time)
    return angle + turned, np.where(free, spin * np.exp(-c * time), spin)


def turn_steadily(state: State, rows: NDArray[np.int64], span: float) -> None:
    """Turn bodies (rows,) through ``span`` seconds; what damping takes of that is booked."""
    transform, velocity, c = state.table(Transform), state.table(Velocity), state.physics.angular_damping
    spin = velocity["angular"][rows]
    if not c:
        transform["angle"][rows] += spin * span
        return
    (transform["angle"][rows],), (velocity["angular"][rows],) = steady_turn(state, rows, np.array([span]))
    inverse = state.bodies.inverse_inertia[rows]
    turns = inverse > 0.0
    momentum = spin[turns] / inverse[turns]
    given = state.account.sums[DAMPING]
    given[ENERGY] += 0.5 * float(momentum @ spin[turns]) * np.expm1(-2.0 * c * span)
    given[ANGULAR_MOMENTUM] += float(momentum.sum()) * np.expm1(-c * span)
