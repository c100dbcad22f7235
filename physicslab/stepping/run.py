"""How long a run is: whole steps, and a shorter one that makes up the rest."""

from __future__ import annotations

import math
from dataclasses import dataclass

from physicslab.ecs.component import InvalidValue
from physicslab.ecs.config import SHORTEST
from physicslab.ecs.fields import Field
from physicslab.state.state import State

__all__ = ["RunLength", "run_length"]

_STEPS = Field("steps", "whole", minimum=0, maximum=2**53, owner="run")
_SECONDS = Field("seconds", "number", minimum=0.0, unit="s", owner="run")


@dataclass(frozen=True, slots=True)
class RunLength:
    """The steps of a run.

    Attributes
    ----------
    seconds : float
        How long it takes [s].
    dt : float
        The length of a whole step [s].
    whole : int
        How many of those there are.
    rest : float
        The length of one more, shorter or a little longer, step [s]; 0 where there is none.
    """

    seconds: float
    dt: float
    whole: int
    rest: float

    @property
    def steps(self) -> int:
        """How many steps there are in all."""
        return self.whole + 1 if self.rest else self.whole

    def elapsed(self, done: int) -> float:
        """Return the time after ``done`` steps [s]; after all of them, exactly that of the run."""
        return done * self.dt if done < self.steps else self.seconds


def run_length(state: State, seconds: float | None, steps: int | None) -> RunLength:
    """Return the length of a run of so many seconds, or of so many steps.

    Raises
    ------
    TypeError
        If both are given, or neither.
    InvalidValue
        If it is not one that can be.
    """
    if (seconds is None) == (steps is None):
        raise TypeError("give either seconds or steps")
    dt = state.simulation.dt
    if seconds is None:
        count: int = _STEPS.check(steps)
        if not math.isfinite(state.time + count * dt):
            raise InvalidValue("run", "steps", steps, f"so few that {dt!r} s each lead to a finite time")
        return RunLength(count * dt, dt, count, 0.0)
    seconds = _SECONDS.check(seconds)
    return RunLength(seconds, dt, *_whole_steps(seconds, dt))


def _whole_steps(seconds: float, dt: float) -> tuple[int, float]:
    """Divide a time into steps of ``dt``: return how many, and the length of one more that makes up the rest.

    Where the time is a multiple of ``dt`` up to rounding, there is no rest. A rest too short to be a step of
    its own is taken together with the last whole step.
    """
    if not seconds / dt < 2**53:
        raise InvalidValue("run", "seconds", seconds, f"less than 2**53 steps of dt = {dt!r} s")
    if seconds < SHORTEST:
        return 0, 0.0
    whole = round(seconds / dt)
    if whole and abs(seconds - whole * dt) <= 4.0 * math.ulp(seconds):
        return whole, 0.0
    whole = math.floor(seconds / dt)
    if whole and seconds - whole * dt < 0.001 * dt:
        whole -= 1
    return whole, seconds - whole * dt
