"""Energies and momenta: pure functions over a world, the one source of these figures."""

from dataclasses import dataclass

import numpy as np

from physicslab.ecs.vector import Vector2
from physicslab.stepping.accounting import balance_of, motion_totals_of
from physicslab.world import World


@dataclass(frozen=True, slots=True)
class Energy:
    """The energy of a world [J]; bodies that are static, kinematic or held do not count.

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
    def stored(self) -> float:
        """Potential energy [J]; it may be negative, and where it is zero depends on the force."""
        return sum(self.potential.values())

    @property
    def total(self) -> float:
        """Kinetic and potential energy [J], added up in the order in which balances do (to the bit)."""
        return sum(self.potential.values(), self.kinetic)


@dataclass(frozen=True, slots=True)
class Momentum:
    """The momentum [kg m/s] of a world and its angular momentum about the origin [kg m^2/s]."""

    linear: Vector2
    angular: float


def _motion(world: World) -> tuple[float, float, float, float, float, float, float]:
    world.synchronise()
    return motion_totals_of(world)


def measure_kinetic(world: World) -> tuple[float, float]:
    """Return the kinetic energies of translation and of rotation [J]."""
    translation, rotation, *_ = _motion(world)
    return translation, rotation


@np.errstate(all="ignore")  # an energy may be infinite, and is returned as such
def measure_energy(world: World) -> Energy:
    """Return the energy of the world as it is now."""
    kinetic, potential = measure_kinetic(world), dict[str, float]()
    with world.active():
        balance_of(world, world.schedule.forces, potential)
    return Energy(*kinetic, potential)


def measure_momentum(world: World) -> Momentum:
    """Return the momentum and angular momentum of the world as it is now."""
    _, _, px, py, spin, _, _ = _motion(world)
    return Momentum(Vector2(px, py), spin)


def summation(world: World) -> str:
    """Return how the running forces are summed, where one does not add pair by pair; else nothing."""
    return "; ".join(words for force in world.schedule.forces if (words := force.summation(world)))
