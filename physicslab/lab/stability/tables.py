"""What the stability lab found, as lines for the terminal."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from physicslab.lab.stability.case import Outcome, StabilityCase, Verdict
from physicslab.lab.table import Columns, cell

__all__ = ["columns", "head_text", "row_text", "summary_text"]


def columns(cases: Collection[StabilityCase]) -> Columns:
    """Return the columns in which the rows of these cases are aligned, before any has been run."""
    width = max((len(case.name) for case in cases), default=4)
    return Columns((width, 9, 10, 11, 0), words=(0, 3, 4))


def head_text(aligned: Columns) -> str:
    """Return the line above the rows."""
    return aligned.line(("case", "figure", "limit", "verdict", "what is measured"))


def row_text(outcome: Outcome, aligned: Columns) -> str:
    """Return a case's line."""
    case = outcome.case
    limit = f"{case.limit:.4g} {case.unit}".rstrip()
    what = f"{case.title}: {outcome.failure or case.figure}"
    return aligned.line((case.name, cell(outcome.figure, ".3g"), limit, outcome.verdict, what))


def summary_text(outcomes: Sequence[Outcome]) -> str:
    """Return how many cases passed, and how long all took."""
    passed = sum(outcome.verdict is Verdict.PASSED for outcome in outcomes)
    took = sum(outcome.wall_s for outcome in outcomes)
    return f"{passed} of {len(outcomes)} cases passed, in {took:.0f} s"
