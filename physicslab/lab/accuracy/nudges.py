"""What rounding does to a result: starts that are moved by one rounding each, and the law of tolerances."""

from __future__ import annotations

import copy
import math
import random
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.lab.accuracy.twins import Document

__all__ = ["NUDGES", "NUDGE_SHARE", "ROUNDING", "error_of_tolerance", "nudged"]

NUDGES = 6
"""How many starts are moved by one rounding."""
NUDGE_SHARE = 0.5
"""A number is off by half a rounding where it is rounded, and these are moved by a whole one."""
ROUNDING = 2.0**-50
"""The smallest error of a result, as a share of its size: that of a few operations."""
_LOOSER = 2.0**8
"""How many times as large errors are where twice as long steps are allowed to a method of order 8."""
_NUMBERS: dict[str, tuple[str, ...]] = {
    "Transform": ("position", "angle"),
    "Velocity": ("linear", "angular"),
    "Mass": ("mass",),
}
"""The numbers of a body that are moved."""


def error_of_tolerance(twice: NDArray[np.float64], four_times: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the error that the tolerance of a method that chooses its steps leaves.

    Errors that grow by a factor f with each of two looser tolerances are off by f - 1 and f^2 - 1 times the
    error, so the quotient less one is f: it is taken as it is seen, and never for more than that of order 8.
    What does not grow with the tolerance is an error of another kind, and counts in full.

    Parameters
    ----------
    twice, four_times : arrays of floats
        How far the results are from those with tolerances for steps twice and four times as long; of any
        shape, in any unit.

    Examples
    --------
    >>> error_of_tolerance(np.array([255.0, 3.0, 1.0]), np.array([65535.0, 15.0, 1.0])).tolist()
    [1.0, 0.75, 1.0]
    """
    with np.errstate(all="ignore"):
        growth = np.where(twice > 0.0, four_times / twice - 1.0, _LOOSER)
    return twice / np.clip(growth, 1.0, _LOOSER - 1.0)


def nudged(document: Document, seed: int) -> Document:
    """Return a scene whose numbers are moved by one rounding each, up or down.

    These are places, velocities and masses of what can move, and gravity. What is zero stays: it is
    not rounded, and with it a symmetry that no rounding breaks.
    """
    twin, order = copy.deepcopy(document), random.Random(seed)

    def move(part: dict[str, Any], *names: str) -> None:
        for name in names:
            value = part.get(name)
            if isinstance(value, list):
                part[name] = [_next(number, order) for number in value]
            elif value is not None:
                part[name] = _next(value, order)

    for entity in twin["entities"]:
        if "Velocity" in entity:
            for kind, names in _NUMBERS.items():
                move(entity.get(kind, {}), *names)
    move(twin.get("physics", {}), "gravity", "G")
    return twin


def _next(number: float, order: random.Random) -> float:
    """Return the next number up or down; of zero itself."""
    return math.nextafter(number, order.choice((-math.inf, math.inf))) if number else number
