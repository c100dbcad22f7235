"""Bodies that rest on others while some move ballistically: the contact step, with their contacts alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.contacts.arguments import motion_of
from physicslab.kernels.events import events
from physicslab.state.state import State
from physicslab.stepping.plan import StepPlan
from physicslab.stepping.stepper import falls_far
from physicslab.stepping.substeps import Span, Substeps
from physicslab.systems.contact import ContactSystem
from physicslab.systems.schedule import Schedule

__all__ = ["Moment", "Motion", "RestingBodies", "clear_impacts", "copy_motion", "list_touching", "set_motion"]

type Motion = list[NDArray[np.float64]]
"""Copies of all positions, angles, velocities and angular velocities."""

_WARM = ("feature", "normal_impulse", "tangent_impulse")
"""What a contact starts the next substep from."""
_IMPACT_FIELDS = ("approach_speed", "impact_normal", "impact_tangent")


def copy_motion(state: State) -> Motion:
    """Return a copy of all positions and velocities."""
    return [column.copy() for column in motion_of(state)]


def set_motion(state: State, motion: Motion) -> None:
    """Write back what :func:`copy_motion` returned."""
    for column, kept in zip(motion_of(state), motion, strict=True):
        column[:] = kept


def list_touching(state: State) -> None:
    """List the pairs that have contact points."""
    contacts = state.contacts
    touching = np.flatnonzero(contacts.manifolds["count"][: contacts.recorded] > 0)
    contacts.active = len(touching)
    contacts.touching[: len(touching)] = touching


def clear_impacts(state: State) -> bool:
    """Clear the records of the impacts of the step before; return whether there were any."""
    contacts = state.contacts
    near = contacts.manifolds[: contacts.recorded]
    if not near["impact_count"].any():
        return False
    near["impact_count"] = 0
    points = contacts.points[: 2 * contacts.recorded]
    for name in _IMPACT_FIELDS:
        points[name] = 0.0
    return True


@dataclass(frozen=True, slots=True)
class Moment:
    """The state at one moment, to go back to.

    Attributes
    ----------
    motion : Motion
        Of all bodies.
    collisions, logged : int
        How many impacts there were until then, and in the log.
    pairs : int64 array (pairs,)
        Those of which the contacts are kept.
    manifolds, points : arrays of records (pairs,) and (pairs, 2)
        These contacts.
    booked : float64 array (CAUSES, 4)
        The sums of the account.
    """

    motion: Motion
    collisions: int
    logged: int
    pairs: NDArray[np.int64]
    manifolds: NDArray[Any]
    points: NDArray[Any]
    booked: NDArray[np.float64]

    @classmethod
    def of(cls, state: State, pairs: NDArray[np.int64]) -> Moment:
        """Return the present one."""
        contacts = state.contacts
        manifolds, points = contacts.manifolds[pairs], contacts.points.reshape(-1, 2)[pairs]
        booked = state.account.sums.copy()
        return cls(copy_motion(state), state.collisions, contacts.logged, pairs, manifolds, points, booked)

    def restore(self, state: State, impacts: int) -> None:
        """Go back there, and take back the first ``impacts`` that came since."""
        state.collisions -= impacts
        if state.contacts.read:
            state.contacts.forget_impacts(self.logged, impacts)
        set_motion(state, self.motion)
        state.account.sums[:] = self.booked
        state.contacts.manifolds[self.pairs] = self.manifolds
        state.contacts.points.reshape(-1, 2)[self.pairs] = self.points


class RestingBodies:
    """Moves the bodies that rest on others by the contact step.

    Parameters
    ----------
    state : State
        Whose bodies.
    schedule : Schedule
        The systems that make the contact step.
    plan : StepPlan
        Its stages.
    """

    def __init__(self, state: State, schedule: Schedule, plan: StepPlan) -> None:
        self._contact = schedule.find(ContactSystem)
        self._substeps = Substeps(state, schedule, plan, whole=False)

    def begin_step(self, state: State) -> None:
        """Begin a step, at whose first substep records of impacts are cleared."""
        if self._contact is not None:
            self._contact.begin_step(state)

    def held(self, state: State) -> NDArray[np.bool_]:
        """Return which rows have a contact that holds them after the contact step."""
        contacts = state.contacts
        near = contacts.manifolds[: contacts.recorded]
        points = contacts.points[: 2 * contacts.recorded].reshape(-1, 2)
        in_use = np.arange(2) < near["count"][:, None]
        deep = points["separation"] < -events.DEEP * near["size"][:, None]
        holding = (in_use & ((points["normal_impulse"] > 0.0) | deep)).any(axis=1)
        held = np.zeros(len(state.entity_index), np.bool_)
        held[near["a"][holding]] = True
        held[near["b"][holding]] = True
        return held

    def advance(self, state: State, pairs: NDArray[np.int64], began: float, span: float) -> Motion:
        """Advance all by the contact step for ``span`` s, with these contacts alone; return the motion."""
        contacts = state.contacts
        near = contacts.manifolds[: contacts.recorded]
        points = contacts.points[: 2 * contacts.recorded]
        lost = np.repeat(near["count"] <= 0, 2)  # a contact that comes again starts from no old impulse
        for name in _WARM:
            points[name][lost] = 0
        others = np.ones(len(near), np.bool_)
        others[pairs] = False
        near["count"][others] = -1  # the contact step passes over them
        impact_count, earlier = near["impact_count"].copy(), [points[name].copy() for name in _IMPACT_FIELDS]
        substeps = falls_far(state, span) * state.simulation.substeps
        # The loop is compiled at its first call: most worlds do not come here.
        self._substeps.go_through(state, Span(substeps, span / substeps, span, began, span))
        near["count"][others] = 0
        # The contact stage has cleared the records of impacts; those of the ballistic part are added again.
        new = impact_count > near["impact_count"]
        near["impact_count"][new] += impact_count[new]
        both = np.repeat(new, 2)
        for name, before in zip(_IMPACT_FIELDS, earlier, strict=True):
            joined = np.maximum if name == "approach_speed" else np.add
            points[name][both] = joined(points[name][both], before[both])
        return copy_motion(state)
