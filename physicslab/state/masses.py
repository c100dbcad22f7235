"""The masses of bodies, from their present components; and whether their state is still finite."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Held, Mass, Shape, Transform, Velocity
from physicslab.components.shape import CIRCLE
from physicslab.ecs.component import InvalidValue
from physicslab.kernels import direct_entry, motion
from physicslab.kernels.solver import impulse
from physicslab.state.state import State

__all__ = ["Diverged", "check_finite", "derive_masses", "quiet"]

_INERTIA = next(spec for spec in Mass.FIELDS if spec.name == "inertia")


class Diverged(ArithmeticError):
    """A value is no longer finite: the run cannot go on."""


quiet = np.errstate(all="ignore")
"""A decorator: an overflow becomes infinite, which is found and raised as Diverged; numpy need not warn."""


def derive_masses(state: State) -> None:
    """Compute moments of inertia and inverse masses of every row.

    Raises
    ------
    InvalidValue
        If a body is so large and heavy that its moment of inertia is not finite, or a size is not above 0.
    """
    bodies = state.bodies
    if len(bodies.torque) != len(state.entity_index):
        bodies.resize(len(state.entity_index))
        state.compile((motion.derive_masses,))
    revision, columns = bodies.columns
    if revision == state.entity_index.revision and columns[-1] is state.sleep.asleep:
        ratio, infinite, sizeless = direct_entry(motion.derive_masses)(*columns)
    else:
        columns = _columns(state)
        ratio, infinite, sizeless = motion.derive_masses(*columns)
        bodies.columns = state.entity_index.revision, columns
    if sizeless >= 0:
        _refuse_size(state, sizeless)
    if infinite >= 0:
        mass = state.table(Mass)
        inertia, allowed = float(mass["inertia"][infinite]), f"{_INERTIA.allowed}, of mass and Shape too"
        raise InvalidValue(f"{state.label_of_row(infinite)}: Mass", "inertia", inertia, allowed)
    bodies.unequal = ratio > impulse.HEAVY_RATIO


def _columns(state: State) -> tuple[NDArray[Any], ...]:
    """Return what masses are derived from, and the arrays that receive them."""
    mass, shape, velocity, bodies = state.table(Mass), state.table(Shape), state.table(Velocity), state.bodies
    return (
        velocity.present, mass.present, state.table(Held).present,
        mass["mass"], mass["inertia"], mass["inertia_given"], mass["fixed_rotation"],
        shape["kind"], shape["radius"], shape["width"], shape["height"], velocity["angular"],
        bodies.inverse_mass, bodies.inverse_inertia,
        bodies.awake_inverse_mass, bodies.awake_inverse_inertia, state.sleep.asleep,
    )  # fmt: skip


def _refuse_size(state: State, row: int) -> None:
    """Refuse a size that was written to a column and would keep a kernel from ever returning."""
    shape = state.table(Shape)
    needed = ("radius",) if shape["kind"][row] == CIRCLE else ("width", "height")
    for spec in Shape.FIELDS:
        size = float(shape[spec.name][row]) if spec.name in needed else 1.0
        if not 0.0 < size < math.inf:
            raise InvalidValue(f"{state.label_of_row(row)}: Shape", spec.name, size, spec.allowed)


def check_finite(state: State, time: float) -> None:
    """Stop a run that has diverged at ``time`` [s], naming the entity and the component.

    A body that can be moved is named before a fixed one, which can only have been drawn into it.

    Raises
    ------
    Diverged
        If a position, an angle or a velocity is not finite.
    """
    transform, velocity = state.table(Transform), state.table(Velocity)
    for table, vectors, numbers in ((transform, "position", "angle"), (velocity, "linear", "angular")):
        row = motion.find_not_finite(table[vectors], table[numbers])
        if row >= 0:
            lost = ~(np.isfinite(table[vectors]).all(axis=1) & np.isfinite(table[numbers]))
            row = int(next(iter(np.flatnonzero(lost & (state.bodies.inverse_mass > 0.0))), row))
            raise Diverged(
                f"{state.label_of_row(row)}: {table.component.__name__} is no longer finite at "
                f"t = {time:.9g} s; a smaller dt or more substeps may help"
            )
