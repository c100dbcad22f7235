"""The results of a scene."""

from __future__ import annotations

from dataclasses import dataclass, field

from physicslab.lab.bench.clock import Spread
from physicslab.lab.bench.engine import OURS
from physicslab.lab.bench.scene import BenchScene

__all__ = ["EngineResult", "SceneResult"]


@dataclass(slots=True)
class EngineResult:
    """The results of a scene in one engine.

    Attributes
    ----------
    title : str
        The engine's name.
    step : Spread, optional
        A step of those that are timed; ``None`` where none was.
    with_read : Spread, optional
        The same, with the state read back; ``None`` for runs in one call.
    begin : Spread, optional
        A step of the first two seconds, while a pile falls.
    ratio, ratio_with_read, begin_ratio : float, optional
        Median of how many times longer than PhysicsLab it took for the same step; 1 for PhysicsLab.
    quality : dict of str to float or None
        What was measured of how well it simulates; ``None`` where it is not finite.
    failure : str
        Why it was not timed.
    """

    title: str
    step: Spread | None = None
    with_read: Spread | None = None
    begin: Spread | None = None
    ratio: float | None = None
    ratio_with_read: float | None = None
    begin_ratio: float | None = None
    quality: dict[str, float | None] = field(default_factory=dict)
    failure: str = ""


@dataclass(slots=True)
class SceneResult:
    """The results of a scene.

    Attributes
    ----------
    scene : BenchScene
        Which.
    steps : int
        How many were timed.
    contacts : int
        How many pairs touch at the end.
    engines : dict of str to EngineResult
        By the engine's name, PhysicsLab first.
    systems : dict of str to float
        What each of PhysicsLab's systems takes of its median step [ms], by their shares of the whole time.
    """

    scene: BenchScene
    steps: int
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
