"""Fields behind the bodies, as a quiet pattern; and the flames of thrusts."""

import math

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Charge, Thrust, Transform
from physicslab.components.thrust import FRAMES
from physicslab.ecs.vector import rotated
from physicslab.theme import Theme, mixed
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, Points, draw_spots
from physicslab.world import World

_APART = 80.0
"""About how far the marks of a field are from each other [px]."""
_MARK, _ARROW = 4.0, 20.0
"""Half the size of a cross, and the length of an arrow [px]."""
_QUIET = 0.45
"""Share of the colour of faint words in that of the marks."""
_FLAME = 48.0
"""Length of the flame of the strongest thrust [px]."""


def draw_fields(world: World, camera: Camera, theme: Theme, canvas: Canvas) -> None:
    """Draw the fields that act on charges, if there are any.

    A magnetic field has dots where it comes out of the plane and crosses where it goes in, an electric one
    arrows between them.
    """
    physics = world.physics
    if not len(world.batch(Charge)) or not (physics.magnetic_field or physics.electric_field):
        return
    colour = mixed(theme.background, theme.faint, _QUIET)
    places, apart = _marks(camera)
    if physics.magnetic_field > 0.0:
        draw_spots(canvas, places, 2.0, colour, colour)
    elif physics.magnetic_field < 0.0:
        for slope in (1.0, -1.0):
            arm = np.array((_MARK, slope * _MARK))
            canvas.lines(places - arm, places + arm, colour, 1.5)
    if physics.electric_field:
        along = np.array((physics.electric_field.x, -physics.electric_field.y))
        along = along * (_ARROW / math.hypot(*along))
        tail = places + 0.5 * apart - 0.5 * along
        canvas.lines(tail, tail + along, colour, 1.5)
        for side in (0.5, -0.5):
            barb = 0.3 * np.array((-along[0] - side * along[1], side * along[0] - along[1]))
            canvas.lines(tail + along, tail + along + barb, colour, 1.5)


def _marks(camera: Camera) -> tuple[Points, float]:
    """Return where marks are that stay where they are in the world, and how far apart [px]."""
    step = 2.0 ** round(math.log2(_APART / camera.scale))
    low_x, low_y, high_x, high_y = camera.visible
    x, y = (
        step * np.arange(math.floor(low / step), math.ceil(high / step) + 1)
        for low, high in ((low_x, high_x), (low_y, high_y))
    )
    grid = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    return camera.project(grid), step * camera.scale


def draw_flames(world: World, camera: Camera, theme: Theme, canvas: Canvas) -> None:
    """Draw what each thrust leaves behind it at this moment, the strongest with the longest flame."""
    rows = world.batch(Thrust, Transform).rows
    if not len(rows):
        return
    table, transform = world.table(Thrust), world.table(Transform)
    angle = transform["angle"][rows]
    follows = table["frame"][rows] == FRAMES.index("body") + 1
    swing = np.cos(2.0 * np.pi * table["frequency"][rows] * world.time + table["phase"][rows])
    force = rotated(table["force"][rows], np.where(follows, angle, 0.0))
    largest = float(np.hypot(*force.T).max(initial=0.0))
    if not 0.0 < largest < math.inf:
        return
    back = force * (swing / -largest)[:, None]
    start = camera.project(transform["position"][rows] + rotated(table["at"][rows], angle))
    seen = np.isfinite(start).all(axis=1) & back.any(axis=1)
    _draw_tongues(start[seen], _FLAME * back[seen] * (1.0, -1.0), theme, canvas)


def _draw_tongues(start: Points, way: NDArray[np.float64], theme: Theme, canvas: Canvas) -> None:
    """Draw flames from points along ways (n, 2) [px]: wide and short ones on narrow and long ones."""
    for share, width in ((1.0, 3.0), (0.65, 6.0), (0.35, 9.0)):
        canvas.lines(start, start + share * way, theme.spark, width, 0.5)
