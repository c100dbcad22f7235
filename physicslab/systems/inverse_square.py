"""The inverse square law between bodies as force systems use it: of gravity, and of charges."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform
from physicslab.kernels import direct_entry
from physicslab.kernels.forces import inverse_square as law
from physicslab.kernels.forces import packed_forces
from physicslab.kernels.forces.tree_pull import MAX_ERROR, RMS_ERROR, THETA
from physicslab.state.packed import PackedForce, StateLayout, fixed_ends
from physicslab.state.state import State
from physicslab.systems.system import ROUNDING

type Numbers = NDArray[np.float64]
"""A float64 array (rows of the world,)."""
_STEEPEST = 2
"""Where among its whole numbers the kernel looks for the place of the fastest rate."""


class InverseSquare(NamedTuple):
    """A force C w_a w_b / d^2 between the bodies of some rows, softened as the laws of a scene say.

    Attributes
    ----------
    rows : int64 array (n,)
        Whose.
    constant : float
        C; positive where those of one sign attract each other.
    weight, yields, pulls : float64 arrays (rows of the world,)
        The weights w, and how fast these make bodies fall
        (:func:`physicslab.kernels.forces.inverse_square.fastest_fall`).
    """

    rows: NDArray[np.int64]
    constant: float
    weight: Numbers
    yields: Numbers
    pulls: Numbers

    def packed(self, state: State, layout: StateLayout, cause: int) -> PackedForce:
        """Return the force for compiled integrators; what comes in by fixed bodies is booked to a cause."""
        rows, physics = self.rows, state.physics
        place = 2 + 3 * len(rows)
        plummer = physics.softening_law == "plummer"
        indices = np.concatenate(((len(rows), plummer, place), layout.place[rows]))
        numbers = self.weight[rows], self.yields[rows], self.pulls[rows]
        parameters = np.concatenate(((self.constant, physics.softening), *numbers, (0.0,)))
        work_slots, anchors = fixed_ends(state, layout, rows)
        return PackedForce(
            packed_forces.inverse_square, parameters, indices, max_rate_slot=_STEEPEST,
            work_slots=work_slots, cause=cause, anchors=anchors,
        )  # fmt: skip

    def strongest_rate(self, state: State) -> float:
        """Return the largest rate of a free fall of any pair at present [rad/s]."""
        state.compile((law.fastest_fall,))
        position, physics = state.table(Transform)["position"], state.physics
        return law.fastest_fall(
            position, self.yields, self.pulls, self.rows, self.constant, physics.softening,
            physics.softening_law == "plummer",
        )  # fmt: skip

    def rounding_floor(self, state: State) -> float:
        """Return how far rounding puts off the acceleration of a body whose neighbours cancel; 0 of many."""
        rows, physics = self.rows, state.physics
        if len(rows) > law.PLAIN_LIMIT:
            return 0.0
        position, weight = state.table(Transform)["position"][rows], np.abs(self.weight[rows])
        apart = position[:, None] - position
        square = np.square(apart).sum(axis=2) + physics.softening**2
        with np.errstate(divide="ignore"):
            pull = np.where(square > 0.0, weight / square, 0.0).sum(axis=1) * weight
        return (
            ROUNDING * abs(self.constant) * float((pull * state.bodies.inverse_mass[rows]).max(initial=0.0))
        )

    def potential_energy(self, state: State) -> float:
        """Return the energy of all pairs [J], zero at infinite distance."""
        state.compile((law.pair_potential,))
        position, physics = state.table(Transform)["position"], state.physics
        stored: float = direct_entry(law.pair_potential)(
            position, self.weight, self.rows, self.constant, physics.softening,
            physics.softening_law == "plummer",
        )  # fmt: skip
        return stored

    def summation(self) -> str:
        """Return how pairs are summed, as :mod:`physicslab.kernels.forces.inverse_square` decides."""
        n, weight = len(self.rows), self.weight[self.rows]
        if n <= law.PLAIN_LIMIT:
            return ""
        if n < law.TREE_THRESHOLD or weight.min() * weight.max() < 0.0:
            return f"each pair of {n} bodies, in vectors"
        return (
            f"Barnes-Hut tree of {n} bodies, theta {THETA:g}: forces within {RMS_ERROR:g} of the mean one by "
            f"root mean square, {MAX_ERROR:g} at most; momentum is kept as well as they are right"
        )
