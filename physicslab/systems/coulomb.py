"""The forces of charges on each other, by Coulomb's law."""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Charge, Held, Transform
from physicslab.ecs.sentences import sentence
from physicslab.kernels.accounts import FIELDS
from physicslab.kernels.forces import packed_forces
from physicslab.state.packed import PackedForce, StateLayout
from physicslab.state.state import State
from physicslab.systems.inverse_square import InverseSquare
from physicslab.systems.system import ForceSystem


class CoulombSystem(ForceSystem):
    """Pushes charges of one sign apart and pulls others together, by k q_a q_b / d^2.

    Softening holds for it as for the gravity of planets. A static charge acts and is not moved; a held one
    does neither.
    """

    needs = (Charge, Transform)
    columns = ((Charge, "charge"),)
    kernels = (packed_forces.inverse_square,)
    potential = "coulomb"

    def __init__(self) -> None:
        self._acting: NDArray[np.int64] = np.zeros(0, np.int64)

    def attach(self, state: State) -> None:
        """Note which charges act on each other."""
        rows = state.batch(*self.needs).rows
        acts = ~state.table(Held).present[rows] & (state.physics.coulomb_constant != 0.0)
        self._acting = rows[acts]

    def why_left_out(self, state: State) -> str | None:
        """Needed where there is a constant, and two charges of which one can be moved."""
        reason = super().why_left_out(state)
        if reason is None and state.physics.coulomb_constant == 0.0:
            return sentence("no_coulomb_constant")
        if reason is None and len(self._acting) < 2:
            return sentence("few_charges")
        return reason

    def _law(self, state: State) -> InverseSquare:
        """Return the law: a charge yields in proportion to itself over its mass."""
        charge = state.table(Charge)["charge"]
        size = np.abs(charge)
        yields = size * state.bodies.inverse_mass
        return InverseSquare(self._acting, -state.physics.coulomb_constant, charge, yields, size)

    def packed(self, state: State, layout: StateLayout) -> PackedForce:
        """Return the forces of all pairs for compiled integrators."""
        return self._law(state).packed(state, layout, FIELDS)

    def coupled_rows(self, state: State) -> NDArray[np.int64]:
        """Return the rows (n,) of those that act."""
        return self._acting

    def needs_origin(self, state: State) -> bool:
        """Only the force of charges that stay where they are depends on it."""
        return bool((state.bodies.inverse_mass[self._acting] == 0.0).any())

    def strongest_rate(self, state: State) -> float:
        """Return the largest sqrt(k |q_a q_b| (1/m_a + 1/m_b) / d^3) of any pair at present."""
        return self._law(state).strongest_rate(state)

    def rounding_floor(self, state: State) -> float:
        """Return that of the largest sum of forces on a charge."""
        return self._law(state).rounding_floor(state)

    def why_singular(self, state: State) -> str | None:
        """Return that charges may come close."""
        return sentence("charges_close")

    @property
    def attractors(self) -> int:
        """How many charges act on each other."""
        return len(self._acting)

    def summation(self, state: State) -> str:
        """Return how pairs are summed."""
        return self._law(state).summation()

    def potential_energy(self, state: State) -> float:
        """Return the sum of k q_a q_b / d [J], zero at infinite distance."""
        return self._law(state).potential_energy(state)
