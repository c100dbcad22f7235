"""A method on a problem: its error and cost, and the errors of conserved quantities along the run."""

import math
import statistics
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from physicslab.components import Mass, Transform, Velocity
from physicslab.diagnostics.energy import Audit, measure_energy, measure_momentum
from physicslab.diagnostics.step_warnings import fastest_force
from physicslab.lab.accuracy.problem import Problem, Setting
from physicslab.lab.accuracy.verdict import verdict
from physicslab.lab.case import Verdict, attempt, cpu_time
from physicslab.world import World

_SAMPLES = 48
_SEED = 20260101


@dataclass(slots=True)
class Row:
    """One method at one setting on one problem; ``None`` for what it has not or does not conserve.

    Attributes
    ----------
    integrator, reason : str
        The method that ran, and why.
    collisions : str
        How contacts were to be found.
    dt : float, optional
        The method's step [s], where it is fixed.
    tolerance : float, optional
        Tolerance of an adaptive method, where one was chosen.
    steps, force_evaluations : int
        Steps of the method, and how often forces were computed.
    cpu_ms, ms_per_simulated_s : float
        Process time of the run [ms], compiling and building the world left out; and of a second of it.
    time : float
        The last of the times that are compared [s].
    error : float, optional
        As the problem measures it; ``None`` where the run diverged.
    energy_drift : float, optional
        |E - E_true| as a share of |E| at the start (of the largest kinetic energy, where that is 0). E_true
        is the energy at the start, or where friction, drag or a damper acts the exact energy at that time.
    energy_numerical : float, optional
        Energy that no account explains, as a share of the energy exchanged.
    momentum_error, angular_momentum_error : float, optional
        The largest departures, as shares of the sum of the bodies' own.
    omega_max_dt : float, optional
        The fastest rate [rad/s] of any force times the method's step, where that is fixed.
    max_penetration : float, optional
        The deepest overlap after any step [m].
    collision_count_error : int, optional
        How many impacts were counted beyond the right number; negative where some are missing.
    verdict : Verdict
        How good the error is.
    failure : str
        Why there is no error; empty where there is one.
    """

    integrator: str
    reason: str
    collisions: str
    dt: float | None
    tolerance: float | None
    steps: int
    force_evaluations: int
    cpu_ms: float
    ms_per_simulated_s: float
    time: float
    error: float | None
    energy_drift: float | None = None
    energy_numerical: float | None = None
    momentum_error: float | None = None
    angular_momentum_error: float | None = None
    omega_max_dt: float | None = None
    max_penetration: float | None = None
    collision_count_error: int | None = None
    verdict: Verdict = Verdict.FAILED
    failure: str = ""


def watch(row: Row, problem: Problem, setting: Setting) -> None:
    """Run a problem once more, measure it at random times, and write into a row what was conserved."""
    world = problem.build(setting.simulation(problem))
    world.synchronise()
    start, audit = _Start(world), Audit(world)
    off = np.zeros(3)
    rate, _ = fastest_force(world)
    deepest = 0.0
    with np.errstate(all="ignore"):
        for sampled in _moments(world, problem):
            if problem.touches:
                deepest = max(deepest, world.contacts.max_penetration)
            if sampled:
                off = np.maximum(off, start.departures(world, problem))
                audit.sample(world)
                rate = max(rate, fastest_force(world)[0])
    energy, momentum, spin = off.tolist()
    if problem.exact_energy is not None or "energy" in problem.keeps:
        row.energy_drift = start.share(energy)
    row.energy_numerical = audit.error
    row.momentum_error = momentum if "momentum" in problem.keeps else None
    row.angular_momentum_error = spin if "angular_momentum" in problem.keeps else None
    if row.dt is not None and rate > 0.0:
        row.omega_max_dt = rate * row.dt
    if problem.touches:
        row.max_penetration = deepest
    if problem.collisions is not None:
        row.collision_count_error = world.collisions - problem.collisions


def _moments(world: World, problem: Problem) -> Iterator[bool]:
    """Advance to the end, yielding after each stretch whether it is one of the random moments."""
    random = np.random.default_rng(_SEED)
    if world.plan.integrator.chooses_steps:
        for t in (*np.sort(random.uniform(0.0, problem.seconds, _SAMPLES)).tolist(), problem.seconds):
            if t > world.time:
                world.run(seconds=t - world.time)
                yield True
        return
    steps = max(1, round(problem.seconds / world.simulation.dt))
    chosen = {*random.integers(1, steps + 1, _SAMPLES).tolist(), steps}
    if problem.touches:
        for done in world.stepping(steps=steps):
            yield done in chosen
        return
    done = 0
    for target in sorted(chosen):
        world.run(steps=target - done)
        done = target
        yield True


class _Start:
    """Energy and momenta of a world at the start, and departures from them."""

    def __init__(self, world: World) -> None:
        self._energy, self._momentum = measure_energy(world), measure_momentum(world)
        self._fastest = self._energy.kinetic

    def departures(self, world: World, problem: Problem) -> tuple[float, float, float]:
        """Return how far energy [J], momentum and angular momentum [shares] are from what they should be."""
        energy, momentum = measure_energy(world), measure_momentum(world)
        self._fastest = max(self._fastest, energy.kinetic)
        exact = problem.exact_energy
        true = self._energy.total if exact is None else exact(world.time)
        rows = world.batch(Transform, Velocity, Mass).rows
        mass, linear = world.table(Mass)["mass"][rows], world.table(Velocity)["linear"][rows]
        each = mass * np.hypot(linear[:, 0], linear[:, 1])
        place = world.table(Transform)["position"][rows]
        swings = each * np.hypot(place[:, 0], place[:, 1])
        return (
            abs(energy.total - true),
            _share(abs(momentum.linear - self._momentum.linear), float(each.sum())),
            _share(abs(momentum.angular - self._momentum.angular), float(swings.sum())),
        )

    def share(self, energy: float) -> float:
        """Return an energy as a share of that at the start."""
        return _share(energy, abs(self._energy.total) or self._fastest)


def _share(part: float, whole: float) -> float:
    return part / whole if whole > 0.0 else part


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
