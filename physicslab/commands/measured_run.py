"""A run without a window: measured at intervals, watched for slow steps, stopped where its time is up."""

import math
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from physicslab.commands import tell
from physicslab.commands.opening import place_of, stopped_at
from physicslab.commands.progress import Progress
from physicslab.diagnostics.energy import Accounts, Audit
from physicslab.diagnostics.impact_table import ImpactTableWriter
from physicslab.diagnostics.overflow import find_overflow
from physicslab.diagnostics.run_report import RunRecord
from physicslab.diagnostics.step_watch import StepWatch
from physicslab.diagnostics.warnings import find_warnings
from physicslab.ecs.text import printable, shortened
from physicslab.kernels.tiers import Tiers
from physicslab.state.masses import Diverged
from physicslab.world import World

_SAMPLES = 500
"""How often a run without contacts is measured: what lies between is one compiled loop."""
_LOOKS = 100
"""How often warnings are looked for in a run: with thousands of contacts that takes a third of a step."""
_WORK = 200_000
"""Entities times substeps that are advanced between two measurements at most, so that a run can be stopped
there: with few entities that takes a tenth of a second. It must not depend on how fast the machine is, as
smooth motion ends in other bits where it is divided elsewhere."""
_PATIENCE_S = 0.1
"""So long [s] a run with a budget goes on before the clock is looked at."""
_ON_TIME = 1e-6
"""Share of a step by which an instant may be late that is due: the clock is a sum of rounded steps."""


type Keep = Callable[[World, Accounts], None]
"""Keeps the state of a world as it is now, with its accounts."""


class MeasuredRun:
    """Advances a world; between steps, outside the time that is counted, it measures and records.

    Parameters
    ----------
    world : World
        The world that is advanced.
    name : str
        Name of the run.
    tiers : Tiers
        The choice whether kernels are compiled or interpreted.
    at_most : float, optional
        Wall-clock time [s] after which the run is stopped, compiling left out.
    keep : callable, optional
        Called to keep the start, the end, and the steps between.
    every : float, optional
        The time [s] between what is kept: the first step that ends at or after each multiple of it, counted
        from the start; every step if it is 0.
    impact_table : ImpactTableWriter, optional
        The writer of impacts, after each call of a stepper.
    always : bool
        Whether how far it is is written to a file or a pipe as well, for a program that reads it.

    Attributes
    ----------
    record : RunRecord
        The record gathered.
    stopped : str
        Where the run was stopped because its time was up, in words; empty if it was not.
    """

    def __init__(
        self, world: World, name: str, tiers: Tiers, at_most: float | None = None, keep: Keep | None = None,
        every: float = 0.0, impact_table: ImpactTableWriter | None = None, *, always: bool = False,
    ) -> None:  # fmt: skip
        self.record, self.stopped = RunRecord(name, Audit(world)), ""
        self._world, self._tiers, self._at_most = world, tiers, at_most
        self._keeper, self._every, self._kept_at = keep, every, -math.inf
        self._impact_table, self._always = impact_table, always
        self._watch = StepWatch(world)
        self._label = shortened(printable(name))
        self._start = world.time
        self._began = time.perf_counter() - world.compile_s
        self._samples, self._measure_every, self._look_every = 0, 1, 1
        self._check_sums()

    def go(self, seconds: float | None, steps: int | None) -> None:
        """Advance by a time [s] or by a number of steps, or until the time is up.

        Raises
        ------
        Diverged
            If a value is not finite any more.
        """
        world, record, dt = self._world, self.record, self._world.simulation.dt
        length = (steps or 0) * dt if seconds is None else seconds
        end = self._start + length
        whole = round(length / dt)
        stride = self._stride(whole) if self._keeper is None else self._kept_stride(dt)
        patience = math.inf if self._at_most is None else _PATIENCE_S
        stepping = world.stepping(seconds=seconds, steps=steps, stride=stride, patience=patience)
        self._measure_every, self._look_every = (max(1, whole // (stride * n)) for n in (_SAMPLES, _LOOKS))
        with Progress(self._label, sys.stderr, always=self._always) as progress, self._placed(whole):
            self._keep()
            while not self.stopped and self._advance(stepping, progress):
                if self._is_due(dt):
                    self._keep()
                if record.steps % stride == 0:
                    self._sample()
                progress.show((world.time - self._start) / length)
                self._tiers.foresee(record.steps / max(whole, record.steps))
                if self._at_most is not None and self._seconds >= self._at_most and world.time < end:
                    self.stopped = stopped_at(self._at_most, world.time, record.steps, whole)
            self._measure()
            if not self._kept_now:
                self._keep()
            record.warnings.add(find_warnings(world))
        record.warnings.add(self._watch.warnings)

    @contextmanager
    def _placed(self, whole: int) -> Iterator[None]:
        """Have an interruption within a ``with`` block say how far the run has come."""
        try:
            yield
        except KeyboardInterrupt as error:
            error.add_note(f"{self._label}: {place_of(self._world.time, self.record.steps, whole)}")
            raise

    def _stride(self, whole: int) -> int:
        """Return how many of so many steps are made between two measurements."""
        each = (len(self._world.entity_index) - 1) * self._world.simulation.substeps
        return max(1, min(whole // _SAMPLES, _WORK // max(each, 1)))

    def _kept_stride(self, dt: float) -> int:
        """Return how many steps are made between two states that are kept, where that is a whole number."""
        steps = round(min(self._every / dt, 1e15))  # the quotient of both may be infinite
        return steps if steps > 1 and abs(steps * dt - self._every) < _ON_TIME * dt else 1

    @property
    def _seconds(self) -> float:
        """How long it has been [s], without the time in which kernels were compiled or loaded."""
        return time.perf_counter() - self._world.compile_s - self._began

    def _advance(self, stepping: Iterator[int], progress: Progress) -> bool:
        """Go on with the run, and count what that took; return whether it was not at its end."""
        record, before, interpreted = self.record, self._seconds, self._tiers.interpreted_s
        computed = time.thread_time()
        done = next(stepping, None)
        taken = self._seconds - before
        record.wall_s += taken
        # Other programs' share of the processor is no reason of this scene's.
        taken = min(taken, time.thread_time() - computed)
        if done is None:
            return False
        made = done - record.steps
        if self._impact_table is not None:
            self._impact_table.write()
        if self._tiers.interpreted_s > interpreted:
            record.interpreted_steps += made
            record.interpreted_s += self._tiers.interpreted_s - interpreted
            taken = 0.0  # a body that is slow in Python need not be slow compiled
        slow = self._watch.note(made, taken)
        told = f"slow: {slow}" if slow else "", self._watch.note_impacts(), self._watch.note_breaks()
        for line in filter(None, told):
            progress.clear()
            tell(f"physicslab: {self._label}: {printable(line)}")
        record.steps = done
        return True

    def _is_due(self, dt: float) -> bool:
        """Whether a multiple of the time between what is kept lies after the last that was, up to now."""
        if self._keeper is None or self._every <= dt:
            return self._keeper is not None
        late = _ON_TIME * dt
        now, before = (
            math.floor((t - self._start + late) / self._every) for t in (self._world.time, self._kept_at)
        )
        return now > before

    @property
    def _kept_now(self) -> bool:
        """Whether the state as it is now was measured and kept."""
        return self._kept_at == self._world.time

    def _keep(self) -> None:
        """Measure, and keep the state as it is now, if it is to be kept."""
        if self._keeper is not None:
            self._measure()
            self._keeper(self._world, self.record.audit.account)
            self._kept_at = self._world.time

    def _sample(self) -> None:
        """Measure, and look for warnings, where that is due."""
        if self._samples % self._measure_every == 0 and not self._kept_now:
            self._measure()
        if self._samples % self._look_every == 0:
            self.record.warnings.add(find_warnings(self._world))
        self._samples += 1

    def _measure(self) -> None:
        world, record = self._world, self.record
        record.audit.sample(world)
        record.max_penetration = max(record.max_penetration, world.contacts.max_penetration)
        record.divided = max(record.divided, world.step_divisions)
        self._check_sums()

    def _check_sums(self) -> None:
        """Stop a run whose energy or momentum is no longer finite, naming what and when."""
        overflow = find_overflow(self._world, self.record.audit.latest)
        if overflow is not None:
            raise Diverged(f"{overflow} at t = {self._world.time:.9g} s")
