"""The free-body diagram of the selection: every force by name, in newtons."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from physicslab.diagnostics.free_body import NamedForce
from physicslab.ecs.vector import Vector2
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas
from physicslab.view.canvas.quantities import quantity
from physicslab.view.canvas.theme import Theme
from physicslab.view.overlay.arrows import ArrowKind, Head, draw_arrows
from physicslab.view.overlay.gauge import Gauge
from physicslab.view.overlay.labels import Label
from physicslab.view.overlay.overlays import Overlays

__all__ = ["draw_free_body"]

_NORMAL = ArrowKind("Normal force", "normal_impulse", Head.DIAMOND)
_FRICTION = ArrowKind("Friction", "friction_impulse", Head.OPEN, dashed=True)
_KINDS = {"field": ArrowKind("Force", "force", Head.DOUBLE), "normal": _NORMAL, "friction": _FRICTION}
_WIDTH = 2.6
_REACH = 0.16
"""Length of the longest arrow, as a share of the smaller side of the picture."""


def draw_free_body(
    forces: Sequence[NamedForce],
    moved: Vector2,
    time: float,
    overlays: Overlays,
    camera: Camera,
    theme: Theme,
    canvas: Canvas,
    text_size: int,
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
    gauge.follow(sizes, _REACH * min(camera.size) / camera.scale, time)
    if not len(forces) or not gauge.per_metre:
        return
    labels = [_draw(one, moved, n, gauge, camera, theme, canvas) for n, one in enumerate(forces)]
    overlays.force_labels.draw(labels, overlays.covered, text_size, canvas, theme)


def _draw(
    one: NamedForce, moved: Vector2, number: int, gauge: Gauge, camera: Camera, theme: Theme, canvas: Canvas
) -> Label:
    """Draw one arrow, and return its label."""
    start = camera.project(np.array([(one.place.x + moved.x, one.place.y + moved.y)]))
    span = np.array([(one.force.x, -one.force.y)]) * (camera.scale / gauge.per_metre)
    draw_arrows(start, span, _KINDS[one.kind], canvas, theme, width=_WIDTH)
    x, y = (start + span)[0].tolist()
    return Label((number, hash(one.name)), (x, y), [f"{one.name}: {quantity(one.force.magnitude, 'N')}"])
