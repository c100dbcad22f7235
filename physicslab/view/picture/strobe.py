"""Strobe pictures: bodies once more where they were at regular moments, faintly."""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape
from physicslab.components.shape import BOX, CIRCLE
from physicslab.contacts.outlines import outlines_at
from physicslab.state.shapes import lengths_of
from physicslab.systems.strobe import StrobeSystem
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, Look
from physicslab.view.canvas.theme import Theme, mixed
from physicslab.view.picture.bodies import POINT_RADIUS, on_canvas, own_colour
from physicslab.world import World

_FILL, _RIM = 0.16, 0.55
"""Shares of a body's colour in the copies of it, the rest being background."""
_MAX = 6_000
"""How many copies are drawn; the newest of all bodies."""


def draw_strobes(world: World, camera: Camera, theme: Theme, canvas: Canvas) -> None:
    """Draw the outline of each body that has a Strobe at every moment that is on record."""
    system = world.schedule.find(StrobeSystem)
    if not isinstance(system, StrobeSystem):
        return
    rows, seen = system.pictures(world)
    rows, seen = rows[-_MAX:], seen[-_MAX:]
    centre, angle = camera.project(seen[:, :2]), seen[:, 2]
    shape = world.table(Shape)
    kind = shape["kind"][rows]
    half, rounding = lengths_of(shape, rows)
    extent, radius = 2.0 * camera.scale * half, np.where(kind == 0, POINT_RADIUS, camera.scale * rounding)
    reach = (np.hypot(extent[:, 0], extent[:, 1]) + radius)[:, None]
    with np.errstate(invalid="ignore"):
        inside = ((centre > -reach) & (centre < np.array(camera.size) + reach)).all(axis=1)
    fills, rims = _tints(theme)
    own = own_colour(world, theme, rows)
    boxes, discs = kind == BOX, (kind == CIRCLE) | (kind == 0)
    for which in (inside & boxes, inside & ~boxes & ~discs, inside & discs):
        if not which.any():
            continue
        look = Look(fills[own[which]], rims[own[which]], np.zeros(int(which.sum()), np.bool_))
        if boxes[which].any():
            canvas.boxes(centre[which], extent[which], angle[which], look)
        elif discs[which].any():
            canvas.discs(centre[which], radius[which], angle[which], look)
        else:
            outlines = outlines_at(world, rows, seen[:, :2], angle)
            canvas.rounded(on_canvas(outlines, which, camera), look)


@lru_cache(maxsize=8)
def _tints(theme: Theme) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Return what is inside the copies of each colour of bodies, and their rims."""
    fills = [mixed(theme.background, body, _FILL) for body in theme.bodies]
    rims = [mixed(theme.background, body, _RIM) for body in theme.bodies]
    return np.array(fills, np.uint8), np.array(rims, np.uint8)
