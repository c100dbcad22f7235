"""The forces that act at the present state, added up beside the steps."""

from __future__ import annotations

from physicslab.state.state import State
from physicslab.systems.accelerate import AccelerateSystem
from physicslab.systems.schedule import Schedule
from physicslab.systems.system import Stage

__all__ = ["add_up_forces"]


def add_up_forces(state: State, schedule: Schedule) -> None:
    """Set ``bodies.force`` and ``.torque`` to the present forces, without changing the state of motion."""
    acting = [s for s in schedule.systems if isinstance(s, AccelerateSystem)] + list(schedule.forces)
    for system in acting:
        state.compile(system.kernels_for(state))
        getattr(system, system.marked()[Stage.FORCE])(state, 0.0)
    state.force_evaluations -= state.has_forces  # not an evaluation of the method
