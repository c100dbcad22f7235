"""The broad phase: a uniform grid over fat boxes, sorted by counting."""

import math

import numpy as np
from numba import boolean, float64, int64, void

from physicslab.kernels import inlined, kernel
from physicslab.kernels.records import Manifolds, Points

__all__ = ["carry_over", "fat_boxes", "find_pairs", "still_holds"]

_FLAGS = boolean[::1]
_NUMBERS = float64[::1]
_VECTORS = float64[:, ::1]
_ROWS = int64[::1]

_LARGE = 16
"""Bodies that would span more cells than this along one axis are kept out of the grid."""


@inlined
def _bounding_radius(kind, radius, width, height):
    if kind == 1:
        return radius
    return 0.5 * math.sqrt(width * width + height * height)


@kernel(boolean(_VECTORS, _NUMBERS, _VECTORS, _ROWS, _NUMBERS, _NUMBERS, _NUMBERS, _VECTORS, float64))
def still_holds(position, angle, linear, kind, radius, width, height, fat, h):
    """Whether every body, with what it moves in a time h, is still inside the fat box made for it.

    ``fat`` (rows, 5) holds where each body was (x, y, angle), its bounding radius then, and the margin around it.
    """
    for i in range(len(angle)):
        if kind[i] == 0:
            if fat[i, 3] != 0.0:
                return False
            continue
        reach = _bounding_radius(kind[i], radius[i], width[i], height[i])
        moved_x = abs(position[i, 0] - fat[i, 0]) + abs(linear[i, 0]) * h
        moved_y = abs(position[i, 1] - fat[i, 1]) + abs(linear[i, 1]) * h
        turned = abs(angle[i] - fat[i, 2]) * reach if kind[i] == 2 else 0.0
        if not max(moved_x, moved_y) + turned <= fat[i, 4] or reach != fat[i, 3]:
            return False
    return True


@kernel(
    float64(_VECTORS, _NUMBERS, _VECTORS, _ROWS, _NUMBERS, _NUMBERS, _NUMBERS, _VECTORS, _VECTORS, float64)
)
def fat_boxes(position, angle, linear, kind, radius, width, height, fat, boxes, h):
    """Make each body's fat box (xmin, ymin, xmax, ymax), good for about two steps; return a fitting cell size."""
    count, inverse_sizes = 0, 0.0
    for i in range(len(angle)):
        fat[i, 3] = 0.0
        if kind[i] == 0:
            continue
        reach = _bounding_radius(kind[i], radius[i], width[i], height[i])
        half_x = half_y = reach
        if kind[i] == 2:
            c, s = abs(math.cos(angle[i])), abs(math.sin(angle[i]))
            half_x = 0.5 * (c * width[i] + s * height[i])
            half_y = 0.5 * (s * width[i] + c * height[i])
        margin = 0.1 * min(half_x, half_y) + 8.0 * h * max(abs(linear[i, 0]), abs(linear[i, 1]))
        fat[i, 0], fat[i, 1], fat[i, 2] = position[i, 0], position[i, 1], angle[i]
        fat[i, 3], fat[i, 4] = reach, margin
        boxes[i, 0], boxes[i, 2] = position[i, 0] - half_x - margin, position[i, 0] + half_x + margin
        boxes[i, 1], boxes[i, 3] = position[i, 1] - half_y - margin, position[i, 1] + half_y + margin
        count += 1
        inverse_sizes += 1.0 / (max(half_x, half_y) + margin)
    return 4.0 * count / inverse_sizes if count else 1.0  # twice the harmonic mean, which a few walls do not spoil


@inlined
def _overlap(boxes, i, j):
    return (
        boxes[i, 0] <= boxes[j, 2] and boxes[j, 0] <= boxes[i, 2]
        and boxes[i, 1] <= boxes[j, 3] and boxes[j, 1] <= boxes[i, 3]
    )  # fmt: skip


@inlined
def _bucket(ix, iy, mask):
    return ((ix * 73856093) ^ (iy * 19349663)) & mask


@kernel(int64(_VECTORS, _ROWS, _NUMBERS, float64, boolean, _NUMBERS, int64[:, ::1]))
def find_pairs(boxes, kind, inverse_mass, cell, bounded, bounds, pairs):
    """Write the pairs (a, b, wall) whose fat boxes overlap, each once, sorted; return how many there are.

    A body may span many cells; a pair is taken only in the cell that holds the lower left corner of the boxes'
    overlap. Large bodies are compared with all others. Pairs of which neither can be moved do not count. More pairs
    than ``pairs`` has rows are counted and not written.
    """
    n = len(kind)
    small = np.empty(n, np.int64)
    large = np.empty(n, np.int64)
    smalls, larges, entries = 0, 0, 0
    for i in range(n):
        if kind[i] == 0:
            continue
        across = math.floor(boxes[i, 2] / cell) - math.floor(boxes[i, 0] / cell)
        up = math.floor(boxes[i, 3] / cell) - math.floor(boxes[i, 1] / cell)
        if across < _LARGE and up < _LARGE:
            small[smalls] = i
            smalls += 1
            entries += (int(across) + 1) * (int(up) + 1)
        else:
            large[larges] = i
            larges += 1

    # Count the entries of each bucket, then put them there: a counting sort.
    mask = 1
    while mask < 2 * entries:
        mask *= 2
    mask -= 1
    first = np.zeros(mask + 2, np.int64)
    cell_x = np.empty(entries, np.int64)
    cell_y = np.empty(entries, np.int64)
    body = np.empty(entries, np.int64)
    for k in range(smalls):
        i = small[k]
        for ix in range(int(math.floor(boxes[i, 0] / cell)), int(math.floor(boxes[i, 2] / cell)) + 1):
            for iy in range(int(math.floor(boxes[i, 1] / cell)), int(math.floor(boxes[i, 3] / cell)) + 1):
                first[_bucket(ix, iy, mask) + 1] += 1
    for bucket in range(mask + 1):
        first[bucket + 1] += first[bucket]
    fill = first[:-1].copy()
    for k in range(smalls):
        i = small[k]
        for ix in range(int(math.floor(boxes[i, 0] / cell)), int(math.floor(boxes[i, 2] / cell)) + 1):
            for iy in range(int(math.floor(boxes[i, 1] / cell)), int(math.floor(boxes[i, 3] / cell)) + 1):
                bucket = _bucket(ix, iy, mask)
                cell_x[fill[bucket]], cell_y[fill[bucket]], body[fill[bucket]] = ix, iy, i
                fill[bucket] += 1

    found = 0
    room = len(pairs)
    if bounded:
        for i in range(n):
            if kind[i] != 0 and inverse_mass[i] > 0.0:
                for wall in range(4):
                    outside = boxes[i, wall] < bounds[wall] if wall < 2 else boxes[i, wall] > bounds[wall]
                    if outside:
                        if found < room:
                            pairs[found, 0], pairs[found, 1], pairs[found, 2] = 0, i, wall
                        found += 1
    walls = found
    for bucket in range(mask + 1):
        for p in range(first[bucket], first[bucket + 1]):
            i = body[p]
            for q in range(p + 1, first[bucket + 1]):
                if cell_x[q] != cell_x[p] or cell_y[q] != cell_y[p]:
                    continue
                j = body[q]
                if inverse_mass[i] + inverse_mass[j] == 0.0 or not _overlap(boxes, i, j):
                    continue
                if int(math.floor(max(boxes[i, 0], boxes[j, 0]) / cell)) != cell_x[p]:
                    continue
                if int(math.floor(max(boxes[i, 1], boxes[j, 1]) / cell)) != cell_y[p]:
                    continue
                if found < room:
                    pairs[found, 0], pairs[found, 1], pairs[found, 2] = min(i, j), max(i, j), -1
                found += 1
    for k in range(larges):
        i = large[k]
        for q in range(smalls + k):
            j = small[q] if q < smalls else large[q - smalls]
            if inverse_mass[i] + inverse_mass[j] > 0.0 and _overlap(boxes, i, j):
                if found < room:
                    pairs[found, 0], pairs[found, 1], pairs[found, 2] = min(i, j), max(i, j), -1
                found += 1
    if found <= room:
        _sort_pairs(pairs, walls, found, n)
    return found


@inlined
def _sort_pairs(pairs, start, end, n):
    """Sort pairs by a, then b: by counting, twice, the last significant key first."""
    spare = np.empty((end - start, 2), np.int64)
    for key in (1, 0):
        first = np.zeros(n + 1, np.int64)
        for p in range(start, end):
            first[pairs[p, key] + 1] += 1
        for i in range(n):
            first[i + 1] += first[i]
        for p in range(start, end):
            to = first[pairs[p, key]]
            spare[to, 0], spare[to, 1] = pairs[p, 0], pairs[p, 1]
            first[pairs[p, key]] += 1
        for p in range(start, end):
            pairs[p, 0], pairs[p, 1] = spare[p - start, 0], spare[p - start, 1]


@kernel(void(int64[:, ::1], int64, _ROWS, Manifolds, Points, int64, Manifolds, Points))
def carry_over(pairs, count, entities, old_manifolds, old_points, old_count, manifolds, points):
    """Give each pair its manifold: the one it had, found by walking both sorted lists, or an empty one."""
    q = 0
    for p in range(count):
        a, b, wall = pairs[p, 0], pairs[p, 1], pairs[p, 2]
        entity_a, entity_b = entities[a], entities[b]
        while q < old_count:
            old = old_manifolds[q]
            if old.entity_a > entity_a:
                break
            if old.entity_a == entity_a:
                if old.entity_b > entity_b:
                    break
                if old.entity_b == entity_b and old.wall >= wall:
                    break
            q += 1
        manifold = manifolds[p]
        matches = False
        if q < old_count:
            old = old_manifolds[q]
            matches = old.entity_a == entity_a and old.entity_b == entity_b and old.wall == wall
        if matches:
            manifolds[p] = old_manifolds[q]
            points[2 * p] = old_points[2 * q]
            points[2 * p + 1] = old_points[2 * q + 1]
        else:
            manifold.entity_a, manifold.entity_b, manifold.wall = entity_a, entity_b, wall
            manifold.count, manifold.found, manifold.struck = 0, 0, 0
            points[2 * p].feature = points[2 * p + 1].feature = 0
            points[2 * p].normal_impulse = points[2 * p + 1].normal_impulse = 0.0
            points[2 * p].tangent_impulse = points[2 * p + 1].tangent_impulse = 0.0
        manifold.a, manifold.b = a, b
