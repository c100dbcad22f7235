"""The results of the benchmark, as tables for the terminal."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from physicslab.lab.bench.added import BODIES, Added
from physicslab.lab.bench.catalogue import PEER_SIZE_LIMIT
from physicslab.lab.bench.costs import Memory, Unused
from physicslab.lab.bench.engine import OURS
from physicslab.lab.bench.result import EngineResult, Growth, SceneResult, Spread, growths
from physicslab.lab.bench.targets import Check, checks
from physicslab.lab.report import cell, lab_document, machine_text, pick, plain, table


@dataclass(slots=True)
class BenchReport:
    """All that a run of the benchmark found.

    Attributes
    ----------
    peers : bool
        Whether other engines took part.
    scenes : list of SceneResult
        Scene by scene.
    unused : list of Unused
        Costs of a step for systems that it does not use.
    added : list of Added
        Those of a crowd for one thing more.
    memory : Memory, optional
        Memory of a body, where that was measured.
    """

    peers: bool
    scenes: list[SceneResult] = field(default_factory=list)
    unused: list[Unused] = field(default_factory=list)
    added: list[Added] = field(default_factory=list)
    memory: Memory | None = None

    @property
    def growths(self) -> list[Growth]:
        """How costs grow with the number of bodies."""
        return growths(self.scenes)

    @property
    def checks(self) -> list[Check]:
        """These figures beside their targets."""
        return checks(self.scenes, self.growths, self.unused)

    @property
    def document(self) -> dict[str, Any]:
        """Every figure, its target, and the machine it was taken on."""
        return lab_document(
            "bench", peers=self.peers, scenes=[_scene(result) for result in self.scenes],
            growth=self.growths, unused=self.unused, added=self.added, bytes_per_body=self.memory,
            targets=[{**plain(check), "met": check.met} for check in self.checks],
        )  # fmt: skip


def _scene(result: SceneResult) -> dict[str, Any]:
    scene = result.scene
    return {
        **pick(scene, "name", "title", "group"), "bodies": scene.size, "contacts": result.contacts,
        "settled_s": scene.seconds, "steps": scene.steps, "one_call": scene.compiled_runs,
        "quality_limits": [pick(quality, "name", "unit", "limit", "when") for quality in scene.quality],
        "systems_ms": result.systems, "engines": [*result.engines.values()],
    }  # fmt: skip


_BEGIN = (
    "ms of CPU time a step of the first 2 s: median; p99: the 99th percentile as a multiple of it; ratio: "
    "the median of how many times as long others take for the same step"
)
_SETTLED = "the same of the steps after that, from when most scenes have settled"
_WITH_READ = "the same, with every position read back after each step"


def _ms(spread: Spread | None) -> str:
    return cell(None if spread is None else spread.median, "#.3g")


def scene_text(result: SceneResult) -> str:
    """Return a line on a scene that has been timed."""
    parts = [
        f"{found.name} {found.failure or _ms(found.step_ms) + ' ms'}" for found in result.engines.values()
    ]
    return f"{result.scene.name}: " + ", ".join(parts)


def report_text(report: BenchReport) -> str:
    """Return every table that is not empty, the machine first."""
    blocks = {"": machine_text(peers=report.peers)}
    if report.scenes:
        blocks[_BEGIN] = _times(
            report, lambda found: (found.first_seconds_ms, found.times_ours_first_seconds)
        )
        blocks[_SETTLED] = _times(report, lambda found: (found.step_ms, found.times_ours))
        if report.peers:
            blocks[_WITH_READ] = _times(
                report, lambda found: (found.step_and_read_ms, found.times_ours_with_read)
            )
        blocks["quality: the largest that was seen, before the timing, or at the end"] = _quality(report)
        blocks["ms a step by system, as shares of the median"] = _systems(report)
    if report.growths:
        blocks[_growth_title(report)] = _growth(report)
    if report.unused:
        blocks["a step with the systems that the scene needs, and with all there are"] = _unused(report)
    if report.added:
        blocks[f"ms a step of {BODIES:,} bodies in a funnel, and with one thing more far from them"] = _added(
            report
        )
    if memory := report.memory:
        blocks["bytes a body"] = (
            f"{memory.columns:.0f} in columns, {memory.spawned:.0f} with handles and esper's part, "
            f"{memory.with_contacts:.0f} with the contacts of a pile"
        )
    if report.checks:
        blocks["targets"] = _targets(report)
    return "\n\n".join(f"{title}\n{text}" if title else text for title, text in blocks.items())


def _times(report: BenchReport, of: Callable[[EngineResult], tuple[Spread | None, float | None]]) -> str:
    """Return a table of one kind of step, which is what ``of`` returns of an engine's results."""
    peers = [name for name in _engines(report) if name != OURS]
    rows = [
        ["scene", "bodies", "contacts", OURS, "p99", *(word for name in peers for word in (name, "ratio"))]
    ]
    for result in report.scenes:
        ours, _ = of(result.ours)
        row = [result.scene.name, f"{result.scene.size}", f"{result.contacts}", _ms(ours)]
        row.append(cell(None if ours is None else ours.tail, ".1f"))
        for name in peers:
            spread, ratio = of(result.engines.get(name, EngineResult(name)))
            row += [_ms(spread), cell(ratio, ".2f")]
        rows.append(row)
    return table(rows)


def _engines(report: BenchReport) -> list[str]:
    return list(dict.fromkeys(name for result in report.scenes for name in result.engines))


def _quality(report: BenchReport) -> str:
    engines = _engines(report)
    rows = [["scene", "figure", *engines, "limit"]]
    for result in report.scenes:
        for quality in result.scene.quality:
            figures = [_figure(result.engines.get(name), quality.name) for name in engines]
            limit = f"{quality.limit:g} {quality.unit}".rstrip()
            rows.append([result.scene.name, quality.name, *figures, limit])
    return table(rows, words=(0, 1)) if len(rows) > 1 else "none is measured in scenes that were opened"


def _figure(found: EngineResult | None, name: str) -> str:
    if found is None or found.failure:
        return "-" if found is None else found.failure
    return cell(found.quality.get(name), ".2g")


def _systems(report: BenchReport) -> str:
    names = list(dict.fromkeys(name for result in report.scenes for name in result.systems))
    rows = [["scene", *(name.removesuffix("System") for name in names), "beside them"]]
    for result in report.scenes:
        if result.ours.step_ms is None:
            continue
        rest = result.ours.step_ms.median - sum(result.systems.values())
        spent = [result.systems.get(name) for name in names]
        rows.append([result.scene.name, *(cell(ms, ".4f") for ms in spent), cell(max(0.0, rest), ".4f")])
    return table(rows)


def _growth_title(report: BenchReport) -> str:
    title = "growth of a step's cost: ms for so many bodies, and the p of N^p"
    alone = any(result.scene.size > PEER_SIZE_LIMIT and len(result.engines) == 1 for result in report.scenes)
    remark = f"; beyond {PEER_SIZE_LIMIT:,}, which take others minutes, PhysicsLab alone"
    return title + remark if report.peers and alone else title


def _growth(report: BenchReport) -> str:
    sizes = sorted({size for growth in report.growths for size in growth.sizes})
    rows = [["scenes", "engine", *(f"{size}" for size in sizes), "p"]]
    for growth in report.growths:
        costs = dict(zip(growth.sizes, growth.ms, strict=True))
        every = [f"{costs[size]:#.3g}" if size in costs else "-" for size in sizes]
        rows.append([growth.group, growth.engine, *every, cell(growth.exponent, ".3f")])
    return table(rows, words=(0, 1))


def _unused(report: BenchReport) -> str:
    rows = [["scene", "needed, ms", "all, ms", "ratio", "not run", "same bits"]]
    rows += [
        [
            spent.scene, _ms(spent.needed_ms), _ms(spent.all_ms), cell(spent.ratio, ".3f"),
            ", ".join(name.removesuffix("System") for name in spent.left_out),
            "yes" if spent.same_bits else "no",
        ]
        for spent in report.unused
    ]  # fmt: skip
    return table(rows)


def _added(report: BenchReport) -> str:
    rows = [["with", "without, ms", "with, ms", "ratio", "stepper"]]
    rows += [
        [one.what, _ms(one.without_ms), _ms(one.with_ms), cell(one.ratio, ".2f"), one.stepper]
        for one in report.added
    ]
    return table(rows, words=(0, 4))


def _targets(report: BenchReport) -> str:
    rows = [["scene", "figure", "found", "must be", "verdict"]]
    rows += [
        [
            check.name, check.what, cell(check.figure, ".2f"),
            f"{'>=' if check.at_least else '<='} {check.limit:g}", check.verdict,
        ]
        for check in report.checks
    ]  # fmt: skip
    return table(rows, words=(0, 1))
