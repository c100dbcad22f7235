"""The results of a scene, and how costs grow with the number of bodies."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from physicslab.lab.bench.clock import Spread
from physicslab.lab.bench.engine import OURS
from physicslab.lab.bench.scene import BenchScene

_GROUPS = ("piles", "gases", "funnels")
_SIZES_NEEDED = 3
"""Without so many, no exponent is fitted."""


@dataclass(slots=True)
class EngineResult:
    """The results of a scene in one engine.

    Attributes
    ----------
    name : str
        The engine's.
    step_ms : Spread, optional
        A step of those that are timed; ``None`` where none was.
    step_and_read_ms : Spread, optional
        The same, with the state read back; ``None`` for runs in one call.
    first_seconds_ms : Spread, optional
        A step of the first two seconds, while a pile falls.
    times_ours, times_ours_with_read, times_ours_first_seconds : float, optional
        Median of how many times longer than PhysicsLab it took for the same step; 1 for PhysicsLab.
    quality : dict of str to float or None
        What was measured of how well it simulates; ``None`` where it is not finite.
    failure : str
        Why it was not timed.
    """

    name: str
    step_ms: Spread | None = None
    step_and_read_ms: Spread | None = None
    first_seconds_ms: Spread | None = None
    times_ours: float | None = None
    times_ours_with_read: float | None = None
    times_ours_first_seconds: float | None = None
    quality: dict[str, float | None] = field(default_factory=dict)
    failure: str = ""


@dataclass(slots=True)
class SceneResult:
    """The results of a scene.

    Attributes
    ----------
    scene : BenchScene
        Which.
    contacts : int
        How many pairs touch at the end.
    engines : dict of str to EngineResult
        By the engine's name, PhysicsLab first.
    systems : dict of str to float
        What each of PhysicsLab's systems takes of its median step [ms], by their shares of the whole time.
    """

    scene: BenchScene
    contacts: int = 0
    engines: dict[str, EngineResult] = field(default_factory=dict)
    systems: dict[str, float] = field(default_factory=dict)

    @property
    def ours(self) -> EngineResult:
        """The results in PhysicsLab."""
        return self.engines[OURS]

    @property
    def right(self) -> bool:
        """Whether PhysicsLab keeps every limit of quality."""
        found = self.ours.quality
        figures = [(found.get(quality.name), quality.limit) for quality in self.scene.quality]
        return not self.ours.failure and all(
            figure is not None and figure <= limit for figure, limit in figures
        )


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
            if found.step_ms is not None and result.scene.group in _GROUPS:
                costs.setdefault((result.scene.group, engine), {})[result.scene.size] = found.step_ms.median
    return [
        Growth(*which, tuple(sizes), tuple(sizes.values()), exponent([*sizes], [*sizes.values()]))
        for which, sizes in costs.items()
        if len(sizes) >= _SIZES_NEEDED
    ]
