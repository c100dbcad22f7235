"""Changes of the energy and the momentum of a world, by cause: kept where they happen."""

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from physicslab.ecs.vector import Vector2
from physicslab.kernels.accounts import BALANCE, BEFORE, BOOK, CAUSES, EDITS, HAND


class Balance(NamedTuple):
    """Energy [J], momentum [kg m/s] and angular momentum about the origin [kg m^2/s] at a moment."""

    energy: float
    px: float
    py: float
    spin: float


@dataclass(frozen=True, slots=True)
class Energy:
    """The energy of a world [J]; bodies that are static, kinematic or held do not count.

    Attributes
    ----------
    kinetic_linear, kinetic_angular : float
        Kinetic energy of translation and of rotation [J].
    potential : dict of str to float
        Energy stored by each running force, by its name ("gravity", "spring", ...).
    """

    kinetic_linear: float
    kinetic_angular: float
    potential: dict[str, float]

    @property
    def kinetic(self) -> float:
        """Kinetic energy [J]."""
        return self.kinetic_linear + self.kinetic_angular

    @property
    def stored(self) -> float:
        """Potential energy [J]; it may be negative, and where it is zero depends on the force."""
        return sum(self.potential.values())

    @property
    def total(self) -> float:
        """Kinetic and potential energy [J], added up in the order in which balances do (to the bit)."""
        total = self.kinetic
        for stored in self.potential.values():  # sum() would carry what rounding loses
            total += stored
        return total


@dataclass(frozen=True, slots=True)
class Momentum:
    """The momentum [kg m/s] of a world and its angular momentum about the origin [kg m^2/s]."""

    linear: Vector2
    angular: float


class KeptAccount(NamedTuple):
    """An account at one moment, to go back to."""

    book: NDArray[np.float64]
    since: float
    start: Balance | None
    held: tuple[int, ...]


class Account:
    """Sums by cause since the first step, or since :meth:`restart`.

    Whatever is not booked here and has changed the energy all the same is the error of the numerical method
    (:func:`physicslab.diagnostics.energy.measure_account`).

    Attributes
    ----------
    table : float64 array (BOOK, 4)
        Contribution of each cause (:mod:`physicslab.kernels.accounts`), which kernels add to; what there was
        after the last step; and all of it as it was before the step at hand.
    sums : float64 array (CAUSES, 4)
        The first of these.
    is_open : bool
        Whether the balance is to be measured at the end of the step at hand.
    since : float
        The world's clock when it began [s].
    start : Balance, optional
        The balance then; ``None`` before the first step.
    held : tuple of int
        The entities that a hand held then.
    columns : tuple, optional
        The arrays that a balance is measured from, and the revision of the rows that they belong to.
    seen : object, optional
        Digest of all that the last balance depends on: while it is the same, so is the balance.
    """

    def __init__(self) -> None:
        self.table: NDArray[np.float64] = np.zeros((BOOK, 4))
        self.sums, self._now = self.table[:CAUSES], self.table[:BEFORE]
        # Numpy takes three times as long to copy so few numbers, or to return one.
        numbers = memoryview(self.table.reshape(-1))
        self._last = numbers[4 * BALANCE : 4 * BALANCE + 4]
        self._kept, self._before = numbers[: 4 * BEFORE], numbers[4 * BEFORE :]
        self.is_open = False
        self.since = 0.0
        self.held: tuple[int, ...] = ()
        self.columns: tuple[int, tuple[Any, ...], tuple[Any, ...]] | None = None
        self.seen: object | None = None
        self.start: Balance | None = None
        self._begun: tuple[float, Balance | None, tuple[int, ...]] = self.since, self.start, self.held

    @property
    def last(self) -> Balance:
        """The balance after the last step."""
        return Balance(*self._last.tolist())

    @last.setter
    def last(self, balance: Balance) -> None:
        self.table[BALANCE] = balance

    @property
    def is_known(self) -> bool:
        """Whether a step was made, after which the energy was finite."""
        return self.start is not None and math.isfinite(self._last[0])

    def pending(self, now: Balance, held: tuple[int, ...]) -> tuple[int, Balance]:
        """Return what has changed since the last step, between steps, and by which cause.

        ``held`` tells which bodies are held: where these are others than before, it was a hand.
        """
        change = Balance(*(new - old for new, old in zip(now, self.last, strict=True)))
        return self.cause_of_edits(held), change

    def cause_of_edits(self, held: tuple[int, ...]) -> int:
        """Return by which cause something has changed between steps."""
        return HAND if held != self.held else EDITS

    def begin_step(self) -> None:
        """Keep what there is, for :meth:`go_back`."""
        self._before[:] = self._kept
        self._begun, self.is_open = (self.since, self.start, self.held), False

    def go_back(self) -> None:
        """Return to what there was before a step that has failed."""
        self._kept[:] = self._before
        self.since, self.start, self.held = self._begun
        self.seen = None

    def open(self, now: Balance, held: tuple[int, ...], time: float) -> None:
        """Begin a step at a balance; what has changed since the last one is booked."""
        if not self.is_known:
            self.sums[:] = 0.0  # of what has passed through infinity no sum is left
            self.start, self.since, self.held, self.last = now, time, held, now
        else:
            self.book(now, held)

    def book(self, now: Balance, held: tuple[int, ...]) -> None:
        """Book what has changed since the last step, or the last booking, once a step was made."""
        if self.start is not None and now != self.last:
            cause, change = self.pending(now, held)
            self.sums[cause] += change
            self.last = now
        self.held = held

    def keep(self) -> KeptAccount:
        """Return what there is, to go back to."""
        return KeptAccount(self._now.copy(), self.since, self.start, self.held)

    def restore(self, kept: KeptAccount) -> None:
        """Go back."""
        np.copyto(self._now, kept.book)
        _, self.since, self.start, self.held = kept
        self.seen = None
