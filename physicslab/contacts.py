"""What is near, what touches, and with what impulse: shared by the systems that find, resolve and show contacts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from physicslab.kernels import compile_kernels, impulse
from physicslab.kernels.records import MANIFOLD, POINT

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["Contacts"]

_NO_ROWS = ("entity_a", "entity_b", "a", "b")
_KEPT = tuple(name for name in MANIFOLD.names or () if name not in _NO_ROWS)
_WARM = ("feature", "normal_impulse", "tangent_impulse")


class Contacts:
    """The near pairs of one world, sorted, each with its manifold, and which of them touch.

    Attributes
    ----------
    manifolds : array of MANIFOLD (capacity,)
        One for each near pair; the first ``candidate_pairs`` are in use.
    points : array of POINT (2 capacity,)
        Points 2 p and 2 p + 1 belong to pair p; the first ``manifolds[p]["count"]`` are in use.
    touching : int64 array (capacity,)
        The pairs with points, in order; the first ``count`` are in use. Points may have positive separation:
        they would meet within a substep.
    candidate_pairs, count : int
        How many pairs are near each other, and how many have points.
    stale : bool
        Whether the pairs must be found anew because bodies came, went or changed.
    """

    def __init__(self) -> None:
        self.candidate_pairs = 0
        self.count = 0
        self.stale = True
        self._fit(64)

    def _fit(self, capacity: int) -> None:
        self.manifolds: NDArray[Any] = np.zeros(capacity, MANIFOLD)
        self.points: NDArray[Any] = np.zeros(2 * capacity, POINT)
        self.touching: NDArray[np.int64] = np.zeros(capacity, np.int64)

    def replace(self, manifolds: NDArray[Any], points: NDArray[Any], pairs: int) -> None:
        """Take over manifolds made for a new list of pairs; what touches is to be found out."""
        self.manifolds, self.points, self.candidate_pairs, self.count = manifolds, points, pairs, 0
        if len(self.touching) < len(manifolds):
            self.touching = np.zeros(len(manifolds), np.int64)

    def clear(self) -> None:
        """Forget every pair."""
        self.candidate_pairs = self.count = 0
        self.stale = True

    @property
    def active(self) -> NDArray[np.int64]:
        """The numbers of the pairs that have contact points."""
        return self.touching[: self.count]

    @property
    def max_penetration(self) -> float:
        """The deepest overlap now [m]."""
        compile_kernels((impulse.deepest,))
        return float(impulse.deepest(self.manifolds, self.points, self.touching, self.count))

    def export(self, world: World) -> list[list[float]]:
        """Return what the next step takes from the last one, as rows of numbers that JSON can hold.

        A row starts with the two entities (0 for the world's bounds) and the wall. Points that will be found anew
        leave their features and impulses; those that will be kept, everything.
        """
        rows: list[list[float]] = []
        for p in range(self.candidate_pairs):
            manifold = self.manifolds[p]
            pair = [int(manifold["entity_a"]), int(manifold["entity_b"]), int(manifold["wall"])]
            if manifold["found"] == 2:
                kept = [manifold[name].item() for name in _KEPT[1:]]
                both = [value for j in (2 * p, 2 * p + 1) for value in self.points[j].item()]
                rows.append([*pair, *kept, *both])
            elif manifold["count"] > 0:
                rows.append([*pair, *(self.points[j][name].item() for j in (2 * p, 2 * p + 1) for name in _WARM)])
        return rows

    def restore(self, world: World, rows: Sequence[Sequence[float]]) -> None:
        """Take back what :meth:`export` returned.

        Raises
        ------
        ValueError
            If a row has not the right number of values.
        """
        self._fit(max(64, len(rows)))
        light, heavy = 3 + 2 * len(_WARM), 2 + len(_KEPT) + 2 * len(POINT.names or ())
        ordered = sorted(rows, key=lambda row: tuple(row[:3]))
        for p, row in enumerate(ordered):
            if len(row) not in (light, heavy):
                raise ValueError(f"a contact has {light} or {heavy} values, not {len(row)}")
            manifold = self.manifolds[p]
            manifold["entity_a"], manifold["entity_b"], manifold["wall"] = row[:3]
            if len(row) == heavy:
                for name, value in zip(_KEPT[1:], row[3:], strict=False):
                    manifold[name] = value
                values = iter(row[2 + len(_KEPT) :])
                names: Sequence[str] = POINT.names or ()
            else:
                values, names = iter(row[3:]), _WARM
            for j in (2 * p, 2 * p + 1):
                for name in names:
                    self.points[j][name] = next(values)
        self.candidate_pairs, self.count, self.stale = len(ordered), 0, True
