"""How well energy and momenta are conserved: measured at random times of a run that is not timed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from physicslab.components import Mass, Transform, Velocity
from physicslab.diagnostics.audit import Audit
from physicslab.diagnostics.energy import measure_energy, measure_momentum
from physicslab.diagnostics.forces import fastest_force
from physicslab.lab.accuracy.problem import Problem
from physicslab.lab.accuracy.settings import Setting
from physicslab.world import World

__all__ = ["Watched", "watch"]

_SAMPLES = 48
_SEED = 20260101


@dataclass(slots=True)
class Watched:
    """The largest departures; ``None`` for what the problem does not conserve.

    Attributes
    ----------
    energy : float, optional
        |E - E_true| as a share of |E| at the start (of the largest kinetic energy, where that is 0). E_true
        is the energy at the start, or where friction, drag or a damper acts the exact energy at that time.
    numerical : float, optional
        What no account explains of the energy, as a share of the energy exchanged.
    momentum, angular_momentum : float, optional
        As shares of the sum of the bodies' own.
    rate_dt : float, optional
        The fastest rate [rad/s] of any force times the method's step, where that is fixed.
    penetration : float, optional
        The deepest overlap after any step [m].
    collisions : int, optional
        How many impacts were counted beyond the right number; negative where some are missing.
    """

    energy: float | None = None
    numerical: float | None = None
    momentum: float | None = None
    angular_momentum: float | None = None
    rate_dt: float | None = None
    penetration: float | None = None
    collisions: int | None = None


def watch(problem: Problem, setting: Setting) -> Watched:
    """Run a problem once more, and measure it at random times."""
    world = problem.build(setting.simulation(problem))
    world.synchronise()
    seen, watched, audit = _Conserved(world), Watched(), Audit(world)
    energy, momentum, spin = 0.0, 0.0, 0.0
    rate, _ = fastest_force(world)
    deepest = 0.0
    with np.errstate(all="ignore"):
        for sampled in _moments(world, problem):
            if problem.touches:
                deepest = max(deepest, world.contacts.max_penetration)
            if sampled:
                off = seen.measure(world, problem)
                audit.sample(world)
                energy, momentum, spin = (
                    float(np.maximum(*pair)) for pair in zip((energy, momentum, spin), off, strict=True)
                )
                rate = max(rate, fastest_force(world)[0])
    if problem.exact_energy is not None or "energy" in problem.keeps:
        watched.energy = seen.share(energy)
    watched.numerical = audit.error
    watched.momentum = momentum if "momentum" in problem.keeps else None
    watched.angular_momentum = spin if "angular_momentum" in problem.keeps else None
    method = world.plan
    if not method.integrator.chooses_steps and rate > 0.0:
        watched.rate_dt = rate * world.simulation.dt / method.substeps
    if problem.touches:
        watched.penetration = deepest
    if problem.collisions is not None:
        watched.collisions = world.collisions - problem.collisions
    return watched


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


class _Conserved:
    """Energy and momenta of a world at the start, and departures from them."""

    def __init__(self, world: World) -> None:
        self._energy, self._momentum = measure_energy(world), measure_momentum(world)
        self._fastest = self._energy.kinetic

    def measure(self, world: World, problem: Problem) -> tuple[float, float, float]:
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
