"""What a case of the stability lab is, and what came of one."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from physicslab.state.masses import Diverged

__all__ = ["Case", "Outcome", "Verdict", "run_case"]


class Verdict(StrEnum):
    """What is said of a case."""

    PASSED = "passed"
    SHORT = "falls short"


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """Something that engines come to grief on, and how far this one may be off.

    Attributes
    ----------
    name, title, group : str
        For the command line, for people, and which row of the table it belongs to.
    right : str
        What the right behaviour is.
    figure, unit : str
        What is measured, and in which SI unit; no unit for a share or a number of things.
    limit : float
        The largest figure that passes.
    measure : callable
        Runs the engine and returns the figure.
    long : bool
        Whether it takes so long that the tests leave it to the command.
    """

    name: str
    title: str
    group: str
    right: str
    figure: str
    limit: float
    measure: Callable[[], float]
    unit: str = ""
    long: bool = False


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of a case.

    Attributes
    ----------
    case : Case
        Which.
    figure : float, optional
        What was measured; ``None`` where the run stopped before its end, or came to no finite number.
    failure : str
        Why there is no figure.
    wall_s : float
        How long it took [s].
    """

    case: Case
    figure: float | None
    failure: str
    wall_s: float

    @property
    def verdict(self) -> Verdict:
        """Whether the figure is within the limit."""
        passed = self.figure is not None and self.figure <= self.case.limit
        return Verdict.PASSED if passed else Verdict.SHORT


def run_case(case: Case) -> Outcome:
    """Run a case, and return what came of it, be it that it diverged."""
    start = time.perf_counter()
    figure, failure = None, ""
    with np.errstate(all="ignore"):  # what overflows is no longer finite, and told as that
        try:
            found = case.measure()
        except Diverged as error:
            failure = str(error)
        else:
            figure = found if math.isfinite(found) else None
            failure = "" if math.isfinite(found) else "the figure is not finite"
    return Outcome(case, figure, failure, time.perf_counter() - start)
