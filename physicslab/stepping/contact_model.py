"""Which worlds can have rigid contacts."""

from __future__ import annotations

from physicslab.components import Transform, Velocity
from physicslab.state.state import State
from physicslab.stepping.ballistic import CONTACT_STEP, count_pairs
from physicslab.systems.schedule import Schedule
from physicslab.systems.system import AROUND, OF_FRAMES, ForceSystem, Stage

__all__ = ["choose_contacts", "why_not_rigid"]

_MAX_PAIRS = 10_000
"""Number of pairs above which contacts are soft: each is looked at in every piece of motion."""
_OBSERVING = OF_FRAMES | AROUND | {Stage.IMPACT}
"""The stages at which a system may observe without changing the motion."""


def choose_contacts(state: State, schedule: Schedule) -> tuple[str, str]:
    """Return whether contacts are ``"rigid"`` or ``"soft"``, and the reason."""
    wish = state.simulation.contacts
    if wish != "rigid":
        return "soft", "asked for" if wish == "soft" else "rigid contacts are not asked for"
    obstacle = why_not_rigid(state, schedule)
    return ("rigid", "asked for") if obstacle is None else ("soft", f"rigid was asked for, and {obstacle}")


def why_not_rigid(state: State, schedule: Schedule) -> str | None:
    """Return why contacts cannot be rigid, or ``None``."""
    if state.simulation.integrator not in ("auto", "dop853"):
        return f"{state.simulation.integrator} was asked for, and rigid contacts go by dop853"
    for needed in CONTACT_STEP:
        if schedule.find(needed) is None:
            return f"{needed.__name__} is not among the systems"
    for system in schedule.running:
        if isinstance(system, ForceSystem) or system.is_engine:
            continue
        if not type(system).marked().keys() <= _OBSERVING:
            return f"{system.name} acts within the step"
    if (state.table(Velocity).present & ~state.table(Transform).present).any():
        return "something moves that is nowhere"
    if count_pairs(state) > _MAX_PAIRS:
        return f"more than {_MAX_PAIRS} pairs may meet"
    return None
