"""Uniform fields: gravity, and with charges in place of masses an electric field."""

from physicslab.kernels import Numbers, Vectors, kernel


@kernel
def uniform_gravity(force: Vectors, mass: Numbers, inverse_mass: Numbers, gx: float, gy: float) -> None:
    """Add m g to the force on every row that forces can move."""
    for i in range(len(mass)):
        if inverse_mass[i] > 0.0:
            force[i, 0] += mass[i] * gx
            force[i, 1] += mass[i] * gy


@kernel
def uniform_potential(position: Vectors, mass: Numbers, inverse_mass: Numbers, gx: float, gy: float) -> float:
    """Return the sum of -m g . x [J], zero at the origin."""
    total = 0.0
    for i in range(len(mass)):
        if inverse_mass[i] > 0.0:
            total -= mass[i] * (gx * position[i, 0] + gy * position[i, 1])
    return total
