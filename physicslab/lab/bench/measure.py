"""Time a scene, in PhysicsLab alone or beside its peers, and judge how well each simulates it."""

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from physicslab.components import Transform, Velocity
from physicslab.kernels import compile_kernels
from physicslab.lab.bench.engine import Engine, OtherEngine, prepared
from physicslab.lab.bench.result import EngineResult, SceneResult, Spread, Times, take_turns
from physicslab.lab.bench.scene import BenchScene, Moment, When
from physicslab.lab.jobs import Job
from physicslab.lab.peers.peer import CannotBuild, Peer
from physicslab.state.masses import Diverged
from physicslab.systems.system import OF_FRAMES
from physicslab.world import World

_BEGIN_S = 2.0
"""How long [s] the beginning is: a pile falls in it."""
_BLOCK = 200
"""Steps of one call where many are taken at once."""


def measure_scene(
    scene: BenchScene, peers: Sequence[type[Peer]] = (), make: Callable[[World], Engine] = Engine
) -> Job[SceneResult]:
    """Time a scene; yield the share that is done now and then.

    Parameters
    ----------
    scene : BenchScene
        The scene to time.
    peers : sequence of type of Peer
        Engines timed beside it; none where the scene has no counterpart in others.
    make : callable
        Takes its world, and returns the engine that steps it.
    """
    ours = make(scene.build())
    result = SceneResult(scene)
    result.engines[ours.title] = EngineResult(ours.title)
    engines = [prepared(engine, scene) for engine in (ours, *build_others(scene, peers, result))]
    load_kernels(ours.world)
    judge = Judge(result)
    settling, begin = round(scene.seconds / ours.dt), math.ceil(_BEGIN_S / ours.dt)
    total = settling + scene.steps
    try:
        judge.begin(engines)
        for times in take_turns(engines, settling):
            judge.look(engines, "throughout")
            yield len(times[0].step) / total
        if settling:
            _note_begin(result, engines, [spent.step[:begin] for spent in times])
        judge.look(engines, "settled")
        engines = [engine for engine in engines if not result.engines[engine.title].failure]
        judge.begin(engines)
        before = spent_by_system(ours.world)
        block = _BLOCK if scene.compiled_runs else 0
        for times in take_turns(engines, math.ceil(scene.steps / max(1, block)), block):
            judge.look(engines, "throughout")
            yield (settling + len(times[0].step) * max(1, block)) / total
    except Diverged as error:
        result.ours.failure = str(error)
    else:
        judge.look(engines, "end")
        _summarise(result, engines, times)
        result.contacts = ours.world.contacts.count
        result.systems = _shares(before, spent_by_system(ours.world), times[0])
    return result


def load_kernels(world: World) -> None:
    """Load what a world's steppers call: the first steps would be timed with it."""
    world.synchronise()
    for stepper in world.steppers.usable:
        compile_kernels(stepper.kernels)


def build_others(scene: BenchScene, peers: Sequence[type[Peer]], result: SceneResult) -> list[Engine]:
    """Build the scene in the peers; write a failure into the results of those that cannot hold it."""
    others: list[Engine] = []
    for peer in () if scene.edit is not None else peers:
        result.engines[peer.title] = EngineResult(peer.title)
        try:
            others.append(OtherEngine(scene.build(), peer))
        except CannotBuild as error:
            result.engines[peer.title].failure = str(error)
    return others


def spent_by_system(world: World) -> dict[str, int]:
    """Return what each system has cost so far in steps [ns]."""
    of_frames = {system.name for system in world.schedule.systems if OF_FRAMES & system.marked().keys()}
    return {
        name: timing.nanoseconds for name, timing in world.schedule.timings.items() if name not in of_frames
    }


def _shares(before: dict[str, int], after: dict[str, int], ours: Times) -> dict[str, float]:
    """Return what systems take of a median step [ms]: noise that made some steps long does not count."""
    median = float(np.median(ours.step))
    return {
        name: (spent - before.get(name, 0)) / 1e6 / ours.wall_ms * median for name, spent in after.items()
    }


def _note_begin(result: SceneResult, engines: Sequence[Engine], spent: Sequence[list[float]]) -> None:
    """Write what the first two seconds took [ms] into the result."""
    for engine, steps in zip(engines, spent, strict=True):
        found = result.engines[engine.title]
        found.first_seconds_ms = Spread.of(steps)
        found.times_ours_first_seconds = _ratio(steps, spent[0])


def _summarise(result: SceneResult, engines: Sequence[Engine], times: Sequence[Times]) -> None:
    """Write medians into the result, and ratios step by step."""
    ours = times[0]
    for engine, spent in zip(engines, times, strict=True):
        found = result.engines[engine.title]
        found.step_ms, found.times_ours = Spread.of(spent.step), _ratio(spent.step, ours.step)
        if spent.read:
            found.step_and_read_ms = Spread.of(spent.with_read)
            found.times_ours_with_read = _ratio(spent.with_read, ours.with_read)


def _ratio(times: ArrayLike, ours: ArrayLike) -> float:
    return float(np.median(np.divide(times, ours)))


class Judge:
    """Measures the qualities of a scene in every engine, and writes them into its results.

    Every engine's state is copied into one world, and measured there: that disturbs no engine, and all are
    measured alike.

    Parameters
    ----------
    result : SceneResult
        Whose scene it is, and where figures are written: ``None`` where one is not finite. A run that
        diverged has that as its failure.
    """

    def __init__(self, result: SceneResult) -> None:
        self._result = result
        self._world = result.scene.build()
        self._before: dict[str, Moment] = {}

    def begin(self, engines: Sequence[Engine]) -> None:
        """Note how the engines' worlds are now: what is measured from here on is measured from that."""
        for engine in engines:
            if self._copy(engine):
                self._before[engine.title] = Moment.of(self._world)

    def look(self, engines: Sequence[Engine], when: When) -> None:
        """Measure what is due at a time."""
        due = [quality for quality in self._result.scene.quality if quality.when == when]
        for engine in engines if due else ():
            if not self._copy(engine):
                continue
            found, before = self._result.engines[engine.title].quality, self._before[engine.title]
            before.follow(self._world)
            for quality in due:
                figure = quality.measure(self._world, before)
                if when == "throughout":
                    figure = max(figure, found.get(quality.name) or 0.0)
                found[quality.name] = figure if math.isfinite(figure) else None

    def _copy(self, engine: Engine) -> bool:
        """Copy an engine's state into the world; return whether it is finite."""
        here, result = self._world, self._result.engines[engine.title]
        try:
            there = engine.look()
        except Diverged:
            result.failure = "NaN"
        if result.failure:
            return False
        here.synchronise()
        source, place = (world.batch(Transform, Velocity).rows for world in (there, here))
        for component, columns in ((Transform, ("position", "angle")), (Velocity, ("linear", "angular"))):
            for column in columns:
                here.table(component)[column][place] = there.table(component)[column][source]
        return True
