"""What a step costs more for what the scene does not use."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from physicslab.components import Transform
from physicslab.lab.bench.catalogue import circles, discs
from physicslab.lab.bench.clock import Spread, take_turns
from physicslab.lab.bench.engine import OurEngine
from physicslab.systems.broad_phase import BroadPhaseSystem
from physicslab.systems.contact import ContactSystem
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.resolve import ResolveSystem
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import System
from physicslab.world import World

__all__ = ["UNUSED", "Unused", "UnusedCase", "measure_unused"]

_SECONDS = 4.0
"""How long discs fall and settle before the timing."""


@dataclass(frozen=True, slots=True)
class UnusedCase:
    """A scene of discs under gravity that is built twice: with what it needs, and with every system.

    Attributes
    ----------
    name : str
        Which.
    build : callable
        Takes the systems and returns the world.
    steps : int
        How many are timed.
    """

    name: str
    build: Callable[[tuple[System, ...]], World]
    steps: int


@dataclass(frozen=True, slots=True)
class Unused:
    """What came of it.

    Attributes
    ----------
    case : UnusedCase
        Which.
    bare, whole : Spread
        A step with the systems that the scene needs, and with all there are.
    ratio : float
        Median of whole by bare, step by step.
    left_out : tuple of str
        What the second world has and does not run.
    same_bits : bool
        Whether both end in the same places, to the bit.
    """

    case: UnusedCase
    bare: Spread
    whole: Spread
    ratio: float
    left_out: tuple[str, ...]
    same_bits: bool


UNUSED = (
    UnusedCase("circles_10", circles, 3_000),
    UnusedCase("pile_1000", partial(discs, 1_000), 600),
)
"""A small scene, of which dispatch is the most, and a large one."""


def _needed() -> tuple[System, ...]:
    """Return what discs under gravity need, and nothing else."""
    return GravitySystem(), IntegrateSystem(), BroadPhaseSystem(), ContactSystem(), ResolveSystem()


def measure_unused(case: UnusedCase) -> Iterator[float | Unused]:
    """Time a case; yield the share that is done now and then, and at last the result."""
    bare, whole = (OurEngine(case.build(systems)) for systems in (_needed(), standard_systems()))
    settling = round(_SECONDS / bare.dt)
    total = settling + case.steps
    for times in take_turns((bare, whole), settling):
        yield len(times[0].step) / total
    for times in take_turns((bare, whole), case.steps):
        yield (settling + len(times[0].step)) / total
    ours, theirs = (np.array(spent.step) for spent in times)
    here, there = (engine.world.table(Transform)["position"] for engine in (bare, whole))
    yield Unused(
        case, Spread(ours), Spread(theirs), float(np.median(theirs / ours)),
        tuple(left.name for left in whole.world.schedule.left_out), bool(np.array_equal(here, there)),
    )  # fmt: skip
