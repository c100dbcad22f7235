"""What the accuracy lab found, as a document."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from physicslab.lab.accuracy.catalogue import LEFT_OUT
from physicslab.lab.accuracy.contacts.document import contact_document
from physicslab.lab.accuracy.contacts.study import ContactStudy
from physicslab.lab.accuracy.figures import record
from physicslab.lab.accuracy.honesty.study import QUANTITIES, HonestRow, share_of
from physicslab.lab.accuracy.problem import Problem
from physicslab.lab.accuracy.scene_study import ESTIMATE, SceneRow, SceneStudy
from physicslab.lab.accuracy.study import Curve, Row, Study
from physicslab.lab.accuracy.trust import Trust, trust_report
from physicslab.lab.accuracy.trust_rows import TrustRow, summarise
from physicslab.lab.document import finite, lab_document

__all__ = ["document", "trust_document"]


def document(
    studies: Sequence[Study], scenes: Sequence[SceneStudy] = (), contacts: Sequence[ContactStudy] = ()
) -> dict[str, Any]:
    """Return everything that was measured."""
    return lab_document(
        "accuracy",
        peers=any(curve.rows and not curve.engine.own for study in contacts for curve in study.curves),
        problems=[_study(study) for study in studies],
        contacts=[contact_document(study) for study in contacts],
        scenes=[_scene(study) for study in scenes],
        left_out=[asdict(left) for left in LEFT_OUT],
    )


def trust_document(
    rows: Sequence[TrustRow], scenes: Mapping[str, Trust], random: Sequence[HonestRow] = ()
) -> dict[str, Any]:
    """Return estimates of errors beside true errors, and what can be relied on in scenes by their names."""
    found, share = summarise(rows), share_of(random)
    return lab_document(
        "trust",
        problems=[
            {
                "name": row.case.name,
                "measure": row.case.measure,
                "method": row.method,
                "estimate": finite(row.estimate),
                "error": finite(row.error),
                "ratio": finite(row.ratio),
                "near": row.is_near,
            }
            for row in rows
        ],
        summary={"known": found.known, "near": found.near, "largest": found.largest, "holds": found.holds},
        random=[{**asdict(row), "ratios": dict(zip(QUANTITIES, row.ratios, strict=False))} for row in random],
        honest={
            "known": share.known,
            "honest": dict(zip(QUANTITIES, share.honest, strict=True)),
            "too_large": share.too_large,
            "worst": share.worst,
            "holds": share.holds,
        },
        scenes=[{"name": name, **trust_report(trust)} for name, trust in scenes.items()],
    )


def _study(study: Study) -> dict[str, Any]:
    problem = study.problem
    return {
        "name": problem.name,
        "title": problem.title,
        "group": problem.group,
        "source": problem.family,
        "reference": record(problem.family)["method"],
        "compared": problem.compared,
        "measure": problem.measure,
        "seconds": problem.seconds,
        "good": problem.good,
        "excellent": problem.excellent,
        "rounding_floor": finite(study.floor),
        "energy_against": _energy_against(problem),
        "note": problem.note,
        "best": finite(study.best),
        "auto": _row(problem, study.auto),
        "rigid": None if study.rigid is None else _row(problem, study.rigid),
        "integrators": [_curve(problem, curve) for curve in study.curves],
    }


def _energy_against(problem: Problem) -> str | None:
    if problem.exact_energy is not None:
        return "the exact energy at that time"
    return "the energy at the start" if "energy" in problem.keeps else None


def _curve(problem: Problem, curve: Curve) -> dict[str, Any]:
    method = curve.integrator
    return {
        "name": method.name,
        "title": method.title,
        "order": finite(method.order),
        "order_measured": finite(curve.order),
        "order_short": curve.short,
        "refused": curve.refused,
        "rows": [_row(problem, row) for row in curve.rows],
    }


def _row(problem: Problem, row: Row) -> dict[str, Any]:
    found, seen = row.measurement, row.measurement.watched
    return {
        "integrator": found.integrator,
        "reason": found.reason,
        "collisions": found.setting.collisions,
        "dt": found.dt,
        "tolerance": found.setting.tolerance,
        "steps": found.steps,
        "force_evaluations": found.evaluations,
        "cpu_ms": 1e3 * found.cpu_s,
        "ms_per_simulated_s": 1e3 * found.cpu_s / problem.seconds,
        "time": problem.seconds,
        "error": finite(found.error),
        "energy_drift": finite(seen.energy),
        "energy_numerical": finite(seen.numerical),
        "momentum_error": finite(seen.momentum),
        "angular_momentum_error": finite(seen.angular_momentum),
        "omega_max_dt": finite(seen.rate_dt),
        "max_penetration": finite(seen.penetration),
        "collision_count_error": seen.collisions,
        "verdict": str(row.verdict),
        "failure": found.failure,
    }


def _scene(study: SceneStudy) -> dict[str, Any]:
    estimate = asdict(study.estimate)
    for name in ("reference", "bodies", "path", "paths", "document", "own_s", "left_s"):
        del estimate[name]
    return {
        "scene": study.name, "seconds": study.seconds, "kind": ESTIMATE, "reference": study.reference,
        "estimate": estimate, "rows": [_scene_row(row) for row in study.rows],
        "horizon_s": study.horizon_s,
    }  # fmt: skip


def _scene_row(row: SceneRow) -> dict[str, Any]:
    found = asdict(row)
    found["cpu_ms"] = 1e3 * found.pop("cpu_s") if not row.failure else None
    return {key: finite(value) if isinstance(value, float) else value for key, value in found.items()}
