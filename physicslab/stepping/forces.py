"""The forces that act at the present state: their sum, added up beside the steps, and their rates."""

from __future__ import annotations

from collections.abc import Sequence

from physicslab.state.state import State
from physicslab.systems.accelerate import AccelerateSystem
from physicslab.systems.schedule import Schedule
from physicslab.systems.system import ForceSystem, Stage

__all__ = ["add_up_forces", "fastest_rate"]


def add_up_forces(state: State, schedule: Schedule) -> None:
    """Set ``bodies.force`` and ``.torque`` to the present forces, without changing the state of motion."""
    acting = [s for s in schedule.systems if isinstance(s, AccelerateSystem)] + list(schedule.forces)
    for system in acting:
        state.compile(system.kernels_for(state))
        getattr(system, system.marked()[Stage.FORCE])(state, 0.0)
    state.force_evaluations -= state.has_forces  # not an evaluation of the method


def fastest_rate(state: State, forces: Sequence[ForceSystem]) -> float:
    """Return the fastest rate that forces and damping give any body [rad/s]."""
    rate = max((system.strongest_rate(state) for system in forces), default=0.0)
    return max(rate, state.physics.linear_damping, state.physics.angular_damping)
