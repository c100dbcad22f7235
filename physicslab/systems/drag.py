"""Drag: resistance that grows with speed or with its square."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Drag, Mass, Velocity
from physicslab.kernels.forces import drag, packed_forces
from physicslab.kernels.forces.resistance import drag_resistance
from physicslab.ode.system import PackedForce
from physicslab.systems.schedule import ForceSystem, Stage, at

if TYPE_CHECKING:
    from physicslab.ode.system import StateLayout
    from physicslab.world import World

__all__ = ["DragSystem"]


class DragSystem(ForceSystem):
    """Slows every body that has Drag. It stores no energy: what it takes is gone."""

    needs = (Drag, Velocity, Mass)
    kernels = (drag.drag_forces,)

    @at(Stage.FORCE)
    def slow(self, world: World, h: float) -> None:
        """Add the drag to the forces."""
        table, rows = world.table(Drag), world.batch(*self.needs).rows
        drag.drag_forces(
            world.bodies.force, world.table(Velocity)["linear"], rows, table["linear"], table["quadratic"]
        )

    def packed(self, world: World, slots: StateLayout) -> PackedForce:
        """Return the drag for compiled integrators."""
        table, rows = world.table(Drag), world.batch(*self.needs).rows
        rows = rows[slots.place[rows] >= 0]  # what rests may not take part, and has no coordinates
        parameters = np.stack((table["linear"][rows], table["quadratic"][rows]), axis=1).ravel()
        indices = np.concatenate(([len(rows)], slots.place[rows]))
        return PackedForce(packed_forces.drag, parameters, indices, drag_resistance)

    def rates(self, world: World) -> NDArray[np.float64]:
        """Return for each row the rate at which it slows down at its present speed [1/s]."""
        table, rows = world.table(Drag), world.batch(*self.needs).rows
        speed = np.hypot(*world.table(Velocity)["linear"][rows].T)
        rates = np.zeros(len(world.entity_index))
        rates[rows] = table["linear"][rows] + 2.0 * table["quadratic"][rows] * speed
        return rates * world.bodies.inverse_mass

    def strongest_rate(self, world: World) -> float:
        """Return the largest of :meth:`rates`."""
        return float(self.rates(world).max())

    def settings(self, world: World) -> bytes:
        """Return both coefficients of every body."""
        table, rows = world.table(Drag), world.batch(*self.needs).rows
        return table["linear"][rows].tobytes() + table["quadratic"][rows].tobytes()

    def couples(self, world: World) -> NDArray[np.int64]:
        """Drag couples nothing."""
        return np.zeros((0, 2), np.int64)

    def sees_velocity(self, world: World) -> bool:
        """Drag is nothing else."""
        return True
