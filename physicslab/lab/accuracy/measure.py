"""What a method does on a problem: error, cost, and what it should have kept."""

from __future__ import annotations

import math
import statistics
import time
from dataclasses import dataclass

import numpy as np

from physicslab.lab.accuracy.problem import Problem
from physicslab.lab.accuracy.settings import Setting
from physicslab.lab.accuracy.watch import Watched, watch
from physicslab.state.masses import Diverged
from physicslab.world import World

__all__ = ["Measurement", "finish", "measure"]

_SHORT_S = 0.05
"""A run that takes less is made three times, and the median counts."""


@dataclass(frozen=True, slots=True)
class Measurement:
    """One method at one setting on one problem.

    Attributes
    ----------
    setting : Setting
        What was asked for.
    integrator, reason : str
        The method that ran, and why.
    dt : float, optional
        Its step [s], where it is fixed.
    steps, evaluations : int
        Steps of the method, and force evaluations.
    cpu_s : float
        Process time of the run [s], compiling and building the world left out.
    error : float, optional
        As the problem measures it; ``None`` where the run diverged.
    watched : Watched
        Energy, momenta, overlap and impacts.
    failure : str
        Why there is no error; empty where there is one.
    """

    setting: Setting
    integrator: str
    reason: str
    dt: float | None
    steps: int
    evaluations: int
    cpu_s: float
    error: float | None
    watched: Watched
    failure: str = ""


def measure(problem: Problem, setting: Setting) -> Measurement:
    """Compute a problem at a setting, more than once if that is short, and once more to look at it."""
    world = problem.build(setting.simulation(problem))
    cpu_s, error, failure = _timed(problem, setting, world)
    if not failure and cpu_s < _SHORT_S:
        again = (problem.build(setting.simulation(problem)) for _ in range(3))
        cpu_s = statistics.median(_timed(problem, setting, other)[0] for other in again)
    method = world.plan
    if method.integrator.chooses_steps:
        cost = method.integrator.evaluations
        dt, steps = None, (world.force_evaluations // cost if cost else len(problem.times))
    else:
        dt, steps = world.simulation.dt / method.substeps, world.steps * method.substeps
    watched = Watched() if failure or problem.search else watch(problem, setting)
    return Measurement(
        setting, method.integrator.name, method.reason, dt, steps, world.force_evaluations, cpu_s, error,
        watched, failure,
    )  # fmt: skip


def finish(problem: Problem, world: World) -> float:
    """Run a world through the times that are compared, and return the largest error."""
    largest = 0.0
    for i, t in enumerate(problem.times):
        world.run(seconds=t - world.time)
        largest = float(np.maximum(largest, problem.error(world, i)))  # numpy's lets NaN through
    return largest


def _timed(problem: Problem, setting: Setting, world: World) -> tuple[float, float | None, str]:
    """Return the process time [s], the error, and what went wrong."""
    world.synchronise()
    compiled, start = world.compile_s, time.process_time()
    error: float | None = None
    failure = ""
    try:
        with np.errstate(all="ignore"):  # what overflows has diverged, and is reported so
            if problem.search is not None:
                error = problem.search(lambda: setting.simulation(problem))
            else:
                error = finish(problem, world)
    except (Diverged, ArithmeticError) as problem_met:
        failure = str(problem_met)
    cpu_s = time.process_time() - start
    if world.compile_s > compiled:  # kernels were loaded: what that took is no part of the method
        cpu_s = max(0.0, cpu_s - (world.compile_s - compiled))
    if error is not None and not math.isfinite(error):
        error, failure = None, "the state is no longer finite"
    return cpu_s, error, failure
