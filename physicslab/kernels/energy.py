"""Kinetic energy, momenta, and moments of mass."""

from physicslab.kernels import Numbers, Vectors, inlined, kernel


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
    total, mx, my, half = 0.0, 0.0, 0.0, len(mass) // 2
    other_total, other_mx, other_my = 0.0, 0.0, 0.0  # two sums: each waits for its own last addition alone
    for i in range(half):
        m = mass[i] if inverse_mass[i] > 0.0 else 0.0
        other = mass[half + i] if inverse_mass[half + i] > 0.0 else 0.0
        total += m
        mx += m * position[i, 0]
        my += m * position[i, 1]
        other_total += other
        other_mx += other * position[half + i, 0]
        other_my += other * position[half + i, 1]
    for i in range(2 * half, len(mass)):
        m = mass[i] if inverse_mass[i] > 0.0 else 0.0
        total += m
        mx += m * position[i, 0]
        my += m * position[i, 1]
    return total + other_total, mx + other_mx, my + other_my
