"""The task sent to other processes: a scene, its rows, its measures; and how a row is run there."""

from __future__ import annotations

import hashlib
import inspect
import json
import math
import pickle
import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Material, Shape, Velocity
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.fields import InvalidValue
from physicslab.ecs.text import printable, shortened
from physicslab.ensembles.measures import Measure, Measures
from physicslab.ensembles.rollout import Rollout
from physicslab.ensembles.space import Space, Values
from physicslab.files.assignments import put
from physicslab.files.checks import SceneError, shown
from physicslab.files.places import Place, entity_names, find_place
from physicslab.files.reader import read_scene
from physicslab.integrators.exact import EXACT
from physicslab.kernels.keys import sources_key
from physicslab.kernels.tiers import compile_first
from physicslab.stepping.partition import is_one
from physicslab.stepping.planning import choose_plan
from physicslab.stepping.run import run_length
from physicslab.world import World

_SETTLED = ("Transform", "Velocity", "Mass")
"""Components whose values decide nothing about which systems a world needs."""
_REASON_LIMIT = 300


@dataclass(frozen=True)
class Task:
    """An ensemble without its results.

    Attributes
    ----------
    scene : bytes
        The scene as a JSON document.
    space : Space
        The rows.
    measures : mapping of str to str or callable
        Measures of each run, by their columns.
    seconds, steps : float or int, optional
        How long a run is, at most; one of the two.
    until : str, optional
        A condition with which it ends.
    """

    scene: bytes
    space: Space
    measures: Mapping[str, Measure]
    seconds: float | None
    steps: int | None
    until: str | None = None

    @cached_property
    def payload(self) -> bytes:
        """The bytes sent with each piece of work."""
        return pickle.dumps({part.name: getattr(self, part.name) for part in fields(self)})

    @cached_property
    def digest(self) -> bytes:
        """32 bytes that differ where a row of the same values would differ: scene, length, measures, code."""
        measures = {
            name: one if isinstance(one, str) else _code_of(one) for name, one in self.measures.items()
        }
        settings = json.dumps([self.seconds, self.steps, self.until, measures, sources_key()])
        return hashlib.sha256(self.scene + b"\0" + settings.encode()).digest()

    def keys(self, columns: Mapping[str, Values]) -> NDArray[np.uint8]:
        """Return a key (n, 32) for each row of these values, by which its result is found again."""
        names = json.dumps([*columns]).encode()
        head = hashlib.sha256(self.digest + names)
        found = bytearray()
        for row in zip(*(column.tolist() for column in columns.values()), strict=True):
            key = head.copy()
            key.update(repr(row).encode())
            found += key.digest()
        if not columns:
            found += head.digest() * len(self.space)
        return np.frombuffer(bytes(found), np.uint8).reshape(-1, 32)

    def world(self, row: int) -> World:
        """Return the world of a row before its first step."""
        world = read_scene(json.loads(self.scene), "the scene")
        values = {name: column[0] for name, column in self.space.columns(row, row + 1).items()}
        places = places_of(world, self.space)
        put(world, {place: _plain(values[name]) for name, place in places.items()})
        return world


def _code_of(function: Any) -> str:
    """Return what names a function, and changes where its source does."""
    try:
        source = inspect.getsource(function)
    except (OSError, TypeError):
        source = ""
    return f"{function.__module__}.{function.__qualname__} {source}"


def places_of(world: World, space: Space) -> dict[str, Place]:
    """Return the fields of a space in a world, by their columns."""
    names = entity_names(world)
    return {axis.name: find_place(world, "space", axis.path, "", names) for axis in space.axes}


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


@dataclass(frozen=True)
class Block:
    """The results of some rows.

    Attributes
    ----------
    first : int
        The first of them.
    values : float64 array (n, measures)
        The measures [SI], NaN where a run failed.
    wall_s : float64 array (n,)
        How long each took [s].
    failures : dict of int to str
        Why a row, by its number, has no result, or not all of it.
    """

    first: int
    values: NDArray[np.float64]
    wall_s: NDArray[np.float64]
    failures: dict[int, str]

    def note(self, number: int, why: str) -> None:
        """Keep why a run, by its place in the block, has no result, if there is a reason."""
        if why:
            self.failures[self.first + number] = shortened(printable(why), _REASON_LIMIT)


class Runner:
    """Runs rows of a task, one after the other, in one world where that is possible."""

    def __init__(self, task: Task) -> None:
        compile_first()
        self.task = task
        self._names = list(task.measures)
        world = read_scene(json.loads(task.scene), "the scene")
        world.mark()
        self._measures = Measures(world, task.measures)
        self._world = world
        self._places = places_of(world, task.space)
        kinds = {place.kind for place in self._places.values()}
        self._in_place = all(map(_is_plain, self._places.values()))
        self._handles = self._found_handles() if self._in_place else []
        self._note_rows()
        self._plan = world.plan
        self._alone = is_one(world, world.schedule)
        laws = PhysicsConfig in kinds
        running, read = set(world.schedule.running), self._measures.read_at_end
        self._asked = [
            (system, system in running)
            for system in world.schedule.systems
            if laws or any(kind in kinds and kind.__name__ not in _SETTLED for kind in system.needs)
        ]
        self._rollout: Rollout | None = None
        rolls = self._in_place and self._alone and not laws and task.until is None
        if rolls and self._places and read is not None:
            orbits = world.plan.smooth and world.plan.integrator is EXACT and not self._asked
            orbits = orbits and any(force.attractors for force in world.schedule.smooth_forces)
            same = (lambda: True) if orbits else self._chooses_the_same  # the flow itself refuses
            self._rollout = Rollout(world, self._places, read, same, self._measures.of_impacts)

    def block(self, first: int, last: int) -> Block:
        """Run the rows from ``first`` up to ``last``."""
        columns = self.task.space.columns(first, last)
        block = Block(first, np.full((last - first, len(self._names)), math.nan), np.zeros(last - first), {})
        made = self._roll_out(block, columns)
        rows = [*zip(*(columns[name].tolist() for name in self._places), strict=True)] or [()] * len(made)
        for number in np.flatnonzero(~made).tolist():
            began, why = time.perf_counter(), ""
            try:
                block.values[number], why = self._run(rows[number])
            except Exception as error:  # of whatever kind: the other rows go on
                why = _reason(error)
            block.note(number, why)
            block.wall_s[number] = time.perf_counter() - began
        return block

    def _roll_out(self, block: Block, columns: Mapping[str, Values]) -> NDArray[np.bool_]:
        """Make what runs of a block need no world of their own; return which (n,) those are."""
        if self._rollout is None:
            return np.zeros(len(block.wall_s), np.bool_)
        began, world = time.perf_counter(), self._world
        length = run_length(world, self.task.seconds, self.task.steps)
        ends, impacts, made = self._rollout.run(columns, length)
        found = self._measures.values_at(world.time + length.seconds, ends[made], impacts[made])
        for number, (values, why) in zip(np.flatnonzero(made).tolist(), found, strict=True):
            block.values[number] = values
            block.note(number, why)
        block.wall_s[made] = (time.perf_counter() - began) / max(1, int(made.sum()))
        return made

    def _run(self, row: Sequence[Any]) -> tuple[list[float], str]:
        """Make the run of a row; return its measures, and why one of them is no number."""
        world, measures = self._world, self._measures
        if not self._in_place or not self._set(row):
            world = read_scene(json.loads(self.task.scene), "the scene")
            put(world, dict(zip(self._places.values(), row, strict=True)))
            measures = Measures(world, self.task.measures)
        measures.begin()
        if self.task.until is not None or measures.path_is_motion:
            self._record(world, measures)
        elif measures.needs_path:
            for _ in world.stepping(seconds=self.task.seconds, steps=self.task.steps):
                measures.sample()
        else:
            world.run(seconds=self.task.seconds, steps=self.task.steps)
        return measures.values()

    def _record(self, world: World, measures: Measures) -> None:
        """Make a run that is recorded, as it ends with a condition or measures look at its motion."""
        task, length = self.task, run_length(world, self.task.seconds, self.task.steps)
        run = world.record(length.seconds, until=task.until)
        if task.until is not None and run.found is None:
            raise SceneError(f"until {shown(task.until)}: does not begin to hold within {length.seconds:g} s")
        measures.take(run)

    def _set(self, row: Sequence[Any]) -> bool:
        """Go back and give the fields their values; return whether all else is as in a world made so."""
        world = self._world
        world.reset()
        if self._changes != world.entity_index.changes:
            self._handles = self._found_handles()
            self._note_rows()
        for place, handle, value in zip(self._places.values(), self._handles, row, strict=True):
            try:
                if handle is None:
                    place.write(world, value)
                    continue
                held = getattr(handle, place.spec.name) if place.part else None
                setattr(handle, place.spec.name, place.whole(held, value))
            except InvalidValue as error:
                raise SceneError(f"{place.words} = {shown(value)}: must be {error.allowed}") from error
        with world.active():
            if self._alone and self._bounces():
                return True
            world.synchronise()
            if not (self._alone or world.islands.hold(world)):
                world.islands.forget(world)
                world.synchronise()
            if self._chooses_the_same():
                return True
        if not self._alone:
            world.stale = world.entity_index.motion_edited = True
        return not self._alone

    def _found_handles(self) -> list[Any]:
        """Return the components of which fields differ, ``None`` for the laws."""
        return [
            None if place.kind is PhysicsConfig else self._world.component(place.entity, place.kind)
            for place in self._places.values()
        ]

    def _note_rows(self) -> None:
        """Note which rows have a velocity, and which a shape, until entities come or go."""
        world = self._world
        self._changes = world.entity_index.changes
        self._moving = np.flatnonzero(world.table(Velocity).present).tolist()
        self._shaped = np.flatnonzero(world.table(Shape).present)

    def _chooses_the_same(self) -> bool:
        """Whether the same systems and the same method would be chosen for the values of now."""
        world = self._world
        if self._bounces():
            return True
        for system, runs in self._asked:
            if (system.why_left_out(world) is None) != runs:
                return False
        return choose_plan(world, world.schedule) == self._plan

    def _bounces(self) -> bool:
        """Whether the flight of one body from impact to impact, which was chosen, is chosen again."""
        world, plan = self._world, self._plan
        if self._asked or plan.collisions != "exact" or len(self._moving) != 1:
            return False
        x, y = world.table(Velocity)["linear"][self._moving[0]].tolist()
        physics = world.physics
        bounces = min(world.table(Material)["restitution"][self._shaped].tolist(), default=1.0) > 0.0
        is_slow = math.hypot(x, y) <= physics.gravity.magnitude * world.simulation.dt
        return bounces and not is_slow and (physics.bounds is None or physics.bounds_restitution > 0.0)


def _is_plain(place: Place) -> bool:
    """Whether a field can have another value in a world that stays as it is otherwise."""
    spec = place.spec
    return (
        place.kind is not SimulationConfig
        and spec.kind in ("number", "vector")
        and not (spec.fixed or spec.derived)
    )


def _reason(error: Exception) -> str:
    known = isinstance(error, SceneError | InvalidValue | ArithmeticError) and str(error)
    return str(error) if known else f"{type(error).__name__}: {error}"


def ready() -> None:
    """Do nothing, in a process that has imported this module by then."""


_kept = threading.local()


def work(payload: bytes, first: int, last: int) -> Block:
    """Run some rows of a task, in a process, or a thread, that keeps the world for the next ones."""
    if getattr(_kept, "payload", None) != payload:
        _kept.runner, _kept.payload = Runner(Task(**pickle.loads(payload))), payload
    runner: Runner = _kept.runner
    return runner.block(first, last)
