"""Where the accounts of energy and momentum are, in the array (BOOK, 4) that kernels add to.

A row is a cause; its columns are the energy that it has given to the world [J], the momentum (x, y) [N s] and
the angular momentum about the origin [N m s]. What a cause takes is negative.
"""

CAUSES = 13
(
    EDITS, HAND, THRUST, MOTORS, FIELDS, IMPACTS, FRICTION, CONTACT, OVERLAP, DAMPING, JOINTS, GRAVITY,
    SPRINGS,
) = range(CAUSES)  # fmt: skip
"""The causes. Gravity and springs store energy, which is part of the world's: their rows have momentum alone,
of what pulls from outside, as a planet below or a fixed end. The momentum of friction of what slides or rests
is that of ``CONTACT``."""
ENERGY, PX, PY, SPIN = range(4)
"""The columns."""
BALANCE, BEFORE, BOOK = CAUSES, CAUSES + 1, 2 * (CAUSES + 1)
"""Behind the causes there is what the world had after the last step; from ``BEFORE`` on all of that as it was
before the step at hand."""
