"""Contact points of near bodies."""

from physicslab.contacts.arguments import do_stage
from physicslab.contacts.near_pairs import add_constraints, refill
from physicslab.kernels.solver import soft
from physicslab.state.state import State
from physicslab.systems.broad_phase import nothing_to_touch
from physicslab.systems.system import Stage, System, at


class ContactSystem(System):
    """Finds the contact points of near pairs: normal from A to B, separation, arms, effective masses.

    Boxes that have hardly moved against each other keep their points; bodies that are fast for their size are
    swept, so that none passes through another.
    """

    engine = True
    kernels = (soft.advance,)

    def __init__(self) -> None:
        self._first = True

    def why_left_out(self, state: State) -> str | None:
        """Needed where two things could ever meet."""
        return nothing_to_touch(state)

    def begin_step(self, state: State) -> None:
        """Begin new records of impacts at the next substep."""
        self._first = True

    @property
    def first(self) -> bool:
        """Whether the next substep is the first of a step."""
        return self._first

    @at(Stage.CONTACT)
    def find(self, state: State, h: float) -> None:
        """Find or refresh the points of every near pair; once a step, put steady contacts into blocks."""
        if self._first:
            refill(state)
        do_stage(state, soft.FIND, h, first=self._first)
        state.contacts.changed()
        if self._first and not state.event_driven:
            self.make_wide(state, h)
        self.end_substep()

    def end_substep(self) -> None:
        """Let the next substep be none that begins a step."""
        self._first = False

    def make_wide(self, state: State, h: float) -> None:
        """Put steady contacts into blocks."""
        add_constraints(state, h)
        state.contacts.changed()
