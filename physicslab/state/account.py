"""What changed the energy and the momentum of a world, by cause: kept where it happens."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from physicslab.kernels.accounts import CAUSES, EDITS, HAND

__all__ = ["Account", "Balance", "KeptAccount"]


class Balance(NamedTuple):
    """Energy [J], momentum [kg m/s] and angular momentum about the origin [kg m^2/s] at a moment."""

    energy: float
    px: float
    py: float
    spin: float


_NOTHING = Balance(0.0, 0.0, 0.0, 0.0)


class KeptAccount(NamedTuple):
    """An account at one moment, to go back to."""

    sums: NDArray[np.float64]
    since: float
    start: Balance | None
    last: Balance
    held: tuple[int, ...]


class Account:
    """Sums by cause since the first step, or since :meth:`restart`.

    Whatever is not booked here and has changed the energy all the same is the error of the numerical method
    (:func:`physicslab.diagnostics.account.measure_account`).

    Attributes
    ----------
    sums : float64 array (CAUSES, 4)
        What each cause has given (:mod:`physicslab.kernels.accounts`); kernels add to it.
    since : float
        The world's clock when it began [s].
    start : Balance, optional
        What there was then; ``None`` before the first step.
    last : Balance
        What there was after the last step.
    held : tuple of int
        The entities that a hand held then.
    columns : tuple, optional
        The arrays that a balance is measured from, and the revision of the rows that they belong to.
    seen : object, optional
        What the last balance depends on, in short: while that is the same, so is the balance.
    """

    def __init__(self) -> None:
        self.sums: NDArray[np.float64] = np.zeros((CAUSES, 4))
        self.since = 0.0
        self.held: tuple[int, ...] = ()
        self.columns: tuple[int, tuple[Any, ...], tuple[Any, ...]] | None = None
        self.seen: object | None = None
        self.start: Balance | None = None
        self.last = _NOTHING

    def restart(self) -> None:
        """Begin again with the next step."""
        self.sums[:] = 0.0
        self.start = None

    def pending(self, now: Balance, held: tuple[int, ...]) -> tuple[int, Balance]:
        """Return what has changed since the last step, between steps, and by which cause.

        ``held`` tells which bodies are held: where these are others than before, it was a hand.
        """
        change = Balance(*(new - old for new, old in zip(now, self.last, strict=True)))
        return HAND if held != self.held else EDITS, change

    def open(self, now: Balance, held: tuple[int, ...], time: float) -> None:
        """Begin a step at a balance; what has changed since the last one is booked."""
        if self.start is None or not math.isfinite(self.last.energy):
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
        return KeptAccount(self.sums.copy(), self.since, self.start, self.last, self.held)

    def bring_back(self, kept: KeptAccount) -> None:
        """Go back."""
        np.copyto(self.sums, kept.sums)
        _, self.since, self.start, self.last, self.held = kept
        self.seen = None
