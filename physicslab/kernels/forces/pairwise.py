"""The inverse square between every two of many bodies, in loops that LLVM turns into vector instructions.

Bodies are given as columns, so that a vector register loads eight bodies at once. Both softening laws are one
formula without a branch: with d^2 = r^2 + ``added``, the pull on a unit mass per unit of G m is (1/d)
min(1/d^2, ``cap``) times the vector there. Plummer: ``added`` = s^2 and no cap; clamp: nothing added, and a
``cap`` of 1/s^2. Bodies on one spot (within 1e-75 m) do not attract each other, so no body is left out of
its own sum.

Square roots and divisions come out of one unit, at about 28 cycles for eight pairs on Zen 4, and more than
half of the time went there. 1/sqrt is therefore guessed from the exponent's bits and refined by
multiplications.
"""

from typing import Any

import numpy as np
from llvmlite import ir
from numba import float64, int64, types
from numba.extending import intrinsic

from physicslab.kernels import Numbers, allocating, inlined_loosely
from physicslab.kernels.python_equivalents import equivalent_for

TILE = 64
"""Bodies in a tile: two of them, forces and all, are 5 kB, which the innermost cache holds."""
_GUESS = 0x5FE6EB50C7B537A9
_ONE_SPOT = 1e-150
"""Squared distance [m^2] below which there is no direction to pull in; its power -3/2 is still finite."""


def _bits_type(context: Any, value: Any) -> Any:
    """Read the bits of a float64 as an int64."""
    return int64(float64), lambda c, builder, s, arguments: builder.bitcast(arguments[0], ir.IntType(64))


def _number_type(context: Any, value: Any) -> Any:
    """Read the bits of an int64 as a float64."""
    return float64(int64), lambda c, builder, s, arguments: builder.bitcast(arguments[0], ir.DoubleType())


def _start_type(context: Any, array: Any) -> Any:
    """Return where an array's data begin: places behind a pointer are never counted from the end."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return context.make_array(signature.args[0])(context, builder, arguments[0]).data

    pointer: Any = types.CPointer
    return pointer(float64)(array), generate


_bits: Any = intrinsic(_bits_type)
_number: Any = intrinsic(_number_type)
_start: Any = intrinsic(_start_type)
equivalent_for(_bits)(lambda value: value.view(np.int64))
equivalent_for(_number)(lambda value: value.view(np.float64))
equivalent_for(_start)(lambda array: array)


@inlined_loosely
def inverse_root(d2: float) -> float:
    """Return 1 / sqrt(d2) to two units in the last place, and 0 on one spot.

    The guess halves the exponent (C. Lomont, "Fast inverse square root", 2003) and is 3.4 % off. With
    h = 1 - d2 y^2, 1/sqrt(d2) = y (1 - h)^(-1/2): four terms of that series leave 6e-6, three more 6e-16.
    """
    y = _number(_GUESS - (_bits(d2) >> 1))
    h = 1.0 - d2 * y * y
    y += y * h * (0.5 + h * (0.375 + h * 0.3125))
    h = 1.0 - d2 * y * y
    y += y * h * (0.5 + h * 0.375)
    return float(y) if not d2 < _ONE_SPOT else 0.0


@inlined_loosely
def pull_terms(softening: float, plummer: bool) -> tuple[float, float]:
    """Return what is added to r^2 [m^2] and the cap on 1/d^2 [1/m^2]."""
    if plummer:
        return softening * softening, np.inf
    return 0.0, 1.0 / (softening * softening) if softening > 0.0 else np.inf


@inlined_loosely
def depth_terms(softening: float, plummer: bool) -> tuple[float, float, float]:
    """Return what is added to r^2, below which d^2 the clamp law holds [m^2], and 1/s [1/m]."""
    if plummer:
        return softening * softening, 0.0, 0.0
    return 0.0, softening * softening, 1.0 / softening if softening > 0.0 else 0.0


@inlined_loosely
def _strength(d2: float, cap: float) -> float:
    u = inverse_root(d2)
    u2 = u * u
    return u * (cap if u2 > cap else u2)


@inlined_loosely
def pull_of(
    x: Numbers, y: Numbers, mass: Numbers, at_x: float, at_y: float, added: float, cap: float
) -> tuple[float, float]:
    """Return the pull [kg/m^2] of all of ``x``, ``y`` [m] and ``mass`` [kg], (n,) each, on a unit mass."""
    fx, fy = 0.0, 0.0
    for j in range(len(x)):
        dx, dy = x[j] - at_x, y[j] - at_y
        w = mass[j] * _strength(dx * dx + dy * dy + added, cap)
        fx += w * dx
        fy += w * dy
    return fx, fy


@inlined_loosely
def depth_of(
    x: Numbers, y: Numbers, mass: Numbers, at_x: float, at_y: float, added: float, near2: float,
    inverse: float,
) -> float:  # fmt: skip
    """Return the sum of m times the depth [kg/m] of bodies as in :func:`pull_of`, for a unit mass.

    Plummer: 1/d. Clamp: 1/r beyond s, and within the straight line (2 s - r) / s^2 that continues it.
    """
    total = 0.0
    for j in range(len(x)):
        dx, dy = x[j] - at_x, y[j] - at_y
        d2 = dx * dx + dy * dy + added
        u = inverse_root(d2)
        total += mass[j] * (u if d2 >= near2 else (2.0 - d2 * u * inverse) * inverse)
    return total


@allocating
def attract_pairwise(
    x: Numbers, y: Numbers, mass: Numbers, softening: float, plummer: bool, ax: Numbers, ay: Numbers
) -> None:
    """Set ``ax``, ``ay`` [kg/m^2] to the pull of all others on a unit mass at each of (n,) bodies.

    Every pair is worked out once, for both of its bodies. Bodies go in tiles of ``x, y, mass, ax, ay`` with
    :data:`TILE` of each, all tiles in one array: LLVM then sees by how much any two places differ, and needs
    no check at run time that what it writes is not what it reads.
    """
    added, cap = pull_terms(softening, plummer)
    n = len(x)
    tiles = (n + TILE - 1) // TILE
    table = np.zeros(tiles * 5 * TILE)
    for i in range(tiles * TILE):
        place = (i // TILE) * 5 * TILE + i % TILE
        body = min(i, n - 1)
        table[place], table[place + TILE] = x[body], y[body]
        table[place + 2 * TILE] = mass[body] if i < n else 0.0
    for a in range(tiles):
        _attract_within(table, a * 5 * TILE, added, cap)
        for b in range(a + 1, tiles):
            _attract_between(table, a * 5 * TILE, b * 5 * TILE, added, cap)
    for i in range(n):
        place = (i // TILE) * 5 * TILE + i % TILE
        ax[i], ay[i] = table[place + 3 * TILE], table[place + 4 * TILE]


@inlined_loosely
def _attract_within(table: Numbers, a: int, added: float, cap: float) -> None:
    p = _start(table)
    for i in range(TILE):
        x, y, fx, fy = p[a + i], p[a + TILE + i], 0.0, 0.0
        for j in range(TILE):
            dx, dy = p[a + j] - x, p[a + TILE + j] - y
            w = p[a + 2 * TILE + j] * _strength(dx * dx + dy * dy + added, cap)
            fx += w * dx
            fy += w * dy
        p[a + 3 * TILE + i] += fx
        p[a + 4 * TILE + i] += fy


@inlined_loosely
def _attract_between(table: Numbers, a: int, b: int, added: float, cap: float) -> None:
    p = _start(table)
    for i in range(TILE):
        x, y, m, fx, fy = p[a + i], p[a + TILE + i], p[a + 2 * TILE + i], 0.0, 0.0
        for j in range(TILE):
            dx, dy = p[b + j] - x, p[b + TILE + j] - y
            w = _strength(dx * dx + dy * dy + added, cap)
            here, there = w * p[b + 2 * TILE + j], w * m
            fx += here * dx
            fy += here * dy
            p[b + 3 * TILE + j] -= there * dx
            p[b + 4 * TILE + j] -= there * dy
        p[a + 3 * TILE + i] += fx
        p[a + 4 * TILE + i] += fy


@inlined_loosely
def depth_of_pairs(x: Numbers, y: Numbers, mass: Numbers, softening: float, plummer: bool) -> float:
    """Return the sum of m_a m_b times the depth [kg^2/m] over every pair of (n,) bodies."""
    added, near2, inverse = depth_terms(softening, plummer)
    total = 0.0
    for i in range(len(x) - 1):
        rest = i + 1
        total += mass[i] * depth_of(x[rest:], y[rest:], mass[rest:], x[i], y[i], added, near2, inverse)
    return total
