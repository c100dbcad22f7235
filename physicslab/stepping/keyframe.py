"""A world at one moment, as raw columns: what a scene file keeps, to go back to in place.

It keeps the same of contacts, sleep, remainders and choices as a scene file does, and the
world goes on from it as it does from a file: pairs are listed again, contacts that had a slot get it again
(:mod:`physicslab.contacts.near_pairs`). But records and columns are copied as they are, not written out as
numbers, and entities keep theirs.
"""

from __future__ import annotations

import weakref
from collections.abc import Iterator, Sequence
from copy import copy, deepcopy
from dataclasses import dataclass, replace
from typing import Any, Protocol, cast

import esper
import numpy as np
from numpy.typing import NDArray

from physicslab.contacts.kept import KeptContacts, KeptSleep, forget_sleep, shared
from physicslab.ecs.component import Component
from physicslab.ecs.config import PhysicsConfig, SimulationConfig
from physicslab.ecs.context import create_numbered
from physicslab.state.account import KeptAccount
from physicslab.state.contents import SCENE_TEXTS
from physicslab.state.remainders import Remainders
from physicslab.state.state import State
from physicslab.stepping.accounting import kept_joints, restore_joints
from physicslab.stepping.island import Island, Part
from physicslab.stepping.islands import Islands
from physicslab.stepping.plan import StepPlan

type _Array = NDArray[Any]
type _Columns = tuple[_Array, ...]

_COUNTS = (
    "time", "steps", "substeps", "step_divisions", "force_evaluations", "collisions", "returned_inside",
)  # fmt: skip
"""Other counts of a world."""


class Kept(Part, Protocol):
    """The parts of a world that a key frame needs; a world is a state as well."""

    islands: Islands

    def edited(self) -> None:
        """Note that columns or components were changed from outside."""

    def adopt(self, plan: StepPlan, remade: int) -> None:
        """Go on by a plan, with steppers that keep nothing of the steps made since."""


@dataclass(slots=True, eq=False)
class _Structure:
    """Which entities there are, in which rows, and of which components.

    Attributes
    ----------
    world : weak reference
        The world that last had it: one island may be followed by another of the same bodies.
    changes : int
        That of its entity index then; nothing has come or gone there while it is the same.
    entities : int64 array (rows,)
        The entity of each row, 0 for blank ones.
    present : dict of component type to bool array (rows,)
        Whose entity has it.
    others : dict of int to tuple of objects
        The components of each entity that have no columns, such as its name.
    """

    world: weakref.ref[State]
    changes: int
    entities: NDArray[np.int64]
    present: dict[type[Any], NDArray[np.bool_]]
    others: dict[int, tuple[Any, ...]]

    @classmethod
    def of(cls, world: State) -> _Structure:
        index = world.entity_index
        others: dict[int, tuple[Any, ...]] = {}
        for entity in index.row_of:
            parts: tuple[Any, ...] = esper.components_for_entity(entity)
            plain = tuple(part for part in parts if not isinstance(part, Component))
            if plain:
                others[entity] = plain
        present = {kind: table.present.copy() for kind, table in index.tables.items() if table.handles}
        return cls(weakref.ref(world), index.changes, index.entities.copy(), present, others)

    def is_unchanged(self, world: State) -> bool:
        """Whether the world has had it last, and nothing came or went since."""
        return self.world() is world and self.changes == world.entity_index.changes

    def is_that_of(self, world: State) -> bool:
        """Whether that is so, and rows are numbered alike."""
        return self.is_unchanged(world) and np.array_equal(self.entities, world.entity_index.entities)

    def restore(self, world: State) -> None:
        """Make the same entities of the same components; what is there already stays as it is."""
        wanted = {int(entity): list(self.others.get(int(entity), ())) for entity in self.entities if entity}
        kinds: dict[int, set[type[Any]]] = {entity: set() for entity in wanted}
        for kind, present in self.present.items():
            for entity in self.entities[present].tolist():
                kinds[entity].add(kind)
        for entity in [entity for entity in esper.get_entities() if entity not in wanted]:
            esper.delete_entity(entity, immediate=True)
        living = set(esper.get_entities())
        for entity, others in wanted.items():
            if entity not in living:
                made = [world.table(kind).blank() for kind in kinds[entity]]
                create_numbered(entity, [*made, *others])
                continue
            there: tuple[Any, ...] = esper.components_for_entity(entity)
            for part in there:
                kind = type(part)
                if kind not in kinds[entity] and not any(part is other for other in others):
                    esper.remove_component(entity, kind)
            for kind in kinds[entity]:
                if not esper.has_component(entity, kind):
                    esper.add_component(entity, world.table(kind).blank())
            for other in others:
                if esper.try_component(entity, type(other)) is not other:
                    esper.add_component(entity, other)


class Keyframe:
    """All that a world needs to go on from one moment bit for bit, in copies that nothing changes.

    Parameters
    ----------
    world : World
        The world, between two steps.
    last : Keyframe, optional
        Arrays that are the same there are shared with it.
    """

    __slots__ = (
        "_account", "_apart_until", "_columns", "_contacts", "_counts", "_forces", "_islands", "_joints",
        "_laws", "_own", "_paired", "_plan", "_rates", "_remade", "_remainders", "_sleep", "_structure",
        "_texts",
    )  # fmt: skip

    def __init__(self, world: Kept, last: Keyframe | None = None) -> None:
        assert isinstance(world, State)
        world.synchronise()
        same = last is not None and last._structure.is_that_of(world)
        with world.active():
            self._structure: _Structure = (
                last._structure if last is not None and same else _Structure.of(world)
            )
        tables = world.entity_index.tables
        known = last._columns if last is not None and same else {}
        self._columns: dict[type[Any], _Columns] = {
            kind: shared(tables[kind].columns, known.get(kind)) for kind in self._structure.present
        }
        self._paired: tuple[_Array | None, list[tuple[_Array, _Array]]] = None, []
        self._counts = {name: getattr(world, name) for name in _COUNTS}
        self._laws: tuple[PhysicsConfig, SimulationConfig] = world.physics, world.simulation
        self._texts = {key: getattr(world, key) for key in SCENE_TEXTS}
        self._plan, self._remade = world.plan, world.schedule.remade
        self._rates = dict(world.fastest_rates)
        self._remainders: Remainders = world.remainders
        self._account: KeptAccount = world.account.keep()
        self._forces: _Columns = shared(
            (world.bodies.force, world.bodies.torque), last._forces if last is not None else None
        )
        self._own: dict[str, _Columns] = {}
        self.take_records(world)
        parts = {} if last is None else {entities.tobytes(): part for entities, part in last._islands}
        self._islands: list[tuple[_Array, Keyframe]] = []
        self._apart_until = world.islands.apart_until
        for island in world.islands.members:
            part = Keyframe(cast(Kept, island.world), parts.get(island.entities.tobytes()))
            self._islands.append((island.entities, part))
        before = (last._contacts, last._sleep) if last is not None else (None, None)
        self._contacts: KeptContacts = KeptContacts.of(world.contacts, before[0])
        self._sleep: KeptSleep = KeptSleep.of(world.sleep, before[1])
        self._joints = kept_joints(world)

    def take_records(self, world: Kept) -> None:
        """Keep what the systems of a world have recorded by now."""
        assert isinstance(world, State)
        self._own = {system.name: kept for system in world.schedule.running if (kept := system.keep())}

    def arrays(self) -> Iterator[_Array]:
        """Yield every array, for the memory that they take."""
        yield self._structure.entities
        yield from self._structure.present.values()
        for columns in self._columns.values():
            yield from columns
        yield from self._forces
        for kept in self._own.values():
            yield from kept
        yield from self._contacts.arrays()
        yield from self._sleep.arrays()
        for entities, part in self._islands:
            yield entities
            yield from part.arrays()
        low = self._remainders
        yield from (low.keys, low.q, low.v, low.q_low, low.v_low)

    def fill(self, world: Kept) -> None:
        """Put another world, which has no entities yet, to this moment."""
        frame, alone = copy(self), {}
        for entity, others in self._structure.others.items():
            alone[entity] = tuple(deepcopy(other) for other in others)
        frame._structure, frame._remade = replace(self._structure, changes=-1, others=alone), -1
        frame.restore(world)

    def restore(self, world: Kept) -> None:
        """Put the world back to this moment, in place; every entity has the number that it had."""
        assert isinstance(world, State)
        world.edited()
        before, world.islands.paused = world.islands.members, True
        world.islands.forget(world)
        structure, index = self._structure, world.entity_index
        with world.active():
            if index.synchronise():
                world.stale = True
            if not structure.is_unchanged(world):
                structure.restore(world)
                world.stale |= index.synchronise()
                structure.world, structure.changes = weakref.ref(world), index.changes
            there = self._put_columns(world)
            if (world.physics, world.simulation) != self._laws:
                world.physics, world.simulation = self._laws
            for name, value in (*self._counts.items(), *self._texts.items()):
                setattr(world, name, value)
            forget_sleep(world.sleep)
            if world.stale:  # rows of pairs are followed; else they are dropped where others are given back
                world.contacts.clear()
            world.synchronise()
            world.adopt(self._plan, self._remade)
        self._contacts.restore(world)
        self._sleep.restore(world, there)
        restore_joints(world, self._joints)
        for now, then in zip((world.bodies.force, world.bodies.torque), self._forces, strict=True):
            _put(then, now, there)
        for system in world.schedule.running if self._own else ():
            if system.name in self._own:
                system.restore(self._own[system.name])
        world.remainders = self._remainders
        world.account.restore(self._account)
        world.fastest_rates.update(self._rates)
        self._restore_islands(world, before)

    def _put_columns(self, world: State) -> NDArray[np.int64] | None:
        """Write every column; return where the rows of then are, -1 for blank ones, ``None`` for the same."""
        index, entities = world.entity_index, self._structure.entities
        followed, paired = self._paired
        if followed is not index.entities:  # numbered again: columns may be in other memory as well
            tables = ((world.table(kind).columns, then) for kind, then in self._columns.items())
            paired = [pair for now, then in tables for pair in zip(now, then, strict=True)]
            if entities.tobytes() != index.entities.tobytes():
                there = np.where(entities > 0, index.rows_of(entities), -1)
                for now, then in paired:
                    _put(then, now, there)
                return there
            self._paired = index.entities, paired
        for now, then in paired:
            now[:] = then
        return None

    def _restore_islands(self, world: Kept, before: Sequence[Island]) -> None:
        """Let the islands go on from that moment, in the worlds that the same ones had ``before``."""
        assert isinstance(world, State)
        there = {island.entities.tobytes(): island.world for island in before}
        members: list[Island] = []
        for entities, frame in self._islands:
            part = there.get(entities.tobytes())
            if part is None:
                part, frame = world.islands.blank(world), copy(frame)
                frame._structure = replace(frame._structure, changes=-1)
            frame.restore(cast(Kept, part))
            members.append(Island(part, entities))
        world.islands.adopt(world, members)
        world.islands.apart_until = self._apart_until


def _put(then: _Array, now: _Array, rows: NDArray[np.int64] | None) -> None:
    """Write the rows of a column of ``then`` where they are now: -1 for blank ones, ``None`` for the same."""
    if rows is None:
        now[1:] = then[1:]
    else:
        now[rows[rows > 0]] = then[rows > 0]
