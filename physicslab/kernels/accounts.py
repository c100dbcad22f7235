"""The accounts of energy and momentum: an array (BOOK, 4) that kernels add to, by one function.

A row is a cause; its columns are the energy that it has given to the world [J], the momentum (x, y) [N s] and
the angular momentum about the origin [N m s]. Takings of a cause are negative.
"""

from typing import Any

from physicslab.kernels import inlined

CAUSES = 13
(
    EDITS, HAND, THRUST, MOTORS, FIELDS, IMPACTS, FRICTION, CONTACT, OVERLAP, DAMPING, JOINTS, GRAVITY,
    SPRINGS,
) = range(CAUSES)  # fmt: skip
"""The causes. Gravity and springs store energy, which is part of the world's: their rows have momentum alone,
of what pulls from outside, as a planet below or a fixed end. The momentum of friction of what slides or rests
is that of ``CONTACT``."""
ENERGY, PX, PY, ANGULAR_MOMENTUM = range(4)
"""The columns."""
BALANCE, BEFORE, BOOK = CAUSES, CAUSES + 1, 2 * (CAUSES + 1)
"""Behind the causes there is what the world had after the last step; from ``BEFORE`` on all of that as it was
before the step at hand."""


@inlined
def book(given: Any, account: int, energy: float, px: float, py: float, spin: float) -> None:
    """Add energy [J], momentum [N s] and angular momentum about the origin [N m s] to an account.

    Or what all of that is in a second, where it is integrated beside the motion. ``given`` is (n,) float64,
    or its address; the account begins at ``account``.
    """
    given[account + ENERGY] += energy
    given[account + PX] += px
    given[account + PY] += py
    given[account + ANGULAR_MOMENTUM] += spin
