"""The results of a scene: times, their spread, and how they grow with the number of bodies."""

from __future__ import annotations

import gc
import itertools
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from physicslab.files.scene import uncollected
from physicslab.lab.bench.engine import OURS, Engine
from physicslab.lab.bench.scene import BenchScene


@dataclass(frozen=True, slots=True)
class Spread:
    """How the CPU times of one thing, measured many times, are distributed [ms].

    Attributes
    ----------
    median, p90, p99, mean : float
        The middle one, those that 90 and 99 of 100 do not exceed, and the mean. Work that is done every few
        steps, as new lists of pairs, shows in the mean and not in the median.
    """

    median: float
    p90: float
    p99: float
    mean: float

    @classmethod
    def of(cls, milliseconds: Sequence[float] | NDArray[np.float64]) -> Spread:
        """Return how some times (n,) [ms] are distributed."""
        median, p90, p99 = map(float, np.percentile(milliseconds, (50, 90, 99)))
        return cls(median, p90, p99, float(np.mean(milliseconds)))

    @property
    def tail(self) -> float:
        """The 99th percentile as a multiple of the median: how much longer the longest steps are."""
        return self.p99 / self.median


@dataclass(slots=True)
class Times:
    """The time of each step of an engine.

    Attributes
    ----------
    step, read : list of float
        The step, and reading the state back after it [ms].
    wall_ms : float
        Time of all turns on the wall [ms]: the schedule's own figures are shares of it.
    """

    step: list[float] = field(default_factory=list)
    read: list[float] = field(default_factory=list)
    wall_ms: float = 0.0

    @property
    def with_read(self) -> NDArray[np.float64]:
        """A step and reading the state back [ms]."""
        return np.add(self.step, self.read)


TURN = 10
"""Single steps that an engine takes before the next has its turn. With one each, all would be timed while
they fetch from memory what the others have driven out of the caches; a program runs one engine."""
_PORTION = 12
"""Turns between two reports of progress: a whole number of times through the orders of three."""


def take_turns(
    engines: Sequence[Engine], rounds: int, block: int = 0, portion: int = _PORTION
) -> Iterator[list[Times]]:
    """Advance all engines ``rounds`` times, in every order in turn; yield the times so far now and then.

    Parameters
    ----------
    engines : sequence of Engine
        Those that take part.
    rounds : int
        How many steps, or blocks of steps, each takes.
    block : int
        Steps of a block, in one call that is a turn; 0 for single ones, ``TURN`` in a turn, after each of
        which the state is read back as well.
    portion : int
        Turns between two of what is yielded.
    """
    times = [Times() for _ in engines]
    orders = itertools.cycle(itertools.permutations(range(len(engines))))
    turns = [1] * rounds if block else [TURN] * (rounds // TURN) + [rounds % TURN] * (rounds % TURN > 0)
    for start in range(0, len(turns), portion):
        if start % _PORTION == 0:  # a tenth of a second in a large program
            gc.collect()
        with uncollected():  # it would slow one engine and not the other
            for turn, order in zip(turns[start : start + portion], orders, strict=False):
                for i in order:
                    for _ in range(turn):
                        _advance(engines[i], times[i], block)
                    engines[i].pause()
        yield times


def _advance(engine: Engine, spent: Times, block: int) -> None:
    """Advance an engine by a step, or by a block of steps, and add what it took to the times."""
    entered, began = time.perf_counter_ns(), time.process_time_ns()
    if block:
        engine.run(block)
    else:
        engine.advance()
    stepped = time.process_time_ns()
    spent.wall_ms += (time.perf_counter_ns() - entered) / 1e6
    spent.step.append((stepped - began) / 1e6 / max(1, block))
    if not block:
        began = time.process_time_ns()
        engine.read()
        spent.read.append((time.process_time_ns() - began) / 1e6)


_GROUPS = ("piles", "gases", "funnels")
_SIZES_NEEDED = 3
"""Without so many, no exponent is fitted."""


@dataclass(frozen=True, slots=True)
class Alike:
    """A peer in steps so short that it is as right as PhysicsLab.

    Attributes
    ----------
    finer : int
        How many times as short as usual its steps were.
    times_ours : float
        How many times as long as PhysicsLab it took.
    is_reached : bool
        Whether it was as right; if not, it would take longer still.
    """

    finer: int
    times_ours: float
    is_reached: bool


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
    alike : Alike, optional
        A peer at like quality, in random scenes.
    quality : dict of str to float or None
        Measures of quality; ``None`` where it is not finite.
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
    alike: Alike | None = None
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
        Time of each of PhysicsLab's systems in its median step [ms], by their shares of the whole time.
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
