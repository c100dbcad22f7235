"""How wide contacts are laid out in memory: eight side by side, so that the processor solves them at once.

A block holds eight contacts of which no two move the same body. Every quantity is a row of eight float64
values, one cache line; all rows of a block are in one array at constant offsets: else LLVM cannot prove that
they do not overlap, and does not vectorise the loops over its slots.
"""

from typing import Annotated, NamedTuple

import numpy as np
from numba import uint64
from numpy.typing import NDArray

from physicslab.kernels import Flags, Numbers, Rows, always_inlined

WIDE = 8
"""Slots of a block."""
DISC, BOX = 0, 1
"""The kinds of blocks: pairs of discs, with one point, and pairs with a box, with one or two."""

# Each pair has the normal from A to B, the friction coefficient, inverse masses and moments of inertia, the
# size of the smaller body.
NORMAL_X, NORMAL_Y, FRICTION, MASS_A, MASS_B, INERTIA_A, INERTIA_B, SIZE = (WIDE * i for i in range(8))

# A point has impulses along the normal and across, effective masses, the separation; its arms.
IMPULSE, TANGENT_IMPULSE, MASS, TANGENT_MASS, SEPARATION = (WIDE * i for i in range(5))
ARM_AX, ARM_AY, ARM_BX, ARM_BY, FOUND = (WIDE * i for i in range(5, 10))
ONE = 8 * WIDE
"""Offset of the first point."""

# The arms of discs are along the normal.
RADIUS_A, RADIUS_B, RESTITUTION = (ONE + WIDE * i for i in range(5, 8))
DISC_ROWS = ONE + 8 * WIDE
"""Numbers in a block of discs."""

TWO = ONE + 10 * WIDE
"""Offset of the second point of pairs with a box."""
SWEPT = TWO + 9 * WIDE
"""Numbers at the beginning of a block that a sweep reads."""
BASE_X, BASE_Y, ANGLE_A, ANGLE_B = (TWO + WIDE * i for i in range(10, 14))
# 1 where a body's points turn with it, 0 for a disc.
TURNS_A, TURNS_B = TWO + 14 * WIDE, TWO + 15 * WIDE
BOX_ROWS = TWO + 16 * WIDE
"""Numbers in a block of pairs with a box."""

Masks = Annotated[NDArray[np.uint64], uint64[::1]]
"""A uint64 array (n,), bit by bit."""


class Slots(NamedTuple):
    """The blocks of a kind: what they hold, rows of A and B and the pair of each slot, the blocks' colours.

    Then the colours that each body has been given, the order in which the blocks are solved, and which blocks
    may have a body that no impulse moves, or turns.
    """

    kind: int
    data: Numbers
    a: Rows
    b: Rows
    pair: Rows
    colour: Rows
    used: Masks
    order: Rows
    outside: Flags


@always_inlined
def rows_of(kind: int) -> int:
    """Return how many numbers a block of a kind has."""
    return DISC_ROWS if kind == DISC else BOX_ROWS
