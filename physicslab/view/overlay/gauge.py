"""Scales of arrows: round numbers that follow what is shown, slowly enough to be read."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from physicslab.view.canvas.quantities import round_quantity, rounded_up

__all__ = ["Gauge"]

_MEMORY = 4.0
"""Time [s] in which the memory of a strong value fades to a third."""
_MIN_LENGTH, _MAX_LENGTH = 0.25, 1.3
"""While the longest arrow is within these shares of the wanted length, the scale stays."""


class Gauge:
    """How much of a quantity a metre of arrow stands for: 1, 2 or 5 times a power of ten.

    The scale follows the strongest value of the last seconds. It depends on the world alone: zooming enlarges
    arrows together with all else, and the legend stays true.

    Parameters
    ----------
    unit : str
        Of the quantity.

    Attributes
    ----------
    per_metre : float
        How much one metre stands for; 0 before anything was shown.
    kept : bool
        Whether it stays as it is, so that two pictures can be compared.

    Examples
    --------
    >>> gauge = Gauge("m/s")
    >>> gauge.follow(np.array([3.0]), reach=1.5, time=0.0)
    >>> gauge.words
    '1 m = 2 m/s'
    """

    def __init__(self, unit: str) -> None:
        self.unit = unit
        self.per_metre = 0.0
        self.kept = False
        self._peak = 0.0
        self._time = 0.0

    def follow(self, values: NDArray[np.float64], reach: float, time: float) -> None:
        """Take in the magnitudes of a frame; the strongest should be about ``reach`` [m] long."""
        if self.kept and self.per_metre:
            return
        strongest = float(np.max(values, initial=0.0, where=np.isfinite(values)))
        faded = self._peak * math.exp(-max(time - self._time, 0.0) / _MEMORY)
        self._peak, self._time = max(strongest, faded), time
        wanted = self._peak / reach
        if wanted > 1e-12 and not _MIN_LENGTH * self.per_metre <= wanted <= _MAX_LENGTH * self.per_metre:
            self.per_metre = rounded_up(wanted, 1e-3)

    @property
    def words(self) -> str:
        """The scale, as it stands in the legend."""
        return f"1 m = {round_quantity(self.per_metre, self.unit)}" if self.per_metre else "none yet"
