"""What the accuracy lab found, as a document: numbers are finite or ``null``, units are SI."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from physicslab.lab.accuracy.catalogue import LEFT_OUT
from physicslab.lab.accuracy.figures import record
from physicslab.lab.accuracy.problem import Problem
from physicslab.lab.accuracy.study import Curve, Row, Study

__all__ = ["document", "finite"]


def document(studies: Sequence[Study], scenes: Sequence[dict[str, Any]] = ()) -> dict[str, Any]:
    """Return everything that was measured."""
    return {
        "format": "physicslab-accuracy/1",
        "problems": [_study(study) for study in studies],
        "scenes": list(scenes),
        "left_out": [{"name": left.name, "reason": left.reason} for left in LEFT_OUT],
    }


def finite(number: float | None) -> float | None:
    """Return a number, or ``None`` where it is not finite: JSON has no such numbers."""
    return number if number is not None and math.isfinite(number) else None


def _study(study: Study) -> dict[str, Any]:
    problem = study.problem
    return {
        "name": problem.name,
        "title": problem.title,
        "group": problem.group,
        "source": problem.source,
        "reference": record(problem.source)["method"],
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
        "order_holds": curve.holds,
        "order_measured": finite(curve.order),
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
        "momentum_error": finite(seen.momentum),
        "angular_momentum_error": finite(seen.angular_momentum),
        "omega_max_dt": finite(seen.rate_dt),
        "max_penetration": finite(seen.penetration),
        "collision_count_error": seen.collisions,
        "verdict": str(row.verdict),
        "failure": found.failure,
    }
