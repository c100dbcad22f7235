"""Gravity: uniform, or pairwise between planets."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Held, Mass, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.kernels import accounts
from physicslab.kernels.forces import gravity, packed_forces
from physicslab.kernels.forces.tree_pull import MAX_ERROR, RMS_ERROR, THETA
from physicslab.state.packed import PackedForce, StateLayout
from physicslab.state.state import State
from physicslab.systems.system import ForceSystem


class GravitySystem(ForceSystem):
    """Pulls every body with Mass: by m g, or towards every other by G m_a m_b / d^2.

    In planet mode a static body with Mass pulls and is not moved; a held one neither pulls nor is pulled.
    Very many are pulled by groups of others: :meth:`summation` says so, and how far off that is.
    """

    engine = True
    potential = "gravity"

    def __init__(self) -> None:
        self._attracting: NDArray[np.int64] = np.zeros(0, np.int64)
        self._pairwise = False

    def attach(self, state: State) -> None:
        """Note which rows attract each other."""
        self._pairwise = state.physics.gravity_mode == "planet"
        rows = state.batch(Transform, Mass).rows
        self._attracting = rows[~state.table(Held).present[rows]]

    def why_left_out(self, state: State) -> str | None:
        """Needed where the mode pulls and something can be pulled."""
        mode = state.physics.gravity_mode
        if mode == "none":
            return "gravity is switched off"
        if not len(state.batch(Velocity, Mass)):
            return "nothing that moves has Mass"
        if mode == "linear" and not state.physics.gravity:
            return "gravity is zero"
        if mode == "planet" and len(self._attracting) < 2:
            return "fewer than two bodies attract each other"
        if mode == "planet" and state.physics.G == 0.0:
            return "G is 0"
        return None

    def kernels_for(self, state: State) -> tuple[Any, ...]:
        """Return the kernel of the law that holds."""
        linear = state.physics.gravity_mode == "linear"
        return (packed_forces.uniform_gravity if linear else packed_forces.planet_gravity,)

    def uniform_acceleration(self, state: State) -> Vector2 | None:
        """Return g; planets attract each other differently from place to place."""
        return state.physics.gravity if state.physics.gravity_mode == "linear" else None

    def packed(self, state: State, layout: StateLayout) -> PackedForce:
        """Return the pull for compiled integrators."""
        physics, mass = state.physics, state.table(Mass)["mass"]
        if physics.gravity_mode == "linear":
            rows = np.flatnonzero((state.bodies.inverse_mass > 0.0) & (layout.place >= 0))
            indices = np.concatenate(([len(rows)], layout.place[rows], (-1,)))
            total = mass[rows].sum()
            parameters = np.concatenate(((physics.gravity.x, physics.gravity.y), mass[rows], (total,)))
            books = ((accounts.GRAVITY, len(indices) - 1),) if len(rows) else ()
            return PackedForce(packed_forces.uniform_gravity, parameters, indices, books=books)
        rows = self._attracting
        indices = np.concatenate(([len(rows), physics.softening_law == "plummer"], layout.place[rows]))
        parameters = np.concatenate(((physics.G, physics.softening), mass[rows], (0.0,)))
        anchors = layout.place[rows[state.bodies.inverse_mass[rows] == 0.0]]
        return PackedForce(
            packed_forces.planet_gravity, parameters, indices, steepest=2 + len(rows), books=(),
            anchors=anchors if len(anchors) else None, cause=accounts.GRAVITY,
        )  # fmt: skip

    def needs_origin(self, state: State) -> bool:
        """Only the pull of bodies that stay where they are depends on it."""
        return self._pairwise and not state.table(Velocity).present[self._attracting].all()

    def inputs(self, state: State, layout: StateLayout) -> bytes:
        """Return every mass: those of fixed bodies pull too."""
        return state.table(Mass)["mass"].tobytes()

    def strongest_rate(self, state: State) -> float:
        """Return the largest sqrt(G (m_a + m_b) / d^3) of any pair at present; 0 for uniform gravity."""
        physics = state.physics
        if physics.gravity_mode == "linear":
            return 0.0
        state.compile((gravity.fastest_fall,))
        return gravity.fastest_fall(
            state.table(Transform)["position"], state.table(Mass)["mass"], self._attracting,
            physics.G, physics.softening, physics.softening_law == "plummer",
        )  # fmt: skip

    def couples(self, state: State) -> NDArray[np.int64] | None:
        """Uniform gravity couples nothing, that of planets every body with every other."""
        return np.zeros((0, 2), np.int64) if state.physics.gravity_mode == "linear" else None

    def why_singular(self, state: State) -> str | None:
        """Say that planets may come close, where they attract each other."""
        return "planets may come close" if self.attractors > 1 else None

    @property
    def attractors(self) -> int:
        """How many bodies attract each other; none where gravity is uniform."""
        return len(self._attracting) if self._pairwise else 0

    def summation(self, state: State) -> str:
        """Return how pairs are summed, as :mod:`physicslab.kernels.forces.gravity` decides by number."""
        n = self.attractors
        if state.physics.gravity_mode != "planet" or n <= gravity.PLAIN_LIMIT:
            return ""
        if n < gravity.TREE_THRESHOLD:
            return f"each pair of {n} bodies, in vectors"
        return (
            f"Barnes-Hut tree of {n} bodies, theta {THETA:g}: forces within {RMS_ERROR:g} of the mean one by "
            f"root mean square, {MAX_ERROR:g} at most; momentum is kept as well as they are right"
        )

    def potential_energy(self, state: State) -> float:
        """Return the sum of -m g . x [J], zero at the origin, or the pairs' energy, zero at infinity."""
        physics, mass = state.physics, state.table(Mass)["mass"]
        position = state.table(Transform)["position"]
        if physics.gravity_mode == "linear":
            g = physics.gravity
            state.compile((gravity.uniform_potential,))
            return gravity.uniform_potential(position, mass, state.bodies.inverse_mass, g.x, g.y)
        state.compile((gravity.planet_potential,))
        return gravity.planet_potential(
            position, mass, self._attracting,
            physics.G, physics.softening, physics.softening_law == "plummer",
        )  # fmt: skip
