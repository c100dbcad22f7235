"""Velocities change positions."""

import logging

from physicslab.components import Transform, Velocity
from physicslab.ecs.sentences import sentence
from physicslab.kernels import motion
from physicslab.state.state import State
from physicslab.systems.accelerate import AccelerateSystem
from physicslab.systems.schedule import Schedule
from physicslab.systems.system import Stage, System, at

_log = logging.getLogger(__name__)
_warned: set[str] = set()
"""Warnings given already: a notebook may make a thousand worlds of one kind."""


class IntegrateSystem(System):
    """Moves and turns every body that has a Velocity, when the integrator's plan says so."""

    engine = True
    needs = (Transform, Velocity)
    kernels = (motion.drift,)

    @at(Stage.DRIFT)
    def drift(self, state: State, h: float) -> None:
        """Move at the present velocity for a time h, except for sub-integrated bodies."""
        transform, velocity = state.table(Transform), state.table(Velocity)
        motion.drift(
            transform["position"], transform["angle"], velocity["linear"], velocity["angular"],
            state.bodies.sub_integrated, h,
        )  # fmt: skip


def why_nowhere(state: State) -> str | None:
    """Return that something has a velocity and no place, which velocities could change; or ``None``."""
    nowhere = state.table(Velocity).present & ~state.table(Transform).present
    return sentence("nowhere") if nowhere.any() else None


def warn_of_what_stands_still(schedule: Schedule) -> None:
    """Warn once where bodies have velocities, and no system changes positions by them."""
    _, *chosen = schedule.systems
    names = ", ".join(f"{system.name}()" for system in chosen)
    moves = not chosen or any(isinstance(system, IntegrateSystem) for system in chosen)
    if not moves and names not in _warned and schedule.find(AccelerateSystem) is not None:
        _warned.add(names)
        _log.warning(
            "World(%s): velocities move nothing without an IntegrateSystem(); World() has all systems", names
        )
