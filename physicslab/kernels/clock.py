"""The clock: after n steps of dt it shows n dt, whether they were made one by one or all at once."""

from physicslab.kernels import inlined

_ROUNDING = 1e-15
"""Share of a time by which it may be off a multiple of the step and still count as that."""
_TO_WHOLE = 1.5 * 2.0**52
"""A number that, added and subtracted, rounds others to whole ones."""


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
    for left in range(steps, 0, -1):
        begin, made = step_grid.py_func(time + dt, dt)  # type: ignore[attr-defined]
        if not begin:
            return float((made + (left - 1)) * dt)
        time = begin
    return time
