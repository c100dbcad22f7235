"""The results of a method on a problem: error, cost, and errors of conserved quantities."""

import math
import statistics
from functools import partial

import numpy as np

from physicslab.components import Transform, Velocity
from physicslab.lab.accuracy.problem import Problem
from physicslab.lab.accuracy.settings import Setting
from physicslab.lab.accuracy.verdict import verdict
from physicslab.lab.accuracy.watch import Row, watch
from physicslab.lab.case import Verdict, attempt, cpu_time
from physicslab.world import World

_REPEATED_BELOW_S = 0.05
"""A run that takes less is made three times more, and their median counts."""


def measure(problem: Problem, setting: Setting, floor: float | None = None) -> Row:
    """Compute a problem at a setting, repeatedly if that is short, and once more to watch it.

    Parameters
    ----------
    floor : float, optional
        How far apart two runs end whose starts differ by one rounding.
    """
    world = problem.build(setting.simulation(problem))
    cpu_s, error, failure = _timed(problem, setting, world)
    if not failure and cpu_s < _REPEATED_BELOW_S:
        again = (problem.build(setting.simulation(problem)) for _ in range(3))
        cpu_s = statistics.median(_timed(problem, setting, other)[0] for other in again)
    method = world.plan
    if method.integrator.chooses_steps:
        cost = method.integrator.evaluations
        dt, steps = None, (world.force_evaluations // cost if cost else len(problem.times))
    else:
        dt, steps = world.simulation.dt / method.substeps, world.steps * method.substeps
    row = Row(
        method.integrator.name, method.reason, setting.collisions, dt, setting.tolerance, steps,
        world.force_evaluations, 1e3 * cpu_s, 1e3 * cpu_s / problem.seconds, problem.seconds, error,
    )  # fmt: skip
    row.failure = failure
    if not failure and problem.search is None:
        watch(row, problem, setting)
    row.verdict = verdict(error, problem.good, problem.excellent, floor=floor, chaotic=problem.chaotic)
    if row.verdict in (Verdict.EXCELLENT, Verdict.GOOD) and row.collision_count_error:
        row.verdict = Verdict.SHORT  # right by chance: collisions are missing, or too many
    return row


def _timed(problem: Problem, setting: Setting, world: World) -> tuple[float, float | None, str]:
    """Return the process time [s], the error, and what went wrong."""
    world.synchronise()
    compiled = world.compile_s
    search = problem.search
    if search is None:
        run = partial(problem.finish, (world,))
    else:
        run = partial(search, lambda: setting.simulation(problem))
    cpu_s, (error, failure) = cpu_time(partial(attempt, run))
    if world.compile_s > compiled:  # kernels were loaded: what that took is no part of the method
        cpu_s = max(0.0, cpu_s - (world.compile_s - compiled))
    return cpu_s, error, failure


def rounding_floor(problem: Problem) -> float | None:
    """Return how much the error changes when the start moves by one rounding; ``None`` where bodies touch.

    Every coordinate and speed is moved to the next float up, and down, and the run is made as ``auto`` does.
    No method that computes in floats can be relied on to do better than a few times this.
    """
    if problem.touches:
        return None
    errors = []
    for way in (0.0, -math.inf, math.inf):
        world = problem.build(Setting("auto").simulation(problem))
        world.synchronise()
        for column in (world.table(Transform)["position"], world.table(Velocity)["linear"]):
            column[:] = np.where((column == 0.0) | (way == 0.0), column, np.nextafter(column, way))
        error, _ = attempt(partial(problem.finish, (world,)))
        if error is None:
            return None
        errors.append(error)
    return max(abs(error - errors[0]) for error in errors)
