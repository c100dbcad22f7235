"""The forces that act at the present state: their sum, added up beside the steps, and their rates."""

import math
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from physicslab.state.state import State
from physicslab.systems.accelerate import AccelerateSystem
from physicslab.systems.schedule import Schedule
from physicslab.systems.system import ForceSystem, Stage

WELL_RESOLVED = 0.5
"""omega h of the steps of blanes_moan: above about 1 it does not reach its order."""
MAX_STEPS = 1000
"""Largest number of steps of a method that ``auto`` makes of a step of the world."""


def add_up_forces(state: State, schedule: Schedule) -> None:
    """Set ``bodies.force`` and ``.torque`` to the present forces, without changing the state of motion."""
    _add_up(state, schedule, schedule.forces)


def forces_by_system(state: State, schedule: Schedule) -> dict[str, NDArray[np.float64]]:
    """Return the present force on each row (n, 2) [N], by the name of the system that it comes from.

    Nothing else is changed: ``bodies.force`` and ``.torque`` are as before.
    """
    bodies, found = state.bodies, {}
    force, torque = bodies.force.copy(), bodies.torque.copy()
    for system in schedule.forces:
        _add_up(state, schedule, (system,))
        found[system.name] = bodies.force.copy()
    bodies.force[:], bodies.torque[:] = force, torque
    return found


def _add_up(state: State, schedule: Schedule, forces: Iterable[ForceSystem]) -> None:
    """Let some forces add to the columns, which are set to zero first."""
    for system in (*(s for s in schedule.systems if isinstance(s, AccelerateSystem)), *forces):
        state.compile(system.kernels_for(state))
        getattr(system, system.marked()[Stage.FORCE])(state, 0.0)
    state.force_evaluations -= state.has_forces  # not an evaluation of the method


def fastest_rate(state: State, forces: Sequence[ForceSystem]) -> float:
    """Return the fastest rate that forces and damping give any body [rad/s]."""
    rate = max((system.strongest_rate(state) for system in forces), default=0.0)
    return max(rate, state.physics.linear_damping, state.physics.angular_damping)


def steps_needed(rate: float, h: float, resolved: float = WELL_RESOLVED) -> int:
    """Return the number of steps of a time h [s] that a rate [rad/s] needs, up to a limit.

    ``resolved`` is their omega h. Where there would be more than ``MAX_STEPS``, it is one more than these.
    """
    phase = rate * h / resolved
    return max(1, math.ceil(phase)) if phase <= MAX_STEPS else MAX_STEPS + 1
