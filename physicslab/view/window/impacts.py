"""Impacts: the list that the table shows, and the one in the microscope."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.contacts.report import ImpactReader
from physicslab.diagnostics.collision import Collision, Result, read_collision, resolve
from physicslab.diagnostics.impact_table import NO_IMPACTS, read_impacts
from physicslab.ecs.vector import Vector2
from physicslab.history import History
from physicslab.view.window.pace import Pace
from physicslab.view.window.record import PastSamples
from physicslab.world import World

type Records = NDArray[Any]
"""Records of impacts (n,)."""

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
        self._past: PastSamples | None = None  # what is made again for impacts that the log has no more
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
            is_whole = world.contacts.logged <= len(world.contacts.log)
            at_end = history.step_count == history.steps_range[1]
            self._past = None if is_whole and at_end else PastSamples(history, ())
        else:
            new = self._reader.new(world)
        if len(new):
            self._take(_with_derived(new))
        self._fill(history)
        at_end = history.step_count == history.steps_range[1]
        if at_end and len(self.records) and self.records["time"].max() > world.time:
            self._put(self.records[self.records["time"] <= world.time])

    @property
    def fills(self) -> bool:
        """Whether steps are being made again for impacts that the log has no more."""
        return self._past is not None and self.shown

    def _fill(self, history: History) -> None:
        """Make a part of the steps again whose impacts are missing, and take these in at the end."""
        past = self._past
        if past is None or not past.is_of(history):
            self._past = None
        elif past.go_on():
            self._past = None
            if past.world is not None and len(past.world.contacts.impacts):
                self._take(_with_derived(past.world.contacts.impacts))

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


# ---- the microscope ----------------------------------------------------------------------------------------


FRAMES = {
    "Lab": "As the window shows it",
    "Centre of mass": "Moving with the centre of mass of both: momenta before and after are opposite",
    "A": "Moving as the centre of A did before the impact",
    "B": "Moving as the centre of B did before the impact",
}
"""Observers, and how each moves."""
_SEEN = 1.0
"""How long after an impact its mark can be clicked [s]; it is the world's time."""
_LATE = 1e-6
"""Share of a step by which an impact may lie before the step in which it was found."""


@dataclass(slots=True)
class SlowRun:
    """A part of the motion that is shown slowly: until when [s], and the pace that comes back after it."""

    until: float
    chosen: float
    slow_motion: bool
    paused: bool


class Microscope:
    """The content of the microscope for one impact.

    Attributes
    ----------
    record : array of IMPACT (), optional
        The impact; ``None`` while the microscope is closed.
    collision, result : Collision, Result
        That impact, and what the law makes of it.
    number : int
        How many impacts were shown.
    frame : str
        The observer, one of ``FRAMES``.
    shows_more, shows_formula : bool, optional
        Whether all about it is shown, and the formula is written out; ``None`` as the level has it.
    waits_for : tuple of int, optional
        The bodies at whose next impact time is to stand still, all where it is empty; ``None`` where it runs.
    slow : SlowRun, optional
        The part of the motion that is being shown slowly.
    """

    def __init__(self) -> None:
        self.record: Any | None = None
        self.number = 0
        self.collision: Collision
        self.result: Result
        self.frame = "Lab"
        self.shows_more: bool | None = None
        self.shows_formula: bool | None = None
        self.waits_for: tuple[int, ...] | None = None
        self.slow: SlowRun | None = None
        self._recent: list[NDArray[Any]] = []

    @property
    def is_open(self) -> bool:
        """Whether an impact is shown."""
        return self.record is not None

    @property
    def state(self) -> tuple[object, ...]:
        """The state that panels show."""
        return self.number, self.is_open, self.waits_for, self.slow is None, self.frame

    def show(self, record: Any) -> None:
        """Show an impact; the record is copied."""
        self.record = record.copy()
        self.number += 1
        self.collision = read_collision(record)
        self.result = resolve(self.collision)

    def close(self) -> None:
        """Show none."""
        self.record = None

    def forget(self) -> None:
        """Forget all that belongs to a world that is shown no more."""
        self.close()
        self.waits_for = self.slow = None
        self._recent = []

    @property
    def observer(self) -> Vector2:
        """The velocity of the observer [m/s]."""
        collision = self.collision
        if self.frame == "Centre of mass":
            return collision.centre_velocity
        if self.frame in ("A", "B"):
            return (collision.a if self.frame == "A" else collision.b).before.linear
        return Vector2()

    @property
    def seen(self) -> Collision:
        """The impact as the observer sees it."""
        return self.collision.seen_by(self.observer)

    # ---- marks that can be clicked -------------------------------------------------------------------------

    def note(self, impacts: NDArray[Any], time: float) -> None:
        """Take in the impacts of a frame, an array of IMPACT (n,); their marks can be clicked for a while."""
        if self._recent and time - self._recent[0]["time"][-1] > _SEEN:
            del self._recent[0]
        if len(impacts):
            self._recent.append(impacts)

    def near(self, place: Vector2, reach: float, time: float) -> Any | None:
        """Return the recent impact nearest to a place, if it is within ``reach`` [m]; the strongest there."""
        if not self._recent:
            return None
        every = np.concatenate(self._recent)
        age = time - every["time"]
        with np.errstate(invalid="ignore"):
            apart = np.hypot(every["x"] - place.x, every["y"] - place.y)
            near = every[(age >= 0.0) & (age < _SEEN) & (apart <= reach)]
        return near[np.argmax(near["normal_impulse"])] if len(near) else None

    # ---- time that stands still, or runs slowly ------------------------------------------------------------

    def sees_impact(self, world: World, logged: int, before: float) -> bool:
        """Whether the step since the time ``before`` [s] has an impact that is waited for; it is then shown.

        ``logged`` is how many impacts there had been.
        """
        if self.waits_for is None:
            return False
        new = world.contacts.impacts_since(logged)
        fits = new["time"] >= before - _LATE * (world.time - before)
        if self.waits_for:
            fits &= np.isin(new["entity_a"], self.waits_for) | np.isin(new["entity_b"], self.waits_for)
        new = new[fits]
        if not len(new):
            return False
        self.waits_for = None
        self.show(new[np.argmax(new["normal_impulse"])])
        return True

    def run_slowly(self, pace: Pace, speed: float, until: float) -> None:
        """Let time run slowly until a time of the world [s]; after that as it does now."""
        if self.slow is None:
            self.slow = SlowRun(until, pace.chosen, pace.slow_motion, pace.paused)
        self.slow.until = until
        pace.chosen, pace.slow_motion, pace.paused = speed, False, False

    def follow(self, pace: Pace, time: float) -> None:
        """End what is shown slowly where its time has come, or where the user has paused."""
        if self.slow is None or (time < self.slow.until and not pace.paused):
            return
        slow, self.slow = self.slow, None
        pace.chosen, pace.slow_motion = slow.chosen, slow.slow_motion
        if slow.paused:
            pace.halt()
