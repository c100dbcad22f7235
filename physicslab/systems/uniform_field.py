"""A field that is the same everywhere, as force systems use it: of gravity, and of charges."""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform
from physicslab.ecs.vector import Vector2
from physicslab.kernels.forces import gravity, packed_forces
from physicslab.state.packed import PackedForce, StateLayout
from physicslab.state.state import State


def packed_field(
    state: State, layout: StateLayout, rows: NDArray[np.int64], weight: NDArray[np.float64], field: Vector2,
    cause: int,
) -> PackedForce:  # fmt: skip
    """Return the force ``weight`` times ``field`` on rows (n,) for compiled integrators.

    Parameters
    ----------
    state, layout, rows
        Whose, and their places; those that take no part are left out.
    weight : float64 array (rows of the world,)
        Masses [kg], or charges [C].
    field : Vector2
        The force on a unit of that.
    cause : int
        The account of the momentum that it gives.
    """
    rows = rows[(state.bodies.inverse_mass[rows] > 0.0) & (layout.place[rows] >= 0)]
    indices = np.concatenate(([len(rows)], layout.place[rows], (-1,)))
    parameters = np.concatenate(((field.x, field.y), weight[rows], (weight[rows].sum(),)))
    books = ((cause, len(indices) - 1),) if len(rows) else ()
    return PackedForce(packed_forces.uniform_gravity, parameters, indices, work_slots=books)


def field_energy(state: State, weight: NDArray[np.float64], field: Vector2) -> float:
    """Return the energy -w field . x of what forces can move [J], zero at the origin; ``weight`` (rows,)."""
    state.compile((gravity.uniform_potential,))
    position, inverse_mass = state.table(Transform)["position"], state.bodies.inverse_mass
    return gravity.uniform_potential(position, weight, inverse_mass, field.x, field.y)
