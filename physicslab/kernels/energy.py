"""Kinetic energy, momenta, and moments of mass.

Sums of many rows are made in four parts, each of every fourth row: one sum waits for its last addition.
"""

from typing import NamedTuple

from physicslab.kernels import Numbers, Vectors, inlined, kernel

__all__ = ["moments_of_mass", "motion_totals"]


class _Totals(NamedTuple):
    """Twice the kinetic energies of translation and rotation, momentum, angular momentum, moments of mass."""

    translation: float
    rotation: float
    px: float
    py: float
    spin: float
    mx: float
    my: float


@inlined
def _with_row(
    totals: _Totals, i: int, position: Vectors, linear: Vectors, angular: Numbers, mass: Numbers,
    inertia: Numbers, inverse_mass: Numbers, inverse_inertia: Numbers,
) -> _Totals:  # fmt: skip
    m = mass[i] if inverse_mass[i] > 0.0 else 0.0
    turned = inertia[i] * angular[i] if m > 0.0 and inverse_inertia[i] > 0.0 else 0.0
    x, y, px, py = position[i, 0], position[i, 1], m * linear[i, 0], m * linear[i, 1]
    return _Totals(
        totals.translation + (px * linear[i, 0] + py * linear[i, 1]),
        totals.rotation + turned * angular[i],
        totals.px + px, totals.py + py, totals.spin + (x * py - y * px + turned),
        totals.mx + m * x, totals.my + m * y,
    )  # fmt: skip


@kernel
def motion_totals(
    position: Vectors, linear: Vectors, angular: Numbers, mass: Numbers, inertia: Numbers,
    inverse_mass: Numbers, inverse_inertia: Numbers,
) -> tuple[float, float, float, float, float, float, float]:  # fmt: skip
    """Return kinetic energy (of translation, of rotation) [J], momentum (x, y) [kg m/s], angular momentum.

    The last is taken about the origin [kg m^2/s]. Then the first moment of mass (x, y) [kg m]: uniform
    gravity g stores -g times it. Rows of infinite weight do not count.
    """
    n = len(mass)
    a = b = c = d = _Totals(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for k in range(n // 4):
        i = 4 * k
        a = _with_row(a, i, position, linear, angular, mass, inertia, inverse_mass, inverse_inertia)
        b = _with_row(b, i + 1, position, linear, angular, mass, inertia, inverse_mass, inverse_inertia)
        c = _with_row(c, i + 2, position, linear, angular, mass, inertia, inverse_mass, inverse_inertia)
        d = _with_row(d, i + 3, position, linear, angular, mass, inertia, inverse_mass, inverse_inertia)
    for i in range(n - n % 4, n):
        a = _with_row(a, i, position, linear, angular, mass, inertia, inverse_mass, inverse_inertia)
    return (
        0.5 * (a.translation + b.translation + (c.translation + d.translation)),
        0.5 * (a.rotation + b.rotation + (c.rotation + d.rotation)),
        a.px + b.px + (c.px + d.px),
        a.py + b.py + (c.py + d.py),
        a.spin + b.spin + (c.spin + d.spin),
        a.mx + b.mx + (c.mx + d.mx),
        a.my + b.my + (c.my + d.my),
    )


@inlined
def _with_mass(
    total: float, mx: float, my: float, i: int, position: Vectors, mass: Numbers, inverse_mass: Numbers
) -> tuple[float, float, float]:
    m = mass[i] if inverse_mass[i] > 0.0 else 0.0
    return total + m, mx + m * position[i, 0], my + m * position[i, 1]


@inlined
def moments_of_mass(position: Vectors, mass: Numbers, inverse_mass: Numbers) -> tuple[float, float, float]:
    """Return the mass of all that can be moved [kg], and its first moment (x, y) [kg m]."""
    n, a, ax, ay, b, bx, by = len(mass), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    c, cx, cy, d, dx, dy = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(n // 4):
        i = 4 * k
        a, ax, ay = _with_mass(a, ax, ay, i, position, mass, inverse_mass)
        b, bx, by = _with_mass(b, bx, by, i + 1, position, mass, inverse_mass)
        c, cx, cy = _with_mass(c, cx, cy, i + 2, position, mass, inverse_mass)
        d, dx, dy = _with_mass(d, dx, dy, i + 3, position, mass, inverse_mass)
    for i in range(n - n % 4, n):
        a, ax, ay = _with_mass(a, ax, ay, i, position, mass, inverse_mass)
    return a + b + (c + d), ax + bx + (cx + dx), ay + by + (cy + dy)
