"""Quantities of bodies, joints, springs and the world at one moment, by name: what graphs and meters show.

The names and units are in :mod:`physicslab.components.quantities`; sums over the world are those of
:mod:`physicslab.diagnostics.energy`.
"""

import math
from collections.abc import Callable
from functools import cached_property

import numpy as np

from physicslab.components import Mass, Spring, Transform, Velocity
from physicslab.components.quantities import (
    ENERGY_CAUSES,
    JOINT,
    MOMENTUM_CAUSES,
    UNMEASURED_MOMENTA,
    carrier_of,
)
from physicslab.diagnostics.energy import Accounts, measure_account
from physicslab.diagnostics.free_body import forces_on, net_force
from physicslab.diagnostics.joints import JointState, joint_states
from physicslab.diagnostics.period import spring_state
from physicslab.diagnostics.present_forces import with_present_forces
from physicslab.ecs.vector import Vector2
from physicslab.state.account import Energy, Momentum
from physicslab.state.joint_rows import KINDS
from physicslab.state.masses import quiet
from physicslab.state.packed import spring_ends
from physicslab.systems.spring import spring_energy
from physicslab.world import World

_NAN = math.nan
NOT_YET = "known after the first step"
"""Why forces have no value where not even a short step of a copy can be made."""


class Reading:
    """The quantities of a world as it is now. Measurements that several of them need are made once.

    Parameters
    ----------
    world : World
        It must stay as it is while it is read.
    account : Accounts, optional
        Its accounts as they are now, if they were measured already.

    Examples
    --------
    >>> from physicslab.systems.integrate import IntegrateSystem
    >>> world = World(IntegrateSystem())
    >>> ball = world.spawn(Transform((0, 5)), Velocity((3, 4)), Mass(2.0))
    >>> reading = Reading(world)
    >>> reading.value("speed", ball), reading.value("kinetic energy", ball), reading.value("kinetic energy")
    (5.0, 25.0, 25.0)
    >>> reading.value("speed", 99)
    nan
    """

    def __init__(self, world: World, account: Accounts | None = None) -> None:
        world.synchronise()
        self._world = world
        self._account = account
        self._rows = world.entity_index.row_of
        self._nets: dict[int, Vector2] = {}

    def value(self, name: str, body: int | None = None) -> float:
        """Return a quantity in its SI unit, of a body, a joint or a spring, or of the world for ``None``.

        It is NaN where it is not defined (:func:`why_undefined`).

        Raises
        ------
        KeyError
            If no entity, or the world, has such a quantity at all.
        """
        if body is None:
            return float(_OF_WORLD[name](self))
        read = _OF_BODY[name]
        if _why_undefined(self._world, name, body):
            return _NAN
        return float(read(self, body))

    # ---- of the world --------------------------------------------------------------------------------------

    @cached_property
    def account(self) -> Accounts:
        """Changes of energy and momentum of the world by cause, and their present values."""
        return measure_account(self._world) if self._account is None else self._account

    @property
    def energy(self) -> Energy:
        """The energy of the world."""
        return self.account.parts

    @property
    def momentum(self) -> Momentum:
        """The momentum of the world."""
        now = self.account.now
        return Momentum(Vector2(now.px, now.py), now.spin)

    def impulse(self, cause: str) -> Vector2:
        """Return the momentum that a cause brought from outside [N s]; NaN where that is not measured."""
        return self.account.momentum.get(cause, Vector2(_NAN, _NAN))

    # ---- of a body -----------------------------------------------------------------------------------------

    def _place(self, body: int) -> Vector2:
        return self._world.component(body, Transform).position

    def _velocity(self, body: int) -> Vector2:
        return self._world.component(body, Velocity).linear

    def _spin(self, body: int) -> float:
        return self._world.component(body, Velocity).angular

    def _mass(self, body: int) -> float:
        return self._world.component(body, Mass).mass

    def _momentum(self, body: int) -> Vector2:
        return self._mass(body) * self._velocity(body)

    def _inertia(self, body: int) -> float:
        """Return the moment of inertia [kg m^2]; 0 of what does not turn, and of points."""
        inverse = float(self._world.bodies.inverse_inertia[self._rows[body]])
        return 1.0 / inverse if inverse > 0.0 else 0.0

    def _angular_momentum(self, body: int) -> float:
        return self._place(body).cross(self._momentum(body)) + self._inertia(body) * self._spin(body)

    def _translation(self, body: int) -> float:
        return 0.5 * self._mass(body) * self._velocity(body).magnitude_squared

    def _rotation(self, body: int) -> float:
        return 0.5 * self._inertia(body) * self._spin(body) ** 2

    def _kinetic(self, body: int) -> float:
        return self._translation(body) + self._rotation(body)

    def _net(self, body: int) -> Vector2:
        if body not in self._nets:
            self._nets[body] = net_force(forces_on(self._world, body))
        return self._nets[body]

    def _acceleration(self, body: int) -> Vector2:
        return self._net(body) / self._mass(body)

    @quiet
    def _potential(self, body: int) -> float:
        """Return that of weight, zero at the origin, and of the springs that hold it to what cannot move."""
        world, total = self._world, 0.0
        if any(force.potential == "gravity" for force in world.schedule.forces):
            total -= self._mass(body) * world.physics.gravity.dot(self._place(body))
        rows, a, b = spring_ends(world)
        own = (a == self._rows[body]) | (b == self._rows[body])
        if own.any():
            total += spring_energy(world, rows[own], a[own], b[own])
        return total

    # ---- of a joint or a spring ----------------------------------------------------------------------------

    @cached_property
    def _joints(self) -> dict[int, JointState]:
        return {joint.entity: joint for joint in joint_states(self._world)}

    def _joint_force(self, entity: int) -> Vector2:
        """Return the force of a joint on its B [N]."""
        return self._joints[entity].force

    def _joint_torque(self, entity: int) -> float:
        return self._joints[entity].torque

    def _spring_force(self, entity: int) -> float:
        """Return the force of a spring [N], positive where it pulls its ends together."""
        spring = spring_state(self._world, entity)
        return _NAN if spring is None else spring.force


def why_undefined(world: World, name: str, body: int | None) -> str:
    """Return in a few words why a quantity has no value now; empty where it has one."""
    world.synchronise()
    return _why_undefined(world, name, body)


def _why_undefined(world: World, name: str, body: int | None) -> str:
    if body is None:
        unmeasured = "impulse" in name and name.partition(": ")[2] in UNMEASURED_MOMENTA
        return "not measured by itself: it is part of that of contacts" if unmeasured else ""
    if body not in world.entity_index.row_of:
        return "gone"
    if carrier_of(name) != "Transform":
        return _why_not_carried(world, carrier_of(name), body)
    if not world.has(body, Transform):
        return "has no place"
    if name in ("x", "y", "angle"):
        return ""
    if not world.has(body, Velocity):
        return "is fixed"
    if name in ("velocity x", "velocity y", "speed", "angular velocity"):
        return ""
    if not world.has(body, Mass):
        return "has no mass"
    return _why_no_potential(world, body) if name in ("potential energy", "total energy") else ""


def _why_not_carried(world: World, carrier: str, entity: int) -> str:
    """Return why an entity has not the one joint or the spring of which a quantity is."""
    if carrier != JOINT:
        return "" if world.has(entity, Spring) else "has no spring"
    count = sum(world.has(entity, kind) for kind in KINDS)
    if count != 1:
        return "has several joints" if count else "has no joint"
    return "" if with_present_forces(world).forces_known else NOT_YET


def _why_no_potential(world: World, body: int) -> str:
    """Return why a body has no potential energy of its own: it then belongs to several together."""
    stored = {force.potential for force in world.schedule.forces} - {None, "gravity", "spring"}
    if stored:
        return f"shares the energy of {min(map(str, stored))} with others"
    is_attracted = any(force.potential == "gravity" for force in world.schedule.forces)
    if is_attracted and world.physics.gravity_mode == "planet":
        return "shares the energy of gravity with others"
    row = world.entity_index.row_of[body]
    _, a, b = spring_ends(world)
    moves = world.bodies.inverse_mass > 0.0
    is_shared = ((a == row) & moves[b]) | ((b == row) & moves[a])
    return "shares the energy of a spring with others" if np.any(is_shared) else ""


def _readers(
    kind: str, error: str, causes: tuple[str, ...], read: Callable[[Reading, str], float]
) -> dict[str, Callable[[Reading], float]]:
    """Return what reads each account of a kind, and its error, by the names of the quantities."""

    def reader(cause: str) -> Callable[[Reading], float]:
        return lambda now: read(now, cause)

    return {f"{kind}: {cause}": reader(cause) for cause in causes} | {error: reader("numerical")}


def _parts[**Of](name: str, size: str, read: Callable[Of, Vector2]) -> dict[str, Callable[Of, float]]:
    """Return what reads the parts and the size of a vector, by the names of the quantities."""
    return {
        f"{name} x": lambda *of, **more: read(*of, **more).x,
        f"{name} y": lambda *of, **more: read(*of, **more).y,
        size: lambda *of, **more: read(*of, **more).magnitude,
    }


_OF_WORLD: dict[str, Callable[[Reading], float]] = {
    **_parts("momentum", "momentum", lambda now: now.momentum.linear),
    "angular momentum": lambda now: now.momentum.angular,
    "kinetic energy": lambda now: now.energy.kinetic,
    "kinetic energy of translation": lambda now: now.energy.kinetic_linear,
    "kinetic energy of rotation": lambda now: now.energy.kinetic_angular,
    "potential energy": lambda now: now.energy.stored,
    "energy of gravity": lambda now: now.energy.potential.get("gravity", 0.0),
    "energy of springs": lambda now: now.energy.potential.get("spring", 0.0),
    "total energy": lambda now: now.energy.total,
    **_readers("account", "error of energy", ENERGY_CAUSES, lambda now, name: now.account.energy[name]),
    **_readers(
        "impulse x", "error of momentum x", MOMENTUM_CAUSES, lambda now, name: now.impulse(name).x
    ),
    **_readers(
        "impulse y", "error of momentum y", MOMENTUM_CAUSES, lambda now, name: now.impulse(name).y
    ),
    **_readers(
        "angular impulse", "error of angular momentum", MOMENTUM_CAUSES,
        lambda now, name: now.account.angular_momentum.get(name, _NAN),
    ),
}  # fmt: skip
_OF_BODY: dict[str, Callable[[Reading, int], float]] = {
    "x": lambda now, body: now._place(body).x,
    "y": lambda now, body: now._place(body).y,
    "angle": lambda now, body: now._world.component(body, Transform).angle,
    **_parts("velocity", "speed", Reading._velocity),
    "angular velocity": Reading._spin,
    **_parts("acceleration", "acceleration", Reading._acceleration),
    **_parts("force", "net force", Reading._net),
    **_parts("momentum", "momentum", Reading._momentum),
    "angular momentum": Reading._angular_momentum,
    "kinetic energy": Reading._kinetic,
    "kinetic energy of translation": Reading._translation,
    "kinetic energy of rotation": Reading._rotation,
    "potential energy": Reading._potential,
    "total energy": lambda now, body: now._kinetic(body) + now._potential(body),
    **_parts("joint force", "joint force", Reading._joint_force),
    "joint torque": Reading._joint_torque,
    "spring force": Reading._spring_force,
}
