"""Whether the columns of motion have the bits that they had."""

import numpy as np
from numpy.typing import NDArray

from physicslab.contacts.arguments import motion_of
from physicslab.kernels.digest import digest_motion
from physicslab.state.masses import quiet
from physicslab.world import World

type Digest = tuple[int, int, int, int]
"""32 bits for each of the columns of motion after a step."""

COLUMNS = ("Transform.position", "Transform.angle", "Velocity.linear", "Velocity.angular")
"""These columns."""


class Digester:
    """Makes the digests of one world.

    Readings of columns are kept while they are the same arrays, which they are between changes of
    structure: for a small world that is most of the work.
    """

    def __init__(self) -> None:
        self._columns: tuple[NDArray[np.float64], ...] = ()
        self._entities: NDArray[np.int64] | None = None
        self._words: tuple[NDArray[np.int64], ...] | None = None

    def digest(self, world: World) -> Digest:
        """Return the digest of a world. It does not depend on how rows are numbered."""
        columns, known = motion_of(world), self._columns
        same = len(known) == 4 and columns[0] is known[0] and columns[2] is known[2]
        if not (same and self._entities is world.entity_index.entities):
            self._columns, self._entities = columns, world.entity_index.entities
            whole = len(world.entity_index.row_of) + 1 == len(world.entity_index)
            self._words = tuple(map(_words, columns)) if whole else None
        words = self._words
        if words is None:  # some rows are blank
            rows = np.flatnonzero(world.entity_index.entities)
            words = tuple(_words(np.concatenate((column[:1], column[rows]))) for column in columns)
        return _digest(words)


@quiet
def _digest(words: tuple[NDArray[np.int64], ...]) -> Digest:
    position, angle, linear, angular = words
    return digest_motion(position, angle, linear, angular)


def _words(column: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the numbers of a column but those of row 0, the world, as the integers of their bits."""
    return column[1:].reshape(-1).view(np.int64)


def differing(one: Digest, other: Digest) -> tuple[str, ...]:
    """Return the names of the columns in which two digests differ."""
    return tuple(name for name, a, b in zip(COLUMNS, one, other, strict=True) if a != b)
