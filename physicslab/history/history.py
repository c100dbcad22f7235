"""One history of the edits and runs of a world: taken back, put back and gone through, to the bit."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Self

from physicslab.history.branches import Branch, Branches
from physicslab.history.commands import Command, Group, Spawn, changes_motion
from physicslab.history.line import Edit, Run, Steps, run_in_words
from physicslab.history.places import Places
from physicslab.history.recording import load, save
from physicslab.history.replay import Played, edit, play, write
from physicslab.stepping.keyframe import Keyframe
from physicslab.world import World

_LATE = 1e-6
"""Share of a step that a time may be after its end and count as within it: sums of steps are rounded."""


@dataclass(frozen=True, slots=True)
class HistoryEntry:
    """An edit or a run.

    Attributes
    ----------
    words : str
        The edit or run in plain English: "made a circle", "mass of ball: 2 kg", "ran 3.2 s".
    done : bool
        Whether it, or the beginning of it, lies before the present place.
    steps : int
        How many it is.
    """

    words: str
    done: bool
    steps: int


class Changes:
    """Edits made to a world by hand; two are equal if the edits are, whatever ran since."""

    def __init__(self, made: Sequence[tuple[Edit | Run, int]] = ()) -> None:
        self._made = made

    def is_like(self, other: Changes) -> bool:
        """Whether nothing was done between the two."""
        return len(self._made) == len(other._made) and all(
            one is two and count == number
            for (one, count), (two, number) in zip(self._made, other._made, strict=True)
        )


class History:
    """Edits and steps of a world, from now on: each of them goes through here.

    A place in the line of edits and runs is gone to from the last key frame before it
    (:class:`physicslab.history.places.Places`); the steps since are made again. ``world`` is the same
    object all the time and is changed in place; handles of entities that an undo brings back are new.

    Parameters
    ----------
    world : World
        As it is at the beginning of the line.
    budget : int
        Bytes that key frames may take together; two are kept in any case. The line itself takes 16 bytes a
        step besides.

    Attributes
    ----------
    world : World
        The world at the present place.
    start : float
        The world's clock at the beginning of the line [s].

    Examples
    --------
    >>> from physicslab import World
    >>> from physicslab.components import Transform, Velocity
    >>> from physicslab.systems.integrate import IntegrateSystem
    >>> history = History(World(IntegrateSystem()))
    >>> ball, = history.do(Spawn([Transform((0, 5)), Velocity((1, 0))], name="ball"))
    >>> history.step(0.5, steps=4)
    >>> history.world.component(ball, Transform).position.x
    2.0
    >>> history.seek(1)
    >>> history.world.component(ball, Transform).position.x
    0.5
    >>> history.undo(), history.undo(), history.undo()
    ('ran 0.5 s', 'made a point, ball', None)
    >>> history.redo(), [entry.words for entry in history.entries]
    ('made a point, ball', ['made a point, ball', 'ran 2.0 s'])
    """

    def __init__(self, world: World, budget: int = 64 * 2**20) -> None:
        self.world, self.start = world, world.time
        self._places, self._branches = Places(world, budget), Branches()
        self._end = 0
        self._divided = self._own = False

    # ---- doing ---------------------------------------------------------------------------------------------

    def do(self, command: Command) -> tuple[int, ...]:
        """Carry out an edit and record it; return the entities that it made.

        In the past this begins a branch.

        Raises
        ------
        InvalidValue, KeyError, TypeError, ValueError
            Raised by the world where it refuses the edit. Nothing is recorded then, and nothing changed.
        """
        places = self._places
        places.mend()
        places.prepare_edit()
        began = time.perf_counter()
        with places.all_or_nothing():
            words = command.words(self.world)
            done = edit(self.world, command)
        self._cut()
        places.line.add(Edit(words, done))
        self._advance(began)
        return tuple(_made(done))

    def write(self, command: Command) -> None:
        """Carry out what a hand does between two steps, as a part of the run and not as an edit.

        So a body that is dragged is given a velocity before each step: ``SetField(ball, "Velocity",
        "linear", v)``; it is taken hold of with ``AddComponent(ball, Held(grip))`` and let go of with
        ``RemoveComponent(ball, "Held")``. Undo takes back all of it together with the run.

        Raises
        ------
        InvalidValue, KeyError, TypeError, ValueError
            As :meth:`do` does.
        """
        self._places.mend()
        began = time.perf_counter()
        with self._places.all_or_nothing():
            done = write(self.world, command)
        self._run().add_write(done)
        self._advance(began)

    def step(self, dt: float | None = None, steps: int = 1) -> None:
        """Step the world and extend the present run, or begin one; in the past this begins a branch.

        Steps are made one by one, like those of ``world.step(dt)``.

        Raises
        ------
        Diverged
            If a value would not be finite. The world is then as it was before that step, to the bit.
        """
        world, places = self.world, self._places
        places.mend()
        h = world.simulation.dt if dt is None else dt
        for _ in range(steps):
            began = time.perf_counter()
            try:
                world.step(h)
            except BaseException:
                places.break_off()
                raise
            self._run().add_step(float(h), places.digester.digest(world))
            self._advance(began)

    def divide(self, *, own: bool = False) -> None:
        """Let the next step or write begin another run: undo takes back one of its ``own`` by itself."""
        self._divided, self._own = True, own

    @property
    def runs_on(self) -> bool:
        """Whether the next step extends a run, and does not begin one."""
        here, line = self._places.here, self._places.line
        return here > 0 and not self._divided and isinstance(line.entries[line.entry_at(here - 1)], Run)

    # ---- going through -------------------------------------------------------------------------------------

    def undo(self, *, runs: bool = True) -> str | None:
        """Undo the last edit or run before the present place; return its words, ``None`` if none is.

        In the middle of a run, its beginning is taken back. Without ``runs``, a run that merely went on
        after an edit is taken back together with it; one of its own (:meth:`divide`) is taken back by itself.
        """
        places, line = self._places, self._places.line
        places.mend()
        if places.here == 0:
            return None
        entry = line.entry_at(places.here - 1) if runs else line.last_by_hand(places.here)
        start, here = line.start_of(entry), places.here
        words = line.entries[entry].words
        if isinstance(line.entries[entry], Run):
            steps = line.steps_before(here) - line.steps_before(start)
            words = run_in_words(steps, line.seconds_before(here) - line.seconds_before(start))
        places.go(start)
        self._end = places.here
        return words

    def redo(self, *, runs: bool = True) -> str | None:
        """Redo the edit or run after the present place; return its words, ``None`` if there is none.

        Without ``runs``, together with the runs that merely went on after it.
        """
        places, line = self._places, self._places.line
        places.mend()
        if places.here >= line.ticks:
            return None
        entry = line.entry_at(places.here)
        places.go(line.start_of(entry + 1 if runs else line.next_by_hand(places.here)))
        self._end = max(self._end, places.here)
        return line.entries[entry].words

    def seek(self, step: int) -> None:
        """Go to the place after so many steps of the line, with the edits made before the next step.

        Nothing is dropped: to play on from there as it was, seek the next step and the next. A new step or
        edit begins a branch.

        Raises
        ------
        IndexError
            If the line has no such step (:attr:`steps_range`).
        """
        self._places.mend()
        first, last = self.steps_range
        if not first <= step <= last:
            raise IndexError(f"step {step}: the line has the steps from {first} to {last}")
        self._places.go(self._places.line.tick_after(step, self._end))

    def switch(self, branch: Branch) -> None:
        """Go on with a branch, at the place where it leaves; the line as it is becomes a branch.

        Raises
        ------
        ValueError
            If it is none of :attr:`branches`.
        """
        places = self._places
        places.mend()
        taken = self._branches.exchange(branch, places.line)
        places.go(min(taken.place, places.here))
        places.follow(taken.line, taken.place)
        self._end = taken.line.ticks
        places.go(taken.place)

    # ---- looking -------------------------------------------------------------------------------------------

    @property
    def entries(self) -> tuple[HistoryEntry, ...]:
        """The edits and runs of the line, those that were taken back last among them."""
        line, here = self._places.line, self._places.here
        return tuple(
            HistoryEntry(entry.words, line.start_of(k) < here, entry.steps)
            for k, entry in enumerate(line.entries)
        )

    @property
    def changes(self) -> Changes:
        """The edits before the present place, and the runs in which a hand did something, in order."""
        entries = self._places.line.entries[: self.position]
        return Changes([(entry, made) for entry in entries if (made := entry.ticks - entry.steps)])

    @property
    def position(self) -> int:
        """How many entries are done, or begun."""
        here = self._places.here
        return self._places.line.entry_at(here - 1) + 1 if here else 0

    @property
    def branches(self) -> tuple[Branch, ...]:
        """The last few lines that were left in the past, the oldest first."""
        return self._branches.kept

    @property
    def step_count(self) -> int:
        """How many steps of the line lie before the present place."""
        return self._places.line.steps_before(self._places.here)

    @property
    def last_edit(self) -> int:
        """How many steps lie before the last edit of what moves, before the present place; 0 without one."""
        line = self._places.line
        for k in reversed(range(self.position)):
            entry = line.entries[k]
            if isinstance(entry, Edit) and changes_motion(entry.command):
                return line.steps_before(line.start_of(k))
        return 0

    @property
    def steps_range(self) -> tuple[int, int]:
        """The first and the last step that :meth:`seek` goes to: what was taken back is not among them."""
        return 0, self._places.line.steps_before(self._end)

    def step_at(self, moment: float) -> int:
        """Return the first step of the line that ends at a time [s] or later; the last if none does."""
        seconds, steps, last = self.start, 0, self.steps_range[1]
        for piece in self._places.line.between(0, self._end):
            if not isinstance(piece, Steps):
                continue
            if seconds + piece.count * piece.dt >= moment - _LATE * piece.dt:
                inside = math.ceil((moment - seconds) / piece.dt - _LATE)
                return min(steps + max(inside, 0), last)
            seconds, steps = seconds + piece.count * piece.dt, steps + piece.count
        return last

    @property
    def time(self) -> float:
        """The world's clock [s]."""
        return self.world.time

    @property
    def next_entity(self) -> int:
        """The number that the next entity gets; those of a group get the numbers from there on."""
        return self.world.next_entity

    @property
    def difference(self) -> Played | None:
        """The first place found where steps that were made again gave other bits; ``None`` as it should be.

        Those of a system that goes on from numbers of its own, and does not keep them, do.
        """
        return self._places.difference

    @property
    def size(self) -> int:
        """Bytes that the key frames take."""
        return self._places.size

    def again(self) -> Iterator[tuple[World, Played]]:
        """Make all steps of the line as it is now again in another world, yielding it after each.

        Its impacts are logged. The world of the history is not touched, and what is done to it meanwhile is
        not made again.
        """
        line, world = self._places.line.head(self._end), World()
        self._places.beginning.fill(world)
        world.contacts.read = True
        return ((world, played) for played in play(world, line, world.name))

    # ---- recordings ----------------------------------------------------------------------------------------

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the line up to its end to a file that ``physicslab replay`` plays.

        Raises
        ------
        SceneError
            If the world at the beginning holds what no scene may.
        OSError
            If the file cannot be written; one that was there before is as it was.
        """
        self._places.mend()
        now = Keyframe(self.world)
        try:
            self._places.beginning.restore(self.world)
            save(self.world, self._places.line.head(self._end), path)
        finally:
            now.restore(self.world)

    @classmethod
    def load(cls, path: str | os.PathLike[str], budget: int = 64 * 2**20) -> Self:
        """Return the history of a recording, at its beginning; :meth:`seek` plays it.

        Raises
        ------
        SceneError
            If the file cannot be read or is no recording.
        """
        world, line = load(path)
        history = cls(world, budget)
        history._places.line, history._end = line, line.ticks
        return history

    # ---- the line ------------------------------------------------------------------------------------------

    def _run(self) -> Run:
        """Return the run that a step or a write at the present place extends."""
        self._cut()
        if not self.runs_on:
            self._places.line.add(Run(own=self._own))
        self._divided = self._own = False
        run = self._places.line.entries[-1]
        assert isinstance(run, Run)
        return run

    def _cut(self) -> None:
        """Let the line end at the present place; what is after it becomes a branch."""
        line, here = self._places.line, self._places.here
        if here < line.ticks:
            self._branches.leave(line, here)
            self._places.follow(line.head(here), here)

    def _advance(self, began: float) -> None:
        """Note that a tick was added at the end of the line, begun at ``began`` [s]."""
        self._places.advance(began)
        self._end = self._places.here


def _made(command: Command) -> Iterator[int]:
    """Yield the entities that a command has made."""
    if isinstance(command, Spawn) and command.entity is not None:
        yield command.entity
    elif isinstance(command, Group):
        for part in command.commands:
            yield from _made(part)
