"""Wide contacts of one world, eight side by side."""

import numpy as np
from numpy.typing import NDArray

from physicslab.kernels import Plain, near_counts
from physicslab.kernels.wide import graph_colour, refresh, restore_slots, slots
from physicslab.kernels.wide_layout import BOX, BOX_ROWS, DISC, DISC_ROWS, WIDE, Slots

type _Rows = NDArray[np.int64]


class WideConstraints:
    """The blocks of one kind of contact.

    Attributes
    ----------
    kind, rows : int
        ``DISC`` or ``BOX``, and how many numbers a block has.
    data : float64 array (capacity * rows,)
        Their contents, as :mod:`physicslab.kernels.wide_layout` has it.
    a, b, pair : int64 arrays (capacity * WIDE,)
        Rows of the bodies in each slot, and which near pair it is; -1 for a free slot.
    colour : int64 array (capacity,)
        The colour of each block: no body has two contacts of one colour.
    order : int64 array (capacity,)
        The blocks, those of one colour together: as they are solved.
    outside : bool array (capacity,)
        Which blocks may have something that no impulse moves, or turns.
    used : uint64 array (rows of the world,)
        The colours that each body has been given, bit by bit.
    """

    def __init__(self, kind: int, counts: _Rows) -> None:
        self._counts = counts
        self._place = near_counts.DISC_BLOCKS if kind == DISC else near_counts.BOX_BLOCKS
        self.kind, self.rows = kind, DISC_ROWS if kind == DISC else BOX_ROWS
        self.data: NDArray[np.float64] = np.zeros(0)
        self.a, self.b, self.pair, self.colour, self.order = (np.zeros(0, np.int64) for _ in range(5))
        self.outside: NDArray[np.bool_] = np.zeros(0, np.bool_)
        self.reset(1)

    @property
    def count(self) -> int:
        """How many blocks there are."""
        return int(self._counts[self._place])

    @count.setter
    def count(self, blocks: int) -> None:
        self._counts[self._place] = blocks

    def reset(self, rows: int) -> None:
        """Drop every block, in a world of so many rows."""
        self.count = 0
        self.used: NDArray[np.uint64] = np.zeros(rows, np.uint64)

    def make_room(self, blocks: int) -> None:
        """Make room for so many blocks."""
        if len(self.colour) < blocks:
            room = 2 * blocks
            data, (colour, order) = _in_lines(room * self.rows), np.zeros((2, room), np.int64)
            outside = np.zeros(room, np.bool_)
            data[: len(self.data)], colour[: len(self.colour)] = self.data, self.colour
            outside[: len(self.outside)] = self.outside
            order[: len(self.order)] = self.order
            constraints = np.zeros((3, room * WIDE), np.int64)
            constraints[:, : len(self.pair)] = self.a, self.b, self.pair
            self.data, self.colour, self.order, self.outside = data, colour, order, outside
            self.a, self.b, self.pair = (np.ascontiguousarray(slot) for slot in constraints)

    def sort(self) -> None:
        """Put the blocks in the order in which they are solved."""
        graph_colour.sort_blocks(self.count, self.colour, self.order)

    @property
    def slots(self) -> Plain[Slots]:
        """The arguments of kernels."""
        return (
            self.kind, self.data, self.a, self.b, self.pair, self.colour, self.used, self.order, self.outside,
        )  # fmt: skip


class WideContacts:
    """The wide contacts of a world, and what they were made of.

    A contact is steady when its bodies move little for their size, and it has no impact.
    Steady contacts of discs and of boxes are in blocks of their own; all others, and all in a world of few
    contacts, are scalar.

    Attributes
    ----------
    discs, boxes : WideConstraints
        The blocks.
    made_of : float64 array (rows, 8)
        The masses, materials and outlines that slots were made of.
    changed : bool array (rows,)
        Which bodies have others now, when that was last looked at.

    Parameters
    ----------
    counts : int64 array (COUNTED,)
        The counts of the contacts that these are part of.
    """

    kernels = (
        graph_colour.add_constraints, restore_slots.restore_slots, graph_colour.sort_blocks,
        restore_slots.remember, restore_slots.outdated, restore_slots.update_slots,
        slots.store, slots.list_scalar, slots.follow_pairs,
        slots.release, refresh.deepest_wide,
    )  # fmt: skip

    def __init__(self, counts: _Rows) -> None:
        self._counts = counts
        self.discs, self.boxes = WideConstraints(DISC, counts), WideConstraints(BOX, counts)
        self.made_of: NDArray[np.float64] = np.zeros((0, 8))
        self.changed: NDArray[np.bool_] = np.zeros(0, np.bool_)

    @property
    def kinds(self) -> tuple[WideConstraints, WideConstraints]:
        """Both."""
        return self.discs, self.boxes

    @property
    def filled(self) -> int:
        """How many contacts have a slot."""
        return int(self._counts[near_counts.WIDE_COUNT])

    @filled.setter
    def filled(self, contacts: int) -> None:
        self._counts[near_counts.WIDE_COUNT] = contacts

    def reset(self, rows: int) -> None:
        """Empty every slot, in a world of so many rows."""
        for constraints in self.kinds:
            constraints.reset(rows)
        self.filled = 0


def _in_lines(size: int) -> NDArray[np.float64]:
    """Return so many zeros, aligned to a cache line: a row across two lines takes twice as long."""
    line = WIDE * 8
    room = np.zeros(size + WIDE)
    start = -room.ctypes.data % line // 8
    return room[start : start + size]
