"""Deep overlap: bodies are moved apart, which gives them no speed."""

import math

from physicslab.kernels import Numbers, Vectors, allocating, always_inlined, inlined
from physicslab.kernels import wide_layout as L
from physicslab.kernels.accounts import ANGULAR_MOMENTUM, ENERGY, OVERLAP
from physicslab.kernels.arguments import Acting, Contacts, Inverse, Motion, Near, Packed
from physicslab.kernels.float64x8 import lesser, mask_bits, take
from physicslab.kernels.forces.force_calls import add_forces_over
from physicslab.kernels.near_counts import BEYOND_BOUNDS, DISC_BLOCKS, OUTSIDE, WEDGED
from physicslab.kernels.records import Manifold, Points

DEEP = 0.1
"""Share beyond which overlap is resolved by moving bodies."""
ROUNDING = 1e-9
"""Share by which overlap may be deeper than that and stays: rounding leaves as much, and whether one is moved
must not depend on whether others are."""
_SWEEPS = 8
"""How often bodies are put out of fixed ones, as long as that leads one into another fixed one."""
_SHARE = 0.6
"""Share of the way that they are moved in a substep."""
_SLOWLY = 2.0**100
"""Time [s] for a way on which nothing resists motion; a power of two, which rounds nothing."""
BEYOND = 0.02
"""Share of its size by which a body is beyond the bounds where it is noted as outside: one that is pressed
against them by others stays below."""


@inlined
def _lowest(manifold: Manifold, points: Points, p: int) -> float:
    """Return the lowest separation of a pair's points [m]."""
    lowest: float = points[2 * p].separation
    return min(lowest, points[2 * p + 1].separation) if manifold.count == 2 else lowest


@always_inlined
def _deep_slots(slots: L.Slots, k: int) -> int:
    """Return the slots of a block that overlap deeply, as bits."""
    at = k * L.rows_of(slots.kind)
    lowest = take(slots.data, at + L.ONE + L.SEPARATION)
    if slots.kind != L.DISC:
        lowest = lesser(lowest, take(slots.data, at + L.TWO + L.SEPARATION))
    return mask_bits(lowest < -(DEEP + ROUNDING) * take(slots.data, at + L.SIZE))


@always_inlined
def any_deep(contacts: Contacts, near: Near) -> bool:
    """Whether any contact overlaps deeply; whether a body is beyond the bounds is noted in the counts."""
    any_deep = False
    for k in range(contacts.number):
        p = contacts.touching[k]
        manifold = contacts.manifolds[p]
        lowest = _lowest(manifold, contacts.points, p)
        if lowest < -(DEEP + ROUNDING) * manifold.size:
            any_deep = True
        if manifold.wall >= 0 and manifold.swept != 1 and lowest < -BEYOND * manifold.size:
            near.counts[OUTSIDE] |= BEYOND_BOUNDS
    if any_deep:
        return True
    for slots in (near.discs, near.boxes):
        for k in range(near.counts[DISC_BLOCKS + slots.kind]):
            if _deep_slots(slots, k) != 0:
                return True
    return False


@always_inlined
def _push_apart(
    a: int, b: int, nx: float, ny: float, lowest: float, size: float, position: Vectors, before: Vectors,
    inverse_mass: Numbers,
) -> None:  # fmt: skip
    """Move the bodies of a pair that overlaps deeply apart, the lighter one further."""
    moved_x = position[b, 0] - before[b, 0] - position[a, 0] + before[a, 0]
    moved_y = position[b, 1] - before[b, 1] - position[a, 1] + before[a, 1]
    depth = -(lowest + moved_x * nx + moved_y * ny) - DEEP * size
    if depth > ROUNDING * size:
        share = _SHARE * depth / (inverse_mass[a] + inverse_mass[b])
        position[a, 0] -= share * inverse_mass[a] * nx
        position[a, 1] -= share * inverse_mass[a] * ny
        position[b, 0] += share * inverse_mass[b] * nx
        position[b, 1] += share * inverse_mass[b] * ny


@always_inlined
def _put_back(
    a: int, b: int, nx: float, ny: float, lowest: float, size: float, position: Vectors, before: Vectors,
    inverse_mass: Numbers,
) -> bool:  # fmt: skip
    """Move what overlaps a fixed body, or the world's bounds, out of it; whether it did."""
    if inverse_mass[a] > 0.0 and inverse_mass[b] > 0.0:
        return False
    i, sign = (b, 1.0) if inverse_mass[b] > 0.0 else (a, -1.0)
    moved = sign * ((position[i, 0] - before[i, 0]) * nx + (position[i, 1] - before[i, 1]) * ny)
    depth = -(lowest + moved) - DEEP * size
    if depth <= ROUNDING * size:
        return False
    position[i, 0] += sign * depth * nx
    position[i, 1] += sign * depth * ny
    return True


@always_inlined
def _move(
    a: int, b: int, nx: float, ny: float, lowest: float, size: float, position: Vectors, before: Vectors,
    inverse_mass: Numbers, back: bool,
) -> bool:  # fmt: skip
    """Push a pair apart, or put it ``back`` out of a fixed body; whether it was."""
    if back:
        return _put_back(a, b, nx, ny, lowest, size, position, before, inverse_mass)
    _push_apart(a, b, nx, ny, lowest, size, position, before, inverse_mass)
    return False


@inlined
def _move_scalar(
    contacts: Contacts, position: Vectors, before: Vectors, inverse_mass: Numbers, back: bool
) -> bool:
    """Move the bodies of scalar contacts; whether any was put back."""
    any_back = False
    for k in range(contacts.number):
        p = contacts.touching[k]
        manifold = contacts.manifolds[p]
        if manifold.swept != 1:
            any_back |= _move(
                manifold.a, manifold.b, manifold.normal_x, manifold.normal_y,
                _lowest(manifold, contacts.points, p), manifold.size, position, before, inverse_mass, back,
            )  # fmt: skip
    return any_back


@inlined
def _move_wide(near: Near, position: Vectors, before: Vectors, inverse_mass: Numbers, back: bool) -> bool:
    """Move the bodies of wide contacts; whether any was put back."""
    any_back = False
    for slots in (near.discs, near.boxes):
        data = slots.data
        for k in range(near.counts[DISC_BLOCKS + slots.kind]):
            deep = _deep_slots(slots, k)
            for place in range(L.WIDE):
                if not (deep >> place) & 1:
                    continue
                at = k * L.rows_of(slots.kind) + place
                if slots.a[k * L.WIDE + place] == 0:  # the world itself: a wall
                    near.counts[OUTSIDE] |= BEYOND_BOUNDS
                lowest = data[at + L.ONE + L.SEPARATION]
                if slots.kind != L.DISC:
                    lowest = min(lowest, data[at + L.TWO + L.SEPARATION])
                any_back |= _move(
                    slots.a[k * L.WIDE + place], slots.b[k * L.WIDE + place], data[at + L.NORMAL_X],
                    data[at + L.NORMAL_Y], lowest, data[at + L.SIZE], position, before, inverse_mass, back,
                )  # fmt: skip
    return any_back


@inlined
def _book(near: Near, motion: Motion, before: Vectors, inverse_mass: Numbers, acting: Acting) -> None:
    """Book what moving bodies has changed: the energy by the work against forces, and angular momentum."""
    for i in range(len(inverse_mass)):
        x, y = motion.position[i, 0] - before[i, 0], motion.position[i, 1] - before[i, 1]
        if inverse_mass[i] > 0.0 and (x != 0.0 or y != 0.0):
            if acting.any:
                near.account[OVERLAP, ENERGY] -= acting.force[i, 0] * x + acting.force[i, 1] * y
            moved = x * motion.linear[i, 1] - y * motion.linear[i, 0]
            near.account[OVERLAP, ANGULAR_MOMENTUM] += moved / inverse_mass[i]


@inlined
def book_stored(packed: Packed, motion: Motion, acting: Acting, inverse: Inverse, account: Vectors) -> None:
    """Book what springs store besides what :func:`separate` booked, for which forces stay as they were.

    That is the work of the forces that they return over the way of bodies, on which these go so slowly that
    dampers and drag do nothing.
    """
    q, v, before, force = packed.state[0], packed.state[1], packed.state[2], packed.state[3]
    n = len(motion.angle)
    for i in range(n):
        x, y = motion.position[i, 0], motion.position[i, 1]
        q[2 * i], q[2 * i + 1] = 0.5 * (before[2 * i] + x), 0.5 * (before[2 * i + 1] + y)
        v[2 * i], v[2 * i + 1] = (x - before[2 * i]) / _SLOWLY, (y - before[2 * i + 1]) / _SLOWLY
        q[2 * n + i], v[2 * n + i] = motion.angle[i], 0.0
    add_forces_over(q, v, _SLOWLY, force, packed.calls)
    for i in range(n):
        if inverse.mass[i] > 0.0:
            x, y = _SLOWLY * v[2 * i], _SLOWLY * v[2 * i + 1]
            other_x, other_y = acting.force[i, 0] - force[2 * i], acting.force[i, 1] - force[2 * i + 1]
            account[OVERLAP, ENERGY] += other_x * x + other_y * y


@allocating
def separate(
    contacts: Contacts, near: Near, motion: Motion, reach: Numbers, inverse_mass: Numbers, acting: Acting,
    max_push: float,
) -> None:  # fmt: skip
    """Move bodies apart where :func:`any_deep`, six tenths of the way.

    Each is moved by at most ``max_push`` of its ``reach`` [m].

    Only positions change: however many bodies are on one spot, separating them gives them no speed. A body
    beyond the world's bounds, or within a fixed body, is put back at once, so that the heaviest body cannot
    press another one through a floor. That one is beyond the bounds, or is wedged between fixed bodies, is
    noted in the counts: there the end of one overlap is the beginning of another
    (:mod:`physicslab.stepping.bounds`).
    """
    position = motion.position
    before = position.copy()
    _move_scalar(contacts, position, before, inverse_mass, False)
    _move_wide(near, position, before, inverse_mass, False)
    for i in range(len(inverse_mass)):
        x, y = position[i, 0] - before[i, 0], position[i, 1] - before[i, 1]
        way = math.sqrt(x * x + y * y)
        farthest = max_push * reach[i]
        if way > farthest:
            position[i, 0] = before[i, 0] + x * farthest / way
            position[i, 1] = before[i, 1] + y * farthest / way
    wedged, sweep = True, 0
    while wedged and sweep < _SWEEPS:
        wedged = _move_scalar(contacts, position, before, inverse_mass, True)
        wedged |= _move_wide(near, position, before, inverse_mass, True)
        sweep += 1
    if wedged:
        near.counts[OUTSIDE] |= WEDGED
    _book(near, motion, before, inverse_mass, acting)
