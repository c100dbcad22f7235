"""A world: entities, clock and systems, in an esper context of its own."""

from __future__ import annotations

import itertools
import math
import time
import weakref
from collections.abc import Iterator
from typing import Any

import esper
import numpy as np

from physicslab.components import Name
from physicslab.components.name import why_no_id
from physicslab.ecs.component import Batch, InvalidValue, Table
from physicslab.ecs.config import SHORTEST, PhysicsConfig, SimulationConfig
from physicslab.ecs.context import Active, switch
from physicslab.ecs.entity_index import Roster
from physicslab.ecs.fields import Field
from physicslab.integrators import StepTooSmall
from physicslab.ode.closed_form import NoClosedForm
from physicslab.ode.system import Equations
from physicslab.state.bodies import Bodies, Diverged
from physicslab.state.contacts import Contacts
from physicslab.state.sleep import Sleep
from physicslab.stepping.checkpoint import Checkpoint
from physicslab.stepping.event_driven import Flights
from physicslab.stepping.fastest_body import fastest_body
from physicslab.stepping.fused_contact import CompiledSteps, why_not_compiled
from physicslab.stepping.select import choose, provisional
from physicslab.stepping.split_forces import Tethers
from physicslab.systems.schedule import ForceSystem, Schedule, Stage, System

__all__ = ["World"]

_numbers = itertools.count(1)
_quiet = np.errstate(all="ignore")
"""What overflows becomes infinite, which is found and told as :class:`Diverged`: numpy need not warn."""
_MOST = 2**62
"""More steps than there can be."""
_MOST_PARTS = 100_000
"""Into so many parts, at the most, a step is divided that is longer than the scene's own."""
_STEP = Field("dt", "number", minimum=SHORTEST, unit="s", owner="step")
_STEPS = Field("steps", "whole", minimum=0, maximum=2**53, owner="run")
_STRIDE = Field("stride", "whole", minimum=1, maximum=_MOST, owner="stepping")
_SECONDS = Field("seconds", "number", minimum=0.0, unit="s", owner="run")
"""What the methods of a world may be given."""
_TOO_LONG = 0.01
"""By which share a step may exceed the scene's own undivided: the last one of a run may take in a rest."""


class World:
    """Entities, a clock, and the systems that act on them.

    Parameters
    ----------
    *systems : System
        Just these systems run, in this order within a stage. Forces turn into velocities without being asked.
    physics, simulation : PhysicsConfig, SimulationConfig, optional
        The laws, and how they are stepped. Assign new ones at any time.

    Attributes
    ----------
    method : Choice
        How the bodies are moved, and why so.
    tethers : Tethers, optional
        What moves the bodies that springs and drag act on where contacts act as well.
    revision : int
        How often its structure or its configuration changed: what was measured before is another world's.
    sleep : Sleep
        Who has come to rest, and is not simulated until something wakes him.
    substeps : int
        Of how many parts the last step was, or each part of one that was divided: more than
        ``simulation.substeps`` where a system found that these would not do.
    divided : int
        Into how many parts the last :meth:`step` was divided, which was longer than ``simulation.dt``; or 1.

    Notes
    -----
    Each world lives in an esper context of its own, so worlds never mix. A new world is esper's active one
    until another is made or activated; every method enters its own context and leaves the one before. That
    context is one for the whole process: one thread at a time can work with worlds. Where another does
    meanwhile, a ``RuntimeError`` says so before anything is touched. Worlds that are to run at the same time
    need a process each (``concurrent.futures.ProcessPoolExecutor``).

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

    def __init__(
        self,
        *systems: System,
        physics: PhysicsConfig | None = None,
        simulation: SimulationConfig | None = None,
    ) -> None:
        self._physics = physics or PhysicsConfig()
        self._simulation = simulation or SimulationConfig()
        self.name, self.title, self.description = "", "", ""
        self.time = 0.0
        self.steps = 0
        self.divided = 1
        # Every id that was ever given here: only one of these can be in use, so a new one costs no search.
        self._names: set[str] = set()
        self.substeps = self._simulation.substeps
        self.revision = 0
        self.force_evaluations = 0
        self.collisions = 0
        self.bodies = Bodies()
        self.contacts = Contacts()
        self.sleep = Sleep()
        self.roster = Roster()
        self.schedule = Schedule((self.bodies, *systems))
        self.has_forces = False
        self._equations: Equations | None = None
        self._flights: Flights | None = None
        self._compiled: CompiledSteps | None = None
        self.tethers: Tethers | None = None
        self._stale = True
        self._stepping = False
        self._before = Checkpoint()
        self.method = provisional(self._simulation)
        self.context = f"physicslab-{next(_numbers)}"
        self.activate()
        weakref.finalize(self, _forget, self.context)

    # ---- contexts ------------------------------------------------------------------------------------------

    def activate(self) -> None:
        """Make this the world that plain esper calls speak of, until another is activated.

        Raises
        ------
        RuntimeError
            If a world is active in another thread.
        """
        switch(self.context)

    def active(self) -> Active[World]:
        """Make this the world that plain esper calls speak of, within a ``with`` block.

        Raises
        ------
        RuntimeError
            At the start of the block, if a world is active in another thread.
        """
        return Active(self, self.context)

    # ---- entities and components ---------------------------------------------------------------------------

    def spawn(self, *components: Any, name: str | None = None) -> int:
        """Make an entity of these components and return its number.

        Systems see it from the next step on. ``name`` is its id in scene files and reports.
        """
        if name is not None:
            components = (*components, Name(name))
        kinds = [_kind(component) for component in components]
        for kind in kinds:
            if kinds.count(kind) > 1:
                raise ValueError(f"an entity has one {kind.__name__}, not {kinds.count(kind)}")
        with self.active():
            for component in components:
                self._check_name(component)
            return esper.create_entity(*components)

    def remove(self, entity: int) -> None:
        """Remove an entity with all its components; handles on them keep their last values."""
        with self.active():
            self._require(entity)
            esper.delete_entity(entity, immediate=True)

    def clear(self) -> None:
        """Remove every entity."""
        with self.active():
            for entity in esper.get_entities():
                esper.delete_entity(entity)
            self.roster.bury_dead()

    def add(self, entity: int, component: Any) -> None:
        """Give an entity a component, in place of the one of that type if it has one."""
        with self.active():
            self._require(entity)
            _kind(component)
            self._check_name(component, entity)
            esper.add_component(entity, component)

    def discard[C](self, entity: int, component: type[C]) -> C | None:
        """Take a component from an entity and return it, or ``None`` if it had none."""
        with self.active():
            self._require(entity)
            return esper.try_remove_component(entity, component)

    def component[C](self, entity: int, component: type[C]) -> C:
        """Return an entity's component.

        Raises
        ------
        KeyError
            If there is no such entity, or it has no such component.
        """
        with self.active():
            self._require(entity)
            self._follow()
            found = esper.try_component(entity, component)
            if found is None:
                raise KeyError(f"{self.label(entity)} has no {component.__name__}")
            return found

    def has(self, entity: int, component: type[Any]) -> bool:
        """Whether an entity exists and has a component."""
        with self.active():
            return esper.entity_exists(entity) and esper.has_component(entity, component)

    def components(self, entity: int) -> tuple[Any, ...]:
        """Return all components of an entity."""
        with self.active():
            self._require(entity)
            self._follow()
            return esper.components_for_entity(entity)

    def entities(self) -> list[int]:
        """Return all entities, in the order of their numbers."""
        with self.active():
            return sorted(filter(esper.entity_exists, esper.get_entities()))

    def entity(self, name: str) -> int:
        """Return the entity with this id, or raise ``KeyError``."""
        with self.active():
            entity = self._holder(name)
        if entity is not None:
            return entity
        raise KeyError(f"no entity has the id {name!r}")

    def label(self, entity: int) -> str:
        """Return the entity's id if it has one, else ``entity <number>``; of row 0 it is ``the world``."""
        if not entity:
            return "the world"
        with self.active():
            named = esper.try_component(entity, Name)
        return named.id if named is not None else f"entity {entity}"

    def _check_name(self, component: Any, entity: int = 0) -> None:
        """Refuse a Name that no scene file may hold, or that another entity than this one has."""
        if not isinstance(component, Name):
            return
        allowed = why_no_id(component.id)
        if allowed is not None:
            raise InvalidValue("Name", "id", component.id, allowed)
        if component.id in self._names and self._holder(component.id) not in (None, entity):
            allowed = f"an id of its own; entity {self._holder(component.id)} has this one"
            raise InvalidValue("Name", "id", component.id, allowed)
        self._names.add(component.id)

    def _holder(self, name: str) -> int | None:
        """Return the entity with this id, if there is one."""
        for entity, named in esper.get_component(Name):
            if named.id == name and esper.entity_exists(entity):
                return entity
        return None

    def _require(self, entity: int) -> None:
        if not esper.entity_exists(entity):
            raise KeyError(f"there is no entity {entity} in this world")

    # ---- columns -------------------------------------------------------------------------------------------

    def table(self, component: type[Any]) -> Table:
        """Return the columns of a component; rows are numbered alike in every table."""
        return self.roster.table(component)

    def batch(self, *components: type[Any]) -> Batch:
        """Return the rows of the entities that have all of ``components``."""
        return self.roster.batch(*components)

    # ---- configuration -------------------------------------------------------------------------------------

    @property
    def physics(self) -> PhysicsConfig:
        """The laws of this world."""
        return self._physics

    @physics.setter
    def physics(self, physics: PhysicsConfig) -> None:
        self._physics = physics
        self._stale = True

    @property
    def simulation(self) -> SimulationConfig:
        """How this world is stepped."""
        return self._simulation

    @simulation.setter
    def simulation(self, simulation: SimulationConfig) -> None:
        self.method = provisional(simulation)
        self._simulation = simulation
        self._stale = True

    @property
    def interpreted(self) -> tuple[str, ...]:
        """The forces that Python computes, step for step, where a compiled loop could run."""
        return self._equations.interpreted if self._equations is not None else ()

    # ---- time ----------------------------------------------------------------------------------------------

    @_quiet
    def synchronise(self) -> None:
        """Follow what entities and components there are now, and weigh them.

        The engine does so at the start of every step; what a system changes within one takes part from the
        next.
        """
        with self.active():
            self._synchronise()

    def _synchronise(self) -> None:
        """Do so where this world's context is active and numpy is quiet."""
        self._follow()
        if not self._stepping:
            self.bodies.derive(self)
            if self._equations is not None and self._equations.outdated(self):
                self._choose()
            if self._flights is not None and not self._flights.holds(self):
                self._choose()
            if self.tethers is not None and self.tethers.outdated(self):
                self._choose()
            self.sleep.check(self)

    def _follow(self) -> None:
        """Follow what changed in the structure of the world since the last call, if anything did."""
        if not self._stepping and (self.roster.synchronise() or self._stale):
            self._adapt()

    @_quiet
    def _adapt(self) -> None:
        """Weigh bodies and choose systems and method anew, until nothing changes any more."""
        while True:
            self._stale = True  # and stays so if a system refuses what it finds
            self.sleep.follow(self)
            self.bodies.derive(self)
            self.sleep.check(self)
            self._remake()
            self.revision += 1
            self._stale = False
            if not self.roster.synchronise():
                return

    def _remake(self) -> None:
        """Choose the systems and the method; who may sleep hangs on the method."""
        while True:
            exact = self.method.collisions == "exact"
            self.schedule.remake(self)
            self.has_forces = any(isinstance(system, ForceSystem) for system in self.schedule.running)
            self._choose()
            if exact == (self.method.collisions == "exact"):
                return

    def _choose(self) -> None:
        """Choose the method for what there is, and make ready what it works with."""
        self.method = choose(self)
        self._equations = Equations(self) if self.method.smooth else None
        self.bodies.tethered[:] = False
        self.tethers = None
        if self.method.tethers is not None:
            self.tethers = Tethers(self, self.method.tethers, self.method.tether_steps)
        had_flights, self._flights = self._flights is not None, None
        if self.method.collisions == "exact":
            self._flights = Flights(self)
            self.schedule.compile(self._flights.kernels)
        self._compiled = None
        if why_not_compiled(self) is None:
            self._compiled = CompiledSteps(self)
            self.schedule.compile(self._compiled.kernels)
        self.contacts.stale |= had_flights or self._flights is not None
        self.sleep.look_around(self)

    @_quiet
    def step(self, dt: float | None = None) -> None:
        """Advance by one step of ``dt`` seconds (``simulation.dt`` where none is given), in substeps.

        What is longer than ``simulation.dt`` is divided, so that no substep is longer than the scene's own:
        ``divided`` says into how many parts. A method that is exact or chooses its steps takes it whole.

        Raises
        ------
        Diverged
            If a value would not be finite; the world then stands where it stood before the step.
        """
        dt = self._simulation.dt if dt is None else _STEP.check(dt)
        if self._stepping:
            raise RuntimeError("a system cannot step the world that is calling it")
        with self.active():
            self._synchronise()
            compiled = self._compiled
            if compiled is not None and dt == self._simulation.dt and compiled.ready(self):
                self._run_compiled(compiled, 1)
                return
            self.divided = parts = self._parts(dt)
            self._before.take(self)
            self._stepping = True
            try:
                self.schedule.run(Stage.PREPARE, self, dt)
                if self.tethers is not None:
                    self.tethers.begin(self)
                if self._equations is not None:
                    self._flow(self._equations, dt / parts, parts)
                elif self._flights is None and self.sleep.everything(self):
                    self.substeps = self._simulation.substeps  # in which nothing would happen
                elif self._flights is None:
                    self.substeps = self.contacts.finer * self._simulation.substeps
                    self._go_through(dt / parts / self.substeps, parts * self.substeps)
                elif parts > 1:
                    self._flights.run(self, dt / parts, parts)
                else:
                    self._flights.step(self, dt)
                self.schedule.run(Stage.FINISH, self, dt)
                self.contacts.finer = max((system.finer(self) for system in self.schedule.running), default=1)
            except Diverged:
                self._go_back()
                raise
            finally:
                self._stepping = False
        self.time += dt
        self.steps += 1

    def _go_back(self) -> None:
        """Stand where the step that failed began."""
        self._before.restore(self)
        self._stale = True  # flights and equations hold numbers of the step that failed

    def _parts(self, dt: float) -> int:
        """Return into how many parts a step of ``dt`` is divided."""
        method = self.method.integrator
        if self._equations is not None and (method.chooses_steps or math.isinf(method.order)):
            return 1
        own = self._simulation.dt
        if dt / own > _MOST_PARTS:
            raise ValueError(f"dt = {dt!r}: must be at most {_MOST_PARTS} times simulation.dt = {own!r} s")
        return max(1, math.ceil(dt / own - _TOO_LONG))

    def _go_through(self, h: float, count: int) -> None:
        """Go through the stages of ``count`` substeps of ``h`` seconds."""
        run, stages = self.schedule.run, self.method.stages.substep
        for _ in range(count):
            for stage, share in stages:
                run(stage, self, share * h)

    def _flow(self, equations: Equations, dt: float, steps: int) -> None:
        """Advance by ``steps`` steps of ``dt`` in one compiled loop; nothing but forces acts."""
        method = self.method
        self.schedule.compile(method.integrator.kernels)
        equations.gather(self)
        parts = 1 if method.integrator.chooses_steps else method.substeps
        h, count = (dt * steps, 1) if method.integrator.chooses_steps else (dt / parts, parts * steps)
        start = time.perf_counter_ns()
        try:
            made = method.integrator.flow(self, equations, h, count)
        except StepTooSmall as error:
            label = self.label(fastest_body(self))
            what = f"{label}: Velocity changes too fast: {error}"
            raise Diverged(f"{what} (after t = {self.time:.9g} s)") from error
        except NoClosedForm:  # somebody gave a body another velocity, or another spring
            self.method = choose(self)
            self._flow(equations, dt, steps)
            return
        equations.scatter(self, dt * steps)
        self.schedule.note("IntegrateSystem", steps, time.perf_counter_ns() - start)
        for name in equations.forces:
            self.schedule.note(name, made, 0)  # their time is within the loop's
        self.force_evaluations += made

    def run(self, *, seconds: float | None = None, steps: int | None = None) -> None:
        """Advance by a time or by a number of steps.

        ``world.time`` grows by exactly ``seconds``: the last step is shortened where they are no multiple of
        dt. Where nothing but compiled forces acts and no system looks at each step, all of it is one compiled
        loop.
        """
        for _ in self.stepping(seconds=seconds, steps=steps, stride=_MOST):
            pass

    @_quiet
    def add_up_forces(self) -> None:
        """See to it that ``bodies.force`` and ``.torque`` hold the forces that act.

        The stages of a step leave them there; a compiled loop does not, and they are added up at the present
        state. Nothing that moves is changed.
        """
        if self._equations is None and self._flights is None:
            return
        with self.active():
            for system in (self.bodies, *self.schedule.running):
                if system is self.bodies or isinstance(system, ForceSystem):
                    getattr(system, system.marked()[Stage.FORCE])(self, 0.0)
            self.force_evaluations -= self.has_forces  # looking at them is no work of the method

    @_quiet
    def _leap(self, dt: float, parts: int, steps: int) -> None:
        """Advance by ``parts`` times ``dt``, which nobody looks at and which count as ``steps``.

        Where that fails it is halved, until the one step that cannot be made is found; the world then stands
        where it stood before that step.
        """
        with self.active():
            self.synchronise()
            self._before.take(self)
            self._stepping = True
            try:
                if self._flights is not None:
                    self._flights.run(self, dt, parts)
                elif self._equations is not None:
                    self._flow(self._equations, dt, parts)
                self.schedule.run(Stage.FINISH, self, dt * parts)
            except Diverged:
                self._go_back()
                if steps == 1:
                    raise
            else:
                self.time += dt * parts
                self.steps += steps
                return
            finally:
                self._stepping = False
        first = steps // 2
        if parts > 1:
            self._leap(dt, first, first)
            self._leap(dt, parts - first, steps - first)
        else:
            self._leap(first * self._simulation.dt, 1, first)
            self._leap(dt - first * self._simulation.dt, 1, steps - first)

    def _pass_over(self, steps: int) -> None:
        """Count steps in which nothing would happen, and calls of systems that would find nothing."""
        self.divided, self.substeps = 1, self._simulation.substeps
        for system in self.schedule.running:
            around = {Stage.PREPARE, Stage.FINISH} & system.marked().keys()
            self.schedule.note(system.name, steps * len(around), 0)
        self.steps += steps

    def _run_compiled(self, compiled: CompiledSteps, steps: int) -> int:
        """Make ``steps`` steps or fewer in one compiled call, in this world's context; return how many."""
        self.divided, self.substeps, self.contacts.finer = 1, self._simulation.substeps, 1
        self._before.make_room(self)  # the loop keeps the state itself
        self._stepping = True
        try:
            return compiled.run(self, steps, self._before)
        except Diverged:
            self._go_back()
            raise
        finally:
            self._stepping = False

    def stepping(
        self, *, seconds: float | None = None, steps: int | None = None, stride: int = 1
    ) -> Iterator[int]:
        """Advance like :meth:`run`, yielding the number of steps done after every ``stride`` steps.

        What lies between is one compiled loop where it can be.

        Raises
        ------
        InvalidValue
            When it is called, not when it is first advanced: if a value is none that a run can have.
        """
        return self._stepping_by(_STRIDE.check(stride), *self._plan(seconds, steps))

    def _stepping_by(self, stride: int, seconds: float, whole: int, rest: float) -> Iterator[int]:
        """Advance by so many whole steps and the rest of one, which take so many seconds."""
        dt, start, done = self._simulation.dt, self.time, 0
        last = whole + 1 if rest else whole
        if not last:
            self.time += seconds  # which is nothing, or too short for anything to move
        while done < last:
            self.synchronise()
            by_step = self._equations is None and self._flights is None
            unseen = min(stride - done % stride, whole - done)
            if unseen > 0 and not self.schedule.observed and self.sleep.everything(self):
                self._pass_over(unseen)
                done += unseen
            elif self._compiled is not None and unseen > 0 and self._compiled.ready(self):
                before = self.steps
                try:
                    with self.active():
                        done += self._run_compiled(self._compiled, unseen)
                except Diverged:
                    self.time = start + (done + self.steps - before) * dt
                    raise
            elif by_step or self.schedule.observed:
                self.step(dt if done < whole else rest)
                done += 1
            elif self._equations and self.method.integrator.chooses_steps and stride >= last - done:
                self._leap(seconds - done * dt, 1, last - done)
                done = last
            else:
                count = min(stride, whole - done) or 1
                self._leap(dt if done < whole else rest, count, count)
                done += count
            self.time = start + (done * dt if done < last else seconds)
            if done % stride == 0 or done == last:
                yield done

    def _plan(self, seconds: float | None, steps: int | None) -> tuple[float, int, float]:
        """Return how long a run takes [s], of how many whole steps, and the length of one more, or 0."""
        if (seconds is None) == (steps is None):
            raise TypeError("give either seconds or steps")
        dt = self._simulation.dt
        if seconds is None:
            count: int = _STEPS.check(steps)
            if not math.isfinite(self.time + count * dt):
                raise InvalidValue("run", "steps", steps, f"so few that {dt!r} s each lead to a finite time")
            return count * dt, count, 0.0
        seconds = _SECONDS.check(seconds)
        return seconds, *_whole_steps(seconds, dt)

    def install(self, *systems: System) -> None:
        """Let further systems act on this world, behind those of the same stage that do already.

        That is how a window looks at a world that was made without one.
        """
        self.schedule.extend(systems)
        self._stale = True

    def frame(self, stage: Stage, dt: float) -> None:
        """Run the systems of a stage that belongs to frames: ``INPUT``, ``RENDER`` or ``HUD``."""
        with self.active():
            self.synchronise()
            self.schedule.run(stage, self, dt)


def _kind(component: Any) -> type[Any]:
    """Return a component's type; refuse a type given in its place."""
    if isinstance(component, type):
        raise TypeError(f"an entity has components, not their types: write {component.__name__}(...)")
    return type(component)


def _whole_steps(seconds: float, dt: float) -> tuple[int, float]:
    """Divide a time into steps of ``dt``: return how many, and the length of one more that makes up the rest.

    Where the time is a multiple of ``dt`` up to rounding, there is no rest. A rest too short to be a step of
    its own is taken together with the last whole step.
    """
    if not seconds / dt < 2**53:
        raise InvalidValue("run", "seconds", seconds, f"less than 2**53 steps of dt = {dt!r} s")
    if seconds < SHORTEST:
        return 0, 0.0
    whole = round(seconds / dt)
    if whole and abs(seconds - whole * dt) <= 4.0 * math.ulp(seconds):
        return whole, 0.0
    whole = math.floor(seconds / dt)
    if whole and seconds - whole * dt < 0.001 * dt:
        whole -= 1
    return whole, seconds - whole * dt


def _forget(context: str) -> None:
    """Drop the esper context of a world that is no more."""
    if esper.current_world == context:
        esper.switch_world("default")
    if context in esper.list_worlds():
        esper.delete_world(context)
