"""Where the accounts of energy and momentum are, in the array (CAUSES, 4) that kernels add to.

A row is a cause; its columns are the energy that it has given to the world [J], the momentum (x, y) [N s] and
the angular momentum about the origin [N m s]. What a cause takes is negative.
"""

__all__ = [
    "CAUSES", "CONTACT", "DAMPING", "EDITS", "ENERGY", "FIELDS", "FRICTION", "GRAVITY", "HAND", "IMPACTS",
    "JOINTS", "MOTORS", "OVERLAP", "PX", "PY", "SPIN", "SPRINGS", "THRUST",
]  # fmt: skip

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
