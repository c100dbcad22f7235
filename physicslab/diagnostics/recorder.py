"""Runs that are recorded: advanced as any, with the motion kept, for a time or until a condition holds.

Steppers keep the motion of bodies while they advance the world. Energies and the page of the player are made
when they are first read, in a copy of the world that is put to each recorded instant.
"""

import logging
import math
import sys
from collections.abc import Iterator, Mapping
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.contacts.report import ImpactReader
from physicslab.diagnostics.energy import Booked, measure_energy, read_books
from physicslab.diagnostics.figures import Figures
from physicslab.diagnostics.impact_table import NO_IMPACTS, impact_table
from physicslab.diagnostics.run_report import body_names
from physicslab.diagnostics.samples import Record, quoted
from physicslab.ecs.component import COMPONENTS
from physicslab.ecs.conditions import Condition
from physicslab.ecs.fields import Field, InvalidValue
from physicslab.ecs.quantity_text import InvalidText
from physicslab.state.run import BODY_COLUMNS, Column, Run
from physicslab.state.samples import Samples, moving_rows, put_motion
from physicslab.stepping.breaks import first_time
from physicslab.stepping.keyframe import Keyframe
from physicslab.stepping.run import RunLength, run_length, strides_as_it_goes
from physicslab.systems.breaking import BreakSystem, breaks_of
from physicslab.systems.joint import remove_joint
from physicslab.world import World

_log = logging.getLogger(__name__)
_EVERY = Field("every", "number", above=0.0, unit="s", owner="record")
_LATE = 1e-6
"""Share of a step by which ``every`` may be longer than whole steps."""
_LOOK = 1024
"""Steps after which impacts are read from the log, so that it does not run over."""
_AHEAD = 8, 512
"""So many steps are made at first, and at most, before a condition is looked at."""
_MOMENT_TOLERANCE = 1e-15
"""Share of a step to which a moment is located."""
_SUMS = ("kinetic", "potential", "energy")


def record(
    world: World, seconds: float, every: float | None, until: str | None, *, again: bool = False
) -> Run:
    """Advance a world and return what it did, as :meth:`World.record` says.

    Where the condition has to begin ``again``, it is taken to hold already.
    """
    length = run_length(world, seconds, None)
    stride = 1
    if every is not None:
        wanted = float(_EVERY.check(every))
        stride = max(1, math.ceil(wanted / length.dt - _LATE))
        if abs(stride - wanted / length.dt) > _LATE and stride < length.steps:
            apart, dt = stride * length.dt, wanted / stride
            words = f"instants are {apart:g} s apart; simulation.dt = {dt:.9g} would help"
            _log.warning("record: every = %g s is no whole number of steps: %s", wanted, words)
    world.synchronise()
    with world.active():
        names = body_names(world)
    begin, reader, frame = read_books(world), ImpactReader(world), Keyframe(world)
    reads, world.contacts.read = world.contacts.read, True
    records: list[NDArray[Any]] = []
    found: float | None = None
    try:
        if until is None:
            samples = _recorded(world, length, stride, reader, records)
        else:
            samples, found = _Watch(world, until, reader, records, again).go(length, stride)
    finally:
        world.samples, world.contacts.read = None, reads
    moving = world.entity_index.entities[samples.rows].tolist()
    return Run(
        samples.times[: samples.count], samples.motion[: samples.count],
        tuple(names[entity] for entity in moving), found, _Replay(world, records, begin, frame),
    )  # fmt: skip


def _recorded(
    world: World, length: RunLength, stride: int, reader: ImpactReader, records: list[NDArray[Any]]
) -> Samples:
    """Make a whole run; the world ends with the bits of :meth:`World.run`."""
    finest = 1 if world.schedule.samplers else stride
    world.samples = samples = Samples(world, world.time, length.dt, finest, length.steps)
    for _ in strides_as_it_goes(world, length, lambda: _stride(world), math.inf):
        records += reader.blocks(world)
    if reader.lost:
        _log.warning("record: %d impacts were not kept, more than the log holds", reader.lost)
    return _thinned(world, samples, stride // finest)


def _thinned(world: World, samples: Samples, stride: int) -> Samples:
    """Return every ``stride``-th of the samples, and the state of now as the last."""
    samples.finish(world, world.time)
    if stride > 1:
        last = samples.count - 1
        kept = np.unique(np.append(np.arange(0, samples.count, stride), last))
        samples.times, samples.motion = samples.times[kept], samples.motion[kept]
        samples.count = len(kept)
    return samples


def _stride(world: World) -> int:
    """Return after how many steps impacts are read: smooth motion, which may begin on the way, is whole."""
    smooth = world.plan.smooth or any(not island.touches for island in world.islands.members)
    return sys.maxsize if smooth else _LOOK


class _Watch:
    """Advances a world until a condition holds, and finds when that begins.

    Parameters
    ----------
    world : World
        The world that is advanced.
    until : str
        The condition, of what graphs show: ``"ball.x >= 8 m"``, ``"time > 2 s and world.kinetic < 1 mJ"``.
    reader, records : ImpactReader, list
        The reader of impacts, and their records.
    again : bool
        Whether the condition is taken to hold at the start, and has to begin once more.
    """

    def __init__(
        self, world: World, until: str, reader: ImpactReader, records: list[NDArray[Any]], again: bool
    ) -> None:
        self._world, self._reader, self._records = world, reader, records
        if not isinstance(until, str):
            raise InvalidValue("record", "until", until, "a condition, as 'ball.x >= 8 m' is one")
        try:
            self._condition = Condition(quoted(until, map(world.label, world.entities())))
            self._names = [name for name in dict.fromkeys(self._condition.names()) if name != "time"]
            self._record = Record(world, self._names)
            self._record.add()
            self._held = again
            self._begun = self._begins()
            self._condition.margin(self._now())
        except InvalidText as error:
            allowed = f"a condition, as 'ball.x >= 8 m' is one: {error}"
            raise InvalidValue("record", "until", until, allowed) from error

    def go(self, length: RunLength, stride: int) -> tuple[Samples, float | None]:
        """Advance; return the samples, and when the condition began to hold [s], if it did."""
        world = self._world
        every = Samples(world, world.time, length.dt, 1, length.steps)
        ahead, most = _AHEAD if self._of_motion else (1, 1)
        done, start, found = 0, world.time, world.time if self._begun else None
        while found is None and done < length.steps:
            count, before, kept = min(ahead, length.steps - done), every.count, Keyframe(world)
            end = start + length.elapsed(done + count)
            self._advance(every, end - world.time, world.time)
            first = self._first(every, before)
            if first is not None:
                steps = first - before
                self._go_back(kept)
                if steps:
                    world.run(steps=steps)
                    self._records += self._reader.blocks(self._world)
                    kept = Keyframe(world)
                found = self._locate(kept, float(every.times[first]) - world.time)
                every.count = first
            self._records += self._reader.blocks(self._world)
            done, ahead = done + count, min(2 * ahead, most)
        world.samples = None
        return _thinned(world, every, stride), found

    def _advance(self, samples: Samples, seconds: float, time: float) -> None:
        """Make some steps, of which every one is sampled."""
        self._world.samples = samples
        self._world.run(seconds=seconds)
        samples.finish(self._world, self._world.time)

    @property
    def _of_motion(self) -> bool:
        """Whether all that it refers to is in samples of the motion."""
        return all(name.rpartition(".")[2] in BODY_COLUMNS for name in self._names)

    def _first(self, samples: Samples, before: int) -> int | None:
        """Return the first sample from number ``before`` on at which the condition has begun to hold."""
        world, record = self._world, self._record
        if not self._of_motion:
            record.add()
            return before if self._begins() else None
        place = {row: k for k, row in enumerate(samples.rows.tolist())}
        fields, columns = list(BODY_COLUMNS), []
        for name in self._names:
            entity, _, field = name.rpartition(".")
            row = place.get(world.entity_index.row_of[world.entity(entity)])
            columns.append((record.columns[name], row, fields.index(field)))
        for number in range(before, samples.count):
            record.times.append(float(samples.times[number]))
            for column, row, k in columns:
                column.append(column[0] if row is None else float(samples.motion[number, row, k]))
            if self._begins():
                return number
        return None

    def _locate(self, kept: Keyframe, h: float) -> float:
        """Return when the condition begins to hold within a step of ``h`` s, and leave the world there."""
        world = self._world
        start, early, last = world.time, self._margin(), -1.0

        def after(t: float) -> float:
            nonlocal last
            self._go_back(kept)
            world.run(seconds=t)
            last = t
            return self._margin()

        late = first_time(
            after, h, after(h), early if early <= 0.0 else None,
            max(_MOMENT_TOLERANCE, math.ulp(start + h) / h), 0.0,
        )  # fmt: skip
        if last != late:
            after(late)
        return world.time

    def _go_back(self, kept: Keyframe) -> None:
        self._world.samples = None
        kept.restore(self._world)
        self._reader.skip()

    def _margin(self) -> float:
        """Return by how much the condition holds now [SI]."""
        self._record.add()
        return self._condition.margin(self._now())

    def _begins(self) -> bool:
        """Whether the condition holds at the last moment that was read, and did not at the one before."""
        held, self._held = self._held, self._condition.holds(self._now())
        return self._held and not held

    def _now(self) -> Figures:
        return Figures(self._record, None, len(self._record.times) - 1)


class _Replay:
    """Finds parts of a run when they are first read: in a copy of its world, which is put to its instants.

    Parameters
    ----------
    world : World
        The world at the end.
    records : list of arrays of IMPACT (n,)
        The impacts.
    begin : Booked
        The books at the beginning.
    frame : Keyframe
        The world at the beginning: with the joints that broke since.
    """

    def __init__(self, world: World, records: list[NDArray[Any]], begin: Booked, frame: Keyframe) -> None:
        self._records, self._books = records, (begin, read_books(world))
        self._frame, self._name = frame, world.title or world.name
        frame.take_records(world)
        self._systems = world.schedule.systems[1:]
        self._broken = breaks_of(self._systems, world.time)
        self._view = world.view
        self._made: World | None = None
        self._whole: Keyframe | None = None

    def __getstate__(self) -> dict[str, Any]:
        """Return what goes to another process: the copy, as worlds do, and what its systems recorded."""
        kept = {"_records": self._records, "_books": self._books, "_broken": self._broken}
        made = self._copy()
        seen = {system.name: own for system in made.schedule.running if (own := system.keep())}
        return {"_name": self._name, "_made": made, "_whole": None, "_seen": seen, **kept}

    def __setstate__(self, kept: dict[str, Any]) -> None:
        seen = kept.pop("_seen")
        self.__dict__.update(kept)
        made = kept["_made"]
        made.synchronise()
        for system in made.schedule.running:
            if system.name in seen:
                system.restore(seen[system.name])

    def _copy(self) -> World:
        """Return the copy as at the beginning, with what has been recorded since."""
        if self._made is None:
            self._made = World(systems=[system.fresh() for system in self._systems])
            self._frame.fill(self._made)
            self._made.view = self._view
        if self._whole is None:
            self._whole = Keyframe(self._made)
        else:
            self._whole.restore(self._made)
        for system in self._made.schedule.systems:
            if isinstance(system, BreakSystem):
                system.broken = self._broken
        return self._made

    def _instants(self, run: Run) -> Iterator[World]:
        """Yield the copy at each instant, with the joints that are not broken by then."""
        world, broken = self._copy(), [one for one in self._broken if one.time > run.times[0]]
        for time, bodies in zip(run.times.tolist(), run.motion, strict=True):
            world.time = time
            while broken and broken[0].time <= time:
                with world.active():
                    remove_joint(broken[0].entity, COMPONENTS[broken.pop(0).kind])
                world.synchronise()
            put_motion(world, moving_rows(world), bodies)
            yield world

    def impacts(self) -> dict[str, NDArray[Any]]:
        """Return the table of impacts."""
        return impact_table(self._copy(), np.concatenate([NO_IMPACTS, *self._records]))

    def account(self) -> dict[str, float]:
        """Return the energy given by each cause [J]."""
        begin, end = self._books
        return end.accounts().after(begin.accounts()).energy

    def sums(self, run: Run) -> Mapping[str, Column]:
        """Return the energies of the world at each instant [J]."""
        energies = [measure_energy(world) for world in self._instants(run)]
        found = np.array([(one.kinetic, one.stored, one.total) for one in energies]).reshape(-1, 3)
        return {f"world.{name}": found[:, k] for k, name in enumerate(_SUMS)}

    def page(self, run: Run) -> bytes:
        """Return the page that plays the run; what makes pages stands above what measures."""
        made: bytes = import_module("physicslab.export.page").page_of(self._instants(run), self._name)
        return made
