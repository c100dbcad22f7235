"""Where bodies have been: trails that fade with age, and strobe pictures."""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape, Trail, Transform, Velocity
from physicslab.components.shape import BOX, CIRCLE
from physicslab.contacts.outlines import outlines_at
from physicslab.state.shapes import lengths_of
from physicslab.systems.strobe import StrobeSystem
from physicslab.systems.trail import SAMPLES, TrailSystem
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, Look, Points
from physicslab.view.canvas.theme import Theme, mixed
from physicslab.view.picture.bodies import POINT_RADIUS, on_canvas, own_colour
from physicslab.world import World

_SHADES = 16
"""Steps in which a trail fades."""
_NEWEST_SHARE = 0.85
"""Share of a body's colour in the newest part of its trail, the rest being background."""
_MAX_WIDTH, _MIN_WIDTH = 2.6, 1.0
"""Width of a trail's newest and oldest part [px]."""
_INK = 0.08
"""Trails longer together than this share of the picture's pixels are finer: something shows between them."""
_MIN_DISTANCE = 3.0
"""The least distance along a trail of the places it is drawn through [px]."""
_MAX_PIECES = 12_000
"""About how many pieces of all trails together are drawn."""
_MAX_READ = 24_000
"""About how many places are looked at, of all trails together: where trails are many, each is coarser."""
_COARSENESS = (1, 2, 4, 8, 16)
"""One place in so many is looked at."""
_MAX_OFFSET = 1e6
"""Places farther away than this are not drawn [px]."""


class TrailSwitch:
    """Gives every moving body a Trail, or takes them all away.

    Attributes
    ----------
    on : bool
        Whether bodies that come get a Trail, too.
    """

    def __init__(self) -> None:
        self.on = False
        self._lengths: dict[int, float] = {}

    def toggle(self, world: World) -> None:
        """Take every Trail away if there are any, else give one to each moving body.

        A Trail that comes back is as long as it was.
        """
        world.synchronise()
        with_trail = world.table(Trail).handles
        if not with_trail:
            self.on = not self.on
            self.follow(world)
            return
        self.on = False
        self._lengths = {entity: world.component(entity, Trail).length for entity in with_trail}
        for entity in self._lengths:
            world.discard(entity, Trail)

    def follow(self, world: World) -> None:
        """Give a Trail to the moving bodies that came since the last call, while it is on."""
        if not self.on:
            return
        moving = world.batch(Transform, Velocity).entities
        with_trail = world.batch(Transform, Velocity, Trail).entities
        if len(moving) == len(with_trail):
            return
        for entity in np.setdiff1d(moving, with_trail).tolist():
            if world.has(entity, Velocity) and not world.has(entity, Trail):
                length = self._lengths.get(entity)
                world.add(entity, Trail() if length is None else Trail(length))


def draw_trails(world: World, camera: Camera, theme: Theme, canvas: Canvas) -> None:
    """Draw the path of every body that has a Trail, fading from its colour to the background."""
    system = world.schedule.find(TrailSystem)
    if not isinstance(system, TrailSystem):
        return
    coarse = len(system.entities) * SAMPLES / _MAX_READ
    every = next(n for n in _COARSENESS if n >= coarse or n == _COARSENESS[-1])
    places, ages = system.paths(every)
    places = camera.project(places.reshape(-1, 2)).reshape(places.shape)
    first, second, total = _pieces(places, ages)
    points, age = places.reshape(-1, 2), ages.ravel()
    seen = _on_screen(points[first], points[second], camera.size)
    first, second = first[seen], second[seen]
    shade = np.clip(_SHADES * 0.5 * (age[first] + age[second]), 0, _SHADES - 1).astype(np.int8)
    order = np.argsort(-shade, kind="stable")  # oldest first, so that what is brighter lies on top
    first, second, shade = first[order], second[order], shade[order]
    colour = own_colour(world, theme, world.entity_index.rows_of(system.entities))[first // ages.shape[1]]
    young = 1.0 - (shade + 0.5) / _SHADES
    room = _INK * camera.size[0] * camera.size[1] / max(total, 1.0)
    width = np.maximum(_MIN_WIDTH + (_MAX_WIDTH - _MIN_WIDTH) * young * min(room, 1.0), _MIN_WIDTH)
    tint = _tints(theme)[shade, colour]
    canvas.strokes(points[first], points[second], tint, width)


@lru_cache(maxsize=8)
def _tints(theme: Theme) -> NDArray[np.uint8]:
    """Return the colours (``_SHADES``, bodies, 3) of trails, newest first."""
    shares = [_NEWEST_SHARE * (1.0 - (shade + 0.5) / _SHADES) for shade in range(_SHADES)]
    return np.array(
        [[mixed(theme.background, body, share) for body in theme.bodies] for share in shares], np.uint8
    )


def _pieces(
    places: NDArray[np.float64], ages: NDArray[np.float64]
) -> tuple[NDArray[np.int64], NDArray[np.int64], float]:
    """Return the two ends of every piece to draw, as numbers into the flattened ``places`` (n, k, 2) [px].

    Places that lie closer together than can be seen apart are left out; the newest never is. The third
    value is how long all trails are together [px].
    """
    with np.errstate(invalid="ignore", over="ignore"):
        across, down = places[..., 0], places[..., 1]
        shown = (ages <= 1.0) & (np.abs(across) < _MAX_OFFSET) & (np.abs(down) < _MAX_OFFSET)
        step = np.hypot(np.diff(across, axis=1), np.diff(down, axis=1))
        step = np.where(shown[:, 1:] & shown[:, :-1], step, 0.0)
    # Measured from the newest end, so that the drawn places do not creep while old ones fall away.
    left = np.zeros(shown.shape)
    left[:, :-1] = np.cumsum(step[:, ::-1], axis=1)[:, ::-1]
    total = float(left[:, 0].sum())
    mark = np.floor(left / max(_MIN_DISTANCE, total / _MAX_PIECES))
    apart = np.ones(shown.shape, np.bool_)
    apart[:, :-1] = mark[:, :-1] != mark[:, 1:]
    kept = np.flatnonzero(shown & apart)
    same = kept[1:] // shown.shape[1] == kept[:-1] // shown.shape[1]
    return kept[:-1][same], kept[1:][same], total


def _on_screen(start: Points, end: Points, size: tuple[int, int]) -> NDArray[np.bool_]:
    """Whether each piece can be seen."""
    seen = np.ones(len(start), np.bool_)
    for a, b, side in zip(start.T, end.T, size, strict=True):
        seen &= (np.maximum(a, b) > -_MAX_WIDTH) & (np.minimum(a, b) < side + _MAX_WIDTH)
    return seen


# ---- strobe pictures: bodies once more where they were at regular moments, faintly -------------------------


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
    fills, rims = _strobe_tints(theme)
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
def _strobe_tints(theme: Theme) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Return what is inside the copies of each colour of bodies, and their rims."""
    fills = [mixed(theme.background, body, _FILL) for body in theme.bodies]
    rims = [mixed(theme.background, body, _RIM) for body in theme.bodies]
    return np.array(fills, np.uint8), np.array(rims, np.uint8)
