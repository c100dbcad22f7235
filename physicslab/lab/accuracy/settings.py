"""How a problem is computed: which method, and how finely."""

from collections.abc import Iterator
from dataclasses import dataclass

from physicslab.diagnostics.step_warnings import fastest_force
from physicslab.ecs.config import SimulationConfig
from physicslab.integrators import Integrator
from physicslab.lab.accuracy.problem import Problem

_TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-15, 1e-16, 1e-17)
_SUBSTEPS = 4
"""Parts of a step where bodies touch: the default of scenes."""
_EVALUATIONS_LIMIT = 1e7
"""Force evaluations that one rung may take."""
_STIFF_LIMIT = 6.0
"""Rate times step [rad] beyond which an explicit adaptive method is no longer stable."""


@dataclass(frozen=True, slots=True)
class Setting:
    """A method, and how finely it is used.

    Attributes
    ----------
    integrator : str
        Its name, or ``"auto"``.
    steps : int, optional
        Into how many the time is divided; ``None`` for a method that chooses its steps.
    tolerance : float, optional
        Of an adaptive method.
    collisions : str
        How contacts are found.
    contacts : str
        How bodies that touch are held apart, with ``"auto"``.
    """

    integrator: str
    steps: int | None = None
    tolerance: float | None = None
    collisions: str = "auto"
    contacts: str = "auto"

    def simulation(self, problem: Problem) -> SimulationConfig:
        """Return the configuration of the problem's world, in which nothing sleeps.

        A method of fixed steps has soft contacts: rigid ones choose their steps.
        """
        if self.integrator == "auto":
            return SimulationConfig(dt=problem.dt, sleeping=False, contacts=self.contacts)
        tolerance = self.tolerance or SimulationConfig().tolerance
        parts = _SUBSTEPS if problem.touches else 1
        dt = problem.seconds * parts / (self.steps or 1)
        return SimulationConfig(
            dt=dt, substeps=parts, integrator=self.integrator, tolerance=tolerance,
            sleeping=False, collisions=self.collisions, contacts="soft",
        )  # fmt: skip


def refusal(problem: Problem, method: Integrator) -> str:
    """Return why a method is not used on a problem; empty if it is."""
    if method.name in problem.not_used:
        return problem.not_used[method.name]
    world = problem.build(SimulationConfig(dt=problem.dt, integrator=method.name))
    world.synchronise()
    if world.plan.refused:
        return world.plan.refused
    if method.chooses_steps and method.evaluations:
        rate, _ = fastest_force(world)
        work = problem.seconds * rate * method.evaluations / _STIFF_LIMIT
        if work > _EVALUATIONS_LIMIT:
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
    """Whether forces in a problem depend on velocities."""
    world = problem.build(SimulationConfig(dt=problem.dt))
    world.synchronise()
    return any(force.sees_velocity(world) for force in world.schedule.forces)
