"""Which worlds can have rigid contacts, and limits and motors with a largest force beside them or alone."""

from physicslab.components import Mass, Shape, Transform, Velocity
from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.sentences import sentence
from physicslab.state.state import State
from physicslab.stepping.ballistic import CONTACT_STEP, count_pairs
from physicslab.stepping.forces import fastest_rate
from physicslab.stepping.rigid_rows import why_not_points
from physicslab.systems.integrate import IntegrateSystem, why_nowhere
from physicslab.systems.schedule import Schedule
from physicslab.systems.system import ForceSystem, Stage

_MAX_PAIRS = 10_000
"""Number of pairs above which contacts are soft: each is looked at in every segment of motion."""
_MAX_BODIES = 12
"""Number of bodies above which ``auto`` takes soft contacts: a step of rigid ones could last for 20 ms."""
_MAX_RATE = 8.0
"""Largest rate of springs and dampers times the step with which ``auto`` takes rigid contacts."""


def choose_contacts(state: State, schedule: Schedule, kept: str | None = None) -> tuple[str, str]:
    """Return whether contacts are ``"rigid"`` or ``"soft"``, and the reason.

    ``kept`` is how collisions were found when ``auto`` chose for an earlier state of motion, if it did.
    """
    wish = state.simulation.contacts
    if wish == "soft":
        return "soft", sentence("asked_for")
    obstacle = why_not_rigid(state, schedule)
    if wish == "rigid":
        why = sentence("asked_for") if obstacle is None else sentence("rigid_refused", obstacle=obstacle)
        return "rigid" if obstacle is None else "soft", why
    obstacle = _why_not_worthwhile(state) or obstacle
    if obstacle is None and kept != "rigid":
        before = sentence("soft_before")
        obstacle = before if kept == "step" else _why_too_fast(state, schedule)
    if obstacle is not None:
        return "soft", obstacle
    joint = state.joints.why_not_smooth()
    return "rigid", sentence("few_touch") if joint is None else sentence("joint_events", joint=joint)


def _why_not_worthwhile(state: State) -> str | None:
    """Return why a world that can have rigid contacts is better off with soft ones, or ``None``.

    A setting that only soft contacts have is not overruled by a default.
    """
    if (asked := _why_overruled(state.simulation)) is not None:
        return asked
    # A body that is held counts: the model must not change when it is let go.
    if len(state.batch(Shape, Transform, Velocity, Mass)) > _MAX_BODIES:
        return sentence("many_touch", limit=_MAX_BODIES)
    if state.joints.why_not_smooth() and len(state.batch(Transform, Velocity, Mass)) > _MAX_BODIES:
        return sentence("many_bodies", limit=_MAX_BODIES)
    return None


def _why_overruled(simulation: SimulationConfig) -> str | None:
    """Return the setting of a simulation that only soft contacts have, or ``None``."""
    if simulation.sleeping is True:
        return sentence("sleeping_asked")
    return sentence("within_steps_asked") if simulation.collisions == "step" else None


def why_all_soft(state: State, schedule: Schedule) -> str | None:
    """Return why what can touch is advanced by the contact step wherever it is, or ``None`` where it may not.

    By settings and systems alone: no island of such a world has a better stepper than another.
    """
    simulation = state.simulation
    if simulation.collisions != "step" and simulation.integrator in ("auto", "exact"):
        return None
    if simulation.contacts == "soft":
        return sentence("asked_for")
    asked = None if simulation.contacts == "rigid" else _why_overruled(simulation)
    return asked or _why_systems_soft(state, schedule)


def _why_too_fast(state: State, schedule: Schedule) -> str | None:
    """Return whether forces act too fast for rigid contacts, in the present state of motion, or ``None``."""
    rate = fastest_rate(state, schedule.forces)
    if rate * state.simulation.dt > _MAX_RATE:
        return sentence("fast_forces", rate=f"{rate:.3g}")
    return None


def why_not_rigid(state: State, schedule: Schedule) -> str | None:
    """Return why contacts cannot be rigid, or ``None``."""
    if (systems := _why_systems_soft(state, schedule)) is not None:
        return systems
    if (nowhere := why_nowhere(state)) is not None:
        return nowhere
    if count_pairs(state) > _MAX_PAIRS:
        return sentence("many_pairs", limit=_MAX_PAIRS)
    return why_not_points(state)


def _why_systems_soft(state: State, schedule: Schedule) -> str | None:
    """Return the method, or the system that is there or is not, with which contacts are soft, or ``None``."""
    if state.simulation.integrator not in ("auto", "dop853"):
        return sentence("other_method_than_rigid", method=state.simulation.integrator)
    for needed in CONTACT_STEP if schedule.runs(Stage.CONTACT) else (IntegrateSystem,):
        if schedule.find(needed) is None:
            return sentence("system_absent", system=needed.__name__)
    for system in schedule.running:
        if not (isinstance(system, ForceSystem) or system.is_engine or system.leaves_motion()):
            return sentence("acts_within_step", system=system.name)
    return None
