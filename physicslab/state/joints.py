"""Joints as rows of constraints: one table, whatever kind of joint a row comes from."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Pin, Transform
from physicslab.ecs.entity_index import EntityIndex
from physicslab.ecs.table import Table


class Row(NamedTuple):
    """One row: B's anchor is to stay at A's along an axis, a unit vector of the world.

    With the next one it is solved as one ``block`` by soft constraints, where that is 2.
    """

    axis: tuple[float, float]
    block: int = 1


def _pin(table: Table, row: int) -> Sequence[Row]:
    """Return two rows: the anchors are in one place."""
    return Row((1.0, 0.0), 2), Row((0.0, 1.0), 0)


KINDS: dict[type[Any], Callable[[Table, int], Sequence[Row]]] = {
    Pin: _pin,
}
"""The kinds of joints: of each the function that returns its rows, of the component's table and a row of it.

The component has the fields of :mod:`physicslab.components.joint_ends`.
"""


class Joint(NamedTuple):
    """One joint: its entity, its kind, the first of its rows and how many they are."""

    entity: int
    kind: type[Any]
    first: int
    size: int


class Joints:
    """The rows of all joints of a world.

    Attributes
    ----------
    joints : tuple of Joint
        Which joint has which rows, in the order of rows.
    a, b : int64 arrays (n,)
        The rows of the bodies of each constraint; 0 is the world.
    anchor_a, anchor_b, axis : float64 arrays (n, 2)
        In the bodies' own frames [m], or in the world's; the axis is a unit vector of the world.
    block : int64 array (n,)
        How many rows are solved as one from here on; 0 for those after the first.
    impulse : float64 array (n,)
        Of the last substep [N s], from which the next one starts.
    force : float64 array (n,)
        At the end of the last step, or as its mean [N].
    measured : float64 array (n, k)
        Room for what soft constraints measure of a row (:mod:`physicslab.kernels.joints.soft`).
    beside_contacts : bool
        Whether contacts are solved at all, and joints with them.
    rank : int
        How many rows are independent, where the last stepper found that; else -1.
    apart : int64 array (k, 2)
        The pairs of bodies a < b that do not touch each other, sorted.
    """

    def __init__(self) -> None:
        self._take(())
        self._settings, self.beside_contacts = b"", False
        self._joined: tuple[Any, ...] = ()

    def _take(self, joints: Sequence[Joint]) -> None:
        n = sum(joint.size for joint in joints)
        self.joints = tuple(joints)
        self.a, self.b, self.block = np.zeros((3, n), np.int64)
        self.anchor_a, self.anchor_b, self.axis = np.zeros((3, n, 2))
        self.impulse, self.force = np.zeros((2, n))
        self.measured: NDArray[np.float64] = np.zeros((0, 0))
        self.apart, self.rank = np.zeros((0, 2), np.int64), -1

    def __len__(self) -> int:
        return len(self.a)

    @property
    def edges(self) -> NDArray[np.int64]:
        """The pairs of rows (n, 2) that joints hold together; 0 is the world."""
        first = np.array([joint.first for joint in self.joints], np.int64)
        return np.stack((self.a[first], self.b[first]), axis=1)

    def rebuild(self, index: EntityIndex) -> bool:
        """Take the joints that there are; return whether they are others than before. Impulses are kept."""
        kept = {(joint.entity, joint.kind): self._held(joint) for joint in self.joints}
        found: list[tuple[Joint, int, int, int, Sequence[Row]]] = []
        n = 0
        for kind, rows_of in KINDS.items():
            table = index.table(kind)
            for row, a, b in zip(*ends_of(index, kind), strict=True):
                if a < 0 or b < 0:
                    continue  # its body is gone, and it goes with that
                rows = rows_of(table, row)
                entity = int(index.entities[row])
                found.append((Joint(entity, kind, n, len(rows)), int(row), int(a), int(b), rows))
                n += len(rows)
        before, entities = self._joined, index.entities
        self._take([joint for joint, *_ in found])
        for joint, _, a, b, rows in found:
            own = slice(joint.first, joint.first + joint.size)
            self.a[own], self.b[own] = a, b
            self.block[own] = [row.block for row in rows]
            held = kept.get((joint.entity, joint.kind))
            if held is not None:
                self.impulse[own], self.force[own] = held
        self._settings = b""
        self.refresh(index)
        apart = {
            (min(a, b), max(a, b))
            for joint, row, a, b, _ in found
            if not index.table(joint.kind)["collide"][row]
        }
        self.apart = np.array(sorted(apart), np.int64).reshape(-1, 2)
        self._joined = tuple(
            (joint.entity, joint.kind, int(entities[a]), int(entities[b])) for joint, _, a, b, _ in found
        )
        return before != self._joined

    def _held(self, joint: Joint) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        own = slice(joint.first, joint.first + joint.size)
        return self.impulse[own].copy(), self.force[own].copy()

    def settings(self, index: EntityIndex) -> bytes:
        """Return the numbers of all joints, bit by bit."""
        return b"".join(index.table(kind)[spec.name].tobytes() for kind in KINDS for spec in kind.FIELDS)

    def refresh(self, index: EntityIndex) -> bool:
        """Take the numbers of joints where they were changed; return whether they were."""
        if not self.joints:
            return False
        settings = self.settings(index)
        if settings == self._settings:
            return False
        self._settings = settings
        for joint in self.joints:
            table, row = index.table(joint.kind), index.row_of[joint.entity]
            own = slice(joint.first, joint.first + joint.size)
            self.anchor_a[own], self.anchor_b[own] = table["anchor_a"][row], table["anchor_b"][row]
            self.axis[own] = [one.axis for one in KINDS[joint.kind](table, row)]
        return True

    def may_touch(self, a: NDArray[Any], b: NDArray[Any]) -> NDArray[np.bool_]:
        """Return of pairs of rows (n,) which of them no joint keeps from touching each other."""
        low, high = np.minimum(a, b).astype(np.int64), np.maximum(a, b).astype(np.int64)
        return ~np.isin((low << 32) | high, (self.apart[:, 0] << 32) | self.apart[:, 1])

    def kept(self) -> Iterator[tuple[int, str, list[float]]]:
        """Yield of each joint that has impulses its entity, its kind and these [N s]."""
        for joint in self.joints:
            impulses = self.impulse[joint.first : joint.first + joint.size]
            if impulses.any():
                yield joint.entity, joint.kind.__name__, impulses.tolist()

    def restore(self, kept: Sequence[tuple[int, str, Sequence[float]]]) -> None:
        """Give back what :meth:`kept` yielded; what no joint of now has is dropped."""
        held = {(entity, kind): impulses for entity, kind, impulses in kept}
        self.impulse[:] = 0.0
        for joint in self.joints:
            impulses = held.get((joint.entity, joint.kind.__name__), ())
            if len(impulses) == joint.size:
                self.impulse[joint.first : joint.first + joint.size] = impulses


def ends_of(
    index: EntityIndex, kind: type[Any]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return the rows (n,) of the joints of a kind, of the bodies at their ends A, and at B; 0 is the world.

    An end that is not there any more is -1. ``a`` that is absent is the entity that carries the joint, or
    the world if that has no place.
    """
    batch, table, rows_of = index.batch(kind), index.table(kind), index.rows_of
    a, b = table["a"][batch.rows], table["b"][batch.rows]
    carried = (a == 0) & index.table(Transform).present[batch.rows]
    return batch.rows, rows_of(np.where(carried, batch.entities, a)), rows_of(b)
