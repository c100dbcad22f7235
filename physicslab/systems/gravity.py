"""Gravity: uniform, or pairwise between planets."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Held, Mass, Transform, Velocity
from physicslab.ecs.sentences import sentence
from physicslab.ecs.vector import Vector2
from physicslab.kernels.accounts import GRAVITY
from physicslab.kernels.forces import packed_forces
from physicslab.state.packed import PackedForce, StateLayout
from physicslab.state.state import State
from physicslab.systems.inverse_square import InverseSquare
from physicslab.systems.system import ROUNDING, ForceSystem
from physicslab.systems.uniform_field import field_energy, packed_field


class GravitySystem(ForceSystem):
    """Pulls every body with Mass: by m g, or towards every other by G m_a m_b / d^2.

    In planet mode a static body with Mass pulls and is not moved; a held one neither pulls nor is pulled.
    Very many are pulled by groups of others: :meth:`summation` says so, and how far off that is.
    """

    engine = True
    account = GRAVITY
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
            return sentence("gravity_off")
        if not len(state.batch(Velocity, Mass)):
            return sentence("no_moving_mass")
        if mode == "linear" and not state.physics.gravity:
            return sentence("gravity_zero")
        if mode == "planet" and len(self._attracting) < 2:
            return sentence("few_attract")
        if mode == "planet" and state.physics.G == 0.0:
            return sentence("no_constant_of_gravity")
        return None

    def kernels_for(self, state: State) -> tuple[Any, ...]:
        """Return the kernel of the law that holds."""
        linear = state.physics.gravity_mode == "linear"
        return (packed_forces.uniform_gravity if linear else packed_forces.inverse_square,)

    def _attraction(self, state: State) -> InverseSquare:
        """Return the law between planets: a mass pulls, and yields to a pull, in proportion to itself."""
        mass = state.table(Mass)["mass"]
        return InverseSquare(self._attracting, state.physics.G, mass, mass, np.ones(len(mass)))

    def uniform_acceleration(self, state: State) -> Vector2 | None:
        """Return g; planets attract each other differently from place to place."""
        return state.physics.gravity if state.physics.gravity_mode == "linear" else None

    def packed(self, state: State, layout: StateLayout) -> PackedForce:
        """Return the pull for compiled integrators."""
        physics = state.physics
        if physics.gravity_mode == "linear":
            every, mass = np.arange(len(state.entity_index)), state.table(Mass)["mass"]
            return packed_field(state, layout, every, mass, physics.gravity, GRAVITY)
        return self._attraction(state).packed(state, layout, GRAVITY)

    def needs_origin(self, state: State) -> bool:
        """Only the pull of bodies that stay where they are depends on it."""
        return self._pairwise and not state.table(Velocity).present[self._attracting].all()

    def inputs(self, state: State, layout: StateLayout) -> bytes:
        """Return every mass: those of fixed bodies pull too."""
        return state.table(Mass)["mass"].tobytes()

    def strongest_rate(self, state: State) -> float:
        """Return the largest sqrt(G (m_a + m_b) / d^3) of any pair at present; 0 for uniform gravity."""
        return self._attraction(state).strongest_rate(state) if self._pairwise else 0.0

    def rounding_floor(self, state: State) -> float:
        """Return that of the weight, or of the largest sum of pulls."""
        pairs = self._pairwise
        return (
            self._attraction(state).rounding_floor(state) if pairs
            else ROUNDING * state.physics.gravity.magnitude
        )  # fmt: skip

    def couples(self, state: State) -> NDArray[np.int64] | None:
        """Uniform gravity couples nothing, that of planets every body with every other."""
        return np.zeros((0, 2), np.int64) if state.physics.gravity_mode == "linear" else None

    def why_singular(self, state: State) -> str | None:
        """Say that planets may come close, where they attract each other."""
        return sentence("planets_close") if self.attractors > 1 else None

    @property
    def attractors(self) -> int:
        """How many bodies attract each other; none where gravity is uniform."""
        return len(self._attracting) if self._pairwise else 0

    def summation(self, state: State) -> str:
        """Return how pairs are summed."""
        return self._attraction(state).summation() if self._pairwise else ""

    def potential_energy(self, state: State) -> float:
        """Return the sum of -m g . x [J], zero at the origin, or the pairs' energy, zero at infinity."""
        physics = state.physics
        if physics.gravity_mode == "linear":
            return field_energy(state, state.table(Mass)["mass"], physics.gravity)
        return self._attraction(state).potential_energy(state)
