"""Drag: resistance that grows with speed or with its square."""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Drag, Mass, Velocity
from physicslab.kernels.accounts import DAMPING
from physicslab.kernels.forces import packed_forces
from physicslab.kernels.forces.resistance import drag_resistance
from physicslab.state.packed import PackedForce, StateLayout
from physicslab.state.state import State
from physicslab.systems.system import ForceSystem

AT_REST = 1e-9
"""Speed [m/s] by which the rate of a body at rest is told: it is slowed as soon as it moves."""


class DragSystem(ForceSystem):
    """Slows every body that has Drag. It dissipates energy and stores none."""

    needs = (Drag, Velocity, Mass)
    columns = ((Drag, "linear"), (Drag, "quadratic"))
    account = DAMPING
    kernels = (packed_forces.drag,)
    couples_nothing = is_everywhere = True

    def packed(self, state: State, layout: StateLayout) -> PackedForce:
        """Return the drag for compiled integrators."""
        table, rows = state.table(Drag), state.batch(*self.needs).rows
        rows = rows[layout.place[rows] >= 0]  # rows that take no part have no coordinates
        moved = state.bodies.inverse_mass[rows] > 0.0
        rows = np.concatenate((rows[moved], rows[~moved]))
        parameters = np.stack((table["linear"][rows], table["quadratic"][rows]), axis=1).ravel()
        indices: NDArray[np.int64] = np.concatenate(
            ([len(rows)], layout.place[rows], (-1, int(np.count_nonzero(moved)), -1))
        )
        books = ((DAMPING, len(rows) + 1),) if moved.any() else ()
        keeps = len(rows) + 3
        return PackedForce(
            packed_forces.drag, parameters, indices, drag_resistance, work_slots=books, dissipation_slot=keeps
        )

    def rates(self, state: State) -> NDArray[np.float64]:
        """Return for each row the rate at which it slows down at its present speed [1/s]."""
        table, rows = state.table(Drag), state.batch(*self.needs).rows
        speed = np.maximum(np.hypot(*state.table(Velocity)["linear"][rows].T), AT_REST)
        rates, inverse = np.zeros(len(state.entity_index)), state.bodies.inverse_mass[rows]
        with np.errstate(over="ignore"):  # that is an unlimited rate
            slowed = (table["linear"][rows] + 2.0 * table["quadratic"][rows] * speed) * inverse
        rates[rows] = np.where(inverse > 0.0, slowed, 0.0)
        return rates

    def depends_on_velocity(self, state: State) -> bool:
        """Whether any drag is more than zero: it is nothing else."""
        table, rows = state.table(Drag), state.batch(*self.needs).rows
        return bool((table["linear"][rows] > 0.0).any() or (table["quadratic"][rows] > 0.0).any())
