"""The targets of the engine, in numbers, and whether they are met."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from physicslab.lab.bench.catalogue import SIZES
from physicslab.lab.bench.growth import Growth
from physicslab.lab.bench.result import SceneResult
from physicslab.lab.bench.unused import Unused
from physicslab.lab.peers.pymunk_mirror import PymunkMirror

__all__ = ["Check", "checks"]

FASTER = {"pyramid_30": 4.0, "pyramid_60": 4.0, "pile_1000": 4.0, "pile_4000": 4.0, "gas_2000": 2.0}
"""Lower limit of how many times as long pymunk's step takes."""
FASTER_WITH_READ = 6.0
"""The same of each of these scenes, with positions read back."""
COMPILED_RUN = 2.0
"""Upper limit of a step of the ten discs, in a run of many, in steps of pymunk's."""
EXPONENT = 1.1
"""Upper limit of the p of N^p by which the cost of piles and gases grows."""
UNUSED = 1.02
"""Upper limit of how many times as long a step takes with systems that it does not use: 1, but for noise."""


@dataclass(frozen=True, slots=True)
class Check:
    """A figure beside what it should be.

    Attributes
    ----------
    name, what : str
        Of which scene or group, and which figure.
    figure, limit : float
        What was found, and the target.
    at_least : bool
        Whether more is better.
    right : bool
        Whether the scene was simulated well enough for its speed to count.
    """

    name: str
    what: str
    figure: float
    limit: float
    at_least: bool
    right: bool = True

    @property
    def met(self) -> bool:
        """Whether it is reached, and counts."""
        reached = self.figure >= self.limit if self.at_least else self.figure <= self.limit
        return reached and self.right

    @property
    def verdict(self) -> str:
        """In words."""
        return "met" if self.met else "not met" if self.right else "not met: quality"


def checks(results: Sequence[SceneResult], grown: Sequence[Growth], unused: Sequence[Unused]) -> list[Check]:
    """Return every figure of these that has a target."""
    found = [check for result in results for check in _of_scene(result)]
    for growth in grown:
        if growth.engine == "PhysicsLab" and {SIZES[0], SIZES[-1]} <= set(growth.sizes):
            found.append(Check(growth.group, "exponent of growth", growth.exponent, EXPONENT, False))
    for spent in unused:
        what = "with unused systems / without"
        found.append(Check(spent.case.name, what, spent.ratio, UNUSED, False, spent.same_bits))
    return found


def _of_scene(result: SceneResult) -> list[Check]:
    name = result.scene.name
    peer = result.engines.get(PymunkMirror.title)
    if peer is None or peer.ratio is None:
        return []
    if result.scene.compiled_runs:
        return [Check(name, "run, PhysicsLab / pymunk", 1.0 / peer.ratio, COMPILED_RUN, False, result.right)]
    if name not in FASTER:
        return []
    found = [Check(name, "step, pymunk / PhysicsLab", peer.ratio, FASTER[name], True, result.right)]
    if peer.ratio_with_read is not None:
        what = "the same, positions read back"
        found.append(Check(name, what, peer.ratio_with_read, FASTER_WITH_READ, True, result.right))
    return found
