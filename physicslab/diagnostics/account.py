"""The accounts of energy and momentum as reports and the window show them: physics apart from error."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from physicslab.ecs.vector import Vector2
from physicslab.kernels import accounts
from physicslab.state.account import Balance
from physicslab.stepping.accounting import balance_of, held_in
from physicslab.world import World

__all__ = ["ENERGY_ACCOUNTS", "MOMENTUM_ACCOUNTS", "Accounts", "measure_account"]

ENERGY_ACCOUNTS: dict[str, int] = {
    "edits": accounts.EDITS, "hand": accounts.HAND, "thrust": accounts.THRUST, "motors": accounts.MOTORS,
    "fields": accounts.FIELDS, "impacts": accounts.IMPACTS, "friction": accounts.FRICTION,
    "contact": accounts.CONTACT, "overlap": accounts.OVERLAP, "damping": accounts.DAMPING,
    "joints": accounts.JOINTS,
}  # fmt: skip
"""The accounts of energy by name, each with its row; ``numerical`` is what they leave."""
MOMENTUM_ACCOUNTS: dict[str, int] = ENERGY_ACCOUNTS | {
    "gravity": accounts.GRAVITY, "springs": accounts.SPRINGS,
}  # fmt: skip
"""Those of momentum: gravity and springs store energy, but pull from outside."""


@dataclass(frozen=True, slots=True)
class Accounts:
    """What changed energy and momentum since the accounts began.

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
    """

    since: float
    start: Balance
    now: Balance
    energy: dict[str, float]
    momentum: dict[str, Vector2]
    angular_momentum: dict[str, float]


@np.errstate(all="ignore")  # an energy may be infinite: what is left is then not a number
def measure_account(world: World) -> Accounts:
    """Return the accounts as they are now; an edit since the last step is booked as one."""
    world.synchronise()
    account, sums = world.account, world.account.sums.copy()
    with world.active():
        now = balance_of(world, world.schedule.forces)
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
    return Accounts(since, start, now, energy, momentum, angular)
