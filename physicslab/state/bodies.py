"""Masses and forces of every row of a world."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.kernels.geometry.shapes import ShapesTuple
from physicslab.state.shapes import blank_shapes, with_names


class Bodies:
    """Inverse masses, and the forces of this substep, one row an entity.

    Attributes
    ----------
    force, torque : float64 arrays (rows, 2), (rows,)
        Forces [N] and torques [N m] added up in this substep; views of ``pull``.
    pull : float64 array (3 rows,)
        Both in one array: the x and y of each force in turn, then the torques.
    packed : float64 array (4, 3 rows + 1)
        Positions and angles, and last the time [s]; velocities and angular velocities in the same order: as
        compiled forces read them. Then room for positions, and for forces.
    inverse_mass, inverse_inertia : float64 arrays (rows,)
        Zero for what cannot be moved or turned: static, kinematic and held bodies.
    awake_inverse_mass, awake_inverse_inertia : float64 arrays (rows,)
        The same, and zero for sleeping bodies: the simulation uses these.
    unequal : bool
        Whether two bodies that may meet differ so much in mass that one may be too heavy for the other.
    smallest : float
        The smallest diameter or side of all shapes [m]; infinite where there are none.
    columns : tuple of an object and arrays
        What :func:`physicslab.state.masses.derive_masses` takes, and for which rows.
    checked : tuple of arrays
        The columns of numbers that are checked before each step.
    shapes : Shapes
        The table of shapes, as :func:`physicslab.state.masses.derive_masses` derives it from components.
    plain_shapes : tuple of arrays
        The same as kernels take it.
    register : tuple of arrays
        The register of cores that both were derived with (:mod:`physicslab.state.shapes`).
    sub_integrated : bool array (rows,)
        The rows with a method of their own between contacts (:class:`physicslab.stepping.split_forces`).
    unkicked : bool array (rows,)
        Those of them whose velocity within a step is not that of kicks, nor predicted as if it were.
    """

    def __init__(self) -> None:
        self.unequal, self.smallest = False, math.inf
        self.columns: tuple[object, tuple[Any, ...]]
        self.register: tuple[NDArray[Any], ...] = ()
        self.checked: tuple[NDArray[Any], ...] = ()
        self.resize(0)

    def resize(self, rows: int) -> None:
        """Set the number of rows, all of them zero."""
        self.columns = None, ()
        self.pull: NDArray[np.float64] = np.zeros(3 * rows)
        self.force, self.torque = self.pull[: 2 * rows].reshape(rows, 2), self.pull[2 * rows :]
        self.packed: NDArray[np.float64] = np.zeros((4, 3 * rows + 1))
        self.plain_shapes: ShapesTuple = blank_shapes(rows)
        self.shapes = with_names(self.plain_shapes)
        self.inverse_mass: NDArray[np.float64] = np.zeros(rows)
        self.inverse_inertia: NDArray[np.float64] = np.zeros(rows)
        self.awake_inverse_mass: NDArray[np.float64] = np.zeros(rows)
        self.awake_inverse_inertia: NDArray[np.float64] = np.zeros(rows)
        self.sub_integrated: NDArray[np.bool_] = np.zeros(rows, np.bool_)
        self.unkicked: NDArray[np.bool_] = np.zeros(rows, np.bool_)

    def set_inactive(self, asleep: NDArray[np.bool_]) -> None:
        """Give those that are ``asleep`` (rows,) an infinite mass in the simulation."""
        np.copyto(self.awake_inverse_mass, self.inverse_mass)
        np.copyto(self.awake_inverse_inertia, self.inverse_inertia)
        if asleep.any():
            self.awake_inverse_mass[asleep] = self.awake_inverse_inertia[asleep] = 0.0
