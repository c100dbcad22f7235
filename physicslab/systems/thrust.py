"""Thrust: what pushes and turns bodies from within, steadily or swinging in time."""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass, Thrust, Transform, Velocity
from physicslab.components.thrust import FRAMES
from physicslab.ecs.sentences import sentence
from physicslab.kernels.accounts import THRUST
from physicslab.kernels.forces.thrust import thrust
from physicslab.state.packed import PackedForce, StateLayout
from physicslab.state.state import State
from physicslab.systems.drag import AT_REST
from physicslab.systems.system import ForceSystem

_WITH_BODY = FRAMES.index("body") + 1


class ThrustSystem(ForceSystem):
    """Pushes and turns every body that has Thrust. It stores no energy: its work is in the account thrust."""

    needs = (Thrust, Transform, Velocity, Mass)
    columns = tuple((Thrust, spec.name) for spec in Thrust.FIELDS)
    account = THRUST
    kernels = (thrust,)
    turns = couples_nothing = is_everywhere = True

    def turned(self, state: State) -> NDArray[np.int64]:
        """Return the rows whose angle a thrust changes, or goes by."""
        table, rows = state.table(Thrust), state.batch(*self.needs).rows
        off = table["at"][rows].any(axis=1) & table["force"][rows].any(axis=1)
        turned: NDArray[np.int64] = rows[off | (table["torque"][rows] != 0.0) | self._follows(state)]
        return turned

    def _follows(self, state: State) -> NDArray[np.bool_]:
        """Return for each body whether its force turns with it."""
        follows: NDArray[np.bool_] = state.table(Thrust)["frame"][state.batch(*self.needs).rows] == _WITH_BODY
        return follows

    def packed(self, state: State, layout: StateLayout) -> PackedForce:
        """Return the thrust for compiled integrators."""
        table, rows, follows = state.table(Thrust), state.batch(*self.needs).rows, self._follows(state)
        part = layout.place[rows] >= 0
        rows, follows = rows[part], follows[part]
        numbers = (
            table["force"][rows], table["torque"][rows], table["at"][rows],
            2.0 * np.pi * table["frequency"][rows], table["phase"][rows],
        )  # fmt: skip
        where = np.stack((layout.place[rows], layout.turn[rows], follows), axis=1)
        indices = np.concatenate(((len(rows), layout.clock), where.ravel()))
        return PackedForce(thrust, np.column_stack(numbers).ravel(), indices)

    def rates(self, state: State) -> NDArray[np.float64]:
        """Return for each row how fast the force swings, and turns at its present spin [rad/s]."""
        table, rows = state.table(Thrust), state.batch(*self.needs).rows
        rates = np.zeros(len(state.entity_index))
        turns = self._follows(state) & (state.bodies.inverse_inertia[rows] > 0.0)
        # That of a body that does not turn yet is told as well: no choice may go by when it was made.
        spin = np.maximum(np.abs(state.table(Velocity)["angular"][rows]), AT_REST) * turns
        swings = np.where(table["force"][rows].any(axis=1) | (table["torque"][rows] != 0.0), 1.0, 0.0)
        rates[rows] = swings * (2.0 * np.pi * table["frequency"][rows] + spin)
        return rates * (state.bodies.inverse_mass > 0.0)

    def depends_on_time(self, state: State) -> bool:
        """Whether any swings."""
        return bool((state.table(Thrust)["frequency"][state.batch(*self.needs).rows] > 0.0).any())

    def why_singular(self, state: State) -> str | None:
        """Return that a body may turn fast, where its force turns with it."""
        return sentence("thrust_turns") if self._follows(state).any() else None
