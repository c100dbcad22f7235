"""The backdrop: sky, stars where bodies attract each other, a grid, and the walls of the world."""

import math

import numpy as np

from physicslab.theme import WALL, Theme
from physicslab.view.canvas.camera import Camera, Extent
from physicslab.view.canvas.canvas import Canvas, Look, Numbers, Points
from physicslab.view.canvas.quantities import rounded_up
from physicslab.world import World

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


def is_in_space(world: World) -> bool:
    """Whether bodies attract each other: then there are stars, and no grid unless it is wanted."""
    return world.physics.gravity_mode == "planet"


def falls_down(world: World) -> bool:
    """Whether bodies fall downwards: below the world's end is ground, and above it there is more to see."""
    return world.physics.gravity_mode == "linear" and world.physics.gravity.y < 0.0


def draw_backdrop(world: World, camera: Camera, theme: Theme, canvas: Canvas, *, grid: bool) -> None:
    """Begin a picture with what is behind all bodies; it is kept while the camera stands still."""
    physics = world.physics
    in_space = is_in_space(world)
    has_ground = falls_down(world)

    def draw() -> None:
        if in_space and theme.is_dark:
            canvas.clear(theme.sky_top, theme.sky_top)
            _draw_stars(theme, canvas)
        else:
            canvas.clear(theme.sky_top, theme.sky_bottom, theme.grain)
        if grid:
            draw_grid(camera, theme, canvas)
        _draw_bounds(physics.bounds, has_ground, camera, theme, canvas)

    canvas.keep((camera.centre, camera.scale, theme.name, grid, in_space, has_ground, physics.bounds), draw)


_STARS, _LARGEST_SKY = 3000, 4096.0
"""Number of stars in a sky so wide [px], and half as high."""
_FAINTEST, _BRIGHTEST = 0.1, 0.5
"""Opacity of stars."""


def _draw_stars(theme: Theme, canvas: Canvas) -> None:
    """Draw faint stars, which are so far away that no camera moves them."""
    chance = np.random.default_rng(3).random((_STARS, 3))
    place, bright = _LARGEST_SKY * chance[:, :2] * (1.0, 0.5), chance[:, 2] ** 2
    seen = (place < canvas.size).all(axis=1)
    place, opacity = place[seen], _FAINTEST + (_BRIGHTEST - _FAINTEST) * bright[seen]
    for part, width in ((opacity < 0.3, 1.2), (opacity >= 0.3, 1.9)):
        canvas.lines(place[part], place[part], theme.text, width, opacity[part])


_FAR = 1e6
"""The farthest place drawn [px]."""


def _draw_bounds(
    bounds: Extent | None, has_ground: bool, camera: Camera, theme: Theme, canvas: Canvas
) -> None:
    """Draw the end of the world beyond its bounds: all is ground below where things fall to; thin walls."""
    if bounds is None:
        return
    xmin, ymin, xmax, ymax = bounds
    (left, bottom), (right, top) = np.clip(
        camera.project(np.array([(xmin, ymin), (xmax, ymax)])), -_FAR, _FAR
    )
    width, height = canvas.size
    below = left - WALL, bottom, right + WALL, bottom + WALL
    if has_ground:
        below = 0.0, bottom, float(width), max(float(height), bottom)
    sides = np.array([
        (left - WALL, top, left, bottom), (right, top, right + WALL, bottom),
        (left - WALL, top - WALL, right + WALL, top), below,
    ])  # fmt: skip
    shown = (sides[:, 2] > sides[:, 0]) & (sides[:, 3] > sides[:, 1])
    low, high = sides[shown, :2], sides[shown, 2:]
    look = Look.plain(theme.earth, theme.earth, len(low))
    canvas.boxes(0.5 * (low + high), high - low, np.zeros(len(low)), look)
    corners = np.array([(left, top), (right, top), (right, bottom), (left, bottom)])
    canvas.lines(corners, np.roll(corners, -1, axis=0), theme.static, 1.5)
