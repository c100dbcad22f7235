"""Where bodies have been: trails that fade with age, and strobe pictures."""

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape, Strobe, Trail, Transform, Velocity
from physicslab.components.shape import BOX, CIRCLE
from physicslab.contacts.outlines import outlines_at
from physicslab.state.shapes import lengths_of
from physicslab.systems.strobe import StrobeSystem
from physicslab.systems.trail import SAMPLES, TrailSystem
from physicslab.theme import POINT_RADIUS, Theme
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Canvas, Look, Points
from physicslab.view.picture.bodies import on_canvas, own_colours, point_radii
from physicslab.view.picture.pen import divided
from physicslab.world import World

_SHADES = 16
"""Steps in which a trail fades."""
_NEWEST_SHARE = 0.85
"""Share of a body's colour in the newest part of its trail, the rest being background."""
_MAX_WIDTH, _MIN_WIDTH, _SHARE = 5.0, 0.7, 0.4
"""Widths of a trail's newest and oldest part [px]; the newest is at most so much of its body's thickness."""
_LINE, _MAX_LINES = 5.0, 8
"""Length of the lines of a curve [px], and most lines between two places."""
_CORNER = 0.8
"""Cosine of the angle at a place above which a trail goes on smoothly there."""
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

    It is a switch of the view, and no edit: where undo or a seek brings back bodies as they were, they have
    trails or none as it was set last.

    Attributes
    ----------
    on : bool, optional
        Whether bodies that come get a Trail, too; ``None`` for trails as the scene has them.
    goes_elsewhere : bool
        Whether the world goes to another place of its history before it is followed again.
    """

    def __init__(self) -> None:
        self.on: bool | None = None
        self._lengths: dict[int, float] = {}
        self.goes_elsewhere = False

    def toggle(self, world: World) -> None:
        """Take every Trail away if there are any, else give one to each moving body.

        A Trail that comes back is as long as it was.
        """
        world.synchronise()
        with_trail = world.table(Trail).handles
        self.on = not with_trail and not self.on
        if with_trail:
            self._lengths = {entity: world.component(entity, Trail).length for entity in with_trail}
            _take_off(world)
        self.follow(world)

    def follow(self, world: World) -> None:
        """Give a Trail to the moving bodies that came since the last call, while it is on.

        After it was turned off, those go again that a place of the history brings back; one that is given
        to a body, or is in a scene that is opened, stays.
        """
        went, self.goes_elsewhere = self.goes_elsewhere, False
        if self.on is False and len(world.batch(Trail)):
            self.on = False if went else None
            if went:
                _take_off(world)
        if not self.on:
            return
        moving = world.batch(Transform, Velocity).entities
        with_trail = world.batch(Transform, Velocity, Trail).entities
        for entity in np.setdiff1d(world.batch(Trail).entities, with_trail).tolist():
            world.discard(entity, Trail)  # it was fixed meanwhile, and would have none if it came again
        if len(moving) == len(with_trail):
            return
        for entity in np.setdiff1d(moving, with_trail).tolist():
            if world.has(entity, Velocity) and not world.has(entity, Trail):
                length = self._lengths.get(entity)
                world.add(entity, Trail() if length is None else Trail(length))


def _take_off(world: World) -> None:
    """Take every Trail away."""
    for entity in world.batch(Trail).entities.tolist():
        world.discard(entity, Trail)


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
    which = first // ages.shape[1]
    start, end, old, trail = _curved(points, age, first, second, which)
    seen = _on_screen(start, end, camera.size)
    shade = np.clip(_SHADES * old, 0, _SHADES - 1).astype(np.int8)
    drawn = np.flatnonzero(seen)
    drawn = drawn[np.argsort(-shade[drawn], kind="stable")]  # oldest first: what is brighter lies on top
    shade, trail = shade[drawn], trail[drawn]
    rows = world.entity_index.rows_of(system.entities)
    young = 1.0 - (shade + 0.5) / _SHADES
    room = min(_INK * camera.size[0] * camera.size[1] / max(total, 1.0), 1.0)
    widest = np.clip(_SHARE * _sizes(world, rows, camera), _MIN_WIDTH, _MAX_WIDTH)[trail]
    width = _MIN_WIDTH + (widest - _MIN_WIDTH) * young * room
    colour = theme.faded(own_colours(world, theme, rows)[trail], _NEWEST_SHARE * young)
    canvas.lines(start[drawn], end[drawn], colour, width)


def _sizes(world: World, rows: NDArray[np.int64], camera: Camera) -> NDArray[np.float64]:
    """Return how thick bodies are (n,) [px]: their least extent."""
    shape = world.table(Shape)
    half, rounding = lengths_of(shape, rows)
    thick = 2.0 * camera.scale * (half.min(axis=1) + rounding)
    points = shape["kind"][rows] == 0
    thick[points] = 2.0 * point_radii(world, rows[points])
    return thick


def _curved(
    points: Points, age: NDArray[np.float64], first: NDArray[np.int64], second: NDArray[np.int64],
    trail: NDArray[np.int64],
) -> tuple[Points, Points, NDArray[np.float64], NDArray[np.int64]]:  # fmt: skip
    """Return the lines that pieces are drawn as: starts, ends (k, 2) [px], ages and trails (k,).

    Pieces that are long enough to be seen straight follow the cubic through their ends along the mean
    directions there; at a sharp corner, as of a bounce, a piece is as straight there as it was recorded.
    """
    begin, along = points[first], points[second] - points[first]
    length = np.hypot(along[:, 0], along[:, 1])
    count = np.clip(np.ceil(length / _LINE), 1, _MAX_LINES).astype(np.int64)
    if len(first) > _MAX_PIECES // 4 or not (count > 1).any():
        return begin, points[second], 0.5 * (age[first] + age[second]), trail
    way = along / np.maximum(length, 1e-9)[:, None]
    joined = second[:-1] == first[1:]
    smooth = joined & ((way[:-1] * way[1:]).sum(axis=1) > _CORNER)
    mean = way[:-1] + way[1:]
    mean /= np.maximum(np.hypot(mean[:, 0], mean[:, 1]), 1e-9)[:, None]
    leave, arrive = way.copy(), way.copy()
    leave[1:][smooth], arrive[:-1][smooth] = mean[smooth], mean[smooth]
    piece, nth = divided(count)

    def place(share: NDArray[np.float64]) -> Points:
        s, size = share[:, None], length[piece][:, None]
        cubic: Points = begin[piece] + (3.0 - 2.0 * s) * s * s * along[piece]
        return cubic + s * (1.0 - s) * size * ((1.0 - s) * leave[piece] - s * arrive[piece])

    share = (nth + 0.5) / count[piece]
    old = age[first][piece] + share * (age[second] - age[first])[piece]
    return place(nth / count[piece]), place((nth + 1) / count[piece]), old, trail[piece]


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
_FADING = 0.75
"""Share of these by which the oldest copies are fainter."""
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
    own = own_colours(world, theme, rows)
    strobe = world.table(Strobe)
    age = (world.time - seen[:, 3]) / np.maximum(strobe["interval"][rows] * strobe["count"][rows], 1e-9)
    fresh = 1.0 - _FADING * np.clip(age, 0.0, 1.0)
    fills, rims = theme.faded(own, _FILL * fresh), theme.faded(own, _RIM * fresh)
    boxes, discs = kind == BOX, (kind == CIRCLE) | (kind == 0)
    for which in (inside & boxes, inside & ~boxes & ~discs, inside & discs):
        if not which.any():
            continue
        look = Look(fills[which], rims[which], np.zeros(int(which.sum()), np.int64))
        if boxes[which].any():
            canvas.boxes(centre[which], extent[which], angle[which], look)
        elif discs[which].any():
            canvas.discs(centre[which], radius[which], angle[which], look)
        else:
            outlines = outlines_at(world, rows, seen[:, :2], angle)
            canvas.rounded(on_canvas(outlines, which, camera), look)
