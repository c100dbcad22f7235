"""Impulses at contacts."""

from physicslab.contacts.arguments import do_stage
from physicslab.kernels import Plain
from physicslab.kernels.arguments import Softness
from physicslab.kernels.solver import soft
from physicslab.state.state import State
from physicslab.systems.broad_phase import nothing_to_touch
from physicslab.systems.system import Stage, System, at


class ResolveSystem(System):
    """Resolves impacts, keeps resting bodies apart, and applies friction.

    Parameters
    ----------
    push : float
        Share of the overlap that is corrected in a substep; with n sweeps, fewer than four, (n / 4)^(1/2) of
        that, by a spring as much stiffer.
    stiffness : float
        Stiffness of the contact spring, in effective masses over the substep squared. With n sweeps over the
        contacts it is n^1.25 times as much: what rests sinks by its load h^2 / (m push stiffness n^1.25).
    max_push : float
        Largest way by which a body is moved in a substep where overlap is deep, as a share of its reach from
        its centre.
    """

    engine = True
    kernels = (soft.advance,)

    def __init__(self, push: float = 0.17, stiffness: float = 7.0, max_push: float = 0.02) -> None:
        self.push, self.stiffness, self.max_push = push, stiffness, max_push

    def fresh(self) -> "ResolveSystem":
        """Return another one with the same contact spring."""
        return ResolveSystem(self.push, self.stiffness, self.max_push)

    def why_left_out(self, state: State) -> str | None:
        """Needed where two things could ever meet."""
        reason = nothing_to_touch(state)
        state.joints.beside_contacts = reason is None
        return reason

    def softness(self, state: State) -> Plain[Softness]:
        """Return the contact spring for the substeps of the coming step.

        Overlap is corrected as fast [1/s] in shorter substeps as in the configured ones, by a spring that is
        as much stiffer: so bodies sink as deep, and are not thrown up by what longer substeps have left.
        """
        finer = max(1, state.substeps // state.simulation.substeps)
        return self.push / finer, self.stiffness * finer, self.max_push / finer

    @at(Stage.IMPACT)
    def resolve_impacts(self, state: State, h: float) -> None:
        """Bounce the pairs that meet within the substep."""
        state.collisions += do_stage(state, soft.IMPACTS, h)[1]
        state.collisions += do_stage(state, soft.LATER_IMPACTS, h)[1]

    @at(Stage.SOLVE)
    def solve(self, state: State, h: float) -> None:
        """Find the impulses that keep bodies apart and correct some of the overlap."""
        do_stage(state, soft.SOLVE, h, softness=self.softness(state))

    @at(Stage.RELAX)
    def relax(self, state: State, h: float) -> None:
        """Remove the velocity that came from correcting overlap."""
        do_stage(state, soft.RELAX, h, softness=self.softness(state))
