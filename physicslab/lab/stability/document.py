"""What the stability lab found, as a document."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from physicslab.lab.document import lab_document
from physicslab.lab.stability.case import Outcome, Verdict

__all__ = ["document"]


def document(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """Return every figure, its limit and the verdict."""
    short = [outcome.case.name for outcome in outcomes if outcome.verdict is Verdict.SHORT]
    cases = [_case(outcome) for outcome in outcomes]
    return lab_document("stability", passed=len(outcomes) - len(short), falls_short=short, cases=cases)


def _case(outcome: Outcome) -> dict[str, Any]:
    case = outcome.case
    return {
        "name": case.name,
        "title": case.title,
        "group": case.group,
        "right": case.right,
        "measured": case.figure,
        "unit": case.unit,
        "figure": outcome.figure,
        "limit": case.limit,
        "verdict": str(outcome.verdict),
        "failure": outcome.failure,
        "wall_s": outcome.wall_s,
    }
