"""The forces on the selection, measured now and then: arrows and figures show those of the same step."""

from __future__ import annotations

from physicslab.components import Transform
from physicslab.diagnostics.free_body import LastStep, NamedForce, forces_on, last_step, net_force
from physicslab.ecs.vector import Vector2
from physicslab.world import World

__all__ = ["Measured"]

_PERIOD = 0.2
"""Time [s] after which forces are measured again while time runs: faster digits cannot be read."""


class Measured:
    """The measurements of one body.

    Attributes
    ----------
    forces : tuple of NamedForce
        Those on it; none where no body is measured.
    step : LastStep, optional
        What changed its momentum in the last step, where that is known.
    number : int
        How often was measured: what shows the figures is built again where it has grown.
    """

    def __init__(self) -> None:
        self.forces: tuple[NamedForce, ...] = ()
        self.step: LastStep | None = None
        self.number = 0
        self._stepped = -1, -1  # how many steps and edits there were when a step was seen first
        self._of: tuple[object, ...] = ()
        self._steps, self._until, self._place = -1, 0.0, Vector2()

    @property
    def net(self) -> Vector2:
        """The sum of the forces [N]."""
        return net_force(self.forces)

    def follow(self, world: World, entity: int | None, now: float, *, paused: bool) -> None:
        """Measure again where it is time for that, or where time stands still and something has changed.

        Parameters
        ----------
        entity : int, optional
            Whose forces are shown; ``None`` where none are.
        now : float
            Time [s] that the window has been open.
        """
        if entity is None or not world.has(entity, Transform):
            self.forces, self.step, self._of = (), None, ()
            return
        if world.steps != self._stepped[0]:
            self._stepped = world.steps, world.motion_edits
        of = world, entity, world.motion_edits
        changed = of != self._of or (paused and world.steps != self._steps)
        if not changed and (now < self._until or world.steps == self._steps):
            return
        self._of, self._steps, self._until = of, world.steps, now + _PERIOD
        self.forces = forces_on(world, entity)
        is_edited = self._stepped != (world.steps, world.motion_edits)
        self.step = None if is_edited else last_step(world, entity)
        self._place = world.component(entity, Transform).position
        self.number += 1

    def moved(self, world: World, entity: int) -> Vector2:
        """Return how far the body has come since it was measured [m]: arrows go with it."""
        return world.component(entity, Transform).position - self._place
