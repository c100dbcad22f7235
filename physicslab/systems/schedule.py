"""The systems of one world: which run, at what cost, and what was left out."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.kernels import working_ns
from physicslab.state.state import State
from physicslab.systems.joint import JointSystem
from physicslab.systems.system import ForceSystem, Stage, System


@dataclass(slots=True)
class Timing:
    """The calls and the cost of a system so far."""

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
    forces : tuple of ForceSystem
        The force systems among those that run.
    smooth_forces : tuple of ForceSystem
        Those that act in smooth motion: behind them the forces of joints, where there are any.
    interpreted : tuple of str
        The names of those that no kernel computes, and Python does.
    observer : System, optional
        The first of them that has to be called at every step.
    samplers : bool
        Whether any of them takes every step from samples.
    remade : int
        How often it was made.
    """

    def __init__(self, systems: Iterable[System]) -> None:
        self.systems: tuple[System, ...] = ()
        self._marked: dict[System, Mapping[Stage, str]] = {}
        self.extend(systems)
        self.running: tuple[System, ...] = ()
        self.left_out: tuple[LeftOut, ...] = ()
        self.forces: tuple[ForceSystem, ...] = ()
        self.smooth_forces: tuple[ForceSystem, ...] = ()
        self.interpreted: tuple[str, ...] = ()
        self.observer: System | None = None
        self.samplers = False
        self.remade = 0
        self._timings: dict[str, Timing] = {}
        self._settle: Callable[[], None] | None = None
        self._calls: dict[Stage, list[tuple[Callable[[State, float], None], Timing]]] = {}

    @property
    def timings(self) -> dict[str, Timing]:
        """Calls and cost of every system that ever ran."""
        settle, self._settle = self._settle, None
        if settle is not None:
            settle()
        return self._timings

    def note_into(self, other: "Schedule") -> None:
        """Note costs where another schedule notes its own."""
        self._timings = other._timings

    def defer(self, settle: Callable[[], None]) -> None:
        """Let ``settle`` be called, which notes costs, before timings are next read."""
        if self._settle != settle:
            _ = self.timings  # which another may owe
            self._settle = settle

    def extend(self, systems: Iterable[System]) -> None:
        """Put systems behind those there are; they are considered when the schedule is next remade."""
        extended = (*self.systems, *systems)
        marked = {system: _checked(system) for system in extended}
        names = [system.name for system in extended]
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"{name} is in the schedule twice")
        self.systems, self._marked = extended, marked

    def remake(self, state: State) -> None:
        """Choose the systems that the world needs now."""
        self.remade += 1
        running: list[System] = []
        left_out: list[LeftOut] = []
        for system in self.systems:
            system.attach(state)
            reason = system.why_left_out(state)
            if reason is None:
                running.append(system)
            else:
                left_out.append(LeftOut(system.name, reason))
        self.running, self.left_out = tuple(running), tuple(left_out)
        self.forces = tuple(system for system in running if isinstance(system, ForceSystem))
        joined = [system.smooth for system in running if isinstance(system, JointSystem)]
        self.smooth_forces = (*self.forces, *joined)
        self.interpreted = tuple(force.name for force in self.forces if not type(force).packs())
        observers = [system for system in running if system.observes()]
        self.observer = next((system for system in observers if not system.sampled), None)
        self.samplers = any(system.sampled for system in observers)
        self._calls = {stage: [] for stage in Stage}
        for system in running:
            timing = self._timings.setdefault(system.name, Timing())
            for stage, method in self._marked[system].items():
                self._calls[stage].append((getattr(system, method), timing))

    def holds(self, state: State) -> bool:
        """Whether the world needs the same systems still, and others are left out for the same reasons."""
        reasons = {left.name: left.reason for left in self.left_out}
        return all(system.why_left_out(state) == reasons.get(system.name) for system in self.systems)

    def runs(self, stage: Stage) -> bool:
        """Whether any system has work at ``stage``."""
        return bool(self._calls.get(stage))

    def at(self, stage: Stage) -> tuple[System, ...]:
        """Return the running systems that have work at ``stage``, in order."""
        return tuple(system for system in self.running if stage in self._marked[system])

    def kernels(self, state: State) -> list[Any]:
        """Return the kernels that the running systems call at their stages."""
        return [needed for system in self.running for needed in system.kernels_for(state)]

    def run(self, stage: Stage, state: State, h: float) -> None:
        """Call every running system of ``stage``, in order, and note what each cost."""
        for call, timing in self._calls.get(stage, ()):
            self._timed(call, timing, state, h)

    def run_forces(
        self, state: State, h: float, note: Callable[[System, NDArray[np.float64], State], None]
    ) -> None:
        """Run ``Stage.FORCE``; ``note`` gets each system, and forces and torques (3 rows,) from before it."""
        for system in self.running:
            if Stage.FORCE in self._marked[system]:
                before = state.bodies.pull.copy()
                self.call(system, getattr(system, self._marked[system][Stage.FORCE]), state, h)
                note(system, before, state)

    def run_others(self, kind: type[System], stage: Stage, state: State, h: float) -> None:
        """Call every running system of ``stage`` but the one of this type, whose work was done otherwise."""
        for system in self.running:
            if stage in self._marked[system] and not isinstance(system, kind):
                self.call(system, getattr(system, self._marked[system][stage]), state, h)

    def call(self, system: System, method: Callable[[State, float], None], state: State, h: float) -> None:
        """Call a method of a running system beside its stages, and note what it cost."""
        self._timed(method, self._timings[system.name], state, h)

    def _timed(self, call: Callable[[State, float], None], timing: Timing, state: State, h: float) -> None:
        """Call, and note the time that it took, without what went by while kernels were compiled."""
        start = working_ns()
        call(state, h)
        timing.nanoseconds += working_ns() - start
        timing.calls += 1

    def note(self, name: str, calls: int, nanoseconds: int) -> None:
        """Note what a system has cost that was not called by :meth:`run`."""
        timing = self._timings.get(name)
        if timing is None:
            timing = self._timings[name] = Timing()
        timing.calls += calls
        timing.nanoseconds += nanoseconds

    def note_loop(self, name: str, calls: int, nanoseconds: int, within: Iterable[str]) -> None:
        """Note what a compiled loop has cost as that of a system; the time of others is part of it."""
        self.note(name, calls, nanoseconds)
        for other in within:
            self.note(other, calls, 0)

    def find[S: System](self, kind: type[S]) -> S | None:
        """Return the running system of a type, if there is one."""
        return next((system for system in self.running if isinstance(system, kind)), None)


def _checked(system: System) -> Mapping[Stage, str]:
    """Return the stages of a system; refuse what could never run, with the reason."""
    if isinstance(system, type):
        raise TypeError(f"a world takes systems, not their types: write {system.__name__}()")
    if not isinstance(system, System):
        raise TypeError(f"{system!r} is no System: subclass physicslab.systems.system.System")
    stages = system.marked()
    if not stages:
        raise TypeError(f"{system.name} has no method marked @at(Stage. ...), so it would never run")
    if isinstance(system, ForceSystem) and Stage.FORCE not in stages:
        raise TypeError(
            f"{system.name} is a ForceSystem and packs no force and has no method marked @at(Stage.FORCE)"
        )
    return stages
