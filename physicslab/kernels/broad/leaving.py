"""Bodies that have left their fat boxes: theirs alone are made again, and only their new pairs are listed.

A list of all pairs takes as long as many substeps. It is made again when many bodies have left; until then
the box of one that leaves grows around the old one, so that what was listed stays so, and pairs of which the
boxes did not overlap before are new.
"""

import math
from typing import NamedTuple

import numpy as np

from physicslab.kernels import (
    Flags,
    Numbers,
    Plain,
    Rows,
    Vectors,
    allocating_kernel,
    always_inlined,
    inlined,
)
from physicslab.kernels.arguments import Motion, Near
from physicslab.kernels.broad.fat_boxes import HIT_SHARE, fatten, left, usual_speed
from physicslab.kernels.broad.filters import may_touch
from physicslab.kernels.broad.grid import cell_at
from physicslab.kernels.broad.near_pairs import beside, distance_to_activate, make_blank
from physicslab.kernels.geometry.shapes import Shapes
from physicslab.kernels.near_counts import PROXIMITY, RECORDED, SCALAR, UNORDERED

_BODIES, _RECORDS = 20, 8
"""All pairs are listed again when one in so many bodies has left, and one more for so many records: to find
the new pairs of a body takes as long as to list so many again."""
_MAX_LARGE = 64
"""Number of large bodies up to which a leaver looks at each, and a sixteenth of all bodies beyond."""
_SOON = 3.0
"""Substeps within which a body that leaves its box is treated at once, where another one leaves now."""
_CELL = 1.5
"""Size of the smallest cells: a multiple of the harmonic mean of the sizes, which goes by the small boxes."""
_LEVELS = 4
"""Sizes of cells in the index, each twice the one before."""
_MAX_CELLS = 256
"""Largest number of cells in which the neighbours of one body are looked for."""


SPARSE = 2
"""Bodies for each record from which on all pairs are listed again: few records are soon carried over."""
NUMBER, SMALLS, BODIES = range(3)
"""Where in ``FatBoxes.counts`` these are."""
CELL, AHEAD, SUBSTEPS_AHEAD = range(3)
"""Where in ``FatBoxes.spans`` these are."""


class FatBoxes(NamedTuple):
    """Fat boxes, which bodies have left theirs since all were made, and the index to find their neighbours.

    ``ways`` (8, rows) is as in :func:`~physicslab.kernels.broad.fat_boxes.all_inside`; the ``boxes`` (rows,
    4) are xmin, ymin, xmax, ymax [m]; ``moved`` (rows,) marks those that have left theirs.

    The index has bodies by the cells of their boxes' centres, of a level that fits them, and then those too
    large: where each bucket of cells begins, the rows of the bodies, the cells of the sorted ones. In
    ``home_x`` is the level as well. ``counts`` is how many bodies have left their boxes, or -1 where all
    pairs must be listed again; how many are sorted, or -1 where there is no index; how many are in it.
    ``spans`` is the size of the smallest cells [m]; for how long boxes are made ahead [s], and for how many
    substeps more. What follows is kept apart (:func:`physicslab.kernels.broad.filters.may_touch`).
    """

    ways: Vectors
    boxes: Vectors
    moved: Flags
    first: Rows
    body: Rows
    home_x: Rows
    home_y: Rows
    counts: Rows
    spans: Numbers
    first_apart: Rows
    apart: Rows
    layer: Rows
    touches: Rows


def blank_boxes(rows: int) -> Plain[FatBoxes]:
    """Return room for the fat boxes of so many bodies, none of which is made."""
    first = np.zeros(1 + (1 << (2 * rows).bit_length()), np.int64)
    body, home_x, home_y = np.zeros((3, rows), np.int64)
    nothing = np.zeros(0, np.int64)
    return (
        np.zeros((8, rows)), np.zeros((rows, 4)), np.zeros(rows, np.bool_), first, body, home_x, home_y,
        np.array([0, -1, 0], np.int64), np.zeros(3), nothing, nothing, nothing, nothing,
    )  # fmt: skip


@inlined
def _level_of(size: float, cell: float) -> int:
    """Return the level of cells that a box of such a size fits in, or _LEVELS."""
    level = 0
    while level < _LEVELS and not size <= cell:
        level += 1
        cell *= 2.0
    return level


@inlined
def _bucket(ix: int, iy: int, mask: int) -> int:
    return ((ix * 73856093) ^ (iy * 19349663)) & mask


@allocating_kernel
def index_bodies(
    boxes: Vectors, vertices: Rows, first: Rows, body: Rows, home_x: Rows, home_y: Rows
) -> tuple[int, int, float]:
    """Sort bodies by the cells of their fat boxes' centres; ``first`` has a power of two of buckets, and one.

    Returns how many fit a cell, how many there are in all, and the size of the smallest cells [m].
    """
    n, mask = len(vertices), len(first) - 2
    inverse_sizes, count = 0.0, 0
    for i in range(n):
        if vertices[i] != 0:
            inverse_sizes += 1.0 / max(boxes[i, 2] - boxes[i, 0], boxes[i, 3] - boxes[i, 1])
            count += 1
    # The harmonic mean goes by the small bodies, which are many, and not by the few walls.
    cell = _CELL * count / inverse_sizes if count else 1.0
    where = np.full(n, -1, np.int64)
    cells = np.empty((n, 2), np.int64)
    first[:] = 0
    smalls = 0
    for i in range(n):
        if vertices[i] == 0:
            continue
        level = _level_of(max(boxes[i, 2] - boxes[i, 0], boxes[i, 3] - boxes[i, 1]), cell)
        if level < _LEVELS:
            size = cell * 2.0**level
            cells[i, 0] = cell_at(0.5 * (boxes[i, 0] + boxes[i, 2]) / size) * _LEVELS + level
            cells[i, 1] = cell_at(0.5 * (boxes[i, 1] + boxes[i, 3]) / size)
            where[i] = _bucket(cells[i, 0], cells[i, 1], mask)
            first[where[i] + 1] += 1
            smalls += 1
    for bucket in range(mask + 1):
        first[bucket + 1] += first[bucket]
    fill, larges = first[:-1].copy(), smalls
    for i in range(n):
        if where[i] >= 0:
            entry = fill[where[i]]
            fill[where[i]] = entry + 1
            body[entry], home_x[entry], home_y[entry] = i, cells[i, 0], cells[i, 1]
        elif vertices[i] != 0:
            body[larges] = i
            larges += 1
    return smalls, count, cell


@inlined
def _overlap(box: tuple[float, float, float, float], boxes: Vectors, j: int) -> bool:
    return bool(
        (box[0] <= boxes[j, 2]) & (boxes[j, 0] <= box[2]) & (box[1] <= boxes[j, 3]) & (boxes[j, 1] <= box[3])
    )


class Leaver(NamedTuple):
    """A body that has left its fat box: its row, its new box, the one before, whether it left none yet."""

    row: int
    box: tuple[float, float, float, float]
    before: tuple[float, float, float, float]
    first: bool


@inlined
def _pair(
    leaver: Leaver, j: int, near: Near, shapes: Shapes, fat: FatBoxes, inverse_mass: Numbers
) -> None:  # fmt: skip
    """List the pair of a leaver and of body j, if it is new and either can be moved."""
    i = leaver.row
    if i == j or inverse_mass[i] + inverse_mass[j] == 0.0 or not _overlap(leaver.box, fat.boxes, j):
        return
    distance = distance_to_activate(fat.ways, i, j)
    # If the boxes overlapped before, it is listed, unless it was left out as beside a long body.
    unmoved = leaver.first and not fat.moved[j]
    left_out = distance == math.inf and unmoved and beside(shapes, fat.ways, i, j)
    if _overlap(leaver.before, fat.boxes, j) and not left_out:
        return
    if not may_touch(fat.first_apart, fat.apart, fat.layer, fat.touches, i, j):
        return
    k = near.counts[PROXIMITY]
    near.counts[PROXIMITY] = k + 1
    if k < len(near.activation_distance):
        near.proximity[2 * k], near.proximity[2 * k + 1] = min(i, j), max(i, j)
        near.activation_distance[k] = distance


@inlined
def _meet_walls(leaver: Leaver, near: Near, bounds: Numbers) -> None:
    """Give records to a leaver and the bounds that its box has passed, and its box before had not."""
    counts = near.counts
    for wall in range(4):
        new, old = leaver.box[wall], leaver.before[wall]
        if (new < bounds[wall] <= old) if wall < 2 else (new > bounds[wall] >= old):
            p = counts[RECORDED]
            counts[RECORDED] = p + 1
            if p < len(near.manifolds) and counts[SCALAR] < len(near.scalar):
                make_blank(near.manifolds, near.points, p)
                manifold = near.manifolds[p]
                manifold.a, manifold.b, manifold.wall = 0, leaver.row, wall
                manifold.entity_a, manifold.entity_b = near.entities[0], near.entities[leaver.row]
                near.scalar[counts[SCALAR]] = p
                counts[SCALAR] += 1
                counts[UNORDERED] = 1


@always_inlined
def _list_leaver(
    leaver: Leaver, growth: float, near: Near, shapes: Shapes, fat: FatBoxes, inverse_mass: Numbers
) -> bool:  # fmt: skip
    """List the new pairs of one body; return whether that can be done. Boxes may have grown by ``growth``."""
    first, body, home_x, home_y = fat.first, fat.body, fat.home_x, fat.home_y
    mask, box, cell = len(first) - 2, leaver.box, fat.spans[CELL]
    for level in range(_LEVELS):
        around = 0.5 * cell + growth
        from_x, to_x = cell_at((box[0] - around) / cell), cell_at((box[2] + around) / cell)
        from_y, to_y = cell_at((box[1] - around) / cell), cell_at((box[3] + around) / cell)
        cell *= 2.0
        if float(to_x - from_x + 1) * float(to_y - from_y + 1) > _MAX_CELLS:
            return False
        for ix in range(from_x, to_x + 1):
            home = ix * _LEVELS + level
            for iy in range(from_y, to_y + 1):
                at = _bucket(home, iy, mask)
                for q in range(first[at], first[at + 1]):
                    if home_x[q] == home and home_y[q] == iy:
                        _pair(leaver, body[q], near, shapes, fat, inverse_mass)
    for q in range(fat.counts[SMALLS], fat.counts[BODIES]):
        _pair(leaver, body[q], near, shapes, fat, inverse_mass)
    return True


@inlined
def list_leavers(
    near: Near, motion: Motion, shapes: Shapes, inverse_mass: Numbers, fat: FatBoxes, bounds: Numbers,
    h: float, speculative_margin: float,
) -> bool:  # fmt: skip
    """Make fat boxes again for the bodies that may leave theirs in a time h, and list their new pairs.

    They are good for some three steps of four substeps ahead. ``bounds`` (4,) are those of the world, or
    zero. Returns whether that was possible; otherwise all pairs must be listed again: there is no index, too
    many have left, or there is no room.
    """
    rows, counts, index = len(motion.angle), near.counts, fat.counts
    if index[NUMBER] < 0 or index[SMALLS] < 0 or SPARSE * counts[RECORDED] < rows:
        return False
    if index[BODIES] - index[SMALLS] > _MAX_LARGE + rows // 16:
        return False
    before = counts[PROXIMITY], counts[RECORDED], counts[SCALAR]
    index[NUMBER] = _list_leavers(near, motion, shapes, inverse_mass, fat, bounds, h, speculative_margin)
    if index[NUMBER] < 0:
        counts[PROXIMITY], counts[RECORDED], counts[SCALAR] = before
    return bool(index[NUMBER] >= 0)


@inlined
def _list_leavers(
    near: Near, motion: Motion, shapes: Shapes, inverse_mass: Numbers, fat: FatBoxes, bounds: Numbers,
    h: float, speculative_margin: float,
) -> int:  # fmt: skip
    """List them; return how many have left their boxes, or -1 where that is given up, counts too large."""
    rows, counts, growth = len(motion.angle), near.counts, 0.0
    ways, boxes, moved = fat.ways, fat.boxes, fat.moved
    already: int = fat.counts[NUMBER]
    ahead = fat.spans[AHEAD] + fat.spans[SUBSTEPS_AHEAD] * h
    limit, usual = rows // _BODIES + counts[RECORDED] // _RECORDS, usual_speed(motion, shapes)
    for i in range(rows):
        if moved[i]:
            growth = max(growth, ways[5, i])
    for i in range(rows):
        if not left(i, motion, shapes, ways, h, _SOON * h, speculative_margin):
            continue
        if not ways[3, i] > 0.0 or (not moved[i] and already >= limit):
            return -1
        before = boxes[i, 0], boxes[i, 1], boxes[i, 2], boxes[i, 3]
        old = ways[0, i], ways[1, i], ways[2, i], ways[3, i], ways[4, i], ways[6, i], ways[7, i]
        hit = usual if inverse_mass[i] > 0.0 else 0.0
        x0, y0, x1, y1 = fatten(i, motion, shapes, ways, ahead, hit, HIT_SHARE, speculative_margin)
        new = ways[0, i], ways[1, i], ways[2, i], ways[3, i], ways[4, i], ways[6, i], ways[7, i]
        if new[3] != old[3]:
            return -1
        box = min(x0, before[0]), min(y0, before[1]), max(x1, before[2]), max(y1, before[3])
        grown = max(max(before[0] - box[0], before[1] - box[1]), max(box[2] - before[2], box[3] - before[3]))
        ways[5, i] = grown + (ways[5, i] if moved[i] else 0.0)
        growth = max(growth, ways[5, i])
        leaver = Leaver(i, box, before, not moved[i])
        # Which long bodies it was beside goes by where it was when all pairs were listed.
        ways[0, i], ways[1, i], ways[2, i], ways[4, i] = old[0], old[1], old[2], old[4]
        ways[6, i], ways[7, i] = old[5], old[6]
        done = _list_leaver(leaver, growth, near, shapes, fat, inverse_mass)
        if bounds[2] > bounds[0] and inverse_mass[i] > 0.0:
            _meet_walls(leaver, near, bounds)
        ways[0, i], ways[1, i], ways[2, i], ways[4, i] = new[0], new[1], new[2], new[4]
        ways[6, i], ways[7, i] = new[5], new[6]
        boxes[i, 0], boxes[i, 1], boxes[i, 2], boxes[i, 3] = box
        already += 0 if moved[i] else 1
        moved[i] = True
        full = counts[PROXIMITY] > len(near.activation_distance)
        full |= counts[PROXIMITY] + counts[RECORDED] > min(len(near.manifolds), len(near.scalar))
        if full or not done:
            return -1
    return already
