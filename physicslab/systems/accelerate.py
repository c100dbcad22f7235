"""Forces change velocities: Newton's second law."""

from physicslab.components import Transform, Velocity
from physicslab.ecs.sentences import sentence
from physicslab.kernels import motion
from physicslab.state.state import State
from physicslab.systems.system import Stage, System, at


class AccelerateSystem(System):
    """Adds up forces from zero and turns them into velocities. Every world has one."""

    engine = True
    kernels = (motion.clear, motion.pack_state, motion.kick, motion.find_beyond)

    def attach(self, state: State) -> None:
        """Clear the forces of systems that may not run any more."""
        state.bodies.pull[:] = 0.0

    def why_left_out(self, state: State) -> str | None:
        """Needed wherever something can change a velocity."""
        if not len(state.batch(Velocity)):
            return sentence("nothing_moves")
        return None

    @at(Stage.FORCE)
    def clear(self, state: State, h: float) -> None:
        """Begin to add up from zero, with the state packed for the forces that need it."""
        if state.has_forces:
            bodies, transform, velocity = state.bodies, state.table(Transform), state.table(Velocity)
            motion.clear(bodies.force, bodies.torque)
            motion.pack_state(
                transform["position"], transform["angle"], velocity["linear"], velocity["angular"],
                state.time, bodies.packed,
            )  # fmt: skip
            state.force_evaluations += 1

    @at(Stage.KICK)
    def kick(self, state: State, h: float) -> None:
        """Change velocities by the forces, and by damping."""
        bodies, physics = state.bodies, state.physics
        if not state.has_forces and physics.linear_damping == physics.angular_damping == 0.0:
            return
        velocity = state.table(Velocity)
        motion.kick(
            velocity["linear"], velocity["angular"], bodies.force, bodies.torque,
            bodies.awake_inverse_mass, bodies.awake_inverse_inertia, bodies.sub_integrated,
            physics.linear_damping, physics.angular_damping, h,
        )  # fmt: skip
