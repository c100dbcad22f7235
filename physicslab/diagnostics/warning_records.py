"""A warning about a world, and the worst warning of each kind over a run."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from physicslab.world import World


@dataclass(frozen=True, slots=True)
class ModelWarning:
    """One thing in which a simulated world cannot be trusted. ``run --json`` has them as ``advice``.

    Attributes
    ----------
    entity : str, optional
        The body or spring, by its id; ``None`` where it concerns all of the world.
    what : str
        What is wrong, in words that hold for any value: they name the kind of warning.
    value, limit : float, optional
        The figure, and the largest that can be trusted.
    unit : str
        Of both; empty for a plain number.
    setting : str
        A setting that helps, with its value; empty where none does.
    number : int, optional
        The entity itself.
    because : str
        The latest cause, which may be another at each step; it is no part of the kind.
    """

    entity: str | None
    what: str
    value: float | None
    unit: str
    limit: float | None
    setting: str
    number: int | None = None
    because: str = ""

    @classmethod
    def about(
        cls, world: World, entity: int | None, what: str, value: float | None, unit: str,
        limit: float | None, setting: str,
    ) -> ModelWarning:  # fmt: skip
        """Return a warning about an entity of a world; about all of it where that is ``None``."""
        name = None if entity is None else world.label(entity)
        return cls(name, what, value, unit, limit, setting, entity)

    @property
    def excess(self) -> tuple[float, float]:
        """The value in units of the limit, infinite without one; two such are compared by their values."""
        value = 0.0 if self.value is None else self.value
        return value / self.limit if self.limit and self.value is not None else math.inf, value

    @property
    def told(self) -> str:
        """A warning: the entity, the fault and its size."""
        words = f"{self.entity}: {self.what}" if self.entity else self.what
        if self.value is not None and self.limit is not None:
            unit = f" {self.unit}" if self.unit else ""
            words += f": {self.value:.3g}{unit}" + (f", well up to {self.limit:.3g}" if self.limit else "")
        return words

    def __str__(self) -> str:
        words = f"{self.told}, as {self.because}" if self.because else self.told
        return (
            f"{words}; {self.setting} would help" if self.setting else f"{words}; no setting is known to help"
        )


class WorstWarnings:
    """The worst warning of each kind over a run."""

    def __init__(self) -> None:
        self._worst: dict[str, ModelWarning] = {}

    def add(self, found: Iterable[ModelWarning]) -> None:
        """Add the warnings of one moment; of each kind the worst is kept."""
        for warning in found:
            known = self._worst.get(warning.what)
            if known is None or warning.excess > known.excess:
                self._worst[warning.what] = warning

    @property
    def all(self) -> tuple[ModelWarning, ...]:
        """One of each kind, in the order in which they first came."""
        return tuple(self._worst.values())
