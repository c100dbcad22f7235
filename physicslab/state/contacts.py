"""What is near, what touches, and with what impulse: what the contact systems share."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Material, Shape, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.kernels import compile_kernels
from physicslab.kernels.broad import near_pairs
from physicslab.kernels.records import IMPACT, MANIFOLD, POINT
from physicslab.kernels.solver import impulse
from physicslab.kernels.wide import graph_colour, refresh, restore_slots, slots
from physicslab.kernels.wide.graph_colour import FEW
from physicslab.kernels.wide.layout import WIDE
from physicslab.state.wide_contacts import WideContacts

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["Contact", "ContactPoint", "Contacts"]

_NO_ROWS = ("entity_a", "entity_b", "a", "b", "gap", "slot")
_KEPT = tuple(name for name in MANIFOLD.names or () if name not in _NO_ROWS)
_WARM = ("feature", "normal_impulse", "tangent_impulse")


@dataclass(frozen=True, slots=True)
class ContactPoint:
    """One point of a contact.

    Attributes
    ----------
    position : Vector2
        Where it is [m].
    separation : float
        Distance of the surfaces along the normal [m]; negative where they overlap.
    normal_impulse, tangent_impulse : float
        Impulses that held the bodies apart and against sliding in the last substep [N s], on B; the tangent
        is the normal turned counter-clockwise.
    approach_speed : float
        Speed at which the surfaces met in an impact of the last step [m/s]; 0 if there was none.
    impact_normal, impact_tangent : float
        Impulses of the impacts of the last step [N s], on B.
    """

    position: Vector2
    separation: float
    normal_impulse: float
    tangent_impulse: float
    approach_speed: float
    impact_normal: float
    impact_tangent: float


@dataclass(frozen=True, slots=True)
class Contact:
    """A pair that touches, would within a substep, or met in the last step.

    Attributes
    ----------
    a, b : int
        The entities; 0 for the world's bounds.
    normal : Vector2
        Unit vector from A to B.
    restitution, friction : float
        Of the pair.
    points : tuple of ContactPoint
        One or two; where an impact of the last step has ended, where it was.
    """

    a: int
    b: int
    normal: Vector2
    restitution: float
    friction: float
    points: tuple[ContactPoint, ...]

    @property
    def depth(self) -> float:
        """The deepest overlap [m], positive; negative where they are still apart."""
        return max(-point.separation for point in self.points)


class Contacts:
    """The near pairs of one world, those that may touch with a record, and which of them do.

    Attributes
    ----------
    manifolds : array of MANIFOLD (capacity,)
        One for each near pair that has a record; the first ``recorded`` are in use. Those that were listed
        together are in order; those that have got their records since stand behind them.
    points : array of POINT (2 capacity,)
        Points 2 p and 2 p + 1 belong to pair p; the first ``manifolds[p]["count"]`` are in use.
    proximity : uint32 array (2 capacity,)
        Rows of the discs that are near each other and have no record, two by two; the first
        ``proximity_count`` pairs are in use.
    activation_distance : float64 array (capacity,)
        How near these must come to get one [m].
    blocks : Blocks
        The settled contacts, eight side by side; what their records say is as old as the last :meth:`sync`.
    scalar : int64 array (capacity,)
        The pairs with records that are in no block and not laid aside; the first ``scalar_count`` are in use.
    sleeping : int64 array (capacity,)
        The pairs with points that were laid aside because both bodies sleep, or one does and nothing moves
        the other; the first ``sleeping_count`` are in use.
    inactive : bool array (rows,)
        Whose pairs with each other are laid aside; empty where nobody sleeps.
    unordered : bool
        Whether pairs were set loose since those were last listed in order.
    touching : int64 array (capacity,)
        The loose pairs with points; the first ``active`` are in use. Points may have positive separation:
        they would meet within a substep.
    recorded, proximity_count, count : int
        How many near pairs have records, how many lie idle, and how many have points, wherever they lie.
    left : int
        How many pairs the impacts of this substep have left to the solver.
    opened : int64 array (COLOURS,)
        Room in which blocks with free lanes are noted.
    impulse_dt : float
        The time [s] that the points' impulses stand for; 0 before there were any.
    substep_factor : int
        How many times as many substeps as asked for the coming step needs.
    stale : bool
        Whether the pairs must be found anew because bodies came, went or changed.
    log : array of IMPACT
        The last impacts whose times were located; number n stands at n modulo the length.
    logged : int
        How many impacts were ever logged.
    """

    LOGGED = 32_768
    """How many impacts are kept."""

    def __init__(self) -> None:
        self.recorded = self.proximity_count = self.scalar_count = self.sleeping_count = 0
        self.active = self.left = 0
        self.wide = WideContacts()
        self.inactive: NDArray[np.bool_] = np.zeros(0, np.bool_)
        self.opened = np.zeros(slots.COLOURS, np.int64)
        self._counts = np.zeros(slots.COUNTED, np.int64)
        self._synced, self._restoring = True, False
        self.unordered = False
        self.impulse_dt, self.substep_factor = 0.0, 1
        self.stale = True
        self.log: NDArray[Any] = np.zeros(self.LOGGED, IMPACT)
        self.logged = 0
        self._fit(64)

    @property
    def impacts(self) -> NDArray[Any]:
        """The last impacts whose times were located, in order: an array of IMPACT.

        They are ``LOGGED`` at the most. Only flying bodies have such impacts (``"collisions": "exact"``);
        those found within steps are not among them.
        """
        if self.logged <= len(self.log):
            return self.log[: self.logged].copy()
        return np.roll(self.log, -self.logged % len(self.log))

    def _fit(self, capacity: int) -> None:
        self.manifolds: NDArray[Any] = np.zeros(capacity, MANIFOLD)
        self.points: NDArray[Any] = np.zeros(2 * capacity, POINT)
        self.touching: NDArray[np.int64] = np.zeros(capacity, np.int64)
        self.scalar: NDArray[np.int64] = np.zeros(capacity, np.int64)
        self.proximity: NDArray[np.uint32] = np.zeros(2 * capacity, np.uint32)
        self.activation_distance: NDArray[np.float64] = np.zeros(capacity)
        self._table: NDArray[np.int64] = np.zeros(16, np.int64)
        self.sleeping: NDArray[np.int64] = np.zeros(capacity, np.int64)
        # Two sets of arrays take turns: new ones for every list would cost more in page faults than all else.
        self._spare_manifolds, self._spare_points = self.manifolds.copy(), self.points.copy()

    @property
    def candidate_pairs(self) -> int:
        """How many pairs are near each other."""
        return self.recorded + self.proximity_count

    @property
    def count(self) -> int:
        """How many near pairs have points."""
        return self.active + self.wide.filled + self.sleeping_count

    def changed(self) -> None:
        """Note that lanes hold what their records do not say."""
        self._synced = not self.wide.filled

    def sync(self) -> None:
        """Write what lanes hold into the records of their pairs, if that is not there already."""
        if not self._synced:
            for constraints in self.wide.kinds:
                slots.store(
                    constraints.data,
                    constraints.rows,
                    constraints.count,
                    constraints.pair,
                    self.manifolds,
                    self.points,
                )
            self._synced = True

    def dissolve(self, rows: int) -> None:
        """Give every contact back to its record, in a world of so many rows."""
        if self.wide.filled:
            self.sync()
            self.manifolds["slot"] = -1
            self._list_scalar(rows)
        self.wide.reset(rows)

    def in_order(self, rows: int) -> None:
        """Put the loose pairs in order, where some were set loose since: a file tells no other order."""
        if self.unordered:
            near_pairs.sort_scalar(self.manifolds, self.scalar, self.scalar_count, rows)
            self.unordered = False

    def _list_scalar(self, rows: int) -> None:
        self.scalar_count, self.sleeping_count = slots.list_scalar(
            self.manifolds, self.recorded, self.inactive, self.scalar, self.sleeping
        )
        self.unordered = True
        self.in_order(rows)

    def set_inactive(self, inactive: NDArray[np.bool_], rows: int) -> None:
        """Leave out the pairs of which both bodies are ``inactive`` (rows,), and take in all others."""
        self.inactive = inactive
        if not self.stale:  # else that is done when they are listed
            self._list_scalar(rows)
            scalar = self.scalar[: self.scalar_count]
            touching = scalar[self.manifolds["count"][scalar] > 0]
            self.active = len(touching)
            self.touching[: self.active] = touching

    def release(self, asleep: NDArray[np.bool_]) -> None:
        """Give the contacts of sleepers back to their records."""
        if self.wide.filled:
            self.wide.filled -= sum(
                slots.release(*constraints.layout, self.manifolds, self.points, asleep)
                for constraints in self.wide.kinds
            )

    def rescale(self, pairs: NDArray[np.bool_], before: float, after: float) -> None:
        """Let the impulses of some pairs stand for another time [s] than ``before``."""
        if before > 0.0 and after > 0.0 and before != after:
            chosen = np.repeat(pairs, 2)
            for name in ("normal_impulse", "tangent_impulse"):
                self.points[name][: len(chosen)][chosen] *= after / before

    def add_constraints(self, world: World, h: float) -> None:
        """Take what has settled into blocks."""
        blocks, bodies, material, shape = self.wide, world.bodies, world.table(Material), world.table(Shape)
        if not blocks.filled and self.active < FEW:
            return
        world.schedule.compile(blocks.kernels)
        known = blocks.filled > 0
        while True:
            counts = self.counted()
            came = graph_colour.add_constraints(
                counts, blocks.discs.slots, blocks.boxes.slots, self.opened,
                self.manifolds, self.points, self.scalar, self.sleeping, self.touching,
                self.inactive, world.sleep.asleep,
                shape["kind"], shape["radius"], material["restitution"], material["friction"],
                world.table(Velocity)["linear"], bodies.awake_inverse_mass, bodies.awake_inverse_inertia, h,
            )  # fmt: skip
            self.recount(counts)
            if came != graph_colour.FULL:
                break
            for constraints in blocks.kinds:
                constraints.make_room(constraints.count + self.active // WIDE + slots.COLOURS)
        if came == graph_colour.SPARSE:
            self.dissolve(len(world.entity_index))
        if blocks.filled and not known:
            blocks.remember(world)

    def counted(self) -> NDArray[np.int64]:
        """Return the counts that kernels change, in the order of :mod:`physicslab.kernels.wide.slots`."""
        discs, boxes = self.wide.kinds
        self._counts[:] = (
            self.proximity_count, self.recorded, self.scalar_count, self.sleeping_count, self.active,
            self.left,
            self.wide.filled, discs.count, boxes.count, self.unordered,
        )  # fmt: skip
        return self._counts

    def recount(self, counts: NDArray[np.int64]) -> None:
        """Take over the counts that a kernel has changed."""
        discs, boxes = self.wide.kinds
        (
            self.proximity_count, self.recorded, self.scalar_count, self.sleeping_count, self.active,
            self.left,
            self.wide.filled, discs.count, boxes.count, unordered,
        ) = counts.tolist()  # fmt: skip
        self.unordered = bool(unordered)

    def partition(
        self, world: World, couples: NDArray[np.uint32], found: int, pairs: NDArray[np.int64], walls: int
    ) -> None:
        """Take a new list of near pairs: ``found`` of bodies, in no order, and ``walls`` of the bounds.

        Pairs of discs of which nothing is remembered lie idle until they come near.
        """
        self._make_table()
        if len(self.activation_distance) < found:
            self.proximity, self.activation_distance = np.zeros(4 * found, np.uint32), np.zeros(2 * found)
        shape = world.table(Shape)
        count, self.proximity_count = near_pairs.partition(
            couples, found, pairs, walls, shape["kind"], shape["radius"], world.bodies.inverse_mass,
            world.entity_index.entities, self.manifolds, self.recorded, self.stale, self._table,
            self.proximity, self.activation_distance,
        )  # fmt: skip
        self._relist(world, pairs, count, noted=True)

    def activate(self, world: World, h: float, speculative_margin: float) -> None:
        """Give records to the idle pairs that come near within a substep of ``h`` seconds.

        ``speculative_margin`` is how far [m] the forces may bring two bodies together within it.
        """
        self.proximity_count, self.recorded, self.scalar_count = near_pairs.activate(
            self.proximity, self.activation_distance, self.proximity_count, self.manifolds, self.points,
            self.recorded,
            self.scalar, self.scalar_count, world.entity_index.entities,
            world.table(Transform)["position"], world.table(Velocity)["linear"], h, speculative_margin,
        )  # fmt: skip

    def _make_table(self) -> None:
        """See to it that there is room to look up every record."""
        if len(self._table) < 4 * self.recorded:
            self._table = np.zeros(8 * self.recorded, np.int64)

    def relist(self, world: World, pairs: NDArray[np.int64], count: int) -> None:
        """Take a new sorted list of ``count`` near pairs (a, b, wall), each with its record.

        Pairs known before stay as they are. What touches is still to be found out.
        """
        self._make_table()
        self.proximity_count = 0
        self._relist(world, pairs, count, noted=False)

    def _relist(self, world: World, pairs: NDArray[np.int64], count: int, *, noted: bool) -> None:
        entities = world.entity_index.entities
        if self.stale:
            self.sync()
            # Rows may be others now: what had a lane takes its seat again.
            self._restoring |= self.wide.filled > 0
            self.wide.reset(len(entities))
        most = count + self.proximity_count
        if len(self._spare_manifolds) < most:
            room = most + most // 4  # a record takes 400 bytes, and there are two sets of them
            self._spare_manifolds, self._spare_points = np.zeros(room, MANIFOLD), np.zeros(2 * room, POINT)
        near_pairs.carry_over(
            pairs, count, entities, self.manifolds, self.points, self.recorded, self._table, noted,
            self._spare_manifolds, self._spare_points,
        )  # fmt: skip
        self.manifolds, self._spare_manifolds = self._spare_manifolds, self.manifolds
        self.points, self._spare_points = self._spare_points, self.points
        self.recorded, self.active, self.stale = count, 0, False
        if len(self.touching) < most:
            self.touching, self.scalar, self.sleeping = np.zeros((3, most + most // 4), np.int64)
        if self._restoring:
            self._restore_slots(world)
        elif self.wide.filled:
            self.wide.filled = sum(
                slots.follow_pairs(*constraints.layout, self.manifolds, count)
                for constraints in self.wide.kinds
            )
        self._list_scalar(len(entities))

    def refill(self, world: World) -> None:
        """Let lanes hold masses, sizes and materials as they are now, if somebody has changed one of them."""
        if self.wide.filled and self.wide.outdated(world):
            rows = len(world.entity_index)
            self.sync()
            self.wide.reset(rows)
            self._restore_slots(world)
            self._list_scalar(rows)

    def _restore_slots(self, world: World) -> None:
        """Put the contacts whose records name a lane, as those of a file do, back into that."""
        self._restoring, material = False, world.table(Material)
        near, asleep = self.manifolds[: self.recorded], world.sleep.asleep
        near["slot"][asleep[near["a"]] | asleep[near["b"]]] = -1  # sleepers have none
        world.schedule.compile(self.wide.kernels)
        for constraints in self.wide.kinds:
            constraints.count, restored = restore_slots.restore_slots(
                constraints.kind, constraints.data, constraints.a, constraints.b, constraints.pair,
                constraints.colour, constraints.used,
                self.manifolds, self.points, self.recorded,
                world.table(Shape)["kind"], world.table(Shape)["radius"],
                material["restitution"], material["friction"],
                world.bodies.inverse_mass, world.bodies.inverse_inertia,
            )  # fmt: skip
            constraints.sort()
            self.wide.filled += restored
        self.wide.remember(world)

    def clear(self) -> None:
        """Forget every pair."""
        self.wide.reset(1)
        self.recorded = self.proximity_count = self.scalar_count = self.sleeping_count = self.active = 0
        self.stale = self._synced = True
        self.substep_factor = 1

    @property
    def max_penetration(self) -> float:
        """The deepest overlap now [m]."""
        compile_kernels((impulse.deepest,))
        pairs = ((self.touching, self.active), (self.sleeping, self.sleeping_count))
        depth = max(float(impulse.deepest(self.manifolds, self.points, *listed)) for listed in pairs)
        constraints = [refresh.deepest_wide(k.kind, k.data, k.count) for k in self.wide.kinds if k.count]
        return max(depth, *constraints) if constraints else depth

    def listed(self, world: World) -> tuple[Contact, ...]:
        """Return every contact and every impact of the last step, in the order of entities."""
        return tuple(self._describe(world, p) for p in self._reported())

    def _reported(self) -> list[int]:
        self.sync()
        near = self.manifolds[: self.recorded]
        reported = (near["count"] > 0) | (near["impact_count"] > 0)
        return [p for p in self._ordered() if reported[p]]

    def _ordered(self) -> list[int]:
        """Return the numbers of all records in the order of entities."""
        near = self.manifolds[: self.recorded]
        pairs: list[int] = np.lexsort((near["wall"], near["entity_b"], near["entity_a"])).tolist()
        return pairs

    def between(self, world: World, a: int, b: int) -> Contact | None:
        """Return the contact of two entities, seen as A and B in the order given, or ``None``."""
        for p in self._reported():
            manifold = self.manifolds[p]
            pair = int(manifold["entity_a"]), int(manifold["entity_b"])
            if pair == (a, b):
                return self._describe(world, p)
            if pair == (b, a):
                seen = self._describe(world, p)
                # Seen from the other side, normal and tangent turn round, and so do the impulses on B: the
                # numbers stay.
                return replace(seen, a=a, b=b, normal=-seen.normal)
        return None

    def _describe(self, world: World, p: int) -> Contact:
        manifold = self.manifolds[p]
        centre = Vector2(*world.table(Transform)["position"][manifold["b"]].tolist())
        points = tuple(
            ContactPoint(
                centre + Vector2(float(point["arm_bx"]), float(point["arm_by"])),
                *(
                    float(point[name])
                    for name in (
                        "separation", "normal_impulse", "tangent_impulse",
                        "approach_speed", "impact_normal", "impact_tangent",
                    )
                ),
            )
            for k, point in enumerate(self.points[2 * p : 2 * p + 2])
            if k < manifold["count"] or point["impact_normal"] > 0.0
        )  # fmt: skip
        return Contact(
            int(manifold["entity_a"]), int(manifold["entity_b"]),
            Vector2(float(manifold["normal_x"]), float(manifold["normal_y"])),
            float(manifold["restitution"]), float(manifold["friction"]), points,
        )  # fmt: skip

    def copied(self) -> Contacts:
        """Return what :meth:`remembered` needs, in copies that no step changes."""
        self.sync()
        held = Contacts.__new__(Contacts)
        held.recorded, held.impulse_dt, held.substep_factor = (
            self.recorded,
            self.impulse_dt,
            self.substep_factor,
        )
        held.manifolds = self.manifolds[: self.recorded].copy()
        held.points = self.points[: 2 * self.recorded].copy()
        held.wide = WideContacts()
        for mine, copy in zip(self.wide.kinds, held.wide.kinds, strict=True):
            copy.colour = mine.colour.copy()
        return held

    def remembered(self) -> Iterator[list[float] | None]:
        """Yield what the next step takes from the last one, as rows of numbers that JSON can hold.

        A row starts with the two entities (0 for the world's bounds) and the wall. Points that will be found
        anew leave their features and impulses; those that will be kept, everything; ``None`` stands for a
        pair of which nothing is kept. A settled contact adds its lane, and the colour of its block; one that
        will strike in the next substep, which of its points do: 1, 2, or 3 for both.
        """
        for p in self._ordered():
            manifold = self.manifolds[p]
            pair = [int(manifold["entity_a"]), int(manifold["entity_b"]), int(manifold["wall"])]
            slot = int(manifold["slot"])
            fill_slot = [slot, int(self.wide.kinds[slot % 2].colour[slot // 2 // WIDE])] if slot >= 0 else []
            if manifold["count"] <= 0:
                yield None
            elif manifold["found"] == 2:
                kept = [manifold[name].item() for name in _KEPT[1:]]
                both = [value for j in (2 * p, 2 * p + 1) for value in self.points[j].item()]
                yield [*pair, *kept, *both, *fill_slot]
            else:
                warm = [self.points[j][name].item() for j in (2 * p, 2 * p + 1) for name in _WARM]
                ahead = int(self.points[2 * p]["ahead"] + 2 * self.points[2 * p + 1]["ahead"])
                rest = fill_slot or ([ahead] if ahead else [])
                yield [*pair, *warm, *rest] if rest or any(warm[1:3] + warm[4:]) else None

    def export(self) -> list[list[float]]:
        """Return all that is :meth:`remembered`."""
        self.sync()
        return [row for row in self.remembered() if row is not None]

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
            if len(row) not in (light, heavy, light + 1, light + 2, heavy + 2):
                raise ValueError(f"a contact has {light} or {heavy} values, or two more, not {len(row)}")
            if len(row) == light + 1 and row[-1] not in (1, 2, 3):
                raise ValueError(f"points that strike next: {row[-1]!r}: must be 1, 2 or 3")
            manifold = self.manifolds[p]
            manifold["slot"] = self._take_slot(*row[-2:]) if len(row) in (light + 2, heavy + 2) else -1
            manifold["entity_a"], manifold["entity_b"], manifold["wall"] = row[:3]
            if len(row) >= heavy:
                for name, value in zip(_KEPT[1:], row[3:], strict=False):
                    manifold[name] = value
                values = iter(row[2 + len(_KEPT) :])
                names: Sequence[str] = POINT.names or ()
            else:
                manifold["count"] = 1  # it had points: if it has none now, their impulses are forgotten
                values, names = iter(row[3:]), _WARM
            for j in (2 * p, 2 * p + 1):
                for name in names:
                    self.points[j][name] = next(values)
            if len(row) == light + 1:
                self.points["ahead"][2 * p : 2 * p + 2] = int(row[-1]) & 1, int(row[-1]) >> 1
        self.recorded, self.proximity_count, self.active, self.stale = len(ordered), 0, 0, True

    def _take_slot(self, slot: float, colour: float) -> int:
        """Note that a lane is that of a contact that will be found again, in a block of a colour."""
        if not (slot == int(slot) and slot >= 0):
            raise ValueError(f"a lane of {slot!r}: must be a whole number >= 0")
        if not (colour == int(colour) and 0 <= colour < slots.COLOURS):
            raise ValueError(f"a colour of {colour!r}: must be a whole number from 0 to 63")
        constraints, block = self.wide.kinds[int(slot) % 2], int(slot) // 2 // WIDE
        if block > 2 * len(self.manifolds) + 1024:  # no world has so many: memory is not to hang on a file
            return -1
        constraints.make_room(block + 1)
        constraints.colour[block] = int(colour)
        self._restoring = True
        return int(slot)
