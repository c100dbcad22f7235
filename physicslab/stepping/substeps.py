"""Substeps with soft contacts: one compiled loop, which hands over to Python where other systems act."""

import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Mass
from physicslab.contacts.arguments import (
    acting_in,
    bounds_of,
    inverse_in,
    joints_in,
    materials_of,
    motion_of,
    near_in,
    shapes_of,
    speculative_margin,
)
from physicslab.contacts.islands import all_asleep
from physicslab.kernels import Plain
from physicslab.kernels.arguments import Plan, Softness
from physicslab.kernels.broad import grid, leaving, near_pairs
from physicslab.kernels.broad.fat_boxes import fat_boxes
from physicslab.kernels.broad.leaving import blank_boxes
from physicslab.kernels.clock import time_after
from physicslab.kernels.loading import direct_entry, working_ns
from physicslab.kernels.near_counts import FOLLOWED
from physicslab.kernels.solver import soft
from physicslab.kernels.solver.finer import needed_factor
from physicslab.kernels.wide import slots
from physicslab.kernels.wide.graph_colour import MIN_WIDE
from physicslab.state.joint_figures import is_overloaded
from physicslab.state.masses import check_finite
from physicslab.state.samples import sampled
from physicslab.state.solid import solid_rows
from physicslab.state.state import State
from physicslab.stepping.bounds import return_inside
from physicslab.stepping.plan import StepPlan
from physicslab.stepping.substep_parts import SubstepParts
from physicslab.systems.accelerate import AccelerateSystem
from physicslab.systems.broad_phase import BroadPhaseSystem
from physicslab.systems.contact import ContactSystem
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.joint import JointSystem
from physicslab.systems.resolve import ResolveSystem
from physicslab.systems.schedule import Schedule
from physicslab.systems.sleep import SleepSystem
from physicslab.systems.system import ForceSystem, System

_KERNELS = (
    soft.advance, needed_factor, fat_boxes, leaving.index_bodies, grid.find_pairs,
    near_pairs.partition, near_pairs.carry_over, near_pairs.sort_scalar, slots.list_scalar,
)  # fmt: skip
_CONTACTS = 2
"""Contacts that a body of a heap has at most, about: 40 in a room came to 64, and halted for 25 ms."""
_COSTS: dict[type[System], int] = {
    AccelerateSystem: soft.ACCELERATE, IntegrateSystem: soft.INTEGRATE, BroadPhaseSystem: soft.BROAD_PHASE,
    ContactSystem: soft.CONTACT, ResolveSystem: soft.RESOLVE, JointSystem: soft.RESOLVE,
    SleepSystem: soft.SLEEP,
}  # fmt: skip
"""Where the loop keeps what their work costs; that of forces is in one, and so is that of all impulses."""


class Span(NamedTuple):
    """Span of substeps: their number a step, the length of a substep and of a step, the start [s].

    ``rested`` is the time [s] that a step counts as rest of what is slow, ``finer`` how many times as many
    substeps as configured loads have been found to need, 0 where it is not looked at them.
    """

    substeps: int
    h: float
    dt: float
    start: float
    rested: float
    finer: int


class Substeps:
    """Going through the parts of substeps, in one compiled loop as far as that goes.

    Parameters
    ----------
    state, schedule, plan
        As of :class:`SubstepParts`.

    Attributes
    ----------
    hooks : tuple of str
        Why the loop comes back in every substep, if it does; ends of steps are then the caller's.
    kernels : tuple of kernels
        Kernels called in most steps; in a crowd those that put contacts into blocks, for loading them would
        halt a later step.
    split : SplitForces, optional
        The flow of bodies on springs and in drag, if not kicks.
    uniform : bool
        Whether no forces act but uniform ones that are compiled.
    went_through, needs_others : bool
        Whether the loop made the last step to its end, and has nothing to leave to Python after it, or only
        that the next step needs another number of substeps.
    """

    def __init__(self, state: State, schedule: Schedule, plan: StepPlan) -> None:
        self._schedule = schedule
        self._contact, self._sleep = schedule.find(ContactSystem), schedule.find(SleepSystem)
        self._broad_phase, self._resolve = schedule.find(BroadPhaseSystem), schedule.find(ResolveSystem)
        self._joined = self._resolve is not None and schedule.find(JointSystem) is not None
        made = SubstepParts(state, schedule, plan)
        self.split, self.uniform, self.hooks = made.split, made.uniform, tuple(made.reasons)
        self._parts, self._times, self._calls = made.parts, made.times, made.calls
        self._python, self._accounts, self._packs = made.hooks, made.accounts, made.packs
        self._hooked, self._edits = bool(made.reasons), made.edits
        start, end = plan.stages.window
        parts, times = np.array(self._parts, np.int64), np.array(self._times).reshape(-1, 3).T.copy()
        self._course = parts, times, start, end, -start, self._hooked
        self._is_compiled = [*(part != soft.HOOK for part in self._parts), True]
        self._evaluates = state.has_forces and not {soft.UNIFORM, soft.PACKED}.isdisjoint(self._parts)
        compiled = _KERNELS if made.compiled else self._accounts.kernels
        crowd = _CONTACTS * len(solid_rows(state)) >= MIN_WIDE
        wide = state.contacts.wide.kernels if crowd else ()
        self.kernels: tuple[Any, ...] = (*compiled, *wide, *(schedule.kernels(state) if made.reasons else ()))
        self._cost, self._forces = np.zeros(soft.COSTS, np.int64), made.forces
        self._columns: object = None
        self._shapes: object = None  # which are others where vertices are new in this process
        self._springs = (np.zeros(0), np.zeros(0, np.int64)) if self.split is None else self.split.flows
        self._entry: Callable[..., Any] = soft.advance
        self._fixed: tuple[tuple[Any, ...], tuple[Any, ...], tuple[Any, ...], Any]
        self._replaced = -1
        self._held: tuple[Any, ...] | None = None  # arguments of the last call, where they hold for the next
        self._packed: tuple[list[NDArray[np.int64]], NDArray[np.int64]] = [], np.zeros((0, 3), np.int64)
        self._steps = self._substeps = self._nanoseconds = 0
        self.went_through = self.needs_others = False

    # ---- going through them --------------------------------------------------------------------------------

    def go_through(
        self, state: State, span: Span, steps: int = 1, cause: int = -1, *, again: bool = False
    ) -> int:  # fmt: skip
        """Make ``steps`` steps or, where everything falls asleep or substeps are to be others, fewer.

        A change since the last step is booked to ``cause``, unless that is negative; ``again`` says that
        there was none. Where one fails, those before it are counted. Returns how many there are; how many
        times as many substeps the next step needs is written into the contacts.
        """
        if not again:
            self._held = None
        before, made, substep, part = state.time, 0, 0, 0
        first, why = 0 if self._contact is None or self._contact.first else -1, soft.OTHER_SUBSTEPS
        try:
            while made < steps and self._parts:
                why = soft.PYTHON
                if self._is_compiled[part]:
                    where = substep, part, first, cause
                    why, done, substep, part = self._advance(state, span, steps - made, made, where)
                    cause, made = -1, made + done
                if why == soft.DIVERGED:
                    check_finite(state, span.start + (made + 1) * span.dt)
                elif why in (soft.SLEEP_PENDING, soft.WALL_PENDING):
                    part = 0
                    self._end_step(state, why, span)
                    if state.samples is not None:
                        state.samples.take(state, time_after(span.start, span.dt, made))
                    if span.finer or all_asleep(state) or self._overloaded(state, span):
                        break
                elif why in (soft.OTHER_SUBSTEPS, soft.OVERLOADED):
                    break
                elif why != soft.ALL:
                    began = time_after(span.start, span.dt, made)
                    state.moment = began + (substep + self._course[4]) * span.h
                    state.time = began + substep * span.h + self._times[part][1] * span.h
                    part += self._leave(state, why, part, span.h)
                    if self._hooked and part == len(self._parts):
                        substep, part = substep + 1, 0
                        made += substep == span.substeps
        except BaseException:
            before = time_after(before, span.dt, made)
            state.steps += made
            raise
        finally:
            state.time = before
        if self._hooked:
            self._finish(state, 1, span)
            if self._contact is not None:
                self._contact.end_substep()
        if span.finer and why != soft.ALL:
            state.contacts.substep_factor = self._needed_factor(state, span)
        self.went_through = why == soft.ALL and not self._hooked
        self.needs_others = why == soft.OTHER_SUBSTEPS and not self._hooked
        return made if self._parts else steps

    def _overloaded(self, state: State, span: Span) -> bool:
        """Whether a joint has to break."""
        acted = state.contacts.impulse_dt or span.h
        return state.joints.breakable and is_overloaded(state, state.joints.impulse / acted)

    def _needed_factor(self, state: State, span: Span) -> int:
        """Return how many times as many substeps as configured the next step needs."""
        state.compile((needed_factor,))
        factor: int = direct_entry(needed_factor)(
            near_in(state), joints_in(state), motion_of(state), shapes_of(state), inverse_in(state),
            state.bodies.force, self._plan(state, span, 0, 0), self._softness(state),
            state.contacts.impulse_dt,
        )  # fmt: skip
        return factor

    def _plan(self, state: State, span: Span, made: int, first: int) -> Plain[Plan]:
        """Return the numbers that the loop goes by after ``made`` steps."""
        simulation = state.simulation
        return (
            span.substeps, simulation.iterations or 0, span.h, span.dt, time_after(span.start, span.dt, made),
            span.rested, first, simulation.dt / simulation.substeps, span.finer,
        )  # fmt: skip

    def _softness(self, state: State) -> Plain[Softness]:
        """Return the spring of contacts."""
        return (0.0, 0.0, 0.0) if self._resolve is None else self._resolve.softness(state)

    def _leave(self, state: State, why: int, part: int, h: float) -> int:
        """Do in Python what the loop has come back for; return at how many parts further it goes on."""
        if why == soft.PYTHON:
            self._python[part](state, h)
            if self._edits:
                state.contacts.counts[FOLLOWED] = 0  # shapes may be others
        elif why == soft.PAIRS_STALE and self._broad_phase is not None:
            if self._broad_phase.index_bodies(state):
                return 0
            self._timed(self._broad_phase, self._broad_phase.list_pairs, state, h)
        elif why == soft.BLOCKS_FULL and self._contact is not None:
            self._timed(self._contact, self._contact.make_wide, state, h)
        elif why == soft.WAKE_PENDING and self._sleep is not None:
            self._timed(self._sleep, self._sleep.wake_touched_islands, state, h)
        return 1

    def _end_step(self, state: State, why: int, span: Span) -> None:
        """Put islands to sleep, or bring bodies back within the bounds, at the end of a step."""
        state.checkpoint.take(motion_of(state), state.counts)
        state.account.begin_step()
        state.account.is_open = True  # the loop has not seen what is done here
        if why == soft.SLEEP_PENDING and self._sleep is not None:
            self._timed(self._sleep, self._sleep.put_islands_to_sleep, state, span.dt)
        if state.contacts.outside:
            return_inside(state, self._schedule)

    def _advance(
        self, state: State, span: Span, steps: int, made: int, where: tuple[int, int, int, int]
    ) -> tuple[int, int, int, int]:
        """Run the loop as far as it goes; return why it ended, after how many steps, and where."""
        began = time.perf_counter_ns()
        contacts, (substep, part, first, cause) = state.contacts, where
        plan, arguments = self._plan(state, span, made, first), self._arguments(state, span.h)
        samples = None if self._hooked else state.samples
        due = sampled(samples, time_after(span.start, span.dt, made), span.dt, steps)
        why, done, substep, part, finished_impacts, impacts, evaluations, contacts.impulse_dt = self._entry(
            steps, substep, part, plan, self._course, cause, *arguments, due
        )
        state.force_evaluations += evaluations
        contacts.changed()
        state.collisions += finished_impacts
        if done and not self._hooked:
            self._finish(state, done, span)
            state.checkpoint.counts = state.counts
        state.collisions += impacts - finished_impacts
        self._nanoseconds += time.perf_counter_ns() - began
        self._schedule.defer(self._settle)
        if why not in (soft.ALL, soft.PAIRS_STALE) and (why != soft.PYTHON or self._edits):
            self._held = None  # arrays may be replaced where it has come back; a list says so
        return why, done, substep, part

    def _finish(self, state: State, steps: int, span: Span) -> None:
        """Count steps that were made."""
        state.force_evaluations += steps * span.substeps * self._evaluates
        self._steps += steps
        self._substeps += steps * span.substeps

    def _arguments(self, state: State, h: float) -> tuple[Any, ...]:
        """Return the arguments of the loop; those that change only with structure or laws are kept."""
        contacts = state.contacts
        if self._replaced != contacts.replaced:
            self._held, self._replaced = None, contacts.replaced
        held = self._held = self._held or self._present_arguments(state, h)
        return (*held, contacts.impulse_dt, contacts.step_log, self._cost)

    def _present_arguments(self, state: State, h: float) -> tuple[Any, ...]:
        """Return those of a call that no call before it tells."""
        contacts, sleep = state.contacts, state.sleep
        columns, shapes = state.checkpoint.columns, state.bodies.plain_shapes
        if self._columns is not columns or self._shapes is not shapes:
            self._columns, self._shapes = columns, shapes
            self._fixed = self._fixed_arguments(state)
            self._entry = soft.advance  # which looks at the types of the arrays once
        else:
            self._entry = direct_entry(soft.advance)
        motion, gravity, laws, marked = self._fixed
        acting = (*gravity, speculative_margin(state, h), self._accounts.other)
        bodies = state.bodies
        packed = bodies.packed, self._addresses(state) if self._packs else self._packed[1]
        sleepers = (
            self._sleep is not None, sleep.count, sleep.asleep, sleep.rest, sleep.slowest, marked,
            contacts.inactive, contacts.sleeping, sleep.forces, sleep.unverified,
        )  # fmt: skip
        damping, fat, bounds = laws
        if self._broad_phase is not None:
            fat = self._broad_phase.fat
        return (
            *motion, acting, packed, self._springs, sleepers, damping, fat, bounds, near_in(state),
            joints_in(state), contacts.opened, self._softness(state),
        )  # fmt: skip

    def _addresses(self, state: State) -> NDArray[np.int64]:
        """Return the addresses (n, 3) of the forces that are compiled."""
        calls, known = [force.calls(state) for force in self._forces], self._packed[0]
        if not calls:
            return self._packed[1]
        if not known or any(new is not old for new, old in zip(calls, known, strict=True)):
            self._packed = calls, np.concatenate(calls)
        return self._packed[1]

    def _fixed_arguments(self, state: State) -> tuple[tuple[Any, ...], tuple[Any, ...], tuple[Any, ...], Any]:
        """Return the columns in order, masses and uniform gravity, the laws, and room for marks."""
        bodies, physics, accounts = state.bodies, state.physics, self._accounts
        mass = state.table(Mass)
        gravity = (
            mass["mass"], mass["inertia"], bodies.inverse_mass, bodies.inverse_inertia, accounts.gravity.x,
            accounts.gravity.y,
        )  # fmt: skip
        columns = (
            motion_of(state), state.checkpoint.numbers, shapes_of(state), materials_of(state),
            inverse_in(state), bodies.sub_integrated, acting_in(state),
        )  # fmt: skip
        laws = (physics.linear_damping, physics.angular_damping), blank_boxes(0), bounds_of(state)
        return columns, gravity, laws, np.zeros_like(state.sleep.asleep)

    # ---- what they cost ------------------------------------------------------------------------------------

    def _settle(self) -> None:
        """Note as many calls as the stages would have made; the time is divided by the loop's own clock.

        Earlier results count half as much: the last steps may be too few to have been timed.
        """
        costs: list[int] = self._cost[: soft.STEPS].tolist()
        total, timings = max(1, sum(costs)), self._schedule.timings
        for system, calls in self._calls.items():
            timing, shared = timings[system.name], 1
            if isinstance(system, ForceSystem):
                place, shared = soft.GRAVITY, max(1, len(self._forces))
            else:
                place = _COSTS[type(system)]
                shared = 2 if place == soft.RESOLVE and self._joined else 1
            once = isinstance(system, SleepSystem) and not self._hooked
            timing.calls += self._substeps * calls + self._steps * once
            timing.nanoseconds += self._nanoseconds * costs[place] // (total * shared)
        self._cost[: soft.STEPS] //= 2
        self._steps = self._substeps = self._nanoseconds = 0

    def _timed(self, system: System, call: Callable[[State, float], None], state: State, h: float) -> None:
        """Call a system's method, whose call is counted with the step, and note what it cost."""
        began = working_ns()
        call(state, h)
        self._schedule.note(system.name, 0, working_ns() - began)
