"""Closed forms: bodies under constant forces, linear drag, and springs to fixed points."""

import math

from physicslab.kernels import Vectors, inlined, kernel
from physicslab.kernels.forces.fall_shares import fall_shares


@inlined
def response(rate2: float, drag: float, t: float) -> tuple[float, float]:
    """Return C and S of the solution of y'' = -rate2 y - drag y'.

    y(t) = C y0 + S (y0' + drag y0 / 2) and y'(t) = C y0' - S (rate2 y0 + drag y0' / 2).
    """
    half = 0.5 * drag
    square = rate2 - half * half
    if square > 0.0:
        w = math.sqrt(square)
        decay = math.exp(-half * t)
        return decay * math.cos(w * t), decay * math.sin(w * t) / w
    s = math.sqrt(-square)
    slow, fast = math.exp(-rate2 / (s + half) * t) if s + half > 0.0 else 1.0, math.exp(-(s + half) * t)
    if s * t < 1e-3:  # the two rates meet: sinh(s t) / s by its series
        z = (s * t) * (s * t)
        decay = math.exp(-half * t)
        return decay * math.cosh(s * t), decay * t * (1.0 + z / 6.0 + z * z / 120.0)
    return 0.5 * (slow + fast), 0.5 * (slow - fast) / s


@inlined
def _along(
    x: float, v: float, rate2: float, drag: float, centre: float, acceleration: float, t: float
) -> tuple[float, float]:
    """Return place and velocity on one axis after a time t."""
    if rate2 == 0.0:
        decay, first, second = fall_shares(drag * t)
        return x + t * (v * first + acceleration * t * second), v * decay + acceleration * t * first
    cosine, sine = response(rate2, drag, t)
    y = x - centre
    moved = centre + cosine * y + sine * (v + 0.5 * drag * y)
    return moved, cosine * v - sine * (rate2 * y + 0.5 * drag * v)


@kernel
def propagate(
    position: Vectors, velocity: Vectors, direction: Vectors, rate2: Vectors, drag: Vectors,
    centre: Vectors, acceleration: Vectors, t: float,
) -> None:  # fmt: skip
    """Move bodies (n, 2) by a time t along y'' = acceleration - rate2 (y - centre) - drag y', on two axes.

    ``direction`` (n, 2) is the first axis, a unit vector; the second is at a right angle to it. ``rate2``
    [1/s^2], ``drag`` [1/s], ``centre`` [m] and ``acceleration`` [m/s^2] (n, 2) belong to the two axes; the
    acceleration counts only where rate2 is 0, for a spring's centre includes it.
    """
    for i in range(len(position)):
        c, s = direction[i, 0], direction[i, 1]
        x = c * position[i, 0] + s * position[i, 1], c * position[i, 1] - s * position[i, 0]
        v = c * velocity[i, 0] + s * velocity[i, 1], c * velocity[i, 1] - s * velocity[i, 0]
        along, along_v = _along(x[0], v[0], rate2[i, 0], drag[i, 0], centre[i, 0], acceleration[i, 0], t)
        across, across_v = _along(x[1], v[1], rate2[i, 1], drag[i, 1], centre[i, 1], acceleration[i, 1], t)
        position[i, 0], position[i, 1] = c * along - s * across, s * along + c * across
        velocity[i, 0], velocity[i, 1] = c * along_v - s * across_v, s * along_v + c * across_v
