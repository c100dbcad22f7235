"""The flow of drag and uniform gravity beside contacts, eight bodies at a time, each by itself."""

from physicslab.kernels import Numbers, Rows, Vectors, always_inlined, inlined
from physicslab.kernels.accounts import DAMPING, GRAVITY, book
from physicslab.kernels.arguments import Motion
from physicslab.kernels.float64x8 import (
    Wide,
    choose,
    everywhere,
    mask_bits,
    put_numbers,
    put_vectors,
    root,
    sum_of,
    take,
    take_numbers,
    take_vectors,
)
from physicslab.kernels.wide_layout import WIDE

_FOLLOWED = 0.05
"""Largest rate times step of what drag alone slows: a step is then right to 3e-9."""
_EQUAL, _MOST = 32, 2**50
"""Number of steps that are equally long: where there would be more, each goes by the speed, which decreases.
Then the largest number that is reckoned with. A number is a power of two."""
_STEADY = 2.0**-92
"""Share of the square of what gravity adds to a velocity below which that of its change is rounding: drag
holds all of it, at the terminal velocity."""


@always_inlined
def _slowed(x: Wide, y: Wide, linear: Wide, quadratic: Wide) -> Wide:
    """Return the share of its velocity that drag takes from a body in a second."""
    return linear + quadratic * root(x * x + y * y)


@inlined
def fall_in_drag(
    motion: Motion, rows: Rows, drag: Numbers, gx: float, gy: float, span: float, account: Vectors
) -> None:
    """Move bodies that only drag and gravity act on, by steps of order 4, as many as eight of them need.

    ``drag`` (3 d,) has of each drag by speed and by its square, of its mass, and the mass; where that is 0
    the row is the world's, which fills the last eight. What drag takes is integrated beside the motion, by
    the same method. What has come to its terminal velocity goes on with it, in a step of any length.
    """
    n, sixth, weight = len(rows), 1.0 / 6.0, everywhere(0.0)
    taken, px, py, turned, fallen = weight, weight, weight, weight, weight
    for at in range(0, n, WIDE):
        linear, quadratic, mass = take(drag, at), take(drag, n + at), take(drag, 2 * n + at)
        fall_x, fall_y = choose(mass > 0.0, gx, 0.0), choose(mass > 0.0, gy, 0.0)
        x, y = take_vectors(motion.position, rows, at)
        vx, vy = take_vectors(motion.linear, rows, at)
        left, changes = span, everywhere(1.0)
        while left > 0.0:
            rate, steps = changes * _slowed(vx, vy, linear, 2.0 * quadratic), 1
            while steps < _MOST and mask_bits(rate * left > _FOLLOWED * steps) != 0:
                steps *= 2
            h, brakes = left / steps, steps > _EQUAL
            for _ in range(1 if brakes else steps):
                to_x, to_y, to_vx, to_vy = 0.0 * x, 0.0 * x, 0.0 * x, 0.0 * x
                at_x, at_y, ux, uy = x, y, vx, vy
                for stage in range(4):
                    share = sixth * h if stage == 0 or stage == 3 else 2.0 * sixth * h
                    slowed = _slowed(ux, uy, linear, quadratic)
                    fx, fy, part = -slowed * ux, -slowed * uy, share * mass
                    taken = taken - part * (fx * ux + fy * uy)
                    px, py = px + part * fx, py + part * fy
                    turned = turned + part * (at_x * fy - at_y * fx)
                    ax, ay = changes * (fall_x + fx), changes * (fall_y + fy)
                    to_x, to_y = to_x + share * ux, to_y + share * uy
                    to_vx, to_vy = to_vx + share * ax, to_vy + share * ay
                    ahead = h if stage == 2 else 0.5 * h
                    at_x, at_y = x + ahead * ux, y + ahead * uy
                    ux, uy = vx + ahead * ax, vy + ahead * ay
                mean_x = h * (x + 0.5 * to_x) - h * h / 12.0 * to_vx
                mean_y = h * (y + 0.5 * to_y) - h * h / 12.0 * to_vy
                fallen = fallen + mass * (mean_x * gy - mean_y * gx)
                x, y, vx, vy = x + to_x, y + to_y, vx + to_vx, vy + to_vy
            falls = h * h * (fall_x * fall_x + fall_y * fall_y)
            is_steady = to_vx * to_vx + to_vy * to_vy < _STEADY * falls
            changes = choose(is_steady, 0.0, changes)
            left = left - h if brakes else 0.0
        weight = weight + mass
        put_vectors(motion.position, rows, at, x, y)
        put_vectors(motion.linear, rows, at, vx, vy)
        turns = take_numbers(motion.angular, rows, at)
        put_numbers(motion.angle, rows, at, take_numbers(motion.angle, rows, at) + span * turns)
    book(account[DAMPING], 0, -sum_of(taken), sum_of(px), sum_of(py), sum_of(turned))
    falls = span * sum_of(weight)
    book(account[GRAVITY], 0, 0.0, falls * gx, falls * gy, sum_of(fallen))
