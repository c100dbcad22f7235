"""Drag: what resists motion through a fluid at rest."""

import math

from physicslab.kernels import inlined


@inlined
def drag_factor(vx: float, vy: float, linear: float, quadratic: float) -> float:
    """Return c + k |v| [kg/s]: the drag is that times -v."""
    if quadratic == 0.0:
        return linear
    return linear + quadratic * math.sqrt(vx * vx + vy * vy)
