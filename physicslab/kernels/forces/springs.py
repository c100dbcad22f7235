"""Springs and dampers."""

import math
from typing import Any

from physicslab.kernels import Numbers, Rows, Vectors, always_inlined, kernel


@always_inlined
def turned(angle: float, anchor_x: float, anchor_y: float) -> tuple[float, float]:
    """Return a local anchor [m] turned into the directions of the world."""
    c, s = math.cos(angle), math.sin(angle)
    return c * anchor_x - s * anchor_y, s * anchor_x + c * anchor_y


@always_inlined
def pull_ends(
    force: Any, a: int, turn_a: int, b: int, turn_b: int, fx: float, fy: float, give_a: float, ax: float,
    ay: float, give_b: float, bx: float, by: float,
) -> None:  # fmt: skip
    """Add a force on A [N], and its opposite on B, at arms (ax, ay), (bx, by) [m] of which a share acts."""
    force[a] += fx
    force[a + 1] += fy
    force[b] -= fx
    force[b + 1] -= fy
    if turn_a >= 0:
        force[turn_a] += give_a * (ax * fy - ay * fx)
    if turn_b >= 0:
        force[turn_b] -= give_b * (bx * fy - by * fx)


@always_inlined
def spring_pull(
    dx: float, dy: float, vx: float, vy: float, rest_length: float, stiffness: float, damping: float
) -> tuple[float, float, float, float, float]:
    """Return the force on A [N], k (length - rest_length) + c (rate of lengthening) along A to B.

    (dx, dy) leads from A to B [m] and changes at (vx, vy) [m/s]. Ends that coincide have no line between
    them; only then is there no force. After the force come the direction of the line, and the rate of
    lengthening [m/s].
    """
    length = math.sqrt(dx * dx + dy * dy)
    if length == 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    nx, ny = dx / length, dy / length
    rate = nx * vx + ny * vy
    pull = stiffness * (length - rest_length) + damping * rate
    return pull * nx, pull * ny, nx, ny, rate


@always_inlined
def turn_over(angle: float) -> tuple[float, float]:
    """Return the ratio of an arm's mean, and of its mean rate, over a turn by ``angle`` to its middle.

    The mean is that of the arm at the start and at the end, the rate that at which one leads to the other.
    """
    half = 0.5 * angle
    if half == 0.0:
        return 1.0, 1.0
    return math.cos(half), math.sin(half) / half


@always_inlined
def mean_spring_pull(
    dx: float, dy: float, vx: float, vy: float, span: float,
    rest_length: float, stiffness: float, damping: float,
) -> tuple[float, float, float, float, float]:  # fmt: skip
    """Return the force on A [N] whose work is all that the spring's energy loses while B goes on steadily.

    The line from A to B goes within ``span`` seconds from l0 = d - span/2 v to l1 = d + span/2 v. The pull is
    k ((|l0| + |l1|) / 2 - rest_length) along (l0 + l1) / (|l0| + |l1|), and the damper's by the mean rate of
    lengthening (LaBudde & Greenspan, J. Comput. Phys. 15 (1974) 134). After the force come that direction
    and that rate, as :func:`spring_pull` has them. Where the line turns by more than a right angle, B passes
    A: the mean length changes by less than B goes, so the damper is that of the line in the middle.
    """
    rx, ry = 0.5 * span * vx, 0.5 * span * vy
    lengths = math.sqrt((dx - rx) * (dx - rx) + (dy - ry) * (dy - ry))
    lengths += math.sqrt((dx + rx) * (dx + rx) + (dy + ry) * (dy + ry))
    if lengths == 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    nx, ny = 2.0 * dx / lengths, 2.0 * dy / lengths
    rate = nx * vx + ny * vy
    stretch, square = stiffness * (0.5 * lengths - rest_length), dx * dx + dy * dy
    if 0.0 < square < rx * rx + ry * ry:
        px, py, length = stretch * nx, stretch * ny, math.sqrt(square)
        nx, ny = dx / length, dy / length
        rate = nx * vx + ny * vy
        return px + damping * rate * nx, py + damping * rate * ny, nx, ny, rate
    pull = stretch + damping * rate
    return pull * nx, pull * ny, nx, ny, rate


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
        ax, ay, bx, by = anchor_a[k, 0], anchor_a[k, 1], anchor_b[k, 0], anchor_b[k, 1]
        if ax != 0.0 or ay != 0.0:  # most springs hold a body by its middle
            ax, ay = turned(angle[a], ax, ay)
        if bx != 0.0 or by != 0.0:
            bx, by = turned(angle[b], bx, by)
        dx = position[b, 0] + bx - position[a, 0] - ax
        dy = position[b, 1] + by - position[a, 1] - ay
        extension = math.sqrt(dx * dx + dy * dy) - rest_length[k]
        total += 0.5 * stiffness[k] * extension * extension
    return total
