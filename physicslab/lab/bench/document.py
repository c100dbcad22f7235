"""What the benchmark found, as a document: times in ms, else SI units."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from physicslab.lab.bench.clock import Spread
from physicslab.lab.bench.report import BenchReport
from physicslab.lab.bench.result import EngineResult, SceneResult
from physicslab.lab.bench.unused import Unused
from physicslab.lab.document import lab_document

__all__ = ["document"]


def document(report: BenchReport) -> dict[str, Any]:
    """Return every figure, its target, and the machine it was taken on."""
    return lab_document(
        "bench",
        peers=report.peers,
        scenes=[_scene(result) for result in report.scenes],
        growth=[asdict(growth) for growth in report.growths],
        unused=[_unused(spent) for spent in report.unused],
        bytes_per_body=None if report.memory is None else asdict(report.memory),
        targets=[{**asdict(check), "met": check.met} for check in report.checks],
    )


def _unused(spent: Unused) -> dict[str, Any]:
    return {
        "scene": spent.case.name,
        "steps": spent.case.steps,
        "needed_ms": _spread(spent.bare),
        "all_ms": _spread(spent.whole),
        "ratio": spent.ratio,
        "left_out": list(spent.left_out),
        "same_bits": spent.same_bits,
    }


def _scene(result: SceneResult) -> dict[str, Any]:
    scene = result.scene
    return {
        "name": scene.name,
        "title": scene.title,
        "group": scene.group,
        "bodies": scene.size,
        "contacts": result.contacts,
        "settled_s": scene.seconds,
        "steps": result.steps,
        "one_call": scene.compiled_runs,
        "quality_limits": [
            {"name": quality.name, "unit": quality.unit, "limit": quality.limit, "when": quality.when}
            for quality in scene.quality
        ],
        "systems_ms": result.systems,
        "engines": [_engine(found) for found in result.engines.values()],
    }


def _engine(found: EngineResult) -> dict[str, Any]:
    return {
        "name": found.title,
        "step_ms": _spread(found.step),
        "step_and_read_ms": _spread(found.with_read),
        "first_seconds_ms": _spread(found.begin),
        "times_ours": found.ratio,
        "times_ours_with_read": found.ratio_with_read,
        "times_ours_first_seconds": found.begin_ratio,
        "quality": found.quality,
        "failure": found.failure,
    }


def _spread(spread: Spread | None) -> dict[str, float] | None:
    if spread is None:
        return None
    return {
        "median": spread.median_ms, "p90": spread.p90_ms, "p99": spread.p99_ms, "mean": spread.mean_ms,
    }  # fmt: skip
