"""What the accuracy lab found, as tables for the terminal."""

from __future__ import annotations

from collections.abc import Sequence

from physicslab.lab.accuracy.catalogue import LEFT_OUT
from physicslab.lab.accuracy.estimate import Spread
from physicslab.lab.accuracy.honesty.study import FAMILIES, QUANTITIES, HonestRow, share_of
from physicslab.lab.accuracy.problem import Problem
from physicslab.lab.accuracy.scene_study import ESTIMATE, SceneRow, SceneStudy
from physicslab.lab.accuracy.study import Curve, Row, Study
from physicslab.lab.accuracy.trust import Trust
from physicslab.lab.accuracy.trust_rows import TrustRow, summarise
from physicslab.lab.accuracy.verdict import Verdict
from physicslab.lab.table import cell, table

__all__ = [
    "honest_text",
    "left_out_text",
    "scene_text",
    "study_text",
    "summary_text",
    "trust_rows_text",
    "trust_text",
]

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
        lines.append("  energy: compared with the exact energy at that time, since some is dissipated")
    if problem.note:
        lines.append(f"  note: {problem.note}")
    rows = [_HEAD, _cells(problem, study.auto, "auto", "", "")]
    if study.rigid is not None:
        rows.append(_cells(problem, study.rigid, "rigid contacts", "", ""))
    for curve in study.curves:
        rows += _curve_cells(problem, curve, whole)
    auto = f"  auto: {study.auto.measurement.integrator}, {study.auto.measurement.reason}"
    return "\n".join([*lines, _reported(rows), auto, *_short_orders(study), *_refusals(study), ""])


def _refusals(study: Study) -> list[str]:
    """Return why methods have no row, methods of one reason together."""
    reasons: dict[str, list[str]] = {}
    for curve in study.curves:
        name = curve.integrator.name
        if curve.refused:
            reason = curve.refused.removeprefix(f"{name} was asked for, ").removeprefix("and ")
            reasons.setdefault(reason, []).append(name)
    return [f"  not {', '.join(names)}: {reason}" for reason, names in reasons.items()]


def _short_orders(study: Study) -> list[str]:
    """Return why orders are not reached, methods of one reason together."""
    reasons: dict[str, list[str]] = {}
    for curve in study.curves:
        if curve.short:
            reasons.setdefault(curve.short, []).append(curve.integrator.name)
    return [f"  * order of {', '.join(names)}: {reason}" for reason, names in reasons.items()]


def _curve_cells(problem: Problem, curve: Curve, whole: bool) -> list[tuple[str, ...]]:
    if not curve.rows:
        return []
    order = f"{curve.integrator.order:g}" + ("*" if curve.short else "")
    measured = cell(curve.order, ".2f")
    if not whole:
        return [_cells(problem, _best_row(curve.rows), curve.integrator.name, order, measured)]
    return [
        _cells(problem, row, *((curve.integrator.name, order, measured) if i == 0 else ("", "", "")))
        for i, row in enumerate(curve.rows)
    ]


def _best_row(rows: Sequence[Row]) -> Row:
    """Return the cheapest excellent row, or else the one of the smallest error."""
    excellent = [row for row in rows if row.verdict is Verdict.EXCELLENT]
    if excellent:
        return min(excellent, key=lambda row: row.measurement.cpu_s)
    return min(rows, key=lambda row: float("inf") if row.measurement.error is None else row.measurement.error)


def _cells(problem: Problem, row: Row, name: str, order: str, measured: str) -> tuple[str, ...]:
    found, seen = row.measurement, row.measurement.watched
    fineness = found.setting.tolerance if found.dt is None else found.dt
    return (
        name, order, measured, cell(fineness, ".3g"), str(found.steps), str(found.evaluations),
        f"{1e3 * found.cpu_s:.3g}", f"{1e3 * found.cpu_s / problem.seconds:.2g}", cell(found.error, ".1e"),
        cell(seen.energy, ".1e"), cell(seen.momentum, ".1e"), cell(seen.angular_momentum, ".1e"),
        cell(seen.rate_dt, ".2g"), cell(seen.penetration, ".1e"),
        "" if seen.collisions is None else f"{seen.collisions:+d}", str(row.verdict),
    )  # fmt: skip


def _reported(rows: Sequence[tuple[str, ...]]) -> str:
    """Return rows as a table, without columns that hold nothing."""
    kept = [i for i in range(len(_HEAD)) if any(row[i] not in ("", "-") for row in rows[1:])]
    return table([[row[i] for i in kept] for row in rows], words=(0, len(kept) - 1), indent="  ")


def scene_text(study: SceneStudy) -> str:
    """Return what was found of a scene as a table."""
    head = ("method", "ran", "step", "forces", "CPU ms", "half step", "error [m]", "energy", "")
    return "\n".join([
        f"{study.name}: {ESTIMATE}",
        *_estimate_lines(study),
        f"  how far bodies are [m] after {study.seconds:g} s from where they are with half the step (and a "
        f"tenth of the tolerance); error: from {study.reference}",
        table([head, *map(_scene_cells, study.rows)], words=(0, 1, 8), indent="  "),
        f"  auto: {study.rows[0].reason}",
        "",
    ])  # fmt: skip


def _estimate_lines(study: SceneStudy) -> list[str]:
    """Return how far the scene as it is configured is from its twins."""
    found = study.estimate
    if found.error is None:
        return [f"  no estimate: {found.failure or 'no twin of the scene could be run'}"]
    head = ("twin", "place [m]", "angle [rad]", "velocity [m/s]", "spin [rad/s]", "")
    rows = [("largest: the error", *_spread_cells(found.error), "")]
    rows += [(twin.name, *_spread_cells(twin.spread), twin.failure or twin.what) for twin in found.twins]
    order = "none" if found.order is None else f"{found.order:.1f}"
    return [
        f"  as it is configured, and how far its twins end from it after {study.seconds:g} s, of any body",
        table([head, *rows], words=(0, 5), indent="  "),
        f"  order of the error in the step: {order} ({found.order_reason})",
        f"  horizon: {_horizon_words(study.horizon_s)}",
        "",
    ]


def _horizon_words(horizon_s: float | None) -> str:
    """Return until when a scene can be predicted."""
    if horizon_s is None:
        return "no rounding was seen to grow to another future"
    return f"one of many possible futures {horizon_s:.3g} s after the start, by whatever method"


def _spread_cells(spread: Spread | None) -> tuple[str, str, str, str]:
    if spread is None:
        return ("-", "-", "-", "-")
    return f"{spread.position:.1e}", f"{spread.angle:.1e}", f"{spread.velocity:.1e}", f"{spread.spin:.1e}"


def _scene_cells(row: SceneRow) -> tuple[str, ...]:
    return (
        row.asked, row.integrator, row.step, str(row.evaluations), f"{1e3 * row.cpu_s:.3g}",
        cell(row.half_step, ".1e"), f"{'at most ' if row.at_most else ''}{cell(row.error, '.1e')}",
        cell(row.energy, ".1e"), row.failure,
    )  # fmt: skip


def summary_text(studies: Sequence[Study]) -> str:
    """Return the number of problems on which ``auto``, and any method, is excellent; and the others."""
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
            f"  {name}: auto has {cell(error, '.1e')} ({study.auto.verdict}), excellent would "
            f"be {limit:.1e}; {any_method}"
        )
    touching = [study for study in studies if study.problem.touches]
    if touching and all(study.auto.measurement.integrator != "exact" for study in touching):
        lines.append("where bodies touch, contacts are found within steps: no impact is located in time")
    return "\n".join(lines)


def _best_verdict(study: Study) -> Verdict:
    rows = [*study.chosen, *(row for curve in study.curves for row in curve.rows)]
    return Verdict.EXCELLENT if any(row.verdict is Verdict.EXCELLENT for row in rows) else Verdict.SHORT


def left_out_text() -> str:
    """Return which reference problems are not there, and why."""
    return "\n".join(["not computed:", *(f"  {left.name}: {left.reason}" for left in LEFT_OUT)])


def trust_rows_text(rows: Sequence[TrustRow]) -> str:
    """Return a line for each problem: estimate, true error, and the second over the first."""
    head = ("problem", "method", "estimate", "true error", "true / estimate", "measured as")
    lines = [
        (
            row.case.name, row.method, cell(row.estimate, ".1e"), cell(row.error, ".1e"),
            cell(row.ratio, ".2g"), row.case.measure,
        )
        for row in rows
    ]  # fmt: skip
    found = summarise(rows)
    if not found.known:
        return table([head, *lines], words=(0, 1, 5))
    closing = (
        f"within a factor of 10: {found.near} of {found.known} ({found.near / found.known:.0%}), "
        f"with {found.cautious} estimates of rounding (up to 1e-12) that are more than 10 times too large; "
        f"the true error is at most {found.largest:.2g} times the estimate: "
        f"{'as it is to be' if found.holds else 'NOT AS IT IS TO BE'} (95 %, and at most 100)"
    )
    return "\n".join([table([head, *lines], words=(0, 1, 5)), "", closing])


def honest_text(rows: Sequence[HonestRow]) -> str:
    """Return a line for each family of random scenes: how often the estimate of an error is honest."""
    families = {family: [row for row in rows if row.family == family] for family in FAMILIES}
    head = ("random scenes", "known", *QUANTITIES, "worst", "too large")
    lines = []
    for name, found in (*families.items(), ("all", rows)):
        share = share_of(found)
        shown = (f"{count / share.known:.1%}" if share.known else "-" for count in share.honest)
        lines.append((name, str(share.known), *shown, f"{share.worst:.2g}", str(share.too_large)))
    share = share_of(rows)
    closing = (
        f"honest, the true error at most 3 times the estimate: {share.honest[0]} of {share.known} "
        f"positions ({share.honest[0] / max(share.known, 1):.1%}), wanted 99 of 100: "
        f"{'as it is to be' if share.holds else 'NOT AS IT IS TO BE'}; more than 100 times too large "
        f"(and not of rounding): {share.too_large}"
    )
    return "\n".join([table([head, *lines], words=(0,)), "", closing])


def trust_text(name: str, trust: Trust) -> str:
    """Return how many digits of a scene can be relied on, and until when."""
    if trust.failure:
        return f"{name}: cannot be measured: {trust.failure}\n"
    head = ("until", "position", "velocity", "angle", "spin", "energy", "momentum", "worst body")
    rows = [
        (
            f"{look.seconds:.4g} s", f"{look.digits:.1f}", f"{min(look.velocities):.1f}",
            f"{min(look.angles):.1f}", f"{min(look.spins):.1f}", f"{look.energy:.1f}", f"{look.momentum:.1f}",
            [*trust.entities][look.bodies.index(look.digits)],
        )
        for look in trust.looks
    ]  # fmt: skip
    lines = [f"{name}: digits that agree in all ways to compute it", table([head, *rows], words=(7,))]
    lines += [f"  left out: {words}" for words in trust.left_out]
    return "\n".join([*lines, f"  horizon: {_horizon_words(trust.horizon_s)}", ""])
