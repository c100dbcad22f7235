"""When a joint breaks within a step: the moment at which its load reaches what it bears."""

import math
from collections.abc import Callable

_LOCATED = 1e-11
"""Share of a step to which the moment is located, and of a load that is treated as reached."""
_TRIALS = 100
"""Largest number of trials to locate it."""


class Overloaded(Exception):
    """A step ends with a load on a joint beyond what it bears; the world is as before that step.

    Attributes
    ----------
    steps : int
        The number of that step among those of the call.
    load : float
        The largest load of any joint, as a share of what that bears; infinite where it was not found.
    """

    def __init__(self, steps: int, load: float = math.inf) -> None:
        super().__init__(steps, load)
        self.steps, self.load = steps, load


def time_of_break(attempt: Callable[[float, int, float], int], h: float, load: float) -> float:
    """Return after which part of ``h`` [s] a ``load`` first found at its end reaches 1, and just exceeds it.

    ``attempt`` makes steps of a length [s], unless a load is then beyond a limit, which it raises. Where the
    load jumps, as in an impact, that is the time of the jump. Nothing is known of the load at the beginning:
    halves lead there if it was too large before.
    """

    def excess_after(t: float) -> float:
        try:
            attempt(t, 1, -math.inf)
        except Overloaded as found:
            return found.load - 1.0
        return -1.0

    return first_time(excess_after, h, load - 1.0, None, _LOCATED, _LOCATED)


def first_time(
    after: Callable[[float], float], h: float, over: float, under: float | None, share: float, close: float
) -> float:
    """Return when within ``h`` seconds a quantity becomes positive, to just beyond that.

    By Chandrupatla's method (Adv. Eng. Softw. 28 (1997) 145): inverse quadratic where that converges, halves
    elsewhere, as at a jump.

    Parameters
    ----------
    after : callable
        Returns the quantity after a time [s].
    over, under : float, float or None
        It at the end, and at the beginning, if that is known.
    share, close : float
        Share of ``h`` to which the time is found, and the value that is treated as zero.
    """
    late: tuple[float, float] = (h, over)
    early: tuple[float, float | None] = (0.0, under)
    newest, opposite = late, early
    t = 0.5 if under is None else over / (over - under)
    for _ in range(_TRIALS):
        least = share * h / max(late[0] - early[0], share * h)
        if least >= 1.0 or 0.0 <= late[1] <= close:
            break
        t = min(max(t, 0.5 * least), 1.0 - 0.5 * least)
        middle = newest[0] + t * (opposite[0] - newest[0])
        found = middle, after(middle)
        same = (found[1] > 0.0) == (newest[1] > 0.0)
        third: tuple[float, float | None] = newest if same else opposite
        opposite = opposite if same else newest
        late, early = (found, early) if found[1] > 0.0 else (late, found)
        newest = found
        t = _inverse_quadratic(newest, opposite, third)
    return late[0]


def _inverse_quadratic(
    newest: tuple[float, float], opposite: tuple[float, float | None], third: tuple[float, float | None]
) -> float:
    """Return where between two points with values of opposite signs zero is; 0.5 where that is not known."""
    (a, fa), (b, fb), (c, fc) = newest, opposite, third
    if fb is None or fc is None or fc in (fa, fb) or c in (a, b):
        return 0.5 if fb is None else fa / (fa - fb)
    xi, phi = (a - b) / (c - b), (fa - fb) / (fc - fb)
    if not (phi * phi < xi and (1.0 - phi) ** 2 < 1.0 - xi):
        return 0.5
    return fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
