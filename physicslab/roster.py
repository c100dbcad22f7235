"""Which entity has which row: keeps a world's tables in step with esper."""

from __future__ import annotations

from typing import Any

import esper
import numpy as np
from numpy.typing import NDArray

from physicslab.columns import COMPONENTS, Batch, Table
from physicslab.components import Transform

__all__ = ["Roster"]


class Roster:
    """The rows of one world. esper alone decides who has what; :meth:`synchronise` follows.

    Row 0 is the world itself. The others are in the order of their entity ids, so that results never hang on the order
    of a set. A removed entity leaves a blank row behind; blanks are closed up when they are many.

    Attributes
    ----------
    tables : dict of component type to Table
        Their columns share one numbering of rows.
    entities : int64 array (rows,)
        The entity of each row; 0 for row 0 and for blank rows.
    lookup : int64 array
        The row of each entity id, -1 where there is none; ``lookup[0]`` is 0, the world.
    """

    def __init__(self) -> None:
        self.tables: dict[type[Any], Table] = {}
        self.row_of: dict[int, int] = {}
        self.entities: NDArray[np.int64] = np.zeros(1, np.int64)
        self.lookup: NDArray[np.int64] = np.zeros(1, np.int64)
        self.newest = 0
        self.capacity = 16
        self._rows = 1
        self._seen: list[Any] | None = None
        self._batches: dict[tuple[type[Any], ...], Batch] = {}

    def __len__(self) -> int:
        return self._rows

    def synchronise(self) -> bool:
        """Follow what esper's active context holds; return whether anything had changed.

        esper hands out the same list object until something structural changes, which makes the test one comparison.
        """
        dead = esper._dead_entities
        if dead:
            unknown = dead - set(esper.get_entities())
            dead -= unknown  # esper would fail on them at every later step
            esper.clear_dead_entities()
            if unknown:
                raise KeyError(f"delete_entity({min(unknown)}): there is no such entity in this world")
        if esper.get_component(Transform) is self._seen:
            return False
        self._follow_entities()
        for component in COMPONENTS.values():
            self._follow_component(component)
        self._batches.clear()
        self._seen = esper.get_component(Transform)
        return True

    def _follow_entities(self) -> None:
        living = set(esper.get_entities())
        gone = self.row_of.keys() - living
        fresh = sorted(living - self.row_of.keys())
        if fresh and fresh[0] <= self.newest:  # ids started again: esper.clear_database() was called
            gone, fresh = set(self.row_of), sorted(living)
        for table in self.tables.values():
            for entity in gone & table.handles.keys():
                table.release(entity)
        for entity in gone:
            self.entities[self.row_of.pop(entity)] = 0
        if len(self.row_of) + 1 < self._rows // 2 or not self.row_of:
            self._close_up()
        start, self._rows = self._rows, self._rows + len(fresh)
        self.row_of.update(zip(fresh, range(start, self._rows), strict=True))
        while self.capacity < self._rows:
            self.capacity *= 2
        grown = np.zeros(self._rows, np.int64)
        grown[:start] = self.entities[:start]
        grown[start:] = fresh
        self.entities = grown
        self.newest = int(grown.max())
        self.lookup = np.full(self.newest + 1, -1, np.int64)
        self.lookup[grown] = np.arange(self._rows)
        self.lookup[0] = 0
        for table in self.tables.values():
            table.resize(self._rows, self.capacity)

    def _close_up(self) -> None:
        kept = np.concatenate(([0], np.flatnonzero(self.entities))).astype(np.int64)
        self.entities = self.entities[kept]
        self._rows = len(kept)
        self.row_of = {int(entity): row for row, entity in enumerate(self.entities) if entity}
        for table in self.tables.values():
            table.compact(kept, self.row_of)

    def _follow_component(self, component: type[Any]) -> None:
        holders = dict(esper.get_component(component))
        table = self.tables.get(component)
        if table is None:
            if not holders:
                return
            table = self.tables[component] = Table(component, self.capacity)
            table.resize(self._rows, self.capacity)
        if holders == table.handles:
            return
        for entity in table.handles.keys() - holders.keys():
            table.release(entity)
        for entity in sorted(holders):
            handle = holders[entity]
            held = table.handles.get(entity)
            if held is not handle:
                if held is not None:
                    table.release(entity)
                table.adopt(entity, handle, self.row_of[entity])

    def table(self, component: type[Any]) -> Table:
        """Return a component's table; one of blank rows where no entity has the component."""
        table = self.tables.get(component)
        if table is None:
            table = self.tables[component] = Table(component, self.capacity)
            table.resize(self._rows, self.capacity)
        return table

    def batch(self, *components: type[Any]) -> Batch:
        """Return the rows whose entity has every one of ``components``."""
        batch = self._batches.get(components)
        if batch is None:
            batch = Batch.of([self.table(component) for component in components], self.entities)
            self._batches[components] = batch
        return batch
