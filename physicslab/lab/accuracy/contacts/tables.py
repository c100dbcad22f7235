"""What was found of contact cases, as tables for the terminal."""

from __future__ import annotations

from collections.abc import Sequence

from physicslab.lab.accuracy.contacts.study import ROUNDING, ContactCurve, ContactRow, ContactStudy
from physicslab.lab.accuracy.verdict import Verdict
from physicslab.lab.table import cell, table

__all__ = ["contact_summary", "contact_text", "order_text"]


_STAR = "  * some steps were left to soft contacts, or made by impulses in short steps: an error of order one"


def contact_text(study: ContactStudy) -> str:
    """Return a case's table: a line for each engine, a column for each step."""
    case = study.case
    rows = max((curve.rows for curve in study.curves), key=len)
    starred = any(row.left_to_soft or row.by_impulses for curve in study.curves for row in curve.rows)
    head = ("engine", "order", *(f"1/{1.0 / row.dt:.0f} s" for row in rows), "ms / s", "to", "")
    refused = [f"  not {curve.engine.title}: {curve.refused}" for curve in study.curves if curve.refused]
    lines = [_cells(curve, len(rows)) for curve in study.curves if not curve.refused]
    return "\n".join([
        f"{case.name}: {case.title}",
        f"  compared: {case.compared}",
        f"  error: {case.measure}; with rigid contacts {case.wanted:.0e} is wanted",
        table([head, *lines], words=(0, len(head) - 1), indent="  "),
        *refused,
        *([_STAR] if starred else []),
        "",
    ])  # fmt: skip


def order_text(curve: ContactCurve) -> str:
    """Return the order of a curve, or why it has none."""
    if curve.order is not None:
        return f"{curve.order:.1f}".replace("-0.0", "0.0")
    return "rounding" if curve.largest is not None and curve.largest <= ROUNDING else "-"


def contact_summary(studies: Sequence[ContactStudy]) -> str:
    """Return on how many cases rigid contacts are exact and soft ones converge, and the others."""
    lines = []
    for name, good in (("rigid", "within what is wanted"), ("soft", "of order 0.9 or within what is wanted")):
        curves = [(s.case.name, c) for s in studies for c in s.curves if c.engine.name == name]
        short = [(case, c) for case, c in curves if c.verdict in (Verdict.SHORT, Verdict.FAILED)]
        lines.append(f"{name} contacts: {len(curves) - len(short)} of {len(curves)} cases are {good}")
        for case, curve in short:
            largest = cell(curve.largest, ".1e")
            lines.append(f"  {case}: largest error {largest}, order {order_text(curve)} ({curve.verdict})")
    return "\n".join(lines)


def _cells(curve: ContactCurve, count: int) -> tuple[str, ...]:
    errors = [_error(row) for row in curve.rows]
    costs = [f"{1e3 * row.cpu_s_per_s:.2g}" for row in (curve.rows[0], curve.rows[-1])]
    missing = [""] * (count - len(errors))
    return (curve.engine.title, order_text(curve), *errors, *missing, *costs, str(curve.verdict or ""))


def _error(row: ContactRow) -> str:
    """Return an error, with a star where steps were left to soft contacts or made by impulses."""
    return cell(row.error, ".1e") + ("*" if row.left_to_soft or row.by_impulses else "")
