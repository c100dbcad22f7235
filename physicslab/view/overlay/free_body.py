"""The free-body diagram of the selection: every force by name, measured now and then."""

from collections.abc import Sequence

import numpy as np

from physicslab.components import Transform
from physicslab.diagnostics.free_body import LastStep, NamedForce, forces_on, last_step, net_force
from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.drawing import Drawing
from physicslab.view.canvas.quantities import quantity
from physicslab.view.overlay.arrows import ArrowKind, Head, draw_arrows
from physicslab.view.overlay.labels import Label
from physicslab.view.overlay.overlays import Gauge, Overlays
from physicslab.world import World

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


# ---- drawing -----------------------------------------------------------------------------------------------


_NORMAL = ArrowKind("Normal force", "normal_impulse", Head.DIAMOND)
_FRICTION = ArrowKind("Friction", "friction_impulse", Head.OPEN, dashed=True)
_KINDS = {"field": ArrowKind("Force", "force", Head.DOUBLE), "normal": _NORMAL, "friction": _FRICTION}
_WIDTH = 2.6
_REACH = 0.16
"""Length of the longest arrow, as a share of the smaller side of the picture."""


def draw_free_body(
    forces: Sequence[NamedForce], moved: Vector2, time: float, overlays: Overlays, on: Drawing
) -> None:
    """Draw the forces on a body as arrows that end with their names and sizes; one scale for all of them.

    Parameters
    ----------
    forces : sequence of NamedForce
        As they were measured last.
    moved : Vector2
        How far the body has come since [m].
    time : float
        Time of the world [s].
    """
    gauge: Gauge = overlays.body_force
    sizes = np.array([one.force.magnitude for one in forces])
    gauge.follow(sizes, _REACH * min(on.camera.size) / on.camera.scale, time)
    if not len(forces) or not gauge.per_metre:
        return
    labels = [_draw(one, moved, n, gauge, on) for n, one in enumerate(forces)]
    overlays.force_labels.draw(labels, overlays.covered, on)


def _draw(one: NamedForce, moved: Vector2, number: int, gauge: Gauge, on: Drawing) -> Label:
    """Draw one arrow, and return its label."""
    start = on.camera.project(np.array([(one.place.x + moved.x, one.place.y + moved.y)]))
    span = np.array([(one.force.x, -one.force.y)]) * (on.camera.scale / gauge.per_metre)
    draw_arrows(start, span, _KINDS[one.kind], on, width=_WIDTH)
    x, y = (start + span)[0].tolist()
    return Label((number, hash(one.name)), (x, y), [f"{one.name}: {quantity(one.force.magnitude, 'N')}"])
