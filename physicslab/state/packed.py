"""Coordinates and forces packed into plain arrays, as compiled integrators take them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Spring, Transform, Velocity
from physicslab.kernels.accounts import FIELDS
from physicslab.kernels.forces.force_calls import ForceKernel
from physicslab.state.state import State

__all__ = ["PackedForce", "StateLayout", "spring_ends", "turned_anchors"]


@dataclass(frozen=True, slots=True)
class PackedForce:
    """A force that compiled integrators call: its kernel, and what the kernel reads.

    Attributes
    ----------
    kernel : ForceKernel
        What adds to the forces.
    parameters, indices : float64 array, int64 array
        Whatever the kernel reads; it gets pointers to them.
    resistance : ForceKernel, optional
        The response of the force to a velocity other than the present one, where it resists motion (see
        :mod:`physicslab.kernels.forces.resistance`).
    steepest : int, optional
        Where in ``parameters`` the kernel leaves the square of the fastest rate that it met [1/s^2].
    books : tuple of (int, int), optional
        The accounts to which the kernel itself adds what it gives, each with where in ``indices`` the kernel
        looks for its place (-1: it books nothing). ``None`` where it does not: what it gives is then measured
        around it, and booked as that of a field.
    keeps : int, optional
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
    steepest: int | None = None
    books: tuple[tuple[int, int], ...] | None = None
    keeps: int | None = None
    anchors: NDArray[np.int64] | None = None
    cause: int = FIELDS

    @property
    def call(self) -> tuple[int, int, int]:
        """The addresses of the kernel and of its numbers: a row of :data:`Calls`."""
        return self.kernel.address, self.parameters.ctypes.data, self.indices.ctypes.data


class StateLayout:
    """The place of each row of a world among the packed coordinates.

    First two coordinates for every row that moves, then an angle for every row that forces may turn, then the
    two coordinates of the rows that stay where they are, the world itself among them, and then the time.

    Attributes
    ----------
    moving, turning, fixed : int64 arrays
        The rows in that order.
    steady : int64 array
        The rows that move and no force turns.
    place, turn : int64 arrays (rows,)
        Indices of x and of the angle of a row; -1 for a row that has none, or takes no part.
    clock : int
        Index of the time [s] of the state: a packed force that depends on time reads it there.
    """

    place: NDArray[np.int64]
    turn: NDArray[np.int64]
    clock: int

    @classmethod
    def of_rows(cls, rows: int) -> StateLayout:
        """Return the layout of every row of a world: all x and y in turn, then all angles."""
        layout = cls.__new__(cls)
        layout.moving = layout.turning = np.arange(rows)
        layout.steady = layout.fixed = np.zeros(0, np.int64)
        layout.place, layout.turn = 2 * np.arange(rows), 2 * rows + np.arange(rows)
        layout.clock = 3 * rows
        return layout

    def __init__(self, state: State, part: NDArray[np.bool_] | None, *, all_turn: bool) -> None:
        transform, velocity = state.table(Transform).present, state.table(Velocity).present
        if part is not None:
            transform = transform & part
        self.moving = np.flatnonzero(transform & velocity)
        turns = np.zeros(len(transform), np.bool_)
        turns[self.moving] = all_turn
        if not all_turn:
            turns[_swung(state)] = True
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
        self.clock = 2 * n + m + 2 * len(self.fixed)

    @property
    def moving_count(self) -> int:
        """How many coordinates move."""
        return 2 * len(self.moving) + len(self.turning)


def spring_ends(state: State) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return the rows of the springs, of the bodies at their ends A, and at B (0 for the world)."""
    batch, spring, rows_of = state.batch(Spring), state.table(Spring), state.entity_index.rows_of
    a = spring["a"][batch.rows]
    return batch.rows, rows_of(np.where(a == 0, batch.entities, a)), rows_of(spring["b"][batch.rows])


def turned_anchors(
    state: State, end: NDArray[np.int64], springs: NDArray[np.int64], anchors: str
) -> NDArray[np.float64]:
    """Return the column ``anchors`` of springs, turned with the bodies at their ends (n, 2) [m]."""
    angle, anchor = state.table(Transform)["angle"][end], state.table(Spring)[anchors][springs]
    c, s = np.cos(angle), np.sin(angle)
    return np.stack((c * anchor[:, 0] - s * anchor[:, 1], s * anchor[:, 0] + c * anchor[:, 1]), axis=1)


def _swung(state: State) -> NDArray[np.int64]:
    """Return the rows that springs hold away from their middle, and so can turn."""
    rows, a, b = spring_ends(state)
    spring = state.table(Spring)
    off_a, off_b = spring["anchor_a"][rows].any(axis=1), spring["anchor_b"][rows].any(axis=1)
    return np.concatenate((a[off_a], b[off_b]))
