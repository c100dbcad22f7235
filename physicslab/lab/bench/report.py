"""All that a run of the benchmark found, and its document: times in ms, else SI units."""

from dataclasses import dataclass, field
from typing import Any

from physicslab.lab.bench.costs import Memory, Unused
from physicslab.lab.bench.result import Growth, SceneResult, growths
from physicslab.lab.bench.targets import Check, checks
from physicslab.lab.document import lab_document, pick, plain


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

    @property
    def document(self) -> dict[str, Any]:
        """Every figure, its target, and the machine it was taken on."""
        return lab_document(
            "bench", peers=self.peers, scenes=[_scene(result) for result in self.scenes],
            growth=self.growths, unused=self.unused, bytes_per_body=self.memory,
            targets=[{**plain(check), "met": check.met} for check in self.checks],
        )  # fmt: skip


def _scene(result: SceneResult) -> dict[str, Any]:
    scene = result.scene
    return {
        **pick(scene, "name", "title", "group"), "bodies": scene.size, "contacts": result.contacts,
        "settled_s": scene.seconds, "steps": scene.steps, "one_call": scene.compiled_runs,
        "quality_limits": [pick(quality, "name", "unit", "limit", "when") for quality in scene.quality],
        "systems_ms": result.systems, "engines": [*result.engines.values()],
    }  # fmt: skip
