"""Who runs when, at what cost, and what was left out."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from physicslab.kernels import compile_kernels

if TYPE_CHECKING:
    from physicslab.ode.system import PackedForce, StateLayout
    from physicslab.world import World

__all__ = ["ForceSystem", "LeftOut", "Schedule", "Stage", "System", "Timing", "at"]


class Stage(Enum):
    """The moments at which systems run. An integrator's ``substep`` puts those of a substep in order."""

    INPUT = "once a frame: what the user did"
    PREPARE = "once a step: what holds for all of it"
    FORCE = "forces and torques are added up"
    KICK = "forces change velocities"
    DRIFT = "velocities change positions"
    BROAD_PHASE = "which bodies are near each other"
    CONTACT = "where they touch"
    IMPACT = "approaching bodies bounce"
    PREDICT = "what forces will do to tethered bodies is shown to the contacts, and taken back"
    SOLVE = "contact impulses keep bodies apart, correcting overlap"
    RELAX = "contact impulses again, so that the correction leaves no velocity behind"
    FINISH = "once a step: what is recorded of it"
    RENDER = "once a frame: the world is drawn"
    HUD = "once a frame: the figures are drawn over it"

    __hash__ = object.__hash__  # Enum's own hashes the name, in Python, at every look-up


def at[M: Callable[..., None]](stage: Stage) -> Callable[[M], M]:
    """Mark a system's method to be called as ``method(world, h)`` at ``stage``.

    ``h`` is the time [s] that the call stands for: the substep, a part of it, or the step.

    Raises
    ------
    TypeError
        If ``stage`` is no Stage.
    """
    if not isinstance(stage, Stage):
        raise TypeError(f"@at takes a Stage, got {stage!r}: write @at(Stage.FORCE), or another of them")

    def mark(method: M) -> M:
        method.stage = stage  # type: ignore[attr-defined]
        return method

    return mark


class System:
    """One thing that happens to a world, and when.

    To write one:

    1. Subclass ``System`` (or :class:`ForceSystem`) in a file of ``physicslab/systems``.
    2. Name the components it works on in ``needs``. While no entity has all of them, the system is left out.
    3. Mark a method ``@at(Stage. ...)``. It gets the world and the time that the call stands for, and reads
    and writes
       columns: ``world.batch(Velocity, Mass).rows`` are row numbers, ``world.table(Velocity)["linear"]`` a
       column.
    4. Say in :meth:`why_left_out` what else makes it needless. What was left out is shown with that reason.
    5. Add it to the list in ``physicslab/systems/standard.py``, in the order in which it runs within its
    stage.

    Attributes
    ----------
    needs : tuple of component types
        An entity must have all of them for the system to have work.
    kernels : tuple of kernels
        What the system calls; compiled before the system first runs.
    observes : bool
        Whether what it does at ``PREPARE`` and ``FINISH`` must happen at every step of a run.
    """

    needs: ClassVar[tuple[type[Any], ...]] = ()
    kernels: ClassVar[tuple[Any, ...]] = ()
    observes: ClassVar[bool] = True

    @property
    def name(self) -> str:
        """The name under which cost and reasons are reported."""
        return type(self).__name__

    def attach(self, world: World) -> None:
        """Look at the world's new content; called whenever it changed, before :meth:`why_left_out`."""

    def why_left_out(self, world: World) -> str | None:
        """Return why this scene does not need the system, or ``None`` if it does."""
        if self.needs and not len(world.batch(*self.needs)):
            absent = [needed for needed in self.needs if not len(world.batch(needed))] or self.needs
            return f"no {' and '.join(needed.__name__ for needed in absent)} in the scene"
        return None

    def kernels_for(self, world: World) -> tuple[Any, ...]:
        """Return which of ``kernels`` the world needs as it is; what it does not need is not waited for."""
        return self.kernels

    def substep_factor(self, world: World) -> int:
        """Return how many times as many substeps as asked for the next step needs, at the end of one."""
        return 1

    @classmethod
    def marked(cls) -> dict[Stage, str]:
        """Return the stages of the system, each with the name of its method.

        A method that overrides a marked one keeps its stage. Two at one stage have no order, and are refused.
        """
        found: dict[Stage, str] = {}
        for base in reversed(cls.__mro__):
            for name, attribute in vars(base).items():
                stage = getattr(attribute, "stage", None)
                if not isinstance(stage, Stage):
                    continue
                if found.setdefault(stage, name) != name:
                    both = f"{found[stage]} and {name}"
                    raise TypeError(f"{cls.__name__}: {both} are both at {stage}; let one call the other")
        return found


class ForceSystem(System):
    """A system that adds to ``world.bodies.force`` [N] and ``.torque`` [N m] at ``Stage.FORCE``.

    It must also say what energy its force stores, so that the energy shown stays true when someone adds a
    force.
    """

    potential: ClassVar[str | None] = None
    """The name under which the energy is reported; ``None`` for a force that stores none."""

    def potential_energy(self, world: World) -> float:
        """Return the energy stored [J]; zero for a force that stores none."""
        return 0.0

    def strongest_rate(self, world: World) -> float:
        """Return the fastest angular frequency [rad/s] that this force gives any body; 0 if it gives none."""
        return 0.0

    def summation(self, world: World) -> str:
        """Return how the force is summed, where that bears on what it is worth; shown beside the figures."""
        return ""

    def rates(self, world: World) -> NDArray[np.float64] | None:
        """Return for each row the fastest angular frequency [rad/s] or rate of decay [1/s] it is given.

        ``None`` for a force that does not tell bodies apart. Where it does, and contacts act as well, the
        bodies it acts on are moved by a method that follows it, instead of a kick a substep.
        """
        return None

    def sees_velocity(self, world: World) -> bool:
        """Return whether the force hangs on velocities, as drag does; a method is chosen by that."""
        return False

    def may_be_singular(self, world: World) -> bool:
        """Return whether bodies may come where the force is not smooth; fixed steps would not notice."""
        return False

    def settings(self, world: World) -> bytes:
        """Return the numbers, bit by bit, that the force has apart from the state of motion.

        Where they change, the method that moves the bodies is chosen anew.
        """
        return b""

    def couples(self, world: World) -> NDArray[np.int64] | None:
        """Return the pairs of rows (n, 2) whose motions the force couples; ``None``: any with any."""
        return None

    def packed(self, world: World, slots: StateLayout) -> PackedForce | None:
        """Return the force as compiled integrators call it, with the world's numbers as they are now.

        A row whose ``slots.place`` is -1 takes no part; there is none where :meth:`couples` is ``None``.
        ``None`` where there is no such kernel: the method at ``Stage.FORCE`` is called instead, from Python.
        """
        return None

    @classmethod
    def packs(cls) -> bool:
        """Whether :meth:`packed` speaks for this class's force, and not for one that it overrides."""
        method = next(name for stage, name in cls.marked().items() if stage is Stage.FORCE)
        for base in cls.__mro__:
            if base is ForceSystem:
                return False
            if "packed" in vars(base) or method in vars(base):
                return "packed" in vars(base)
        return False


@dataclass(slots=True)
class Timing:
    """What a system has cost so far."""

    calls: int = 0
    nanoseconds: int = 0

    @property
    def ms(self) -> float:
        """The cost in milliseconds."""
        return self.nanoseconds / 1e6


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A system that the scene does not need, and why."""

    name: str
    reason: str


class Schedule:
    """The systems of one world, made from what the world holds and remade when that changes.

    Attributes
    ----------
    systems : tuple of System
        All of them, in order.
    running : tuple of System
        Those that the world needs at present.
    left_out : tuple of LeftOut
        The others, each with the reason.
    timings : dict of str to Timing
        Calls and cost of every system that ever ran.
    compile_s : float
        Seconds spent compiling kernels, or loading them.
    """

    def __init__(self, systems: Iterable[System]) -> None:
        self.systems: tuple[System, ...] = ()
        self._marked: dict[System, dict[Stage, str]] = {}
        self.extend(systems)
        self.running: tuple[System, ...] = ()
        self.left_out: tuple[LeftOut, ...] = ()
        self.timings: dict[str, Timing] = {}
        self.compile_s = 0.0
        self._calls: dict[Stage, list[tuple[Callable[[World, float], None], Timing]]] = {}

    def extend(self, systems: Iterable[System]) -> None:
        """Put systems behind those there are; they are considered when the schedule is next remade."""
        extended = (*self.systems, *systems)
        marked = {system: _checked(system) for system in extended}
        names = [system.name for system in extended]
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"{name} is in the schedule twice")
        self.systems, self._marked = extended, marked

    def remake(self, world: World) -> None:
        """Choose the systems that ``world`` needs now."""
        running: list[System] = []
        left_out: list[LeftOut] = []
        for system in self.systems:
            system.attach(world)
            reason = system.why_left_out(world)
            if reason is None:
                running.append(system)
            else:
                left_out.append(LeftOut(system.name, reason))
        self.running, self.left_out = tuple(running), tuple(left_out)
        self._calls = {stage: [] for stage in Stage}
        # All at once: where other processes compile, they are then told of all that is waited for.
        self.compile([needed for system in running for needed in system.kernels_for(world)])
        for system in running:
            timing = self.timings.setdefault(system.name, Timing())
            for stage, method in self._marked[system].items():
                self._calls[stage].append((getattr(system, method), timing))

    def compile(self, kernels: Iterable[Any]) -> None:
        """Compile kernels, or load them, and note how long it took."""
        self.compile_s += compile_kernels(kernels)

    def runs(self, stage: Stage) -> bool:
        """Whether any system has work at ``stage``."""
        return bool(self._calls.get(stage))

    @property
    def observed(self) -> bool:
        """Whether a system looks at every step, apart from the check that all is finite."""
        looks = {Stage.PREPARE, Stage.FINISH}
        return any(not looks.isdisjoint(self._marked[system]) for system in self.running if system.observes)

    def run(self, stage: Stage, world: World, h: float) -> None:
        """Call every running system of ``stage``, in order, and note what each cost."""
        for call, timing in self._calls.get(stage, ()):
            start = time.perf_counter_ns()
            call(world, h)
            timing.nanoseconds += time.perf_counter_ns() - start
            timing.calls += 1

    def run_beside(self, name: str, stage: Stage, world: World, h: float) -> None:
        """Call every running system of ``stage`` but the one of this name, whose work was done otherwise."""
        for system in self.running:
            method = self._marked[system].get(stage)
            if method is not None and system.name != name:
                start = time.perf_counter_ns()
                getattr(system, method)(world, h)
                self.note(system.name, 1, time.perf_counter_ns() - start)

    def note(self, name: str, calls: int, nanoseconds: int) -> None:
        """Note what a system has cost that was not called by :meth:`run`."""
        timing = self.timings.get(name)
        if timing is None:
            timing = self.timings[name] = Timing()
        timing.calls += calls
        timing.nanoseconds += nanoseconds

    def find(self, kind: type[System]) -> System | None:
        """Return the running system of a type, if there is one."""
        return next((system for system in self.running if isinstance(system, kind)), None)


def _checked(system: System) -> dict[Stage, str]:
    """Return the stages of a system; refuse what could never run, with the reason."""
    if isinstance(system, type):
        raise TypeError(f"a world takes systems, not their types: write {system.__name__}()")
    if not isinstance(system, System):
        raise TypeError(f"{system!r} is no System: subclass physicslab.systems.schedule.System")
    stages = system.marked()
    if not stages:
        raise TypeError(f"{system.name} has no method marked @at(Stage. ...), so it would never run")
    if isinstance(system, ForceSystem) and Stage.FORCE not in stages:
        raise TypeError(f"{system.name} is a ForceSystem and has no method marked @at(Stage.FORCE)")
    return stages
