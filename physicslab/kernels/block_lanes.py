"""Which settled contact has which lane of which block: taking contacts in, giving them back."""

import math
from typing import Annotated

import numpy as np
from numba import uint64
from numpy.typing import NDArray

from physicslab.kernels import Flags, Numbers, Rows, Vectors, inlined, kernel
from physicslab.kernels.block_layout import (
    ANGLE_A,
    ANGLE_B,
    ARM_AX,
    ARM_AY,
    ARM_BX,
    ARM_BY,
    BASE_X,
    BASE_Y,
    BOX_ROWS,
    DISC,
    DISC_ROWS,
    FOUND,
    FRICTION,
    IMPULSE,
    INERTIA_A,
    INERTIA_B,
    MASS,
    MASS_A,
    MASS_B,
    NORMAL_X,
    NORMAL_Y,
    ONE,
    RADIUS_A,
    RADIUS_B,
    RUB,
    RUB_MASS,
    SEPARATION,
    SIZE,
    TWO,
    WIDE,
)  # fmt: skip
from physicslab.kernels.records import Manifold, Manifolds, Point, Points

__all__ = [
    "COLOURS", "Masks", "admit", "empty_lane", "follow_pairs", "give_up", "keep_loose", "list_loose",
    "release", "seat_again", "sort_blocks", "sort_loose", "store",
    "store_lane", "wake",
]  # fmt: skip

COLOURS = 64
"""So many blocks, at the most, may move one body; what is left over stays loose."""
_OF_FIXED = 48
"""The first colour of contacts with what nothing moves: they are solved last, and so hold best."""
Masks = Annotated[NDArray[np.uint64], uint64[::1]]
"""A uint64 array (n,), bit by bit."""


@inlined
def empty_lane(data: Numbers, rows: int, k: int, lane: int, a: Rows, b: Rows, pair: Rows) -> None:
    """Let lane number ``lane`` of block k stand for nothing: it moves nobody, and is never of interest."""
    block = data[k * rows : (k + 1) * rows]
    for row in range(0, rows, WIDE):
        block[row + lane] = 0.0
    block[SIZE + lane] = block[NORMAL_X + lane] = block[ONE + SEPARATION + lane] = 1.0
    if rows == DISC_ROWS:
        block[RADIUS_A + lane] = block[RADIUS_B + lane] = -0.5
    else:
        block[TWO + SEPARATION + lane] = block[ONE + FOUND + lane] = block[TWO + FOUND + lane] = 1.0
    a[k * WIDE + lane] = b[k * WIDE + lane] = 0
    pair[k * WIDE + lane] = -1


@inlined
def _fill_common(
    data: Numbers, at: int, manifold: Manifold, inverse_mass: Numbers, inverse_inertia: Numbers
) -> None:
    a, b = manifold.a, manifold.b
    data[at + NORMAL_X], data[at + NORMAL_Y] = manifold.normal_x, manifold.normal_y
    data[at + FRICTION], data[at + SIZE] = manifold.friction, manifold.size
    data[at + MASS_A], data[at + MASS_B] = inverse_mass[a], inverse_mass[b]
    data[at + INERTIA_A], data[at + INERTIA_B] = inverse_inertia[a], inverse_inertia[b]


@inlined
def _fill_point(data: Numbers, at: int, point: Point) -> None:
    data[at + IMPULSE], data[at + RUB] = point.normal_impulse, point.tangent_impulse
    data[at + MASS], data[at + RUB_MASS] = point.normal_mass, point.tangent_mass
    data[at + SEPARATION] = point.separation


@inlined
def _fill_arms(data: Numbers, at: int, point: Point) -> None:
    data[at + ARM_AX], data[at + ARM_AY] = point.arm_ax, point.arm_ay
    data[at + ARM_BX], data[at + ARM_BY] = point.arm_bx, point.arm_by
    data[at + FOUND] = point.found_separation


@inlined
def store_lane(data: Numbers, rows: int, lane: int, p: int, manifolds: Manifolds, points: Points) -> None:
    """Write what the lane holds, impulses above all, into the records of its pair."""
    at = lane // WIDE * rows + lane % WIDE
    manifold = manifolds[p]
    for j in range(manifold.count):
        point = points[2 * p + j]
        base = at + (ONE if j == 0 else TWO)
        point.normal_impulse, point.tangent_impulse = data[base + IMPULSE], data[base + RUB]
        point.separation = data[base + SEPARATION]
    if rows == DISC_ROWS:
        nx, ny, point = data[at + NORMAL_X], data[at + NORMAL_Y], points[2 * p]
        manifold.normal_x, manifold.normal_y = nx, ny
        point.arm_ax, point.arm_ay = data[at + RADIUS_A] * nx, data[at + RADIUS_A] * ny
        point.arm_bx, point.arm_by = -data[at + RADIUS_B] * nx, -data[at + RADIUS_B] * ny


@kernel
def store(data: Numbers, rows: int, blocks: int, pair: Rows, manifolds: Manifolds, points: Points) -> None:
    """Write what every lane holds into the records of its pair; the lanes stay."""
    for lane in range(blocks * WIDE):
        if pair[lane] >= 0:
            store_lane(data, rows, lane, pair[lane], manifolds, points)


@inlined
def _is_settled(
    manifold: Manifold, one: Point, two: Point, linear: Vectors, h: float, still: float, near: float
) -> bool:
    """Whether a contact may lie in a block: it is slow for its size, and overlaps little."""
    if manifold.swept != 0 or manifold.struck != 0 or one.ahead != 0:
        return False
    a, b, deep = manifold.a, manifold.b, -0.1 * manifold.size
    if one.separation < deep or (manifold.count == 2 and (two.separation < deep or two.ahead != 0)):
        return False
    ux, uy = (linear[b, 0] - linear[a, 0]) * h, (linear[b, 1] - linear[a, 1]) * h
    slow = still if manifold.found == 0 else near
    return bool(ux * ux + uy * uy <= slow * slow * manifold.size * manifold.size)


@inlined
def _seat(
    kind: int, data: Numbers, lane: int, a: Rows, b: Rows, pair: Rows, used: Masks, colour: int,
    manifolds: Manifolds, points: Points, p: int,
    radius: Numbers, restitution: Numbers, friction: Numbers,
    inverse_mass: Numbers, inverse_inertia: Numbers,
) -> None:  # fmt: skip
    """Put a pair into a free lane of a block of that colour."""
    rows = DISC_ROWS if kind == DISC else BOX_ROWS
    at = lane // WIDE * rows + lane % WIDE
    manifold, one, two = manifolds[p], points[2 * p], points[2 * p + 1]
    i, j = manifold.a, manifold.b
    manifold.restitution = min(restitution[i], restitution[j])
    manifold.friction = math.sqrt(friction[i] * friction[j])
    if kind == DISC:
        manifold.size, manifold.swept = 2.0 * min(radius[i], radius[j]), 0
    _fill_common(data, at, manifold, inverse_mass, inverse_inertia)
    _fill_point(data, at + ONE, one)
    if kind == DISC:
        ra, rb, linear = radius[i], radius[j], inverse_mass[i] + inverse_mass[j]
        data[at + RADIUS_A], data[at + RADIUS_B] = ra, rb
        data[at + ONE + MASS] = 1.0 / linear
        data[at + ONE + RUB_MASS] = 1.0 / (
            linear + inverse_inertia[i] * ra * ra + inverse_inertia[j] * rb * rb
        )
    else:
        data[at + BASE_X], data[at + BASE_Y] = manifold.base_x, manifold.base_y
        data[at + ANGLE_A], data[at + ANGLE_B] = manifold.base_angle_a, manifold.base_angle_b
        _fill_arms(data, at + ONE, one)
        if manifold.count == 2:
            _fill_point(data, at + TWO, two)
            _fill_arms(data, at + TWO, two)
    a[lane], b[lane], pair[lane] = i, j, p
    bit = np.uint64(1) << np.uint64(colour)
    used[i] |= bit
    used[j] |= bit
    manifold.lane = 2 * lane + kind


@inlined
def _survey(blocks: int, pair: Rows, colour: Rows, opened: Rows) -> tuple[int, int]:
    """Find the first block of each colour that has room, the first empty one, and how many are needed.

    Nothing of that hangs on what was before: a world read from a file goes on alike.
    """
    opened[:] = -1
    last = 0
    first_empty = -1
    for k in range(blocks):
        free = 0
        for lane in range(k * WIDE, (k + 1) * WIDE):
            free += 1 if pair[lane] < 0 else 0
        if free == WIDE:
            colour[k] = -1
            if first_empty < 0:
                first_empty = k
            continue
        last = k + 1
        if free > 0 and opened[colour[k]] < 0:
            opened[colour[k]] = k
    return last, first_empty if 0 <= first_empty < last else last


@inlined
def _free_lane(home: int, blocks: int, c: int, pair: Rows, colour: Rows) -> int:
    """Return the first free lane of the blocks of a colour from ``home`` on, or -1."""
    for k in range(home, blocks):
        if colour[k] == c:
            for lane in range(k * WIDE, (k + 1) * WIDE):
                if pair[lane] < 0:
                    return lane
    return -1


@kernel
def admit(
    kind: int, data: Numbers, blocks: int, a: Rows, b: Rows, pair: Rows, colour: Rows, used: Masks,
    opened: Rows, manifolds: Manifolds, points: Points, touching: Rows, count: int,
    shape: Rows, radius: Numbers, restitution: Numbers, friction: Numbers, linear: Vectors,
    inverse_mass: Numbers, inverse_inertia: Numbers, asleep: Flags,
    h: float, still: float, near: float,
) -> tuple[int, int]:  # fmt: skip
    """Take the settled contacts of one kind into blocks; return how many there are, and how many came.

    Two contacts of a body never share a block: each has one of ``COLOURS``, the first that neither of its
    bodies has been given. ``used`` (rows,) are the colours of each body's contacts, ``opened`` (COLOURS,) the
    block of each colour that may have room. What finds no room in ``data`` stays loose, and so does what
    touches somebody ``asleep``: it is about to wake him.
    """
    rows, came = (DISC_ROWS if kind == DISC else BOX_ROWS), 0
    blocks, empty = _survey(blocks, pair, colour, opened)
    for k in range(count):
        p = touching[k]
        manifold = manifolds[p]
        i, j = manifold.a, manifold.b
        discs, boxes = shape[i] == 1 and shape[j] == 1, shape[i] == 2 and shape[j] == 2
        if manifold.wall >= 0 or not (discs if kind == DISC else boxes and manifold.found == 2):
            continue
        if asleep[i] or asleep[j]:
            continue
        if not _is_settled(manifold, points[2 * p], points[2 * p + 1], linear, h, still, near):
            continue
        taken = used[i] if inverse_mass[i] > 0.0 else np.uint64(0)
        if inverse_mass[j] > 0.0:
            taken |= used[j]
        c = 0 if inverse_mass[i] > 0.0 and inverse_mass[j] > 0.0 else _OF_FIXED
        while c < COLOURS and (taken >> np.uint64(c)) & np.uint64(1) != np.uint64(0):
            c += 1
        if c == COLOURS:
            continue
        lane = _free_lane(opened[c], blocks, c, pair, colour) if opened[c] >= 0 else -1
        if lane < 0:
            home = empty
            if (home + 1) * rows > len(data):
                continue
            for free in range(WIDE):
                empty_lane(data, rows, home, free, a, b, pair)
            colour[home], lane = c, home * WIDE
            blocks = max(blocks, home + 1)
            empty += 1
            while empty < blocks and colour[empty] >= 0:
                empty += 1
        opened[c] = lane // WIDE
        _seat(
            kind, data, lane, a, b, pair, used, c, manifolds, points, p, radius, restitution, friction,
            inverse_mass, inverse_inertia,
        )  # fmt: skip
        came += 1
    return blocks, came


@kernel
def seat_again(
    kind: int, data: Numbers, a: Rows, b: Rows, pair: Rows, colour: Rows, used: Masks,
    manifolds: Manifolds, points: Points, pairs: int,
    shape: Rows, radius: Numbers, restitution: Numbers, friction: Numbers,
    inverse_mass: Numbers, inverse_inertia: Numbers,
) -> tuple[int, int]:  # fmt: skip
    """Put the pairs whose records name a lane back there; return how many blocks there are, and lanes.

    What has no business there, as a file may say that was written by hand, stays loose.
    """
    rows, blocks, seated = (DISC_ROWS if kind == DISC else BOX_ROWS), 0, 0
    for p in range(pairs):
        if manifolds[p].lane >= 0 and manifolds[p].lane % 2 == kind:
            blocks = max(blocks, manifolds[p].lane // 2 // WIDE + 1)
    for k in range(blocks):
        for lane in range(WIDE):
            empty_lane(data, rows, k, lane, a, b, pair)
    for p in range(pairs):
        named = manifolds[p].lane
        if named >= 0 and named % 2 == kind:
            lane, manifold = named // 2, manifolds[p]
            i, j, wanted = manifold.a, manifold.b, 1 if kind == DISC else 2
            bit = np.uint64(1) << np.uint64(colour[lane // WIDE])
            taken = (used[i] if inverse_mass[i] > 0.0 else np.uint64(0)) | (
                used[j] if inverse_mass[j] > 0.0 else np.uint64(0)
            )
            fits = pair[lane] < 0 and taken & bit == np.uint64(0) and manifold.wall < 0
            fits = fits and shape[i] == wanted and shape[j] == wanted and manifold.count > 0
            if not fits or inverse_mass[i] + inverse_mass[j] == 0.0:
                manifold.lane = -1
                continue
            _seat(
                kind, data, lane, a, b, pair, used, colour[lane // WIDE], manifolds, points, p,
                radius, restitution, friction, inverse_mass, inverse_inertia,
            )  # fmt: skip
            seated += 1
    return blocks, seated


@kernel
def sort_blocks(blocks: int, colour: Rows, order: Rows) -> None:
    """Write the blocks in the order of their colours.

    Blocks of one colour share no body that moves: one need not wait for what the last one came to.
    """
    found = 0
    for c in range(-1, COLOURS):
        for k in range(blocks):
            if colour[k] == c:
                order[found] = k
                found += 1


@kernel
def list_loose(manifolds: Manifolds, pairs: int, quiet: Flags, loose: Rows, resting: Rows) -> tuple[int, int]:
    """Write the pairs that have no lane, in order; return how many there are.

    Where both bodies are ``quiet`` (rows,), none of which there may be, nothing is to be found out: of such
    pairs those with points are written to ``resting``; how many is returned as well.
    """
    found, rest = 0, 0
    for p in range(pairs):
        if manifolds[p].lane >= 0:
            continue
        if len(quiet) > 0 and quiet[manifolds[p].a] and quiet[manifolds[p].b]:
            if manifolds[p].count > 0:
                resting[rest] = p
                rest += 1
            continue
        loose[found] = p
        found += 1
    return found, rest


@kernel
def sort_loose(loose: Rows, count: int) -> None:
    """Put the loose pairs in order, of which all but the last few are."""
    for k in range(1, count):
        p, place = loose[k], k
        while place > 0 and loose[place - 1] > p:
            loose[place] = loose[place - 1]
            place -= 1
        loose[place] = p


@kernel
def follow_pairs(
    kind: int, data: Numbers, blocks: int, a: Rows, b: Rows, pair: Rows, colour: Rows, used: Masks,
    manifolds: Manifolds, pairs: int,
) -> int:  # fmt: skip
    """After pairs were listed anew, find those of the lanes; return how many lanes are in use.

    A lane whose pair is near no longer is given up.
    """
    rows, kept = (DISC_ROWS if kind == DISC else BOX_ROWS), 0
    before = pair[: blocks * WIDE].copy()
    for lane in range(blocks * WIDE):
        pair[lane] = -1
    for p in range(pairs):
        lane = manifolds[p].lane
        if lane >= 0 and lane % 2 == kind:
            pair[lane // 2] = p
            kept += 1
    for lane in range(blocks * WIDE):
        if before[lane] >= 0 and pair[lane] < 0:
            give_up(data, rows, lane, a, b, pair, colour, used)
    return kept


@inlined
def give_up(
    data: Numbers, rows: int, lane: int, a: Rows, b: Rows, pair: Rows, colour: Rows, used: Masks
) -> None:
    """Empty a lane, for others to use."""
    k = lane // WIDE
    bit = np.uint64(1) << np.uint64(colour[k])
    used[a[lane]] &= ~bit
    used[b[lane]] &= ~bit
    empty_lane(data, rows, k, lane % WIDE, a, b, pair)


@kernel
def release(
    kind: int, data: Numbers, blocks: int, a: Rows, b: Rows, pair: Rows, colour: Rows, used: Masks,
    manifolds: Manifolds, points: Points, asleep: Flags,
) -> int:  # fmt: skip
    """Give the contacts of sleepers back to their records; return how many."""
    rows, released = (DISC_ROWS if kind == DISC else BOX_ROWS), 0
    for lane in range(blocks * WIDE):
        p = pair[lane]
        if p >= 0 and (asleep[a[lane]] or asleep[b[lane]]):
            store_lane(data, rows, lane, p, manifolds, points)
            manifolds[p].lane = -1
            give_up(data, rows, lane, a, b, pair, colour, used)
            released += 1
    return released


@kernel
def keep_loose(manifolds: Manifolds, touching: Rows, count: int) -> int:
    """Take the pairs that have lanes out of the list of those that touch; return how many are left."""
    kept = 0
    for k in range(count):
        p = touching[k]
        if manifolds[p].lane < 0:
            touching[kept] = p
            kept += 1
    return kept


@inlined
def _resting_speed(a: int, b: int, linear: Vectors, force: Vectors, inverse_mass: Numbers, h: float) -> float:
    """Return up to which speed an approach is rest: what forces bring about in two substeps [m/s]."""
    speed = abs(linear[a, 0]) + abs(linear[a, 1]) + abs(linear[b, 0]) + abs(linear[b, 1])
    pull_a = math.sqrt(force[a, 0] * force[a, 0] + force[a, 1] * force[a, 1]) * inverse_mass[a]
    pull_b = math.sqrt(force[b, 0] * force[b, 0] + force[b, 1] * force[b, 1]) * inverse_mass[b]
    resting: float = 1e-9 * speed + 2.0 * h * max(pull_a, pull_b)
    return resting


@kernel
def wake(
    kind: int, data: Numbers, blocks: int, a: Rows, b: Rows, pair: Rows, colour: Rows, used: Masks,
    manifolds: Manifolds, points: Points, loose: Rows, loose_count: int, touching: Rows, count: int,
    linear: Vectors, angular: Numbers, force: Vectors, inverse_mass: Numbers, h: float,
) -> tuple[int, int]:  # fmt: skip
    """Set loose what touches a struck body, may bounce, and approaches faster than rest.

    Returns how many pairs are loose, and how many of them touch.
    """
    rows = DISC_ROWS if kind == DISC else BOX_ROWS
    struck = np.zeros(len(angular), np.bool_)
    for k in range(count):
        manifold = manifolds[touching[k]]
        if manifold.struck > 0:
            struck[manifold.a] = struck[manifold.b] = True
    for lane in range(blocks * WIDE):
        p = pair[lane]
        if p < 0 or not (struck[a[lane]] | struck[b[lane]]) or manifolds[p].restitution == 0.0:
            continue
        at, i, j = lane // WIDE * rows + lane % WIDE, a[lane], b[lane]
        nx, ny = data[at + NORMAL_X], data[at + NORMAL_Y]
        lowest = 0.0
        for k in range(manifolds[p].count):
            base = at + (ONE if k == 0 else TWO)
            if kind == DISC:
                rax, ray = data[at + RADIUS_A] * nx, data[at + RADIUS_A] * ny
                rbx, rby = -data[at + RADIUS_B] * nx, -data[at + RADIUS_B] * ny
            else:
                rax, ray = data[base + ARM_AX], data[base + ARM_AY]
                rbx, rby = data[base + ARM_BX], data[base + ARM_BY]
            vx = linear[j, 0] - angular[j] * rby - linear[i, 0] + angular[i] * ray
            vy = linear[j, 1] + angular[j] * rbx - linear[i, 1] - angular[i] * rax
            lowest = min(lowest, vx * nx + vy * ny)
        if lowest < 0.0 and lowest < -_resting_speed(i, j, linear, force, inverse_mass, h):
            store_lane(data, rows, lane, p, manifolds, points)
            manifolds[p].lane = -1
            loose[loose_count], touching[count] = p, p
            loose_count, count = loose_count + 1, count + 1
            give_up(data, rows, lane, a, b, pair, colour, used)
    return loose_count, count
