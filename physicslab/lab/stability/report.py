"""The results of the stability lab: lines for the terminal, and a document."""

from collections.abc import Collection, Sequence
from typing import Any

from physicslab.lab.case import Verdict
from physicslab.lab.document import lab_document
from physicslab.lab.stability.case import Outcome, StabilityCase
from physicslab.lab.table import Columns, cell


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


def short_names(outcomes: Sequence[Outcome]) -> list[str]:
    """Return the names of the cases that fall short."""
    return [outcome.case.name for outcome in outcomes if outcome.verdict is Verdict.SHORT]


def summary_text(outcomes: Sequence[Outcome]) -> str:
    """Return how many cases passed, and how long all took."""
    passed = len(outcomes) - len(short_names(outcomes))
    took = sum(outcome.wall_s for outcome in outcomes)
    return f"{passed} of {len(outcomes)} cases passed, in {took:.0f} s"


def document(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """Return every figure, its limit and the verdict."""
    short, cases = short_names(outcomes), [_case(outcome) for outcome in outcomes]
    return lab_document("stability", passed=len(outcomes) - len(short), falls_short=short, cases=cases)


def _case(outcome: Outcome) -> dict[str, Any]:
    case = outcome.case
    return {
        "name": case.name, "title": case.title, "group": case.group, "right": case.right,
        "measured": case.figure, "unit": case.unit, "figure": outcome.figure, "limit": case.limit,
        "verdict": outcome.verdict, "failure": outcome.failure, "wall_s": outcome.wall_s,
    }  # fmt: skip
