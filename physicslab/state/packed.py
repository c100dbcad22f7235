"""Coordinates and forces packed into plain arrays, as compiled integrators take them."""

from __future__ import annotations

import copy
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Spring, Transform, Velocity
from physicslab.ecs.vector import rotated
from physicslab.kernels.accounts import FIELDS
from physicslab.kernels.forces.force_calls import ForceKernel
from physicslab.state.state import State

_ROUNDING = 1e-14
"""Share of the largest coordinate that is rounding."""


@dataclass(frozen=True, slots=True)
class PackedForce:
    """A force that compiled integrators call: its kernel, and what the kernel reads.

    Attributes
    ----------
    kernel : ForceKernel
        The kernel that adds to the forces.
    parameters, indices : float64 array, int64 array
        Whatever the kernel reads; it gets pointers to them.
    resistance : ForceKernel, optional
        The response of the force to a velocity other than the present one, where it resists motion (see
        :mod:`physicslab.kernels.forces.resistance`).
    max_rate_slot : int, optional
        Where in ``indices`` the kernel looks for the place, the last of its ``parameters``, at which it
        leaves the square of the fastest rate that it met [1/s^2].
    work_slots : tuple of (int, int), optional
        The accounts to which the kernel itself adds what it gives, each with where in ``indices`` the kernel
        looks for its place (-1: it books nothing). ``None`` where it does not: what it gives is then measured
        around it, and booked as that of a field.
    dissipation_slot : int, optional
        Where in ``indices`` the kernel looks for a place to keep by itself what it takes without storing it.
    anchors : int64 array, optional
        The places of fixed ends, where all else that it acts on is moved by what acts on these, reversed.
    cause : int
        The account of what comes in by the anchors.
    """

    kernel: ForceKernel
    parameters: NDArray[np.float64]
    indices: NDArray[np.int64]
    resistance: ForceKernel | None = None
    max_rate_slot: int | None = None
    work_slots: tuple[tuple[int, int], ...] | None = None
    dissipation_slot: int | None = None
    anchors: NDArray[np.int64] | None = None
    cause: int = FIELDS

    @property
    def call(self) -> tuple[int, int, int]:
        """The addresses of the kernel and of its numbers: a row of :data:`Calls`."""
        return self.kernel.address, self.parameters.ctypes.data, self.indices.ctypes.data


def share_steepness[S](packed: Iterable[tuple[S, PackedForce | None]]) -> list[tuple[S, PackedForce | None]]:
    """Return forces of which all that note their fastest rate do so at one place, the last of a parameter."""
    found = list(packed)
    noting = [
        i for i, (_, force) in enumerate(found) if force is not None and force.max_rate_slot is not None
    ]
    if noting:
        parts = [force.parameters for _, force in (found[i] for i in noting) if force is not None]
        joint, start = np.concatenate(parts), 0
        for i, part in zip(noting, parts, strict=True):
            system, force = found[i]
            assert force is not None and force.max_rate_slot is not None
            force.indices[force.max_rate_slot] = len(joint) - 1 - start
            found[i] = system, replace(force, parameters=joint[start:])
            start += len(part)
    return found


class StateLayout:
    """The place of each row of a world among the packed coordinates.

    First two coordinates for every row that moves, then an angle for every row that forces may turn, then the
    two coordinates of the rows that stay where they are, the world itself among them, and then the time.

    Parameters
    ----------
    state : State
        Whose rows.
    part : bool array (rows,), optional
        The rows that take part; all by default.
    turned : iterable of int64 arrays, optional
        The rows that forces may turn; ``None`` where they may turn any.

    Attributes
    ----------
    moving, turning, fixed : int64 arrays
        The rows in that order.
    steady : int64 array
        The rows that move and no force turns.
    place : int64 array (rows,)
        Index of x of a row; -1 for a row that has none, or takes no part.
    clock : int
        Index of the time [s] of the state: a packed force that depends on time reads it there.
    """

    place: NDArray[np.int64]
    clock: int
    _turn: NDArray[np.int64]
    _straight: str = ""

    @classmethod
    def of_rows(cls, rows: int) -> StateLayout:
        """Return the layout of every row of a world: all x and y in turn, then all angles."""
        layout = cls.__new__(cls)
        layout.moving = layout.turning = np.arange(rows)
        layout.steady = layout.fixed = np.zeros(0, np.int64)
        layout.place, layout._turn = 2 * np.arange(rows), 2 * rows + np.arange(rows)
        layout.clock = 3 * rows
        return layout

    def __init__(
        self, state: State, part: NDArray[np.bool_] | None, turned: Iterable[NDArray[np.int64]] | None
    ) -> None:
        transform, velocity = state.table(Transform).present, state.table(Velocity).present
        if part is not None:
            transform = transform & part
        self.moving = np.flatnonzero(transform & velocity)
        turns = np.full(len(transform), turned is None)
        for rows in turned or ():
            turns[rows] = True
        turns &= transform & velocity
        self.turning = np.flatnonzero(turns)
        self.steady = np.setdiff1d(self.moving, self.turning, assume_unique=True)
        fixed = transform & ~velocity
        fixed[0] = True
        self.fixed = np.flatnonzero(fixed)
        n, m = len(self.moving), len(self.turning)
        self.place, self._turn = np.full((2, len(transform)), -1, np.int64)
        self.place[self.moving] = 2 * np.arange(n)
        self._turn[self.turning] = 2 * n + np.arange(m)
        self.place[self.fixed] = 2 * n + m + 2 * np.arange(len(self.fixed))
        self.clock = 2 * n + m + 2 * len(self.fixed)

    @property
    def turn(self) -> NDArray[np.int64]:
        """Index of the angle of each row (rows,); -1 for a row that no force turns, or that takes no part.

        Raises
        ------
        TypeError
            For a force that does not say that it turns bodies.
        """
        if self._straight:
            raise TypeError(f"{self._straight} reads layout.turn: set turns = True there, as it turns bodies")
        return self._turn

    def without_angles(self, force: str) -> StateLayout:
        """Return the layout as the force of that name sees it, which does not say that it turns bodies."""
        seen = copy.copy(self)
        seen._straight = force
        return seen

    @property
    def moving_count(self) -> int:
        """How many coordinates move."""
        return 2 * len(self.moving) + len(self.turning)


def fixed_ends(
    state: State, layout: StateLayout, rows: NDArray[np.int64]
) -> tuple[tuple[()] | None, NDArray[np.int64] | None]:
    """Return ``work_slots`` and ``anchors`` of a force between pairs of bodies of some rows (n,).

    Where none of them moves that no force moves, the force does no work but on the others; what comes in by
    fixed ones is known by their places.
    """
    fixed = state.bodies.inverse_mass[rows] == 0.0
    if (fixed & state.table(Velocity).present[rows]).any():
        return None, None
    return (), layout.place[rows[fixed]] if fixed.any() else None


def spring_rates(state: State) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
    """Return the entities of all springs (n,), and how fast each oscillates [rad/s] and is damped [1/s]."""
    rows, a, b = spring_ends(state)
    spring, inverse = state.table(Spring), state.bodies.inverse_mass
    give = inverse[a] + inverse[b]
    rates = np.sqrt(spring["stiffness"][rows] * give), spring["damping"][rows] * give
    return state.entity_index.entities[rows], *rates


def spring_ends(state: State) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return the rows of the springs, of the bodies at their ends A, and at B (0 for the world)."""
    batch, spring, rows_of = state.batch(Spring), state.table(Spring), state.entity_index.rows_of
    a = spring["a"][batch.rows]
    return batch.rows, rows_of(np.where(a == 0, batch.entities, a)), rows_of(spring["b"][batch.rows])


def pulls_driven_alone(state: State) -> bool:
    """Whether a spring pulls at what moves at a given speed, and at nothing that it moves."""
    _, a, b = spring_ends(state)
    driven, goes = state.bodies.inverse_mass == 0.0, state.table(Velocity).present
    return bool((driven[a] & driven[b] & (goes[a] | goes[b])).any())


def turned_anchors(
    state: State, end: NDArray[np.int64], springs: NDArray[np.int64], anchors: str
) -> NDArray[np.float64]:
    """Return the column ``anchors`` of springs, turned with the bodies at their ends (n, 2) [m]."""
    return rotated(state.table(Spring)[anchors][springs], state.table(Transform)["angle"][end])


def way_and_size(before: NDArray[np.float64], after: NDArray[np.float64]) -> tuple[float, float]:
    """Return by how much coordinates (n,) moved at most, and the largest of those that did.

    A move within the rounding of the largest of all does not count: an angle of 1e-16 turns by itself.
    """
    size, way = np.abs(before), np.abs(after - before)
    moved = way > _ROUNDING * size.max(initial=0.0)
    return float(way[moved].max(initial=0.0)), float(size[moved].max(initial=0.0))
