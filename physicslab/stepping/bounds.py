"""Bodies that fixed ones push to and fro: they are put where they have room.

A body beyond the bounds of the world is pushed in by their walls. Where a fixed body pushes it out again, as
the end of a floor does, neither has an end: the bounds win. Nor has it one where fixed bodies push another
one into each other, as in a wedge that is too narrow for it. Such a body is put to the nearest place within
the bounds in which it overlaps nothing fixed, and loses the part of its velocity that points beyond them.
"""

import heapq
import itertools
import math

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform, Velocity
from physicslab.contacts.islands import wake_neighbours
from physicslab.contacts.outlines import Numbers, Outlines, Rows, exits, outlines_of, overlap, overlapping
from physicslab.kernels.accounts import OVERLAP
from physicslab.kernels.near_counts import WEDGED
from physicslab.kernels.solver.separate import BEYOND, DEEP, ROUNDING
from physicslab.state.solid import is_any_apart, may_touch, solid_rows
from physicslab.state.state import State
from physicslab.stepping.accounting import balance_of
from physicslab.systems.schedule import Schedule

_OUTWARDS = -0.1
"""Along the inward normal of a wall: a fixed body whose push has less keeps what is beyond the wall there."""
_HELD = 0.01
"""Overlap with it, as a share of a size, above which that body does push."""
_WITHIN = DEEP + ROUNDING
"""Overlap with a fixed body, as a share of a size, that is more than contacts leave: it is inside."""
_PRESSED = 0.5 * BEYOND
"""Overlap with the bounds, as a share of a size, by which a body may be beyond them."""
_FREE = 1e-6
"""Overlap, as a share of a size, that is none."""
_ALIKE = 0.1
"""Distance, as a share of a size, at which two places to try are one."""
_TRIES, _GRID = 40, 12
"""How many places are tried; then how many across and up."""
_INWARDS = np.array(((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)))
"""The normals of the walls: left, bottom, right, top."""


def return_inside(state: State, schedule: Schedule) -> int:
    """Put every body where it has room that a fixed one keeps beyond the bounds or in itself; count them.

    To be called at the end of a step in which the contact stages have found one beyond them, or wedged.

    Parameters
    ----------
    state : State
        Whose contacts may note that a body is outside; after the call none is.
    schedule : Schedule
        The forces, whose energy this changes.
    """
    noted, state.contacts.outside = state.contacts.outside, 0
    solid, velocity = solid_rows(state), state.table(Velocity)
    fixed = np.flatnonzero(~velocity.present[solid])
    if not len(fixed):
        return 0
    low, high = _room(state)
    bodies, places = outlines_of(state, solid), dict[int, Numbers]()
    beyond = _beyond(bodies, low, high) > BEYOND * bodies.size[:, None]
    kept = beyond.any(axis=1) & np.isin(solid, _pressed(state))
    if noted & WEDGED:
        kept[_may_be_within(state, bodies, solid, fixed)] = True
    held = bodies.only(fixed)
    for n in np.flatnonzero(kept & (state.bodies.inverse_mass[solid] > 0.0)).tolist():
        touched = held
        if is_any_apart(state):
            touched = held.only(may_touch(state, np.full(len(fixed), solid[n]), solid[fixed]))
        if _is_kept(bodies, n, touched, _INWARDS[beyond[n]]):
            place = _free_place(bodies, n, touched, low, high)
            if place is not None:
                places[n] = place
    if places:
        numbers = np.array(list(places))
        _put(state, schedule, solid[numbers], np.array(list(places.values())), beyond[numbers])
    return len(places)


def _room(state: State) -> tuple[Numbers, Numbers]:
    """Return the lowest and the highest x and y within the bounds (2,) [m]."""
    bounds = state.physics.bounds or (-math.inf, -math.inf, math.inf, math.inf)
    return np.array(bounds[:2]), np.array(bounds[2:])


def _pressed(state: State) -> Rows:
    """Return the rows (n,) of bodies that are pressed into the bounds, or beyond them."""
    contacts = state.contacts
    pairs = contacts.manifolds[: contacts.recorded]
    with_wall = np.flatnonzero((pairs["wall"] >= 0) & (pairs["count"] > 0))
    depth = -contacts.points["separation"].reshape(-1, 2)[with_wall].min(axis=1)
    pressed: Rows = pairs["b"][with_wall[depth > _PRESSED * pairs["size"][with_wall]]]
    return pressed


def _may_be_within(state: State, bodies: Outlines, solid: Rows, fixed: Rows) -> Rows:
    """Return which bodies (n,) are in contact with fixed ones that they may be inside, by upright boxes."""
    contacts = state.contacts
    pairs = contacts.manifolds[: contacts.recorded]
    pairs = pairs[(pairs["wall"] < 0) & (pairs["count"] > 0)]
    numbers, is_fixed = np.full(len(state.entity_index), -1), np.zeros(len(solid), np.bool_)
    numbers[solid], is_fixed[fixed] = np.arange(len(solid)), True
    a, b = numbers[pairs["a"]], numbers[pairs["b"]]
    n, m = np.concatenate((a, b)), np.concatenate((b, a))
    n, m = n[is_fixed[m]], m[is_fixed[m]]
    apart = np.abs(bodies.place[n] - bodies.place[m]) - bodies.reach[m]
    within: Rows = n[(apart < bodies.reach[n] - _WITHIN * bodies.size[n, None]).all(axis=1)]
    return within


def _beyond(bodies: Outlines, low: Numbers, high: Numbers) -> Numbers:
    """Return how far each body is beyond each of the walls (n, 4) [m]."""
    reach = bodies.reach
    return np.concatenate((low - bodies.place + reach, bodies.place + reach - high), axis=1)


def _is_kept(bodies: Outlines, n: int, fixed: Outlines, inwards: Numbers) -> bool:
    """Whether a fixed body pushes one out through a wall that it is beyond, or has it inside itself."""
    for m in overlapping(bodies, n, fixed):
        depth, away = overlap(fixed, int(m), bodies, n)
        outwards = bool((inwards @ away < _OUTWARDS).any())
        if depth > (_HELD if outwards else _WITHIN) * bodies.size[n]:
            return True
    return False


def _free_place(
    bodies: Outlines, n: int, fixed: Outlines, low: Numbers, high: Numbers
) -> Numbers | None:  # fmt: skip
    """Return a place within the bounds, near to a body, where it overlaps nothing fixed, if one is found.

    From a place that is taken, the ways out of what is there lead to others; the nearest is tried first.
    Where that leads nowhere, as in a wedge, places all over the world are tried.
    """
    reach, size, begin = bodies.reach[n], float(bodies.size[n]), bodies.place[n]
    low, high = low + reach, high - reach
    if (high < low).any():
        return None  # it is larger than the world
    own = bodies.only(np.array([n]))

    def hits(place: Numbers) -> list[int]:
        own.place[0] = place
        near = overlapping(own, 0, fixed).tolist()
        return [m for m in near if overlap(fixed, m, own, 0)[0] > _FREE * size]

    waiting: list[tuple[float, int, Numbers]] = [(0.0, 0, np.clip(begin, low, high))]
    order = itertools.count(1)
    seen: set[tuple[int, int]] = set()
    for _ in range(_TRIES):
        if not waiting:
            break
        _, _, place = heapq.heappop(waiting)
        taken = hits(place)
        if not taken:
            return place
        for way in itertools.chain.from_iterable(exits(fixed, m, own, 0) for m in taken):
            found = np.clip(place + way, low, high)
            key = round(found[0] / (_ALIKE * size)), round(found[1] / (_ALIKE * size))
            if key not in seen:
                seen.add(key)
                heapq.heappush(waiting, (float(np.hypot(*(found - begin))), next(order), found))
    share = np.linspace(0.0, 1.0, _GRID)
    low = np.where(np.isfinite(low), low, (fixed.place - fixed.reach).min(axis=0) - reach)
    high = np.where(np.isfinite(high), high, (fixed.place + fixed.reach).max(axis=0) + reach)
    grid: Numbers = low + np.stack(np.meshgrid(share, share), axis=-1).reshape(-1, 2) * (high - low)
    nearest = np.argsort(np.hypot(*(grid - begin).T), kind="stable")
    free = next((int(k) for k in nearest if not hits(grid[k])), None)
    return None if free is None else grid[free].copy()


def _put(state: State, schedule: Schedule, rows: Rows, places: Numbers, beyond: NDArray[np.bool_]) -> None:
    """Put bodies elsewhere, without the velocity that led outwards, and note what energy that brought."""
    position, linear = state.table(Transform)["position"], state.table(Velocity)["linear"]
    before = balance_of(state, schedule.forces)
    position[rows] = places
    for wall, inwards in enumerate(_INWARDS):
        out = rows[beyond[:, wall]]
        linear[out] -= np.minimum(linear[out] @ inwards, 0.0)[:, None] * inwards
    state.account.sums[OVERLAP] += np.subtract(balance_of(state, schedule.forces), before)
    state.returned_inside += len(rows)
    state.contacts.forget(rows, len(state.entity_index))
    wake_neighbours(state, state.entity_index.entities[rows])
