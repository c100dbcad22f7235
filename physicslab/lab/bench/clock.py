"""Times of engines that take turns, so that noise and heat are the same for all.

Times are CPU times, of all threads of the process: on an idle machine that is the time on the wall, and on
one that does other work it leaves the waiting out. No engine gains by a second thread.
"""

from __future__ import annotations

import gc
import itertools
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from physicslab.lab.bench.engine import Engine


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
        """Return how some times are distributed."""
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
        What all turns took on the wall [ms]: what the schedule's own figures are shares of.
    """

    step: list[float] = field(default_factory=list)
    read: list[float] = field(default_factory=list)
    wall_ms: float = 0.0

    @property
    def with_read(self) -> NDArray[np.float64]:
        """A step and reading the state back [ms]."""
        return np.add(self.step, self.read)


@contextmanager
def _no_collection() -> Iterator[None]:
    """Keep Python's garbage collector from slowing one engine and not the other."""
    gc.collect()
    gc.disable()
    try:
        yield
    finally:
        gc.enable()


TURN = 10
"""Single steps that an engine takes before the next has its turn. With one each, all would be timed while
they fetch from memory what the others have driven out of the caches; a program runs one engine."""
_PORTION = 12
"""Turns between two reports of progress: a whole number of times through the orders of three."""


def take_turns(engines: Sequence[Engine], rounds: int, block: int = 0) -> Iterator[list[Times]]:
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
    """
    times = [Times() for _ in engines]
    orders = itertools.cycle(itertools.permutations(range(len(engines))))
    turns = [1] * rounds if block else [TURN] * (rounds // TURN) + [rounds % TURN] * (rounds % TURN > 0)
    for start in range(0, len(turns), _PORTION):
        with _no_collection():
            for turn, order in zip(turns[start : start + _PORTION], orders, strict=False):
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
