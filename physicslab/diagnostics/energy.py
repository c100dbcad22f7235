"""Energies, momenta and penetration: pure functions over a world, the one source of these figures."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from physicslab.components import Mass, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.kernels import energy
from physicslab.systems.system import ForceSystem
from physicslab.world import World

__all__ = ["Drift", "Energy", "Momentum", "measure_energy", "measure_momentum", "summation"]


@dataclass(frozen=True, slots=True)
class Energy:
    """The energy of a world [J]; what is static, kinematic or held does not count.

    Attributes
    ----------
    kinetic_linear, kinetic_angular : float
        Of translation and of rotation.
    potential : dict of str to float
        What each running force stores, by the force's name ("gravity", "spring", ...).
    """

    kinetic_linear: float
    kinetic_angular: float
    potential: dict[str, float]

    @property
    def kinetic(self) -> float:
        """Kinetic energy [J]."""
        return self.kinetic_linear + self.kinetic_angular

    @property
    def total(self) -> float:
        """Kinetic and potential energy [J]."""
        return self.kinetic + sum(self.potential.values())


@dataclass(frozen=True, slots=True)
class Momentum:
    """The momentum [kg m/s] of a world and its angular momentum about the origin [kg m^2/s]."""

    linear: Vector2
    angular: float


def _motion(world: World) -> tuple[float, float, float, float, float]:
    world.synchronise()
    world.compile((energy.motion_totals,))
    velocity, mass = world.table(Velocity), world.table(Mass)
    return energy.motion_totals(
        world.table(Transform)["position"], velocity["linear"], velocity["angular"],
        mass["mass"], mass["inertia"], world.bodies.inverse_mass, world.bodies.inverse_inertia,
    )  # fmt: skip


@np.errstate(all="ignore")  # an energy may be infinite, and says so itself
def measure_energy(world: World) -> Energy:
    """Return the energy of the world as it is now."""
    translation, rotation, *_ = _motion(world)
    potential: dict[str, float] = {}
    with world.active():
        for system in world.schedule.running:
            if isinstance(system, ForceSystem) and system.potential is not None:
                stored = system.potential_energy(world)
                potential[system.potential] = potential.get(system.potential, 0.0) + stored
    return Energy(translation, rotation, potential)


def measure_momentum(world: World) -> Momentum:
    """Return the momentum and angular momentum of the world as it is now."""
    _, _, px, py, spin = _motion(world)
    return Momentum(Vector2(px, py), spin)


class Drift:
    """The largest departure of the total energy from where it began.

    Attributes
    ----------
    initial, latest : Energy
        At the start, and at the last :meth:`sample`.
    largest : float
        The largest |E - E0| so far [J].
    """

    def __init__(self, world: World) -> None:
        self.initial = self.latest = measure_energy(world)
        self.largest = 0.0
        self._scale = self.initial.kinetic

    def sample(self, world: World) -> None:
        """Measure the energy as it is now."""
        self.latest = measure_energy(world)
        # numpy's maximum, unlike max, lets NaN through.
        self.largest = float(np.maximum(self.largest, abs(self.latest.total - self.initial.total)))
        self._scale = max(self._scale, self.latest.kinetic)

    @property
    def relative(self) -> float:
        """The largest departure as a share of |E0|; of the largest kinetic energy seen where E0 is zero."""
        scale = abs(self.initial.total) or self._scale
        return self.largest / scale if scale > 0.0 else 0.0


def summation(world: World) -> str:
    """Return how the running forces are summed, where one has something to say of it."""
    forces = (system for system in world.schedule.running if isinstance(system, ForceSystem))
    return "; ".join(said for force in forces if (said := force.summation(world)))
