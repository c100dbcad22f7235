"""Outlines of bodies as discs and boxes, and by how much they overlap."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape, Transform
from physicslab.components.shape import BOX
from physicslab.ecs.vector import Vector2
from physicslab.state.state import State

type Numbers = NDArray[np.float64]
"""A float64 array, of bodies (n,) or of vectors (n, 2), or a vector (2,)."""
type Rows = NDArray[np.int64]
"""Row numbers (n,)."""


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

    @property
    def size(self) -> Numbers:
        """The diameter of each disc, the smaller side of each box (n,) [m]."""
        sizes: Numbers = np.where(self.radius > 0.0, 2.0 * self.radius, 2.0 * self.half.min(axis=1))
        return sizes


def outlines_of(state: State, rows: Rows) -> Outlines:
    """Return the outlines of the shapes in some rows (n,)."""
    transform, shape = state.table(Transform), state.table(Shape)
    box = shape["kind"][rows] == BOX
    half = 0.5 * np.stack((shape["width"][rows], shape["height"][rows]), axis=1) * box[:, None]
    radius = np.where(box, 0.0, shape["radius"][rows])
    return Outlines(transform["position"][rows].copy(), half, radius, transform["angle"][rows].copy())


def overlapping(one: Outlines, n: int, others: Outlines) -> Rows:
    """Return which of the others may overlap a shape: their boxes along the axes of the world do."""
    near = (np.abs(others.place - one.place[n]) < others.reach + one.reach[n]).all(axis=1)
    return np.flatnonzero(near)


def overlap(one: Outlines, n: int, two: Outlines, m: int) -> tuple[float, Numbers]:
    """Return by how much two shapes overlap along the direction in which it is least [m], and that direction.

    The overlap is negative where they are apart; the direction (2,) is that in which ``two`` goes to leave
    ``one``. Directions of edges and between middles and the nearest corners are tried (Ericson, Real-Time
    Collision Detection, 2005, 5.2).
    """
    offset = two.place[m] - one.place[n]
    axes = [*_axes(one, n), *_axes(two, m)]
    for disc, centre, other, k in ((one, n, two, m), (two, m, one, n)):
        if disc.radius[centre] > 0.0:
            towards = _nearest(other, k, disc.place[centre]) - disc.place[centre]
            length = float(np.hypot(*towards))
            if length > 0.0:
                axes.append(towards / length)
    if not axes:
        axes = [np.array((0.0, 1.0))]  # two discs at one place
    gaps = [_extent(one, n, axis) + _extent(two, m, axis) - abs(float(offset @ axis)) for axis in axes]
    least = int(np.argmin(gaps))
    return gaps[least], axes[least] if float(offset @ axes[least]) >= 0.0 else -axes[least]


def exits(one: Outlines, n: int, two: Outlines, m: int) -> list[Numbers]:
    """Return the ways (2,) [m] along the edges of ``one`` and the world's axes on which ``two`` leaves it."""
    offset = two.place[m] - one.place[n]
    ways = []
    for axis in (*_axes(one, n), np.array((1.0, 0.0)), np.array((0.0, 1.0))):
        both, along = _extent(one, n, axis) + _extent(two, m, axis), float(offset @ axis)
        ways += [(both - along) * axis, -(both + along) * axis]
    return ways


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
