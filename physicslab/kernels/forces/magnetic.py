"""A magnetic field out of the plane, over packed coordinates."""

from physicslab.kernels.accounts import book
from physicslab.kernels.forces.force_calls import force_kernel


@force_kernel
def magnetic_field(q, v, span, force, parameters, indices):  # type: ignore[no-untyped-def]
    """Add q B (vy, -vx), which does no work. ``parameters``: q B of each.

    ``indices``: how many, where x of each is, and the account of the momentum that it gives, or -1.
    """
    n, px, py, spin = indices[0], 0.0, 0.0, 0.0
    for p in range(n):
        i, strength = indices[1 + p], parameters[p]
        fx, fy = strength * v[i + 1], -strength * v[i]
        force[i] += fx
        force[i + 1] += fy
        px += fx
        py += fy
        spin += q[i] * fy - q[i + 1] * fx
    if indices[1 + n] >= 0:
        book(force, indices[1 + n], 0.0, px, py, spin)
