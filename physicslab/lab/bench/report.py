"""All that a run of the benchmark found."""

from __future__ import annotations

from dataclasses import dataclass, field

from physicslab.lab.bench.growth import Growth, growths
from physicslab.lab.bench.memory import Memory
from physicslab.lab.bench.result import SceneResult
from physicslab.lab.bench.targets import Check, checks
from physicslab.lab.bench.unused import Unused

__all__ = ["BenchReport"]


@dataclass(slots=True)
class BenchReport:
    """All that a run of the benchmark found.

    Attributes
    ----------
    peers : bool
        Whether other engines took part.
    scenes : list of SceneResult
        Scene by scene.
    unused : list of Unused
        What a step costs more for what it does not use.
    memory : Memory, optional
        What a body takes, where that was measured.
    """

    peers: bool
    scenes: list[SceneResult] = field(default_factory=list)
    unused: list[Unused] = field(default_factory=list)
    memory: Memory | None = None

    @property
    def growths(self) -> list[Growth]:
        """How costs grow with the number of bodies."""
        return growths(self.scenes)

    @property
    def checks(self) -> list[Check]:
        """These figures beside their targets."""
        return checks(self.scenes, self.growths, self.unused)
