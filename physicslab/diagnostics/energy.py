"""Energies, momenta and what changes them, by cause: the one source of these figures."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from physicslab.components.quantities import ENERGY_CAUSES, MOMENTUM_CAUSES, UNMEASURED_MOMENTA
from physicslab.ecs.vector import Vector2
from physicslab.kernels import accounts
from physicslab.state.account import Balance, Energy, Momentum
from physicslab.stepping.accounting import balance_of, held_in, motion_totals_of
from physicslab.world import World


def _motion(world: World) -> tuple[float, float, float, float, float, float, float]:
    world.synchronise()
    return motion_totals_of(world)


def measure_kinetic(world: World) -> tuple[float, float]:
    """Return the kinetic energies of translation and of rotation [J]."""
    translation, rotation, *_ = _motion(world)
    return translation, rotation


@np.errstate(all="ignore")  # an energy may be infinite, and is returned as such
def measure_energy(world: World) -> Energy:
    """Return the energy of the world as it is now."""
    kinetic, potential = measure_kinetic(world), dict[str, float]()
    with world.active():
        balance_of(world, world.schedule.forces, potential)
    return Energy(*kinetic, potential)


def measure_momentum(world: World) -> Momentum:
    """Return the momentum and angular momentum of the world as it is now."""
    _, _, px, py, spin, _, _ = _motion(world)
    return Momentum(Vector2(px, py), spin)


def summation(world: World) -> str:
    """Return how the running forces are summed, where one does not add pair by pair; else nothing."""
    return "; ".join(words for force in world.schedule.forces if (words := force.summation(world)))


ENERGY_ACCOUNTS: dict[str, int] = {name: getattr(accounts, name.upper()) for name in ENERGY_CAUSES}
"""The accounts of energy by name, each with its row; ``numerical`` is what they leave."""
MOMENTUM_ACCOUNTS: dict[str, int] = {
    name: getattr(accounts, name.upper()) for name in MOMENTUM_CAUSES if name not in UNMEASURED_MOMENTA
}
"""Those of momentum: gravity and springs store energy, but pull from outside."""


@dataclass(frozen=True, slots=True)
class Accounts:
    """Changes of energy and momentum by cause since the accounts began.

    Attributes
    ----------
    since : float
        The world's clock when they began [s].
    start, now : Balance
        The balance then and now.
    energy : dict of str to float
        Energy given by each cause [J], negative where it took; ``numerical`` is the error of the method.
    momentum : dict of str to Vector2
        The impulse of each cause from outside [N s], ``numerical`` likewise.
    angular_momentum : dict of str to float
        The angular impulse of each about the origin [N m s].
    parts : Energy
        Parts of the energy now.
    """

    since: float
    start: Balance
    now: Balance
    energy: dict[str, float]
    momentum: dict[str, Vector2]
    angular_momentum: dict[str, float]
    parts: Energy

    @property
    def change(self) -> float:
        """How much more energy there is than at the start [J]: the sum of the accounts of energy."""
        return self.now.energy - self.start.energy

    @property
    def unknown(self) -> Accounts:
        """The same balance, of which no cause is known."""
        nothing = math.nan
        energy, angular = (dict.fromkeys(given, nothing) for given in (self.energy, self.angular_momentum))
        momentum = dict.fromkeys(self.momentum, Vector2(nothing, nothing))
        return replace(self, energy=energy, momentum=momentum, angular_momentum=angular)

    @np.errstate(all="ignore")
    def after(self, begin: Accounts) -> Accounts:
        """Return the accounts of what happened after an earlier moment, at which they were ``begin``."""
        energy, momentum = _given(self.energy, begin.energy), _given(self.momentum, begin.momentum)
        angular = _given(self.angular_momentum, begin.angular_momentum)
        # Accounts begin with the first step of a world: what was changed before it is an edit too.
        edited = [after - before for after, before in zip(self.start, begin.start, strict=True)]
        energy["edits"] += edited[0]
        momentum["edits"] += Vector2(edited[1], edited[2])
        angular["edits"] += edited[3]
        now, start = self.now, begin.now
        energy["numerical"] = now.energy - start.energy - sum(energy.values())
        change = Vector2(now.px - start.px, now.py - start.py)
        momentum["numerical"] = change - sum(momentum.values(), Vector2())
        angular["numerical"] = now.spin - start.spin - sum(angular.values())
        return replace(self, start=start, energy=energy, momentum=momentum, angular_momentum=angular)


def _given[V: (float, Vector2)](now: Mapping[str, V], before: Mapping[str, V]) -> dict[str, V]:
    """Return what each cause has given since an earlier moment, without the error."""
    return {name: value - before[name] for name, value in now.items() if name != "numerical"}


@dataclass(frozen=True, slots=True)
class Booked:
    """The account books at a moment, of which :class:`Accounts` are made.

    Attributes
    ----------
    since : float
        When they began [s].
    start, now : Balance
        Energy and momentum then and now.
    sums : float64 array (CAUSES, 4)
        Energy, momentum and angular momentum given by each cause in between.
    parts : Energy
        The energy of now.
    """

    since: float
    start: Balance
    now: Balance
    sums: NDArray[np.float64]
    parts: Energy

    @np.errstate(all="ignore")
    def accounts(self) -> Accounts:
        """Return the accounts by the names of causes."""
        left = np.subtract(self.now, self.start) - self.sums.sum(axis=0)
        rows = self.sums.tolist()
        energy = {name: rows[row][0] for name, row in ENERGY_ACCOUNTS.items()}
        energy["numerical"] = float(left[0])
        momentum = {name: Vector2(rows[row][1], rows[row][2]) for name, row in MOMENTUM_ACCOUNTS.items()}
        momentum["numerical"] = Vector2(float(left[1]), float(left[2]))
        angular = {name: rows[row][3] for name, row in MOMENTUM_ACCOUNTS.items()}
        angular["numerical"] = float(left[3])
        return Accounts(self.since, self.start, self.now, energy, momentum, angular, self.parts)


def measure_account(world: World) -> Accounts:
    """Return the accounts as they are now; an edit since the last step is booked as one."""
    return read_books(world).accounts()


@np.errstate(all="ignore")  # an energy may be infinite: what is left is then not a number
def read_books(world: World) -> Booked:
    """Return what :func:`measure_account` tells, in a tenth of the time."""
    world.synchronise()
    account, sums = world.account, world.account.sums.copy()
    stored: dict[str, float] = {}
    with world.active():
        now = balance_of(world, world.schedule.forces, stored)
        held = held_in(world)
    start = account.start
    if start is None:
        start = now
    elif now != account.last:
        cause, change = account.pending(now, held)
        sums[cause] += change
    since = account.since if account.start is not None else world.time
    translation, rotation, *_ = motion_totals_of(world)
    return Booked(since, start, now, sums, Energy(translation, rotation, stored))


_LEAST_OF_EXCHANGED = 1e-12
"""Share of the energy exchanged below which an account is rounding."""
_LEAST_OF_ENERGY = 1e-15
"""Share of the largest energy below which it is so, where hardly any is exchanged."""
_BRINGING = ("edits", "hand")
"""The accounts whose size is no measure of what is exchanged: a body that comes, goes or is taken into a hand
brings or takes all of its potential energy, which depends on where that is zero."""


class Audit:
    """The accounts of a world from now on, sampled, with the largest change and the largest error seen.

    Shares are of the energy that is exchanged: the largest kinetic energy seen, the range of the potential
    energy apart from what edits and a hand brought, or the largest account of another cause, work of driven
    bodies included while nothing is held; whichever is largest. None of these depends on where a potential
    is zero.

    Parameters
    ----------
    world : World
        The world that is sampled.
    whole : bool
        Whether it reaches back to where the world's own accounts began, and not just to now.

    Attributes
    ----------
    account : Accounts
        Changes of energy and momenta from the beginning to the last :meth:`sample`.
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
        self._bringing = _BRINGING if whole and found.energy["hand"] else _BRINGING[:1]
        self._moved: dict[str, None] = {}
        self.largest_change = self.largest_error = self.exchanged = 0.0
        self._low, self._high = math.inf, -math.inf
        self._take(found, world)
        self.initial = self.account.start.energy

    def sample(self, world: World) -> None:
        """Read the accounts as they are now."""
        self._take(measure_account(world), world)

    @np.errstate(all="ignore")
    def _take(self, found: Accounts, world: World) -> None:
        if held_in(world):
            self._bringing = _BRINGING
        self.account = account = found if self._begin is None else found.after(self._begin)
        self.latest: Energy = account.parts
        booked = account.energy
        inside = self.latest.stored - sum(booked[name] for name in self._bringing)
        self._low, self._high = min(self._low, inside), max(self._high, inside)
        sizes = (abs(value) for name, value in booked.items() if name not in (*self._bringing, "numerical"))
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


ACCOUNT_WORDS: dict[str, str] = {
    "edits": "edits",
    "hand": "hand and driven bodies",
    "thrust": "thrust",
    "motors": "motors",
    "fields": "other forces",
    "impacts": "impacts",
    "friction": "friction",
    "contact": "resting contacts",
    "overlap": "overlap",
    "damping": "damping",
    "joints": "joints",
    "gravity": "gravity",
    "springs": "springs",
    "numerical": "error",
}
"""The name of each account in plain words."""
STORED_WORDS = {
    "coulomb": "charges", "electric_field": "electric field", "medium": "media", "spring": "springs",
}  # fmt: skip
"""Plain words for forces that store energy, where their names are code."""


def flows(booked: Mapping[str, float]) -> list[tuple[str, float]]:
    """Return the causes that gave energy, then those that took some, the largest first of each [J].

    Parameters
    ----------
    booked : mapping of str to float
        Accounts, without the error.

    Examples
    --------
    >>> flows({"hand": 5.0, "impacts": -1.0, "friction": -2.0, "edits": 0.0})
    [('hand', 5.0), ('friction', -2.0), ('impacts', -1.0)]
    """
    moved = [(name, value) for name, value in booked.items() if value]
    return sorted(moved, key=lambda flow: (not flow[1] > 0.0, -abs(flow[1])))
