"""What a scene of the benchmark is: how it is built, for how long it runs, and what must come of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from physicslab.lab.bench.quality import Quality
from physicslab.world import World

__all__ = ["BenchScene"]


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchScene:
    """A scene that is timed.

    Attributes
    ----------
    name, title, group : str
        For the command line, for people, and which family of sizes it belongs to.
    size : int
        How many bodies move.
    build : callable
        Returns its world, at the start.
    seconds : float
        How long it runs before the timing [s]; quality is looked at then.
    steps : int
        How many steps are timed after that.
    quality : tuple of Quality
        What is looked at beside the times.
    compiled_runs : bool
        Whether many steps are taken in one call, as headless runs do, and not one by one.
    """

    name: str
    title: str
    group: str
    size: int
    build: Callable[[], World]
    seconds: float = 10.0
    steps: int = 300
    quality: tuple[Quality, ...] = ()
    compiled_runs: bool = False
