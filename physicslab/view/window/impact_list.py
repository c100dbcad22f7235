"""The impacts that the table lists: read from the world's log while they are wanted, and kept in order."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.contacts.impact_reader import ImpactReader
from physicslab.diagnostics.ledger import NO_IMPACTS, read_impacts
from physicslab.history import History
from physicslab.world import World

__all__ = ["COLUMNS", "LIMIT", "ImpactList"]

type Records = NDArray[Any]

LIMIT = 100_000
"""Impacts that are kept: beyond that number the oldest are forgotten."""
_DROPPED = 0.1
"""Share of them that is forgotten at once."""
_SAME = ["time", "entity_a", "entity_b", "wall", "normal_impulse"]
"""The key of an impact, equal for its records in a repeated step."""
_DERIVED = ("sticks", "e_found", "energy_lost")
"""Columns that follow from a record, and that rows are sorted by."""
COLUMNS = (
    "time", "entity_a", "entity_b", "approach_speed", "normal_impulse", "tangent_impulse",
    "sticks", "friction", "restitution", "e_found", "energy_lost",
)  # fmt: skip
"""Columns by which rows can be sorted."""


class ImpactList:
    """The impacts of a world along the line of its history, oldest first.

    Going back in time keeps those that come later, for as long as the line has the steps in which they were;
    those of steps that are made again are not listed twice.

    Attributes
    ----------
    shown : bool
        Whether the table is shown.
    only_selected : bool
        Whether it shows impacts of the selection alone.
    sorted_by : str
        One of ``COLUMNS``.
    falling : bool
        Whether the largest comes first.
    records : array (n,)
        IMPACT, with a column more for each derived figure.
    """

    def __init__(self) -> None:
        self.shown = self.only_selected = self.falling = False
        self.sorted_by = "time"
        self._reader = ImpactReader()
        self._world: World | None = None
        self.records = _with_derived(NO_IMPACTS)
        self._room = self.records
        self._order: NDArray[np.int64] = np.zeros(0, np.int64)
        self._key: tuple[str, bool] | None = None  # what the order is by; None where it is to be found again

    def clear(self) -> None:
        """Forget them all."""
        self._put(self.records[:0])

    def follow(self, world: World, history: History) -> None:
        """Take in what the log has since the last call; the first call begins with all that it has."""
        if world is not self._world:
            self._world = world
            self.clear()
            self._reader.follow(world)
            new = _of_one_line(world.contacts.impacts)
        else:
            new = self._reader.new(world)
        if len(new):
            self._take(_with_derived(new))
        at_end = history.step_count == history.steps_range[1]
        if at_end and len(self.records) and self.records["time"].max() > world.time:
            self._put(self.records[self.records["time"] <= world.time])

    def _take(self, new: Records) -> None:
        """Add impacts that are new, or that were made again."""
        kept = self.records
        if not len(kept) or kept.dtype != new.dtype:
            self._put(new[-LIMIT:])
            return
        first = new["time"].min()
        if first > kept["time"][-1]:
            self._append(new)
            return
        again = kept["time"] >= first
        both = np.concatenate((kept[again], new))
        _, unique = np.unique(both[_SAME], return_index=True)
        if len(unique) == again.sum():  # all of them are known
            return
        self._put(np.concatenate((kept[~again], both[unique]))[-LIMIT:])

    def _append(self, new: Records) -> None:
        """Add impacts after all that are kept, in the room behind them."""
        count = len(self.records) + len(new)
        if count > LIMIT:
            dropped = count - LIMIT + round(_DROPPED * LIMIT)
            self._put(np.concatenate((self.records[dropped:], new))[-LIMIT:])
            return
        if count > len(self._room):
            room = np.zeros(min(2 * count, LIMIT), new.dtype)
            room[: len(self.records)] = self.records
            self._room = room
        self._room[count - len(new) : count] = new
        self.records = self._room[:count]

    def _put(self, records: Records) -> None:
        """Put others in place of all that are kept."""
        self._room = self.records = records.copy()
        self._order, self._key = np.zeros(0, np.int64), None

    # ---- in which order they are shown ---------------------------------------------------------------------

    def order(self, selected: Iterable[int]) -> NDArray[np.int64]:
        """Return which records are shown, in their order: numbers of rows (m,)."""
        key = self.sorted_by, self.falling
        if key != self._key or len(self._order) > len(self.records):
            self._order, self._key = np.zeros(0, np.int64), key
        self._sort_in()
        order = self._order[::-1] if self.falling else self._order
        if not self.only_selected:
            return order
        bodies = np.fromiter(selected, np.int64)
        a, b = self.records["entity_a"], self.records["entity_b"]
        return order[(np.isin(a, bodies) | np.isin(b, bodies))[order]]

    def _sort_in(self) -> None:
        """Put the rows that came since into the order, after those that are equal."""
        known = len(self._order)
        if known == len(self.records):
            return
        values = self.records[self.sorted_by]
        new = known + np.argsort(values[known:], kind="stable")
        if known:
            new = np.insert(self._order, np.searchsorted(values[self._order], values[new], "right"), new)
        self._order = new

    def beside(self, time: float, by: int, selected: Iterable[int]) -> Any | None:
        """Return the next record after a time [s] or, ``by`` -1, the last before it; ``None`` if none is."""
        times = self.records["time"]
        fits = times > time if by > 0 else times < time
        if self.only_selected:
            bodies = np.fromiter(selected, np.int64)
            fits &= np.isin(self.records["entity_a"], bodies) | np.isin(self.records["entity_b"], bodies)
        rows = np.flatnonzero(fits)
        if not len(rows):
            return None
        return self.records[rows[np.argmin(times[rows]) if by > 0 else np.argmax(times[rows])]].copy()


def _of_one_line(log: Records) -> Records:
    """Return the impacts of a log that were not taken back: none of those written later is earlier."""
    earliest_after = np.minimum.accumulate(log["time"][::-1])[::-1]
    kept: Records = log[log["time"] <= earliest_after]
    return kept


def _with_derived(records: Records) -> Records:
    """Return records with a column more for each derived figure."""
    columns = read_impacts(records)
    made = np.zeros(len(records), [*records.dtype.descr, *((name, np.float64) for name in _DERIVED)])
    for name in records.dtype.names or ():
        made[name] = records[name]
    for name in _DERIVED:
        made[name] = getattr(columns, name)
    return made
