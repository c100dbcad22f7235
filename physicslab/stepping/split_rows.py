"""Which bodies hang on springs or are slowed by drag, and so need a method that follows them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform
from physicslab.systems.schedule import ForceSystem

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["sub_integrated_rows"]


def sub_integrated_rows(world: World) -> NDArray[np.bool_]:
    """Return for each row whether a force acts on it that tells bodies apart, or it is an end of one.

    Where another force couples any body with any, all are.
    """
    forces = [system for system in world.schedule.running if isinstance(system, ForceSystem)]
    rows = np.zeros(len(world.entity_index), np.bool_)
    for force in forces:
        rates = force.rates(world)
        pairs = force.couples(world)
        if rates is not None:
            rows |= rates > 0.0
            if pairs is not None:
                rows[pairs.ravel()] = True
    if rows.any() and any(force.couples(world) is None for force in forces):
        rows[:] = True
    return rows & world.table(Transform).present
