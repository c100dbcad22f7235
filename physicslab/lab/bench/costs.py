"""Memory of a body, and the extra cost of a step for systems that the scene does not use."""

import gc
import tracemalloc
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from physicslab.components import Transform
from physicslab.lab.bench.catalogue import discs, ten_discs
from physicslab.lab.bench.engine import Engine
from physicslab.lab.bench.result import Spread, take_turns
from physicslab.lab.jobs import Job
from physicslab.systems.broad_phase import BroadPhaseSystem
from physicslab.systems.contact import ContactSystem
from physicslab.systems.gravity import GravitySystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.resolve import ResolveSystem
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import System
from physicslab.world import World

_SIZES = (1_000, 4_000)
_STEPS = 120
"""Long enough for discs to lie on each other: contacts take memory too."""
_SECONDS = 4.0
"""How long discs fall and settle before the timing."""
UNUSED: dict[str, tuple[Callable[[tuple[System, ...]], World], int]] = {
    "circles_10": (ten_discs, 3_000),
    "pile_1000": (partial(discs, 1_000), 600),
}
"""Functions that make a scene of discs with some systems, and the number of timed steps: a small scene,
most of whose step is dispatch, and a large one."""


@dataclass(frozen=True, slots=True)
class Memory:
    """The memory of one more disc of a pile, of all that Python and numpy hold.

    Attributes
    ----------
    columns : float
        The numbers of its components [bytes].
    spawned : float
        All of it when it has been spawned: numbers, handles, and esper's records [bytes].
    with_contacts : float
        The same in a pile: near pairs, contacts and what the solver works with [bytes].
    """

    columns: float
    spawned: float
    with_contacts: float


def measure_memory(sizes: tuple[int, int] = _SIZES, steps: int = _STEPS) -> Memory:
    """Return what a body takes: the difference of two piles, so that what every world has does not count."""
    _held(min(sizes[0], 100), 2)  # objects that are allocated only once are allocated now
    (few, small), (many, large) = ((size, _held(size, steps)) for size in sizes)
    return Memory(*((high - low) / (many - few) for low, high in zip(small, large, strict=True)))


def _held(count: int, steps: int) -> tuple[int, int, int]:
    """Return the bytes of a pile's columns, of the whole pile at the start, and of the whole later."""
    gc.collect()
    tracemalloc.start()
    try:
        world = discs(count)
        world.synchronise()
        spawned = _traced()
        world.run(steps=steps)
        tables = world.entity_index.tables.values()
        columns = sum(table[spec.name].nbytes for table in tables for spec in table.component.FIELDS)
        return columns, spawned, _traced()
    finally:
        tracemalloc.stop()


def _traced() -> int:
    gc.collect()
    return tracemalloc.get_traced_memory()[0]


@dataclass(frozen=True, slots=True)
class Unused:
    """A scene of discs under gravity, with what it needs and with every system.

    Attributes
    ----------
    scene : str
        Which.
    steps : int
        How many were timed.
    needed_ms, all_ms : Spread
        A step with the systems that the scene needs, and with all there are.
    ratio : float
        Median of the second by the first, step by step.
    left_out : tuple of str
        Systems that the second world has and does not run.
    same_bits : bool
        Whether both end in the same places, to the bit.
    """

    scene: str
    steps: int
    needed_ms: Spread
    all_ms: Spread
    ratio: float
    left_out: tuple[str, ...]
    same_bits: bool


def _needed() -> tuple[System, ...]:
    """Return the systems that discs under gravity need, and no others."""
    return GravitySystem(), IntegrateSystem(), BroadPhaseSystem(), ContactSystem(), ResolveSystem()


def measure_unused(name: str, build: Callable[[tuple[System, ...]], World], steps: int) -> Job[Unused]:
    """Time a scene with the systems that it needs and with all; yield the share that is done."""
    bare, whole = (Engine(build(systems)) for systems in (_needed(), standard_systems()))
    settling = round(_SECONDS / bare.dt)
    for times in take_turns((bare, whole), settling):
        yield len(times[0].step) / (settling + steps)
    for times in take_turns((bare, whole), steps):
        yield (settling + len(times[0].step)) / (settling + steps)
    ours, theirs = (np.array(spent.step) for spent in times)
    here, there = (engine.world.table(Transform)["position"] for engine in (bare, whole))
    return Unused(
        name, steps, Spread.of(ours), Spread.of(theirs), float(np.median(theirs / ours)),
        tuple(left.name for left in whole.world.schedule.left_out), bool(np.array_equal(here, there)),
    )  # fmt: skip
