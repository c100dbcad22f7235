"""The accounts of energy and momentum as reports and the window show them: physics apart from error."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from physicslab.components.quantities import ENERGY_CAUSES, MOMENTUM_CAUSES, UNMEASURED_MOMENTA
from physicslab.diagnostics.energy import Energy, measure_kinetic
from physicslab.ecs.vector import Vector2
from physicslab.kernels import accounts
from physicslab.state.account import Balance
from physicslab.stepping.accounting import balance_of, held_in
from physicslab.world import World

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
        What there was then, and what there is now.
    energy : dict of str to float
        What each cause gave [J], negative for what it took; ``numerical`` is the error of the method.
    momentum : dict of str to Vector2
        The impulse of each cause from outside [N s], ``numerical`` likewise.
    angular_momentum : dict of str to float
        The angular impulse of each about the origin [N m s].
    parts : Energy
        Of what the energy now consists.
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

    @np.errstate(all="ignore")
    def after(self, begin: Accounts) -> Accounts:
        """Return the accounts of what happened after an earlier moment, at which they were ``begin``."""
        energy, momentum = _given(self.energy, begin.energy), _given(self.momentum, begin.momentum)
        angular = _given(self.angular_momentum, begin.angular_momentum)
        now, start = self.now, begin.now
        energy["numerical"] = now.energy - start.energy - sum(energy.values())
        change = Vector2(now.px - start.px, now.py - start.py)
        momentum["numerical"] = change - sum(momentum.values(), Vector2())
        angular["numerical"] = now.spin - start.spin - sum(angular.values())
        return replace(self, start=start, energy=energy, momentum=momentum, angular_momentum=angular)


def _given[V: (float, Vector2)](now: Mapping[str, V], before: Mapping[str, V]) -> dict[str, V]:
    """Return what each cause has given since an earlier moment, without the error."""
    return {name: value - before[name] for name, value in now.items() if name != "numerical"}


@np.errstate(all="ignore")  # an energy may be infinite: what is left is then not a number
def measure_account(world: World) -> Accounts:
    """Return the accounts as they are now; an edit since the last step is booked as one."""
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
    left = np.subtract(now, start) - sums.sum(axis=0)
    rows = sums.tolist()
    energy = {name: rows[row][0] for name, row in ENERGY_ACCOUNTS.items()}
    energy["numerical"] = float(left[0])
    momentum = {name: Vector2(rows[row][1], rows[row][2]) for name, row in MOMENTUM_ACCOUNTS.items()}
    momentum["numerical"] = Vector2(float(left[1]), float(left[2]))
    angular = {name: rows[row][3] for name, row in MOMENTUM_ACCOUNTS.items()}
    angular["numerical"] = float(left[3])
    since = account.since if account.start is not None else world.time
    return Accounts(since, start, now, energy, momentum, angular, Energy(*measure_kinetic(world), stored))
