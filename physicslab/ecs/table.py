"""The columns of one component in one world, and the rows of entities that have several."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.ecs.component import Component
from physicslab.ecs.fields import Field, InvalidValue, Kind

_DTYPES: Mapping[Kind, type] = {
    "number": np.float64,
    "whole": np.int64,
    "vector": np.float64,
    "flag": np.bool_,
    "entity": np.int64,
    "choice": np.int64,
    "text": np.int64,
    "points": np.int64,
}

_NUMBERS = "number", "whole", "vector"
_LINE = 64
"""Bytes at multiples of which columns begin: those of a line of the cache."""


class Table:
    """The columns of one component in one world, one row an entity.

    All tables of a world number their rows alike, so that a kernel indexes every column with the same number.
    Row 0 is the world itself, fixed at the origin. A row whose entity lacks the component holds zeros, which
    every kernel reads as "nothing here": no mass, no speed, no shape.

    ``table["position"]`` is the column of a field, in use rows only; a derived field has a second column
    ``"<field>_given"``. The arrays are views that stay valid until the next structural change; they are in
    one ``block`` of memory.
    """

    def __init__(self, component: type[Any], capacity: int, rows: int = 0) -> None:
        self.component: type[Component] = component
        self.handles: dict[int, Component] = {}
        self._names, kinds = list[str](), list[Kind]()
        for spec in self.component.FIELDS:
            self._names.append(spec.name)
            kinds.append(spec.kind)
            if spec.derived:
                self._names.append(f"{spec.name}_given")
                kinds.append("flag")
        self._kinds = tuple(kinds)
        self._views: list[Any] = []
        self._take(capacity)
        self.resize(rows, capacity)

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self._columns[name]

    @property
    def columns(self) -> list[NDArray[Any]]:
        """Every column, in the order in which components hold them."""
        return list(self._columns.values())

    def resize(self, rows: int, capacity: int) -> None:
        """Use the first ``rows`` rows, with room for ``capacity``."""
        if capacity > len(self._present):
            before = self._present, *self._storage
            self._take(capacity)
            for column, values in zip((self._present, *self._storage), before, strict=True):
                column[: len(values)] = values
        self.present: NDArray[np.bool_] = self._present[:rows]
        self._columns = {name: column[:rows] for name, column in zip(self._names, self._storage, strict=True)}

    def _take(self, capacity: int) -> None:
        """Take memory for ``capacity`` rows, all zero."""
        size, places = _layout(self._kinds, capacity)
        self.block: NDArray[np.uint8] = np.zeros(size, np.uint8)
        columns: list[NDArray[Any]]
        columns = [np.ndarray(shape, dtype, self.block, start) for dtype, shape, start in places]
        self._present, self._storage = columns[0], columns[1:]
        # Handles share this list, so replacing its items moves every one of them to the new memory.
        self._views[:] = [memoryview(column.reshape(-1)) for column in self._storage]

    def adopt(self, entity: int, handle: Component, row: int) -> None:
        """Move a detached component's values into ``row``; from here on the handle is a view of it."""
        if handle._row:
            raise ValueError(
                f"entity {entity}: this {type(handle).__name__} object already belongs to an entity; "
                f"make one for each"
            )
        for view, own in zip(self._views, handle._views, strict=True):
            if len(own) == 2:
                view[2 * row], view[2 * row + 1] = own
            else:
                view[row] = own[0]
        handle._views, handle._row = self._views, row
        self._present[row] = True
        self.handles[entity] = handle

    def refuse_written(self, entities: NDArray[np.int64], label: Callable[[int], str]) -> None:
        """Refuse what was written to the columns of some entities (n,) and their handles would have refused.

        Raises
        ------
        InvalidValue
            With the ``label`` of the first such entity.
        """
        handles = [self.handles[entity] for entity in entities.tolist()]
        rows = np.array([handle._row for handle in handles], np.int64)
        together = self.component.validate is not Component.validate
        wrong: list[tuple[int, Field | None]] = [(k, None) for k in range(len(rows) * together)]
        for spec in self.component.FIELDS:
            if spec.kind in _NUMBERS and len(rows):
                values = self[spec.name][rows]
                least = -spec.highest if spec.kind == "vector" else spec.lowest
                out = ~((values >= least) & (values <= spec.highest)).reshape(len(rows), -1).all(axis=1)
                out &= self[f"{spec.name}_given"][rows] if spec.derived else True
                wrong[:0] = [(k, spec) for k in np.flatnonzero(out).tolist()]
        for k, one in wrong:
            try:
                handles[k].validate() if one is None else one.check(self[one.name][rows[k]].tolist())
            except InvalidValue as error:
                owner = f"{label(int(entities[k]))}: {error.component}"
                raise InvalidValue(owner, error.field, error.value, error.allowed) from None

    def blank(self) -> Component:
        """Return a component of no entity, whose values are all zero: it is adopted before any is written."""
        made: Component = Component.__new__(self.component)
        made._views = _zeros(self._kinds)
        made._row = 0
        return made

    def release(self, entity: int) -> None:
        """Detach the entity's handle, which keeps its last values, and blank its row."""
        handle = self.handles.pop(entity)
        row = handle._row
        handle._views = [
            [view[2 * row], view[2 * row + 1]] if column.ndim == 2 else [view[row]]
            for view, column in zip(self._views, self._storage, strict=True)
        ]
        handle._row = 0
        self._present[row] = False
        for column in self._storage:
            column[row] = 0

    def compact(self, kept: NDArray[np.int64], row_of: Mapping[int, int]) -> None:
        """Move rows ``kept`` (n,) to the front, in order; ``row_of`` gives each entity its new row."""
        for column in (self._present, *self._storage):
            column[: len(kept)] = column[kept]
            column[len(kept) :] = 0
        for entity, handle in self.handles.items():
            handle._row = row_of[entity]


def as_slice(rows: NDArray[np.int64]) -> Any:
    """Return rows (n,) as a slice where they follow one another: numpy takes a tenth of the time for one."""
    if not len(rows):
        return slice(0, 0)
    first, end = int(rows[0]), int(rows[-1]) + 1
    return slice(first, end) if end - first == len(rows) and (np.diff(rows) == 1).all() else rows


@lru_cache(1024)
def _layout(kinds: tuple[Kind, ...], capacity: int) -> tuple[int, list[tuple[type, tuple[int, ...], int]]]:
    """Return the size of a block for ``capacity`` rows [bytes]; type, shape and first byte of each column.

    The first column says where the component is present. Tables of one component are mostly of one size,
    those of all worlds together.
    """
    size, places = 0, list[tuple[type, tuple[int, ...], int]]()
    for dtype, width in ((np.bool_, 1), *((_DTYPES[kind], _width(kind)) for kind in kinds)):
        places.append((dtype, (capacity, width) if width > 1 else (capacity,), size))
        size += -(-capacity * width * np.dtype(dtype).itemsize // _LINE) * _LINE
    return size, places


@cache
def _zeros(kinds: tuple[Kind, ...]) -> list[list[Any]]:
    """Return what columns of ``kinds`` hold in a blank row, in the form of a detached component's values."""
    return [[np.zeros(1, _DTYPES[kind]).item()] * _width(kind) for kind in kinds]


def _width(kind: Kind) -> int:
    """Return how many numbers a row of a column has."""
    return 2 if kind == "vector" else 1


@dataclass(frozen=True, slots=True)
class Batch:
    """The rows of all entities that have certain components, in the order of their entity ids.

    Attributes
    ----------
    rows : int64 array (k,)
        Row numbers, good for every table of the world.
    entities : int64 array (k,)
        The entity in each of those rows.
    """

    rows: NDArray[np.int64]
    entities: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.rows)

    @classmethod
    def of(cls, tables: Iterable[Table], entities: NDArray[np.int64]) -> Batch:
        """Select the rows that are in every one of ``tables``; ``entities`` are those of all (rows,)."""
        selected = entities > 0
        for table in tables:
            selected = selected & table.present
        rows = np.flatnonzero(selected).astype(np.int64)
        return cls(rows, entities[rows])
