"""Energies and momenta: pure functions over a world, the one source of these figures."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from physicslab.components import Mass, Material, Shape, Spring, Transform, Velocity
from physicslab.ecs.vector import Vector2
from physicslab.kernels import energy
from physicslab.world import World

__all__ = [
    "Drift",
    "Energy",
    "Momentum",
    "energy_changers",
    "measure_energy",
    "measure_momentum",
    "summation",
]


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
    def total(self) -> float:
        """Kinetic and potential energy [J]."""
        return self.kinetic + sum(self.potential.values())


@dataclass(frozen=True, slots=True)
class Momentum:
    """The momentum [kg m/s] of a world and its angular momentum about the origin [kg m^2/s]."""

    linear: Vector2
    angular: float


def _motion(world: World) -> tuple[float, float, float, float, float, float, float]:
    world.synchronise()
    world.compile((energy.motion_totals,))
    velocity, mass = world.table(Velocity), world.table(Mass)
    return energy.motion_totals(
        world.table(Transform)["position"], velocity["linear"], velocity["angular"],
        mass["mass"], mass["inertia"], world.bodies.inverse_mass, world.bodies.inverse_inertia,
    )  # fmt: skip


@np.errstate(all="ignore")  # an energy may be infinite, and is returned as such
def measure_energy(world: World) -> Energy:
    """Return the energy of the world as it is now."""
    translation, rotation, *_ = _motion(world)
    potential: dict[str, float] = {}
    with world.active():
        for force in world.schedule.forces:
            if force.potential is not None:
                stored = force.potential_energy(world)
                potential[force.potential] = potential.get(force.potential, 0.0) + stored
    return Energy(translation, rotation, potential)


def measure_momentum(world: World) -> Momentum:
    """Return the momentum and angular momentum of the world as it is now."""
    _, _, px, py, spin, _, _ = _motion(world)
    return Momentum(Vector2(px, py), spin)


_TAKING = ("impacts and friction", "dampers", "damping", "drag")
"""What takes energy and never gives any."""


def energy_changers(world: World) -> list[str]:
    """Return what changes the energy of a world by law; where it is nothing, any change is an error."""
    found = []
    if world.plan.collisions != "none" and _contacts_take_energy(world):
        found.append("impacts and friction")
    rows = world.batch(Spring).rows
    if np.any(world.table(Spring)["damping"][rows]):
        found.append("dampers")
    if world.physics.linear_damping or world.physics.angular_damping:
        found.append("damping")
    forces = world.schedule.forces
    found += [force.name.removesuffix("System").lower() for force in forces if force.potential is None]
    moving = world.batch(Transform, Velocity).rows
    if not world.table(Mass).present[moving].all():
        found.append("bodies that are driven")
    return found


def _contacts_take_energy(world: World) -> bool:
    """Whether a pair could lose energy: not where all give all of it back and what moves has no friction."""
    material, physics = world.table(Material), world.physics
    shaped, moving = world.batch(Shape).rows, world.batch(Shape, Velocity).rows
    bounds = physics.bounds is not None and physics.bounds_restitution < 1.0
    return bool(
        bounds or (material["restitution"][shaped] < 1.0).any() or (material["friction"][moving] > 0.0).any()
    )


class Drift:
    """How far the total energy departs from where it began, and how much of that is an error.

    Shares are of the energy that is exchanged: the largest kinetic energy seen, or the range of the potential
    energy if that is larger. Neither depends on where a potential is zero.

    Attributes
    ----------
    initial, latest : Energy
        At the start, and at the last :meth:`sample`.
    largest : float
        The largest |E - E0| so far [J].
    causes : tuple of str
        What changed the energy by law at any sample; such a change is no error.
    """

    def __init__(self, world: World) -> None:
        self.initial = self.latest = measure_energy(world)
        self.causes: tuple[str, ...] = tuple(energy_changers(world))
        self.largest = self._rise = 0.0
        self._kinetic, self._lowest = self.initial.kinetic, self.initial.total
        self._stored = (_stored(self.initial), _stored(self.initial))

    def sample(self, world: World) -> None:
        """Measure the energy as it is now."""
        self.latest = measure_energy(world)
        self.causes = tuple(dict.fromkeys((*self.causes, *energy_changers(world))))
        total, stored = self.latest.total, _stored(self.latest)
        # numpy's maximum, unlike max, keeps NaN.
        self.largest = float(np.maximum(self.largest, abs(total - self.initial.total)))
        self._rise = float(np.maximum(self._rise, total - self._lowest))
        self._lowest = min(self._lowest, total)
        self._kinetic = max(self._kinetic, self.latest.kinetic)
        self._stored = (min(self._stored[0], stored), max(self._stored[1], stored))

    @property
    def relative(self) -> float:
        """The largest departure, whatever caused it, as a share of the energy exchanged."""
        return self._share(self.largest)

    @property
    def error(self) -> float | None:
        """That part of the departure that no law explains, as a share of the energy exchanged.

        Where contacts, dampers or drag take energy, it is the largest rise: they give none, so that a rise is
        an error, and what they take is none. ``None`` where other forces or driven bodies do work.
        """
        if not self.causes:
            return self.relative
        return self._share(self._rise) if set(self.causes) <= set(_TAKING) else None

    def _share(self, energy: float) -> float:
        scale = max(self._kinetic, self._stored[1] - self._stored[0])
        return energy / scale if scale > 0.0 else 0.0


def _stored(energy: Energy) -> float:
    return sum(energy.potential.values())


def summation(world: World) -> str:
    """Return how the running forces are summed, where one does not add pair by pair; else nothing."""
    return "; ".join(words for force in world.schedule.forces if (words := force.summation(world)))
