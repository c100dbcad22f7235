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
    kernel,
)
from physicslab.kernels.arguments import Motion, Near, named_near
from physicslab.kernels.broad.fat_boxes import HIT_SHARE, fatten, left, usual_speed
from physicslab.kernels.broad.grid import cell_at
from physicslab.kernels.broad.near_pairs import beside, distance_to_activate, make_blank
from physicslab.kernels.geometry.shapes import Shapes, ShapesTuple, named_shapes
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


class Index(NamedTuple):
    """Bodies by the cells of their fat boxes' centres, of a level that fits them; then those too large.

    Where each bucket of cells begins, the rows of the bodies, the cells of the sorted ones, how many of these
    there are, how many in all, and the size of the smallest cells [m]. In ``home_x`` is the level as well.
    """

    first: Rows
    body: Rows
    home_x: Rows
    home_y: Rows
    smalls: int
    bodies: int
    cell: float


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
    leaver: Leaver, j: int, near: Near, shapes: Shapes, fat: Vectors, boxes: Vectors, moved: Flags,
    inverse_mass: Numbers,
) -> None:  # fmt: skip
    """List the pair of a leaver and of body j, if it is new and either can be moved."""
    i = leaver.row
    if i == j or inverse_mass[i] + inverse_mass[j] == 0.0 or not _overlap(leaver.box, boxes, j):
        return
    distance = distance_to_activate(fat, i, j)
    # If the boxes overlapped before, it is listed, unless it was left out as beside a long body.
    left_out = distance == math.inf and leaver.first and not moved[j] and beside(shapes, fat, i, j)
    if _overlap(leaver.before, boxes, j) and not left_out:
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
    leaver: Leaver, growth: float, index: Index, near: Near, shapes: Shapes, fat: Vectors, boxes: Vectors,
    moved: Flags, inverse_mass: Numbers,
) -> bool:  # fmt: skip
    """List the new pairs of one body; return whether that can be done. Boxes may have grown by ``growth``."""
    first, body, home_x, home_y, smalls, count, cell = index
    mask, box = len(first) - 2, leaver.box
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
                        _pair(leaver, body[q], near, shapes, fat, boxes, moved, inverse_mass)
    for q in range(smalls, count):
        _pair(leaver, body[q], near, shapes, fat, boxes, moved, inverse_mass)
    return True


@kernel
def add_pairs(
    plain_near: Plain[Near], plain_motion: Plain[Motion], plain_shapes: ShapesTuple, inverse_mass: Numbers,
    fat: Vectors, boxes: Vectors, moved: Flags, already: int, bounded: bool, bounds: Numbers,
    first: Rows, body: Rows, home_x: Rows, home_y: Rows, found: tuple[int, int, float],
    h: float, ahead: float, speculative_margin: float,
) -> int:  # fmt: skip
    """Make fat boxes again for the bodies that may leave theirs in a time h, and list their new pairs.

    They are good for some three steps of four substeps ``ahead``. ``moved`` (rows,) marks those that have
    left theirs since all were made, of which there were ``already`` so many. The index is that of
    :func:`index_bodies`. Returns how many there are now, or -1 where all pairs must be listed again: too many
    have left, or there is no room.
    """
    near, motion, shapes = named_near(plain_near), Motion(*plain_motion), named_shapes(plain_shapes)
    index = Index(first, body, home_x, home_y, found[0], found[1], found[2])
    rows, counts = len(motion.angle), near.counts
    if index.bodies - index.smalls > _MAX_LARGE + rows // 16:
        return -1
    before = counts[PROXIMITY], counts[RECORDED], counts[SCALAR]
    already = _add_pairs(
        near, motion, shapes, inverse_mass, fat, boxes, moved, already, bounded, bounds, index, h, ahead,
        speculative_margin,
    )  # fmt: skip
    if already < 0:
        counts[PROXIMITY], counts[RECORDED], counts[SCALAR] = before
    return already


@inlined
def _add_pairs(
    near: Near, motion: Motion, shapes: Shapes, inverse_mass: Numbers, fat: Vectors, boxes: Vectors,
    moved: Flags, already: int, bounded: bool, bounds: Numbers, index: Index, h: float, ahead: float,
    speculative_margin: float,
) -> int:  # fmt: skip
    """Do what :func:`add_pairs` describes; where it is given up, counts are too large."""
    rows, counts, growth = len(motion.angle), near.counts, 0.0
    limit, usual = rows // _BODIES + counts[RECORDED] // _RECORDS, usual_speed(motion, shapes)
    for i in range(rows):
        if moved[i]:
            growth = max(growth, fat[5, i])
    for i in range(rows):
        if not left(i, motion, shapes, fat, h, _SOON * h, speculative_margin):
            continue
        if not fat[3, i] > 0.0 or (not moved[i] and already >= limit):
            return -1
        before = boxes[i, 0], boxes[i, 1], boxes[i, 2], boxes[i, 3]
        old = fat[0, i], fat[1, i], fat[2, i], fat[3, i], fat[4, i], fat[6, i], fat[7, i]
        hit = usual if inverse_mass[i] > 0.0 else 0.0
        x0, y0, x1, y1 = fatten(i, motion, shapes, fat, ahead, hit, HIT_SHARE, speculative_margin)
        new = fat[0, i], fat[1, i], fat[2, i], fat[3, i], fat[4, i], fat[6, i], fat[7, i]
        if new[3] != old[3]:
            return -1
        box = min(x0, before[0]), min(y0, before[1]), max(x1, before[2]), max(y1, before[3])
        grown = max(max(before[0] - box[0], before[1] - box[1]), max(box[2] - before[2], box[3] - before[3]))
        fat[5, i] = grown + (fat[5, i] if moved[i] else 0.0)
        growth = max(growth, fat[5, i])
        leaver = Leaver(i, box, before, not moved[i])
        # Which long bodies it was beside goes by where it was when all pairs were listed.
        fat[0, i], fat[1, i], fat[2, i], fat[4, i] = old[0], old[1], old[2], old[4]
        fat[6, i], fat[7, i] = old[5], old[6]
        done = _list_leaver(leaver, growth, index, near, shapes, fat, boxes, moved, inverse_mass)
        if bounded and inverse_mass[i] > 0.0:
            _meet_walls(leaver, near, bounds)
        fat[0, i], fat[1, i], fat[2, i], fat[4, i] = new[0], new[1], new[2], new[4]
        fat[6, i], fat[7, i] = new[5], new[6]
        boxes[i, 0], boxes[i, 1], boxes[i, 2], boxes[i, 3] = box
        already += 0 if moved[i] else 1
        moved[i] = True
        full = counts[PROXIMITY] > len(near.activation_distance)
        full |= counts[PROXIMITY] + counts[RECORDED] > min(len(near.manifolds), len(near.scalar))
        if full or not done:
            return -1
    return already
