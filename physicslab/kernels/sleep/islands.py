"""Islands: bodies that touch each other, directly or through others. They fall asleep and wake together."""

import math

import numpy as np

from physicslab.kernels import Flags, Numbers, Rows, Vectors, allocating_kernel, inlined, kernel
from physicslab.kernels.records import Manifolds, Points

__all__ = ["READY", "REST", "SLOW", "count_rest", "find_held", "find_touched", "join_marked", "list_sleeping"]

REST = 0.5
"""How long [s] a body must have been slow before it may sleep."""
SLOW = 0.05
"""Speed [m/s] of any point of a body below which it is slow."""
_GAIN = 0.002
"""Gain of speed [m/s] of a slow body by which its rest starts again: it is about to move."""
_PERIOD = 0.1
"""Interval [s] at which islands are checked, while some body has rested long enough."""
_ROUNDING = 1e-9
"""Rounding [s] of a time that was added up step by step."""
READY = REST - _ROUNDING
"""Rest [s], as the sum of its steps, from which a body may sleep."""


@kernel
def count_rest(
    linear: Vectors, angular: Numbers, kind: Rows, radius: Numbers, width: Numbers, height: Numbers,
    inverse_mass: Numbers, sub_integrated: Flags, asleep: Flags, rest: Numbers, slowest: Numbers, h: float,
) -> bool:  # fmt: skip
    """Count for a step of h how long each body has been slow; return whether islands are to be checked.

    ``slowest`` (rows,) is the lowest speed since its rest began. Islands are checked when the longest rest
    passes a multiple of a tenth of a second, which depends on the rests alone.
    """
    longest = 0.0
    for i in range(len(rest)):
        if asleep[i]:
            continue
        if kind[i] == 0 or inverse_mass[i] == 0.0 or sub_integrated[i]:
            rest[i] = slowest[i] = 0.0
            continue
        reach = radius[i] if kind[i] == 1 else 0.5 * math.sqrt(width[i] * width[i] + height[i] * height[i])
        speed = math.sqrt(linear[i, 0] * linear[i, 0] + linear[i, 1] * linear[i, 1]) + abs(angular[i]) * reach
        if not speed < SLOW or (rest[i] > 0.0 and speed > slowest[i] + _GAIN):
            rest[i] = slowest[i] = 0.0
            continue
        slowest[i] = min(speed, slowest[i]) if rest[i] > 0.0 else speed
        rest[i] += h
        longest = max(longest, rest[i])
    now, before = (longest + _ROUNDING) / _PERIOD, (longest - h + _ROUNDING) / _PERIOD
    return bool(longest >= READY and np.floor(now) > np.floor(before))


@inlined
def _root(parent: Rows, i: int) -> int:
    """Return the root of the island of body i."""
    while parent[i] != i:
        parent[i] = parent[parent[i]]
        i = parent[i]
    return i


@inlined
def _join(parent: Rows, i: int, j: int) -> None:
    """Make one island of those of i and j."""
    i, j = _root(parent, i), _root(parent, j)
    if i != j:
        parent[max(i, j)] = min(i, j)


@allocating_kernel
def find_held(
    manifolds: Manifolds, points: Points, pairs: int,
    inverse_mass: Numbers, linear: Vectors, angular: Numbers, ready: Flags, held: Flags,
) -> int:  # fmt: skip
    """Mark the bodies of islands that may sleep; return how many there are.

    All bodies of such an island are ``ready``, none had an impact in this step, and one of them is pressed
    with friction against a fixed body at rest: without friction or support it would move on for ever.
    """
    parent = np.arange(len(inverse_mass))
    for p in range(pairs):
        manifold = manifolds[p]
        if manifold.count > 0 and inverse_mass[manifold.a] > 0.0 and inverse_mass[manifold.b] > 0.0:
            _join(parent, manifold.a, manifold.b)
    restless = np.zeros(len(inverse_mass), np.bool_)
    supported = np.zeros(len(inverse_mass), np.bool_)
    for i in range(len(inverse_mass)):
        if inverse_mass[i] > 0.0 and not ready[i]:
            restless[_root(parent, i)] = True
    for p in range(pairs):
        manifold = manifolds[p]
        if manifold.count <= 0:
            continue
        body, other = manifold.a, manifold.b
        if inverse_mass[body] == 0.0:
            body, other = other, body
        if inverse_mass[body] == 0.0:
            continue
        island = _root(parent, body)
        if manifold.impact_count > 0:
            restless[island] = True
        if inverse_mass[other] > 0.0:
            continue
        if linear[other, 0] != 0.0 or linear[other, 1] != 0.0 or angular[other] != 0.0:
            restless[island] = True
        elif manifold.friction > 0.0:
            loaded = points[2 * p].normal_impulse > 0.0
            if loaded or (manifold.count == 2 and points[2 * p + 1].normal_impulse > 0.0):
                supported[island] = True
    found = 0
    for i in range(len(inverse_mass)):
        island = _root(parent, i)
        held[i] = inverse_mass[i] > 0.0 and supported[island] and not restless[island]
        found += 1 if held[i] else 0
    return found


@kernel
def find_touched(
    manifolds: Manifolds, points: Points, touching: Rows, count: int, inverse_mass: Numbers,
    linear: Vectors, angular: Numbers, asleep: Flags, touched: Flags,
) -> tuple[int, int]:  # fmt: skip
    """Mark the sleeping bodies that touch one that is awake or moves.

    ``inverse_mass`` is 0 for sleeping bodies too. Pairs of a sleeping and a fixed body at rest have nothing
    to solve and are removed from ``touching``. Returns how many pairs are left there, and how many of them
    wake a body.
    """
    kept, found = 0, 0
    for k in range(count):
        p = touching[k]
        manifold = manifolds[p]
        a, b = manifold.a, manifold.b
        if asleep[a] or asleep[b]:
            sleeping, other = (a, b) if asleep[a] else (b, a)
            moves = linear[other, 0] != 0.0 or linear[other, 1] != 0.0 or angular[other] != 0.0
            if inverse_mass[other] == 0.0 and not moves:
                for j in range(2 * p, 2 * p + manifold.count):
                    points[j].normal_mass = points[j].tangent_mass = 0.0  # and not infinite
                continue
            touched[sleeping] = True
            found += 1
        touching[kept] = p
        kept += 1
    return kept, found


@allocating_kernel
def join_marked(a: Rows, b: Rows, count: Rows, asleep: Flags, marked: Flags) -> None:
    """Mark all sleeping bodies that touch marked ones, directly or through other sleeping bodies.

    ``a`` and ``b`` are rows of near pairs, -1 for bodies that are gone, and ``count`` their points.
    """
    parent = np.arange(len(asleep))
    for p in range(len(a)):
        if count[p] > 0 and a[p] >= 0 and b[p] >= 0 and asleep[a[p]] and asleep[b[p]]:
            _join(parent, a[p], b[p])
    wakes = np.zeros(len(asleep), np.bool_)
    for i in range(len(asleep)):
        if asleep[i] and marked[i]:
            wakes[_root(parent, i)] = True
    for i in range(len(asleep)):
        if asleep[i] and wakes[_root(parent, i)]:
            marked[i] = True


@kernel
def list_sleeping(manifolds: Manifolds, pairs: int, inactive: Flags, sleeping: Rows) -> int:
    """Write the pairs of which both bodies are inactive, whether they touch or not; return how many."""
    found = 0
    for p in range(pairs):
        if inactive[manifolds[p].a] and inactive[manifolds[p].b]:
            sleeping[found] = p
            found += 1
    return found
