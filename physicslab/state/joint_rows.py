"""The rows of equations that joints consist of: what they measure, and how they act on it."""

import math
from collections.abc import Callable, Sequence
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Gear, Pin, Pulley, Rod, Rope, Slot, Transform, Weld
from physicslab.components.quantities import JOINT
from physicslab.ecs.entity_index import EntityIndex
from physicslab.ecs.table import Table
from physicslab.kernels.joints import terms
from physicslab.kernels.joints.terms import MeasuredTerm, TermEnd, measure_turned


class Measure(IntEnum):
    """Measure of a term between the anchors of A and B, or their angles."""

    ALONG = terms.ALONG
    """How far B's anchor is from A's along an axis of the world [m]."""
    ALONG_A = terms.ALONG_A
    """The same along an axis that turns with A [m]."""
    DISTANCE = terms.DISTANCE
    """The distance of the anchors [m]."""
    ANGLE = terms.ANGLE
    """The angle of B less that of A [rad]."""


class Role(IntEnum):
    """Demand of a row on its quantity g."""

    HOLD = terms.HOLD
    """g = 0, by a force of any sign."""
    LIMIT = terms.LIMIT
    """g >= 0, by a force >= 0 and without bounce."""
    MOTOR = terms.MOTOR
    """dg/dt = ``target``, by a force of at most ``strongest``."""


class Term(NamedTuple):
    """``scale`` times a measure between two bodies, rows of the tables; 0 is the world."""

    measure: Measure
    a: int
    b: int
    anchor_a: tuple[float, float] = (0.0, 0.0)
    anchor_b: tuple[float, float] = (0.0, 0.0)
    axis: tuple[float, float] = (0.0, 0.0)
    scale: float = 1.0


class Row(NamedTuple):
    """One row: g is the sum of one or two terms less ``offset``, its force acts by the gradient of g.

    ``target`` is the speed of a motor, ``strongest`` its largest force, which may be infinite. ``placed`` is
    the field that has the sum of the terms over the first one's scale; it is measured where it is not given.
    """

    terms: tuple[Term, ...]
    role: Role = Role.HOLD
    offset: float = 0.0
    target: float = 0.0
    strongest: float = math.inf
    placed: str = ""


class Joined(NamedTuple):
    """A joint as the columns of its component have it, and the rows of the bodies at its ends."""

    entity_index: EntityIndex
    table: Table
    row: int
    a: int
    b: int

    def number(self, name: str) -> float:
        """Return a number."""
        return float(self.table[name][self.row])

    def given(self, name: str) -> float | None:
        """Return a number that may be absent."""
        return self.number(name) if self.table[f"{name}_given"][self.row] else None

    def vector(self, name: str) -> tuple[float, float]:
        """Return a pair of numbers."""
        x, y = self.table[name][self.row].tolist()
        return x, y

    def term(self, measure: Measure, axis: tuple[float, float] = (0.0, 0.0), scale: float = 1.0) -> Term:
        """Return a term between its two anchors."""
        return Term(measure, self.a, self.b, self.vector("anchor_a"), self.vector("anchor_b"), axis, scale)

    def bounded(self, term: Term, most: str = "max_force") -> list[Row]:
        """Return the limits of a term, and its motor, as far as there are any."""
        rows, (lower, upper) = [], (self.given("lower"), self.given("upper"))
        if lower is not None:
            rows.append(Row((term,), Role.LIMIT, lower))
        if upper is not None:
            rows.append(Row((term._replace(scale=-1.0),), Role.LIMIT, -upper))
        target = self.given("motor_speed")
        if target is not None:
            limit = self.given(most)
            strongest = math.inf if limit is None else limit
            rows.append(Row((term,), Role.MOTOR, target=target, strongest=strongest))
        return rows


def _point(joint: Joined) -> list[Row]:
    """Return two rows: the anchors are in one place."""
    return [Row((joint.term(Measure.ALONG, axis),)) for axis in ((1.0, 0.0), (0.0, 1.0))]


def _pin(joint: Joined) -> Sequence[Row]:
    return _point(joint) + joint.bounded(joint.term(Measure.ANGLE), most="max_torque")


def _weld(joint: Joined) -> Sequence[Row]:
    return [*_point(joint), Row((joint.term(Measure.ANGLE),), placed="angle")]


def _rod(joint: Joined) -> Sequence[Row]:
    return [Row((joint.term(Measure.DISTANCE),), placed="length")]


def _rope(joint: Joined) -> Sequence[Row]:
    return [Row((joint.term(Measure.DISTANCE, scale=-1.0),), Role.LIMIT, placed="length")]


def _axis(joint: Joined) -> tuple[float, float]:
    x, y = joint.vector("axis")
    size = math.hypot(x, y)
    return x / size, y / size


def _slot(joint: Joined) -> Sequence[Row]:
    """Return the row across the axis, that of the angle unless B turns, limits and motor along the axis."""
    x, y = _axis(joint)
    rows = [Row((joint.term(Measure.ALONG_A, (-y, x)),))]
    if not joint.table["turns"][joint.row]:
        rows.append(Row((joint.term(Measure.ANGLE),), placed="angle"))
    return rows + joint.bounded(joint.term(Measure.ALONG_A, (x, y)))


def _pulley(joint: Joined) -> Sequence[Row]:
    wheels = joint.vector("wheel_a"), joint.vector("wheel_b")
    anchors = joint.vector("anchor_a"), joint.vector("anchor_b")
    over = (
        Term(Measure.DISTANCE, body, 0, anchor, wheel, scale=-scale)
        for body, anchor, wheel, scale in zip(
            (joint.a, joint.b), anchors, wheels, (1.0, joint.number("ratio")), strict=True
        )
    )
    return [Row(tuple(over), Role.LIMIT, placed="length")]


def _coordinate(index: EntityIndex, entity: int) -> tuple[Joined, Term] | None:
    """Return the joint that a Gear couples by the entity which carries it, with its coordinate."""
    row = index.row_of.get(entity, 0)
    for kind in (Pin, Slot):
        if index.table(kind).present[row]:
            a, b = (int(end[0]) for end in ends_of(index, kind, np.array([row])))
            joint = Joined(index, index.table(kind), row, a, b)
            return joint, joint.term(*((Measure.ANGLE,) if kind is Pin else (Measure.ALONG_A, _axis(joint))))
    return None


def _gear(joint: Joined) -> Sequence[Row]:
    """Return one row: the second coordinate less ratio times the first stays as it is."""
    first, second = (
        _coordinate(joint.entity_index, int(joint.table[end][joint.row])) for end in ("first", "second")
    )
    if first is None or second is None:
        return []
    return [Row((second[1], first[1]._replace(scale=-joint.number("ratio"))), placed="offset")]


KINDS: dict[type[Any], Callable[[Joined], Sequence[Row]]] = {
    Pin: _pin, Slot: _slot, Weld: _weld, Rod: _rod, Rope: _rope, Pulley: _pulley, Gear: _gear,
}  # fmt: skip
"""The kinds of joints: of each the function that returns its rows.

The component has the fields of :mod:`physicslab.components.joint_ends`.
"""


def kinds_of(needed: str) -> tuple[str, ...]:
    """Return the components of which an entity must have one: the one that is named, or any joint."""
    return tuple(kind.__name__ for kind in KINDS) if needed == JOINT else (needed,)


def measured(term: Term, index: EntityIndex) -> MeasuredTerm:
    """Return what a term measures where bodies are."""
    transform = index.table(Transform)

    def end(body: int, anchor: tuple[float, float]) -> TermEnd:
        x, y = transform["position"][body].tolist()
        return TermEnd(x, y, float(transform["angle"][body]), 0.0, 0.0, 0.0, *anchor)

    ends = end(term.a, term.anchor_a), end(term.b, term.anchor_b)
    turned = [turn(end.angle) for end in ends for turn in (math.cos, math.sin)]
    in_python: Any = measure_turned
    found: MeasuredTerm = in_python.py_func(int(term.measure), *ends, *turned, *term.axis)
    return found


def ends_of(
    index: EntityIndex, kind: type[Any], rows: NDArray[np.int64] | None = None
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the rows (n,) of the bodies at the ends A of joints of a kind, and at B; 0 is the world.

    An end that is not there any more is -1. ``a`` that is absent is the entity that carries the joint, or
    the world if that has no place. The ends of a Gear are what its joints turn or move: B, or A if B is the
    world. ``rows`` (n,) are those of the joints, by default all.
    """
    table = index.table(kind)
    rows = index.batch(kind).rows if rows is None else rows
    if kind is Gear:
        coupled = [
            [_coordinate(index, int(entity)) for entity in table[end][rows]] for end in ("first", "second")
        ]
        first, second = (
            np.array([-1 if one is None else one[0].b or one[0].a for one in side], np.int64)
            for side in coupled
        )
        return first, second
    a, b = table["a"][rows], table["b"][rows]
    carried = (a == 0) & index.table(Transform).present[rows]
    return index.rows_of(np.where(carried, index.entities[rows], a)), index.rows_of(b)
