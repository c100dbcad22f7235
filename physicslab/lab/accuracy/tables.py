"""The results of the accuracy lab: tables for the terminal, and a document."""

import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

from physicslab.lab.accuracy.catalogue import LEFT_OUT
from physicslab.lab.accuracy.contacts.study import ROUNDING, ContactCurve, ContactStudy
from physicslab.lab.accuracy.estimate import Departure
from physicslab.lab.accuracy.honesty.study import FAMILIES, QUANTITIES, HonestRow, share_of
from physicslab.lab.accuracy.measure import Row
from physicslab.lab.accuracy.problem import record
from physicslab.lab.accuracy.scene_study import ESTIMATE, SceneRow, SceneStudy
from physicslab.lab.accuracy.study import MethodCurve, Study
from physicslab.lab.accuracy.trust import Trust, TrustRow, summarise, trust_report
from physicslab.lab.case import Verdict
from physicslab.lab.report import cell, lab_document, pick, plain, table

type _Cells = Sequence[str]

_COLUMNS: dict[str, Callable[[Row], str]] = {
    "dt or tol": lambda row: cell(row.tolerance if row.dt is None else row.dt, ".3g"),
    "steps": lambda row: str(row.steps),
    "forces": lambda row: str(row.force_evaluations),
    "CPU ms": lambda row: f"{row.cpu_ms:.3g}",
    "ms / s": lambda row: f"{row.ms_per_simulated_s:.2g}",
    "error": lambda row: cell(row.error, ".1e"),
    "energy": lambda row: cell(row.energy_drift, ".1e"),
    "momentum": lambda row: cell(row.momentum_error, ".1e"),
    "ang. mom.": lambda row: cell(row.angular_momentum_error, ".1e"),
    "omega dt": lambda row: cell(row.omega_max_dt, ".2g"),
    "overlap": lambda row: cell(row.max_penetration, ".1e"),
    "hits": lambda row: "" if row.collision_count_error is None else f"{row.collision_count_error:+d}",
    "verdict": lambda row: str(row.verdict),
}
"""The columns of a problem's table, behind those of the method and its order."""


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
    rows = [["method", "order", "measured", *_COLUMNS]]
    for name, row in zip(("auto", "rigid contacts"), study.chosen, strict=False):
        rows.append([name, "", "", *_cells(row)])
    for curve in study.curves:
        heads = itertools.chain([_head(curve)], itertools.repeat(["", "", ""]))
        shown = curve.rows if whole or not curve.rows else [_best_row(curve.rows)]
        rows += [[*head, *_cells(row)] for head, row in zip(heads, shown, strict=False)]
    refusals = ((curve.method.name, _reason(curve)) for curve in study.curves)
    short = ((curve.method.name, curve.short) for curve in study.curves)
    return "\n".join([
        *lines,
        _reported(rows),
        f"  auto: {study.auto.integrator}, {study.auto.reason}",
        *(f"  * order of {names}: {reason}" for reason, names in _together(short)),
        *(f"  not {names}: {reason}" for reason, names in _together(refusals)),
        "",
    ])  # fmt: skip


def _head(curve: MethodCurve) -> list[str]:
    order = f"{curve.method.order:g}" + ("*" if curve.short else "")
    return [curve.method.name, order, cell(curve.order, ".2f")]


def _cells(row: Row) -> list[str]:
    return [text(row) for text in _COLUMNS.values()]


def _reason(curve: MethodCurve) -> str:
    """Return why a method is refused, without its own name."""
    return curve.refused.removeprefix(f"{curve.method.name} was asked for, ").removeprefix("and ")


def _together(reasons: Iterable[tuple[str, str]]) -> Iterator[tuple[str, str]]:
    """Yield each reason that is not empty, and the names of the methods that have it."""
    found: dict[str, list[str]] = {}
    for name, reason in reasons:
        if reason:
            found.setdefault(reason, []).append(name)
    yield from ((reason, ", ".join(names)) for reason, names in found.items())


def _best_row(rows: Sequence[Row]) -> Row:
    """Return the cheapest excellent row, or else the one of the smallest error."""
    excellent = [row for row in rows if row.verdict is Verdict.EXCELLENT]
    if excellent:
        return min(excellent, key=lambda row: row.cpu_ms)
    return min(rows, key=lambda row: math.inf if row.error is None else row.error)


def _reported(rows: Sequence[_Cells]) -> str:
    """Return rows as a table, without columns that hold nothing."""
    kept = [i for i, column in enumerate(zip(*rows[1:], strict=True)) if {*column} - {"", "-"}]
    return table([[row[i] for i in kept] for row in rows], words=(0, len(kept) - 1), indent="  ")


_STAR = "  * some steps were left to soft contacts, or made by impulses in short steps: an error of order one"


def contact_text(study: ContactStudy) -> str:
    """Return a contact case's table: a line for each engine, a column for each step."""
    case = study.case
    rows = max((curve.rows for curve in study.curves), key=len)
    starred = any(row.left_to_soft or row.by_impulses for curve in study.curves for row in curve.rows)
    head = ("engine", "order", *(f"1/{1.0 / row.dt:.0f} s" for row in rows), "ms / s", "to", "")
    lines = [_contact_cells(curve, len(rows)) for curve in study.curves if not curve.refused]
    return "\n".join([
        f"{case.name}: {case.title}",
        f"  compared: {case.compared}",
        f"  error: {case.measure}; with rigid contacts {case.wanted:.0e} is wanted",
        table([head, *lines], words=(0, len(head) - 1), indent="  "),
        *(f"  not {curve.method.title}: {curve.refused}" for curve in study.curves if curve.refused),
        *([_STAR] if starred else []),
        "",
    ])  # fmt: skip


def _contact_cells(curve: ContactCurve, count: int) -> _Cells:
    """Return a line; errors have a star where steps were left to soft contacts or made by impulses."""
    starred = ["*" if row.left_to_soft or row.by_impulses else "" for row in curve.rows]
    errors = [cell(row.error, ".1e") + star for row, star in zip(curve.rows, starred, strict=True)]
    costs = [f"{1e3 * row.cpu_s_per_s:.2g}" for row in (curve.rows[0], curve.rows[-1])]
    missing = [""] * (count - len(errors))
    return (curve.method.title, order_text(curve), *errors, *missing, *costs, str(curve.verdict or ""))


def order_text(curve: ContactCurve) -> str:
    """Return the order of a curve, or why it has none."""
    if curve.order is not None:
        return f"{curve.order:.1f}".replace("-0.0", "0.0")
    return "rounding" if curve.largest is not None and curve.largest <= ROUNDING else "-"


def contact_summary(studies: Sequence[ContactStudy]) -> str:
    """Return on how many cases rigid contacts are exact and soft ones converge, and the others."""
    lines = []
    for name, good in (("rigid", "within what is wanted"), ("soft", "of order 0.9 or within what is wanted")):
        curves = [(s.case.name, c) for s in studies for c in s.curves if c.method.name == name]
        short = [(case, c) for case, c in curves if c.verdict in (Verdict.SHORT, Verdict.FAILED)]
        lines.append(f"{name} contacts: {len(curves) - len(short)} of {len(curves)} cases are {good}")
        for case, curve in short:
            largest = cell(curve.largest, ".1e")
            lines.append(f"  {case}: largest error {largest}, order {order_text(curve)} ({curve.verdict})")
    return "\n".join(lines)


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
    """Return how far the scene as it is configured is from its variants."""
    found = study.estimate
    if found.error is None:
        return [f"  no estimate: {found.failure or 'no variant of the scene could be run'}"]
    head = ("variant", "place [m]", "angle [rad]", "velocity [m/s]", "spin [rad/s]", "")
    rows = [("largest: the error", *_spread_cells(found.error), "")]
    rows += [
        (variant.name, *_spread_cells(variant.spread), variant.failure or variant.what)
        for variant in found.variants
    ]
    order = "none" if found.order is None else f"{found.order:.1f}"
    return [
        f"  as it is configured, and how far its variants end from it after {study.seconds:g} s, of any body",
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


def _spread_cells(spread: Departure | None) -> tuple[str, str, str, str]:
    if spread is None:
        return ("-", "-", "-", "-")
    return f"{spread.position:.1e}", f"{spread.angle:.1e}", f"{spread.velocity:.1e}", f"{spread.spin:.1e}"


def _scene_cells(row: SceneRow) -> tuple[str, ...]:
    return (
        row.asked, row.integrator, row.step, str(row.evaluations), cell(row.cpu_ms, ".3g"),
        cell(row.half_step, ".1e"), f"{'at most ' if row.at_most else ''}{cell(row.error, '.1e')}",
        cell(row.energy, ".1e"), row.failure,
    )  # fmt: skip


def summary_text(studies: Sequence[Study]) -> str:
    """Return the number of problems on which ``auto``, and any method, is excellent; and the others."""
    short = [study for study in studies if study.auto.verdict is not Verdict.EXCELLENT]
    some = [study for study in studies if any(row.verdict is Verdict.EXCELLENT for row in study.rows)]
    lines = [
        f"auto is excellent on {len(studies) - len(short)} of {len(studies)} problems, "
        f"some method on {len(some)}"
    ]
    for study in short:
        best = f"the best error of any method is {study.best:.1e}" if study in some else "no method is"
        lines.append(
            f"  {study.problem.name}: auto has {cell(study.auto.error, '.1e')} ({study.auto.verdict}), "
            f"excellent would be {study.problem.excellent:.1e}; {best}"
        )
    touching = [study for study in studies if study.problem.touches]
    if touching and all(study.auto.integrator != "exact" for study in touching):
        lines.append("where bodies touch, contacts are found within steps: no impact is located in time")
    return "\n".join(lines)


def left_out_text() -> str:
    """Return which reference problems are not there, and why."""
    return "\n".join(["not computed:", *(f"  {name}: {reason}" for name, reason in LEFT_OUT.items())])


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
        f"{'met' if found.holds else 'NOT MET'} (95 %, and at most 100)"
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
        f"{'met' if share.holds else 'NOT MET'}; more than 100 times too large "
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


def document(
    studies: Sequence[Study], scenes: Sequence[SceneStudy] = (), contacts: Sequence[ContactStudy] = ()
) -> dict[str, Any]:
    """Return everything that was measured."""
    return lab_document(
        "accuracy",
        peers=any(curve.rows and not curve.method.own for study in contacts for curve in study.curves),
        problems=[_study(study) for study in studies],
        contacts=[_contacts(study) for study in contacts],
        scenes=[_scene(study) for study in scenes],
        left_out=[{"name": name, "reason": reason} for name, reason in LEFT_OUT.items()],
    )


def trust_document(
    rows: Sequence[TrustRow], scenes: Mapping[str, Trust], random: Sequence[HonestRow] = ()
) -> dict[str, Any]:
    """Return estimates of errors beside true errors, and what can be relied on in scenes by their names."""
    found, share = summarise(rows), share_of(random)
    problems = [
        pick(row.case, "name", "measure") | pick(row, "method", "estimate", "error", "ratio", "near")
        for row in rows
    ]
    return lab_document(
        "trust",
        problems=problems,
        summary=pick(found, "known", "near", "largest", "holds"),
        random=[{**plain(row), "ratios": dict(zip(QUANTITIES, row.ratios, strict=False))} for row in random],
        honest=pick(share, "known", "honest", "too_large", "worst", "holds")
        | {"honest": dict(zip(QUANTITIES, share.honest, strict=True))},
        scenes=[{"name": name, **trust_report(trust)} for name, trust in scenes.items()],
    )


def _study(study: Study) -> dict[str, Any]:
    problem = study.problem
    against = "the energy at the start" if "energy" in problem.keeps else None
    return {
        **pick(problem, "name", "title", "group"), "source": problem.family,
        "reference": record(problem.family)["method"],
        **pick(problem, "compared", "measure", "seconds", "good", "excellent"),
        "rounding_floor": study.floor,
        "energy_against": "the exact energy at that time" if problem.exact_energy else against,
        "note": problem.note, **pick(study, "best", "auto", "rigid"),
        "integrators": [_curve(curve) for curve in study.curves],
    }  # fmt: skip


def _curve(curve: MethodCurve) -> dict[str, Any]:
    measured = {"order_measured": curve.order, "order_short": curve.short}
    return pick(curve.method, "name", "title", "order") | measured | pick(curve, "refused", "rows")


def _contacts(study: ContactStudy) -> dict[str, Any]:
    case = study.case
    engines = [
        pick(curve.method, "name", "title")
        | {"order_measured": curve.order}
        | pick(curve, "verdict", "refused", "rows")
        for curve in study.curves
    ]
    names = pick(case, "name", "title", "group", "compared", "measure")
    return names | {"reference": case.source} | pick(case, "seconds", "wanted") | {"engines": engines}


def _scene(study: SceneStudy) -> dict[str, Any]:
    estimate = pick(study.estimate, "error", "worst", "order", "order_reason", "variants", "failure")
    return {
        "scene": study.name, "seconds": study.seconds, "kind": ESTIMATE, "reference": study.reference,
        "estimate": estimate, "rows": study.rows, "horizon_s": study.horizon_s,
    }  # fmt: skip
