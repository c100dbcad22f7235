"""Scenes in which nothing but forces acts: one compiled flow, however many steps."""

import math
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape
from physicslab.integrators import Exhausted, StepTooSmall
from physicslab.integrators.dop853 import MAX_COSTLY
from physicslab.kernels.clock import time_after
from physicslab.ode.closed_form import NoClosedForm
from physicslab.ode.steady_turn import steady_turn
from physicslab.ode.system import OdeSystem
from physicslab.state.joint_figures import is_overloaded
from physicslab.state.masses import Diverged, check_finite
from physicslab.state.packed import pulls_driven_alone
from physicslab.state.samples import Samples
from physicslab.state.state import State
from physicslab.stepping.accounting import put_together
from physicslab.stepping.breaks import Overloaded
from physicslab.stepping.fastest_body import changes_fast
from physicslab.stepping.method import tolerance_for
from physicslab.stepping.plan import StepPlan
from physicslab.stepping.stepper import Advance, Stepper, Stretch, divisions
from physicslab.systems.integrate import IntegrateSystem
from physicslab.systems.joint import JointSystem
from physicslab.systems.schedule import Schedule

_PROJECTED = 16
"""Steps after which what joints hold together is put there again, by a method that chooses its steps: it is
apart by no more than the method errs by then."""
_SPAN = 256
"""The most evaluations after which that is done: some two radians of turning, whatever the unit of time.
Linkages that lie flat on their way would else go on wrongly."""
_COSTLY_S = 0.27
"""The length of a step [s] for which a method may spend what one costs at most; in proportion for longer
ones. Joints whose forces grow without limit take as much for no motion at all."""
_FOLLOWED = 1e-13
"""The largest tolerance, where it is not the configured one, with which samples are taken within steps. Their
errors are some four times it, and do not die out, as those of the steps do where a larger one is chosen."""
_FINEST = 512
"""Parts of a step, of which as many are taken together as such a span can have."""

_NONE_DUE = np.zeros(0, np.int64), np.zeros(0), np.zeros((2, 0, 0))
"""Numbers, times and motion of samples that are due within a step, where there are none."""


class NotSmooth(ArithmeticError):
    """A force in Python jumps, or those of joints grow without limit: steps that follow them end nowhere."""


class Flow(Stepper):
    """Advances the smooth motion of a world by the flow of an integrator."""

    name: str = "flow"
    title: str = "Steps as one compiled flow"
    divisible: bool = False
    samples: bool = True

    def __init__(self, state: State, schedule: Schedule, plan: StepPlan) -> None:
        self._schedule, self._plan, self._method = schedule, plan, plan.integrator
        self._ode = OdeSystem(state, schedule.smooth_forces, kicked=self._method.kicks)
        self._ode.tolerance = tolerance_for(state, schedule.forces)
        self._joined = schedule.find(JointSystem) is not None
        # Last digits depend on where motion is divided: in an island that may meet others, at each step.
        meets = state.is_part and bool((state.bodies.inverse_mass[state.batch(Shape).rows] > 0.0).any())
        self.leaps: bool = not meets or (self._joined and self._method.chooses_steps)
        # No error of a motion at a given speed shows how finely the power of its springs is to be followed.
        self._driven = pulls_driven_alone(state)
        self.kernels: tuple[Any, ...] = self._method.kernels
        self.reason = plan.reason

    @classmethod
    def why_not(cls, state: State, schedule: Schedule, plan: StepPlan) -> str | None:
        """Return what acts besides forces, or ``None``."""
        return None if plan.smooth else plan.obstacle or plan.collision_reason

    def holds(self, state: State) -> bool:
        """Whether no number was changed that the layout, or the choice of a method, depends on."""
        return not self._ode.outdated(state)

    @property
    def whole(self) -> bool:
        """Whether a run of any length is one step of the method."""
        return self._method.chooses_steps and not (self._joined or self._driven)

    def advance(self, state: State, h: float, steps: int) -> Advance:
        """Make all of the steps in one compiled loop; where joints are put together, in several."""
        exact = self._method.chooses_steps or math.isinf(self._method.order)
        parts = 1 if exact else divisions(state, h)
        begun, start = state.force_evaluations, state.time
        adaptive = self._joined and self._method.chooses_steps
        whole = _FINEST if adaptive else 1  # in a part
        free = parts * steps if self.leaps else parts
        longest = _PROJECTED * whole if adaptive else 1 if self._joined or self._driven else free
        if state.joints.breakable and (state.samples is None or state.samples.stride > 1):
            longest = whole  # loads are known at the ends of steps that are sampled
        most = MAX_COSTLY * max(1, math.ceil(h / _COSTLY_S))
        made, span, short, unedited = 0, longest, h / parts / whole, self.is_repeated
        left = most  # evaluations that the step may have that is being made
        try:
            while made < parts * steps * whole:
                span, within = min(span, parts * steps * whole - made), made % whole
                left = left if within else most
                # Whole steps, or a part of one: what a step may have is counted from its start.
                piece = min(span, whole - within) if within or span < whole else span - span % whole
                divides = adaptive and piece > 1 and left > _SPAN
                self._ode.most = _SPAN if divides else left if adaptive else None
                try:
                    self._flow(
                        state, short, piece, max(1, piece // whole), divides=divides, unedited=unedited
                    )
                except Overloaded as found:
                    found.steps += made // (parts * whole)
                    raise
                except Exhausted:
                    span, left = piece // 2, left - _SPAN
                    continue
                except NotSmooth:
                    if made and parts == 1 and not within:
                        return Advance(made // whole)  # the next call begins where it fails
                    raise
                made, state.time, unedited = made + piece, time_after(state.time, short, piece), True
                step, rest = divmod(made, parts * whole)
                if state.joints.breakable and not rest and step < steps and is_overloaded(state):
                    raise Overloaded(step)
                if state.samples is not None:
                    state.samples.take(state, state.time)
                spent, begun = state.force_evaluations - begun, state.force_evaluations
                span, left = min(2 * span, longest) if spent < _SPAN // 4 else span, left - spent
        finally:
            state.time = start
        check_finite(state, state.time + h * steps)
        return Advance(steps, parts)

    def goes_on(self, state: State) -> bool:
        """Whether no force is one in Python, which may depend on anything."""
        return not self._ode.interpreted

    def repeatable(self, state: State, stretches: Sequence[Stretch]) -> Callable[[], bool]:
        """Return what makes steps from the present places and velocities; see :class:`Repeatable`."""
        low, rates = state.remainders, dict(state.fastest_rates)

        def make() -> bool:
            state.remainders = low
            state.fastest_rates.clear()
            state.fastest_rates.update(rates)
            try:
                for began, h, steps in stretches:
                    state.time = began
                    self.advance(state, h, steps)
            except (Diverged, NotSmooth, NoClosedForm):
                return False
            return True

        return make

    def _flow(
        self, state: State, short: float, pieces: int, steps: int, *, divides: bool, unedited: bool
    ) -> None:  # fmt: skip
        """Advance by ``pieces`` times ``short`` seconds, which count as ``steps``."""
        method, ode, span = self._method, self._ode, short * pieces
        if ode.gather(state, unedited=unedited):
            ode.set_going()
        else:
            put_together(state, self._schedule.forces, ode)
        parts = 1 if method.chooses_steps else self._plan.substeps
        count, h = (1, span) if method.chooses_steps else (parts * steps, short / parts)
        start = time.perf_counter_ns()
        places, after, packed = _NONE_DUE
        if state.samples is not None:
            places, after = state.samples.due(state.time, span)
            if len(after) and after[-1] == span:  # taken at the end
                places, after = places[:-1], after[:-1]
        if len(places):
            packed = np.full((2, len(places), ode.layout.moving_count), np.nan)
            if method.samples and ode.tolerance <= max(_FOLLOWED, state.simulation.tolerance):
                ode.wanted = after, *packed
            else:
                self._sample_aside(state, after, packed)
        try:
            made = method.flow(state, ode, h, count)
        except StepTooSmall as error:
            if isinstance(error, Exhausted) and divides:
                ode.undo(state)
                raise
            if (ode.undo(state) or self._joined) and state.simulation.integrator == "auto":
                raise NotSmooth(str(error)) from error
            raise changes_fast(state, self._schedule.forces, error) from error
        if state.samples is not None and len(places):
            self._keep(state, state.samples, places, after, packed)
            if state.joints.breakable:
                self._check_loads(state, after, packed)
        ode.scatter(state, span)
        self._schedule.note(IntegrateSystem.__name__, steps, time.perf_counter_ns() - start)
        for system in ode.forces:
            self._schedule.note(system.name, made, 0)  # their time is part of the loop's
        state.force_evaluations += made

    def _check_loads(
        self, state: State, after: NDArray[np.float64], packed: NDArray[np.float64]
    ) -> None:  # fmt: skip
        """Raise where a joint bears less than its load at one of the times after now (m,) [s].

        Coordinates and rates (2, m, n) are ``packed``.
        """
        ode, n, clock = self._ode, self._ode.layout.moving_count, self._ode.layout.clock
        end, steepness = (ode.q, ode.v), ode.steepness.copy()
        ode.q, ode.v = ode.q.copy(), ode.v.copy()
        try:
            for k, span in enumerate(after.tolist()):
                ode.q[:n], ode.v[:n], ode.q[clock] = packed[0, k], packed[1, k], state.time + span
                ode.write(state)
                if is_overloaded(state):
                    raise Overloaded(k + 1)
        finally:
            (ode.q, ode.v), ode.steepness[:] = end, steepness

    def _sample_aside(self, state: State, after: NDArray[np.float64], packed: NDArray[np.float64]) -> None:
        """Find coordinates and rates (2, m, n) at times after now (m,) [s]; the motion is divided by none."""
        ode, n = self._ode, self._ode.layout.moving_count
        parts = 1 if self._method.chooses_steps else self._plan.substeps
        with ode.aside(), suppress(StepTooSmall):  # the motion itself then tells why
            for k, span in enumerate(np.diff(after, prepend=0.0).tolist()):
                steps = parts * max(1, round(span / state.simulation.dt))
                self._method.flow(state, ode, span / steps, steps)
                packed[0, k], packed[1, k] = ode.q[:n], ode.v[:n]

    def _keep(
        self, state: State, samples: Samples, places: NDArray[np.int64], after: NDArray[np.float64],
        packed: NDArray[np.float64],
    ) -> None:  # fmt: skip
        """Keep what was found as samples."""
        layout, into = self._ode.layout, samples.put(places, state.time + after)
        n = 2 * len(layout.moving)
        turning, steady = (np.searchsorted(layout.moving, rows) for rows in (layout.turning, layout.steady))
        for numbers, first in ((packed[0], 0), (packed[1], 3)):
            into[:, :, first : first + 2] = numbers[:, :n].reshape(-1, len(layout.moving), 2)
            into[:, turning, first + 2] = numbers[:, n:]
        if len(steady):
            into[:, steady, 2], into[:, steady, 5] = steady_turn(state, layout.steady, after)
