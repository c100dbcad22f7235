"""The masses of bodies, from their present components; and whether their state is still finite."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Drag, Held, Mass, Material, Medium, Shape, Spring, Transform, Velocity
from physicslab.components.shape import CHAIN, STAYS, kind_of
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.sentences import sentence
from physicslab.kernels import direct_entry, motion, ranges
from physicslab.kernels.solver import impulse
from physicslab.state.shapes import REGISTER, sizes_in, with_names
from physicslab.state.state import State

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
        If a body is so large and heavy that its moment of inertia is not finite, a size is not above 0, or a
        number that was written to a column is none that its field can hold.
    """
    bodies = state.bodies
    if len(bodies.torque) != len(state.entity_index):
        bodies.resize(len(state.entity_index))
        state.compile((motion.derive_masses, ranges.find_outside))
    if REGISTER.arrays() is not bodies.register:
        bodies.register, bodies.columns = REGISTER.arrays(), (None, ())
        bodies.plain_shapes = (*bodies.plain_shapes[:2], REGISTER.pool)
        bodies.shapes = with_names(bodies.plain_shapes)
    revision, columns = bodies.columns
    if revision == state.entity_index.revision and columns[-1] is state.sleep.asleep:
        outside = direct_entry(ranges.find_outside)(*bodies.checked)
        if outside >= 0:
            _refuse_number(state, outside)
        ratio, infinite, sizeless, bodies.smallest = direct_entry(motion.derive_masses)(*columns)
    else:
        bodies.checked = _checked(state)
        outside = ranges.find_outside(*bodies.checked)
        if outside >= 0:
            _refuse_number(state, outside)
        _check_chains(state)
        columns = _columns(state)
        ratio, infinite, sizeless, bodies.smallest = motion.derive_masses(*columns)
        if not len(state.batch(Medium)):  # else some are copies, which do not follow edits
            bodies.columns = state.entity_index.revision, columns
    if sizeless >= 0:
        _refuse_size(state, sizeless)
    if infinite >= 0:
        mass = state.table(Mass)
        inertia, allowed = float(mass["inertia"][infinite]), f"{_INERTIA.allowed}, of mass and Shape too"
        raise InvalidValue(f"{state.label_of_row(infinite)}: Mass", "inertia", inertia, allowed)
    bodies.unequal = ratio > impulse.HEAVY_RATIO


def _check_chains(state: State) -> None:
    """Refuse chains that move."""
    for row in np.flatnonzero((state.table(Shape)["kind"] == CHAIN) & state.table(Velocity).present).tolist():
        raise InvalidValue(f"{state.label_of_row(row)}: Shape", "kind", "chain", STAYS)


def _columns(state: State) -> tuple[Any, ...]:
    """Return what masses are derived from, and the arrays that receive them."""
    mass, shape, velocity, bodies = state.table(Mass), state.table(Shape), state.table(Velocity), state.bodies
    return (
        velocity.present, mass.present, _immovable(state),
        mass["mass"], mass["inertia"], mass["inertia_given"], mass["fixed_rotation"],
        *_solid(state), sizes_in(shape), REGISTER.kinds, REGISTER.extents,
        bodies.plain_shapes, velocity["angular"],
        bodies.inverse_mass, bodies.inverse_inertia,
        bodies.awake_inverse_mass, bodies.awake_inverse_inertia, state.sleep.asleep,
    )  # fmt: skip


def _immovable(state: State) -> NDArray[np.bool_]:
    """Return of each row (rows,) whether a hand holds it and does not yield."""
    held = state.table(Held)
    found: NDArray[np.bool_] = held.present & ~held["yields"] if held["yields"].any() else held.present
    return found


def _solid(state: State) -> tuple[NDArray[np.int64], ...]:
    """Return kind and vertices of each row (rows,); 0 where a medium fills it: nothing touches it."""
    shape, filled = state.table(Shape), state.table(Medium).present
    columns = shape["kind"], shape["vertices"]
    return tuple(np.where(filled, 0, column) for column in columns) if filled.any() else columns


def _checked(state: State) -> tuple[NDArray[Any], ...]:
    """Return the columns of numbers that no step can take where they are outside their ranges."""
    mass, material, spring, drag = (state.table(kind) for kind in (Mass, Material, Spring, Drag))
    return (
        mass.present, mass["mass"], mass["inertia"], material["restitution"], material["friction"],
        spring["stiffness"], spring["damping"], spring["rest_length"], drag["linear"], drag["quadratic"],
    )  # fmt: skip


def _refuse_number(state: State, row: int) -> None:
    """Refuse a number that was written to a column, as its handle would have; entities that have it first."""
    for kind in (Mass, Material, Spring, Drag):
        table = state.table(kind)
        numbers = [spec for spec in kind.FIELDS if spec.kind == "number"]
        for spec in numbers:
            for one in (*np.flatnonzero(table.present).tolist(), *([] if kind is Mass else [row])):
                value = float(table[spec.name][one])
                if spec.derived and value >= 0.0:  # of a point it is 0
                    continue
                try:
                    spec.check(value)
                except InvalidValue as error:
                    owner = f"{state.label_of_row(one)}: {kind.__name__}"
                    raise InvalidValue(owner, spec.name, value, error.allowed) from None


def _refuse_size(state: State, row: int) -> None:
    """Refuse a size that was written to a column and would keep a kernel from ever returning."""
    shape = state.table(Shape)
    label, has = state.label_of_row(row), kind_of(int(shape["kind"][row])).fields
    for spec in Shape.FIELDS:
        size = float(shape[spec.name][row]) if spec.name in has and spec.kind == "number" else 1.0
        if not 0.0 < size < math.inf and not (size == 0.0 and "vertices" in has):
            raise InvalidValue(f"{label}: Shape", spec.name, size, spec.allowed)
    code = int(shape["vertices"][row])
    raise InvalidValue(f"{label}: Shape", "vertices", code, "a code of vertices that a Shape has been given")


def check_finite(state: State, time: float) -> None:
    """Stop a run that has diverged at ``time`` [s], naming the entity and the component.

    A body that can be moved is named before a fixed one, which can only have been drawn into it.

    Raises
    ------
    Diverged
        If a position, an angle or a velocity is not finite, or a position is one that no file may hold.
    """
    transform, velocity = state.table(Transform), state.table(Velocity)
    for table, vectors, numbers, limit in (
        (transform, "position", "angle", motion.FARTHEST),
        (velocity, "linear", "angular", motion.LARGEST),
    ):
        row = direct_entry(motion.find_beyond)(table[vectors], table[numbers], limit)
        if row >= 0:
            finite = np.isfinite(table[vectors]).all(axis=1) & np.isfinite(table[numbers])
            lost = ~(finite & (np.abs(table[vectors]) <= limit).all(axis=1))
            row = int(next(iter(np.flatnonzero(lost & (state.bodies.inverse_mass > 0.0))), row))
            raise Diverged(
                sentence(
                    "too_far" if finite[row] else "not_finite",
                    body=state.label_of_row(row), component=table.component.__name__, limit=f"{limit:g}",
                    time=f"{time:.9g}", help=sentence("smaller_steps_may_help"),
                )
            )  # fmt: skip
