"""What the accuracy lab found, as text."""

from __future__ import annotations

from collections.abc import Sequence

from physicslab.lab.accuracy.catalogue import LEFT_OUT
from physicslab.lab.accuracy.problem import Problem
from physicslab.lab.accuracy.study import Curve, Row, Study
from physicslab.lab.accuracy.verdict import Verdict

__all__ = ["left_out_text", "study_text", "summary_text"]

_HEAD = ("method", "order", "measured", "dt or tol", "steps", "forces", "CPU ms", "ms / s", "error", "energy",
         "momentum", "ang. mom.", "omega dt", "overlap", "hits", "verdict")  # fmt: skip


def study_text(study: Study, *, whole: bool) -> str:
    """Return a problem's table: every rung, or where not ``whole`` a line for each method."""
    problem = study.problem
    floor = "" if study.floor is None else f"; one rounding at the start does {study.floor:.1g}"
    limits = f"excellent up to {problem.excellent:.2g}, good up to {problem.good:.2g}"
    lines = [
        f"{problem.name}: {problem.title}",
        f"  compared: {problem.compared}",
        f"  error: {problem.measure}; {limits}{floor}",
    ]
    if problem.exact_energy is not None:
        lines.append("  energy: against the exact one at that time, as some is lost on the way")
    if problem.note:
        lines.append(f"  note: {problem.note}")
    rows = [_HEAD, _cells(problem, study.auto, "auto", "", "")]
    for curve in study.curves:
        rows += _curve_cells(problem, curve, whole)
    return "\n".join([*lines, *_aligned(rows), f"  auto: {study.auto.measurement.integrator}, "
                      f"{study.auto.measurement.reason}", *_refusals(study), ""])  # fmt: skip


def _refusals(study: Study) -> list[str]:
    """Return why methods have no row, methods of one reason together."""
    reasons: dict[str, list[str]] = {}
    for curve in study.curves:
        name = curve.integrator.name
        if curve.refused:
            reason = curve.refused.removeprefix(f"{name} was asked for, ").removeprefix("and ")
            reasons.setdefault(reason, []).append(name)
    return [f"  not {', '.join(names)}: {reason}" for reason, names in reasons.items()]


def _curve_cells(problem: Problem, curve: Curve, whole: bool) -> list[tuple[str, ...]]:
    if not curve.rows:
        return []
    order = f"{curve.integrator.order:g}" + ("" if curve.holds else "*")
    measured = _short(curve.order, ".2f")
    if not whole:
        return [_cells(problem, _telling(curve.rows), curve.integrator.name, order, measured)]
    return [
        _cells(problem, row, *((curve.integrator.name, order, measured) if i == 0 else ("", "", "")))
        for i, row in enumerate(curve.rows)
    ]


def _telling(rows: Sequence[Row]) -> Row:
    """Return the cheapest excellent row, or else the one of the smallest error."""
    excellent = [row for row in rows if row.verdict is Verdict.EXCELLENT]
    if excellent:
        return min(excellent, key=lambda row: row.measurement.cpu_s)
    return min(rows, key=lambda row: float("inf") if row.measurement.error is None else row.measurement.error)


def _cells(problem: Problem, row: Row, name: str, order: str, measured: str) -> tuple[str, ...]:
    found, seen = row.measurement, row.measurement.watched
    fineness = found.setting.tolerance if found.dt is None else found.dt
    return (
        name, order, measured, _short(fineness, ".3g"), str(found.steps), str(found.evaluations),
        f"{1e3 * found.cpu_s:.3g}", f"{1e3 * found.cpu_s / problem.seconds:.2g}", _short(found.error, ".1e"),
        _short(seen.energy, ".1e"), _short(seen.momentum, ".1e"), _short(seen.angular_momentum, ".1e"),
        _short(seen.rate_dt, ".2g"), _short(seen.penetration, ".1e"),
        "" if seen.collisions is None else f"{seen.collisions:+d}", str(row.verdict),
    )  # fmt: skip


def _short(number: float | None, form: str) -> str:
    return "-" if number is None else format(number, form)


def _aligned(rows: Sequence[tuple[str, ...]]) -> list[str]:
    """Return rows as lines; columns that say nothing are left out, numbers stand to the right."""
    reported = [i for i in range(len(rows[0])) if any(row[i] not in ("", "-") for row in rows[1:])]
    widths = {i: max(len(row[i]) for row in rows) for i in reported}
    sides = {i: "<" if i in (0, len(rows[0]) - 1) else ">" for i in reported}
    return ["  " + "  ".join(f"{row[i]:{sides[i]}{widths[i]}}" for i in reported).rstrip() for row in rows]


def summary_text(studies: Sequence[Study]) -> str:
    """Return on how many problems ``auto``, and any method at all, is excellent; and where not."""
    short = [study for study in studies if study.auto.verdict is not Verdict.EXCELLENT]
    none = [study for study in studies if _best_verdict(study) is not Verdict.EXCELLENT]
    lines = [
        f"auto is excellent on {len(studies) - len(short)} of {len(studies)} problems, "
        f"some method on {len(studies) - len(none)}"
    ]
    for study in short:
        name, limit = study.problem.name, study.problem.excellent
        any_method = "no method is" if study in none else f"the best error of any method is {study.best:.1e}"
        error = study.auto.measurement.error
        lines.append(
            f"  {name}: auto has {_short(error, '.1e')} ({study.auto.verdict}), excellent would "
            f"be {limit:.1e}; {any_method}"
        )
    if any(not curve.holds for study in studies for curve in study.curves if curve.rows):
        lines.append("* an order that does not hold for these forces, or where bodies touch")
    touching = [study for study in studies if study.problem.touches]
    if touching and all(study.auto.measurement.integrator != "exact" for study in touching):
        lines.append("where bodies touch, contacts are found within steps: no impact is located in time")
    return "\n".join(lines)


def _best_verdict(study: Study) -> Verdict:
    verdicts = [study.auto.verdict, *(row.verdict for curve in study.curves for row in curve.rows)]
    return Verdict.EXCELLENT if Verdict.EXCELLENT in verdicts else Verdict.SHORT


def left_out_text() -> str:
    """Return which reference problems are not there, and why."""
    return "\n".join(["not asked:", *(f"  {left.name}: {left.reason}" for left in LEFT_OUT)])
