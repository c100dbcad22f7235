"""Charges in an electric and in a magnetic field that are the same everywhere."""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Charge, Mass, Transform, Velocity
from physicslab.ecs.sentences import sentence
from physicslab.kernels.accounts import FIELDS
from physicslab.kernels.forces import packed_forces
from physicslab.kernels.forces.magnetic import magnetic_field
from physicslab.state.packed import PackedForce, StateLayout
from physicslab.state.state import State
from physicslab.systems.system import ROUNDING, ForceSystem
from physicslab.systems.uniform_field import field_energy, packed_field


class _ChargeForce(ForceSystem):
    """A force on each charge by itself, in a field that is the same everywhere."""

    needs = (Charge, Transform, Velocity, Mass)
    columns = ((Charge, "charge"),)
    couples_nothing = is_everywhere = True


class ElectricFieldSystem(_ChargeForce):
    """Pushes every charge by q E."""

    kernels = (packed_forces.uniform_gravity,)
    potential = "electric_field"

    def why_left_out(self, state: State) -> str | None:
        """Needed where there is a field, and a charge that it can move."""
        return super().why_left_out(state) or (
            None if state.physics.electric_field else sentence("no_electric_field")
        )

    def packed(self, state: State, layout: StateLayout) -> PackedForce:
        """Return the push for compiled integrators."""
        rows, charge = state.batch(*self.needs).rows, state.table(Charge)["charge"]
        return packed_field(state, layout, rows, charge, state.physics.electric_field, FIELDS)

    def rounding_floor(self, state: State) -> float:
        """Return that of the largest push."""
        rows = state.batch(*self.needs).rows
        pushes = np.abs(state.table(Charge)["charge"][rows]) * state.bodies.inverse_mass[rows]
        return ROUNDING * float(pushes.max(initial=0.0)) * state.physics.electric_field.magnitude

    def potential_energy(self, state: State) -> float:
        """Return the sum of -q E . x [J], zero at the origin."""
        return field_energy(state, state.table(Charge)["charge"], state.physics.electric_field)


class MagneticFieldSystem(_ChargeForce):
    """Turns the velocity of every charge, by F = q B (vy, -vx): clockwise where q B is positive."""

    kernels = (magnetic_field,)

    def why_left_out(self, state: State) -> str | None:
        """Needed where there is a field, and a charge that can move."""
        return super().why_left_out(state) or (
            None if state.physics.magnetic_field else sentence("no_magnetic_field")
        )

    def packed(self, state: State, layout: StateLayout) -> PackedForce:
        """Return the force for methods that do not turn velocities by themselves."""
        rows = state.batch(*self.needs).rows
        rows = rows[(state.bodies.inverse_mass[rows] > 0.0) & (layout.place[rows] >= 0)]
        indices = np.concatenate(([len(rows)], layout.place[rows], (-1,)))
        strength = state.table(Charge)["charge"][rows] * state.physics.magnetic_field
        return PackedForce(magnetic_field, strength, indices, work_slots=((FIELDS, len(rows) + 1),))

    def add_packed(self, state: State, h: float) -> None:
        """Add the force, but not within a step to bodies that are sub-integrated: these are turned by it."""
        if h == 0.0 or not state.bodies.sub_integrated.any():
            super().add_packed(state, h)

    def gyration(self, state: State) -> NDArray[np.float64]:
        """Return for each row q B / m [rad/s]."""
        rates: NDArray[np.float64] = state.table(Charge)["charge"] * state.bodies.inverse_mass
        return rates * state.physics.magnetic_field

    def rates(self, state: State) -> NDArray[np.float64]:
        """Return for each row the size of q B / m [rad/s]."""
        return np.abs(self.gyration(state))

    def depends_on_velocity(self, state: State) -> bool:
        """Return True: it depends on nothing else."""
        return True
