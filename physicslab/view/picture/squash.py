"""Bodies that were just hit are drawn a little smaller: a matter of the window, not of the world."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.view.canvas.canvas import Numbers, Points
from physicslab.world import World

_SHARE, _LIFE = 0.03, 0.06
"""Share of its size that a body is smaller by, towards the point of impact, and for how long [s]."""
_MAX = 60
"""Number of bodies that are drawn so at once."""


class Squash:
    """Bodies that were just hit; they touch what they hit all the time."""

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        """Draw all as they are."""
        self._entities: NDArray[np.int64] = np.zeros(0, np.int64)
        self._hits = np.zeros((0, 3))  # where [m], when [s]

    def note(self, impacts: NDArray[Any], time: float) -> None:
        """Take the impacts since the last picture, of IMPACT (n,), at a time of the world [s]."""
        for body in "ab":
            moved = impacts[impacts[f"inverse_mass_{body}"] > 0.0]
            hits = np.stack((moved["x"], moved["y"], moved["time"]), axis=1)
            self._entities = np.concatenate((self._entities, moved[f"entity_{body}"]))
            self._hits = np.concatenate((self._hits, hits))
        fresh = (self._hits[:, 2] <= time) & (time - self._hits[:, 2] < _LIFE)
        self._entities, self._hits = self._entities[fresh][-_MAX:], self._hits[fresh][-_MAX:]

    def of(self, world: World, rows: NDArray[np.int64], centre: Points) -> tuple[Points, Numbers]:
        """Return the middles (n, 2) [m] of bodies as they are drawn, and the shares of their sizes (n,)."""
        if not len(self._entities):
            return centre, np.ones(len(rows))
        index = world.entity_index
        drawn_as = np.full(len(index.entities), -1)
        drawn_as[rows] = np.arange(len(rows))
        at = drawn_as[index.rows_of(self._entities)]
        hits, at = self._hits[at >= 0], at[at >= 0]
        share = _SHARE * np.maximum(1.0 - (world.time - hits[:, 2]) / _LIFE, 0.0)
        moved, less = centre.copy(), np.zeros(len(rows))
        np.add.at(moved, at, share[:, None] * (hits[:, :2] - centre[at]))
        np.maximum.at(less, at, share)
        return moved, 1.0 - less
