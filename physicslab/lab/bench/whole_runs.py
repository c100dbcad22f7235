"""Whole runs of scenes beside other engines, also at like quality; features that the slowest have in common.

Scenes drawn at random are run for a short while, others to the end of the steps that are timed.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from physicslab.ecs.config import SimulationConfig
from physicslab.lab.bench.engine import OURS, Engine, OtherEngine
from physicslab.lab.bench.measure import Judge, build_others, load_kernels, spent_by_system
from physicslab.lab.bench.random_scenes import random_scene
from physicslab.lab.bench.result import Alike, EngineResult, SceneResult, Spread, Times, take_turns
from physicslab.lab.bench.scene import BenchScene, largest_overlap, stretched
from physicslab.lab.jobs import Job
from physicslab.lab.peers.mirrors import PymunkMirror
from physicslab.lab.peers.peer import Peer
from physicslab.lab.report import cell, lab_document, machine_text, table
from physicslab.state.masses import Diverged
from physicslab.world import World

_LONGEST = 240
"""Most steps of a random scene."""
_BUDGET_MS = 1_500.0
"""CPU time of all engines together after which a random scene takes no more turns."""
_SHOWN = 10
"""The slowest scenes that are listed."""
_FEW = 4
"""Scenes of a feature from which on their median says something."""
BESIDE = "beside systems"
"""Name of the time of steps in no system: packing, choosing and calling."""
BLOCK, PORTION, WARM = 5, 2, 2
"""Steps of a turn, turns between two looks at the quality, and steps before the timing, in which kernels are
loaded and pairs are listed for the first time. Scenes that no engine is fit for take seconds a step."""
_SLOP = 0.01
"""A figure below it is treated as zero: a length [m], twice the slop of pymunk and of Box2D, and the share of
the kinetic energy that was gained."""
_FINEST = 64
"""Most parts of a usual step."""
_SLOWEST = 8.0
"""Time by PhysicsLab's from which on a peer is not run in shorter steps still."""


@dataclass(frozen=True, slots=True)
class WholeResult:
    """Results of a run of a scene.

    Attributes
    ----------
    result : SceneResult
        Times and quality; ``times_ours`` are ratios of whole times, the largest of all looks counts.
    features : list of str
        Properties of the scene.
    path : str
        The steppers, what moves bodies on springs and in drag, and the substeps of a step.
    scalar, wide : int
        How many contacts were solved one by one at the end, and how many eight at a time.
    """

    result: SceneResult
    features: list[str] = field(default_factory=list)
    path: str = ""
    scalar: int = 0
    wide: int = 0

    def speed(self, engine: str) -> float | None:
        """Return how many times as long an engine took, if it ran."""
        found = self.result.engines.get(engine)
        return None if found is None else found.times_ours

    @property
    def dearest(self) -> tuple[str, float]:
        """The system that took most of the time, and its share of it."""
        whole = sum(self.result.systems.values()) or 1.0
        name, spent = max(self.result.systems.items(), key=lambda item: item[1], default=("-", 0.0))
        return name.removesuffix("System"), spent / whole


def measure_whole(scene: BenchScene, features: list[str], peers: Sequence[type[Peer]]) -> Job[WholeResult]:
    """Time a scene from its start; yield the share that is done now and then.

    A random scene has ``features``, and is run for a short while; others are run to their end.
    """
    longest = _LONGEST if features else round(scene.seconds / SimulationConfig().dt) + scene.steps
    budget = _BUDGET_MS if features else math.inf
    ours = Engine(scene.build())
    result = SceneResult(scene, engines={OURS: EngineResult(OURS)})
    engines = [ours, *build_others(scene, peers, result)]
    load_kernels(ours.world)
    judge = Judge(result)
    try:
        for engine in engines:
            engine.run(WARM)
        judge.begin(engines)
        before = spent_by_system(ours.world)
        times: list[Times] = []
        for times in take_turns(engines, longest // BLOCK, BLOCK, PORTION):
            judge.look(engines, "throughout")
            if sum(sum(spent.step) for spent in times) * BLOCK > budget:
                break
            yield len(times[0].step) * BLOCK / longest
        judge.look(engines, "end")
    except Diverged as error:
        result.ours.failure = str(error)
        return WholeResult(result, features)
    _note(result, engines, times, before)
    contacts = ours.world.contacts
    wide = sum(part.contacts.wide.filled for part in ours.world.parts)
    result.contacts = contacts.count
    path = _path(ours.world)
    for peer in peers:
        result.engines[peer.title].alike = yield from run_alike(result, peer, times[0])
    return WholeResult(result, features, path, contacts.count - wide, wide)


def _note(
    result: SceneResult, engines: Sequence[Engine], times: Sequence[Times], before: dict[str, int]
) -> None:
    """Write times, their ratios, and what each system took of a mean step [ms] into the result."""
    whole = sum(times[0].step)
    for engine, spent in zip(engines, times, strict=True):
        found = result.engines[engine.title]
        found.step_ms, found.times_ours = Spread.of(spent.step), sum(spent.step) / whole
    steps = len(times[0].step) * BLOCK
    after = spent_by_system(engines[0].world)
    result.systems = {name: (after[name] - before.get(name, 0)) / 1e6 / steps for name in after}
    rest = times[0].wall_ms / steps - sum(result.systems.values())
    result.systems[BESIDE] = max(0.0, rest)


def _path(world: World) -> str:
    """Return the steppers of a world's islands, and what their substeps are."""
    found: dict[str, int] = {}
    for part in world.parts:
        words = [] if part.stepper is None else [part.stepper.name]
        if part.plan.split_forces is not None:
            words.append(part.plan.split_forces.name)
        if part.substeps > part.simulation.substeps:
            words.append(f"{part.substeps} substeps")
        name = " + ".join(words)
        found[name] = found.get(name, 0) + 1
    return ", ".join(name if count == 1 else f"{count} x {name}" for name, count in found.items())


# ---- others at like quality --------------------------------------------------------------------------------
# At their usual settings others may be faster only because they leave deeper overlaps. So each is run again
# from the start in steps of a half, a quarter, ... of the usual length, with contacts as stiff as those
# allow, until no figure of quality is worse than PhysicsLab's in the same steps.


def _is_alike(found: EngineResult, ours: EngineResult) -> bool:
    """Return whether no figure of quality is worse than PhysicsLab's."""
    return not found.failure and all(
        figure is not None and figure <= max(_SLOP, ours.quality.get(name) or 0.0)
        for name, figure in found.quality.items()
    )


def run_alike(result: SceneResult, peer: type[Peer], ours: Times) -> Job[Alike | None]:
    """Run a peer, that has been run at its usual settings, in shorter steps until it is as right.

    Parameters
    ----------
    result : SceneResult
        Results at usual settings, PhysicsLab's among them.
    peer : type of Peer
        Which engine.
    ours : Times
        The time of the same steps in PhysicsLab.

    Returns
    -------
    Alike, optional
        The first length of step at which it is as right, or the last that was tried; ``None`` where it
        cannot hold the scene.
    """
    usual = result.engines[peer.title]
    if usual.failure or usual.times_ours is None:
        return None
    found = Alike(1, usual.times_ours, _is_alike(usual, result.ours))
    while not found.is_reached and found.finer < _FINEST and found.times_ours < _SLOWEST:
        found = yield from _run(result, peer, 2 * found.finer, ours)
    return found


def _run(result: SceneResult, peer: type[Peer], finer: int, ours: Times) -> Job[Alike]:
    """Run a peer in shorter steps, as far as it is as right as PhysicsLab."""
    engine = OtherEngine(result.scene.build(), peer, finer)
    here = SceneResult(result.scene, engines={peer.title: EngineResult(peer.title)})
    judge, found = Judge(here), here.engines[peer.title]
    engine.run(WARM)
    judge.begin([engine])
    steps, spent, reached = 0, 0.0, True
    for (times,) in take_turns([engine], len(ours.step), BLOCK, PORTION):
        judge.look([engine], "throughout")
        steps, spent, reached = len(times.step), sum(times.step), _is_alike(found, result.ours)
        yield 1.0
        if not reached:
            break
    judge.look([engine], "end")
    reached = reached and _is_alike(found, result.ours)
    return Alike(finer, spent / sum(ours.step[:steps]), reached)


# ---- the report ----------------------------------------------------------------------------------------


@dataclass(slots=True)
class WholeReport:
    """All runs.

    Attributes
    ----------
    seed : str
        The series, and where in it the scenes begin; empty of scenes that were named.
    peers : list of str
        The other engines.
    found : list of WholeResult
        Scene by scene.
    """

    seed: str
    peers: list[str]
    found: list[WholeResult] = field(default_factory=list)

    def ratios(self, peer: str, found: Sequence[WholeResult] | None = None) -> list[float]:
        """Return how many times as long a peer took, in the scenes that it ran, the smallest first."""
        speeds = [one.speed(peer) for one in (self.found if found is None else found)]
        return sorted(speed for speed in speeds if speed is not None)

    def alike(self, peer: str) -> list[Alike]:
        """Return how a peer ran at like quality, in the scenes in which both ran."""
        engines = (one.result.engines.get(peer) for one in self.found)
        return [engine.alike for engine in engines if engine is not None and engine.alike is not None]

    @property
    def document(self) -> dict[str, Any]:
        """Every figure, and the machine."""
        return lab_document(
            "bench-random", peers=True, seed=self.seed, scenes=[_scene(one) for one in self.found]
        )


def _scene(one: WholeResult) -> dict[str, Any]:
    result = one.result
    return {
        "name": result.scene.name, "family": result.scene.group, "bodies": result.scene.size,
        "features": one.features, "path": one.path, "scalar": one.scalar, "wide": one.wide,
        "systems_ms": result.systems, "engines": [*result.engines.values()],
    }  # fmt: skip


def whole_text(report: WholeReport) -> str:
    """Return the tables of a run: the whole, the slowest beside each peer, medians by feature."""
    blocks = [machine_text(peers=True), _whole(report)]
    for peer in report.peers:
        ran = [one for one in report.found if one.speed(peer) is not None]
        worst = sorted(ran, key=lambda one: one.speed(peer) or 0.0)[:_SHOWN]
        if worst:
            blocks.append(f"the slowest beside {peer}\n{_worst(report, worst)}")
    blocks.append(f"medians by feature: time of the other by ours\n{_common(report)}")
    failed = [
        f"{one.result.scene.name}: {one.result.ours.failure}"
        for one in report.found
        if one.result.ours.failure
    ]
    return "\n\n".join([*blocks, *failed])


def _whole(report: WholeReport) -> str:
    rows = [["time of the other by ours", "scenes", "least", "a tenth", "median", "nine tenths", "below 1"]]
    lines = []
    for peer in report.peers:
        alike = report.alike(peer)
        for name, ratios in (
            (peer, report.ratios(peer)),
            (f"{peer}, at like quality", sorted(one.times_ours for one in alike)),
        ):
            if ratios:
                shares = (f"{share:.2f}" for share in np.quantile(ratios, (0.0, 0.1, 0.5, 0.9)))
                below = sum(ratio < 1.0 for ratio in ratios)
                rows.append([name, f"{len(ratios)}", *shares, f"{below}"])
        if alike:
            finer = sorted(one.finer for one in alike)
            missed = sum(not one.is_reached for one in alike)
            lines.append(
                f"{peer}, at like quality: steps of 1/{finer[len(finer) // 2]} of the usual "
                f"(median); {missed} of {len(finer)} scenes not as right at the shortest that were tried"
            )
    measured = {quality.name: quality for one in report.found for quality in one.result.scene.quality}
    for quality in measured.values():
        for name in (OURS, *report.peers):
            seen = [
                one.result.engines[name].quality.get(quality.name)
                for one in report.found
                if name in one.result.engines
            ]
            known = [figure for figure in seen if figure is not None]
            if known:
                middle, most = np.quantile(known, (0.5, 1.0))
                middle, most = (f"{figure:.2g} {quality.unit}".rstrip() for figure in (middle, most))
                lines.append(f"{quality.name}, {name}: median {middle}, most {most}")
    return "\n".join([table(rows), *lines])


def _worst(report: WholeReport, worst: Sequence[WholeResult]) -> str:
    engines = [column for peer in report.peers for column in (peer, "at like quality")]
    rows = [["scene", "family", "bodies", "scalar", "wide", "ms", *engines, "most of it", "path", "features"]]
    for one in worst:
        result, (name, share) = one.result, one.dearest
        ms = result.ours.step_ms
        rows.append([
            result.scene.name, result.scene.group, f"{result.scene.size}", f"{one.scalar}", f"{one.wide}",
            cell(None if ms is None else ms.mean, ".3g"),
            *(text for peer in report.peers for text in _ratios(result.engines.get(peer))),
            f"{name} {share:.0%}", one.path, ", ".join(one.features),
        ])  # fmt: skip
    return table(rows, words=(0, 1, *range(6 + len(engines), 9 + len(engines))))


def _ratios(found: EngineResult | None) -> tuple[str, str]:
    """Return a peer's time by PhysicsLab's, and that at like quality with its parts of a step."""
    usual = cell(None if found is None else found.times_ours, ".2f")
    if found is None or found.alike is None:
        return usual, cell(None, ".2f")
    least = "" if found.alike.is_reached else "more than "
    return usual, f"{least}{found.alike.times_ours:.2f} (1/{found.alike.finer})"


def _common(report: WholeReport) -> str:
    """Return a line for each feature and family, those with the smallest median first."""
    groups: dict[str, list[WholeResult]] = {}
    for one in report.found:
        for feature in (one.result.scene.group, *one.features):
            groups.setdefault(feature, []).append(one)
    lines = []
    for name, group in groups.items():
        medians = [
            float(np.median(found)) if (found := report.ratios(peer, group)) else None
            for peer in report.peers
        ]
        if len(group) >= _FEW:
            lines.append(
                (medians[0] if medians and medians[0] is not None else 0.0, name, len(group), medians)
            )
    rows = [["feature", "scenes", *report.peers]]
    for _, name, count, medians in sorted(lines, key=lambda line: line[:2]):
        rows.append([name, f"{count}", *(cell(median, ".2f") for median in medians)])
    return table(rows)


def random_jobs(
    seed: int, first: int, count: int, peers: Sequence[type[Peer]]
) -> Iterator[tuple[float, Job[WholeResult]]]:
    """Yield the work: ``count`` scenes of a series from the ``first`` on, each with its bodies."""
    for number in range(first, first + count):
        scene, features = random_scene(seed, number)
        yield float(scene.size), measure_whole(scene, features, peers)


def alike_jobs(
    scenes: Sequence[BenchScene], peers: Sequence[type[Peer]]
) -> Iterator[tuple[float, Job[WholeResult]]]:
    """Yield the work: scenes of the benchmark, judged by their overlaps and joints alone."""
    for scene in scenes:
        judged = replace(scene, quality=(largest_overlap(math.inf), stretched(math.inf)))
        yield float(scene.size), measure_whole(judged, [], peers)


WHOLE_PEERS: tuple[type[Peer], ...] = (PymunkMirror,)
"""The packages that whole runs are made in: the others are slower, or the same in C."""
