"""The table of shapes of a world, and the register of kinds as the arrays that it is derived with."""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import shape
from physicslab.components.shape import Kind
from physicslab.ecs.table import Table
from physicslab.kernels.geometry.shapes import Shapes, ShapesTuple, SizesTuple

_SIZES = tuple(spec.name for spec in shape.Shape.FIELDS if spec.name != "kind")


def register(kinds: tuple[Kind, ...]) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
    """Return kinds (n, 5) and half extents (n, 2) by code, as ``derive_shape`` takes them, and the pool."""
    cores = [np.array(kind.core) for kind in kinds]
    extents = np.array([(0.0, 0.0), *(np.abs(core).max(axis=0) for core in cores)])
    pool = [
        core / np.where(extent > 0.0, extent, 1.0) for core, extent in zip(cores, extents[1:], strict=True)
    ]
    rows, first = [(0, 0, -1, -1, -1)], 0
    for kind in kinds:
        x, y, radius = (_SIZES.index(name) if name else -1 for name in (kind.x, kind.y, kind.radius))
        rows.append((len(kind.core), first, x, y, radius))
        first += len(kind.core)
    return np.array(rows), extents, np.concatenate(pool)


KINDS, EXTENTS, _POOL = register(tuple(shape.KINDS.values()))
"""The register as arrays: see :func:`physicslab.kernels.geometry.shapes.derive_shape`."""


def blank_shapes(rows: int) -> ShapesTuple:
    """Return a table of so many rows without shapes."""
    return np.zeros((2, rows), np.int64), np.zeros((4, rows)), _POOL


def with_names(plain: ShapesTuple) -> Shapes:
    """Return the same table, its columns by name."""
    cores, lengths, pool = plain
    return Shapes(cores[0], cores[1], lengths[0], lengths[1], lengths[2], lengths[3], pool)


def sizes_in(table: Table) -> SizesTuple:
    """Return the columns of sizes of the ``Shape`` component."""
    radius, width, height, length = (table[name] for name in _SIZES)
    return radius, width, height, length
