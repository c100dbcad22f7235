"""The outline of a body and its way against another one, as the narrow phase takes them."""

import math
from typing import NamedTuple

from physicslab.kernels import Numbers, Vectors, fused, inlined
from physicslab.kernels.geometry.shapes import BOX, Shapes

__all__ = ["Outline", "Way", "kept_outline", "outline_of", "turned"]


class Outline(NamedTuple):
    """Whether a body is a box; cosine and sine of its angle and its half extents [m]; a disc's radius [m]."""

    box: bool
    c: float
    s: float
    half_x: float
    half_y: float
    radius: float


class Way(NamedTuple):
    """From A's centre to B's (dx, dy) [m], and how far B moves against A in a substep (ux, uy) [m]."""

    dx: float
    dy: float
    ux: float
    uy: float


@fused
def outline_of(i: int, angle: Numbers, shapes: Shapes) -> Outline:
    """Return the outline of row i."""
    box = shapes.first[i] == BOX
    c, s = (math.cos(angle[i]), math.sin(angle[i])) if box else (1.0, 0.0)
    return Outline(box, c, s, shapes.half_x[i], shapes.half_y[i], shapes.radius[i])


@fused
def kept_outline(i: int, angle: Numbers, shapes: Shapes, rotations: Vectors) -> Outline:
    """Return the same; ``rotations`` (rows, 3) keeps each box's angle, its cosine and its sine."""
    box = shapes.first[i] == BOX
    if box and rotations[i, 0] != angle[i]:
        rotations[i, 0] = angle[i]
        rotations[i, 1], rotations[i, 2] = math.cos(angle[i]), math.sin(angle[i])
    c, s = (rotations[i, 1], rotations[i, 2]) if box else (1.0, 0.0)
    return Outline(box, c, s, shapes.half_x[i], shapes.half_y[i], shapes.radius[i])


@inlined
def turned(outline: Outline, angle: float) -> Outline:
    """Return an outline turned by an angle [rad]."""
    box, c, s, half_x, half_y, radius = outline
    if angle == 0.0 or not box:
        return outline
    cosine, sine = math.cos(angle), math.sin(angle)
    return Outline(box, c * cosine - s * sine, s * cosine + c * sine, half_x, half_y, radius)
