"""Contacts and sleep that the next step takes from the last ones, as copies of records and columns.

A scene file keeps the same as rows of numbers (:mod:`physicslab.contacts.memory`, and ``export_rests`` of
:mod:`physicslab.contacts.islands`). Here records are whole, so that what is read of contacts is right at
once.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.contacts.islands import set_inactive
from physicslab.kernels import near_counts
from physicslab.state.contacts import Contacts
from physicslab.state.sleep import Sleep
from physicslab.state.state import State

type _Array = NDArray[Any]

_LISTED_AGAIN = np.array([
    near_counts.PROXIMITY, near_counts.SCALAR, near_counts.SLEEPING, near_counts.ACTIVE, near_counts.LEFT,
    near_counts.WIDE_COUNT, near_counts.DISC_BLOCKS, near_counts.BOX_BLOCKS, near_counts.UNORDERED,
])  # fmt: skip
"""The counts that are found when pairs are listed."""
_SMALL = 1 << 15
"""Size [bytes] up to which arrays are compared sooner by copies than by what numpy needs for a comparison."""
_OF_ALL, _OF_SLEEPERS = ("rest", "slowest"), ("asleep", "forces", "kept", "known")


def shared(columns: Iterable[_Array], known: Sequence[_Array] | None) -> tuple[_Array, ...]:
    """Return copies of columns of any shapes, or those of ``known`` with the same bits in their place."""
    if known is None:
        return tuple(column.copy() for column in columns)
    return tuple(
        old if _same(column, old) else column.copy() for column, old in zip(columns, known, strict=True)
    )


def _same(one: _Array, other: _Array) -> bool:
    """Whether two arrays have the same bits."""
    if one.shape != other.shape or not one.flags.c_contiguous:
        return False
    if one.nbytes <= _SMALL:
        return one.tobytes() == other.tobytes()
    word = np.uint64 if one.dtype.itemsize % 8 == 0 else np.uint8
    a, b = one.reshape(-1).view(word), other.reshape(-1).view(word)
    some = max(1, len(a) // 50)  # as a rule a few words show that they are not
    return bool((a[::some] == b[::some]).all() and (a == b).all())


@dataclass(frozen=True, slots=True, eq=False)
class KeptContacts:
    """The records of pairs that touch, or have had an impact in the last step, and which slots they have.

    Attributes
    ----------
    manifolds, points : arrays of MANIFOLD (n,), POINT (n, 2)
        In the order of entities.
    colours : two int64 arrays (blocks,)
        The colours of the blocks of wide contacts, of discs and of boxes.
    counts : int64 array (COUNTED,)
        Those of the world.
    impulse_dt, substep_factor : float, int
        The time [s] over which impulses act; how much finer the next step is.
    """

    manifolds: _Array
    points: _Array
    colours: tuple[_Array, ...]
    counts: _Array
    impulse_dt: float
    substep_factor: int

    @classmethod
    def of(cls, contacts: Contacts, last: KeptContacts | None = None) -> KeptContacts:
        """Return those of now; arrays that are the same in the ``last`` are shared with it."""
        contacts.sync()
        near = contacts.manifolds[: contacts.recorded]
        # A record that no list of pairs would carry over from an older one has no contents.
        kept = np.flatnonzero((near["count"] != 0) | (near["impact_count"] != 0) | (near["slot"] >= 0))
        points, held = contacts.points.reshape(-1, 2), contacts.restoring or contacts.wide.filled > 0
        # Where some are left out this is a copy already, of megabytes.
        fresh = (near[kept], points[kept]) if len(kept) < len(near) else (near.copy(), points[kept])
        if last is not None:
            old = last.manifolds, last.points
            fresh = (
                old[0] if _same(fresh[0], old[0]) else fresh[0],
                old[1] if _same(fresh[1], old[1]) else fresh[1],
            )
        colours = [kind.colour if held else kind.colour[:0] for kind in contacts.wide.kinds]
        rest = shared((*colours, contacts.counts), last.arrays()[2:] if last is not None else None)
        return cls(*fresh, rest[:2], rest[2], contacts.impulse_dt, contacts.substep_factor)

    @classmethod
    def joined(cls, parts: Sequence[KeptContacts], counts: _Array, *, rescaled: bool = True) -> KeptContacts:
        """Return those of several parts of a world, with its ``counts`` (COUNTED,); one at most has slots.

        Impulses act over the time of the first part: others are ``rescaled`` to that.
        """
        spans = [part.impulse_dt for part in parts]
        span = next((span for span in spans if span > 0.0), 0.0)
        points = [part.points.copy() for part in parts]
        for own, before in zip(points, spans if rescaled else (), strict=False):
            for name in ("normal_impulse", "tangent_impulse") if before not in (0.0, span) else ():
                own[name] *= span / before
        manifolds = np.concatenate([part.manifolds for part in parts])
        order = np.lexsort((manifolds["wall"], manifolds["entity_b"], manifolds["entity_a"]))
        colours = max((part.colours for part in parts), key=lambda kinds: sum(map(len, kinds)))
        factor = max(part.substep_factor for part in parts)
        return cls(manifolds[order], np.concatenate(points)[order], colours, counts.copy(), span, factor)

    def among(self, entities: NDArray[np.int64], *, apart: bool) -> KeptContacts:
        """Return those that some entities (n,) have; where these are ``apart`` now, without slots."""
        has = np.isin(self.manifolds["entity_a"], entities) | np.isin(self.manifolds["entity_b"], entities)
        manifolds, colours = self.manifolds[has], self.colours
        if apart:
            manifolds["slot"] = -1
        if not (manifolds["slot"] >= 0).any():
            colours = tuple(colour[:0] for colour in colours)
        rest = self.counts, self.impulse_dt, self.substep_factor
        return KeptContacts(manifolds, self.points[has], colours, *rest)

    def as_contacts(self) -> Contacts:
        """Return contacts that hold copies of them, to be written to a file."""
        held = Contacts()
        held.recorded, held.impulse_dt = len(self.manifolds), self.impulse_dt
        held.substep_factor = self.substep_factor
        held.manifolds, held.points = self.manifolds.copy(), self.points.reshape(-1).copy()
        for kind, colour in zip(held.wide.kinds, self.colours, strict=True):
            kind.colour = colour.copy()
        return held

    def show(self, state: State) -> None:
        """Give them to a state in which others are not found, so that they can be read."""
        self.restore(state)
        contacts = state.contacts
        contacts.manifolds["slot"][: contacts.recorded] = -1
        contacts.restoring = contacts.stale = False
        count = len(self.manifolds)
        if len(contacts.touching) < count:
            contacts.touching, contacts.scalar, contacts.sleeping = np.zeros((3, count), np.int64)
        contacts.set_inactive(contacts.inactive, len(state.entity_index))

    def arrays(self) -> tuple[_Array, ...]:
        """Return every array."""
        return (self.manifolds, self.points, *self.colours, self.counts)

    def restore(self, state: State) -> None:
        """Give them back to a state whose bodies are those of then; its pairs are listed at the next step."""
        contacts, index, n = state.contacts, state.entity_index, len(self.manifolds)
        if len(contacts.manifolds) < n:
            contacts.make_room(n + n // 4)
        contacts.clear()
        contacts.rotations[:] = np.nan
        near = contacts.manifolds[:n]
        if n:
            near[:], contacts.points[: 2 * n] = self.manifolds, self.points.reshape(-1)
        for name, other in (("a", "entity_a"), ("b", "entity_b")) if n else ():
            near[name] = np.maximum(index.rows_of(near[other]), 0)
        contacts.counts[:] = self.counts
        contacts.counts[_LISTED_AGAIN] = 0
        contacts.recorded = n
        for constraints, colour in zip(contacts.wide.kinds, self.colours, strict=True):
            constraints.make_room(len(colour))
            constraints.colour[: len(colour)] = colour
        contacts.restoring = n > 0 and bool((near["slot"] >= 0).any())
        contacts.impulse_dt, contacts.substep_factor = self.impulse_dt, self.substep_factor
        contacts.inactive = np.zeros(0, np.bool_)
        contacts.stale = True


@dataclass(frozen=True, slots=True, eq=False)
class KeptSleep:
    """Which bodies sleep, how, and how long the others have rested.

    Attributes
    ----------
    columns : dict of str to array (rows, ...)
        Columns of :class:`physicslab.state.sleep.Sleep`; where nothing sleeps, those of rest alone.
    gone : int64 array (n,)
        The entities removed since the last check.
    laws : tuple, optional
        The configuration under which bodies fell asleep.
    unverified : bool
        Whether their support must still be checked.
    """

    columns: dict[str, _Array]
    gone: _Array
    laws: tuple[Any, Any] | None
    unverified: bool

    @classmethod
    def of(cls, sleep: Sleep, last: KeptSleep | None = None) -> KeptSleep:
        """Return those of now; arrays that are the same in the ``last`` are shared with it."""
        names = _OF_ALL + (_OF_SLEEPERS if sleep.count else ())
        alike = last is not None and tuple(last.columns) == names
        known = list(last.columns.values()) if last is not None and alike else None
        found = shared([getattr(sleep, name) for name in names], known)
        return cls(dict(zip(names, found, strict=True)), sleep.gone, sleep.laws, sleep.unverified)

    def arrays(self) -> tuple[_Array, ...]:
        """Return every array."""
        return (*self.columns.values(), self.gone)

    def restore(self, state: State, rows: NDArray[np.int64] | None) -> None:
        """Give them back to a state in which nothing sleeps or has rested.

        ``rows`` (rows then,) are those of now; -1 for what is blank, ``None`` where all are the same.
        """
        sleep = state.sleep
        for name, column in self.columns.items():
            now = getattr(sleep, name)
            if rows is None:
                now[1 : len(column)] = column[1:]
            else:
                now[rows[rows >= 0]] = column[rows >= 0]
        sleep.gone, sleep.laws, sleep.unverified = self.gone, self.laws, self.unverified
        sleep.count = int(np.count_nonzero(sleep.asleep))
        if sleep.count:
            set_inactive(state)


def carry_sleep(state: State, part: State) -> None:
    """Let the bodies of a part of a world sleep and rest as they do in ``state``, which has some of them."""
    source, sleep = state.sleep, part.sleep
    if not (sleep.on and source.on):
        return
    # The rows of a world whose structure was changed may be numbered again, and those of its sleep not yet.
    _, own, there = np.intersect1d(sleep.entities, source.entities, return_indices=True)
    own, there = own[sleep.entities[own] > 0], there[source.entities[there] > 0]
    for name in _OF_ALL + _OF_SLEEPERS:
        getattr(sleep, name)[own] = getattr(source, name)[there]
    sleep.gone, sleep.laws = np.union1d(sleep.gone, source.gone), source.laws or sleep.laws
    sleep.unverified |= source.unverified
    sleep.count = int(np.count_nonzero(sleep.asleep))
    if sleep.count and len(sleep.asleep) == len(part.entity_index):
        set_inactive(part)


def forget_sleep(sleep: Sleep) -> None:
    """Let nothing sleep, and no body have rested."""
    for name in _OF_ALL + _OF_SLEEPERS:
        getattr(sleep, name)[:] = 0
    sleep.count, sleep.unverified, sleep.gone = 0, False, sleep.gone[:0]
