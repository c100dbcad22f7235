"""How a problem is computed: which method, and how finely."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from physicslab.ecs.config import SimulationConfig
from physicslab.integrators import Integrator
from physicslab.lab.accuracy.problem import Problem
from physicslab.systems.system import ForceSystem

__all__ = ["Setting", "ladder", "refusal", "sees_velocity"]

_TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-15, 1e-16, 1e-17)
_SUBSTEPS = 4
"""Parts of a step where bodies touch: those of every scene that says nothing else."""
_MOST_WORK = 1e7
"""Force evaluations that one rung may take."""
_STIFF_REACH = 6.0
"""Rate times step [rad] beyond which an explicit adaptive method is no longer stable."""


@dataclass(frozen=True, slots=True)
class Setting:
    """A method, and how finely it is used.

    Attributes
    ----------
    integrator : str
        Its name, or ``"auto"``.
    steps : int, optional
        Into how many the time is divided; ``None`` for a method that needs no telling.
    tolerance : float, optional
        Of an adaptive method.
    collisions : str
        How contacts are found.
    """

    integrator: str
    steps: int | None = None
    tolerance: float | None = None
    collisions: str = "auto"

    def simulation(self, problem: Problem) -> SimulationConfig:
        """Return the configuration of the problem's world; nobody sleeps: errors are the method's."""
        if self.integrator == "auto":
            return SimulationConfig(dt=problem.dt, sleeping=False)
        tolerance = self.tolerance or SimulationConfig().tolerance
        parts = _SUBSTEPS if problem.touches else 1
        dt = problem.seconds * parts / (self.steps or 1)
        return SimulationConfig(
            dt=dt, substeps=parts, integrator=self.integrator, tolerance=tolerance,
            sleeping=False, collisions=self.collisions,
        )  # fmt: skip


def refusal(problem: Problem, method: Integrator) -> str:
    """Return why a method is not used on a problem; empty if it is."""
    if method.name in problem.not_asked:
        return problem.not_asked[method.name]
    world = problem.build(SimulationConfig(dt=problem.dt, integrator=method.name))
    world.synchronise()
    if world.plan.refused:
        return world.plan.refused
    if method.chooses_steps and method.evaluations:
        rate = max((system.strongest_rate(world) for system in world.schedule.running
                    if isinstance(system, ForceSystem)), default=0.0)  # fmt: skip
        work = problem.seconds * rate * method.evaluations / _STIFF_REACH
        if work > _MOST_WORK:
            return f"an explicit method would take about {work:.0e} force evaluations to stay bounded"
    return ""


def ladder(problem: Problem, method: Integrator) -> Iterator[Setting]:
    """Yield the rungs of a method, from coarse to fine."""
    if not method.evaluations:
        yield Setting(method.name)
    elif method.chooses_steps:
        for tolerance in _TOLERANCES:
            yield Setting(method.name, tolerance=tolerance)
    else:
        # Located impacts have no step: they come with the closed form, or with auto.
        collisions = "step" if problem.touches else "auto"
        for steps in problem.ladder.steps(method.evaluations):
            yield Setting(method.name, steps, collisions=collisions)


def sees_velocity(problem: Problem) -> bool:
    """Whether forces in a problem hang on velocities."""
    world = problem.build(SimulationConfig(dt=problem.dt))
    world.synchronise()
    forces = [system for system in world.schedule.running if isinstance(system, ForceSystem)]
    return any(force.sees_velocity(world) for force in forces)
