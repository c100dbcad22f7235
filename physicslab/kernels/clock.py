"""The clock: after n steps of dt it shows n dt, whether they were made one by one or all at once."""

import numpy as np

from physicslab.kernels import inlined

_ROUNDING = 1e-15
"""Share of a time by which it may be off a multiple of the step and still count as that."""
_TO_WHOLE = 1.5 * 2.0**52
"""A number that, added and subtracted, rounds others to whole ones."""
_AT_ONCE = 4096
"""How many times are looked at together."""


@inlined
def step_grid(time: float, dt: float) -> tuple[float, float]:
    """Return where a grid of ``dt`` seconds begins [s] and how many steps of it a time is from there.

    It begins at 0 where the time is a multiple of ``dt`` up to rounding, else at that time.
    """
    steps = (time / dt + _TO_WHOLE) - _TO_WHOLE
    return (0.0, steps) if abs(steps * dt - time) <= _ROUNDING * abs(time) else (time, 0.0)


@inlined
def next_time(time: float, dt: float) -> float:
    """Return the time a step of ``dt`` seconds after another one [s]."""
    begin, steps = step_grid(time + dt, dt)
    return begin + steps * dt


def time_after(time: float, dt: float, steps: int = 1) -> float:
    """Return the time after ``steps`` steps of ``dt`` seconds: that of so many calls of :func:`next_time`."""
    if steps == 0:
        return time
    begin, made = step_grid.py_func(time + dt, dt)  # type: ignore[attr-defined]
    return float((made + (steps - 1)) * dt) if not begin else _after_many(begin, dt, steps - 1)


def _after_many(time: float, dt: float, steps: int) -> float:
    """Return the same for a time that is not on the grid: many sums at once, until one of them is."""
    while steps:
        sums = np.full(min(steps, _AT_ONCE) + 1, dt)
        sums[0] = time
        sums = np.add.accumulate(sums)[1:]  # one after the other
        made = (sums / dt + _TO_WHOLE) - _TO_WHOLE
        found = np.flatnonzero(np.abs(made * dt - sums) <= _ROUNDING * np.abs(sums))
        if len(found):
            return float((made[found[0]] + (steps - 1 - found[0])) * dt)
        time, steps = float(sums[-1]), steps - len(sums)
    return time
