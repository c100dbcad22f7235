"""Outlines of bodies, and by how much they overlap."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from physicslab.components import Shape, Transform
from physicslab.components.shape import CHAIN
from physicslab.ecs.vector import Vector2
from physicslab.state.shapes import cores_of
from physicslab.state.state import State

type Numbers = NDArray[np.float64]
"""A float64 array, of bodies (n,) or of vectors (n, 2), or a vector (2,)."""
type Rows = NDArray[np.int64]
"""Row numbers (n,)."""


@dataclass(frozen=True)
class Outlines:
    """Rounded polygons, a row each: a disc has one corner, its middle, and a radius; a box four and none.

    Attributes
    ----------
    place : float64 array (n, 2)
        Where the middle is [m].
    corners : float64 array (n, 8, 2)
        The vertices of its core from there, counter-clockwise, the last one repeated [m].
    vertices : int64 array (n,)
        Their numbers.
    radius, size : float64 arrays (n,)
        Radius that rounds the core, and the smaller one of the whole extents [m].
    line : bool array (n,)
        Whether it is a chain, which has no inside.
    """

    place: Numbers
    corners: Numbers
    vertices: Rows
    radius: Numbers
    size: Numbers
    line: NDArray[np.bool_]

    def moved(self, by: Vector2) -> Outlines:
        """Return the same elsewhere."""
        return replace(self, place=self.place + np.array((by.x, by.y)))

    def only(self, which: NDArray[np.bool_] | Rows) -> Outlines:
        """Return some of them, by a mask (n,) or numbers (m,), with places of their own."""
        return Outlines(*(getattr(self, each.name)[which] for each in fields(self)))

    @cached_property
    def reach(self) -> Numbers:
        """Half of the width and height of what is taken up along the axes of the world (n, 2) [m]."""
        reach: Numbers = np.abs(self.corners).max(axis=1) + self.radius[:, None]
        return reach

    @property
    def boxes(self) -> tuple[Numbers, Numbers]:
        """The lowest and the highest corner of the upright box around each (n, 2) [m]."""
        return self.place - self.reach, self.place + self.reach

    @property
    def area(self) -> Numbers:
        """Area within each of them (n,) [m^2]; 0 for a chain."""
        around = np.roll(self.corners, -1, axis=1)
        core = 0.5 * (self.corners[:, :, 0] * around[:, :, 1] - self.corners[:, :, 1] * around[:, :, 0]).sum(
            axis=1
        )
        length = np.hypot(*(around - self.corners).transpose(2, 0, 1)).sum(axis=1)
        area: Numbers = core + self.radius * (length + np.pi * self.radius)
        return np.where(self.line, 0.0, area)

    def gaps(self, x: float, y: float) -> Numbers:
        """Return how far a place [m] is from each outline (n,) [m]; negative within."""
        edges = np.roll(self.corners, -1, axis=1) - self.corners
        offset = np.array((x, y)) - self.place[:, None, :] - self.corners
        share = (offset * edges).sum(axis=2) / np.maximum((edges * edges).sum(axis=2), 1e-300)
        away = offset - np.clip(share, 0.0, 1.0)[:, :, None] * edges
        distance = np.hypot(away[:, :, 0], away[:, :, 1]).min(axis=1)
        across = edges[:, :, 0] * offset[:, :, 1] - edges[:, :, 1] * offset[:, :, 0]
        within = (self.vertices > 2) & (across >= 0.0).all(axis=1)
        gaps: Numbers = np.where(within, -distance, distance) - self.radius
        return gaps


def discs_at(places: Sequence[Vector2], radius: float) -> Outlines:
    """Return discs of a radius [m] at places [m]."""
    count = len(places)
    middle = np.array([tuple(place) for place in places]).reshape(-1, 2)
    return Outlines(
        middle, np.zeros((count, 8, 2)), np.ones(count, np.int64), np.full(count, radius),
        np.full(count, 2.0 * radius), np.zeros(count, np.bool_),
    )  # fmt: skip


def outlines_of(state: State, rows: Rows) -> Outlines:
    """Return the outlines of the shapes in some rows, as they are now."""
    transform = state.table(Transform)
    return outlines_at(state, rows, transform["position"][rows].copy(), transform["angle"][rows])


def outlines_at(state: State, rows: Rows, place: Numbers, angle: Numbers) -> Outlines:
    """Return outlines of the shapes in some rows, at places (n, 2) [m] and turned by angles (n,) [rad]."""
    corners, vertices, radius, half = cores_of(state.table(Shape), rows)
    line = state.table(Shape)["kind"][rows] == CHAIN
    half[line] = np.hypot(*half[line].T)[:, None]
    c, s = np.cos(angle), np.sin(angle)
    turned = np.stack((c, s, -s, c), axis=1).reshape(-1, 2, 2)
    return Outlines(place, corners @ turned, vertices, radius, 2.0 * (half.min(axis=1) + radius), line)


def overlapping(one: Outlines, n: int, others: Outlines) -> Rows:
    """Return which of the others may overlap a shape: their upright boxes do, and they are no chains."""
    near = (np.abs(others.place - one.place[n]) < others.reach + one.reach[n]).all(axis=1)
    return np.flatnonzero(near & ~others.line & ~one.line[n])


def overlap(one: Outlines, n: int, two: Outlines, m: int) -> tuple[float, Numbers]:
    """Return by how much two shapes overlap along the direction in which it is least [m], and that direction.

    The overlap is negative where they are apart; the direction (2,) is that in which ``two`` goes to leave
    ``one``. Directions of edges and between middles and the nearest corners are tried (Ericson, Real-Time
    Collision Detection, 2005, 5.2).
    """
    axes = np.concatenate((_axes(one, n), _axes(two, m)))
    if one.radius[n] + two.radius[m] > 0.0:
        axes = np.concatenate((axes, _between(one, n, two, m)))
    if not len(axes):
        axes = np.array(((0.0, 1.0),))  # two discs at one place
    ways = np.stack((axes, -axes), axis=1).reshape(-1, 2)
    depth = _lengths(one, n, two, m, ways)
    least = int(depth.argmin())
    return float(depth[least]), ways[least]


def _between(one: Outlines, n: int, two: Outlines, m: int) -> Numbers:
    """Return the direction (1, 2) from the point of a core that is nearest to another core to that one's.

    None (0, 2) where these points are one.
    """
    ways = np.concatenate((_to_nearest(one, n, two, m), -_to_nearest(two, m, one, n)))
    lengths = np.hypot(*ways.T)
    shortest = int(lengths.argmin())
    found: Numbers = ways[shortest : shortest + 1] / (lengths[shortest] or 1.0)
    return found if lengths[shortest] > 0.0 else ways[:0]


def exits(one: Outlines, n: int, two: Outlines, m: int) -> list[Numbers]:
    """Return the ways (2,) [m] along the edges of ``one`` and the world's axes on which ``two`` leaves it."""
    axes = np.concatenate((_axes(one, n), ((1.0, 0.0), (0.0, 1.0))))
    ways = np.stack((axes, -axes), axis=1).reshape(-1, 2)
    return list(_lengths(one, n, two, m, ways)[:, None] * ways)


def _axes(shape: Outlines, n: int) -> Numbers:
    """Return the normals of a core's edges (k, 2); a disc has none."""
    corners = shape.corners[n, : shape.vertices[n]]
    ways = np.concatenate((corners[1:], corners[:1])) - corners
    ways = ways[: len(ways) if len(ways) > 1 else 0]
    normals: Numbers = np.stack((ways[:, 1], -ways[:, 0]), axis=1) / np.hypot(*ways.T)[:, None]
    return normals


def _lengths(one: Outlines, n: int, two: Outlines, m: int, ways: Numbers) -> Numbers:
    """Return how far ``two`` has to go in each of some directions (k, 2) to leave ``one`` (k,) [m]."""
    reach = (one.corners[n] @ ways.T).max(axis=0) - (two.corners[m] @ ways.T).min(axis=0)
    lengths: Numbers = reach + one.radius[n] + two.radius[m] - ways @ (two.place[m] - one.place[n])
    return lengths


def _to_nearest(one: Outlines, n: int, two: Outlines, m: int) -> Numbers:
    """Return the ways (k, 2) from the corners of a core to the nearest point of another's edges [m]."""
    corners = two.place[m] + two.corners[m]
    edges = np.concatenate((corners[1:], corners[:1])) - corners
    offset = (one.place[n] + one.corners[n, : one.vertices[n]])[:, None] - corners
    share = (offset * edges).sum(axis=2) / np.maximum((edges * edges).sum(axis=1), 1e-300)
    ways = np.clip(share, 0.0, 1.0)[:, :, None] * edges - offset
    nearest: Numbers = ways[np.arange(len(ways)), np.hypot(ways[:, :, 0], ways[:, :, 1]).argmin(axis=1)]
    return nearest
