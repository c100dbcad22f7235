"""The state of a world: entities, columns, laws, clock and arrays. It depends on no system and no stepper."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from physicslab.ecs.config import PhysicsConfig, SimulationConfig, field_names
from physicslab.ecs.text import printable, shortened
from physicslab.kernels import compile_kernels, seconds_waited
from physicslab.state.account import Account
from physicslab.state.bodies import Bodies
from physicslab.state.checkpoint import Checkpoint
from physicslab.state.contacts import Contacts
from physicslab.state.entities import Entities
from physicslab.state.joints import Joints
from physicslab.state.remainders import NO_REMAINDERS, Remainders
from physicslab.state.samples import Samples
from physicslab.state.sleep import Sleep

SCENE_TEXTS: Mapping[str, int | None] = {"name": 1_000, "title": 200, "description": None}
"""The texts of a scene, and the characters that those on one line may have."""
type View = tuple[float, float, float, float]
LEVELS = ("Explore", "Measure", "Engineer")
"""How much a window may show beside the world, the least first."""
SHOWN = (
    "arrows", "centres", "grid", "impacts", "impulses", "momenta", "panel", "parts", "stopwatch",
)  # fmt: skip
"""Things that a window may show beside that."""


@dataclass(frozen=True, slots=True)
class Desk:
    """The view of a scene beside the world: one of ``LEVELS``, and some of ``SHOWN``."""

    level: str
    shown: frozenset[str]


"""The part of a world that a window shows at first: xmin, ymin, xmax, ymax [m]."""


class State(Entities):
    """Entities, the laws, the clock, and the arrays that systems and steppers share.

    Attributes
    ----------
    name, title, description : str
        Name, title and description of the scene.
    view : View, optional
        The part that a window shows at first; all of it by default.
    desk : Desk, optional
        The view beside that; by default as the user has it.
    time : float
        The clock [s]. Within a step it is that of the state which a force or a stage sees.
    steps : int
        Steps made.
    substeps : int
        Number of parts of the last step, or of each part of one that was divided: more than
        ``simulation.substeps`` where a system found these too few.
    step_divisions : int
        Into how many parts the last step was divided, which was longer than ``simulation.dt``; or 1.
    force_evaluations, collisions : int
        How often forces were evaluated, and how many impacts there were.
    returned_inside : int
        How often a body beyond the bounds was put elsewhere, as something fixed held it there.
    has_forces, uniform_forces : bool
        Whether a force system runs; whether those that do, and all else that acts within a step, accelerate
        all bodies alike and turn none.
    event_driven, rigid_contacts : bool
        Whether collisions are located in time, instead of found within steps; whether contacts are rigid.
    window : tuple of two floats
        When a substep begins and ends, relative to the moment at which impacts are resolved, in substeps.
    generation : int
        Grows whenever columns may have been changed from outside, as between steps.
    kick_before_contacts : float
        Which share of a substep's kick comes before contacts are found.
    moment : float
        The time [s] at which impacts of the substep at hand are resolved.
    revision : int
        How often structure, configuration or columns were changed from outside.
    motion_edits : int
        How often that concerned the motion, as a new trail does not: measurements over time from before do
        not apply any more.
    stale : bool
        Whether systems and steppers are to be chosen again before the next step.
    bodies : Bodies
        Masses and forces, a row an entity.
    contacts : Contacts
        The near pairs.
    joints : Joints
        Joints between bodies, as rows of constraints.
    fastest_rates : dict of str to float
        Fastest rate [rad/s] of each force system within steps since the motion was last edited.
    remainders : Remainders
        Rounding remainders of positions and velocities in the last step.
    checkpoint : Checkpoint
        The state of motion before the step at hand.
    sleep : Sleep
        Which bodies have come to rest, and are not simulated until something wakes them.
    account : Account
        Changes of the energy and the momentum, by cause.
    samples : Samples, optional
        Arrays filled with the motion while the world is advanced.
    """

    # An attribute that is misspelt, or belongs elsewhere, would be kept and do nothing.
    __slots__ = (
        "_forces_at",
        "_physics",
        "_simulation",
        "_waited_before",
        "account",
        "bodies",
        "checkpoint",
        "collisions",
        "contacts",
        "description",
        "desk",
        "event_driven",
        "fastest_rates",
        "force_evaluations",
        "generation",
        "has_forces",
        "joints",
        "kick_before_contacts",
        "moment",
        "motion_edits",
        "name",
        "remainders",
        "returned_inside",
        "revision",
        "rigid_contacts",
        "samples",
        "sleep",
        "stale",
        "step_divisions",
        "steps",
        "substeps",
        "time",
        "title",
        "uniform_forces",
        "view",
        "window",
    )  # fmt: skip

    def __init__(
        self, physics: PhysicsConfig | None = None, simulation: SimulationConfig | None = None
    ) -> None:
        self._physics = PhysicsConfig() if physics is None else _checked(physics, PhysicsConfig)
        self._simulation = (
            SimulationConfig() if simulation is None else _checked(simulation, SimulationConfig)
        )
        self.name: str = ""
        self.title: str = ""
        self.description: str = ""
        self.view: View | None = None
        self.desk: Desk | None = None
        self.time, self.steps, self.revision, self.motion_edits = 0.0, 0, 0, 0
        self._forces_at = -1, -1  # after how many steps and edits forces were solved for
        self.substeps, self.step_divisions = self._simulation.substeps, 1
        self.force_evaluations = self.collisions = self.returned_inside = 0
        self._waited_before = seconds_waited()
        self.generation = 0
        self.has_forces = self.uniform_forces = self.event_driven = self.rigid_contacts = False
        self.window, self.kick_before_contacts, self.moment = (-0.5, 0.5), 0.5, 0.0
        self.bodies, self.contacts, self.sleep = Bodies(), Contacts(), Sleep()
        self.joints = Joints()
        self.remainders: Remainders = NO_REMAINDERS
        self.fastest_rates: dict[str, float] = {}
        self.checkpoint = Checkpoint()
        self.account = Account()
        self.samples: Samples | None = None
        self.stale = True
        super().__init__()

    # ---- configuration -------------------------------------------------------------------------------------

    @property
    def physics(self) -> PhysicsConfig:
        """The laws of this world."""
        return self._physics

    @physics.setter
    def physics(self, physics: PhysicsConfig) -> None:
        self._physics = _checked(physics, PhysicsConfig)
        self.stale = self.entity_index.motion_edited = True

    @property
    def simulation(self) -> SimulationConfig:
        """How this world is stepped."""
        return self._simulation

    @simulation.setter
    def simulation(self, simulation: SimulationConfig) -> None:
        self._simulation = _checked(simulation, SimulationConfig)
        self.stale = self.entity_index.motion_edited = True

    @property
    def counts(self) -> tuple[int, int, int]:
        """Force evaluations, impacts, and impacts logged."""
        return self.force_evaluations, self.collisions, self.contacts.logged

    @property
    def forces_known(self) -> bool:
        """Whether a step has led to the present state, and so to forces of joints and contacts."""
        return self._forces_at == (self.steps, self.motion_edits)

    def compile(self, kernels: Iterable[Any]) -> None:
        """Compile kernels that are about to be called, or load them."""
        compile_kernels(kernels)

    @property
    def compile_s(self) -> float:
        """Seconds that this process has spent on compiling or loading kernels since this world was made."""
        return seconds_waited() - self._waited_before


def _checked[C: PhysicsConfig | SimulationConfig](value: C, kind: type[C]) -> C:
    """Return laws or settings; refuse what is none, as a dict of them."""
    if isinstance(value, kind):
        return value
    words = shortened(printable(repr(value)))
    raise TypeError(f"world.{kind.section} is a {kind.__name__}, not {words}: write {kind.__name__}(...)")


class _Elsewhere:
    """Refuses what is a part of the laws or of the settings where it is written to the world itself."""

    def __init__(self, record: str, name: str) -> None:
        self._words = (
            f"is in world.{record}: "
            f"world.{record} = dataclasses.replace(world.{record}, {name}=...) changes it"
        )
        self._name = name

    def __get__(self, state: State | None, owner: type[State]) -> object:
        if state is None:
            return self
        raise AttributeError(f"world.{self._name} {self._words}")

    def __set__(self, state: State, value: object) -> None:
        raise AttributeError(f"world.{self._name} {self._words}")


for _config in (PhysicsConfig, SimulationConfig):
    for _field in field_names(_config):
        if not hasattr(State, _field):
            setattr(State, _field, _Elsewhere(_config.section, _field))
