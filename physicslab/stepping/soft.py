"""Steps with soft contacts: any scene, any systems."""

import math
from typing import Any

from physicslab.contacts.islands import keep_places, measure_joints
from physicslab.contacts.near_pairs import refill
from physicslab.ecs.sentences import sentence
from physicslab.kernels.accounts import CONTACT, ENERGY
from physicslab.kernels.clock import time_after
from physicslab.kernels.loading import working_ns
from physicslab.state.masses import check_finite
from physicslab.state.state import State
from physicslab.stepping.accounting import held_in, note_places, open_account, put_far_together
from physicslab.stepping.bounds import return_inside
from physicslab.stepping.plan import StepPlan
from physicslab.stepping.stepper import Advance, Stepper, divisions, falls_far
from physicslab.stepping.substeps import Span, Substeps
from physicslab.systems.broad_phase import BroadPhaseSystem
from physicslab.systems.contact import ContactSystem
from physicslab.systems.schedule import Schedule
from physicslab.systems.sleep import SleepSystem

_MAX_STEPS = 4096
"""Largest number of steps of one call."""
_CALL_NS = 100_000_000
"""Time [ns] that a call takes at most, judged by the last one: what stops a run waits for its end."""


class Soft(Stepper):
    """Goes through the stages of every substep, in one compiled loop.

    It can advance any world, so it is the last of the list. Where only systems of the engine act, it makes
    many steps in one call. Where another acts within the step, or a force in Python, the loop hands over to
    it; steps are then made one by one.

    Attributes
    ----------
    substeps : Substeps
        The parts of a substep.
    hooks : tuple of str
        Why the loop comes back in every substep, if it does.
    energy_taken, energy_given : float
        The most that contacts had taken, and what they have given again since then [J].
    """

    name: str = "contact"
    title: str = "Steps stage by stage, contacts within them"
    leaves_forces: bool = True
    samples: bool = True

    def __init__(self, state: State, schedule: Schedule, plan: StepPlan) -> None:
        self._schedule, self.substeps = schedule, Substeps(state, schedule, plan)
        self._broad_phase, self._contact = schedule.find(BroadPhaseSystem), schedule.find(ContactSystem)
        self._sleep = schedule.find(SleepSystem)
        self.kernels: tuple[Any, ...] = self.substeps.kernels
        self.hooks = self.substeps.hooks
        self.keeps_balance: bool = not self.hooks and self.substeps.uniform
        # With one force the loop measures the same energy, bit for bit, as is measured between steps.
        self._measures = len(schedule.forces) < 2
        self._max_steps, self._call = 64, (Span(1, 0.0, 0.0, 0.0, 0.0, 0), 1)
        self.energy_taken, self.energy_given, self._last = -math.inf, 0.0, -math.inf
        self.reason = plan.reason
        if not self.hooks:
            self.name, self.title = "fused_contact", "Compiled steps, contacts within them"
            self.reason = plan.reason if plan.collisions == "none" else sentence("compiled_contacts")
        elif self.hooks[0] not in plan.reason:
            self.reason = sentence("both", one=plan.reason, other=self.hooks[0])

    @classmethod
    def why_not(cls, state: State, schedule: Schedule, plan: StepPlan) -> str | None:
        """None: any world can be stepped so."""
        return None

    def holds(self, state: State) -> bool:
        """Whether the sub-integrated bodies and their forces are still the same."""
        split = self.substeps.split
        return split is None or not split.outdated(state)

    def advance(self, state: State, h: float, steps: int) -> Advance:
        """Make ``steps`` steps or fewer; where one fails, those before it are counted."""
        if len(state.joints):
            put_far_together(state, self._schedule.forces)
        span = self._span(state, h)
        refill(state)
        if state.sleep.count:
            measure_joints(state)
        return self._make(state, span, steps, self._open(state) if self.keeps_balance else -1)

    def _span(self, state: State, h: float) -> Span:
        """Return the span of coming steps of ``h`` seconds, in as many substeps as loads need now."""
        contacts, parts = state.contacts, divisions(state, h)
        unequal = state.bodies.unequal and state.has_forces
        if not unequal:
            contacts.substep_factor = 1
        factor = max(contacts.substep_factor, falls_far(state, h / parts, state.bodies.smallest))
        state.substeps = factor * state.simulation.substeps
        rested = min(h, state.simulation.dt)  # of a divided step only the end is observed
        finer = contacts.substep_factor if unequal else 0
        span = Span(parts * state.substeps, h / parts / state.substeps, h, state.time, rested, finer)
        self._call = span, parts
        return span

    def goes_on(self, state: State) -> bool:
        """Whether the loop has gone through, with all bodies awake."""
        return self.substeps.went_through and not state.sleep.count

    def repeat(self, state: State, h: float, steps: int) -> Advance:
        """Make steps as in the last call, with its arguments."""
        span, _ = self._call
        now = Span(span.substeps, span.h, span.dt, state.time, span.rested, span.finer)
        return self._make(state, now, steps, -1, again=True)

    def _make(self, state: State, span: Span, steps: int, cause: int, *, again: bool = False) -> Advance:
        """Make steps; a change since the last one is booked to ``cause``, unless that is negative."""
        parts, wanted = self._call[1], steps
        steps = 1 if self.hooks or parts > 1 else min(steps, self._max_steps)
        began = working_ns() if wanted > 1 else 0
        if not again:
            self._note_energy(state)
        logged, start, made = state.contacts.logged, state.time, 0
        try:
            while True:
                made += self._go_through(state, span, steps - made, cause, again=again)
                if made >= steps or state.sleep.count or not self.substeps.needs_others:
                    break
                state.time = time_after(start, span.dt, made)
                span, cause, again = self._span(state, span.dt), -1, False
        except BaseException:
            state.steps += made
            raise
        state.time = start
        if state.contacts.logged > logged + 1:
            state.contacts.order_log(logged)
        if self.hooks:
            self._end_step(state, span.dt)
            if state.samples is not None:
                state.samples.take(state, time_after(state.time, span.dt, made))
        keep_places(state)
        if len(state.joints):
            note_places(state)
            state.joints.force[:] = state.joints.impulse / (state.contacts.impulse_dt or span.h)
        self._note_energy(state)
        for force in self._schedule.forces:
            force.note_rate(state)
        if wanted > 1:
            self._max_steps = max(1, min(_MAX_STEPS, made * _CALL_NS // max(working_ns() - began, 1)))
        return Advance(made, parts)

    def _go_through(self, state: State, span: Span, steps: int, cause: int, *, again: bool) -> int:
        """Make steps as long as they have the same substeps; return how many."""
        if self._broad_phase is not None and (state.contacts.stale or not again):
            self._broad_phase.follow_rows(state)
        if self._contact is not None:
            self._contact.begin_step(state)
        if self.substeps.split is not None:
            self.substeps.split.begin(state, span.dt)
        return self.substeps.go_through(state, span, steps, cause, again=again)

    def _note_energy(self, state: State) -> None:
        """Note what contacts have taken at most and given since; from here on where time went back."""
        given = state.account.sums.item(CONTACT, ENERGY)
        if state.time < self._last:
            self.energy_taken = -math.inf
        self.energy_taken, self._last = max(self.energy_taken, -given), state.time
        self.energy_given = given + self.energy_taken

    def _end_step(self, state: State, h: float) -> None:
        """Judge what has come of a step with hooks, as the loop does where there are none."""
        check_finite(state, state.time + h)
        if self._sleep is not None:
            self._schedule.call(self._sleep, self._sleep.count_rest, state, h)
        if state.contacts.outside:
            return_inside(state, self._schedule)

    def _open(self, state: State) -> int:
        """Return by which cause anything was changed since the last step, or -1 where that is booked."""
        account = state.account
        if not (account.is_open or (account.is_known and self._measures)):
            open_account(state, self._schedule.forces)
        if account.is_open:
            return -1
        held, account.seen = held_in(state), None
        cause, account.held = account.cause_of_edits(held), held
        return cause
