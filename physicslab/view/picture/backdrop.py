"""The backdrop: a grid, and the walls of the world."""

import math

import numpy as np

from physicslab.view.canvas.camera import Camera, Extent
from physicslab.view.canvas.canvas import Canvas, Numbers, Points
from physicslab.view.canvas.quantities import rounded_up
from physicslab.view.canvas.theme import Theme

_MIN_SPACING = 45.0
"""Least distance of grid lines [px]."""


def grid_spacing(scale: float) -> float:
    """Return the distance of grid lines [m] at a scale [px/m]: 1, 2 or 5 times a power of ten.

    >>> grid_spacing(100.0)
    0.5
    """
    return rounded_up(_MIN_SPACING / scale, 1e-9)


def _lines(camera: Camera, xs: Numbers, ys: Numbers) -> tuple[Points, Points]:
    """Return the starts and ends of upright lines at ``xs`` and level ones at ``ys`` [m], on whole pixels."""
    x = np.floor(camera.project(_pairs(xs, 0.0))[:, 0]) + 0.5
    y = np.floor(camera.project(_pairs(0.0, ys))[:, 1]) + 0.5
    width, height = camera.size
    start = np.concatenate((_pairs(x, 0.0), _pairs(0.0, y)))
    end = np.concatenate((_pairs(x, height), _pairs(width, y)))
    return start, end


def _pairs(x: Numbers | float, y: Numbers | float) -> Points:
    """Return points (n, 2) of two columns, one of which may be the same number throughout."""
    pairs: Points = np.stack(np.broadcast_arrays(x, y), axis=1, dtype=np.float64)
    return pairs


def draw_grid(camera: Camera, theme: Theme, canvas: Canvas) -> None:
    """Draw grid lines at round distances, and the lines through the origin a little brighter."""
    spacing = grid_spacing(camera.scale)
    xmin, ymin, xmax, ymax = camera.visible
    if max(map(abs, (xmin, ymin, xmax, ymax))) > 1e9 * spacing:  # so far out that lines would fall together
        return
    xs = spacing * np.arange(math.ceil(xmin / spacing), math.floor(xmax / spacing) + 1, dtype=np.float64)
    ys = spacing * np.arange(math.ceil(ymin / spacing), math.floor(ymax / spacing) + 1, dtype=np.float64)
    canvas.lines(*_lines(camera, xs, ys), theme.grid)
    canvas.lines(*_lines(camera, xs[xs == 0.0], ys[ys == 0.0]), theme.axis)


def draw_bounds(bounds: Extent | None, camera: Camera, theme: Theme, canvas: Canvas) -> None:
    """Draw the walls of the world, if it has any."""
    if bounds is None:
        return
    xmin, ymin, xmax, ymax = bounds
    corners = camera.project(np.array([(xmin, ymin), (xmax, ymin), (xmax, ymax), (xmin, ymax)]))
    corners = np.clip(corners, -1e6, 1e6)
    canvas.lines(corners, np.roll(corners, -1, axis=0), theme.bounds, 2.0)
