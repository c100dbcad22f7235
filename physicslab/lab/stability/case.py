"""Cases of the stability lab, their outcomes, and these as a table and as a document."""

import time
from collections.abc import Callable, Collection, Hashable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from physicslab.lab.case import Case, Verdict, attempt
from physicslab.lab.report import Columns, cell, lab_document
from physicslab.lab.worlds import open_space

MODELS = {"soft": "soft contacts", "rigid": "rigid contacts"}
"""Names of both models of contacts, by the word in a scene's ``simulation``."""
touching_space = partial(open_space, collisions="step")
"""Returns an empty world for a model of contacts, to which impacts belong as well."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StabilityCase(Case):
    """A scene on which engines are known to fail, and how large a figure passes.

    Attributes
    ----------
    right : str
        The right behaviour, in words.
    figure, unit : str
        The figure measured, and its SI unit; no unit for a share or a number of things.
    limit : float
        The largest figure that passes.
    measure : callable
        Builds a world, runs it and returns the figure.
    long_s : float
        About how long it takes [s], where only the command runs it, and no test; else 0.
    """

    right: str
    figure: str
    limit: float
    measure: Callable[[], float]
    unit: str = ""
    long_s: float = 0.0

    @property
    def run(self) -> Hashable:
        """The shared fields of cases with several figures of one run."""
        measure = self.measure
        return measure.args[1:] if isinstance(measure, partial) and measure.func is part_of else self.name


@dataclass(frozen=True, slots=True)
class Outcome:
    """The result of a case.

    Attributes
    ----------
    case : StabilityCase
        Which.
    figure : float, optional
        The value measured; ``None`` where the run stopped before its end, or the number is not finite.
    failure : str
        Why there is no figure.
    wall_s : float
        How long it took [s].
    """

    case: StabilityCase
    figure: float | None
    failure: str
    wall_s: float

    @property
    def verdict(self) -> Verdict:
        """Whether the figure is within the limit."""
        passed = self.figure is not None and self.figure <= self.case.limit
        return Verdict.PASSED if passed else Verdict.SHORT


def run_case(case: StabilityCase) -> Outcome:
    """Run a case and return its outcome; that of a run that diverged is no exception."""
    start = time.perf_counter()
    figure, failure = attempt(case.measure)
    return Outcome(case, figure, failure, time.perf_counter() - start)


def part_of[*Given](number: int, run: Callable[[*Given], Sequence[float]], *given: *Given) -> float:
    """Return one of the figures of a run, at which several cases look.

    >>> part_of(1, divmod, 17.0, 5.0)
    2.0
    """
    return run(*given)[number]


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
