"""Which bodies are near each other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape, Transform, Velocity
from physicslab.contacts.arguments import motion_of, sizes_of, speculative_margin
from physicslab.contacts.near_pairs import partition
from physicslab.kernels.broad import grid, near_pairs
from physicslab.kernels.broad.fat_boxes import fat_boxes, still_holds
from physicslab.kernels.wide import slots
from physicslab.state.state import State
from physicslab.systems.system import Stage, System, at

__all__ = ["BroadPhaseSystem"]

_MAX_LOOKAHEAD = 8.0
"""Largest factor by which the margin of a moving body is increased."""


def nothing_to_touch(state: State) -> str | None:
    """Return why no two things in this world can ever meet, or ``None`` if they can."""
    shapes, moving = len(state.batch(Shape, Transform)), len(state.batch(Shape, Transform, Velocity))
    if not shapes:
        return "no Shape in the scene"
    if not moving:
        return "nothing that has a Shape moves"
    if shapes == 1 and state.physics.bounds is None:
        return "only one Shape in the scene, and no bounds"
    return None


def _lookahead(sleepers: int, awake: int) -> float:
    """Return the factor by which the margins of awake bodies are increased.

    Among many sleeping bodies a new list takes longer than the surplus pairs of an old one.
    """
    return min(max(1.0, sleepers / max(1, awake)), _MAX_LOOKAHEAD)


class BroadPhaseSystem(System):
    """Keeps the list of near pairs: those whose fat boxes overlap, found with a uniform grid.

    The list is valid, and nothing is done, until a body leaves the fat box that was made for it.

    Attributes
    ----------
    fat : float64 array (5, rows)
        Where each body was (x, y, angle), its bounding radius then, and the margin around it [m].
    bounds : float64 array (4,)
        Of the world: xmin, ymin, xmax, ymax [m].
    """

    engine = True
    kernels = (
        still_holds, fat_boxes, grid.find_pairs,
        near_pairs.partition, near_pairs.carry_over, near_pairs.sort_scalar, slots.list_scalar,
    )  # fmt: skip

    def __init__(self) -> None:
        self.fat: NDArray[np.float64] = np.zeros((5, 0))
        self._boxes: NDArray[np.float64] = np.zeros((0, 4))
        self._couples: NDArray[np.uint32] = np.zeros(512, np.uint32)
        self._pairs: NDArray[np.int64] = np.zeros((512, 3), np.int64)
        self.bounds: NDArray[np.float64] = np.zeros(4)

    def attach(self, state: State) -> None:
        """Mark the list as stale: bodies came, went or changed."""
        state.contacts.stale = True
        if state.physics.bounds is not None:
            self.bounds[:] = state.physics.bounds

    def why_left_out(self, state: State) -> str | None:
        """Needed where two things could ever meet."""
        reason = nothing_to_touch(state)
        if reason is not None:
            state.contacts.clear()
        return reason

    def follow_rows(self, state: State) -> None:
        """Make room for every row; where the list is stale, invalidate every fat box."""
        rows = len(state.entity_index)
        if self.fat.shape[1] != rows:
            self.fat, self._boxes = np.zeros((5, rows)), np.zeros((rows, 4))
            state.contacts.stale = True
        if state.contacts.stale:
            self.fat[3] = np.nan

    @at(Stage.BROAD_PHASE)
    def search(self, state: State, h: float) -> None:
        """Update the list of near pairs, where it is not valid any more."""
        self.follow_rows(state)
        if not still_holds(*motion_of(state), *sizes_of(state), self.fat, h, speculative_margin(state, h)):
            self.list_pairs(state, h)

    def list_pairs(self, state: State, h: float) -> None:
        """List the near pairs again, with margins for the time to come."""
        shape = state.table(Shape)
        awake = state.bodies.awake_inverse_mass
        ahead = h * _lookahead(state.sleep.count, int(np.count_nonzero(awake)))
        margin = speculative_margin(state, h)
        fat_boxes(*motion_of(state), *sizes_of(state), awake, self.fat, self._boxes, ahead, margin)
        inverse_mass = state.bodies.inverse_mass
        bounded = state.physics.bounds is not None
        found, walls = self._count_pairs(shape["kind"], inverse_mass, bounded)
        partition(state, self._couples, found, self._pairs, walls, self.fat)

    def _count_pairs(
        self, kind: NDArray[np.int64], inverse_mass: NDArray[np.float64], bounded: bool
    ) -> tuple[int, int]:
        """Find the pairs, with more room where it is too little; return how many of bodies, of walls."""
        while True:
            found, walls = grid.find_pairs(
                self._boxes, self.fat, kind, inverse_mass, bounded, self.bounds, self._pairs, self._couples
            )
            if 2 * found <= len(self._couples) and found + walls <= len(self._pairs):
                return found, walls
            self._couples = np.zeros(4 * found, np.uint32)
            self._pairs = np.zeros((2 * (found + walls), 3), np.int64)
