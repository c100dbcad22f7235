"""Springs and dampers between bodies, or a body and a fixed point."""

from __future__ import annotations

from typing import TYPE_CHECKING

import esper
import numpy as np
from numpy.typing import NDArray

from physicslab.columns import InvalidValue
from physicslab.components import Spring, Transform, Velocity
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

    def attach(self, world: World) -> None:
        """Check that both ends of every spring are bodies; a spring whose body was removed goes with it."""
        batch, spring = world.batch(Spring), world.table(Spring)
        known, placed = world.roster.row_of, world.table(Transform).present
        for row, entity in zip(batch.rows.tolist(), batch.entities.tolist(), strict=True):
            for end, name in ((int(spring["a"][row]) or entity, "a"), (int(spring["b"][row]), "b")):
                if end == 0:
                    continue
                if end not in known and end <= world.roster.newest:
                    esper.remove_component(entity, Spring)
                    if not esper.components_for_entity(entity):
                        esper.delete_entity(entity, immediate=True)
                    break
                if end not in known or not placed[known[end]]:
                    raise InvalidValue(f"{world.label(entity)}: Spring", name, end, "an entity with a Transform")

    @staticmethod
    def ends(world: World) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
        """Return the rows of the springs, of the bodies at their ends A, and at B (0 for the world)."""
        batch, spring, lookup = world.batch(Spring), world.table(Spring), world.roster.lookup
        a = spring["a"][batch.rows]
        return batch.rows, lookup[np.where(a == 0, batch.entities, a)], lookup[spring["b"][batch.rows]]

    @at(Stage.FORCE)
    def pull(self, world: World, h: float) -> None:
        """Add the springs' pull to the forces."""
        bodies, spring = world.bodies, world.table(Spring)
        transform, velocity = world.table(Transform), world.table(Velocity)
        rows, a, b = self.ends(world)
        springs.spring_forces(
            bodies.force, bodies.torque, transform["position"], transform["angle"],
            velocity["linear"], velocity["angular"], rows, a, b, spring["anchor_a"], spring["anchor_b"],
            spring["rest_length"], spring["stiffness"], spring["damping"],
        )  # fmt: skip

    def potential_energy(self, world: World) -> float:
        """Return the sum of k (length - rest_length)^2 / 2 [J]."""
        spring, transform = world.table(Spring), world.table(Transform)
        rows, a, b = self.ends(world)
        return float(
            springs.spring_potential(
                transform["position"], transform["angle"], rows, a, b,
                spring["anchor_a"], spring["anchor_b"], spring["rest_length"], spring["stiffness"],
            )  # fmt: skip
        )
