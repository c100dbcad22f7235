"""The impacts of the last second: over in one step, but shown for long enough to be seen."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physicslab.view.touches import TOUCH, Touches, impacts_of
from physicslab.world import World

__all__ = ["SHOWN", "Impacts"]

SHOWN = 1.0
"""How long an impact is kept [s]; it is the world's time, which stands still while paused."""
_MOST = 256
"""How many are kept."""


class Impacts:
    """Remembers impacts; of those at one contact point, the one that stands out most.

    Attributes
    ----------
    kept : array of TOUCH (n,)
        The impacts, strongest first when they were last noted.
    """

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        """Forget them all."""
        self.kept: Touches = np.zeros(0, TOUCH)

    def note(self, world: World) -> None:
        """Take in the impacts of this substep; call it where they happen, for normals turn afterwards."""
        new = impacts_of(world)
        if not len(new):
            return
        # What this step has told already stays as it was told first.
        every = np.concatenate((self.recent(world.time), new))
        _, told = np.unique(every[["a", "b", "time", "normal", "tangent"]], return_index=True)
        every = every[np.sort(told)]
        every = every[np.argsort(-every["normal"] * self.freshness(every, world.time), kind="stable")]
        _, first = np.unique(every[["a", "b", "point"]], return_index=True)
        self.kept = every[np.sort(first)[:_MOST]]

    def recent(self, time: float) -> Touches:
        """Return those that are still to be seen at a time [s]."""
        age = time - self.kept["time"]
        return self.kept[(age >= 0.0) & (age < SHOWN)]

    @staticmethod
    def freshness(touches: Touches, time: float) -> NDArray[np.float64]:
        """Return how far each has faded at a time [s]: 1 is new, 0 is gone."""
        fresh: NDArray[np.float64] = np.clip(1.0 - (time - touches["time"]) / SHOWN, 0.0, 1.0)
        return fresh
