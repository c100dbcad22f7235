"""How damping shortens motion: shares of time that do not lose digits where there is little of it."""

import math

from physicslab.kernels import inlined


@inlined
def fall_shares(z: float) -> tuple[float, float, float]:
    """Return e^-z, (1 - e^-z) / z and (z - 1 + e^-z) / z^2 without loss for small z."""
    if abs(z) < 0.1:
        first, second, term = 0.0, 0.0, 1.0
        for k in range(1, 14):
            first += term / k
            second += term / (k * (k + 1.0))
            term *= -z / k
        return math.exp(-z), first, second
    first = -math.expm1(-z) / z
    return math.exp(-z), first, (1.0 - first) / z
