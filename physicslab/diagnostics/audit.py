"""How the energy of a world changes while it is sampled, and how much of that is an error."""

import math

import numpy as np

from physicslab.diagnostics.account import Accounts, measure_account
from physicslab.diagnostics.energy import Energy
from physicslab.world import World

_LEAST_OF_EXCHANGED = 1e-12
"""Share of the energy exchanged below which an account is rounding."""
_LEAST_OF_ENERGY = 1e-15
"""Share of the largest energy below which it is so, where hardly any is exchanged."""
_OUTSIDE = ("edits", "hand", "numerical")
"""The accounts whose size is no measure of what is exchanged: a body that comes, goes or is taken into a hand
brings or takes all of its potential energy, which depends on where that is zero."""


class Audit:
    """The accounts of a world from now on, sampled, with the largest change and the largest error seen.

    Shares are of the energy that is exchanged: the largest kinetic energy seen, the range of the potential
    energy apart from what edits and a hand brought, or the largest account of another cause; whichever is
    largest. None of these depends on where a potential is zero.

    Parameters
    ----------
    world : World
        What is sampled.
    whole : bool
        Whether it reaches back to where the world's own accounts began, and not just to now.

    Attributes
    ----------
    account : Accounts
        What changed energy and momenta from the beginning to the last :meth:`sample`.
    initial : float
        The energy at the beginning [J].
    latest : Energy
        The energy at the last sample.
    largest_change, largest_error : float
        The largest size, so far, of E - E0 and of ``numerical`` [J]; NaN once either was no number.
    """

    def __init__(self, world: World, *, whole: bool = False) -> None:
        found = measure_account(world)
        self._begin = None if whole else found
        self._moved: dict[str, None] = {}
        self.largest_change = self.largest_error = self.exchanged = 0.0
        self._low, self._high = math.inf, -math.inf
        self._take(found)
        self.initial = self.account.start.energy

    def sample(self, world: World) -> None:
        """Read the accounts as they are now."""
        self._take(measure_account(world))

    @np.errstate(all="ignore")
    def _take(self, found: Accounts) -> None:
        self.account = account = found if self._begin is None else found.after(self._begin)
        self.latest: Energy = account.parts
        booked = account.energy
        inside = self.latest.stored - booked["edits"] - booked["hand"]
        self._low, self._high = min(self._low, inside), max(self._high, inside)
        sizes = (abs(value) for name, value in booked.items() if name not in _OUTSIDE)
        self.exchanged = max(self.exchanged, self.latest.kinetic, self._high - self._low, *sizes)
        # numpy's maximum, unlike max, keeps NaN.
        self.largest_change = float(np.maximum(self.largest_change, abs(account.change)))
        self.largest_error = float(np.maximum(self.largest_error, abs(booked["numerical"])))
        self._moved |= dict.fromkeys(self.notable)

    @property
    def notable(self) -> dict[str, float]:
        """The accounts of energy at the last sample [J] that are more than rounding, without the error."""
        ends = self.account.start.energy, self.account.now.energy
        least = max(_LEAST_OF_EXCHANGED * self.exchanged, _LEAST_OF_ENERGY * max(map(abs, ends)))
        booked = self.account.energy.items()
        return {name: value for name, value in booked if name != "numerical" and not abs(value) <= least}

    @property
    def causes(self) -> tuple[str, ...]:
        """The accounts that changed the energy at any sample, by name; such a change is no error."""
        return tuple(self._moved)

    @property
    def error(self) -> float:
        """The largest error as a share of the energy exchanged."""
        return self.share(self.largest_error)

    @property
    def change(self) -> float:
        """The largest change, whatever caused it, as a share of the energy exchanged."""
        return self.share(self.largest_change)

    def share(self, energy: float) -> float:
        """Return an energy [J] as a share of what is exchanged; 0 where nothing is."""
        return energy / self.exchanged if self.exchanged > 0.0 else 0.0
