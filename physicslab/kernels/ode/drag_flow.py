"""The flow of drag and uniform gravity beside contacts, each body by itself."""

import math

from physicslab.kernels import Numbers, Rows, Vectors, always_inlined, inlined
from physicslab.kernels.accounts import DAMPING, GRAVITY, book
from physicslab.kernels.arguments import Motion

_FOLLOWED = 0.05
"""Largest rate times step of what drag alone slows: a step is then right to 3e-9."""
_EQUAL, _MOST = 1_250, 1e15
"""Number of steps that are equally long: where there would be more, each goes by the speed, which decreases.
Then the largest number that is reckoned with."""


@always_inlined
def _slowed(x: float, y: float, linear: float, quadratic: float) -> float:
    """Return the share of its velocity that drag takes from a body in a second."""
    return linear + quadratic * math.sqrt(x * x + y * y) if quadratic > 0.0 else linear


@inlined
def fall_in_drag(
    motion: Motion, rows: Rows, drag: Numbers, gx: float, gy: float, span: float, account: Vectors
) -> None:
    """Move bodies that only drag and gravity act on, by steps of order 4, as many as each needs.

    ``drag`` (3 d,) has of each drag by speed and by its square, of its mass, and the mass. What drag takes is
    integrated beside the motion, by the same method.
    """
    n, sixth = len(rows), 1.0 / 6.0
    taken, px, py, turned, fallen, weight = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(n):
        row, linear, quadratic, mass = rows[i], drag[i], drag[n + i], drag[2 * n + i]
        x, y = motion.position[row, 0], motion.position[row, 1]
        vx, vy = motion.linear[row, 0], motion.linear[row, 1]
        left = span
        while left > 0.0:
            slows = _slowed(vx, vy, linear, 2.0 * quadratic)
            steps = 1 + int(min(slows * left / _FOLLOWED, _MOST))
            h, brakes = left / steps, steps > _EQUAL
            for _ in range(1 if brakes else steps):
                to_x, to_y, to_vx, to_vy = 0.0, 0.0, 0.0, 0.0
                at_x, at_y, ux, uy = x, y, vx, vy
                for stage in range(4):
                    share = sixth * h if stage == 0 or stage == 3 else 2.0 * sixth * h
                    slowed = _slowed(ux, uy, linear, quadratic)
                    fx, fy = -slowed * ux, -slowed * uy
                    taken -= share * mass * (fx * ux + fy * uy)
                    px += share * mass * fx
                    py += share * mass * fy
                    turned += share * mass * (at_x * fy - at_y * fx)
                    to_x += share * ux
                    to_y += share * uy
                    to_vx += share * (gx + fx)
                    to_vy += share * (gy + fy)
                    ahead = h if stage == 2 else 0.5 * h
                    at_x, at_y = x + ahead * ux, y + ahead * uy
                    ux, uy = vx + ahead * (gx + fx), vy + ahead * (gy + fy)
                mean_x = h * (x + 0.5 * to_x) - h * h / 12.0 * to_vx
                mean_y = h * (y + 0.5 * to_y) - h * h / 12.0 * to_vy
                fallen += mass * (mean_x * gy - mean_y * gx)
                x, y, vx, vy = x + to_x, y + to_y, vx + to_vx, vy + to_vy
            left = left - h if brakes else 0.0
        weight += mass
        motion.position[row, 0], motion.position[row, 1] = x, y
        motion.linear[row, 0], motion.linear[row, 1] = vx, vy
        motion.angle[row] += span * motion.angular[row]
    book(account[DAMPING], 0, -taken, px, py, turned)
    book(account[GRAVITY], 0, 0.0, weight * gx * span, weight * gy * span, fallen)
