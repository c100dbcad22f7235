"""Going back to before a step that failed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Transform, Velocity

if TYPE_CHECKING:
    from physicslab.world import World

__all__ = ["Checkpoint"]


class Checkpoint:
    """A world's state of motion at one moment, to go back to.

    It is taken before every step, so it holds no more than what a step may make infinite: places, velocities
    and a few counts (7 us for 4,000 bodies, of a step of some milliseconds). What contacts remember is not
    copied, which would cost ten times as much; going back forgets it, and the contacts are found anew.

    Attributes
    ----------
    columns : tuple of float64 arrays
        Positions, angles, velocities and angular velocities of then.
    """

    def __init__(self) -> None:
        self.columns: tuple[NDArray[np.float64], ...] = ()
        self._counts = 0, 0, 0

    def take(self, world: World) -> None:
        """Keep the state as it is now."""
        self.make_room(world)
        for kept, column in zip(self.columns, _moving(world), strict=True):
            np.copyto(kept, column)

    def make_room(self, world: World) -> None:
        """Keep the counts as they are now, with room for a state that a compiled loop will keep."""
        columns = _moving(world)
        if not self.columns or len(self.columns[0]) != len(columns[0]):
            self.columns = tuple(np.zeros_like(column) for column in columns)
        self.count(world)

    def count(self, world: World) -> None:
        """Keep the counts as they are now, where a compiled loop has kept the state."""
        self._counts = world.force_evaluations, world.collisions, world.contacts.logged

    def restore(self, world: World) -> None:
        """Go back to the state that was kept; no body may have come or gone since."""
        for kept, column in zip(self.columns, _moving(world), strict=True):
            np.copyto(column, kept)
        world.force_evaluations, world.collisions, world.contacts.logged = self._counts
        world.contacts.clear()  # what a failed step left there may not be finite either
        world.sleep.forget(world)  # and nothing is known to hold anybody


def _moving(world: World) -> tuple[NDArray[np.float64], ...]:
    transform, velocity = world.table(Transform), world.table(Velocity)
    return transform["position"], transform["angle"], velocity["linear"], velocity["angular"]
