"""The order in which rows of joints are solved, and which of them at once."""

from collections import defaultdict
from collections.abc import Sequence, Set
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from physicslab.state.ordering import cuthill_mckee

_LARGEST = 2_000_000
"""The squared widths of the rows of a block, added up, from which on its joints are solved one by one: more
takes milliseconds in each substep."""

type _Rows = NDArray[np.int64]


class Blocks(NamedTuple):
    """Blocks of rows that are solved at once, each within an envelope.

    Attributes
    ----------
    order : int64 array (n,)
        The row at each place.
    ends : int64 array (k,)
        The place behind each block.
    low : int64 array (n,)
        Of each place the first one of its block with which it may share a body, or one between has.
    start : int64 array (n,)
        Where the numbers of each place begin, from ``low`` on.
    room : int
        How many numbers there are.
    """

    order: _Rows
    ends: _Rows
    low: _Rows
    start: _Rows
    room: int


def order_rows(bodies: Sequence[Set[int]], joints: Sequence[range]) -> Blocks:
    """Return the blocks for rows between moving ``bodies`` (n sets), which are those of ``joints``.

    Joints that share a moving body are one block, in an order in which rows that share a body stand near each
    other. A block that would cost too much is one for each joint instead.
    """
    order: list[int] = []
    low: list[int] = []
    ends: list[int] = []
    for group in _groups(bodies, joints):
        rows = [row for joint in group for row in joints[joint]]
        places = _lowest(rows, bodies)
        if sum((n - place) ** 2 for n, place in enumerate(places)) <= _LARGEST:
            parts = [(rows, places)]
        else:
            own = [list(joints[joint]) for joint in sorted(group)]
            parts = [(rows, _lowest(rows, bodies)) for rows in own]
        for part, places in parts:
            low += [len(order) + place for place in places]
            order += part
            ends.append(len(order))
    lows = np.array(low, np.int64)
    width = np.arange(1, len(lows) + 1) - lows
    start = np.cumsum(width) - width
    return Blocks(np.array(order, np.int64), np.array(ends, np.int64), lows, start, int(width.sum()))


def _lowest(rows: Sequence[int], bodies: Sequence[Set[int]]) -> list[int]:
    """Return of each place the first one of a row with which it shares a body, or itself."""
    first: dict[int, int] = {}
    return [min([first.setdefault(body, n) for body in bodies[row]], default=n) for n, row in enumerate(rows)]


def _groups(bodies: Sequence[Set[int]], joints: Sequence[range]) -> list[list[int]]:
    """Return the joints that hold on to each other, each group in an order in which neighbours are near."""
    held = [set[int]().union(*(bodies[row] for row in rows)) for rows in joints]
    of: dict[int, set[int]] = defaultdict(set)
    for joint, own in enumerate(held):
        for body in own:
            of[body].add(joint)
    beside = {joint: set[int]().union(*(of[body] for body in own)) for joint, own in enumerate(held)}
    groups: list[list[int]] = []
    seen: set[int] = set()
    for joint in cuthill_mckee(beside):
        if seen.isdisjoint(beside[joint]):
            groups.append([])
        groups[-1].append(joint)
        seen.add(joint)
    return groups


NO_BLOCKS = order_rows((), ())
"""Those without joints."""
