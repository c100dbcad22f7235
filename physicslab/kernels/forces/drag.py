"""Drag: what resists motion through a fluid at rest."""

import math

from physicslab.kernels import Numbers, Rows, Vectors, inlined, kernel

__all__ = ["drag_factor", "drag_forces"]


@inlined
def drag_factor(vx: float, vy: float, linear: float, quadratic: float) -> float:
    """Return c + k |v| [kg/s]: the drag is that times -v."""
    if quadratic == 0.0:
        return linear
    return linear + quadratic * math.sqrt(vx * vx + vy * vy)


@kernel
def drag_forces(force: Vectors, velocity: Vectors, rows: Rows, linear: Numbers, quadratic: Numbers) -> None:
    """Add -(c + k |v|) v to the force on each of ``rows``; c in kg/s, k in kg/m."""
    for i in rows:
        f = drag_factor(velocity[i, 0], velocity[i, 1], linear[i], quadratic[i])
        force[i, 0] -= f * velocity[i, 0]
        force[i, 1] -= f * velocity[i, 1]
