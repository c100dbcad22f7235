"""Whether there is room for what is to be made."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape, Transform
from physicslab.components.shape import BOX
from physicslab.ecs.vector import Vector2
from physicslab.world import World

__all__ = ["Outlines", "outlines_of", "refused_place"]

type Numbers = NDArray[np.float64]

_ALLOWED = 1e-3
"""Overlap [m] that is no obstacle: what is put down on a floor by eye."""


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


def outlines_of(world: World) -> Outlines:
    """Return the outlines of all shapes of a world."""
    world.synchronise()
    rows = world.batch(Transform, Shape).rows
    transform, shape = world.table(Transform), world.table(Shape)
    box = shape["kind"][rows] == BOX
    half = 0.5 * np.stack((shape["width"][rows], shape["height"][rows]), axis=1) * box[:, None]
    radius = np.where(box, 0.0, shape["radius"][rows])
    return Outlines(transform["position"][rows].copy(), half, radius, transform["angle"][rows].copy())


def refused_place(world: World, outlines: Outlines) -> str:
    """Return why something cannot be made here; empty where it can."""
    bounds = world.physics.bounds
    if bounds is not None:
        low, high = outlines.place - outlines.reach, outlines.place + outlines.reach
        if (low < np.array(bounds[:2]) - _ALLOWED).any() or (high > np.array(bounds[2:]) + _ALLOWED).any():
            return "there is no room beyond the walls"
    others = outlines_of(world)
    for n in range(len(outlines.place)):
        near = (np.abs(others.place - outlines.place[n]) < others.reach + outlines.reach[n]).all(axis=1)
        for other in np.flatnonzero(near):
            if _overlap(outlines, n, others, int(other)) > _ALLOWED:
                return "there is no room here"
    return ""


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
