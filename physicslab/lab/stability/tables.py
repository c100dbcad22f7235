"""What the stability lab found, as lines for people."""

from __future__ import annotations

from collections.abc import Sequence

from physicslab.lab.stability.case import Case, Outcome, Verdict

__all__ = ["head_text", "row_text", "summary_text"]


def head_text(cases: Sequence[Case]) -> str:
    """Return the line above the rows of these cases."""
    return _line(cases, "case", "figure", "limit", "verdict", "what is measured")


def row_text(outcome: Outcome, cases: Sequence[Case]) -> str:
    """Return a case's line, aligned with those of all ``cases``."""
    case = outcome.case
    figure = "-" if outcome.figure is None else f"{outcome.figure:.3g}"
    limit = f"{case.limit:.4g} {case.unit}".rstrip()
    what = f"{case.title}: {outcome.failure or case.figure}"
    return _line(cases, case.name, figure, limit, str(outcome.verdict), what)


def _line(cases: Sequence[Case], name: str, figure: str, limit: str, verdict: str, what: str) -> str:
    width = max((len(case.name) for case in cases), default=4)
    return f"{name:<{width}}  {figure:>9}  {limit:>10}  {verdict:<11}  {what}"


def summary_text(outcomes: Sequence[Outcome]) -> str:
    """Return how many cases passed, and how long all took."""
    passed = sum(outcome.verdict is Verdict.PASSED for outcome in outcomes)
    took = sum(outcome.wall_s for outcome in outcomes)
    return f"{passed} of {len(outcomes)} cases passed, in {took:.0f} s"
