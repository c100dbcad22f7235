"""Pull: the force of a hand on a body that joints hold."""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Held, Mass, Transform, Velocity
from physicslab.ecs.sentences import sentence
from physicslab.kernels.accounts import HAND
from physicslab.kernels.forces.thrust import thrust
from physicslab.state.packed import PackedForce, StateLayout
from physicslab.state.state import State
from physicslab.systems.system import ForceSystem


class PullSystem(ForceSystem):
    """Pulls at bodies in the hand that yield. It stores no energy: its work is in the account hand."""

    needs = (Held, Transform, Velocity, Mass)
    columns = ((Held, "pull"), (Held, "grip"))
    account = HAND
    kernels = (thrust,)
    turns = couples_nothing = is_everywhere = True

    def why_left_out(self, state: State) -> str | None:
        """Return that no body is held, or that those which are do not yield."""
        yields = state.table(Held)["yields"].any()
        return super().why_left_out(state) or (None if yields else sentence("moved_by_hand"))

    def _pulled(self, state: State) -> NDArray[np.int64]:
        rows = state.batch(*self.needs).rows
        pulled: NDArray[np.int64] = rows[state.table(Held)["yields"][rows]]
        return pulled

    def turned(self, state: State) -> NDArray[np.int64]:
        """Return the rows that are pulled: off their middles, too."""
        return self._pulled(state)

    def packed(self, state: State, layout: StateLayout) -> PackedForce:
        """Return the pull for compiled integrators: a steady thrust at the grip."""
        table, rows = state.table(Held), self._pulled(state)
        rows = rows[layout.place[rows] >= 0]
        nothing = np.zeros(len(rows))
        numbers = table["pull"][rows], nothing, table["grip"][rows], nothing, nothing
        where = np.stack((layout.place[rows], layout.turn[rows], np.zeros(len(rows), np.int64)), axis=1)
        indices = np.concatenate(((len(rows), layout.clock), where.ravel()))
        return PackedForce(thrust, np.column_stack(numbers).ravel(), indices)
