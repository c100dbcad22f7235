"""The smooth motion of a world as one system of ordinary differential equations."""

from __future__ import annotations

import ctypes
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Spring, Transform, Velocity
from physicslab.kernels.forces.force_calls import ForceKernel
from physicslab.systems.schedule import ForceSystem, Stage

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["OdeSystem", "PackedForce", "StateLayout", "spring_ends", "why_not_smooth"]

_REAL = ctypes.POINTER(ctypes.c_double)
_WHOLE = ctypes.POINTER(ctypes.c_int64)
_CALLBACK = ctypes.CFUNCTYPE(None, _REAL, _REAL, ctypes.c_double, _REAL, _REAL, _WHOLE)


@dataclass(frozen=True, slots=True)
class PackedForce:
    """A force that compiled integrators call: its kernel, and what the kernel reads.

    Attributes
    ----------
    kernel : ForceKernel
        What adds to the forces.
    parameters, indices : float64 array, int64 array
        Whatever the kernel wants to know; it gets pointers to them.
    resistance : ForceKernel, optional
        What the force answers to another velocity than that of the moment, where it resists motion (see
        :mod:`physicslab.kernels.forces.resistance`).
    """

    kernel: ForceKernel
    parameters: NDArray[np.float64]
    indices: NDArray[np.int64]
    resistance: ForceKernel | None = None


class StateLayout:
    """Where each row of a world stands among the packed coordinates.

    First two coordinates for every row that moves, then an angle for every row that forces may turn, then the
    two coordinates of the rows that stay where they are, the world itself among them.

    Attributes
    ----------
    moving, turning, fixed : int64 arrays
        The rows in that order.
    steady : int64 array
        The rows that move and no force turns.
    place, turn : int64 arrays (rows,)
        Where x of a row stands, and where its angle; -1 for a row that has none, or takes no part.
    """

    def __init__(self, world: World, part: NDArray[np.bool_] | None, *, all_turn: bool) -> None:
        transform, velocity = world.table(Transform).present, world.table(Velocity).present
        if part is not None:
            transform = transform & part
        self.moving = np.flatnonzero(transform & velocity)
        turns = np.zeros(len(transform), np.bool_)
        turns[self.moving] = all_turn
        if not all_turn:
            turns[_swung(world)] = True
            turns &= transform & velocity
        self.turning = np.flatnonzero(turns)
        self.steady = np.setdiff1d(self.moving, self.turning, assume_unique=True)
        fixed = transform & ~velocity
        fixed[0] = True
        self.fixed = np.flatnonzero(fixed)
        n, m = len(self.moving), len(self.turning)
        self.place, self.turn = np.full((2, len(transform)), -1, np.int64)
        self.place[self.moving] = 2 * np.arange(n)
        self.turn[self.turning] = 2 * n + np.arange(m)
        self.place[self.fixed] = 2 * n + m + 2 * np.arange(len(self.fixed))

    @property
    def moving_count(self) -> int:
        """How many coordinates move."""
        return 2 * len(self.moving) + len(self.turning)


def spring_ends(world: World) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return the rows of the springs, of the bodies at their ends A, and at B (0 for the world)."""
    batch, spring, rows_of = world.batch(Spring), world.table(Spring), world.entity_index.rows_of
    a = spring["a"][batch.rows]
    return batch.rows, rows_of(np.where(a == 0, batch.entities, a)), rows_of(spring["b"][batch.rows])


def _swung(world: World) -> NDArray[np.int64]:
    """Return the rows that springs hold away from their middle, and so can turn."""
    rows, a, b = spring_ends(world)
    spring = world.table(Spring)
    off_a, off_b = spring["anchor_a"][rows].any(axis=1), spring["anchor_b"][rows].any(axis=1)
    return np.concatenate((a[off_a], b[off_b]))


class OdeSystem:
    """Packed state and packed forces of a world in which nothing acts but forces.

    ``q`` holds the coordinates as :class:`StateLayout` orders them, ``v`` their rates (zero for what is
    fixed); q'' = ``inverse_mass`` * force - ``damping`` * v.

    A force system that packs its force (:meth:`ForceSystem.packed`) is called without Python. One that does
    not is called back at its ``Stage.FORCE``, with the state that it reads in the world's tables: slower, and
    named in ``interpreted``.

    Attributes
    ----------
    slots : Slots
        Where each row stands.
    q, v : float64 arrays
        The state.
    inverse_mass : float64 array
        Of what moves: inverse masses [1/kg] and inverse moments of inertia [1/(kg m^2)].
    damping : float64 array
        Rates of damping [1/s]; empty where nothing is damped.
    calls, resistances : int64 arrays (n, 3)
        What kernels call for the forces, and for what of them resists motion.
    near : int64 array and int, optional
        An order of the coordinates in which those that forces couple are near, and how near; whoever needs
        it finds it once, as it hangs on the layout alone.
    tolerance : float
        Relative error a step for methods that choose their steps.
    forces, interpreted : tuple of str
        The force systems, and those of them that are not compiled.

    Parameters
    ----------
    world : World
        Whose motion.
    part : bool array (rows,), optional
        The rows that take part; all where nothing is said.
    """

    def __init__(self, world: World, part: NDArray[np.bool_] | None = None) -> None:
        self._forces = [system for system in world.schedule.running if isinstance(system, ForceSystem)]
        interpreted = [system for system in self._forces if not type(system).packs()]
        self.interpreted = tuple(system.name for system in interpreted)
        self.forces = tuple(system.name for system in self._forces)
        self.layout = StateLayout(world, part, all_turn=bool(interpreted))
        self.near: tuple[NDArray[np.int64], int] | None = None
        self.tolerance = world.simulation.tolerance
        self._error: BaseException | None = None
        self._settings = self._look(world)

    def _look(self, world: World) -> bytes:
        return world.bodies.inverse_mass.tobytes() + b"".join(f.settings(world) for f in self._forces)

    def outdated(self, world: World) -> bool:
        """Whether a number was changed that the layout, or the choice of a method, hangs on."""
        return self._look(world) != self._settings

    def gather(self, world: World) -> None:
        """Take the state, the masses and the forces from the world's tables."""
        self.gather_state(world)
        bodies, physics = world.bodies, world.physics
        moving, turning = self.layout.moving, self.layout.turning
        self.inverse_mass = np.concatenate(
            (np.repeat(bodies.inverse_mass[moving], 2), bodies.inverse_inertia[turning])
        )
        rates = physics.linear_damping, physics.angular_damping
        self.damping = np.zeros(0)
        if any(rates):
            pulled = np.concatenate((np.repeat(moving, 2), turning))
            rates_of = np.repeat(rates, (2 * len(moving), len(turning)))
            self.damping = rates_of * (bodies.inverse_mass[pulled] > 0.0)
        self._calls(world)

    def gather_state(self, world: World) -> None:
        """Take the state alone, where masses and forces are those of the last :meth:`gather`."""
        transform, velocity = world.table(Transform), world.table(Velocity)
        moving, turning, fixed = self.layout.moving, self.layout.turning, self.layout.fixed
        position, linear = transform["position"], velocity["linear"]
        self.q = np.concatenate(
            (position[moving].ravel(), transform["angle"][turning], position[fixed].ravel())
        )
        self.v = np.concatenate(
            (linear[moving].ravel(), velocity["angular"][turning], np.zeros(2 * len(fixed)))
        )

    def scatter(self, world: World, span: float) -> None:
        """Put the state back into the tables; what no force turns has turned steadily for ``span`` s."""
        if self._error is not None:
            error, self._error = self._error, None
            raise error
        slots, transform, velocity = self.layout, world.table(Transform), world.table(Velocity)
        self._write(world, self.q, self.v)
        steady = slots.steady
        if len(steady):
            spin, c = velocity["angular"][steady], world.physics.angular_damping
            free = world.bodies.inverse_mass[steady] > 0.0
            lasting = np.where(free & (c > 0.0), -np.expm1(-c * span) / (c or 1.0), span)
            transform["angle"][steady] += spin * lasting
            velocity["angular"][steady] = np.where(free, spin * np.exp(-c * span), spin)

    def _write(self, world: World, q: NDArray[np.float64], v: NDArray[np.float64]) -> None:
        slots, transform, velocity = self.layout, world.table(Transform), world.table(Velocity)
        n, d = 2 * len(slots.moving), slots.moving_count
        transform["position"][slots.moving] = q[:n].reshape(-1, 2)
        velocity["linear"][slots.moving] = v[:n].reshape(-1, 2)
        transform["angle"][slots.turning] = q[n:d]
        velocity["angular"][slots.turning] = v[n:d]

    def _calls(self, world: World) -> None:
        packed = [
            (system, system.packed(world, self.layout) if type(system).packs() else None)
            for system in self._forces
        ]
        forces = [force for _, force in packed if force is not None]
        # Behind how many coordinates there are, as resistances get several velocities in one.
        resisting = [
            (force.resistance, force.parameters, np.concatenate(([len(self.q)], force.indices)))
            for force in forces
            if force.resistance is not None
        ]
        self._kept: list[Any] = [*forces, *resisting]  # while C may read them
        world.schedule.compile([*(force.kernel for force in forces), *(kernel for kernel, _, _ in resisting)])
        rows = [
            (force.kernel.address, force.parameters.ctypes.data, force.indices.ctypes.data)
            for force in forces
        ]
        against = [(kernel.address, n.ctypes.data, indices.ctypes.data) for kernel, n, indices in resisting]
        self.resistances = np.array(against, np.int64).reshape(-1, 3)
        python = [system for system, force in packed if force is None]
        if python:
            callback = _CALLBACK(self._caller(world, python))
            self._kept.append(callback)
            rows.append((ctypes.cast(callback, ctypes.c_void_p).value or 0, 0, 0))
        self.calls = np.array(rows, np.int64).reshape(-1, 3)

    def _caller(self, world: World, systems: Iterable[ForceSystem]) -> Any:
        """Return a C function that lets force systems written in Python act on the world's tables."""
        methods = [getattr(system, type(system).marked()[Stage.FORCE]) for system in systems]
        slots, bodies = self.layout, world.bodies
        n, d, size = 2 * len(slots.moving), slots.moving_count, len(self.q)

        def call(q: Any, v: Any, _span: float, force: Any, parameters: Any, indices: Any) -> None:
            if self._error is not None:
                return
            try:
                self._write(world, np.ctypeslib.as_array(q, (size,)), np.ctypeslib.as_array(v, (size,)))
                bodies.force[:] = 0.0
                bodies.torque[:] = 0.0
                for method in methods:
                    method(world, 0.0)
                total = np.ctypeslib.as_array(force, (size,))
                total[:n] += bodies.force[slots.moving].ravel()
                total[n:d] += bodies.torque[slots.turning]
            except BaseException as error:  # C code cannot be unwound: it is raised when that has returned
                self._error = error

        return call


_WITHIN = {Stage.FORCE, Stage.KICK, Stage.DRIFT}
"""What happens at these stages is within the substeps of a world in which nothing touches."""


def why_not_smooth(world: World) -> str | None:
    """Return what else than forces acts on bodies within a step, or ``None``."""
    schedule = world.schedule
    if schedule.runs(Stage.BROAD_PHASE) or schedule.runs(Stage.CONTACT):
        return "bodies can touch"
    if not any(system.name == "IntegrateSystem" for system in schedule.running):
        return "nothing moves the bodies"
    for system in schedule.running:
        stages = set(type(system).marked()) & _WITHIN
        if isinstance(system, ForceSystem):
            stages -= {Stage.FORCE}
        if stages and system.name not in ("Bodies", "IntegrateSystem"):
            return f"{system.name} acts within the step"
    if (world.table(Velocity).present & ~world.table(Transform).present).any():
        return "something moves that is nowhere"
    return None
