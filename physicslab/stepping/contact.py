"""The contact step, stage by stage: any scene, any systems."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

from physicslab.state.masses import check_finite
from physicslab.state.state import State
from physicslab.stepping.accounting import acts_unbooked, run_measured
from physicslab.stepping.bounds import bring_back
from physicslab.stepping.plan import StepPlan
from physicslab.stepping.split_forces import OF_SPLIT_FORCES, SplitForces
from physicslab.stepping.stage_accounts import StageAccounts
from physicslab.stepping.stepper import Advance, divisions, falls_far
from physicslab.systems.contact import ContactSystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.schedule import Schedule
from physicslab.systems.sleep import SleepSystem
from physicslab.systems.system import Stage

__all__ = ["Contact"]


class Contact:
    """Goes through the stages of every substep and calls the systems of each, from Python.

    It can advance any world, so it is the last of the list. Bodies that springs and drag act on may be moved
    by a method of their own within it (:class:`physicslab.stepping.split_forces.SplitForces`).
    """

    name: ClassVar[str] = "contact"
    title: ClassVar[str] = "Steps stage by stage, contacts within them"
    leaps: bool = False
    keeps_balance: ClassVar[bool] = False
    leaves_forces: ClassVar[bool] = True

    def __init__(self, state: State, schedule: Schedule, plan: StepPlan) -> None:
        self._schedule, self._stages = schedule, plan.stages.substep
        self._contact, self._sleep = schedule.find(ContactSystem), schedule.find(SleepSystem)
        self._split: SplitForces | None = None
        if plan.split_forces is not None:
            self._split = SplitForces(state, schedule.forces, plan.split_forces, plan.split_steps)
        self._accounts = StageAccounts(state, schedule.forces)
        self._run: Callable[[Stage, State, float], None] = schedule.run
        # Where a system of one's own moves the bodies itself, its error is that of the method.
        if schedule.find(IntegrateSystem) is not None and any(map(acts_unbooked, schedule.running)):
            self._run = lambda stage, state, h: run_measured(stage, schedule, state, h)
        self.kernels: tuple[Any, ...] = (*schedule.kernels(state), *self._accounts.kernels)
        self.reason = plan.reason

    @classmethod
    def why_not(cls, state: State, schedule: Schedule, plan: StepPlan) -> str | None:
        """None: any world can be stepped so."""
        return None

    def holds(self, state: State) -> bool:
        """Whether the sub-integrated bodies and their forces are still the same."""
        return self._split is None or not self._split.outdated(state)

    def ready(self, state: State, h: float) -> bool:
        """Be ready for any step."""
        return True

    def advance(self, state: State, h: float, steps: int) -> Advance:
        """Make one step."""
        parts = divisions(state, h)
        factor = max(state.contacts.substep_factor, falls_far(state, h / parts))
        state.substeps = factor * state.simulation.substeps
        self.begin(state)
        self.go_through(state, state.time, h / parts / state.substeps, parts * state.substeps)
        check_finite(state, state.time + h)
        if self._sleep is not None:
            self._schedule.call(self._sleep, self._sleep.count_rest, state, h)
        if state.contacts.outside:
            bring_back(state, self._schedule)
        factors = (system.substep_factor(state) for system in self._schedule.running)
        state.contacts.substep_factor = max(factors, default=1)
        return Advance(1, parts)

    def begin(self, state: State) -> None:
        """Begin new records of impacts, and take the present forces and masses."""
        if self._contact is not None:
            self._contact.begin_step(state)
        if self._split is not None:
            self._split.begin(state)

    def go_through(self, state: State, start: float, h: float, count: int) -> None:
        """Go through the stages of ``count`` substeps of ``h`` seconds, from the time ``start`` [s]."""
        before = state.time
        try:
            for substep in range(count):
                state.moment = start + (substep - state.window[0]) * h
                self._go_through_one(state, start + substep * h, h)
        finally:
            state.time = before

    def _go_through_one(self, state: State, start: float, h: float) -> None:
        """Go through the stages of a substep; the clock goes on as the positions do."""
        run, split, drifted = self._run, self._split, 0.0
        accounts = self._accounts
        accounts.begin_substep(state)
        for stage, share in self._stages:
            state.time = start + drifted * h
            accounts.begin(stage, state, share, h)
            if stage is Stage.FORCE and accounts.notes_forces:
                self._schedule.run_forces(state, share * h, accounts.note_force)
            elif stage is not Stage.PREDICT:
                run(stage, state, share * h)
            if split is not None and stage in OF_SPLIT_FORCES:
                split.take_part(stage, state, share * h)
            accounts.end(stage, state)
            if stage is Stage.DRIFT:
                drifted += share
