"""Which body to name where a method finds no step: the one that moves or speeds up fastest."""

from collections.abc import Iterable

import numpy as np

from physicslab.components import Velocity
from physicslab.ecs.sentences import sentence
from physicslab.integrators import StepTooSmall
from physicslab.state.masses import Diverged
from physicslab.state.state import State
from physicslab.systems.system import ForceSystem, Stage


def changes_fast(state: State, forces: Iterable[ForceSystem], error: StepTooSmall) -> Diverged:
    """Return the error of a world in which a method finds no step, by what it said."""
    what = sentence("velocity_changes_fast", body=fastest_body(state, forces), why=error.args[0])
    return Diverged(sentence("after_time", what=what, time=f"{state.time:.9g}"))


@np.errstate(all="ignore")
def fastest_body(state: State, forces: Iterable[ForceSystem]) -> str:
    """Return the label of the body whose speed, with what forces add in a step, is largest or not finite.

    ``bodies.force`` and ``.torque`` hold the forces at the present state afterwards; nothing that moves is
    changed. Row 0, which is the world itself, is never meant.

    Parameters
    ----------
    state : State
        In which something has a Velocity; its context is active.
    forces : iterable of ForceSystem
        Those that act.
    """
    bodies, velocity = state.bodies, state.table(Velocity)
    bodies.force[:] = 0.0
    bodies.torque[:] = 0.0
    for force in forces:
        state.compile(force.kernels_for(state))
        getattr(force, force.marked()[Stage.FORCE])(state, 0.0)
    gained = np.hypot(bodies.force[:, 0], bodies.force[:, 1]) * bodies.inverse_mass * state.simulation.dt
    speeds = np.hypot(velocity["linear"][:, 0], velocity["linear"][:, 1]) + gained
    speeds = np.where(np.isfinite(speeds), speeds, np.inf)
    speeds[~velocity.present] = -1.0
    return state.label_of_row(int(np.argmax(speeds)))
