"""A step at hand, and back to before one that failed."""

from types import TracebackType

from physicslab.contacts.arguments import motion_of
from physicslab.contacts.islands import wake_all
from physicslab.kernels import Plain
from physicslab.kernels.arguments import Motion
from physicslab.state.state import State


class StepTransaction:
    """A ``with`` block that makes a step: where it fails or is broken off, the state goes back to before it.

    Parameters
    ----------
    state : State
        The state that the step changes.
    motion : tuple of arrays
        Its positions, angles and velocities (``motion_of``).
    """

    __slots__ = ("_motion", "_state")

    def __init__(self, state: State, motion: Plain[Motion]) -> None:
        self._state, self._motion = state, motion

    def __enter__(self) -> None:
        """Take the checkpoint; raise ``RuntimeError`` within a step."""
        state = self._state
        if state.in_step:
            raise RuntimeError("a system cannot step the world that is calling it")
        state.checkpoint.take(self._motion, state.counts)
        state.account.begin_step()
        state.checkpoint.time = state.time
        state.in_step, state.checkpoint.remainders = True, state.remainders

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        state = self._state
        try:
            if kind is not None:
                go_back(state)
                # Steppers hold numbers of the step that failed.
                state.stale = state.entity_index.motion_edited = True
        finally:
            state.in_step = False


def go_back(state: State) -> None:
    """Restore positions, velocities and counts from the checkpoint, and drop all contacts."""
    state.checkpoint.restore(motion_of(state))
    state.force_evaluations, state.collisions, state.contacts.logged = state.checkpoint.counts
    state.remainders = state.checkpoint.remainders
    state.account.go_back()
    state.contacts.clear()  # what a failed step left there may not be finite either
    state.joints.impulse[:] = 0.0
    wake_all(state)  # no contact supports any body now
