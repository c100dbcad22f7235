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
    early, late, under, over = 0.0, h, None, load - 1.0
    for trial in range(_TRIALS):
        if late - early <= _LOCATED * h or over <= _LOCATED:
            break
        middle = 0.5 * (early + late)
        if under is not None and trial % 3:
            middle = early + (late - early) * under / (under - over)
            if over < -under:
                middle += _LOCATED * h  # to just beyond, from both sides
        middle = min(max(middle, early + 0.25 * _LOCATED * h), late - 0.25 * _LOCATED * h)
        beyond = load_after(middle) - 1.0
        if beyond > 0.0:
            late, over = middle, beyond
        else:
            early, under = middle, beyond
    return late
