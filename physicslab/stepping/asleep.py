"""Steps in which everything sleeps."""

from physicslab.contacts.islands import all_asleep, book_sleep
from physicslab.ecs.sentences import sentence
from physicslab.state.state import State
from physicslab.stepping.plan import StepPlan
from physicslab.stepping.stepper import Advance, Stepper
from physicslab.systems.schedule import Schedule


class Asleep(Stepper):
    """Advances the clock alone, while all that could move sleeps."""

    name: str = "asleep"
    title: str = "Everything sleeps: only time passes"
    leaves_forces: bool = True
    samples: bool = True

    def __init__(self, state: State, schedule: Schedule, plan: StepPlan) -> None:
        self.reason = sentence("everything_sleeps")

    @classmethod
    def why_not(cls, state: State, schedule: Schedule, plan: StepPlan) -> str | None:
        """Return why bodies cannot sleep, or ``None``."""
        return None if state.sleep.on else sentence("stays_awake")

    def ready(self, state: State, h: float) -> bool:
        """Whether nothing would happen."""
        return all_asleep(state)

    def advance(self, state: State, h: float, steps: int) -> Advance:
        """Let the time go by."""
        state.substeps = state.simulation.substeps
        book_sleep(state, state.sleep.asleep, steps * h)
        if state.samples is not None:
            state.samples.repeat(state, state.time, steps * h)
        return Advance(steps)
