"""Which body to name where a method finds no step: the one that moves or speeds up fastest."""

from collections.abc import Iterable

import numpy as np

from physicslab.components import Mass, Transform, Velocity
from physicslab.ecs.sentences import sentence
from physicslab.integrators import StepTooSmall
from physicslab.state.masses import Diverged
from physicslab.state.state import State
from physicslab.systems.system import ForceSystem, Stage

_STEPS, _BOUND = 3.0, 4.0
"""Steps within which bodies meet, and the share of the energy of their pull that their motion may have."""


def changes_fast(state: State, forces: Iterable[ForceSystem], error: StepTooSmall) -> Diverged:
    """Return the error of a world in which a method finds no step, by what it said."""
    row = fastest_row(state, forces)
    body, sun = state.label_of_row(row), _falls_into(state, row)
    if sun:
        what = sentence("falls_into", body=body, other=state.label_of_row(sun))
    else:
        what = sentence("velocity_changes_fast", body=body, why=error.args[0])
    return Diverged(sentence("after_time", what=what, time=f"{state.time:.9g}"))


@np.errstate(all="ignore")
def _falls_into(state: State, row: int) -> int:
    """Return the row of the body that another meets within a few steps by their pull; 0 for none."""
    physics = state.physics
    if physics.gravity_mode != "planet" or physics.softening > 0.0:
        return 0
    mass, place = state.table(Mass), state.table(Transform)["position"]
    moved = np.where(state.table(Velocity).present[:, None], state.table(Velocity)["linear"], 0.0)
    way, approach = place - place[row], moved[row] - moved
    distance, speed = np.hypot(*way.T), np.hypot(*approach.T)
    pull = 2.0 * physics.G * (mass["mass"] + mass["mass"][row])
    falls = mass.present & (distance > 0.0) & ((way * approach).sum(axis=1) > 0.0)
    falls &= (distance < _STEPS * speed * state.simulation.dt) & (speed**2 * distance < _BOUND * pull)
    return int(np.argmin(np.where(falls, distance, np.inf))) if falls.any() else 0


@np.errstate(all="ignore")
def fastest_row(state: State, forces: Iterable[ForceSystem]) -> int:
    """Return the row of the body whose speed, with what forces add in a step, is largest or not finite.

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
    return int(np.argmax(speeds))
