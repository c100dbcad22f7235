"""Kinetic energy, momenta, and moments of mass."""

from physicslab.kernels import Numbers, Vectors, inlined, kernel

__all__ = ["moments_of_mass", "motion_totals"]


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
            m, x, y = mass[i], position[i, 0], position[i, 1]
            vx, vy, w = linear[i, 0], linear[i, 1], angular[i]
            translation += 0.5 * m * (vx * vx + vy * vy)
            px += m * vx
            py += m * vy
            spin += m * (x * vy - y * vx)
            mx += m * x
            my += m * y
            if inverse_inertia[i] > 0.0:
                rotation += 0.5 * inertia[i] * w * w
                spin += inertia[i] * w
    return translation, rotation, px, py, spin, mx, my


@inlined
def moments_of_mass(position: Vectors, mass: Numbers, inverse_mass: Numbers) -> tuple[float, float, float]:
    """Return the mass of all that can be moved [kg], and its first moment (x, y) [kg m]."""
    total, mx, my = 0.0, 0.0, 0.0
    for i in range(len(mass)):
        if inverse_mass[i] > 0.0:
            total += mass[i]
            mx += mass[i] * position[i, 0]
            my += mass[i] * position[i, 1]
    return total, mx, my
