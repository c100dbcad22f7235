"""The motion of two bodies that attract each other by the inverse square: Kepler's problem in closed form.

All of it is computed with twice the digits. Sums cancel on the way to a close passage, by as much as the
distance is larger than that of the pericentre, and the phase of many periods is a small rest of a large one.
"""

import math
from fractions import Fraction

import numpy as np

from physicslab.kernels import Numbers, Vectors, inlined, kernel
from physicslab.kernels.ode.compensated import Pair, over, plus, root, scaled, times

_MAX_ITERATIONS = 200
_CLOSE = 1e-10
"""The last correction, as a share of s and of what bends the path, whose cube no digit shows."""
_SMALL = 0.25
"""The z up to which Stumpff's functions are summed as series."""
_PAIRS, _TERMS = 7, 13
"""Terms of the series that need twice the digits, and all of them: the next is 2e-34 of the sum."""
_SERIES = np.array(
    [
        (high := float(one), float(one - Fraction(high)))
        for one in (Fraction(1, math.factorial(k)) for k in range(2, 2 * _TERMS + 2))
    ]
)
"""1/2!, 1/3!, ... as pairs."""
_TURN = 2.0 * math.pi, 2.4492935982947064e-16
"""2 pi as a pair."""


@kernel
def move_two(
    places: Vectors, rates: Vectors, weight: Numbers, constant: float, spans: Numbers, q: Vectors, v: Vectors
) -> None:
    """Move two bodies on their Kepler orbits through spans of time, each from where the last one led.

    By universal variables, for ellipses, parabolas and hyperbolas alike (Danby, Fundamentals of Celestial
    Mechanics, 1988, 6.9). Whole periods are taken off first. The error is some units of the last place of the
    remainders, times the condition of the motion.

    Parameters
    ----------
    places, rates : float64 arrays (4, 2)
        Places and velocities of both, then what rounding left out of them [m, m/s]; changed in place. They
        are more than rounding apart, and not about to meet.
    weight : float64 array (2,)
        Their masses [kg]; 0 for one that moves about a fixed one.
    constant : float
        G [m^3/(kg s^2)].
    spans : float64 array (n,)
        Times [s], not negative.
    q, v : float64 arrays (n, 4)
        Take x and y, and both rates, of the one and of the other after each.

    Examples
    --------
    A quarter of a circle about a fixed body:

    >>> places, rates = np.array([(0.0, 0), (1, 0), (0, 0), (0, 0)]), np.zeros((4, 2))
    >>> rates[1, 1], q, v = 1.0, np.zeros((1, 4)), np.zeros((1, 4))
    >>> move_two(places, rates, np.array((1.0, 0.0)), 1.0, np.array((math.pi / 2,)), q, v)
    >>> bool(abs(q - (0, 0, 0, 1)).max() < 1e-16 and abs(v - (0, 0, -1, 0)).max() < 1e-16)
    True
    """
    all_weight = plus((weight[0], 0.0), (weight[1], 0.0))
    mu = times(all_weight, (constant, 0.0))
    shares = over((weight[0], 0.0), all_weight), over((weight[1], 0.0), all_weight)
    for k in range(len(spans)):
        t = spans[k], 0.0
        moved, gained = _changes(_between(places), _between(rates), mu, t)
        for i in range(2):
            first, second = (rates[0, i], rates[2, i]), (rates[1, i], rates[3, i])
            carried = times(plus(times(shares[0], first), times(shares[1], second)), t)
            for body in range(2):
                arm = shares[0] if body else scaled(shares[1], -1.0)
                place = plus((places[body, i], places[2 + body, i]), plus(carried, times(arm, moved[i])))
                rate = plus((rates[body, i], rates[2 + body, i]), times(arm, gained[i]))
                places[body, i], places[2 + body, i] = place
                rates[body, i], rates[2 + body, i] = rate
                q[k, 2 * body + i], v[k, 2 * body + i] = place[0], rate[0]


@inlined
def _between(of: Vectors) -> tuple[Pair, Pair]:
    """Return x and y of the second less those of the first."""
    return (
        plus((of[1, 0], of[3, 0]), (-of[0, 0], -of[2, 0])),
        plus((of[1, 1], of[3, 1]), (-of[0, 1], -of[2, 1])),
    )


@inlined
def _dot(a: tuple[Pair, Pair], b: tuple[Pair, Pair]) -> Pair:
    return plus(times(a[0], b[0]), times(a[1], b[1]))


@inlined
def _changes(
    apart: tuple[Pair, Pair], rate: tuple[Pair, Pair], mu: Pair, t: Pair
) -> tuple[tuple[Pair, Pair], tuple[Pair, Pair]]:
    """Return by how much the distance vector and its rate change in a time t."""
    r, radial = root(_dot(apart, apart)), _dot(apart, rate)
    near = over(mu, r)
    alpha = plus(scaled(near, 2.0), scaled(_dot(rate, rate), -1.0))  # mu over the semi-major axis
    if alpha[0] > 0.0:
        period = times(_TURN, over(over(mu, alpha), root(alpha)))
        turns = math.floor(t[0] / period[0])
        t = plus(t, times(period, (-turns, 0.0)))
        if t[0] < 0.0:
            t = plus(t, period)
    s, low, high = t[0] / r[0], 0.0, math.inf
    if alpha[0] != 0.0:
        s = min(s, 1.0 / math.sqrt(abs(alpha[0])))
    pull = plus(mu, scaled(times(alpha, r), -1.0))
    g0, g1, g2, g3 = _functions(alpha, s)
    step = 0.0
    for _ in range(_MAX_ITERATIONS):
        distance = plus(r, plus(times(radial, g1), times(pull, g2)))[0]
        late = plus(plus(times(r, g1), times(radial, g2)), plus(times(mu, g3), scaled(t, -1.0)))[0]
        step = late / distance
        bends = (radial[0] * g0[0] + pull[0] * g1[0]) / distance * step
        step *= 1.0 + 0.5 * bends if abs(bends) < 0.5 else 1.0
        if late > 0.0:
            high = s
        else:
            low = s
        following = s - step
        if not low < following < high:
            following = 0.5 * (low + high)
        following = min(following, 2.0 * s)  # so that hyperbolic functions do not overflow
        if following == s or (abs(step) <= _CLOSE * s and abs(bends) <= _CLOSE):
            break
        s = following
        g0, g1, g2, g3 = _functions(alpha, s)
    square = 0.5 * step * step
    g3 = plus(g3, (square * g1[0] - step * g2[0], 0.0))
    g2 = plus(g2, (square * g0[0] - step * g1[0], 0.0))
    g1 = plus(g1, (-square * alpha[0] * g1[0] - step * g0[0], 0.0))
    after = plus(r, plus(times(radial, g1), times(pull, g2)))
    f, g = scaled(times(near, g2), -1.0), plus(t, scaled(times(mu, g3), -1.0))  # Gauss's f - 1, and g
    df, dg = scaled(over(times(near, g1), after), -1.0), scaled(times(over(mu, after), g2), -1.0)
    return (
        (_dot((f, g), (apart[0], rate[0])), _dot((f, g), (apart[1], rate[1]))),
        (_dot((df, dg), (apart[0], rate[0])), _dot((df, dg), (apart[1], rate[1]))),
    )


@inlined
def _functions(alpha: Pair, s: float) -> tuple[Pair, Pair, Pair, Pair]:
    """Return G0 to G3: s^k times Stumpff's c_k of alpha s^2, by series for a half, a quarter, ... of s."""
    z, share, halvings = times(times(alpha, (s, 0.0)), (s, 0.0)), 1.0, 0
    while abs(z[0]) * share * share > _SMALL:
        share, halvings = 0.5 * share, halvings + 1
    s, z = share * s, scaled(z, -share * share)
    even, odd = 0.0, 0.0
    for k in range(_TERMS - 1, _PAIRS - 1, -1):
        even, odd = _SERIES[2 * k, 0] + z[0] * even, _SERIES[2 * k + 1, 0] + z[0] * odd
    c2, c3 = (even, 0.0), (odd, 0.0)
    for k in range(_PAIRS - 1, -1, -1):
        c2 = plus((_SERIES[2 * k, 0], _SERIES[2 * k, 1]), times(z, c2))
        c3 = plus((_SERIES[2 * k + 1, 0], _SERIES[2 * k + 1, 1]), times(z, c3))
    span = s, 0.0
    g0, g1 = plus((1.0, 0.0), times(z, c2)), plus(span, times(times(z, c3), span))
    g2 = times(times(c2, span), span)
    g3 = times(times(times(c3, span), span), span)
    for _ in range(halvings):
        g3 = scaled(plus(times(span, g2), times(g0, g3)), 2.0)
        g2 = scaled(times(g1, g1), 2.0)
        g1 = scaled(times(g0, g1), 2.0)
        g0 = plus((1.0, 0.0), scaled(times(alpha, g2), -1.0))
        span = scaled(span, 2.0)
    return g0, g1, g2, g3
