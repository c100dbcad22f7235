"""The targets of the engine, in numbers, and whether they are met."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

from physicslab.lab.bench.catalogue import SIZES
from physicslab.lab.bench.costs import Unused
from physicslab.lab.bench.engine import OURS
from physicslab.lab.bench.result import Growth, SceneResult
from physicslab.lab.peers.box2d3_built import BuiltBox2D
from physicslab.lab.peers.mirrors import PymunkMirror

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
        The scene or group, and the figure.
    figure, limit : float
        The figure found, and the target.
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
    found = [check for result in results for check in (*_of_scene(result), *_of_many(result))]
    for growth in grown:
        if growth.engine == OURS and {SIZES[0], SIZES[-1]} <= set(growth.sizes):
            found.append(Check(growth.group, "exponent of growth", growth.exponent, EXPONENT, False))
    for spent in unused:
        what = "with unused systems / without"
        found.append(Check(spent.scene, what, spent.ratio, UNUSED, False, spent.same_bits))
    return found


def _of_scene(result: SceneResult) -> Iterator[Check]:
    name, check, ours = result.scene.name, partial(Check, result.scene.name, right=result.right), result.ours
    peer = result.engines.get(PymunkMirror.title)
    if ours.step_ms is not None and name in SINGLE_STEPS:
        yield check("a single step, us", 1e3 * ours.step_ms.median, SINGLE_STEPS[name], False)
    if peer is not None and peer.times_ours is not None:
        if name == "circles_10":
            yield check("run, PhysicsLab / pymunk", 1.0 / peer.times_ours, COMPILED_RUN, False)
        if name in FASTER:
            yield check("step, pymunk / PhysicsLab", peer.times_ours, FASTER[name], True)
            if peer.times_ours_with_read is not None:
                yield check(
                    "the same, positions read back", peer.times_ours_with_read, FASTER_WITH_READ, True
                )


def _of_many(result: SceneResult) -> Iterator[Check]:
    """Yield the checks of a scene of many bodies: of the first two seconds, and of the steps after that."""
    if result.scene.name not in MANY:
        return
    check = partial(Check, result.scene.name, right=result.right)
    for when, spread in (("first 2 s", result.ours.first_seconds_ms), ("then", result.ours.step_ms)):
        for engine in result.engines.values():
            ratio = engine.times_ours_first_seconds if when == "first 2 s" else engine.times_ours
            if ratio is not None and engine.name == PymunkMirror.title:
                yield check(f"{when}: pymunk / PhysicsLab", ratio, FASTER_THAN_PYMUNK, True)
            elif ratio is not None and engine.name.startswith(BuiltBox2D.title):
                yield check(f"{when}: PhysicsLab / {engine.name}", 1.0 / ratio, BESIDE_BOX2D, False)
        if spread is not None:
            yield check(f"{when}: p99 / median", spread.tail, TAIL, False)
