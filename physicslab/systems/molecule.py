"""Molecules: gases, drops and crystals."""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Held, Molecule, Transform, Velocity
from physicslab.ecs.sentences import sentence
from physicslab.kernels.accounts import FIELDS
from physicslab.kernels.forces.molecules import CUT2, molecules
from physicslab.state.packed import PackedForce, StateLayout, fixed_ends
from physicslab.state.state import State
from physicslab.systems.system import ROUNDING, ForceSystem


class MoleculeSystem(ForceSystem):
    """Lets molecules that are near attract each other, and repel each other where they are too near.

    A static molecule acts and is not moved; a held one does neither.
    """

    needs = (Molecule, Transform)
    columns = ((Molecule, "depth"), (Molecule, "distance"))
    kernels = (molecules,)
    potential = "molecules"

    def __init__(self) -> None:
        self._acting: NDArray[np.int64] = np.zeros(0, np.int64)

    def attach(self, state: State) -> None:
        """Note which molecules act on each other."""
        rows = state.batch(*self.needs).rows
        self._acting = rows[~state.table(Held).present[rows]]

    def why_left_out(self, state: State) -> str | None:
        """Needed where there are two molecules, of which one can be moved."""
        reason = super().why_left_out(state)
        if reason is None and len(self._acting) < 2:
            return sentence("few_molecules")
        if reason is None and not len(state.batch(Molecule, Velocity)):
            return sentence("no_molecule_moves")
        return reason

    def packed(self, state: State, layout: StateLayout) -> PackedForce:
        """Return the forces of all near pairs for compiled integrators."""
        table, rows = state.table(Molecule), self._acting
        depth, distance = table["depth"][rows], table["distance"][rows]
        reach = float(np.sqrt(CUT2) * distance.max(initial=0.0))
        own = np.stack((np.sqrt(depth), 0.5 * distance), axis=1)
        parameters = np.concatenate(((0.0, reach), own.ravel()))
        indices = np.concatenate(([len(rows)], layout.place[rows]))
        work_slots, anchors = fixed_ends(state, layout, rows)
        return PackedForce(
            molecules, parameters, indices, work_slots=work_slots, cause=FIELDS, anchors=anchors
        )  # fmt: skip

    def coupled_rows(self, state: State) -> NDArray[np.int64]:
        """Return the rows (n,) of those that act."""
        return self._acting

    def rates(self, state: State) -> NDArray[np.float64]:
        """Return for each row how fast it bounces where its speed brings it near another like it [rad/s]."""
        table, rows, rates = state.table(Molecule), self._acting, np.zeros(len(state.entity_index))
        depth, distance = table["depth"][rows], table["distance"][rows]
        inverse = state.bodies.inverse_mass[rows]
        with np.errstate(all="ignore"):
            energy = 0.5 * np.square(state.table(Velocity)["linear"][rows]).sum(axis=1) / (inverse * depth)
            s = 1.0 + np.sqrt(1.0 + np.where(inverse * depth > 0.0, energy, 0.0))
            curve = depth * (156.0 * s * s - 84.0 * s) * np.cbrt(s) / (distance * distance)
            rates[rows] = np.sqrt(2.0 * curve * inverse)
        return rates

    def rounding_floor(self, state: State) -> float:
        """Return that of forces near the distance where they cancel."""
        table, rows = state.table(Molecule), self._acting
        force = 24.0 * table["depth"][rows] / table["distance"][rows] * state.bodies.inverse_mass[rows]
        return ROUNDING * float(force.max(initial=0.0))

    def why_singular(self, state: State) -> str | None:
        """Return that molecules collide."""
        return sentence("molecules_collide")

    @property
    def crowd(self) -> int:
        """How many molecules act on each other."""
        return len(self._acting)

    def potential_energy(self, state: State) -> float:
        """Return the energy of all pairs [J], zero beyond 2.5 sigma."""
        return self.energy_found(state)
