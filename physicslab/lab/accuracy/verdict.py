"""Verdicts on errors, and the order with which errors fall."""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence
from enum import StrEnum
from itertools import pairwise

__all__ = ["Verdict", "measured_order", "verdict"]


class Verdict(StrEnum):
    """How good an error is."""

    EXCELLENT = "excellent"
    GOOD = "good"
    SHORT = "falls short"
    ROUNDING = "rounding floor"
    CHAOS = "chaos limit"
    FAILED = "failed"


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

    Errors count from a tenth down to where rounding begins to show: a hundred times the smallest error below
    1e-6 that the next finer rung does not halve.

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
    rungs = [(n, e) for n, e in zip(efforts, errors, strict=True) if e is not None and e > 0.0]
    pairs = list(pairwise(rungs))
    stalled = [late for (_, early), (_, late) in pairs if 0.5 * early < late < 1e-6]
    floor = max(100.0 * min(stalled, default=0.0), 1e-13)
    clear = [
        ((n, early), (m, late)) for (n, early), (m, late) in pairs if m > n and late > floor and early < 0.1
    ]
    if not clear:
        return None
    if even:
        (n, early), (m, late) = clear[-1]
        return math.log(early / late) / math.log(m / n)
    used = dict(rung for pair in clear for rung in pair)
    return -statistics.linear_regression(
        [math.log(n) for n in used], [math.log(error) for error in used.values()]
    ).slope
