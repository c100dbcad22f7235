"""What rounding does to a result: starts that are moved by one rounding each."""

from __future__ import annotations

import copy
import math
import random
from typing import Any

from physicslab.lab.accuracy.twins import Document

__all__ = ["NUDGES", "NUDGE_SHARE", "ROUNDING", "nudged"]

NUDGES = 6
"""How many starts are moved by one rounding."""
NUDGE_SHARE = 0.5
"""A number is off by half a rounding where it is rounded, and these are moved by a whole one."""
ROUNDING = 2.0**-50
"""The smallest error of a result, as a share of its size: that of a few operations."""
_NUMBERS: dict[str, tuple[str, ...]] = {
    "Transform": ("position", "angle"),
    "Velocity": ("linear", "angular"),
    "Mass": ("mass",),
}
"""The numbers of a body that are moved."""


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
