"""A world: a state, the systems that act on it, and the stepper that advances it."""

import math
import sys
from collections.abc import Iterable, Iterator
from typing import Never

import numpy as np

from physicslab.contacts.arguments import motion_of
from physicslab.contacts.islands import check_edits, follow_rows, wake_all
from physicslab.ecs.config import MAX_TIME, MIN_TIME, PhysicsConfig, SimulationConfig
from physicslab.ecs.fields import Field
from physicslab.kernels.clock import time_after
from physicslab.kernels.tiers import begin_run
from physicslab.ode.closed_form import NoClosedForm
from physicslab.state.masses import derive_masses, quiet
from physicslab.stepping.accounting import book_account, close_account, open_account
from physicslab.stepping.breaks import Overloaded, time_of_break
from physicslab.stepping.facade import Facade
from physicslab.stepping.flow import NotSmooth
from physicslab.stepping.forces import add_up_forces
from physicslab.stepping.islands import Islands
from physicslab.stepping.keyframe import Keyframe
from physicslab.stepping.plan import StepPlan, default_plan
from physicslab.stepping.planning import plan_for_jumps
from physicslab.stepping.repeat import Repeat
from physicslab.stepping.run import refuse_unnamed, run_through, strides
from physicslab.stepping.select import Steppers, choose, remake, restart, resume, settle
from physicslab.stepping.small import smallness_of
from physicslab.stepping.soft import Soft
from physicslab.stepping.stepper import Advance, Advancer
from physicslab.stepping.undo import StepTransaction, go_back
from physicslab.systems.accelerate import AccelerateSystem
from physicslab.systems.breaking import load_of
from physicslab.systems.integrate import warn_of_what_stands_still
from physicslab.systems.schedule import Schedule
from physicslab.systems.standard import standard_systems
from physicslab.systems.system import Stage, System

_STEP = Field("dt", "number", minimum=MIN_TIME, maximum=MAX_TIME, unit="s", owner="step")


class World(Facade):
    """Entities, a clock, and the systems that act on them.

    Parameters
    ----------
    *just : System
        Just these systems run, in this order within a stage; without any, those of
        :func:`physicslab.systems.standard.standard_systems` that the contents need. Forces always turn into
        velocities; velocities move bodies where :class:`IntegrateSystem` is one of them.
    systems : iterable of System, optional
        The same; an empty one is a world without systems.
    physics : PhysicsConfig, optional
        The laws. Assign new ones at any time.
    simulation : SimulationConfig, optional
        How they are stepped, likewise.

    Attributes
    ----------
    schedule : Schedule
        The systems: which run, at what cost, and what was left out.
    plan : StepPlan
        The method that moves the bodies, how collisions are found, and why.
    steppers : Steppers
        Steppers that can advance this world as it is now, the best first.
    stepper : Advancer, optional
        The stepper of the last step: one of them, or the islands.
    islands : Islands
        The bodies that have nothing to do with each other, each with steppers of their own.

    Notes
    -----
    Each world lives in an esper context of its own, so worlds never mix. A new world is esper's active one
    until another is made or activated; every method enters its own context and leaves the one before. That
    context is one for the whole process: one thread at a time works with worlds, and others wait. So a system
    must not wait for a thread that uses a world. Worlds that are to run at the same time need a process each.

    Examples
    --------
    >>> from physicslab.components import Mass, Transform, Velocity
    >>> from physicslab.systems.gravity import GravitySystem
    >>> world = World(GravitySystem())
    >>> ball = world.spawn(Transform((0, 5)), Velocity(), Mass(2.0))
    >>> world.step(0.01)
    >>> round(world.component(ball, Velocity).linear.y, 12)
    -0.0981
    """

    __slots__ = ("_mark", "_motion", "_repeat", "islands", "plan", "schedule", "stepper", "steppers")

    def __init__(
        self,
        *just: System,
        systems: Iterable[System] | None = None,
        physics: PhysicsConfig | None = None,
        simulation: SimulationConfig | None = None,
    ) -> None:
        if (just and systems is not None) or not isinstance(systems, Iterable | None):
            raise TypeError("World takes systems one after the other, or a list as systems=[...]; not both")
        chosen = just or (standard_systems() if systems is None else tuple(systems))
        super().__init__(physics, simulation)
        self.schedule = Schedule((AccelerateSystem(), *chosen))
        self.plan: StepPlan = default_plan(self.simulation)
        self.steppers = Steppers((), ())
        self.stepper: Advancer | None = None
        self.islands = Islands(self.schedule, _island_world)
        self._motion = motion_of(self)
        self._mark: Keyframe | None = None
        self._repeat: Repeat | None = None

    # ---- time ----------------------------------------------------------------------------------------------

    @quiet
    def step(self, dt: float | None = None) -> None:
        """Advance by one step of ``dt`` seconds (``simulation.dt`` where none is given), in substeps.

        A step longer than ``simulation.dt`` is divided into ``step_divisions`` parts, so that no substep is
        longer than the scene's own. A method that is exact or chooses its steps takes it whole.

        Raises
        ------
        Diverged
            If a value would not be finite; the world is then as it was before the step.
        """
        h = self.simulation.dt if dt is None else _STEP.check(dt)
        if not self.steps:
            begin_run(smallness_of(self))
        with self.active():
            self._follow(numbers=True)
            self.advance(h, 1)
        self.time = time_after(self.time, h)

    def advance(self, h: float, steps: int) -> int:
        """Make ``steps`` steps of ``h`` seconds, or fewer, with the best stepper; return how many.

        The clock is the caller's. Where that fails or is broken off, the world goes back to before the step.
        A step in which a joint breaks is two: until then, and without it.
        """
        if not self.steps and self._mark is None and self.islands.divides:
            self.mark()
        repeat, self._repeat = self._repeat, None
        if repeat is not None and not (repeat.h == h and repeat.stepper.ready(self, h)):
            repeat = None
        try:
            return self.attempt(h, steps, 1.0, repeat)
        except Overloaded as found:
            if not self.islands.divides:
                raise  # the world that this one is an island of divides the step
            safe, load = found.steps - 1, found.load
        if steps > 1:
            return self.advance(h, max(1, safe))
        at, start = time_of_break(self.attempt, h, load), self.time
        self.attempt(at, 1, math.inf)
        if h - at < MIN_TIME:
            return 1
        self.steps, self.time = self.steps - 1, start + at
        try:
            self._follow(numbers=True)
            return self.advance(h - at, 1)
        finally:
            self.time = start

    def attempt(self, h: float, steps: int, bears: float, repeat: Repeat | None = None) -> int:
        """Advance, by ``repeat`` where given; raise ``Overloaded`` for loads on joints beyond ``bears``."""
        if self.stale:  # as where a step was undone
            self._follow(numbers=True)
        with StepTransaction(self, self._motion):
            self._prepare(h)
            made = self._advance(h, steps, repeat)
            if self.account.is_open:
                close_account(self, self.schedule.forces)
            loaded = repeat is None and bears < math.inf and (steps > 1 or self.islands.divides)
            load = load_of(self) if loaded else 0.0
            tried = bears == -math.inf  # a trial leaves nothing behind, by whatever stepper it was made
            if tried or (load > bears and not any(isinstance(part.stepper, Soft) for part in self.parts)):
                raise Overloaded(made.steps, load)
            self.schedule.run(Stage.FINISH, self, h * made.steps)
        self.count_steps(made.steps, made.divisions)
        self._repeat = Repeat.of(self, self.schedule, self.steppers, h, self.stepper, repeat)
        self._follow_islands()
        return made.steps

    def go_on(self, h: float, steps: int) -> int:
        """Make steps as the last ones were, as an island; return how many (:meth:`Repeat.make`)."""
        return 0 if self._repeat is None else self._repeat.make(self, self.schedule, h, steps)

    def _prepare(self, h: float) -> None:
        """Begin a step; what is written at PREPARE is booked with what was written before."""
        if self.account.start is None:
            open_account(self, self.schedule.forces)
        self.schedule.run(Stage.PREPARE, self, h)
        self.account.is_open = False

    def _advance(self, h: float, steps: int, repeat: Repeat | None) -> Advance:
        """Advance with the best stepper; choose again where its numbers do not apply any more."""
        try:
            made = self._make(h, steps, repeat)
        except NoClosedForm:  # a body was given another velocity, or another spring
            self.plan, self.steppers = choose(self, self.schedule)
            made = self._make(h, steps)
        except NotSmooth:
            go_back(self)
            plan = plan_for_jumps(self, self.schedule, self.plan)
            self.plan, self.steppers = remake(self, self.schedule, plan)
            self._prepare(h)
            made = self._make(h, steps)
        start, begun = self.time, 0.0
        try:
            while not made.steps:  # it is not ready for this step any more, or for what is left of it
                begun += made.begun
                self.time = start + begun
                made = self._make(h - begun, 1 if begun else steps)
        finally:
            self.time = start
        return made

    def _make(self, h: float, steps: int, repeat: Repeat | None = None) -> Advance:
        """Make steps by ``repeat``, or the best stepper for the coming one, with its kernels compiled."""
        self.stepper = stepper = self.stepper_for(h) if repeat is None else repeat.stepper
        self.steppers.use(stepper)
        self.compile(stepper.kernels)
        if not (stepper.keeps_balance or self.account.is_open):
            open_account(self, self.schedule.forces, unedited=repeat is not None)
        if repeat is not None:
            return stepper.repeat(self, h, steps)
        apart = None if stepper.samples else self.samples
        ahead = steps if apart is None else min(steps, apart.steps_ahead(self.time))
        made = stepper.advance(self, h, self.steppers.at_once(stepper, ahead))
        if apart is not None and made.steps:
            apart.take(self, self.time + made.steps * h)
        self._follow_islands()
        return made

    def stepper_for(self, h: float) -> Advancer:
        """Return the best stepper for a coming step of ``h`` seconds."""
        return self.islands if self.islands.members else self.steppers.ready(self, h)

    def steps_ahead(self, h: float) -> int:
        """Return how many steps of ``h`` seconds may be one call."""
        return sys.maxsize if self.islands.members else self.islands.steps_ahead(self, h)

    def run(
        self, *wrong: Never, seconds: float | None = None, steps: int | None = None,
        at_most: float | None = None,
    ) -> None:  # fmt: skip
        """Advance by a time or by a number of steps.

        ``world.time`` grows by exactly ``seconds``: the last step is shortened where they are no multiple of
        dt. Where no system looks at each step, many are made in one compiled loop.

        Raises
        ------
        TimeoutError
            If it is not at its end after ``at_most`` seconds of wall clock, compiling left out. The world
            stands where it has come to. Smooth motion is divided for it, which changes last digits.
        """
        refuse_unnamed("run", wrong)
        run_through(self, seconds, steps, at_most)

    def stepping(
        self, *wrong: Never, seconds: float | None = None, steps: int | None = None, stride: int = 1,
        patience: float = math.inf,
    ) -> Iterator[int]:  # fmt: skip
        """Advance like :meth:`run`, yielding the number of steps done after every ``stride`` steps.

        The steps in between are one compiled loop where possible. With ``patience`` it yields also where
        about so many seconds of wall clock have passed since the last yield; smooth motion is not divided.
        """
        refuse_unnamed("stepping", wrong)
        return strides(self, seconds, steps, stride, patience)

    # ---- moments -------------------------------------------------------------------------------------------

    def mark(self) -> None:
        """Keep the present moment, to which :meth:`reset` goes back."""
        self._mark = Keyframe(self, self._mark)

    def reset(self) -> None:
        """Go back to the moment of :meth:`mark`, or to that before the first step.

        Everything is as it was then, entities, laws and clock, and goes on with the same bits.
        """
        if self._mark is not None:
            self._mark.restore(self)

    def copy(self) -> "World":
        """Return another world at this moment, with the same entities, which goes on with the same bits."""
        with self.active():  # a new world is the active one until the end of the block
            _, *systems = self.schedule.systems
            other = World(systems=[system.fresh() for system in systems])
            Keyframe(self).fill(other)
        other.view, other.desk = self.view, self.desk
        return other

    __copy__ = copy

    def __deepcopy__(self, memo: object) -> "World":
        return self.copy()

    # ---- structure -----------------------------------------------------------------------------------------

    def synchronise(self) -> None:
        """Follow the present entities and components, and compute their masses, as each step does first."""
        with self.active():
            self._follow(numbers=True)

    def _follow(self, *, numbers: bool = False) -> None:
        """Follow what changed in the structure of the world since the last call; in the numbers as well."""
        if self.in_step:
            return
        if numbers and self._repeat is not None and self._repeat.holds(self, self.islands):
            self.generation += 1
        elif not numbers and not self.stale and self.entity_index.is_synchronous():
            self._repeat, self._behind = None, False  # a frame takes dozens of batches
        else:
            self._follow_edits(numbers)

    @quiet
    def _follow_edits(self, numbers: bool) -> None:
        """Follow what changed, whatever that was."""
        self._repeat = None
        self.in_step = True  # a batch that is taken meanwhile follows nothing
        self._behind = False
        try:
            if self.entity_index.synchronise() or self.stale:
                self._adapt()
            if numbers:
                self.generation += 1
                derive_masses(self)
                joined = self.joints.refresh(self.entity_index)
                if joined and self.sleep.count:
                    wake_all(self)
                if joined and not self.schedule.holds(self):
                    self.plan, self.steppers = remake(self, self.schedule, None)
                elif joined or not self.steppers.hold(self):
                    self.plan, self.steppers = choose(self, self.schedule)
                self.islands.follow(self)
                self._follow_islands()
                if not self.islands.members:
                    check_edits(self)
        finally:
            self.in_step = False

    def _adapt(self) -> None:
        """Compute masses and choose systems and steppers again, until nothing changes any more."""
        if self.entity_index.motion_edited:
            self.islands.give_back(self)
            self.islands.find_again()
        while True:
            self.stale = True  # and stays so if a system refuses what it finds
            self.generation += 1
            self._motion = motion_of(self)
            follow_rows(self)
            derive_masses(self)
            check_edits(self)
            self.schedule.remake(self)
            if not self.entity_index.synchronise():
                break  # else springs and joints went with their bodies: rows are numbered again
        plan = None if self.entity_index.motion_edited else self.plan
        self.plan, self.steppers = settle(self, self.schedule, plan)
        self.revision += 1
        self.motion_edits += self.entity_index.motion_edited
        if self.entity_index.motion_edited:
            self.fastest_rates.clear()
        self.stale = self.entity_index.motion_edited = False
        warn_of_what_stands_still(self.schedule)

    def _follow_islands(self) -> None:
        """Choose systems and steppers again, and the method, where all islands have become one."""
        if self.islands.joined:
            self.islands.joined = False
            self.plan, self.steppers = remake(self, self.schedule, None)

    def resume(self, collisions: str, method: str, steps: int) -> None:
        """Go on with what was chosen before this world was saved (:attr:`StepPlan.kept`), where possible."""
        self.plan, self.steppers = resume(self, self.schedule, (collisions, method, steps))

    def adopt(self, plan: StepPlan, remade: int) -> None:
        """Go on by a plan of an earlier moment, with steppers that keep nothing of the steps made since.

        Systems are chosen again unless that was not done since they were ``remade`` so often.
        """
        with self.active():
            if self.schedule.remade == remade and self.plan == plan:
                self.steppers = restart(self, self.schedule, plan, self.steppers)
            else:
                self.plan, self.steppers = remake(self, self.schedule, plan)

    def edited(self) -> None:
        """Note that columns or components were changed from outside: measurements over time begin again."""
        self.revision += 1
        self.motion_edits += 1
        self.fastest_rates.clear()
        self._repeat = None

    @quiet
    def book_edits(self) -> None:
        """Book what was changed since the last step, or since this was called last, in the accounts.

        Each step does so first; around an edit it keeps that apart from what a hand does in the same step.
        """
        with self.active():
            self._follow(numbers=True)
            book_account(self, self.schedule.forces)

    def install(self, *systems: System) -> None:
        """Add systems to this world, after those of the same stage, as a window does that shows it."""
        self.schedule.extend(systems)
        self.stale = True
        self.entity_index.motion_edited |= any(system.acts_within_step() for system in systems)

    # ---- looking -------------------------------------------------------------------------------------------

    @property
    def parts(self) -> "tuple[World, ...]":
        """The worlds that advance this one: itself, or those of its islands, that with most bodies first."""
        worlds = [one.state for one in self.islands.members if isinstance(one.state, World)] or [self]
        return tuple(sorted(worlds, key=lambda part: -int(np.count_nonzero(part.bodies.inverse_mass))))

    @property
    def plans(self) -> tuple[StepPlan, ...]:
        """The plans by which it is advanced: its own, or those of its islands, in the order of ``parts``."""
        return tuple(part.plan for part in self.parts)

    @quiet
    def add_up_forces(self) -> None:
        """Update ``bodies.force`` and ``.torque`` to the forces that act.

        The stages of a step leave them there, and a compiled flow does not. The motion is not changed.
        """
        if self.islands.members or not all(stepper.leaves_forces for stepper in self.steppers.usable):
            with self.active():
                add_up_forces(self, self.schedule)

    def frame(self, stage: Stage, dt: float) -> None:
        """Run the systems of a stage that belongs to frames: ``INPUT``, ``RENDER`` or ``HUD``."""
        with self.active():
            self.synchronise()
            self.schedule.run(stage, self, dt)


def _island_world(systems: Iterable[System], physics: PhysicsConfig, simulation: SimulationConfig) -> World:
    """Return a world for an island of another: it is one itself."""
    world = World(systems=systems, physics=physics, simulation=simulation)
    world.islands, world.is_part = Islands(world.schedule, None), True
    return world
