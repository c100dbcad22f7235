"""The length of a vector."""

import math

from physicslab.kernels import inlined


@inlined
def length_of(x: float, y: float) -> float:
    """Return the length of a vector, rounded alike compiled and as Python, which ``math.hypot`` is not."""
    return math.sqrt(x * x + y * y)
