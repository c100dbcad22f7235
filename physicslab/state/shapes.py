"""The table of shapes of a world, and the register of kinds as the arrays that it is derived with."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from physicslab.components import shape
from physicslab.components.shape import Kind
from physicslab.ecs.table import Table
from physicslab.kernels.geometry.shapes import MOST_VERTICES, Shapes, ShapesTuple, SizesTuple

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


class Cores(NamedTuple):
    """Rounded polygons: vertices (n, 8, 2) [m], the last one repeated; their numbers and radii (n,) [m]."""

    corners: NDArray[np.float64]
    vertices: NDArray[np.int64]
    radius: NDArray[np.float64]


def lengths_of(table: Table, rows: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return half of the extents (n, 2) and the radii (n,) of the cores in some rows of ``Shape`` [m]."""
    code, own = table["kind"][rows], np.arange(len(rows))
    columns = np.zeros((1 + len(_SIZES), len(rows)))
    columns[1:] = [column[rows] for column in sizes_in(table)]
    which = KINDS[code, 2:].T + 1
    half: NDArray[np.float64] = EXTENTS[code] * columns[which[:2], own].T
    return half, columns[which[2], own]


def cores_of(table: Table, rows: NDArray[np.int64]) -> Cores:
    """Return the shapes of some rows as they are now, be they in the table of shapes yet or not."""
    half, radius = lengths_of(table, rows)
    vertices, first = KINDS[table["kind"][rows], :2].T
    last = np.maximum(vertices - 1, 0)[:, None]
    corners = _POOL[first[:, None] + np.minimum(np.arange(MOST_VERTICES), last)] * half[:, None, :]
    return Cores(corners, vertices, radius)
