"""The impacts of the last second: over in one step, but shown for long enough to be seen."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physicslab.view.overlay.contact_samples import TOUCH, ContactSamples, impacts_of
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
        self.kept: ContactSamples = np.zeros(0, TOUCH)

    def note(self, world: World) -> None:
        """Take in the impacts of this substep; call it where they happen, for normals turn afterwards."""
        new = impacts_of(world)
        if not len(new):
            return
        new = new[np.argsort(-new["normal"], kind="stable")[:_MOST]]
        old = self.recent(world.time)
        same_pair = _same(new, old, "a") & _same(new, old, "b")
        # What this step has told already stays as it was told first.
        reported = (
            same_pair & _same(new, old, "time") & _same(new, old, "normal") & _same(new, old, "tangent")
        )
        fresh = ~reported.any(axis=1)
        new, same_point = new[fresh], (same_pair & _same(new, old, "point"))[fresh]
        before, now = old["normal"] * self.freshness(old, world.time), new["normal"]
        weaker = before < now[:, None]
        every = np.concatenate((
            old[~(same_point & weaker).any(axis=0)], new[~(same_point & ~weaker).any(axis=1)]
        ))  # fmt: skip
        strength = every["normal"] * self.freshness(every, world.time)
        self.kept = every[np.argsort(-strength, kind="stable")[:_MOST]]

    def recent(self, time: float) -> ContactSamples:
        """Return those that are still to be seen at a time [s]."""
        age = time - self.kept["time"]
        return self.kept[(age >= 0.0) & (age < SHOWN)]

    @staticmethod
    def freshness(touches: ContactSamples, time: float) -> NDArray[np.float64]:
        """Return how far each has faded at a time [s]: 1 is new, 0 is gone."""
        fresh: NDArray[np.float64] = np.clip(1.0 - (time - touches["time"]) / SHOWN, 0.0, 1.0)
        return fresh


def _same(new: ContactSamples, old: ContactSamples, column: str) -> NDArray[np.bool_]:
    """Return whether a column is the same, an array (new, old)."""
    same: NDArray[np.bool_] = new[column][:, None] == old[column]
    return same
