"""The targets of the engine, in numbers, and whether they are met."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from physicslab.lab.bench.catalogue import SIZES
from physicslab.lab.bench.growth import Growth
from physicslab.lab.bench.result import SceneResult
from physicslab.lab.bench.unused import Unused
from physicslab.lab.peers.box2d3_built import BuiltBox2D
from physicslab.lab.peers.pymunk_mirror import PymunkMirror

__all__ = ["Check", "checks"]

FASTER = {"pyramid_30": 4.0, "pyramid_60": 4.0, "pile_1000": 4.0, "pile_4000": 4.0, "gas_2000": 2.0}
"""Lower limit of how many times as long pymunk's step takes."""
FASTER_WITH_READ = 6.0
"""The same of each of these scenes, with positions read back."""
MANY = ("pyramid_60", "pile_4000", "gas_2000", "funnel", "funnel_open", "heap", "chains", "tumbler")
"""Scenes of many bodies, settled or not, to which the three limits below apply."""
FASTER_THAN_PYMUNK, BESIDE_BOX2D, TAIL = 1.5, 1.2, 3.0
"""How many times as long pymunk's step takes at least; upper limits of a step in steps of Box2D 3's in C,
and of its 99th percentile in medians."""
COMPILED_RUN = 1.0
"""Upper limit of a step of the ten discs, in a run of many, in steps of pymunk's."""
SINGLE_STEPS = {"circles_10_stepped": 20.0, "circles_10_window": 20.0}
"""Upper limits of a single step [us]."""
EXPONENT = 1.1
"""Upper limit of the p of N^p by which the cost of piles, gases and funnels grows."""
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
    name, right = result.scene.name, result.right
    peer = result.engines.get(PymunkMirror.title)
    found: list[Check] = []
    if result.ours.step is not None and name in SINGLE_STEPS:
        found.append(
            Check(
                name, "a single step, us", 1e3 * result.ours.step.median_ms, SINGLE_STEPS[name], False, right
            )
        )
    if peer is not None and peer.ratio is not None:
        if name == "circles_10":
            found.append(
                Check(name, "run, PhysicsLab / pymunk", 1.0 / peer.ratio, COMPILED_RUN, False, right)
            )
        if name in FASTER:
            found.append(Check(name, "step, pymunk / PhysicsLab", peer.ratio, FASTER[name], True, right))
            if peer.ratio_with_read is not None:
                what = "the same, positions read back"
                found.append(Check(name, what, peer.ratio_with_read, FASTER_WITH_READ, True, right))
    return found + _of_many(result) if name in MANY else found


def _of_many(result: SceneResult) -> list[Check]:
    """Return the checks of a scene of many bodies: of the first two seconds, and of the steps after that."""
    name, right, found = result.scene.name, result.right, list[Check]()
    for when, spread in (("first 2 s", result.ours.begin), ("then", result.ours.step)):
        for engine in result.engines.values():
            ratio = engine.begin_ratio if when == "first 2 s" else engine.ratio
            if ratio is None:
                continue
            if engine.title == PymunkMirror.title:
                what = f"{when}: pymunk / PhysicsLab"
                found.append(Check(name, what, ratio, FASTER_THAN_PYMUNK, True, right))
            elif engine.title.startswith(BuiltBox2D.title):
                what = f"{when}: PhysicsLab / {engine.title}"
                found.append(Check(name, what, 1.0 / ratio, BESIDE_BOX2D, False, right))
        if spread is not None:
            found.append(Check(name, f"{when}: p99 / median", spread.tail, TAIL, False, right))
    return found
