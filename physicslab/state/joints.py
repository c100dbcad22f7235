"""Joints as rows of constraints: one table, whatever kind of joint a row comes from."""

from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Velocity, Weld
from physicslab.ecs.component import InvalidValue
from physicslab.ecs.entity_index import EntityIndex
from physicslab.ecs.sentences import sentence
from physicslab.kernels import Plain
from physicslab.kernels.joints.blocks import Joints as JointArguments
from physicslab.languages.sentence import Sentence
from physicslab.state.entities import label_in_context
from physicslab.state.joint_order import NO_BLOCKS, Blocks, buffers_of, order_rows
from physicslab.state.joint_rows import KINDS, Joined, Role, Row, ends_of, measured


class Joint(NamedTuple):
    """One joint: its entity, its kind, the first of its rows and how many they are, its bodies A and B."""

    entity: int
    kind: type[Any]
    first: int
    size: int
    a: int
    b: int

    @property
    def own(self) -> slice:
        """Its rows."""
        return slice(self.first, self.first + self.size)


class Joints:
    """The rows of all joints of a world, and the terms of these.

    A row's quantity is g = scale * measure of its first term, plus that of a second one, less its offset. The
    first terms of rows 0 to n - 1 are the terms 0 to n - 1, and the second ones stand behind them.

    Attributes
    ----------
    joints : tuple of Joint
        Which joint has which rows, in the order of rows.
    measure : int64 array (m,)
        Measure of each term, a :class:`physicslab.state.joint_rows.Measure`.
    a, b : int64 arrays (m,)
        The rows of its bodies; 0 is the world.
    anchor_a, anchor_b, axis : float64 arrays (m, 2)
        In the bodies' own frames [m], or in the world's; the axis is a unit vector of the world, or in A's
        frame.
    scale : float64 array (m,)
        The factor of the measure.
    second : int64 array (n,)
        The second term of each row, or -1.
    role : int64 array (n,)
        Its demand, a :class:`Role`.
    offset, target, strongest : float64 arrays (n,)
        Offset of the terms [m or rad]; the speed of a motor [m/s or rad/s]; its largest force [N or
        N m], which may be infinite.
    blocks : Blocks
        The order in which soft constraints solve them, and which at once.
    impulse : float64 array (n,)
        Impulses of the last substep [N s or N m s], from which the next one starts.
    force : float64 array (n,)
        At the end of the last step, or as its mean [N or N m].
    largest : float64 array (n,)
        The largest error so far, as far as soft constraints solved it [m or rad].
    row, owner : int64 arrays (m,)
        The row that each term is of, and the number of its joint.
    held : int64 array (j,)
        The row of each joint's body B.
    bears : float64 array (j, 2)
        The force [N] and the torque [N m] beyond which each joint breaks; (0, 2) where none can.
    loads : float64 array (j, 3)
        Room for the force on each joint's B [N] and the torque on it [N m].
    buffers : tuple of float64 arrays
        Room for what is computed of the ends, nodes and entries of blocks
        (:mod:`physicslab.kernels.joints.blocks`).
    plain : tuple
        The arguments of kernels that work on rows.
    watched : bool
        Whether a system removes joints that do not bear their load.
    beside_contacts : bool
        Whether contacts are solved at all, and joints with them.
    dependent : bool array (n,)
        Which rows hold what others hold already, where the equations of smooth motion were solved.
    edges : int64 array (k, 2)
        The pairs of rows that joints hold together; 0 is the world.
    apart : int64 array (k, 2)
        The pairs of bodies a < b that do not touch each other, sorted: those of a joint, and all that welds
        make one thing of.
    placed : bytes
        The places of bodies after the last step by soft contacts; empty where it is not known whether they
        were edited since.
    wholes : dict of int to int
        For each entity that is a part of such a thing, the first of its parts.
    """

    def __init__(self) -> None:
        self._take([], [])
        self._settings, self.beside_contacts, self.watched = list[bytes](), False, False
        self._entities = np.zeros(0, np.int64)
        self._joined: tuple[Any, ...] = ()
        self.placed = b""
        self.wholes: dict[int, int] = {}

    def _take(self, joints: Sequence[Joint], rows: Sequence[Row]) -> None:
        self.joints, self._kinds = tuple(joints), {joint.kind for joint in joints}
        self.second = np.full(len(rows), -1, np.int64)
        self.second[[len(row.terms) > 1 for row in rows]] = len(rows) + np.arange(
            sum(len(row.terms) > 1 for row in rows)
        )
        terms = [row.terms[0] for row in rows] + [term for row in rows for term in row.terms[1:]]
        self.measure, self.a, self.b = (np.array([term[n] for term in terms], np.int64) for n in range(3))
        self.anchor_a, self.anchor_b, self.axis = (
            np.array([term[n] for term in terms], np.float64).reshape(-1, 2) for n in range(3, 6)
        )
        self.scale = np.array([term.scale for term in terms], np.float64)
        self.role = np.array([row.role for row in rows], np.int64)
        self.offset, self.target, self.strongest = (
            np.array([row[n] for row in rows], np.float64) for n in range(2, 5)
        )
        self.impulse, self.force, self.largest = np.zeros((3, len(rows)))
        first = np.arange(len(rows))
        self.row = np.concatenate((first, first[self.second >= 0]))
        self.owner = np.repeat(np.arange(len(joints)), [joint.size for joint in joints])[self.row]
        self.held = np.array([joint.b for joint in joints], np.int64)
        self.bears, self.loads = np.zeros((0, 2)), np.zeros((len(joints), 3))
        self._set_blocks(NO_BLOCKS)
        self.edges, self.apart = np.zeros((2, 0, 2), np.int64)
        self.dependent = np.zeros(len(rows), np.bool_)

    def _set_blocks(self, blocks: Blocks) -> None:
        self.blocks, self.buffers = blocks, buffers_of(blocks)
        self.plain: Plain[JointArguments] = (
            self.measure, self.a, self.b, self.anchor_a, self.anchor_b, self.axis, self.scale, self.role,
            self.offset, self.target, self.strongest, self.impulse, self.largest, self.row, self.owner,
            self.held, self.bears, self.loads, *blocks, *self.buffers,
        )  # fmt: skip

    def __len__(self) -> int:
        return len(self.role)

    def rebuild(self, index: EntityIndex) -> bool:
        """Take the joints that there are; return whether they are others than before. Impulses are kept."""
        before, entities = self._joined, index.entities
        held: dict[Any, tuple[NDArray[np.float64], ...]] = {
            (joint.entity, joint.kind): tuple(array[joint.own].copy() for array in self._carried)
            for joint in self.joints
        }
        joints: list[Joint] = []
        rows: list[Row] = []
        edges: set[tuple[int, int]] = set()
        apart: set[tuple[int, int]] = set()
        welded: dict[int, set[int]] = {}
        for kind in filter(index.has_any, KINDS):
            table, rows_of = index.table(kind), KINDS[kind]
            for row, a, b in zip(index.batch(kind).rows.tolist(), *ends_of(index, kind), strict=True):
                if a < 0 or b < 0:
                    continue  # its body is gone, and it goes with that
                joined = Joined(index, table, row, int(a), int(b))
                own = [_placed(joined, one) for one in rows_of(joined)]
                joints.append(Joint(int(entities[row]), kind, len(rows), len(own), joined.a, joined.b))
                rows += own
                bodies = {end for one in own for term in one.terms for end in (term.a, term.b)}
                edges.update(combinations(sorted(bodies), 2))
                if not table["collide"][row]:
                    apart.add((min(joined.a, joined.b), max(joined.a, joined.b)))
                    if kind is Weld:
                        whole = welded.get(joined.a, {joined.a}) | welded.get(joined.b, {joined.b})
                        welded.update(dict.fromkeys(whole, whole))
        for one, whole in welded.items():
            apart.update((one, other) for other in whole if one < other)
        self.wholes = {int(entities[one]): int(entities[min(whole)]) for one, whole in welded.items()}
        self._take(joints, rows)
        bears = np.array([_bounds_of(index, joint) for joint in joints]).reshape(-1, 2)
        self.bears = bears if (bears < np.inf).any() else self.bears
        moves = index.table(Velocity).present
        own_rows = [range(joint.first, joint.first + joint.size) for joint in joints]
        self._set_blocks(order_rows(rows, own_rows, moves.tolist()))
        self.edges = np.array(sorted(edges), np.int64).reshape(-1, 2)
        self.apart = np.array(sorted(apart), np.int64).reshape(-1, 2)
        for joint in joints:
            before_it = held.get((joint.entity, joint.kind), ())
            if before_it and len(before_it[0]) == joint.size:
                for array, values in zip(self._carried, before_it, strict=True):
                    array[joint.own] = values
        self._settings, self._entities, self.placed = self._columns(index), entities, b""
        self._joined = tuple(
            (joint.entity, joint.kind, int(entities[joint.a]), int(entities[joint.b])) for joint in joints
        )
        return before != self._joined

    @property
    def _carried(self) -> tuple[NDArray[np.float64], ...]:
        """Columns of a row that are not fields of its component."""
        return self.impulse, self.force, self.largest

    @property
    def settings(self) -> bytes:
        """The numbers of all joints that rows were made of, bit by bit."""
        return b"".join(self._settings)

    @property
    def breakable(self) -> bool:
        """Whether any joint can break, and a system looks for it."""
        return self.watched and len(self.bears) > 0

    def _columns(self, index: EntityIndex) -> list[bytes]:
        """Return the same column by column: in one piece they take many times as long."""
        parts = [(index.table(kind), index.batch(kind).rows) for kind in KINDS if kind in self._kinds]
        return [column[rows].tobytes() for table, rows in parts for column in table.columns]

    def refresh(self, index: EntityIndex) -> bool:
        """Take the numbers of joints where they were changed; return whether they were.

        That bodies have come or gone, so that rows are numbered again, is no change of a joint.
        """
        changed = bool(self.joints) and self._columns(index) != self._settings
        if changed:
            for kind in self._kinds:
                index.table(kind).refuse_written(index.batch(kind).entities, label_in_context)
        if changed or (self.joints and self._entities is not index.entities):
            self.rebuild(index)
        return changed

    @property
    def solved(self) -> NDArray[np.bool_]:
        """Which rows (n,) are equations of smooth motion: what holds, and motors of any strength."""
        solved: NDArray[np.bool_] = (self.role == Role.HOLD) | (
            (self.role == Role.MOTOR) & np.isinf(self.strongest)
        )
        return solved

    def why_not_smooth(self) -> str | None:
        """Return which joint has other rows, or ``None``."""
        left = (joint.kind.__name__ for joint in self.joints if not self.solved[joint.own].all())
        return next((sentence("joint_limit", joint=Sentence(kind)) for kind in left), None)

    def kept(self) -> Iterator[tuple[int, str, list[float]]]:
        """Yield of each joint that has impulses its entity, its kind and these [N s]."""
        for joint in self.joints:
            impulses = self.impulse[joint.own]
            if impulses.any():
                yield joint.entity, joint.kind.__name__, impulses.tolist()

    def restore(self, kept: Sequence[tuple[int, str, Sequence[float]]]) -> None:
        """Give back what :meth:`kept` yielded; what no joint of now has is dropped."""
        held = {(entity, kind): impulses for entity, kind, impulses in kept}
        self.impulse[:], self.placed = 0.0, b""
        self.buffers[0][:] = 0.0  # gradients: they are found again, where bodies are then
        for joint in self.joints:
            impulses = held.get((joint.entity, joint.kind.__name__), ())
            if len(impulses) == joint.size:
                self.impulse[joint.own] = impulses


def _bounds_of(index: EntityIndex, joint: Joint) -> tuple[float, ...]:
    """Return the force [N] and the torque [N m] that a joint bears, infinite where that is not given."""
    table, row = index.table(joint.kind), index.row_of[joint.entity]
    known = {spec.name for spec in joint.kind.FIELDS}
    return tuple(
        float(table[name][row]) if name in known and table[f"{name}_given"][row] else np.inf
        for name in ("breaks", "breaks_torque")
    )


def _placed(joined: Joined, row: Row) -> Row:
    """Return a row with the offset of its field, which is measured where it was not given."""
    if not row.placed:
        return row
    table, scale = joined.table, row.terms[0].scale
    if joined.given(row.placed) is None:
        value = sum(term.scale * measured(term, joined.entity_index).value for term in row.terms) / scale
        kind = table.component
        spec = next(spec for spec in kind.FIELDS if spec.name == row.placed)
        try:
            table[row.placed][joined.row] = spec.check(value)
        except InvalidValue as error:
            owner = label_in_context(int(joined.entity_index.entities[joined.row]))
            allowed = f"{error.allowed}{': its anchors are in one place' if value == 0.0 else ''}"
            raise InvalidValue(f"{owner}: {kind.__name__}", row.placed, value, allowed) from None
        table[f"{row.placed}_given"][joined.row] = True
    return row._replace(offset=scale * joined.number(row.placed))
