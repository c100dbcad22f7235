"""What every row of a world weighs and feels: Newton's second law."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Held, Mass, Shape, Transform, Velocity
from physicslab.ecs.component import InvalidValue
from physicslab.kernels import motion
from physicslab.kernels.solver import impulse
from physicslab.systems.schedule import Stage, System, at

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["Bodies", "Diverged"]


class Diverged(ArithmeticError):
    """A value is no longer finite: the run cannot go on."""


_INERTIA = next(spec for spec in Mass.FIELDS if spec.name == "inertia")


class Bodies(System):
    """Adds up forces and turns them into velocities. Every world has one; force systems write into it.

    Attributes
    ----------
    force, torque : float64 arrays (rows, 2), (rows,)
        Forces [N] and torques [N m] added up in this substep.
    inverse_mass, inverse_inertia : float64 arrays (rows,)
        Zero for what cannot be moved or turned: static, kinematic and held bodies.
    awake_inverse_mass, awake_inverse_inertia : float64 arrays (rows,)
        The same, and zero for sleepers: what is simulated goes by these.
    unequal : bool
        Whether two bodies that may meet differ so much in mass that one may be too heavy for the other.
    sub_integrated : bool array (rows,)
        What moves by a method of its own beside contacts
        (:class:`physicslab.stepping.split_forces.SplitForces`).
    """

    kernels = (motion.clear, motion.kick, motion.find_not_finite)
    observes = False  # what is not finite does not become so again

    def __init__(self) -> None:
        self._resize(0)
        self.unequal = False

    def _resize(self, rows: int) -> None:
        self.force: NDArray[np.float64] = np.zeros((rows, 2))
        self.torque: NDArray[np.float64] = np.zeros(rows)
        self.inverse_mass: NDArray[np.float64] = np.zeros(rows)
        self.inverse_inertia: NDArray[np.float64] = np.zeros(rows)
        self.awake_inverse_mass: NDArray[np.float64] = np.zeros(rows)
        self.awake_inverse_inertia: NDArray[np.float64] = np.zeros(rows)
        self.sub_integrated: NDArray[np.bool_] = np.zeros(rows, np.bool_)

    def derive(self, world: World) -> None:
        """Work out moments of inertia and inverse masses from the components as they are now.

        Raises
        ------
        InvalidValue
            If a body is so large and heavy that its moment of inertia is not finite.
        """
        if len(self.torque) != len(world.entity_index):
            self._resize(len(world.entity_index))
            world.schedule.compile((motion.derive_masses,))
        mass, shape, velocity = world.table(Mass), world.table(Shape), world.table(Velocity)
        ratio, infinite = motion.derive_masses(
            velocity.present, mass.present, world.table(Held).present,
            mass["mass"], mass["inertia"], mass["inertia_given"], mass["fixed_rotation"],
            shape["kind"], shape["radius"], shape["width"], shape["height"], velocity["angular"],
            self.inverse_mass, self.inverse_inertia,
        )  # fmt: skip
        if infinite >= 0:
            label, inertia = (
                world.label(int(world.entity_index.entities[infinite])),
                float(mass["inertia"][infinite]),
            )
            allowed = f"{_INERTIA.allowed}, of mass and Shape too"
            raise InvalidValue(f"{label}: Mass", "inertia", inertia, allowed)
        self.unequal = ratio > impulse.HEAVY_RATIO
        self.set_inactive(world.sleep.asleep)

    def set_inactive(self, asleep: NDArray[np.bool_]) -> None:
        """Let nothing move who is asleep."""
        np.copyto(self.awake_inverse_mass, self.inverse_mass)
        np.copyto(self.awake_inverse_inertia, self.inverse_inertia)
        if asleep.any():
            self.awake_inverse_mass[asleep] = self.awake_inverse_inertia[asleep] = 0.0

    def attach(self, world: World) -> None:
        """Forget the forces of systems that may run no more."""
        self.force[:] = 0.0
        self.torque[:] = 0.0

    def why_left_out(self, world: World) -> str | None:
        """Needed wherever something can change a velocity."""
        if not len(world.batch(Velocity)):
            return "nothing moves"
        return None

    @at(Stage.FORCE)
    def clear(self, world: World, h: float) -> None:
        """Start adding up from zero."""
        if world.has_forces:
            motion.clear(self.force, self.torque)
            world.force_evaluations += 1

    @at(Stage.KICK)
    def kick(self, world: World, h: float) -> None:
        """Change velocities by the forces, and by damping."""
        physics = world.physics
        if not world.has_forces and physics.linear_damping == physics.angular_damping == 0.0:
            return
        velocity = world.table(Velocity)
        motion.kick(
            velocity["linear"], velocity["angular"], self.force, self.torque,
            self.awake_inverse_mass, self.awake_inverse_inertia, self.sub_integrated,
            physics.linear_damping, physics.angular_damping, h,
        )  # fmt: skip

    @at(Stage.FINISH)
    def check_finite(self, world: World, h: float) -> None:
        """Stop a run that has diverged, naming what and when."""
        transform, velocity = world.table(Transform), world.table(Velocity)
        for table, vectors, numbers in ((transform, "position", "angle"), (velocity, "linear", "angular")):
            row = motion.find_not_finite(table[vectors], table[numbers])
            if row >= 0:
                label = world.label(int(world.entity_index.entities[row]))
                raise Diverged(
                    f"{label}: {table.component.__name__} is no longer finite at t = {world.time + h:.9g} s; "
                    f"a smaller dt or more substeps may help"
                )
