"""Springs and dampers."""

import math

from numba import float64, int64, void

from physicslab.kernels import inlined, kernel

__all__ = ["spring_forces", "spring_potential"]

_NUMBERS = float64[::1]
_VECTORS = float64[:, ::1]
_ROWS = int64[::1]


@inlined
def _arm(angle, anchor_x, anchor_y):
    """Return a local anchor [m] turned into the directions of the world."""
    c, s = math.cos(angle), math.sin(angle)
    return c * anchor_x - s * anchor_y, s * anchor_x + c * anchor_y


@kernel(
    void(
        _VECTORS, _NUMBERS, _VECTORS, _NUMBERS, _VECTORS, _NUMBERS,
        _ROWS, _ROWS, _ROWS, _VECTORS, _VECTORS, _NUMBERS, _NUMBERS, _NUMBERS,
    )
)  # fmt: skip
def spring_forces(
    force, torque, position, angle, linear, angular,
    springs, row_a, row_b, anchor_a, anchor_b, rest_length, stiffness, damping,
):  # fmt: skip
    """Add F = k (length - rest_length) + c (rate of lengthening), along A to B, to both ends.

    ``springs`` are the rows of the springs, ``row_a`` and ``row_b`` those of the bodies at their ends (0: the world).
    Ends that coincide have no line between them; only then there is no force.
    """
    for s in range(len(springs)):
        k = springs[s]
        a, b = row_a[s], row_b[s]
        ax, ay = _arm(angle[a], anchor_a[k, 0], anchor_a[k, 1])
        bx, by = _arm(angle[b], anchor_b[k, 0], anchor_b[k, 1])
        dx = position[b, 0] + bx - position[a, 0] - ax
        dy = position[b, 1] + by - position[a, 1] - ay
        length = math.sqrt(dx * dx + dy * dy)
        if length == 0.0:
            continue
        nx, ny = dx / length, dy / length
        rate = nx * (linear[b, 0] - angular[b] * by - linear[a, 0] + angular[a] * ay)
        rate += ny * (linear[b, 1] + angular[b] * bx - linear[a, 1] - angular[a] * ax)
        pull = stiffness[k] * (length - rest_length[k]) + damping[k] * rate
        fx, fy = pull * nx, pull * ny
        force[a, 0] += fx
        force[a, 1] += fy
        torque[a] += ax * fy - ay * fx
        force[b, 0] -= fx
        force[b, 1] -= fy
        torque[b] -= bx * fy - by * fx


@kernel(
    float64(_VECTORS, _NUMBERS, _ROWS, _ROWS, _ROWS, _VECTORS, _VECTORS, _NUMBERS, _NUMBERS)
)
def spring_potential(position, angle, springs, row_a, row_b, anchor_a, anchor_b, rest_length, stiffness):
    """Return the sum of k (length - rest_length)^2 / 2 [J]."""
    total = 0.0
    for s in range(len(springs)):
        k = springs[s]
        a, b = row_a[s], row_b[s]
        ax, ay = _arm(angle[a], anchor_a[k, 0], anchor_a[k, 1])
        bx, by = _arm(angle[b], anchor_b[k, 0], anchor_b[k, 1])
        dx = position[b, 0] + bx - position[a, 0] - ax
        dy = position[b, 1] + by - position[a, 1] - ay
        extension = math.sqrt(dx * dx + dy * dy) - rest_length[k]
        total += 0.5 * stiffness[k] * extension * extension
    return total
