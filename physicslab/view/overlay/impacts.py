"""Impacts, kept for long enough to be seen."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.view.overlay.contact_samples import SAMPLE, ContactSamples, samples_of
from physicslab.world import World

__all__ = ["SHOWN", "RecentImpacts"]

SHOWN = 1.0
"""How long an impact is shown [s]; it is the world's time, which stands still while paused."""
_MAX_KEPT = 256
"""The weakest impacts beyond that number are left out."""
_SAME_PLACE = 0.15
"""Impacts of a pair nearer than that look like one; in lengths of the longest arrow."""


class RecentImpacts:
    """Keeps the impacts of the last second; of those of one pair at one place, the one that stands out most.

    Attributes
    ----------
    kept : array of SAMPLE (n,)
        The impacts, those that stood out most when they were noted first.
    same_place : float
        Two impacts of a pair, or an impact and a resting contact, are shown as one if nearer than that [m].
    """

    def __init__(self) -> None:
        self.same_place = 0.0
        self._count = 0
        self.clear()

    def clear(self) -> None:
        """Forget them all."""
        self.kept: ContactSamples = np.zeros(0, SAMPLE)

    def note(self, world: World, impacts: NDArray[Any], reach: float) -> None:
        """Take in new impacts of a world, an array of IMPACT; the longest arrow is ``reach`` [m] long."""
        self.same_place = _SAME_PLACE * reach
        if not len(impacts):
            return
        strongest = np.argsort(-impacts["normal_impulse"], kind="stable")[:_MAX_KEPT]
        new = samples_of(world, impacts[strongest])
        new["point"] = -1 - self._count - np.arange(len(new))  # a key that no other contact or impact has
        self._count += len(new)
        every = np.concatenate((self.recent(world.time), new))
        strength = every["normal"] * self.freshness(every, world.time)
        every = every[np.argsort(-strength, kind="stable")]
        stands_behind = np.tril(same_place(every, every, self.same_place), -1).any(axis=1)
        self.kept = every[~stands_behind][:_MAX_KEPT]

    def recent(self, time: float) -> ContactSamples:
        """Return those that are still to be seen at a time [s]."""
        return self.kept[time - self.kept["time"] < SHOWN]

    @staticmethod
    def freshness(impacts: ContactSamples, time: float) -> NDArray[np.float64]:
        """Return how far each has faded at a time [s]: 1 is new, 0 is gone."""
        fresh: NDArray[np.float64] = np.clip(1.0 - (time - impacts["time"]) / SHOWN, 0.0, 1.0)
        return fresh


def same_place(one: ContactSamples, other: ContactSamples, distance: float) -> NDArray[np.bool_]:
    """Return whether samples are of the same pair and nearer than ``distance`` [m], an array (one, other)."""
    same: NDArray[np.bool_] = one["a"][:, None] == other["a"]
    same &= one["b"][:, None] == other["b"]
    first, second = np.nonzero(same)
    apart = one["place"][first] - other["place"][second]
    same[first, second] = np.hypot(apart[:, 0], apart[:, 1]) < distance
    return same
