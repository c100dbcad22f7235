"""The outline of a body and its way against another one, as the narrow phase takes them."""

import math
from typing import NamedTuple

from physicslab.kernels import Numbers, Vectors, always_inlined, inlined
from physicslab.kernels.geometry.shapes import BOX, Shapes, segment_of

_SMALL = 0.1
"""Angle [rad] up to which five terms of the series of cosine and sine are right to rounding."""


class Outline(NamedTuple):
    """A row of the table of shapes, and how it lies.

    Whether it is a box; cosine and sine of its angle; half extents of its core and its radius [m]; the number
    of its vertices, and where they begin in the pool; half of its smallest width [m].
    """

    box: bool
    c: float
    s: float
    half_x: float
    half_y: float
    radius: float
    vertices: int
    first: int
    thin: float


class Way(NamedTuple):
    """From A's centre to B's (dx, dy) [m], and how far B moves against A in a substep (ux, uy) [m]."""

    dx: float
    dy: float
    ux: float
    uy: float


@always_inlined
def lying(i: int, shapes: Shapes, c: float, s: float) -> Outline:
    """Return the outline of row i, turned by the angle of which these are cosine and sine."""
    return Outline(
        shapes.first[i] == BOX, c, s, shapes.half_x[i], shapes.half_y[i], shapes.radius[i],
        shapes.vertices[i], shapes.first[i], shapes.thin[i],
    )  # fmt: skip


@always_inlined
def kept_outline(i: int, angle: Numbers, shapes: Shapes, rotations: Vectors) -> Outline:
    """Return the outline of row i; ``rotations`` (rows, 3) keeps angles, and their cosines and sines."""
    turns = shapes.vertices[i] > 1
    if turns and rotations[i, 0] != angle[i]:
        rotations[i, 0] = angle[i]
        rotations[i, 1], rotations[i, 2] = math.cos(angle[i]), math.sin(angle[i])
    c, s = (rotations[i, 1], rotations[i, 2]) if turns else (1.0, 0.0)
    return lying(i, shapes, c, s)


@always_inlined
def is_segment(outline: Outline) -> bool:
    """Whether an outline is one of a chain: no other core of two vertices has no radius."""
    return bool(outline.vertices == 2 and outline.radius == 0.0)


@always_inlined
def on_segment(outline: Outline, wall: int) -> Outline:
    """Return the segment of a chain that the ``wall`` of a pair names; of other shapes the outline itself."""
    box, c, s, half_x, half_y, radius, vertices, first, thin = outline
    first += segment_of(wall) if is_segment(outline) else 0
    return Outline(box, c, s, half_x, half_y, radius, vertices, first, thin)


@always_inlined
def rotation(angle: float) -> tuple[float, float]:
    """Return cosine and sine of an angle [rad], by their series where it is as small as a substep's."""
    if abs(angle) > _SMALL:
        return math.cos(angle), math.sin(angle)
    z = angle * angle
    cosine = 1.0 - z * (1.0 / 2.0 - z * (1.0 / 24.0 - z * (1.0 / 720.0 - z * (1.0 / 40320.0))))
    sine = angle * (1.0 - z * (1.0 / 6.0 - z * (1.0 / 120.0 - z * (1.0 / 5040.0 - z * (1.0 / 362880.0)))))
    return cosine, sine


@inlined
def turned(outline: Outline, angle: float) -> Outline:
    """Return an outline turned by an angle [rad]."""
    box, c, s, half_x, half_y, radius, vertices, first, thin = outline
    if angle == 0.0 or vertices < 2:
        return outline
    cosine, sine = rotation(angle)
    return Outline(
        box, c * cosine - s * sine, s * cosine + c * sine, half_x, half_y, radius, vertices, first, thin
    )  # fmt: skip


@inlined
def corner(k: int, outline: Outline, pool: Vectors) -> tuple[float, float]:
    """Return vertex k of a core, counted counter-clockwise, from its centre in the world's directions [m]."""
    x, y = outline.half_x * pool[outline.first + k, 0], outline.half_y * pool[outline.first + k, 1]
    return outline.c * x - outline.s * y, outline.s * x + outline.c * y


@inlined
def swing_of(outline: Outline, turn: float) -> float:
    """Return how far a corner comes, at most, while an outline turns so far [m]."""
    return abs(turn) * math.sqrt(outline.half_x * outline.half_x + outline.half_y * outline.half_y)
