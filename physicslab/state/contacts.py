"""The near pairs of a world, those that may touch with a record, and which of them do: arrays."""

import sys
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.kernels import compile_kernels, direct_entry, near_counts
from physicslab.kernels.broad import near_pairs
from physicslab.kernels.geometry.contact import AS_FOUND
from physicslab.kernels.records import APART, CONSTRAINT, CONSTRAINT_POINT, IMPACT, MANIFOLD, POINT
from physicslab.kernels.solver import impulse
from physicslab.kernels.wide import refresh, slots
from physicslab.state.wide_contacts import WideContacts


def _count(place: int, meaning: str, *, of_pairs: bool = True) -> Any:
    """Return a property that reads and writes one of the counts that kernels change."""

    def read(contacts: "Contacts") -> int:
        if of_pairs and contacts.source is not None:
            contacts.fetch()
        return int(contacts.counts[place])

    def write(contacts: "Contacts", value: int) -> None:
        contacts.counts[place] = value

    return property(read, write, doc=meaning)


class Contacts:
    """The near pairs of one world, in three places: those far apart, those that may touch, those asleep.

    Attributes
    ----------
    counts : int64 array (COUNTED,)
        How much of each array is in use; kernels change it (:mod:`physicslab.kernels.wide.slots`).
    manifolds : array of MANIFOLD (capacity,)
        One for each near pair that has a record; the first ``recorded`` are in use. Those that were listed
        together are in order; those activated since come after them.
    points : array of POINT (2 capacity,)
        Points 2 p and 2 p + 1 belong to pair p; the first ``manifolds[p]["count"]`` are in use.
    proximity : uint32 array (2 capacity,)
        Rows of the discs that are near each other and have no record, two by two; the first
        ``proximity_count`` pairs are in use.
    activation_distance : float64 array (capacity,)
        The distance at which these get one [m].
    wide : WideContacts
        The wide contacts, eight side by side; their records are as old as the last :meth:`sync`.
    scalar : int64 array (capacity,)
        The pairs with records that are neither in a block nor inactive; the first ``scalar_count`` are in
        use.
    sleeping : int64 array (capacity,)
        The inactive pairs with points: both bodies sleep, or one does and nothing moves the other; the first
        ``sleeping_count`` are in use.
    inactive : bool array (rows,)
        Whose pairs with each other are inactive; empty where no body sleeps.
    touching : int64 array (capacity,)
        The scalar pairs with points; the first ``active`` are in use. Points may have positive separation:
        they would meet within a substep.
    opened : int64 array (COLOURS,)
        Room in which blocks with free slots are noted.
    impulse_dt : float
        The time [s] over which the points' impulses act; 0 before there were any.
    substep_factor : int
        The factor by which the coming step needs more substeps than configured; of rigid contacts one more
        than how many steps in a row were made by impulses.
    stale : bool
        Whether the pairs must be listed again because bodies came, went or changed.
    restoring : bool
        Whether records name slots that are still to be filled, as those of a file do.
    log : array of IMPACT
        The last impacts; number n is at n modulo the length.
    read : bool
        Whether the impacts of the contact step are read from the log, and so written to it (a gas takes 5 %
        longer for that); those located in time are there in any case.
    replaced : int
        How often arrays were put in the place of others, which who holds them must then take.
    source : callable, optional
        Brings the pairs here when they are read, where they are found in the worlds of islands.
    """

    LOGGED = 100_000
    """How many impacts are kept; their memory is taken as they come."""

    proximity_count = _count(near_counts.PROXIMITY, "How many near pairs have no record.")
    recorded = _count(near_counts.RECORDED, "How many near pairs have records.")
    scalar_count = _count(near_counts.SCALAR, "How many of these are solved one by one.")
    sleeping_count = _count(near_counts.SLEEPING, "How many inactive pairs have points.")
    active = _count(near_counts.ACTIVE, "How many scalar pairs have points.")
    logged = _count(near_counts.LOGGED, "How many impacts were ever logged.", of_pairs=False)
    restitutions_lowered = _count(
        near_counts.LOWERED,
        "How many impacts of two points had their restitution lowered, so that no energy was made.",
        of_pairs=False,
    )
    energetic_impacts = _count(
        near_counts.ENERGETIC,
        "How many impacts obeyed Stronge's law, as Newton's would have made energy.",
        of_pairs=False,
    )
    outside = _count(
        near_counts.OUTSIDE, "Whether a body was beyond the bounds, or wedged, in the step at hand."
    )
    unordered = _count(
        near_counts.UNORDERED, "Whether scalar pairs were added since those were last put in order."
    )

    def __init__(self) -> None:
        self.counts = np.zeros(near_counts.COUNTED, np.int64)
        self.wide = WideContacts(self.counts)
        self.inactive: NDArray[np.bool_] = np.zeros(0, np.bool_)
        self.opened = np.zeros(slots.COLOURS, np.int64)
        self._synced, self.restoring = True, False
        self.impulse_dt, self.substep_factor = 0.0, 1
        self.stale, self.replaced = True, 0
        self.log: NDArray[Any] = np.zeros(self.LOGGED, IMPACT)
        self._lengthened = 0
        self.read = False
        self.source: Callable[[], None] | None = None
        self.make_room(64)

    @property
    def impacts(self) -> NDArray[Any]:
        """The last impacts, in order: an array of IMPACT.

        At most ``LOGGED`` of them.
        """
        return self.impacts_since(0)

    @property
    def first_logged(self) -> int:
        """The number of the oldest impact in the log: a longer one still lacks what the shorter one did."""
        self._lengthened = min(self._lengthened, self.logged)  # time may have gone back
        first: int = max(self.logged - len(self.log), self._lengthened)
        return first

    def impacts_since(self, first: int, most: int = sys.maxsize) -> NDArray[Any]:
        """Return the impacts from number ``first`` on that are still in the log: an array of IMPACT (n,)."""
        length, first = len(self.log), max(first, self.first_logged)
        begin = first % length
        end = begin + max(min(self.logged - first, most), 0)
        return np.concatenate((self.log[begin:end], self.log[: max(end - length, 0)]))

    def order_log(self, first: int) -> None:
        """Put the impacts from number ``first`` on into the order of time, as those of a substep are not."""
        new = self.impacts_since(first)
        if (np.diff(new["time"]) < 0.0).any():
            places = np.arange(self.logged - len(new), self.logged) % len(self.log)
            self.log[places] = new[np.argsort(new["time"], kind="stable")]

    @property
    def step_log(self) -> NDArray[Any]:
        """The log for the impacts of the contact step: of no length where they are not read."""
        return self.log if self.read else self.log[:0]

    def lengthen_log(self, length: int) -> None:
        """Let the log hold so many impacts, no fewer than now; those in it stay."""
        last, log, self._lengthened = self.impacts, np.zeros(length, IMPACT), self.first_logged
        begin = self._lengthened % length
        before = min(len(last), length - begin)
        log[begin : begin + before], log[: len(last) - before] = last[:before], last[before:]
        self.log = log

    def make_room(self, capacity: int) -> None:
        """Drop everything, and make room for so many records."""
        self.replaced += 1
        self.manifolds: NDArray[Any] = np.zeros(capacity, MANIFOLD)
        self.points: NDArray[Any] = np.zeros(2 * capacity, POINT)
        self.touching: NDArray[np.int64] = np.zeros(capacity, np.int64)
        self.scalar: NDArray[np.int64] = np.zeros(capacity, np.int64)
        self.proximity: NDArray[np.uint32] = np.zeros(2 * capacity, np.uint32)
        self.activation_distance: NDArray[np.float64] = np.zeros(capacity)
        self.rotations: NDArray[np.float64] = np.zeros((0, 3))
        self.noted: NDArray[np.float64] = np.zeros((0, 4))
        self.linear_before: NDArray[np.float64] = np.zeros((0, 2))
        self.angular_before: NDArray[np.float64] = np.zeros(0)
        self.moments: NDArray[np.float64] = np.zeros((0, 7))
        self.apart: NDArray[Any] = np.zeros(0, APART)
        self.constraints: NDArray[Any] = np.zeros(0, CONSTRAINT)
        self.constraint_points: NDArray[Any] = np.zeros(0, CONSTRAINT_POINT)
        self.travels: NDArray[np.float64] = np.zeros((5, 0))
        self.stirred: NDArray[np.int64] = np.zeros(0, np.int64)
        self.table: NDArray[np.int64] = np.zeros(16, np.int64)
        self.sleeping: NDArray[np.int64] = np.zeros(capacity, np.int64)
        # Two sets of arrays take turns: new ones for every list would cost more in page faults than all else.
        self.spare_manifolds, self.spare_points = self.manifolds.copy(), self.points.copy()

    @property
    def candidate_pairs(self) -> int:
        """How many pairs are near each other."""
        return int(self.recorded + self.proximity_count)

    @property
    def count(self) -> int:
        """How many near pairs have points; until they are listed again, how many did before."""
        self.fetch()
        if self.stale:
            self.sync()
            return int(np.count_nonzero(self.manifolds["count"][: self.recorded]))
        return int(self.active + self.wide.filled + self.sleeping_count)

    def fetch(self) -> None:
        """Take the pairs from where they are found, if that is elsewhere."""
        source, self.source = self.source, None
        if source is not None:
            source()

    def changed(self) -> None:
        """Note that slots are newer than their records."""
        self._synced = not self.wide.filled

    def sync(self) -> None:
        """Write slots into the records of their pairs, if they are newer."""
        self.fetch()
        if not self._synced:
            for constraints in self.wide.kinds:
                slots.store(constraints.slots, constraints.count, self.manifolds, self.points)
            self._synced = True

    def dissolve(self, rows: int) -> None:
        """Write every slot to its record and empty it, in a world of so many rows."""
        if self.wide.filled:
            self.sync()
            self.manifolds["slot"] = -1
            self.list_scalar(rows)
        self.wide.reset(rows)

    def forget(self, bodies: NDArray[np.int64], rows: int) -> None:
        """Drop the points of some bodies (n,) that are elsewhere now, in a world of so many ``rows``."""
        self.dissolve(rows)
        near = self.manifolds[: self.recorded]
        touched = np.isin(near["a"], bodies) | np.isin(near["b"], bodies)
        for name in ("count", "found", "swept"):
            near[name][touched] = 0
        of_points = np.repeat(touched, 2)
        for name in ("feature", "ahead", "normal_impulse", "tangent_impulse"):
            self.points[name][: len(of_points)][of_points] = 0
        self._list_touching(rows)

    def _list_touching(self, rows: int) -> None:
        """Find which pairs are scalar, which of these have points, and which are inactive."""
        self.list_scalar(rows)
        scalar = self.scalar[: self.scalar_count]
        touching = scalar[self.manifolds["count"][scalar] > 0]
        self.active = len(touching)
        self.touching[: self.active] = touching

    def in_order(self, rows: int) -> None:
        """Sort the scalar pairs, where some were added since: a file keeps no other order."""
        if self.unordered:
            near_pairs.sort_scalar(self.manifolds, self.scalar, self.scalar_count, rows)
            self.unordered = 0

    def list_scalar(self, rows: int) -> None:
        """Find which pairs are scalar and which are inactive."""
        self.scalar_count, self.sleeping_count = direct_entry(slots.list_scalar)(
            self.manifolds, self.recorded, self.inactive, self.scalar, self.sleeping
        )
        self.unordered = 1
        self.in_order(rows)

    def set_inactive(self, inactive: NDArray[np.bool_], rows: int) -> None:
        """Leave out the pairs of which both bodies are ``inactive`` (rows,), and take in all others."""
        self.inactive = inactive
        self.replaced += 1
        found = self.manifolds["found"]
        found[found == AS_FOUND] = 0  # the effective masses are others
        if not self.stale:  # else this is done when they are listed
            self._list_touching(rows)

    def release(self, asleep: NDArray[np.bool_]) -> None:
        """Write the slots of those that are ``asleep`` (rows,) to their records and empty them."""
        if self.wide.filled:
            self.wide.filled -= sum(
                slots.release(constraints.slots, constraints.count, self.manifolds, self.points, asleep)
                for constraints in self.wide.kinds
            )

    def rescale(self, pairs: NDArray[np.bool_], before: float, after: float) -> None:
        """Rescale impulses of ``pairs`` (recorded,) from the time ``before`` [s] to the one ``after``."""
        if before > 0.0 and after > 0.0 and before != after:
            chosen = np.repeat(pairs, 2)
            for name in ("normal_impulse", "tangent_impulse"):
                self.points[name][: len(chosen)][chosen] *= after / before

    def clear(self) -> None:
        """Drop every pair."""
        self.wide.reset(1)
        logged, self.counts[:] = self.logged, 0
        self.logged = logged
        self.stale = self._synced = True
        self.substep_factor = 1

    @property
    def max_penetration(self) -> float:
        """The deepest overlap now [m]."""
        self.fetch()
        compile_kernels((impulse.deepest,))
        pairs = ((self.touching, self.active), (self.sleeping, self.sleeping_count))
        depth = max(float(impulse.deepest(self.manifolds, self.points, *listed)) for listed in pairs)
        constraints = [refresh.deepest_wide(k.kind, k.data, k.count) for k in self.wide.kinds if k.count]
        return max(depth, *constraints) if constraints else depth
