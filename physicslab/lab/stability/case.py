"""Cases of the stability lab, and their outcomes."""

import time
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from functools import partial

from physicslab.lab.case import Case, Verdict, attempt
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
        What the right behaviour is.
    figure, unit : str
        What is measured, and in which SI unit; no unit for a share or a number of things.
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


def part_of[*Given](number: int, run: Callable[[*Given], Sequence[float]], *given: *Given) -> float:
    """Return one of the figures of a run, at which several cases look.

    >>> part_of(1, divmod, 17.0, 5.0)
    2.0
    """
    return run(*given)[number]
