"""Springs and dampers between bodies, or a body and a fixed point."""

from __future__ import annotations

from typing import TYPE_CHECKING

import esper
import numpy as np
from numpy.typing import NDArray

from physicslab.columns import InvalidValue
from physicslab.components import Name, Spring, Transform, Velocity
from physicslab.kernels import springs
from physicslab.schedule import ForceSystem, Stage, at

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["SpringSystem"]


class SpringSystem(ForceSystem):
    """Pulls the ends of every Spring together by F = k (length - rest_length) + c (rate of lengthening)."""

    needs = (Spring,)
    kernels = (springs.spring_forces, springs.spring_potential)
    potential = "spring"

    def __init__(self) -> None:
        self._rows = self._a = self._b = np.zeros(0, np.int64)

    def attach(self, world: World) -> None:
        """Find the bodies at both ends of every spring; a spring whose body was removed goes with it.

        Raises
        ------
        InvalidValue
            If an end never was an entity, or is one without a Transform.
        """
        self._rows, self._a, self._b = rows, a, b = self.ends(world)
        placed = world.table(Transform).present
        lost_a, lost_b = (a < 0) | ~placed[a], (b < 0) | ~(placed[b] | (b == 0))
        spring, entities = world.table(Spring), world.batch(Spring).entities
        for i in np.flatnonzero(lost_a | lost_b).tolist():
            entity, name = int(entities[i]), "a" if lost_a[i] else "b"
            end = int(spring[name][rows[i]]) or entity
            if end in world.roster.row_of or end > world.roster.newest:
                raise InvalidValue(f"{world.label(entity)}: Spring", name, end, "an entity with a Transform")
            esper.remove_component(entity, Spring)
            left: tuple[object, ...] = esper.components_for_entity(entity)
            if all(isinstance(component, Name) for component in left):
                esper.delete_entity(entity, immediate=True)

    @staticmethod
    def ends(world: World) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
        """Return the rows of the springs, of the bodies at their ends A, and at B (0 for the world)."""
        batch, spring, rows_of = world.batch(Spring), world.table(Spring), world.roster.rows_of
        a = spring["a"][batch.rows]
        return batch.rows, rows_of(np.where(a == 0, batch.entities, a)), rows_of(spring["b"][batch.rows])

    @at(Stage.FORCE)
    def pull(self, world: World, h: float) -> None:
        """Add the springs' pull to the forces."""
        bodies, spring = world.bodies, world.table(Spring)
        transform, velocity = world.table(Transform), world.table(Velocity)
        springs.spring_forces(
            bodies.force, bodies.torque, transform["position"], transform["angle"],
            velocity["linear"], velocity["angular"],
            self._rows, self._a, self._b, spring["anchor_a"], spring["anchor_b"],
            spring["rest_length"], spring["stiffness"], spring["damping"],
        )  # fmt: skip

    def potential_energy(self, world: World) -> float:
        """Return the sum of k (length - rest_length)^2 / 2 [J]."""
        spring, transform = world.table(Spring), world.table(Transform)
        return springs.spring_potential(
            transform["position"], transform["angle"], self._rows, self._a, self._b,
            spring["anchor_a"], spring["anchor_b"], spring["rest_length"], spring["stiffness"],
        )  # fmt: skip
