"""Islands: bodies that touch each other, directly or through others. They fall asleep and wake together."""

import math

import numpy as np

from physicslab.kernels import Flags, Numbers, Rows, Vectors, allocating, allocating_kernel, inlined, kernel
from physicslab.kernels.constraint.pair import frame_of, point_velocity, velocity_of
from physicslab.kernels.disjoint_sets import join_sets, root_of
from physicslab.kernels.records import Manifold, Manifolds, Points

REST = 0.5
"""How long [s] a body must have been slow before it may sleep."""
SLOW = 0.05
"""Speed [m/s] of any point of a body below which it is slow."""
_GAIN = 0.002
"""Gain of speed [m/s] of a slow body by which its rest starts again: it is about to move."""
_PERIOD = 0.1
"""Interval [s] at which islands are checked, while some body has rested long enough."""
_STOPS_WITHIN = 1e-5
"""Way, as a share of the smaller body's size, within which friction must stop what is to sleep."""
_STILL = 1e-6
"""Speed along a surface, in shapes of the smaller body a second, below which it is treated as zero."""
_ROLLING = 1e-2
"""The same for a disc that rolls: nothing stops it, and without a limit strays would keep piles awake."""
_LEVEL = 1e-6
"""Slope of a fixed surface [rad], from the plane normal to the force, from which on a disc rolls down. What
moves gives way, and tilts by more."""
_SATURATED = 0.999
"""Share of the largest friction from which on a contact that moves slides."""
_LOADED = 0.01
"""Share of a body's largest load from which on a contact carries it."""
_PARALLEL = 0.999
"""Cosine between normals of contacts that hold a disc no better than one of them."""
_TIME_ROUNDING = 1e-9
"""Rounding [s] of a time that was added up step by step."""
READY = REST - _TIME_ROUNDING
"""Rest [s], as the sum of its steps, from which a body may sleep."""


@kernel
def count_rest(
    linear: Vectors, angular: Numbers, reach: Numbers, inverse_mass: Numbers, sub_integrated: Flags,
    asleep: Flags, rest: Numbers, slowest: Numbers, h: float,
) -> bool:  # fmt: skip
    """Count for a step of h how long each body has been slow; return whether islands are to be checked.

    ``slowest`` (rows,) is the lowest speed since its rest began. Islands are checked when the longest rest
    passes a multiple of a tenth of a second, which depends on the rests alone.
    """
    longest = 0.0
    for i in range(len(rest)):
        if asleep[i]:
            continue
        if reach[i] == 0.0 or inverse_mass[i] == 0.0 or sub_integrated[i]:
            rest[i] = slowest[i] = 0.0
            continue
        speed = (
            math.sqrt(linear[i, 0] * linear[i, 0] + linear[i, 1] * linear[i, 1]) + abs(angular[i]) * reach[i]
        )
        if not speed < SLOW or (rest[i] > 0.0 and speed > slowest[i] + _GAIN):
            rest[i] = slowest[i] = 0.0
            continue
        slowest[i] = min(speed, slowest[i]) if rest[i] > 0.0 else speed
        rest[i] += h
        longest = max(longest, rest[i])
    now, before = (longest + _TIME_ROUNDING) / _PERIOD, (longest - h + _TIME_ROUNDING) / _PERIOD
    return bool(longest >= READY and np.floor(now) > np.floor(before))


@inlined
def _load(manifold: Manifold, points: Points, p: int) -> float:
    """Return the normal impulse of a pair in a substep."""
    impulse = 0.0
    for j in range(2 * p, 2 * p + manifold.count):
        impulse += points[j].normal_impulse
    return impulse


@inlined
def _slips(
    manifold: Manifold, points: Points, p: int, impulse_dt: float,
    inverse_mass: Numbers, linear: Vectors, angular: Numbers,
) -> tuple[bool, bool]:  # fmt: skip
    """Return whether the bodies of a pair slide on each other, and whether friction does not stop that soon.

    Friction takes v^2 / (2 mu g_n) to stop a speed v, where g_n is the pressure over the mass.
    """
    a, b = manifold.a, manifold.b
    v, fastest, friction = velocity_of(linear, angular, a, b), 0.0, 0.0
    for j in range(2 * p, 2 * p + manifold.count):
        point = points[j]
        vx, vy = point_velocity(frame_of(manifold, point), v)
        fastest = max(fastest, abs(manifold.normal_x * vy - manifold.normal_y * vx))
        friction += abs(point.tangent_impulse)
    if fastest <= _STILL * manifold.size:
        return False, False
    limit = manifold.friction * _load(manifold, points, p)
    lightest = max(inverse_mass[a], inverse_mass[b])
    room = 2.0 * _STOPS_WITHIN * manifold.size * limit * lightest / impulse_dt
    return friction >= _SATURATED * limit, fastest * fastest > room


@inlined
def _rolls(
    manifold: Manifold, disc: int, fixed: bool, points: Points, p: int, force: Vectors, linear: Vectors,
    angular: Numbers,
) -> bool:  # fmt: skip
    """Whether a disc goes along the surface on which it lies or, if that is ``fixed``, is pulled along it."""
    point, other = points[2 * p], manifold.a
    ax, ay = point.arm_ax, point.arm_ay
    if other == disc:
        other, ax, ay = manifold.b, point.arm_bx, point.arm_by
    vx = linear[disc, 0] - linear[other, 0] + angular[other] * ay
    vy = linear[disc, 1] - linear[other, 1] - angular[other] * ax
    nx, ny, fx, fy = manifold.normal_x, manifold.normal_y, force[disc, 0], force[disc, 1]
    if fixed and abs(nx * fy - ny * fx) > _LEVEL * math.sqrt(fx * fx + fy * fy):
        return True
    return bool(abs(nx * vy - ny * vx) > _ROLLING * manifold.size)


@allocating
def _mark_moving(
    manifolds: Manifolds, points: Points, pairs: int, impulse_dt: float, vertices: Rows,
    inverse_mass: Numbers, force: Vectors, linear: Vectors, angular: Numbers, moving: Flags,
) -> None:  # fmt: skip
    """Mark the bodies that go on moving: friction does not stop them soon, or they slide or roll freely.

    A body slides if no contact that carries it sticks. A disc rolls freely if all contacts that press on it
    have one normal: nothing else can hold it, and friction does no work where it rolls.
    """
    number = len(inverse_mass)
    load, carrier = np.zeros(number), np.zeros(number, np.int64)
    for p in range(pairs):
        manifold = manifolds[p]
        if manifold.count <= 0:
            continue
        pressed = _load(manifold, points, p)
        for i in (manifold.a, manifold.b):
            if pressed > load[i]:
                load[i], carrier[i] = pressed, p
    sticks, caged = np.zeros(number, np.bool_), np.zeros(number, np.bool_)
    for p in range(pairs):
        manifold = manifolds[p]
        if manifold.count <= 0:
            continue
        pressed = _load(manifold, points, p)
        if pressed <= 0.0:
            continue
        slides, far = _slips(manifold, points, p, impulse_dt, inverse_mass, linear, angular)
        for i in (manifold.a, manifold.b):
            if far:
                moving[i] = True
            if pressed >= _LOADED * load[i]:
                sticks[i] |= not slides
            main = manifolds[carrier[i]]
            along = manifold.normal_x * main.normal_x + manifold.normal_y * main.normal_y
            caged[i] |= abs(along) < _PARALLEL
    for i in range(number):
        if inverse_mass[i] == 0.0 or load[i] <= 0.0:
            continue
        p = carrier[i]
        free = vertices[i] == 1 and not caged[i]
        main = manifolds[p]
        fixed = inverse_mass[main.a] == 0.0 or inverse_mass[main.b] == 0.0
        if not sticks[i] or (free and _rolls(main, i, fixed, points, p, force, linear, angular)):
            moving[i] = True


@allocating_kernel
def find_held(
    manifolds: Manifolds, points: Points, pairs: int, impulse_dt: float, vertices: Rows,
    inverse_mass: Numbers, force: Vectors, linear: Vectors, angular: Numbers, edges: Rows, ready: Flags,
    held: Flags,
) -> int:  # fmt: skip
    """Mark the bodies of islands that may sleep; return how many there are.

    Bodies that touch each other are one island, and so are those that joints hold together: ``edges`` (2 n,)
    are their rows.

    All bodies of such an island are ``ready``, none had an impact in this step, friction holds or soon stops
    all of them, and one of them is on a joint to a fixed body at rest, or pressed against one with friction:
    without friction or support it would move on for ever. ``impulse_dt`` is the time [s] over which the
    points' impulses act.
    """
    parent = np.arange(len(inverse_mass))
    for p in range(pairs):
        manifold = manifolds[p]
        if manifold.count > 0 and inverse_mass[manifold.a] > 0.0 and inverse_mass[manifold.b] > 0.0:
            join_sets(parent, manifold.a, manifold.b)
    for k in range(0, len(edges), 2):
        if inverse_mass[edges[k]] > 0.0 and inverse_mass[edges[k + 1]] > 0.0:
            join_sets(parent, edges[k], edges[k + 1])
    restless = np.zeros(len(inverse_mass), np.bool_)
    supported = np.zeros(len(inverse_mass), np.bool_)
    moving = ~ready
    _mark_moving(manifolds, points, pairs, impulse_dt, vertices, inverse_mass, force, linear, angular, moving)
    for i in range(len(inverse_mass)):
        if inverse_mass[i] > 0.0 and moving[i]:
            restless[root_of(parent, i)] = True
    for p in range(pairs):
        manifold = manifolds[p]
        if manifold.count <= 0:
            continue
        body, other = manifold.a, manifold.b
        if inverse_mass[body] == 0.0:
            body, other = other, body
        if inverse_mass[body] == 0.0:
            continue
        island = root_of(parent, body)
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
    for k in range(0, len(edges), 2):
        body, other = edges[k], edges[k + 1]
        if inverse_mass[body] == 0.0:
            body, other = other, body
        if inverse_mass[body] > 0.0 and inverse_mass[other] == 0.0:
            still = linear[other, 0] == 0.0 and linear[other, 1] == 0.0 and angular[other] == 0.0
            supported[root_of(parent, body)] |= still
            restless[root_of(parent, body)] |= not still
    found = 0
    for i in range(len(inverse_mass)):
        island = root_of(parent, i)
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
            join_sets(parent, a[p], b[p])
    wakes = np.zeros(len(asleep), np.bool_)
    for i in range(len(asleep)):
        if asleep[i] and marked[i]:
            wakes[root_of(parent, i)] = True
    for i in range(len(asleep)):
        if asleep[i] and wakes[root_of(parent, i)]:
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
