"""A run: how long it is, in whole steps and a rest, and how it goes on, a call of a stepper at a time."""

import math
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Protocol

from physicslab.ecs.component import InvalidValue
from physicslab.ecs.config import MIN_TIME, SimulationConfig
from physicslab.ecs.fields import Field
from physicslab.kernels.clock import time_after
from physicslab.kernels.tiers import begin_run
from physicslab.state.masses import Diverged, quiet
from physicslab.state.samples import Samples, moving_rows
from physicslab.state.state import State
from physicslab.stepping.flow import Flow
from physicslab.stepping.small import smallness_of
from physicslab.stepping.stepper import Advancer
from physicslab.systems.schedule import Schedule

_STEPS = Field("steps", "whole", minimum=0, maximum=2**53, owner="run")
_SECONDS = Field("seconds", "number", minimum=0.0, unit="s", owner="run")
_STRIDE = Field("stride", "whole", minimum=1, owner="stepping")
_AT_MOST = Field("at_most", "number", above=0.0, unit="s", owner="run")
_SAMPLED, _SAMPLED_STEPS = 2_048, 16
"""Samples of bodies that are taken at most before systems look at them, of at least so many steps.

Where steps are made one by one, room for more would take as long as the steps."""
_LOOK_S, _LOOK_STEPS = 0.1, 1000
"""So long [s], and so many steps of smooth motion, a run goes on before the clock is looked at."""


@dataclass(frozen=True, slots=True)
class RunLength:
    """The steps of a run.

    Attributes
    ----------
    seconds : float
        How long it takes [s].
    dt : float
        The length of a whole step [s].
    whole : int
        How many of those there are.
    rest : float
        The length of one more, shorter or a little longer, step [s]; 0 where there is none.
    is_time : bool
        Whether it is the time that was given, after which the clock shows exactly that much more.
    """

    seconds: float
    dt: float
    whole: int
    rest: float
    is_time: bool

    @property
    def steps(self) -> int:
        """How many steps there are in all."""
        return self.whole + 1 if self.rest else self.whole

    def elapsed(self, done: int) -> float:
        """Return the time after ``done`` steps [s]; after all of them, exactly that of the run."""
        return done * self.dt if done < self.steps else self.seconds


class Stepped(Protocol):
    """The parts of a world that a run needs."""

    time: float
    steps: int
    schedule: Schedule
    samples: Samples | None

    @property
    def simulation(self) -> SimulationConfig:
        """Return how the world is stepped."""

    @property
    def compile_s(self) -> float:
        """Return how long compiling has taken [s]."""

    def active(self) -> AbstractContextManager[object]:
        """Make this the world that plain esper calls act on, within a ``with`` block."""

    def synchronise(self) -> None:
        """Follow the present entities and components."""

    def advance(self, h: float, steps: int) -> int:
        """Make steps of ``h`` seconds; return how many."""

    def stepper_for(self, h: float) -> Advancer:
        """Return the best stepper for a coming step of ``h`` seconds."""

    def steps_ahead(self, h: float) -> int:
        """Return how many steps of ``h`` seconds may be one call."""


def run_length(world: Stepped, seconds: float | None, steps: int | None) -> RunLength:
    """Return the length of a run of so many seconds, or of so many steps.

    Raises
    ------
    TypeError
        If both are given, or neither.
    InvalidValue
        If it is not one that can be.
    """
    if (seconds is None) == (steps is None):
        raise TypeError("give either seconds or steps")
    dt = world.simulation.dt
    if seconds is None:
        count: int = _STEPS.check(steps)
        if not math.isfinite(world.time + count * dt):
            raise InvalidValue("run", "steps", steps, f"so few that {dt!r} s each lead to a finite time")
        return RunLength(count * dt, dt, count, 0.0, False)
    seconds = _SECONDS.check(seconds)
    return RunLength(seconds, dt, *_whole_steps(seconds, dt), True)


def _whole_steps(seconds: float, dt: float) -> tuple[int, float]:
    """Divide a time into steps of ``dt``: return how many, and the length of one more that makes up the rest.

    Where the time is a multiple of ``dt`` up to rounding, there is no rest. A rest too short to be a step of
    its own is taken together with the last whole step.
    """
    if not seconds / dt < 2**53:
        raise InvalidValue("run", "seconds", seconds, f"less than 2**53 steps of dt = {dt!r} s")
    if seconds < MIN_TIME:
        return 0, 0.0
    whole = round(seconds / dt)
    if whole and abs(seconds - whole * dt) <= 4.0 * math.ulp(seconds):
        return whole, 0.0
    whole = math.floor(seconds / dt)
    if whole and seconds - whole * dt < 0.001 * dt:
        whole -= 1
    return whole, seconds - whole * dt


def run_through(world: Stepped, seconds: float | None, steps: int | None, at_most: float | None) -> None:
    """Advance by a time or a number of steps, as :meth:`World.run` says."""
    if at_most is None:
        for _ in strides(world, seconds, steps, sys.maxsize, math.inf):
            pass
        return
    longest, length = _AT_MOST.check(at_most), run_length(world, seconds, steps)
    began = time.perf_counter() - world.compile_s
    for done in strides(world, seconds, steps, _LOOK_STEPS, _LOOK_S):
        if done < length.steps and time.perf_counter() - world.compile_s - began >= longest:
            raise TimeoutError(
                f"run: stopped after {longest:g} s of wall clock (at_most) at t = {world.time:.9g} s, "
                f"after {done} of {length.steps} steps"
            )


def refuse_unnamed(method: str, values: tuple[object, ...]) -> None:
    """Refuse arguments of a method that tell by no name whether they are seconds or steps."""
    if values:
        given = ", ".join(map(repr, values))
        raise TypeError(f"{method}({given}): say {method}(seconds={values[0]!r}) or {method}(steps=...)")


def strides(
    world: Stepped, seconds: float | None, steps: int | None, stride: int, patience: float
) -> Iterator[int]:
    """Return what advances by a time or a number of steps, and yields as :meth:`World.stepping` says."""
    length, checked = run_length(world, seconds, steps), _STRIDE.check(stride)
    return strides_as_it_goes(world, length, lambda: checked, patience)


def strides_as_it_goes(
    world: Stepped, length: RunLength, stride: Callable[[], int], patience: float
) -> Iterator[int]:
    """Return the same; ``stride`` gives, for the world as it is, the steps between two yields."""
    assert isinstance(world, State)
    first = begin_run(smallness_of(world))
    due, divided = time.monotonic() + patience, first is not None or patience < math.inf
    at_once = 1 if divided else sys.maxsize
    start, done = world.time, 0
    if not length.steps:
        world.time += length.seconds  # which is nothing, or too short for anything to move
    while done < length.steps:
        before, clock, began = world.steps, world.time, time.monotonic()
        try:
            with world.active():
                made = _go_on(world, length, done, stride, at_once, patience < math.inf)
        except Diverged:
            world.time = time_after(clock, length.dt, world.steps - before)
            raise
        done += made
        exactly = length.is_time and done == length.steps
        world.time = start + length.seconds if exactly else time_after(world.time, length.dt, made)
        if first is not None:
            first.foresee(done / length.steps)
        taken = time.monotonic() - began
        if taken < 0.25 * patience:
            at_once = min(2 * at_once, stride())
        elif taken > patience:
            at_once = max(at_once // 2, 1)
        if done % stride() == 0 or done == length.steps or time.monotonic() >= due:
            yield done
            due = time.monotonic() + patience


@quiet
def _go_on(
    world: Stepped, length: RunLength, done: int, stride: Callable[[], int], at_once: int, is_patient: bool
) -> int:
    """Go on with a run of which ``done`` steps are made, as far as one call goes; return how many it made.

    A stepper that goes step by step makes ``at_once`` at most where the run has patience, or where its
    kernels are interpreted. That changes no bit.
    """
    assert isinstance(world, State)
    world.synchronise()
    h = length.dt if done < length.whole else length.rest
    wanted = stride() - done % stride()
    taken = world.samples
    if world.schedule.observer is not None:
        return world.advance(h, 1)
    if world.schedule.samplers:
        room = max(_SAMPLED // max(1, len(moving_rows(world))), _SAMPLED_STEPS)
        wanted = max(1, min(wanted, length.steps - done, room))
        world.samples = taken or Samples(world, world.time, h, 1, wanted)
    try:
        return _advance(world, length, done, h, wanted, at_once, is_patient)
    finally:
        world.samples = taken


def _advance(
    world: Stepped, length: RunLength, done: int, h: float, wanted: int, at_once: int, is_patient: bool
) -> int:
    """Advance by at most ``wanted`` steps of ``h`` seconds, as far as one call goes; return how many."""
    best = world.stepper_for(h)
    count = max(1, min(wanted, length.whole - done, world.steps_ahead(h)))
    if not best.leaps:
        may = at_once < count and (is_patient or not all(one.compiled for one in best.kernels))
        divides = may and best.divisible
        return world.advance(h, at_once if divides else count)
    if isinstance(best, Flow) and best.whole and wanted >= length.steps - done:
        return _leap(world, length.seconds - length.elapsed(done), 1, length.steps - done)
    return _leap(world, h, count, count)


def _leap(world: Stepped, h: float, parts: int, steps: int) -> int:
    """Advance by ``parts`` times ``h`` at once, which count as ``steps``; return how many were made.

    Where that fails it is halved, until the one step that cannot be made is found; the world is then as it
    was before that step.
    """
    start, made = world.time, 0
    try:
        made = world.advance(h, parts)
    except Diverged:
        if steps == 1:
            raise
    if made:
        world.steps += steps - parts if made == parts else 0
        return steps if made == parts else made
    first = steps // 2
    halves = ((h, first, first), (h, parts - first, steps - first))
    if parts == 1:
        own = first * world.simulation.dt
        halves = ((own, 1, first), (h - own, 1, steps - first))
    for span, count, counted in halves:
        world.synchronise()
        done = _leap(world, span, count, counted)
        world.time += span * (count if done == counted else done)
        made += done
        if done < counted:
            break
    world.time = start
    return made
