"""Kinetic energy and momenta."""

from physicslab.kernels import Numbers, Vectors, kernel

__all__ = ["motion_totals"]


@kernel
def motion_totals(
    position: Vectors, linear: Vectors, angular: Numbers, mass: Numbers, inertia: Numbers,
    inverse_mass: Numbers, inverse_inertia: Numbers,
) -> tuple[float, float, float, float, float, float, float]:  # fmt: skip
    """Return kinetic energy (of translation, of rotation) [J], momentum (x, y) [kg m/s], angular momentum.

    The last is taken about the origin [kg m^2/s]. Then the first moment of mass (x, y) [kg m]: uniform
    gravity g stores -g times it. Rows of infinite weight do not count.
    """
    translation, rotation, px, py, spin, mx, my = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(len(mass)):
        if inverse_mass[i] > 0.0:
            vx, vy, w = linear[i, 0], linear[i, 1], angular[i]
            translation += 0.5 * mass[i] * (vx * vx + vy * vy)
            px += mass[i] * vx
            py += mass[i] * vy
            mx += mass[i] * position[i, 0]
            my += mass[i] * position[i, 1]
            spin += mass[i] * (position[i, 0] * vy - position[i, 1] * vx)
            if inverse_inertia[i] > 0.0:
                rotation += 0.5 * inertia[i] * w * w
                spin += inertia[i] * w
    return translation, rotation, px, py, spin, mx, my
