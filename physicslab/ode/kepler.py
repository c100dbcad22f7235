"""The motion of two bodies that attract each other by the inverse square: Kepler's problem."""

import math

import numpy as np
from numpy.typing import NDArray

_MAX_ITERATIONS = 100


def propagate_kepler(
    position: NDArray[np.float64], velocity: NDArray[np.float64], mu: float, t: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return where a body on a Kepler orbit is a time t [s] later, and its velocity.

    Parameters
    ----------
    position, velocity : float64 arrays (2,)
        Relative to the attracting body [m, m/s].
    mu : float
        G times the mass that attracts [m^3/s^2], > 0.
    t : float
        Time from now [s]; may be negative.

    Notes
    -----
    By universal variables, for ellipses, parabolas and hyperbolas alike (Danby, Fundamentals of Celestial
    Mechanics, 1988, 6.9). Whole periods are taken off first.

    Examples
    --------
    A quarter of a circle:

    >>> x, v = propagate_kepler(np.array((1.0, 0.0)), np.array((0.0, 1.0)), 1.0, math.pi / 2)
    >>> bool(abs(x - (0, 1)).max() < 1e-14 and abs(v - (-1, 0)).max() < 1e-14)
    True
    """
    r = math.hypot(*position)
    radial = float(position @ velocity)
    alpha = 2.0 * mu / r - float(velocity @ velocity)  # mu over the semi-major axis
    if alpha > 0.0:
        period = 2.0 * math.pi * mu / alpha**1.5
        t = math.remainder(t, period)

    def late(s: float) -> tuple[float, float, tuple[float, float, float]]:
        """Return by how much s is later than t, how fast that changes, and the functions at s."""
        g1, g2, g3 = _functions(alpha, s)
        return r * g1 + radial * g2 + mu * g3 - t, r + radial * g1 + (mu - alpha * r) * g2, (g1, g2, g3)

    low, high = _bracket(late, t, r)
    s = 0.5 * (low + high)
    for _ in range(_MAX_ITERATIONS):
        excess, slope, _ = late(s)
        low, high = (low, s) if excess > 0.0 else (s, high)
        following = s - excess / slope if slope > 0.0 else math.nan
        if not low < following < high:
            following = 0.5 * (low + high)
        if abs(following - s) <= 2.0 * math.ulp(max(abs(s), 1e-300)):
            break
        s = following
    _, distance, (g1, g2, g3) = late(s)
    f, g = 1.0 - mu * g2 / r, t - mu * g3
    df, dg = -mu * g1 / (r * distance), 1.0 - mu * g2 / distance
    return f * position + g * velocity, df * position + dg * velocity


def _bracket(late: object, t: float, r: float) -> tuple[float, float]:
    """Return two values of s between which the time is t."""
    assert callable(late)
    step = math.copysign(max(abs(t), 1e-300) / r, t)
    while late(step)[0] * step < 0.0:
        step *= 2.0
    return (0.0, step) if step > 0.0 else (step, 0.0)


def _functions(alpha: float, s: float) -> tuple[float, float, float]:
    """Return G1, G2 and G3: s^k times Stumpff's c_k of alpha s^2."""
    z = alpha * s * s
    if abs(z) < 0.1:
        c2 = c3 = term = 0.0
        term = 1.0
        for k in range(1, 12):
            c2 += term / math.factorial(2 * k) * (1.0 if k % 2 else -1.0)
            c3 += term / math.factorial(2 * k + 1) * (1.0 if k % 2 else -1.0)
            term *= z
        return s * (1.0 - z * c3), s * s * c2, s**3 * c3
    root = math.sqrt(abs(alpha))
    x = root * s
    if alpha > 0.0:
        return math.sin(x) / root, (1.0 - math.cos(x)) / alpha, (x - math.sin(x)) / (alpha * root)
    return math.sinh(x) / root, (1.0 - math.cosh(x)) / alpha, (math.sinh(x) - x) / (-alpha * root)
