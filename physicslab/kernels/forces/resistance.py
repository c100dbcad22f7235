"""The response of dampers and drag to a velocity within a step, for the implicit method.

Each is a C function like a force of :mod:`physicslab.kernels.forces.packed_forces`, of the same numbers,
behind how many coordinates there are. Its ``v`` holds three velocities one behind the other,
each of so many numbers: y, to which it responds; u, the mean of the step; and v, that at the start. At the
end it is u + y.
"""

import math

from physicslab.kernels.forces.force_calls import force_kernel
from physicslab.kernels.forces.springs import pull_ends, turn_over, turned


@force_kernel
def drag_resistance(q, v, span, force, parameters, indices):  # type: ignore[no-untyped-def]
    """Add -(c + 2 k |u|) y: the slope of quadratic drag along the velocity, where it is steepest."""
    n = indices[0]
    for p in range(indices[1]):
        i = indices[2 + p]
        x, y = v[n + i], v[n + i + 1]
        f = parameters[2 * p] + 2.0 * parameters[2 * p + 1] * math.sqrt(x * x + y * y)
        force[i] -= f * v[i]
        force[i + 1] -= f * v[i + 1]


@force_kernel
def damper_resistance(q, v, span, force, parameters, indices):  # type: ignore[no-untyped-def]
    """Add the pull of every damper, were y the velocity, less the part that is due to the damper's rotation.

    The velocity of a body that circles at the end of a damper changes along it, though its length stays: by
    a . d - (n1 . v1 - n0 . v0), where a is the mean direction, d the change of velocity, and n0 and n1 the
    directions at the start and at the end. Half of that is taken off, so that a rod that only turns is left
    to the midpoint rule: with the end's velocity along the mean direction it would lose speed. A line that
    turns by more than a right angle passes through zero instead, and is that of the middle.
    """
    n = indices[0]
    for s in range(indices[1]):
        w, p = 2 + 4 * s, 7 * s
        damping = parameters[p + 6]
        if damping == 0.0:
            continue
        a, turn_a, b, turn_b = indices[w], indices[w + 1], indices[w + 2], indices[w + 3]
        ax, ay = parameters[p], parameters[p + 1]
        bx, by = parameters[p + 2], parameters[p + 3]
        near_a, give_a, near_b, give_b, half_a, half_b = 1.0, 1.0, 1.0, 1.0, 0.0, 0.0
        spin_a, spin_b = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)  # of y, at the start, at the end
        if turn_a >= 0:
            ax, ay = turned(q[turn_a], ax, ay)
            half_a = 0.5 * span * v[n + turn_a]
            near_a, give_a = turn_over(2.0 * half_a)
            spin_a = (v[turn_a], v[2 * n + turn_a], v[n + turn_a] + v[turn_a])
        if turn_b >= 0:
            bx, by = turned(q[turn_b], bx, by)
            half_b = 0.5 * span * v[n + turn_b]
            near_b, give_b = turn_over(2.0 * half_b)
            spin_b = (v[turn_b], v[2 * n + turn_b], v[n + turn_b] + v[turn_b])
        a0x, a0y = turned(-half_a, ax, ay)
        a1x, a1y = turned(half_a, ax, ay)
        b0x, b0y = turned(-half_b, bx, by)
        b1x, b1y = turned(half_b, bx, by)
        dx, dy = q[b] - q[a], q[b + 1] - q[a + 1]
        rx, ry = 0.5 * span * (v[n + b] - v[n + a]), 0.5 * span * (v[n + b + 1] - v[n + a + 1])
        l0x, l0y = dx - rx + b0x - a0x, dy - ry + b0y - a0y
        l1x, l1y = dx + rx + b1x - a1x, dy + ry + b1y - a1y
        start, end = math.sqrt(l0x * l0x + l0y * l0y), math.sqrt(l1x * l1x + l1y * l1y)
        if start + end == 0.0:
            continue
        share = 2.0 / (start + end)
        nx, ny = share * (dx + near_b * bx - near_a * ax), share * (dy + near_b * by - near_a * ay)
        yx = v[b] - give_b * spin_b[0] * by - v[a] + give_a * spin_a[0] * ay
        yy = v[b + 1] + give_b * spin_b[0] * bx - v[a + 1] - give_a * spin_a[0] * ax
        passes = l0x * l1x + l0y * l1y < 0.0
        if passes:
            size = math.sqrt(nx * nx + ny * ny)
            nx, ny = (nx / size, ny / size) if size > 0.0 else (0.0, 0.0)
        rate = nx * yx + ny * yy
        if not passes and start > 0.0 and end > 0.0:
            v0x, v0y = v[2 * n + b] - v[2 * n + a], v[2 * n + b + 1] - v[2 * n + a + 1]
            v1x = v[n + b] + v[b] - v[n + a] - v[a]
            v1y = v[n + b + 1] + v[b + 1] - v[n + a + 1] - v[a + 1]
            change_a, change_b = give_a * (spin_a[2] - spin_a[1]), give_b * (spin_b[2] - spin_b[1])
            along = nx * (v1x - v0x - change_b * by + change_a * ay)
            along += ny * (v1y - v0y + change_b * bx - change_a * ax)
            v0x += -spin_b[1] * b0y + spin_a[1] * a0y
            v0y += spin_b[1] * b0x - spin_a[1] * a0x
            v1x += -spin_b[2] * b1y + spin_a[2] * a1y
            v1y += spin_b[2] * b1x - spin_a[2] * a1x
            turning = along - (l1x * v1x + l1y * v1y) / end + (l0x * v0x + l0y * v0y) / start
            rate -= 0.5 * turning
        fx, fy = damping * rate * nx, damping * rate * ny
        pull_ends(force, a, turn_a, b, turn_b, fx, fy, give_a, ax, ay, give_b, bx, by)
