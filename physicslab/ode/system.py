"""The smooth motion of a world as one system of ordinary differential equations."""

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform, Velocity
from physicslab.ecs.table import as_slice
from physicslab.kernels import direct_entry
from physicslab.kernels.accounts import FIELDS
from physicslab.kernels.forces.budget import ACCOUNTS
from physicslab.kernels.forces.force_calls import add_forces
from physicslab.kernels.forces.inverse_square import PLAIN_LIMIT
from physicslab.kernels.joints.layout import FIRST
from physicslab.kernels.joints.rows import constrain, project, set_going
from physicslab.ode.budget import BudgetLayout
from physicslab.ode.python_forces import PythonForces
from physicslab.ode.steady_turn import turn_steadily
from physicslab.state.packed import StateLayout, share_steepness, way_and_size
from physicslab.state.remainders import NO_REMAINDERS, Remainders, coordinate_keys
from physicslab.state.state import State
from physicslab.systems.joint_forces import solved_rows
from physicslab.systems.system import ForceSystem

_APART, _PUT = 1e-6, 1e-9
"""Share of the coordinates of bodies by which joints are apart after a step if they cannot be kept; and by
which they are before one if soft joints or an edit left them so: what methods leave is far less."""

NOTHING_WANTED = np.zeros(0), np.zeros((0, 0)), np.zeros((0, 0))
"""Moments at which the motion is wanted, of which there are none, and room for coordinates and rates."""


class OdeSystem:
    """Packed state and packed forces of a world in which nothing acts but forces.

    ``q`` holds the coordinates as :class:`StateLayout` orders them, and then the time; ``v`` their rates
    (zero for what is fixed, and there); q'' = ``inverse_mass`` * force - ``damping`` * v. Behind that, v
    takes what causes give, in four places for each account that this world needs; :meth:`scatter` books it.

    A force system that packs its force (:meth:`ForceSystem.packed`) is called without Python. One that does
    not is called back at its ``Stage.FORCE``, with the state that it reads in the world's tables, and the
    time of that state as ``state.time``: slower.

    Attributes
    ----------
    layout : StateLayout
        The place of each row.
    q, v : float64 arrays
        The state.
    inverse_mass : float64 array
        Inverse masses [1/kg] and inverse moments of inertia [1/(kg m^2)] of moving bodies.
    damping : float64 array
        Rates of damping [1/s]; empty where nothing is damped.
    calls, resistances : int64 arrays (n, 3)
        Functions that kernels call for the forces, and for their resistance to motion.
    gyration : float64 array (bodies,)
        Where a splitting method advances it and fields turn velocities, the rate of each body [rad/s],
        clockwise; else empty.
    by_velocity : bool
        Whether any force depends on velocities.
    damped_calls : int64 array (n, 3)
        ``calls``, and what books the damping, for methods that do not book it themselves.
    slots : dict of int to int
        Where the account of each cause that is booked begins.
    places : int64 array
        Places of the budget for kernels (:mod:`physicslab.kernels.forces.budget`).
    near : int64 array and int, optional
        An order of the coordinates in which those that forces couple are near, and how near.
    form : tuple, optional
        A closed form of the motion, behind the ``laws`` for which it holds.
    free_bodies : int
        How many bodies move, where no force depends on the origin and they are few; else 0.
    steepness : float64 array (1,)
        Where attraction notes the square of the fastest rate of a free fall [1/s^2]; zero without one.
    laws : tuple, optional
        The numbers that masses and packed forces were made of; ``None`` where a force does not tell.
    tolerance : float
        Relative error a step for methods that choose their steps.
    most : int, optional
        The most evaluations of a flow by one of these, where it is not to be their own limit.
    wanted : tuple of float64 arrays (m,), (m, n) and (m, n)
        Times after the start [s] within the next flow, ascending, and what receives the coordinates of what
        moves, and their rates, at these; for methods that have them.
    forces : tuple of ForceSystem
        The forces that act.
    interpreted : bool
        Whether Python computes any of it.

    Parameters
    ----------
    state : State
        Whose motion.
    forces : sequence of ForceSystem
        The forces that act.
    part : bool array (rows,), optional
        The rows that take part; all by default.
    every_row : bool, optional
        Whether every row has its coordinates and its angle, be it fixed or not.
    also : tuple of int, optional
        Causes that need an account besides those of the forces.
    kicked : bool, optional
        Whether a splitting method is to advance it.
    """

    def __init__(
        self, state: State, forces: Sequence[ForceSystem], part: NDArray[np.bool_] | None = None, *,
        every_row: bool = False, also: tuple[int, ...] = (), kicked: bool = False,
    ) -> None:  # fmt: skip
        self.forces, self._also, self._kicked = tuple(forces), also, kicked
        self._every_row = every_row
        self.interpreted = any(not type(system).packs() for system in self.forces)
        self.layout = (
            StateLayout.of_rows(len(state.entity_index))
            if every_row
            else StateLayout(state, part, None if self.interpreted else [f.turned(state) for f in forces])
        )
        self._moving, self._turning = as_slice(self.layout.moving), as_slice(self.layout.turning)
        entities, self._carries = state.entity_index.entities, part is None
        self._keys = coordinate_keys(entities[self.layout.moving], entities[self.layout.turning])
        self._low: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None
        self.near: tuple[NDArray[np.int64], int] | None = None
        self.form: tuple[Any, Any] | None = None
        self.tolerance = state.simulation.tolerance
        self.most: int | None = None
        self.wanted = NOTHING_WANTED
        self._python: PythonForces | None = None
        self._clock = np.zeros(1)
        self._settings = self._look(state)
        self.laws: tuple[Any, ...] | None = None
        self._is_current = False
        self.q, self.v = np.zeros((2, 0))

    def _look(self, state: State) -> bytes:
        return state.bodies.inverse_mass.tobytes() + b"".join(f.settings(state) for f in self.forces)

    def outdated(self, state: State) -> bool:
        """Whether a number was changed that the layout, or the choice of a method, depends on."""
        return self._look(state) != self._settings

    def gather(self, state: State, *, unedited: bool = False) -> bool:
        """Take the state, the masses and the forces from the world's tables, unless these are known.

        Returns whether the state is that of the last :meth:`scatter`, since which all is ``unedited``.
        """
        inputs = self.laws if unedited else self._inputs(state)
        if inputs is None or inputs != self.laws:
            self._gather_laws(state)
            self.laws, unedited = inputs, False
        if not (unedited and self._is_current):
            self.gather_state(state)
            return False
        self._clock[0] = state.time
        self.q = np.concatenate((self.q[: self.layout.clock], *self._behind))
        self.v = np.concatenate((self.v[: self.layout.moving_count], self._still))
        self._begin()
        return True

    def _inputs(self, state: State) -> tuple[Any, ...] | None:
        """Return what masses and packed forces are made of, or ``None`` where a force does not give that."""
        found: list[Any] = [state.physics]
        for force in self.forces:
            numbers = force.inputs(state, self.layout)
            if numbers is None:
                return None
            found.append(numbers)
        bodies = state.bodies
        return *found, bodies.inverse_mass.tobytes(), bodies.inverse_inertia.tobytes()

    def _gather_laws(self, state: State) -> None:
        """Take the masses, the damping and the forces."""
        bodies, physics = state.bodies, state.physics
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
        self._calls(state)
        few = len(moving) <= PLAIN_LIMIT and self._carries
        self.free_bodies = len(moving) if few and not any(f.needs_origin(state) for f in self.forces) else 0

    def gather_state(self, state: State) -> None:
        """Take the state alone, where masses and forces are those of the last :meth:`gather`."""
        transform, velocity = state.table(Transform), state.table(Velocity)
        moving, turning, fixed = self._moving, self._turning, self.layout.fixed
        position, linear = transform["position"], velocity["linear"]
        self._clock[0] = state.time
        places = position[moving].ravel(), transform["angle"][turning], position[fixed].ravel()
        self.q = np.concatenate((*places, *self._behind))
        self.v = np.concatenate((linear[moving].ravel(), velocity["angular"][turning], self._still))
        self._begin()

    def _begin(self) -> None:
        self._low, self.wanted, self._is_current = None, NOTHING_WANTED, False
        self._start = (self.q.copy(), self.v.copy()) if self.interpreted else None

    def remainders(self, state: State) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return what rounding left out of the present q and v, of what moves; a method carries them on.

        A method changes both arrays in place; those that it leaves are kept for the next step by
        :meth:`scatter`. Where only a part of the world is advanced they begin with zero and are not kept:
        contacts act in between.
        """
        n = self.layout.moving_count
        if not self._carries:
            return np.zeros(n), np.zeros(n)
        if self._low is not None:
            return self._low  # of an earlier call since the state was gathered
        self._low = state.remainders.of(self._keys, self.q[:n], self.v[:n])
        return self._low

    @contextmanager
    def aside(self) -> Iterator[None]:
        """Let a method be tried in a ``with`` block: after it the state is as it was gathered."""
        q, v, steepness = self.q.copy(), self.v.copy(), self.steepness.copy()
        try:
            yield
        finally:
            self.q, self.v, self._low = q, v, None
            self.steepness[:] = steepness

    def scatter(self, state: State, span: float) -> None:
        """Put the state back into the tables; what no force turns has turned steadily for ``span`` s."""
        self._raise()
        layout = self.layout
        if not self._every_row:
            self.hold_together()
        self.write(state)
        self._book(state)
        n = layout.moving_count
        if self._low is not None:
            state.remainders = Remainders(self._keys, self.q[:n], self.v[:n], *self._low)
        elif self._carries:
            state.remainders = NO_REMAINDERS
        self._note_rates(state)
        self._is_current = True
        if len(layout.steady):
            turn_steadily(state, layout.steady, span)

    def set_going(self) -> None:
        """Change speeds that joints do not allow, and bring motors to theirs, by impulses."""
        if self._joints is not None:
            direct_entry(set_going)(self.q, self.v, *self.joints)

    def placed_together(self) -> NDArray[np.float64] | None:
        """Return places with which joints hold, where those of now are apart by more than rounding.

        ``None`` where they are not, and where joints contradict each other.
        """
        if self._joints is None:
            return None
        q, n = self.q.copy(), self.layout.moving_count
        left = direct_entry(project)(q, self.v.copy(), np.zeros(n), np.zeros(n), *self.joints)
        if q.tobytes() == self.q.tobytes():
            return None
        moved, size = way_and_size(self.q[:n], q[:n])
        return q if moved > _PUT * size and left <= _APART * moved else None

    def place(self, state: State, q: NDArray[np.float64]) -> None:
        """Put what moves at other places, coordinates (n,) like ``q`` [m and rad], in the tables too."""
        self.q = q
        self._write(state, q, self.v)

    def hold_together(self) -> NDArray[np.float64]:
        """Put together again what joints hold together; return the coordinates before (n,) [m and rad]."""
        n = self.layout.moving_count
        before = self.q[:n]
        if self._joints is not None:
            before, low = before.copy(), self._low or np.zeros((2, n))
            direct_entry(project)(self.q, self.v, *low, *self.joints)
        return before

    def was_apart(self, before: NDArray[np.float64]) -> bool:
        """Whether coordinates (n,) ``before`` joints were put together differ by more than a method errs."""
        if before.tobytes() == self.q[: len(before)].tobytes():  # which is found in a tenth of the time
            return False
        moved, size = way_and_size(before, self.q[: len(before)])
        return moved > _APART * size

    def find_joint_forces(self, state: State) -> None:
        """Find the forces of joints in the present state of motion, where nothing touches."""
        if self._joints is not None:
            direct_entry(add_forces)(self.q, self.v, np.zeros(len(self.q)), self.calls)
            rows, _, pivots = self._solved  # those that depend on others get no force
            state.joints.force[:] = 0.0
            self.add_joint_forces(state)
            state.joints.dependent[rows] = self._joints.parameters[pivots] == 0.0

    def add_joint_forces(self, state: State) -> None:
        """Add the forces [N or N m] of joints as they were found last."""
        if self._joints is not None:
            rows, forces, _ = self._solved
            state.joints.force[rows] += self._joints.parameters[forces]

    @property
    def joined(self) -> bool:
        """Whether joints hold what moves."""
        return self._joints is not None

    @property
    def joints(self) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """The rows of joints, their numbers and whole numbers, as they are packed; none without joints."""
        rows = self._joints
        return (np.zeros(0), np.zeros(FIRST, np.int64)) if rows is None else (rows.parameters, rows.indices)

    def _book(self, state: State) -> None:
        """Book what causes have given since the state was gathered."""
        for cause, first in self.slots.items():
            state.account.sums[cause] += self.v[first : first + ACCOUNTS]

    def _note_rates(self, state: State) -> None:
        """Note the fastest rates that forces met, wherever within the steps that was."""
        for system in self._measured:
            rate = math.sqrt(self.steepness[0])
            state.fastest_rates[system.name] = max(rate, state.fastest_rates.get(system.name, 0.0))
        self.steepness[0] = 0.0

    def undo(self, state: State) -> bool:
        """Write back the state from which a method that failed began; return whether Python had changed it.

        Raises
        ------
        BaseException
            The error of a force in Python, if that is why it failed.
        """
        self._raise()
        if self._start is not None:
            self._write(state, *self._start)
        return self.interpreted

    def _raise(self) -> None:
        """Raise the error of a force in Python, if there was one."""
        if self._python is not None:
            self._python.raise_error()

    def write(self, state: State) -> None:
        """Put places and rates, and the forces of joints with them, into the tables."""
        if not self._every_row:
            self.find_joint_forces(state)
        self._write(state, self.q, self.v)

    def _write(self, state: State, q: NDArray[np.float64], v: NDArray[np.float64]) -> None:
        layout, transform, velocity = self.layout, state.table(Transform), state.table(Velocity)
        n, d = 2 * len(layout.moving), layout.moving_count
        transform["position"][self._moving] = q[:n].reshape(-1, 2)
        velocity["linear"][self._moving] = v[:n].reshape(-1, 2)
        transform["angle"][self._turning] = q[n:d]
        velocity["angular"][self._turning] = v[n:d]

    def _calls(self, state: State) -> None:
        self.by_velocity = any(force.depends_on_velocity(state) for force in self.forces)
        turned = [rates for force in self.forces if (rates := force.gyration(state)) is not None]
        drifts = self._kicked and bool(turned)  # a splitting turns velocities exactly, within its drifts
        self.gyration = np.sum(turned, axis=0)[self.layout.moving] if drifts else np.zeros(0)
        packed = share_steepness(
            (system, system.packed(state, system.seen(self.layout)) if type(system).packs() else None)
            for system in self.forces
            if not (drifts and system.gyration(state) is not None)
        )
        also = (*self._also, FIELDS) if drifts else self._also
        book = BudgetLayout(state, self.layout, packed, self.damping, also, kicked=self._kicked)
        self.slots, self.places = book.slots, book.places
        self._behind = self._clock, np.zeros(book.count)
        self._still = np.zeros(2 * len(self.layout.fixed) + 1 + book.count)
        forces = [force for _, force in packed if force is not None]
        # After the number of coordinates: resistances get several velocities in one array.
        size = self.layout.clock + 1 + book.count
        resisting = [
            (force.resistance, force.parameters, np.concatenate(([size], force.indices)))
            for force in forces
            if force.resistance is not None
        ]
        self._joints = next((force for force in forces if force.kernel is constrain), None)
        self._solved = solved_rows(self.joints[1])
        measured = [(system, force) for system, force in packed if force and force.max_rate_slot is not None]
        self._measured = [system for system, _ in measured]
        self.steepness = measured[-1][1].parameters[-1:] if measured else np.zeros(1)
        damping = book.damping(self.damping, self.inverse_mass)
        booked = [call for system, force in packed if force for call in book.around(system, force)]
        self._kept: list[Any] = [*booked, *resisting, damping]  # while C may read them
        kernels = [force.kernel for force in (*booked, *damping)]
        joining = (project, set_going, add_forces) if self._joints is not None else ()
        state.compile([*kernels, *(kernel for kernel, _, _ in resisting), *joining])
        last = [force.call for force in booked if force is self._joints]  # they follow from all others
        rows = [force.call for force in booked if force is not self._joints]
        against = [(kernel.address, n.ctypes.data, indices.ctypes.data) for kernel, n, indices in resisting]
        self.resistances = np.array(against, np.int64).reshape(-1, 3)
        python = [system for system, force in packed if force is None]
        if python:
            self._python = PythonForces(state, python, self.layout, book, size, self._write)
            rows.append((self._python.address, 0, 0))
        rows += last
        self.calls = np.array(rows, np.int64).reshape(-1, 3)
        self.damped_calls = np.array([*rows, *(force.call for force in damping)], np.int64).reshape(-1, 3)
