"""The motion of two bodies that attract each other by the inverse square: Kepler's problem in closed form."""

import math

from physicslab.kernels import Numbers, inlined, kernel

_MAX_ITERATIONS = 100
_BY_SERIES, _TERMS = 4.0, 12
"""The z below which Stumpff's functions are summed as series, whose next term is then 1e-18 of the sum: by
sines x - sin x would lose up to two digits."""


@kernel
def kepler_change(
    apart: Numbers, rate: Numbers, mu: float, t: float, moved: Numbers, gained: Numbers
) -> None:
    """Find by how much place and velocity on a Kepler orbit change in a time t [s], which may be negative.

    By universal variables, for ellipses, parabolas and hyperbolas alike (Danby, Fundamentals of Celestial
    Mechanics, 1988, 6.9). Whole periods are taken off first.

    Parameters
    ----------
    apart, rate : float64 arrays (2,)
        Place and velocity relative to the attracting body [m, m/s].
    mu : float
        G times the mass that attracts [m^3/s^2], > 0.
    t : float
        Time from now [s].
    moved, gained : float64 arrays (2,)
        Take the changes [m, m/s]. Added to what they change they are rounded without a bias, so that errors
        of many short steps grow slowly.

    Examples
    --------
    A quarter of a circle:

    >>> import numpy as np
    >>> x, v = np.array((1.0, 0.0)), np.array((0.0, 1.0))
    >>> moved, gained = np.zeros(2), np.zeros(2)
    >>> kepler_change(x, v, 1.0, math.pi / 2, moved, gained)
    >>> bool(abs(x + moved - (0, 1)).max() < 1e-14 and abs(v + gained - (-1, 0)).max() < 1e-14)
    True
    """
    x, y, u, v = apart[0], apart[1], rate[0], rate[1]
    r = math.hypot(x, y)
    radial = x * u + y * v
    alpha = 2.0 * mu / r - (u * u + v * v)  # mu over the semi-major axis
    if alpha > 0.0:
        period = 2.0 * math.pi * mu / (alpha * math.sqrt(alpha))
        t = math.copysign(abs(t) % period, t)
        if abs(t) > 0.5 * period:
            t -= math.copysign(period, t)
    moved[:] = 0.0
    gained[:] = 0.0
    if t == 0.0:
        return
    low, high = _bracket(r, radial, mu, alpha, t)
    s = 0.5 * (low + high)
    for _ in range(_MAX_ITERATIONS):
        excess, slope = _lateness(r, radial, mu, alpha, t, s)
        if excess > 0.0:
            high = s
        else:
            low = s
        following = s - excess / slope if slope > 0.0 else low
        if not low < following < high:
            following = 0.5 * (low + high)
        if abs(following - s) <= 4e-16 * abs(s):
            break
        s = following
    g1, g2, g3 = _functions(alpha, s)
    distance = r + radial * g1 + (mu - alpha * r) * g2
    f, g = -mu * g2 / r, t - mu * g3  # Gauss's f - 1, and g
    df, dg = -mu * g1 / (r * distance), -mu * g2 / distance
    moved[0], moved[1] = f * x + g * u, f * y + g * v
    gained[0], gained[1] = df * x + dg * u, df * y + dg * v


@inlined
def _lateness(r: float, radial: float, mu: float, alpha: float, t: float, s: float) -> tuple[float, float]:
    """Return by how much later than t the universal variable s is, and how fast that changes."""
    g1, g2, g3 = _functions(alpha, s)
    return r * g1 + radial * g2 + mu * g3 - t, r + radial * g1 + (mu - alpha * r) * g2


@inlined
def _bracket(r: float, radial: float, mu: float, alpha: float, t: float) -> tuple[float, float]:
    """Return two values of s between which the time is t, the lower one first."""
    step = abs(t) / r
    if alpha != 0.0:
        step = min(step, 1.0 / math.sqrt(abs(alpha)))  # hyperbolic functions must not overflow
    step = math.copysign(max(step, 1e-300), t)
    while _lateness(r, radial, mu, alpha, t, step)[0] * step < 0.0:
        step *= 2.0
    return (0.0, step) if step > 0.0 else (step, 0.0)


@inlined
def _functions(alpha: float, s: float) -> tuple[float, float, float]:
    """Return G1, G2 and G3: s^k times Stumpff's c_k of alpha s^2."""
    z = alpha * s * s
    if abs(z) < _BY_SERIES:
        c2, c3, term = 0.0, 0.0, 0.5
        for k in range(1, _TERMS + 1):
            c2 += term
            c3 += term / (2 * k + 1)
            term *= -z / ((2 * k + 1) * (2 * k + 2))
        return s * (1.0 - z * c3), s * s * c2, s * s * s * c3
    root = math.sqrt(abs(alpha))
    x = root * s
    if alpha > 0.0:
        half = math.sin(0.5 * x)
        return math.sin(x) / root, 2.0 * half * half / alpha, (x - math.sin(x)) / (alpha * root)
    half = math.sinh(0.5 * x)
    return math.sinh(x) / root, -2.0 * half * half / alpha, (math.sinh(x) - x) / (-alpha * root)
