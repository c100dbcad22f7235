"""Energy and momentum from causes to bodies that move in closed form: integrals in closed form as well.

No power is integrated beside such a motion: what dampers and drag take is what the energy of their bodies
loses along the solution, and what is left of the angular momentum of these is that of damping. The solution
is written here once more, and not taken from where bodies have come to: an error of the kernel that moves
them (:mod:`physicslab.kernels.ode.propagate`) is no damping.
"""

import math

from physicslab.kernels import Numbers, Vectors, inlined, kernel
from physicslab.kernels.accounts import ANGULAR_MOMENTUM, ENERGY, PX, PY

GRAVITY_ROW, SPRINGS_ROW, DAMPING_ROW = range(3)
"""The rows of what is given."""
_SMALL = 0.1
"""Share of a time constant of damping below which what it leaves is summed as a series."""


@kernel
def give_in_closed_form(
    position: Vectors, velocity: Vectors, mass: Numbers, direction: Vectors, rate2: Vectors, drag: Vectors,
    centre: Vectors, acceleration: Vectors, t: float, given: Vectors,
) -> None:  # fmt: skip
    """Find what gravity, springs and damping give to bodies within a time t [s].

    Parameters
    ----------
    position, velocity : float64 arrays (n, 2)
        At the start [m, m/s].
    mass : float64 array (n,)
        Masses [kg]; zero for what nothing moves.
    direction, rate2, drag, centre, acceleration : float64 arrays (n, 2)
        As :func:`physicslab.kernels.ode.propagate.propagate` takes them.
    t : float
        How long that takes [s].
    given : float64 array (3, 4)
        Takes the energy [J], the momentum [N s] and the angular momentum about the origin [N m s] of each
        cause; gravity and springs store energy, which is not counted.
    """
    given[:] = 0.0
    is_damped, by_torques = False, 0.0
    for i in range(len(position)):
        m, c, s = mass[i], direction[i, 0], direction[i, 1]
        if m == 0.0:
            continue
        x0, x1 = c * position[i, 0] + s * position[i, 1], c * position[i, 1] - s * position[i, 0]
        v0, v1 = c * velocity[i, 0] + s * velocity[i, 1], c * velocity[i, 1] - s * velocity[i, 0]
        a0, a1 = acceleration[i, 0], acceleration[i, 1]
        k0, k1, d0, d1, o0, o1 = rate2[i, 0], rate2[i, 1], drag[i, 0], drag[i, 1], centre[i, 0], centre[i, 1]
        y0, u0, l0 = _along(x0, v0, k0, d0, o0, a0, t)
        y1, u1, l1 = _along(x1, v1, k1, d1, o1, a1, t)
        for axis in range(2):
            x, v, y, u, k, d, o, a = x0, v0, y0, u0, k0, d0, o0, a0
            if axis == 1:
                x, v, y, u, k, d, o, a = x1, v1, y1, u1, k1, d1, o1, a1
            across, along = (c, s) if axis == 0 else (-s, c)
            by_gravity, by_damping = m * a * t, -m * d * (y - x)
            by_springs = m * (u - v) - by_gravity - by_damping if k > 0.0 else 0.0
            given[GRAVITY_ROW, PX] += across * by_gravity
            given[GRAVITY_ROW, PY] += along * by_gravity
            given[SPRINGS_ROW, PX] += across * by_springs
            given[SPRINGS_ROW, PY] += along * by_springs
            given[DAMPING_ROW, PX] += across * by_damping
            given[DAMPING_ROW, PY] += along * by_damping
            if d > 0.0:
                is_damped = True
                change = 0.5 * (u - v) * (u + v) + 0.5 * k * (y - x) * (y + x - 2.0 * o)
                given[DAMPING_ROW, ENERGY] += m * (change if k > 0.0 else change - a * (y - x))
        torque = m * (l0 * a1 - l1 * a0)
        pull0 = k0 * o0 - a0 if k0 > 0.0 else 0.0  # the centre without gravity, times rate2
        pull1 = k1 * o1 - a1 if k1 > 0.0 else 0.0
        twist = m * ((k0 - k1) * x1 * l0 + pull1 * l0 - pull0 * l1)  # of springs in a line: x1 stays
        given[GRAVITY_ROW, ANGULAR_MOMENTUM] += torque
        given[SPRINGS_ROW, ANGULAR_MOMENTUM] += twist
        by_torques += m * ((y0 * u1 - y1 * u0) - (x0 * v1 - x1 * v0)) - torque - twist
    if is_damped:
        given[DAMPING_ROW, ANGULAR_MOMENTUM] = by_torques


@inlined
def _along(
    x: float, v: float, rate2: float, drag: float, centre: float, a: float, t: float
) -> tuple[float, float, float]:
    """Return place, velocity and the integral of the places after a time t of motion on one axis.

    The equation is x'' = a - rate2 (x - centre) - drag x', and its integral that of the places.
    """
    if rate2 == 0.0:
        second, third = late_shares(drag * t)
        first = 1.0 - drag * t * second
        place, speed = x + t * (v * first + a * t * second), v - drag * t * first * v + a * t * first
        return place, speed, x * t + t * t * (v * second + a * t * third)
    half = 0.5 * drag
    s = math.sqrt(abs(rate2 - half * half))
    if rate2 > half * half:
        slow = math.exp(-half * t)
        cosine, sine = slow * math.cos(s * t), slow * math.sin(s * t) / s
    else:
        slow, fast = math.exp(-rate2 / (half + s) * t), math.exp(-(half + s) * t)
        cosine, z = 0.5 * (slow + fast), (s * t) * (s * t)
        if s * t < 1e-3:  # the two rates meet: sinh(s t) / s by its series
            sine = math.exp(-half * t) * t * (1.0 + z / 6.0 + z * z / 120.0)
        else:
            sine = 0.5 * (slow - fast) / s
    apart = x - centre
    place = centre + cosine * apart + sine * (v + half * apart)
    speed = cosine * v - sine * (rate2 * apart + half * v)
    return place, speed, centre * t - ((speed - v) + drag * (place - x)) / rate2


@inlined
def late_shares(z: float) -> tuple[float, float]:
    """Return (z - 1 + e^-z) / z^2 and (z^2 / 2 - z + 1 - e^-z) / z^3 without loss for small z."""
    if z < _SMALL:
        second, third, term = 0.0, 0.0, 0.5
        for k in range(1, 14):
            second += term
            third += term / (k + 2.0)
            term *= -z / (k + 2.0)
        return second, third
    second = (1.0 + math.expm1(-z) / z) / z
    return second, (0.5 - second) / z
