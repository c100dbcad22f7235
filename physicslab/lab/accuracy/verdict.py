"""Verdicts on errors, and the order with which errors fall."""

import math
import statistics
from collections.abc import Sequence
from itertools import pairwise

from physicslab.lab.case import Verdict

_LARGE, _ROUNDING = 0.1, 1e-13
"""Errors between which an order can be seen."""
_CLEAN = 1e-12
"""An error below which rounding may be all of it."""
_REACHED, _EVEN = 0.9, 0.25
"""Share of its order that a method must show, and by which it may differ from step to step."""
_ROUNDING_FACTOR = 30.0
"""An error of up to so many times the effect of one rounding at the start is put down to rounding."""


def verdict(
    error: float | None, good: float, excellent: float, *, floor: float | None = None, chaotic: bool = False
) -> Verdict:
    """Return the verdict on an error.

    Parameters
    ----------
    error : float, optional
        ``None`` where the run failed.
    good, excellent : float
        The largest error with that verdict.
    floor : float, optional
        How far apart two runs end whose starts differ by one rounding.
    chaotic : bool
        Whether the motion makes each rounding grow exponentially.

    Examples
    --------
    >>> str(verdict(1e-7, 1e-6, 1e-9))
    'good'
    >>> str(verdict(1e-7, 1e-8, 1e-9, floor=2e-8, chaotic=True))
    'chaos limit'
    """
    if error is None:
        return Verdict.FAILED
    if error <= excellent:
        return Verdict.EXCELLENT
    if floor is not None and error <= _ROUNDING_FACTOR * floor:
        return Verdict.CHAOS if chaotic else Verdict.ROUNDING
    return Verdict.GOOD if error <= good else Verdict.SHORT


def measured_order(
    efforts: Sequence[float], errors: Sequence[float | None], *, even: bool = True
) -> float | None:
    """Return the power of the effort with which errors fall; ``None`` where they do not.

    Errors count from where all finer ones are below a tenth, as a small one before that is chance, down to
    where rounding begins to show: a hundred times the smallest error below 1e-6 that the next finer rung does
    not halve.

    Parameters
    ----------
    efforts : sequence of floats
        Steps, or force evaluations, from coarse to fine.
    even : bool
        Whether efforts grow evenly: the order is then the slope between the two finest rungs. Otherwise, as
        with adaptive methods, a straight line is fitted to all rungs.

    Examples
    --------
    >>> measured_order([10, 20, 40], [1e-4, 2.5e-5, 6.25e-6])
    2.0
    """
    clear = _clear_pairs(efforts, errors)
    if not clear:
        return None
    if even:
        return _slope(*clear[-1])
    used = dict(rung for pair in clear for rung in pair)
    return -statistics.linear_regression(
        [math.log(n) for n in used], [math.log(error) for error in used.values()]
    ).slope


type _Rung = tuple[float, float]


def _clear_pairs(efforts: Sequence[float], errors: Sequence[float | None]) -> list[tuple[_Rung, _Rung]]:
    """Return the pairs of a rung and the next finer one whose errors count."""
    rungs = [(n, e) for n, e in zip(efforts, errors, strict=True) if e is not None and e > 0.0]
    coarse = max((k for k, (_, error) in enumerate(rungs) if not error < _LARGE), default=-1)
    pairs = list(pairwise(rungs))
    stalled = [late for (_, early), (_, late) in pairs if 0.5 * early < late < 1e-6]
    floor = max(100.0 * min(stalled, default=0.0), _ROUNDING)
    return [
        ((n, early), (m, late)) for (n, early), (m, late) in pairs[coarse + 1 :] if m > n and late > floor
    ]


def _slope(coarse: _Rung, fine: _Rung) -> float:
    return math.log(coarse[1] / fine[1]) / math.log(fine[0] / coarse[0])


def why_order_short(
    stated: float, efforts: Sequence[float], errors: Sequence[float | None], rates: Sequence[float | None],
    limit: float, *, even: bool, exception: str = "",
) -> str:  # fmt: skip
    """Return why a ladder does not show the order that a method states; empty where it does.

    Parameters
    ----------
    stated, limit : float
        The order, and the largest omega h at which the method is stable.
    efforts, errors, even
        As for :func:`measured_order`.
    rates : sequence of floats
        Products omega h of the rungs; ``None`` where that is not known.
    exception : str
        Why the order does not hold for such forces.

    Examples
    --------
    >>> why_order_short(2, [10, 20], [1e-3, 5e-4], [0.2, 0.1], 2.0, even=True, exception="bodies touch")
    'bodies touch'
    >>> why_order_short(1, [10, 20, 40], [None, 1e9, 3e-2], [4.2, 2.1, 1.05], 2.0, even=True)
    'all steps but the finest are beyond the limit of stability, omega h = 2'
    """
    order = measured_order(efforts, errors, even=even)
    if order is not None and order >= _REACHED * stated:
        return ""
    found = [error for error in errors if error is not None]
    if found and max(found) <= _CLEAN:
        return f"all errors are rounding: {max(found):.1e} at most"
    if exception:
        return exception
    beyond = [error is None or (rate or 0.0) > limit for error, rate in zip(errors, rates, strict=True)]
    if sum(beyond) >= len(errors) - 1:
        steps = "all steps" if all(beyond) else "all steps but the finest"
        return f"{steps} are beyond the limit of stability, omega h = {limit:.3g}"
    clear = _clear_pairs(efforts, errors)
    if not clear:
        finest = next(error for error in reversed(errors) if error is not None)
        if finest >= _LARGE:
            return f"no step is short enough: the error of the finest is {finest:.1e}"
        return f"fewer than two errors are between {_LARGE:g} and rounding"
    slopes = [_slope(*pair) for pair in clear]
    if not even:
        (fewest, _), (most, _) = clear[0][0], clear[-1][1]
        return (
            f"the tolerance sets the error, and from {fewest:.0f} to {most:.0f} evaluations it is not yet in "
            f"proportion: {min(slopes):.1f} to {max(slopes):.1f} from one to the next"
        )
    if len(slopes) == 1 or max(slopes) - min(slopes) > _EVEN * stated:
        words = ", ".join(f"{slope:.1f}" for slope in slopes)
        return f"errors do not fall evenly: the order from step to step is {words}"
    return f"errors fall evenly with the order {order:.1f}: the forces are not smooth enough for {stated:g}"
