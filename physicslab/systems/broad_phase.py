"""Which bodies are near each other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape, Transform, Velocity
from physicslab.kernels import block_lanes, grid
from physicslab.schedule import Stage, System, at

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
    fat : float64 array (rows, 5)
        Where each body was (x, y, angle), its bounding radius then, and the margin around it [m].
    bounds : float64 array (4,)
        Of the world: xmin, ymin, xmax, ymax [m].
    """

    kernels = (
        grid.still_holds, grid.fat_boxes, grid.find_pairs, grid.carry_over, block_lanes.list_loose,
    )  # fmt: skip

    def __init__(self) -> None:
        self.fat: NDArray[np.float64] = np.zeros((0, 5))
        self._boxes: NDArray[np.float64] = np.zeros((0, 4))
        self._pairs: NDArray[np.int64] = np.zeros((256, 3), np.int64)
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
        if len(self.fat) != len(angle):
            self.fat, self._boxes = np.zeros((len(angle), 5)), np.zeros((len(angle), 4))
            world.contacts.stale = True
        if not world.contacts.stale and grid.still_holds(position, angle, linear, *sizes, self.fat, h):
            return
        awake = world.bodies.awake_inverse_mass
        ahead = h * _foresight(world.sleep.count, int(np.count_nonzero(awake)))
        grid.fat_boxes(position, angle, linear, *sizes, awake, self.fat, self._boxes, ahead)
        inverse_mass = world.bodies.inverse_mass
        bounded = world.physics.bounds is not None
        count = self._count_pairs(shape["kind"], inverse_mass, bounded)
        world.contacts.relist(world, self._pairs, count)

    def _count_pairs(self, kind: NDArray[np.int64], inverse_mass: NDArray[np.float64], bounded: bool) -> int:
        """Fill the list of pairs, made larger where it is too small, and return their number."""
        while True:
            count = int(
                grid.find_pairs(self._boxes, self.fat, kind, inverse_mass, bounded, self.bounds, self._pairs)
            )
            if count <= len(self._pairs):
                return count
            self._pairs = np.zeros((2 * count, 3), np.int64)
