"""Which plan advances a world, by what it holds, its configuration and its state of motion."""

from dataclasses import replace

from physicslab.ecs.sentences import sentence
from physicslab.integrators import INTEGRATORS, SPLIT_METHODS
from physicslab.integrators.blanes_moan import BLANES_MOAN
from physicslab.integrators.dop853 import DOP853
from physicslab.integrators.exact import EXACT
from physicslab.integrators.implicit_midpoint import IMPLICIT_MIDPOINT
from physicslab.integrators.leapfrog import LEAPFROG, LEAPFROG_WITH_SPLIT_FORCES
from physicslab.integrators.rk4 import RK4
from physicslab.integrators.spring_splitting import SPRING_SPLITTING
from physicslab.ode.closed_form import NoClosedForm, closed_form
from physicslab.state.masses import quiet
from physicslab.state.state import State
from physicslab.stepping.ballistic import why_not_exact, why_not_worthwhile
from physicslab.stepping.contact_model import choose_contacts
from physicslab.stepping.method import best_method, method_beside_contacts
from physicslab.stepping.plan import ASKED_FOR, EVENTS_WITHOUT_END, WITHOUT_END, StepPlan, default_plan
from physicslab.systems.accelerate import AccelerateSystem
from physicslab.systems.integrate import IntegrateSystem, why_nowhere
from physicslab.systems.schedule import Schedule
from physicslab.systems.system import ForceSystem, Stage

_FOLLOWING = (BLANES_MOAN.name, DOP853.name, IMPLICIT_MIDPOINT.name, SPRING_SPLITTING.name)
"""The methods that ``auto`` chooses by the state of motion."""


def choose_plan(state: State, schedule: Schedule, kept: str | None = None) -> StepPlan:
    """Return the method for what a world holds, or the configured one if it can advance it.

    ``kept`` is how collisions were found when ``auto`` chose for an earlier state of motion, if it did.
    """
    if not schedule.runs(Stage.CONTACT):
        joint = state.joints.why_not_smooth()
        return _mover(state, schedule) if joint is None else _bounded(state, schedule, kept)
    contacts, reason = choose_contacts(state, schedule, kept)
    plan = _plan_of_collisions(state, schedule, "step" if kept == "rigid" else kept)
    if contacts == "rigid" and (state.simulation.contacts == "rigid" or plan.collisions == "step"):
        # The rest of the plan is for steps that are left to soft contacts.
        own = sentence("own_events")
        bounced = plan.collisions == "step" and plan.collision_reason != ASKED_FOR
        own = sentence("both", one=plan.collision_reason, other=own) if bounced else own
        plan = replace(
            _mover(state, schedule), integrator=DOP853, reason=sentence("rigid_events"),
            collisions="step", collision_reason=own,
        )  # fmt: skip
    return replace(plan, contacts=contacts, contact_reason=reason)


def _bounded(state: State, schedule: Schedule, kept: str | None) -> StepPlan:
    """Return the method where nothing can touch, and joints have limits or motors that may stall."""
    contacts, reason = choose_contacts(state, schedule, kept)
    plan = replace(_mover(state, schedule), contacts=contacts, contact_reason=reason)
    if contacts == "soft":
        return plan
    return replace(plan, integrator=DOP853, reason=sentence("joint_limits"))


def _plan_of_collisions(state: State, schedule: Schedule, kept: str | None) -> StepPlan:
    """Return the method where bodies can touch, and how their collisions are found."""
    wish = state.simulation.collisions
    if wish == "auto" and kept in ("exact", "step"):
        wish = kept
    if wish == "step":
        return replace(_mover(state, schedule), collisions="step", collision_reason=ASKED_FOR)
    obstacle = why_not_exact(state, schedule)
    if wish == "exact":
        if obstacle is not None:
            reason = sentence("exact_refused", obstacle=obstacle)
            return replace(_mover(state, schedule), collisions="step", collision_reason=reason)
        return _event_driven_plan(state, ASKED_FOR)
    obstacle = obstacle or why_not_worthwhile(state, schedule)
    if obstacle is not None:
        return replace(_mover(state, schedule), collisions="step", collision_reason=obstacle)
    return _event_driven_plan(state, sentence("few_bounce"))


def plan_for_jumps(state: State, schedule: Schedule, plan: StepPlan) -> StepPlan:
    """Return the plan with steps of one length, for a force that no method which chooses its steps follows.

    So is dry friction, in Python, of a body that it has stopped: it jumps at every step, however short. So
    are those of joints that contradict each other, or hold a body in a line between fixed points, and rigid
    contacts of what is wedged: soft ones give a little.
    """
    if len(state.joints) or plan.contacts == "rigid":
        end = WITHOUT_END if len(state.joints) else EVENTS_WITHOUT_END
        plan = method_beside_contacts(state, schedule, why_not_smooth(state, schedule) or end)
        touch = "step" if schedule.runs(Stage.CONTACT) else "none"
        return replace(plan, collisions=touch, collision_reason=end, contacts="soft", contact_reason=end)
    reason = sentence("jumps_in_python", system=schedule.interpreted[0])
    return replace(plan, integrator=RK4, substeps=state.simulation.substeps, reason=reason)


@quiet
def outlived(state: State, schedule: Schedule, plan: StepPlan) -> tuple[str, str, int] | None:
    """Return ``plan.kept`` where the world would not choose so any more, in its present state of motion.

    A plan holds until the motion is edited: whether bodies rest, how fast drag slows them and whether a
    spring may be compressed to nothing are judged once.
    """
    return None if choose_plan(state, schedule).kept == plan.kept else plan.kept


def resumed_plan(state: State, schedule: Schedule, kept: tuple[str, str, int]) -> StepPlan:
    """Return the plan with what was ``kept`` of an earlier one, where it can advance the world."""
    collisions, method, steps = kept
    plan = choose_plan(state, schedule, collisions)
    if plan.smooth and collisions == "step" and len(state.joints):
        return plan_for_jumps(state, schedule, plan)
    if plan.kept == kept or plan.integrator.name == state.simulation.integrator:
        return plan
    reason = sentence("chosen_before", method=method)
    if plan.split_forces is not None and method in _FOLLOWING:
        chosen, beyond = SPLIT_METHODS[method], plan.beyond if method == SPRING_SPLITTING.name else None
        return replace(plan, split_forces=chosen, split_steps=steps, beyond=beyond, reason=reason)
    if plan.smooth and method in INTEGRATORS and (method in _FOLLOWING or method == LEAPFROG.name):
        return replace(plan, integrator=INTEGRATORS[method], substeps=steps, reason=reason)
    return plan


def _event_driven_plan(state: State, reason: str) -> StepPlan:
    """Return the plan for bodies whose collisions are exact."""
    method = sentence("closed_form_between_impacts")
    return StepPlan(
        EXACT, method, state.simulation.substeps, smooth=False, collisions="exact", collision_reason=reason
    )


def _mover(state: State, schedule: Schedule) -> StepPlan:
    """Return what moves bodies where collisions, if there are any, are found within steps."""
    simulation = state.simulation
    obstacle = why_not_smooth(state, schedule)
    if simulation.integrator == "auto":
        if obstacle is not None:
            return method_beside_contacts(state, schedule, obstacle)
        return best_method(state, schedule)
    choice = default_plan(simulation)
    method = choice.integrator
    if obstacle is not None:
        if not method.substep:
            reason = sentence("forces_alone", method=method.name, obstacle=obstacle)
            choice = StepPlan(LEAPFROG, reason, simulation.substeps, smooth=False, refused=reason)
        if any(force.gyration(state) is not None for force in schedule.forces):
            stages, own = LEAPFROG_WITH_SPLIT_FORCES, choice.integrator
            return replace(choice, obstacle=obstacle, stages=stages, split_forces=own, split_steps=1)
        return replace(choice, obstacle=obstacle)
    if method is EXACT:
        try:
            closed_form(state, schedule.smooth_forces)
        except NoClosedForm as error:
            reason = sentence("no_closed_form", why=error.args[0])
            return replace(best_method(state, schedule), reason=reason, refused=reason)
    return replace(choice, substeps=1 if method.chooses_steps else simulation.substeps, smooth=True)


_WITHIN = {Stage.FORCE, Stage.KICK, Stage.DRIFT}
"""Stages within the substeps of a world in which nothing touches."""


def why_not_smooth(state: State, schedule: Schedule) -> str | None:
    """Return what acts on bodies within a step besides forces, or ``None``."""
    if schedule.runs(Stage.BROAD_PHASE) or schedule.runs(Stage.CONTACT):
        return sentence("can_touch")
    if schedule.find(IntegrateSystem) is None:
        return sentence("nothing_integrates")
    for system in schedule.running:
        stages = type(system).marked().keys() & _WITHIN
        if isinstance(system, ForceSystem):
            stages -= {Stage.FORCE}
        if stages and type(system) not in (AccelerateSystem, IntegrateSystem):  # a subclass may do other work
            return sentence("acts_within_step", system=system.name)
    return why_nowhere(state) or state.joints.why_not_smooth()
