"""Where two shapes touch: separations, normals and points, in coordinates relative to A's centre."""

import math
from typing import NamedTuple

from physicslab.kernels import inlined
from physicslab.kernels.geometry.outline import Outline

_PARALLEL = 0.9998
"""Cosine of the angle between axes of boxes from which on these count as parallel: 0.02 rad."""
FAVOUR, ALIKE = 0.005, 1e-9
"""Share of the smallest half extent by which an axis must be better than that of old points, and up to which
two axes are as good."""
LEVEL = 0.01
"""Share of the smaller half extent by which the surfaces of parallel boxes may differ and still be level."""


@inlined
def circle_circle(
    dx: float, dy: float, radius_a: float, radius_b: float, tie: int
) -> tuple[float, float, float]:
    """Return the normal from A to B and the separation of two circles whose centres are (dx, dy) apart.

    Coincident centres have no direction; ``tie`` gives each pair one of its own.
    """
    distance = math.sqrt(dx * dx + dy * dy)
    if distance > 0.0:
        return dx / distance, dy / distance, distance - radius_a - radius_b
    turn = 2.399963229728653 * tie  # the golden angle spreads many coincident pairs evenly
    return math.cos(turn), math.sin(turn), -radius_a - radius_b


@inlined
def circle_box(x: float, y: float, box: Outline, radius: float) -> tuple[float, float, float, float, float]:
    """Return the normal from box to circle, the point of the box's outline nearest, and the separation.

    (x, y) is the circle's centre from the box's.
    """
    c, s, half_x, half_y = box.c, box.s, box.half_x, box.half_y
    local_x, local_y = c * x + s * y, c * y - s * x
    near_x = min(max(local_x, -half_x), half_x)
    near_y = min(max(local_y, -half_y), half_y)
    out_x, out_y = local_x - near_x, local_y - near_y
    distance = math.sqrt(out_x * out_x + out_y * out_y)
    if distance > 0.0:
        nx, ny = out_x / distance, out_y / distance
    else:  # the centre is inside: out through the nearest face
        nx, ny = 0.0, 0.0
        depth_x, depth_y = half_x - abs(local_x), half_y - abs(local_y)
        if depth_x < depth_y:
            nx = 1.0 if local_x >= 0.0 else -1.0
            near_x = nx * half_x
            distance = -depth_x
        else:
            ny = 1.0 if local_y >= 0.0 else -1.0
            near_y = ny * half_y
            distance = -depth_y
    return (
        c * nx - s * ny, s * nx + c * ny, c * near_x - s * near_y, s * near_x + c * near_y, distance - radius,
    )  # fmt: skip


@inlined
def wall_corner(k: int, box: Outline) -> tuple[float, float]:
    """Return corner k of a box, counted counter-clockwise from (+, +), relative to its centre."""
    x = box.half_x if k == 0 or k == 3 else -box.half_x
    y = box.half_y if k == 0 or k == 1 else -box.half_y
    return box.c * x - box.s * y, box.s * x + box.c * y


class Corner(NamedTuple):
    """A point of two boxes: half-way between the surfaces, from A's centre [m], and which point it is."""

    x: float
    y: float
    separation: float
    feature: int


@inlined
def _feature_of(face: int, edge: int, incident: int) -> int:
    """Return the number of the first of two points of a face, its edge, and the edge that it faces."""
    return 1 + 2 * (incident + 4 * (edge + (4 if face >= 2 else 0)))


@inlined
def _face_of(feature: int) -> int:
    """Return the axis of a point's number: x or y of A, x or y of B."""
    edge = (feature - 1) // 8
    return (0 if edge % 2 == 1 else 1) + (2 if edge >= 4 else 0)


@inlined
def _grazes(across: float, slack: float, toward: float, aside: float) -> bool:
    """Whether what comes on along an axis hardly overlaps across it: it slides over what it meets."""
    return across > -slack and toward < 0.0 and -toward > abs(aside)


@inlined
def _best_axis(
    dx: float, dy: float, ux: float, uy: float, a: Outline, b: Outline, margin: float, feature: int
) -> tuple[float, int]:
    """Return the largest separation [m] along an axis of two boxes, and which: x or y of A, x or y of B.

    (ux, uy) is how B moves against A. The axis of an old point's ``feature`` stays unless another one is
    better by a little, so that the reference face does not change to and fro; else the best is taken,
    whichever box is A. Where parallel boxes are level but for a little, and B slides on to A, the axis across
    the way is returned: the side of the next tile of a floor is no wall.
    """
    # d in the frames of A and of B; the axes of B seen from A
    dax, day = a.c * dx + a.s * dy, a.c * dy - a.s * dx
    dbx, dby = b.c * dx + b.s * dy, b.c * dy - b.s * dx
    c, s = abs(a.c * b.c + a.s * b.s), abs(a.c * b.s - a.s * b.c)
    gap_ax = abs(dax) - a.half_x - (c * b.half_x + s * b.half_y)
    gap_ay = abs(day) - a.half_y - (s * b.half_x + c * b.half_y)
    gap_bx = abs(dbx) - b.half_x - (c * a.half_x + s * a.half_y)
    gap_by = abs(dby) - b.half_y - (s * a.half_x + c * a.half_y)
    smallest = min(min(a.half_x, a.half_y), min(b.half_x, b.half_y))
    rounding, gap, face = ALIKE * smallest, gap_ax, 0
    if gap_ay > gap + rounding:
        gap, face = gap_ay, 1
    if gap_bx > gap + rounding:
        gap, face = gap_bx, 2
    if gap_by > gap + rounding:
        gap, face = gap_by, 3
    if feature > 0:
        held = _face_of(feature)
        held_gap = (gap_ax if held == 0 else gap_ay) if held < 2 else (gap_bx if held == 2 else gap_by)
        if gap <= held_gap + FAVOUR * smallest:
            gap, face = held_gap, held
    if (c < _PARALLEL and s < _PARALLEL) or gap > margin or (ux == 0.0 and uy == 0.0):
        return gap, face
    # With parallel boxes, A has the axes of B, which may be turned by a right angle.
    alike = s < c
    gap_x, gap_y = max(gap_ax, gap_bx if alike else gap_by), max(gap_ay, gap_by if alike else gap_bx)
    uax, uay = a.c * ux + a.s * uy, a.c * uy - a.s * ux
    toward_x, toward_y = (uax if dax > 0.0 else -uax), (uay if day > 0.0 else -uay)
    slack = LEVEL * smallest
    upright = face == 0 or face == (2 if alike else 3)
    if upright and _grazes(gap_y, slack, toward_x, toward_y):
        return gap_y, 1
    if not upright and _grazes(gap_x, slack, toward_y, toward_x):
        return gap_x, 0
    return gap, face


@inlined
def _reference_face(
    upright: bool, toward_x: float, toward_y: float, box: Outline
) -> tuple[float, float, float, float, int]:
    """Return the outward normal of the face of a box towards a point, its distance, half length and edge.

    The point is given in the frame of the box; the normal is along its x if ``upright``, else along its y.
    """
    if upright:
        sign = 1.0 if toward_x >= 0.0 else -1.0
        return sign * box.c, sign * box.s, box.half_x, box.half_y, 3 if sign > 0.0 else 1
    sign = 1.0 if toward_y >= 0.0 else -1.0
    return -sign * box.s, sign * box.c, box.half_y, box.half_x, 0 if sign > 0.0 else 2


@inlined
def _incident_edge(nx: float, ny: float, box: Outline) -> int:
    """Return the edge of a box whose outward normal is most opposed to a normal."""
    local_nx, local_ny = -(box.c * nx + box.s * ny), -(box.c * ny - box.s * nx)
    sideways, upright = 3 if local_nx > 0.0 else 1, 0 if local_ny > 0.0 else 2
    return sideways if abs(local_nx) > abs(local_ny) else upright


@inlined
def clipped(along1: float, along2: float, side: float) -> tuple[float, float]:
    """Return the shares of an edge from ``along1`` to ``along2`` [m] between which it is within ``side``."""
    start, end = 0.0, 1.0
    run = along2 - along1
    if abs(run) > 0.0:
        low, high = (-side - along1) / run, (side - along1) / run
        start, end = max(start, min(low, high)), min(end, max(low, high))
    elif abs(along1) > side:
        end = -1.0
    return start, end


@inlined
def box_box(
    dx: float, dy: float, ux: float, uy: float, a: Outline, b: Outline, margin: float, old: int
) -> tuple[float, float, float, int, Corner, Corner]:
    """Return the contact of two boxes: separating axes, then the incident edge clipped to the reference face.

    (dx, dy) leads from A's centre to B's, (ux, uy) is how B moves against A. ``old`` is the feature of a
    point that they have had, or 0.

    Returns
    -------
    gap, nx, ny, count, one, two
        ``gap`` is the separation along the best axis, the normal leads from A to B. No points where the gap
        exceeds ``margin``. (After Catto, box2d-lite.)
    """
    gap, face = _best_axis(dx, dy, ux, uy, a, b, margin, old)
    none = Corner(0.0, 0.0, 0.0, 0)
    if gap > margin:
        return gap, 0.0, 0.0, 0, none, none
    # The reference box holds the face; the edge of the incident box is cut off at the face's ends.
    flip = face >= 2
    upright = face == 0 or face == 2
    if flip:
        nx, ny, depth, side, edge = _reference_face(
            upright, -(b.c * dx + b.s * dy), -(b.c * dy - b.s * dx), b
        )
        incident = _incident_edge(nx, ny, a)
        x1, y1 = wall_corner(incident, a)
        x2, y2 = wall_corner((incident + 1) % 4, a)
        origin_x, origin_y, incident_x, incident_y = dx, dy, 0.0, 0.0
    else:
        nx, ny, depth, side, edge = _reference_face(upright, a.c * dx + a.s * dy, a.c * dy - a.s * dx, a)
        incident = _incident_edge(nx, ny, b)
        x1, y1 = wall_corner(incident, b)
        x2, y2 = wall_corner((incident + 1) % 4, b)
        origin_x, origin_y, incident_x, incident_y = 0.0, 0.0, dx, dy
    x1, y1 = x1 + incident_x - origin_x, y1 + incident_y - origin_y
    x2, y2 = x2 + incident_x - origin_x, y2 + incident_y - origin_y
    tx, ty = -ny, nx
    start, end = clipped(x1 * tx + y1 * ty, x2 * tx + y2 * ty, side)
    if start > end:
        return gap, 0.0, 0.0, 0, none, none
    px1, py1 = x1 + start * (x2 - x1), y1 + start * (y2 - y1)
    px2, py2 = x1 + end * (x2 - x1), y1 + end * (y2 - y1)
    separation1, separation2 = px1 * nx + py1 * ny - depth, px2 * nx + py2 * ny - depth
    feature = _feature_of(face, edge, incident)
    one = Corner(
        px1 - 0.5 * separation1 * nx + origin_x, py1 - 0.5 * separation1 * ny + origin_y, separation1, feature
    )
    two = Corner(
        px2 - 0.5 * separation2 * nx + origin_x, py2 - 0.5 * separation2 * ny + origin_y, separation2,
        feature + 1,
    )  # fmt: skip
    if flip:
        nx, ny = -nx, -ny
    if separation1 <= margin and separation2 <= margin:
        return gap, nx, ny, 2, one, two
    if separation1 <= margin:
        return gap, nx, ny, 1, one, none
    return gap, nx, ny, 1, two, none
