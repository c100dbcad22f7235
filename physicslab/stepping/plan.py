"""How a world is advanced: the record of the choices, and the reasons for them."""

from dataclasses import dataclass

from physicslab.ecs.config import SimulationConfig
from physicslab.ecs.sentences import sentence
from physicslab.integrators import INTEGRATORS, Integrator
from physicslab.integrators.leapfrog import LEAPFROG
from physicslab.systems.system import Stage

WITHOUT_END = sentence("joints_without_end")
"""Why joints are soft that were not before."""
EVENTS_WITHOUT_END = sentence("events_without_end")
"""The same of contacts."""
ASKED_FOR = sentence("asked_for")
"""Why something is as it was configured."""


@dataclass(frozen=True, slots=True)
class StepPlan:
    """A method, and the reason for it.

    Attributes
    ----------
    integrator : Integrator
        The method.
    reason : str
        Why, for people.
    substeps : int
        Steps of the method a step of the world; 1 for one that chooses its steps itself.
    smooth : bool
        Whether nothing but forces acts, so that the method's flow advances the world.
    refused : str
        Why it is not the one that was configured; empty if it is.
    collisions : str
        ``"exact"`` (contact times located, paths in between in closed form), ``"step"`` (found and resolved
        within steps) or ``"none"`` (nothing can touch).
    collision_reason : str
        The reason, for people.
    contacts : str
        ``"rigid"`` or ``"soft"``.
    contact_reason : str
        The reason, for people.
    obstacle : str
        The system that acts within a step besides forces, if one does.
    stages : Integrator
        The method whose stages the contact step uses; where collisions are exact, only for resting bodies.
    split_forces : Integrator, optional
        Method that moves bodies on springs and in drag between contacts; ``None`` where kicks do.
    split_steps : int
        Its steps each half substep, at most.
    beyond : Integrator, optional
        Method that moves those of these bodies whose springs are too fast for it.
    """

    integrator: Integrator
    reason: str
    substeps: int
    smooth: bool
    refused: str = ""
    collisions: str = "none"
    collision_reason: str = sentence("nothing_touches")
    contacts: str = "soft"
    contact_reason: str = sentence("nothing_touches")
    obstacle: str = ""
    stages: Integrator = LEAPFROG
    split_forces: Integrator | None = None
    split_steps: int = 1
    beyond: Integrator | None = None

    @property
    def kept(self) -> tuple[str, str, int]:
        """Choices that a file keeps: how collisions are found, how forces are followed, in how many steps."""
        collisions = "rigid" if self.contacts == "rigid" and self.collisions != "exact" else self.collisions
        if self.contact_reason in (WITHOUT_END, EVENTS_WITHOUT_END):
            collisions = "step"
        if self.split_forces is not None:
            return collisions, self.split_forces.name, self.split_steps
        return collisions, self.integrator.name, self.substeps

    @property
    def kick_before_contacts(self) -> float:
        """Which share of a substep's kick comes before contacts are found."""
        substep = self.stages.substep
        found = [stage for stage, _ in substep].index(Stage.CONTACT)
        return sum(share for stage, share in substep[:found] if stage is Stage.KICK)


def default_plan(simulation: SimulationConfig) -> StepPlan:
    """Return the plan of a world before its contents are known."""
    name = simulation.integrator
    if name == "auto":
        return StepPlan(LEAPFROG, sentence("nothing_moves"), simulation.substeps, smooth=False)
    method = INTEGRATORS[name]
    stages = method if method.substep else LEAPFROG
    return StepPlan(method, ASKED_FOR, simulation.substeps, smooth=False, stages=stages)
