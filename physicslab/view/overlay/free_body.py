"""The free-body diagram of what is selected: every force by name, in newtons."""

from __future__ import annotations

import numpy as np

from physicslab.diagnostics.free_body import NamedForce, forces_on
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas
from physicslab.view.canvas.quantities import quantity
from physicslab.view.canvas.theme import Theme
from physicslab.view.overlay.arrows import ArrowKind, Head, draw_arrows
from physicslab.view.overlay.gauge import Gauge
from physicslab.view.overlay.labels import Label
from physicslab.view.overlay.overlays import Overlays
from physicslab.world import World

__all__ = ["draw_free_body"]

_NORMAL = ArrowKind("Normal force", "normal_impulse", Head.DIAMOND)
_FRICTION = ArrowKind("Friction", "friction_impulse", Head.OPEN, dashed=True)
_KINDS = {"field": ArrowKind("Force", "force", Head.DOUBLE), "normal": _NORMAL, "friction": _FRICTION}
_WIDTH = 2.6
_REACH = 0.16
"""Length of the longest arrow, as a share of the smaller side of the picture."""


def draw_free_body(
    world: World,
    entity: int,
    overlays: Overlays,
    camera: Camera,
    theme: Theme,
    canvas: Canvas,
    text_size: int,
) -> None:
    """Draw the forces on a body as arrows that end with their names and sizes; one scale for all of them."""
    forces = forces_on(world, entity)
    gauge: Gauge = overlays.body_force
    sizes = np.array([one.force.magnitude for one in forces])
    gauge.follow(sizes, _REACH * min(camera.size) / camera.scale, world.time)
    if not len(forces) or not gauge.per_metre:
        return
    labels = [_draw(one, n, gauge, camera, theme, canvas) for n, one in enumerate(forces)]
    overlays.force_labels.draw(labels, overlays.covered, text_size, canvas, theme)


def _draw(one: NamedForce, number: int, gauge: Gauge, camera: Camera, theme: Theme, canvas: Canvas) -> Label:
    """Draw one arrow, and return its label."""
    start = camera.project(np.array([(one.place.x, one.place.y)]))
    span = np.array([(one.force.x, -one.force.y)]) * (camera.scale / gauge.per_metre)
    draw_arrows(start, span, _KINDS[one.kind], canvas, theme, width=_WIDTH)
    x, y = (start + span)[0].tolist()
    return Label((number, hash(one.name)), (x, y), [f"{one.name}: {quantity(one.force.magnitude, 'N')}"])
