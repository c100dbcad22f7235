"""Steppers: ways to advance a state."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

from physicslab.ecs.fields import InvalidValue
from physicslab.state.state import State
from physicslab.stepping.plan import StepPlan
from physicslab.systems.schedule import Schedule

_MAX_DIVISIONS = 100_000
"""Largest number of parts of a step that is longer than the scene's own."""
_TOLERATED = 0.01
"""Share by which an undivided step may exceed the scene's own: the last of a run may include a remainder."""


MAX_FALL = 0.08
"""Largest share of the smallest size by which gravity adds to the way of a substep of soft contacts. Bodies
sink in proportion to it: at 0.085 ten rods on each other by 0.45 of a thickness, at 0.02 by 0.11."""
MAX_FACTOR = 256
"""Largest factor by which substeps are increased for that."""


@dataclass(frozen=True, slots=True)
class Advance:
    """Report of a stepper on an advance.

    Attributes
    ----------
    steps, divisions : int
        Whole steps, and into how many parts each was divided.
    begun : float
        If none: how much of the step [s] it has made, the rest of which is the next stepper's.
    """

    steps: int
    divisions: int = 1
    begun: float = 0.0


class Advancer(Protocol):
    """A way to advance a state.

    Attributes
    ----------
    name, title : str
        For reports (``run --json``), and for people (the HUD).
    reason : str
        The reason for it, for people.
    kernels : tuple of kernels
        Kernels that it calls; compiled before it first advances, and not before.
    leaps : bool
        Whether several steps are one advance, made as a whole or not at all.
    divisible : bool
        Whether several steps have the same bits as one by one.
    keeps_balance : bool
        Whether it measures energy and momentum before its steps and after them.
    leaves_forces : bool
        Whether ``bodies.force`` holds the forces after a step.
    samples : bool
        Whether it takes those of ``state.samples`` that are due within its steps.
    yields : bool
        Whether its calls end where a better stepper may make the next step.
    """

    name: str
    title: str
    keeps_balance: bool
    leaves_forces: bool
    samples: bool
    yields: bool

    @property
    def reason(self) -> str:
        """Return the reason for it."""

    @property
    def leaps(self) -> bool:
        """Whether several steps are one advance."""

    @property
    def divisible(self) -> bool:
        """Whether several steps have the same bits as one by one."""

    @property
    def kernels(self) -> tuple[Any, ...]:
        """Return the kernels that it calls."""

    def holds(self, state: State) -> bool:
        """Whether the numbers that it was made from are still the same."""

    def ready(self, state: State, h: float) -> bool:
        """Whether it can make the coming step of ``h`` seconds."""

    def advance(self, state: State, h: float, steps: int) -> Advance:
        """Advance by ``steps`` steps of ``h`` seconds, or by some of them; the clock is the caller's.

        Raises
        ------
        Diverged
            If a value would not be finite. Whole steps before that one are counted by the stepper.
        """

    def goes_on(self, state: State) -> bool:
        """Whether another call may be like the last one where nothing is edited in between."""
        return False

    def repeat(self, state: State, h: float, steps: int) -> Advance:
        """Make steps as in the last call, since which nothing was edited, and after which it goes on."""
        return self.advance(state, h, steps)


type Stretch = tuple[float, float, int]
"""When some steps begin [s], how long each is [s], and how many they are."""


@runtime_checkable
class Repeatable(Advancer, Protocol):
    """A stepper that makes the same steps from many starts, with nothing chosen or booked in between."""

    def repeatable(self, state: State, stretches: Sequence[Stretch]) -> Callable[[], bool]:
        """Return what makes steps from where bodies are when it is called, as a new stepper would.

        It returns whether it has made all of them: others are to make some where it has not. What is kept of
        contacts, and what rounding has left out, is that of the moment at which this method is called, before
        the first of them. Impacts are logged and counted from there on, in each.
        """


class Stepper(Advancer, Protocol):
    """One way to advance a state, made for its structure and remade when that changes.

    To add one, write its file, and name it in the list of :mod:`physicslab.stepping.select`, before those
    over which it is preferred. One that says nothing else can make any step, and does none of what the
    attributes say.
    """

    reason: str = ""
    kernels: tuple[Any, ...] = ()
    leaps: bool = False
    divisible: bool = True
    keeps_balance: bool = False
    leaves_forces: bool = False
    samples: bool = False
    yields: bool = False
    is_repeated: bool = False
    """Whether the call at hand is the last one made again: nothing was edited since."""

    def __init__(self, state: State, schedule: Schedule, plan: StepPlan) -> None: ...

    @classmethod
    def why_not(cls, state: State, schedule: Schedule, plan: StepPlan) -> str | None:
        """Return why this stepper cannot advance such a world, or ``None``."""

    def holds(self, state: State) -> bool:
        """Return True: it was made from no numbers."""
        return True

    def ready(self, state: State, h: float) -> bool:
        """Return True: it can make any step."""
        return True

    def repeat(self, state: State, h: float, steps: int) -> Advance:
        """Make steps as in the last call, under its laws."""
        self.is_repeated = True
        try:
            return self.advance(state, h, steps)
        finally:
            self.is_repeated = False


def divisions(state: State, h: float) -> int:
    """Return into how many parts a step of ``h`` seconds is divided, so that none exceeds the scene's own."""
    own = state.simulation.dt
    if h <= own:
        return 1
    if h / own > _MAX_DIVISIONS:
        most = f"at most {_MAX_DIVISIONS} times simulation.dt = {own!r} s"
        raise InvalidValue("step", "dt", h, most)
    return max(1, math.ceil(h / own - _TOLERATED))


def falls_far(state: State, h: float, smallest: float) -> int:
    """Return by which factor the substeps of a step of ``h`` seconds must be more for soft contacts.

    In a substep, what gravity adds to the way of a body at rest must not carry it past another one, and
    bodies, of which the ``smallest`` has that size [m], are to sink into each other by a small share of their
    size alone.
    """
    substep, physics = h / state.simulation.substeps, state.physics
    if physics.gravity_mode != "linear":
        return 1
    fall, most = physics.gravity.magnitude * substep * substep, MAX_FALL * smallest
    if fall <= most:
        return 1
    return MAX_FACTOR if fall >= MAX_FACTOR**2 * most else math.ceil(math.sqrt(fall / most))
