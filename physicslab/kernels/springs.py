"""Springs and dampers."""

import math

from physicslab.kernels import Numbers, Rows, Vectors, inlined, kernel

__all__ = ["spring_forces", "spring_potential"]


@inlined
def _arm(angle: float, anchor_x: float, anchor_y: float) -> tuple[float, float]:
    """Return a local anchor [m] turned into the directions of the world."""
    c, s = math.cos(angle), math.sin(angle)
    return c * anchor_x - s * anchor_y, s * anchor_x + c * anchor_y


@kernel
def spring_forces(
    force: Vectors, torque: Numbers, position: Vectors, angle: Numbers, linear: Vectors, angular: Numbers,
    springs: Rows, row_a: Rows, row_b: Rows, anchor_a: Vectors, anchor_b: Vectors,
    rest_length: Numbers, stiffness: Numbers, damping: Numbers,
) -> None:  # fmt: skip
    """Add F = k (length - rest_length) + c (rate of lengthening), along A to B, to both ends.

    ``springs`` are the rows of the springs, ``row_a`` and ``row_b`` those of the bodies at their ends (0: the
    world). Ends that coincide have no line between them; only then there is no force.
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


@kernel
def spring_potential(
    position: Vectors, angle: Numbers, springs: Rows, row_a: Rows, row_b: Rows,
    anchor_a: Vectors, anchor_b: Vectors, rest_length: Numbers, stiffness: Numbers,
) -> float:  # fmt: skip
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
