"""The state of a world: entities, columns, laws, clock and arrays. It depends on no system and no stepper."""

import math
from collections.abc import Iterable
from typing import Any

from physicslab.ecs.config import PhysicsConfig, SimulationConfig, field_names
from physicslab.ecs.fields import Field
from physicslab.kernels import compile_kernels, seconds_waited
from physicslab.state.account import Account
from physicslab.state.bodies import Bodies
from physicslab.state.checkpoint import Checkpoint
from physicslab.state.contacts import Contacts
from physicslab.state.contents import Contents
from physicslab.state.joints import Joints
from physicslab.state.remainders import NO_REMAINDERS, Remainders
from physicslab.state.samples import Samples
from physicslab.state.sleep import Sleep

_TIME = Field("time", "number", unit="s", owner="world")


class State(Contents):
    """Entities, the laws, the clock, and the arrays that systems and steppers share.

    Attributes
    ----------
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
    is_part : bool
        Whether it is that of an island of another world.
    kick_before_contacts : float
        Which share of a substep's kick comes before contacts are found.
    moment : float
        The time [s] at which impacts of the substep at hand are resolved.
    revision : int
        How often structure, configuration or columns were changed from outside.
    motion_edits : int
        How often that concerned the motion, as a new trail does not: measurements over time from before do
        not apply any more.
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
        "_forces_at", "_time", "_waited_before", "account", "bodies", "checkpoint", "collisions", "contacts",
        "event_driven", "fastest_rates", "force_evaluations", "generation", "has_forces", "is_part", "joints",
        "kick_before_contacts", "moment", "motion_edits", "remainders", "returned_inside", "revision",
        "rigid_contacts", "samples", "sleep", "step_divisions", "steps", "substeps", "uniform_forces",
        "window",
    )  # fmt: skip

    def __init__(
        self, physics: PhysicsConfig | None = None, simulation: SimulationConfig | None = None
    ) -> None:
        super().__init__(physics, simulation)
        self.time, self.steps, self.revision, self.motion_edits = 0.0, 0, 0, 0
        self._forces_at = -1, -1  # after how many steps and edits forces were solved for
        self.substeps, self.step_divisions = self.simulation.substeps, 1
        self.force_evaluations = self.collisions = self.returned_inside = 0
        self._waited_before = seconds_waited()
        self.generation, self.is_part = 0, False
        self.has_forces = self.uniform_forces = self.event_driven = self.rigid_contacts = False
        self.window, self.kick_before_contacts, self.moment = (-0.5, 0.5), 0.5, 0.0
        self.bodies, self.contacts, self.sleep = Bodies(), Contacts(), Sleep()
        self.joints = Joints()
        self.remainders: Remainders = NO_REMAINDERS
        self.fastest_rates: dict[str, float] = {}
        self.checkpoint = Checkpoint()
        self.account = Account()
        self.samples: Samples | None = None

    @property
    def time(self) -> float:
        """The clock [s]. Within a step it is that of the state which a force or a stage sees."""
        return self._time

    @time.setter
    def time(self, value: float) -> None:
        is_finite = type(value) is float and -math.inf < value < math.inf
        self._time: float = value if is_finite else _TIME.check(value)

    @property
    def counts(self) -> tuple[int, int, int]:
        """Force evaluations, impacts, and impacts logged."""
        return self.force_evaluations, self.collisions, self.contacts.logged

    @property
    def forces_known(self) -> bool:
        """Whether a step has led to the present state, and so to forces of joints and contacts."""
        return self._forces_at == (self.steps, self.motion_edits)

    def count_steps(self, steps: int, divisions: int) -> None:
        """Count steps that were made, each divided into so many parts; forces are then those of its end."""
        self.steps += steps
        self._forces_at, self.step_divisions = (self.steps, self.motion_edits), divisions

    def compile(self, kernels: Iterable[Any]) -> None:
        """Compile kernels that are about to be called, or load them."""
        compile_kernels(kernels)

    @property
    def compile_s(self) -> float:
        """Seconds that this process has spent on compiling or loading kernels since this world was made."""
        return seconds_waited() - self._waited_before


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
