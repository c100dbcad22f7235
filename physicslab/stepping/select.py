"""Which steppers there are, in one list, and which of them can advance a world."""

from dataclasses import dataclass, field

from physicslab.components import Transform, Velocity
from physicslab.state.state import State
from physicslab.stepping.asleep import Asleep
from physicslab.stepping.event_driven import EventDriven
from physicslab.stepping.flow import Flow
from physicslab.stepping.plan import StepPlan
from physicslab.stepping.planning import choose_plan, resumed_plan
from physicslab.stepping.rigid import Rigid
from physicslab.stepping.soft import Soft
from physicslab.stepping.stepper import Advancer, Stepper
from physicslab.systems.schedule import LeftOut, Schedule

STEPPERS: tuple[type[Stepper], ...] = (Asleep, Flow, EventDriven, Rigid, Soft)
"""All of them, the best first. The last can advance any world."""


@dataclass(frozen=True, slots=True)
class Steppers:
    """The steppers that can advance a world as it is made now, the best first, and why not the others.

    Those that were ``used`` may keep what they go on from.
    """

    usable: tuple[Stepper, ...]
    left_out: tuple[LeftOut, ...]
    used: set[int] = field(default_factory=set)

    def ready(self, state: State, h: float) -> Stepper:
        """Return the best of them that can make the coming step."""
        for stepper in self.usable[:-1]:
            if stepper.ready(state, h):
                return stepper
        return self.usable[-1]

    def main(self, state: State) -> Stepper:
        """Return the best of them for awake bodies and steps of the scene's own length, for reports."""
        awake = [stepper for stepper in self.usable if not isinstance(stepper, Asleep)]
        return next(stepper for stepper in awake if stepper.ready(state, state.simulation.dt))

    def at_once(self, stepper: Advancer, steps: int) -> int:
        """Return how many of ``steps`` a stepper makes in one call; one that is none of these, all.

        It is one where a better stepper has left the coming step to it, and may make the next, unless it
        yields then: a run makes the same steps as single ones.
        """
        if steps == 1 or stepper not in self.usable or stepper.yields:
            return steps
        first = next(one for one in self.usable if not isinstance(one, Asleep))
        return steps if stepper is first or isinstance(stepper, Asleep) else 1

    def use(self, stepper: Advancer) -> None:
        """Note that a stepper is about to advance the world."""
        self.used.add(id(stepper))

    def hold(self, state: State) -> bool:
        """Whether the numbers that they were made from are still the same."""
        return False not in [stepper.holds(state) for stepper in self.usable]


def select_steppers(state: State, schedule: Schedule, plan: StepPlan) -> Steppers:
    """Return the steppers for a world; its method is chosen, and nothing is compiled yet."""
    state.bodies.sub_integrated[:] = state.bodies.unkicked[:] = False
    state.window = plan.stages.window
    state.kick_before_contacts = plan.kick_before_contacts
    others = [system for system in schedule.running if not system.is_engine]
    state.sleep.acted_upon = any(system.acts_within_step() for system in others)
    uniform = [force.is_engine and force.uniform_acceleration(state) is not None for force in schedule.forces]
    state.uniform_forces = bool(uniform) and all(uniform) and not state.sleep.acted_upon
    state.sleep.has_external_writers = any(
        system.acts_within_step() or system.observes() for system in others
    )
    usable: list[Stepper] = []
    left_out: list[LeftOut] = []
    for kind in STEPPERS:
        reason = kind.why_not(state, schedule, plan)
        if reason is None:
            usable.append(kind(state, schedule, plan))
        else:
            left_out.append(LeftOut(kind.name, reason))
        if kind is Flow and reason is None:
            break
    return Steppers(tuple(usable), tuple(left_out))


def choose(state: State, schedule: Schedule, plan: StepPlan | None = None) -> tuple[StepPlan, Steppers]:
    """Choose the steppers for the systems that run, and the method, unless there is a ``plan`` already."""
    for force in schedule.forces:
        if force.needs and force.needs[0] not in (Transform, Velocity):  # which motion writes
            entities = state.batch(*force.needs).entities
            state.table(force.needs[0]).refuse_written(entities, state.label)
    before = state.event_driven
    plan = plan or choose_plan(state, schedule)
    state.rigid_contacts = plan.contacts == "rigid"
    state.event_driven = plan.collisions == "exact" and not state.rigid_contacts
    state.contacts.stale |= before or plan.collisions == "exact"
    return plan, select_steppers(state, schedule, plan)


def resume(state: State, schedule: Schedule, kept: tuple[str, str, int]) -> tuple[StepPlan, Steppers]:
    """Choose what was ``kept`` of an earlier plan (:attr:`StepPlan.kept`), where possible."""
    return choose(state, schedule, resumed_plan(state, schedule, kept))


def restart(state: State, schedule: Schedule, plan: StepPlan, steppers: Steppers) -> Steppers:
    """Return steppers of the same kinds that keep nothing of the steps made: those that made some are new."""
    state.contacts.stale |= state.event_driven
    usable: list[Stepper] = []
    for one in steppers.usable:
        if id(one) in steppers.used:
            if isinstance(one, EventDriven):
                one.forget()  # to make one takes as long as a run of some seconds
            else:
                one = type(one)(state, schedule, plan)
        usable.append(one)
    return Steppers(tuple(usable), steppers.left_out)


def remake(state: State, schedule: Schedule, plan: StepPlan | None) -> tuple[StepPlan, Steppers]:
    """Choose systems, steppers and the method, unless there is a ``plan`` already.

    Whether bodies may sleep depends on how collisions are found.
    """
    schedule.remake(state)
    return settle(state, schedule, plan)


def settle(state: State, schedule: Schedule, plan: StepPlan | None) -> tuple[StepPlan, Steppers]:
    """Choose steppers and the method for systems that were just chosen, and these again where they change."""
    while True:
        state.has_forces = bool(schedule.forces)
        chosen = choose(state, schedule, plan)
        if schedule.holds(state):
            return chosen
        schedule.remake(state)
