"""How soon bodies of different islands may meet."""

import math

from physicslab.kernels import Numbers, Rows, Vectors, inlined, kernel
from physicslab.kernels.disjoint_sets import join_sets, root_of
from physicslab.kernels.length import length_of

_SAFETY = 2.0
"""Factor by which bodies may become faster while no meeting is looked for."""
_MAX_STEPS = 128
"""Largest number of steps before it is looked for again."""


@kernel
def steps_apart(
    first: Rows, position: Vectors, radius: Numbers, speed: Numbers, fastest: Numbers,
    gravity: float, soon: float, h: float, labels: Rows,
) -> int:  # fmt: skip
    """Return how many steps it is certain that no body comes near one of another island, 1 at least.

    Islands with bodies that may meet soon get one label; whether two do depends on these alone.

    Parameters
    ----------
    first : int64 array (n + 1,)
        Where the bodies of each island begin, and their number.
    position, radius, speed : float64 arrays (m, 2), (m,), (m,)
        Centres of bodies [m], radii of the circles around them [m], and how fast these move [m/s].
    fastest : float64 array (n,)
        The highest speed that the bodies of each island may soon have [m/s], gravity left out.
    gravity : float
        By which they are accelerated [m/s^2].
    soon, h : float
        The time within which a meeting is soon [s], and the length of steps [s].
    labels : int64 array (n,)
        Numbers from 0 on; set to the smallest number of those that are near.
    """
    n, least, fall = len(fastest), _MAX_STEPS, gravity * soon * soon
    for one in range(n):
        left, right, bottom, top = _box(first[one], first[one + 1], position, radius)
        for other in range(one + 1, n):
            together, nearest = fastest[one] + fastest[other], math.inf
            enough = _reach(least, together, gravity, soon, h)
            for j in range(first[other], first[other + 1]):
                x, y, r = position[j, 0], position[j, 1], radius[j]
                if max(left - x, x - right, bottom - y, y - top) - r > enough:
                    continue
                for i in range(first[one], first[one + 1]):
                    dx, dy, both = abs(x - position[i, 0]), abs(y - position[i, 1]), radius[i] + r
                    if max(dx, dy) - both > enough:
                        continue
                    gap = length_of(dx, dy) - both
                    nearest = min(nearest, gap)
                    if gap <= (speed[i] + speed[j]) * soon + fall:
                        join_sets(labels, one, other)
            while least > 1 and nearest <= _reach(least, together, gravity, soon, h):
                least //= 2
    for one in range(n):
        labels[one] = root_of(labels, one)
    return least


@inlined
def _box(begin: int, end: int, position: Vectors, radius: Numbers) -> tuple[float, float, float, float]:
    """Return left, right, bottom and top of some bodies."""
    left, right, bottom, top = math.inf, -math.inf, math.inf, -math.inf
    for i in range(begin, end):
        left, right = min(left, position[i, 0] - radius[i]), max(right, position[i, 0] + radius[i])
        bottom, top = min(bottom, position[i, 1] - radius[i]), max(top, position[i, 1] + radius[i])
    return left, right, bottom, top


@inlined
def _reach(steps: int, fastest: float, gravity: float, soon: float, h: float) -> float:
    """Return how far apart bodies are at least [m] that come near in no fewer than so many steps."""
    span = steps * h
    return _SAFETY * (fastest + 2.0 * gravity * span) * (span + soon) + gravity * soon * soon
