"""Whether there is room for what is to be made."""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape, Transform, Velocity
from physicslab.contacts import outlines
from physicslab.contacts.outlines import Outlines, overlap, overlapping
from physicslab.ecs.component import Component
from physicslab.ecs.vector import Vector2
from physicslab.world import World

_ALLOWED = 1e-3
"""Overlap [m] that is no obstacle: what is put down on a floor by eye."""
_BEYOND = "there is no room beyond the walls"
_STRIDE, _MAX_STRIDES, _HALVINGS = 0.1, 64, 10
"""A way is looked at every so many metres, at so many places at most, and then more closely."""


def outlines_of(world: World, rows: NDArray[np.int64] | None = None) -> Outlines:
    """Return the outlines of all shapes of a world, or of those in some rows."""
    world.synchronise()
    return outlines.outlines_of(world, world.batch(Transform, Shape).rows if rows is None else rows)


def refused_place(world: World, wanted: Outlines) -> str:
    """Return why something cannot be made here; empty where it can."""
    if _is_outside(world, wanted):
        return _BEYOND
    others = outlines_of(world)
    for n in range(len(wanted.place)):
        for other in overlapping(wanted, n, others):
            if overlap(wanted, n, others, int(other))[0] > _ALLOWED:
                return "there is no room here"
    return ""


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
        outside = _is_outside(world, outlines_of(world, _row_of(world, entity)))
    finally:
        setattr(part, name, kept)
    if outside:
        return _BEYOND
    return "it would overlap another body" if after > max(before, _ALLOWED) else ""


def _row_of(world: World, entity: int) -> NDArray[np.int64]:
    return np.array([world.entity_index.row_of[entity]], np.int64)


def _overlapping(world: World, entity: int) -> float:
    """Return by how much a body overlaps any other [m]; at least 0."""
    rows = world.batch(Transform, Shape).rows
    own = _row_of(world, entity)
    return _deepest(outlines_of(world, own), outlines_of(world, rows[rows != own[0]]))


def _is_outside(world: World, shapes: Outlines) -> bool:
    """Whether a part of this lies beyond the walls of the world."""
    bounds = world.physics.bounds
    if bounds is None:
        return False
    low, high = shapes.place - shapes.reach, shapes.place + shapes.reach
    beyond = (low < np.array(bounds[:2]) - _ALLOWED) | (high > np.array(bounds[2:]) + _ALLOWED)
    return bool(beyond.any())


def free_way(world: World, entity: int, way: Vector2) -> Vector2:
    """Return the part of a way [m] that leads a body no deeper into what cannot move: it slides along it."""
    row = world.entity_index.row_of[entity]
    shaped = world.batch(Transform, Shape).rows
    walls = outlines_of(world, shaped[~world.table(Velocity).present[shaped]])
    own = outlines_of(world, np.array([row], np.int64))
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
