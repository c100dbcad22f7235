"""Gravity: uniform, or pairwise between planets."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Held, Mass, Transform, Velocity
from physicslab.kernels.forces import gravity, packed_forces
from physicslab.kernels.forces.tree_pull import LARGEST_ERROR, RMS_ERROR, THETA
from physicslab.ode.system import PackedForce
from physicslab.systems.schedule import ForceSystem, Stage, at

if TYPE_CHECKING:
    from physicslab.ode.system import StateLayout
    from physicslab.world import World

__all__ = ["GravitySystem"]


class GravitySystem(ForceSystem):
    """Pulls every body with Mass: by m g, or towards every other by G m_a m_b / d^2.

    In planet mode a static body with Mass pulls and is not moved; a held one neither pulls nor is pulled.
    Very many are pulled by groups of others: :meth:`summation` says so, and how far off that is.
    """

    kernels = (
        gravity.uniform_gravity,
        gravity.uniform_potential,
        gravity.planet_gravity,
        gravity.planet_potential,
        gravity.fastest_fall,
    )
    potential = "gravity"

    def __init__(self) -> None:
        self._attracting: NDArray[np.int64] = np.zeros(0, np.int64)

    def attach(self, world: World) -> None:
        """Note which rows attract each other."""
        rows = world.batch(Transform, Mass).rows
        self._attracting = rows[~world.table(Held).present[rows]]

    def why_left_out(self, world: World) -> str | None:
        """Needed where the mode pulls and something can be pulled."""
        mode = world.physics.gravity_mode
        if mode == "none":
            return 'gravity_mode is "none"'
        if not len(world.batch(Velocity, Mass)):
            return "nothing that moves has Mass"
        if mode == "linear" and not world.physics.gravity:
            return "gravity is [0, 0]"
        if mode == "planet" and len(self._attracting) < 2:
            return "fewer than two bodies attract each other"
        if mode == "planet" and world.physics.G == 0.0:
            return "G is 0"
        return None

    def kernels_for(self, world: World) -> tuple[Any, ...]:
        """Return the kernels of one mode: those of planets take long to compile."""
        return self.kernels[:2] if world.physics.gravity_mode == "linear" else self.kernels[2:]

    @at(Stage.FORCE)
    def pull(self, world: World, h: float) -> None:
        """Add the pull to the forces."""
        bodies, physics, mass = world.bodies, world.physics, world.table(Mass)["mass"]
        if physics.gravity_mode == "linear":
            g = physics.gravity
            gravity.uniform_gravity(bodies.force, mass, bodies.inverse_mass, g.x, g.y)
        else:
            gravity.planet_gravity(
                bodies.force, world.table(Transform)["position"], mass, self._attracting,
                physics.G, physics.softening, physics.softening_law == "plummer",
            )  # fmt: skip

    def packed(self, world: World, slots: StateLayout) -> PackedForce:
        """Return the pull for compiled integrators."""
        physics, mass = world.physics, world.table(Mass)["mass"]
        if physics.gravity_mode == "linear":
            rows = np.flatnonzero((world.bodies.inverse_mass > 0.0) & (slots.place >= 0))
            indices = np.concatenate(([len(rows)], slots.place[rows]))
            parameters = np.concatenate(((physics.gravity.x, physics.gravity.y), mass[rows]))
            return PackedForce(packed_forces.uniform_gravity, parameters, indices)
        rows = self._attracting
        indices = np.concatenate(([len(rows), physics.softening_law == "plummer"], slots.place[rows]))
        parameters = np.concatenate(((physics.G, physics.softening), mass[rows]))
        return PackedForce(packed_forces.planet_gravity, parameters, indices)

    def strongest_rate(self, world: World) -> float:
        """Return the largest sqrt(G (m_a + m_b) / d^3) of any pair as they stand; 0 for uniform gravity."""
        physics = world.physics
        if physics.gravity_mode == "linear":
            return 0.0
        return gravity.fastest_fall(
            world.table(Transform)["position"], world.table(Mass)["mass"], self._attracting,
            physics.G, physics.softening, physics.softening_law == "plummer",
        )  # fmt: skip

    def couples(self, world: World) -> NDArray[np.int64] | None:
        """Uniform gravity couples nothing, that of planets every body with every other."""
        return np.zeros((0, 2), np.int64) if world.physics.gravity_mode == "linear" else None

    @property
    def attractors(self) -> int:
        """How many bodies attract each other."""
        return len(self._attracting)

    def summation(self, world: World) -> str:
        """Return how pairs are summed, as :mod:`physicslab.kernels.forces.gravity` decides by number."""
        n = self.attractors
        if world.physics.gravity_mode != "planet" or n <= gravity.FEW:
            return ""
        if n < gravity.MANY:
            return f"each pair of {n} bodies, in vectors"
        return (
            f"Barnes-Hut tree of {n} bodies, theta {THETA:g}: forces within {RMS_ERROR:g} of the mean one by "
            f"root mean square, {LARGEST_ERROR:g} at most; momentum is kept as well as they are right"
        )

    def potential_energy(self, world: World) -> float:
        """Return the sum of -m g . x [J], zero at the origin, or the pairs' energy, zero at infinity."""
        physics, mass = world.physics, world.table(Mass)["mass"]
        position = world.table(Transform)["position"]
        if physics.gravity_mode == "linear":
            g = physics.gravity
            return gravity.uniform_potential(position, mass, world.bodies.inverse_mass, g.x, g.y)
        return gravity.planet_potential(
            position, mass, self._attracting,
            physics.G, physics.softening, physics.softening_law == "plummer",
        )  # fmt: skip
