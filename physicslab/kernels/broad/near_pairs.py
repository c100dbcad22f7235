"""The list of near pairs: which have a record, and which are proximity pairs without one.

Most near pairs do not touch for long. They are kept as two rows and a distance each, so that looking at them
all takes a nanosecond or two a pair; the record of a contact, of hundreds of bytes, is made when the two come
so near that they may touch within the substep.
"""

import math

import numpy as np

from physicslab.kernels import (
    Numbers,
    Rows,
    Vectors,
    allocating,
    allocating_kernel,
    always_inlined,
    inlined,
    kernel,
)
from physicslab.kernels.arguments import Motion, Near
from physicslab.kernels.geometry.margins import ACTIVATION_RATIO, CORNERWISE
from physicslab.kernels.geometry.shapes import Shapes, ShapesTuple, named_shapes
from physicslab.kernels.near_counts import PROXIMITY, RECORDED, SCALAR, UNORDERED
from physicslab.kernels.records import Couples, Manifold, Manifolds, Pairs, Points

_LONG = 4.0
"""Ratio of bounding radii from which the circle around the larger body shows little of where it is."""
_FREE = -1
_SIDES = 1024
"""More than there are bounds and segments of a chain."""


@inlined
def _place(table: Rows, mask: int, entity_a: int, entity_b: int, wall: int) -> int:
    """Return where the search for a pair begins in a table of mask + 1 places."""
    mixed = entity_a * 73856093 + entity_b * 19349663 + wall
    return (mixed ^ (mixed >> 15)) & mask


@inlined
def _mask(count: int) -> int:
    """Return the table size less one for so many records: a power of two, at least half of it free."""
    places = 16
    while places < 2 * count:
        places *= 2
    return places - 1


@inlined
def _has_contents(manifold: Manifold) -> bool:
    """Whether the record of a pair holds more than that it is near, and how far apart it was."""
    return bool((manifold.count != 0) | (manifold.impact_count != 0) | (manifold.slot >= 0))


@inlined
def _known(table: Rows, mask: int, manifolds: Manifolds, entity_a: int, entity_b: int, wall: int) -> int:
    """Return the number of the record of a pair, or -1."""
    place = _place(table, mask, entity_a, entity_b, wall)
    while table[place] != _FREE:
        q = table[place]
        old = manifolds[q]
        if old.entity_a == entity_a and old.entity_b == entity_b and old.wall == wall:
            return int(q)
        place = (place + 1) & mask
    return -1


@inlined
def _note_known(manifolds: Manifolds, count: int, table: Rows) -> None:
    """Fill a table that leads from a pair of entities to its record, if that has contents."""
    mask = _mask(count)
    table[: mask + 1] = _FREE
    for q in range(count):
        old = manifolds[q]
        if _has_contents(old):
            place = _place(table, mask, old.entity_a, old.entity_b, old.wall)
            while table[place] != _FREE:
                place = (place + 1) & mask
            table[place] = q


@inlined
def beside(shapes: Shapes, fat: Vectors, one: int, other: int) -> bool:
    """Whether the smaller of two bodies stays beside the other, though it is in the upright box around that.

    Both may leave the places for which the fat boxes were made by no more than their margins.
    """
    long, small = (one, other) if fat[3, one] > fat[3, other] else (other, one)
    if shapes.vertices[long] < 2:
        return False
    c, s = math.cos(fat[2, long]), math.sin(fat[2, long])
    x, y = fat[0, small] - fat[0, long], fat[1, small] - fat[1, long]
    ways = abs(fat[6, long]) + abs(fat[7, long]) + abs(fat[6, small]) + abs(fat[7, small])
    clear = fat[3, small] + shapes.radius[long] + CORNERWISE * (fat[4, long] + fat[4, small]) + ways
    across, up = abs(c * x + s * y), abs(c * y - s * x)
    return bool((across > shapes.half_x[long] + clear) | (up > shapes.half_y[long] + clear))


@inlined
def distance_to_activate(fat: Vectors, a: int, b: int) -> float:
    """Return the distance of two centres within which a pair gets its record [m].

    Where one body is far longer than the other, the circle around it says little: infinity.
    """
    reach_a, reach_b = fat[3, a], fat[3, b]
    if max(reach_a, reach_b) > _LONG * min(reach_a, reach_b):
        return math.inf
    distance: float = ACTIVATION_RATIO * (reach_a + reach_b)
    return distance


@allocating_kernel
def partition(
    couples: Couples, found: int, pairs: Pairs, walls: int,
    plain_shapes: ShapesTuple, fat: Vectors, inverse_mass: Numbers, entities: Rows,
    manifolds: Manifolds, known: int, stale: bool, table: Rows, proximity: Couples,
    activation_distance: Numbers,
) -> tuple[int, int]:  # fmt: skip
    """Partition the pairs that were found: those without points so far get no record, all others get one.

    The rows of those that were ``found`` are in ``couples``, in either order; where neither body can be moved
    they are dropped. In ``pairs`` are the first ``walls``, those of the bounds, and to these are added the
    others with records, sorted; returns how many there are then, and how many proximity pairs. The first
    ``known`` of ``manifolds`` are the records so far, whose rows have changed if they are ``stale``. ``fat``
    is that of :mod:`physicslab.kernels.broad.fat_boxes`. ``table`` is filled for :func:`carry_over`.

    For a long body and a short one that are not ``beside`` each other, the record is made at once.
    """
    _note_known(manifolds, known, table)
    shapes = named_shapes(plain_shapes)
    mask, n = _mask(known), len(shapes.vertices)
    recorded = np.full(n, stale)
    if not stale:
        for q in range(known):
            old = manifolds[q]
            if _has_contents(old):
                recorded[old.a] = recorded[old.b] = True
    kept, proximity_count = walls, 0
    for k in range(found):
        one, other = np.int64(couples[2 * k]), np.int64(couples[2 * k + 1])
        a, b = int(min(one, other)), int(max(one, other))
        if inverse_mass[a] + inverse_mass[b] == 0.0:
            continue
        if (
            not (recorded[a] & recorded[b])
            or _known(table, mask, manifolds, entities[a], entities[b], -1) < 0
        ):
            distance = distance_to_activate(fat, a, b)
            if distance < math.inf:
                proximity[2 * proximity_count], proximity[2 * proximity_count + 1] = a, b
                activation_distance[proximity_count] = distance
                proximity_count += 1
                continue
            if beside(shapes, fat, a, b):
                continue
        pairs[kept, 0], pairs[kept, 1], pairs[kept, 2] = a, b, -1
        kept += 1
    _sort_pairs(pairs, walls, kept, n)
    return kept, proximity_count


@allocating
def _sort_pairs(pairs: Pairs, start: int, end: int, n: int) -> None:
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


@kernel
def carry_over(
    pairs: Pairs, count: int, entities: Rows, old_manifolds: Manifolds, old_points: Points, known: int,
    table: Rows, noted: bool, manifolds: Manifolds, points: Points,
) -> None:  # fmt: skip
    """Give each pair its record: the one it had, or a blank one.

    The first ``known`` of the old records are looked up in ``table``, which is filled first if they are not
    ``noted`` there.
    """
    if not noted:
        _note_known(old_manifolds, known, table)
    mask = _mask(known)
    for p in range(count):
        a, b, wall = pairs[p, 0], pairs[p, 1], pairs[p, 2]
        q = _known(table, mask, old_manifolds, entities[a], entities[b], wall)
        if q >= 0:
            manifolds[p] = old_manifolds[q]
            points[2 * p] = old_points[2 * q]
            points[2 * p + 1] = old_points[2 * q + 1]
        else:
            make_blank(manifolds, points, p)
            manifold = manifolds[p]
            manifold.entity_a, manifold.entity_b, manifold.wall = entities[a], entities[b], wall
        manifold = manifolds[p]
        manifold.a, manifold.b = a, b


@inlined
def make_blank(manifolds: Manifolds, points: Points, p: int) -> None:
    """Clear a record of all contents."""
    manifold = manifolds[p]
    manifold.count, manifold.found, manifold.impact_count, manifold.slot, manifold.size = 0, 0, 0, -1, 0.0
    for j in range(2 * p, 2 * p + 2):
        point = points[j]
        point.feature = point.ahead = 0
        point.normal_impulse = point.tangent_impulse = 0.0
        point.approach_speed = point.impact_normal = point.impact_tangent = point.bend = 0.0


@always_inlined
def comes_near(
    proximity: Couples, activation_distance: Numbers, k: int, places: Numbers, velocities: Numbers, h: float,
    speculative_margin: float,
) -> bool:  # fmt: skip
    """Whether proximity pair k may touch within ``h`` seconds from now or before.

    ``places`` and ``velocities`` (2 rows,) are flat, and indices unsigned: else each is multiplied by a
    stride and tested for its sign.
    """
    xa, xb = 2 * np.uint64(proximity[2 * k]), 2 * np.uint64(proximity[2 * k + 1])
    ya, yb = xa + np.uint64(1), xb + np.uint64(1)
    dx, dy = places[xb] - places[xa], places[yb] - places[ya]
    moved = abs(velocities[xb] - velocities[xa]) + abs(velocities[yb] - velocities[ya])
    far = activation_distance[k] + CORNERWISE * (moved * h + speculative_margin)
    return bool(not (dx * dx + dy * dy > far * far))


@inlined
def give_record(
    proximity: Couples, k: int, manifolds: Manifolds, points: Points, p: int, entities: Rows
) -> None:
    """Make record ``p`` that of proximity pair k, which has had no points yet."""
    manifold, a, b = manifolds[p], np.int64(proximity[2 * k]), np.int64(proximity[2 * k + 1])
    make_blank(manifolds, points, p)
    manifold.a, manifold.b, manifold.wall = a, b, -1
    manifold.entity_a, manifold.entity_b = entities[a], entities[b]


@allocating
def activate(
    proximity: Couples, activation_distance: Numbers, proximity_count: int, manifolds: Manifolds,
    points: Points, count: int,
    scalar: Rows, scalar_count: int, entities: Rows, position: Vectors, linear: Vectors, h: float,
    speculative_margin: float, near: Rows,
) -> tuple[int, int, int]:  # fmt: skip
    """Give records to the proximity pairs that may touch within ``h`` seconds from now or before.

    Returns how many pairs have no record, have one, and are scalar. New records are appended, and their
    numbers put into ``scalar`` in the order of rows, so that the time of activation makes no difference.
    In ``near`` is room for the numbers of all proximity pairs.
    """
    if proximity_count == 0:
        return proximity_count, count, scalar_count
    came = 0
    places, velocities = position.reshape(position.size), linear.reshape(linear.size)
    for k in range(proximity_count):
        near[came] = k  # kept by counting: which pair comes near cannot be predicted
        came += comes_near(proximity, activation_distance, k, places, velocities, h, speculative_margin)
    if came == 0:
        return proximity_count, count, scalar_count
    for k in range(came):
        give_record(proximity, near[k], manifolds, points, count + k, entities)
        scalar[scalar_count + k] = count + k
    for k in range(came - 1, -1, -1):
        proximity_count, to = proximity_count - 1, near[k]
        proximity[2 * to] = proximity[2 * proximity_count]
        proximity[2 * to + 1] = proximity[2 * proximity_count + 1]
        activation_distance[to] = activation_distance[proximity_count]
    merge_tail(manifolds, scalar, scalar_count, scalar_count + came, len(entities))
    return proximity_count, count + came, scalar_count + came


@inlined
def list_near(near: Near, motion: Motion, h: float, speculative_margin: float) -> None:
    """Give records to the pairs that may touch within ``h`` seconds, at their velocities of now.

    Scalar pairs are in order then. What ``near.touching`` lists is lost.
    """
    counts = near.counts
    if counts[UNORDERED] != 0:
        sort_scalar(near.manifolds, near.scalar, counts[SCALAR], len(motion.angle))
        counts[UNORDERED] = 0
    counts[PROXIMITY], counts[RECORDED], counts[SCALAR] = activate(
        near.proximity, near.activation_distance, counts[PROXIMITY], near.manifolds, near.points,
        counts[RECORDED], near.scalar, counts[SCALAR], near.entities, motion.position, motion.linear, h,
        speculative_margin, near.touching,
    )  # fmt: skip


@inlined
def rank_of(manifolds: Manifolds, p: int, rows: int) -> int:
    """Return a number that is larger for what comes later in the order of rows and walls."""
    manifold = manifolds[p]
    wall = manifold.wall if manifold.wall > -2 else 2 - manifold.wall
    return int((manifold.a * rows + manifold.b) * _SIDES + wall + 1)


@allocating
def merge_tail(manifolds: Manifolds, scalar: Rows, start: int, count: int, rows: int) -> None:
    """Put the numbers from ``start`` on in their places among those before, which are in order."""
    many = count - start
    tail, ranks = np.empty(many, np.int64), np.empty(many, np.int64)
    for k in range(many):
        tail[k] = scalar[start + k]
        ranks[k] = rank_of(manifolds, tail[k], rows)
    gap = many // 2  # Shell's sort: a few as a rule, all pairs of a world at its beginning
    while gap > 0:
        for k in range(gap, many):
            p, rank, place = tail[k], ranks[k], k
            while place >= gap and ranks[place - gap] > rank:
                tail[place], ranks[place] = tail[place - gap], ranks[place - gap]
                place -= gap
            tail[place], ranks[place] = p, rank
        gap = 1 if gap == 2 else (gap * 5) // 11
    before, to = start - 1, count - 1
    for k in range(many - 1, -1, -1):
        while before >= 0 and rank_of(manifolds, scalar[before], rows) > ranks[k]:
            scalar[to] = scalar[before]
            to, before = to - 1, before - 1
        scalar[to] = tail[k]
        to -= 1


@kernel
def sort_scalar(manifolds: Manifolds, scalar: Rows, count: int, rows: int) -> None:
    """Sort scalar pairs by rows and walls; as a rule all but the last few are in order."""
    start = min(count, 1)
    while start < count and rank_of(manifolds, scalar[start - 1], rows) < rank_of(
        manifolds, scalar[start], rows
    ):
        start += 1
    if start < count:
        merge_tail(manifolds, scalar, start, count, rows)
