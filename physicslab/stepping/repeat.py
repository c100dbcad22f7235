"""The last call of a stepper, which is made again while nothing was edited since."""

from typing import Self

from physicslab.state.state import State
from physicslab.stepping.accounting import close_account, open_account
from physicslab.stepping.asleep import Asleep
from physicslab.stepping.islands import Islands
from physicslab.stepping.select import Steppers
from physicslab.stepping.soft import Soft
from physicslab.stepping.stepper import Advancer
from physicslab.systems.schedule import Schedule

_FEW = 4_096
"""Rows up to which all columns are compared: of more, a step takes so long that little is saved."""


class Repeat:
    """The last call of a stepper: how it is made again, and all that must not have changed until then.

    To follow edits and to choose a stepper takes longer than a step of ten bodies. Whether there were any is
    one comparison of memory.

    Parameters
    ----------
    state : State
        The state as the call has left it.
    stepper : Advancer
        The stepper that has made the call, or the islands.
    h : float
        The length of its steps [s].
    """

    __slots__ = ("_began", "_blocks", "_bytes", "h", "stepper")

    def __init__(self, state: State, stepper: Advancer, h: float) -> None:
        self.stepper, self.h = stepper, h
        self._blocks = [memoryview(block) for block in state.entity_index.blocks()]
        self._keep(state)

    def _keep(self, state: State) -> None:
        self._bytes, self._began = b"".join(self._blocks), state.time

    @classmethod
    def of(
        cls, state: State, schedule: Schedule, steppers: Steppers, h: float, last: Advancer | None,
        before: Self | None,
    ) -> Self | None:  # fmt: skip
        """Return how the ``last`` stepper's call is made again; ``None`` where more is to be done in each.

        ``before`` is how that call was made again itself, if it was; that is then returned.
        """
        if before is not None and before.stepper is last:
            if not last.goes_on(state):
                return None
            before._keep(state)
            return before
        if len(state.entity_index) > _FEW or state.stale or state.joints.breakable:
            return None
        first = next(one for one in steppers.usable if not isinstance(one, Asleep))
        if last is None or not (last is first or last.yields or isinstance(last, Islands)):
            return None
        if not last.samples or schedule.observer is not None:
            return None  # what is written within a call, as at impacts, is an edit that is not seen behind it
        compiled = all(kernel.compiled for kernel in last.kernels)
        return cls(state, last, h) if compiled and last.goes_on(state) else None

    def holds(self, state: State, islands: Islands) -> bool:
        """Whether nothing was edited since, the clock among it, and islands are not to be looked for."""
        return (
            state.time > self._began
            and not state.stale
            and state.entity_index.is_synchronous()
            and b"".join(self._blocks) == self._bytes
            and state.account.start is not None
            and islands.are_settled(state, self.h)
        )

    def make(self, state: State, schedule: Schedule, h: float, steps: int) -> int:
        """Make steps as in the last call, for one that sees all edits and goes back where they fail.

        Returns how many; 0 where they are not to be made so. Other steppers than those of soft contacts may
        make a part of a step, or hand it to another.
        """
        stepper, account, start = self.stepper, state.account, state.time
        if not isinstance(stepper, Soft) or self.h != h or start <= self._began or state.stale:
            return 0
        if not (stepper.ready(state, h) and stepper.goes_on(state)):
            return 0
        self._began, account.is_open, state.in_step = start, False, True
        state.generation += 1
        try:
            if not stepper.keeps_balance:
                open_account(state, schedule.forces, unedited=True)
            made = stepper.repeat(state, h, steps)
            if account.is_open:
                close_account(state, schedule.forces)
        finally:
            state.in_step = False
        state.count_steps(made.steps, made.divisions)
        return made.steps
