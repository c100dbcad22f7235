"""What a scene of the benchmark is: how it is built, for how long it runs, and which quality it must have."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from physicslab.ecs.vector import Vector2
from physicslab.lab.bench.quality import Quality
from physicslab.lab.case import Case
from physicslab.world import World

__all__ = ["BenchScene"]


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchScene(Case):
    """A scene that is timed.

    Attributes
    ----------
    size : int
        How many bodies move.
    build : callable
        Returns its world, at the start.
    seconds : float
        How long it runs before the timing [s]; quality is measured then.
    steps : int
        How many steps are timed after that.
    quality : tuple of Quality
        What is measured beside the times.
    compiled_runs : bool
        Whether many steps are taken in one call, as headless runs do, and not one by one.
    in_window : bool
        Whether it is stepped with the systems of a window installed.
    gravity_at : callable, optional
        Returns gravity [m/s^2] at a time [s]; it is set before every step.
    edit : callable, optional
        Takes the world and the number of the step; it is called before every step, as part of what is timed.
        Other engines do not run such a scene.
    by_default : bool
        Whether the scene is run where none is named.
    """

    size: int
    build: Callable[[], World]
    seconds: float = 10.0
    steps: int = 300
    quality: tuple[Quality, ...] = ()
    compiled_runs: bool = False
    in_window: bool = False
    gravity_at: Callable[[float], Vector2] | None = None
    edit: Callable[[World, int], None] | None = None
    by_default: bool = True
