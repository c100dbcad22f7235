"""Whether there is room for what is to be made."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape, Transform, Velocity
from physicslab.components.shape import BOX
from physicslab.ecs.component import Component
from physicslab.ecs.vector import Vector2
from physicslab.world import World

__all__ = ["Outlines", "free_way", "outlines_of", "refused_change", "refused_place"]

type Numbers = NDArray[np.float64]

_ALLOWED = 1e-3
"""Overlap [m] that is no obstacle: what is put down on a floor by eye."""
_BEYOND = "there is no room beyond the walls"
_STRIDE, _MAX_STRIDES, _HALVINGS = 0.1, 64, 10
"""A way is looked at every so many metres, at so many places at most, and then more closely."""


@dataclass(frozen=True, slots=True)
class Outlines:
    """Discs and boxes, a row each; a disc has a radius and no extent, a box the other way round.

    Attributes
    ----------
    place, half : float64 arrays (n, 2)
        Where the middle is, and half of a box's width and height [m].
    radius, angle : float64 arrays (n,)
        Of a disc [m], and how far a box has turned [rad].
    """

    place: Numbers
    half: Numbers
    radius: Numbers
    angle: Numbers

    def moved(self, by: Vector2) -> Outlines:
        """Return the same elsewhere."""
        return Outlines(self.place + np.array((by.x, by.y)), self.half, self.radius, self.angle)

    @property
    def reach(self) -> Numbers:
        """Half of the width and height of what is taken up along the axes of the world (n, 2) [m]."""
        c, s = np.abs(np.cos(self.angle)), np.abs(np.sin(self.angle))
        across = c * self.half[:, 0] + s * self.half[:, 1] + self.radius
        up = s * self.half[:, 0] + c * self.half[:, 1] + self.radius
        return np.stack((across, up), axis=1)


def outlines_of(world: World, rows: NDArray[np.int64] | None = None) -> Outlines:
    """Return the outlines of all shapes of a world, or of those in some rows."""
    world.synchronise()
    if rows is None:
        rows = world.batch(Transform, Shape).rows
    transform, shape = world.table(Transform), world.table(Shape)
    box = shape["kind"][rows] == BOX
    half = 0.5 * np.stack((shape["width"][rows], shape["height"][rows]), axis=1) * box[:, None]
    radius = np.where(box, 0.0, shape["radius"][rows])
    return Outlines(transform["position"][rows].copy(), half, radius, transform["angle"][rows].copy())


def refused_place(world: World, outlines: Outlines) -> str:
    """Return why something cannot be made here; empty where it can."""
    if _is_outside(world, outlines):
        return _BEYOND
    others = outlines_of(world)
    for n in range(len(outlines.place)):
        near = (np.abs(others.place - outlines.place[n]) < others.reach + outlines.reach[n]).all(axis=1)
        for other in np.flatnonzero(near):
            if _overlap(outlines, n, others, int(other)) > _ALLOWED:
                return "there is no room here"
    return ""


def refused_change(world: World, entity: int, kind: type[Component], name: str, value: object) -> str:
    """Return why a body cannot be given another place or size: it would overlap, or lie beyond the walls.

    What overlaps already may be changed as long as it does not overlap more.
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


def _is_outside(world: World, outlines: Outlines) -> bool:
    """Whether a part of this lies beyond the walls of the world."""
    bounds = world.physics.bounds
    if bounds is None:
        return False
    low, high = outlines.place - outlines.reach, outlines.place + outlines.reach
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
    near = np.flatnonzero((np.abs(others.place - one.place[0]) < others.reach + one.reach[0]).all(axis=1))
    return max((_overlap(one, 0, others, int(other)) for other in near), default=0.0)


def _overlap(one: Outlines, n: int, two: Outlines, m: int) -> float:
    """Return by how much two shapes overlap along the direction in which it is least [m]; negative if apart.

    Directions of edges and between middles and the nearest corners are tried (Ericson, Real-Time Collision
    Detection, 2005, 5.2).
    """
    offset = two.place[m] - one.place[n]
    axes = [*_axes(one, n), *_axes(two, m)]
    for disc, centre, other, k in ((one, n, two, m), (two, m, one, n)):
        if disc.radius[centre] > 0.0:
            towards = _nearest(other, k, disc.place[centre]) - disc.place[centre]
            length = float(np.hypot(*towards))
            if length > 0.0:
                axes.append(towards / length)
    gaps = [_extent(one, n, axis) + _extent(two, m, axis) - abs(float(offset @ axis)) for axis in axes]
    return min(gaps)


def _axes(shape: Outlines, n: int) -> list[Numbers]:
    """Return the directions of a box's edges; a disc has none."""
    if shape.radius[n] > 0.0:
        return []
    c, s = np.cos(shape.angle[n]), np.sin(shape.angle[n])
    return [np.array((c, s)), np.array((-s, c))]


def _extent(shape: Outlines, n: int, axis: Numbers) -> float:
    """Return how far a shape reaches from its middle along a direction [m]."""
    if shape.radius[n] > 0.0:
        return float(shape.radius[n])
    along, across = _axes(shape, n)
    return float(shape.half[n, 0] * abs(along @ axis) + shape.half[n, 1] * abs(across @ axis))


def _nearest(shape: Outlines, n: int, place: Numbers) -> Numbers:
    """Return the point of a shape that is nearest to a place; of a disc its middle."""
    middle: Numbers = shape.place[n]
    if shape.radius[n] > 0.0:
        return middle
    along, across = _axes(shape, n)
    offset = place - middle
    u = float(np.clip(offset @ along, -shape.half[n, 0], shape.half[n, 0]))
    v = float(np.clip(offset @ across, -shape.half[n, 1], shape.half[n, 1]))
    nearest: Numbers = middle + u * along + v * across
    return nearest
