"""Which body to name where a method finds no step: the one that moves or speeds up fastest."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from physicslab.components import Velocity
from physicslab.systems.schedule import ForceSystem, Stage

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["fastest_body"]


@np.errstate(all="ignore")
def fastest_body(world: World) -> int:
    """Return the entity whose speed, with what the forces add to it in a step, is largest or not finite.

    Forces are added up at the present state, for which the world's context must be active; nothing that moves
    is changed. Row 0, which is the world itself, is never meant.

    Parameters
    ----------
    world : World
        In which something has a Velocity.

    Returns
    -------
    int
        An entity; 0 if nothing moves.
    """
    bodies, velocity = world.bodies, world.table(Velocity)
    evaluations = world.force_evaluations
    for system in (bodies, *world.schedule.running):
        if system is bodies or isinstance(system, ForceSystem):
            getattr(system, system.marked()[Stage.FORCE])(world, 0.0)
    world.force_evaluations = evaluations  # looking at them is no work of the method
    gained = np.hypot(bodies.force[:, 0], bodies.force[:, 1]) * bodies.inverse_mass * world.simulation.dt
    speeds = np.hypot(velocity["linear"][:, 0], velocity["linear"][:, 1]) + gained
    speeds = np.where(np.isfinite(speeds), speeds, np.inf)
    speeds[~velocity.present] = -1.0
    row = int(np.argmax(speeds))
    return int(world.roster.entities[row]) if velocity.present[row] else 0
