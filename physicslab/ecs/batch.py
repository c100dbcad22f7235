"""The rows of entities that have certain components."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physicslab.ecs.table import Table


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
        """Select the rows that are present in every one of ``tables``."""
        selected = entities > 0
        for table in tables:
            selected = selected & table.present
        rows = np.flatnonzero(selected).astype(np.int64)
        return cls(rows, entities[rows])
