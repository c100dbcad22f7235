"""Velocities change positions."""

from physicslab.components import Transform, Velocity
from physicslab.kernels import motion
from physicslab.state.state import State
from physicslab.systems.system import Stage, System, at


class IntegrateSystem(System):
    """Moves and turns every body that has a Velocity, when the integrator's plan says so."""

    engine = True
    needs = (Transform, Velocity)
    kernels = (motion.drift,)

    @at(Stage.DRIFT)
    def drift(self, state: State, h: float) -> None:
        """Move at the present velocity for a time h, except for sub-integrated bodies."""
        transform, velocity = state.table(Transform), state.table(Velocity)
        motion.drift(
            transform["position"], transform["angle"], velocity["linear"], velocity["angular"],
            state.bodies.sub_integrated, h,
        )  # fmt: skip
