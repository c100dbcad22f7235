"""Velocities change positions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from physicslab.components import Transform, Velocity
from physicslab.kernels import motion
from physicslab.schedule import Stage, System, at

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["IntegrateSystem"]


class IntegrateSystem(System):
    """Moves and turns every body that has a Velocity, when the integrator's plan says so."""

    needs = (Transform, Velocity)
    kernels = (motion.drift,)

    @at(Stage.DRIFT)
    def drift(self, world: World, h: float) -> None:
        """Move at the present velocity for a time h."""
        transform, velocity = world.table(Transform), world.table(Velocity)
        motion.drift(transform["position"], transform["angle"], velocity["linear"], velocity["angular"], h)
