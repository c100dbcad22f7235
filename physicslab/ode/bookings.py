"""Which accounts the forces of a world need, and the kernels that book beside them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Velocity
from physicslab.kernels.accounts import DAMPING, ENERGY, FIELDS, HAND, PX, PY, SPIN
from physicslab.kernels.forces.bookings import (
    ACCOUNTS,
    BODIES,
    CLOCK,
    DAMPED,
    END,
    FIELD,
    PLACES,
    PULL,
    RESISTANCE,
    gather,
    resist,
)
from physicslab.state.packed import PackedForce, StateLayout
from physicslab.state.state import State
from physicslab.systems.system import ForceSystem

__all__ = ["BookKeeper", "book_in_python"]

type Numbers = NDArray[np.float64]
type Packed = Sequence[tuple[ForceSystem, PackedForce | None]]


class BookKeeper:
    """The accounts of a world in which forces act, and their places behind the clock.

    Parameters
    ----------
    state : State
        Whose forces.
    layout : StateLayout
        The place of each row.
    packed : sequence of (ForceSystem, PackedForce or None)
        The forces; ``None`` for one that Python computes. Those that book themselves are given their accounts.
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
    places : int64 array (PLACES,)
        What integrators take.
    """

    def __init__(
        self, state: State, layout: StateLayout, packed: Packed, damping: Numbers, also: tuple[int, ...],
        *, kicked: bool,
    ) -> None:  # fmt: skip
        self._state, self._layout = state, layout
        free = state.bodies.inverse_mass[layout.moving] > 0.0
        goes = state.table(Velocity).present[layout.moving]
        self._movable, self._driven = layout.moving[free], layout.moving[goes & ~free]
        causes = set(also) | ({DAMPING} if len(damping) else set())
        foreign = [(system, force) for system, force in packed if force is None or force.books is None]
        unstored = any(system.potential is None for system, _ in foreign)
        if foreign:
            causes |= {FIELDS}
            if len(self._driven) and any(system.potential is not None for system, _ in foreign):
                causes |= {HAND}
        for _, force in packed:
            if force is not None:
                causes |= {cause for cause, _ in force.books or ()}
                causes |= {force.cause} if force.anchors is not None else set()
        first = layout.clock + 1
        self.slots = {cause: first + ACCOUNTS * number for number, cause in enumerate(sorted(causes))}
        self.count = ACCOUNTS * len(causes)
        end = first + self.count
        self.places = np.full(PLACES, -1, np.int64)
        self.places[[CLOCK, END, BODIES]] = layout.clock, end, len(layout.moving)
        self.places[[DAMPED, FIELD]] = self.slots.get(DAMPING, -1), self.slots.get(FIELDS, -1)
        if kicked and unstored:
            self.places[PULL] = self._room()
        own = [force for _, force in packed if force is not None]
        if kicked and any(force.keeps is not None for force in own):
            self.places[RESISTANCE] = self._room()
        for force in own:
            for cause, place in force.books or ():
                force.indices[place] = self.slots[cause]
            if force.keeps is not None:
                force.indices[force.keeps] = self.places[RESISTANCE]

    def _room(self) -> int:
        """Make room for a number for each coordinate; return where it begins."""
        first = self._layout.clock + 1 + self.count
        self.count += self._layout.clock
        return first

    def around(self, system: ForceSystem, force: PackedForce) -> list[PackedForce]:
        """Return the force, and before and after it what measures it, where it does not book all itself."""
        measures: list[NDArray[np.int64]] = []
        signs: list[float] = []
        if force.anchors is not None:
            ends = np.stack((force.anchors, np.full(len(force.anchors), -1)), axis=1)
            measures.append(self._indices(force.cause, ends, energy=False, momentum=True))
            signs.append(-1.0)
        if force.books is None:
            unstored = system.potential is None
            ends, kept = self._ends(self._movable), int(self.places[PULL]) if unstored else -1
            measures.append(self._indices(FIELDS, ends, energy=unstored, momentum=True, kept=kept))
            signs.append(1.0)
            if not unstored and HAND in self.slots:
                measures.append(self._indices(HAND, self._ends(self._driven), energy=True, momentum=False))
                signs.append(-1.0)
        pairs = list(zip(measures, signs, strict=True))
        before = [PackedForce(gather, np.array([-sign]), indices) for indices, sign in pairs]
        after = [PackedForce(gather, np.array([sign]), indices) for indices, sign in pairs]
        return [*before, force, *after]

    def _ends(self, rows: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return where x and the angle of rows are, -1 for an angle that forces do not change; (n, 2)."""
        turn, driven = self._layout.turn[rows], self._state.bodies.inverse_mass[rows] == 0.0
        turns = driven | (self._state.bodies.inverse_inertia[rows] > 0.0)
        return np.stack((self._layout.place[rows], np.where(turns, turn, -1)), axis=1)

    def _indices(
        self, cause: int, ends: NDArray[np.int64], *, energy: bool, momentum: bool,
        kept: int = -1,
    ) -> NDArray[np.int64]:  # fmt: skip
        head = (self.slots[cause], energy, momentum, kept, len(ends))
        return np.concatenate((np.array(head, np.int64), ends.ravel()))

    def damping(self, rates: Numbers, inverse_mass: Numbers) -> list[PackedForce]:
        """Return what books the damping of all motion, if there is any."""
        if not len(rates):
            return []
        weight = np.where(inverse_mass > 0.0, rates / np.where(inverse_mass > 0.0, inverse_mass, 1.0), 0.0)
        indices = np.array((self.slots[DAMPING], len(self._layout.moving), len(rates)), np.int64)
        return [PackedForce(resist, weight, indices)]


def book_in_python(
    state: State, layout: StateLayout, slots: dict[int, int], pull: int, stored: bool,
    change: tuple[Numbers, Numbers], q: Numbers, v: Numbers, force: Numbers,
) -> None:  # fmt: skip
    """Book what a force in Python gives in a second.

    Parameters
    ----------
    state, layout, slots
        Whose, and where.
    pull : int
        Where forces without potential are kept, coordinate by coordinate, or -1.
    stored : bool
        Whether the force has a potential.
    change : tuple of float64 arrays (rows, 2) and (rows,)
        The force [N] and the torque [N m].
    q, v, force : float64 arrays
        The state, and what takes the sums.
    """
    moving, turning = layout.moving, layout.turning
    n, d = 2 * len(moving), layout.moving_count
    moved = np.repeat(state.bodies.inverse_mass[moving] > 0.0, 2)
    turned = state.bodies.inverse_inertia[turning] > 0.0
    all_forces = np.concatenate((change[0][moving].ravel(), change[1][turning]))
    free = np.concatenate((moved, turned))
    given, account = np.where(free, all_forces, 0.0), slots[FIELDS]
    x, y, fx, fy = q[:n:2], q[1:n:2], given[:n:2], given[1:n:2]
    force[account + PX] += fx.sum()
    force[account + PY] += fy.sum()
    force[account + SPIN] += (x * fy - y * fx).sum() + given[n:d].sum()
    if not stored and pull >= 0:
        force[pull : pull + d] += given
    elif not stored:
        force[account + ENERGY] += given @ v[:d]
    elif HAND in slots:
        force[slots[HAND] + ENERGY] -= np.where(free, 0.0, all_forces) @ v[:d]
