"""Which method moves a world, and why."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from physicslab.integrators import INTEGRATORS, Integrator
from physicslab.integrators.blanes_moan import BLANES_MOAN
from physicslab.integrators.dop853 import DOP853
from physicslab.integrators.exact import EXACT
from physicslab.integrators.implicit_midpoint import IMPLICIT_MIDPOINT
from physicslab.integrators.leapfrog import LEAPFROG, LEAPFROG_WITH_SPLIT_FORCES
from physicslab.ode.closed_form import NoClosedForm, closed_form
from physicslab.ode.system import why_not_smooth
from physicslab.stepping.event_driven_limits import why_not_exact, why_not_worthwhile
from physicslab.stepping.split_rows import sub_integrated_rows
from physicslab.systems.schedule import ForceSystem, Stage

if TYPE_CHECKING:
    from physicslab.ecs.config import SimulationConfig
    from physicslab.world import World

__all__ = ["StepPlan", "choose", "default_plan"]

_MANY = 200
"""From so many attracting bodies on, sampling their forces costs more than accuracy is worth."""
_WELL_RESOLVED = 0.5
"""omega h that blanes_moan is given: beyond about 1 its order does not show."""
_MOST_STEPS = 1000
"""Into how many steps a step of the world may be divided of the method's own accord."""


@dataclass(frozen=True, slots=True)
class StepPlan:
    """A method, and why it.

    Attributes
    ----------
    integrator : Integrator
        The method.
    reason : str
        Why, for people.
    substeps : int
        Steps of the method a step of the world; 1 for one that chooses its steps itself.
    smooth : bool
        Whether nothing but forces acts, so that the method's flow advances the world.
    refused : str
        Why it is not the one that was asked for; empty if it is.
    collisions : str
        ``"exact"`` (contact times located, flights in between in closed form), ``"step"`` (found and resolved
        within steps) or ``"none"`` (nothing can touch).
    collision_reason : str
        Why so, for people.
    stages : Integrator
        The method by whose stages the contact step goes; where collisions are exact, only for what rests.
    split_forces : Integrator, optional
        What moves the bodies that springs and drag act on between contacts; ``None`` where kicks do.
    split_steps : int
        Its steps each half substep.
    """

    integrator: Integrator
    reason: str
    substeps: int
    smooth: bool
    refused: str = ""
    collisions: str = "none"
    collision_reason: str = "nothing can touch"
    stages: Integrator = LEAPFROG
    split_forces: Integrator | None = None
    split_steps: int = 1


def default_plan(simulation: SimulationConfig) -> StepPlan:
    """Return the choice for a world of which nothing is known yet."""
    name = simulation.integrator
    if name == "auto":
        return StepPlan(LEAPFROG, "nothing moves", simulation.substeps, smooth=False)
    method = INTEGRATORS[name]
    stages = method if method.substep else LEAPFROG
    return StepPlan(method, "asked for", simulation.substeps, smooth=False, stages=stages)


def choose(world: World) -> StepPlan:
    """Return the method for what a world holds, or the one that its configuration asks for if it can."""
    if not world.schedule.runs(Stage.CONTACT):
        return _mover(world)
    wish = world.simulation.collisions
    if wish == "step":
        return replace(_mover(world), collisions="step", collision_reason="asked for")
    obstacle = why_not_exact(world)
    if wish == "exact":
        if obstacle is not None:
            reason = f"exact was asked for, and {obstacle}"
            return replace(_mover(world), collisions="step", collision_reason=reason)
        return _flights(world, "asked for")
    obstacle = obstacle or why_not_worthwhile(world)
    if obstacle is not None:
        return replace(_mover(world), collisions="step", collision_reason=obstacle)
    return _flights(world, "few bodies, which bounce")


def _flights(world: World, reason: str) -> StepPlan:
    """Return the choice for bodies whose collisions are exact."""
    method = "between impacts bodies fly in closed form; what rests goes by leapfrog"
    return StepPlan(
        EXACT, method, world.simulation.substeps, smooth=False, collisions="exact", collision_reason=reason
    )


def _mover(world: World) -> StepPlan:
    """Return what moves bodies where collisions, if there are any, are found within steps."""
    simulation = world.simulation
    obstacle = why_not_smooth(world)
    if simulation.integrator == "auto":
        if obstacle is not None:
            return _beside_contacts(world, obstacle)
        return _best(world)
    choice = default_plan(simulation)
    method = choice.integrator
    if obstacle is not None:
        if method.substep:
            return choice
        reason = f"{method.name} was asked for, which advances bodies under forces alone, and {obstacle}"
        return StepPlan(LEAPFROG, reason, simulation.substeps, smooth=False, refused=reason)
    if method is EXACT:
        try:
            closed_form(world)
        except NoClosedForm as error:
            reason = f"exact was asked for, and there is no closed form: {error}"
            return replace(_best(world), reason=reason, refused=reason)
    return replace(choice, substeps=1 if method.chooses_steps else simulation.substeps, smooth=True)


def _best(world: World) -> StepPlan:
    """Return the method for a world in which nothing but forces acts."""
    substeps, h = world.simulation.substeps, world.simulation.dt
    forces = [system for system in world.schedule.running if isinstance(system, ForceSystem)]
    python = [system.name for system in forces if not type(system).packs()]
    if python:
        return StepPlan(LEAPFROG, f"the force of {python[0]} is written in Python", substeps, smooth=True)
    try:
        return StepPlan(EXACT, f"{closed_form(world).what}: solved in closed form", 1, smooth=True)
    except NoClosedForm as error:
        why = str(error)
    attractors = max((getattr(system, "attractors", 0) for system in forces), default=0)
    planets = world.physics.gravity_mode == "planet" and attractors > 1
    rate = _fastest(world, [f for f in forces if not (planets and hasattr(f, "attractors"))])
    needed = _steps(rate, h)
    if needed > _MOST_STEPS:
        return StepPlan(IMPLICIT_MIDPOINT, _too_fast(rate), substeps, smooth=True)
    if planets and attractors >= _MANY and world.physics.softening > 0.0:
        return StepPlan(LEAPFROG, f"{attractors} bodies attract each other, softened", substeps, smooth=True)
    if planets:
        return StepPlan(DOP853, "planets may come close: the step follows them", 1, smooth=True)
    if _sees_velocity(world, forces):
        return StepPlan(DOP853, f"forces hang on velocities, and {why}", 1, smooth=True)
    if any(system.may_be_singular(world) for system in forces):
        return StepPlan(
            DOP853, "a spring may be pressed together to nothing: the step follows it", 1, smooth=True
        )
    reason = f"conservative and smooth; {needed} steps of omega h = {rate * h / needed:.2g}"
    return StepPlan(BLANES_MOAN, reason, needed, smooth=True)


def _beside_contacts(world: World, obstacle: str) -> StepPlan:
    """Return the choice where more than forces acts within a step: kicks, or a method for what is tethered.

    Other stages than those of leapfrog know of no flow.
    """
    substeps = world.simulation.substeps
    kicks = StepPlan(LEAPFROG, obstacle, substeps, smooth=False)
    forces = [system for system in world.schedule.running if isinstance(system, ForceSystem)]
    moved = any(system.name == "IntegrateSystem" for system in world.schedule.running)
    if not moved or not sub_integrated_rows(world).any():
        return kicks
    python = [system.name for system in forces if not type(system).packs()]
    if python:
        return replace(kicks, reason=f"{obstacle}, and the force of {python[0]} is written in Python")
    planets = world.physics.gravity_mode == "planet"
    if max((getattr(system, "attractors", 0) for system in forces), default=0) >= _MANY and planets:
        return kicks
    rate, half = _fastest(world, forces), 0.5 * world.simulation.dt / substeps
    needed = _steps(rate, half)
    if needed * 2 * substeps > _MOST_STEPS:
        method, needed, how = IMPLICIT_MIDPOINT, 1, _too_fast(rate)
    elif planets or _sees_velocity(world, forces) or any(f.may_be_singular(world) for f in forces):
        method, needed, how = DOP853, 1, "the step follows the motion"
    else:
        method, how = BLANES_MOAN, f"steps of omega h = {rate * half / needed:.2g}"
    reason = f"{obstacle}; between contacts what springs or drag act on goes by {method.name}: {how}"
    return replace(
        kicks, reason=reason, stages=LEAPFROG_WITH_SPLIT_FORCES, split_forces=method, split_steps=needed
    )


def _fastest(world: World, forces: list[ForceSystem]) -> float:
    """Return the fastest rate that forces and damping give any body [rad/s]."""
    rate = max((system.strongest_rate(world) for system in forces), default=0.0)
    return max(rate, world.physics.linear_damping, world.physics.angular_damping)


def _steps(rate: float, h: float) -> int:
    """Return into how many steps a time h must be divided for a rate, of no more than need be told apart."""
    phase = rate * h / _WELL_RESOLVED
    return max(1, math.ceil(phase)) if phase <= _MOST_STEPS else _MOST_STEPS + 1


def _sees_velocity(world: World, forces: list[ForceSystem]) -> bool:
    return world.physics.linear_damping > 0.0 or any(system.sees_velocity(world) for system in forces)


def _too_fast(rate: float) -> str:
    return f"{rate:.3g} rad/s is too fast to be followed: what it does between steps is not shown"
