"""The line of edits and runs that a world has gone along, as data.

A line is a list of entries. An entry is an edit, or a run; a run is a list of pieces: steps of one length,
and writes, the edits that a hand makes between steps. Every edit, write and step is one tick: a place in a
line is the number of ticks before it.
"""

from __future__ import annotations

import math
from array import array
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from physicslab.history.commands import Command
from physicslab.history.digest import Digest
from physicslab.languages.sentence import Sentence


@dataclass(slots=True)
class Steps:
    """Steps of ``dt`` seconds, ``count`` of them."""

    dt: float
    count: int


type Piece = Steps | Command


@dataclass(frozen=True, slots=True)
class Edit:
    """A command that was carried out, and what it does in words; one tick."""

    words: str
    command: Command
    ticks: int = 1
    steps: int = 0
    by_hand: bool = True


@dataclass(slots=True)
class Run:
    """Steps without an edit between them, and what a hand did meanwhile.

    Attributes
    ----------
    pieces : list of Steps and Command
        In order; steps of the same length that follow each other are one piece.
    digests : array of 32-bit numbers (4 steps,)
        Those of the columns of motion after every step.
    ticks, steps : int
        How many there are.
    seconds : float
        How long the run took [s].
    own : bool
        Whether it was begun by itself, as from a pause, and does not merely go on after an edit.
    """

    pieces: list[Piece] = field(default_factory=list)
    digests: array[int] = field(default_factory=lambda: array("I"))
    ticks: int = 0
    steps: int = 0
    seconds: float = 0.0
    own: bool = False
    _ticks_before: list[int] = field(default_factory=list)
    _steps_before: list[int] = field(default_factory=list)

    @property
    def words(self) -> str:
        """The edit or run in plain English."""
        return run_in_words(self.steps, self.seconds)

    @property
    def by_hand(self) -> bool:
        """Whether it was begun by itself, or anything was written in it."""
        return self.own or any(not isinstance(piece, Steps) for piece in self.pieces)

    def words_after(self, tick: int) -> str:
        """Return what comes after the first ``tick`` ticks, in plain English."""
        return run_in_words(self.steps - self.steps_before(tick), self.seconds - self.seconds_before(tick))

    def add_step(self, dt: float, digest: Digest) -> None:
        """Add a step of ``dt`` seconds."""
        last = self.pieces[-1] if self.pieces else None
        if isinstance(last, Steps) and last.dt == dt:
            last.count += 1
        else:
            self._begin(Steps(dt, 1))
        self.ticks += 1
        self.steps += 1
        self.seconds += dt
        self.digests.extend(digest)

    def add_steps(self, dt: float, count: int) -> None:
        """Add steps of which the digests are there already, or will be."""
        self._begin(Steps(dt, count))
        self.ticks += count
        self.steps += count
        self.seconds += count * dt

    def add_write(self, command: Command) -> None:
        """Add a write."""
        self._begin(command)
        self.ticks += 1

    def _begin(self, piece: Piece) -> None:
        self._ticks_before.append(self.ticks)
        self._steps_before.append(self.steps)
        self.pieces.append(piece)

    def digest(self, step: int) -> Digest:
        """Return that after a step, from 0."""
        one, two, three, four = self.digests[4 * step : 4 * step + 4]
        return one, two, three, four

    def tick_of(self, step: int) -> int:
        """Return how many ticks there are before a step, from 0."""
        k = bisect_right(self._steps_before, step) - 1
        return self._ticks_before[k] + step - self._steps_before[k]

    def steps_before(self, tick: int) -> int:
        """Return how many of the first ``tick`` ticks are steps."""
        if tick >= self.ticks:
            return self.steps
        k = bisect_right(self._ticks_before, tick) - 1
        return self._steps_before[k] + (
            tick - self._ticks_before[k] if isinstance(self.pieces[k], Steps) else 0
        )

    def seconds_before(self, tick: int) -> float:
        """Return how long the steps among the first ``tick`` ticks took [s]."""
        return math.fsum(
            piece.dt * piece.count for piece in self.between(0, tick) if isinstance(piece, Steps)
        )

    def between(self, start: int, end: int) -> Iterator[Piece]:
        """Yield the pieces of the ticks from ``start`` to ``end``."""
        k = bisect_right(self._ticks_before, start) - 1
        while start < end:
            piece = self.pieces[k]
            if isinstance(piece, Steps):
                count = min(end, self._ticks_before[k] + piece.count) - start
                yield Steps(piece.dt, count)
                start += count
            else:
                yield piece
                start += 1
            k += 1

    def head(self, ticks: int) -> Run:
        """Return a run of the first ``ticks`` ticks."""
        made = Run(own=self.own)
        for piece in self.between(0, ticks):
            if isinstance(piece, Steps):
                made.add_steps(piece.dt, piece.count)
            else:
                made.add_write(piece)
        made.digests = self.digests[: 4 * made.steps]
        return made


type Entry = Edit | Run


class Line:
    """Entries one after the other.

    Attributes
    ----------
    entries : list of Edit and Run
        In order. The last is the only one that grows.
    """

    def __init__(self, entries: Sequence[Entry] = ()) -> None:
        self.entries: list[Entry] = []
        self._ticks_before: list[int] = []
        self._steps_before: list[int] = []
        for entry in entries:
            self.add(entry)

    def add(self, entry: Entry) -> None:
        """Add an entry at the end."""
        ticks, steps = self.ticks, self.steps
        self._ticks_before.append(ticks)
        self._steps_before.append(steps)
        self.entries.append(entry)

    @property
    def ticks(self) -> int:
        """How many there are."""
        return self._ticks_before[-1] + self.entries[-1].ticks if self.entries else 0

    @property
    def steps(self) -> int:
        """How many of them are steps."""
        return self._steps_before[-1] + self.entries[-1].steps if self.entries else 0

    def start_of(self, entry: int) -> int:
        """Return how many ticks there are before an entry; that of none, at the end of the line."""
        return self._ticks_before[entry] if entry < len(self.entries) else self.ticks

    def entry_at(self, tick: int) -> int:
        """Return the number of the entry in which the tick after the first ``tick`` is."""
        if tick >= self.ticks:
            return len(self.entries)
        return bisect_right(self._ticks_before, tick) - 1

    def last_by_hand(self, tick: int) -> int:
        """Return the number of the last entry begun before ``tick`` that was done by hand; 0 if none was."""
        k = self.entry_at(tick - 1)
        return next((n for n in range(k, 0, -1) if self.entries[n].by_hand), 0)

    def next_by_hand(self, tick: int) -> int:
        """Return the number of the first entry begun after ``tick`` that was done by hand, or of none."""
        k = self.entry_at(tick) + 1
        return next((n for n in range(k, len(self.entries)) if self.entries[n].by_hand), len(self.entries))

    def steps_before(self, tick: int) -> int:
        """Return how many of the first ``tick`` ticks are steps."""
        k = self.entry_at(tick)
        if k == len(self.entries):
            return self.steps
        entry = self.entries[k]
        inside = entry.steps_before(tick - self._ticks_before[k]) if isinstance(entry, Run) else 0
        return self._steps_before[k] + inside

    def seconds_before(self, tick: int) -> float:
        """Return how long the steps among the first ``tick`` ticks took [s]."""
        k, last = self.entry_at(tick), 0.0
        if k < len(self.entries) and isinstance(entry := self.entries[k], Run):
            last = entry.seconds_before(tick - self._ticks_before[k])
        return last + math.fsum(entry.seconds for entry in self.entries[:k] if isinstance(entry, Run))

    def words_after(self, tick: int) -> tuple[str, ...]:
        """Return in words what is done after the first ``tick`` ticks; of a run, what is left of it."""
        k = self.entry_at(tick)
        words = [entry.words for entry in self.entries[k:]]
        if words and isinstance(entry := self.entries[k], Run) and tick > self._ticks_before[k]:
            words[0] = entry.words_after(tick - self._ticks_before[k])
        return tuple(words)

    def tick_after(self, step: int, end: int) -> int:
        """Return the last place, at most ``end``, with no more than so many steps before it."""
        if step >= self.steps:
            return end
        k = bisect_right(self._steps_before, step) - 1
        entry = self.entries[k]
        assert isinstance(entry, Run)  # the last of those with so many steps before them: it has some
        return min(end, self._ticks_before[k] + entry.tick_of(step - self._steps_before[k]))

    def digest_before(self, tick: int) -> Digest:
        """Return the digest after the step that ends at ``tick``."""
        k = self.entry_at(tick - 1)
        entry = self.entries[k]
        assert isinstance(entry, Run)
        return entry.digest(entry.steps_before(tick - self._ticks_before[k]) - 1)

    def between(self, start: int, end: int) -> Iterator[Piece | Edit]:
        """Yield what is done from place ``start`` to ``end``: steps, writes and edits."""
        k = self.entry_at(start)
        while start < end:
            entry, first = self.entries[k], self._ticks_before[k]
            until = min(end, first + entry.ticks)
            if isinstance(entry, Edit):
                yield entry
            else:
                yield from entry.between(start - first, until - first)
            start, k = until, k + 1

    def head(self, tick: int) -> Line:
        """Return the line up to a place; its last run is its own, so that it can grow."""
        k, made = self.entry_at(tick), Line()
        made.entries, made._ticks_before = self.entries[:k], self._ticks_before[:k]
        made._steps_before = self._steps_before[:k]
        if k < len(self.entries) and tick > self._ticks_before[k]:
            entry = self.entries[k]
            assert isinstance(entry, Run)
            made.add(entry.head(tick - self._ticks_before[k]))
        elif made.entries and isinstance(last := made.entries[-1], Run):
            made.entries[-1] = last.head(last.ticks)
        return made

    def common_ticks(self, other: Line) -> int:
        """Return how many ticks this and another line begin with alike."""
        common = 0
        for one, two in zip(self.entries, other.entries, strict=False):
            if one is two:
                common += one.ticks
                continue
            if isinstance(one, Run) and isinstance(two, Run):
                common += _common_of_runs(one, two)
            break
        return common


def run_in_words(steps: int, seconds: float) -> str:
    """Return what a run was, in plain English."""
    if not steps:
        return "moved by hand"
    shown = f"{seconds:.1f}" if seconds >= 0.1 else f"{seconds:.2g}"
    return Sentence("ran {time} s", time=shown)


def _common_of_runs(one: Run, two: Run) -> int:
    common = 0
    for a, b in zip(one.pieces, two.pieces, strict=False):
        if isinstance(a, Steps) and isinstance(b, Steps) and a.dt == b.dt:
            common += min(a.count, b.count)
            if a.count == b.count:
                continue
        elif a is b:
            common += 1
            continue
        break
    return common
