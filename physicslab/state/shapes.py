"""The table of shapes of a world, and the register of kinds as the arrays that it is derived with."""

from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from physicslab.components import shape
from physicslab.components.shape import Kind
from physicslab.ecs.fields import POINTS
from physicslab.ecs.table import Table
from physicslab.kernels.geometry.shapes import (
    MOST_VERTICES,
    OWN,
    Shapes,
    ShapesTuple,
    SizesTuple,
    named_shapes,
)
from physicslab.state.chain_links import NO_LINKS, line_along, links_before, links_of

_SIZES = tuple(spec.name for spec in shape.Shape.FIELDS if spec.kind == "number")


class Register:
    """The cores of all kinds, and behind them those of polygons, as arrays that grow.

    Attributes
    ----------
    kinds : int64 array (n, 5)
        See :func:`physicslab.kernels.geometry.shapes.derive_shape`; in row ``OWN + code`` are the vertices
        with this code in :data:`physicslab.ecs.fields.POINTS`. Rows that are not taken yet are 0.
    extents : float64 array (n, 2)
        Half of the extents of each core, in units of the sizes that stretch it.
    pool : float64 array (m, 4)
        The vertices of the cores, in shares of these, and the normals of the faces that begin there.
    """

    def __init__(self, kinds: tuple[Kind, ...]) -> None:
        self.kinds: NDArray[np.int64] = np.zeros((0, 5), np.int64)
        self.extents: NDArray[np.float64] = np.zeros((0, 2))
        self.pool: NDArray[np.float64] = np.zeros((0, 4))
        self._arrays: tuple[NDArray[Any], ...] = ()
        self._cores = self._vertices = 0
        self._known = 1  # of the lists of points; the first one is empty
        self._add(np.zeros((0, 2)), -1, -1, -1)
        for kind in kinds:
            x, y, radius = (_SIZES.index(name) if name else -1 for name in (kind.x, kind.y, kind.radius))
            self._add(np.array(kind.core).reshape(-1, 2), x, y, radius)
            self.kinds[self._cores - 1, 0] += kind.part
        if self._cores > OWN + 1:
            raise ValueError(f"there are more than {OWN} kinds of shapes: raise OWN")
        self._cores = OWN + 1

    def arrays(self) -> tuple[NDArray[Any], ...]:
        """Return kinds, extents and pool with all lists of points: another tuple where one is new."""
        for code in range(self._known, len(POINTS)):
            points, links = np.array([(point.x, point.y) for point in POINTS.value_of(code)]), NO_LINKS
            if len(points) > 1:  # a component with fewer has been refused
                points, links = links_of(points)
                closed = bool((points[0] == points[-1]).all())
                before, behind = points[[-2 if closed else 1]], points[[1 if closed else -2]]
                points = np.concatenate((before, points, behind))
            self._add(points.reshape(-1, 2), -1, -1, 0, beside=1, links=links)
            self._known = code + 1
        if not self._arrays:
            self._arrays = self.kinds, self.extents, self.pool
        return self._arrays

    def _add(
        self, core: NDArray[np.float64], x: int, y: int, radius: int, beside: int = 0,
        links: NDArray[np.float64] = NO_LINKS,
    ) -> None:  # fmt: skip
        """Add a core; so many vertices at its beginning and its end are its neighbours as a chain.

        Before it come its ``links`` as one.
        """
        self._arrays, row, first = (), self._cores, self._vertices + len(links)
        self.pool = _with_room(self.pool, first)
        self.pool[self._vertices : first, :2] = links
        extent = np.abs(core).max(axis=0, initial=0.0)
        self.kinds, self.extents = _with_room(self.kinds, row + 1), _with_room(self.extents, row + 1)
        self.pool = _with_room(self.pool, first + len(core))
        self.kinds[row] = max(len(core) - 2 * beside, 0), first + beside, x, y, radius
        self.extents[row] = extent
        self.pool[first : first + len(core), :2] = core / np.where(extent > 0.0, extent, 1.0)
        convex = core[beside : len(core) - beside]
        faces = first + beside
        self.pool[faces : faces + len(convex), 2:] = _normals(convex, as_one=x == y)
        self._cores, self._vertices = row + 1, first + len(core)


def _normals(core: NDArray[np.float64], *, as_one: bool) -> NDArray[np.float64]:
    """Return the outward normals (n, 2) of the faces of a core (n, 2).

    One is 0 where its direction goes by the sizes of a shape: where these do not stretch the core ``as_one``,
    and it is slanted.
    """
    along = np.roll(core, -1, axis=0) - core
    length = np.hypot(*along.T)
    normals = np.stack((along[:, 1], -along[:, 0]), axis=1) / np.where(length > 0.0, length, 1.0)[:, None]
    if not as_one:
        normals[(normals != 0.0).all(axis=1)] = 0.0
    return normals


def _with_room[T: np.generic](array: NDArray[T], rows: int) -> NDArray[T]:
    """Return an array of at least so many rows that begins as this one does: the same one, or a larger."""
    if rows <= len(array):
        return array
    larger = np.zeros((max(rows, 2 * len(array)), *array.shape[1:]), array.dtype)
    larger[: len(array)] = array
    return larger


REGISTER = Register(tuple(shape.KINDS.values()))
"""The cores of this process."""


def blank_shapes(rows: int) -> ShapesTuple:
    """Return a table of so many rows without shapes."""
    return np.zeros((2, rows), np.int64), np.zeros((6, rows)), REGISTER.pool


_of_kernels: Any = named_shapes
with_names: Callable[[ShapesTuple], Shapes] = _of_kernels.py_func
"""Returns the same table, its columns by name."""


def sizes_in(table: Table) -> SizesTuple:
    """Return the columns of sizes of the ``Shape`` component."""
    radius, width, height, length = (table[name] for name in _SIZES)
    return radius, width, height, length


class Cores(NamedTuple):
    """Rounded polygons: vertices (n, 8, 2) [m], the last one repeated; their numbers and radii (n,) [m].

    And half of the extents of these cores (n, 2) [m].

    A chain goes there and back again, with as many vertices more as it needs.
    """

    corners: NDArray[np.float64]
    vertices: NDArray[np.int64]
    radius: NDArray[np.float64]
    half: NDArray[np.float64]


def _rows_in(table: Table, rows: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the rows of the register of the shapes in some rows of ``Shape``."""
    REGISTER.arrays()
    own = table["vertices"][rows]
    found: NDArray[np.int64] = np.where(own > 0, OWN + own, table["kind"][rows])
    return found


def lengths_of(table: Table, rows: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return half of the extents (n, 2) and the radii (n,) of the cores in some rows of ``Shape`` [m]."""
    core, own = _rows_in(table, rows), np.arange(len(rows))
    columns = np.ones((1 + len(_SIZES), len(rows)))
    columns[1:] = [column[rows] for column in sizes_in(table)]
    stretched_x, stretched_y, rounded = REGISTER.kinds[core, 2:].T
    stretched = np.stack((columns[stretched_x + 1, own], columns[stretched_y + 1, own]), axis=1)
    half: NDArray[np.float64] = REGISTER.extents[core] * stretched
    return half, np.where(rounded >= 0, columns[rounded + 1, own], 0.0)


def cores_of(table: Table, rows: NDArray[np.int64]) -> Cores:
    """Return the shapes of some rows as they are now, be they in the table of shapes yet or not."""
    half, radius = lengths_of(table, rows)
    vertices, first = REGISTER.kinds[_rows_in(table, rows), :2].T
    last, chain = np.maximum(vertices - 1, 0)[:, None], table["kind"][rows] == shape.CHAIN
    most = max(MOST_VERTICES, 2 * int(vertices[chain].max(initial=0)))
    which = np.minimum(np.arange(most), last)
    if chain.any():
        which[chain] = np.maximum(last[chain] - np.abs(np.arange(most) - last[chain]), 0)
        vertices = np.where(chain, 2 * last[:, 0], vertices)
    corners = REGISTER.pool[first[:, None] + which, :2] * half[:, None, :]
    return Cores(corners, vertices, radius, half)


@lru_cache(maxsize=64)
def line_of(code: int) -> NDArray[np.float64]:
    """Return places (n, 2) along the chain with a code of ``vertices``, in its own directions [m].

    Arcs are many short sides.
    """
    REGISTER.arrays()
    return line_along(links_before(REGISTER.pool, int(REGISTER.kinds[OWN + code, 1])))
