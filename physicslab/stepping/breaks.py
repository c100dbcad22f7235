"""When a joint breaks within a step: the moment at which its load reaches what it bears."""

from collections.abc import Callable

_LOCATED = 1e-11
"""Share of a step to which the moment is located, and of a load that is treated as reached."""
_TRIALS = 100
"""Largest number of trials to locate it; every third halves the time that is left."""


class Overloaded(Exception):
    """A step ends with a load on a joint beyond what it bears; the world is as before that step.

    Attributes
    ----------
    load : float
        The largest load of any joint, as a share of what that bears.
    """

    def __init__(self, load: float) -> None:
        super().__init__(load)
        self.load = load


def time_of_break(load_after: Callable[[float], float], h: float, load: float) -> float:
    """Return after which part of ``h`` [s] a ``load`` first found at its end reaches 1, and just exceeds it.

    ``load_after`` tells the load after a time [s]; where it jumps, as in an impact, that is the time of the
    jump. Nothing is known of the load at the beginning: halves lead there if it was too large before.
    """
    return first_time(lambda t: load_after(t) - 1.0, h, load - 1.0, None, _LOCATED, _LOCATED)


def first_time(
    after: Callable[[float], float], h: float, over: float, under: float | None, share: float, close: float
) -> float:
    """Return when within ``h`` seconds a quantity becomes positive, to just beyond that.

    Parameters
    ----------
    after : callable
        Returns the quantity after a time [s].
    over, under : float, float or None
        It at the end, and at the beginning, if that is known.
    share, close : float
        Share of ``h`` to which the time is found, and the value that is treated as zero.
    """
    early, late = 0.0, h
    for trial in range(_TRIALS):
        if late - early <= share * h or 0.0 <= over <= close:
            break
        middle = 0.5 * (early + late)
        if under is not None and trial % 3:
            middle = early + (late - early) * under / (under - over)
            if over < -under:
                middle += share * h  # to just beyond, from both sides
        middle = min(max(middle, early + 0.25 * share * h), late - 0.25 * share * h)
        beyond = after(middle)
        if beyond > 0.0:
            late, over = middle, beyond
        else:
            early, under = middle, beyond
    return late
