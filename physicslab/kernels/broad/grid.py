"""The broad phase: a uniform grid over fat boxes, sorted by counting."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from physicslab.kernels import Numbers, Rows, Vectors, allocating, allocating_kernel, always_inlined, inlined
from physicslab.kernels.records import Couples, Pairs

_COMPANY_LIMIT = 32
"""Largest number of overlapping bodies of a body's own size that make pairs with it."""
_CELL_LIMIT = 1e15
"""Number of the farthest cell: beyond it, float64 does not resolve neighbouring cells."""
_CELLS_EACH = 32.0
"""Largest number of cells for each body where every cell has a bucket of its own."""
_OWN_SIZE = 2.0
"""Ratio of sizes up to which two bodies are of the same size: few such bodies fit beside one."""


@inlined
def _overlap(these: Vectors, i: int, those: Vectors, j: int) -> bool:
    # "&", not "and": one branch that is nearly always the same, not four that cannot be predicted.
    return bool(
        (these[i, 0] <= those[j, 2]) & (those[j, 0] <= these[i, 2])
        & (these[i, 1] <= those[j, 3]) & (those[j, 1] <= these[i, 3])
    )  # fmt: skip


@inlined
def _meet(flat: Numbers, p: int, q: int) -> bool:
    """Whether two boxes overlap, of those that are stored one after the other."""
    i, j = 4 * p, 4 * q
    return bool(
        (flat[i] <= flat[j + 2]) & (flat[j] <= flat[i + 2])
        & (flat[i + 1] <= flat[j + 3]) & (flat[j + 1] <= flat[i + 3])
    )  # fmt: skip


class Search(NamedTuple):
    """The boxes among which pairs are found, with their margins and inverse masses, and where pairs go.

    ``company`` counts the bodies of its own size that overlap each body.
    """

    boxes: Vectors
    fat: Vectors
    inverse_mass: Numbers
    couples: Couples
    company: Rows


@inlined
def _extent(boxes: Vectors, fat: Vectors, i: int) -> tuple[float, float]:
    """Return width and height of a fat box without margins and without the way of its body [m]."""
    width = boxes[i, 2] - boxes[i, 0] - 2.0 * (fat[4, i] + abs(fat[6, i]))
    height = boxes[i, 3] - boxes[i, 1] - 2.0 * (fat[4, i] + abs(fat[7, i]))
    return width, height


@inlined
def _take(search: Search, found: int, i: int, j: int) -> int:
    """Write the pair (i, j), if it can be moved and there is room; return how many there are now.

    With bodies on one spot only so many pairs are taken that work and memory stay proportional
    to the bodies: a body whose ``company`` is full makes pairs with further ones when some have left.
    """
    boxes, fat, inverse_mass, couples, company = search
    if inverse_mass[i] + inverse_mass[j] == 0.0:
        return found
    # The boxes without their margins, where the bodies are.
    across_i, up_i = _extent(boxes, fat, i)
    across_j, up_j = _extent(boxes, fat, j)
    dx = 2.0 * abs(fat[0, i] - fat[6, i] - fat[0, j] + fat[6, j])
    dy = 2.0 * abs(fat[1, i] - fat[7, i] - fat[1, j] + fat[7, j])
    if (dx < across_i + across_j) & (dy < up_i + up_j):
        larger, smaller = max(across_i, up_i), min(across_j, up_j)
        if larger <= _OWN_SIZE * smaller and max(across_j, up_j) <= _OWN_SIZE * min(across_i, up_i):
            if company[i] >= _COMPANY_LIMIT or company[j] >= _COMPANY_LIMIT:
                return found
            company[i] += 1
            company[j] += 1
    if 2 * found < len(couples):
        couples[2 * found], couples[2 * found + 1] = i, j
    return found + 1


@inlined
def cell_at(x: float) -> int:
    """Return the number of a cell; what is not finite, or too far out for one, is in the last."""
    return math.floor(x) if abs(x) < _CELL_LIMIT else int(_CELL_LIMIT)


class Cells(NamedTuple):
    """The first and the last of the cells, with an empty rim, and how many are above each other.

    Then the number of buckets, and whether each cell has one of its own: if not, they are shared by a hash.
    """

    low_x: int
    low_y: int
    high_x: int
    high_y: int
    up: int
    buckets: int
    dense: bool


class Grid(NamedTuple):
    """Bodies sorted by bucket: where each bucket begins, the bodies' rows, cells (., 2) and boxes (., 4)."""

    first: Rows
    body: Rows
    home: NDArray[np.int64]
    near: Vectors


@inlined
def _bucket(ix: int, iy: int, cells: Cells) -> int:
    """Return the bucket of a cell: one of its own, or a shared one by a hash."""
    if cells.dense:
        return (ix - cells.low_x) * cells.up + iy - cells.low_y
    return ((ix * 73856093) ^ (iy * 19349663)) & (cells.buckets - 1)


@always_inlined
def _place(
    boxes: Vectors, members: Rows, count: int, cell: float, larges: Rows, small: Rows, home: NDArray[np.int64]
) -> tuple[int, int, Cells]:
    """Find the cell of each body no larger than one; return how many are, how many larger, and the cells."""
    smalls, large_count = 0, 0
    low_x, low_y, high_x, high_y = 0, 0, -1, -1
    half_per_cell = 0.5 / cell
    for k in range(count):
        i = members[k]
        if max(boxes[i, 2] - boxes[i, 0], boxes[i, 3] - boxes[i, 1]) > cell:
            larges[large_count] = i
            large_count += 1
            continue
        ix = cell_at(half_per_cell * (boxes[i, 0] + boxes[i, 2]))
        iy = cell_at(half_per_cell * (boxes[i, 1] + boxes[i, 3]))
        if smalls == 0:
            low_x, high_x, low_y, high_y = ix, ix, iy, iy
        low_x, high_x, low_y, high_y = min(low_x, ix), max(high_x, ix), min(low_y, iy), max(high_y, iy)
        small[smalls], home[smalls, 0], home[smalls, 1] = i, ix, iy
        smalls += 1
    # A rim of empty cells, so that every cell has all its neighbours.
    low_x, low_y, high_x, high_y = low_x - 1, low_y - 1, high_x + 1, high_y + 1
    across, up = high_x - low_x + 1, high_y - low_y + 1
    dense = float(across) * float(up) <= _CELLS_EACH * smalls + 64.0
    buckets = across * up if dense else 1
    while not dense and buckets < 2 * smalls:
        buckets *= 2
    return smalls, large_count, Cells(low_x, low_y, high_x, high_y, up, buckets, dense)


@allocating
def _sort(boxes: Vectors, small: Rows, cell_of: NDArray[np.int64], smalls: int, cells: Cells) -> Grid:
    """Count the bodies of each bucket, then put them there: a counting sort."""
    first = np.zeros(cells.buckets + 1, np.int64)
    where = np.empty(smalls, np.int64)
    for k in range(smalls):
        where[k] = _bucket(cell_of[k, 0], cell_of[k, 1], cells)
        first[where[k] + 1] += 1
    for bucket in range(cells.buckets):
        first[bucket + 1] += first[bucket]
    fill = first[:-1].copy()
    body = np.empty(smalls, np.int64)
    home = np.empty((smalls, 2), np.int64)
    near = np.empty((smalls, 4))
    for k in range(smalls):
        entry = fill[where[k]]
        fill[where[k]] = entry + 1
        body[entry], home[entry, 0], home[entry, 1] = small[k], cell_of[k, 0], cell_of[k, 1]
        for side in range(4):
            near[entry, side] = boxes[small[k], side]
    return Grid(first, body, home, near)


@always_inlined
def _pair_dense(search: Search, cells: Cells, grid: Grid, smalls: int, found: int) -> int:
    """Find the pairs of small bodies where each cell has its own bucket; return how many pairs there are now.

    Buckets one above the other are next to each other: two stretches hold all five cells.
    """
    first, body, home, near = grid
    couples = search.couples
    flat = near.reshape(near.size)  # else every index is multiplied by a stride
    for p in range(smalls):
        at, i = (home[p, 0] - cells.low_x) * cells.up + home[p, 1] - cells.low_y, body[p]
        above, beside, end = first[at + 2], first[at + cells.up - 1], first[at + cells.up + 2]
        candidates = above - (p + 1) + end - beside
        if candidates <= 2 * _COMPANY_LIMIT:
            if 2 * (found + candidates) > len(couples):
                found += candidates
                continue
            # Every neighbour is written, and kept by counting: whether two overlap cannot be predicted.
            for q in range(p + 1, above):
                couples[2 * found], couples[2 * found + 1] = i, body[q]
                found += _meet(flat, p, q)
            for q in range(beside, end):
                couples[2 * found], couples[2 * found + 1] = i, body[q]
                found += _meet(flat, p, q)
            continue
        for q in range(p + 1, above):
            if _overlap(near, p, near, q):
                found = _take(search, found, i, body[q])
        for q in range(beside, end):
            if _overlap(near, p, near, q):
                found = _take(search, found, i, body[q])
    return found


@always_inlined
def _pair_hashed(search: Search, cells: Cells, grid: Grid, smalls: int, found: int) -> int:
    """Find the pairs of small bodies where cells share buckets; return how many pairs there are now."""
    first, body, home, near = grid
    for p in range(smalls):
        ix, iy = home[p, 0], home[p, 1]
        for neighbour in range(5):
            jx = ix if neighbour < 2 else ix + 1
            jy = iy + neighbour if neighbour < 2 else iy + neighbour - 3
            at = _bucket(jx, jy, cells)
            for q in range(p + 1 if neighbour == 0 else first[at], first[at + 1]):
                if home[q, 0] == jx and home[q, 1] == jy and _overlap(near, p, near, q):
                    found = _take(search, found, body[p], body[q])
    return found


@always_inlined
def _pair_large(
    search: Search, cells: Cells, grid: Grid, smalls: int, larges: Rows, count: int, cell: float, found: int
) -> int:
    """Find the pairs of large bodies with small ones; return how many pairs there are now."""
    boxes, body, home = search.boxes, grid.body, grid.home
    for k in range(count):
        i = larges[k]
        from_x, to_x = cell_at(boxes[i, 0] / cell - 0.5), cell_at(boxes[i, 2] / cell + 0.5)
        from_y, to_y = cell_at(boxes[i, 1] / cell - 0.5), cell_at(boxes[i, 3] / cell + 0.5)
        from_x, to_x = max(from_x, cells.low_x), min(to_x, cells.high_x)
        from_y, to_y = max(from_y, cells.low_y), min(to_y, cells.high_y)
        if from_x > to_x or from_y > to_y:
            continue
        if float(to_x - from_x + 1) * float(to_y - from_y + 1) > smalls:
            for q in range(smalls):
                if _overlap(boxes, i, grid.near, q):
                    found = _take(search, found, i, body[q])
            continue
        for ix in range(from_x, to_x + 1):
            if cells.dense:
                column = (ix - cells.low_x) * cells.up - cells.low_y
                for q in range(grid.first[column + from_y], grid.first[column + to_y + 1]):
                    if _overlap(boxes, i, grid.near, q):
                        found = _take(search, found, i, body[q])
                continue
            for iy in range(from_y, to_y + 1):
                at = _bucket(ix, iy, cells)
                for q in range(grid.first[at], grid.first[at + 1]):
                    if home[q, 0] == ix and home[q, 1] == iy and _overlap(boxes, i, grid.near, q):
                        found = _take(search, found, i, body[q])
    return found


@allocating
def _level(
    search: Search, members: Rows, count: int, cell: float, larges: Rows, found: int
) -> tuple[int, int]:
    """Find all pairs with a body no larger than a cell; return how many there are, and how many are larger.

    Each small body is in the one cell that holds its centre, so that its partners are in that cell and its
    eight neighbours, of which four are looked at, to take each pair once. Each large body looks through all
    cells it spans.
    """
    small = np.empty(count, np.int64)
    home = np.empty((count, 2), np.int64)
    smalls, large_count, cells = _place(search.boxes, members, count, cell, larges, small, home)
    grid = _sort(search.boxes, small, home, smalls, cells)
    if cells.dense:
        found = _pair_dense(search, cells, grid, smalls, found)
    else:
        found = _pair_hashed(search, cells, grid, smalls, found)
    return _pair_large(search, cells, grid, smalls, larges, large_count, cell, found), large_count


@allocating_kernel
def find_pairs(
    boxes: Vectors, fat: Vectors, vertices: Rows, inverse_mass: Numbers,
    bounded: bool, bounds: Numbers, pairs: Pairs, couples: Couples,
) -> tuple[int, int, bool]:  # fmt: skip
    """Find the pairs whose fat boxes overlap, each once; return how many of bodies there are, and of walls.

    Then whether so many bodies are on one spot that some of their pairs were left out.

    A grid whose cells fit the usual body finds the pairs of small ones, and of small with large ones; the
    large ones go on to a coarser grid. Their rows are written to ``couples``. Bodies past the bounds make
    pairs (0, row, wall), written to ``pairs``. Where either has no room, the numbers are larger than that,
    and no less than is needed.
    """
    n = len(vertices)
    members = np.empty(n, np.int64)
    larges = np.empty(n, np.int64)
    search = Search(boxes, fat, inverse_mass, couples, np.zeros(n, np.int64))
    count, found, walls = 0, 0, 0
    for i in range(n):
        if vertices[i] == 0:
            continue
        members[count] = i
        count += 1
        if bounded and inverse_mass[i] > 0.0:
            for wall in range(4):
                if boxes[i, wall] < bounds[wall] if wall < 2 else boxes[i, wall] > bounds[wall]:
                    if walls < len(pairs):
                        pairs[walls, 0], pairs[walls, 1], pairs[walls, 2] = 0, i, wall
                    walls += 1
    while count > 1:
        inverse_sizes = 0.0
        for k in range(count):
            i = members[k]
            inverse_sizes += 1.0 / max(boxes[i, 2] - boxes[i, 0], boxes[i, 3] - boxes[i, 1])
        # The harmonic mean goes by the small bodies, which are many, and not by the few walls.
        found, count = _level(search, members, count, 1.25 * count / inverse_sizes, larges, found)
        # One by one: for slices, numba compiles the text of an error that cannot occur.
        for k in range(count):
            members[k] = larges[k]
    crowded = False
    for i in range(n):
        crowded |= search.company[i] >= _COMPANY_LIMIT
    return found, walls, crowded
