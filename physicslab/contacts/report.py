"""Contacts as people and programs read them: normal, points, impulses."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform, Velocity
from physicslab.contacts.islands import impulse_spans
from physicslab.contacts.outlines import outlines_of
from physicslab.ecs.vector import Vector2
from physicslab.state.contacts import Contacts
from physicslab.state.solid import is_any_apart, may_touch, solid_rows
from physicslab.state.state import State


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
    normal_force, tangent_force : float
        The forces that these impulses come to [N], on B; impacts left out. Those of rigid contacts keep
        the laws to rounding.
    """

    position: Vector2
    separation: float
    normal_impulse: float
    tangent_impulse: float
    approach_speed: float
    impact_normal: float
    impact_tangent: float
    normal_force: float
    tangent_force: float


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
        Coefficients of the pair.
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


def list_contacts(state: State) -> tuple[Contact, ...]:
    """Return every contact and every pair with an impact of the last step, in the order of entities."""
    return tuple(_describe(state, p) for p in _reported(state.contacts))


def contacts_of(state: State, entity: int) -> tuple[Contact, ...]:
    """Return every contact of one entity, in the order of entities."""
    reported = np.array(_reported(state.contacts), np.int64)
    near = state.contacts.manifolds[reported]
    of_it = (near["entity_a"] == entity) | (near["entity_b"] == entity)
    return tuple(_describe(state, p) for p in reported[of_it].tolist())


def contact_between(state: State, a: int, b: int) -> Contact | None:
    """Return the contact of two entities, as A and B in the order given, or ``None``."""
    seen = next((one for one in contacts_of(state, a) if {one.a, one.b} == {a, b}), None)
    if seen is None or seen.a == a:
        return seen
    # From the other side, normal and tangent are reversed, and so are the impulses on B: the numbers stay.
    return replace(seen, a=a, b=b, normal=-seen.normal)


_GROWN = 0.1
"""Share of its size by which the box around a body is grown where pairs are called near."""
_LARGE = 4.0
"""Extent in medians from which on a body is compared with all others; the others are in strips."""


def count_near_pairs(state: State) -> int:
    """Return how many pairs of bodies, of which one moves, are near enough to meet within a step or so.

    The boxes around them overlap, each grown by a tenth of its body's size and the way of a step. This
    depends on the present motion alone: the pairs that the broad phase has listed depend on when it did so.
    """
    rows, velocity = solid_rows(state), state.table(Velocity)
    bodies, moves = outlines_of(state, rows), state.bodies.inverse_mass[rows] > 0.0
    speed = np.where(velocity.present[rows, None], np.abs(velocity["linear"][rows]), 0.0)
    reach = bodies.reach + _GROWN * bodies.size[:, None] + speed * state.simulation.dt
    low, high = bodies.place - reach, bodies.place + reach
    found, extent = 0, reach.max(axis=1, initial=0.0)
    if state.physics.bounds is not None:
        bounds = np.array(state.physics.bounds)
        found += int((low[moves] <= bounds[:2]).sum() + (high[moves] >= bounds[2:]).sum())

    def count(a: NDArray[np.int64], b: NDArray[np.int64]) -> int:
        near = ((low[a] <= high[b]) & (low[b] <= high[a])).all(axis=1) & (moves[a] | moves[b])
        if is_any_apart(state):
            near &= may_touch(state, rows[a], rows[b])
        return int(near.sum())

    large = extent > _LARGE * np.median(extent) if len(rows) else extent > 0.0
    for k in np.flatnonzero(large).tolist():
        others = np.flatnonzero(~large | (np.arange(len(rows)) > k))
        found += count(np.full(len(others), k), others)
    small = np.flatnonzero(~large)
    for a, b in _neighbours(low[small], high[small]) if len(small) > 1 else ():
        found += count(small[a], small[b])
    return found


def _neighbours(low: NDArray[np.float64], high: NDArray[np.float64]) -> Iterator[tuple[Any, Any]]:
    """Yield pairs of boxes (n, 2) among which all are that overlap, each once: two arrays of numbers (k,).

    Boxes are in the strip that holds their lower edges, as high as the highest of them: each may overlap
    those of its own and of the next strip.
    """
    width, height = (high - low).max(axis=0)
    strips, row = np.unique(np.floor((low[:, 1] - low[:, 1].min()) / height), return_inverse=True)
    strip = np.cumsum(np.minimum(np.diff(strips, prepend=strips[0]), 2.0))[row]  # no two far ones in turn
    across = 2.0 * (high[:, 0].max() - low[:, 0].min())  # the next strip begins so far to the right
    left = strip * across + low[:, 0]
    order = np.argsort(left, kind="stable")
    begins = left[order]
    ends = begins + (high - low)[order, 0]
    own = np.arange(len(order)), np.arange(1, len(order) + 1), np.searchsorted(begins, ends, side="right")
    first = np.searchsorted(begins, begins + across - width)
    above = own[0], first, np.searchsorted(begins, ends + across, side="right")
    for one, start, stop in (own, above):
        number = np.maximum(stop - start, 0)
        other = np.arange(number.sum()) + np.repeat(start - np.cumsum(number) + number, number)
        yield order[np.repeat(one, number)], order[other]


def ordered_records(contacts: Contacts) -> list[int]:
    """Return the numbers of all records in the order of entities."""
    contacts.fetch()
    near = contacts.manifolds[: contacts.recorded]
    pairs: list[int] = np.lexsort((near["wall"], near["entity_b"], near["entity_a"])).tolist()
    return pairs


def _reported(contacts: Contacts) -> list[int]:
    contacts.sync()
    near = contacts.manifolds[: contacts.recorded]
    reported = (near["count"] > 0) | (near["impact_count"] > 0)
    order = np.array(ordered_records(contacts), np.int64)
    shown: list[int] = order[reported[order]].tolist()
    return shown


def _describe(state: State, p: int) -> Contact:
    manifold = state.contacts.manifolds[p]
    centre = Vector2(*state.table(Transform)["position"][manifold["b"]].tolist())
    span = float(impulse_spans(state, np.array([p]))[0])
    rate = 1.0 / span if span > 0.0 else 0.0
    points = tuple(
        _describe_point(point, centre, rate)
        for k, point in enumerate(state.contacts.points[2 * p : 2 * p + 2])
        if k < manifold["count"] or point["impact_normal"] > 0.0
    )
    return Contact(
        int(manifold["entity_a"]), int(manifold["entity_b"]),
        Vector2(float(manifold["normal_x"]), float(manifold["normal_y"])),
        float(manifold["restitution"]), float(manifold["friction"]), points,
    )  # fmt: skip


def _describe_point(point: Any, centre: Vector2, rate: float) -> ContactPoint:
    """Return a point, of which impulses times ``rate`` [1/s] are forces."""
    names = (
        "separation", "normal_impulse", "tangent_impulse", "approach_speed", "impact_normal", "impact_tangent"
    )  # fmt: skip
    separation, normal, tangent, approach, impact_normal, impact_tangent = (float(point[n]) for n in names)
    return ContactPoint(
        centre + Vector2(float(point["arm_bx"]), float(point["arm_by"])),
        separation, normal, tangent, approach, impact_normal, impact_tangent, rate * normal, rate * tangent,
    )  # fmt: skip


_GROWS_FROM = 0.25
"""Share of the log that is filled between two readings from which on it is doubled."""
_MAX_RING = 1_600_000
"""Largest number of impacts in the log."""
_BLOCK = 65_536
"""Impacts that are read at a time."""


class ImpactReader:
    """Reads each impact of a world once.

    The log of a world (``Contacts.log``) holds the last impacts, and ``Contacts.logged`` is how many there
    were: what has a higher number than at the last call is new, however many steps were made meanwhile.

    Parameters
    ----------
    state : State, optional
        The world whose next impact is the first, if they are logged (``Contacts.read``).

    Attributes
    ----------
    lost : int
        How many were overwritten in the log before :meth:`blocks` could read them.
    """

    def __init__(self, state: State | None = None) -> None:
        self._state, self._next, self.lost = state, 0, 0
        self.skip()

    def skip(self) -> None:
        """Begin with those that come."""
        if self._state is not None:
            self._next = int(self._state.contacts.logged)

    def follow(self, state: State) -> None:
        """Begin with the next impact of ``state``, unless it is the world that is read already."""
        if state is not self._state:
            self._state, state.contacts.read = state, True
            self.skip()

    def new(self, state: State) -> NDArray[Any]:
        """Return the impacts since the last call, oldest first: an array of IMPACT (n,).

        If there were more than the log holds, the oldest are missing.
        """
        self.follow(state)
        new = state.contacts.impacts_since(self._next)
        self.skip()
        return new

    def blocks(self, state: State) -> Iterator[NDArray[Any]]:
        """Yield the impacts since the last call, arrays of IMPACT (n,) in the order of the log.

        The log is doubled where it fills up fast.
        """
        contacts = state.contacts
        logged, ring = int(contacts.logged), len(contacts.log)
        new = logged - self._next
        if new <= 0:
            return
        oldest = max(self._next, contacts.first_logged)
        self.lost += oldest - self._next
        for first in range(oldest, logged, _BLOCK):
            yield contacts.impacts_since(first, _BLOCK)
        self._next = logged
        if new > _GROWS_FROM * ring and ring < _MAX_RING:
            contacts.lengthen_log(2 * ring)
