"""Cases of the stability lab, and their outcomes."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

from physicslab.lab.case import Case, attempt

__all__ = ["Outcome", "StabilityCase", "Verdict", "run_case"]


class Verdict(StrEnum):
    """Whether a figure is within its limit."""

    PASSED = "passed"
    SHORT = "falls short"


@dataclass(frozen=True, slots=True, kw_only=True)
class StabilityCase(Case):
    """A scene on which engines are known to fail, and how large a figure passes.

    Attributes
    ----------
    right : str
        What the right behaviour is.
    figure, unit : str
        What is measured, and in which SI unit; no unit for a share or a number of things.
    limit : float
        The largest figure that passes.
    measure : callable
        Builds a world, runs it and returns the figure.
    long_s : float
        About how long it takes [s], where only the command runs it, and no test; else 0.
    run : str
        The run that it shares with other cases, which look at it from another side; none if empty.
    """

    right: str
    figure: str
    limit: float
    measure: Callable[[], float]
    unit: str = ""
    long_s: float = 0.0
    run: str = ""


@dataclass(frozen=True, slots=True)
class Outcome:
    """The result of a case.

    Attributes
    ----------
    case : StabilityCase
        Which.
    figure : float, optional
        What was measured; ``None`` where the run stopped before its end, or the number is not finite.
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
