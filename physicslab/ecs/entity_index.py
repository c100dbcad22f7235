"""Which entity has which row: keeps a world's tables in step with esper."""

from collections.abc import Iterable, Mapping, Set
from operator import is_
from typing import Any

import esper
import numpy as np
from numpy.typing import NDArray

from physicslab.ecs.component import Component
from physicslab.ecs.table import Batch, Table


class _Nothing:
    """A component that no entity has: looking it up in esper is cheap, and shows whether anything changed."""


class EntityIndex:
    """The rows of one world. esper owns the entities and their components; :meth:`synchronise` follows.

    Row 0 is the world itself. The others are in the order of their entity ids, so that results do not depend
    on the order of a set. A removed entity leaves a blank row; blanks are closed up when they are many.

    Attributes
    ----------
    tables : dict of component type to Table
        Their columns share one numbering of rows.
    row_of : dict of int to int
        The row of each entity.
    entities : int64 array (rows,)
        The entity of each row; 0 for row 0 and for blank rows.
    lookup : int64 array (newest + 1,)
        The row of each entity id, -1 where there is none; ``lookup[0]`` is 0, the world.
    newest : int
        The highest entity id there has ever been.
    motion_edited : bool
        Whether a change concerned the motion since this was last set to false: a component that is physical
        came or went.
    revision : int
        How often entities, or components that are physical, have come or gone.
    changes : int
        How often entities or components of any kind have.
    """

    def __init__(self) -> None:
        self.tables: dict[type[Any], Table] = {}
        self.row_of: dict[int, int] = {}
        self.entities: NDArray[np.int64] = np.zeros(1, np.int64)
        self.lookup: NDArray[np.int64] = np.zeros(1, np.int64)
        self.newest = 0
        self.motion_edited = True
        self.capacity = 16
        self._components: dict[int, tuple[Any, ...]] = {}
        self._seen: list[Any] | None = None
        self.revision = self.changes = 0
        self._batches: dict[tuple[type[Any], ...], Batch] = {}
        self._physical: list[NDArray[Any]] | None = None

    def __len__(self) -> int:
        return len(self.entities)

    def synchronise(self) -> bool:
        """Follow what esper's active context holds; return whether anything had changed.

        esper hands out the same list object until something structural changes, which makes the test one
        comparison.
        """
        self.flush_deleted()
        if esper.get_component(_Nothing) is self._seen:
            return False
        self._batches.clear()
        self._physical = None
        living = set(esper.get_entities())
        renumbered = living != self.row_of.keys()
        if renumbered:
            self._follow_entities(living)
        changed: dict[int, tuple[Any, ...]] = {}
        known = self._components.get
        for entity in living:
            components: tuple[Any, ...] = esper.components_for_entity(entity)
            try:
                if known(entity) == components:  # handles are equal only to themselves
                    continue
            except Exception:  # a component of another program may define == in any way
                pass
            changed[entity] = components
            self._note_edit(entity, components)
        self._follow_components(changed)
        self._components.update(changed)
        self._seen = esper.get_component(_Nothing)
        self.changes += 1
        if renumbered or self.motion_edited:
            self.revision += 1
        return True

    def is_synchronous(self) -> bool:
        """Whether esper's active context still holds the same, so that no table has changed its rows."""
        return esper.get_component(_Nothing) is self._seen and not esper._dead_entities

    def blocks(self) -> list[NDArray[np.uint8]]:
        """Return the memory of all components; other blocks take its place when structure changes."""
        return [table.block for table in self.tables.values() if table.handles]

    def physical_columns(self) -> list[NDArray[Any]]:
        """Return every column that motion may depend on; others take its place when structure changes."""
        if self._physical is None:
            self._physical = [
                column
                for kind, table in self.tables.items()
                if table.handles and getattr(kind, "physical", True)
                for column in table.columns
            ]
        return self._physical

    def has_followed(self, entity: int) -> bool:
        """Whether the components of an entity of esper's active context are those that it had lately."""
        if self.is_synchronous():
            return True
        if entity in esper._dead_entities:
            return False
        present: tuple[Any, ...] = esper.components_for_entity(entity)
        known = self._components.get(entity)
        return known is not None and len(known) == len(present) and all(map(is_, known, present))

    def flush_deleted(self) -> None:
        """Delete the entities that ``esper.delete_entity`` marked.

        Raises
        ------
        KeyError
            If one of them was never there. esper would fail on it at this and every later step; here it fails
            once.
        """
        dead = esper._dead_entities
        if dead:
            unknown = dead.difference(esper.get_entities())
            dead -= unknown
            esper.clear_dead_entities()
            if unknown:
                raise KeyError(f"delete_entity({min(unknown)}): there is no such entity in this world")

    def _follow_entities(self, living: Set[int]) -> None:
        """Give each new entity a row, and blank the rows of those that are gone."""
        fresh = sorted(living - self.row_of.keys())
        if fresh and fresh[0] <= self.newest:  # ids started again: esper.clear_database() was called
            self._blank(list(self.row_of))
            fresh, self.newest = sorted(living), 0
        else:
            self._blank(self.row_of.keys() - living)
        if len(self.row_of) + 1 < len(self) // 2 or not self.row_of:
            self._close_up()
        start = len(self)
        self.entities = np.append(self.entities, np.array(fresh, np.int64))
        self.row_of.update(zip(fresh, range(start, len(self)), strict=True))
        while self.capacity < len(self):
            self.capacity *= 2
        for table in self.tables.values():
            table.resize(len(self), self.capacity)
        self.newest = max(self.newest, int(self.entities.max()))
        self.lookup = np.full(self.newest + 1, -1, np.int64)
        self.lookup[self.entities] = np.arange(len(self))
        self.lookup[0] = 0

    def _blank(self, gone: Iterable[int]) -> None:
        """Release what the entities had and leave their rows empty."""
        for entity in gone:
            for table in self.tables.values():
                if entity in table.handles:
                    table.release(entity)
            self.entities[self.row_of.pop(entity)] = 0
            self._note_edit(entity, ())
            self._components.pop(entity, None)

    def _note_edit(self, entity: int, components: tuple[Any, ...]) -> None:
        """Note whether a change to the ``components`` that an entity has now concerns the motion."""
        if self.motion_edited:
            return
        before = {id(part): part for part in self._components.get(entity, ())}
        after = {id(part): part for part in components}
        changed = [(before | after)[key] for key in before.keys() ^ after.keys()]
        self.motion_edited = any(getattr(type(part), "physical", True) for part in changed)

    def _close_up(self) -> None:
        """Move the rows in use to the front."""
        kept = np.concatenate(([0], np.flatnonzero(self.entities))).astype(np.int64)
        self.entities = self.entities[kept]
        self.row_of = {entity: row for row, entity in enumerate(self.entities.tolist()) if entity}
        for table in self.tables.values():
            table.compact(kept, self.row_of)

    def _follow_components(self, changed: Mapping[int, Iterable[Any]]) -> None:
        """Release what entities no longer have, then adopt what is new: a component may change its entity."""
        handles = {
            entity: {type(handle): handle for handle in components if isinstance(handle, Component)}
            for entity, components in changed.items()
        }
        for kind, table in self.tables.items():
            for entity in table.handles.keys() & handles.keys():
                if handles[entity].get(kind) is not table.handles[entity]:
                    table.release(entity)
        for entity, owned in handles.items():
            for kind, handle in owned.items():
                table = self.table(kind)
                if entity not in table.handles:
                    table.adopt(entity, handle, self.row_of[entity])

    def rows_of(self, entities: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return the rows (n,) of entities (n,), -1 where there is no such entity; 0 is the world's."""
        known = np.maximum(entities, 0)
        np.minimum(known, self.newest, out=known)  # clip takes three times as long for a few
        return np.where(known == entities, self.lookup[known], -1)

    def table(self, component: type[Any]) -> Table:
        """Return a component's table; one of blank rows where no entity has the component."""
        table = self.tables.get(component)
        if table is None:
            table = self.tables[component] = Table(component, self.capacity, len(self))
        return table

    def has_any(self, component: type[Any]) -> bool:
        """Whether any entity has a component; no table is made for one that none has."""
        table = self.tables.get(component)
        return table is not None and bool(table.handles)

    def batch(self, *components: type[Any]) -> Batch:
        """Return the rows whose entity has every one of ``components``; no table is made for one without."""
        batch = self._batches.get(components)
        if batch is None:
            if all(map(self.has_any, components)):
                batch = Batch.of([self.table(component) for component in components], self.entities)
            else:
                batch = Batch(np.zeros(0, np.int64), np.zeros(0, np.int64))
            self._batches[components] = batch
        return batch
