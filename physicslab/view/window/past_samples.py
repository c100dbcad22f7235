"""Samples of graphs from before they were made: the steps of the history repeated, a slice a frame."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator

from physicslab.diagnostics.quantities import Reading
from physicslab.files.checks import SceneError
from physicslab.history import History
from physicslab.history.replay import Played
from physicslab.state.masses import Diverged
from physicslab.view.window.record import CAPACITY, Key, Record
from physicslab.world import World

__all__ = ["PastSamples"]

_SLICE = 0.004
"""Time [s] that steps may take in a frame."""


class PastSamples:
    """Samples of all steps of a history up to now, taken while frames go by.

    Parameters
    ----------
    history : History
        Its world stays as it is; another one goes through the steps.
    keys : tuple of Key
        What is measured.

    Attributes
    ----------
    record : Record
        A moment for each step, as far as they were made.
    share : float
        How much of the way is done, from 0 to 1.
    """

    def __init__(self, history: History, keys: tuple[Key, ...]) -> None:
        self.keys, self.record, self.share = keys, Record(), 0.0
        self._branches = history.branches
        self._steps = max(history.steps_range[1], 1)
        self._stride = -(-self._steps // CAPACITY)
        self._again: Iterator[tuple[World, Played]] = history.again()

    def is_of(self, history: History) -> bool:
        """Whether the history goes on from the steps that are made again, and has left none of them."""
        return history.branches == self._branches

    def go_on(self) -> bool:
        """Make some steps; return whether all are made, or one comes out otherwise than it did."""
        until = time.perf_counter() + _SLICE
        try:
            for world, played in self._again:
                if played.columns:
                    return True
                if played.step % self._stride == 0:
                    reading = Reading(world)
                    values = {key: reading.value(key[1], key[0]) for key in self.keys}
                    if not all(map(math.isnan, values.values())):  # no body yet, no moments
                        self.record.add(played.time, played.step, values)
                self.share = played.step / self._steps
                if time.perf_counter() >= until:
                    return False
        except (Diverged, SceneError):
            pass  # only the samples until then exist
        return True
