"""Which method follows the forces of a world, in how many steps, and to which tolerance."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.sentences import sentence
from physicslab.integrators.blanes_moan import BLANES_MOAN
from physicslab.integrators.dop853 import DOP853
from physicslab.integrators.exact import EXACT
from physicslab.integrators.implicit_midpoint import IMPLICIT_MIDPOINT
from physicslab.integrators.leapfrog import LEAPFROG, LEAPFROG_WITH_SPLIT_FORCES
from physicslab.integrators.rk4 import RK4
from physicslab.integrators.spring_splitting import SPRING_SPLITTING
from physicslab.languages.sentence import Sentence
from physicslab.ode.closed_form import NoClosedForm, closed_form
from physicslab.state.packed import spring_rates
from physicslab.state.state import State
from physicslab.stepping.forces import MAX_STEPS, fastest_rate, steps_needed
from physicslab.stepping.plan import StepPlan
from physicslab.stepping.split_forces import depends_on_velocity_in_python, sub_integrated_rows
from physicslab.stepping.spring_flow import why_no_spring_flow
from physicslab.stepping.spring_groups import spring_groups
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.schedule import Schedule
from physicslab.systems.spring import SpringSystem
from physicslab.systems.system import ForceSystem

_SAMPLED_LIMIT = 200
"""Number of attracting bodies from which sampling their forces takes longer than the accuracy is worth."""
_CROWD, _RESOLVED_IN_CROWDS = 32, 0.2
"""Number of molecules from which on ``auto`` keeps their energy by leapfrog, and omega h of its steps: the
energy of 1,000 that collide at once swings by 1e-4 of what is exchanged."""
_MANY, _FEW_STEPS = 100, 2
"""Number of bodies from which on ``rk4`` follows forces by velocities beside contacts, if in so few steps:
300 that float exchange 4e5 J with an error of 0.2 J, in a third of the time of ``dop853``."""
_STIFF = 1.0
"""omega dt of springs from which damped motion at the default tolerance costs more than anything can show."""
_OF_STIFF = 1e-13
"""Tolerance of dop853 there. A chain of 19 bodies on springs of 1e4 N/m and dampers is then 2e-13 m off after
2 s, as good as at 1e-17 with an eighth of the evaluations; 1e-10 takes 0.4 times as many, for 3e-11 m."""
_OF_JOINED = 1e-15
"""The same for what joints hold. Their equations are rounded to 1e-16 in each evaluation: a double pendulum
is 1e-15 m off after 2 s, at 1e-17 too, with 1.75 times as many evaluations."""
_OF_OVERDAMPED = 1e-9
"""The same where every stiff spring is damped far beyond the critical rate: what errs dies out. Chains of 19
bodies at 100 to 10^6 N/m and damping ratios from 1.5 on are then 6e-12 m off at most after 2 s, in 1.0 to 2.5
times the time of the cheapest method that reaches 1e-10 m; 1e-13 takes 5 to 15 times as long."""
_OVERDAMPED = 1.4
"""The damping ratio from which that holds."""


def _in_python(state: State, schedule: Schedule) -> StepPlan:
    """Return the method for a world in which nothing but forces acts, of which Python computes some."""
    substeps, name = state.simulation.substeps, schedule.interpreted[0]
    if _depends_on_velocity(state, schedule.smooth_forces):
        reason = sentence("velocity_may_matter_in_python", system=name)
        return StepPlan(DOP853, reason, 1, smooth=True)
    return StepPlan(LEAPFROG, sentence("in_python", system=name), substeps, smooth=True)


def best_method(state: State, schedule: Schedule) -> StepPlan:
    """Return the method for a world in which nothing but forces acts."""
    substeps, h = state.simulation.substeps, state.simulation.dt
    forces = schedule.smooth_forces
    python = schedule.interpreted
    if len(state.joints):
        joined = sentence("joint_equations", count=len(state.joints))
        return StepPlan(DOP853, joined, 1, smooth=True)
    if python:
        return _in_python(state, schedule)
    try:
        forces_alone = closed_form(state, schedule.smooth_forces).what
        return StepPlan(EXACT, sentence("closed_form", forces=forces_alone), 1, smooth=True)
    except NoClosedForm as error:
        (why,) = error.args
    attractors = max((force.attractors for force in forces), default=0)
    planets = attractors > 1
    rate = fastest_rate(state, [force for force in forces if not force.attractors > 1])
    needed, crowd = steps_needed(rate, h), max((force.crowd for force in forces), default=0)
    if needed > MAX_STEPS and not crowd:  # no rule that steps over it makes molecules bounce
        return StepPlan(IMPLICIT_MIDPOINT, _too_fast(rate), substeps, smooth=True)
    if planets and attractors >= _SAMPLED_LIMIT and state.physics.softening > 0.0:
        return StepPlan(LEAPFROG, sentence("softened", count=attractors), substeps, smooth=True)
    if planets:
        return StepPlan(DOP853, sentence("step_follows", why=_why_singular(state, forces)), 1, smooth=True)
    if crowd >= _CROWD and not _depends_on_velocity(state, forces):
        needed = steps_needed(rate, h, _RESOLVED_IN_CROWDS)
        how = sentence("molecules", count=crowd, steps=needed, phase=f"{rate * h / needed:.2g}")
        return StepPlan(LEAPFROG, how, needed, smooth=True)
    if _depends_on_velocity(state, forces):
        tolerance = sentence("tolerance", value=f"{tolerance_for(state, forces):.0e}")
        return StepPlan(DOP853, sentence("velocity_forces", why=why, tolerance=tolerance), 1, smooth=True)
    singular = _why_singular(state, forces)
    if singular is not None:
        return StepPlan(DOP853, sentence("step_follows_it", why=singular), 1, smooth=True)
    kind = sentence("conservative")
    if any(force.depends_on_time(state) for force in forces):
        kind = sentence("by_places_and_time")
    phase = f"{rate * h / needed:.2g}"
    how = sentence("steps_of", why=kind, steps=needed, phase=phase)
    return StepPlan(BLANES_MOAN, how, needed, smooth=True)


def method_beside_contacts(state: State, schedule: Schedule, obstacle: str) -> StepPlan:
    """Return the plan where more than forces acts within a step: kicks, or sub-integrated bodies.

    Only the stages of leapfrog can be combined with a flow.
    """
    substeps = state.simulation.substeps
    kicks = StepPlan(LEAPFROG, obstacle, substeps, smooth=False, obstacle=obstacle)
    forces = schedule.forces
    moved = schedule.find(IntegrateSystem) is not None
    rows = sub_integrated_rows(state, forces)
    followed_rows = np.count_nonzero(rows)
    if not moved or not followed_rows:
        return kicks
    python = schedule.interpreted
    followed = any(depends_on_velocity_in_python(state, force) for force in forces)
    if python and not followed:
        return replace(kicks, reason=sentence("and_in_python", obstacle=obstacle, system=python[0]))
    attractors = max((force.attractors for force in forces), default=0)
    turned = any(force.gyration(state) is not None for force in forces)
    if attractors >= _SAMPLED_LIMIT and not turned:
        return kicks
    rate, half = fastest_rate(state, forces), 0.5 * state.simulation.dt / substeps
    needed = steps_needed(rate, half)
    groups = spring_groups(state, forces, rows) if why_no_spring_flow(state, forces) is None else []
    beyond = IMPLICIT_MIDPOINT if groups and not groups[-1].steps else None
    if groups and groups[0].steps:
        method, needed = SPRING_SPLITTING, max(group.steps for group in groups)
        phase = max(group.rate * half / group.steps for group in groups if group.steps)
        how = sentence("resolved_springs", phase=f"{phase:.2g}", method=DOP853.name)
        if beyond is not None:
            how = sentence("both", one=how, other=sentence("beyond", method=beyond.name, why=_too_fast(rate)))
    elif groups or needed * 2 * substeps > MAX_STEPS:
        method, needed, beyond, how = IMPLICIT_MIDPOINT, 1, None, _too_fast(rate)
    elif followed:
        method, how = RK4, sentence("velocity_in_python", system=python[0])
    elif turned and not _depends_on_velocity(
        state, [force for force in forces if force.gyration(state) is None]
    ):
        method = BLANES_MOAN if attractors < _SAMPLED_LIMIT else LEAPFROG
        how = sentence("magnetic", phase=f"{rate * half / needed:.2g}")
    elif max(force.crowd for force in forces) >= _CROWD and not _depends_on_velocity(state, forces):
        method, needed = LEAPFROG, steps_needed(rate, half, _RESOLVED_IN_CROWDS)
        how = sentence("many_molecules", steps=needed, phase=f"{rate * half / needed:.2g}")
    elif attractors > 1 or _depends_on_velocity(state, forces) or _why_singular(state, forces):
        method, how = DOP853, sentence("follows_motion")
        bends = all(force.bends or force.why_singular(state) is None for force in forces)
        if attractors < 2 and bends and followed_rows >= _MANY and needed <= _FEW_STEPS:
            method, how = RK4, sentence("many_followed", phase=f"{rate * half / needed:.2g}")
        else:
            needed = 1
    else:
        method, how = BLANES_MOAN, sentence("resolved", phase=f"{rate * half / needed:.2g}")
    moved_by = sentence("all_bodies") if followed else sentence("sprung_bodies")
    moved_by = sentence("charges_alone") if turned and not python else moved_by
    reason = sentence("beside_contacts", obstacle=obstacle, bodies=moved_by, method=method.name, how=how)
    return replace(
        kicks, reason=reason, stages=LEAPFROG_WITH_SPLIT_FORCES, split_forces=method, split_steps=needed,
        beyond=beyond,
    )  # fmt: skip


def tolerance_for(state: State, forces: Sequence[ForceSystem]) -> float:
    """Return the tolerance of a method that chooses its steps.

    It is the configured one; but ``auto`` takes a larger one than the default for joints, for forces that
    are rounded more than others, and for stiff springs in damped motion. It depends on no position or
    velocity: a loaded scene has the same.
    """
    simulation = state.simulation
    rates = [force.strongest_rate(state) for force in forces if isinstance(force, SpringSystem)]
    stiff = max(rates, default=0.0) * simulation.dt > _STIFF and _depends_on_velocity(state, forces)
    chosen = simulation.integrator == "auto" and simulation.tolerance == SimulationConfig().tolerance
    planets = any(force.attractors > 1 for force in forces)
    finest = max((force.rounding for force in forces), default=0.0) if chosen else 0.0
    if not chosen or planets or not (stiff or len(state.joints)):
        return max(simulation.tolerance, finest)
    if not stiff:
        return max(_OF_JOINED, finest)
    return _OF_OVERDAMPED if _is_overdamped(state) else _OF_STIFF


def _is_overdamped(state: State) -> bool:
    """Whether each stiff spring is damped far beyond the rate at which it would stop to oscillate."""
    _, rate, decay = spring_rates(state)
    stiff = np.maximum(rate, decay) * state.simulation.dt > _STIFF
    return bool(stiff.any() and (decay[stiff] >= 2.0 * _OVERDAMPED * rate[stiff]).all())


def _why_singular(state: State, forces: Sequence[ForceSystem]) -> str | None:
    return next((why for force in forces if (why := force.why_singular(state)) is not None), None)


def _depends_on_velocity(state: State, forces: Sequence[ForceSystem]) -> bool:
    turns = state.physics.angular_damping > 0.0 and any(len(force.turned(state)) for force in forces)
    return (
        state.physics.linear_damping > 0.0
        or turns
        or any(force.depends_on_velocity(state) for force in forces)
    )


def _too_fast(rate: float) -> Sentence:
    return sentence("too_fast", rate=f"{rate:.3g}")
