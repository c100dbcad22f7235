"""Velocities change positions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from physicslab.components import Transform, Velocity
from physicslab.kernels import motion
from physicslab.systems.schedule import Stage, System, at

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["IntegrateSystem"]


class IntegrateSystem(System):
    """Moves and turns every body that has a Velocity, when the integrator's plan says so."""

    needs = (Transform, Velocity)
    kernels = (motion.drift, motion.predict)

    @at(Stage.DRIFT)
    def drift(self, world: World, h: float) -> None:
        """Move at the present velocity for a time h, and what is tethered as its tethers have it."""
        transform, velocity = world.table(Transform), world.table(Velocity)
        motion.drift(
            transform["position"], transform["angle"], velocity["linear"], velocity["angular"],
            world.bodies.sub_integrated, h,
        )  # fmt: skip
        if world.split_forces is not None:
            world.split_forces.move(world, h)

    @at(Stage.PREDICT)
    def predict(self, world: World, h: float) -> None:
        """Show contacts the velocity that tethers will bring about in a time h; take it back with -h."""
        if world.split_forces is not None:
            bodies, velocity = world.bodies, world.table(Velocity)
            motion.predict(
                velocity["linear"], velocity["angular"], bodies.force, bodies.torque,
                bodies.awake_inverse_mass, bodies.awake_inverse_inertia, world.split_forces.gentle, h,
            )  # fmt: skip
