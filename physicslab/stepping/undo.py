"""Back to before a step that failed."""

from __future__ import annotations

from physicslab.contacts.arguments import motion_of
from physicslab.contacts.islands import wake_all
from physicslab.state.state import State

__all__ = ["go_back"]


def go_back(state: State) -> None:
    """Restore positions, velocities and counts from the checkpoint, and drop all contacts."""
    state.checkpoint.restore(motion_of(state))
    state.force_evaluations, state.collisions, state.contacts.logged = state.checkpoint.counts
    state.contacts.clear()  # what a failed step left there may not be finite either
    wake_all(state)  # no contact supports any body now
