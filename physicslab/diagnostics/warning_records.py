"""One thing that is not to be trusted, and the worst of each kind over a run."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

__all__ = ["Advice", "WorstAdvice"]


@dataclass(frozen=True, slots=True)
class Advice:
    """One thing that is not to be trusted.

    Attributes
    ----------
    entity : str, optional
        Whose motion, by its id; ``None`` where it concerns all of the world.
    what : str
        What is wrong, in words that hang on no number.
    value, limit : float, optional
        How much of it there is, and how much would be well.
    unit : str
        Of both; empty for a plain number.
    setting : str
        What to set, and to which value; empty where no setting helps.
    """

    entity: str | None
    what: str
    value: float | None
    unit: str
    limit: float | None
    setting: str

    @property
    def excess(self) -> float:
        """How far beyond the limit it is, as a factor."""
        return math.inf if self.value is None or not self.limit else self.value / self.limit

    def __str__(self) -> str:
        words = f"{self.entity}: {self.what}" if self.entity else self.what
        if self.value is not None and self.limit is not None:
            unit = f" {self.unit}" if self.unit else ""
            words += f": {self.value:.3g}{unit}, well up to {self.limit:.3g}"
        return f"{words}; {self.setting} would help" if self.setting else words


class WorstAdvice:
    """The worst of every kind of advice over a run."""

    def __init__(self) -> None:
        self._worst: dict[str, Advice] = {}

    def note(self, advices: Iterable[Advice]) -> None:
        """Take note of what was found at one moment."""
        for advice in advices:
            known = self._worst.get(advice.what)
            if known is None or advice.excess > known.excess:
                self._worst[advice.what] = advice

    @property
    def all(self) -> tuple[Advice, ...]:
        """One of each kind, in the order in which they were first met."""
        return tuple(self._worst.values())
