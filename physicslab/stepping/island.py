"""An island: some bodies of a world, and a world of their own that advances them."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import esper
import numpy as np
from numpy.typing import NDArray

from physicslab.components import Gear, Name, Shape, Transform, Velocity
from physicslab.contacts.arguments import motion_of
from physicslab.contacts.kept import KeptContacts, carry_sleep
from physicslab.ecs.component import Component
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.context import create_numbered
from physicslab.ecs.table import Table, as_slice
from physicslab.kernels import Plain, near_counts
from physicslab.kernels.arguments import Motion
from physicslab.kernels.clock import time_after
from physicslab.state.remainders import Remainders, coordinate_keys
from physicslab.state.state import State
from physicslab.stepping.accounting import kept_joints, restore_joints
from physicslab.stepping.breaks import Overloaded
from physicslab.stepping.partition import MAX_BODIES, movable_in
from physicslab.stepping.plan import StepPlan
from physicslab.stepping.planning import choose_plan, outlived
from physicslab.stepping.run import Stepped
from physicslab.stepping.select import Steppers
from physicslab.systems.schedule import Schedule
from physicslab.systems.standard import PHYSICS_SYSTEMS
from physicslab.systems.system import System

type Rows = NDArray[np.int64]
"""Numbers of rows or entities (n,)."""

_COUNTED = ("force_evaluations", "collisions", "returned_inside")
"""Counts of a world that are sums over its islands."""
_IMPACTS = np.array([near_counts.LOWERED, near_counts.ENERGETIC])


class Part(Stepped, Protocol):
    """The parts of a world that its islands need."""

    plan: StepPlan
    steppers: Steppers

    def resume(self, collisions: str, method: str, steps: int) -> None:
        """Go on with what was chosen earlier."""

    def go_on(self, h: float, steps: int) -> int:
        """Make steps as the last ones were made, if nothing was edited; return how many."""

    def book_edits(self) -> None:
        """Book what was changed since the last step."""


type Make = Callable[[Sequence[System], PhysicsConfig, SimulationConfig], Part]


class Island:
    """Some bodies, and the world that advances them.

    Attributes
    ----------
    world, state : Part, State
        That world, and the same as what it holds.
    entities : int64 array (n,)
        The bodies that are its own, in order.
    own, there : int64 arrays (n,)
        Their rows in its world, and in the whole one.
    shaped : int64 array (k,)
        Rows in the whole world of those that can touch others.
    every, every_there : int64 arrays (m,)
        Those of all its entities, fixed bodies and springs among them.
    """

    def __init__(self, world: Part, entities: Rows) -> None:
        assert isinstance(world, State)
        self.world: Part = world
        self.state: State = world
        self.entities = entities
        self.own = self.there = self.shaped = self.every = self.every_there = np.zeros(0, np.int64)
        self._slices: tuple[Any, Any] = self.own, self.there

    @property
    def touches(self) -> bool:
        """Whether any of its bodies can touch another."""
        return len(self.shaped) > 0

    def follow_rows(self, state: State) -> None:
        """Find its rows again in the whole world."""
        index, self.state.joints.watched = self.state.entity_index, state.joints.watched
        self.own, self.there = index.rows_of(self.entities), state.entity_index.rows_of(self.entities)
        self._slices = as_slice(self.own), as_slice(self.there)
        self.every = np.flatnonzero(index.entities)
        self.every_there = state.entity_index.rows_of(index.entities[self.every])
        self.shaped = self.there[self.state.table(Shape).present[self.own]]

    def stored(self) -> float:
        """Return the energy in its springs and fields that is no weight [J]."""
        stores = [force for force in self.world.schedule.forces if force.potential is not None]
        return sum(
            force.potential_energy(self.state)
            for force in stores
            if force.uniform_acceleration(self.state) is None
        )

    def take(self, state: State, changed: NDArray[np.bool_]) -> None:
        """Follow what was edited in rows (rows,) of the whole world, which books it."""
        edited = changed[self.every_there]
        if edited.any():
            copy_rows(state, self.state, self.every_there[edited], self.every[edited])
            self.world.book_edits()

    def chooses_the_same(self) -> bool:
        """Whether the same systems and the same method would be chosen for it as it is now."""
        own, world = self.state, self.world
        with own.active():
            return world.schedule.holds(own) and choose_plan(own, world.schedule) == world.plan

    def go(self, state: State, time: float, h: float, steps: int, driven: Rows) -> int:
        """Advance by ``steps`` steps of ``h`` seconds from ``time`` [s] on; return how many it made.

        Those are fewer where a joint bears less than its load at the end of the next one.
        Its bookings and counts are added to those of the whole world, and samples are taken of its bodies and
        of ``driven`` rows.
        """
        own, samples = self.state, state.samples
        part = None if samples is None else samples.part(own, time, steps * h)
        own.contacts.read = state.contacts.read
        counts, impacts = [getattr(own, name) for name in _COUNTED], own.contacts.counts[_IMPACTS]
        own.time, own.samples, sums = time, part, own.account.sums.copy()
        done = self.world.go_on(h, steps) if self.touches else 0
        if done < steps:
            with own.active():
                while done < steps:
                    own.time = time_after(time, h, done)
                    self.world.synchronise()
                    # Smooth motion depends on where it is divided, and that on what else there is.
                    single = self.touches and self.world.stepper_for(h).leaps
                    try:
                        done += self.world.advance(h, 1 if single else steps - done)
                    except Overloaded as found:
                        steps = done + found.steps - 1
                        if not steps:
                            raise
        own.time = time_after(time, h, done)
        if samples is not None and part is not None:
            samples.join(part, *self._with(state, driven))
            own.samples = None
        state.account.sums += own.account.sums - sums
        for name, count in zip(_COUNTED, counts, strict=True):
            setattr(state, name, getattr(state, name) + getattr(own, name) - count)
        state.contacts.counts[_IMPACTS] += own.contacts.counts[_IMPACTS] - impacts
        state.substeps = max(state.substeps, own.substeps)
        for name, rate in own.fastest_rates.items():
            state.fastest_rates[name] = max(rate, state.fastest_rates.get(name, 0.0))
        return done

    def _with(self, state: State, driven: Rows) -> tuple[Rows, Rows]:
        """Return its bodies' and ``driven`` rows, in its world and in the whole one."""
        entities = state.entity_index.entities[driven]
        own = np.concatenate((self.own, self.state.entity_index.rows_of(entities)))
        return own, np.concatenate((self.there, driven))

    def write_back(self, state: State, motion: Plain[Motion], driven: Rows) -> None:
        """Write how its bodies move, and which sleep, to the whole world, and so ``driven`` rows of that."""
        own, there = self._with(state, driven) if len(driven) else self._slices
        for column, part in zip(motion, motion_of(self.state), strict=True):
            column[there] = part[own]
        if self.state.sleep.on:
            own, there = self._slices
            whole, part = state.sleep, self.state.sleep
            whole.asleep[there], whole.rest[there] = part.asleep[own], part.rest[own]
            whole.slowest[there] = part.slowest[own]


def in_order(members: Iterable[Island]) -> tuple[Island, ...]:
    """Return islands in the order of their first bodies."""
    return tuple(sorted(members, key=lambda island: int(island.entities[0])))


def blank_world(state: State, schedule: Schedule, make: Make) -> Part:
    """Return a world without bodies, with the systems of a ``schedule`` that act within a step."""
    systems = [
        system.fresh()
        for system in schedule.systems
        if type(system) in PHYSICS_SYSTEMS and system.acts_within_step()
    ]
    with state.active():  # a new world is the active one until the end of the block
        part = make(systems, state.physics, state.simulation)
    part.schedule.note_into(schedule)
    return part


def make_island(state: State, world: Part, entities: Rows, sources: Sequence[State]) -> Island:
    """Return an island of some bodies in a blank world; of these ``sources`` have contacts and rests."""
    island = Island(world, entities)
    part = island.state
    fixed = state.table(Transform).present & ~movable_in(state)
    fill(state, part, entities, state.entity_index.entities[np.flatnonzero(fixed)])
    part.time, part.steps = state.time, state.steps
    world.synchronise()
    # Slots of wide contacts are those of one world, and no matter of few bodies.
    apart = len(sources) > 1 or len(entities) <= MAX_BODIES
    kept = [KeptContacts.of(source.contacts).among(entities, apart=apart) for source in sources]
    KeptContacts.joined(kept, part.contacts.counts).restore(part)
    for source in sources:
        carry_sleep(source, part)
    restore_joints(part, [kept for source in sources for kept in kept_joints(source)], *sources)
    part.remainders = Remainders.joined([source.remainders for source in sources])
    return island


def fill(state: State, part: State, entities: Rows, fixed: Rows) -> None:
    """Make in another state the same entities: ``entities`` and their springs, and what is ``fixed``.

    Bodies get their numbers, columns and names; components that nothing moves by are left out.
    """
    index = state.entity_index
    kinds = [
        (kind, table) for kind, table in index.tables.items() if issubclass(kind, Component) and table.handles
    ]
    physical = [(kind, table) for kind, table in kinds if kind.physical]
    own, placed = set(entities.tolist()), set(entities.tolist()) | set(fixed.tolist())
    made: dict[int, list[Any]] = {entity: [] for entity in sorted(placed)}
    joined: set[int] = set()
    for kind, table in sorted(physical, key=lambda one: one[0] is Gear):  # which couples joints
        ends = [spec.name for spec in kind.FIELDS if spec.kind == "entity"]
        for entity in sorted(table.handles):
            if ends:
                row = index.row_of[entity]
                held = {int(table[name][row]) for name in ends} - {0}
                held |= {entity} & placed if _holds_itself(table, row, ends) else set()
                if not (held <= joined if kind is Gear else held <= placed and held & own):
                    continue
                joined.add(entity)
            elif entity not in placed:
                continue
            made.setdefault(entity, []).append(table.blank())
    with state.active():
        names = {entity: esper.try_component(entity, Name) for entity in made}
    with part.active():
        for entity in sorted(made):
            name = names[entity]
            create_numbered(entity, made[entity] + ([] if name is None else [name]))
        part.entity_index.synchronise()
    every = np.array(sorted(made), np.int64)
    copy_rows(state, part, index.rows_of(every), part.entity_index.rows_of(every))


def _holds_itself(table: Table, row: int, ends: list[str]) -> bool:
    """Whether a component holds the body of its own entity: its first end is not given."""
    return int(table[ends[0]][row]) == 0


def copy_rows(state: State, part: State, there: Rows, own: Rows) -> None:
    """Copy rows ``there`` of the components that a part has to its ``own`` rows."""
    for kind, table in part.entity_index.tables.items():
        if not table.handles:
            continue
        has = table.present[own]
        for column, whole in zip(table.columns, state.table(kind).columns, strict=True):
            column[own[has]] = whole[there[has]]


def copy_joints(part: State, state: State) -> None:
    """Copy what the joints of a part hold bodies with to those of the whole world."""
    if len(part.joints):
        there = {(joint.entity, joint.kind): joint.own for joint in state.joints.joints}
        for joint in part.joints.joints:
            for name in ("impulse", "force", "largest", "dependent"):
                whole = getattr(state.joints, name)
                whole[there[joint.entity, joint.kind]] = getattr(part.joints, name)[joint.own]


def rows_changed(numbers: Sequence[NDArray[Any]], left: bytes) -> NDArray[np.bool_]:
    """Return in which rows (rows,) columns are not as they were ``left``; all if there were others."""
    changed = np.zeros(len(numbers[0]), np.bool_)
    if len(left) != sum(column.nbytes for column in numbers):
        return ~changed
    start = 0
    for column in numbers:
        end = start + column.nbytes
        before = np.frombuffer(left[start:end], column.dtype).reshape(column.shape)
        changed |= (column != before).reshape(len(changed), -1).any(axis=1)
        start = end
    return changed


def join_logs(state: State, parts: list[State], logged: list[int]) -> None:
    """Add the impacts of all parts, from numbers ``logged`` on, to the log of the whole, in order of time."""
    if [part.contacts.logged for part in parts] != logged:
        new = [part.contacts.impacts_since(first) for part, first in zip(parts, logged, strict=True)]
        log, first = state.contacts.log, state.contacts.logged
        impacts = np.concatenate(new)
        impacts = impacts[np.argsort(impacts["time"], kind="stable")][-len(log) :]
        log[np.arange(first, first + len(impacts)) % len(log)] = impacts
        state.contacts.logged += len(impacts)


@dataclass(frozen=True, slots=True)
class KeptIsland:
    """Parts of an island that a file keeps, beside the contacts, rests and remainders of all bodies.

    Attributes
    ----------
    bodies : list of int
        Its entities.
    span, finer : float, int
        The time [s] over which impulses of its contacts act; by which factor its next step needs more
        substeps.
    chosen : tuple, optional
        Choices made for it as it once moved, where others would be made now (:attr:`StepPlan.kept`).
    driven : list of lists
        Entity, x, y [m] and angle of bodies that move at given speeds, and the remainders of these three,
        where there are any, or rounding has led them elsewhere than in the whole world.
    """

    bodies: list[int]
    span: float
    finer: int
    chosen: tuple[str, str, int] | None
    driven: list[list[float]]

    def is_fresh(self, state: State) -> bool:
        """Whether an island begins so."""
        simulation = state.simulation
        begins = self.finer == 1 and self.chosen is None and not self.driven
        return begins and self.span == simulation.dt / simulation.substeps

    def give_back(self, island: Island) -> None:
        """Let an island that was made of the same bodies go on from there."""
        part = island.state
        part.contacts.impulse_dt, part.contacts.substep_factor = self.span, self.finer
        for entity, *pose in self.driven:
            row, transform = part.entity_index.row_of[int(entity)], part.table(Transform)
            transform["position"][row], transform["angle"][row] = pose[:2], pose[2]
        own = {int(row[0]): ((*row[1:4], 0.0, 0.0, 0.0), (*row[4:], 0.0, 0.0, 0.0)) for row in self.driven}
        part.remainders = Remainders.joined([Remainders.of_bodies(own), part.remainders])
        if self.chosen is not None:
            with part.active():
                island.world.resume(*self.chosen)


def kept_of(state: State, island: Island) -> KeptIsland:
    """Return what a file keeps of an island."""
    part, contacts = island.state, island.state.contacts
    span = contacts.impulse_dt or part.simulation.dt / part.simulation.substeps
    rows = np.flatnonzero(part.table(Velocity).present & ~movable_in(part))
    entities = part.entity_index.entities[rows]
    poses, whole = _poses(part, rows), _poses(state, state.entity_index.rows_of(entities))
    q = np.concatenate((poses[:, :2].ravel(), poses[:, 2]))
    low, _ = part.remainders.of(coordinate_keys(entities, entities), q, q)
    numbers = np.column_stack((entities, poses, low[: 2 * len(rows)].reshape(-1, 2), low[2 * len(rows) :]))
    driven = numbers[(poses != whole).any(axis=1) | numbers[:, 4:].any(axis=1)].tolist()
    with part.active():
        chosen = outlived(part, island.world.schedule, island.world.plan)
    return KeptIsland(island.entities.tolist(), span, contacts.substep_factor, chosen, driven)


def _poses(state: State, rows: Rows) -> NDArray[np.float64]:
    """Return x, y [m] and angle of some rows (n, 3)."""
    transform = state.table(Transform)
    return np.column_stack((transform["position"][rows], transform["angle"][rows]))
