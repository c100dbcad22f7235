"""The contact step of whole steps in one compiled call, for scenes in which no system observes substeps."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np

from physicslab.components import Mass
from physicslab.contacts.arguments import (
    acting_in,
    bounds_of,
    inverse_in,
    materials_of,
    motion_of,
    near_in,
    sizes_of,
    speculative_margin,
)
from physicslab.contacts.islands import all_asleep, keep_places
from physicslab.contacts.wide import refill
from physicslab.ecs.vector import Vector2
from physicslab.integrators.leapfrog import LEAPFROG
from physicslab.kernels.broad import grid, leaving, near_pairs
from physicslab.kernels.broad.fat_boxes import fat_boxes
from physicslab.kernels.loading import direct_entry, working_ns
from physicslab.kernels.solver import fused_contact as fused
from physicslab.kernels.wide import slots
from physicslab.state.masses import check_finite
from physicslab.state.state import State
from physicslab.stepping.accounting import held_in, open_account
from physicslab.stepping.bounds import bring_back
from physicslab.stepping.plan import StepPlan
from physicslab.stepping.stepper import Advance, divisions, falls_far
from physicslab.systems.accelerate import AccelerateSystem
from physicslab.systems.broad_phase import BroadPhaseSystem
from physicslab.systems.contact import ContactSystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.resolve import ResolveSystem
from physicslab.systems.schedule import Schedule
from physicslab.systems.sleep import SleepSystem
from physicslab.systems.system import ForceSystem, System

__all__ = ["FusedContact"]

_NEEDED = (AccelerateSystem, IntegrateSystem, BroadPhaseSystem, ContactSystem, ResolveSystem)
_MAX_STEPS = 4096
"""Largest number of steps of one call."""
_CALL_NS = 100_000_000
"""Time [ns] that a call takes at most, judged by the last one: what stops a run waits for its end."""
_SUBSTEP = [stage for stage, _ in LEAPFROG.substep]


class FusedContact:
    """Makes steps in a compiled loop, with the bits of the contact step.

    The loop comes back where Python is needed: to list the near pairs, to make the first blocks or room for
    more, to wake touched bodies, to put rested islands to sleep, to report a divergence.
    """

    name: ClassVar[str] = "fused_contact"
    title: ClassVar[str] = "Compiled steps, contacts within them"
    leaps: bool = False
    keeps_balance: ClassVar[bool] = True
    leaves_forces: ClassVar[bool] = True
    kernels: tuple[Any, ...] = (
        fused.advance, fat_boxes, leaving.index_bodies, leaving.add_pairs, grid.find_pairs,
        near_pairs.partition, near_pairs.carry_over, near_pairs.sort_scalar, slots.list_scalar,
    )  # fmt: skip

    def __init__(self, state: State, schedule: Schedule, plan: StepPlan) -> None:
        self._schedule = schedule
        self._calls: list[tuple[int, str, int, int]] = []
        for system in schedule.running:
            place = _place(system) if system.is_engine else None
            if place is not None:
                calls = sum(stage in type(system).marked() for stage in _SUBSTEP)
                self._calls.append((place, system.name, calls, int(isinstance(system, SleepSystem))))
        self._broad_phase = _found(schedule, BroadPhaseSystem)
        self._contact = _found(schedule, ContactSystem)
        self._resolve = _found(schedule, ResolveSystem)
        self._sleep = schedule.find(SleepSystem)
        # Of one force the loop measures the same energy, bit for bit, as is measured between steps.
        self._measures = len(schedule.forces) < 2
        uniform = [force.uniform_acceleration(state) for force in schedule.forces]
        self._gravity = sum((g for g in uniform if g is not None), start=Vector2(0.0, 0.0))
        self._cost = np.zeros(fused.COSTS, np.int64)
        self._h = 0.0
        self._max_steps = 64
        self._kept: object = None
        self._entry: Callable[..., Any] = fused.advance
        self._steps = self._nanoseconds = 0
        self._substeps = state.simulation.substeps
        self._fixed: tuple[tuple[Any, ...], tuple[Any, ...], Any]
        self.reason = "bodies can touch, and nothing looks at substeps"

    @classmethod
    def why_not(cls, state: State, schedule: Schedule, plan: StepPlan) -> str | None:
        """Return why steps of this world cannot be made in a compiled loop, or ``None``."""
        for needed in _NEEDED:
            found = schedule.find(needed)
            if found is None or not found.is_engine:
                return f"the engine's {needed.__name__} is not among the systems"
        if plan.collisions != "step":
            return "collisions are not found within steps"
        if plan.stages is not LEAPFROG or plan.split_forces is not None:
            return f"bodies are not moved by {LEAPFROG.name} alone"
        for force in schedule.forces:
            if not force.is_engine or force.uniform_acceleration(state) is None:
                return f"the force of {force.name} is no uniform acceleration"
        for system in schedule.running:
            if not system.is_engine and system.acts_within_step():
                return f"{system.name} acts within the step"
        return None

    def holds(self, state: State) -> bool:
        """Return True: all that it is made from changes only with structure or laws."""
        return True

    def ready(self, state: State, h: float) -> bool:
        """Whether no body carries a far heavier one, and neither the step nor its substeps are divided."""
        heavy = state.bodies.unequal and state.has_forces
        return not (heavy or state.sleep.unverified or divisions(state, h) > 1 or falls_far(state, h) > 1)

    def advance(self, state: State, h: float, steps: int) -> Advance:
        """Make ``steps`` steps or fewer; where one fails, those before it are counted."""
        state.substeps, state.contacts.substep_factor = state.simulation.substeps, 1
        span = h / state.substeps
        refill(state)
        self._broad_phase.follow_rows(state)
        self._contact.begin_step(state)
        made, substep, stage, wanted, cause = 0, 0, fused.BEGIN, steps, self._open(state)
        steps, began = min(steps, self._max_steps), working_ns() if steps > 1 else 0
        try:
            while made < steps:
                why, done, substep = self._advance(state, made, steps - made, substep, stage, h, cause)
                cause = -1
                made += done
                if why == fused.DIVERGED:
                    check_finite(state, state.time + (made + 1) * h)
                elif why == fused.PAIRS_STALE:
                    self._timed(self._broad_phase, self._broad_phase.list_pairs, state, span)
                    stage = fused.FIND
                elif why in (fused.BLOCKS_FULL, fused.WAKE_PENDING):
                    if why == fused.BLOCKS_FULL:
                        self._timed(self._contact, self._contact.make_wide, state, span)
                    if self._sleep is not None:
                        self._timed(self._sleep, self._sleep.wake_touched_islands, state, span)
                    stage = fused.IMPACTS
                elif why in (fused.SLEEP_PENDING, fused.WALL_PENDING):
                    state.checkpoint.take(motion_of(state), state.counts)
                    state.account.is_open = True  # the loop has not seen what is done here
                    if why == fused.SLEEP_PENDING and self._sleep is not None:
                        self._timed(self._sleep, self._sleep.put_islands_to_sleep, state, h)
                    if state.contacts.outside:
                        bring_back(state, self._schedule)
                    stage = fused.BEGIN
                    if all_asleep(state):
                        break
        except BaseException:
            state.time, state.steps = state.time + made * h, state.steps + made
            raise
        keep_places(state)
        if wanted > 1:
            self._max_steps = max(1, min(_MAX_STEPS, made * _CALL_NS // max(working_ns() - began, 1)))
        return Advance(made)

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

    def _advance(
        self, state: State, made: int, steps: int, substep: int, stage: int, h: float, cause: int
    ) -> tuple[int, int, int]:
        """Run the loop as far as it goes; return why it ended, after how many steps, and where."""
        began = time.perf_counter_ns()
        contacts, substeps = state.contacts, state.substeps
        plan = (substeps, state.simulation.iterations or 0, h / substeps, h, state.time + made * h)
        arguments = self._arguments(state, h / substeps)
        why, done, substep, finished_impacts, impacts, contacts.impulse_dt = self._entry(
            steps, substep, stage, plan, cause, *arguments
        )
        contacts.changed()
        state.collisions += finished_impacts
        if done:
            state.force_evaluations += done * substeps * state.has_forces
            state.checkpoint.counts = state.counts
        state.collisions += impacts - finished_impacts
        self._steps += done
        self._nanoseconds += time.perf_counter_ns() - began
        self._schedule.defer(self._settle)
        return why, done, substep

    def _arguments(self, state: State, h: float) -> tuple[Any, ...]:
        """Return the arguments of the loop; those that change only with structure or laws are kept."""
        contacts, sleep, kept = state.contacts, state.sleep, state.checkpoint.columns
        if self._kept is not kept or self._h != h:
            self._kept, self._h, self._fixed = kept, h, self._fixed_arguments(state, h)
            self._entry = fused.advance  # which looks at the types of the arrays once
        else:
            self._entry = direct_entry(fused.advance)
        motion, laws, marked = self._fixed
        sleepers = (
            self._sleep is not None, sleep.count, sleep.asleep, sleep.rest, sleep.slowest, marked,
            contacts.inactive, contacts.sleeping,
        )  # fmt: skip
        damping, bounds = laws
        return (
            *motion, sleepers, damping, self._broad_phase.fat, bounds, near_in(state), contacts.opened,
            self._resolve.softness, contacts.impulse_dt, contacts.step_log, self._cost,
        )  # fmt: skip

    def _fixed_arguments(self, state: State, h: float) -> tuple[tuple[Any, ...], tuple[Any, ...], Any]:
        """Return the columns in order, the laws, and room for marks."""
        bodies, physics = state.bodies, state.physics
        mass = state.table(Mass)
        gravity = (
            mass["mass"], mass["inertia"], bodies.inverse_mass, bodies.inverse_inertia, self._gravity.x,
            self._gravity.y, speculative_margin(state, h),
        )  # fmt: skip
        columns = (
            motion_of(state), tuple(state.checkpoint.columns), sizes_of(state), materials_of(state),
            inverse_in(state), bodies.sub_integrated, acting_in(state), gravity,
        )  # fmt: skip
        laws = (physics.linear_damping, physics.angular_damping), bounds_of(state)
        return columns, laws, np.zeros_like(state.sleep.asleep)

    def _settle(self) -> None:
        """Note as many calls as the stages would have made; the time is divided by the loop's own clock.

        What that has shown before counts half as much: the last steps may be too few to have been timed.
        """
        costs: list[int] = self._cost[: fused.STEPS].tolist()
        total, timings = max(1, sum(costs)), self._schedule.timings
        for place, name, calls, once in self._calls:
            timing = timings[name]
            timing.calls += self._steps * (calls * self._substeps + once)
            timing.nanoseconds += self._nanoseconds * costs[place] // total
        self._cost[: fused.STEPS] //= 2
        self._steps = self._nanoseconds = 0

    def _timed(self, system: System, call: Callable[[State, float], None], state: State, h: float) -> None:
        """Call a system's method, whose call is counted with the step, and note what it cost."""
        began = working_ns()
        call(state, h)
        self._schedule.note(system.name, 0, working_ns() - began)


def _place(system: System) -> int | None:
    """Return where the loop keeps the cost of a system's work."""
    places: dict[type[System], int] = {
        AccelerateSystem: fused.ACCELERATE, IntegrateSystem: fused.INTEGRATE,
        BroadPhaseSystem: fused.BROAD_PHASE, ContactSystem: fused.CONTACT, ResolveSystem: fused.RESOLVE,
        SleepSystem: fused.SLEEP,
    }  # fmt: skip
    return fused.GRAVITY if isinstance(system, ForceSystem) else places.get(type(system))


def _found[S: System](schedule: Schedule, kind: type[S]) -> S:
    found = schedule.find(kind)
    assert found is not None  # else why_not would have returned a reason
    return found
