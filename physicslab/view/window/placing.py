"""Whether there is room for what is to be made, and where it snaps."""

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape, Transform, Velocity
from physicslab.contacts import outlines
from physicslab.contacts.outlines import Outlines, overlap, overlapping
from physicslab.ecs.component import Component
from physicslab.ecs.vector import Vector2
from physicslab.languages.sentence import Sentence
from physicslab.state.solid import may_touch, solid_rows
from physicslab.view.canvas.camera import Camera
from physicslab.view.picture.backdrop import grid_spacing
from physicslab.world import World

_ALLOWED = 1e-3
"""Overlap [m] that is no obstacle: what is put down on a floor by eye."""
_BY_EYE = 9.0
"""Overlap [px] by which something that is put down by eye is moved aside: it was to lie against the other."""
_SIDES = 4
"""How many bodies it is moved away from, one after the other."""
_FOOT = 0.5
"""How far from what is below the foot of something may be put down to stand on it [m]."""
_BEYOND = Sentence("it would reach beyond the walls")
_STRIDE, _MAX_STRIDES, _HALVINGS = 0.1, 64, 10
"""A way is looked at every so many metres, at so many places at most, and then more closely."""


def outlines_of(world: World, rows: NDArray[np.int64] | None = None) -> Outlines:
    """Return the outlines of all shapes of a world, or of those in some rows."""
    world.synchronise()
    return outlines.outlines_of(world, world.batch(Transform, Shape).rows if rows is None else rows)


def outline_of(world: World, entity: int) -> Outlines:
    """Return the outline of an entity's shape, the only row."""
    return outlines_of(world, np.array([world.entity_index.row_of[entity]]))


def refused_place(world: World, wanted: Outlines) -> str:
    """Return why something cannot be made here; empty where it can."""
    if _is_outside(world, wanted):
        return _BEYOND
    rows = solid_rows(world)
    others = outlines_of(world, rows)
    for n in range(len(wanted.place)):
        for other in overlapping(wanted, n, others):
            if overlap(wanted, n, others, int(other))[0] > _ALLOWED:
                body = world.label(int(world.entity_index.entities[rows[other]]))
                return Sentence("there is no room here, {body} is in the way", body=body)
    return ""


def way_aside(world: World, camera: Camera, wanted: Outlines) -> Vector2:
    """Return the way [m] on which something leaves what it overlaps by a few pixels; zero if it cannot."""
    others, most = outlines_of(world, solid_rows(world)), _BY_EYE / camera.scale
    gone = _way_inside(world, wanted)
    for _ in range(_SIDES):
        moved = wanted.moved(gone)
        found = [
            overlap(moved, n, others, int(other))
            for n in range(len(moved.place))
            for other in overlapping(moved, n, others)
        ]
        depth, way = max(found, key=lambda pair: pair[0], default=(0.0, np.zeros(2)))
        if depth <= _ALLOWED or gone.magnitude > most:
            break
        gone -= Vector2(*(way * depth).tolist())
    return gone if gone.magnitude <= most else Vector2()


def way_within(world: World, entity: int, way: Vector2) -> Vector2:
    """Return the part of a way [m] that does not lead a body beyond the walls of the world."""
    return way + _way_inside(world, outline_of(world, entity).moved(way))


def _way_inside(world: World, shapes: Outlines) -> Vector2:
    """Return the way [m] from beyond the walls of the world to within them; to the middle if too large."""
    bounds = world.physics.bounds
    if bounds is None or not len(shapes.place):
        return Vector2()
    low, high = extent_about(shapes)
    below, above = np.array(bounds[:2]) - low, high - np.array(bounds[2:])
    within = np.maximum(below, 0.0) - np.maximum(above, 0.0)
    way = np.where(below + above > 0.0, 0.5 * (below - above), within)
    return Vector2(*way.tolist())


def meetings(world: World, entities: Sequence[int], reach: float) -> dict[tuple[int, int], Vector2]:
    """Return where pairs of bodies meet, or are not farther apart than a length [m]: in the middle there."""
    world.synchronise()
    shapes = outlines_of(world, world.entity_index.rows_of(np.array(entities, np.int64)))
    low, high = shapes.boxes
    return {
        (entities[n], entities[m]): Vector2(
            *(0.5 * (np.maximum(low[n], low[m]) + np.minimum(high[n], high[m]))).tolist()
        )
        for n, m in combinations(range(len(entities)), 2)
        if overlap(shapes, n, shapes, m)[0] >= -reach and not (shapes.line[n] or shapes.line[m])
    }


def refused_change(world: World, entity: int, kind: type[Component], name: str, value: object) -> str:
    """Return why a body cannot be given another place or size: it would overlap, or lie beyond the walls.

    A body that overlaps already may be changed as long as it does not overlap more.
    """
    if not (world.has(entity, Transform) and world.has(entity, Shape)):
        return ""
    before = _overlapping(world, entity)
    part = world.component(entity, kind)
    kept = getattr(part, name)
    try:
        setattr(part, name, value)
        after = _overlapping(world, entity)
        outside = _is_outside(world, outline_of(world, entity))
    finally:
        setattr(part, name, kept)
    if outside:
        return _BEYOND
    return "it would overlap another body" if after > max(before, _ALLOWED) else ""


def _overlapping(world: World, entity: int) -> float:
    """Return by how much a body overlaps any other that it can touch [m]; at least 0."""
    return _deepest(outline_of(world, entity), outlines_of(world, _touched(world, entity)))


def _touched(world: World, entity: int) -> NDArray[np.int64]:
    """Return the rows (n,) of all shapes that can touch that of an entity."""
    rows, own = solid_rows(world), world.entity_index.row_of[entity]
    if own not in rows:  # a medium
        return rows[:0]
    rows = rows[rows != own]
    touched: NDArray[np.int64] = rows[may_touch(world, np.full(len(rows), own), rows)]
    return touched


def area_of(world: World, entity: int) -> float:
    """Return the area of a body's shape [m^2]; 0 without a shape."""
    return float(outline_of(world, entity).area[0]) if world.has(entity, Shape) else 0.0


def _is_outside(world: World, shapes: Outlines) -> bool:
    """Whether a part of this lies beyond the walls of the world."""
    bounds = world.physics.bounds
    if bounds is None:
        return False
    low, high = shapes.boxes
    beyond = (low < np.array(bounds[:2]) - _ALLOWED) | (high > np.array(bounds[2:]) + _ALLOWED)
    return bool(beyond.any())


def free_way(world: World, entity: int, way: Vector2) -> Vector2:
    """Return the part of a way [m] that leads a body no deeper into what cannot move: it slides along it."""
    own, touched = outline_of(world, entity), _touched(world, entity)
    walls = outlines_of(world, touched[~world.table(Velocity).present[touched]])
    if not len(walls.place) or not world.has(entity, Shape):
        return way
    allowed = max(_deepest(own, walls), _ALLOWED)

    def is_free(part: Vector2) -> bool:
        return _deepest(own.moved(part), walls) <= allowed

    gone = _as_far(is_free, Vector2(), way)
    for rest in (Vector2(way.x - gone.x, 0.0), Vector2(0.0, way.y - gone.y)):
        gone = _as_far(is_free, gone, rest)
    return gone


def _as_far(is_free: Callable[[Vector2], bool], start: Vector2, way: Vector2) -> Vector2:
    """Return how far something comes from a free start along a way."""
    steps = min(max(math.ceil(way.magnitude / _STRIDE), 1), _MAX_STRIDES)
    free, blocked = 0.0, None
    for n in range(1, steps + 1):
        if not is_free(start + way * (n / steps)):
            blocked = n / steps
            break
        free = n / steps
    for _ in range(_HALVINGS if blocked is not None else 0):
        middle = 0.5 * (free + (blocked or 0.0))
        if is_free(start + way * middle):
            free = middle
        else:
            blocked = middle
    return start + way * free


def _deepest(one: Outlines, others: Outlines) -> float:
    """Return by how much the first shape of ``one`` overlaps any of the others [m]; at least 0."""
    depths = (overlap(one, 0, others, int(other))[0] for other in overlapping(one, 0, others))
    return max(depths, default=0.0)


# ---- places that snap: to the edges and middles of other bodies, and else to the grid ----------------------


_NEAR = 9.0
"""How near the edge of another body must be for a place to snap to it [px]."""
_FINE = 5
"""Into how many parts the distance of grid lines is divided: places snap to these."""

type Numbers = NDArray[np.float64]
"""A float64 array, of bodies (n, 2) [m], or a place (2,) [m]."""


@dataclass(frozen=True, slots=True)
class Mark:
    """A line that shows where a place has snapped: at a coordinate along x (0) or y (1) [m]."""

    axis: int
    at: float


@dataclass(frozen=True, slots=True)
class Snapped:
    """A place that has snapped, with what shows where."""

    place: Vector2
    marks: tuple[Mark, ...] = ()


def extent_about(outlines: Outlines) -> tuple[Numbers, Numbers]:
    """Return the lowest and the highest corner of what shapes take up (2,) [m]; points are at the origin."""
    if not len(outlines.place):
        return np.zeros(2), np.zeros(2)
    low, high = outlines.boxes
    return low.min(axis=0), high.max(axis=0)


def snapped(
    world: World, camera: Camera, place: Vector2, low: Numbers, high: Numbers, without: Collection[int] = ()
) -> Snapped:
    """Return the place near to one at which something snaps.

    Along each axis its lower side, its middle and its upper side are tried against those of other bodies;
    where none is near, its middle goes to the lines of the grid, or to what lies a fifth between two of them.

    Parameters
    ----------
    place : Vector2
        Where its middle would be [m].
    low, high : float64 arrays (2,)
        Its extent from its middle [m]; both zero for a point.
    without : collection of int
        Entities that it does not snap to: itself.
    """
    rows = world.batch(Transform, Shape).rows
    rows = rows[~np.isin(world.entity_index.entities[rows], list(without))]
    others = outlines_of(world, rows)
    lowest, highest = others.boxes
    near = _NEAR / camera.scale
    step = grid_spacing(camera.scale) / _FINE
    found, marks = [place.x, place.y], []
    for axis in (0, 1):
        lines = np.concatenate((lowest[:, axis], others.place[:, axis], highest[:, axis]))
        own = np.array((low[axis], 0.0, high[axis]))
        gaps = lines[:, None] - (found[axis] + own)[None, :]
        least = int(np.argmin(np.abs(gaps))) if gaps.size else 0
        if gaps.size and abs(gaps.flat[least]) <= near:
            found[axis] += float(gaps.flat[least])
            marks.append(Mark(axis, float(lines[least // len(own)])))
        else:
            found[axis] = round(found[axis] / step) * step
            if abs(found[axis] / (step * _FINE) - round(found[axis] / (step * _FINE))) < 1e-9:
                marks.append(Mark(axis, found[axis]))
    return Snapped(Vector2(*found), tuple(marks))


def snapped_point(world: World, camera: Camera, place: Vector2) -> Vector2:
    """Return the place near to one [m] at which a point snaps."""
    return snapped(world, camera, place, np.zeros(2), np.zeros(2)).place


class Snapping:
    """Whether places snap, and where the cursor's place has snapped to.

    Attributes
    ----------
    on, held : bool
        Whether it was chosen to stay, and whether a key for it is held.
    place : Vector2, optional
        Where what is moved or made goes in place of the cursor [m]; ``None`` where nothing snaps.
    marks : tuple of Mark
        Marks that show that.
    """

    def __init__(self) -> None:
        self.on = self.held = False
        self.place: Vector2 | None = None
        self.marks: tuple[Mark, ...] = ()

    @property
    def active(self) -> bool:
        """Whether places, sizes and angles snap now."""
        return self.on or self.held

    def clear(self) -> None:
        """Let nothing be snapped."""
        self.place, self.marks = None, ()

    def follow(
        self, world: World, camera: Camera, cursor: Vector2, middle: Vector2, about: Outlines | None,
        without: Collection[int],
    ) -> None:  # fmt: skip
        """Find where what the cursor moves or makes would snap.

        Parameters
        ----------
        cursor, middle : Vector2
            Where the cursor is, and where the middle of what it holds would be [m].
        about : Outlines, optional
            Its outlines, with its middle at the origin; ``None`` for a point.
        without : collection of int
            Entities that it does not snap to.
        """
        low, high = (np.zeros(2), np.zeros(2)) if about is None else extent_about(about)
        found = snapped(world, camera, middle, low, high, without)
        self.place, self.marks = found.place + (cursor - middle), found.marks


def put_down(world: World, places: Sequence[Vector2], *, each: bool) -> Sequence[Vector2]:
    """Return points [m] so far down, or up, that what is at them stands on what is just below.

    Parameters
    ----------
    each : bool
        Whether each of them is put down, so that a row goes along the ground; else all alike.
    """
    solid, floor = outlines_of(world, solid_rows(world)), (world.physics.bounds or (0.0, -math.inf))[1]
    low = min(place.y for place in places)
    feet = [(place.x, place.y if each else low) for place in places]
    falls = [min(y - floor, *(solid.gaps(x, y).tolist() or [math.inf])) for x, y in feet]
    if max(map(abs, falls)) > _FOOT:
        return places
    if not each:
        falls = [min(falls, key=abs)] * len(falls)
    return [place - Vector2(0.0, fall) for place, fall in zip(places, falls, strict=True)]
