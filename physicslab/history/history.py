"""One history of the edits and runs of a world: taken back, put back and gone through, to the bit."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Self

from physicslab.history.commands import Command, Group, Spawn
from physicslab.history.digest import Digester, differing
from physicslab.history.keyframe import Keyframe
from physicslab.history.keyframes import Keyframes
from physicslab.history.line import Edit, Line, Run, Steps
from physicslab.history.recording import load, save
from physicslab.history.replay import follow_edit
from physicslab.history.seen import Branch, Difference, HistoryEntry
from physicslab.world import World

__all__ = ["History"]

_RARELY, _OFTEN, _SEEKING = 80.0, 30.0, 5.0
"""How many times as long as a key frame takes the steps between two take, at most and at least in a run; and
where steps are made again, or an edit begins."""
_SMOOTH = 0.010
"""Time [s] of the steps between two in a run, where that lies between those: nearly any place is then reached
within a frame of the screen."""
_FEW = 8
"""Number of steps that are made sooner than a key frame is gone back to."""
_BRANCH_LIMIT = 8
"""Number of branches that are kept; the oldest go first."""


class History:
    """What was done to a world and what it did, from now on: every edit and every step goes through here.

    A place in the line of edits and runs is gone to from the last key frame before it
    (:class:`physicslab.history.keyframe.Keyframe`); the steps since are made again. ``world`` is the same
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
    difference : Difference, optional
        The first place found where steps that were made again gave other bits, as those of a system do that
        keeps numbers of its own; ``None`` as it should be.

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
    ('ran 2.0 s', 'made a point, ball', None)
    >>> history.redo(), [entry.words for entry in history.entries]
    ('made a point, ball', ['made a point, ball', 'ran 2.0 s'])
    """

    def __init__(self, world: World, budget: int = 64 * 2**20) -> None:
        self.world = world
        self.difference: Difference | None = None
        self._line, self._branches = Line(), list[Branch]()
        self._place = self._end = 0
        self._whole, self._divided = True, False
        self._frames = Keyframes(budget)
        self._cost = self._since = 0.0
        self._digester = Digester()
        self._last: Keyframe | None = None
        self._take()  # the first takes longer than others will
        self._cost = 0.0
        self._frames.add_along(0, self._take())

    # ---- doing ---------------------------------------------------------------------------------------------

    def do(self, command: Command) -> tuple[int, ...]:
        """Carry out an edit and record it; return the entities that it made.

        In the past this begins a branch.

        Raises
        ------
        InvalidValue, KeyError, TypeError, ValueError
            What the world raises where it refuses the edit. Nothing is recorded then, and nothing changed.
        """
        self._mend()
        if self._since >= _SEEKING * self._cost:
            self._leave_nearby()
        with self._all_or_nothing():
            words = command.words(self.world)
            done = command.carry_out(self.world)
            follow_edit(self.world)
        self._cut()
        self._line.add(Edit(words, done))
        self._advance()
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
        self._mend()
        with self._all_or_nothing():
            done = command.carry_out(self.world)
            self.world.synchronise()
        self._run().add_write(done)
        self._advance()

    def step(self, dt: float | None = None, steps: int = 1) -> None:
        """Step the world and extend the present run, or begin one; in the past this begins a branch.

        Steps are made one by one, like those of ``world.step(dt)``.

        Raises
        ------
        Diverged
            If a value would not be finite. The world is then as it was before that step, to the bit.
        """
        self._mend()
        world = self.world
        for _ in range(steps):
            h = world.simulation.dt if dt is None else dt
            began = time.perf_counter()
            with self._all_or_nothing():
                world.step(h)
            self._since += time.perf_counter() - began
            self._run().add_step(float(h), self._digester.digest(world))
            self._advance()
            if self._since >= self._interval and self._frames.takes(self._place):
                self._frames.add_along(self._place, self._take())

    def divide(self) -> None:
        """Let the next step or write begin another run: undo takes back what comes from now on by itself."""
        self._divided = True

    # ---- going through -------------------------------------------------------------------------------------

    def undo(self) -> str | None:
        """Take back the last edit or run before the present place; return its words, ``None`` if none is.

        Of a run in the middle of which the place is, the beginning is taken back.
        """
        self._mend()
        if self._place == 0:
            return None
        entry = self._line.entry_at(self._place - 1)
        self._go(self._line.start_of(entry))
        self._end = self._place
        return self._line.entries[entry].words

    def redo(self) -> str | None:
        """Put back the edit or run after the present place; return its words, ``None`` if there is none."""
        self._mend()
        if self._place >= self._line.ticks:
            return None
        entry = self._line.entry_at(self._place)
        self._go(self._line.start_of(entry + 1))
        self._end = max(self._end, self._place)
        return self._line.entries[entry].words

    def seek(self, step: int) -> None:
        """Go to the place after so many steps of the line, with the edits made before the next step.

        Nothing is dropped: to play on from there as it was, seek the next step and the next. A new step or
        edit begins a branch.

        Raises
        ------
        IndexError
            If the line has no such step (:attr:`steps_range`).
        """
        self._mend()
        first, last = self.steps_range
        if not first <= step <= last:
            raise IndexError(f"step {step}: the line has the steps from {first} to {last}")
        self._go(self._line.tick_after(step, self._end))

    def switch(self, branch: Branch) -> None:
        """Go on with a branch, at the place where it was left; the line as it is becomes a branch.

        Raises
        ------
        ValueError
            If it is none of :attr:`branches`.
        """
        self._mend()
        self._branches.remove(branch)
        common = self._line.common_ticks(branch.line)
        self._go(min(common, self._place))
        self._keep_branch(common)
        self._line = branch.line
        self._frames.cut(common)
        self._end = self._line.ticks
        self._go(branch.place)

    # ---- looking -------------------------------------------------------------------------------------------

    @property
    def entries(self) -> tuple[HistoryEntry, ...]:
        """The edits and runs of the line, those that were taken back last among them."""
        line = self._line
        return tuple(
            HistoryEntry(entry.words, line.start_of(k) < self._place, line.steps_before_entry(k), entry.steps)
            for k, entry in enumerate(line.entries)
        )

    @property
    def position(self) -> int:
        """How many entries are done, or begun."""
        return self._line.entry_at(self._place - 1) + 1 if self._place else 0

    @property
    def branches(self) -> tuple[Branch, ...]:
        """The last few lines that were left in the past, the oldest first."""
        return tuple(self._branches)

    @property
    def step_count(self) -> int:
        """How many steps of the line lie before the present place."""
        return self._line.steps_before(self._place)

    @property
    def steps_range(self) -> tuple[int, int]:
        """The first and the last step that :meth:`seek` goes to: what was taken back is not among them."""
        return 0, self._line.steps_before(self._end)

    @property
    def time(self) -> float:
        """The world's clock [s]."""
        return self.world.time

    @property
    def next_entity(self) -> int:
        """The number that the next entity gets; those of a group get the numbers from there on."""
        return self.world.next_entity

    @property
    def size(self) -> int:
        """Bytes that the key frames take."""
        return self._frames.size

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
        self._mend()
        now = Keyframe(self.world)
        try:
            self._frames[0].restore(self.world)
            save(self.world, self._line.head(self._end), path)
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
        history._line, history._end = line, line.ticks
        return history

    # ---- places --------------------------------------------------------------------------------------------

    def _run(self) -> Run:
        """Return the run that a step or a write at the present place extends."""
        self._cut()
        entries = self._line.entries
        if not entries or not isinstance(entries[-1], Run) or self._divided:
            self._line.add(Run())
        self._divided = False
        run = entries[-1]
        assert isinstance(run, Run)
        return run

    def _advance(self) -> None:
        """Note that a tick was added at the end of the line."""
        self._place += 1
        self._end = self._place

    def _cut(self) -> None:
        """Let the line end at the present place; what is after it becomes a branch."""
        if self._place == self._line.ticks:
            return
        self._keep_branch(self._place)
        self._line = self._line.head(self._place)
        self._frames.cut(self._place)

    def _keep_branch(self, place: int) -> None:
        if place < self._line.ticks:
            self._branches = [*self._branches[1 - _BRANCH_LIMIT :], Branch(self._line, place)]

    def _go(self, place: int) -> None:
        """Go to a place of the line."""
        base = self._frames.before(place)
        ahead = place - self._place
        if not self._whole or ahead < 0 or (base > self._place and ahead > _FEW):
            self._restore(base)
        try:
            self._make_again(place)
        except BaseException:
            self._whole = False
            raise

    def _restore(self, base: int) -> None:
        """Go back to a key frame."""
        self._whole = False
        self._last = self._frames[base]
        self._last.restore(self.world)
        self._place, self._since, self._whole = base, 0.0, True

    def _make_again(self, place: int) -> None:
        """Go on to a place along the line, and leave key frames on the way: others nearby will follow."""
        world = self.world
        for piece in self._line.between(self._place, place):
            if isinstance(piece, Steps):
                for _ in range(piece.count):
                    self._make_step_again(piece.dt, place)
                continue
            command = piece.command if isinstance(piece, Edit) else piece
            command.carry_out(world)
            if isinstance(piece, Edit):
                follow_edit(self.world)
            else:
                world.synchronise()
            self._place += 1

    def _make_step_again(self, dt: float, target: int) -> None:
        began = time.perf_counter()
        self.world.step(dt)
        self._place += 1
        self._since += time.perf_counter() - began
        columns = differing(self._digester.digest(self.world), self._line.digest_before(self._place))
        if columns and self.difference is None:
            self.difference = Difference(self.step_count, columns)
        if self._since >= _SEEKING * self._cost:
            self._leave_nearby(target)

    def _leave_nearby(self, target: int | None = None) -> None:
        if self._place not in self._frames:
            around = self._place if target is None else target
            self._frames.add_nearby(self._place, self._take(), around)

    @property
    def _interval(self) -> float:
        """The time of the steps between two key frames in a run [s]."""
        rarely = _RARELY * self._cost
        return _SMOOTH if _OFTEN * self._cost <= _SMOOTH <= rarely else rarely

    def _take(self) -> Keyframe:
        """Return a key frame of now."""
        began = time.perf_counter()
        frame = Keyframe(self.world, self._last)
        took = time.perf_counter() - began
        self._cost = (
            min(took, 2.0 * self._cost) if self._cost else took
        )  # other programs may have run meanwhile
        self._since, self._last = 0.0, frame
        return frame

    @contextmanager
    def _all_or_nothing(self) -> Iterator[None]:
        """Go back to the present place where what is done in the ``with`` block fails."""
        try:
            yield
        except BaseException:
            self._whole = False
            self._mend()
            raise

    def _mend(self) -> None:
        """Make the world again that is at the present place, where something was broken off."""
        if not self._whole:
            place = self._place
            self._restore(self._frames.before(place))
            self._go(place)


def _made(command: Command) -> Iterator[int]:
    """Yield the entities that a command has made."""
    if isinstance(command, Spawn) and command.entity is not None:
        yield command.entity
    elif isinstance(command, Group):
        for part in command.commands:
            yield from _made(part)
