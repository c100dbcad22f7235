"""Which accounts the forces of a world need, and the kernels that book beside them."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Velocity
from physicslab.kernels.accounts import ANGULAR_MOMENTUM, DAMPING, ENERGY, HAND, PX, PY
from physicslab.kernels.forces.budget import ACCOUNTS, gather, resist
from physicslab.state.packed import PackedForce, StateLayout
from physicslab.state.state import State
from physicslab.systems.system import ForceSystem

type Numbers = NDArray[np.float64]
"""A float64 array, of coordinates (d,), or of rows (rows, 2)."""
type Packed = Sequence[tuple[ForceSystem, PackedForce | None]]


class BudgetLayout:
    """The accounts of a world in which forces act, and their places behind the clock.

    Parameters
    ----------
    state : State
        Whose forces.
    layout : StateLayout
        The place of each row.
    packed : sequence of (ForceSystem, PackedForce or None)
        The forces; ``None`` for one that Python computes. Those that book themselves get their accounts.
    damping : float64 array
        Rates of damping; empty where nothing is damped.
    also : tuple of int
        Causes that need an account as well.
    kicked : bool
        Whether the method kicks, so that it needs forces that store nothing by themselves.

    Attributes
    ----------
    slots : dict of int to int
        Where the account of each cause begins.
    count : int
        How many places there are behind the clock.
    buffers : dict of int to int
        Start of the coordinates of each cause whose forces are kept by themselves.
    places : int64 array
        The places that integrators take (:data:`physicslab.kernels.forces.budget.KEPT`).
    layout : StateLayout
        As given.
    """

    def __init__(
        self, state: State, layout: StateLayout, packed: Packed, damping: Numbers, also: tuple[int, ...],
        *, kicked: bool,
    ) -> None:  # fmt: skip
        self._state, self.layout = state, layout
        free = state.bodies.inverse_mass[layout.moving] > 0.0
        goes = state.table(Velocity).present[layout.moving]
        self._movable, self._driven = layout.moving[free], layout.moving[goes & ~free]
        foreign = [system for system, force in packed if force is None or force.work_slots is None]
        own = [force for _, force in packed if force is not None]
        causes = set(also) | ({DAMPING} if len(damping) else set()) | {system.account for system in foreign}
        if len(self._driven) and any(system.potential is not None for system in foreign):
            causes.add(HAND)
        for force in own:
            causes |= {cause for cause, _ in force.work_slots or ()}
            causes |= {force.cause} if force.anchors is not None else set()
        first = layout.clock + 1
        self.slots = {cause: first + ACCOUNTS * number for number, cause in enumerate(sorted(causes))}
        self.count = ACCOUNTS * len(causes)
        kept = {system.account for system in foreign if system.potential is None}
        # A force that books nothing, as drag on what cannot move, needs no buffer either.
        kept |= {DAMPING} & causes if any(force.dissipation_slot is not None for force in own) else set()
        self.buffers = {cause: self._buffer() for cause in sorted(kept if kicked else ())}
        pairs = [(self.slots[cause], buffer) for cause, buffer in self.buffers.items()]
        head = layout.clock, first + ACCOUNTS * len(causes), len(layout.moving), self.slots.get(DAMPING, -1)
        self.places = np.array((*head, *(place for pair in pairs for place in pair)), np.int64)
        for force in own:
            for cause, place in force.work_slots or ():
                force.indices[place] = self.slots[cause]
            if force.dissipation_slot is not None:
                force.indices[force.dissipation_slot] = self.buffers.get(DAMPING, -1)

    def _buffer(self) -> int:
        """Make room for a number for each coordinate; return where it begins."""
        first = self.layout.clock + 1 + self.count
        self.count += self.layout.clock
        return first

    def around(self, system: ForceSystem, force: PackedForce) -> list[PackedForce]:
        """Return the force, and before and after it what measures it, where it does not book all itself."""
        measures: list[tuple[NDArray[np.int64], float]] = []
        if force.anchors is not None:
            ends = np.stack((force.anchors, np.full(len(force.anchors), -1)), axis=1)
            measures.append((self._indices(force.cause, ends, energy=False, momentum=True), -1.0))
        if force.work_slots is None:
            stored, ends = system.potential is not None, self._ends(self._movable)
            kept = -1 if stored else self.buffers.get(system.account, -1)
            found = self._indices(system.account, ends, energy=not stored, momentum=True, kept=kept)
            measures.append((found, 1.0))
            if stored and HAND in self.slots:
                driven = self._ends(self._driven)
                measures.append((self._indices(HAND, driven, energy=True, momentum=False), -1.0))
        before = [PackedForce(gather, np.array([-sign]), indices) for indices, sign in measures]
        after = [PackedForce(gather, np.array([sign]), indices) for indices, sign in measures]
        return [*before, force, *after]

    def _ends(self, rows: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return where x and the angle of rows are, -1 for an angle that forces do not change; (n, 2)."""
        turn, driven = self.layout.turn[rows], self._state.bodies.inverse_mass[rows] == 0.0
        turns = driven | (self._state.bodies.inverse_inertia[rows] > 0.0)
        return np.stack((self.layout.place[rows], np.where(turns, turn, -1)), axis=1)

    def _indices(
        self, cause: int, ends: NDArray[np.int64], *, energy: bool, momentum: bool,
        kept: int = -1,
    ) -> NDArray[np.int64]:  # fmt: skip
        head = (self.slots[cause], energy, momentum, kept, len(ends))
        return np.concatenate((np.array(head, np.int64), ends.ravel()))

    def damping(self, rates: Numbers, inverse_mass: Numbers) -> list[PackedForce]:
        """Return what books the damping of all motion, if there is any.

        Rate (d,) [1/s] and inverse mass, or moment of inertia (d,) [SI], of every coordinate.
        """
        if not len(rates):
            return []
        weight = np.where(inverse_mass > 0.0, rates / np.where(inverse_mass > 0.0, inverse_mass, 1.0), 0.0)
        indices = np.array((self.slots[DAMPING], len(self.layout.moving), len(rates)), np.int64)
        return [PackedForce(resist, weight, indices)]


def book_in_python(
    state: State, book: BudgetLayout, system: ForceSystem, change: tuple[Numbers, Numbers],
    q: Numbers, v: Numbers, force: Numbers,
) -> None:  # fmt: skip
    """Book what a force in Python gives in a second.

    Parameters
    ----------
    state, book
        Whose, and where.
    system : ForceSystem
        The force that acts.
    change : tuple of float64 arrays (rows, 2) and (rows,)
        The force [N] and the torque [N m].
    q, v, force : float64 arrays
        The state, and what takes the sums.
    """
    layout, slots = book.layout, book.slots
    moving, turning = layout.moving, layout.turning
    n, d = 2 * len(moving), layout.moving_count
    moved = np.repeat(state.bodies.inverse_mass[moving] > 0.0, 2)
    free = np.concatenate((moved, state.bodies.inverse_inertia[turning] > 0.0))
    every = np.concatenate((change[0][moving].ravel(), change[1][turning]))
    given, account = np.where(free, every, 0.0), slots[system.account]
    x, y, fx, fy = q[:n:2], q[1:n:2], given[:n:2], given[1:n:2]
    force[account + PX] += fx.sum()
    force[account + PY] += fy.sum()
    force[account + ANGULAR_MOMENTUM] += (x * fy - y * fx).sum() + given[n:d].sum()
    if system.potential is not None:
        if HAND in slots:
            force[slots[HAND] + ENERGY] -= np.where(free, 0.0, every) @ v[:d]
    elif system.account in book.buffers:
        buffer = book.buffers[system.account]
        force[buffer : buffer + d] += given
    else:
        force[account + ENERGY] += given @ v[:d]
