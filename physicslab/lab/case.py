"""Shared parts of the labs: cases in a catalogue, and their measurements."""

import math
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from physicslab.state.masses import Diverged


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """Something that a lab measures.

    Attributes
    ----------
    name, title, group : str
        For the command line, for people, and which cases it belongs with.
    """

    name: str
    title: str
    group: str

    @property
    def family(self) -> str:
        """The name for it and others together on the command line."""
        return self.group


class Verdict(StrEnum):
    """How good a figure is: whether it is within a limit, or how near an error is to what can be."""

    PASSED = "passed"
    EXCELLENT = "excellent"
    GOOD = "good"
    SHORT = "falls short"
    ROUNDING = "rounding floor"
    CHAOS = "chaos limit"
    FAILED = "failed"


class Catalogue[AnyCase: Case](dict[str, AnyCase]):
    """The cases of a lab by name, in order.

    Examples
    --------
    >>> cases = Catalogue([Case(name=name, title="", group="stacks") for name in ("low", "high")])
    >>> cases.families, cases.names
    (['stacks'], ['stacks', 'low', 'high'])
    >>> [case.name for case in cases.select("stacks")], cases.select("none")
    (['low', 'high'], [])
    """

    def __init__(self, cases: Iterable[AnyCase]) -> None:
        super().__init__((case.name, case) for case in cases)

    @property
    def families(self) -> list[str]:
        """The names of families, in order."""
        return list(dict.fromkeys(case.family for case in self.values()))

    @property
    def names(self) -> list[str]:
        """Every name that :meth:`select` takes: families, then cases."""
        return list(dict.fromkeys((*self.families, *self)))

    def select(self, name: str) -> list[AnyCase]:
        """Return the cases of the family of that name, or else the case of that name; nothing if neither."""
        family = [case for case in self.values() if case.family == name]
        return family or ([self[name]] if name in self else [])


def attempt[Found](measure: Callable[[], Found]) -> tuple[Found | None, str]:
    """Return what a measurement found; or ``None``, and the reason why there is nothing finite to return.

    A run that diverged and a number that cannot be computed are reasons, and no errors.

    >>> attempt(lambda: 1.0 / 4.0)
    (0.25, '')
    >>> attempt(lambda: 1.0 / 0.0)
    (None, 'float division by zero')
    """
    try:
        with np.errstate(all="ignore"):  # an overflow is not finite, and is reported as that
            found = measure()
    except (Diverged, ArithmeticError) as error:
        return None, str(error)
    if isinstance(found, float) and not math.isfinite(found):
        return None, "the figure is not finite"
    return found, ""


def cpu_time[Found](call: Callable[[], Found]) -> tuple[float, Found]:
    """Return the CPU time of a call [s], of all threads of the process, and what the call returned."""
    start = time.process_time()
    found = call()
    return time.process_time() - start, found
