"""Which bodies are near each other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape, Transform, Velocity
from physicslab.kernels.broad import grid, near_pairs
from physicslab.kernels.wide import slots
from physicslab.systems.schedule import Stage, System, at

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["BroadPhaseSystem"]

_FARTHEST = 8.0
"""So many times as far as usual, at the most, a body that moves looks ahead."""


def nothing_to_touch(world: World) -> str | None:
    """Return why no two things in this world can ever meet, or ``None`` if they can."""
    shapes, moving = len(world.batch(Shape, Transform)), len(world.batch(Shape, Transform, Velocity))
    if not shapes:
        return "no Shape in the scene"
    if not moving:
        return "nothing that has a Shape moves"
    if shapes == 1 and world.physics.bounds is None:
        return "only one Shape in the scene, and no bounds"
    return None


def _foresight(sleepers: int, awake: int) -> float:
    """Return how many times as far as usual those look ahead who are awake.

    Among many sleepers a new list costs more than the pairs that a few of them have too many in an old one.
    """
    return min(max(1.0, sleepers / max(1, awake)), _FARTHEST)


class BroadPhaseSystem(System):
    """Keeps the list of near pairs: those whose fat boxes overlap, found with a uniform grid.

    The list holds, and nothing is done, until a body leaves the fat box that was made for it.

    Attributes
    ----------
    fat : float64 array (5, rows)
        Where each body was (x, y, angle), its bounding radius then, and the margin around it [m].
    bounds : float64 array (4,)
        Of the world: xmin, ymin, xmax, ymax [m].
    """

    kernels = (
        grid.still_holds, grid.fat_boxes, grid.find_pairs,
        near_pairs.partition, near_pairs.carry_over, near_pairs.sort_scalar, slots.list_scalar,
    )  # fmt: skip

    def __init__(self) -> None:
        self.fat: NDArray[np.float64] = np.zeros((5, 0))
        self._boxes: NDArray[np.float64] = np.zeros((0, 4))
        self._couples: NDArray[np.uint32] = np.zeros(512, np.uint32)
        self._pairs: NDArray[np.int64] = np.zeros((512, 3), np.int64)
        self.bounds: NDArray[np.float64] = np.zeros(4)

    def attach(self, world: World) -> None:
        """Find the pairs anew: bodies came, went or changed."""
        world.contacts.stale = True
        if world.physics.bounds is not None:
            self.bounds[:] = world.physics.bounds

    def why_left_out(self, world: World) -> str | None:
        """Needed where two things could ever meet."""
        reason = nothing_to_touch(world)
        if reason is not None:
            world.contacts.clear()
        return reason

    @at(Stage.BROAD_PHASE)
    def search(self, world: World, h: float) -> None:
        """Bring the list of near pairs up to date, where it no longer holds."""
        transform, shape = world.table(Transform), world.table(Shape)
        position, angle, linear = transform["position"], transform["angle"], world.table(Velocity)["linear"]
        sizes = shape["kind"], shape["radius"], shape["width"], shape["height"]
        if self.fat.shape[1] != len(angle):
            self.fat, self._boxes = np.zeros((5, len(angle))), np.zeros((len(angle), 4))
            world.contacts.stale = True
        if not world.contacts.stale and grid.still_holds(position, angle, linear, *sizes, self.fat, h):
            return
        awake = world.bodies.awake_inverse_mass
        ahead = h * _foresight(world.sleep.count, int(np.count_nonzero(awake)))
        grid.fat_boxes(position, angle, linear, *sizes, awake, self.fat, self._boxes, ahead)
        inverse_mass = world.bodies.inverse_mass
        bounded = world.physics.bounds is not None
        found, walls = self._count_pairs(shape["kind"], inverse_mass, bounded)
        world.contacts.partition(world, self._couples, found, self._pairs, walls)

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
