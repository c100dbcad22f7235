"""How the cost of a step grows with the number of bodies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from physicslab.lab.bench.result import SceneResult

__all__ = ["Growth", "exponent", "growths"]

_GROUPS = ("piles", "gases", "funnels")
_SIZES_NEEDED = 3
"""Without so many, no exponent is fitted."""


@dataclass(frozen=True, slots=True)
class Growth:
    """How an engine's cost grows over the sizes of a group.

    Attributes
    ----------
    group, engine : str
        Which scenes, and in which engine.
    sizes : tuple of int
        How many bodies.
    ms : tuple of float
        Median of a step [ms], size by size.
    exponent : float
        The p of the N^p that fits best.
    """

    group: str
    engine: str
    sizes: tuple[int, ...]
    ms: tuple[float, ...]
    exponent: float


def exponent(sizes: Sequence[float], costs: Sequence[float]) -> float:
    """Return the slope of the straight line that fits best, by least squares of logarithms.

    >>> round(exponent([10, 20, 40], [3.0, 12.0, 48.0]), 12)
    2.0
    """
    slope, _ = np.polyfit(np.log(sizes), np.log(costs), 1)
    return float(slope)


def growths(results: Sequence[SceneResult]) -> list[Growth]:
    """Return the growth of every engine in each group of which it ran three sizes or more."""
    costs: dict[tuple[str, str], dict[int, float]] = {}
    for result in results:
        for engine, found in result.engines.items():
            if found.step is not None and result.scene.group in _GROUPS:
                costs.setdefault((result.scene.group, engine), {})[result.scene.size] = found.step.median_ms
    return [
        Growth(
            group, engine, tuple(sizes), tuple(sizes.values()), exponent(list(sizes), list(sizes.values()))
        )
        for (group, engine), sizes in costs.items()
        if len(sizes) >= _SIZES_NEEDED
    ]
