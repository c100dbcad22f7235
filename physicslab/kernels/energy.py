"""Kinetic energy and momenta."""

from numba import float64, types

from physicslab.kernels import kernel

__all__ = ["motion_totals"]

_NUMBERS = float64[::1]
_VECTORS = float64[:, ::1]


@kernel(types.UniTuple(float64, 5)(_VECTORS, _VECTORS, _NUMBERS, _NUMBERS, _NUMBERS, _NUMBERS, _NUMBERS))
def motion_totals(position, linear, angular, mass, inertia, inverse_mass, inverse_inertia):
    """Return kinetic energy (of translation, of rotation) [J], momentum (x, y) [kg m/s], angular momentum [kg m^2/s].

    Angular momentum is taken about the origin. Rows of infinite weight do not count.
    """
    translation, rotation, px, py, spin = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(len(mass)):
        if inverse_mass[i] > 0.0:
            vx, vy, w = linear[i, 0], linear[i, 1], angular[i]
            translation += 0.5 * mass[i] * (vx * vx + vy * vy)
            px += mass[i] * vx
            py += mass[i] * vy
            spin += mass[i] * (position[i, 0] * vy - position[i, 1] * vx)
            if inverse_inertia[i] > 0.0:
                rotation += 0.5 * inertia[i] * w * w
                spin += inertia[i] * w
    return translation, rotation, px, py, spin
