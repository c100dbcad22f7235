"""Runs of a lesson, sampled after each step."""

from collections.abc import Callable, Iterable

from physicslab.diagnostics.figures import AROUND, Figures
from physicslab.diagnostics.samples import Record
from physicslab.files.checks import SceneError
from physicslab.lessons.lesson import Run
from physicslab.lessons.setup import AS_IT_IS, Case, Setup
from physicslab.stepping.run import run_length
from physicslab.world import World

MOST_STEPS = 1_000_000
"""Steps that a run of a lesson may take: a minute or two of computing; 4.6 hours at dt = 1/60 s."""
_STEP_SUM_ROUNDING = 1e-6
"""Share of a step by which a sum of steps is rounded at most."""


class LiveRun:
    """A run of a lesson that is being made: :meth:`sample` after each step of its ``world``.

    Attributes
    ----------
    case : Case
        Changes to the scene.
    world : World
        The world that is stepped.
    record : Record
        The samples so far.
    limit : float
        The longest that it takes [s].
    """

    def __init__(self, setup: Setup, run: Run, names: Iterable[str], case: Case = AS_IT_IS) -> None:
        self.case = Case(case.text, (*run.case.values, *case.values), case.note)
        self.world, self._parameters = setup.world(self.case), setup.values(self.case)
        self.record, self.world.contacts.read = Record(self.world, names), True
        self.record.add()
        self._until, self._after = run.until, 0
        self.limit = (run.seconds or run.limit).value(self._parameters).value
        refuse_long(self.limit, self.world)
        self._length = None if run.until else run_length(self.world, self.limit, None)

    @property
    def next_step(self) -> float:
        """Length of the step that comes next [s]: with the last one a run is exactly as long as it says."""
        length = self._length
        is_rest = length is not None and len(self.record.times) > length.whole
        return length.rest if length is not None and is_rest else self.world.simulation.dt

    @property
    def figures(self) -> Figures:
        """Figures of the run so far."""
        return Figures(self.record, self._parameters)

    def sample(self) -> bool:
        """Take a sample after a step, and return whether the run has ended.

        After an event a few steps more are made, for what is read between samples.

        Raises
        ------
        SceneError
            If the event does not come in time.
        """
        self.record.add()
        if self._until is None:
            return self.world.time >= self.limit - _STEP_SUM_ROUNDING * self.world.simulation.dt
        self._after += bool(self._after) or self._until.margin(self.figures) > 0.0
        if self._after < AROUND // 2:
            if self.world.time > self.limit:
                raise SceneError(f"the run did not come to '{self._until.text}' within {self.limit:g} s")
            return False
        self.record.end = self.figures.moment(self._until.margin, self._until.names())
        return True


def refuse_long(limit: float, world: World) -> None:
    """Refuse a run of so long a time [s] that it needs more steps than a lesson may take.

    Raises
    ------
    SceneError
        If it does.
    """
    dt = world.simulation.dt
    if limit > MOST_STEPS * dt:
        longest = f"{MOST_STEPS:,} steps of {dt:.6g} s, {MOST_STEPS * dt:.6g} s"
        raise SceneError(f"{limit:g} s is too long: must be at most {longest}")


def record_run(
    setup: Setup, run: Run, names: Iterable[str], case: Case = AS_IT_IS,
    watch: Callable[[World], object] = lambda world: None,
) -> Figures:  # fmt: skip
    """Make a run of a lesson, and return its figures; ``watch`` is given the world at every sample.

    Raises
    ------
    SceneError
        If it does not end in time, or a case is not of the scene.
    """
    live = LiveRun(setup, run, names, case)
    watch(live.world)
    if run.seconds is not None:
        for _ in live.world.stepping(seconds=live.limit):
            live.record.add()
            watch(live.world)
        return live.figures
    ended = False
    while not ended:
        live.world.step()
        ended = live.sample()
        watch(live.world)
    return live.figures
