"""What the accuracy lab found, as a document."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from physicslab.lab.accuracy.catalogue import LEFT_OUT
from physicslab.lab.accuracy.contacts.study import ContactStudy
from physicslab.lab.accuracy.figures import record
from physicslab.lab.accuracy.honesty.study import QUANTITIES, HonestRow, share_of
from physicslab.lab.accuracy.scene_study import ESTIMATE, SceneStudy
from physicslab.lab.accuracy.study import Curve, Study
from physicslab.lab.accuracy.trust import Trust, trust_report
from physicslab.lab.accuracy.trust_rows import TrustRow, summarise
from physicslab.lab.document import lab_document, plain

__all__ = ["document", "trust_document"]


def document(
    studies: Sequence[Study], scenes: Sequence[SceneStudy] = (), contacts: Sequence[ContactStudy] = ()
) -> dict[str, Any]:
    """Return everything that was measured."""
    return lab_document(
        "accuracy",
        peers=any(curve.rows and not curve.engine.own for study in contacts for curve in study.curves),
        problems=[_study(study) for study in studies],
        contacts=[_contacts(study) for study in contacts],
        scenes=[_scene(study) for study in scenes],
        left_out=LEFT_OUT,
    )


def trust_document(
    rows: Sequence[TrustRow], scenes: Mapping[str, Trust], random: Sequence[HonestRow] = ()
) -> dict[str, Any]:
    """Return estimates of errors beside true errors, and what can be relied on in scenes by their names."""
    found, share = summarise(rows), share_of(random)
    problems = [
        {
            "name": row.case.name, "measure": row.case.measure, "method": row.method,
            "estimate": row.estimate, "error": row.error, "ratio": row.ratio, "near": row.is_near,
        }
        for row in rows
    ]  # fmt: skip
    return lab_document(
        "trust",
        problems=problems,
        summary={"known": found.known, "near": found.near, "largest": found.largest, "holds": found.holds},
        random=[{**plain(row), "ratios": dict(zip(QUANTITIES, row.ratios, strict=False))} for row in random],
        honest={
            "known": share.known, "honest": dict(zip(QUANTITIES, share.honest, strict=True)),
            "too_large": share.too_large, "worst": share.worst, "holds": share.holds,
        },
        scenes=[{"name": name, **trust_report(trust)} for name, trust in scenes.items()],
    )  # fmt: skip


def _study(study: Study) -> dict[str, Any]:
    problem = study.problem
    against = "the energy at the start" if "energy" in problem.keeps else None
    return {
        "name": problem.name, "title": problem.title, "group": problem.group, "source": problem.family,
        "reference": record(problem.family)["method"], "compared": problem.compared,
        "measure": problem.measure, "seconds": problem.seconds, "good": problem.good,
        "excellent": problem.excellent, "rounding_floor": study.floor,
        "energy_against": "the exact energy at that time" if problem.exact_energy else against,
        "note": problem.note, "best": study.best, "auto": study.auto, "rigid": study.rigid,
        "integrators": [_curve(curve) for curve in study.curves],
    }  # fmt: skip


def _curve(curve: Curve) -> dict[str, Any]:
    method = curve.integrator
    return {
        "name": method.name, "title": method.title, "order": method.order, "order_measured": curve.order,
        "order_short": curve.short, "refused": curve.refused, "rows": curve.rows,
    }  # fmt: skip


def _contacts(study: ContactStudy) -> dict[str, Any]:
    case = study.case
    engines = [
        {
            "name": curve.engine.name, "title": curve.engine.title, "order_measured": curve.order,
            "verdict": curve.verdict, "refused": curve.refused, "rows": curve.rows,
        }
        for curve in study.curves
    ]  # fmt: skip
    return {
        "name": case.name, "title": case.title, "group": case.group, "compared": case.compared,
        "measure": case.measure, "reference": case.source, "seconds": case.seconds, "wanted": case.wanted,
        "engines": engines,
    }  # fmt: skip


def _scene(study: SceneStudy) -> dict[str, Any]:
    found, rows = study.estimate, [plain(row) for row in study.rows]
    names = ("error", "worst", "order", "order_reason", "twins", "failure")
    for row in rows:
        cpu_s = row.pop("cpu_s")
        row["cpu_ms"] = None if row["failure"] else 1e3 * cpu_s
    return {
        "scene": study.name, "seconds": study.seconds, "kind": ESTIMATE, "reference": study.reference,
        "estimate": {name: getattr(found, name) for name in names}, "rows": rows,
        "horizon_s": study.horizon_s,
    }  # fmt: skip
