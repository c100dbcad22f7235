"""Which body or instrument is at a place on the screen."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Note, Spring, Transform
from physicslab.contacts.outlines import outlines_of
from physicslab.ecs.vector import Vector2
from physicslab.theme import POINT_RADIUS
from physicslab.view.canvas.camera import Camera
from physicslab.view.canvas.canvas import Rect, is_within
from physicslab.view.overlay.instruments import Instrument, instruments_of
from physicslab.view.picture.bodies import body_rows, point_radii
from physicslab.view.picture.joints import gaps_to, joint_at
from physicslab.view.picture.springs import ends_of
from physicslab.world import World

_MAX_FROM_SPRING = 6.0
"""How near to the line between its ends a click on a spring need be [px]."""
_MAX_DISTANCE = 7.0
"""How near to the middle of a body a click need only be [px]: so that what appears small can be caught."""
_MIDDLE = 10.0
"""How near to a body's middle a point of an instrument need be to go with it [px]."""
_ON_LINE, _ON_POINT = 5.0, 9.0
"""How near to a line or a point of an instrument a press need be [px]."""


def body_at(world: World, camera: Camera, pixel: tuple[float, float]) -> int | None:
    """Return the body that is drawn on top at a place on the screen [px], or ``None``.

    Otherwise the nearest whose middle is within a few pixels is taken.
    """
    return next(iter(bodies_at(world, camera, pixel)), None)


def bodies_at(world: World, camera: Camera, pixel: tuple[float, float], reach: float = 0.0) -> list[int]:
    """Return the bodies within a reach of a place on the screen [px], the upper ones first.

    Otherwise the one that :func:`body_at` returns.
    """
    place, rows = camera.to_world(pixel), body_rows(world)
    entities = world.entity_index.entities
    everything = rows.all
    gap = outlines_of(world, everything).gaps(place.x, place.y)
    gap[len(gap) - len(rows.points) :] -= point_radii(world, rows.points) / camera.scale
    gap[: len(rows.chains)] -= POINT_RADIUS / camera.scale
    near = np.flatnonzero(gap <= reach / camera.scale)[::-1]
    hit: list[int] = entities[everything[near]].tolist()
    if hit:
        return hit
    nearest = _nearest(world, everything, place, _MAX_DISTANCE / camera.scale)
    return [] if nearest is None else [nearest]


def spring_at(world: World, camera: Camera, pixel: tuple[float, float]) -> int | None:
    """Return the entity whose spring is nearest to a place on the screen [px], if it is near, or ``None``."""
    if not len(world.batch(Spring).rows):
        return None
    start, end = (camera.project(place) for place in ends_of(world))
    distance = gaps_to(start, end, pixel)
    nearest = int(np.argmin(distance))
    if distance[nearest] > _MAX_FROM_SPRING:
        return None
    return int(world.batch(Spring).entities[nearest])


def link_at(world: World, camera: Camera, pixel: tuple[float, float]) -> int | None:
    """Return the entity whose rod, rope or spring is at a place on the screen [px], or ``None``."""
    joint = joint_at(world, camera, pixel, lines=True)
    return spring_at(world, camera, pixel) if joint is None else joint


def centre_near(world: World, camera: Camera, pixel: tuple[float, float]) -> int | None:
    """Return the body whose middle is nearest to a place on the screen [px], if it is within a few pixels."""
    return _nearest(world, body_rows(world).all, camera.to_world(pixel), _MIDDLE / camera.scale)


def _nearest(world: World, rows: NDArray[np.int64], place: Vector2, reach: float) -> int | None:
    """Return which of the bodies in rows (n,) has the nearest middle, if it is within a reach [m]."""
    offset = world.table(Transform)["position"][rows] - (place.x, place.y)
    distance = np.hypot(offset[:, 0], offset[:, 1])
    if not len(distance) or not np.fmin.reduce(distance) <= reach:
        return None
    return int(world.entity_index.entities[rows[int(np.nanargmin(distance))]])


def directions_near(world: World, camera: Camera, place: Vector2) -> list[float]:
    """Return the angles of the boxes at a place [rad]: along them, or across, lines may be meant to go."""
    rows = np.concatenate((body_rows(world).boxes, body_rows(world).rounded))
    near = rows[outlines_of(world, rows).gaps(place.x, place.y) <= _MIDDLE / camera.scale]
    angles: list[float] = world.table(Transform)["angle"][near].tolist()
    return angles


def instrument_at(
    world: World, camera: Camera, pixel: tuple[float, float], rects: Mapping[int, Rect]
) -> int | None:
    """Return the instrument whose line or words are at a place on the screen [px]; of several the last made.

    ``rects`` says where words were drawn.
    """
    found = 0
    for one in instruments_of(world):
        words = rects.get(one.entity)
        if (words and is_within(pixel, words)) or _line_gap(one, camera, pixel) <= _ON_LINE:
            found = max(found, one.entity)
    return found or None


def point_at(one: Instrument, camera: Camera, pixel: tuple[float, float]) -> str | None:
    """Return the name of the point of an instrument that is at a place on the screen [px]."""
    distances = {
        name: math.dist(camera.to_screen(place), pixel)
        for name, place in one.points.items()
        if one.kind is not Note
    }
    nearest = min(distances, key=lambda name: distances[name], default=None)
    return nearest if nearest is not None and distances[nearest] <= _ON_POINT else None


def _line_gap(one: Instrument, camera: Camera, pixel: tuple[float, float]) -> float:
    """Return how far a place is from the lines of an instrument [px]; a note has none."""
    first, *others = (np.array(camera.to_screen(place)) for place in one.points.values())
    return float(gaps_to(first, np.reshape(others, (-1, 2)), pixel).min(initial=math.inf))
