"""The last call of a stepper, which is made again while nothing was edited since."""

from typing import Self

from physicslab.kernels import Plain
from physicslab.kernels.arguments import Motion
from physicslab.ode.closed_form import NoClosedForm
from physicslab.state.state import State
from physicslab.stepping.accounting import close_account, open_account
from physicslab.stepping.asleep import Asleep
from physicslab.stepping.flow import NotSmooth
from physicslab.stepping.islands import Islands
from physicslab.stepping.select import Steppers
from physicslab.stepping.stepper import Advance, Advancer
from physicslab.stepping.undo import StepTransaction, go_back
from physicslab.systems.schedule import Schedule
from physicslab.systems.system import Stage

_FEW = 256
"""Rows up to which all columns are compared: of more, a step takes so long that little is saved."""


class Repeat:
    """The last call of a stepper: how it is made again, and all that must not have changed until then.

    To follow edits and to choose a stepper takes longer than a step of ten bodies. Whether there were any is
    one comparison of memory.

    Parameters
    ----------
    state : State
        The state as the call has left it.
    schedule : Schedule
        Its systems.
    stepper : Advancer
        The stepper that has made the call, or the islands.
    h : float
        The length of its steps [s].
    """

    __slots__ = ("_began", "_blocks", "_bytes", "_schedule", "h", "stepper")

    def __init__(self, state: State, schedule: Schedule, stepper: Advancer, h: float) -> None:
        self.stepper, self.h, self._schedule = stepper, h, schedule
        self._blocks = [memoryview(block) for block in state.entity_index.blocks()]
        self._bytes, self._began = b"".join(self._blocks), state.time

    @classmethod
    def of(
        cls, state: State, schedule: Schedule, steppers: Steppers, stepper: Advancer | None, h: float
    ) -> Self | None:  # fmt: skip
        """Return how the last call is made again; ``None`` where more is to be done in each."""
        if len(state.entity_index) > _FEW or state.stale or state.joints.breakable:
            return None
        first = next(one for one in steppers.usable if not isinstance(one, Asleep))
        if stepper is not first and not isinstance(stepper, Islands):
            return None
        if not stepper.samples or schedule.observer is not None:
            return None
        compiled = all(kernel.compiled for kernel in stepper.kernels)
        return cls(state, schedule, stepper, h) if compiled and stepper.goes_on(state) else None

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

    def make(
        self, state: State, motion: Plain[Motion], steps: int
    ) -> tuple[Advance, Self | None] | None:  # fmt: skip
        """Make the call again, with so many steps, and return this where it can be made once more.

        ``None`` where the stepper cannot make them, and the state is as before.
        """
        stepper, account = self.stepper, state.account
        if not stepper.ready(state, self.h):
            return None
        state.compile(stepper.kernels)
        with StepTransaction(state, motion):
            self._schedule.run(Stage.PREPARE, state, self.h)
            if not stepper.keeps_balance:
                open_account(state, self._schedule.forces, unedited=True)
            try:
                made = stepper.repeat(state, self.h, steps)
            except (NoClosedForm, NotSmooth):
                go_back(state)
                return None
            if not made.steps:
                return None
            if account.is_open:
                close_account(state, self._schedule.forces)
            self._schedule.run(Stage.FINISH, state, self.h * made.steps)
        self._bytes, self._began = b"".join(self._blocks), state.time
        return made, self if stepper.goes_on(state) else None
